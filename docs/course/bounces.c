/* Two patches that exchange light, bounce after bounce: chapter 1 of the course.
 *
 * Of a lamp 0 and a floor 1, each sees the other under the form factor F:
 *
 *     B_0 = E_0 + rho_0 F B_1,        B_1 = E_1 + rho_1 F B_0.
 *
 * Each bounce evaluates both lines once, from the radiosities of the bounce before. The
 * last line is the answer of the two equations, by elimination. */
#include <stdio.h>

int main(void)
{
    const double emission[2] = {100.0, 0.0}, rho[2] = {0.5, 0.5}; /* W/m^2, 1 */
    const double f = 0.2;                                         /* 1 */
    double b[2] = {0.0, 0.0};                                     /* W/m^2 */
    printf("bounce      lamp     floor\n");
    for (int bounce = 0; bounce <= 5; bounce++) {
        printf("%6d %9.4f %9.4f\n", bounce, b[0], b[1]);
        double lamp = emission[0] + rho[0] * f * b[1];
        double floor = emission[1] + rho[1] * f * b[0];
        b[0] = lamp;
        b[1] = floor;
    }
    double lamp = (emission[0] + rho[0] * f * emission[1]) /
                  (1.0 - rho[0] * rho[1] * f * f);
    printf("answer %9.4f %9.4f\n", lamp, emission[1] + rho[1] * f * lamp);
    return 0;
}
