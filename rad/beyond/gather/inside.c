/* Things may pierce each other, so the first face on a ray does not tell: from inside of
 * one thing this may be the front of another. So faces are counted, as in the crossing
 * number of a polygon: a front is an entry, a back an exit, and one exit more than
 * entries is the thing around the ray's origin. The walls of a room are entered, and left
 * as often. */
#include "rad/beyond/gather/inside.h"

#include <math.h>

#include "rad/beyond/sample.h"

/* Faces crossed by a ray, at most. */
enum { CROSSED_MOST = 32 };

/* A face crossed by a ray. */
struct crossing {
    int32_t input; /* triangle, -1: none */
    bool back;     /* met from behind, and of one side */
    struct vec3 at;
    struct vec3 normal; /* towards the ray's origin, but of a back */
};

/* The next face crossed by a ray; a back in the place of a front counts as a front. */
static struct crossing next_face(struct model *model, struct vec3 origin,
                                 struct vec3 direction)
{
    struct octree_hit hit;
    if (!octree_first_hit(model->octree, origin, direction, false, &hit, &model->counts))
        return (struct crossing){.input = -1};
    struct plane plane = model->scene->planes[hit.triangle];
    double along = plane_ahead(&plane, origin, direction);
    bool twin = scene_has_twin(model->scene, hit.triangle);
    return (struct crossing){
        hit.triangle, !hit.front && !twin, vec3_add(origin, vec3_scale(direction, along)),
        vec3_scale(plane.normal, !hit.front && twin ? -1.0 : 1.0)};
}

/* True if another face lies back to back with a front: seen from behind, its front. */
static bool is_backed(struct model *model, const struct crossing *front)
{
    struct vec3 behind = vec3_sub(front->at, vec3_scale(front->normal, FACES_APART));
    struct octree_hit hit;
    return octree_first_hit(model->octree, behind, front->normal, true, &hit,
                            &model->counts) &&
           fabs(plane_distance(&model->scene->planes[hit.triangle], front->at)) <=
               FACES_APART;
}

/* True if a ray meeting the face leaves more things than it has entered, or meets first a
 * front backed by another; `*single`: the ray leaves by a back alone, there or later. */
static bool leaves_a_thing(struct model *model, struct crossing face,
                           struct vec3 direction, bool *single)
{
    int entered = 0;
    bool bound = false;
    for (int count = 0; count < CROSSED_MOST && face.input >= 0; count++) {
        bool backed = !face.back && is_backed(model, &face);
        if (entered == 0 && face.back)
            return *single = true;
        bound = bound || (entered == 0 && backed);
        if (!backed && !scene_has_twin(model->scene, face.input))
            entered += face.back ? -1 : 1;
        double beyond = face.back ? FACES_APART : -FACES_APART;
        struct vec3 origin = vec3_add(face.at, vec3_scale(face.normal, beyond));
        face = next_face(model, origin, direction);
    }
    return bound;
}

bool ray_is_bound(struct model *model, struct vec3 origin, struct vec3 direction,
                  bool *single)
{
    struct crossing first = next_face(model, origin, direction);
    if (leaves_a_thing(model, first, direction, single))
        return true;
    if (first.input < 0 || first.back)
        return false;
    origin = point_above(first.at, first.normal);
    return leaves_a_thing(model, next_face(model, origin, first.normal), first.normal,
                          single);
}
