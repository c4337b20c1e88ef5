/* The light meter against the path tracer, at points of a scene: scenes/cornell.obj, or
 * the one named.
 *
 * A claim is a bound for 95 % of points; of POINTS more than OUTSIDE are outside in one
 * of 60 scenes, and none may be off by three times its claim. Three deviations of the
 * path tracer are added to the claims. */
#include "rad/beyond/meter.h"

#include "geom/hash.h"
#include "rad/beyond/paths.h"
#include "tests/defaults.h"
#include "tests/random.h"
#include "tests/reading.h"
#include "tests/tap.h"

enum { POINTS = 20, OUTSIDE = 3, RAYS = 4096, RUNS = 16, SAMPLES = 4096 };

/* A random point of all surfaces, by area: barycentric coordinates in the root. */
static int32_t choose_point(const struct scene *scene, struct random *random,
                            struct vec3 *weight)
{
    double at = random_unit(random) * scene_area(scene), sum = 0.0;
    double u = sqrt(random_unit(random)), v = random_unit(random);
    int32_t root = 0;
    while ((sum += scene_root_area(scene, root)) <= at)
        root++;
    *weight = (struct vec3){1.0 - u, u * (1.0 - v), u * v};
    return root;
}

/* H there in the first band by paths, and its deviation, W/m^2. */
static double trace(const struct pathtracer *tracer, int32_t root, struct vec3 weight,
                    uint64_t seed, double *deviation)
{
    struct triangle part = {{weight, weight, weight}};
    double rho = scene_root_material(tracer->scene, root)->reflectance.band[0];
    double mean = 0.0, squares = 0.0;
    for (uint64_t run = 0; run < RUNS; run++) {
        double h = pathtracer_reflected(tracer, root, &part, SAMPLES,
                                        hash_mix(seed) + run).band[0] / rho;
        mean += h / RUNS;
        squares += h * h / RUNS;
    }
    *deviation = sqrt(fmax(0.0, squares - mean * mean) / (RUNS - 1));
    return mean;
}

int main(int argc, char **argv)
{
    struct error error = {0};
    struct reading file = {.path = argc > 1 ? argv[1] : "scenes/cornell.obj"};
    comm_start(&world_comm, &argc, &argv);
    struct scene *scene = scene_read(file, &error);
    if (!scene) {
        printf("Bail out! %s\n", error.text);
        return 1;
    }
    struct solution s = solve(&world_comm, scene, criterion_parse(""));
    struct meter meter = meter_make(s.solver->model.forest, s.octree,
                                    beyond_answer(s.solver)->error);
    struct pathtracer tracer = pathtracer_make(scene, s.octree);
    struct random random = random_seed(67);
    double most = 0.0, claims = 0.0, light = 0.0;
    int outside = 0;
    for (int i = 0; i < POINTS;) {
        struct vec3 weight;
        double deviation;
        int32_t root = choose_point(scene, &random, &weight);
        if (!(scene_root_material(scene, root)->reflectance.band[0] > 0.0))
            continue;
        struct triangle t = scene_root_triangle(scene, root);
        struct metered metered =
            meter_read(&meter, corners_mean(t.corner, weight),
                       scene_root_plane(scene, root).normal, RAYS, (uint64_t)i);
        double truth = trace(&tracer, root, weight, (uint64_t)i, &deviation);
        double off = fabs(metered.irradiance.band[0] - truth) - 3.0 * deviation;
        printf("# %.4f, paths %.4f +- %.4f, claim %.4f\n", metered.irradiance.band[0],
               truth, deviation, metered.error);
        outside += off > metered.error;
        most = fmax(most, off / metered.error);
        claims += metered.error;
        light += truth;
        i++;
    }
    tap_ok(outside <= OUTSIDE, "%d of %d points outside of their claims", outside,
           POINTS);
    tap_ok(most < 3.0, "none by three times its claim: %.2f", most);
    tap_ok(claims < 0.05 * light, "which are %.2g of the light", claims / light);
    meter_free(&meter);
    pathtracer_free(&tracer);
    solution_free(&s);
    comm_stop(&world_comm);
    return tap_done();
}
