/* Pairs of roots, dealt like cards: the k-th facing pair goes to rank k mod P.
 *
 * Neighbours in this order cost about the same, so each rank gets its part of the
 * expensive pairs, and a scene of a dozen triangles is divided as evenly as a large one.
 * To count, every rank goes through all pairs, a thousandth of the work. Sums are
 * integers, independent of the adding ranks, and sent in pieces that MPI can count. After
 * each TURN pairs of every rank all learn whether one has got a signal: the deal is the
 * same on all ranks, so all meet there. */
#include "tools/viewfactors/pairs.h"

#include "geom/alloc.h"
#include "geom/stop.h"

enum { TURN = 16 };

/* True if a rank is asked to stop. */
static bool some_stop(const struct comm *comm)
{
    int64_t stopped = stop_is_asked();
    comm_add(comm, &stopped, 1);
    return stopped > 0;
}

static void add_own_pairs(const struct comm *comm, struct viewfactors *factors,
                          struct progress *progress)
{
    const struct scene *scene = factors->scene;
    int32_t roots = scene_root_count(scene);
    struct facet *facets = alloc_array((size_t)roots, sizeof *facets);
    for (int32_t i = 0; i < roots; i++)
        facets[i] =
            (struct facet){scene_root_triangle(scene, i), scene_root_plane(scene, i),
                           scene_root_area(scene, i), scene_input_of(scene, i)};
    bool *faced = alloc_array((size_t)roots, sizeof *faced); /* by some other */
    int64_t dealt = 0, turn = (int64_t)TURN * comm->size;
    bool stopped = false;
    for (int32_t i = 0; i < roots && !stopped; i++) {
        progress_tick_pairs(progress, i, roots);
        for (int32_t j = i + 1; j < roots && !stopped; j++) {
            if (!(facets[i].area > 0.0) || !(facets[j].area > 0.0) ||
                !facets_face(&facets[i], &facets[j]))
                continue;
            faced[i] = faced[j] = true;
            if (dealt % comm->size == comm->rank)
                viewfactors_add(factors, i, &facets[i], j, &facets[j]);
            stopped = ++dealt % turn == 0 && some_stop(comm);
        }
    }
    factors->away = 0;
    for (int32_t i = roots - 1; i >= 0; i--)
        if (facets[i].area > 0.0 && !faced[i]) {
            factors->away++;
            factors->first_away = i;
        }
    alloc_free(faced);
    alloc_free(facets);
}

void pairs_add(const struct comm *comm, struct viewfactors *factors,
               struct progress *progress)
{
    const int64_t most = 1 << 20;
    for (int64_t k = 0; k < factors->pairs && comm->rank > 0; k++)
        factors->sums[k] = factors->errors[k] = 0; /* those of rank 0 are enough */
    add_own_pairs(comm, factors, progress);
    for (int64_t done = 0; done < factors->pairs; done += most) {
        int64_t left = factors->pairs - done;
        comm_add(comm, factors->sums + done, left < most ? left : most);
        comm_add(comm, factors->errors + done, left < most ? left : most);
    }
}
