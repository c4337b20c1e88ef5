/* Reading PLY files record by record.
 *
 * The counts of the header are checked against the size of the file before anything is
 * allocated: a record has at least the bytes of its scalars and of its lists' counts, or,
 * as text, two characters for each value. So a file of a hundred bytes cannot ask for a
 * billion vertices. The count of a list is checked in the same way.
 *
 * A record of a text file is a line, as the format's description has it. Values behind
 * its last are passed over and counted: to a reader that ignores line ends one value too
 * many shifts all later ones, and gives a wrong scene without a message. For the same
 * reason only blanks may follow the last record.
 *
 * Values of properties not read may be NaN; all others have to be finite. The types of
 * the header hold for binary files only: a text file may write 300 for a uchar. */
#include "io/scene/plyfile.h"

#include <math.h>
#include <string.h>

#include "geom/alloc.h"
#include "geom/stop.h"

static const struct {
    const char *name, *other;
    int size; /* bytes */
} TYPES[] = {{"char", "int8", 1},     {"uchar", "uint8", 1},    {"short", "int16", 2},
             {"ushort", "uint16", 2}, {"int", "int32", 4},      {"uint", "uint32", 4},
             {"float", "float32", 4}, {"double", "float64", 8}};

/* Properties read: names in the order of their fields. */
static const struct {
    enum ply_kind kind;
    const char *names;
    enum ply_field first;
} FIELDS[] = {{PLY_VERTEX, "x y z", PLY_X},
              {PLY_VERTEX, "red green blue", PLY_RED},
              {PLY_VERTEX, "r g b", PLY_R},
              {PLY_VERTEX, "diffuse_red diffuse_green diffuse_blue", PLY_DIFFUSE_RED},
              {PLY_VERTEX, "color_0 color_1 color_2", PLY_COLOR_0},
              {PLY_FACE, "vertex_indices", PLY_CORNERS},
              {PLY_FACE, "vertex_index", PLY_CORNERS},
              {PLY_FACE, "red green blue", PLY_RED},
              {PLY_FACE, "r g b", PLY_R},
              {PLY_FACE, "diffuse_red diffuse_green diffuse_blue", PLY_DIFFUSE_RED},
              {PLY_FACE, "color_0 color_1 color_2", PLY_COLOR_0},
              {PLY_FACE, "emission_r emission_g emission_b", PLY_EMISSION_R},
              {PLY_FACE, "radiosity_r radiosity_g radiosity_b", PLY_RADIOSITY_R},
              {PLY_FACE, "root hierarchy error", PLY_ROOT},
              {PLY_FACE, "rest_r rest_g rest_b outside", PLY_REST_R},
              {PLY_STRIPS, "vertex_indices", PLY_STRIP},
              {PLY_STRIPS, "vertex_index", PLY_STRIP},
              {PLY_MATERIAL, "reflectance_r reflectance_g reflectance_b",
               PLY_REFLECTANCE_R},
              {PLY_MATERIAL, "emission_r emission_g emission_b", PLY_EMISSION_R},
              {PLY_MATERIAL, "transmittance_r transmittance_g transmittance_b",
               PLY_TRANSMITTANCE_R},
              {PLY_ROOT_CORNER, "x y z", PLY_X},
              {PLY_ROOT_CORNER, "nx ny nz material", PLY_NX},
              {PLY_SOLUTION, "x y z", PLY_X},
              {PLY_SOLUTION, "exponent two_sided two_sided_lamps lamp_least mean",
               PLY_EXPONENT}};

/* Names of elements, and of their records in messages. */
static const char *const KIND_NAMES[] = {
    "vertex", "face", "tristrips", "material", "root_corner", "solution", "row"};

/* --- the header --- */

/* Returns the next line without its end, or NULL behind the last one. */
static char *next_line(struct ply_file *file)
{
    struct binary *binary = &file->binary;
    if (binary_left(binary) == 0)
        return NULL;
    char *line = binary->data + binary->position;
    char *end = memchr(line, file->line_end, (size_t)binary_left(binary));
    binary->position = end ? end + 1 - binary->data : binary->size;
    end = end ? end : binary->data + binary->size;
    *end = '\0';
    if (end > line && end[-1] == '\r')
        end[-1] = '\0';
    file->line = binary->line++;
    return line;
}

static bool fail_word(const struct ply_file *file, struct error *error, const char *what,
                      const char *word)
{
    return error_set(error, EXIT_USAGE, "%s:%ld: %s '%.40s'", file->binary.path,
                     file->line, what, word ? word : "");
}

static bool read_format(struct ply_file *file, char *rest, bool *known,
                        struct error *error)
{
    const char *name = text_word(&rest), *version = text_word(&rest);
    if (*known)
        return fail_word(file, error, "a second format", name);
    *known = true;
    file->ascii = name && strcmp(name, "ascii") == 0;
    file->big_endian = name && strcmp(name, "binary_big_endian") == 0;
    if (!file->ascii && !file->big_endian &&
        (!name || strcmp(name, "binary_little_endian") != 0))
        return fail_word(file, error, "unknown format", name);
    if (!version || strcmp(version, "1.0") != 0)
        return fail_word(file, error, "unknown version of the format", version);
    return true;
}

static bool read_element(struct ply_file *file, char *rest, struct error *error)
{
    const char *name = text_word(&rest), *count = text_word(&rest);
    struct ply_header *header = &file->header;
    struct ply_element element = {.kind = PLY_OTHER, .property = header->property_count,
                                  .line = file->line};
    for (int field = 0; field < PLY_FIELDS; field++)
        element.type_of[field] = PLY_NONE;
    for (int kind = 0; name && kind < PLY_OTHER; kind++)
        if (strcmp(name, KIND_NAMES[kind]) == 0)
            element.kind = (enum ply_kind)kind;
    const char *digits = count;
    if (!count || !text_integer(&digits, &element.count) || *digits || element.count < 0)
        return fail_word(file, error, "bad number of elements", count);
    if (element.kind != PLY_OTHER && ply_file_find(file, element.kind))
        return fail_word(file, error, "a second element", name);
    if (element.kind == PLY_OTHER)
        text_names_add(&file->passed, name ? name : "");
    RESERVE(header->elements, &header->element_capacity, header->element_count + 1);
    header->elements[header->element_count++] = element;
    return true;
}

static enum ply_type find_type(const char *word)
{
    for (int i = 0; word && i < PLY_NONE; i++)
        if (strcmp(word, TYPES[i].name) == 0 || strcmp(word, TYPES[i].other) == 0)
            return (enum ply_type)i;
    return PLY_NONE;
}

static enum ply_field find_field(enum ply_kind kind, const char *name)
{
    for (size_t i = 0; i < sizeof FIELDS / sizeof FIELDS[0]; i++) {
        const char *at = FIELDS[i].names;
        for (int k = 0; FIELDS[i].kind == kind && *at; k++, at += *at == ' ') {
            size_t length = strcspn(at, " ");
            if (strlen(name) == length && strncmp(at, name, length) == 0)
                return (enum ply_field)((int)FIELDS[i].first + k);
            at += length;
        }
    }
    return PLY_FIELDS;
}

/* Checks the type of a property: corners are lists of integers, all others single
 * numbers. */
static bool check_field(struct ply_file *file, struct ply_element *element,
                        const struct ply_property *property, const char *name,
                        struct error *error)
{
    bool list = property->count_type != PLY_NONE;
    if (property->field == PLY_FIELDS) {
        if (element->kind != PLY_OTHER)
            text_names_add(&file->passed, name);
        return true;
    }
    if (list != (property->field >= PLY_CORNERS) || (list && property->type >= PLY_FLOAT))
        return fail_word(file, error, "the wrong kind of property for", name);
    if (element->type_of[property->field] != PLY_NONE)
        return fail_word(file, error, "a second property", name);
    element->type_of[property->field] = (enum ply_type)property->type;
    return true;
}

static bool read_property(struct ply_file *file, char *rest, struct error *error)
{
    struct ply_header *header = &file->header;
    if (header->element_count == 0)
        return fail_word(file, error, "a property before any element:", rest);
    struct ply_element *element = &header->elements[header->element_count - 1];
    const char *word = text_word(&rest);
    bool list = word && strcmp(word, "list") == 0;
    enum ply_type count_type = list ? find_type(text_word(&rest)) : PLY_NONE;
    const char *type_name = list ? text_word(&rest) : word, *name = text_word(&rest);
    enum ply_type type = find_type(type_name);
    if (type == PLY_NONE || !name || (list && count_type >= PLY_FLOAT))
        return fail_word(file, error, "bad property", name);
    struct ply_property property = {.type = (uint8_t)type,
                                    .count_type = (uint8_t)count_type,
                                    .field = (uint8_t)find_field(element->kind, name)};
    RESERVE(header->properties, &header->property_capacity, header->property_count + 1);
    header->properties[header->property_count++] = property;
    element->property_count++;
    element->has_list = element->has_list || list;
    element->record_size += TYPES[list ? count_type : type].size;
    return check_field(file, element, &property, name, error);
}

/* Checks the counts of the elements against the size of the file. */
static bool check_claims(struct ply_file *file, struct error *error)
{
    const struct binary *binary = &file->binary;
    if (file->ascii &&
        (int64_t)strlen(binary->data + binary->position) < binary_left(binary))
        return error_set(error, EXIT_USAGE, "%s: not text, though its header says ascii",
                         binary->path);
    int64_t last_end = file->ascii ? 1 : 0; /* the last line may lack its end */
    int64_t left = binary_left(binary) + last_end;
    for (int64_t i = 0; i < file->header.element_count; i++) {
        struct ply_element *element = &file->header.elements[i];
        if (file->ascii)
            element->record_size = 2 * element->property_count;
        if (element->record_size > 0 && element->count > left / element->record_size)
            return error_set(error, EXIT_USAGE,
                             "%s:%ld: the file is too short for %lld elements "
                             "of this kind",
                             binary->path, element->line, (long long)element->count);
    }
    return true;
}

static bool read_header(struct ply_file *file, struct error *error)
{
    bool known = false, good = true;
    const char *keyword = NULL;
    next_line(file);
    for (char *rest; good && (rest = next_line(file)) != NULL;) {
        keyword = text_word(&rest);
        if (!keyword || strcmp(keyword, "comment") == 0 ||
            strcmp(keyword, "obj_info") == 0)
            continue;
        if (strcmp(keyword, "format") == 0)
            good = read_format(file, rest, &known, error);
        else if (strcmp(keyword, "element") == 0)
            good = read_element(file, rest, error);
        else if (strcmp(keyword, "property") == 0)
            good = read_property(file, rest, error);
        else if (strcmp(keyword, "end_header") == 0)
            return known ? check_claims(file, error)
                         : fail_word(file, error, "no format before", keyword);
        else
            good = fail_word(file, error, "unknown line of the header:", keyword);
    }
    return good && error_set(error, EXIT_USAGE, "%s:%ld: the header has no end",
                             file->binary.path, file->line);
}

bool ply_file_open(struct ply_file *file, struct source *source, struct error *error)
{
    *file = (struct ply_file){.record_name = KIND_NAMES[PLY_OTHER]};
    if (!binary_read(&file->binary, source, "ply", "a PLY file", error))
        return false;
    const char *end = file->binary.data + 3;
    if (*end != '\n' && *end != '\r')
        return error_set(error, EXIT_USAGE, "%s: not a PLY file", source->path);
    file->line_end = *end == '\r' && end[1] != '\n' ? '\r' : '\n';
    return read_header(file, error);
}

void ply_file_close(struct ply_file *file)
{
    binary_free(&file->binary);
    alloc_free(file->header.elements);
    alloc_free(file->header.properties);
    text_names_free(&file->passed);
    alloc_free(file->corners);
    *file = (struct ply_file){0};
}

const struct ply_element *ply_file_find(const struct ply_file *file, enum ply_kind kind)
{
    for (int64_t i = 0; i < file->header.element_count; i++)
        if (file->header.elements[i].kind == kind)
            return &file->header.elements[i];
    return NULL;
}

/* --- the records --- */

bool ply_fail(const struct ply_file *file, struct error *error, const char *text)
{
    if (file->ascii)
        return error_set(error, EXIT_USAGE, "%s:%ld: %s", file->binary.path, file->line,
                         text);
    return error_set(error, EXIT_USAGE, "%s: %s %lld: %s", file->binary.path,
                     file->record_name, (long long)file->record, text);
}

static bool fail_short(const struct ply_file *file, struct error *error)
{
    return error_set(error, EXIT_USAGE, "%s: the file ends in %s %lld", file->binary.path,
                     file->record_name, (long long)file->record);
}

static double decode(const char *at, enum ply_type type, bool big_endian)
{
    int size = TYPES[type].size;
    if (type == PLY_DOUBLE)
        return binary_double(at, big_endian);
    if (type == PLY_FLOAT)
        return (double)binary_float(at, big_endian);
    if (type == PLY_CHAR || type == PLY_SHORT || type == PLY_INT)
        return (double)binary_signed(at, size, big_endian);
    return (double)binary_integer(at, size, big_endian);
}

/* Reads the next value of the record, or skips one if `value` is NULL. */
static bool take(struct ply_file *file, enum ply_type type, double *value,
                 struct error *error)
{
    if (file->ascii) {
        const char *word = text_word(&file->rest);
        if (!word)
            return ply_fail(file, error, "fewer values than the header says");
        if (value && !text_is_number(word, value))
            return fail_word(file, error, "bad number", word);
    } else {
        if (binary_left(&file->binary) < TYPES[type].size)
            return fail_short(file, error);
        const char *at = file->binary.data + file->binary.position;
        file->binary.position += TYPES[type].size;
        if (value)
            *value = decode(at, type, file->big_endian);
    }
    if (value && !(fabs(*value) <= TEXT_NUMBER_MAX))
        return ply_fail(file, error, "a number is not finite or out of range");
    return true;
}

/* Reads the number of items of a list, for which enough bytes have to be left. */
static bool take_count(struct ply_file *file, const struct ply_property *property,
                       int64_t *count, struct error *error)
{
    double value;
    if (!take(file, (enum ply_type)property->count_type, &value, error))
        return false;
    if (!(value >= 0.0) || value != floor(value))
        return ply_fail(file, error, "the length of a list is not a natural number");
    double size = file->ascii ? 1.0 : (double)TYPES[property->type].size;
    if (value * size > (double)file->binary.size)
        return file->ascii ? ply_fail(file, error, "fewer values than the header says")
                           : fail_short(file, error);
    *count = (int64_t)value;
    return true;
}

static bool take_corners(struct ply_file *file, const struct ply_property *property,
                         struct error *error)
{
    int64_t count;
    double least = property->field == PLY_STRIP ? -1.0 : 0.0;
    if (!take_count(file, property, &count, error))
        return false;
    for (file->corner_count = 0; file->corner_count < count; file->corner_count++) {
        double value;
        if (!take(file, (enum ply_type)property->type, &value, error))
            return false;
        if (!(value >= least && value <= INT32_MAX) || value != floor(value))
            return ply_fail(file, error, "a corner is not the number of a vertex");
        RESERVE(file->corners, &file->corner_capacity, file->corner_count + 1);
        file->corners[file->corner_count] = (int32_t)value;
    }
    return true;
}

static bool pass_list(struct ply_file *file, const struct ply_property *property,
                      struct error *error)
{
    int64_t count;
    if (!take_count(file, property, &count, error))
        return false;
    int64_t size = count * TYPES[property->type].size;
    for (int64_t i = 0; i < count && file->ascii; i++)
        if (!take(file, (enum ply_type)property->type, NULL, error))
            return false;
    if (!file->ascii && size > binary_left(&file->binary))
        return fail_short(file, error);
    file->binary.position += file->ascii ? 0 : size;
    return true;
}

static bool take_property(struct ply_file *file, const struct ply_property *property,
                          struct error *error)
{
    if (property->field >= PLY_CORNERS && property->field < PLY_FIELDS)
        return take_corners(file, property, error);
    if (property->count_type != PLY_NONE)
        return pass_list(file, property, error);
    double *value = property->field < PLY_FIELDS ? &file->value[property->field] : NULL;
    return take(file, (enum ply_type)property->type, value, error);
}

/* Moves to the next line that is not blank. */
static bool find_record(struct ply_file *file, struct error *error)
{
    do {
        file->rest = next_line(file);
        if (!file->rest)
            return fail_short(file, error);
        file->rest = text_trim(file->rest);
    } while (*file->rest == '\0');
    return true;
}

bool ply_file_record(struct ply_file *file, const struct ply_element *element,
                     int64_t record, struct error *error)
{
    file->record = record;
    file->record_name = KIND_NAMES[element->kind];
    if (!stop_check(error) || (file->ascii && !find_record(file, error)))
        return false;
    for (int64_t i = 0; i < element->property_count; i++)
        if (!take_property(file, &file->header.properties[element->property + i], error))
            return false;
    if (file->ascii && *text_trim(file->rest) && file->long_lines++ == 0)
        file->first_long = file->line;
    return true;
}

bool ply_file_skip(struct ply_file *file, const struct ply_element *element,
                   struct error *error)
{
    if (element->property_count == 0)
        return true;
    if (!file->ascii && !element->has_list) {
        file->record_name = KIND_NAMES[element->kind];
        file->record = binary_left(&file->binary) / element->record_size;
        if (element->count > file->record)
            return fail_short(file, error);
        file->binary.position += element->count * element->record_size;
        return true;
    }
    for (int64_t record = 0; record < element->count; record++)
        if (!ply_file_record(file, element, record, error))
            return false;
    return true;
}

bool ply_file_end(const struct ply_file *file, struct error *error)
{
    if (!binary_is_over(&file->binary))
        return error_set(error, EXIT_USAGE,
                         "%s: %lld bytes are left behind the last element",
                         file->binary.path, (long long)binary_left(&file->binary));
    return true;
}
