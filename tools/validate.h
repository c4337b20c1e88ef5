/* phr --validate: every form factor of the program against exact answers. */
#ifndef TOOLS_VALIDATE_H
#define TOOLS_VALIDATE_H

#include <stdbool.h>
#include <stdio.h>

/* Prints a table of all cases and methods and a summary. False if a method is worse than what is
 * stated of it, on any case in the range for which it is stated. Takes milliseconds. */
bool validate_print(FILE *file);

#endif
