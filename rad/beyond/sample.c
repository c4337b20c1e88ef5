/* Samples: two numbers give a point of the parallelogram of two edges, of which one half
 * is folded onto the other; the direction around the normal is a point's in a square, the
 * first of some to lie in the disk, too. */
#include "rad/beyond/sample.h"

#include "geom/hash.h"

int64_t sum_place(const double *sums, int64_t count, double at)
{
    int64_t low = 0, high = count - 1;
    while (low < high) {
        int64_t middle = low + (high - low) / 2;
        if (sums[middle] > at)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

struct vec3 triangle_sample(const struct triangle *t, uint64_t seed)
{
    double u = hash_unit(seed), v = hash_unit(seed + 1);
    bool beyond = u + v > 1.0;
    u = beyond ? 1.0 - u : u;
    v = beyond ? 1.0 - v : v;
    struct vec3 along = vec3_add(vec3_scale(vec3_sub(t->corner[1], t->corner[0]), u),
                                 vec3_scale(vec3_sub(t->corner[2], t->corner[0]), v));
    return vec3_add(t->corner[0], along);
}

/* The direction with this square of the sine to the triangle's unit normal, turned about
 * the normal by an angle from the seed. */
static struct vec3 direction_above(const struct triangle *t, struct vec3 normal,
                                   double sine2, uint64_t seed)
{
    struct vec3 x = vec3_unit(vec3_sub(t->corner[1], t->corner[0]));
    double a, b, r2;
    do {
        a = 2.0 * hash_unit(seed) - 1.0;
        b = 2.0 * hash_unit(seed + 1) - 1.0;
        r2 = a * a + b * b;
        seed = hash_mix(seed);
    } while (!(r2 > 0.0 && r2 <= 1.0));
    double scale = sqrt(sine2 / r2);
    struct vec3 along = vec3_add(vec3_scale(x, a * scale),
                                 vec3_scale(vec3_cross(normal, x), b * scale));
    return vec3_add(along, vec3_scale(normal, sqrt(1.0 - sine2)));
}

struct half_line ray_sample(const struct triangle *t, struct vec3 normal, uint64_t seed,
                            int ring, int rings)
{
    double sine2 = (ring + hash_unit(seed + 4)) / rings;
    return (struct half_line){point_above(triangle_sample(t, seed), normal),
                              direction_above(t, normal, sine2, seed + 2)};
}

int32_t root_met(const struct scene *scene, const struct octree *octree,
                 const struct half_line *ray, int32_t outside,
                 struct octree_counts *counts)
{
    struct octree_hit hit;
    if (!octree_first_hit(octree, ray->origin, ray->direction, false, &hit, counts))
        return outside;
    return scene_root_on(scene, hit.triangle, hit.front);
}

int32_t leaf_at(const struct forest *forest, int32_t root, double weight[3])
{
    int32_t patch = root;
    while (!patch_is_leaf(&forest->patches[patch]))
        patch = forest->patches[patch].children + triangle_child_at(weight);
    return patch;
}

int32_t leaf_under(const struct forest *forest, int32_t root, struct vec3 at,
                   double weight[3])
{
    struct triangle t = scene_root_triangle(forest->scene, root);
    triangle_weights(&t, at, weight);
    return leaf_at(forest, root, weight);
}
