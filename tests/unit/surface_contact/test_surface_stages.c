/* SPDX-License-Identifier: BSD-3-Clause */
/* surface_stages.c: stages taken range by range, against surface_ways_within() of whole states. */
#include "surface_contact/surface_stages.h"

#include "curves.h"
#include "harness/cleanup_gsl.h"
#include "verification/support.h"

enum { n_stages = 3 };

typedef struct scene {
    dem_lattice lattice;
    contact_surface surface;
    surface_ways ways;
    surface_stages stages;
    double *x[n_stages];
} scene;

/* Each stage is moved further, by random ways of bodies and nodes. */
static void open_scene(scene *s, gsl_rng *rng, dem_index n_bodies)
{
    *s = (scene){.lattice = curves_make(rng, n_bodies, 9, 2.1)};
    const dem_index n = 2 * s->lattice.n_nodes;
    assert_ok(contact_surface_compile(&s->surface, &s->lattice, 0.0, 1.0));
    s->ways.surface = &s->surface;
    assert_ok(surface_ways_note(&s->ways, 0.5, s->lattice.x));
    for (int stage = 0; stage < n_stages; stage++) {
        s->x[stage] = malloc((size_t)n * sizeof(double));
        for (dem_index k = 0; k < n; k++) {
            const dem_index which = 2 * s->lattice.body[k / 2] + k % 2;
            s->x[stage][k] =
                s->lattice.x[k] + 0.05 * stage * (gsl_rng_uniform(rng) - 0.5) + 0.1 * stage * sin((double)which);
        }
    }
}

static void close_scene(scene *s)
{
    for (int stage = 0; stage < n_stages; stage++) free(s->x[stage]);
    surface_stages_destroy(&s->stages);
    surface_ways_destroy(&s->ways);
    contact_surface_free(&s->surface);
    dem_lattice_free(&s->lattice);
}

/* One body, some, and so many that all are one group; ranges that part the nodes of a two, the last ones first. */
TEST(stages_that_are_taken_in_ranges_are_judged_as_whole_ones)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    static const dem_index bodies[] = {1, 5, 40};
    int n_within = 0, n_not = 0;
    for (int turn = 0; turn < 60; turn++) {
        CLEANUP(close_scene) scene s;
        open_scene(&s, rng, bodies[turn % 3]);
        const dem_index n = s.lattice.n_nodes, length = 1 + turn % 7;
        assert_true(surface_stages_begin(&s.stages, &s.ways, n_stages));
        for (int stage = 0; stage < n_stages; stage++)
            for (dem_index first = (n - 1) / length * length; first >= 0; first -= length) {
                const dem_index range[2] = {first, first + length < n ? first + length : n};
                surface_stages_take(&s.stages, &s.ways, stage, range, s.x[stage]);
            }
        for (int stage = 0; stage < n_stages; stage++)
            for (double most = 1e-3; most < 1.0; most *= 1.5) {
                const bool within = surface_ways_within(&s.ways, most, s.x[stage]);
                assert_true(surface_stages_within(&s.stages, &s.ways, stage, most) == within);
                n_within += within;
                n_not += !within;
            }
    }
    assert_true(n_within > 500 && n_not > 500);
}

/* Another surface in the same place, with more stages. */
TEST(there_is_room_for_another_surface)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(close_scene) scene few, many;
    open_scene(&few, rng, 1);
    open_scene(&many, rng, 5);
    assert_true(surface_stages_begin(&few.stages, &few.ways, 1));
    assert_true(surface_stages_begin(&few.stages, &many.ways, n_stages));
    const dem_index all[2] = {0, many.lattice.n_nodes};
    surface_stages_take(&few.stages, &many.ways, n_stages - 1, all, many.x[n_stages - 1]);
    const bool within = surface_ways_within(&many.ways, 0.2, many.x[n_stages - 1]);
    assert_true(surface_stages_within(&few.stages, &many.ways, n_stages - 1, 0.2) == within);
}
