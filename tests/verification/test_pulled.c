/* SPDX-License-Identifier: BSD-3-Clause */
/* A spring, and a chain of 40, held at one end and pulled at the other at a constant speed. In its own line a chain is
 * linear: with masses m and springs k = E/d0 each of its pieces has a motion at the speed of its ends, and modes, sines
 * or cosines of the frequencies 2 sqrt(k/m) sin(angle/2) that vanish at an end that is held or pulled, and are even
 * about the middle of the spring that is missing at a free one. So time and place of each break are known, one after
 * the other. */
#include "verification/support.h"

#include <stdlib.h>

enum { N = 40, MOST = 8 }; /* springs; breaks */

static const double speed = 0.01, limit = 0.014; /* m/s; waves have the strain speed/c = 0.01, twice that at an end */

/* Nodes first to first + n - 1 of a chain of N springs of 1 N and 1 m, masses of 1 kg; 0 is held, N is pulled. */
typedef struct piece {
    int first, n;
} piece;

typedef struct chain {
    double t;                  /* s, from which on the pieces are these, */
    double u[N + 1], v[N + 1]; /* m, m/s: and their motion then */
    int n_pieces;
    piece pieces[MOST + 1];
} chain;

typedef struct known_break {
    double t;
    int spring;
} known_break;

static bool is_held(const piece *p)
{
    return p->first == 0;
}

static bool is_pulled(const piece *p)
{
    return p->first + p->n == N + 1;
}

/* Of node i in mode q of a piece, and its angle from node to node. The lengths over which half a wave fits end at the
 * nodes that are driven, or half a spring beyond those that are free. */
static double mode(const piece *p, int q, int i, double *angle)
{
    const double half = is_held(p) != is_pulled(p) ? 0.5 : 0.0, length = p->n - (is_held(p) + is_pulled(p)) * 0.5;
    const int wave = is_held(p) && is_pulled(p) ? q + 1 : q;
    *angle = M_PI * (wave + half) / length;
    return is_held(p) ? sin(*angle * i) : cos(*angle * (i - p->first + 0.5));
}

/* The motion that all nodes of a piece would have without waves. */
static double without_waves(const piece *p, int i)
{
    if (!is_pulled(p)) return 0.0;
    return is_held(p) ? speed * i / N : speed;
}

static void move_piece(const chain *c, const piece *p, double t, double *u, double *v)
{
    const int last = p->first + p->n - 1;
    for (int i = p->first; i <= last; i++) {
        u[i] = without_waves(p, i) * t;
        v[i] = without_waves(p, i);
    }
    for (int q = 0; q < p->n - is_held(p) - is_pulled(p); q++) {
        double angle = 0.0, square = 0.0, a = 0.0, b = 0.0;
        for (int i = p->first; i <= last; i++) {
            const double m = mode(p, q, i, &angle);
            square += m * m;
            a += m * (c->u[i] - without_waves(p, i) * c->t);
            b += m * (c->v[i] - without_waves(p, i));
        }
        const double w = 2.0 * sin(0.5 * angle), s = t - c->t, drift = w > 0.0 ? sin(w * s) / w : s;
        for (int i = p->first; i <= last; i++) {
            const double m = mode(p, q, i, &angle) / square;
            u[i] += m * (a * cos(w * s) + b * drift);
            v[i] += m * (b * cos(w * s) - a * w * sin(w * s));
        }
    }
}

static void move(const chain *c, double t, double *u, double *v)
{
    for (int k = 0; k < c->n_pieces; k++) move_piece(c, &c->pieces[k], t, u, v);
}

/* The largest strain, and where: its spring follows the node of its number. */
static double largest(const chain *c, double t, int *spring)
{
    double u[N + 1], v[N + 1], most = 0.0;
    move(c, t, u, v);
    for (int k = 0; k < c->n_pieces; k++)
        for (int i = c->pieces[k].first; i < c->pieces[k].first + c->pieces[k].n - 1; i++) {
            if (u[i + 1] - u[i] <= most) continue;
            most = u[i + 1] - u[i];
            *spring = i;
        }
    return most;
}

/* The next break, at which its piece becomes two. */
static known_break find_next(chain *c)
{
    known_break found = {.spring = -1};
    double before = c->t, after = c->t, u[N + 1], v[N + 1];
    while (largest(c, after, &found.spring) < limit) {
        before = after;
        after += 0.02;
        assert_true(after < 1e4);
    }
    for (int k = 0; k < 60; k++) {
        const double middle = 0.5 * (before + after);
        *(largest(c, middle, &found.spring) < limit ? &before : &after) = middle;
    }
    (void)largest(c, after, &found.spring);
    found.t = after;
    move(c, after, u, v);
    for (int i = 0; i <= N; i++) c->u[i] = u[i], c->v[i] = v[i];
    c->t = after;
    for (int k = 0; k < c->n_pieces; k++) {
        piece *p = &c->pieces[k];
        const int n = found.spring - p->first + 1;
        if (n < 1 || n >= p->n) continue;
        c->pieces[c->n_pieces++] = (piece){found.spring + 1, p->n - n};
        p->n = n;
        return found;
    }
    fail_msg("spring %d is in no piece", found.spring);
    return found;
}

typedef struct breaks {
    int n, most;
    known_break list[MOST];
} breaks;

static dem_status note(void *context, const dem_simulation *s, const dem_break *what)
{
    breaks *b = context;
    (void)s;
    b->list[b->n++] = (known_break){what->t, (int)what->spring};
    return b->n == b->most ? DEM_STOPPED : DEM_OK;
}

/* Breaks of a chain of n springs, held at its left end and pulled at its right one. */
static void run(breaks *b, dem_index n, const dem_options *choice)
{
    double *x = calloc((size_t)(2 * n + 2), sizeof *x), *v = calloc((size_t)(2 * n + 2), sizeof *v),
           *masses = calloc((size_t)(n + 1), sizeof *masses);
    dem_index *ends = calloc((size_t)(2 * n), sizeof *ends), left = 0;
    assert_true(x != NULL && v != NULL && masses != NULL && ends != NULL);
    for (dem_index i = 0; i <= n; i++) {
        x[2 * i] = (double)i;
        masses[i] = 1.0;
    }
    for (dem_index k = 0; k < 2 * n; k++) ends[k] = (k + 1) / 2;
    v[2 * n] = speed;
    CLEANUP(dem_lattice_free) dem_lattice l = support_lattice(n + 1, x, masses, n, ends, 1.0, 1.0, NULL);
    support_start(&l, NULL, v);
    l.critical_stretch = calloc((size_t)n, sizeof *l.critical_stretch);
    assert_non_null(l.critical_stretch);
    for (dem_index k = 0; k < n; k++) l.critical_stretch[k] = limit;
    const dem_boundary hold[2] = {SIZED(dem_boundary, .kind = DEM_BOUNDARY_VELOCITY,
                                        .components = DEM_COMPONENT_X | DEM_COMPONENT_Y, .nodes = &left, .n_nodes = 1),
                                  SIZED(dem_boundary, .kind = DEM_BOUNDARY_VELOCITY,
                                        .components = DEM_COMPONENT_X | DEM_COMPONENT_Y, .nodes = &n, .n_nodes = 1,
                                        .value = {speed, 0.0})};
    dem_options options = *choice;
    options.gravity[1] = 0.0;
    options.n_boundaries = 2;
    options.boundaries = hold;
    CLEANUP(support_close) support_run run;
    support_open(&run, &l, NULL, 0, &options);
    const dem_observer observer = {.struct_size = sizeof observer, .broken = note, .context = b};
    assert_ok(dem_simulation_observe(run.simulation, &observer));
    assert_int_equal(dem_simulation_advance(run.simulation, 1e4), DEM_STOPPED);
    free(x);
    free(v);
    free(masses);
    free(ends);
}

static dem_options accurate(dem_contact_method way)
{
    dem_options options = dem_options_default();
    options.rtol = 1e-12;
    options.contact = way;
    return options;
}

static const dem_contact_method ways[2] = {DEM_CONTACT_LOCAL, DEM_CONTACT_EXACT};

/* Its strain is speed t over 1 m. */
TEST(a_spring_that_is_pulled_breaks_when_it_is_long_enough)
{
    for (int k = 0; k < 2; k++) {
        const dem_options options = accurate(ways[k]);
        breaks b = {.most = 1};
        run(&b, 1, &options);
        assert_close(b.list[0].t, limit / speed, 1e-10 * limit / speed);
    }
}

static void solve(known_break *list, int n)
{
    chain c = {.n_pieces = 1, .pieces = {{0, N + 1}}};
    c.v[N] = speed;
    for (int k = 0; k < n; k++) {
        list[k] = find_next(&c);
        print_message("# spring %d at %.9f s\n", list[k].spring, list[k].t);
    }
}

/* The wave of the pull comes to the held end and doubles: three springs break there within 0.11 s, less than half a
 * step; two nodes fly off, and the rest flies after the end that pulls it, until it breaks off there, too.
 * Found: within 7e-13 of the time. */
TEST(a_chain_that_is_pulled_breaks_where_and_when_its_modes_say)
{
    enum { BREAKS = 4 };
    known_break list[BREAKS];
    solve(list, BREAKS);
    for (int way = 0; way < 2; way++) {
        const dem_options options = accurate(ways[way]);
        breaks b = {.most = BREAKS};
        run(&b, N, &options);
        for (int k = 0; k < BREAKS; k++) {
            assert_int_equal(b.list[k].spring, list[k].spring);
            assert_close(b.list[k].t, list[k].t, 1e-10 * list[k].t);
        }
    }
}

static double verlet_error(double step, const known_break *list)
{
    dem_options options = dem_options_default();
    options.method = DEM_METHOD_VERLET;
    options.fixed_step = step;
    breaks b = {.most = 1};
    run(&b, N, &options);
    assert_int_equal(b.list[0].spring, list[0].spring);
    return fabs(b.list[0].t - list[0].t);
}

/* Found: 3.77; what is missing is of the next order. */
TEST(times_of_breaks_have_the_order_of_the_method)
{
    known_break list[1];
    solve(list, 1);
    const double ratio = verlet_error(0.1, list) / verlet_error(0.05, list);
    assert_close(ratio, 4.0, 0.4);
}
