/* SPDX-License-Identifier: BSD-3-Clause */
/* diagnostics.c: energies and mean motion of bodies that move rigidly, extremes of strain by hand, and the power of
 * damping. */
#include "verification/support.h"

#include <stdlib.h>

#include "unit/forces/measure.h"

static const double gravity[2] = {0.5, -10.0};

/* ---- a rigid motion ---- */

/* Two rectangles of different density as bodies 0 and 1. */
static dem_model *make_bodies(void)
{
    const dem_material light = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 500.0,
                                     .thickness = 1.0, .guard = 0.02);
    const dem_material heavy = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0,
                                     .density = 2000.0, .thickness = 1.0, .guard = 0.02);
    const double aside[2] = {3.0, 0.5};
    CLEANUP(dem_lattice_free) dem_lattice first = dem_lattice_empty(), second = dem_lattice_empty();
    assert_ok(dem_lattice_rectangle(&first, 0.4, 0.3, 0.1));
    assert_ok(dem_lattice_assemble(&first, &light));
    assert_ok(dem_lattice_rectangle(&second, 0.2, 0.5, 0.1));
    assert_ok(dem_lattice_assemble(&second, &heavy));
    dem_lattice_move(&second, 0.0, aside);
    assert_ok(dem_lattice_append(&first, &second));
    dem_model *model = support_model(&first, NULL, 0);
    return model;
}

/* Mass, centre and moment of inertia about the centre, of the rest positions. */
typedef struct inertia {
    double mass, moment;
    vec2 centre;
} inertia;

static inertia inertia_of(const dem_lattice *l, int body)
{
    inertia b = {0.0, 0.0, {0.0, 0.0}};
    for (dem_index i = 0; i < l->n_nodes; i++)
        if (l->body[i] == body) {
            b.mass += l->mass[i];
            b.centre.x += l->mass[i] * l->x[2 * i];
            b.centre.y += l->mass[i] * l->x[2 * i + 1];
        }
    b.centre = vec2_scale(1.0 / b.mass, b.centre);
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const vec2 r = vec2_sub(vec2_at(l->x, i), b.centre);
        if (l->body[i] == body) b.moment += l->mass[i] * vec2_dot(r, r);
    }
    return b;
}

static const double turned[2] = {0.7, -2.1}, spin[2] = {3.0, -5.0};                            /* rad, rad/s */
static const vec2 centre[2] = {{1.0, 2.0}, {-4.0, 0.5}}, speed[2] = {{2.0, -1.0}, {0.0, 6.0}}; /* m, m/s */

/* Both bodies turned, shifted, and in rigid motion. */
static void move_rigidly(const dem_model *model, double *x, double *v)
{
    const dem_lattice *l = &model->lattice;
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const int b = l->body[i];
        const vec2 r = vec2_sub(vec2_at(l->x, i), inertia_of(l, b).centre);
        const double c = cos(turned[b]), s = sin(turned[b]);
        const vec2 now = {c * r.x - s * r.y, s * r.x + c * r.y};
        vec2_put(x, i, vec2_add(centre[b], now));
        vec2_put(v, i, vec2_add(speed[b], (vec2){-spin[b] * now.y, spin[b] * now.x}));
    }
}

typedef struct moving {
    dem_model *model;
    double *x, *v;
} moving;

static moving make_moving(void)
{
    moving m = {.model = make_bodies()};
    const size_t n = 2 * (size_t)m.model->lattice.n_nodes;
    m.x = malloc(n * sizeof *m.x);
    m.v = malloc(n * sizeof *m.v);
    assert_true(m.x != NULL && m.v != NULL);
    move_rigidly(m.model, m.x, m.v);
    return m;
}

static void free_moving(moving *m)
{
    dem_model_destroy(m->model);
    free(m->x);
    free(m->v);
}

static dem_energy energy_of(const dem_model *model, const double *x, const double *v)
{
    const forces acting = {.model = model, .gravity = {gravity[0], gravity[1]}};
    return measure_state(&acting, x, v).energy;
}

static dem_strain strain_of(const dem_model *model, const double *x)
{
    const forces acting = {.model = model};
    return measure_state(&acting, x, x).strain;
}

static dem_body_motion body_of(const dem_model *model, dem_index body, const double *x, const double *v)
{
    const forces acting = {.model = model};
    return measure_state(&acting, x, v).body[body];
}

/* Relative rounding of sums of some 30 terms; the elastic energy is of the order of E h A eps^2. */
TEST(a_rigid_motion_has_kinetic_and_gravity_energy_only)
{
    double kinetic = 0.0, weight = 0.0;
    CLEANUP(free_moving) moving m = make_moving();
    for (int b = 0; b < 2; b++) {
        const inertia body = inertia_of(&m.model->lattice, b);
        kinetic += 0.5 * body.mass * vec2_dot(speed[b], speed[b]) + 0.5 * body.moment * spin[b] * spin[b];
        weight -= body.mass * (gravity[0] * centre[b].x + gravity[1] * centre[b].y);
    }
    const dem_energy energy = energy_of(m.model, m.x, m.v);
    assert_close(energy.kinetic, kinetic, 1e-13 * kinetic);
    assert_close(energy.gravity, weight, 1e-13 * kinetic);
    assert_close(energy.elastic, 0.0, 1e-20 * 1e7);
    assert_close(energy.guard, 0.0, 0.0);
    assert_close(energy.impact, 0.0, 0.0);
    assert_close(energy.projection, 0.0, 0.0);
}

TEST(each_body_has_the_mean_motion_it_was_given)
{
    CLEANUP(free_moving) moving m = make_moving();
    for (int b = 0; b < 2; b++) {
        const inertia body = inertia_of(&m.model->lattice, b);
        const dem_body_motion measured = body_of(m.model, b, m.x, m.v);
        assert_close(measured.mass, body.mass, 1e-13 * body.mass);
        assert_close(measured.centre[0], centre[b].x, 1e-14);
        assert_close(measured.centre[1], centre[b].y, 1e-14);
        assert_close(measured.velocity[0], speed[b].x, 1e-13);
        assert_close(measured.velocity[1], speed[b].y, 1e-13);
        assert_close(measured.angular_momentum[2], body.moment * spin[b], 1e-12 * body.moment * fabs(spin[b]));
        assert_close(measure_state(&(forces){.model = m.model}, m.x, m.v).inertia[b], body.moment, 1e-12 * body.moment);
    }
}

TEST(a_rigid_motion_strains_nothing)
{
    CLEANUP(free_moving) moving m = make_moving();
    const dem_strain strain = strain_of(m.model, m.x);
    assert_close(strain.min, 0.0, 1e-13); /* rounding of positions of 1 m over 0.1 m */
    assert_close(strain.max, 0.0, 1e-13);
    assert_close(strain.area_min, 1.0, 1e-12);
    assert_int_equal(strain.guarded, 0);
}

/* ---- strains by hand ---- */

/* A square of 1 m with one diagonal; springs of rest length 1 m, of the diagonal 2 m. */
static dem_model *make_square(void)
{
    static const double x[8] = {0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0}, mass[4] = {1.0, 1.0, 1.0, 1.0};
    static const dem_index ends[10] = {2, 3, 3, 0, 0, 2, 1, 0, 2, 1}, corners[6] = {0, 1, 2, 0, 2, 3};
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(4, x, mass, 5, ends, 1.0, 10.0, NULL);
    lattice.rest_length[2] = 2.0;
    lattice.n_triangles = 2;
    lattice.triangles = malloc(sizeof corners);
    lattice.guard = malloc(2 * sizeof(double));
    assert_true(lattice.triangles != NULL && lattice.guard != NULL);
    for (int k = 0; k < 6; k++) lattice.triangles[k] = corners[k];
    lattice.guard[0] = 0.0;
    lattice.guard[1] = 5.0;
    lattice.area_stiffness = malloc(2 * sizeof(double));
    assert_non_null(lattice.area_stiffness);
    lattice.area_stiffness[0] = 6.0;
    lattice.area_stiffness[1] = -2.0;
    dem_model *model = support_model(&lattice, NULL, 0);
    return model;
}

/* Node 3 at (0.25, 0.5): spring 1 (3-0) has sqrt(0.3125), spring 0 (2-3) sqrt(0.8125) m; spring 2 sqrt 2 of 2 m. The
 * triangle 0 2 3 keeps a quarter of its area, the other all of its. */
TEST(extremes_of_strain_are_found_with_their_springs)
{
    const double x[8] = {0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.25, 0.5};
    CLEANUP(free_model) dem_model *model = make_square();
    dem_strain strain = strain_of(model, x);
    assert_close(strain.min, sqrt(0.3125) - 1.0, 1e-15);
    assert_int_equal(strain.spring_min, 1);
    assert_close(strain.max, 0.0, 0.0);
    assert_int_equal(strain.spring_max, 3); /* 0-1, the first of two unstrained ones */
    assert_close(strain.area_min, 0.25, 1e-15);
    assert_int_equal(strain.guarded, 1);
    const double stretched[8] = {0.0, 0.0, 1.5, 0.0, 1.0, 1.0, 0.0, 1.0};
    strain = strain_of(model, stretched);
    assert_close(strain.min, 0.5 * sqrt(2.0) - 1.0, 1e-15);
    assert_int_equal(strain.spring_min, 2);
    assert_close(strain.max, 0.5, 0.0);
    assert_int_equal(strain.spring_max, 3);
    assert_close(strain.area_min, 1.0, 0.0);
    assert_int_equal(strain.guarded, 0);
    const double rest[8] = {0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0};
    strain = strain_of(model, rest);
    assert_int_equal(strain.spring_max, 3); /* 0-1, before 3-0 and 1-2 by its ends, and 2-3 that has number 0 */
}

/* Node 1 across the diagonal, at (0.1, 0.9): triangle 0 1 2 has -0.8 of its area and no guard; node 3 at its mirror
 * image. */
TEST(inverted_triangles_have_negative_areas_and_count)
{
    double x[8] = {0.0, 0.0, 0.1, 0.9, 1.0, 1.0, 0.0, 1.0};
    CLEANUP(free_model) dem_model *model = make_square();
    dem_strain strain = strain_of(model, x);
    assert_close(strain.area_min, -0.8, 1e-15);
    assert_int_equal(strain.guarded, 0);
    assert_int_equal(strain.inverted, 1);
    x[6] = 0.9;
    x[7] = 0.1;
    strain = strain_of(model, x);
    assert_close(strain.area_min, -0.8, 1e-15);
    assert_int_equal(strain.guarded, 1);
    assert_int_equal(strain.inverted, 2);
    assert_true(energy_of(model, x, x).guard > 0.0);
}

TEST(elastic_energy_is_that_of_the_springs)
{
    const double x[8] = {0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0}, v[8] = {0.0};
    CLEANUP(free_model) dem_model *model = make_square();
    const double strain = 0.5 * sqrt(2.0) - 1.0; /* of the diagonal alone */
    assert_close(energy_of(model, x, v).elastic, 0.5 * 10.0 * 2.0 * strain * strain, 1e-14);
}

/* Node 3 at (0.25, 0.5) leaves the triangle 0 2 3, of kappa -2 N/m, a quarter of its area, node 1 at (1.5, 0) gives the
 * other, of 6 N/m, half as much again: A0 kappa/2 (J - 1)^2 each. */
TEST(area_energy_is_that_of_the_triangles)
{
    const double x[8] = {0.0, 0.0, 1.5, 0.0, 1.0, 1.0, 0.25, 0.5}, v[8] = {0.0};
    CLEANUP(free_model) dem_model *model = make_square();
    const dem_energy energy = energy_of(model, x, v);
    assert_close(energy.area, 0.5 * (3.0 * 0.25 - 1.0 * 0.5625), 1e-15);
    assert_close(energy.motion + energy.gravity, energy.area + energy.elastic + energy.guard + energy.gravity, 1e-12);
}

TEST(without_springs_and_triangles_there_is_no_strain)
{
    const double x[2] = {1.0, 2.0}, v[2] = {3.0, 4.0}, mass = 2.0;
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(1, x, &mass, 0, NULL, 0.0, 0.0, NULL);
    CLEANUP(free_model) dem_model *model = support_model(&lattice, NULL, 0);
    const dem_strain strain = strain_of(model, x);
    assert_close(strain.min, 0.0, 0.0);
    assert_close(strain.max, 0.0, 0.0);
    assert_int_equal(strain.spring_min, -1);
    assert_int_equal(strain.spring_max, -1);
    assert_close(strain.area_min, 1.0, 0.0);
    assert_int_equal(strain.guarded, 0);
    assert_int_equal(strain.inverted, 0);
    const dem_body_motion measured = body_of(model, 0, x, v);
    assert_close(measured.angular_momentum[2], 0.0, 0.0);
    assert_close(energy_of(model, x, v).kinetic, 25.0, 0.0);
    assert_close(energy_of(model, x, v).gravity, -2.0 * (0.5 - 20.0), 0.0);
}

/* ---- damping ---- */

static double pseudo(dem_index k)
{
    return sin(12.9898 * (double)(k + 1)); /* in [-1, 1], without an order */
}

/* A damped block with its lowest row fixed, strained by some 10 % and moving at about 1 m/s. */
static moving make_damped(double damping_time)
{
    const dem_material soft = SIZED(dem_material, .youngs_modulus = 1e5, .poissons_ratio = 1.0 / 3.0, .density = 1000.0,
                                    .thickness = 0.5, .damping_time = damping_time);
    moving m = {.model = NULL};
    dem_lattice lattice = support_rectangle(0.4, 0.3, 0.1, &soft);
    lattice.flags = calloc((size_t)lattice.n_nodes, 1);
    assert_non_null(lattice.flags);
    for (int i = 0; i < 5; i++) lattice.flags[i] = DEM_NODE_FIXED;
    assert_ok(dem_model_create(&m.model, &lattice, NULL, 0));
    const dem_index n = lattice.n_nodes;
    dem_lattice_free(&lattice);
    m.x = malloc(2 * (size_t)n * sizeof *m.x);
    m.v = malloc(2 * (size_t)n * sizeof *m.v);
    assert_true(m.x != NULL && m.v != NULL);
    for (dem_index k = 0; k < 2 * n; k++) {
        m.x[k] = m.model->lattice.x[k] + (k < 10 ? 0.0 : 0.01 * pseudo(k));
        m.v[k] = k < 10 ? 0.0 : pseudo(7 * k);
    }
    return m;
}

/* W, forces times velocities, node by node for every spring of the lattice: < 0. */
static double power_of_damping_forces(const moving *m, double mass_damping)
{
    const dem_lattice *l = &m->model->lattice;
    double given = 0.0;
    for (dem_index k = 0; k < l->n_springs; k++) {
        const dem_index i = l->ends[2 * k], j = l->ends[2 * k + 1];
        const double dx = m->x[2 * j] - m->x[2 * i], dy = m->x[2 * j + 1] - m->x[2 * i + 1], d = hypot(dx, dy);
        const double rate = (dx * (m->v[2 * j] - m->v[2 * i]) + dy * (m->v[2 * j + 1] - m->v[2 * i + 1])) / d;
        const double pull = l->viscosity[k] * rate / l->rest_length[k];
        given += pull * (dx * m->v[2 * i] + dy * m->v[2 * i + 1]) / d;
        given -= pull * (dx * m->v[2 * j] + dy * m->v[2 * j + 1]) / d;
    }
    for (dem_index i = 0; i < l->n_nodes; i++)
        for (int c = 0; c < 2; c++) given -= mass_damping * l->mass[i] * m->v[2 * i + c] * m->v[2 * i + c];
    return given;
}

/* Relative rounding of sums of some hundred terms. */
TEST(the_power_of_damping_is_minus_that_of_its_forces)
{
    CLEANUP(free_moving) moving m = make_damped(1e-3);
    const forces loads[2] = {{.model = m.model, .gravity = {0.5, -10.0}},
                             {.model = m.model, .gravity = {0.5, -10.0}, .mass_damping = 40.0}};
    for (int k = 0; k < 2; k++) {
        const double power = forces_damping_power(&loads[k], m.x, m.v);
        assert_true(power > 100.0);
        assert_close(power, -power_of_damping_forces(&m, loads[k].mass_damping), 1e-12 * power);
    }
}

/* It is also what the accelerations of damped and undamped motion differ by; fixed nodes have none, whatever v is. */
TEST(the_power_of_damping_is_what_the_accelerations_lack)
{
    double lacking = 0.0;
    CLEANUP(free_moving) moving m = make_damped(1e-3), plain = make_damped(0.0);
    const forces load = {.model = m.model, .gravity = {0.5, -10.0}, .mass_damping = 40.0};
    const forces free_of_it = {.model = plain.model, .gravity = {0.5, -10.0}};
    for (dem_index i = 0; i < m.model->lattice.n_nodes; i++) {
        const vec2 damped = forces_acceleration(&load, i, m.x, m.v);
        const vec2 undamped = forces_acceleration(&free_of_it, i, m.x, m.v);
        lacking += m.model->lattice.mass[i] * vec2_dot(vec2_sub(undamped, damped), vec2_at(m.v, i));
    }
    const double power = forces_damping_power(&load, m.x, m.v);
    assert_close(power, lacking, 1e-11 * power); /* differences of accelerations ten times as large */
    assert_close(forces_damping_power(&free_of_it, m.x, m.v), 0.0, 0.0);
}

TEST(mass_damping_takes_twice_alpha_times_the_kinetic_energy_of_what_moves)
{
    CLEANUP(free_moving) moving m = make_damped(0.0);
    const forces load = {.model = m.model, .mass_damping = 3.0};
    m.v[0] = 100.0; /* of a fixed node */
    const double kinetic = energy_of(m.model, m.x, m.v).kinetic;
    const double fixed = 0.5 * m.model->lattice.mass[0] * 100.0 * 100.0;
    assert_close(forces_damping_power(&load, m.x, m.v), 6.0 * (kinetic - fixed), 1e-12 * 6.0 * kinetic);
}

/* Two bodies of two nodes each, whose nodes take turns in the list: masses 1 and 3 kg at x = 0 and 2 m, 2 and 6 kg at
 * 1 and 3 m. All numbers are small integers or halves, and so exact. */
TEST(bodies_may_take_turns_in_the_list_of_nodes)
{
    const double x[8] = {0.0, 0.0, 1.0, 0.0, 2.0, 0.0, 3.0, 0.0}, mass[4] = {1.0, 2.0, 3.0, 6.0};
    const double v[8] = {0.0, 4.0, 2.0, 0.0, 0.0, 0.0, -2.0, 0.0};
    const dem_index ends[4] = {0, 2, 1, 3};
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(4, x, mass, 2, ends, 2.0, 1.0, NULL);
    lattice.body = calloc(4, sizeof *lattice.body);
    assert_non_null(lattice.body);
    lattice.body[1] = lattice.body[3] = 1;
    CLEANUP(free_model) dem_model *model = support_model(&lattice, NULL, 0);
    const dem_body_motion first = body_of(model, 0, x, v), second = body_of(model, 1, x, v);
    assert_close(first.mass, 4.0, 0.0);
    assert_close(first.centre[0], 1.5, 0.0);
    assert_close(first.velocity[1], 1.0, 0.0);
    assert_close(first.angular_momentum[2], 1.0 * -1.5 * 3.0 + 3.0 * 0.5 * -1.0, 0.0);
    assert_close(second.mass, 8.0, 0.0);
    assert_close(second.centre[0], 2.5, 0.0);
    assert_close(second.velocity[0], -1.0, 0.0);
    assert_close(second.angular_momentum[2], 0.0, 0.0);
}
