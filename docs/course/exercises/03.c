/* Exercises of chapter 3. */

/* One bounce: next[i] = e[i] + rho[i] * sum over j of f[i * n + j] * b[j]. */
void jacobi_step(int n, const double *e, const double *rho, const double *f,
                 const double *b, double *next)
{
    for (int i = 0; i < n; i++)
        next[i] = b[i];
}

/* The same in place: each new b[i] is used at once for those that follow. */
void gauss_seidel_step(int n, const double *e, const double *rho, const double *f,
                       double *b)
{
}

/* The power, W, that n patches absorb, by their radiosities b, emissions e, reflectances
 * rho (none is 0) and areas, m^2. */
double absorbed_power(int n, const double *e, const double *rho, const double *area,
                      const double *b)
{
    return 0.0;
}
