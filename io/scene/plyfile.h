/* The container format PLY: a header of elements and properties, then for each element
 * its records of values, as text or binary in either byte order.
 *
 * Understood: `format`, `element`, `property`, `property list`, `comment`, `obj_info`;
 * the types char uchar short ushort int uint float double and their other names, int8 ...
 * float64. Lines of the header end in LF, CRLF or CR, as its first one does. Properties
 * without a field below, and elements not read by the caller, are skipped by their
 * size. */
#ifndef IO_SCENE_PLYFILE_H
#define IO_SCENE_PLYFILE_H

#include <stdbool.h>
#include <stdint.h>

#include "geom/error.h"
#include "io/scene/binary.h"
#include "io/scene/text.h"

enum ply_kind { PLY_VERTEX, PLY_FACE, PLY_STRIPS, PLY_MATERIAL, PLY_ROOT_CORNER,
                PLY_SOLUTION, PLY_OTHER };

/* Properties read, of one kind of elements or of several. */
enum ply_field {
    PLY_X, PLY_Y, PLY_Z,
    PLY_RED, PLY_GREEN, PLY_BLUE, /* colours, and their other names */
    PLY_R, PLY_G, PLY_B,
    PLY_DIFFUSE_RED, PLY_DIFFUSE_GREEN, PLY_DIFFUSE_BLUE,
    PLY_COLOR_0, PLY_COLOR_1, PLY_COLOR_2,
    PLY_EMISSION_R, PLY_EMISSION_G, PLY_EMISSION_B,
    PLY_RADIOSITY_R, PLY_RADIOSITY_G, PLY_RADIOSITY_B,
    PLY_ROOT, PLY_HIERARCHY, PLY_ERROR,
    PLY_REST_R, PLY_REST_G, PLY_REST_B, PLY_OUTSIDE,
    PLY_NX, PLY_NY, PLY_NZ, PLY_MATERIAL_NUMBER,
    PLY_REFLECTANCE_R, PLY_REFLECTANCE_G, PLY_REFLECTANCE_B,
    PLY_TRANSMITTANCE_R, PLY_TRANSMITTANCE_G, PLY_TRANSMITTANCE_B,
    PLY_EXPONENT, PLY_TWO_SIDED, PLY_TWO_SIDED_LAMPS, PLY_LAMP_LEAST, PLY_MEAN,
    PLY_CORNERS, /* the list vertex_indices or vertex_index */
    PLY_STRIP,   /* the same of tristrips, where -1 begins a strip */
    PLY_FIELDS
};

enum ply_type { PLY_CHAR, PLY_UCHAR, PLY_SHORT, PLY_USHORT, PLY_INT, PLY_UINT, PLY_FLOAT,
                PLY_DOUBLE, PLY_NONE };

struct ply_property {
    uint8_t type;       /* enum ply_type of the value, or of a list's items */
    uint8_t count_type; /* enum ply_type of a list's count; PLY_NONE: no list */
    uint8_t field;      /* enum ply_field; PLY_FIELDS: skipped */
};

struct ply_element {
    enum ply_kind kind;
    int64_t count;         /* records, as the header claims */
    int64_t property;      /* number of its first property */
    int64_t property_count;
    int64_t record_size;   /* smallest size of a record, with empty lists, bytes */
    bool has_list;
    long line;             /* of its declaration in the header */
    enum ply_type type_of[PLY_FIELDS]; /* PLY_NONE: lacks the property */
};

struct ply_header {
    struct ply_element *elements;    /* [element_count], in the order of the file */
    int64_t element_count, element_capacity;
    struct ply_property *properties; /* [property_count], element by element */
    int64_t property_count, property_capacity;
};

struct ply_file {
    struct binary binary;
    bool ascii, big_endian;
    char line_end;                   /* the last character of a line */
    struct ply_header header;
    struct text_names passed;        /* elements and properties not read */
    double value[PLY_FIELDS];        /* of the current record */
    int32_t *corners;                /* [corner_count] of the current record, >= 0, or -1
                                      * in a strip */
    int64_t corner_count, corner_capacity;
    int64_t record;                  /* number of the current record, from 0 */
    const char *record_name;         /* the name of the element, or "row", for messages */
    long line;                       /* number of the current text line */
    char *rest;                      /* unread part of the current text line */
    int64_t long_lines;              /* with more values than the header says, so far */
    long first_long;                 /* number of the first such line */
};

/* Reads an open file and its header. To be closed also after an error.
 * Errors: those of binary_read(); "PATH:LINE: REASON", EXIT_USAGE; also for an element
 * with more records than the file has bytes for. */
bool ply_file_open(struct ply_file *file, struct source *source, struct error *error);
void ply_file_close(struct ply_file *file);

/* Returns the first element of the kind, or NULL. */
const struct ply_element *ply_file_find(const struct ply_file *file, enum ply_kind kind);

/* Reads record `record` of the element into `file`. Elements and their records are to be
 * read in order. Numbers are at most TEXT_NUMBER_MAX in magnitude, and corners fit an
 * int32_t.
 * Errors: as ply_fail(), for a value that is missing, no number, infinite or out of
 * range. */
bool ply_file_record(struct ply_file *file, const struct ply_element *element,
                     int64_t record, struct error *error);

/* Skips all records of an element. Errors: the same. */
bool ply_file_skip(struct ply_file *file, const struct ply_element *element,
                   struct error *error);

/* Checks the end of the file, behind the last element. Errors: bytes other than blanks
 * are left. */
bool ply_file_end(const struct ply_file *file, struct error *error);

/* Sets an error at the current record: "PATH:LINE: TEXT" in a text file, else "PATH: face
 * 3: TEXT".
 * Returns false. */
bool ply_fail(const struct ply_file *file, struct error *error, const char *text);

#endif
