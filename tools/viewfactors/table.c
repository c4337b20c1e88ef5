/* Form factors as CSV.
 *
 * 17 digits represent each double exactly, so A_i F_ij and A_j F_ji, read back, are equal
 * but for the rounding of one division. The sum of a row adds its printed factors, in
 * their order. */
#include "tools/viewfactors/table.h"

#include <string.h>

#include "geom/alloc.h"
#include "geom/stop.h"

static void print_name(const char *name, FILE *file)
{
    size_t length = strlen(name);
    if (!strpbrk(name, ",\"") && strcmp(name, "*") != 0) {
        fwrite(name, 1, length, file);
        return;
    }
    fputc('"', file);
    for (size_t i = 0; i < length; i++) {
        if (name[i] == '"')
            fputc('"', file);
        fputc(name[i], file);
    }
    fputc('"', file);
}

static void print_line(const char *from, const char *to, double area, double factor,
                       FILE *file)
{
    print_name(from, file);
    fputc(',', file);
    if (to)
        print_name(to, file);
    else
        fputc('*', file);
    fprintf(file, ",%.17g,%.17g\n", area, factor);
}

void table_print(const struct viewfactors *factors, bool dense, FILE *file)
{
    double unit = scene_area_unit(factors->scene);
    const char **names = alloc_array((size_t)factors->count, sizeof *names);
    const char *name = factors->scene->groups.names;
    for (int32_t i = 0; i < factors->count; i++, name += strlen(name) + 1)
        names[i] = name;
    fputs("from,to,area_from,F\n", file);
    for (int32_t i = 0; i < factors->count && !stop_is_asked(); i++) {
        double area = factors->areas[i] * unit, sum = 0.0;
        for (int32_t j = 0; j < factors->count; j++) {
            double factor = viewfactors_factor(factors, i, j);
            if (dense || factor > 0.0)
                print_line(names[i], names[j], area, factor, file);
            sum += factor;
        }
        print_line(names[i], NULL, area, sum, file);
    }
    alloc_free((void *)names);
}
