/* The sky is the upper half of an octahedron whose faces are cut in four LEVELS times,
 * its corners moved to a ball: all facets look about as large. As facets have one
 * radiosity and hide each other nowhere, only the edge of the sky matters. At the height
 * of the edge this is the horizon; from a height h the sky begins h / radius below the
 * horizon, and an upright face gets too much by at most 1.3 of this. */
#include "io/scene/sky.h"

#include "io/scene/subject.h"

enum { LEVELS = 2, FACETS = 4 << 2 * LEVELS };

static const double DISTANCE = 1024.0; /* relative to half the diagonal of the scene */

/* The place, and the next facet. */
struct dome {
    struct scene *scene;
    struct vec3 centre;
    double radius;
    int32_t next;
};

/* Adds the facets of a triangle of directions, which is seen from within. */
static void add_part(struct dome *dome, struct triangle part, int levels)
{
    for (int k = 0; k < 3; k++)
        part.corner[k] = vec3_unit(part.corner[k]);
    if (levels > 0) {
        for (int k = 0; k < 4; k++)
            add_part(dome, triangle_child(&part, k), levels - 1);
        return;
    }
    struct triangle *facet = &dome->scene->triangles[dome->next];
    for (int k = 0; k < 3; k++)
        facet->corner[k] = vec3_add(dome->centre,
                                    vec3_scale(part.corner[k], dome->radius));
    dome->scene->material_of[dome->next++] = dome->scene->material_count - 1;
}

void sky_add(struct scene *scene, struct rgb radiosity)
{
    int32_t axis = subject_find(scene).up;
    struct vec3 low = triangle_low(&scene->triangles[0]), high = low;
    for (int32_t i = 0; i < scene->input_count; i++) {
        low = vec3_least(low, triangle_low(&scene->triangles[i]));
        high = vec3_most(high, triangle_high(&scene->triangles[i]));
    }
    struct dome dome = {scene, vec3_middle(low, high),
                        0.5 * DISTANCE * vec3_length(vec3_sub(high, low)),
                        scene->input_count};
    struct vec3 up = up_frame(axis, 0.0, 0.0, 1.0), side = up_frame(axis, 1.0, 0.0, 0.0);
    double bottom = vec3_dot(up, low) < vec3_dot(up, high) ? vec3_dot(up, low)
                                                           : vec3_dot(up, high);
    dome.centre = (struct vec3){up.x != 0.0 ? bottom * up.x : dome.centre.x,
                                up.y != 0.0 ? bottom * up.y : dome.centre.y,
                                up.z != 0.0 ? bottom * up.z : dome.centre.z};
    scene_add_sky(scene, FACETS, (struct material){.emission = radiosity});
    struct vec3 other = vec3_cross(up, side);
    for (int k = 0; k < 4; k++) {
        add_part(&dome, (struct triangle){{up, other, side}}, LEVELS);
        struct vec3 before = side;
        side = other;
        other = vec3_scale(before, -1.0);
    }
}
