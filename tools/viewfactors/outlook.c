/* The hidden part is a cone with its top at the point. A piece is cut along the planes of
 * the cone, one by one: the part outside of a plane is seen, the part inside goes on to
 * the next plane; the part inside of all three is hidden. */
#include "tools/viewfactors/outlook.h"

void outlook_start(struct outlook *outlook, struct vec3 from, const struct triangle *t)
{
    outlook->from = from;
    outlook->count = 1;
    outlook->piece[0].count = 3;
    for (int k = 0; k < 3; k++)
        outlook->piece[0].corner[k] = t->corner[k];
}

/* Height over a plane through the point; 0 within rounding, which would leave slivers
 * along each common side of two triangles. */
static double rise_over(struct vec3 normal, struct vec3 from, struct vec3 corner)
{
    static const double ROUNDING = 1e-13; /* scene units */
    double rise = vec3_dot(vec3_sub(corner, from), normal);
    return rise > ROUNDING || rise < -ROUNDING ? rise : 0.0;
}

/* Cuts a piece along a plane through the point: the parts above and below the plane,
 * without corners where there is none. */
static void split_piece(const struct outlook_piece *piece, struct vec3 from,
                        struct vec3 normal, struct outlook_piece *above,
                        struct outlook_piece *below)
{
    double rise[OUTLOOK_CORNERS];
    bool some_above = false, some_below = false;
    for (int k = 0; k < piece->count; k++) {
        rise[k] = rise_over(normal, from, piece->corner[k]);
        some_above = some_above || rise[k] > 0.0;
        some_below = some_below || rise[k] < 0.0;
    }
    above->count = below->count = 0;
    for (int k = 0; k < piece->count; k++) {
        int next = (k + 1) % piece->count;
        struct vec3 a = piece->corner[k], b = piece->corner[next];
        if (some_above && rise[k] >= 0.0)
            above->corner[above->count++] = a;
        if (some_below && rise[k] <= 0.0)
            below->corner[below->count++] = a;
        if ((rise[k] > 0.0 && rise[next] < 0.0) || (rise[k] < 0.0 && rise[next] > 0.0))
            above->corner[above->count++] = below->corner[below->count++] =
                vec3_add(a, vec3_scale(vec3_sub(b, a), rise[k] / (rise[k] - rise[next])));
    }
}

/* True if a piece lies outside of one of the planes: no part is hidden. */
static bool is_outside(const struct outlook_piece *piece, struct vec3 from,
                       const struct vec3 normal[3])
{
    for (int k = 0; k < 3; k++) {
        bool outside = true;
        for (int i = 0; i < piece->count && outside; i++)
            outside = rise_over(normal[k], from, piece->corner[i]) <= 0.0;
        if (outside)
            return true;
    }
    return false;
}

/* Cuts a piece; the last one takes its place, its visible pieces come to the end. */
static void cut_piece(struct outlook *outlook, int i, const struct vec3 normal[3])
{
    struct outlook_piece inside[2];
    inside[0] = outlook->piece[i];
    outlook->piece[i] = outlook->piece[--outlook->count];
    for (int k = 0; k < 3 && inside[k % 2].count > 0; k++) {
        struct outlook_piece *outside = &outlook->piece[outlook->count];
        split_piece(&inside[k % 2], outlook->from, normal[k], &inside[(k + 1) % 2],
                    outside);
        outlook->count += outside->count > 0;
    }
}

bool outlook_hide(struct outlook *outlook, const struct triangle *behind)
{
    bool whole = true;
    struct vec3 to[3], normal[3];
    for (int k = 0; k < 3; k++)
        to[k] = vec3_sub(behind->corner[k], outlook->from);
    double volume = vec3_dot(to[0], vec3_cross(to[1], to[2]));
    if (volume == 0.0)
        return true;
    for (int k = 0; k < 3; k++) {
        struct vec3 across = vec3_cross(to[k], to[(k + 1) % 3]);
        double length = vec3_length(across);
        normal[k] = vec3_scale(across, (volume > 0.0 ? 1.0 : -1.0) / length);
    }
    for (int i = outlook->count - 1; i >= 0; i--) {
        const struct outlook_piece *piece = &outlook->piece[i];
        if (is_outside(piece, outlook->from, normal))
            continue;
        if (outlook->count + 2 <= OUTLOOK_PIECES && piece->count + 3 <= OUTLOOK_CORNERS)
            cut_piece(outlook, i, normal);
        else
            whole = false;
    }
    return whole;
}
