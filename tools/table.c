/* Tables, as CSV: names in quotes, numbers of light in W/m^2 or lux, powers in W over all
 * bands. A report sums over leaves: by object, the groups of the file, and by
 * material. */
#include "tools/table.h"

#include <math.h>
#include <string.h>

#include "geom/alloc.h"
#include "io/picture/scale.h"
#include "io/run/output.h"
#include "tools/irradiance.h"

enum { POINT_RAYS = 4096, POINT_FLOATS = BANDS + 1 };

/* Returns the error of scale_value() of light whose bands have an error. */
static double value_error(double error, bool lux)
{
    return scale_value(&(struct rgb){{error, error, error}}, lux);
}

/* --- at points --- */

static void read_point(const struct meter *meter, const void *context, int64_t item,
                       float *floats)
{
    const struct points *points = context;
    const struct sensor *sensor = &points->sensors[item];
    struct metered reading =
        meter_read(meter, scene_from_input(meter->forest->scene, sensor->at),
                   sensor->normal, POINT_RAYS, (uint64_t)item + 1);
    for (int c = 0; c < BANDS; c++)
        floats[c] = (float)reading.irradiance.band[c];
    floats[BANDS] = (float)reading.error;
}

bool table_print_points(struct run *run)
{
    struct points *points = &run->points;
    bool lux = run->options.lux;
    if (!run->options.at)
        return true;
    comm_broadcast(&run->comm, &points->count, sizeof points->count);
    if (run->comm.rank > 0)
        points->sensors = alloc_array((size_t)points->count, sizeof *points->sensors);
    comm_broadcast(&run->comm, points->sensors,
                   (size_t)points->count * sizeof *points->sensors);
    float *read = irradiance_deal(run, points->count, POINT_FLOATS, read_point, points);
    bool good = run_goes_on(run);
    if (good && run->comm.rank == 0)
        printf("x,y,z,nx,ny,nz,irradiance_r,irradiance_g,irradiance_b,%s,error\n",
               lux ? "illuminance" : "irradiance");
    for (int64_t i = 0; good && read && i < points->count; i++) {
        const struct sensor *sensor = &points->sensors[i];
        const float *h = read + i * POINT_FLOATS;
        struct rgb light = {{(double)h[0], (double)h[1], (double)h[2]}};
        printf("%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.6g,%.6g,%.6g,%.6g,%.3g\n", sensor->at.x,
               sensor->at.y, sensor->at.z, sensor->normal.x, sensor->normal.y,
               sensor->normal.z, light.band[0], light.band[1], light.band[2],
               scale_value(&light, lux), value_error((double)h[BANDS], lux));
    }
    alloc_free(read);
    return good;
}

/* --- by object --- */

/* Sums over the leaves of an object or a material. */
struct tally {
    double area;                        /* square input units */
    double emitted, absorbed, reflected; /* W */
    double radiosity, irradiance;       /* W/m^2 or lux, times area */
    double least, most;                 /* irradiance of a leaf */
    double error;                       /* of a leaf's irradiance, times area */
};

static void add_leaf(struct tally *totals, const struct run *run,
                     const struct irradiance *found, int32_t leaf)
{
    const struct forest *forest = run->solver->model.forest;
    const struct material *m = forest_material(forest, leaf);
    const struct rgb *h = &found->forest.radiosity[leaf];
    double area = forest_area(forest, leaf) * scene_area_unit(forest->scene);
    double value = scale_value(h, run->options.lux);
    totals->least = totals->area > 0.0 ? fmin(totals->least, value) : value;
    totals->most = fmax(totals->most, value);
    totals->area += area;
    totals->radiosity += area * scale_value(&forest->radiosity[leaf], run->options.lux);
    totals->irradiance += area * value;
    if (found->error)
        totals->error += area * value_error((double)found->error[leaf], run->options.lux);
    for (int c = 0; c < BANDS; c++) {
        double rho = m->reflectance.band[c];
        totals->emitted += area * m->emission.band[c];
        totals->absorbed += area * (1.0 - rho) * h->band[c];
        totals->reflected += area * rho * h->band[c];
    }
}

/* Writes a name in quotes, which are doubled within. */
static void write_name(FILE *file, const char *name)
{
    putc('"', file);
    for (; *name; name++)
        fprintf(file, *name == '"' ? "\"\"" : "%c", *name);
    putc('"', file);
}

static void write_totals(FILE *file, const char *kind, const char *name,
                       const struct tally *totals)
{
    if (!(totals->area > 0.0))
        return;
    fprintf(file, "%s,", kind);
    write_name(file, name);
    fprintf(file, ",%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.3g\n", totals->area,
            totals->emitted, totals->absorbed, totals->reflected,
            totals->radiosity / totals->area, totals->irradiance / totals->area,
            totals->least, totals->most, totals->error / totals->area);
}

/* Writes the lines of all objects and materials, on rank 0. */
static void write_all(const struct run *run, const struct irradiance *found, FILE *file)
{
    const struct forest *forest = run->solver->model.forest;
    const struct scene *scene = forest->scene;
    struct tally *objects = alloc_array((size_t)scene->groups.count, sizeof *objects);
    struct tally *materials = alloc_array((size_t)scene->material_count,
                                         sizeof *materials);
    int32_t leaf = forest_next_leaf(forest, -1);
    for (; leaf >= 0; leaf = forest_next_leaf(forest, leaf)) {
        int32_t root = (int32_t)forest->patches[leaf].id.root;
        int32_t input = scene_input_of(scene, root);
        if (scene_is_sky(scene, root))
            continue;
        add_leaf(&objects[scene->groups.of[input]], run, found, leaf);
        add_leaf(&materials[scene->material_of[input]], run, found, leaf);
    }
    fprintf(file, "kind,name,area,emitted,absorbed,reflected,radiosity,irradiance,"
                  "irradiance_least,irradiance_most,irradiance_error\n");
    const char *name = scene->groups.names;
    for (int32_t i = 0; i < scene->groups.count; i++, name += strlen(name) + 1)
        write_totals(file, "object", name, &objects[i]);
    for (int32_t i = 0; i < scene->material_count; i++) {
        char number[32];
        snprintf(number, sizeof number, "material %ld", (long)i);
        write_totals(file, "material",
                   i < run->materials.count ? run->materials.name[i] : number,
                   &materials[i]);
    }
    alloc_free(objects);
    alloc_free(materials);
}

bool table_write_report(struct run *run)
{
    struct irradiance found;
    struct output output;
    struct error error = {.code = EXIT_DONE};
    if (!run->options.report)
        return true;
    irradiance_make(run, &found);
    if (run_goes_on(run) && run->comm.rank == 0) {
        if (output_open(&output, run->options.report, &error)) {
            write_all(run, &found, output.file);
            output_close(&output, &error);
        }
        run_lose(run, &error);
    }
    irradiance_free(&found);
    return run_agree(run);
}
