/* Well-known slips, and the number that each makes of a case. */
#ifndef TOOLS_SLIPS_H
#define TOOLS_SLIPS_H

#include "tools/cases.h"

enum { SLIPS_MOST = 24, SLIP_NAME = 64 };

struct slip {
    char name[SLIP_NAME];
    double value; /* in the unit of the case */
};

/* Sets the slips of a case, the plainest first; returns how many there are. Factors of
 * polygons are computed anew with each slip, light is scaled, and the case itself may
 * name others. */
int slips_of(const struct known_case *known, struct slip slips[SLIPS_MOST]);

#endif
