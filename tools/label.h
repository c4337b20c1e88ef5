/* Names of nodes in texts: ROOT/PATH for a patch, top/PATH for a cluster, a digit for
 * each step down. 5/ is root 5, 5/02 child 2 of its child 0, top/ the whole scene. */
#ifndef TOOLS_LABEL_H
#define TOOLS_LABEL_H

#include "rad/id.h"

enum { LABEL_SIZE = 32 };

/* Writes the name with its final 0. Pre: id_is_valid(id). Returns `text`. */
const char *label_write(struct patch_id id, char text[LABEL_SIZE]);

/* Reads a name. False for other text, or for more than ID_MAX_LEVEL steps. */
bool label_read(const char *text, struct patch_id *id);

#endif
