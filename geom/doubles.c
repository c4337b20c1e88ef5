/* Finding faces lying exactly on each other.
 *
 * A face is known by the edges around it: its signature is a sum over its directed edges
 * of
 *
 *     m(p, q) - m(q, p)
 *
 * with m a hash of the coordinates of both ends. The sum does not depend on its first
 * corner, a face turned over has the negative, and an edge shared by two triangles
 * cancels out: the sum over the triangles of a polygon is the sum around the polygon,
 * whatever the diagonals of the cuts. Diagonals do differ: of a quad given twice, the
 * second time from another corner on or from behind, the second is cut along the other
 * diagonal.
 *
 * Signatures have 128 bits and are taken for the edges themselves: two of k different
 * faces have the same one with a chance of k^2 / 2^129, which is below the machine's own
 * chance to err. Signatures are looked up in a hash table (linear probing) in which a
 * face and its opposite share an entry. Most faces are alone and never enter the table: a
 * sieve of one bit for each remainder of a signature, which fits into a cache, tells of
 * no other face with theirs.
 *
 * Whole faces come first, then the triangles of the kept ones: a triangle may repeat one
 * half of a quad. Of two quads back to back the second is to have the diagonal of the
 * first. A polygon folded onto itself, whose edges cancel each other, has the signature
 * 0, like all others of this kind, and is looked up by its triangles alone.
 *
 * Rejected: sorting (three times as long for a million triangles); vertex numbers, for
 * programs write the same corner twice. */
#include "geom/doubles.h"

#include <string.h>

#include "geom/alloc.h"
#include "geom/hash.h"

enum {
    LANES = 2, /* of 64 bits, of a signature */
    SIEVE = 8  /* bits of the sieve for each entry of the table */
};

struct signature {
    uint64_t lane[LANES];
};

/* A face in the table: of a triangle, its number and 1; of several, minus the number of
 * the first and 1; 0: there is none. */
struct entry {
    struct signature signature; /* of the face on side 0 */
    int32_t face[2];            /* faces turned one way, and the other */
};

/* The faces known so far. */
struct catalogue {
    const struct faces *faces;
    struct signature *signatures; /* [faces->count] of the triangles */
    struct entry *entries;        /* [mask + 1], at least a quarter of them empty */
    uint64_t mask;
    uint8_t *seen[2]; /* the sieve: a bit for each remainder of signatures that was seen,
                       * and that was seen again */
    int32_t *opposite;
};

/* --- signatures --- */

static struct signature corner_hash(struct vec3 x)
{
    const double at[3] = {x.x + 0.0, x.y + 0.0, x.z + 0.0}; /* -0 becomes 0 */
    struct signature hash = {{1, 2}};
    for (int axis = 0; axis < 3; axis++) {
        uint64_t bits;
        memcpy(&bits, &at[axis], sizeof bits);
        for (int k = 0; k < LANES; k++)
            hash.lane[k] = hash_mix(hash.lane[k] ^ bits);
    }
    return hash;
}

static struct signature signature_of(const struct triangle *t)
{
    struct signature sum = {{0, 0}}, corner[3];
    for (int k = 0; k < 3; k++)
        corner[k] = corner_hash(t->corner[k]);
    for (int k = 0; k < LANES; k++)
        for (int edge = 0; edge < 3; edge++) {
            uint64_t p = corner[edge].lane[k], q = corner[(edge + 1) % 3].lane[k];
            sum.lane[k] += hash_mix(p + 3 * q) - hash_mix(q + 3 * p);
        }
    return sum;
}

/* Of the face turned the other way. */
static struct signature turned(struct signature s)
{
    return (struct signature){{-s.lane[0], -s.lane[1]}};
}

/* Of two opposite faces one is on side 0, one on side 1. */
static int side_of(const struct signature *s)
{
    return s->lane[0] >> 63 != 0;
}

/* --- faces --- */

int32_t face_end(const struct faces *faces, int32_t i)
{
    do
        i++;
    while (i < faces->count && faces->goes_on && faces->goes_on[i]);
    return i;
}

static struct signature signature_of_face(const struct catalogue *known, int32_t begin,
                                          int32_t end)
{
    struct signature sum = {{0, 0}};
    for (int32_t i = begin; i < end; i++)
        for (int k = 0; k < LANES; k++)
            sum.lane[k] += known->signatures[i].lane[k];
    return sum;
}

/* --- the sieve --- */

static uint64_t remainder_of(const struct catalogue *known, const struct signature *s)
{
    uint64_t size = side_of(s) ? -s->lane[0] : s->lane[0];
    return size & (SIEVE * (known->mask + 1) - 1);
}

static void sieve_add(struct catalogue *known, const struct signature *s)
{
    uint64_t at = remainder_of(known, s);
    unsigned bit = 1u << at % 8, before = known->seen[0][at / 8] & bit;
    known->seen[0][at / 8] = (uint8_t)(known->seen[0][at / 8] | bit);
    known->seen[1][at / 8] = (uint8_t)(known->seen[1][at / 8] | before);
}

/* True if another face may have the signature, or the opposite. */
static bool sieve_holds(const struct catalogue *known, const struct signature *s)
{
    uint64_t at = remainder_of(known, s);
    return (known->seen[1][at / 8] >> at % 8 & 1) != 0;
}

static void sieve_add_all(struct catalogue *known)
{
    const struct faces *faces = known->faces;
    for (int32_t i = 0; i < faces->count; i++)
        known->signatures[i] = signature_of(&faces->triangles[i]);
    for (int32_t begin = 0, end; begin < faces->count; begin = end) {
        end = face_end(faces, begin);
        struct signature whole = signature_of_face(known, begin, end);
        sieve_add(known, &whole);
        for (int32_t i = begin; i < end && end > begin + 1; i++)
            sieve_add(known, &known->signatures[i]);
    }
}

/* --- the table --- */

static int32_t number_of(int32_t face)
{
    return (face < 0 ? -face : face) - 1;
}

/* Pairs two faces lying back to back, triangle by triangle. */
static void pair(struct catalogue *known, int32_t face, int32_t other)
{
    int32_t i = number_of(face), j = number_of(other);
    int32_t count = face < 0 ? face_end(known->faces, i) - i : 1;
    if (count != (other < 0 ? face_end(known->faces, j) - j : 1))
        return;
    for (int32_t k = 0; k < count; k++) {
        known->opposite[i + k] = j + k;
        known->opposite[j + k] = i + k;
    }
}

/* Looks up a face, and enters a new one. Returns the number of the repeated face, or
 * -1. */
static int32_t look_up(struct catalogue *known, struct signature s, int32_t face)
{
    int side = side_of(&s);
    if (!sieve_holds(known, &s))
        return -1;
    s = side ? turned(s) : s;
    uint64_t at = s.lane[1] & known->mask;
    struct entry *entry = &known->entries[at];
    while ((entry->face[0] || entry->face[1]) &&
           memcmp(&entry->signature, &s, sizeof s) != 0) {
        at = (at + 1) & known->mask;
        entry = &known->entries[at];
    }
    if (entry->face[side])
        return number_of(entry->face[side]);
    entry->signature = s;
    entry->face[side] = face;
    if (entry->face[!side])
        pair(known, face, entry->face[!side]);
    return -1;
}

static int32_t look_up_polygon(struct catalogue *known, int32_t begin, int32_t end)
{
    struct signature whole = signature_of_face(known, begin, end);
    bool folded = whole.lane[0] == 0 && whole.lane[1] == 0;
    return folded ? -1 : look_up(known, whole, -(begin + 1));
}

/* Looks up a triangle; one of a polygon with an opposite, as the opposite is cut. */
static int32_t look_up_triangle(struct catalogue *known, int32_t i)
{
    int32_t cut = known->opposite[i] >= 0 ? known->opposite[i] : i;
    struct signature s = known->signatures[cut];
    if (!(known->faces->areas[cut] > 0.0))
        return -1;
    return look_up(known, cut == i ? s : turned(s), i + 1);
}

void doubles_find(const struct faces *faces, int32_t *first, int32_t *opposite)
{
    struct catalogue known = {.faces = faces, .mask = 1, .opposite = opposite};
    while (known.mask + 1 < 2 * (uint64_t)faces->count) /* with polygons 3/2 count */
        known.mask = 2 * known.mask + 1;
    size_t count = (size_t)known.mask + 1;
    known.entries = alloc_array(count, sizeof *known.entries);
    known.seen[0] = alloc_array(count, SIEVE / 8);
    known.seen[1] = alloc_array(count, SIEVE / 8);
    known.signatures = alloc_array((size_t)faces->count, sizeof *known.signatures);
    sieve_add_all(&known);
    for (int32_t i = 0; i < faces->count; i++)
        opposite[i] = -1;
    for (int32_t begin = 0, end; begin < faces->count; begin = end) {
        end = face_end(faces, begin);
        int32_t same = end > begin + 1 ? look_up_polygon(&known, begin, end) : -1;
        for (int32_t i = begin; i < end; i++) {
            int32_t earlier = same < 0 ? look_up_triangle(&known, i) : same;
            first[i] = earlier >= 0 ? earlier : i;
        }
    }
    alloc_free(known.signatures);
    alloc_free(known.seen[0]);
    alloc_free(known.seen[1]);
    alloc_free(known.entries);
}
