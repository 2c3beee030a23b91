/* SPDX-License-Identifier: BSD-3-Clause */
/* What is known of a deck's lattice once it is built: nothing that comes later looks at its arrays, so that they need not
 * be in one process. */
#ifndef DEM_LATTICE_FACTS_H
#define DEM_LATTICE_FACTS_H

#include <stdbool.h>

#include <dem/lattice.h>

typedef struct lattice_facts {
    bool may_break;  /* something of it breaks by itself, */
    bool may_soften; /* and softens before */
} lattice_facts;

lattice_facts lattice_facts_of(const dem_lattice *lattice);

#endif
