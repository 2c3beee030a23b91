/* SPDX-License-Identifier: BSD-3-Clause */
/* Edges are joined to chains by their nodes: an edge a-b after which the boundary goes on to c is followed by b-c. At a
 * node where boundaries meet several edges start; the node before b on the boundary tells which of them follows. What
 * is done with the order is in contact_forces.c. */
#include "contact/group_walk.h"

#include <stdlib.h>

#include "base/sorted.h"
#include "base/status.h"

/* Of a candidate in a walk: an edge that nothing leads to so far, one that another leads to, what has been passed. */
enum { UNREACHED, FOLLOWING, PASSED };

dem_status group_walk_create(group_walk *out, const contact_candidate *candidates, dem_index n_candidates,
                             dem_index *const scratch[2])
{
    const size_t n = (size_t)n_candidates + 1;
    group_walk w = {.candidates = candidates, .starting = scratch[0], .of_node = scratch[1]};
    w.list = malloc(n * sizeof *w.list);
    w.after = malloc(n * sizeof *w.after);
    w.beside = malloc(n * sizeof *w.beside);
    w.state = malloc(n * sizeof *w.state);
    w.heads = malloc(n * sizeof *w.heads);
    *out = w;
    if (w.list && w.after && w.beside && w.state && w.heads) return DEM_OK;
    group_walk_destroy(out);
    return status_fail(DEM_ERROR_MEMORY, "out of memory for %lld contact candidates", (long long)n_candidates);
}

void group_walk_destroy(group_walk *w)
{
    free(w->list);
    free(w->after);
    free(w->beside);
    free(w->state);
    free(w->heads);
    *w = (group_walk){0};
}

/* Enters edges at the nodes where they start, and nodes. */
static void enter(group_walk *w, const dem_index *members, dem_index n)
{
    for (dem_index p = 0; p < n; p++) {
        const contact_candidate *s = &w->candidates[members[p]];
        w->starting[s->node] = w->of_node[s->node] = -1;
        if (candidate_is_edge(s)) w->starting[s->other] = w->of_node[s->other] = -1;
    }
    for (dem_index p = 0; p < n; p++) {
        const dem_index k = members[p], node = w->candidates[k].node;
        w->state[k] = UNREACHED;
        if (!candidate_is_edge(&w->candidates[k])) {
            w->of_node[node] = k;
            continue;
        }
        w->beside[k] = w->starting[node];
        w->starting[node] = k;
    }
}

static dem_index follower(const group_walk *w, dem_index k)
{
    const contact_candidate *s = &w->candidates[k];
    for (dem_index f = w->starting[s->other]; f >= 0; f = w->beside[f])
        if (w->candidates[f].other == s->next && w->candidates[f].previous == s->node) return f;
    return -1;
}

static void join(group_walk *w, const dem_index *members, dem_index n)
{
    for (dem_index p = 0; p < n; p++) {
        const dem_index k = members[p];
        if (!candidate_is_edge(&w->candidates[k])) continue;
        w->after[k] = follower(w, k);
        if (w->after[k] >= 0) w->state[w->after[k]] = FOLLOWING;
    }
}

/* ---- where walks begin ---- */

static int by_nodes(const void *a, const void *b)
{
    const contact_candidate *one = *(const contact_candidate *const *)a, *other = *(const contact_candidate *const *)b;
    return candidate_is_before(other, one) - candidate_is_before(one, other);
}

/* Marks the edges from k on as passed, round to it again in a ring.  \return the lowest of them */
static const contact_candidate *pass(group_walk *w, dem_index k)
{
    const contact_candidate *lowest = &w->candidates[k];
    for (; k >= 0 && w->state[k] != PASSED; k = w->after[k]) {
        w->state[k] = PASSED;
        if (candidate_is_before(&w->candidates[k], lowest)) lowest = &w->candidates[k];
    }
    return lowest;
}

/* Chains first: what they do not reach is rings.  \return how many */
static dem_index find_heads(group_walk *w, const dem_index *members, dem_index n)
{
    dem_index n_heads = 0;
    for (dem_index p = 0; p < n; p++) {
        const dem_index k = members[p];
        if (!candidate_is_edge(&w->candidates[k]) || w->state[k] != UNREACHED) continue;
        w->heads[n_heads++] = &w->candidates[k];
        (void)pass(w, k);
    }
    for (dem_index p = 0; p < n; p++)
        if (candidate_is_edge(&w->candidates[members[p]]) && w->state[members[p]] == FOLLOWING)
            w->heads[n_heads++] = pass(w, members[p]);
    if (n_heads > 1) qsort(w->heads, (size_t)n_heads, sizeof *w->heads, by_nodes);
    return n_heads;
}

/* ---- the walks ---- */

/* Lists the candidate of a node that is not listed yet. */
static dem_index list_node(group_walk *w, dem_index node, dem_index n)
{
    const dem_index k = w->of_node[node];
    if (k < 0) return n;
    w->of_node[node] = -1;
    w->list[n] = k;
    return n + 1;
}

static dem_index walk_from(group_walk *w, dem_index head, dem_index n)
{
    dem_index last = head;
    for (dem_index k = head; k >= 0; k = w->after[k] != head ? w->after[k] : -1) {
        n = list_node(w, w->candidates[k].node, n);
        w->list[n++] = k;
        last = k;
    }
    return list_node(w, w->candidates[last].other, n);
}

void group_walk_take(group_walk *w, const dem_index *members, dem_index n)
{
    dem_index n_listed = 0;
    enter(w, members, n);
    join(w, members, n);
    const dem_index n_heads = find_heads(w, members, n);
    for (dem_index h = 0; h < n_heads; h++) n_listed = walk_from(w, w->heads[h] - w->candidates, n_listed);
    const dem_index n_along = n_listed;
    for (dem_index p = 0; p < n; p++)
        if (!candidate_is_edge(&w->candidates[members[p]]))
            n_listed = list_node(w, w->candidates[members[p]].node, n_listed);
    (void)sorted_make(w->list + n_along, n_listed - n_along);
}
