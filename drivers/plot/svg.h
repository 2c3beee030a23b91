/* SPDX-License-Identifier: BSD-3-Clause */
/* A canvas that writes SVG: texts stay texts, parts of the picture are groups with their names. */
#ifndef DEM_SVG_H
#define DEM_SVG_H

#include <stdio.h>

#include "canvas.h"

/** On an open file, which stays the caller's. NULL without memory. */
canvas *svg_open(FILE *file, double width, double height);

#endif
