/* SPDX-License-Identifier: BSD-3-Clause */
#include "lattice_facts.h"

#include <stddef.h>

lattice_facts lattice_facts_of(const dem_lattice *lattice)
{
    const bool may_break = lattice->strength != NULL || lattice->critical_stretch != NULL;
    return (lattice_facts){.may_break = may_break, .may_soften = may_break && lattice->softening != NULL};
}
