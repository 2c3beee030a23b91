/* SPDX-License-Identifier: BSD-3-Clause */
/* See scene.h. */
#include "scene.h"

#include <stdlib.h>
#include <string.h>

#include "harness/cleanup_gsl.h"
#include "judge.h"

static double uniform(gsl_rng *rng, double a, double b)
{
    return a + (b - a) * gsl_rng_uniform(rng);
}

static int chance(gsl_rng *rng, double p)
{
    return gsl_rng_uniform(rng) < p;
}

static double one_of(gsl_rng *rng, const double *list, unsigned long n)
{
    return list[gsl_rng_uniform_int(rng, n)];
}

static void put_point(solid *s, double x, double y)
{
    assert_true(s->n < SCENE_POINTS);
    s->points[2 * s->n] = x;
    s->points[2 * s->n + 1] = y;
    s->n++;
}

/* ---- obstacles ---- */

/* What closes an open terrain far below. */
static void bury(solid *s)
{
    s->n_exposed = s->n;
    put_point(s, 0.3, -5.0);
    put_point(s, -0.3, -5.0);
}

static void random_terrain(gsl_rng *rng, solid *s)
{
    const int n = 2 + (int)gsl_rng_uniform_int(rng, 10);
    const double step = 0.6 / n, steep = uniform(rng, 0.0, 2.0);
    double y = 0.0;
    for (int k = 0; k <= n; k++) {
        put_point(s, -0.3 + step * k, y);
        y += step * uniform(rng, -steep, steep);
    }
    bury(s);
}

/* A slope with teeth, narrower than a spacing or wider, now and then hanging over; between them all in line, or not. */
static void random_spikes(gsl_rng *rng, solid *s)
{
    const double rough = chance(rng, 0.7) ? 1e-3 : 0.0;
    const int n = 1 + (int)gsl_rng_uniform_int(rng, 12);
    const double slope = uniform(rng, -0.5, 0.5), pitch = 0.4 / n, narrow = fmin(0.8 * pitch, uniform(rng, 2e-3, 0.03));
    put_point(s, -0.3, -0.3 * slope);
    for (int k = 0; k < n; k++) {
        const double x = -0.2 + pitch * k, tip = x + narrow * uniform(rng, -0.1, 1.1);
        put_point(s, x, slope * x + uniform(rng, -rough, rough));
        put_point(s, tip, slope * tip + uniform(rng, 2e-3, 0.03));
        put_point(s, x + narrow, slope * (x + narrow));
    }
    put_point(s, 0.3, 0.3 * slope);
    bury(s);
}

static void close_ring(solid *s)
{
    s->n_exposed = s->n + 1;
    assert_true(s->n < SCENE_POINTS);
    s->points[2 * s->n] = s->points[0];
    s->points[2 * s->n + 1] = s->points[1];
}

/* Star-shaped about a point: a block, clockwise, or a room, counter-clockwise. */
static void random_star(gsl_rng *rng, solid *s, const double at[2], const double radius[2])
{
    const int n = 3 + (int)gsl_rng_uniform_int(rng, 6);
    const double turn = uniform(rng, 0.0, 6.28), sense = s->is_room ? 1.0 : -1.0;
    for (int k = 0; k < n; k++) {
        const double r = uniform(rng, radius[0], radius[1]), angle = turn + sense * 2.0 * M_PI * k / n;
        put_point(s, at[0] + r * cos(angle), at[1] + r * sin(angle));
    }
    close_ring(s);
}

static void random_block(gsl_rng *rng, solid *s)
{
    const double at[2] = {uniform(rng, -0.1, 0.1), uniform(rng, 0.2, 0.4)};
    const double size = uniform(rng, 0.01, 0.05), rough = uniform(rng, 0.0, 0.8);
    random_star(rng, s, at, (const double[2]){(1.0 - rough) * size, size});
}

/* A wall of its own that stands on the terrain, the solid on its right. */
static void random_wall(gsl_rng *rng, solid *s, const solid *terrain)
{
    const double x = uniform(rng, 0.05, 0.15), lean = uniform(rng, -0.05, 0.2);
    double y = 0.0;
    for (dem_index k = 0; k + 1 < terrain->n_exposed; k++) {
        const double *a = &terrain->points[2 * k], *b = a + 2;
        if (a[0] <= x && x <= b[0]) y = a[1] + (x - a[0]) / (b[0] - a[0]) * (b[1] - a[1]);
    }
    put_point(s, x, y);
    put_point(s, x + lean, y + 1.0);
    s->n_exposed = 2;
    put_point(s, x + 2.0, y + 1.0);
    put_point(s, x + 2.0, y - 5.0);
    put_point(s, x - 5.0 * lean, y - 5.0); /* it goes on behind what it stands on */
}

static void random_laws(gsl_rng *rng, scene *sc)
{
    static const double restitutions[5] = {0.0, 0.0, 0.5, 0.9, 1.0}, frictions[5] = {0.0, 0.3, 0.3, 1.0, 1.0};
    for (int k = 0; k < sc->n; k++)
        sc->obstacles[k] =
            (dem_obstacle)SIZED(dem_obstacle, .n_points = sc->solids[k].n_exposed, .points = sc->solids[k].points,
                                .restitution = one_of(rng, restitutions, 5), .friction = one_of(rng, frictions, 5),
                                .friction_law = chance(rng, 0.25) ? DEM_FRICTION_PAPER : DEM_FRICTION_COULOMB);
}

/* Open ground with blocks and walls, or a closed room, now and then with a block in it. */
static void random_obstacles(gsl_rng *rng, scene *sc)
{
    sc->n = 1;
    if (chance(rng, 0.25)) {
        const double size = uniform(rng, 0.08, 0.15);
        sc->solids[0].is_room = 1;
        random_star(rng, &sc->solids[0], (const double[2]){0.0, 0.3},
                    (const double[2]){size * (chance(rng, 0.5) ? 1.0 : 0.7), size});
        if (chance(rng, 0.2)) random_block(rng, &sc->solids[sc->n++]);
        return;
    }
    if (chance(rng, 0.4))
        random_spikes(rng, &sc->solids[0]);
    else
        random_terrain(rng, &sc->solids[0]);
    if (chance(rng, 0.4)) random_block(rng, &sc->solids[sc->n++]);
    if (chance(rng, 0.2)) random_block(rng, &sc->solids[sc->n++]);
    if (chance(rng, 0.2)) random_wall(rng, &sc->solids[sc->n++], &sc->solids[0]);
}

/* ---- bodies ---- */

static void random_solid_body(gsl_rng *rng, scene *sc)
{
    const dem_material rubber =
        SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0, .thickness = 1.0,
              .guard = 0.02, .damping_time = chance(rng, 0.25) ? uniform(rng, 1e-6, 3e-5) : 0.0);
    sc->spacing = uniform(rng, 8e-3, 15e-3);
    sc->body = dem_lattice_empty();
    if (chance(rng, 0.3)) {
        assert_ok(dem_lattice_disc(&sc->body, uniform(rng, 0.02, 0.04), sc->spacing));
    } else { /* one by one: compilers evaluate arguments in different orders */
        const double height = uniform(rng, 0.02, 0.07), width = uniform(rng, 0.02, 0.07);
        assert_ok(dem_lattice_rectangle(&sc->body, width, height, sc->spacing));
    }
    assert_ok(dem_lattice_assemble(&sc->body, &rubber));
}

static void random_masses(gsl_rng *rng, scene *sc)
{
    const dem_index n = 1 + (dem_index)gsl_rng_uniform_int(rng, 4);
    double x[8], mass[4], velocity[8];
    for (dem_index i = 0; i < n; i++) {
        mass[i] = uniform(rng, 0.1, 2.0);
        for (int k = 0; k < 2; k++) {
            x[2 * i + k] = uniform(rng, -0.01, 0.01);
            velocity[2 * i + k] = uniform(rng, -3.0, 3.0);
        }
    }
    sc->body = support_lattice(n, x, mass, 0, NULL, 0.0, 0.0, NULL);
    support_start(&sc->body, NULL, velocity);
    sc->body.body = calloc(4, sizeof *sc->body.body);
    assert_non_null(sc->body.body);
    for (dem_index i = 0; i < n; i++) sc->body.body[i] = (int32_t)i;
    sc->spacing = sc->options.spacing = 0.01;
    sc->options.max_step = 5e-5;
    if (!sc->solids[0].is_room) return; /* in the open they would get to the ends */
    sc->t_end = 0.04;
    sc->interval = 1e-5;
}

static void random_body(gsl_rng *rng, scene *sc)
{
    const int room = sc->solids[0].is_room;
    const double speed = uniform(rng, 0.0, 8.0), heading = room ? uniform(rng, -3.14, 3.14) : uniform(rng, -3.0, 0.0);
    const double velocity[2] = {speed * cos(heading), speed * sin(heading)};
    const double lift[2] = {room ? 0.0 : uniform(rng, -0.15, 0.1), room ? 0.3 : 0.75};
    if (chance(rng, room ? 0.5 : 0.05))
        random_masses(rng, sc);
    else
        random_solid_body(rng, sc);
    dem_lattice_move(&sc->body, uniform(rng, 0.0, 6.28), lift);
    assert_ok(dem_lattice_launch(&sc->body, velocity));
}

/* Moves the body until it is near something: nine tenths of the clearance at a time, which it can go any way. */
static void bring_near(gsl_rng *rng, scene *sc, const boundary_condition *b)
{
    const double way = sc->solids[0].is_room ? uniform(rng, 0.0, 6.28) : -0.5 * M_PI;
    for (int k = 0; k < 60; k++) {
        const double clear = judge_clearance(sc, b, sc->body.x);
        if (clear < 1e-3) return;
        dem_lattice_move(&sc->body, 0.0, (const double[2]){0.9 * clear * cos(way), 0.9 * clear * sin(way)});
    }
}

static void random_options(gsl_rng *rng, scene *sc)
{
    static const double windows[5] = {-1.0, 0.0, 0.0, 0.0, 2e-6};
    sc->options.gravity[1] = chance(rng, 0.4) ? -9.81 : -2000.0;
    sc->options.window = one_of(rng, windows, 5);
    sc->options.mass_damping = chance(rng, 0.15) ? uniform(rng, 10.0, 300.0) : 0.0;
}

/* Whether the body starts clear of everything. */
static int starts_clear(gsl_rng *rng, scene *sc)
{
    boundary_condition b;
    judge_boundary(&b, &sc->body);
    int clear = judge_nodes(sc, sc->body.x) == 0.0 && judge_vertices(sc, &b, sc->body.x) == 0.0;
    if (clear) bring_near(rng, sc, &b);
    clear = clear && judge_clearance(sc, &b, sc->body.x) > 1e-5 && judge_nodes(sc, sc->body.x) == 0.0;
    free(b.ends);
    return clear;
}

void scene_random(scene *out, unsigned long seed)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    assert_non_null(rng);
    gsl_rng_set(rng, seed);
    for (int tries = 0;; tries++) {
        assert_true(tries < 100);
        *out = (scene){.options = support_options(), .t_end = 8e-3, .interval = 2e-6};
        random_obstacles(rng, out);
        random_laws(rng, out);
        random_options(rng, out);
        random_body(rng, out);
        if (starts_clear(rng, out)) break;
        dem_lattice_free(&out->body);
    }
}

void scene_free(scene *sc)
{
    dem_lattice_free(&sc->body);
}

/* ---- the same in another order ---- */

/* order: [n] new position of each row. */
static void *in_order(const void *from, size_t size, const dem_index *old, dem_index n)
{
    char *to = malloc(size * (size_t)n + 1);
    assert_non_null(to);
    for (dem_index i = 0; i < n && from != NULL; i++)
        memcpy(to + size * (size_t)i, (const char *)from + size * (size_t)old[i], size);
    if (from != NULL) return to;
    free(to);
    return NULL;
}

static void *renumbered(const dem_index *list, dem_index n, const dem_index *new_number)
{
    dem_index *to = malloc(((size_t)n + 1) * sizeof *to);
    assert_non_null(to);
    for (dem_index k = 0; k < n; k++) to[k] = new_number[list[k]];
    return to;
}

static void shuffle(gsl_rng *rng, dem_index *list, dem_index n)
{
    for (dem_index k = 0; k < n; k++) list[k] = k;
    for (dem_index k = n - 1; k > 0; k--) {
        const dem_index other = (dem_index)gsl_rng_uniform_int(rng, (unsigned long)k + 1), kept = list[k];
        list[k] = list[other];
        list[other] = kept;
    }
}

static void *copy(const void *from, size_t size)
{
    void *to = from != NULL ? malloc(size + 1) : NULL;
    if (to != NULL) memcpy(to, from, size);
    return to;
}

static void shuffle_body(dem_lattice *to, const dem_lattice *l, const dem_index *old)
{
    const dem_index n = l->n_nodes;
    const size_t springs = (size_t)l->n_springs * sizeof(double);
    CLEANUP(free_memory) dem_index *new_number = malloc((size_t)n * sizeof *new_number);
    assert_non_null(new_number);
    for (dem_index i = 0; i < n; i++) new_number[old[i]] = i;
    *to = dem_lattice_empty();
    to->n_nodes = n;
    to->n_springs = l->n_springs;
    to->n_triangles = l->n_triangles;
    to->x = in_order(l->x, 2 * sizeof(double), old, n);
    to->mass = in_order(l->mass, sizeof(double), old, n);
    to->flags = in_order(l->flags, 1, old, n);
    to->body = in_order(l->body, sizeof(int32_t), old, n);
    to->position = in_order(l->position, 2 * sizeof(double), old, n);
    to->velocity = in_order(l->velocity, 2 * sizeof(double), old, n);
    to->ends = renumbered(l->ends, 2 * l->n_springs, new_number);
    to->triangles = l->n_triangles > 0 ? renumbered(l->triangles, 3 * l->n_triangles, new_number) : NULL;
    to->rest_length = copy(l->rest_length, springs);
    to->stiffness = copy(l->stiffness, springs);
    to->viscosity = copy(l->viscosity, springs);
    to->guard = copy(l->guard, (size_t)l->n_triangles * sizeof(double));
}

void scene_shuffle(scene *out, const scene *sc, unsigned long seed, dem_index *old)
{
    dem_index order[SCENE_SOLIDS];
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    assert_non_null(rng);
    gsl_rng_set(rng, seed);
    *out = *sc;
    shuffle(rng, order, sc->n);
    for (int k = 0; k < sc->n; k++) {
        out->solids[k] = sc->solids[order[k]];
        out->obstacles[k] = sc->obstacles[order[k]];
        out->obstacles[k].points = out->solids[k].points;
    }
    shuffle(rng, old, sc->body.n_nodes);
    shuffle_body(&out->body, &sc->body, old);
}
