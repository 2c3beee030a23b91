/* SPDX-License-Identifier: BSD-3-Clause */
/* The lanes of a block: a sweep takes so many nodes at the same time (layout.h). */
#ifndef DEM_ELASTIC_LAYOUT_LANES_H
#define DEM_ELASTIC_LAYOUT_LANES_H

enum { LAYOUT_LANES = 8 };

#endif
