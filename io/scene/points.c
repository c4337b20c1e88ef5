/* Points for a light meter, as spreadsheets and other programs of light write them. */
#include "io/scene/points.h"

#include "geom/alloc.h"

/* A number too many may be a number as 1,5. */
enum { NUMBERS = 6, POINTS_MOST = 1 << 24 };

static void part_words(char *line)
{
    for (; *line; line++)
        *line = *line == ',' || *line == ';' ? ' ' : *line;
}

static bool read_line(struct points *points, const struct text *text, char *line,
                      struct error *error)
{
    double value[NUMBERS];
    int count = 0;
    part_words(line);
    for (const char *word; (word = text_word(&line)) != NULL; count++) {
        double number;
        if (count == 0 && points->count == 0 && !text_is_number(word, &number))
            return true; /* the heading */
        if (count < NUMBERS && !text_number(text, word, &value[count], error))
            return false;
    }
    if (count == 0)
        return true;
    if (count != NUMBERS)
        return error_set(error, EXIT_USAGE,
                         "%s:%ld: a point is x y z nx ny nz, not %d numbers", text->path,
                         text->line, count);
    if (points->count == POINTS_MOST)
        return error_set(error, EXIT_USAGE, "%s:%ld: more than %d points", text->path,
                         text->line, POINTS_MOST);
    struct vec3 normal = {value[3], value[4], value[5]};
    double length = vec3_length(normal);
    if (!(length > 0.0))
        return error_set(error, EXIT_USAGE, "%s:%ld: the normal has no length",
                         text->path, text->line);
    RESERVE(points->sensors, &points->capacity, points->count + 1);
    points->sensors[points->count++] = (struct sensor){
        {value[0], value[1], value[2]}, vec3_scale(normal, 1.0 / length)};
    return true;
}

bool points_of_text(struct points *points, struct text *text, struct error *error)
{
    *points = (struct points){.count = 0};
    for (char *line; (line = text_line(text)) != NULL;)
        if (!read_line(points, text, line, error))
            return false;
    return points->count > 0 ||
           error_set(error, EXIT_USAGE, "%s: no points", text->path);
}

bool points_read(struct points *points, const char *path, struct error *error)
{
    struct text text;
    *points = (struct points){.count = 0};
    if (!text_read(&text, path, error))
        return false;
    bool good = points_of_text(points, &text, error);
    text_free(&text);
    return good;
}

void points_free(struct points *points)
{
    alloc_free(points->sensors);
    *points = (struct points){.count = 0};
}
