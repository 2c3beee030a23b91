/* SPDX-License-Identifier: BSD-3-Clause */
/* What tests of other rooms may see of contact's data that no other room of the library touches: where its fields
 * change, this file follows, and those tests stay. */
#ifndef DEM_TEST_CONTACT_LOOK_H
#define DEM_TEST_CONTACT_LOOK_H

#include "harness/test.h"

#include <string.h>

#include "contact/contact_source.h"

static inline const state_layout *look_layout(const automaton *c)
{
    return scene_layout(&c->set.scene);
}

/* ---- candidates ---- */

static inline dem_index look_node(const automaton *c, dem_index k)
{
    return c->set.list[k].node;
}

/** The second node of an edge; -1 of a node. */
static inline dem_index look_other(const automaton *c, dem_index k)
{
    return c->set.list[k].other;
}

static inline dem_index look_candidate(const automaton *c, dem_index node)
{
    return c->set.of_node[node];
}

static inline dem_index look_closed(const automaton *c, dem_index k)
{
    return c->set.list[k].n_closed;
}

/** Whether an edge sticks to a vertex at a place between its nodes. */
static inline bool look_sticks_at_vertex(const automaton *c, dem_index k)
{
    const contact_candidate *candidate = &c->set.list[k];
    return candidate_is_edge(candidate) && candidate->n_closed > 0 && candidate->closed[0].slide == 0 &&
           candidate->closed[0].place > 0.0;
}

/** Copies candidates k to k + n - 1 with all that is known of them. */
static inline void look_copy(const automaton *c, dem_index k, dem_index n, contact_candidate *out)
{
    memcpy(out, &c->set.list[k], (size_t)n * sizeof *out);
}

static inline void look_assert_same(const automaton *c, const automaton *d, dem_index k)
{
    const contact_candidate *a = &c->set.list[k], *b = &d->set.list[k];
    assert_int_equal(a->n_closed, b->n_closed);
    assert_int_equal(a->storm.n, b->storm.n);
    assert_true(a->storm.start == b->storm.start);
    for (int q = 0; q < 2; q++) assert_int_equal(a->behind[q], b->behind[q]);
    for (int q = 0; q < a->n_closed; q++) {
        assert_int_equal(a->closed[q].feature, b->closed[q].feature);
        assert_int_equal(a->closed[q].slide, b->closed[q].slide);
        assert_int_equal(a->closed[q].held, b->closed[q].held);
        assert_true(a->closed[q].place == b->closed[q].place);
    }
}

/** As if a candidate had had n changes since a time, s. */
static inline void look_set_storm(automaton *c, dem_index k, dem_index n, double start)
{
    c->set.list[k].storm.n = n;
    c->set.list[k].storm.start = start;
}

static inline void look_limit_impacts(automaton *c, dem_index most)
{
    c->set.scene.rule.max_impacts = most;
}

/** A contact with a feature, that slides (1, -1) or sticks (0), at a place along the feature. */
static inline contact_point look_point(dem_index feature, int slide, double place)
{
    return (contact_point){.feature = feature, .slide = slide, .place = place};
}

/* ---- events ---- */

/** s, when the next change of a candidate is due. */
static inline double look_due(const contact_source *s, dem_index k)
{
    return s->heap.due[k];
}

/** Enters the changes that are due anew, the one of the last candidate first. */
static inline void look_enter_backwards(contact_source *s, dem_index n)
{
    CLEANUP(free_memory) double *due = malloc((size_t)n * sizeof *due);
    assert_non_null(due);
    memcpy(due, s->heap.due, (size_t)n * sizeof *due);
    event_heap_clear(&s->heap);
    for (dem_index k = n - 1; k >= 0; k--) event_heap_set(&s->heap, k, due[k], 0);
}

#endif
