/* SPDX-License-Identifier: BSD-3-Clause */
/* Items in a row, of which neighbours lie near each other, in a balanced tree of boxes: finds the items that a query
 * may concern. */
#ifndef DEM_OBSTACLE_BOX_TREE_H
#define DEM_OBSTACLE_BOX_TREE_H

#include "base/box.h"

typedef struct box_tree {
    dem_index n; /* items */
    int depth;   /* there are 2^depth leaves, which get the items evenly and in order */
    box *boxes;  /* [2^(depth + 1)] the root is 1, the children of k are 2 k and 2 k + 1, the second half are leaves */
} box_tree;

/** Relative error allowed to what is computed from coordinates: some 40 roundings. */
#define BOX_TREE_ROUNDING 1e-14

/** Box of all points within `reach`, m, of the segment ab, widened by a bound of rounding errors. */
box box_around(vec2 a, vec2 b, double reach);

/** A tree of n items that cover nothing yet. Free with box_tree_free(). */
dem_status box_tree_create(box_tree *out, dem_index n);
void box_tree_free(box_tree *t);

/** Widens an item by a box. */
void box_tree_cover(box_tree *t, dem_index item, const box *around);

/** The first item at or after `from` whose leaf meets the window; n if there is none. Costs the depth of the tree. */
dem_index box_tree_seek(const box_tree *t, dem_index from, const box *window);

static inline bool box_tree_is_leaf(const box_tree *t, dem_index node)
{
    return node >> t->depth != 0;
}

/** First item of a leaf; the next leaf's first item ends it. */
static inline dem_index box_tree_first(const box_tree *t, dem_index leaf)
{
    return ((leaf - ((dem_index)1 << t->depth)) * t->n) >> t->depth;
}

/* ---- best first: a node's bound is a lower bound of what is looked for in it ---- */

enum { BOX_TREE_DEPTH = 63 };

/** A best-first search: the nodes that are still to be visited, and the limit above which a node's bound rules it
 *  out. */
typedef struct box_tree_walk {
    double limit;
    int n;
    dem_index node[BOX_TREE_DEPTH];
    double bound[BOX_TREE_DEPTH];
} box_tree_walk;

/** Starts a walk; returns the root. */
static inline dem_index box_tree_start(box_tree_walk *walk, double limit)
{
    walk->limit = limit;
    walk->n = 0;
    return 1;
}

/** The last node kept for later that is not ruled out by now; 0 if there is none. */
static inline dem_index box_tree_back(box_tree_walk *walk)
{
    while (walk->n > 0)
        if (walk->bound[--walk->n] <= walk->limit) return walk->node[walk->n];
    return 0;
}

/** Goes to `first` and keeps its sibling `other` for later; if `first` is ruled out, as box_tree_back(). */
static inline dem_index box_tree_prefer(box_tree_walk *walk, dem_index first, double bound, dem_index other,
                                        double other_bound)
{
    walk->node[walk->n] = other;
    walk->bound[walk->n++] = other_bound;
    return bound <= walk->limit ? first : box_tree_back(walk);
}

/** Where to go from a node whose children have these bounds: to the child with the smaller bound. */
static inline dem_index box_tree_down(box_tree_walk *walk, dem_index node, double bound, double bound_too)
{
    /* A branch rather than a conditional move: the processor guesses, and reads the next boxes meanwhile. */
    if (bound_too < bound) return box_tree_prefer(walk, 2 * node + 1, bound_too, 2 * node, bound);
    return box_tree_prefer(walk, 2 * node, bound, 2 * node + 1, bound_too);
}

#endif
