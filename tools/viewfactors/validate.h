/* Every form factor of phr against exact answers. */
#ifndef TOOLS_VIEWFACTORS_VALIDATE_H
#define TOOLS_VIEWFACTORS_VALIDATE_H

#include <stdbool.h>
#include <stdio.h>

/* Prints a table of all cases and methods and a summary. False if a method exceeds its
 * stated error on a case in its stated range. Takes milliseconds. */
bool validate_print(FILE *file);

#endif
