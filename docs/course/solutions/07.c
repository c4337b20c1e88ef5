/* Solutions to the exercises of chapter 7. */

/* H of a leaf, W/m^2. Its line of ancestors has `count` patches, from the root to the
 * leaf itself: flux[i] is what links have brought to each, W, and area[i] its area,
 * m^2. */
double irradiance_of(int count, const double *flux, const double *area)
{
    double irradiance = 0.0;
    for (int i = 0; i < count; i++)
        irradiance += flux[i] / area[i];
    return irradiance;
}

/* The mean radiosity of a patch with `count` children of these radiosities b and
 * areas. */
double pull(int count, const double *b, const double *area)
{
    double power = 0.0, sum = 0.0;
    for (int i = 0; i < count; i++) {
        power += area[i] * b[i];
        sum += area[i];
    }
    return power / sum;
}
