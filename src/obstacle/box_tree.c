/* SPDX-License-Identifier: BSD-3-Clause */
/* A balanced tree of boxes over items in a row, segments or vertices of a polyline, which lie near each other if their
 * numbers do. The tree is an array in the order of levels: the children of node k are 2 k and 2 k + 1, so that it needs
 * no links and siblings lie side by side. Nothing is sorted, since a polyline is in order already; building it costs
 * its number of items times the depth. A query gets candidates only: what they are (point_gap.c, vertex_gap.c) judges
 * them exactly, and boxes are a little wider than rounding could matter, so that the tree changes no result. */
#include "obstacle/box_tree.h"

#include <stdlib.h>

#include "base/status.h"

static const dem_index fewest_in_leaf = 2; /* measured: halves and doubles of it cost more */

/* The box is widened by a relative bound of the rounding in what is computed from the coordinates. */
box box_around(vec2 a, vec2 b, double reach)
{
    const double size = fabs(a.x) + fabs(a.y) + fabs(b.x) + fabs(b.y) + reach;
    const double r = reach + BOX_TREE_ROUNDING * size;
    return (box){{fmin(a.x, b.x) - r, fmin(a.y, b.y) - r}, {fmax(a.x, b.x) + r, fmax(a.y, b.y) + r}};
}

/* The leaf whose items, box_tree_first(leaf) to box_tree_first(leaf + 1) - 1, include this one: the 2^depth leaves get
 * the items evenly and in order. */
static dem_index leaf_of(const box_tree *t, dem_index item)
{
    const dem_index leaves = (dem_index)1 << t->depth;
    return leaves + ((item + 1) * leaves - 1) / t->n;
}

dem_status box_tree_create(box_tree *out, dem_index n)
{
    box_tree t = {.n = n};
    while (n >> (t.depth + 1) >= fewest_in_leaf) t.depth++;
    const size_t n_boxes = (size_t)2 << t.depth;
    t.boxes = malloc(n_boxes * sizeof *t.boxes);
    CHECK_MEMORY(t.boxes);
    for (size_t k = 0; k < n_boxes; k++) t.boxes[k] = box_empty();
    *out = t;
    return DEM_OK;
}

void box_tree_free(box_tree *t)
{
    free(t->boxes);
    *t = (box_tree){0};
}

/* Widens the leaf and all its ancestors, the last of which is node 1, the root. */
void box_tree_cover(box_tree *t, dem_index item, const box *around)
{
    for (dem_index node = leaf_of(t, item); node > 0; node /= 2) t->boxes[node] = box_join(*around, t->boxes[node]);
}

/* The node behind a subtree, in the order of items; 0 behind the last. A right child (odd) has nothing behind it within
 * its parent, so one goes up until a left child has a sibling. */
static dem_index behind(dem_index node)
{
    while (node % 2 == 1) node /= 2;
    return node > 0 ? node + 1 : 0;
}

/* Goes down into boxes that meet the window and passes over the others with all their items. A leaf may hold items
 * before `from`, which have been seen. */
dem_index box_tree_seek(const box_tree *t, dem_index from, const box *window)
{
    if (from >= t->n) return t->n;
    dem_index node = leaf_of(t, from);
    while (node > 0) {
        if (!box_meets(&t->boxes[node], window)) {
            node = behind(node);
        } else if (box_tree_is_leaf(t, node)) {
            const dem_index first = box_tree_first(t, node);
            return first > from ? first : from;
        } else {
            node *= 2;
        }
    }
    return t->n;
}
