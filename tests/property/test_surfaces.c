/* SPDX-License-Identifier: BSD-3-Clause */
/* A candidate counts from when it comes until it goes, whatever its number: random bodies run with all of their
 * surface, and again with parts of it that nothing touches left out until half-time, or from then on. They end in the
 * same bits. `test_surfaces [CASES [FIRST_SEED]]`. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "simulation/private.h"

#include "harness/cleanup_gsl.h"
#include "harness/motion.h"
#include "scene.h"

static long n_cases = 20, first_seed = 1;

/* Nodes with events until a time, and from a time on. */
typedef struct touched {
    double half; /* s */
    unsigned char *early, *late;
} touched;

static void mark(unsigned char *flags, const dem_event *event)
{
    flags[event->node] = 1;
    if (event->other >= 0) flags[event->other] = 1;
}

/* A step goes on beyond half-time, and has begun before it. */
static dem_status hear(void *context, const dem_simulation *simulation, const dem_event *event)
{
    const touched *s = context;
    (void)simulation;
    if (event->t < 1.2 * s->half) mark(s->early, event);
    if (event->t > 0.8 * s->half) mark(s->late, event);
    return DEM_OK;
}

/* Contacts that last have no events. */
static void mark_closed(const dem_simulation *simulation, unsigned char *flags)
{
    motion state;
    motion_see(simulation, &state);
    for (dem_index k = 0; k < state.n_contacts; k++)
        for (int p = 0; p < state.contacts[k].n_nodes; p++) flags[state.contacts[k].nodes[p]] = 1;
}

/* A surface without the nodes that are not marked, in the same order, as ties and groups are in it. */
static surface cut_out(const surface *whole, const unsigned char *marked, dem_index n_nodes)
{
    const size_t n = (size_t)n_nodes + 1, n_edges = (size_t)whole->n_edges + 1;
    surface s = {.nodes = calloc(n, sizeof *s.nodes), .row = calloc(n, sizeof *s.row)};
    s.ends = calloc(2 * n_edges, sizeof *s.ends);
    s.at = calloc(2 * n_edges, sizeof *s.at);
    s.next = calloc(n_edges, sizeof *s.next);
    s.previous = calloc(n_edges, sizeof *s.previous);
    CLEANUP(free_memory) dem_index *number = calloc(n_edges, sizeof *number);
    assert_true(s.nodes && s.row && s.ends && s.at && s.next && s.previous && number);
    for (dem_index k = 0; k < whole->n_nodes; k++)
        if (marked[whole->nodes[k]]) s.nodes[s.n_nodes++] = whole->nodes[k];
    for (dem_index e = 0; e < whole->n_edges; e++) {
        const dem_index *ends = &whole->ends[2 * e];
        number[e] = marked[ends[0]] && marked[ends[1]] ? s.n_edges++ : -1;
        if (number[e] >= 0) memcpy(&s.ends[2 * number[e]], ends, 2 * sizeof *ends);
    }
    for (dem_index e = 0; e < whole->n_edges; e++) {
        if (number[e] < 0) continue;
        s.next[number[e]] = whole->next[e] >= 0 ? number[whole->next[e]] : -1;
        s.previous[number[e]] = whole->previous[e] >= 0 ? number[whole->previous[e]] : -1;
    }
    for (dem_index i = 0; i < n_nodes; i++) {
        s.row[i + 1] = s.row[i];
        for (dem_index p = whole->row[i]; p < whole->row[i + 1]; p++)
            if (number[whole->at[p]] >= 0) s.at[s.row[i + 1]++] = number[whole->at[p]];
    }
    return s;
}

/* The surface without half of the nodes that are further than two edges from the marked ones: an event changes what is
 * next to it, and an edge knows its neighbours. */
static surface thin_out(const dem_model *model, const unsigned char *marked, gsl_rng *rng)
{
    const dem_index n = model->lattice.n_nodes;
    const surface *whole = &model->surface;
    unsigned char *flags = malloc(2 * (size_t)n), *before = flags + n;
    assert_non_null(flags);
    memcpy(flags, marked, (size_t)n);
    for (int ring = 0; ring < 2; ring++) {
        memcpy(before, flags, (size_t)n);
        for (dem_index k = 0; k < 2 * whole->n_edges; k++) flags[whole->ends[k]] |= before[whole->ends[k ^ 1]];
    }
    for (dem_index i = 0; i < n; i++) flags[i] |= gsl_rng_uniform(rng) < 0.5;
    const surface out = cut_out(whole, flags, n);
    free(flags);
    return out;
}

static void follow(dem_simulation *simulation, const surface *to)
{
    assert_ok(contact_source_follow_surface(&simulation->contact_events, to));
    assert_true(simulation->automaton.set.surface == to);
}

static dem_simulation *run(const dem_model *model, const scene *sc, const surface *first, const surface *second)
{
    dem_simulation *simulation = support_simulation(model, &sc->options);
    follow(simulation, first);
    assert_ok(dem_simulation_advance(simulation, 0.5 * sc->t_end));
    follow(simulation, second);
    assert_ok(dem_simulation_advance(simulation, sc->t_end));
    return simulation;
}

static void check_same(const dem_simulation *a, dem_simulation *b, unsigned long seed, const char *what)
{
    const dem_counts counts_a = ask_counts(a), counts_b = ask_counts(b);
    const size_t size = 2 * (size_t)a->model->lattice.n_nodes * sizeof(double);
    motion end_a, end_b;
    motion_see(a, &end_a);
    motion_see(b, &end_b);
    if (memcmp(end_a.x, end_b.x, size) != 0 || memcmp(end_a.v, end_b.v, size) != 0 ||
        memcmp(&counts_a, &counts_b, sizeof counts_a) != 0 || end_a.n_contacts != end_b.n_contacts)
        fail_msg("seed %lu: candidates that %s leave a trace", seed, what);
    dem_simulation_destroy(b);
}

/* Runs it with all of the surface, and notes what is touched. */
static dem_simulation *run_whole(const dem_model *model, const scene *sc, touched *nodes)
{
    const dem_observer observer = {.struct_size = sizeof(dem_observer), .context = nodes, .event = hear};
    dem_simulation *simulation = support_simulation(model, &sc->options);
    assert_ok(dem_simulation_observe(simulation, &observer));
    assert_ok(dem_simulation_advance(simulation, nodes->half));
    mark_closed(simulation, nodes->late);
    assert_ok(dem_simulation_advance(simulation, sc->t_end));
    return simulation;
}

/* \return candidates that came or went */
static dem_index check_scene(unsigned long seed, gsl_rng *rng)
{
    CLEANUP(scene_free) scene sc;
    scene_random(&sc, seed);
    sc.options.contact = DEM_CONTACT_LOCAL;
    dem_model *model = support_model(&sc.body, sc.obstacles, sc.n);
    const size_t n = (size_t)model->lattice.n_nodes;
    touched nodes = {0.5 * sc.t_end, calloc(n, 1), calloc(n, 1)};
    assert_true(nodes.early != NULL && nodes.late != NULL);
    dem_simulation *whole = run_whole(model, &sc, &nodes);
    surface before = thin_out(model, nodes.early, rng), after = thin_out(model, nodes.late, rng);
    check_same(whole, run(model, &sc, &before, &model->surface), seed, "come");
    check_same(whole, run(model, &sc, &model->surface, &after), seed, "go");
    check_same(whole, run(model, &sc, &before, &after), seed, "come and go");
    const dem_index changes = 2 * model->surface.n_nodes - before.n_nodes - after.n_nodes;
    dem_simulation_destroy(whole);
    surface_free(&before);
    surface_free(&after);
    dem_model_destroy(model);
    free(nodes.early);
    free(nodes.late);
    return changes;
}

TEST(candidates_that_come_and_go_leave_no_trace)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    dem_index changes = 0;
    for (long k = 0; k < n_cases; k++) changes += check_scene((unsigned long)(first_seed + k), rng);
    print_message("# %lld candidates came or went\n", (long long)changes);
    assert_true(changes > 5 * n_cases);
}

int main(int argc, char **argv)
{
    if (argc > 1) n_cases = strtol(argv[1], NULL, 10);
    if (argc > 2) first_seed = strtol(argv[2], NULL, 10);
    return test_run();
}
