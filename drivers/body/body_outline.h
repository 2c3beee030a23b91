/* SPDX-License-Identifier: BSD-3-Clause */
/* The outline of a &body, &void, &inclusion or &weakness by its keys. */
#ifndef DEM_BODY_OUTLINE_H
#define DEM_BODY_OUTLINE_H

#include <dem/shape.h>

#include "schema.h"

/* In its own coordinates, before it is turned and placed: a rectangle that is a body stands on its origin, others are
 * centred there. The points of a polygon are borrowed from the deck. */
dem_outline body_outline(const schema_instance *group);

/* Of a group that has a centre and perhaps an angle: turned, and in its place. */
dem_outline body_outline_placed(const schema_instance *group);

#endif
