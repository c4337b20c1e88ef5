/* The scene: triangles with materials, in the program's own units.
 *
 * Positions are moved and scaled on preparation: the centre of the bounding box goes to
 * the origin, and a power of two brings the longest side into [1/2, 1). Lengths in the
 * program are such "scene units"; one scene unit is 2^place.exponent input units (called
 * metres). */
#ifndef GEOM_SCENE_H
#define GEOM_SCENE_H

#include <stdbool.h>
#include <stdint.h>

#include "geom/error.h"
#include "geom/pack.h"
#include "geom/triangle.h"

struct material {
    struct rgb reflectance; /* rho, 1, each band in [0, 1) */
    struct rgb emission;    /* E, emitted radiosity, W/m^2, each band >= 0 */
    struct rgb transmittance; /* of a pane, 1, each band in [0, 1]; 0: opaque */
};

/* True for a pane: such faces block nothing, and multiply the light crossing them. */
static inline bool material_is_pane(const struct material *material)
{
    return rgb_sum(material->transmittance) > 0.0;
}

/* True for a surface without reflectance and emission. */
static inline bool material_is_dark(const struct material *material)
{
    return rgb_sum(material->reflectance) == 0.0 && rgb_sum(material->emission) == 0.0;
}

static inline bool material_is_same(const struct material *a, const struct material *b)
{
    bool same = true;
    for (int c = 0; c < BANDS; c++)
        same = same && a->reflectance.band[c] == b->reflectance.band[c] &&
               a->emission.band[c] == b->emission.band[c] &&
               a->transmittance.band[c] == b->transmittance.band[c];
    return same;
}

/* True for a lamp. */
static inline bool material_emits(const struct material *material)
{
    return rgb_sum(material->emission) > 0.0;
}

/* Repairs of an input, for one warning per kind. */
struct scene_repairs {
    int64_t degenerate; /* triangles without area, dropped (their numbers stay) */
    int64_t doubles;    /* triangles lying on earlier ones and facing the same way,
                         * dropped alike */
    int64_t unlike;     /* of these, those of another material than the kept one */
    int64_t clamped;    /* materials with a reflectance of 1 or more, set to 0.999 */
};

/* Faces of the file, which triangles are cut from, and its groups of faces. */
struct scene_groups {
    int32_t *of;   /* [input_count], number of the group of each triangle */
    bool *goes_on; /* [input_count], of the same face as the triangle before; NULL after
                    * scene_prepare() */
    char *names;   /* [bytes], each with its zero */
    int32_t count; /* at least 1 */
    int64_t bytes;
};

/* Where the scene lies in the file's coordinates. */
struct scene_place {
    struct vec3 centre; /* of the input's bounding box, input units */
    int32_t exponent;   /* a scene unit is 2^exponent input units */
};

struct scene {
    struct triangle *triangles; /* [input_count], scene units after scene_prepare() */
    struct plane *planes;       /* [input_count]; zero for a dropped triangle */
    struct plane *opaque;       /* the same, zero for a pane, too; NULL: there are none */
    double *areas;              /* [input_count], square scene units; 0: dropped */
    int32_t *material_of;       /* [input_count], index into materials */
    bool *opposed;              /* [input_count], another triangle lies on this one,
                                 * facing the other way, in place of a twin */
    struct material *materials; /* [material_count] */
    struct vec3 *normals;       /* [3 * input_count] or NULL, of corner k of triangle i at
                                 * [3 i + k], for smooth shading: of length 1, or 0 */
    struct scene_groups groups;
    int32_t input_count;        /* triangles read from the file, dropped ones included,
                                 * and those of a sky */
    int32_t sky_first;          /* input triangles from this one on are a sky, which is no
                                 * part of the file; input_count: there is none */
    int32_t material_count;
    int32_t up;                 /* upward axis: 1, 2, 3 for x, y, z, or -; 0: unknown */
    bool two_sided;             /* triangles have twins: of i, root i + input_count */
    bool two_sided_lamps;       /* if two_sided: lamps have twins, too */
    bool has_panes;             /* faces are panes, which have twins, as if two_sided */
    struct scene_place place;
    struct vec3 low, high;      /* bounding box, scene units */
    bool is_view;               /* the arrays lie in memory of others */
};

/* An empty scene with room for the given numbers, all of it in one group, "default". Owns
 * its arrays. */
struct scene *scene_create(int32_t input_count, int32_t material_count);
void scene_destroy(struct scene *scene);

/* Into a block, and as laid out there: read-only, valid as long as the block. */
void scene_pack(const struct scene *scene, struct pack *pack);
struct scene *scene_view(struct pack *pack);

/* Makes room for normals at the corners, all of them 0. */
void scene_add_normals(struct scene *scene);

/* Makes room for the names of `count` groups, of `bytes` bytes with their zeros. */
void scene_set_groups(struct scene *scene, int32_t count, int64_t bytes);

/* Adds a sky of `count` triangles that emit these radiosities, W/m^2, and reflect
 * nothing; triangles beside each other of one radiosity share a material. */
void scene_add_sky(struct scene *scene, int32_t count, const struct triangle *triangles,
                   const struct rgb *radiosities);

/* Takes the emissions for radiances, W/m^2/sr, of which radiosities are made. */
void scene_take_radiances(struct scene *scene);

/* Moves and scales the positions, clamps reflectances, drops degenerate triangles and
 * doubles, computes planes and areas. To be called once, on positions in input units.
 * Errors: no triangle with an area; a coordinate or extent out of the range of the
 * numbers. */
bool scene_prepare(struct scene *scene, struct scene_repairs *repairs,
                   struct error *error);

/* Prepares, in place of scene_prepare(), a scene of positions in scene units, with the
 * centre and the exponent used for these. */
void scene_restore(struct scene *scene, struct vec3 centre, int32_t exponent);

/* Finds the faces of a restored scene modelled from both sides; only faces with an
 * area. */
void scene_find_backs(struct scene *scene);

/* Drops a triangle from a prepared scene. */
void scene_drop(struct scene *scene, int32_t input);

/* Drops all panes. */
void scene_drop_panes(struct scene *scene);

/* The planes of blockers, for an octree. Valid as long as the scene. */
static inline const struct plane *scene_blocking_planes(const struct scene *scene)
{
    return scene->opaque ? scene->opaque : scene->planes;
}

/* Number of roots, twins and dropped ones included: IDs run from 0 to this. Where a
 * triangle has no twin, the twin's root is absent: its area is 0, and so is its plane. A
 * face modelled from both sides has no twins: each side has the other's place. */
int32_t scene_root_count(const struct scene *scene);

/* The input triangle behind a root: itself, or the one with this twin. */
static inline int32_t scene_input_of(const struct scene *scene, int32_t root)
{
    return root < scene->input_count ? root : root - scene->input_count;
}

/* True if the root belongs to a sky. */
static inline bool scene_is_sky(const struct scene *scene, int32_t root)
{
    return scene_input_of(scene, root) >= scene->sky_first;
}

/* True if the back of an input triangle is the front of a twin. */
bool scene_has_twin(const struct scene *scene, int32_t input);

/* The root whose front is on the front, or the back, of an input triangle; -1 if this
 * side is black. */
static inline int32_t scene_root_on(const struct scene *scene, int32_t input, bool front)
{
    if (front)
        return input;
    return scene_has_twin(scene, input) ? input + scene->input_count : -1;
}

/* Geometry of a root. A twin has its corners in the order (a, c, b) and faces the other
 * way. */
static inline struct triangle scene_root_triangle(const struct scene *scene, int32_t root)
{
    const struct triangle *t = &scene->triangles[scene_input_of(scene, root)];
    return root >= scene->input_count ? triangle_turned(t) : *t;
}

static inline struct plane scene_root_plane(const struct scene *scene, int32_t root)
{
    int32_t input = scene_input_of(scene, root);
    struct plane plane = scene->planes[input];
    if (root == input)
        return plane;
    if (!scene_has_twin(scene, input))
        return (struct plane){{0.0, 0.0, 0.0}, 0.0};
    return (struct plane){vec3_scale(plane.normal, -1.0), -plane.offset};
}

/* The normal for shading at a corner of a root, turned to the root's front; 0 if there is
 * none. */
struct vec3 scene_root_normal(const struct scene *scene, int32_t root, int corner);

/* Square scene units; 0 for a dropped root and an absent one. */
static inline double scene_root_area(const struct scene *scene, int32_t root)
{
    int32_t input = scene_input_of(scene, root);
    return root == input || scene_has_twin(scene, input) ? scene->areas[input] : 0.0;
}

/* The same, 0 for a root of a sky. */
static inline double scene_root_own_area(const struct scene *scene, int32_t root)
{
    return scene_is_sky(scene, root) ? 0.0 : scene_root_area(scene, root);
}

static inline const struct material *scene_root_material(const struct scene *scene,
                                                         int32_t root)
{
    return &scene->materials[scene->material_of[scene_input_of(scene, root)]];
}

/* Sum of the areas of all roots, square scene units. */
double scene_area(const struct scene *scene);

/* The same without a sky. */
double scene_own_area(const struct scene *scene);

/* Sum over roots and bands of area times emission, W for areas in square scene units. */
double scene_emitted_power(const struct scene *scene);

/* The same, but of a sky what enters the box of all else. */
double scene_entering_power(const struct scene *scene);

/* Square input units in a square scene unit: turns power and areas into those of the
 * input. */
double scene_area_unit(const struct scene *scene);

/* A number telling prepared scenes apart by their triangles and materials, in scene
 * units; the same on every machine. Neither paths nor names of materials and groups
 * count. */
uint64_t scene_hash(const struct scene *scene);

/* A point of the scene in input units. */
struct vec3 scene_to_input(const struct scene *scene, struct vec3 x);

/* A point in input units in the scene's. */
struct vec3 scene_from_input(const struct scene *scene, struct vec3 x);

#endif
