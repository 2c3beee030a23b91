/* SPDX-License-Identifier: BSD-3-Clause */
/* What a page shows of a run: which frames, coloured by which quantities. */
#ifndef DEM_PAGE_CONTENT_H
#define DEM_PAGE_CONTENT_H

#include <dem/reader.h>

#include "box.h"
#include "colour_range.h"
#include "frame_list.h"
#include "outcome.h"
#include "quantity.h"
#include "request.h"
#include "timeline.h"

/** A quantity to choose, and what all frames have in common of it. */
typedef struct page_quantity {
    quantity shown;
    bool fills;     /* triangles; else springs are drawn */
    size_t n_cells; /* triangles or springs */
    colour_range range;
} page_quantity;

typedef struct page_content {
    const dem_reader *reader;
    const dem_lattice *lattice;
    const request *asked;
    frame_list frames;
    size_t n_asked; /* frames, before they are thinned */
    size_t n_found; /* quantities, before some are left out */
    size_t n_quantities;
    page_quantity quantity[QUANTITY_KNOWN + 1]; /* [n_found] the one shown first, then as they are named */
    size_t n_bare;
    unsigned char *is_bare; /* [n_nodes] 1: no spring holds the node, which is drawn as a point */
    timeline *history;      /* NULL: there is none */
    size_t n_rows;          /* of the history, that the page has */
    box *box;               /* [frames.n] around all nodes, m */
    box view;               /* m */
} page_content;

/** All frames and quantities that are asked for, none looked at yet. False after a fault, which is reported. To be
 *  closed in any case. */
bool page_content_open(page_content *p, const dem_reader *reader, const request *asked, outcome *o);
void page_content_close(page_content *p);

/** Of the frames no more than n, the first and the last among them, evenly; n > 0. */
void page_content_thin(page_content *p, size_t n);

/** Looks at all frames for what they have in common. False after a fault, which is reported. */
bool page_content_survey(page_content *p, outcome *o);

/** Whether springs, or triangles, are drawn for some quantity. */
bool page_content_draws(const page_content *p, bool fills);

#endif
