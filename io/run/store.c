/* Stored snapshots; the format is in io/run/store.h.
 *
 * Reading first checks the counts against the size of the file, so allocations stay
 * within a small multiple of this size; then the checksum, the settings and the scene;
 * then every number (rad/beyond/snapshot.c). The file is read twice: the links, by far
 * its largest part, need not fit into the memory of rank 0.
 *
 * The checksum finds accidents, not attacks. Rejected: a CRC for each section, which
 * finds no more and takes a table; text, which is four times as long. */
#include "io/run/store.h"

#include <errno.h>
#include <string.h>

#include "geom/hash.h"
#include "geom/little.h"
#include "geom/stop.h"

enum { MAGIC_BYTES = 8, HEADER_BYTES = 40, LEAF_BYTES = 24, LINK_BYTES = 24,
       CHUNK = 4096, SETTINGS_MAX = 4096 };

static const char *const MAGIC[] = {"PHRLINK5", "PHRCHKP5"};
static const char *const NAMES[] = {"link cache", "checkpoint"};

/* --- writing --- */

static void put(struct store_writer *writer, const void *bytes, size_t count)
{
    writer->hash = hash_bytes(writer->hash, bytes, count);
    fwrite(bytes, 1, count, writer->output.file);
}

static void put32(struct store_writer *writer, uint32_t value)
{
    uint8_t bytes[4];
    little_put32(bytes, value);
    put(writer, bytes, sizeof bytes);
}

static void put64(struct store_writer *writer, int64_t value)
{
    uint8_t bytes[8];
    little_put64(bytes, (uint64_t)value);
    put(writer, bytes, sizeof bytes);
}

static void put_double(struct store_writer *writer, double value)
{
    uint8_t bytes[8];
    little_put_double(bytes, value);
    put(writer, bytes, sizeof bytes);
}

static void put_snapshot(struct store_writer *writer, const struct snapshot *snapshot)
{
    for (int i = 0; i < SNAPSHOT_NUMBERS; i++)
        put64(writer, snapshot->number[i]);
    for (int i = 0; i < SNAPSHOT_VALUES; i++)
        put_double(writer, snapshot->value[i]);
    put(writer, snapshot->split, (size_t)snapshot->patch_count);
    for (int64_t i = 0; i < snapshot_leaf_count(snapshot); i++)
        for (int c = 0; c < BANDS; c++)
            put_double(writer, snapshot->leaves[i].band[c]);
}

bool store_create(struct store_writer *writer, const char *path,
                  const struct store_terms *terms, const struct snapshot *snapshot,
                  struct error *error)
{
    *writer = (struct store_writer){.hash = HASH_START};
    if (!output_open(&writer->output, path, error))
        return false;
    put(writer, MAGIC[terms->kind], MAGIC_BYTES);
    put64(writer, (int64_t)scene_hash(terms->scene));
    put32(writer, (uint32_t)strlen(terms->settings));
    put32(writer, (uint32_t)snapshot->root_count);
    put64(writer, snapshot->patch_count);
    put64(writer, snapshot->link_count);
    put(writer, terms->settings, strlen(terms->settings));
    put_snapshot(writer, snapshot);
    return true;
}

void store_put_links(struct store_writer *writer, const struct link *links, int64_t count)
{
    for (int64_t i = 0; i < count; i++) {
        const struct link *link = &links[i];
        uint8_t bytes[LINK_BYTES];
        little_put32(bytes, (uint32_t)link->p);
        little_put32(bytes + 4, (uint32_t)link->q);
        little_put_float(bytes + 8, link->area);
        little_put32(bytes + 12, (uint32_t)link->blocker);
        memcpy(bytes + 16, link->parts_p, 3);
        memcpy(bytes + 19, link->parts_q, 3);
        bytes[22] = link->seen;
        bytes[23] = link->cost;
        put(writer, bytes, sizeof bytes);
    }
}

bool store_finish(struct store_writer *writer, struct error *error)
{
    if (!writer->output.file)
        return false;
    put64(writer, (int64_t)writer->hash);
    return output_close(&writer->output, error);
}

/* --- reading --- */

/* Hash of the scene and counts, as in the header of a file. */
struct header {
    uint64_t scene;
    int64_t settings, roots, patches, links;
};

static bool damaged(const struct store_reader *reader, const char *how,
                    struct error *error)
{
    return error_set(error, EXIT_USAGE, "%s: damaged: %s", reader->path, how);
}

/* Reports a system's error, or the end of a shortened file. */
static bool unreadable(const struct store_reader *reader, struct error *error)
{
    return error_set(error, EXIT_USAGE, "%s: cannot read: %s", reader->path,
                     ferror(reader->file) && errno ? strerror(errno)
                                                   : "the file ends too early");
}

static bool get(struct store_reader *reader, void *bytes, size_t count,
                struct error *error)
{
    errno = 0;
    return stop_check(error) &&
           (fread(bytes, 1, count, reader->file) == count || unreadable(reader, error));
}

/* Checks the kind and the version, which are the first bytes. */
static bool check_magic(const struct store_reader *reader, const uint8_t *magic,
                        enum store_kind kind, struct error *error)
{
    enum store_kind other = kind == STORE_LINKS ? STORE_CHECKPOINT : STORE_LINKS;
    if (memcmp(magic, MAGIC[kind], MAGIC_BYTES) == 0)
        return true;
    if (memcmp(magic, MAGIC[other], MAGIC_BYTES - 1) == 0)
        return error_set(error, EXIT_USAGE, "%s: not a %s but a %s", reader->path,
                         NAMES[kind], NAMES[other]);
    if (memcmp(magic, MAGIC[kind], MAGIC_BYTES - 1) == 0)
        return error_set(error, EXIT_USAGE,
                         "%s: a %s of version %c, and this program knows %c",
                         reader->path, NAMES[kind], magic[MAGIC_BYTES - 1],
                         MAGIC[kind][MAGIC_BYTES - 1]);
    return error_set(error, EXIT_USAGE, "%s: not a %s", reader->path, NAMES[kind]);
}

/* True if the counts are in their ranges and make a file of `size` bytes. */
static bool counts_fit(const struct header *h, int64_t size)
{
    if (h->settings > SETTINGS_MAX || h->settings > size || h->roots > size ||
        h->patches < h->roots || h->patches > size || h->patches > INT32_MAX ||
        (h->patches - h->roots) % 4 != 0 || h->links < 0 || h->links > size / LINK_BYTES)
        return false;
    struct snapshot counts = {.root_count = h->roots, .patch_count = h->patches};
    return size == HEADER_BYTES + h->settings + 8 * (SNAPSHOT_NUMBERS + SNAPSHOT_VALUES) +
                       h->patches + LEAF_BYTES * snapshot_leaf_count(&counts) +
                       LINK_BYTES * h->links + 8;
}

static bool read_header(struct store_reader *reader, enum store_kind kind,
                        struct header *header, int64_t *size, struct error *error)
{
    uint8_t bytes[HEADER_BYTES];
    if (!get(reader, bytes, MAGIC_BYTES, error) ||
        !check_magic(reader, bytes, kind, error) ||
        !get(reader, bytes + MAGIC_BYTES, HEADER_BYTES - MAGIC_BYTES, error))
        return false;
    *header = (struct header){
        .scene = little_get64(bytes + 8),
        .settings = little_get32(bytes + 16),
        .roots = little_get32(bytes + 20),
        .patches = (int64_t)little_get64(bytes + 24),
        .links = (int64_t)little_get64(bytes + 32),
    };
    errno = 0;
    *size = fseek(reader->file, 0, SEEK_END) == 0 ? ftell(reader->file) : -1;
    if (*size < 0)
        return error_set(error, EXIT_USAGE, "%s: cannot read: %s", reader->path,
                         strerror(errno));
    return counts_fit(header, *size) ||
           damaged(reader, "its size is not what its counts say", error);
}

/* Reads the whole file and compares its hash with the one at its end. */
static bool check_hash(struct store_reader *reader, int64_t size, struct error *error)
{
    uint8_t chunk[CHUNK];
    uint64_t hash = HASH_START;
    if (fseek(reader->file, 0, SEEK_SET) != 0)
        return unreadable(reader, error);
    for (int64_t left = size - 8; left > 0;) {
        size_t now = left < CHUNK ? (size_t)left : CHUNK;
        if (!get(reader, chunk, now, error))
            return false;
        hash = hash_bytes(hash, chunk, now);
        left -= (int64_t)now;
    }
    if (!get(reader, chunk, 8, error))
        return false;
    return hash == little_get64(chunk) || damaged(reader, "its checksum is wrong", error);
}

/* Names the last setting in which the runs differ: a setting stands behind others whose
 * defaults it sets. But a setting of only one of the runs is named if no other
 * differs. */
static bool check_settings(struct store_reader *reader, int64_t bytes, const char *wanted,
                           struct error *error)
{
    char made[SETTINGS_MAX + 1];
    if (!get(reader, made, (size_t)bytes, error))
        return false;
    made[bytes] = '\0';
    const char *differs = NULL, *from = NULL;
    for (const char *a = made, *b = wanted; *a || *b;) {
        size_t length_a = strcspn(a, "\n"), length_b = strcspn(b, "\n");
        bool same = length_a == length_b && strncmp(a, b, length_a) == 0;
        if (!same && (!differs || (*a && *b))) {
            differs = a;
            from = b;
        }
        a += length_a + (a[length_a] != '\0');
        b += length_b + (b[length_b] != '\0');
    }
    if (!differs)
        return true;
    int shown = (int)strcspn(differs, "\n");
    return error_set(error, EXIT_USAGE, "%s: made with %.*s, this run has %.*s",
                     reader->path, shown < 80 ? shown : 80, differs,
                     (int)strcspn(from, "\n"), from);
}

static bool get64(struct store_reader *reader, int64_t *value, struct error *error)
{
    uint8_t bytes[8];
    if (!get(reader, bytes, sizeof bytes, error))
        return false;
    *value = (int64_t)little_get64(bytes);
    return true;
}

static bool get_doubles(struct store_reader *reader, double *values, int count,
                        struct error *error)
{
    uint8_t bytes[LEAF_BYTES];
    if (!get(reader, bytes, 8 * (size_t)count, error))
        return false;
    for (int i = 0; i < count; i++)
        values[i] = little_get_double(bytes + 8 * i);
    return true;
}

static bool get_snapshot(struct store_reader *reader, struct error *error)
{
    struct snapshot *snapshot = &reader->snapshot;
    bool good = true;
    for (int i = 0; i < SNAPSHOT_NUMBERS && good; i++)
        good = get64(reader, &snapshot->number[i], error);
    for (int i = 0; i < SNAPSHOT_VALUES && good; i++)
        good = get_doubles(reader, &snapshot->value[i], 1, error);
    good = good && get(reader, snapshot->split, (size_t)snapshot->patch_count, error);
    for (int64_t i = 0; i < snapshot_leaf_count(snapshot) && good; i++)
        good = get_doubles(reader, snapshot->leaves[i].band, BANDS, error);
    return good;
}

static bool check_snapshot(const struct store_reader *reader, enum store_kind kind,
                           struct error *error)
{
    struct error wrong = {0};
    const struct snapshot *snapshot = &reader->snapshot;
    if (!snapshot_check(snapshot, &wrong))
        return damaged(reader, wrong.text, error);
    if (kind == STORE_LINKS && (snapshot->patch_count != snapshot->root_count ||
                                snapshot->number[SNAPSHOT_PASSES] != 0))
        return damaged(reader, "its links are not initial ones", error);
    return true;
}

bool store_open_file(struct store_reader *reader, FILE *file, const char *name,
                     const struct store_terms *terms, struct error *error)
{
    struct header header;
    int64_t size;
    *reader = (struct store_reader){.file = file, .path = name};
    if (!read_header(reader, terms->kind, &header, &size, error) ||
        !check_hash(reader, size, error))
        return false;
    if (fseek(file, HEADER_BYTES, SEEK_SET) != 0)
        return unreadable(reader, error);
    if (!check_settings(reader, header.settings, terms->settings, error))
        return false;
    if (header.scene != scene_hash(terms->scene) ||
        header.roots != scene_root_count(terms->scene))
        return error_set(error, EXIT_USAGE, "%s: made from another scene", name);
    reader->snapshot.root_count = header.roots;
    reader->snapshot.patch_count = header.patches;
    reader->snapshot.link_count = reader->links_left = header.links;
    snapshot_allocate(&reader->snapshot);
    if (!get_snapshot(reader, error) || !check_snapshot(reader, terms->kind, error))
        return false;
    reader->check = link_check_start(&reader->snapshot, terms->scene, terms->tree);
    return true;
}

bool store_open(struct store_reader *reader, const char *path,
                const struct store_terms *terms, struct error *error)
{
    *reader = (struct store_reader){.path = path};
    FILE *file = fopen(path, "rb");
    if (!file)
        return error_set(error, EXIT_USAGE, "%s: cannot read: %s", path, strerror(errno));
    return store_open_file(reader, file, path, terms, error);
}

int64_t store_get_links(struct store_reader *reader, struct link *links, int64_t count,
                        struct error *error)
{
    int64_t now = count < reader->links_left ? count : reader->links_left;
    for (int64_t i = 0; i < now; i++) {
        uint8_t bytes[LINK_BYTES];
        struct link *link = &links[i];
        if (!get(reader, bytes, sizeof bytes, error))
            return 0;
        link->p = (int32_t)little_get32(bytes);
        link->q = (int32_t)little_get32(bytes + 4);
        link->area = little_get_float(bytes + 8);
        link->blocker = (int32_t)little_get32(bytes + 12);
        memcpy(link->parts_p, bytes + 16, 3);
        memcpy(link->parts_q, bytes + 19, 3);
        link->seen = bytes[22];
        link->cost = bytes[23];
        if (!link_check_next(&reader->check, link)) {
            damaged(reader, "a link in it cannot be", error);
            return 0;
        }
    }
    reader->links_left -= now;
    return now;
}

void store_close(struct store_reader *reader)
{
    if (reader->file)
        fclose(reader->file);
    snapshot_free(&reader->snapshot);
    link_check_free(&reader->check);
    *reader = (struct store_reader){0};
}
