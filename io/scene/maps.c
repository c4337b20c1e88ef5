/* Maps of Kd and Ke. A picture is read once, for the faces of all its materials. The mean
 * over the whole picture would be the mean of a sheet on which parts lie apart: most of
 * the pictures of scanned things is black filler. Faces unlike each other, as those of a
 * scanned thing, become materials of their own; those of a wallpaper, which repeats on
 * each, do not. */
#include "io/scene/maps.h"

#include <math.h>

#include "geom/alloc.h"

static const double APART = 0.1; /* 1 */

/* The faces of a table's materials, one material after the other. */
struct order {
    int32_t *faces; /* [count] */
    int64_t *first; /* [materials + 1] */
};

static struct order make_order(const struct mtl_table *table,
                               const struct map_face *faces, int64_t count)
{
    size_t materials = (size_t)table->names.count;
    struct order order = {alloc_array((size_t)count, sizeof *order.faces),
                          alloc_array(materials + 2, sizeof *order.first)};
    for (int64_t i = 0; i < count; i++)
        order.first[faces[i].material + 2]++;
    for (size_t m = 2; m < materials + 2; m++)
        order.first[m] += order.first[m - 1];
    for (int64_t i = 0; i < count; i++)
        order.faces[order.first[faces[i].material + 1]++] = (int32_t)i;
    return order;
}

/* Multiplies Kd (`k` is 0) or Ke (1) by the mean of its map; NULL: the map is lost. */
static void take_mean(struct mtl_entry *entry, int k, const struct rgb *mean)
{
    struct rgb *colour =
        k == 0 ? &entry->material.reflectance : &entry->material.emission;
    bool given = k == 0 ? entry->has_kd || entry->unread : entry->has_ke, white = true;
    for (int c = 0; c < BANDS; c++) {
        colour->band[c] = given || (k == 1 && !mean) ? colour->band[c] : 1.0;
        white = white && colour->band[c] >= 1.0;
        colour->band[c] *= mean ? mean->band[c] : 1.0;
    }
    if (k == 0 && white && !mean)
        *colour = (struct rgb){{0.5, 0.5, 0.5}};
}

/* Takes the map of a material, whose faces have these means. */
static void take_map(struct mtl_entry *entry, int k, const struct map_face *faces,
                     const int32_t *own, int64_t count, const struct rgb *means,
                     const struct rgb *whole, struct rgb *colours)
{
    struct rgb sum = {{0.0, 0.0, 0.0}}, kd = entry->material.reflectance;
    double area = 0.0, apart = 0.0;
    if (!entry->has_kd && !entry->unread)
        kd = (struct rgb){{1.0, 1.0, 1.0}};
    for (int64_t i = 0; i < count; i++) {
        rgb_add(&sum, faces[own[i]].area, means[i]);
        area += faces[own[i]].area;
    }
    for (int c = 0; c < BANDS; c++)
        sum.band[c] = area > 0.0 ? sum.band[c] / area : whole->band[c];
    take_mean(entry, k, &sum);
    for (int64_t i = 0; i < count; i++)
        for (int c = 0; c < BANDS; c++)
            apart = fmax(apart, fabs(means[i].band[c] - sum.band[c]) * kd.band[c]);
    for (int64_t i = 0; i < count && k == 0 && apart > APART; i++)
        for (int c = 0; c < BANDS; c++)
            colours[own[i]].band[c] = kd.band[c] * means[i].band[c];
}

/* Takes one picture, the map of materials. */
static void take_picture(struct mtl_table *table, int32_t picture,
                         const struct map_face *faces, const struct order *order,
                         map_mean *mean_of, struct text_missing *lost,
                         struct rgb *colours)
{
    const char *path = table->maps.name[picture];
    struct error error = {EXIT_DONE, ""};
    int64_t count = 0, parts = 0;
    for (int32_t m = 0; m < table->names.count; m++)
        if (table->entries[m].maps[0] == picture + 1 ||
            table->entries[m].maps[1] == picture + 1)
            count += order->first[m + 1] - order->first[m];
    struct map_part *part = alloc_array((size_t)count, sizeof *part);
    struct rgb *means = alloc_array((size_t)count + 1, sizeof *means);
    struct rgb *own = alloc_array((size_t)count + 1, sizeof *own);
    for (int32_t m = 0; m < table->names.count; m++)
        for (int64_t i = order->first[m]; i < order->first[m + 1]; i++)
            if ((table->entries[m].maps[0] == picture + 1 ||
                 table->entries[m].maps[1] == picture + 1) &&
                faces[order->faces[i]].has_part)
                part[parts++] = faces[order->faces[i]].part;
    bool found = mean_of && mean_of(path, part, parts, means, &error);
    struct rgb whole = means[parts];
    parts = 0;
    for (int32_t m = 0; m < table->names.count; m++) {
        struct mtl_entry *entry = &table->entries[m];
        int64_t faces_of = order->first[m + 1] - order->first[m];
        const int32_t *list = order->faces + order->first[m];
        if (!entry->used || (entry->maps[0] != picture + 1 &&
                             entry->maps[1] != picture + 1))
            continue;
        for (int64_t i = 0; i < faces_of && found; i++)
            own[i] = faces[list[i]].has_part ? means[parts++] : whole;
        for (int k = 0; k < 2; k++) {
            if (entry->maps[k] != picture + 1)
                continue;
            if (found)
                take_map(entry, k, faces, list, faces_of, own, &whole, colours);
            else
                take_mean(entry, k, NULL);
            if (!found)
                text_missing_add(lost, path);
        }
    }
    alloc_free(own);
    alloc_free(means);
    alloc_free(part);
}

void maps_take(struct mtl_table *table, const struct map_face *faces, int64_t count,
               map_mean *mean_of, struct text_missing *lost, struct text_names *files,
               struct rgb *colours)
{
    struct order order = make_order(table, faces, count);
    bool *used = alloc_array((size_t)table->maps.count, sizeof *used);
    for (int64_t i = 0; i < count; i++)
        colours[i].band[0] = -1.0;
    for (int32_t m = 0; m < table->names.count; m++)
        for (int k = 0; k < 2; k++)
            if (table->entries[m].used && table->entries[m].maps[k] > 0)
                used[table->entries[m].maps[k] - 1] = true;
    for (int32_t picture = 0; picture < table->maps.count; picture++) {
        if (!used[picture])
            continue;
        take_picture(table, picture, faces, &order, mean_of, lost, colours);
        if (files)
            text_names_add(files, table->maps.name[picture]);
    }
    alloc_free(used);
    alloc_free(order.faces);
    alloc_free(order.first);
}
