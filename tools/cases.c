/* A list of right answers: comma-separated values without quotes, so that awk reads it,
 * too. */
#include "tools/cases.h"

#include <stdlib.h>
#include <string.h>

#include "geom/alloc.h"

enum { COLUMNS = 9, COLUMNS_LEAST = 8 };

int cases_cut(char *line, char **fields, int most)
{
    static char none[1];
    int count = 0;
    for (char *at = line; at; count++) {
        char *comma = strchr(at, ',');
        if (comma)
            *comma = '\0';
        if (count < most)
            fields[count] = text_trim(at);
        at = comma ? comma + 1 : NULL;
    }
    for (int k = count; k < most; k++)
        fields[k] = none;
    return count;
}

static bool add_line(struct cases *cases, char *line, struct error *error)
{
    char *field[COLUMNS];
    int count = cases_cut(line, field, COLUMNS);
    struct known_case known = {.id = field[0], .what = field[1], .unit = field[4],
                          .geometry = field[5], .formula = field[6],
                          .source = field[7], .slips = field[8]};
    if (count < COLUMNS_LEAST || count > COLUMNS)
        return error_set(error, EXIT_USAGE, "%s:%ld: %d fields, not %d or %d",
                         cases->text.path, cases->text.line, count, COLUMNS_LEAST,
                         COLUMNS);
    if (!text_number(&cases->text, field[2], &known.right, error) ||
        !text_number(&cases->text, field[3], &known.uncertainty, error))
        return false;
    if (cases_find(cases, known.id))
        return error_set(error, EXIT_USAGE, "%s:%ld: %s is there twice",
                         cases->text.path, cases->text.line, known.id);
    RESERVE(cases->items, &cases->capacity, cases->count + 1);
    cases->items[cases->count++] = known;
    return true;
}

bool cases_of_text(struct cases *cases, struct error *error)
{
    for (char *line; (line = text_line(&cases->text)) != NULL;)
        if (*line != '#' && *text_trim(line) && !add_line(cases, line, error))
            return false;
    return true;
}

bool cases_read(struct cases *cases, const char *path, struct error *error)
{
    *cases = (struct cases){.count = 0};
    return text_read(&cases->text, path, error) && cases_of_text(cases, error);
}

void cases_free(struct cases *cases)
{
    text_free(&cases->text);
    alloc_free(cases->items);
}

const struct known_case *cases_find(const struct cases *cases, const char *id)
{
    for (int64_t i = 0; i < cases->count; i++)
        if (strcmp(cases->items[i].id, id) == 0)
            return &cases->items[i];
    return NULL;
}

bool cases_next_slip(const char **slips, char name[64], double *value)
{
    const char *equals = strchr(*slips, '=');
    if (!equals)
        return false;
    size_t length = (size_t)(equals - *slips);
    length = length < 63 ? length : 63;
    memcpy(name, *slips, length);
    name[length] = '\0';
    char *end;
    *value = strtod(equals + 1, &end);
    *slips = end + (*end == ';');
    return true;
}

/* Reads the corners of one polygon; `*at` moves on to its end. */
static bool read_corners(const char **at, struct case_polygons *polygons)
{
    double x[3];
    char *end;
    int32_t polygon = polygons->count, count = 0;
    for (;; count++) {
        for (int k = 0; k < 3; k++, *at = end) {
            x[k] = strtod(*at, &end);
            if (end == *at && k == 0) {
                polygons->corners[polygon] = count;
                return count >= 3;
            }
            if (end == *at || count == CASE_CORNERS)
                return false;
        }
        polygons->corner[polygon][count] = (struct vec3){x[0], x[1], x[2]};
    }
}

bool case_polygons(const struct known_case *known, struct case_polygons *polygons)
{
    const char *at = known->geometry;
    for (polygons->count = 0; polygons->count < CASE_POLYGONS; at++) {
        if (!read_corners(&at, polygons))
            return false;
        polygons->count++;
        at += strspn(at, " ");
        if (*at != '/')
            return *at == '\0';
    }
    return false;
}
