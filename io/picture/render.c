/* Rendering. A pixel depends only on its place, so scanlines can be dealt to ranks in any
 * way. A rank visits its own in the order of their numbers with the digits backwards: any
 * part of the scanlines is spread over the picture, and the share done tells the time
 * left, also where the upper half is dark.
 *
 * A ray meeting the back of a triangle sees its twin, if there is one. The N x N rays of
 * a pixel are on a grid whose rows and columns are slanted by a part of a cell: no two
 * rays have the same x or y, and across an upright edge there are N x N steps.
 *
 * Direct light of lamps has edges followed by no mesh, so this light is gathered at each
 * visible point, by segments; reflected light is smooth and interpolated over the mesh.
 * Or all light is gathered at the point: then the picture has no trace of the mesh. All
 * light is also gathered where interpolation does not hold (io/picture/shading.h): on a
 * leaf counted as covered but visible, as the side of a book standing out from its
 * neighbours; on a steep leaf, in the housing of a lamp. All points of a pixel on one
 * triangle are gathered together, by few segments; again by more as long as these are
 * noisy. Few segments may all arrive, or all miss, and seem sure: so by more, too, where
 * the mesh has another light of lamps there.
 *
 * The standard error of a pixel is the root of four parts, squared and added up: that of
 * the mesh's light, which is claimed for its leaves; the noise of segments and rays; what
 * lamps' light is apart from the mesh's, as few segments may agree by chance; and what
 * n camera rays tell of the edges in a pixel, whose variance is n^-3/2 times that of the
 * light they meet.
 *
 * A surface with normals of its own has the light of the smooth surface in which the
 * facets are inscribed: a point is lifted towards the plane through each corner across
 * its normal, weighted by the barycentric coordinate of the corner (Hanika, 2021). So
 * facets do not shadow each other where the smooth surface is lit. A facet of a bowl is
 * not lifted, and may hide from its own points a lamp above their tangent planes but
 * behind the facet. */
#include "io/picture/render.h"

#include <math.h>

#include "geom/alloc.h"
#include "geom/hash.h"
#include "geom/stop.h"
#include "rad/beyond/panes.h"
#include "rad/beyond/sample.h"

enum {
    SEGMENTS = 4, /* to lamps, for a pixel, at first */
    ENOUGH = 64,  /* in an unsure pixel, at least, or a quarter of --final-gather */
    COVERED = 2,  /* --final-gather over the rays and segments for a pixel in which things
                     cover the leaf */
    STEEP = 2,    /* those on a steep leaf, over --final-gather */
    MORE = 4      /* most factor on these two */
};

/* A pixel is unsure if the deviation of its light by chance exceeds NOISE, or its
 * difference from the mesh's light does. Both are relative to the geometric mean of its
 * light and the mean light reflected in its space, since a display shows differences by
 * the root of light. .015 are about one code of 255. */
static const double NOISE = 0.015; /* 1 */

struct renderer renderer_make(const struct octree *octree, const struct shading *shading,
                              struct final_gather *gather)
{
    int rays = gather ? gather->model->criterion.final_gather : 0;
    return (struct renderer){octree, shading, gather, NULL, rays, false, 1.0};
}

/* --- visible points --- */

/* The roots met by the camera rays of a pixel: an entry for each ray with a hit. */
struct pixel_roots {
    int32_t *roots;
    struct vec3 *weights; /* barycentric coordinates in the root */
    int *whole;           /* rays for a pixel of such points, where all light is gathered;
                             0: light is interpolated; set by show() */
    struct vec3 *at;      /* points, scene units; room for add_light() */
    struct rgb *through;  /* share of the light that panes let through, 1; NULL: all */
    int count;
};

/* Light of a pixel; the last three fields are for its error alone. */
struct pixel_light {
    struct rgb sum;   /* of the radiosities met by the camera rays, W/m^2 */
    struct rgb apart; /* excess of lamps' light over the mesh's, where only these are
                         gathered */
    double variance;  /* of `sum` by chance, over bands, (W/m^2)^2 */
    struct rgb noise;   /* variance of `sum` by the sequences, (W/m^2)^2 */
    struct rgb squares; /* sum of the squared radiosities, (W/m^2)^2 */
    struct rgb mesh;    /* sum of the standard errors of leaves, W/m^2 */
};

/* Least cosine between the normals at a corner and of the plane, 45 degrees, for facets
 * of a smooth surface. A box with normals smoothed over its edges is beyond 45 degrees:
 * lifted towards a sphere, its sides would cover the objects on top. */
static const double LEAN = 0.7;

/* A root as shown: with normals at its corners, or flat. */
struct facade {
    struct triangle triangle;
    struct vec3 normals[3];
    struct plane plane;
    bool curved; /* false: all normals are 0 */
};

static struct facade facade_make(const struct scene *scene, int32_t root)
{
    struct facade facade = {.triangle = scene_root_triangle(scene, root),
                            .plane = scene_root_plane(scene, root)};
    struct vec3 normals[3];
    for (int k = 0; k < 3 && scene->normals; k++) {
        normals[k] = scene_root_normal(scene, root, k);
        if (!(vec3_dot(normals[k], facade.plane.normal) > LEAN))
            return facade;
    }
    facade.curved = scene->normals != NULL;
    for (int k = 0; k < 3 && facade.curved; k++)
        facade.normals[k] = normals[k];
    return facade;
}

/* Returns the point with these coordinates, lifted towards the planes through the
 * corners. */
static struct vec3 facade_point(const struct facade *facade, struct vec3 weight)
{
    struct vec3 x = corners_mean(facade->triangle.corner, weight), lifts[3];
    if (!facade->curved)
        return x;
    for (int k = 0; k < 3; k++) {
        struct vec3 normal = facade->normals[k];
        double below = vec3_dot(vec3_sub(facade->triangle.corner[k], x), normal);
        lifts[k] = vec3_scale(normal, below > 0.0 ? below : 0.0);
    }
    return point_above(vec3_add(x, corners_mean(lifts, weight)), facade->plane.normal);
}

/* Returns the tangent plane at x, the point with these coordinates. */
static struct plane facade_plane(const struct facade *facade, struct vec3 weight,
                                 struct vec3 x)
{
    struct vec3 normal = corners_mean(facade->normals, weight);
    if (!(vec3_dot(normal, facade->plane.normal) > 0.0))
        return facade->plane;
    normal = vec3_scale(normal, 1.0 / vec3_length(normal));
    return (struct plane){normal, vec3_dot(normal, x)};
}

/* The sum of the shares let through by panes, over the first `count` entries. */
static struct rgb sum_of_shares(const struct pixel_roots *view, int count)
{
    struct rgb sum = {{0.0, 0.0, 0.0}};
    if (!view->through)
        return (struct rgb){{count, count, count}};
    for (int i = 0; i < count; i++)
        rgb_add(&sum, 1.0, view->through[i]);
    return sum;
}

/* Adds what the error of a pixel is made of, by the first `count` entries, which are of
 * one root and show the same light, with the sum of shares `seen`. The error of a leaf,
 * which is that of its brightest band, is as large a part of the others. */
static void add_error(const struct renderer *renderer, const struct pixel_roots *view,
                      int count, struct rgb seen, struct rgb shown,
                      struct pixel_light *pixel)
{
    if (!renderer->error)
        return;
    const struct forest *forest = renderer->shading ? renderer->shading->forest
                                                    : renderer->gather->model->forest;
    const struct material *m = scene_root_material(forest->scene, view->roots[0]);
    double most = 0.0, error = 0.0;
    for (int i = 0; i < count; i++) {
        double w[3] = {view->weights[i].x, view->weights[i].y, view->weights[i].z};
        int32_t leaf = leaf_at(forest, view->roots[i], w);
        error += DEVIATION * (double)renderer->error[leaf];
    }
    for (int c = 0; c < BANDS; c++)
        most = fmax(most, shown.band[c] - m->emission.band[c]);
    for (int c = 0; c < BANDS; c++) {
        double b = shown.band[c], share = seen.band[c] / count;
        pixel->squares.band[c] += count * share * share * b * b;
        if (most > 0.0)
            pixel->mesh.band[c] +=
                share * error * fmax(0.0, b - m->emission.band[c]) / most;
    }
}

/* The variance of a band by a sequence of `count` segments or rays: that by chance over
 * the root of their number, as on a grid that an edge cuts; more where the halves of the
 * sequence are further apart, as where a few rays bring most light. */
static double variance_of(const struct gather_light *light, int count, int band)
{
    double chance = light->variance.band[band];
    return fmin(chance, fmax(chance / sqrt(count), light->halves.band[band]));
}

/* Adds the light of the first `count` entries, which are of one root and whole alike. */
static void add_light(const struct renderer *renderer, const struct pixel_roots *view,
                      int count, uint64_t seed, int rays, struct pixel_light *pixel)
{
    const struct shading *shading = renderer->shading;
    struct final_gather *gather = renderer->gather;
    const struct scene *scene = gather->model->scene;
    static const struct material WHITE = {.reflectance = {{1.0, 1.0, 1.0}}};
    const struct material *m =
        renderer->irradiance ? &WHITE : scene_root_material(scene, view->roots[0]);
    if (renderer->irradiance && scene_is_sky(scene, view->roots[0]))
        return;
    struct facade facade = facade_make(scene, view->roots[0]);
    struct vec3 middle = {0.0, 0.0, 0.0};
    for (int i = 0; i < count; i++) {
        view->at[i] = facade_point(&facade, view->weights[i]);
        middle = vec3_add(middle, vec3_scale(view->weights[i], 1.0 / count));
    }
    struct gather_points points = {.at = view->at, .count = count,
                                   .middle = facade_point(&facade, middle),
                                   .root = view->roots[0],
                                   .above = facade.curved};
    points.plane = facade_plane(&facade, middle, points.middle);
    bool whole = view->whole[0] > 0;
    struct gather_light light = final_gather_at(gather, &points, seed, rays, whole);
    double rho = 0.0, w[3] = {middle.x, middle.y, middle.z};
    struct rgb other = m->emission, mesh = {{0.0, 0.0, 0.0}}, shown;
    struct rgb seen = sum_of_shares(view, count);
    if (!whole) {
        other = shading_at(shading, shading->values, view->roots[0], w);
        mesh = shading_at(shading, shading->lamps, view->roots[0], w);
    }
    for (int c = 0; c < BANDS; c++) {
        double h = light.straight.band[c] + light.rest.band[c];
        double b = m->reflectance.band[c] * h;
        shown.band[c] = other.band[c] + b;
        pixel->sum.band[c] += seen.band[c] * shown.band[c];
        if (!whole)
            pixel->apart.band[c] += seen.band[c] * (b - mesh.band[c]);
        rho = fmax(rho, m->reflectance.band[c]);
    }
    if (whole || rgb_sum(light.straight) > 0.0 || rgb_sum(mesh) > 0.0)
        pixel->variance += count * count * rho * rho * rgb_sum(light.variance);
    for (int c = 0; c < BANDS; c++)
        pixel->noise.band[c] += seen.band[c] * seen.band[c] * m->reflectance.band[c] *
                                m->reflectance.band[c] * variance_of(&light, rays, c);
    add_error(renderer, view, count, seen, shown, pixel);
}

/* Moves the entries like the first to the front. Returns their number. */
static int collect_root(struct pixel_roots *view)
{
    int count = 0;
    for (int i = 0; i < view->count; i++) {
        if (view->roots[i] != view->roots[0] || view->whole[i] != view->whole[0])
            continue;
        struct vec3 weight = view->weights[i];
        view->weights[i] = view->weights[count];
        view->weights[count] = weight;
        if (view->through) {
            struct rgb through = view->through[i];
            view->through[i] = view->through[count];
            view->through[count] = through;
        }
        view->roots[i] = view->roots[count];
        view->whole[i] = view->whole[count];
        view->whole[count] = view->whole[0];
        view->roots[count++] = view->roots[0];
    }
    return count;
}

/* Returns the number of rays for a pixel of points such as entry i, all light of which is
 * to be gathered; or 0: reflected light is interpolated. */
static int rays_for_all(const struct renderer *renderer, const struct pixel_roots *view,
                        int i)
{
    const struct shading *shading = renderer->shading;
    double w[3] = {view->weights[i].x, view->weights[i].y, view->weights[i].z};
    if (!shading)
        return renderer->rays;
    enum shade shade =
        shading->shades[leaf_at(shading->forest, view->roots[i], w)];
    return shade == SHADE_SMOOTH  ? 0
           : shade == SHADE_STEEP ? STEEP * renderer->rays
                                  : (renderer->rays + COVERED - 1) / COVERED;
}

/* Returns the light of all entries together, as the mesh has it. */
static struct pixel_light show_mesh(const struct renderer *renderer,
                                    const struct pixel_roots *view)
{
    const struct shading *shading = renderer->shading;
    struct pixel_light pixel = {.variance = 0.0};
    for (int i = 0; i < view->count; i++) {
        double w[3] = {view->weights[i].x, view->weights[i].y, view->weights[i].z};
        struct rgb b = shading_at(shading, shading->values, view->roots[i], w);
        struct pixel_roots one = {.roots = view->roots + i, .weights = view->weights + i,
                                  .through = view->through ? view->through + i : NULL};
        struct rgb seen = sum_of_shares(&one, 1);
        for (int c = 0; c < BANDS; c++)
            pixel.sum.band[c] += seen.band[c] * b.band[c];
        add_error(renderer, &one, 1, seen, b, &pixel);
    }
    return pixel;
}

/* Returns the light of all entries together, gathered by `more` times the fewest
 * segments, or rays. Reorders the entries. */
static struct pixel_light show(const struct renderer *renderer,
                               const struct pixel_roots *view, uint64_t seed, int more)
{
    struct pixel_light pixel = {.variance = 0.0};
    for (int i = 0; i < view->count; i++)
        view->whole[i] = rays_for_all(renderer, view, i);
    struct pixel_roots rest = *view;
    while (rest.count > 0) {
        int count = collect_root(&rest);
        int all = rest.whole[0] > 0 ? rest.whole[0] * (more < MORE ? more : MORE)
                                    : SEGMENTS * more;
        int own = (all * count + view->count - 1) / view->count;
        add_light(renderer, &rest, count, hash_mix(seed) + (uint64_t)rest.roots[0], own,
                  &pixel);
        rest.roots += count;
        rest.weights += count;
        rest.through = rest.through ? rest.through + count : NULL;
        rest.whole += count;
        rest.count -= count;
    }
    return pixel;
}

/* The factor on the fewest segments by which a pixel found by `now` times these is to be
 * found again; at most `now`: a sure pixel. The variance of n segments of a sequence
 * falls as n^-4/3: as n^-1 by chance, and as n^-3/2 on a grid that an edge cuts. */
static int more_for(const struct renderer *renderer, const struct pixel_light *pixel,
                    const struct pixel_roots *view, int now)
{
    const struct final_gather *gather = renderer->gather;
    int32_t space = view->count > 0 ? node_space(gather->model, view->roots[0]) : 0;
    double mean = renderer->brighter * gather->lit[space].reflected;
    double square = rgb_sum(pixel->sum) * view->count * mean;
    double noise = pixel->variance / (NOISE * NOISE * square);
    double apart = now > 1 ? 0.0 : rgb_sum(pixel->apart) / NOISE;
    int most = renderer->rays / SEGMENTS, least = ENOUGH / SEGMENTS;
    if (!(noise > 1.0) && apart * apart <= square)
        return now;
    double more = sqrt(now * noise) * sqrt(sqrt(now * noise));
    least = most / 4 > least ? most / 4 : least < most ? least : most;
    return more < least ? least : more < most ? (int)more : most;
}

/* The same by few segments, and where unsure by more, other ones; and so on. */
static struct pixel_light show_well(const struct renderer *renderer,
                                    const struct pixel_roots *view, uint64_t seed)
{
    if (!renderer->gather)
        return show_mesh(renderer, view);
    struct pixel_light pixel = show(renderer, view, seed, 1);
    int now = 0, more = 1;
    while (renderer->shading && now < more) {
        now = more;
        more = more_for(renderer, &pixel, view, now);
        if (more > now) {
            pixel = show(renderer, view, seed, more);
            pixel.apart = (struct rgb){{0.0, 0.0, 0.0}}; /* more segments hardly agree
                                                            by chance */
        }
    }
    return pixel;
}

struct rgb render_point(const struct renderer *renderer, int32_t root,
                        const double weight[3], uint64_t seed)
{
    struct vec3 w = {weight[0], weight[1], weight[2]}, at;
    int whole;
    struct pixel_roots view = {.roots = &root, .weights = &w, .whole = &whole, .at = &at,
                               .count = 1};
    return show_well(renderer, &view, seed).sum;
}

/* --- pixels --- */

/* Neighbouring pixels of a scanline, whose rays go down the octree in packets. */
struct strip {
    const struct renderer *renderer;
    const struct scene *scene;
    const struct camera *camera;
    struct panes *panes;     /* NULL: none */
    struct rgb glare;        /* light of a pixel reflected by panes, W/m^2 */
    struct camera_basis basis;
    struct vec3 eye;         /* of the camera, scene units */
    int samples, rays;       /* along the side of a pixel; in it */
    int pixels;              /* at most */
    struct octree_hit *hits; /* [pixels rays] */
    struct vec3 *directions; /* [pixels rays] of the rays, if there are panes */
    struct pixel_roots view; /* room for the rays of a pixel */
};

/* Finds the first hits of the rays of `pixels` pixels from (px, py). */
static void look(struct strip *strip, int px, int py, int pixels)
{
    struct octree_counts counts = {0};
    struct vec3 directions[PACKET_RAYS];
    int samples = strip->samples, rays = pixels * strip->rays, filled = 0;
    for (int i = 0; i < rays; i++) {
        int k = i % strip->rays;
        int column = k % samples, row = k / samples;
        double x = px + i / strip->rays + (column + (row + 0.5) / samples) / samples;
        double y = py + (row + (samples - column - 0.5) / samples) / samples;
        directions[filled++] = camera_basis_ray(&strip->basis, x, y);
        if (strip->panes)
            strip->directions[i] = directions[filled - 1];
        if (filled < PACKET_RAYS && i + 1 < rays)
            continue;
        octree_first_hits(strip->renderer->octree, strip->eye, directions, filled,
                          strip->camera->fronts_only, &strip->hits[i + 1 - filled],
                          &counts);
        filled = 0;
    }
}

/* Follows a camera ray across panes up to its hit. Adds the light reflected by panes.
 * Returns the share of the light from behind. */
static struct rgb look_through(struct strip *strip, const struct octree_hit *hit,
                               struct vec3 direction)
{
    const struct renderer *renderer = strip->renderer;
    const struct forest *forest =
        renderer->gather ? renderer->gather->model->forest : renderer->shading->forest;
    struct pane_walk walk = {strip->eye, vec3_unit(direction), HUGE_VAL, -1};
    struct rgb share = {{1.0, 1.0, 1.0}};
    struct octree_counts counts = {0};
    if (hit->triangle >= 0)
        walk = pane_walk_to(strip->eye,
                            corners_mean(strip->scene->triangles[hit->triangle].corner,
                                         (struct vec3){hit->weight[0], hit->weight[1],
                                                       hit->weight[2]}));
    panes_cross(strip->panes, walk, forest, &share, &strip->glare, &counts);
    return share;
}

/* The roots met by the rays of a pixel. */
static void collect_roots(struct strip *strip, const struct octree_hit *hits,
                          struct pixel_roots *view)
{
    view->count = 0;
    strip->glare = (struct rgb){{0.0, 0.0, 0.0}};
    for (const struct octree_hit *hit = hits; hit < hits + strip->rays; hit++) {
        if (strip->panes)
            view->through[view->count] =
                look_through(strip, hit, strip->directions[hit - strip->hits]);
        if (hit->triangle < 0)
            continue;
        int32_t root = scene_root_on(strip->scene, hit->triangle, hit->front);
        if (root < 0)
            continue;
        const double *w = hit->weight;
        view->roots[view->count] = root;
        view->weights[view->count++] = hit->front ? (struct vec3){w[0], w[1], w[2]}
                                                  : (struct vec3){w[0], w[2], w[1]};
    }
}

/* Returns the standard error of a band of a pixel, W/m^2. */
static double pixel_error(const struct pixel_light *pixel, int rays, int band)
{
    double n = rays, mean = pixel->sum.band[band] / n, mesh = pixel->mesh.band[band] / n;
    double spread = fmax(0.0, pixel->squares.band[band] / n - mean * mean);
    double apart = pixel->apart.band[band] / n;
    return sqrt(mesh * mesh + apart * apart + pixel->noise.band[band] / (n * n) +
                spread / (n * sqrt(n)));
}

static void render_pixel(struct strip *strip, const struct octree_hit *hits, int px,
                         int py, float *rgb)
{
    const struct renderer *renderer = strip->renderer;
    uint64_t seed = (uint64_t)py * (uint64_t)strip->camera->width + (uint64_t)px;
    collect_roots(strip, hits, &strip->view);
    struct pixel_light pixel = show_well(renderer, &strip->view, seed);
    rgb_add(&pixel.sum, 1.0, strip->glare);
    for (int c = 0; c < BANDS; c++)
        rgb[c] = (float)(pixel.sum.band[c] / strip->rays);
    for (int c = 0; c < BANDS && renderer->error; c++)
        rgb[BANDS * strip->camera->width + c] =
            (float)pixel_error(&pixel, strip->rays, c);
}

static void render_scanline(struct strip *strip, int py, float *rgb)
{
    int width = strip->camera->width;
    for (int x = 0; x < width && !stop_is_asked(); x += strip->pixels) {
        int pixels = width - x < strip->pixels ? width - x : strip->pixels;
        look(strip, x, py, pixels);
        for (int k = 0; k < pixels && !stop_is_asked(); k++)
            render_pixel(strip, &strip->hits[k * strip->rays], x + k, py,
                         rgb + 3 * (x + k));
    }
}

/* Returns the number made of the last binary digits of i, backwards. */
static int backwards(int i, int digits)
{
    int number = 0;
    for (; digits > 0; digits--, i >>= 1)
        number = 2 * number + (i & 1);
    return number;
}

float *render_scanlines(const struct renderer *renderer, const struct camera *camera,
                        int samples, int first, int step, struct progress *progress)
{
    const struct scene *scene = renderer->gather ? renderer->gather->model->scene
                                                 : renderer->shading->forest->scene;
    size_t rays = (size_t)(samples * samples);
    size_t length = (renderer->error ? 2u : 1u) * BANDS * (size_t)camera->width;
    int scanlines = first < camera->height ? (camera->height - first - 1) / step + 1 : 0;
    float *rgb = alloc_array((size_t)scanlines * length, sizeof *rgb);
    for (size_t i = 0; i < (size_t)scanlines * length; i++)
        rgb[i] = -1.0f;
    struct strip strip = {
        .renderer = renderer, .scene = scene, .camera = camera,
        .basis = camera_basis_of(camera), .eye = scene_from_input(scene, camera->eye),
        .samples = samples, .rays = (int)rays,
        .pixels = rays < PACKET_RAYS ? PACKET_RAYS / (int)rays : 1,
        .view = {.roots = alloc_array(rays, sizeof *strip.view.roots),
                 .weights = alloc_array(rays, sizeof *strip.view.weights),
                 .whole = alloc_array(rays, sizeof *strip.view.whole),
                 .at = alloc_array(rays, sizeof *strip.view.at)}};
    strip.hits = alloc_array((size_t)strip.pixels * rays, sizeof *strip.hits);
    strip.panes = renderer->irradiance ? NULL : panes_create(scene);
    if (strip.panes) {
        strip.directions =
            alloc_array((size_t)strip.pixels * rays, sizeof *strip.directions);
        strip.view.through = alloc_array(rays, sizeof *strip.view.through);
    }
    int digits = 0, done = 0;
    while (1 << digits < scanlines)
        digits++;
    for (int k = 0; k < 1 << digits; k++) {
        int i = backwards(k, digits);
        if (i >= scanlines)
            continue;
        progress_tick(progress, (double)done++ / scanlines);
        render_scanline(&strip, first + i * step, rgb + (size_t)i * length);
    }
    alloc_free(strip.hits);
    alloc_free(strip.directions);
    panes_destroy(strip.panes);
    alloc_free(strip.view.through);
    alloc_free(strip.view.roots);
    alloc_free(strip.view.weights);
    alloc_free(strip.view.whole);
    alloc_free(strip.view.at);
    return rgb;
}
