/* SPDX-License-Identifier: BSD-3-Clause */
/* springs.c, springs.h: CSR from triplets, the bond force (1), its energy and damping, the bounds of both. */
#include "verification/support.h"

#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_rng.h>

#include "elastic/springs.h"
#include "harness/cleanup_gsl.h"
#include "harness/message.h"
#include "unit/elastic/energy.h"

enum { n_nodes = 5, n_springs = 6 };

static const double corners[2 * n_nodes] = {0.0, 0.0, 1.0, 0.1, 0.9, 1.2, -0.2, 0.8, 0.4, 0.5};
static const double masses[n_nodes] = {1.0, 2.0, 3.0, 4.0, 5.0};
static const dem_index pairs[2 * n_springs] = {4, 0, 3, 0, 1, 4, 2, 1, 0, 1, 4, 2}; /* in no order */

static double viscosity_of(dem_index spring)
{
    return spring == 2 ? 0.0 : 3.0 + 0.5 * (double)spring;
}

/* A net of springs that differ in rest length, stiffness and viscosity. */
static dem_lattice make_net(void)
{
    dem_lattice lattice = support_lattice(n_nodes, corners, masses, n_springs, pairs, 1.0, 100.0, NULL);
    for (dem_index k = 0; k < n_springs; k++) {
        lattice.rest_length[k] = 0.5 + 0.1 * (double)k;
        lattice.stiffness[k] = 100.0 + 7.0 * (double)k;
    }
    lattice.viscosity = malloc(n_springs * sizeof *lattice.viscosity);
    assert_non_null(lattice.viscosity);
    for (dem_index k = 0; k < n_springs; k++) lattice.viscosity[k] = viscosity_of(k);
    return lattice;
}

static springs compile(const dem_lattice *lattice)
{
    springs s;
    assert_ok(springs_compile(&s, lattice));
    return s;
}

static dem_lattice make_pair(const double x[4], double rest_length, double stiffness)
{
    const dem_index ends[2] = {0, 1};
    dem_lattice lattice = support_lattice(2, x, masses, 1, ends, rest_length, stiffness, NULL);
    return lattice;
}

/* Positions away from rest, or velocities, the same in every run. */
static void stir(double *x, dem_index n, double by, unsigned long seed)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_rng_set(rng, seed);
    for (dem_index k = 0; k < 2 * n; k++) x[k] += by * (2.0 * gsl_rng_uniform(rng) - 1.0);
}

/* Strain and force of every spring in the order of the lattice, and r x f, from the two ends by hand. */
TEST(strain_force_and_virial_are_those_of_each_spring)
{
    double x[2 * n_nodes], strain[n_springs], force[n_springs], virial[3];
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_net();
    memcpy(x, corners, sizeof x);
    stir(x, n_nodes, 0.3, 5);
    springs_strains(&lattice, SPRINGS_WHOLE, x, strain);
    springs_forces(&lattice, SPRINGS_WHOLE, x, force);
    for (dem_index k = 0; k < n_springs; k++) {
        const dem_index i = pairs[2 * k], j = pairs[2 * k + 1];
        const double dx = x[2 * j] - x[2 * i], dy = x[2 * j + 1] - x[2 * i + 1], d = hypot(dx, dy);
        const double e = d / lattice.rest_length[k] - 1.0, f = lattice.stiffness[k] * e;
        springs_virial(&lattice, k, x, virial);
        assert_close(strain[k], e, 1e-15);
        assert_close(force[k], f, 1e-12);
        assert_close(virial[0], f * dx * dx / d, 1e-12);
        assert_close(virial[1], f * dy * dy / d, 1e-12);
        assert_close(virial[2], f * dx * dy / d, 1e-12);
    }
}

/* ---- rows ---- */

TEST(rows_list_the_neighbours_in_ascending_order)
{
    static const int32_t row[n_nodes + 1] = {0, 3, 6, 8, 9, 12};
    static const int32_t neighbour[2 * n_springs] = {1, 3, 4, 0, 2, 4, 1, 4, 0, 0, 1, 2};
    static const int32_t spring[2 * n_springs] = {4, 1, 0, 4, 3, 2, 3, 5, 1, 0, 2, 5};
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_net();
    springs s = compile(&lattice);
    assert_int_equal(s.n_nodes, n_nodes);
    assert_int_equal(s.n_springs, n_springs);
    assert_memory_equal(s.row, row, sizeof row);
    assert_memory_equal(s.neighbour, neighbour, sizeof neighbour);
    assert_memory_equal(s.spring, spring, sizeof spring);
    for (dem_index k = 0; k < n_springs; k++) {
        assert_close(s.rest_length_of[k], 0.5 + 0.1 * (double)k, 0.0);
        assert_close(s.stiffness_of[k], 100.0 + 7.0 * (double)k, 0.0);
        assert_close(s.viscosity_of[k], viscosity_of(k), 0.0);
    }
    springs_free(&s);
    assert_null(s.row);
    assert_null(s.viscosity_of);
}

TEST(two_springs_between_the_same_nodes_are_named)
{
    static const dem_index alike[8] = {0, 1, 2, 1, 0, 2, 2, 1}, turned[8] = {2, 1, 0, 1, 2, 0, 1, 0};
    springs s = {.n_nodes = 77};
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(3, corners, masses, 4, alike, 1.0, 1.0, NULL);
    assert_int_equal(springs_compile(&s, &lattice), DEM_ERROR_MODEL);
    assert_message_parts("springs 1 and 3 * nodes 1 and 2");
    dem_lattice_free(&lattice);
    lattice = support_lattice(3, corners, masses, 4, turned, 1.0, 1.0, NULL);
    assert_int_equal(springs_compile(&s, &lattice), DEM_ERROR_MODEL);
    assert_message_parts("springs 1 and 3 * nodes 0 and 1");
    assert_int_equal(s.n_nodes, 77);
}

TEST(nodes_without_springs_feel_nothing)
{
    CLEANUP(springs_free) springs s;
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(n_nodes, corners, masses, 0, NULL, 0.0, 0.0, NULL);
    assert_ok(springs_compile(&s, &lattice));
    for (dem_index i = 0; i < n_nodes; i++) {
        const vec2 force = springs_force(&s, SPRINGS_WHOLE, i, corners);
        assert_true(force.x == 0.0 && force.y == 0.0);
    }
    assert_close(energy_springs(&lattice, SPRINGS_WHOLE, corners), 0.0, 0.0);
    assert_close(sym2_largest(springs_block(&s, s.stiffness_of, 0, corners)), 0.0, 0.0);
}

/* ---- force and energy ---- */

/* E = 100 N, d0 = 2 m, d = 5 m: 100 N (5 - 2)/2 = 150 N along (3, 4)/5; energy 100 * 2/2 * 1.5^2 = 225 J. Rounding
 * only. */
TEST(a_stretched_spring_pulls_with_stiffness_times_strain)
{
    const double x[4] = {1.0, -1.0, 4.0, 3.0};
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_pair(x, 2.0, 100.0);
    CLEANUP(springs_free) springs s = compile(&lattice);
    const vec2 first = springs_force(&s, SPRINGS_WHOLE, 0, x), second = springs_force(&s, SPRINGS_WHOLE, 1, x);
    assert_close(first.x, 90.0, 1e-13);
    assert_close(first.y, 120.0, 1e-13);
    assert_true(second.x == -first.x && second.y == -first.y);
    assert_close(springs_strain(&s, 0, 0, x), 1.5, 0.0);
    assert_close(energy_springs(&lattice, SPRINGS_WHOLE, x), 225.0, 0.0);
    assert_close(springs_node_energy(&s, SPRINGS_WHOLE, 1, x), 225.0, 0.0);
}

TEST(a_compressed_spring_pushes)
{
    const double x[4] = {0.0, 0.0, 0.0, 1.5};
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_pair(x, 2.0, 100.0);
    CLEANUP(springs_free) springs s = compile(&lattice);
    assert_close(springs_force(&s, SPRINGS_WHOLE, 0, x).y, -25.0, 0.0);
    assert_close(springs_force(&s, SPRINGS_WHOLE, 1, x).y, 25.0, 0.0);
    assert_close(springs_strain(&s, 1, 1, x), -0.25, 0.0);
}

/* Central differences over 1e-5 m: truncation of order 1e-10 times E/d^3 = 1e3 N/m^3, rounding of order 1e-16 * 100
 * J/1e-5 m. */
TEST(the_force_is_minus_the_gradient_of_the_energy)
{
    const double step = 1e-5;
    double x[2 * n_nodes];
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_net();
    CLEANUP(springs_free) springs s = compile(&lattice);
    memcpy(x, corners, sizeof x);
    stir(x, n_nodes, 0.2, 1);
    for (dem_index i = 0; i < n_nodes; i++) {
        const vec2 force = springs_force(&s, SPRINGS_WHOLE, i, x);
        for (int k = 0; k < 2; k++) {
            const double here = x[2 * i + k];
            x[2 * i + k] = here + step;
            const double above = energy_springs(&lattice, SPRINGS_WHOLE, x),
                         node_above = springs_node_energy(&s, SPRINGS_WHOLE, i, x);
            x[2 * i + k] = here - step;
            const double below = energy_springs(&lattice, SPRINGS_WHOLE, x),
                         node_below = springs_node_energy(&s, SPRINGS_WHOLE, i, x);
            x[2 * i + k] = here;
            assert_close(k == 0 ? force.x : force.y, (below - above) / (2.0 * step), 1e-6);
            assert_close(k == 0 ? force.x : force.y, (node_below - node_above) / (2.0 * step), 1e-6);
        }
    }
}

/* Rounding of sums of a dozen terms of about 100 N. */
TEST(springs_exert_no_force_and_no_torque_on_the_whole)
{
    double x[2 * n_nodes], torque = 0.0, energy = 0.0;
    vec2 total = {0.0, 0.0};
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_net();
    CLEANUP(springs_free) springs s = compile(&lattice);
    memcpy(x, corners, sizeof x);
    stir(x, n_nodes, 0.2, 2);
    for (dem_index i = 0; i < n_nodes; i++) {
        const vec2 force = springs_force(&s, SPRINGS_WHOLE, i, x);
        total = vec2_add(total, force);
        torque += vec2_cross(vec2_at(x, i), force);
        energy += 0.5 * springs_node_energy(&s, SPRINGS_WHOLE, i, x); /* every spring is at two nodes */
    }
    assert_close(total.x, 0.0, 1e-12);
    assert_close(total.y, 0.0, 1e-12);
    assert_close(torque, 0.0, 1e-12);
    assert_true(energy_springs(&lattice, SPRINGS_WHOLE, x) > 1.0);
    assert_close(energy, energy_springs(&lattice, SPRINGS_WHOLE, x), 1e-12);
}

TEST(nodes_that_coincide_give_a_force_that_is_no_number)
{
    const double apart[4] = {0.0, 0.0, 1.0, 0.0}, together[4] = {0.3, 0.7, 0.3, 0.7};
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_pair(apart, 1.0, 10.0);
    CLEANUP(springs_free) springs s = compile(&lattice);
    assert_true(isnan(springs_force(&s, SPRINGS_WHOLE, 0, together).x) != 0);
    assert_true(isnan(springs_force(&s, SPRINGS_WHOLE, 1, together).y) != 0);
    assert_close(energy_springs(&lattice, SPRINGS_WHOLE, together), 5.0, 0.0);
}

/* ---- damping ---- */

static double damping_power(const springs *s, const double *x, const double *v)
{
    exact_sum power = {0};
    exact_terms terms;
    exact_terms_begin(&terms, &power);
    springs_add_damping_power(s, SPRINGS_WHOLE, (dem_index[]){0, s->n_nodes}, x, v, &terms);
    exact_terms_end(&terms);
    return exact_sum_value(&power);
}

TEST(springs_without_viscosities_stay_without)
{
    const double x[4] = {0.0, 0.0, 1.0, 0.0}, v[4] = {0.0, 0.0, 1.0, 0.0}, inverse_mass[2] = {1.0, 1.0};
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_pair(x, 1.0, 10.0);
    CLEANUP(springs_free) springs s = compile(&lattice);
    assert_null(s.viscosity_of);
    assert_close(damping_power(&s, x, v), 0.0, 0.0);
    assert_close(springs_damping_bound(&s, x, inverse_mass), 0.0, 0.0);
}

static dem_lattice make_damped_pair(const double x[4], double rest_length, double viscosity)
{
    dem_lattice lattice = make_pair(x, rest_length, 100.0);
    lattice.viscosity = malloc(sizeof *lattice.viscosity);
    assert_non_null(lattice.viscosity);
    lattice.viscosity[0] = viscosity;
    return lattice;
}

/* c = 6 N s, d0 = 2 m, d = 5 m along (3, 4)/5. The ends part with (7, -1) m/s, along the spring (21 - 4)/5 = 3.4 m/s:
 * 6 N s * 3.4/2 = 10.2 N along (3, 4)/5, that takes 10.2 N * 3.4 m/s. Rounding only. */
TEST(a_lengthening_spring_pulls_with_viscosity_times_strain_rate)
{
    const double x[4] = {1.0, -1.0, 4.0, 3.0}, v[4] = {-2.0, 5.0, 5.0, 4.0};
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_damped_pair(x, 2.0, 6.0);
    CLEANUP(springs_free) springs s = compile(&lattice);
    const vec2 first = springs_damping(&s, SPRINGS_WHOLE, 0, x, v),
               second = springs_damping(&s, SPRINGS_WHOLE, 1, x, v);
    assert_close(first.x, 6.12, 1e-14);
    assert_close(first.y, 8.16, 1e-14);
    assert_true(second.x == -first.x && second.y == -first.y);
    assert_close(damping_power(&s, x, v), 34.68, 1e-13);
}

/* Rounding of sums of a dozen terms of about 10 N at 1 m/s. */
TEST(damping_has_no_force_and_no_torque_on_the_whole_and_takes_its_power)
{
    double x[2 * n_nodes], v[2 * n_nodes] = {0}, torque = 0.0, given = 0.0;
    vec2 total = {0.0, 0.0};
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_net();
    CLEANUP(springs_free) springs s = compile(&lattice);
    memcpy(x, corners, sizeof x);
    stir(x, n_nodes, 0.2, 3);
    stir(v, n_nodes, 1.0, 4);
    for (dem_index i = 0; i < n_nodes; i++) {
        const vec2 force = springs_damping(&s, SPRINGS_WHOLE, i, x, v);
        total = vec2_add(total, force);
        torque += vec2_cross(vec2_at(x, i), force);
        given += vec2_dot(vec2_at(v, i), force);
    }
    assert_close(total.x, 0.0, 1e-13);
    assert_close(total.y, 0.0, 1e-13);
    assert_close(torque, 0.0, 1e-13);
    assert_true(damping_power(&s, x, v) > 1.0);
    assert_close(damping_power(&s, x, v), -given, 1e-13);
}

/* However much it is strained: each force is of the rounding of 10 N. */
TEST(a_rigid_motion_is_not_damped)
{
    double x[2 * n_nodes], v[2 * n_nodes];
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_net();
    CLEANUP(springs_free) springs s = compile(&lattice);
    memcpy(x, corners, sizeof x);
    stir(x, n_nodes, 0.2, 5);
    for (dem_index i = 0; i < n_nodes; i++) vec2_put(v, i, (vec2){0.7 - 3.0 * x[2 * i + 1], -0.2 + 3.0 * x[2 * i]});
    for (dem_index i = 0; i < n_nodes; i++) {
        const vec2 force = springs_damping(&s, SPRINGS_WHOLE, i, x, v);
        assert_close(force.x, 0.0, 1e-13);
        assert_close(force.y, 0.0, 1e-13);
    }
    assert_close(damping_power(&s, x, v), 0.0, 1e-26);
}

/* ---- frequencies ---- */

/* A pair on k = E/d0 = 50 N/m along (3, 4)/5: k n n^T of either node. */
TEST(the_block_of_a_pair_is_its_stiffness_along_it)
{
    const double x[4] = {0.0, 0.0, 1.2, 1.6};
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_pair(x, 2.0, 100.0);
    CLEANUP(springs_free) springs s = compile(&lattice);
    for (dem_index i = 0; i < 2; i++) {
        const sym2 block = springs_block(&s, s.stiffness_of, i, x);
        assert_close(block.xx, 50.0 * 0.36, 1e-13);
        assert_close(block.xy, 50.0 * 0.48, 1e-13);
        assert_close(block.yy, 50.0 * 0.64, 1e-13);
        assert_close(sym2_largest(block), 50.0, 1e-13);
    }
}

/* C/d0 = 6 N s/2 m = 3 kg/s: relative motion of 1 and 2 kg along the spring decays with 3 (1 + 1/2) = 4.5/s; the bound
 * is 2 * 3/m of the lighter that may move. */
TEST(the_damping_bound_of_a_pair_is_twice_its_damping_over_the_mass)
{
    const double x[4] = {0.0, 0.0, 1.2, 1.6}, both[2] = {1.0, 0.5}, held[2] = {0.0, 0.5};
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_damped_pair(x, 2.0, 6.0);
    CLEANUP(springs_free) springs s = compile(&lattice);
    assert_close(springs_damping_bound(&s, x, both), 6.0, 1e-14);
    assert_close(springs_damping_bound(&s, x, held), 3.0, 1e-14);
}

static gsl_matrix *make_matrix(const dem_lattice *lattice)
{
    return gsl_matrix_alloc(2 * (size_t)lattice->n_nodes, 2 * (size_t)lattice->n_nodes);
}

/* Minus a force on node i per change of coordinate q, times M^-1/2 from both sides. */
static void set_entry(gsl_matrix *matrix, const dem_lattice *lattice, dem_index i, dem_index q, vec2 minus_force)
{
    const vec2 k = vec2_scale(1.0 / sqrt(lattice->mass[i] * lattice->mass[q / 2]), minus_force);
    gsl_matrix_set(matrix, (size_t)(2 * i), (size_t)q, k.x);
    gsl_matrix_set(matrix, (size_t)(2 * i + 1), (size_t)q, k.y);
}

/* Frees the matrix. */
static double largest_eigenvalue(gsl_matrix *matrix)
{
    CLEANUP(free_vector) gsl_vector *values = gsl_vector_alloc(matrix->size1);
    gsl_eigen_symm_workspace *work = gsl_eigen_symm_alloc(matrix->size1);
    assert_int_equal(gsl_eigen_symm(matrix, values, work), 0);
    const double largest = gsl_vector_max(values);
    gsl_eigen_symm_free(work);
    gsl_matrix_free(matrix);
    return largest;
}

/* C from the forces at one unit velocity after the other, in which they are linear. */
static double highest_damping_rate(const springs *s, const dem_lattice *lattice)
{
    gsl_matrix *damping = make_matrix(lattice);
    double v[400] = {0};
    for (dem_index q = 0; q < 2 * lattice->n_nodes; q++) {
        v[q] = 1.0;
        for (dem_index i = 0; i < lattice->n_nodes; i++)
            set_entry(damping, lattice, i, q, vec2_scale(-1.0, springs_damping(s, SPRINGS_WHOLE, i, lattice->x, v)));
        v[q] = 0.0;
    }
    return largest_eigenvalue(damping);
}

/* About the rest shape C = damping_time K, so that the bound follows that of the frequency: see verify_spectrum. */
TEST(the_damping_bound_is_above_the_highest_rate_by_less_than_six_tenths)
{
    const dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0,
                                      .density = 1050.0, .thickness = 1.0, .damping_time = 1e-5);
    const double sizes[3][2] = {{0.02, 0.02}, {0.04, 0.06}, {0.08, 0.03}};
    for (int k = 0; k < 3; k++) {
        CLEANUP(springs_free) springs s;
        double inverse_mass[200];
        CLEANUP(dem_lattice_free) dem_lattice lattice = support_rectangle(sizes[k][0], sizes[k][1], 0.01, &rubber);
        assert_true(lattice.n_nodes <= 200);
        for (dem_index i = 0; i < lattice.n_nodes; i++) inverse_mass[i] = 1.0 / lattice.mass[i];
        assert_ok(springs_compile(&s, &lattice));
        const double rate = highest_damping_rate(&s, &lattice);
        const double damping = springs_damping_bound(&s, lattice.x, inverse_mass);
        assert_true(damping >= rate * (1.0 - 1e-13));
        assert_true(damping <= 1.6 * rate);
    }
}

/* Viscosities of its own for every spring, one of them 0. */
TEST(the_damping_bound_of_a_net_is_above_the_highest_rate)
{
    double inverse_mass[n_nodes];
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_net();
    CLEANUP(springs_free) springs s = compile(&lattice);
    for (int i = 0; i < n_nodes; i++) inverse_mass[i] = 1.0 / masses[i];
    const double bound = springs_damping_bound(&s, corners, inverse_mass), rate = highest_damping_rate(&s, &lattice);
    assert_true(bound >= rate * (1.0 - 1e-13));
    assert_true(bound <= 2.0 * rate); /* no rate is below those of single nodes, |S_i|/m_i */
}
