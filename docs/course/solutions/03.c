/* Solutions to the exercises of chapter 3. */

/* One bounce: next[i] = e[i] + rho[i] * sum over j of f[i * n + j] * b[j]. */
void jacobi_step(int n, const double *e, const double *rho, const double *f,
                 const double *b, double *next)
{
    for (int i = 0; i < n; i++) {
        double irradiance = 0.0;
        for (int j = 0; j < n; j++)
            irradiance += f[i * n + j] * b[j];
        next[i] = e[i] + rho[i] * irradiance;
    }
}

/* The same in place: each new b[i] is used at once for those that follow. */
void gauss_seidel_step(int n, const double *e, const double *rho, const double *f,
                       double *b)
{
    for (int i = 0; i < n; i++) {
        double irradiance = 0.0;
        for (int j = 0; j < n; j++)
            irradiance += f[i * n + j] * b[j];
        b[i] = e[i] + rho[i] * irradiance;
    }
}

/* The power, W, that n patches absorb, by their radiosities b, emissions e, reflectances
 * rho (none is 0) and areas, m^2. */
double absorbed_power(int n, const double *e, const double *rho, const double *area,
                      const double *b)
{
    double power = 0.0;
    for (int i = 0; i < n; i++)
        power += area[i] * (1.0 - rho[i]) * (b[i] - e[i]) / rho[i];
    return power;
}
