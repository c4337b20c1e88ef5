/* Pictures of the algorithm.
 *
 * Owners, levels and errors are colours of leaves in place of their radiosities; the rest
 * is the renderer's. Outlines and the leaf under a pixel come from a picture of numbers:
 * the same renderer with the number of each leaf for its light, one ray a pixel. */
#include "tools/show.h"

#include <math.h>
#include <stdlib.h>

#include "geom/alloc.h"
#include "io/picture/render.h"
#include "mpi/beyond/keep.h"
#include "mpi/picture.h"
#include "rad/beyond/cluster_light.h"
#include "rad/beyond/patch_link.h"
#include "tools/label.h"

/* --- checks before there is light --- */

/* Reads X,Y. False if the text is not of this form. */
static bool read_pixel(const char *text, long *x, long *y)
{
    char *end;
    *x = strtol(text, &end, 10);
    if (end == text || *end != ',')
        return false;
    const char *second = end + 1;
    *y = strtol(second, &end, 10);
    return end != second && *end == '\0';
}

/* Checks the name of the patch of --show links. A pixel has to be in all pictures. */
static bool check_links(struct run *run)
{
    const char *name = run->options.show_patch;
    struct patch_id id;
    long x, y;
    if (read_pixel(name, &x, &y)) {
        for (int i = 0; i < run_camera_count(run); i++) {
            int width = run->cameras[i].width, height = run->cameras[i].height;
            if (x < 0 || y < 0 || x >= width || y >= height)
                return error_set(&run->error, EXIT_USAGE,
                                 "--show links:%s: there is no such pixel in %dx%d", name,
                                 width, height);
        }
        return true;
    }
    if (!label_read(name, &id))
        return error_set(&run->error, EXIT_USAGE,
                         "--show links:%s: neither a patch, as in links:5/023, nor a "
                         "pixel, as in links:X,Y",
                         name);
    return (id.root < (uint32_t)scene_root_count(run->scene) &&
            id_level(id) <= run->options.criterion.max_level) ||
           error_set(&run->error, EXIT_USAGE, "--show links:%s: there is no such patch",
                     name);
}

bool show_check(struct run *run)
{
    enum show show = run->options.show;
    bool error = run->stored ? run->stored->has_error
                             : run->options.criterion.final_gather > 0;
    if (!options_show(&run->options, 0)) /* there is no picture */
        return true;
    bool colours = show == SHOW_OWNER || show == SHOW_LEVEL || show == SHOW_ERROR;
    for (int i = 0; i < run->options.output_count && (colours || !error); i++)
        if (run->options.outputs[i].format == FORMAT_ERROR)
            return error_set(&run->error, EXIT_USAGE,
                             "%s: only pictures of light after a final gather have "
                             "errors",
                             run->options.outputs[i].path);
    if (show == SHOW_ERROR && !error)
        return error_set(&run->error, EXIT_USAGE,
                         "--show error: there is no error without a final gather");
    if (run->stored && (show == SHOW_OWNER || show == SHOW_LINKS))
        return error_set(&run->error, EXIT_USAGE,
                         "--show owner and links need a run: "
                         "a stored solution has no ranks and no links");
    return show != SHOW_LINKS || check_links(run);
}

/* --- colours --- */

/* From black, 0, over red and yellow to white, 1. */
static struct rgb heat(double x)
{
    struct rgb colour;
    for (int c = 0; c < BANDS; c++)
        colour.band[c] = fmin(1.0, fmax(0.0, 3.0 * x - c));
    return colour;
}

/* Hues of neighbouring ranks, a golden section apart, and of neighbouring levels, from
 * blue over green and yellow to red. */
static const double HUE_OF_RANK = 0.6180339887498949, HUE_OF_LEVEL = 0.08;
static const double BLUE = 1.0 / 3.0;

/* A colour of the circle, which has length 1. */
static struct rgb hue(double turn)
{
    struct rgb colour;
    for (int c = 0; c < BANDS; c++) {
        double h = 6.0 * (turn + c / 3.0 - floor(turn + c / 3.0));
        double ramp = fmin(1.0, fmax(0.0, fabs(h - 3.0) - 1.0)); /* 1, 1, 0 .. 0, 1, 1 */
        colour.band[c] = 0.15 + 0.75 * ramp;
    }
    return colour;
}

/* The error shown white: three times the RMS, by area, W/m^2. */
static double error_scale(const struct forest *forest, const float *error)
{
    double sum = 0.0, area = 0.0;
    int32_t leaf = forest_next_leaf(forest, -1); /* in the same order on all ranks */
    for (; leaf >= 0; leaf = forest_next_leaf(forest, leaf)) {
        double e = (double)error[leaf];
        sum += forest_area(forest, leaf) * e * e;
        area += forest_area(forest, leaf);
    }
    return sum > 0.0 ? 3.0 * sqrt(sum / area) : 1.0;
}

static struct rgb colour_of(const struct run *run, int32_t p, double scale)
{
    struct patch_id id = run->solver->model.forest->patches[p].id;
    switch (run->options.show) {
    case SHOW_OWNER: return hue(HUE_OF_RANK * run->solver->homes.owner[id.root]);
    case SHOW_LEVEL: return hue(BLUE + HUE_OF_LEVEL * id_level(id));
    default: return heat((double)beyond_answer(run->solver)->error[p] / scale);
    }
}

struct rgb *show_colours(struct run *run)
{
    const struct forest *forest = run->solver->model.forest;
    enum show show = run->options.show;
    double scale = 1.0;
    if (show != SHOW_OWNER && show != SHOW_LEVEL && show != SHOW_ERROR)
        return NULL;
    if (show == SHOW_ERROR) {
        scale = error_scale(forest, beyond_answer(run->solver)->error);
        run_say(run, "legend: black is an error of 0, red %.3g, yellow %.3g, "
                     "white %.3g W/m^2 or more",
                scale / 3.0, 2.0 * scale / 3.0, scale);
    }
    if (show == SHOW_LEVEL)
        run_say(run, "legend: blue is level 0, green 4, yellow 6, red 8");
    struct rgb *colours = alloc_array((size_t)forest->count, sizeof *colours);
    for (int64_t p = 0; p < forest->count; p++)
        if (patch_is_leaf(&forest->patches[p]))
            colours[p] = colour_of(run, (int32_t)p, scale);
    if (!(run->options.exposure > 0.0))
        run->options.exposure = 1.0;
    return colours;
}

struct shading *show_shading(struct run *run, struct rgb *colours)
{
    struct forest *forest = run->solver->model.forest;
    struct rgb *radiosity = forest->radiosity;
    forest->radiosity = colours;
    struct shading *shading = shading_create_flat(forest);
    forest->radiosity = radiosity;
    return shading;
}

/* --- the leaf of each pixel --- */

enum { DIGIT = 4096 }; /* numbers as two digits, each exact as a float */

static bool has_overlay(enum show show)
{
    return show > SHOW_IRRADIANCE && show != SHOW_ERROR;
}

int32_t *show_leaves(struct run *run, const struct camera *camera)
{
    if (!has_overlay(run->options.show))
        return NULL;
    const struct forest *forest = run->solver->model.forest;
    struct rgb *numbers = alloc_array((size_t)forest->count, sizeof *numbers);
    int32_t *order = forest_order(forest); /* local numbers differ from rank to rank */
    for (int64_t i = 0; i < forest->count; i++) /* none is 0 */
        numbers[order[i]] = (struct rgb){{(double)((i + 1) / DIGIT),
                                          (double)((i + 1) % DIGIT), 0.0}};
    struct shading *shading = show_shading(run, numbers);
    struct renderer renderer = renderer_make(run->octree, shading, NULL);
    float *scanlines = render_scanlines(&renderer, camera, 1, run->comm.rank,
                                        run->comm.size, NULL);
    float *digits = picture_gather(&run->comm, scanlines, 3 * (size_t)camera->width,
                                   camera->height);
    size_t pixels = (size_t)camera->width * (size_t)camera->height;
    int32_t *leaves = digits ? alloc_array(pixels, sizeof *leaves) : NULL;
    for (size_t i = 0; leaves && i < pixels; i++) {
        int32_t number = DIGIT * (int32_t)digits[3 * i] + (int32_t)digits[3 * i + 1];
        leaves[i] = number > 0 ? order[number - 1] : -1;
    }
    alloc_free(order);
    alloc_free(digits);
    shading_destroy(shading);
    alloc_free(numbers);
    return leaves;
}

/* --- outlines --- */

/* The light of a pixel on the outline of a leaf: less, the deeper the leaf lies. */
static double outline_of(const struct forest *forest, int32_t leaf)
{
    return 0.7 - 0.6 * id_level(forest->patches[leaf].id) / ID_MAX_LEVEL;
}

/* Darkens the pixels with another leaf to the right or below. */
static void draw_outlines(const struct run *run, const struct camera *camera,
                          const int32_t *leaves, float *picture)
{
    const struct forest *forest = run->solver->model.forest;
    for (int y = 0; y < camera->height; y++)
        for (int x = 0; x < camera->width; x++) {
            size_t i = (size_t)y * (size_t)camera->width + (size_t)x;
            int32_t leaf = leaves[i];
            int32_t right = x + 1 < camera->width ? leaves[i + 1] : leaf;
            int32_t below =
                y + 1 < camera->height ? leaves[i + (size_t)camera->width] : leaf;
            if (leaf < 0 || (leaf == right && leaf == below))
                continue;
            for (int c = 0; c < BANDS; c++)
                picture[3 * i + (size_t)c] *= (float)outline_of(forest, leaf);
        }
}

/* --- links --- */

/* The links over which light comes to a patch: its own, and the links of the patches and
 * clusters above. */
struct found_links {
    const struct model *model;
    const int32_t *order; /* local numbers of patches, by their numbers in links */
    int32_t patch;
    struct link *links;   /* [count] q is the sender */
    int64_t count, capacity;
};

/* True if the node is the patch or holds it. */
static bool holds(const struct model *model, int32_t node, int32_t patch)
{
    const struct forest *forest = model->forest;
    if (node_is_cluster(node)) {
        const struct cluster_tree *tree = model->clusters->tree;
        int32_t place = tree->place[forest->patches[patch].id.root];
        return place >= tree->clusters[~node].first && place < tree->clusters[~node].end;
    }
    for (; patch >= 0; patch = forest->patches[patch].parent)
        if (patch == node)
            return true;
    return false;
}

static void add_link(struct found_links *found, struct link link, int32_t sender)
{
    link.q = sender;
    RESERVE(found->links, &found->capacity, found->count + 1);
    found->links[found->count++] = link;
}

static void find_links(void *context, const struct link *links, const int *owners,
                       int64_t count)
{
    struct found_links *found = context;
    (void)owners;
    for (int64_t i = 0; i < count; i++) {
        int32_t p = links[i].p, q = links[i].q;
        p = node_is_cluster(p) ? p : found->order[p];
        q = node_is_cluster(q) ? q : found->order[q];
        if (holds(found->model, p, found->patch))
            add_link(found, links[i], q);
        else if (holds(found->model, q, found->patch))
            add_link(found, links[i], p);
    }
}

/* The middle of a patch or a cluster, scene units. */
static struct vec3 middle_of(const struct model *model, int32_t node)
{
    if (!node_is_cluster(node)) {
        struct triangle t = forest_triangle(model->forest, node);
        return triangle_centroid(&t);
    }
    const struct cluster *cluster = &model->clusters->tree->clusters[~node];
    return vec3_scale(vec3_add(cluster->low, cluster->high), 0.5);
}

/* The power brought by a link, over all bands. */
static double power_of(const struct model *model, const struct link *link)
{
    const struct rgb *b = node_is_cluster(link->q)
                              ? &model->clusters->radiosity[~link->q]
                              : &model->forest->radiosity[link->q];
    return link_area(link) * (b->band[0] + b->band[1] + b->band[2]);
}

/* A place in the picture, pixels from the top left; `depth` before the eye. */
struct place {
    double x, y, depth;
};

static struct place place_of(const struct camera *camera, struct vec3 eye, struct vec3 at)
{
    struct camera_basis basis = camera_basis_of(camera);
    struct vec3 to = vec3_sub(at, eye);
    double depth = vec3_dot(to, basis.forward);
    double unit = depth * basis.pixel;
    return (struct place){basis.middle[0] + vec3_dot(to, basis.right) / unit,
                          basis.middle[1] - vec3_dot(to, basis.above) / unit, depth};
}

static void draw_disc(const struct camera *camera, double x, double y, double width,
                      float *picture, float brightness)
{
    double r = 0.5 * width;
    for (int j = (int)floor(y - r); j <= (int)ceil(y + r); j++)
        for (int i = (int)floor(x - r); i <= (int)ceil(x + r); i++) {
            double dx = i + 0.5 - x, dy = j + 0.5 - y;
            if (i < 0 || j < 0 || i >= camera->width || j >= camera->height ||
                dx * dx + dy * dy > r * r)
                continue;
            float *pixel = picture + 3 * ((size_t)j * (size_t)camera->width + (size_t)i);
            pixel[0] = brightness;
            pixel[1] = 0.8f * brightness;
            pixel[2] = 0.0f;
        }
}

/* A line through space, disc by disc, half a pixel apart; parts behind the eye are left
 * out. */
static void draw_line(const struct camera *camera, struct vec3 eye, struct vec3 from,
                      struct vec3 to, double width, float *picture, float brightness)
{
    struct place a = place_of(camera, eye, from), b = place_of(camera, eye, to);
    enum { STEPS_MOST = 8192 };
    bool before = a.depth > 0.0 && b.depth > 0.0;
    double pixels = before ? fmax(fabs(a.x - b.x), fabs(a.y - b.y)) : STEPS_MOST;
    int steps = (int)fmin(STEPS_MOST, 2.0 * pixels + 1.0);
    for (int i = 0; i <= steps; i++) {
        double t = (double)i / steps;
        struct vec3 at = vec3_add(vec3_scale(from, 1.0 - t), vec3_scale(to, t));
        struct place p = place_of(camera, eye, at);
        if (p.depth > 0.0 && p.x > -width && p.x < camera->width + width &&
            p.y > -width && p.y < camera->height + width)
            draw_disc(camera, p.x, p.y, width, picture, brightness);
    }
}

/* Draws the links to the patch over the light, at a third of it. */
static void draw_links(const struct found_links *found, const struct camera *camera,
                       float *picture)
{
    static const double WIDEST = 6.0;
    const struct model *model = found->model;
    struct vec3 eye = scene_from_input(model->scene, camera->eye);
    double most = 0.0;
    float brightest = 0.0f;
    for (size_t i = 0; i < 3 * (size_t)camera->width * (size_t)camera->height; i++) {
        brightest = picture[i] > brightest ? picture[i] : brightest;
        picture[i] /= 3.0f;
    }
    for (int64_t i = 0; i < found->count; i++)
        most = fmax(most, power_of(model, &found->links[i]));
    for (int64_t i = 0; i < found->count; i++) {
        const struct link *link = &found->links[i];
        double part = most > 0.0 ? power_of(model, link) / most : 0.0;
        draw_line(camera, eye, middle_of(model, found->patch), middle_of(model, link->q),
                  1.0 + (WIDEST - 1.0) * sqrt(part), picture, brightest);
    }
}

/* The patch with this ID, or -1: there is none. */
static int32_t find_patch(const struct forest *forest, struct patch_id id)
{
    int32_t p = id.root < (uint32_t)forest->root_count ? (int32_t)id.root : -1;
    for (int step = 0; step < id_level(id) && p >= 0; step++)
        p = patch_is_leaf(&forest->patches[p])
                ? -1 : forest->patches[p].children + id_step(id, step);
    return p;
}

/* The patch named by --show links, or at the pixel named there. On rank 0; -1 and an
 * error: there is none. */
static int32_t named_patch(struct run *run, const struct camera *camera,
                           const int32_t *leaves)
{
    const char *name = run->options.show_patch;
    struct patch_id id;
    long x, y;
    int32_t patch = -1;
    if (read_pixel(name, &x, &y))
        patch = leaves[(size_t)y * (size_t)camera->width + (size_t)x];
    else if (label_read(name, &id))
        patch = find_patch(run->solver->model.forest, id);
    if (patch < 0)
        error_set(&run->error, EXIT_USAGE,
                  "--show links:%s: there is no such patch, or none is seen there", name);
    return patch;
}

static bool overlay_links(struct run *run, const struct camera *camera,
                          const int32_t *leaves, float *picture)
{
    int32_t *order = forest_order(run->solver->model.forest);
    struct found_links found = {
        .model = &run->solver->model, .order = order, .patch = -1};
    if (run->comm.rank == 0)
        found.patch = named_patch(run, camera, leaves);
    bool good = run_agree(run);
    if (good) {
        char name[LABEL_SIZE];
        const struct model *model = &run->solver->model;
        if (model->clusters) /* a finished run, resumed, has none of this light */
            cluster_light_average(model->clusters, model->forest,
                                  model->forest->radiosity, model->clusters->radiosity);
        links_collect(run->solver, find_links, &found);
        if (run->comm.rank == 0) {
            struct patch_id id = run->solver->model.forest->patches[found.patch].id;
            run_say(run, "patch %s: %lld links of it and of what is above it",
                    label_write(id, name), (long long)found.count);
            draw_links(&found, camera, picture);
        }
    }
    alloc_free(found.links);
    alloc_free(order);
    return good;
}

bool show_overlay(struct run *run, const struct camera *camera, const int32_t *leaves,
                  float *picture)
{
    if (run->options.show == SHOW_LINKS)
        return overlay_links(run, camera, leaves, picture);
    if (leaves)
        draw_outlines(run, camera, leaves, picture);
    return true;
}
