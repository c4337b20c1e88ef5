/* Exercises of chapter 1. */

/* Puts the radiosities of two patches, W/m^2, into b[0] and b[1]: of emissions e,
 * reflectances rho, and with the form factor f from either to the other. */
void two_patches(const double e[2], const double rho[2], double f, double b[2])
{
    b[0] = e[0];
    b[1] = e[1]; /* no light has gone anywhere yet */
}

/* The number of bounces of docs/course/bounces.c after which the radiosity of the floor
 * differs by less than one part in ten million from the answer. */
int bounces_needed(void)
{
    return 0;
}

/* The power, W, that leaves the two patches of bounces.c (1 m^2 each) and arrives at
 * neither. */
double power_lost(void)
{
    return 0.0;
}
