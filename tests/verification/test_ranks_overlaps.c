/* SPDX-License-Identifier: BSD-3-Clause */
/* Ranks that share bodies which run into themselves or each other, as threads: the first overlap, with its time and
 * place, and how many there are, are to the bit those of one process, whoever owns which node; also where boundaries
 * come of breaks, in checkpoints, and where rank 0 leads. What one process finds is checked in
 * tests/unit/model/test_overlap.c. */
#include <string.h>

#include "ask.h"
#include "rank_runs.h"
#include "scattered.h"
#include "support.h"

#include "domain/partition.h"

static const double spacing = 4e-3;

/* ---- scenes ---- */

typedef enum kind {
    FOLDED,  /* a body with a slot, whose arms go through each other */
    CROSSED, /* two bodies that run into each other; the second one has larger triangles */
    BROKEN,  /* a body that flies apart, into another one that does not break */
    N_KINDS
} kind;

static dem_lattice make_block(double width, double height, double rows, double critical_stretch)
{
    const dem_material rubber =
        SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0, .thickness = 1.0,
              .guard = 0.02, .critical_stretch = critical_stretch);
    return support_rectangle(width, height, rows * spacing, &rubber);
}

/* The slot is a row and a half wide. The ends of the arms come nearer at 80 m/s. */
static dem_lattice make_fold(void)
{
    dem_lattice l = make_block(0.1, 0.04, 1.0, 0.0);
    CLEANUP(free_memory) bool *keep = malloc((size_t)l.n_nodes * sizeof *keep);
    const double middle = 0.5 * (support_bottom(&l) + support_top(&l));
    double left = INFINITY;
    for (dem_index i = 0; i < l.n_nodes; i++) left = fmin(left, l.x[2 * i]);
    for (dem_index i = 0; i < l.n_nodes; i++)
        keep[i] = fabs(l.x[2 * i + 1] - middle) > 0.75 * spacing || l.x[2 * i] < left + 0.025;
    assert_ok(dem_lattice_select(&l, keep));
    CLEANUP(free_memory) double *v = calloc(2 * (size_t)l.n_nodes, sizeof *v);
    for (dem_index i = 0; i < l.n_nodes; i++)
        v[2 * i + 1] = (l.x[2 * i + 1] > middle ? -400.0 : 400.0) * (l.x[2 * i] - left);
    support_start(&l, NULL, v);
    return l;
}

/* The second body is turned, and comes from the right. */
static void add_intruder(dem_lattice *l, double rows, double gap)
{
    dem_lattice other = make_block(0.06, 0.05, rows, 0.0);
    double right = -INFINITY, left = INFINITY;
    dem_lattice_move(&other, 0.3, (const double[2]){0.0, 7e-3});
    for (dem_index i = 0; i < l->n_nodes; i++) right = fmax(right, l->x[2 * i]);
    for (dem_index i = 0; i < other.n_nodes; i++) left = fmin(left, other.x[2 * i]);
    dem_lattice_move(&other, 0.0, (const double[2]){right - left + gap, 0.0});
    assert_ok(dem_lattice_launch(&other, (const double[2]){-30.0, 3.0}));
    assert_ok(dem_lattice_append(&other, l)); /* numbers of the first body are not the lowest ones */
    dem_lattice_free(l);
    *l = other;
}

static dem_lattice make_bodies(kind k)
{
    if (k == FOLDED) return make_fold();
    dem_lattice l = make_block(0.06, 0.06, 1.0, k == BROKEN ? 0.03 : 0.0);
    CLEANUP(free_memory) double *v = calloc(2 * (size_t)l.n_nodes, sizeof *v);
    for (dem_index i = 0; i < l.n_nodes && k == BROKEN; i++) v[2 * i] = 250.0 * l.x[2 * i];
    support_start(&l, NULL, v);
    add_intruder(&l, k == CROSSED ? 1.7 : 1.0, k == CROSSED ? 1e-3 : 8e-3);
    return l;
}

static bool has_overlaps(const dem_simulation *s, const rank_runs_outcome *so_far)
{
    (void)so_far;
    return ask_overlap(s).node >= 0;
}

static void open_scene(rank_runs_scene *s, kind k, dem_method method)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make_bodies(k);
    *s = (rank_runs_scene){.model = support_model(&l, NULL, 0),
                           .options = dem_options_default(),
                           .t_end = 6e-4,
                           .is_seen_at_events = true,
                           .keeps = has_overlaps};
    s->options.method = method;
    s->options.bodies = DEM_BODIES_NONE;
    s->options.checkpoint_steps = 7;
    s->options.gravity[1] = 0.0;
}

/* Something is found in the run, and more later, so that the first one has to be kept. */
static void check_whole(kind k, const rank_runs_outcome *whole)
{
    const dem_overlap *end = &whole->views[RANK_RUNS_STOPS - 1].overlap;
    assert_string_equal(whole->message, "");
    assert_true(end->t > 0.0 && end->node >= 0 && end->most > 3 && whole->kept != NULL);
    assert_true(whole->kept_t < 0.9 * whole->scene->t_end);
    if (k != BROKEN) return;
    assert_true(whole->n_breaks > 10 && whole->notes[0].broken.t < end->t);
}

/* ---- the same bits ---- */

static void share(const rank_runs_scene *s, int n_ranks, const int32_t *owner, const rank_runs_outcome *from,
                  const rank_runs_outcome *whole)
{
    rank_runs_assert_shared(s, n_ranks, &(domain_model_shares){.owner = owner}, from, whole);
}

/* In compact domains, and in scattered tiles; and from a checkpoint. */
static void check(kind k, dem_method method)
{
    static const int numbers[] = {1, 2, 3, 5};
    rank_runs_scene s;
    open_scene(&s, k, method);
    const dem_lattice *l = dem_model_lattice(s.model);
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)l->n_nodes * sizeof *owner);
    rank_runs_outcome whole = rank_runs_alone(&s);
    check_whole(k, &whole);
    for (int q = 0; q < 4; q++) {
        assert_ok(partition_bisect(l, numbers[q], owner));
        share(&s, numbers[q], owner, NULL, &whole);
        scatter(l, 4.1 * spacing, numbers[q], owner);
        share(&s, numbers[q], owner, NULL, &whole);
    }
    share(&s, 5, owner, &whole, &whole);
    rank_runs_assert_led(&s, 3, NULL, &whole);
    rank_runs_assert_led(&s, 2, &whole, &whole);
    rank_runs_free_outcome(&whole);
    dem_model_destroy(s.model);
}

TEST(a_body_that_folds_into_itself)
{
    check(FOLDED, DEM_METHOD_FEHLBERG45);
    check(FOLDED, DEM_METHOD_VERLET);
    check(FOLDED, DEM_METHOD_RK4); /* which leaves ghosts behind at the end of a step */
}

TEST(bodies_that_run_into_each_other)
{
    check(CROSSED, DEM_METHOD_FEHLBERG45);
    check(CROSSED, DEM_METHOD_VERLET);
}

TEST(pieces_that_run_into_another_body)
{
    check(BROKEN, DEM_METHOD_FEHLBERG45);
    check(BROKEN, DEM_METHOD_VERLET);
}
