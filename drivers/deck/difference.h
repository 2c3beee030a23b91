/* SPDX-License-Identifier: BSD-3-Clause */
/* In what two resolved decks differ. */
#ifndef DEM_DIFFERENCE_H
#define DEM_DIFFERENCE_H

#include <stdbool.h>

enum { DIFFERENCE = 256 }; /* bytes of the words for it */

/** Whether they do, line by line: names the first lines that are not the same, and the group they are in. */
bool difference_find(const char *then, const char *now, char text[DIFFERENCE]);

#endif
