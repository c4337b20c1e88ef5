/* Packets: first hits of up to 64 rays from one point, such as those of a few pixels.
 *
 * A packet goes down the tree as a whole. Eight boxes at once are tested with the
 * earliest entry and the latest exit possible for any of the rays (interval arithmetic),
 * so a node costs the tests of two rays for all 64. Rays whose directions have the same
 * signs meet the children in one order, and boxes behind the hits of all rays are passed
 * over.
 *
 * A triangle and the eye span a cone. Three linear forms of a ray's direction d say
 * whether the ray is inside: ((a - eye) x (b - eye)) . d for each edge ab. A fourth is
 * one over the length of the ray up to the triangle's plane, -n . d / (n . eye - offset).
 * The forms are made in double, once for all rays. A ray then takes four sums of three
 * products in float, and no division. Each form has a margin for its rounding:
 * coefficients, directions, products and sums are off by 2^-24 each, together by 5 x
 * 2^-24 of the sum of the coefficients' sizes.
 *
 * Float decides where a ray is inside of the cone by more than the margin, and nearer
 * than all others by more than theirs; a third triangle in front of two settles which of
 * those is nearer. Rays in doubt, about one in a thousand, and packets whose directions
 * differ in sign, go down one by one (octree/hit.c). The point on the triangle is
 * computed in double, as there. So the answers are the same to the bit, and do not depend
 * on which rays form a packet. */
#include "octree/octree.h"
#include "octree/ray.h"

enum { GROUPS = PACKET_RAYS / LANES };

/* In place of a triangle's number. */
enum { NONE = -1, DOUBT = -2 };

static const float MARGIN = 1e-6f;      /* of a form, of the sum of its coefficients */
static const double EDGE_LEAST = 1e-7;  /* of a form for an edge: double rounds below */
static const double PLANE_LEAST = 1e-6; /* distance of the eye that makes no doubt */
static const double EYE_FAR = 3.0;      /* from the scene: BOX_MARGIN is too little */

/* Lengths are those along rays, in scene units; nearness is one over a length. */
struct packet {
    const struct octree *octree;
    struct vec3 eye;
    bool fronts_only;
    lanes direction[GROUPS][3];   /* of length 1 */
    lanes low[GROUPS];            /* least possible nearness of the hit so far */
    lanes high[GROUPS];           /* most possible nearness of a triangle so far */
    lanes_mask triangle[GROUPS];  /* the hit so far; NONE or DOUBT */
    float least[3], most[3];      /* of the directions */
    lanes start[3];               /* the eye */
    lanes slow[3], fast[3];       /* least and largest |1 / direction|, with its sign */
    lanes_mask weights;           /* of the children: bit k for octant k ^ near */
    int near;                     /* the nearest octant, as in struct ray */
    float farthest;               /* the least of `low` */
    float reach;                  /* length up to which boxes are of use */
};

/* --- boxes --- */

/* Children whose boxes any ray may meet within its reach. */
INLINE unsigned packet_enters(const void *beam, const struct node *node,
                              float enter[LANES])
{
    const struct packet *packet = beam;
    lanes first = lanes_all(0.0f), last = lanes_all(packet->reach);
    for (int axis = 0; axis < 3; axis++) {
        int side = packet->near >> axis & 1;
        lanes slow = packet->slow[axis], fast = packet->fast[axis];
        lanes n = lanes_sub(lanes_at(node->bound[axis][side]), packet->start[axis]);
        lanes f = lanes_sub(lanes_at(node->bound[axis][side ^ 1]), packet->start[axis]);
        lanes n0 = lanes_mul(n, slow), n1 = lanes_mul(n, fast);
        lanes f0 = lanes_mul(f, slow), f1 = lanes_mul(f, fast);
        n0 = lanes_min(n0, n1);
        f0 = lanes_max(f0, f1);
        first = lanes_max(first, n0);
        last = lanes_min(last, f0);
    }
    lanes_mask in = lanes_upto(first, last);
    memcpy(enter, &first, LANES * sizeof *enter); /* the walk has a reach */
    return mask_select(&in, &packet->weights);
}

/* --- triangles --- */

/* A triangle seen from the eye, as linear forms of a direction. */
struct cone {
    float edge[3][3];   /* inside, all are positive */
    float nearness[3];
    float margin;       /* of the nearness */
};

static void set_form(float form[3], struct vec3 x, double scale)
{
    form[0] = (float)(x.x * scale);
    form[1] = (float)(x.y * scale);
    form[2] = (float)(x.z * scale);
}

static double size_of(struct vec3 x)
{
    return fabs(x.x) + fabs(x.y) + fabs(x.z);
}

/* Pre: `distance` is from the eye to the plane. */
static void set_cone(struct cone *cone, const struct packet *packet,
                     const struct record *r, double distance)
{
    const struct vec3 *corner = packet->octree->triangles[r->triangle].corner;
    double side = distance > 0.0 ? -1.0 : 1.0;
    struct vec3 arm[3];
    for (int k = 0; k < 3; k++)
        arm[k] = vec3_sub(corner[k], packet->eye);
    for (int k = 0; k < 3; k++) {
        struct vec3 across = vec3_cross(arm[k], arm[(k + 1) % 3]);
        set_form(cone->edge[k], across, side / real_max(size_of(across), EDGE_LEAST));
    }
    bool is_near = fabs(distance) < PLANE_LEAST;
    double scale = is_near ? 0.0 : -1.0 / distance;
    set_form(cone->nearness, r->plane.normal, scale);
    cone->margin =
        is_near ? HUGE_VALF : MARGIN * (float)(size_of(r->plane.normal) * fabs(scale));
}

/* The largest value of a form for directions of the packet. */
static float form_most(const float form[3], const struct packet *packet)
{
    float sum = 0.0f;
    for (int axis = 0; axis < 3; axis++) {
        float a = form[axis] * packet->least[axis], b = form[axis] * packet->most[axis];
        sum += a > b ? a : b;
    }
    return sum;
}

/* True if every ray passes by the triangle, or meets it behind its hit. */
static bool is_beside(const struct cone *cone, const struct packet *packet)
{
    for (int k = 0; k < 3; k++)
        if (form_most(cone->edge[k], packet) < -MARGIN)
            return true;
    return form_most(cone->nearness, packet) + cone->margin < packet->farthest;
}

/* A form of eight directions. */
#define FORM(f, d)                                                                  \
    lanes_add(lanes_add(lanes_mul(lanes_all((f)[0]), (d)[0]),                       \
                        lanes_mul(lanes_all((f)[1]), (d)[1])),                      \
              lanes_mul(lanes_all((f)[2]), (d)[2]))

/* Tests a triangle against all rays. */
static void improve_hits(struct packet *packet, const struct cone *cone, int32_t triangle)
{
    lanes margin = lanes_all(cone->margin), inside = lanes_all(MARGIN),
          outside = lanes_all(-MARGIN);
    lanes_mask number = mask_all(triangle), doubt = mask_all(DOUBT);
    for (int g = 0; g < GROUPS; g++) {
        const lanes *d = packet->direction[g];
        lanes e0 = FORM(cone->edge[0], d), e1 = FORM(cone->edge[1], d);
        lanes e2 = FORM(cone->edge[2], d), e01 = lanes_min(e0, e1);
        lanes edge = lanes_min(e01, e2), nearness = FORM(cone->nearness, d);
        lanes low = lanes_sub(nearness, margin), high = lanes_add(nearness, margin);
        lanes_mask out = mask_or(lanes_above(outside, edge),
                                 lanes_above(packet->low[g], high));
        if (mask_is_full(&out))
            continue;
        lanes_mask unsure = mask_or(out, lanes_above(inside, edge));
        lanes_mask undecided = mask_or(unsure, lanes_above(packet->high[g], low));
        lanes more = lanes_unless(unsure, low), most = lanes_unless(out, high);
        packet->low[g] = lanes_max(packet->low[g], more);
        packet->high[g] = lanes_max(packet->high[g], most);
        lanes_mask found = mask_choose(undecided, doubt, number);
        packet->triangle[g] = mask_choose(out, packet->triangle[g], found);
    }
}

/* Passes over all boxes behind the hit of every ray. */
static void shorten_reach(struct packet *packet)
{
    float low[LANES];
    lanes least = packet->low[0];
    for (int g = 1; g < GROUPS; g++)
        least = lanes_min(least, packet->low[g]);
    memcpy(low, &least, sizeof low);
    for (int k = 1; k < LANES; k++)
        low[0] = low[k] < low[0] ? low[k] : low[0];
    packet->farthest = low[0];
    packet->reach = low[0] > 0.0f ? (1.0f + MARGIN) / low[0] : HUGE_VALF;
}

/* Visits a leaf, for tree_walk(). */
INLINE bool search_leaf(void *at, const struct record *records, int32_t count,
                        struct octree_counts *counts)
{
    struct packet *packet = at;
    counts->triangle_tests += count;
    for (int32_t i = 0; i < count; i++) {
        struct cone cone;
        double distance = plane_distance(&records[i].plane, packet->eye);
        if (packet->fronts_only && distance < -PLANE_LEAST)
            continue;
        set_cone(&cone, packet, &records[i], distance);
        if (!is_beside(&cone, packet))
            improve_hits(packet, &cone, records[i].triangle);
    }
    shorten_reach(packet);
    return false;
}

/* --- the packet --- */

/* Sets the numbers for boxes. Returns false if the rays' signs differ. */
static bool set_bounds(struct packet *packet, float direction[3][PACKET_RAYS])
{
    packet->near = 0;
    for (int axis = 0; axis < 3; axis++) {
        const float *d = direction[axis];
        float least = d[0], most = d[0];
        for (int i = 1; i < PACKET_RAYS; i++) {
            least = d[i] < least ? d[i] : least;
            most = d[i] > most ? d[i] : most;
        }
        if (!(least > STEP_LEAST || most < -STEP_LEAST))
            return false;
        packet->least[axis] = least;
        packet->most[axis] = most;
        packet->near |= (most < 0.0f) << axis;
        packet->slow[axis] = lanes_all(1.0f / (most < 0.0f ? least : most));
        packet->fast[axis] = lanes_all(1.0f / (most < 0.0f ? most : least));
        packet->start[axis] = lanes_all((float)vec3_axis(packet->eye, axis));
    }
    mask_set_weights(&packet->weights, packet->near);
    return true;
}

/* Sets the rays; the last one fills the places left over. Returns false if the rays go
 * down one by one. */
static bool set_packet(struct packet *packet, const struct vec3 *directions, int count)
{
    float direction[3][PACKET_RAYS];
    if (vec3_length(vec3_sub(packet->eye, packet->octree->middle)) > EYE_FAR)
        return false;
    for (int i = 0; i < PACKET_RAYS; i++) {
        struct vec3 d = directions[i < count ? i : count - 1];
        d = vec3_unit(d);
        direction[0][i] = (float)d.x;
        direction[1][i] = (float)d.y;
        direction[2][i] = (float)d.z;
    }
    for (int g = 0; g < GROUPS; g++) {
        for (int axis = 0; axis < 3; axis++)
            packet->direction[g][axis] = lanes_at(&direction[axis][g * LANES]);
        packet->low[g] = packet->high[g] = lanes_all(0.0f);
        packet->triangle[g] = mask_all(NONE);
    }
    packet->farthest = 0.0f;
    packet->reach = HUGE_VALF;
    return set_bounds(packet, direction);
}

void octree_first_hits(const struct octree *octree, struct vec3 origin,
                       const struct vec3 *directions, int count, bool fronts_only,
                       struct octree_hit *hits, struct octree_counts *counts)
{
    struct packet packet; /* set by parts, since large */
    int32_t triangles[PACKET_RAYS];
    packet.octree = octree;
    packet.eye = origin;
    packet.fronts_only = fronts_only;
    bool together = set_packet(&packet, directions, count);
    if (together) {
        tree_walk(&octree->inside, packet_enters, &packet, packet.near, &packet.reach,
                  search_leaf, &packet, counts);
        tree_walk(&octree->hull, packet_enters, &packet, packet.near, &packet.reach,
                  search_leaf, &packet, counts);
        memcpy(triangles, packet.triangle, sizeof triangles);
    }
    for (int i = 0; i < count; i++)
        if (!together || triangles[i] == DOUBT) {
            octree_first_hit(octree, origin, directions[i], fronts_only, &hits[i],
                             counts);
        } else {
            counts->rays++;
            hits[i].triangle = triangles[i];
            hits[i].front = triangles[i] != NONE &&
                            plane_distance(&octree->planes[triangles[i]], origin) > 0.0;
        }
    for (int i = 0; i < count; i++)
        if (hits[i].triangle >= 0)
            octree_hit_weights(octree, origin, directions[i], &hits[i]);
}
