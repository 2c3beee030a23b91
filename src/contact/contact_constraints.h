/* SPDX-License-Identifier: BSD-3-Clause */
/* Closed contacts as constraints of the motion near an event: their groups are those of contact_forces.c. */
#ifndef DEM_CONTACT_CONTACT_CONSTRAINTS_H
#define DEM_CONTACT_CONTACT_CONSTRAINTS_H

#include "contact/automaton.h"
#include "events/constraints.h"

/** Borrows the automaton. */
constraints contact_constraints_of(automaton *c);

#endif
