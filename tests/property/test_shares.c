/* SPDX-License-Identifier: BSD-3-Clause */
/* A run is the same to the last bit on any number of ranks, whichever owns which node: random bodies among random
 * obstacles, by both methods of contact, and crowds that run into each other. `test_shares [CASES [FIRST_SEED]]`. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ask.h"
#include "crowd.h"
#include "harness/rank_threads.h"
#include "model/domain_model.h"
#include "scene.h"

enum { MOST_RANKS = 5, TEXT = 256 };

static long n_cases = 6, first_seed = 1;

/* What is run. */
typedef struct problem {
    const dem_lattice *lattice;
    const dem_obstacle *obstacles; /* [n] */
    int n;
    const dem_options *options;
    double t_end; /* s */
} problem;

/* How a run ends. */
typedef struct ending {
    double t, step;
    dem_counts counts;
    dem_energy energy;
    dem_surfaces surfaces;
    uint64_t events; /* a hash of all that is said of them */
    double *x, *v;   /* [n][2] of the whole */
    dem_status status;
    char message[TEXT];
} ending;

static ending make_ending(dem_index n)
{
    ending e = {.x = calloc(2 * (size_t)n, sizeof(double)), .v = calloc(2 * (size_t)n, sizeof(double))};
    assert_true(e.x != NULL && e.v != NULL);
    return e;
}

static void free_ending(ending *e)
{
    free(e->x);
    free(e->v);
}

/* By Fowler, Noll and Vo. */
static dem_status note_event(void *context, const dem_simulation *s, const dem_event *event)
{
    ending *e = context;
    const unsigned char *bytes = (const unsigned char *)event;
    (void)s;
    for (size_t k = 0; k < sizeof *event; k++) e->events = (e->events ^ bytes[k]) * 1099511628211u;
    return DEM_OK;
}

/* Ranks write the rows of their own nodes. */
static dem_status see_end(const dem_simulation *s, ending *e)
{
    dem_state seen = {.struct_size = sizeof seen};
    const dem_model *model = dem_simulation_model(s);
    const domain *d = model->domain;
    e->counts.struct_size = sizeof e->counts;
    dem_status status = dem_simulation_state(s, &seen);
    if (status == DEM_OK) status = dem_simulation_counts(s, &e->counts);
    if (status != DEM_OK) return status;
    e->energy = ask_energy(s);
    e->surfaces = ask_surfaces(s);
    e->t = seen.t;
    e->step = seen.step;
    for (dem_index i = 0; i < model->lattice.n_nodes; i++) {
        if (!domain_owns(d, i)) continue;
        memcpy(e->x + 2 * domain_number(d, i), seen.x + 2 * i, 2 * sizeof *seen.x);
        memcpy(e->v + 2 * domain_number(d, i), seen.v + 2 * i, 2 * sizeof *seen.v);
    }
    return DEM_OK;
}

static void run(const dem_model *model, const problem *p, ending *e)
{
    dem_simulation *s = NULL;
    const dem_observer observer = SIZED(dem_observer, .context = e, .event = note_event);
    e->status = dem_simulation_create(&s, model, p->options);
    if (e->status == DEM_OK) e->status = dem_simulation_observe(s, &observer);
    if (e->status == DEM_OK) e->status = dem_simulation_advance(s, p->t_end);
    if (e->status != DEM_OK) (void)snprintf(e->message, TEXT, "%s", dem_status_message());
    if (s != NULL && see_end(s, e) != DEM_OK) (void)snprintf(e->message, TEXT, "its end cannot be seen");
    dem_simulation_destroy(s);
}

/* Of all ranks. */
typedef struct shared_run {
    const problem *problem;
    const dem_model *whole;
    domain_model_shares shares;
    ending *ends; /* [ranks] whose x and v are one */
} shared_run;

static void run_rank(const ranks *r, void *context)
{
    const shared_run *c = context;
    ending *e = &c->ends[r->rank];
    dem_model *model = NULL;
    e->status = domain_model_create(&model, r, c->whole, &c->shares);
    if (e->status == DEM_OK)
        run(model, c->problem, e);
    else
        (void)snprintf(e->message, TEXT, "%s", dem_status_message());
    dem_model_destroy(model);
}

static bool is_same(const ending *a, const ending *b, dem_index n)
{
    const size_t size = 2 * (size_t)n * sizeof(double);
    return a->status == b->status && strcmp(a->message, b->message) == 0 && a->t == b->t && a->step == b->step &&
           a->events == b->events && memcmp(&a->counts, &b->counts, sizeof a->counts) == 0 &&
           memcmp(&a->energy, &b->energy, sizeof a->energy) == 0 &&
           memcmp(&a->surfaces, &b->surfaces, sizeof a->surfaces) == 0 && memcmp(a->x, b->x, size) == 0 &&
           memcmp(a->v, b->v, size) == 0;
}

/* Any rank may own any node; each has one at least. */
static void draw_owners(int32_t *owner, dem_index n, int n_ranks, unsigned long seed)
{
    gsl_rng *random = gsl_rng_alloc(gsl_rng_taus);
    gsl_rng_set(random, seed);
    for (dem_index i = 0; i < n; i++) owner[i] = (int32_t)gsl_rng_uniform_int(random, (unsigned long)n_ranks);
    for (int k = 0; k < n_ranks; k++) owner[k * (n / n_ranks)] = k;
    gsl_rng_free(random);
}

/* \return whether surfaces push each other at the end */
static bool check(const problem *p, unsigned long seed)
{
    const dem_index n = p->lattice->n_nodes;
    CLEANUP(free_model) dem_model *whole = support_model(p->lattice, p->obstacles, p->n);
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)n * sizeof *owner);
    ending alone = make_ending(n);
    run(whole, p, &alone);
    for (int n_ranks = 2; n_ranks <= MOST_RANKS && n_ranks <= n; n_ranks += 3) {
        ending ends[MOST_RANKS] = {make_ending(n)};
        for (int k = 1; k < n_ranks; k++) ends[k] = ends[0];
        draw_owners(owner, n, n_ranks, seed);
        rank_threads_run(
            n_ranks, run_rank,
            &(shared_run){
                p,
                whole,
                {.owner = owner, .touching = p->options->bodies != DEM_BODIES_NONE, .n_rings = n_ranks == 2 ? 3 : 1},
                ends});
        for (int k = 0; k < n_ranks; k++)
            if (!is_same(&ends[k], &alone, n))
                fail_msg("seed %lu, contact %d, method %d: rank %d of %d ends otherwise: '%s', alone '%s'", seed,
                         (int)p->options->contact, (int)p->options->method, k, n_ranks, ends[k].message, alone.message);
        free_ending(&ends[0]);
    }
    const bool pushes = alone.surfaces.pushing > 0;
    free_ending(&alone);
    return pushes;
}

TEST(who_owns_which_node_leaves_no_trace)
{
    static const dem_method methods[3] = {DEM_METHOD_FEHLBERG45, DEM_METHOD_VERLET, DEM_METHOD_RK4};
    for (long k = 0; k < n_cases; k++)
        for (int exact = 0; exact < 2; exact++) {
            CLEANUP(scene_free) scene sc;
            const unsigned long seed = (unsigned long)(first_seed + k);
            scene_random(&sc, seed);
            sc.options.contact = exact ? DEM_CONTACT_EXACT : DEM_CONTACT_LOCAL;
            sc.options.method = methods[k % 3];
            sc.options.checkpoint_steps = 0;
            (void)check(&(problem){&sc.body, sc.obstacles, sc.n, &sc.options, 0.5 * sc.t_end}, seed);
        }
}

/* Half as many, as they are larger. */
TEST(who_owns_which_node_of_a_crowd_leaves_no_trace)
{
    bool pushes = false;
    for (long k = 0; 2 * k < n_cases; k++) {
        crowd c;
        const unsigned long seed = (unsigned long)(first_seed + k);
        crowd_draw(&c, seed);
        pushes = check(&(problem){&c.lattice, &c.walls, c.boxed, &c.options, 3e-3}, seed) || pushes;
        dem_lattice_free(&c.lattice);
    }
    assert_true(pushes || n_cases < 6);
}

int main(int argc, char **argv)
{
    if (argc > 1) n_cases = atol(argv[1]);
    if (argc > 2) first_seed = atol(argv[2]);
    return test_run();
}
