/* Tests the answers to the exercises of chapter 3. */
#include ANSWERS

#include "docs/course/exercises/exercise.h"

int main(void)
{
    /* Six patches, each of which sees a fifth of each other; the first shines. */
    double e[6] = {1.0}, rho[6], f[36], area[6], b[6] = {0.0}, c[6] = {0.0};
    for (int i = 0; i < 36; i++)
        f[i] = i / 6 == i % 6 ? 0.0 : 0.2;
    for (int i = 0; i < 6; i++) {
        rho[i] = 0.5;
        area[i] = 1.0;
    }
    int steps[2] = {0, 0};
    for (double change = 1.0; change > 1e-12 && steps[0] < 100; steps[0]++) {
        double next[6] = {0.0};
        jacobi_step(6, e, rho, f, b, next);
        change = 0.0;
        for (int i = 0; i < 6; i++) {
            change = fmax(change, fabs(next[i] - b[i]));
            b[i] = next[i];
        }
    }
    for (double change = 1.0; change > 1e-12 && steps[1] < 100; steps[1]++) {
        double old = c[0], last = c[5];
        gauss_seidel_step(6, e, rho, f, c);
        change = fabs(c[0] - old) + fabs(c[5] - last);
    }
    printf("# %d steps of Jacobi's, %d of Gauss and Seidel's\n", steps[0], steps[1]);
    report(is_near(b[0], 12.0 / 11.0) && is_near(b[1], 2.0 / 11.0), "jacobi_step()");
    report(is_near(c[0], 12.0 / 11.0) && is_near(c[5], 2.0 / 11.0) && steps[1] < steps[0],
           "gauss_seidel_step()");
    report(is_near(absorbed_power(6, e, rho, area, (double[]){12.0 / 11.0, 2.0 / 11.0,
                                                              2.0 / 11.0, 2.0 / 11.0,
                                                              2.0 / 11.0, 2.0 / 11.0}),
                   1.0),
           "absorbed_power(): all that is emitted");
    return finish();
}
