/* SPDX-License-Identifier: BSD-3-Clause */
/* forces.h, forces.c: what every force keeps to. Forces are minus the gradient of the energy, power is force times
 * velocity, nothing but the neighbours matters, and what is broken is as if it had never been. */
#include "verification/support.h"

#include <stdlib.h>
#include <string.h>

#include "unit/forces/measure.h"

enum { MOST_NODES = 64 };

static const double spacing = 1e-2;

/* A block of rubber in which all there is acts, on the move. Stays where it is: it points to itself. */
typedef struct body {
    dem_lattice lattice;
    dem_model *model;
    element_state state;
    boundary_conditions boundaries;
    external_force *external;
    forces f;
    dem_index n;
    double x[2 * MOST_NODES], v[2 * MOST_NODES + 1]; /* the time behind the velocities */
} body;

/* N: depends on everything that it may. */
static dem_status wind(void *context, const dem_force_query *q, double *force)
{
    (void)context;
    for (dem_index k = 0; k < q->n; k++) {
        force[2 * k] = 3.0 * q->x[2 * k + 1] - 0.2 * q->v[2 * k] + q->t;
        force[2 * k + 1] = 2.0 + 0.1 * (double)q->nodes[k] + 0.3 * q->v[2 * k];
    }
    return DEM_OK;
}

static bool breaks_spring(dem_index k)
{
    return k % 5 == 0;
}

static bool breaks_triangle(dem_index k)
{
    return k % 7 == 2;
}

/* A spring breaks when no triangle holds it any more, and so it has no couplings either. */
static void uncouple_broken_springs(dem_lattice *l)
{
    for (dem_index k = 0; k < 3 * l->n_springs * l->n_triangles; k++) {
        const dem_index spring = k / (3 * l->n_triangles), corner = k % (3 * l->n_triangles), t = corner / 3;
        const dem_index i = l->triangles[corner], j = l->triangles[3 * t + (corner + 1) % 3], *e = l->ends + 2 * spring;
        const bool is_edge = (e[0] == i && e[1] == j) || (e[0] == j && e[1] == i);
        for (int c = 0; c < 3 && is_edge && breaks_spring(spring); c++) l->coupling[3 * t + c] = 0.0;
    }
}

/* nu = 0.2 brings the area term, jitter the couplings; nodes are moved by up to 0.4 of a spacing, so that the guard
 * acts. */
static void make_lattice(dem_lattice *out, double damping_time)
{
    const dem_material rubber =
        SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 0.2, .density = 1050.0, .thickness = 1.0,
              .guard = 0.02, .damping_time = damping_time, .springs = DEM_SPRINGS_COUPLED);
    *out = dem_lattice_empty();
    assert_ok(dem_lattice_rectangle(out, 5.0 * spacing, 5.0 * spacing, spacing));
    assert_ok(dem_lattice_jitter(out, 0.2 * spacing, 1));
    assert_ok(dem_lattice_assemble(out, &rubber));
    uncouple_broken_springs(out);
    assert_true(out->n_nodes <= MOST_NODES && out->n_nodes > 30);
}

static void compile(body *b)
{
    b->n = b->lattice.n_nodes;
    assert_ok(dem_model_create(&b->model, &b->lattice, NULL, 0));
    assert_ok(element_state_create(&b->state, &b->model->lattice, &b->model->springs));
    b->f = (forces){.model = b->model, .elements = &b->state, .gravity = {0.5, -9.81}, .clock = 2 * b->n};
    for (dem_index c = 0; c < 2 * b->n; c++) {
        b->x[c] = b->lattice.x[c] + 0.4 * spacing * sin(7.0 * (double)(c * c));
        b->v[c] = 3.0 * cos(5.0 * (double)(c * c));
    }
    b->v[2 * b->n] = 0.7;
}

static void open_body(body *b, double damping_time)
{
    *b = (body){0};
    make_lattice(&b->lattice, damping_time);
    compile(b);
}

/* Mass damping, a force on two nodes and one from outside; one component of a node is prescribed. */
static void drive(body *b)
{
    const dem_index pushed[2] = {7, 12}, moved[1] = {9};
    const dem_boundary list[2] = {SIZED(dem_boundary, .kind = DEM_BOUNDARY_FORCE, .n_nodes = 2, .nodes = pushed,
                                        .value = {40.0, -20.0}, .ramp = 2.0),
                                  SIZED(dem_boundary, .kind = DEM_BOUNDARY_VELOCITY, .components = DEM_COMPONENT_Y,
                                        .n_nodes = 1, .nodes = moved, .value = {0.0, 2.0}, .ramp = 2.0)};
    const dem_options options = {.force = wind};
    assert_ok(boundary_conditions_compile(&b->boundaries, list, 2, &b->model->lattice, NULL, 0));
    assert_ok(external_force_create(&b->external, &options, 2, b->n, NULL));
    b->f.mass_damping = 30.0;
    b->f.boundaries = &b->boundaries;
    b->f.external = b->external;
}

static void close_body(body *b)
{
    boundary_conditions_free(&b->boundaries);
    external_force_destroy(b->external);
    element_state_destroy(&b->state);
    dem_model_destroy(b->model);
    dem_lattice_free(&b->lattice);
}

/* Every fifth spring and every seventh triangle. */
static void break_some(body *b)
{
    for (dem_index k = 0; k < b->lattice.n_springs; k++)
        if (breaks_spring(k)) element_state_break_spring(&b->state, k);
    for (dem_index k = 0; k < b->lattice.n_triangles; k++)
        if (breaks_triangle(k)) element_state_break_triangle(&b->state, k);
    assert_true(b->state.n_damaged > 10);
}

/* Breaks all that is at node 0. */
static void break_off(body *b)
{
    const dem_lattice *l = &b->lattice;
    for (dem_index k = 0; k < 2 * l->n_springs; k++)
        if (l->ends[k] == 0) element_state_break_spring(&b->state, k / 2);
    for (dem_index k = 0; k < 3 * l->n_triangles; k++)
        if (l->triangles[k] == 0) element_state_break_triangle(&b->state, k / 3);
}

/* The body without them: springs have what is left of their stiffness, and springs and triangles keep their order, so
 * that sums run as they did. */
static void open_without(body *b, double damping_time, const element_state *broken)
{
    *b = (body){0};
    make_lattice(&b->lattice, damping_time);
    dem_lattice *l = &b->lattice;
    dem_index n_springs = 0, n_triangles = 0;
    for (dem_index k = 0; k < l->n_springs; k++) {
        if (broken->integrity[k] == 0.0) continue;
        memmove(l->ends + 2 * n_springs, l->ends + 2 * k, 2 * sizeof *l->ends);
        l->stiffness[n_springs] = broken->integrity[k] * l->stiffness[k];
        l->rest_length[n_springs] = l->rest_length[k];
        if (l->viscosity != NULL) l->viscosity[n_springs] = broken->integrity[k] * l->viscosity[k];
        n_springs++;
    }
    for (dem_index k = 0; k < l->n_triangles; k++) {
        if (broken->triangle[k]) continue;
        memmove(l->triangles + 3 * n_triangles, l->triangles + 3 * k, 3 * sizeof *l->triangles);
        l->area_stiffness[n_triangles] = l->area_stiffness[k];
        l->guard[n_triangles] = l->guard[k];
        memmove(l->coupling + 3 * n_triangles, l->coupling + 3 * k, 3 * sizeof *l->coupling);
        n_triangles++;
    }
    l->n_springs = n_springs;
    l->n_triangles = n_triangles;
    compile(b);
}

static vec2 force_on(const body *b, dem_index i)
{
    return vec2_scale(b->model->lattice.mass[i], forces_acceleration(&b->f, i, b->x, b->v));
}

/* ---- energy ---- */

/* Minus the slope of the node's energy along c, by central differences over 1e-8 m. */
static double pull_of_energy(body *b, dem_index i, int c)
{
    const double step = 1e-8, here = b->x[2 * i + c];
    b->x[2 * i + c] = here + step;
    const double above = forces_node_energy(&b->f, i, b->x);
    b->x[2 * i + c] = here - step;
    const double below = forces_node_energy(&b->f, i, b->x);
    b->x[2 * i + c] = here;
    return (below - above) / (2.0 * step);
}

/* Energies of some 1e3 J in rounding 1e-16 over 2e-8 m: 1e-5 N of forces of up to 1e6 N; truncation 1e-16 * 1e12 N/m^2
 * where a triangle is all but flat. */
TEST(forces_are_minus_the_gradient_of_the_energy_at_a_node)
{
    for (int broken = 0; broken < 2; broken++) {
        CLEANUP(close_body) body b;
        open_body(&b, 0.0);
        if (broken) break_some(&b);
        for (dem_index i = 0; i < b.n; i++) {
            const vec2 force = force_on(&b, i);
            assert_close(force.x, pull_of_energy(&b, i, 0), 1e-3);
            assert_close(force.y, pull_of_energy(&b, i, 1), 1e-3);
        }
    }
}

/* The energy of all nodes moved at once by their velocities times 1e-8 s: sums of some 1e4 J, rounding 1e-16 each, over
 * 2e-8 s; the power is 1.6e6 W. */
TEST(the_power_of_all_forces_is_what_the_energy_loses)
{
    const double tau = 1e-8;
    for (int broken = 0; broken < 2; broken++) {
        CLEANUP(close_body) body b;
        double power = 0.0, moved[2][2 * MOST_NODES], stored[2];
        open_body(&b, 0.0);
        if (broken) break_some(&b);
        for (dem_index i = 0; i < b.n; i++) power += vec2_dot(force_on(&b, i), vec2_at(b.v, i));
        for (int k = 0; k < 2; k++) {
            for (dem_index c = 0; c < 2 * b.n; c++) moved[k][c] = b.x[c] + (k == 0 ? -tau : tau) * b.v[c];
            const dem_energy e = measure_state(&b.f, moved[k], b.v).energy;
            assert_true(e.guard > 0.0 && e.area < 0.0 && e.elastic > 0.0);
            stored[k] = e.elastic + e.area + e.guard + e.gravity;
        }
        assert_close(power, (stored[0] - stored[1]) / (2.0 * tau), 1e-2);
    }
}

/* ---- power ---- */

/* The force on a node that is driven and damped, times its velocity, is that of its energy, less what damping takes,
 * with what is put in. Some 5e6 W in rounding 1e-16, some ten terms. */
TEST(the_power_of_a_node_is_its_force_times_its_velocity)
{
    for (int broken = 0; broken < 2; broken++) {
        CLEANUP(close_body) body b;
        open_body(&b, 1e-4);
        if (broken) break_some(&b);
        const forces still = {.model = b.model, .elements = b.f.elements, .gravity = {0.5, -9.81}};
        const double at_rest[2 * MOST_NODES] = {0.0};
        drive(&b);
        for (dem_index i = 0; i < b.n; i++) {
            const vec2 v = vec2_at(b.v, i);
            double push[2];
            external_force_of_node(b.external, b.v[2 * b.n], i, b.x + 2 * i, b.v + 2 * i, push);
            const forces_power power = forces_node_power(&b.f, i, vec2_at(push, 0), b.x, b.v);
            const double mass = b.model->lattice.mass[i];
            const double elastic = mass * vec2_dot(forces_acceleration(&still, i, b.x, at_rest), v);
            const double held =
                forces_held(&b.f, i) != 0 ? force_on(&b, i).y * v.y : 0.0; /* given back by the boundary */
            assert_close(power.work - power.damping, vec2_dot(force_on(&b, i), v) - held - elastic, 1e-7);
        }
    }
}

/* Terms of up to 5e6 W: rounding. What the prescribed acceleration takes itself is in the sum over all alone. */
TEST(the_power_of_all_is_the_sum_over_nodes)
{
    for (int broken = 0; broken < 2; broken++) {
        CLEANUP(close_body) body b;
        double u[2 * MOST_NODES], a[2 * MOST_NODES], damping = 0.0, work = 0.0;
        open_body(&b, 1e-4);
        if (broken) break_some(&b);
        drive(&b);
        const double t = b.v[2 * b.n];
        const boundary_condition *moves = &b.boundaries.list[1];
        b.v[2 * 9 + 1] = boundary_condition_velocity(moves, t).y;
        external_force_evaluate(b.external, &(dem_force_query){t, b.n, b.external->all, b.x, b.v});
        for (dem_index i = 0; i < b.n; i++) {
            const forces_power power = forces_node_power(&b.f, i, vec2_at(b.external->value, i), b.x, b.v);
            vec2_put(a, i, forces_acceleration(&b.f, i, b.x, b.v));
            damping += power.damping;
            work += power.work;
        }
        memcpy(u, b.v, sizeof u);
        work += b.model->lattice.mass[9] * boundary_condition_acceleration(moves, t).y * b.v[2 * 9 + 1];
        assert_true(damping > 100.0 && fabs(work) > 100.0);
        assert_close(forces_damping_power(&b.f, b.x, b.v), damping, 1e-12 * damping);
        assert_close(forces_prescribe(&b.f, t, b.v, u, a), work, 1e-8);
        assert_close(a[2 * 9 + 1], boundary_condition_acceleration(moves, t).y, 0.0);
    }
}

/* ---- neighbours ---- */

static bool has_neighbour(const forces *f, dem_index i, dem_index other)
{
    for (forces_neighbours j = forces_neighbours_of(f, i); forces_next_neighbour(&j);)
        if (j.node == other) return true;
    return false;
}

/* Whether another place and velocity of one node make any difference to the acceleration of another. */
static bool matters(body *b, dem_index i, dem_index other)
{
    const vec2 x = vec2_at(b->x, other), v = vec2_at(b->v, other);
    const vec2 before = forces_acceleration(&b->f, i, b->x, b->v);
    vec2_put(b->x, other, (vec2){x.x + 0.11 * spacing, x.y - 0.07 * spacing});
    vec2_put(b->v, other, (vec2){v.x + 1.0, v.y - 2.0});
    const vec2 after = forces_acceleration(&b->f, i, b->x, b->v);
    vec2_put(b->x, other, x);
    vec2_put(b->v, other, v);
    return before.x != after.x || before.y != after.y;
}

static void check_neighbours(body *b)
{
    dem_index n_pairs = 0;
    drive(b);
    for (dem_index i = 0; i < b->n; i++)
        for (dem_index j = 0; j < b->n; j++) {
            if (i == j) continue;
            assert_int_equal(matters(b, i, j), has_neighbour(&b->f, i, j));
            assert_int_equal(has_neighbour(&b->f, i, j), has_neighbour(&b->f, j, i));
            n_pairs += has_neighbour(&b->f, i, j);
        }
    assert_true(n_pairs > 100);
}

TEST(the_neighbours_of_a_node_are_all_that_matter_to_it)
{
    for (int broken = 0; broken < 2; broken++) {
        CLEANUP(close_body) body b;
        open_body(&b, 1e-4);
        if (broken) break_some(&b);
        if (broken) break_off(&b);
        check_neighbours(&b);
        for (dem_index j = 0; j < b.n && broken; j++) assert_false(has_neighbour(&b.f, 0, j));
    }
}

/* Corners of a triangle without a spring between them act on each other by their triangle alone. */
TEST(corners_of_triangles_are_neighbours_where_springs_are_missing)
{
    CLEANUP(close_body) body b, without;
    open_body(&b, 1e-4);
    break_some(&b);
    open_without(&without, 1e-4, &b.state);
    assert_true(b.model->edges_are_springs && !without.model->edges_are_springs);
    check_neighbours(&without);
}

/* ---- what is broken ---- */

/* To the bit: sums have the same terms in the same order. */
TEST(what_is_broken_is_as_if_it_had_never_been)
{
    CLEANUP(close_body) body b, without;
    open_body(&b, 1e-4);
    break_some(&b);
    open_without(&without, 1e-4, &b.state);
    without.f.elements = NULL;
    drive(&b);
    drive(&without);
    for (dem_index i = 0; i < b.n; i++) {
        const vec2 own = forces_acceleration(&b.f, i, b.x, b.v), other = forces_acceleration(&without.f, i, b.x, b.v);
        assert_close(own.x, other.x, 0.0);
        assert_close(own.y, other.y, 0.0);
        assert_close(forces_node_energy(&b.f, i, b.x), forces_node_energy(&without.f, i, b.x), 0.0);
    }
    const dem_energy e = measure_state(&b.f, b.x, b.v).energy, expected = measure_state(&without.f, b.x, b.v).energy;
    assert_memory_equal(&e, &expected, sizeof e);
    assert_close(forces_damping_power(&b.f, b.x, b.v), forces_damping_power(&without.f, b.x, b.v), 0.0);
    const dem_strain strain = measure_state(&b.f, b.x, b.v).strain, left = measure_state(&without.f, b.x, b.v).strain;
    assert_close(strain.min, left.min, 0.0);
    assert_close(strain.max, left.max, 0.0);
    assert_close(strain.area_min, left.area_min, 0.0);
    assert_int_equal(strain.guarded, left.guarded);
    assert_int_equal(strain.inverted, left.inverted);
}

/* A body of which all triangles soften, those about the middle by some levels; some are broken. */
static void open_soft(body *b)
{
    *b = (body){0};
    make_lattice(&b->lattice, 0.0);
    const dem_index n = b->lattice.n_triangles;
    b->lattice.softening = malloc((size_t)n * sizeof *b->lattice.softening);
    assert_non_null(b->lattice.softening);
    for (dem_index t = 0; t < n; t++) b->lattice.softening[t] = 2.5;
    compile(b);
    for (dem_index t = 0; t < n; t++)
        for (dem_index k = 0; k < 5 * t % 17 && t % 3 > 0; k++) element_state_soften(&b->state, t);
    for (dem_index t = 0; t < n; t += 7) element_state_break_triangle(&b->state, t);
}

/* Forces are minus the gradient of the energy that depends on a node, springs in tension and under pressure, couplings,
 * areas and guard among them. The energy of a node has parts of 1e4 J, and central differences over 2e-7 m the error
 * 1e4 J 1e-16/2e-7 m = 5e-6 N and that of the third derivative; forces are up to 1e6 N. */
TEST(forces_of_what_has_softened_come_from_its_energy)
{
    const double h = 1e-7;
    CLEANUP(close_body) body b;
    dem_index n_pulled = 0, n_pushed = 0;
    open_soft(&b);
    for (dem_index k = 0; k < b.lattice.n_springs; k++) {
        const bool soft = b.state.tension[k] < b.state.integrity[k];
        const double strain = springs_strain_of(&b.lattice, k, b.x);
        n_pulled += soft && strain > 0.0;
        n_pushed += soft && strain < 0.0;
    }
    assert_true(n_pulled > 10 && n_pushed > 10);
    for (dem_index c = 0; c < 2 * b.n; c++) {
        const dem_index i = c / 2;
        const vec2 force = vec2_scale(b.lattice.mass[i], forces_acceleration(&b.f, i, b.x, b.v));
        const double x = b.x[c];
        b.x[c] = x + h;
        const double above = forces_node_energy(&b.f, i, b.x);
        b.x[c] = x - h;
        const double below = forces_node_energy(&b.f, i, b.x);
        b.x[c] = x;
        assert_close(c % 2 == 0 ? force.x : force.y, (below - above) / (2.0 * h), 1e-2);
    }
}

/* Strains and forces that are reported of each spring: those that are broken have none, weaker ones
 * less force. */
TEST(a_broken_spring_has_no_strain_and_no_force)
{
    CLEANUP(close_body) body b;
    open_body(&b, 0.0);
    break_some(&b);
    CLEANUP(free_memory) double *whole = calloc(3 * (size_t)b.lattice.n_springs, sizeof *whole);
    assert_non_null(whole);
    double *strain = whole + b.lattice.n_springs, *force = strain + b.lattice.n_springs;
    const double *integrity = b.state.integrity;
    const springs_integrity state = element_state_springs(&b.state);
    dem_index n_weaker = 0;
    springs_strains(&b.model->lattice, SPRINGS_WHOLE, b.x, whole);
    springs_strains(&b.model->lattice, state, b.x, strain);
    springs_forces(&b.model->lattice, state, b.x, force);
    for (dem_index k = 0; k < b.lattice.n_springs; k++) {
        const double expected = integrity[k] * b.lattice.stiffness[k] * whole[k];
        assert_true(whole[k] != 0.0);
        assert_close(strain[k], integrity[k] == 0.0 ? 0.0 : whole[k], 0.0);
        assert_close(force[k], expected, 1e-15 * fabs(expected));
        n_weaker += integrity[k] > 0.0 && integrity[k] < 1.0;
    }
    assert_true(n_weaker > 5);
}
