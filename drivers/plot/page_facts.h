/* SPDX-License-Identifier: BSD-3-Clause */
/* What a page says of its run, as JSON texts for its script. */
#ifndef DEM_PAGE_FACTS_H
#define DEM_PAGE_FACTS_H

#include "page_content.h"

/** The texts of /provenance: decks, versions, title. False after a fault, which is reported.
 *  \param[out] text  malloc'ed, terminated; caller owns it */
bool page_facts_notes(const char *path, char **text, outcome *o);

/** What NAME.json beside NAME.vtkhdf, or NAME.part.vtkhdf, has; "null" where there is none. As page_facts_notes(). */
bool page_facts_summary(const char *path, char **text, outcome *o);

/** Frames, quantities, obstacles and charts, as they are in the blocks. As page_facts_notes(). */
bool page_facts_content(const page_content *p, char **text, outcome *o);

/** Writes a text so that it can stand within <script>: a < of its strings as \u003c. */
void page_facts_write(const char *text, FILE *out);

/** How many bytes that takes. */
double page_facts_length(const char *text);

#endif
