/* SPDX-License-Identifier: BSD-3-Clause */
/* approach_bound.c: against points that methods of integration move with accelerations of all kinds. */
#include "surface_contact/approach_bound.h"

#include "base/vec2.h"
#include "harness/cleanup_gsl.h"
#include "time/butcher.h"
#include "verification/support.h"

enum { POINTS = 3, COMPONENTS = 2 * POINTS };

static const double step = 1e-3; /* s */

/* Points with the bound of their ways; `x0` is where it was noted. */
typedef struct scene {
    gsl_rng *rng;
    approach_bound bound;
    butcher_table table;
    double x[COMPONENTS], v[COMPONENTS], a[COMPONENTS], x0[COMPONENTS];
    double size;        /* m/s^2, of accelerations */
    int n_held, n_lost; /* evaluations */
} scene;

/* The largest distance of the differences p - q of two points. */
static double spread(const double *p, const double *q)
{
    double longest = 0.0;
    for (int i = 0; i < POINTS; i++)
        for (int j = 0; j < i; j++) {
            const vec2 a = vec2_sub(vec2_at(p, i), vec2_at(q, i)), b = vec2_sub(vec2_at(p, j), vec2_at(q, j));
            longest = fmax(longest, vec2_norm(vec2_sub(a, b)));
        }
    return longest;
}

/* Accelerations of any direction, of the full size or of less. */
static void accelerate(scene *s, double *a)
{
    double largest = 0.0;
    for (int i = 0; i < POINTS; i++) {
        const double angle = 2.0 * acos(-1.0) * gsl_rng_uniform(s->rng);
        const double size = s->size * (gsl_rng_uniform(s->rng) < 0.5 ? 1.0 : gsl_rng_uniform(s->rng));
        vec2_put(a, i, (vec2){size * cos(angle), size * sin(angle)});
        largest = fmax(largest, size);
    }
    approach_bound_take(&s->bound, largest);
}

/* What a stage is evaluated at: where the bound holds, points have not moved further than was noted. */
static void look(scene *s, const double *x, double noted)
{
    if (!approach_bound_holds(&s->bound)) {
        s->n_lost++;
        return;
    }
    s->n_held++;
    assert_true(spread(x, s->x0) <= noted);
}

/* A state with weights of the stages so far. */
static void combine(const scene *s, const double *weight, int n, double k[][2 * COMPONENTS], double *x, double *v)
{
    for (int c = 0; c < COMPONENTS; c++) {
        x[c] = s->x[c];
        v[c] = s->v[c];
        for (int j = 0; j < n; j++) {
            x[c] += step * weight[j] * k[j][c];
            v[c] += step * weight[j] * k[j][COMPONENTS + c];
        }
    }
}

/* The first stage has the accelerations of the step's start, the end those of the next. */
static void take_step(scene *s, double noted)
{
    double k[BUTCHER_STAGES][2 * COMPONENTS], x[COMPONENTS], v[COMPONENTS];
    const butcher_table *t = &s->table;
    memcpy(k[0], s->v, sizeof s->v);
    memcpy(k[0] + COMPONENTS, s->a, sizeof s->a);
    for (int i = 1; i < t->stages; i++) {
        combine(s, t->a + i * t->stages, i, k, x, v);
        look(s, x, noted);
        memcpy(k[i], v, sizeof v);
        accelerate(s, k[i] + COMPONENTS);
    }
    combine(s, t->b, t->stages, k, x, v);
    look(s, x, noted);
    memcpy(s->x, x, sizeof x);
    memcpy(s->v, v, sizeof v);
    accelerate(s, s->a);
    approach_bound_end_step(&s->bound, step);
}

static void open_scene(scene *s, gsl_rng *rng, dem_method method)
{
    step_reach reach;
    *s = (scene){.rng = rng};
    assert_ok(butcher_load(&s->table, method));
    assert_ok(butcher_reach(&reach, method));
    approach_bound_create(&s->bound, reach, step, 4);
    for (int c = 0; c < COMPONENTS; c++) s->v[c] = gsl_rng_uniform(rng) - 0.5;
    s->size = 100.0 * pow(10.0, 2.0 * gsl_rng_uniform(rng) - 1.0);
}

/* In a first step nothing is known. Then the bound is noted where that is asked for, for ways of a few steps. */
TEST(no_two_points_move_further_than_the_bound_says)
{
    static const dem_method methods[4] = {DEM_METHOD_FEHLBERG45, DEM_METHOD_DOPRI45, DEM_METHOD_RK4, DEM_METHOD_HEUN12};
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    int n_held = 0, n_lost = 0;
    for (int turn = 0; turn < 400; turn++) {
        scene s;
        open_scene(&s, rng, methods[turn % 4]);
        double noted = 0.0;
        for (int k = 0; k < 30; k++) {
            if (approach_bound_begin_step(&s.bound)) {
                static const double still[COMPONENTS] = {0};
                assert_true(k > 0);
                noted = step * pow(10.0, 1.0 + gsl_rng_uniform(rng));
                memcpy(s.x0, s.x, sizeof s.x);
                approach_bound_note(&s.bound, noted, spread(s.v, still));
            }
            take_step(&s, noted);
        }
        n_held += s.n_held;
        n_lost += s.n_lost;
    }
    print_message("# held in %d evaluations, lost in %d\n", n_held, n_lost);
    assert_true(n_held > 3000 && n_lost > 3000);
}

/* How many steps of Verlet's the bound holds for two points that approach each other at 2 m/s, with 50 m/s^2 each. */
static int count_steps(double noted)
{
    static const double a = 50.0;
    step_reach reach;
    approach_bound bound;
    int n = 0;
    assert_ok(butcher_reach(&reach, DEM_METHOD_VERLET));
    approach_bound_create(&bound, reach, step, 4);
    assert_false(approach_bound_begin_step(&bound));
    approach_bound_take(&bound, a);
    approach_bound_end_step(&bound, step);
    assert_true(approach_bound_begin_step(&bound));
    approach_bound_note(&bound, noted, 2.0);
    while (n < 20 && approach_bound_holds(&bound)) {
        approach_bound_take(&bound, a);
        approach_bound_end_step(&bound, step);
        (void)approach_bound_begin_step(&bound);
        n++;
    }
    return n;
}

/* After n steps these are nearer by V n h + A (n h)^2. The bound has 1e-6 to spare. */
TEST(verlets_bound_is_the_parabola)
{
    const double way = 2.0 * 9 * step + 50.0 * 9 * step * 9 * step;
    assert_int_equal(count_steps((1.0 + 1e-5) * way), 9);
    assert_int_equal(count_steps((1.0 - 1e-5) * way), 8);
}

/* What is not a number, and what has not been evaluated, bound nothing; nor does a note of another state. */
TEST(nothing_is_bounded_by_what_is_unknown)
{
    const step_reach reach = {1.0, 0.5, 1.0};
    approach_bound bound;
    approach_bound_create(&bound, reach, step, 4);
    approach_bound_note(&bound, 1.0, 1.0);
    assert_false(approach_bound_holds(&bound));
    for (int k = 0; k < 3; k++) {
        approach_bound_create(&bound, reach, step, 4);
        approach_bound_take(&bound, 1.0);
        approach_bound_end_step(&bound, step);
        assert_true(approach_bound_begin_step(&bound));
        approach_bound_note(&bound, 1.0, 1.0);
        assert_true(approach_bound_holds(&bound));
        if (k == 0) approach_bound_take(&bound, (double)NAN);
        if (k == 1) approach_bound_lose(&bound);
        if (k == 2) approach_bound_forget(&bound);
        assert_false(approach_bound_holds(&bound));
    }
    approach_bound_end_step(&bound, step);
    for (int k = 0; k < 40; k++) assert_false(approach_bound_begin_step(&bound)); /* accelerations are not known */
}
