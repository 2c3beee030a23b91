/* SPDX-License-Identifier: BSD-3-Clause */
/* A run is the same to the last bit on any number of ranks, with any number of threads, whichever owns which node:
 * random bodies among random obstacles, by both methods of contact, crowds that run into each other, crowds that break,
 * and bodies that break in a few places. Each case has some of the ways to share it, or with 'all' all of them; by
 * every other one it goes on from a checkpoint.
 * `test_shares [CASES [FIRST_SEED [all]]]`. */
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_rng.h>

#include "crowd.h"
#include "domain/partition.h"
#include "scene.h"
#include "verification/rank_runs.h"
#include "verification/scattered.h"

static long n_cases = 6, first_seed = 1, n_runs = 0, n_resumed = 0;
static bool has_all = false;

/* ---- ways to share a lattice ---- */

typedef enum shares_kind { BISECTED, SCATTERED, DRAWN, N_SHARES } shares_kind;

/* Any rank may own any node. */
static void draw_owners(int32_t *owner, dem_index n, int n_ranks, unsigned long seed)
{
    gsl_rng *random = gsl_rng_alloc(gsl_rng_taus);
    gsl_rng_set(random, seed);
    for (dem_index i = 0; i < n; i++) owner[i] = (int32_t)gsl_rng_uniform_int(random, (unsigned long)n_ranks);
    gsl_rng_free(random);
}

/* Each rank has one node at least. */
static void find_owners(const dem_lattice *l, double spacing, shares_kind how, int n_ranks, unsigned long seed,
                        int32_t *owner)
{
    if (how == BISECTED) assert_ok(partition_bisect(l, n_ranks, owner));
    if (how == SCATTERED) scatter(l, 3.1 * spacing, n_ranks, owner);
    if (how == DRAWN) draw_owners(owner, l->n_nodes, n_ranks, seed);
    if (how == BISECTED) return;
    for (int k = 0; k < n_ranks; k++) owner[k * (l->n_nodes / n_ranks)] = k;
}

/* ---- runs ---- */

/* \param from  of whose checkpoint ranks go on; NULL: they begin */
static void compare(const rank_runs_scene *run, const rank_runs_outcome *from, const rank_runs_outcome *alone,
                    int n_ranks, shares_kind how, unsigned long seed)
{
    const dem_lattice *l = dem_model_lattice(run->model);
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)l->n_nodes * sizeof *owner);
    rank_runs_outcome all[RANK_RUNS_MOST];
    find_owners(l, dem_model_spacing(run->model), how, n_ranks, seed, owner);
    rank_runs_make_outcomes(run, n_ranks, all);
    rank_runs_together(run, n_ranks,
                       &(domain_model_shares){.owner = owner,
                                              .touching = run->options.bodies != DEM_BODIES_NONE,
                                              .n_rings = n_ranks % 2 == 0 ? 3 : 1},
                       from, all);
    for (int k = 0; k < n_ranks; k++) {
        const char *what = rank_runs_difference(&all[k], alone, from);
        if (what != NULL)
            fail_msg(
                "seed %lu, contact %d, method %d, threads %d, shares %d: rank %d of %d has another %s: '%s', alone "
                "'%s'",
                seed, (int)run->options.contact, (int)run->options.method, (int)run->options.threads, (int)how, k,
                n_ranks, what, all[k].message, alone->message);
    }
    rank_runs_free_outcomes(all, n_ranks);
}

/* Of the ways to share it two, others for each seed, or all; every other one from a checkpoint, if there is one.
 * \return what a process alone sees */
static rank_runs_outcome check(rank_runs_scene *run, unsigned long seed)
{
    enum { N_NUMBERS = 5, N_WAYS = 2 * N_NUMBERS * N_SHARES, SOME = 2 };
    static const int numbers[N_NUMBERS] = {2, 5, 7, 3, 4};
    const dem_index n = dem_model_lattice(run->model)->n_nodes;
    rank_runs_outcome alone = rank_runs_alone(run);
    run->options.thread_nodes = 10;
    for (unsigned long k = 0; k < (has_all ? N_WAYS : SOME); k++) {
        const unsigned long way = has_all ? k : 7 * seed + 13 * k;
        const int n_ranks = numbers[way % N_NUMBERS];
        run->options.threads = 1 + (int)(way / (N_NUMBERS * N_SHARES) % 2);
        const rank_runs_outcome *from = k % 2 == 1 && alone.kept != NULL ? &alone : NULL;
        n_runs += n_ranks <= n;
        n_resumed += n_ranks <= n && from != NULL;
        if (n_ranks <= n) compare(run, from, &alone, n_ranks, (shares_kind)(way / N_NUMBERS % N_SHARES), seed);
    }
    return alone;
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
            CLEANUP(free_model) dem_model *whole = support_model(&sc.body, sc.obstacles, sc.n);
            rank_runs_scene run = {.model = whole, .options = sc.options, .t_end = 0.5 * sc.t_end};
            run.options.checkpoint_steps = 15;
            rank_runs_outcome alone = check(&run, seed);
            rank_runs_free_outcome(&alone);
        }
}

/* \return what a process alone sees */
static rank_runs_outcome check_crowd(crowd *c, double t_end)
{
    CLEANUP(free_model) dem_model *whole = support_model(&c->lattice, &c->walls, c->boxed);
    rank_runs_scene run = {.model = whole, .options = c->options, .t_end = t_end};
    run.options.checkpoint_steps = 40;
    rank_runs_outcome alone = check(&run, (unsigned long)c->seed);
    alone.scene = NULL;
    return alone;
}

/* Half as many, as they are larger. */
TEST(who_owns_which_node_of_a_crowd_leaves_no_trace)
{
    bool pushes = false;
    for (long k = 0; 2 * k < n_cases; k++) {
        crowd c;
        crowd_draw(&c, (uint64_t)(first_seed + k));
        rank_runs_outcome alone = check_crowd(&c, 3e-3);
        for (int q = 0; q < RANK_RUNS_STOPS; q++) pushes = pushes || alone.views[q].surfaces.pushing > 0;
        rank_runs_free_outcome(&alone);
        dem_lattice_free(&c.lattice);
    }
    assert_true(pushes || n_cases < 6);
}

/* By stress or by stretch, of each triangle or spring another one: impacts at the speed of a crowd break some. */
static void weaken(dem_lattice *l, uint64_t seed)
{
    const bool by_stress = seed % 2 == 0;
    const dem_index n = by_stress ? l->n_triangles : l->n_springs;
    double *limits = malloc((size_t)n * sizeof *limits);
    assert_non_null(limits);
    for (dem_index k = 0; k < n; k++) limits[k] = (by_stress ? 5e5 : 0.06) * (1.0 + 0.4 * sin(3.0 * (double)k));
    *(by_stress ? &l->strength : &l->critical_stretch) = limits;
}

TEST(who_owns_which_node_of_a_crowd_that_breaks_leaves_no_trace)
{
    dem_index n_breaks = 0;
    for (long k = 0; 2 * k < n_cases; k++) {
        crowd c;
        crowd_draw(&c, (uint64_t)(first_seed + k));
        weaken(&c.lattice, c.seed);
        rank_runs_outcome alone = check_crowd(&c, 1.5e-3);
        n_breaks += alone.n_breaks;
        rank_runs_free_outcome(&alone);
        dem_lattice_free(&c.lattice);
    }
    assert_true(n_breaks > 0 || n_cases < 6);
}

/* ---- bodies of which a part may break ---- */

enum { MOST_PLACES = 3 };

static double draw(gsl_rng *random, double low, double high)
{
    return low + (high - low) * gsl_rng_uniform(random);
}

/* By stress or by stretch, at some nodes as far as a few spacings. */
static void weaken_places(dem_lattice *l, gsl_rng *random, uint64_t seed)
{
    const bool by_stress = seed % 2 == 0;
    const dem_index n = by_stress ? l->n_triangles : l->n_springs, arity = by_stress ? 3 : 2;
    const dem_index *nodes = by_stress ? l->triangles : l->ends;
    dem_index place[MOST_PLACES];
    double reach[MOST_PLACES];
    for (int q = 0; q < MOST_PLACES; q++) {
        place[q] = (dem_index)gsl_rng_uniform_int(random, (unsigned long)l->n_nodes);
        reach[q] = draw(random, 0.0, 0.02);
    }
    weaken(l, seed);
    double *limits = by_stress ? l->strength : l->critical_stretch;
    for (dem_index k = 0; k < n; k++) {
        bool is_near = false;
        for (int q = 0; q < MOST_PLACES; q++) {
            const double *x = l->x + 2 * nodes[arity * k], *y = l->x + 2 * place[q];
            is_near = is_near || hypot(x[0] - y[0], x[1] - y[1]) < reach[q];
        }
        limits[k] = is_near ? 0.4 * limits[k] : (double)INFINITY;
    }
}

/* A ring or a rectangle of 900 nodes or so that is pulled and turned. */
static dem_lattice draw_body(gsl_rng *random, uint64_t seed)
{
    const dem_outline ring = SIZED(dem_outline, .kind = DEM_OUTLINE_RING, .radius = 0.08, .inner_radius = 0.045),
                      plate = SIZED(dem_outline, .size = {0.15, 0.08});
    const dem_shape shape = SIZED(dem_shape, .outline = seed % 3 == 0 ? &plate : &ring, .spacing = 4e-3);
    const dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0,
                                      .density = 1050.0, .thickness = 1.0, .guard = 0.02);
    double rate[4];
    dem_lattice l = dem_lattice_empty();
    assert_ok(dem_shape_lattice(&l, &shape, NULL));
    assert_ok(dem_lattice_assemble(&l, &rubber));
    dem_lattice_move(&l, draw(random, -3.0, 3.0), (const double[2]){0.0, 0.0});
    weaken_places(&l, random, seed);
    for (int c = 0; c < 4; c++) rate[c] = draw(random, -150.0, 150.0); /* 1/s */
    l.velocity = calloc(2 * (size_t)l.n_nodes, sizeof *l.velocity);
    for (dem_index i = 0; i < l.n_nodes; i++)
        for (int c = 0; c < 2; c++) l.velocity[2 * i + c] = rate[2 * c] * l.x[2 * i] + rate[2 * c + 1] * l.x[2 * i + 1];
    return l;
}

TEST(who_owns_which_node_of_a_body_that_breaks_in_places_leaves_no_trace)
{
    static const dem_method methods[3] = {DEM_METHOD_VERLET, DEM_METHOD_FEHLBERG45, DEM_METHOD_RK4};
    static const double floor_points[4] = {-1.0, 0.0, 1.0, 0.0};
    const dem_obstacle floor = SIZED(dem_obstacle, .n_points = 2, .points = floor_points, .restitution = 0.4);
    dem_index n_breaks = 0;
    for (long k = 0; k < n_cases; k++) {
        const uint64_t seed = (uint64_t)(first_seed + k);
        const bool falls = seed % 4 == 1;
        gsl_rng *random = gsl_rng_alloc(gsl_rng_taus);
        gsl_rng_set(random, seed);
        CLEANUP(dem_lattice_free) dem_lattice l = draw_body(random, seed);
        dem_lattice_move(&l, 0.0, (const double[2]){0.0, 1e-3 - support_bottom(&l)});
        CLEANUP(free_model) dem_model *whole = support_model(&l, &floor, falls);
        rank_runs_scene run = {.model = whole, .options = dem_options_default(), .t_end = 1.2e-3};
        run.options.method = methods[seed % 3];
        run.options.contact = seed % 5 == 0 ? DEM_CONTACT_EXACT : DEM_CONTACT_LOCAL;
        run.options.bodies = seed % 7 < 3 ? DEM_BODIES_ALL : DEM_BODIES_NONE;
        run.options.checkpoint_steps = 20;
        rank_runs_outcome alone = check(&run, (unsigned long)seed);
        n_breaks += alone.n_breaks;
        rank_runs_free_outcome(&alone);
        gsl_rng_free(random);
    }
    assert_true(n_breaks > 0 || n_cases < 6);
    print_message("# %lld breaks in places; in all tests %ld runs on ranks, %ld of them from a checkpoint\n",
                  (long long)n_breaks, n_runs, n_resumed);
    assert_true(n_resumed > n_runs / 4 || n_cases < 6);
}

int main(int argc, char **argv)
{
    if (argc > 1) n_cases = atol(argv[1]);
    if (argc > 2) first_seed = atol(argv[2]);
    has_all = argc > 3 && strcmp(argv[3], "all") == 0;
    return test_run();
}
