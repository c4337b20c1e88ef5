/* Right answers as data: docs/oracle/cases.csv, whose head names its columns. */
#ifndef TOOLS_CASES_H
#define TOOLS_CASES_H

#include "geom/vec.h"
#include "io/scene/text.h"

/* A line of the file; texts live as long as the list. */
struct known_case {
    const char *id;
    const char *what;      /* the quantity, such as "F 1 2" */
    double right;          /* in `unit` */
    double uncertainty;    /* of `right`, in `unit` */
    const char *unit;
    const char *geometry;  /* polygons, a scene, or words */
    const char *formula;
    const char *source;
    const char *slips;     /* "name=value;..." or "" */
};

struct cases {
    struct text text;
    struct known_case *items;   /* [count] */
    int64_t count, capacity;
};

/* Reads a list. Lines that begin with # and empty ones are comments. Errors: "PATH:LINE:
 * what is wrong", EXIT_USAGE. To be freed also after a failure. */
bool cases_read(struct cases *cases, const char *path, struct error *error);

/* Does the same with cases->text, which is read; all else is 0. */
bool cases_of_text(struct cases *cases, struct error *error);

void cases_free(struct cases *cases);

/* Returns the case of this ID, or NULL. */
const struct known_case *cases_find(const struct cases *cases, const char *id);

/* Cuts a line at its commas into at most `most` fields without blanks around; `fields` is
 * filled with "" behind the last. Returns how many there were. */
int cases_cut(char *line, char **fields, int most);

/* Takes the next "name=value" off `*slips`, which moves on behind. False at the end. */
bool cases_next_slip(const char **slips, char name[64], double *value);

enum { CASE_CORNERS = 16, CASE_POLYGONS = 16 };

/* Polygons, counter-clockwise as seen from the front, in the units of the file. */
struct case_polygons {
    int32_t count;                                       /* of polygons */
    int32_t corners[CASE_POLYGONS];
    struct vec3 corner[CASE_POLYGONS][CASE_CORNERS];
};

/* Reads the polygons of a case. False if its geometry is something else. */
bool case_polygons(const struct known_case *known, struct case_polygons *polygons);

#endif
