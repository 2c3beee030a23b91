/* SPDX-License-Identifier: BSD-3-Clause */
/* See support.h. */
#include "harness/motion.h"
#include "support.h"

#include <stdlib.h>
#include <string.h>

static void *copy(const void *from, size_t size)
{
    void *to = malloc(size > 0 ? size : 1);
    assert_non_null(to);
    memcpy(to, from, size);
    return to;
}

dem_lattice support_lattice(dem_index n, const double *x, const double *mass, dem_index n_springs,
                            const dem_index *ends, double rest_length, double stiffness, const unsigned char *fixed)
{
    dem_lattice l = dem_lattice_empty();
    l.n_nodes = n;
    l.x = copy(x, 2 * (size_t)n * sizeof *x);
    l.mass = copy(mass, (size_t)n * sizeof *mass);
    l.flags = malloc((size_t)n);
    assert_non_null(l.flags);
    for (dem_index i = 0; i < n; i++)
        l.flags[i] = (unsigned char)(DEM_NODE_CONTACT | (fixed && fixed[i] ? DEM_NODE_FIXED : 0));
    if (n_springs == 0) return l;
    l.n_springs = n_springs;
    l.ends = copy(ends, 2 * (size_t)n_springs * sizeof *ends);
    l.rest_length = malloc((size_t)n_springs * sizeof(double));
    l.stiffness = malloc((size_t)n_springs * sizeof(double));
    assert_true(l.rest_length != NULL && l.stiffness != NULL);
    for (dem_index k = 0; k < n_springs; k++) {
        l.rest_length[k] = rest_length;
        l.stiffness[k] = stiffness;
    }
    return l;
}

dem_lattice support_rectangle(double width, double height, double spacing, const dem_material *material)
{
    dem_lattice l = dem_lattice_empty();
    assert_ok(dem_lattice_rectangle(&l, width, height, spacing));
    assert_ok(dem_lattice_assemble(&l, material));
    return l;
}

dem_lattice support_squares(double side, double spacing, const dem_material *material, const double way[2])
{
    dem_lattice first = support_rectangle(side, side, spacing, material);
    CLEANUP(dem_lattice_free) dem_lattice second = support_rectangle(side, side, spacing, material);
    dem_lattice_move(&second, 0.0, way);
    assert_ok(dem_lattice_append(&first, &second));
    return first;
}

double support_top(const dem_lattice *l)
{
    double top = -INFINITY;
    for (dem_index i = 0; i < l->n_nodes; i++) top = fmax(top, l->x[2 * i + 1]);
    return top;
}

double support_bottom(const dem_lattice *l)
{
    double bottom = INFINITY;
    for (dem_index i = 0; i < l->n_nodes; i++) bottom = fmin(bottom, l->x[2 * i + 1]);
    return bottom;
}

dem_model *support_model(const dem_lattice *lattice, const dem_obstacle *obstacles, dem_index n_obstacles)
{
    dem_model *model;
    assert_ok(dem_model_create(&model, lattice, obstacles, n_obstacles));
    return model;
}

dem_simulation *support_simulation(const dem_model *model, const dem_options *options)
{
    dem_simulation *simulation;
    assert_ok(dem_simulation_create(&simulation, model, options));
    return simulation;
}

void support_start(dem_lattice *lattice, const double *position, const double *velocity)
{
    const size_t size = 2 * (size_t)lattice->n_nodes * sizeof(double);
    if (position != NULL) {
        free(lattice->position);
        lattice->position = copy(position, size);
    }
    if (velocity != NULL) {
        free(lattice->velocity);
        lattice->velocity = copy(velocity, size);
    }
}

/* e(s) = (1 - s^2)^2 and its first and second integral over y = half s. */
void support_block(dem_lattice *out)
{
    const dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0,
                                      .density = 1050.0, .thickness = 1.0, .guard = 0.0);
    const double stretch = 0.04, curvature = 1.4, spacing = 5e-3, half = 3.0 * sqrt(3.0) * spacing;
    assert_ok(dem_lattice_rectangle(out, 0.05, 2.0 * half, spacing));
    assert_ok(dem_lattice_assemble(out, &rubber));
    assert_int_equal(out->n_nodes, 137);
    out->position = malloc(2 * (size_t)out->n_nodes * sizeof(double));
    assert_non_null(out->position);
    for (dem_index i = 0; i < out->n_nodes; i++) {
        const double x = out->x[2 * i], y = out->x[2 * i + 1] - half, s2 = y * y / (half * half);
        const double e = (1.0 - s2) * (1.0 - s2), once = y * (1.0 - s2 * (2.0 / 3.0 - s2 / 5.0));
        const double twice = y * y * (0.5 - s2 * (1.0 / 6.0 - s2 / 30.0));
        out->position[2 * i] = x - stretch * e * x / 3.0 + curvature * (twice + e * x * x / 6.0);
        out->position[2 * i + 1] = y + stretch * once - curvature * once * x;
    }
}

dem_options support_options(void)
{
    const char *method = getenv("CONTACT");
    dem_options options = dem_options_default();
    if (method != NULL) options.contact = strcmp(method, "exact") == 0 ? DEM_CONTACT_EXACT : DEM_CONTACT_LOCAL;
    return options;
}

static dem_status checkpoint(void *context, const dem_simulation *simulation, const dem_event *event)
{
    support_run *run = context;
    (void)simulation;
    if (event->kind != DEM_EVENT_IMPACT) return DEM_OK;
    if (run->n_impacts < SUPPORT_IMPACTS) run->impacts[run->n_impacts] = *event;
    run->n_impacts++;
    return DEM_OK;
}

void support_open(support_run *run, const dem_lattice *lattice, const dem_obstacle *obstacles, dem_index n_obstacles,
                  const dem_options *options)
{
    *run = (support_run){0};
    const dem_observer observer = {.struct_size = sizeof(dem_observer), .event = checkpoint, .context = run};
    assert_ok(dem_model_create(&run->model, lattice, obstacles, n_obstacles));
    assert_ok(dem_simulation_create(&run->simulation, run->model, options));
    assert_ok(dem_simulation_observe(run->simulation, &observer));
}

void support_close(support_run *run)
{
    dem_simulation_destroy(run->simulation);
    dem_model_destroy(run->model);
}

motion support_at(support_run *run, double t)
{
    motion state;
    assert_ok(dem_simulation_advance(run->simulation, t));
    motion_see(run->simulation, &state);
    return state;
}

void support_point(support_run *run, double m, const double x[2], const double v[2], const double *points,
                   dem_index n_points, double restitution)
{
    const dem_obstacle obstacle =
        SIZED(dem_obstacle, .n_points = n_points, .points = points, .restitution = restitution);
    dem_options options = support_options();
    options.spacing = 1.0;
    options.max_step = 0.01;
    options.rtol = 1e-12;
    options.penetration_tolerance = 1e-13;
    options.v_scale = 1.0;
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(1, x, &m, 0, NULL, 0.0, 0.0, NULL);
    support_start(&lattice, NULL, v);
    support_open(run, &lattice, &obstacle, 1, &options);
}
