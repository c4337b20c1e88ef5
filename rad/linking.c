/* Initial linking.
 *
 * "Interactions between all initial patches in the scene are computed" (Sec. 2.2): k
 * roots have k (k - 1) / 2 pairs, and each has its form factor and its rays.
 * Nothing is known of a pair before, so a link depends on its two roots alone, neither on
 * other links nor on the ranks.
 *
 * The paper deals "an equal number of patches" to each processor. If a patch takes the
 * interactions with all patches behind it, the first patch has k - 1 of them and the last
 * one none. So pairs are dealt here instead, in turn: each rank has the same number of
 * them, but for one, and a part of the dear pairs and of the cheap ones of each row.
 * Nothing is predicted. Rejected: rows in turn (of 32 rows the first has 31 pairs more
 * than the last, and a large root makes its whole row dear). */
#include "rad/linking.h"

#include "geom/alloc.h"

/* Goes on by this number of pairs. */
static void step(struct linking *linking, int pairs)
{
    linking->number += pairs;
    linking->j += pairs;
    while (linking->j >= linking->count && linking->i < linking->count) {
        linking->i++;
        linking->j += linking->i + 1 - linking->count;
    }
}

struct linking linking_start(struct model *model, struct link_list *links, int rank,
                             int ranks)
{
    const struct forest *forest = model->forest;
    size_t roots = (size_t)forest->root_count;
    struct linking linking = {.model = model, .links = links, .j = 1, .ranks = ranks};
    linking.roots = alloc_array(roots, sizeof *linking.roots);
    linking.facets = alloc_array(roots, sizeof *linking.facets);
    for (int32_t root = 0; root < forest->root_count; root++) {
        if (!(scene_root_area(model->scene, root) > 0.0))
            continue;
        linking.facets[linking.count] = facet_make(forest, root);
        linking.roots[linking.count++] = root;
    }
    step(&linking, rank);
    return linking;
}

void linking_end(struct linking *linking)
{
    alloc_free(linking->roots);
    alloc_free(linking->facets);
    *linking = (struct linking){0};
}

int64_t linking_pairs(const struct linking *linking)
{
    return (int64_t)linking->count * (linking->count - 1) / 2;
}

void linking_add(struct linking *linking)
{
    int32_t i = linking->i, j = linking->j;
    struct link link;
    if (linking->model->method.make_link(linking->model, linking->roots[i],
                                         &linking->facets[i], linking->roots[j],
                                         &linking->facets[j], NULL, &link))
        link_list_append(linking->links, link);
    step(linking, linking->ranks);
}
