/* SPDX-License-Identifier: BSD-3-Clause */
/* Early reflection: impacts nearer to one another in time than the window are taken together, at the first of them. */
#ifndef DEM_CONTACT_EARLY_REFLECTION_H
#define DEM_CONTACT_EARLY_REFLECTION_H

#include "contact/contact_set.h"

/** Reflects now, where they are, the free candidates that would touch within the window: no contact closes. One that
 *  shares nodes with closed contacts is left alone. */
void early_reflection(contact_set *c, contact_instant *now);

/** Reflects one free candidate at its gap to a surface. */
void early_reflection_of(contact_set *c, dem_index k, const contact_gap *gap, contact_instant *now);

#endif
