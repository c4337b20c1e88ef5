/* A sum in two orders, with floating point and with integers: chapter 8 of the course. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>

enum { LINKS = 1000 };

/* Watts in units of 2^-40 W, as phr does it (rad/flux.h). */
static int64_t fixed(double watts)
{
    return (int64_t)llrint(watts * 1099511627776.0);
}

int main(void)
{
    double forth = 0.0, back = 0.0;
    int64_t fixed_forth = 0, fixed_back = 0;
    for (int k = 1; k <= LINKS; k++) {
        forth += 1.0 / k;
        back += 1.0 / (LINKS + 1 - k);
        fixed_forth += fixed(1.0 / k);
        fixed_back += fixed(1.0 / (LINKS + 1 - k));
    }
    printf("floating point %.15f %.15f\n", forth, back);
    printf("fixed point    %lld %lld\n", (long long)fixed_forth, (long long)fixed_back);
    return 0;
}
