/* A scene under test for benches of visibility: its octree, and Embree 3 beside it where
 * that is compiled in (-DWITH_EMBREE), one thread. */
#ifndef TESTS_BENCH_SUBJECT_H
#define TESTS_BENCH_SUBJECT_H

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "geom/alloc.h"
#include "octree/octree.h"
#include "octree/tree.h"
#include "tests/random.h"
#include "tests/reading.h"

#ifdef WITH_EMBREE
#include <embree3/rtcore.h>
#endif

struct bench {
    const struct scene *scene;
    struct octree *octree;
#ifdef WITH_EMBREE
    RTCDevice device;
    RTCScene whole, inside; /* all triangles; without those of the hull */
#endif
};

static inline double cpu_seconds(void)
{
    return (double)clock() / CLOCKS_PER_SEC;
}

#ifdef WITH_EMBREE

/* Room for `count` rays as Embree wants them, within `*memory`, which is to be freed. */
static inline void *alloc_aligned(int count, size_t size, void **memory)
{
    char *bytes = *memory = alloc_array((size_t)count + 1, size);
    return bytes + (64 - (uintptr_t)bytes % 64) % 64;
}

/* The triangles of a prepared scene, numbered as they are there. If `place` is not NULL
 * those are left out whose place in the octree is below 0, and the others move up. */
static inline RTCScene embree_create(RTCDevice device, const struct scene *scene,
                                     const int32_t *place)
{
    RTCScene embree = rtcNewScene(device);
    RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    size_t count = (size_t)scene->input_count, kept = 0;
    for (size_t i = 0; i < count; i++)
        kept += !place || place[i] >= 0;
    float *vertices = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0,
                                              RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                              3 * count);
    unsigned *indices = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0,
                                                RTC_FORMAT_UINT3, 3 * sizeof(unsigned),
                                                kept);
    for (size_t i = 0; i < 3 * count; i++) {
        struct vec3 x = scene->triangles[i / 3].corner[i % 3];
        vertices[3 * i] = (float)x.x;
        vertices[3 * i + 1] = (float)x.y;
        vertices[3 * i + 2] = (float)x.z;
        if (!place || place[i / 3] >= 0)
            *indices++ = (unsigned)i;
    }
    rtcCommitGeometry(mesh);
    rtcAttachGeometry(embree, mesh);
    rtcReleaseGeometry(mesh);
    rtcSetSceneBuildQuality(embree, RTC_BUILD_QUALITY_HIGH);
    rtcCommitScene(embree);
    return embree;
}

#endif

/* Reads and prepares the scene argv[1], and runs the bench on it with a number and a
 * seed from argv[2] and argv[3]. Returns the exit status. */
static inline int bench_main(int argc, char **argv, const char *usage, int number,
                                void (*bench)(const struct bench *, int, uint64_t))
{
    struct comm comm;
    struct error error = {0};
    struct scene *scene = NULL;
    comm_start(&comm, &argc, &argv);
    if (argc < 2)
        error_set(&error, EXIT_USAGE, "usage: %s", usage);
    else
        scene = scene_read((struct reading){.path = argv[1]}, &error);
    if (scene) {
        struct bench s = {.scene = scene};
        struct pack pack = {0};
        double start = cpu_seconds();
        s.octree = octree_create(scene->triangles, scene->planes, scene->input_count);
        double built = cpu_seconds() - start;
        octree_pack(s.octree, &pack);
        printf("%s: %d triangles, octree built in %.3f s, %.1f bytes per triangle\n",
               argv[1], (int)scene->input_count, built,
               (double)pack.bytes / scene->input_count);
#ifdef WITH_EMBREE
        s.device = rtcNewDevice("threads=1");
        s.whole = embree_create(s.device, scene, NULL);
        s.inside = embree_create(s.device, scene, s.octree->place);
#endif
        bench(&s, argc > 2 ? atoi(argv[2]) : number,
              argc > 3 ? (uint64_t)atoi(argv[3]) : 1);
#ifdef WITH_EMBREE
        rtcReleaseScene(s.whole);
        rtcReleaseScene(s.inside);
        rtcReleaseDevice(s.device);
#endif
        octree_destroy(s.octree);
    }
    if (error.code != EXIT_DONE)
        fprintf(stderr, "%s\n", error.text);
    scene_destroy(scene);
    comm_stop(&comm);
    return error.code;
}

#endif
