/* SPDX-License-Identifier: BSD-3-Clause */
/* A body does not know how its nodes are numbered: the same motion, after the numbering is undone, for a body whose
 * nodes are shuffled and one whose nodes are not; to the bit the same numbers of the whole of the same state. */
#include "harness/cleanup_gsl.h"
#include "ask.h"
#include "support.h"

#include <gsl/gsl_rng.h>
#include <stdlib.h>
#include <string.h>

#include "forces/forces.h"
#include "model/touching_bodies.h"

static const dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 0.4, .density = 1050.0,
                                         .thickness = 1.0, .guard = 0.02);

static dem_lattice make_block(double width, double height, double spacing)
{
    const double down[2] = {1.0, -10.0};
    dem_lattice lattice = support_rectangle(width, height, spacing, &rubber);
    assert_ok(dem_lattice_launch(&lattice, down));
    dem_lattice_move(&lattice, 0.1, (const double[2]){0.0, 0.3 * spacing});
    assert_ok(dem_lattice_spin(&lattice, 30.0));
    return lattice;
}

/* number[i]: the new one of node i. */
static dem_index *shuffle(dem_index n)
{
    dem_index *number = malloc((size_t)n * sizeof *number);
    CLEANUP(free_rng) gsl_rng *r = gsl_rng_alloc(gsl_rng_mt19937);
    assert_non_null(number);
    for (dem_index k = 0; k < n; k++) number[k] = k;
    for (dem_index k = n - 1; k > 0; k--) {
        const dem_index j = (dem_index)gsl_rng_uniform_int(r, (unsigned long)k + 1), kept = number[k];
        number[k] = number[j];
        number[j] = kept;
    }
    return number;
}

static void renumber_array(double *array, dem_index n, int width, const dem_index *number)
{
    const size_t size = (size_t)(n * width) * sizeof *array;
    CLEANUP(free_memory) double *old = malloc(size);
    assert_non_null(old);
    memcpy(old, array, size);
    for (dem_index i = 0; i < n; i++) memcpy(array + width * number[i], old + width * i, (size_t)width * sizeof *array);
}

static void renumber(dem_lattice *l, const dem_index *number)
{
    renumber_array(l->x, l->n_nodes, 2, number);
    if (l->position != NULL) renumber_array(l->position, l->n_nodes, 2, number);
    renumber_array(l->velocity, l->n_nodes, 2, number);
    renumber_array(l->mass, l->n_nodes, 1, number);
    for (dem_index k = 0; k < 2 * l->n_springs; k++) l->ends[k] = number[l->ends[k]];
    for (dem_index k = 0; k < 3 * l->n_triangles; k++) l->triangles[k] = number[l->triangles[k]];
}

/* Positions at t, in the numbers of the lattice. */
static double *run(const dem_lattice *lattice, const dem_obstacle *ground, double t)
{
    const size_t size = 2 * (size_t)lattice->n_nodes * sizeof(double);
    dem_options options = support_options();
    CLEANUP(support_close) support_run r;
    double *x = malloc(size);
    assert_non_null(x);
    options.rtol = 1e-9;
    options.threads = 2;
    options.thread_nodes = 1;
    support_open(&r, lattice, ground, ground != NULL ? 1 : 0, &options);
    memcpy(x, support_at(&r, t).x, size);
    assert_true(ground == NULL || ask_counts(r.simulation).impacts > 3);
    return x;
}

/* Largest difference of positions at t, m. */
static double difference(double width, double height, double spacing, const dem_obstacle *ground, double t)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_block(width, height, spacing);
    const dem_index n = lattice.n_nodes;
    CLEANUP(free_memory) dem_index *number = shuffle(n);
    double *usual = run(&lattice, ground, t), largest = 0.0;
    renumber(&lattice, number);
    CLEANUP(free_memory) double *shuffled = run(&lattice, ground, t);
    for (dem_index i = 0; i < n; i++)
        for (int c = 0; c < 2; c++) largest = fmax(largest, fabs(usual[2 * i + c] - shuffled[2 * number[i] + c]));
    free(usual);
    return largest;
}

/* 1e-12 m: the sums at a node have another order, 1e-16 of forces of 1e5 N/m times coordinates, over some hundred
 * steps. 3000 nodes, for which the model finds a numbering of its own. */
TEST(a_free_body_moves_alike)
{
    assert_close(difference(0.3, 0.2, 5e-3, NULL, 1e-3), 0.0, 1e-12);
}

/* Plastic impacts: rounding is not amplified from one to the next. */
TEST(a_body_that_hits_the_ground_moves_alike)
{
    const double points[4] = {-1.0, -0.004, 1.0, -0.004};
    const dem_obstacle ground =
        SIZED(dem_obstacle, .n_points = 2, .points = points, .restitution = 0.0, .friction = 0.3);
    assert_close(difference(0.1, 0.06, 1e-2, &ground, 2e-3), 0.0, 1e-12);
}

/* ---- energies of one state ---- */

static double on_grid(double x)
{
    return round(x * 1024.0) / 1024.0;
}

/* Places are multiples of 2^-10 m, at rest and now, so that the area of a triangle is the same to the bit from each of
 * its corners: what is added up does not depend on the numbers, and the sum must not. Strains of some 30 %, velocities
 * of 1 m/s and masses, all without an order. */
static dem_lattice make_irregular(void)
{
    dem_lattice l = dem_lattice_empty();
    assert_ok(dem_lattice_rectangle(&l, 0.6, 0.4, 0.02));
    for (dem_index k = 0; k < 2 * l.n_nodes; k++) l.x[k] = on_grid(l.x[k]);
    assert_ok(dem_lattice_assemble(&l, &rubber));
    assert_ok(dem_lattice_launch(&l, (const double[2]){0.0, 0.0}));
    for (dem_index i = 0; i < l.n_nodes; i++) l.mass[i] *= 1.0 + 0.3 * sin(4.1 * (double)i);
    l.position = malloc(2 * (size_t)l.n_nodes * sizeof *l.position);
    assert_non_null(l.position);
    for (dem_index k = 0; k < 2 * l.n_nodes; k++) {
        l.position[k] = on_grid(l.x[k] + 0.012 * sin(12.9898 * (double)(k + 1)));
        l.velocity[k] = sin(78.233 * (double)(k + 1));
    }
    return l;
}

typedef struct sums {
    dem_energy energy;
    dem_body_motion motion;
    dem_strain strain;
    dem_fracture fracture;
    body_content content;
    double mass;
} sums;

static body_content content_of(const dem_lattice *lattice)
{
    CLEANUP(touching_bodies_free) touching_bodies bodies = {0};
    assert_ok(touching_bodies_sum_up(&bodies, &ranks_alone, lattice, 1));
    return bodies.bodies[0];
}

/* Four of five triangles are broken, without an order: single nodes and small pieces are left beside larger ones. */
static void break_some(dem_simulation *s, const dem_lattice *l)
{
    CLEANUP(free_memory) dem_index *broken = malloc((size_t)l->n_triangles * sizeof *broken);
    dem_index n = 0;
    assert_non_null(broken);
    for (dem_index k = 0; k < l->n_triangles; k++)
        if (sin(12.9898 * (double)(k + 1)) < 0.81) broken[n++] = k;
    assert_ok(dem_simulation_break(s, broken, n, NULL, 0));
}

static sums sums_of(const dem_lattice *lattice, bool broken)
{
    const dem_options options = support_options();
    CLEANUP(support_close) support_run r;
    support_open(&r, lattice, NULL, 0, &options);
    if (broken) break_some(r.simulation, lattice);
    const sums all = {ask_energy(r.simulation),   ask_body(r.simulation, 0), ask_strain(r.simulation),
                      ask_fracture(r.simulation), content_of(lattice),       dem_model_mass(r.model)};
    return all;
}

/* Springs take other places in their list, too. */
static void reverse_springs(dem_lattice *l)
{
    CLEANUP(free_memory) dem_index *place = malloc((size_t)l->n_springs * sizeof *place);
    assert_non_null(place);
    for (dem_index k = 0; k < l->n_springs; k++) place[k] = l->n_springs - 1 - k;
    renumber_array(l->stiffness, l->n_springs, 1, place);
    renumber_array(l->rest_length, l->n_springs, 1, place);
    for (dem_index k = 0; k < l->n_springs / 2; k++)
        for (int c = 0; c < 2; c++) {
            const dem_index other = 2 * (l->n_springs - 1 - k) + c, kept = l->ends[2 * k + c];
            l->ends[2 * k + c] = l->ends[other];
            l->ends[other] = kept;
        }
}

/* But which of several springs with the same strain is named: that goes by numbers. */
static void assert_same_strains(const dem_strain *a, const dem_strain *b)
{
    assert_close(a->min, b->min, 0.0);
    assert_close(a->max, b->max, 0.0);
    assert_close(a->area_min, b->area_min, 0.0);
    assert_int_equal(a->guarded, b->guarded);
    assert_int_equal(a->inverted, b->inverted);
}

static void check_sums(bool broken)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_irregular();
    CLEANUP(free_memory) dem_index *number = shuffle(lattice.n_nodes);
    const sums usual = sums_of(&lattice, broken);
    renumber(&lattice, number);
    reverse_springs(&lattice);
    const sums shuffled = sums_of(&lattice, broken);
    assert_true(usual.energy.kinetic > 1.0 && usual.energy.elastic > 1.0 && usual.energy.area > 1.0);
    assert_true(usual.energy.guard > 0.0 && usual.energy.gravity != 0.0);
    assert_memory_equal(&usual.energy, &shuffled.energy, sizeof usual.energy);
    assert_memory_equal(&usual.motion, &shuffled.motion, sizeof usual.motion);
    assert_same_strains(&usual.strain, &shuffled.strain);
    assert_memory_equal(&usual.fracture, &shuffled.fracture, sizeof usual.fracture);
    assert_memory_equal(&usual.content, &shuffled.content, sizeof usual.content);
    assert_close(usual.mass, shuffled.mass, 0.0);
    assert_true(!broken || (usual.fracture.fragments > 3 && usual.fracture.debris > 0.0));
}

TEST(energies_and_mean_motion_are_the_same_to_the_bit)
{
    check_sums(false);
}

TEST(what_is_broken_is_the_same_to_the_bit)
{
    check_sums(true);
}

/* ---- powers in one state ---- */

typedef struct powers {
    double damping, work, given; /* W, W, J */
} powers;

enum { PUSHED, HELD, N_BOUNDARIES };

/* A force shared out among all nodes without an order, and prescribed motion of every seventh. \param number  the new
 * one of node i */
static powers powers_of(const dem_lattice *l, const dem_index *number)
{
    const dem_index n = l->n_nodes;
    CLEANUP(free_memory) dem_index *nodes = calloc(2 * (size_t)n, sizeof *nodes);
    CLEANUP(free_memory) double *values = calloc(7 * (size_t)n, sizeof *values);
    double *share = values, *u = values + n, *a = values + 3 * n, *v = values + 5 * n;
    dem_boundary list[N_BOUNDARIES] = {[PUSHED] = SIZED(dem_boundary, .kind = DEM_BOUNDARY_FORCE, .nodes = nodes,
                                                        .share = share, .n_nodes = n, .value = {3.0, -7.0}),
                                       [HELD] = SIZED(dem_boundary, .kind = DEM_BOUNDARY_VELOCITY,
                                                      .components = DEM_COMPONENT_Y, .nodes = nodes + n,
                                                      .value = {0.0, 0.1})};
    for (dem_index i = 0; i < n; i++) {
        const dem_index j = number != NULL ? number[i] : i;
        nodes[j] = j; /* in the order of numbers */
        share[j] = 1.0 + sin(3.7 * (double)i);
        a[2 * j] = 100.0 * sin(1.3 * (double)i);
        a[2 * j + 1] = 100.0 * cos(2.9 * (double)i);
    }
    for (dem_index i = 0; i < n; i += 7) nodes[n + list[HELD].n_nodes++] = number != NULL ? number[i] : i;
    CLEANUP(free_model) dem_model *model = support_model(l, NULL, 0);
    CLEANUP(boundary_conditions_free) boundary_conditions given;
    assert_ok(boundary_conditions_compile(&given, list, N_BOUNDARIES, dem_model_lattice(model), NULL, 0));
    const forces f = {.model = model, .mass_damping = 5.0, .boundaries = &given};
    memcpy(v, l->velocity, 2 * (size_t)n * sizeof *v);
    memcpy(u, v, 2 * (size_t)n * sizeof *u);
    powers p = {.damping = forces_damping_power(&f, l->position, v), .work = forces_prescribe(&f, 0.0, v, u, a)};
    exact_sum energy = {0};
    boundary_conditions_give_velocities(&given, l->mass, 0.0, v, &energy);
    p.given = exact_sum_value(&energy);
    return p;
}

TEST(powers_are_the_same_to_the_bit)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_irregular();
    lattice.viscosity = malloc((size_t)lattice.n_springs * sizeof *lattice.viscosity);
    assert_non_null(lattice.viscosity);
    for (dem_index k = 0; k < lattice.n_springs; k++) lattice.viscosity[k] = 1e-3 * lattice.stiffness[k];
    CLEANUP(free_memory) dem_index *number = shuffle(lattice.n_nodes);
    const powers usual = powers_of(&lattice, NULL);
    renumber(&lattice, number);
    const powers shuffled = powers_of(&lattice, number);
    assert_true(usual.damping > 1.0 && fabs(usual.work) > 1.0 && fabs(usual.given) > 0.1);
    assert_close(usual.damping, shuffled.damping, 0.0);
    assert_close(usual.work, shuffled.work, 0.0);
    assert_close(usual.given, shuffled.given, 0.0);
}
