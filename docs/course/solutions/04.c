/* Solutions to the exercises of chapter 4. */
#include <math.h>
#include <stdbool.h>

/* True if the triangle t stands between the points x and y. (Points and corners are
 * arrays of three coordinates.) */
bool is_blocked(double t[3][3], const double x[3], const double y[3])
{
    double d[3], e[3], g[3], s[3], p[3], q[3];
    for (int k = 0; k < 3; k++) {
        d[k] = y[k] - x[k];
        e[k] = t[1][k] - t[0][k];
        g[k] = t[2][k] - t[0][k];
        s[k] = x[k] - t[0][k];
    }
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        p[k] = d[i] * g[j] - d[j] * g[i];
        q[k] = s[i] * e[j] - s[j] * e[i];
    }
    double det = e[0] * p[0] + e[1] * p[1] + e[2] * p[2];
    double u = (s[0] * p[0] + s[1] * p[1] + s[2] * p[2]) / det;
    double v = (d[0] * q[0] + d[1] * q[1] + d[2] * q[2]) / det;
    double at = (g[0] * q[0] + g[1] * q[1] + g[2] * q[2]) / det;
    return det != 0.0 && u >= 0.0 && v >= 0.0 && u + v <= 1.0 && at > 0.0 && at < 1.0;
}

/* True if no point of the segment from x to y is in the box from `low` to `high`. */
bool misses_box(const double x[3], const double y[3], const double low[3],
                const double high[3])
{
    double begin = 0.0, end = 1.0; /* the part of the segment within all slabs so far */
    for (int k = 0; k < 3; k++) {
        double d = y[k] - x[k];
        if (d == 0.0 && (x[k] < low[k] || x[k] > high[k]))
            return true;
        if (d == 0.0)
            continue;
        double a = (low[k] - x[k]) / d, b = (high[k] - x[k]) / d;
        begin = fmax(begin, fmin(a, b));
        end = fmin(end, fmax(a, b));
    }
    return begin > end;
}
