/* Sparks: points in the dark where first light lands, and where it goes from there. For
 * the files of the final gather alone. */
#ifndef RAD_BEYOND_GATHER_SPARKS_H
#define RAD_BEYOND_GATHER_SPARKS_H

#include "rad/beyond/receiver.h"

/* Adds the light of the sparks that the receiver sees. */
void receiver_add_sparks(struct receiver *r);

/* True if first light of a leaf in the dark is known. */
bool leaf_has_sparks(const struct final_gather *gather, int32_t leaf);

/* True if it sees first light of a leaf as sparks. */
bool receiver_sees_sparks(const struct receiver *r, int32_t patch);

/* Takes away that light from a ray, of this weight, that has met the leaf. */
void receiver_leave_out_sparks(struct receiver *r, int32_t patch, double weight);

#endif
