/* SPDX-License-Identifier: BSD-3-Clause */
/* A program of one's own round the library: a rubber block in a trap. Its own force pulls every node back to the
 * vertical through its place at rest and carries its weight; its own observer stops the run when the block turns back.
 *
 *     cc drive.c $(pkg-config --cflags --libs dem) -lm -o drive && ./drive
 *
 * The block starts stretched, so it trembles. The springs between its nodes do not move its centre of mass, which
 * swings as x(t) = v/w sin(w t); the stress of the stretch is E e/(1 - nu^2) along it and nu times that across. */
#include <dem/dem.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { FRAMES = 18 };
static const double gravity = 9.81, period = 10e-3, speed = 1.0, stretch = 1e-4;
static const dem_material rubber = {.struct_size = sizeof(dem_material),
                                    .youngs_modulus = 1e7,
                                    .poissons_ratio = 1.0 / 3.0,
                                    .density = 1050,
                                    .thickness = 1,
                                    .guard = 0.02};

typedef struct block {
    const dem_lattice *rest;
    double rate;   /* w, rad/s */
    double way[2]; /* m, of the centre of mass from its place at rest, at the last frame */
    double stress; /* largest error at the first, as a share */
} block;

/* The force from outside: of each node that is asked about, by its number. */
static dem_status pull(void *context, const dem_force_query *query, double *force)
{
    const block *b = context;
    for (dem_index k = 0; k < query->n; k++) {
        const dem_index i = query->nodes[k];
        const double mass = b->rest->mass[i], way = query->x[2 * k] - b->rest->x[2 * i];
        force[2 * k] = -mass * b->rate * b->rate * way;
        force[2 * k + 1] = mass * gravity;
    }
    return DEM_OK;
}

static dem_status look_at_stress(block *b, const dem_simulation *simulation)
{
    const double nu = rubber.poissons_ratio, along = rubber.youngs_modulus * stretch / (1.0 - nu * nu);
    double *stress = malloc((size_t)b->rest->n_nodes * 3 * sizeof *stress);
    if (stress == NULL) return DEM_ERROR_MEMORY;
    const dem_status status = dem_simulation_stress(simulation, stress);
    for (dem_index i = 0; i < b->rest->n_nodes; i++) {
        b->stress = fmax(b->stress, fabs(stress[3 * i] - along) / along);
        b->stress = fmax(b->stress, fabs(stress[3 * i + 1] - nu * along) / along);
        b->stress = fmax(b->stress, fabs(stress[3 * i + 2]) / along);
    }
    free(stress);
    return status;
}

/* The observer: at every frame. */
static dem_status look(void *context, const dem_simulation *simulation)
{
    block *b = context;
    dem_state state = {.struct_size = sizeof state};
    double mass = 0.0, moment[2] = {0}, momentum = 0.0;
    const dem_status status = dem_simulation_state(simulation, &state);
    if (status != DEM_OK) return status;
    for (dem_index i = 0; i < b->rest->n_nodes; i++) {
        mass += b->rest->mass[i];
        moment[0] += b->rest->mass[i] * (state.x[2 * i] - b->rest->x[2 * i]);
        moment[1] += b->rest->mass[i] * (state.x[2 * i + 1] - b->rest->x[2 * i + 1]);
        momentum += b->rest->mass[i] * state.v[2 * i];
    }
    b->way[0] = moment[0] / mass;
    b->way[1] = moment[1] / mass;
    if (state.t == 0.0) return look_at_stress(b, simulation);
    return momentum < 0.0 ? DEM_STOPPED : DEM_OK;
}

/* Another state than that of the lattice: stretched, and on its way. */
static dem_status start(dem_simulation *simulation, const dem_lattice *rest)
{
    const size_t n = (size_t)rest->n_nodes;
    double *x = malloc(2 * n * sizeof *x), *v = malloc(2 * n * sizeof *v);
    for (size_t i = 0; i < n && x != NULL && v != NULL; i++) {
        x[2 * i] = (1.0 + stretch) * rest->x[2 * i];
        x[2 * i + 1] = rest->x[2 * i + 1];
        v[2 * i] = speed;
        v[2 * i + 1] = 0.0;
    }
    const dem_status status = x == NULL || v == NULL ? DEM_ERROR_MEMORY : dem_simulation_set_motion(simulation, x, v);
    free(x);
    free(v);
    return status;
}

static int fail(void)
{
    fprintf(stderr, "drive: %s\n", dem_status_message());
    return 1;
}

int main(void)
{
    dem_lattice lattice = dem_lattice_empty();
    dem_model *model;
    dem_simulation *simulation;
    block b = {.rate = 2.0 * acos(-1.0) / period};
    dem_options options = dem_options_default();
    const dem_observer observer = {
        .struct_size = sizeof(dem_observer), .interval = period / FRAMES, .frame = look, .context = &b};
    options.gravity[1] = -gravity;
    options.force = pull;
    options.force_context = &b;

    if (dem_lattice_rectangle(&lattice, 0.04, 0.04, 0.01) || dem_lattice_assemble(&lattice, &rubber)) return fail();
    if (dem_model_create(&model, &lattice, NULL, 0)) return fail();
    dem_lattice_free(&lattice);
    b.rest = dem_model_lattice(model);
    if (dem_simulation_create(&simulation, model, &options) || start(simulation, b.rest)) return fail();
    if (dem_simulation_observe(simulation, &observer)) return fail();
    if (dem_simulation_advance(simulation, period) != DEM_STOPPED) return fail();
    dem_simulation_destroy(simulation);
    dem_model_destroy(model);

    /* It turns back at a quarter of the period, 4.5 frames. */
    const double expected = speed / b.rate * sin(2.0 * acos(-1.0) * 5.0 / FRAMES);
    printf("%.9e m\n", b.way[0]);
    const double error = hypot(b.way[0] - expected, b.way[1]);
    return error <= 1e-6 * expected && b.stress <= 10.0 * stretch ? 0 : 1;
}
