/* SPDX-License-Identifier: BSD-3-Clause */
/* Contact as a source of events (events/event_source.h), with a key for each candidate. begin() finds when each active
 * candidate changes next, and a heap holds these times; after an event, follow() finds them again for candidates near
 * it. What an event may change of contacts is copied before the first event of a step changes it. undo() restores the
 * copies, to the bit, so that the same events come again. When and how contacts change is the automaton's part
 * (automaton.c, automaton_step.c), what follows for the motion that of src/events. */
#include "contact/contact_source.h"

#include <stdlib.h>

#include "base/status.h"
#include "contact/automaton_step.h"
#include "contact/contact_entry.h"
#include "contact/impact_group.h"

/* ---- set-up ---- */

static bool comes_before(const void *self, dem_index a, dem_index b)
{
    const contact_candidate *list = ((const automaton *)self)->set.list;
    return candidate_is_before(&list[a], &list[b]);
}

/* Lists for n candidates. Saved ones that are candidates no more still need room, besides the n that there are. */
static dem_status allocate(contact_source *s, dem_index n)
{
    const size_t size = (size_t)n + 1, most = size + (size_t)s->n_saved;
    s->crossing = malloc(size * sizeof *s->crossing);
    s->kept = calloc(size, sizeof *s->kept);
    s->saved = malloc(most * sizeof *s->saved);
    s->before = malloc(most * sizeof *s->before);
    s->heap = (event_heap){0};
    CHECK(s->crossing && s->kept && s->saved && s->before, DEM_ERROR_MEMORY,
          "out of memory for %lld contact candidates", (long long)n);
    return event_heap_create(&s->heap, n, (event_key_order){comes_before, s->automaton});
}

static void free_lists(contact_source *s)
{
    event_heap_destroy(&s->heap);
    free(s->crossing);
    free(s->kept);
    free(s->saved);
    free(s->before);
}

dem_status contact_source_create(contact_source *out, automaton *c)
{
    *out = (contact_source){.automaton = c, .taken = -1};
    dem_status status = allocate(out, c->set.n);
    if (status == DEM_OK) status = ledger_create(&out->ledger, c->set.scene.model->obstacles.n);
    if (status != DEM_OK) contact_source_destroy(out);
    return status;
}

void contact_source_destroy(contact_source *s)
{
    ledger_destroy(&s->ledger);
    free_lists(s);
    *s = (contact_source){0};
}

/* ---- another surface ---- */

/* What is due and what is saved goes on under new numbers, from one source to the next; a candidate is known by its
 * nodes. */
static void carry_over(const contact_source *from, const contact_key *due, contact_source *to)
{
    const contact_set *c = &to->automaton->set;
    for (dem_index p = 0; p < from->heap.n; p++) {
        const dem_index was = from->heap.keys[p], k = contact_set_find(c, due[p]);
        if (k >= 0) event_heap_set(&to->heap, k, from->heap.due[was], from->heap.generation[was]);
    }
    for (dem_index m = 0; m < to->n_saved; m++) {
        const dem_index k = contact_set_find(c, candidate_key(&from->before[m]));
        to->before[m] = from->before[m];
        to->saved[m] = k;
        if (k >= 0) to->kept[k] = true;
    }
}

/* The keys of what is due are noted while the numbers of the old surface still hold. */
dem_status contact_source_follow_surface(contact_source *s, const surface *to)
{
    const contact_candidate *list = s->automaton->set.list;
    contact_source next = *s;
    contact_key *due = malloc(((size_t)s->heap.n + 1) * sizeof *due);
    dem_status status = allocate(&next, to->n_nodes + to->n_edges);
    if (status == DEM_OK && due == NULL) status = status_fail(DEM_ERROR_MEMORY, "out of memory for events");
    for (dem_index p = 0; p < s->heap.n && due != NULL; p++) due[p] = candidate_key(&list[s->heap.keys[p]]);
    if (status == DEM_OK) status = automaton_follow_surface(s->automaton, to);
    if (status == DEM_OK) carry_over(s, due, &next);
    free(due);
    free_lists(status == DEM_OK ? s : &next);
    if (status == DEM_OK) *s = next;
    return status;
}

/* ---- what is next ---- */

enum { CANDIDATE_NODES = 64 }; /* that take as long in a loop as a look at a free candidate */

static bool is_free(const contact_source *s, dem_index k)
{
    return s->automaton->set.list[k].n_closed == 0;
}

typedef struct looking {
    const contact_source *source;
    int n_shares;
} looking;

/* Finds when the free candidates of a share touch. Each writes its own place only, so that the result does not depend
 * on the number of shares. */
static void look_at_free(const void *context, int share, int thread)
{
    const looking *look = context;
    const contact_source *s = look->source;
    automaton *c = s->automaton;
    const dem_index n = automaton_n_active(c), end = team_share(n, look->n_shares, share + 1);
    (void)thread;
    for (dem_index a = team_share(n, look->n_shares, share); a < end; a++) {
        const dem_index k = automaton_active_candidate(c, a);
        if (is_free(s, k)) s->crossing[k] = automaton_crossing(c, s->step, k, s->step->t0);
    }
}

/* The next change of every active candidate from the start of the step. Threads look at free ones beforehand; what they
 * have found holds unless it is at the start itself, or a node has gone behind an obstacle meanwhile, which concerns
 * its edges. Then, and for closed candidates, it is found here, in the order of candidates. */
static void look_ahead(contact_source *s)
{
    automaton *c = s->automaton;
    const dense_output *step = s->step;
    event_heap_clear(&s->heap);
    automaton_begin_step(c, step, s->state);
    team *const t = c->set.scene.rule.team;
    const looking look = {s, team_shares(t, CANDIDATE_NODES * automaton_n_active(c))};
    team_run(t, look.n_shares, look_at_free, &look);
    const dem_index *behind = &c->set.ledger.counts.behind, were_behind = *behind;
    for (dem_index a = 0; a < automaton_n_active(c); a++) {
        const dem_index k = automaton_active_candidate(c, a);
        const bool known = is_free(s, k) && s->crossing[k] > step->t0 && *behind == were_behind;
        const double due = known ? s->crossing[k] : automaton_next_change(c, step, k, step->t0, s->state);
        if (isfinite(due))
            event_heap_set(&s->heap, k, due, 0); /* the heap was cleared: most candidates need no entry */
    }
}

/* A new step has been begun: what was saved for the step before it is no longer needed. */
static void forget_saved(contact_source *s)
{
    for (dem_index m = 0; m < s->n_saved; m++)
        if (s->saved[m] >= 0) s->kept[s->saved[m]] = false;
    s->n_saved = 0;
    s->has_ledger = false;
}

/* Contacts stick no longer than their friction allows in a new step. */
static void unpin(contact_set *c)
{
    const contact_forces *r = &c->forces;
    for (dem_index g = 0; g < r->n_groups; g++)
        for (dem_index k = r->groups[g]; k >= 0; k = r->next[k])
            for (int q = 0; q < c->list[k].n_closed; q++) c->list[k].closed[q].pinned = false;
}

static void contact_source_begin(void *self, const dense_output *step, double *state)
{
    contact_source *s = self;
    forget_saved(s);
    s->step = step;
    s->state = state;
    s->automaton->set.step = step->t0;
    unpin(&s->automaton->set);
    look_ahead(s);
}

static event_due contact_source_next(const void *self)
{
    const event_heap *h = &((const contact_source *)self)->heap;
    const dem_index key = event_heap_first(h);
    return key >= 0 ? (event_due){h->due[key], h->generation[key], key} : (event_due){(double)INFINITY, 0, -1};
}

static dem_index contact_source_seeds(const void *self, dem_index key, dem_index *nodes, dem_index capacity)
{
    const contact_source *s = self;
    return contact_set_seeds(&s->automaton->set, key, nodes, capacity);
}

/* ---- candidates near an event ---- */

/* Calls a function for every candidate that has a moving node of the neighbourhood, once: an edge comes with its first
 * node if that moves, else with its other. */
static void each_candidate(contact_source *s, const event_place *at,
                           void (*act)(contact_source *s, const event_place *at, dem_index k))
{
    const contact_set *c = &s->automaton->set;
    const local_nodes *nodes = &at->near->nodes;
    for (dem_index j = 0; j < local_nodes_n_moving(nodes); j++) {
        const dem_index i = nodes->list[j];
        if (c->of_node[i] >= 0) act(s, at, c->of_node[i]);
        for (contact_edges e = contact_set_edges_at(c, i); contact_edges_next(&e);) {
            const dem_index start = c->list[e.k].node;
            if (start == i || !local_nodes_have(nodes, start, nodes->n_rings - 1)) act(s, at, e.k);
        }
    }
}

/* Copies a candidate before its first change in the step. */
static void keep_candidate(contact_source *s, const event_place *at, dem_index k)
{
    (void)at;
    if (s->kept[k]) return;
    s->kept[k] = true;
    s->saved[s->n_saved] = k;
    s->before[s->n_saved++] = s->automaton->set.list[k];
}

/* Takes away velocities that errors have left in closed contacts at the event, and that these do not allow: they would
 * be taken for sliding or for an approach. Groups that begin farther out stay as they are: the correction has rings for
 * a jump in ring 0, and would lose momentum of one farther out. */
static void stop_groups(contact_source *s, const event_place *at)
{
    contact_set *c = &s->automaton->set;
    contact_instant now = {at->t, at->state, at->state + state_velocities(scene_layout(&c->scene)), NULL, DEM_OK};
    for (dem_index g = 0; g < at->near->n_groups; g++)
        if (at->near->groups[g].ring == 0) impact_group_stop(c, at->near->groups[g].group, &now);
}

/* Called before an event of any source, as its local correction changes contact forces too. `solved` NAN: the forces
 * are no longer those of the end of the step. */
static void contact_source_prepare(void *self, const event_place *at)
{
    contact_source *s = self;
    automaton *c = s->automaton;
    if (!s->has_ledger) ledger_copy(&s->ledger, &c->set.ledger, c->set.scene.model->obstacles.n);
    s->has_ledger = true;
    c->solved = NAN;
    each_candidate(s, at, keep_candidate);
    stop_groups(s, at);
}

static dem_status contact_source_resolve(void *self, dem_index key, const event_place *at,
                                         const event_listener *listener)
{
    contact_source *s = self;
    s->taken = key;
    return automaton_resolve_near(s->automaton, key, at->t, at->state, listener);
}

/* The next change of a candidate after an event; infinity takes it off the heap. One that was due at the same time
 * before keeps its generation, unless it is the one that has changed. */
static void look_again(contact_source *s, const event_place *at, dem_index k)
{
    const double due = automaton_next_change(s->automaton, at->step, k, at->t, at->state);
    const dem_index before = k == s->taken ? -1 : event_heap_generation(&s->heap, k, at->t);
    event_heap_set(&s->heap, k, due, due > at->t ? 0 : (before >= 0 ? before : at->generation + 1));
}

/* Bound of how far candidates go in the step, m: nodes near the event may be faster after it than the fastest was
 * before. */
static double furthest(const contact_source *s, const event_place *at)
{
    const dense_output *step = at->step;
    double way = s->automaton->way;
    for (dem_index j = 0; j < local_nodes_n_moving(&at->near->nodes); j++) {
        const dem_index i = at->near->nodes.list[j];
        if (s->automaton->set.of_node[i] < 0) continue;
        const double speed = vec2_norm(vec2_at(step->y1 + state_velocities(&step->layout), i));
        way = fmax(way, 2.0 * (step->t1 - step->t0) * (speed + surface_speed(&s->automaton->set.scene)));
    }
    return way;
}

/* The forces of groups near the event are those of the end of the step again before changes are looked for. */
static void contact_source_follow(void *self, const event_place *at)
{
    contact_source *s = self;
    s->automaton->way = furthest(s, at);
    for (dem_index g = 0; g < at->near->n_groups; g++)
        automaton_solve_group(s->automaton, at->step, at->near->groups[g].group, at->state);
    each_candidate(s, at, look_again);
    s->taken = -1;
}

/* Puts the copies back, and leaves out what is a candidate no more. */
static void put_back(contact_source *s)
{
    dem_index n = 0;
    for (dem_index m = 0; m < s->n_saved; m++) {
        if (s->saved[m] < 0) continue;
        contact_set_become(&s->automaton->set, s->saved[m], &s->before[m]);
        s->saved[n++] = s->saved[m];
    }
    s->n_saved = n;
}

/* Candidates, ledger and groups become those before the step; velocities are put back by the queue. Regrouping cannot
 * fail, as these groups had room before. */
static void contact_source_undo(void *self)
{
    contact_source *s = self;
    automaton *c = s->automaton;
    c->solved = NAN;
    if (!s->has_ledger) return;
    put_back(s);
    ledger_copy(&c->set.ledger, &s->ledger, c->set.scene.model->obstacles.n);
    (void)contact_set_regroup_some(&c->set, s->saved, s->n_saved);
    forget_saved(s);
}

/* ---- checkpoints ---- */

static dem_status contact_source_save(const void *self, dem_checkpoint *checkpoint)
{
    return contact_entry_put(&((const contact_source *)self)->automaton->set, checkpoint);
}

static dem_status contact_source_restore(void *self, const dem_checkpoint *checkpoint, double t, const double *y)
{
    contact_source *s = self;
    TRY(contact_entry_get(&s->automaton->set, checkpoint));
    return automaton_restore(s->automaton, t, y);
}

event_source contact_source_events(contact_source *s)
{
    return (event_source){.name = "contact",
                          .self = s,
                          .begin = contact_source_begin,
                          .next = contact_source_next,
                          .seeds = contact_source_seeds,
                          .prepare = contact_source_prepare,
                          .resolve = contact_source_resolve,
                          .follow = contact_source_follow,
                          .undo = contact_source_undo,
                          .save = contact_source_save,
                          .restore = contact_source_restore};
}
