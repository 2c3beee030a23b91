/* SPDX-License-Identifier: BSD-3-Clause */
#include "rank_runs.h"

#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

#include "ask.h"
#include "base/checkpoint_entries.h"
#include "simulation/led_run.h"
#include "simulation/rank_shares.h"
#include "simulation/private.h"
#include "support.h"

/* ---- outcomes ---- */

typedef dem_status ask_rows(const dem_simulation *s, double *to);

static dem_status ask_x(const dem_simulation *s, double *to)
{
    memcpy(to, ask_state(s).x, 2 * (size_t)s->model->lattice.n_nodes * sizeof *to);
    return DEM_OK;
}

static dem_status ask_v(const dem_simulation *s, double *to)
{
    memcpy(to, ask_state(s).v, 2 * (size_t)s->model->lattice.n_nodes * sizeof *to);
    return DEM_OK;
}

static dem_status ask_contact_force(const dem_simulation *s, double *to)
{
    return s->options.bodies != DEM_BODIES_NONE ? dem_simulation_contact_forces(s, to) : DEM_OK;
}

static dem_status ask_pressure(const dem_simulation *s, double *to)
{
    return s->options.bodies != DEM_BODIES_NONE ? dem_simulation_contact_pressures(s, to) : DEM_OK;
}

static dem_status ask_broken(const dem_simulation *s, bool of_springs, double *to)
{
    const dem_lattice *l = &s->model->lattice;
    CLEANUP(free_memory) unsigned char *triangle = malloc((size_t)l->n_triangles + 1);
    CLEANUP(free_memory) unsigned char *spring = malloc((size_t)l->n_springs + 1);
    const dem_status status = dem_simulation_broken(s, triangle, spring);
    const dem_index n = of_springs ? l->n_springs : l->n_triangles;
    for (dem_index k = 0; k < n && status == DEM_OK; k++) to[k] = of_springs ? spring[k] : triangle[k];
    return status;
}

static dem_status ask_broken_springs(const dem_simulation *s, double *to)
{
    return ask_broken(s, true, to);
}

static dem_status ask_broken_triangles(const dem_simulation *s, double *to)
{
    return ask_broken(s, false, to);
}

static const struct {
    int kind, width;
    ask_rows *ask;
    const char *name;
} rows[RANK_RUNS_ROWS] = {
    [RANK_RUNS_X] = {RANK_RUNS_NODES, 2, ask_x, "positions"},
    [RANK_RUNS_V] = {RANK_RUNS_NODES, 2, ask_v, "velocities"},
    [RANK_RUNS_STRESS] = {RANK_RUNS_NODES, 3, dem_simulation_stress, "stresses"},
    [RANK_RUNS_CONTACT_FORCE] = {RANK_RUNS_NODES, 2, ask_contact_force, "contact forces"},
    [RANK_RUNS_PRESSURE] = {RANK_RUNS_NODES, 1, ask_pressure, "contact pressures"},
    [RANK_RUNS_STRAIN] = {RANK_RUNS_SPRINGS, 1, dem_simulation_strains, "strains of springs"},
    [RANK_RUNS_FORCE] = {RANK_RUNS_SPRINGS, 1, dem_simulation_forces, "forces of springs"},
    [RANK_RUNS_BROKEN_SPRINGS] = {RANK_RUNS_SPRINGS, 1, ask_broken_springs, "broken springs"},
    [RANK_RUNS_BROKEN_TRIANGLES] = {RANK_RUNS_TRIANGLES, 1, ask_broken_triangles, "broken triangles"},
};

/* Numbers of all kinds in a lattice. */
static void count(const dem_lattice *l, dem_index n[RANK_RUNS_KINDS])
{
    n[RANK_RUNS_NODES] = l->n_nodes;
    n[RANK_RUNS_SPRINGS] = l->n_springs;
    n[RANK_RUNS_TRIANGLES] = l->n_triangles;
}

static void *zeros(size_t n, size_t size)
{
    void *new = calloc(n + 1, size);
    assert_non_null(new);
    return new;
}

/* At one time. */
static size_t size_of_rows(const rank_runs_outcome *o, int which)
{
    return (size_t)(o->n[rows[which].kind] * rows[which].width);
}

rank_runs_outcome rank_runs_make_outcome(const rank_runs_scene *scene)
{
    rank_runs_outcome o = {.scene = scene, .views = zeros(RANK_RUNS_LOOKS, sizeof *o.views)};
    count(dem_model_lattice(scene->model), o.n);
    for (int k = 0; k < RANK_RUNS_ROWS; k++) o.rows[k] = zeros(RANK_RUNS_LOOKS * size_of_rows(&o, k), sizeof(double));
    return o;
}

static void free_own(rank_runs_outcome *o)
{
    free(o->views);
    free(o->notes);
    free(o->steps);
    dem_checkpoint_destroy(o->kept);
}

void rank_runs_free_outcome(rank_runs_outcome *o)
{
    free_own(o);
    for (int k = 0; k < RANK_RUNS_ROWS; k++) free(o->rows[k]);
}

void rank_runs_make_outcomes(const rank_runs_scene *scene, int n, rank_runs_outcome *out)
{
    for (int k = 0; k < n; k++) {
        out[k] = k == 0 ? rank_runs_make_outcome(scene) : out[0];
        if (k > 0) out[k].views = zeros(RANK_RUNS_LOOKS, sizeof *out->views);
    }
}

void rank_runs_free_outcomes(rank_runs_outcome *o, int n)
{
    for (int k = 1; k < n; k++) free_own(&o[k]);
    rank_runs_free_outcome(o);
}

/* ---- what is seen ---- */

static void see_lists(const dem_simulation *s, rank_runs_view *to)
{
    const dem_index n_bodies = ask_sizes(s->model).n_bodies;
    for (int k = 0; k < 2; k++) {
        if (n_bodies > 0) to->bodies[k] = ask_body(s, k * (n_bodies - 1));
        if (to->surfaces.pushing > 0) to->pairs[k] = ask_pair(s, k * (to->surfaces.pushing - 1));
        if (to->n_contacts > 0) to->contacts[k] = ask_contact(s, k * (to->n_contacts - 1));
        if (s->options.n_boundaries > 0) to->boundaries[k] = ask_boundary(s, k * (s->options.n_boundaries - 1));
    }
    if (s->model->obstacles.n > 0) to->obstacle = ask_obstacle(s, 0);
}

/* A leader has the ledger in its own part. */
static void see_sums(const dem_simulation *s, rank_runs_view *to)
{
    const contact_ledger *ledger = &(s->leads != NULL ? led_run_part(s->leads) : s)->automaton.set.ledger;
    const exact_sum *sums[] = {&ledger->impact, &ledger->projection, &ledger->work};
    for (int k = 0; k < 3; k++) to->ledger[k] = exact_sum_value(sums[k]);
    for (int k = 0; k < STATE_TOTALS; k++)
        if (state_has_total(&s->layout, (state_total)k))
            to->totals[k] = state_total_of(&s->layout, s->seen, (state_total)k);
}

/* In the midst of the whole, by numbers there. */
static dem_status see_one(const dem_simulation *s, rank_runs_view *to)
{
    const domain *d = s->model->domain;
    const dem_lattice *l = &s->model->lattice;
    const dem_index node = (d != NULL ? d->n_whole : l->n_nodes) / 2;
    const dem_index spring = (d != NULL ? d->n_springs : l->n_springs) / 2;
    const dem_status status = dem_simulation_stress_at(s, node, to->stress_at);
    return status == DEM_OK ? dem_simulation_force_at(s, spring, &to->force_at) : status;
}

static dem_status see(const dem_simulation *s, rank_runs_view *to)
{
    const dem_state state = ask_state(s);
    to->t = state.t;
    to->step = state.step;
    to->n_contacts = state.n_contacts;
    to->residual = dem_simulation_residual(s);
    to->counts = ask_counts(s);
    to->energy = ask_energy(s);
    to->strain = ask_strain(s);
    to->surfaces = ask_surfaces(s);
    to->overlap = ask_overlap(s);
    see_lists(s, to);
    see_sums(s, to);
    return see_one(s, to);
}

static bool owns(const dem_model *model, int kind, dem_index k)
{
    const dem_lattice *l = &model->lattice;
    dem_index lowest = k;
    if (kind == RANK_RUNS_SPRINGS) lowest = l->ends[2 * k] < l->ends[2 * k + 1] ? l->ends[2 * k] : l->ends[2 * k + 1];
    if (kind == RANK_RUNS_TRIANGLES) {
        lowest = l->triangles[3 * k];
        for (int c = 1; c < 3; c++)
            if (l->triangles[3 * k + c] < lowest) lowest = l->triangles[3 * k + c];
    }
    return domain_owns(model->domain, lowest);
}

static dem_index number_of(const domain *d, int kind, dem_index k)
{
    if (kind == RANK_RUNS_SPRINGS) return domain_spring(d, k);
    return kind == RANK_RUNS_TRIANGLES ? domain_triangle(d, k) : domain_number(d, k);
}

/* Of springs and triangles those whose lowest node is an own one. */
static void copy(const dem_model *model, int kind, int width, const double *from, double *to)
{
    dem_index n[RANK_RUNS_KINDS];
    count(&model->lattice, n);
    for (dem_index k = 0; k < n[kind]; k++)
        if (owns(model, kind, k))
            memcpy(to + width * number_of(model->domain, kind, k), from + width * k, (size_t)width * sizeof *to);
}

void rank_runs_set_off(dem_lattice *l, double speed, double wave)
{
    CLEANUP(free_memory) double *v = calloc(2 * (size_t)l->n_nodes, sizeof *v);
    assert_non_null(v);
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const double x = l->x[2 * i] / 0.05, y = l->x[2 * i + 1] / 0.05;
        v[2 * i] = speed * (0.3 + sin(3.0 * y) + 0.5 * sin(wave * x));
        v[2 * i + 1] = speed * (cos(2.0 * x) - 0.7 * sin(5.0 * x * y));
    }
    support_start(l, NULL, v);
}

void rank_runs_copy(const dem_model *model, int width, const double *from, double *to)
{
    copy(model, RANK_RUNS_NODES, width, from, to);
}

static dem_status see_rows(const dem_simulation *s, rank_runs_outcome *o, int look)
{
    dem_index n[RANK_RUNS_KINDS];
    dem_status status = DEM_OK;
    count(&s->model->lattice, n);
    for (int k = 0; k < RANK_RUNS_ROWS && status == DEM_OK; k++) {
        CLEANUP(free_memory)
        double *values = zeros((size_t)(rows[k].width * n[rows[k].kind]), sizeof *values);
        status = rows[k].ask(s, values);
        copy(s->model, rows[k].kind, rows[k].width, values, o->rows[k] + (size_t)look * size_of_rows(o, k));
    }
    return status;
}

/* Of a rank of several so far, but for those with which it has looked. */
static rank_threads_counts count_calls(const dem_simulation *s, const rank_runs_outcome *o)
{
    if (s->model->domain == NULL) return (rank_threads_counts){0};
    const rank_threads_counts all = rank_threads_count(s->model->ranks);
    return (rank_threads_counts){all.reductions - o->of_looks.reductions, all.exchanges - o->of_looks.exchanges};
}

static dem_status look(const dem_simulation *s, rank_runs_outcome *o, int number)
{
    const rank_threads_counts before = count_calls(s, o);
    dem_status status = see(s, &o->views[number]);
    if (status == DEM_OK) status = see_rows(s, o, number);
    const rank_threads_counts after = count_calls(s, o);
    o->of_looks.reductions += after.reductions - before.reductions;
    o->of_looks.exchanges += after.exchanges - before.exchanges;
    return status;
}

/* ---- observers ---- */

static dem_status take_note(rank_runs_outcome *o, const dem_simulation *s, const rank_runs_note *note)
{
    if (o->n_notes == o->capacity) {
        o->capacity = 2 * o->capacity + 64;
        o->notes = realloc(o->notes, (size_t)o->capacity * sizeof *o->notes);
        if (o->notes == NULL) return DEM_ERROR_MEMORY;
    }
    rank_runs_note *next = memcpy(&o->notes[o->n_notes++], note, sizeof *note);
    return o->scene->is_seen_at_events ? see(s, &next->view) : DEM_OK;
}

static dem_status note_event(void *context, const dem_simulation *s, const dem_event *event)
{
    rank_runs_note note;
    memset(&note, 0, sizeof note);
    memcpy(&note.event, event, sizeof note.event);
    return take_note(context, s, &note);
}

static dem_status note_break(void *context, const dem_simulation *s, const dem_break *broken)
{
    rank_runs_outcome *o = context;
    rank_runs_note note;
    memset(&note, 0, sizeof note);
    memcpy(&note.broken, broken, sizeof note.broken);
    o->n_breaks++;
    return take_note(o, s, &note);
}

static dem_status note_calls(const dem_simulation *s, rank_runs_outcome *o)
{
    enum { MANY = 256 };
    if (o->n_steps % MANY == 1) o->steps = realloc(o->steps, (size_t)(o->n_steps + MANY) * sizeof *o->steps);
    if (o->steps == NULL) return DEM_ERROR_MEMORY;
    o->steps[o->n_steps - 1] = (rank_runs_step){count_calls(s, o), s->events, o->n_stops};
    return DEM_OK;
}

static dem_status see_step(void *context, const dem_simulation *s)
{
    rank_runs_outcome *o = context;
    const rank_runs_scene *scene = o->scene;
    o->n_steps++;
    if (scene->stops != NULL && scene->stops(s, o)) return DEM_STOPPED;
    if (scene->counts_calls) return note_calls(s, o);
    return o->n_steps == scene->step ? look(s, o, RANK_RUNS_STOPS) : DEM_OK;
}

static dem_status see_frame(void *context, const dem_simulation *s)
{
    (void)s;
    ((rank_runs_outcome *)context)->n_frames++;
    return DEM_OK;
}

/* Rank 0 has that of the whole, and keeps it. */
static dem_status keep_checkpoint(void *context, const dem_simulation *s, dem_checkpoint *checkpoint)
{
    rank_runs_outcome *o = context;
    const rank_runs_scene *scene = o->scene;
    o->n_checkpoints++;
    if (o->kept_t > 0.0 || !(scene->keeps != NULL ? scene->keeps(s, o) : o->n_checkpoints == 3)) return DEM_OK;
    o->kept_t = ask_state(s).t;
    o->kept_notes = o->n_notes;
    if (s->model->ranks->rank > 0) return DEM_OK;
    const dem_status status = dem_checkpoint_create(&o->kept);
    return status == DEM_OK ? checkpoint_entries_copy(o->kept, checkpoint) : status;
}

/* ---- runs ---- */

static double stop(const rank_runs_scene *scene, int k)
{
    return scene->t_end * k / (RANK_RUNS_STOPS - 1);
}

/* Where a run from a checkpoint comes to. */
static int first_stop(const rank_runs_outcome *from)
{
    int k = 0;
    while (from != NULL && k < RANK_RUNS_STOPS && stop(from->scene, k) < from->kept_t) k++;
    return k;
}

static dem_status begin(dem_simulation **s, const dem_model *model, const ranks *leads, const rank_runs_outcome *from,
                        rank_runs_outcome *o)
{
    const dem_options *options = &o->scene->options;
    const int n_frames = o->scene->n_frames;
    const bool sees_steps = o->scene->step > 0 || o->scene->counts_calls || o->scene->stops != NULL || n_frames > 0;
    const dem_checkpoint *checkpoint = from != NULL && model->ranks->rank == 0 ? from->kept : NULL;
    const dem_observer observer =
        SIZED(dem_observer, .context = o, .event = note_event, .broken = note_break,
              .step = sees_steps ? see_step : NULL, .interval = n_frames > 0 ? o->scene->t_end / n_frames : 0.0,
              .frame = n_frames > 0 ? see_frame : NULL, .checkpoint = from == NULL ? keep_checkpoint : NULL);
    dem_status status =
        from != NULL ? dem_simulation_resume(s, model, options, checkpoint) : dem_simulation_create(s, model, options);
    if (status == DEM_OK && leads != NULL) status = dem_private_lead(*s, leads, options, checkpoint);
    return status == DEM_OK ? dem_simulation_observe(*s, &observer) : status;
}

static void note_failure(rank_runs_outcome *o, dem_status status)
{
    if (status == DEM_OK || o->status != DEM_OK) return;
    o->status = status;
    (void)snprintf(o->message, RANK_RUNS_TEXT, "%s", dem_status_message());
}

/* What a failed advance leaves is looked at, too. */
static dem_status advance_to(dem_simulation *s, int k, rank_runs_outcome *o)
{
    const double t = stop(o->scene, k);
    dem_status status = dem_simulation_advance(s, t);
    note_failure(o, status);
    if (status != DEM_OK && o->scene->mends != NULL && o->scene->mends(o)) {
        note_failure(o, look(s, o, RANK_RUNS_STOPS));
        status = dem_simulation_advance(s, t);
    }
    const dem_status seen = look(s, o, k);
    o->n_stops++;
    o->calls = count_calls(s, o);
    note_failure(o, seen);
    return status == DEM_OK ? seen : status;
}

static double count_common(const dem_simulation *s)
{
    double least[RANK_SHARES_ALL], most[RANK_SHARES_ALL];
    dem_private_shares(s, least, most);
    return most[RANK_SHARES_COMMON];
}

void rank_runs_go(const dem_model *model, const ranks *leads, const rank_runs_outcome *from, rank_runs_outcome *o)
{
    dem_simulation *s = NULL;
    dem_status status = begin(&s, model, leads, from, o);
    note_failure(o, status);
    if (status == DEM_OK && leads != NULL) o->n_common[0] = count_common(s);
    for (int k = first_stop(from); k < RANK_RUNS_STOPS && status == DEM_OK; k++) status = advance_to(s, k, o);
    if (status == DEM_OK && leads != NULL) o->n_common[1] = count_common(s);
    dem_simulation_destroy(s);
}

rank_runs_outcome rank_runs_alone(const rank_runs_scene *scene)
{
    rank_runs_outcome whole = rank_runs_make_outcome(scene);
    rank_runs_go(scene->model, NULL, NULL, &whole);
    return whole;
}

/* Of all ranks. */
typedef struct shared_run {
    const rank_runs_scene *scene;
    const domain_model_shares *shares;
    const rank_runs_outcome *from;
    rank_runs_outcome *outcomes;
} shared_run;

static void run_rank(const ranks *r, void *context)
{
    const shared_run *c = context;
    dem_model *model = NULL;
    rank_runs_outcome *o = &c->outcomes[r->rank];
    note_failure(o, domain_model_create(&model, r, c->scene->model, c->shares));
    if (o->status == DEM_OK) rank_runs_go(model, NULL, c->from, o);
    dem_model_destroy(model);
}

void rank_runs_together(const rank_runs_scene *scene, int n_ranks, const domain_model_shares *shares,
                        const rank_runs_outcome *from, rank_runs_outcome *out)
{
    rank_threads_run(n_ranks, run_rank, &(shared_run){scene, shares, from, out});
}

/* ---- runs that rank 0 leads ---- */

enum { DISMISSAL = 75 };

typedef struct led_work {
    slab_maker maker;
    rank_threads_work *lead;
    void *context;
    atomic_int n_lost; /* ranks that were dismissed with another number */
} led_work;

static void take_part(const ranks *r, void *context)
{
    led_work *w = context;
    if (r->rank > 0) {
        (void)atomic_fetch_add(&w->n_lost, dem_private_follow(r, &w->maker) != DISMISSAL);
        return;
    }
    w->lead(r, w->context);
    dem_private_dismiss(r, DISMISSAL);
}

void rank_runs_lead(int n_ranks, const slab_maker *maker, rank_threads_work *lead, void *context)
{
    led_work w = {.lead = lead, .context = context};
    if (maker != NULL) w.maker = *maker;
    rank_threads_run(n_ranks, take_part, &w);
    assert_int_equal(atomic_load(&w.n_lost), 0);
}

static void lead_run(const ranks *r, void *context)
{
    const shared_run *c = context;
    rank_runs_go(c->scene->model, r, c->from, c->outcomes);
}

void rank_runs_led(const rank_runs_scene *scene, int n_ranks, const rank_runs_outcome *from, rank_runs_outcome *out)
{
    rank_runs_lead(n_ranks, NULL, lead_run, &(shared_run){.scene = scene, .from = from, .outcomes = out});
}

/* ---- comparison ---- */

static const char *const entries[] = {"sizes",
                                      "motions",
                                      "numbers",
                                      "counts",
                                      "impulses",
                                      "overlap",
                                      "contacts",
                                      "state",
                                      "broken triangles",
                                      "broken springs",
                                      "fracture",
                                      "fillings",
                                      "nodes buried",
                                      "softened triangles",
                                      "friction",
                                      "pause",
                                      "friction of rigid body 0"};

static const char *difference_of_checkpoints(const dem_checkpoint *one, const dem_checkpoint *whole)
{
    for (size_t k = 0; k < sizeof entries / sizeof *entries; k++) {
        size_t size, expected;
        const void *bytes = dem_checkpoint_find(one, entries[k], &size);
        const void *wanted = dem_checkpoint_find(whole, entries[k], &expected);
        if ((bytes != NULL) != (wanted != NULL) || size != expected) return entries[k];
        if (bytes != NULL && memcmp(bytes, wanted, size) != 0) return entries[k];
    }
    return NULL;
}

#define MEMBER(name)                                                                                                   \
    {                                                                                                                  \
#name, offsetof(rank_runs_view, name), sizeof(((rank_runs_view *)0)->name)                                     \
    }

static const struct {
    const char *name;
    size_t at, size;
} members[] = {MEMBER(t),         MEMBER(step),     MEMBER(residual), MEMBER(counts),     MEMBER(energy),
               MEMBER(strain),    MEMBER(surfaces), MEMBER(totals),   MEMBER(ledger),     MEMBER(n_contacts),
               MEMBER(bodies),    MEMBER(pairs),    MEMBER(contacts), MEMBER(boundaries), MEMBER(obstacle),
               MEMBER(stress_at), MEMBER(force_at), MEMBER(overlap)};

static const char *difference_of_views(const rank_runs_view *one, const rank_runs_view *whole)
{
    for (size_t k = 0; k < sizeof members / sizeof *members; k++)
        if (memcmp((const char *)one + members[k].at, (const char *)whole + members[k].at, members[k].size) != 0)
            return members[k].name;
    return NULL;
}

/* A run from a checkpoint has the last notes of one that began. */
static const char *difference_of_notes(const rank_runs_outcome *one, const rank_runs_outcome *whole,
                                       const rank_runs_outcome *from)
{
    const dem_index before = from != NULL ? from->kept_notes : 0;
    if (one->n_notes + before != whole->n_notes) return "number of events and breaks";
    for (dem_index k = 0; k < one->n_notes; k++) {
        const rank_runs_note *here = &one->notes[k], *there = &whole->notes[before + k];
        if (memcmp(&here->event, &there->event, sizeof here->event) != 0) return "event";
        if (memcmp(&here->broken, &there->broken, sizeof here->broken) != 0) return "break";
        const char *what = difference_of_views(&here->view, &there->view);
        if (what != NULL) return what;
    }
    return NULL;
}

static const char *difference_at(const rank_runs_outcome *one, const rank_runs_outcome *whole, int number)
{
    const char *what = difference_of_views(&one->views[number], &whole->views[number]);
    if (what != NULL) return what;
    for (int k = 0; k < RANK_RUNS_ROWS; k++) {
        const size_t n = size_of_rows(whole, k), first = (size_t)number * n;
        if (memcmp(one->rows[k] + first, whole->rows[k] + first, n * sizeof(double)) != 0) return rows[k].name;
    }
    return NULL;
}

const char *rank_runs_difference(const rank_runs_outcome *one, const rank_runs_outcome *whole,
                                 const rank_runs_outcome *from)
{
    const int n_looks = from == NULL ? RANK_RUNS_LOOKS : RANK_RUNS_STOPS;
    if (one->status != whole->status || strcmp(one->message, whole->message) != 0) return "status or message";
    for (int k = first_stop(from); k < n_looks; k++) {
        const char *what = difference_at(one, whole, k);
        if (what != NULL) return what;
    }
    if (from == NULL && (one->n_steps != whole->n_steps || one->n_frames != whole->n_frames))
        return "number of steps or frames";
    if (from == NULL && one->kept_t != whole->kept_t) return "time of the checkpoint that is kept";
    if (one->kept != NULL && whole->kept != NULL) {
        const char *what = difference_of_checkpoints(one->kept, whole->kept);
        if (what != NULL) return what;
    }
    return difference_of_notes(one, whole, from);
}

rank_threads_counts rank_runs_assert_shared(const rank_runs_scene *scene, int n_ranks,
                                            const domain_model_shares *shares, const rank_runs_outcome *from,
                                            const rank_runs_outcome *whole)
{
    rank_runs_outcome all[RANK_RUNS_MOST];
    rank_runs_make_outcomes(scene, n_ranks, all);
    rank_runs_together(scene, n_ranks, shares, from, all);
    for (int k = 0; k < n_ranks; k++) {
        const char *what = rank_runs_difference(&all[k], whole, from);
        if (what != NULL) fail_msg("rank %d of %d has another %s: '%s'", k, n_ranks, what, all[k].message);
    }
    const rank_threads_counts calls = all[0].calls;
    rank_runs_free_outcomes(all, n_ranks);
    return calls;
}

void rank_runs_assert_led(const rank_runs_scene *scene, int n_ranks, const rank_runs_outcome *from,
                          const rank_runs_outcome *whole)
{
    rank_runs_outcome led = rank_runs_make_outcome(scene);
    rank_runs_led(scene, n_ranks, from, &led);
    const char *what = rank_runs_difference(&led, whole, from);
    if (what != NULL) fail_msg("a leader of %d ranks has another %s: '%s'", n_ranks, what, led.message);
    rank_runs_free_outcome(&led);
}
