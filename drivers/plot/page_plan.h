/* SPDX-License-Identifier: BSD-3-Clause */
/* What of a run fits into a page of bounded size. */
#ifndef DEM_PAGE_PLAN_H
#define DEM_PAGE_PLAN_H

#include "page_content.h"

enum { PAGE_PLAN_FRAMES = 40 }; /* for so many, quantities are left out before frames are */

/** Bounds the history to a quarter of the room, leaves out quantities from the last on, and thins the frames, until all
 *  fits. False after a fault, which is reported: not even a frame with one quantity does.
 *  \param texts  bytes of the page that are no blocks
 *  \param most   bytes of the whole page */
bool page_plan_fit(page_content *p, double texts, double most, outcome *o);

#endif
