/* Being asked to stop, as the long loops of all layers see it. Who asks, and how, is the
 * business of the caller of stop_when() (geom/signals.h). */
#ifndef GEOM_STOP_H
#define GEOM_STOP_H

#include <stdbool.h>

#include "geom/error.h"

/* `asked()` tells whether the program is asked to stop, and never takes a yes back. NULL:
 * not asked. What was asked before is no longer heeded. */
void stop_when(bool (*asked)(void));

/* True if the asking loop is to break off. Its result can be packed and freed, and is of
 * no other use. */
bool stop_is_asked(void);

/* Heeds the question: stop_is_asked() is false from here on. A run shows its light. */
void stop_heed(void);

/* True if the program has been asked to stop, heeded or not: nothing is waited for. */
bool stop_was_asked(void);

/* True if nobody asks the program to stop. Else fills `error`, as error_set() does. */
bool stop_check(struct error *error);

#endif
