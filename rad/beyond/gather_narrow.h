/* Light that leaves in the dark find through narrow openings. For the files of the final
 * gather alone. */
#ifndef RAD_BEYOND_GATHER_NARROW_H
#define RAD_BEYOND_GATHER_NARROW_H

#include "rad/beyond/receiver.h"

/* True if little light comes to the receiver, a leaf, or to its region. */
bool receiver_is_in_the_dark(const struct receiver *r);

/* True if the region that openings were found of last has any. */
bool openings_are_known(const struct final_gather *gather);

/* True if a leaf is in a region that the receiver sees through one. */
bool receiver_aims_through(const struct receiver *r, int32_t leaf);

/* Adds the light of these. */
void receiver_aim_through(struct receiver *r);

#endif
