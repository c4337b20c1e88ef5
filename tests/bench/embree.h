/* Embree 3 beside the octree, where it is compiled in: -DWITH_EMBREE. */
#ifndef TESTS_BENCH_EMBREE_H
#define TESTS_BENCH_EMBREE_H

#ifdef WITH_EMBREE

#include <embree3/rtcore.h>

#include "geom/scene.h"

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

#endif
