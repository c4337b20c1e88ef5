/* Which lamps are seen from around a point of a picture. */
#ifndef RAD_BEYOND_LAMPS_SEEN_H
#define RAD_BEYOND_LAMPS_SEEN_H

#include "rad/beyond/receiver.h"

/* Makes the groups of lamps at hand worth less where little of them is seen from the
 * surface around the receiver's points, and tells how much is. Does nothing unless there
 * are more groups than segments. Pre: r->points. */
void receiver_weigh_groups(struct receiver *r, struct lamps *lamps, int segments);

#endif
