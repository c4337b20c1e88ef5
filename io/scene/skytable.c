/* Tregenza's patches lie in seven rows of 12 degrees, and one around the zenith of 12
 * degrees across. Reinhart cuts each row, and each patch along it, in `parts`; the zenith
 * stays one. All rows are then as high, and the zenith half as high. The first patch of a
 * row has its middle in the north. */
#include "io/scene/skytable.h"

#include "geom/alloc.h"
#include "geom/elementary.h"

enum { ROWS = 7, PATCHES = 144, PARTS_MOST = 16 };

static const int IN_ROW[ROWS] = {30, 30, 24, 24, 18, 12, 6};

struct rgb sky_table_radiance(const struct sky_table *table, double east, double north,
                              double up)
{
    int rows = ROWS * table->parts;
    int64_t first = 0;
    double height = arctangent(up, sqrt(east * east + north * north));
    int row = (int)(height / (0.5 * PI) * (rows + 0.5));
    if (row >= rows)
        return table->radiances[table->count - 1];
    row = row < 0 ? 0 : row;
    for (int k = 0; k < row; k++)
        first += IN_ROW[k / table->parts] * table->parts;
    int in_row = IN_ROW[row / table->parts] * table->parts;
    double turn = arctangent(east, north) / (2.0 * PI);
    int patch = (int)((turn + 1.0) * in_row + 0.5) % in_row;
    return table->radiances[first + patch];
}

/* Makes a table of numbers. False if no table has as many. */
static bool take(struct sky_table *table, const double *numbers, int64_t count)
{
    for (int parts = 1; parts <= PARTS_MOST; parts++)
        for (int bands = 1; bands <= BANDS; bands += 2)
            for (int ground = 0; ground <= 1; ground++) {
                int64_t patches = 1 + PATCHES * parts * parts;
                if (count != bands * (patches + ground))
                    continue;
                table->count = patches;
                table->parts = parts;
                table->radiances = alloc_array((size_t)patches, sizeof(struct rgb));
                for (int64_t i = 0; i < patches; i++)
                    for (int c = 0; c < BANDS; c++)
                        table->radiances[i].band[c] =
                            numbers[bands * (i + ground) + c % bands];
                return true;
            }
    return false;
}

bool sky_table_of_text(struct sky_table *table, struct text *text, struct error *error)
{
    double *numbers = NULL;
    int64_t count = 0, capacity = 0;
    bool good = true;
    *table = (struct sky_table){.count = 0};
    for (char *line; good && (line = text_line(text)) != NULL;) {
        double number = 0.0;
        for (char *word; good && (word = text_word(&line)) != NULL;) {
            if (count == 0 && !text_is_number(word, &number))
                break; /* a heading */
            good = text_number(text, word, &number, error);
            if (good && number < 0.0)
                good = error_set(error, EXIT_USAGE, "%s:%ld: a radiance below 0",
                                 text->path, text->line);
            RESERVE(numbers, &capacity, count + 1);
            numbers[count++] = number;
        }
    }
    if (good && !take(table, numbers, count))
        good = error_set(error, EXIT_USAGE, "%s: %lld numbers are no sky: 145, 577, "
                         "2305 ... patches, and perhaps the ground first, of one number "
                         "or three each", text->path, (long long)count);
    alloc_free(numbers);
    return good;
}

bool sky_table_read(struct sky_table *table, const char *path, struct error *error)
{
    struct text text;
    *table = (struct sky_table){.count = 0};
    if (!text_read(&text, path, error))
        return false;
    bool good = sky_table_of_text(table, &text, error);
    text_free(&text);
    return good;
}

void sky_table_free(struct sky_table *table)
{
    alloc_free(table->radiances);
    *table = (struct sky_table){.count = 0};
}
