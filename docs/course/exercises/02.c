/* Exercises of chapter 2. */

/* F of two squares of this area, m^2, that face each other at this distance, m, by Eq. 2
 * from centre to centre. */
double disk_factor(double area, double distance)
{
    return 0.0;
}

/* F_ji, given F_ij and both areas, m^2. */
double other_way(double f_ij, double area_i, double area_j)
{
    return f_ij;
}

/* F from the floor of a cube to one of its four walls, given that from the floor to the
 * ceiling. */
double floor_to_wall(double floor_to_ceiling)
{
    return 0.0;
}
