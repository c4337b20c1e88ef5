/* Solutions to the exercises of chapter 1. */

/* Puts the radiosities of two patches, W/m^2, into b[0] and b[1]: of emissions e,
 * reflectances rho, and with the form factor f from either to the other. */
void two_patches(const double e[2], const double rho[2], double f, double b[2])
{
    double loop = rho[0] * f * rho[1] * f; /* of its own light, this comes back */
    b[0] = (e[0] + rho[0] * f * e[1]) / (1.0 - loop);
    b[1] = (e[1] + rho[1] * f * e[0]) / (1.0 - loop);
}

/* The number of bounces of docs/course/bounces.c after which the radiosity of the floor
 * differs by less than one part in ten million from the answer. */
int bounces_needed(void)
{
    double lamp = 0.0, floor = 0.0, answer = 10.0 / 0.99;
    int bounces = 0;
    while (answer - floor >= 1e-7 * answer) {
        double next = 100.0 + 0.1 * floor;
        floor = 0.1 * lamp;
        lamp = next;
        bounces++;
    }
    return bounces;
}

/* The power, W, that leaves the two patches of bounces.c (1 m^2 each) and arrives at
 * neither. */
double power_lost(void)
{
    double lamp = 100.0 / 0.99, floor = 0.1 * lamp;
    return (1.0 - 0.2) * (lamp + floor); /* a fifth of each arrives */
}
