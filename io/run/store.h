/* Stored snapshots: the files of --save-links and --load-links, --checkpoint and
 * --resume.
 *
 * Link caches and checkpoints hold a snapshot (rad/beyond/snapshot.h) and its links. A
 * link cache is taken before the first pass, has the links of all pairs of roots, and is
 * bound to fewer settings. Numbers are little-endian, integers in two's complement,
 * others IEEE 754. With R roots, N patches, L leaves, M links and T bytes of settings:
 *
 *     bytes    content
 *     8        "PHRLINK5" a link cache, "PHRCHKP5" a checkpoint; the digit is the version
 *     8        scene_hash()
 *     4  4     T  R
 *     8  8     N  M
 *     T        settings: lines "--option value", each with its newline
 *     8 x 11   snapshot.number
 *     8 x 6    snapshot.value
 *     N        snapshot.split, a byte each
 *     24 L     leaves: radiosity (3 doubles)
 *     24 M     links: p q (4 bytes each; below 0: clusters), area (float), blocker (4),
 *              parts_p parts_q (3 each), seen, cost (1 each); ascending by p, then q
 *     8        hash_bytes() of all bytes before
 *
 * The bytes do not depend on the number of ranks; a state has exactly one encoding. */
#ifndef IO_RUN_STORE_H
#define IO_RUN_STORE_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "geom/error.h"
#include "io/run/output.h"
#include "rad/beyond/snapshot.h"

enum store_kind { STORE_LINKS, STORE_CHECKPOINT };

/* Kind, settings and scene of a file. */
struct store_terms {
    enum store_kind kind;
    const char *settings;            /* as in the file; borrowed */
    const struct scene *scene;       /* prepared; borrowed */
    const struct cluster_tree *tree; /* borrowed; NULL: links join patches alone */
};

struct store_writer {
    struct output output;
    uint64_t hash; /* of the bytes written so far */
};

/* Opens the file and writes the part before the links. Errors: "PATH: cannot write:
 * REASON", EXIT_FAILED. */
bool store_create(struct store_writer *writer, const char *path,
                  const struct store_terms *terms, const struct snapshot *snapshot,
                  struct error *error);

/* Writes the next links. Errors are reported by store_finish(). */
void store_put_links(struct store_writer *writer, const struct link *links,
                     int64_t count);

/* Ends the file and puts it in its place. On error the old file stays. */
bool store_finish(struct store_writer *writer, struct error *error);

struct store_reader {
    FILE *file;
    const char *path;         /* borrowed */
    struct snapshot snapshot; /* checked; owned */
    int64_t links_left;       /* links not yet read */
    struct link_check check;
};

/* Opens a file, checks that the file is whole and bound to these terms, and reads the
 * part before the links.
 * Errors, EXIT_USAGE: "PATH: cannot read: REASON", "PATH: not a link cache", "PATH:
 * damaged ...", "PATH: made with OPTION, this run has OPTION", "PATH: made from another
 * scene". To be released with store_close(), also after an error. */
bool store_open(struct store_reader *reader, const char *path,
                const struct store_terms *terms, struct error *error);

/* Does the same with an open file; `name` is for messages. */
bool store_open_file(struct store_reader *reader, FILE *file, const char *name,
                     const struct store_terms *terms, struct error *error);

/* Reads the next links, at most `count`. Returns their number, 0 after the last one or an
 * error. */
int64_t store_get_links(struct store_reader *reader, struct link *links, int64_t count,
                        struct error *error);
void store_close(struct store_reader *reader);

#endif
