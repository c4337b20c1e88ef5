/* Nodes and weights of four rules, to the last bit of a double.
 *
 * A function analytic inside the ellipse with foci at the ends of the interval and half
 * axes of sum r (in units of half the interval) is integrated by n points with an error
 * of order r^(-2n) (Trefethen, Approximation Theory and Approximation Practice, Theorem
 * 19.3). So 4, 6, 10 and 16 points give 12 digits for r = 32, 10, 4 and 2.4;
 * geom/contour.c chooses by r.
 *
 * Rejected: nodes found by iteration at start, which needs a cosine to begin with. */
#include "geom/gauss.h"

static const struct gauss_pair GAUSS4[] = {
    {0.33998104358485626, 0.65214515486254614},
    {0.86113631159405258, 0.34785484513745386},
};

static const struct gauss_pair GAUSS6[] = {
    {0.23861918608319691, 0.46791393457269105},
    {0.66120938646626451, 0.36076157304813861},
    {0.93246951420315203, 0.17132449237917035},
};

static const struct gauss_pair GAUSS10[] = {
    {0.14887433898163121, 0.29552422471475287},
    {0.43339539412924719, 0.26926671930999636},
    {0.67940956829902441, 0.21908636251598204},
    {0.86506336668898451, 0.14945134915058059},
    {0.97390652851717172, 0.066671344308688138},
};

static const struct gauss_pair GAUSS16[] = {
    {0.095012509837637440, 0.18945061045506850},
    {0.28160355077925891, 0.18260341504492359},
    {0.45801677765722739, 0.16915651939500254},
    {0.61787624440264375, 0.14959598881657673},
    {0.75540440835500303, 0.12462897125553387},
    {0.86563120238783174, 0.095158511682492785},
    {0.94457502307323258, 0.062253523938647893},
    {0.98940093499164993, 0.027152459411754095},
};

struct gauss gauss_rule(int points)
{
    if (points <= 4)
        return (struct gauss){2, GAUSS4};
    if (points <= 6)
        return (struct gauss){3, GAUSS6};
    if (points <= 10)
        return (struct gauss){5, GAUSS10};
    return (struct gauss){8, GAUSS16};
}

double gauss_point(const struct gauss *rule, int k, double *weight)
{
    struct gauss_pair pair = rule->pair[k / 2];
    *weight = 0.5 * pair.weight;
    return k % 2 == 0 ? 0.5 - 0.5 * pair.at : 0.5 + 0.5 * pair.at;
}
