/* Bends of light over leaves with exact rows.
 *
 * Over such a leaf B counts as linear (rad/beyond/gather/gather.c). The rest is the bend:
 * B of a leaf less the linear function over its parent. Its error comes back as often as
 * light is reflected, so less is allowed where little is absorbed:
 *
 *     area * bend^2  <=  BENT * absorptance * epsilon * sum of area * (rho H)^2,
 *
 * in each band apart, since dim bands are to be right, too. Links make a mesh for the
 * brightest band, which may be too coarse by more than a level for a dim one reflected
 * more often, and where much is reflected next to an edge. */
#include "rad/beyond/gather/bends.h"

#include <math.h>

#include "rad/beyond/gather/gather.h"

static const double BENT = 0.002;

/* Where B is smooth, the error of a bend over a child is the part FALL of the error over
 * its parent, a sixteenth for the square of the bend, a quarter for the area; a child is
 * split, too, if its error is more than MUCH times the allowed one. */
static const double FALL = 1.0 / 64.0, MUCH = 64.0;

/* The squares of B of a leaf less the linear function over its parent, band by band. Over
 * a root this function is constant, and some children have its B by chance: there the
 * child most off counts for all. */
static struct rgb bends_of(const struct forest *forest, int32_t leaf)
{
    const struct patch *patches = forest->patches;
    int32_t parent = patches[leaf].parent, first = leaf, count = parent < 0 ? 0 : 1;
    struct rgb bends = {{0.0, 0.0, 0.0}};
    if (parent >= 0 && patches[parent].parent < 0) {
        first = patches[parent].children;
        count = 4;
    }
    for (int32_t child = first; child < first + count; child++) {
        struct rgb line = light_by_parent(forest, child);
        for (int c = 0; c < BANDS; c++) {
            double off = forest->radiosity[child].band[c] - line.band[c];
            bends.band[c] = fmax(bends.band[c], off * off);
        }
    }
    return bends;
}

int gather_splits_of(const struct model *model, int32_t leaf, const struct rgb *all)
{
    struct rgb bends = bends_of(model->forest, leaf);
    double part = BENT * model->absorptance * model->criterion.epsilon;
    double area = forest_area(model->forest, leaf);
    int splits = 0;
    for (int c = 0; c < BANDS; c++) {
        if (!(area * bends.band[c] > part * all->band[c]))
            continue;
        int levels = 1;
        double error = FALL * area * bends.band[c];
        for (; levels < ID_MAX_LEVEL && error > MUCH * part * all->band[c]; error *= FALL)
            levels++;
        splits = levels > splits ? levels : splits;
    }
    return splits;
}
