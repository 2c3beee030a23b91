/* SPDX-License-Identifier: BSD-3-Clause */
/* The outline of a &body, &void, &inclusion or &weakness by its keys. */
#ifndef DEM_BODY_OUTLINE_H
#define DEM_BODY_OUTLINE_H

#include "outline.h"
#include "schema.h"

/* In its own coordinates, before it is turned and placed: a rectangle that is a body stands on its origin, others are
 * centred there. Of a mask, which has the size of its image, it is a rectangle without size. The points of a polygon
 * are borrowed from the deck; the last one may be the first once more there, and is then left out. */
outline body_outline(const schema_instance *group);

/* The same with points of its own. Returns false when memory runs out. */
bool body_outline_copy(outline *out, const schema_instance *group);

/* Of a group that has a centre and perhaps an angle: turned, and in its place. Returns false when memory runs out; *out
 * is then freed. */
bool body_outline_place(outline *out, const schema_instance *group);

#endif
