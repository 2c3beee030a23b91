/* SPDX-License-Identifier: BSD-3-Clause */
/* The order of independent events leaves no trace. Events of a step that are far apart, and between which no group of
 * contacts reaches, read nothing of each other: taken in any order that keeps those near each other in the order of
 * time, they give the same bits, of all that is reported too. A long body lands on flat and on uneven ground; once the
 * next event is the first of all, and then one at random of those before which none is near. `test_orders [CASES
 * [FIRST_SEED]]`. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_rng.h>

#include "harness/motion.h"
#include "simulation/private.h"
#include "verification/support.h"

static long n_cases = 12, first_seed = 1;

/* An event moves 3 rings round its nodes and reads 6: two of them that are further apart are independent. One ring more
 * for the seeds, and what groups of contacts on uneven ground may reach. */
static const double spacing = 0.01, near = 20.0; /* m; spacings */

/* ---- a source that does not give the first event ---- */

/* The one of the simulation under way. */
static const contact_source *contacts;
static gsl_rng *dice;
static long n_not_first;

static bool comes_before(const event_heap *h, dem_index a, dem_index b)
{
    if (h->due[a] != h->due[b]) return h->due[a] < h->due[b];
    if (h->generation[a] != h->generation[b]) return h->generation[a] < h->generation[b];
    return h->order.before(h->order.self, a, b);
}

static double distance(dem_index a, dem_index b)
{
    const contact_set *c = &contacts->automaton->set;
    const double *x = c->scene.model->lattice.position;
    const dem_index i = c->list[a].node, j = c->list[b].node;
    return hypot(x[2 * i] - x[2 * j], x[2 * i + 1] - x[2 * j + 1]);
}

/* Whether no event that comes before it is near. */
static bool is_independent(const event_heap *h, dem_index key)
{
    for (dem_index p = 0; p < h->n; p++)
        if (comes_before(h, h->keys[p], key) && distance(h->keys[p], key) < near * spacing) return false;
    return true;
}

static event_due next_of_any(const void *self)
{
    const event_heap *h = &contacts->heap;
    dem_index n = 0, key = event_heap_first(h);
    (void)self;
    for (dem_index p = 0; p < h->n; p++) {
        if (!is_independent(h, h->keys[p])) continue;
        if (gsl_rng_uniform_int(dice, (unsigned long)++n) == 0) key = h->keys[p];
    }
    n_not_first += key != event_heap_first(h);
    return key >= 0 ? (event_due){h->due[key], h->generation[key], key} : (event_due){.t = (double)INFINITY};
}

/* ---- scenes ---- */

static const dem_method methods[] = {DEM_METHOD_FEHLBERG45, DEM_METHOD_VERLET, DEM_METHOD_DOPRI45, DEM_METHOD_RK4};

enum { N_METHODS = sizeof methods / sizeof *methods, MOST_POINTS = 64, MOST_NODES = 128 };

typedef struct landing {
    dem_lattice body;
    double points[2 * MOST_POINTS];
    dem_obstacle ground;
    dem_index top[MOST_NODES];
    dem_boundary press;
    dem_options options;
} landing;

static double between(gsl_rng *rng, double low, double high)
{
    return low + (high - low) * gsl_rng_uniform(rng);
}

/* Flat, or with bends some five spacings apart, which edges touch as well; at rest, or shaken. */
static void make_ground(landing *l, gsl_rng *rng)
{
    const bool flat = gsl_rng_uniform_int(rng, 2) == 0, shaken = gsl_rng_uniform_int(rng, 3) == 0;
    const int n = flat ? 2 : 20;
    for (int k = 0; k < n; k++) {
        l->points[2 * k] = -0.5 + 1.0 * k / (n - 1);
        l->points[2 * k + 1] = flat ? 0.0 : between(rng, -0.004, 0.004);
    }
    l->ground = (dem_obstacle){.struct_size = sizeof l->ground,
                               .n_points = n,
                               .points = l->points,
                               .restitution = 0.5 * (double)gsl_rng_uniform_int(rng, 3),
                               .friction = 0.3 * (double)gsl_rng_uniform_int(rng, 2),
                               .amplitude = {0.0, shaken ? 1e-3 : 0.0},
                               .frequency = shaken ? 200.0 : 0.0};
}

/* A force on the upper side that grows all the time, so that forces depend on the time; drag, which takes energy. */
static void make_load(landing *l, gsl_rng *rng)
{
    const double top = support_top(&l->body) - 0.5 * spacing;
    l->options = dem_options_default();
    if (gsl_rng_uniform_int(rng, 3) == 0) l->options.mass_damping = 20.0;
    if (gsl_rng_uniform_int(rng, 2) == 0) return;
    l->press = (dem_boundary){.struct_size = sizeof l->press,
                              .kind = DEM_BOUNDARY_FORCE,
                              .nodes = l->top,
                              .value = {100.0, -5e4},
                              .ramp = 0.05};
    for (dem_index i = 0; i < l->body.n_nodes; i++)
        if (l->body.x[2 * i + 1] > top && l->press.n_nodes < MOST_NODES) l->top[l->press.n_nodes++] = i;
    l->options.n_boundaries = 1;
    l->options.boundaries = &l->press;
}

static void throw(dem_lattice * body, gsl_rng *rng)
{
    double *v = malloc(2 * (size_t)body->n_nodes * sizeof *v);
    assert_non_null(v);
    for (dem_index i = 0; i < body->n_nodes; i++) {
        v[2 * i] = 1.0 + between(rng, -0.3, 0.3);
        v[2 * i + 1] = -4.0 + between(rng, -0.3, 0.3);
    }
    support_start(body, NULL, v);
    free(v);
}

static void make_landing(landing *l, unsigned long seed)
{
    static const dem_material rubber = {.struct_size = sizeof(dem_material),
                                        .youngs_modulus = 1e7,
                                        .poissons_ratio = 1.0 / 3.0,
                                        .density = 1050.0,
                                        .thickness = 1.0};
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    assert_non_null(rng);
    gsl_rng_set(rng, seed);
    l->body = support_rectangle(0.8, 0.04, spacing, &rubber);
    make_ground(l, rng);
    make_load(l, rng);
    dem_lattice_move(&l->body, between(rng, -0.01, 0.01), (const double[2]){0.0, 0.02});
    throw(&l->body, rng);
    l->options.method = methods[seed % N_METHODS];
    gsl_rng_free(rng);
}

static void free_landing(landing *l)
{
    dem_lattice_free(&l->body);
}

/* ---- runs ---- */

/* Hashes of what is seen after every step, and what has happened in the end. */
typedef struct account {
    uint64_t motion, energies, counts, loads;
    dem_index n_events;
} account;

static void add(uint64_t *hash, const void *bytes, size_t n)
{
    for (size_t k = 0; k < n; k++) *hash = (*hash ^ ((const unsigned char *)bytes)[k]) * 1099511628211u;
}

static dem_status note(void *context, const dem_simulation *simulation)
{
    account *a = context;
    const size_t n = 2 * (size_t)ask_sizes(dem_simulation_model(simulation)).n_nodes;
    motion s;
    motion_see(simulation, &s);
    const dem_counts counts = ask_counts(simulation);
    const dem_obstacle_load load = ask_obstacle(simulation, 0);
    add(&a->motion, (const double[]){s.t, s.step}, 2 * sizeof(double));
    add(&a->motion, s.x, n * sizeof *s.x);
    add(&a->motion, s.v, n * sizeof *s.v);
    add(&a->energies, &s.energy, sizeof s.energy);
    add(&a->counts, &counts, sizeof counts);
    add(&a->loads, &load, sizeof load);
    a->n_events = counts.impacts + counts.releases + counts.slips + counts.sticks;
    return DEM_OK;
}

static account run(const landing *l, bool shuffled)
{
    account a = {.n_events = 0};
    const dem_observer observer = {.struct_size = sizeof observer, .step = note, .context = &a};
    CLEANUP(free_model) dem_model *model = support_model(&l->body, &l->ground, 1);
    CLEANUP(free_simulation) dem_simulation *s = support_simulation(model, &l->options);
    assert_ok(dem_simulation_observe(s, &observer));
    contacts = &s->contact_events;
    if (shuffled) s->sources.list[0].next = next_of_any;
    assert_ok(dem_simulation_advance(s, 0.012));
    return a;
}

static void assert_same(const account *a, const account *b)
{
    assert_true(a->motion == b->motion);
    assert_true(a->energies == b->energies);
    assert_true(a->counts == b->counts);
    assert_true(a->loads == b->loads);
}

TEST(the_order_of_independent_events_leaves_no_trace)
{
    dice = gsl_rng_alloc(gsl_rng_mt19937);
    assert_non_null(dice);
    n_not_first = 0;
    for (long seed = first_seed; seed < first_seed + n_cases; seed++) {
        CLEANUP(free_landing) landing l = {.press = {.n_nodes = 0}};
        make_landing(&l, (unsigned long)seed);
        const account usual = run(&l, false), other = run(&l, true);
        print_message("# %ld: method %d, restitution %g, friction %g, %lld points%s%s: %lld events\n", seed,
                      (int)l.options.method, l.ground.restitution, l.ground.friction, (long long)l.ground.n_points,
                      l.ground.frequency > 0.0 ? ", shaken" : "", l.press.n_nodes > 0 ? ", pressed" : "",
                      (long long)other.n_events);
        assert_same(&usual, &other);
    }
    print_message("# %ld events were not the first\n", n_not_first);
    assert_true(n_not_first > 10 * n_cases);
    gsl_rng_free(dice);
}

int main(int argc, char **argv)
{
    if (argc > 1) n_cases = atol(argv[1]);
    if (argc > 2) first_seed = atol(argv[2]);
    return test_run();
}
