/* Things that stand on a leaf, and faces in its plane that cover it. */
#ifndef RAD_BEYOND_GATHER_COVERS_H
#define RAD_BEYOND_GATHER_COVERS_H

#include "rad/beyond/gather/receiver.h"

/* True if the first ray of a path comes from inside of a thing standing on the leaf.
 * Costs some rays, spent only where some ray of the leaf has met a back. */
bool ray_comes_from_inside(struct receiver *r, struct vec3 origin,
                           struct vec3 direction);

/* True if a ray of a leaf from x ends at `end` in a gap narrow for the leaf. At an edge,
 * where surfaces meet, there is none. */
bool ray_ends_in_gap(struct receiver *r, struct vec3 x, struct vec3 end);

/* Fills in the kept share of the leaf's light. Rays that seem to begin inside of a thing
 * are believed if all seem so, or if one begins outside. Else their light is lost: a room
 * that shows the backs of its walls is like the inside of a column. */
void receiver_find_outside(struct receiver *r);

/* Fills in the shares of the leaf's area: the bare one, not covered by another face in
 * its plane (a picture on a wall, a lamp in the ceiling), and, as its rays have shown,
 * those outside of things on the leaf and of narrow gaps. A leaf with nothing in view, as
 * the underside of such a thing, has no bare share. */
void receiver_find_covers(struct receiver *r);

#endif
