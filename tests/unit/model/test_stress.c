/* SPDX-License-Identifier: BSD-3-Clause */
/* stress.c: which springs make up whose stress, against sums over springs, forces and energies taken otherwise. */
#include "verification/support.h"

#include <gsl/gsl_rng.h>
#include <stdlib.h>
#include <string.h>

#include "forces/forces.h"
#include "harness/cleanup_gsl.h"
#include "ask.h"
#include "unit/elastic/energy.h"
#include "unit/elastic/look.h"
#include "unit/solids.h"

static double *copy_positions(const dem_model *model)
{
    const size_t size = 2 * (size_t)model->lattice.n_nodes * sizeof(double);
    double *x = malloc(size);
    assert_non_null(x);
    memcpy(x, model->lattice.x, size);
    return x;
}

/* x -> F x, F row by row. */
static void deform(double *x, dem_index n, const double F[4])
{
    for (dem_index i = 0; i < n; i++) {
        const vec2 a = vec2_at(x, i);
        vec2_put(x, i, (vec2){F[0] * a.x + F[1] * a.y, F[2] * a.x + F[3] * a.y});
    }
}

static void stress_at(const dem_model *m, dem_index i, const double *x, double stress[3])
{
    assert_ok(stress_prepare(&m->stress));
    stress_of_node(&m->stress, &m->lattice, &m->triangles, i, x, stress);
}

/* Sum of V_i sigma_i, N m. */
static void total_at(const dem_model *m, const double *x, double total[3])
{
    total[0] = total[1] = total[2] = 0.0;
    for (dem_index i = 0; i < m->lattice.n_nodes; i++) {
        double stress[3];
        stress_at(m, i, x, stress);
        for (int c = 0; c < 3; c++) total[c] += dem_model_volumes(m)[i] * stress[c];
    }
}

static dem_model *make_model(const dem_lattice *lattice)
{
    dem_model *model = support_model(lattice, NULL, 0);
    return model;
}

/* A block with a hole, so that boundaries and corners of all kinds are there. */
static bool outside_hole(void *context, const double *x)
{
    (void)context;
    return hypot(x[0] - 0.004, x[1] - 0.021) > 0.007;
}

static dem_model *make_jittered(double guard, double ratio, double jitter)
{
    dem_material material = rubber;
    material.guard = guard;
    material.poissons_ratio = ratio;
    if (jitter > 0.0) material.springs = DEM_SPRINGS_COUPLED;
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_rectangle(0.03, 0.04, 2.5e-3);
    assert_ok(dem_lattice_cut(&lattice, outside_hole, NULL));
    assert_ok(dem_lattice_jitter(&lattice, jitter * 2.5e-3, 1));
    assert_ok(dem_lattice_assemble(&lattice, &material));
    dem_model *model = make_model(&lattice);
    return model;
}

static dem_model *make_holed(double guard, double ratio)
{
    return make_jittered(guard, ratio, 0.0);
}

/* Squeezed to `height` and stirred by up to `share` of the spacing. */
static double *stir(const dem_model *model, double height, double share, gsl_rng *rng)
{
    const double F[4] = {1.1, 0.2, -0.1, height};
    double *x = copy_positions(model);
    deform(x, model->lattice.n_nodes, F);
    for (dem_index k = 0; k < 2 * model->lattice.n_nodes; k++)
        x[k] += share * 2.5e-3 * (2.0 * gsl_rng_uniform(rng) - 1.0);
    return x;
}

static double triangles_energy_at(const dem_model *m, const double *x)
{
    double area, guard;
    energy_triangles(&m->triangles, x, &area, &guard);
    return area + guard;
}

/* ---- sums ---- */

TEST(volumes_add_up_to_that_of_the_triangles)
{
    CLEANUP(free_model) dem_model *model = make_holed(0.0, 1.0 / 3.0);
    double volume = 0.0, corner = 0.0;
    for (dem_index i = 0; i < model->lattice.n_nodes; i++) volume += dem_model_volumes(model)[i];
    const double triangle = rubber.thickness * sqrt(3.0) / 4.0 * 2.5e-3 * 2.5e-3;
    corner = dem_model_volumes(model)[0];
    assert_close(volume, (double)model->lattice.n_triangles * triangle, 1e-12 * volume);
    assert_close(volume * rubber.density, dem_model_mass(model), 1e-12 * dem_model_mass(model));
    assert_close(corner, triangle / 3.0, 1e-12 * corner);
}

/* Rows and volumes take memory that runs without stresses have no use for. */
TEST(volumes_and_rows_are_made_when_they_are_asked_for)
{
    CLEANUP(free_model) dem_model *model = make_holed(0.0, 1.0 / 3.0);
    const stress_rows *r = model->stress.rows;
    assert_null(r->volume);
    const double *volumes = dem_model_volumes(model);
    assert_ptr_equal(volumes, r->volume);
    assert_null(r->row);
    assert_ok(stress_prepare(&model->stress));
    assert_non_null(r->row);
    assert_ptr_equal(dem_model_volumes(model), volumes);
}

/* Shares of a spring, times the volumes: each is given once, whole. */
TEST(every_spring_is_shared_out_whole)
{
    CLEANUP(free_model) dem_model *model = make_jittered(0.0, 1.0 / 3.0, 0.2);
    const stress_map *map = &model->stress;
    const stress_rows *r = map->rows;
    assert_ok(stress_prepare(map));
    CLEANUP(free_memory) double *given = calloc((size_t)model->lattice.n_springs, sizeof *given);
    assert_non_null(given);
    for (dem_index i = 0; i < model->lattice.n_nodes; i++)
        for (dem_index p = r->row[i]; p < r->row[i + 1]; p++) given[r->spring[p]] += r->share[p] * r->volume[i];
    for (dem_index k = 0; k < model->lattice.n_springs; k++) assert_close(given[k], 1.0, 1e-14);
}

/* The same spring from two triangles stands in a row once: an inner node has its 6 springs and the 6 opposite. */
TEST(a_row_has_every_spring_once)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(0.03, 0.04, 2.5e-3);
    CLEANUP(free_model) dem_model *model = make_model(&lattice);
    const stress_rows *r = model->stress.rows;
    const dem_index inner = 13 + 12 + 6;
    assert_null(r->row); /* before they are asked for */
    assert_ok(stress_prepare(&model->stress));
    assert_int_equal(r->row[inner + 1] - r->row[inner], 12);
    assert_int_equal(r->row[1], 3); /* a corner with one triangle */
}

/* sum V sigma = sum of r x f over the springs, summed here by pairs from the CSR; rounding of some 800 terms. */
TEST(the_sum_over_nodes_is_that_of_r_times_f)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(free_model) dem_model *model = make_holed(0.0, 1.0 / 3.0);
    const dem_csr csr = ask_csr(model);
    for (int trial = 0; trial < 5; trial++) {
        double *x = stir(model, 0.9, 0.2, rng), total[3], expected[3] = {0.0, 0.0, 0.0}, size = 0.0;
        for (dem_index i = 0; i < csr.n_nodes; i++)
            for (dem_index p = csr.row[i]; p < csr.row[i + 1]; p++) {
                const vec2 r = vec2_sub(vec2_at(x, csr.neighbour[p]), vec2_at(x, i));
                const double f = csr.stiffness[p] * (vec2_norm(r) - csr.rest_length[p]) / csr.rest_length[p];
                expected[0] += 0.5 * f * r.x * r.x / vec2_norm(r);
                expected[1] += 0.5 * f * r.y * r.y / vec2_norm(r);
                expected[2] += 0.5 * f * r.x * r.y / vec2_norm(r);
                size += 0.5 * fabs(f) * vec2_norm(r);
            }
        total_at(model, x, total);
        for (int c = 0; c < 3; c++) assert_close(total[c], expected[c], 1e-13 * size);
        free(x);
    }
}

/* The same by the forces on the nodes, of couplings, area term and guard too: sum V sigma = - sum x_i f_i, symmetric
 * since they have no torque. Here every triangle is below the onset, some are inverted. */
TEST(the_sum_over_nodes_is_minus_that_of_places_times_forces)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(free_model) dem_model *model = make_jittered(0.02, 0.45, 0.2);
    CLEANUP(free_memory) double *v = calloc(2 * (size_t)model->lattice.n_nodes, sizeof *v);
    const forces acting = {.model = model};
    assert_non_null(v);
    for (int trial = 0; trial < 5; trial++) {
        double *x = stir(model, 0.2, 0.3, rng), total[3], expected[4] = {0.0, 0.0, 0.0, 0.0}, size = 0.0;
        for (dem_index i = 0; i < model->lattice.n_nodes; i++) {
            const vec2 f = forces_of_elements(&acting, i, x, v), at = vec2_at(x, i);
            expected[0] -= at.x * f.x;
            expected[1] -= at.y * f.y;
            expected[2] -= at.x * f.y;
            expected[3] -= at.y * f.x;
            size += vec2_norm(at) * vec2_norm(f);
        }
        assert_true(triangles_energy_at(model, x) > 0.0);
        total_at(model, x, total);
        for (int c = 0; c < 3; c++) assert_close(total[c], expected[c], 1e-13 * size);
        assert_close(total[2], expected[3], 1e-13 * size);
        free(x);
    }
}

/* Under a small uniform strain every node of coupled triangles has the stress of Hooke's law, boundary and corners too:
 * terms of second order are some 1e-7 of it. */
TEST(jittered_nodes_have_the_exact_stress)
{
    static const double e[3] = {3e-8, -1e-8, 2e-8}, F[4] = {1.0 + 3e-8, 2e-8, 2e-8, 1.0 - 1e-8};
    static const double ratios[3] = {0.0, 0.3, 0.45};
    for (int k = 0; k < 3; k++) {
        const double nu = ratios[k], E = rubber.youngs_modulus, G = 0.5 * E / (1.0 + nu),
                     lambda = E * nu / (1 - nu * nu);
        CLEANUP(free_model) dem_model *model = make_jittered(0.02, nu, 0.3);
        CLEANUP(free_memory) double *x = copy_positions(model);
        deform(x, model->lattice.n_nodes, F);
        for (dem_index i = 0; i < model->lattice.n_nodes; i++) {
            double stress[3];
            stress_at(model, i, x, stress);
            for (int c = 0; c < 3; c++) {
                const double expected = 2.0 * G * e[c] + (c < 2 ? lambda * (e[0] + e[1]) : 0.0);
                assert_close(stress[c], expected, 1e-6 * E * 3e-8);
            }
        }
    }
}

/* ---- energies ---- */

static double energy_of(const dem_model *model, const double *x, const double F[4])
{
    CLEANUP(free_memory) double *turned = copy_positions(model);
    memcpy(turned, x, 2 * (size_t)model->lattice.n_nodes * sizeof *x);
    deform(turned, model->lattice.n_nodes, F);
    const double energy = energy_springs(&model->lattice, SPRINGS_WHOLE, turned) +
                          energy_couplings(&model->couplings, TRIANGLES_WHOLE, turned) +
                          triangles_energy_at(model, turned);
    return energy;
}

/* sum V sigma_ab = dW/de_ab under x -> (1 + e) x, for the shear by both halves; central differences of 1e-6: W is of
 * third derivatives like 1e3 W where the guard acts, so 1e-9 W, and rounding 1e-16 W/1e-6. */
TEST(it_is_the_derivative_of_the_energy_by_the_strain)
{
    static const double heights[3] = {0.95, 0.35, 0.15};
    const double h = 1e-6;
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(free_model) dem_model *model = make_jittered(0.02, 0.1, 0.2);
    for (int trial = 0; trial < 3; trial++) {
        double *x = stir(model, heights[trial], 0.1, rng), total[3];
        const double W = energy_of(model, x, (const double[4]){1, 0, 0, 1});
        const double xx =
            energy_of(model, x, (double[4]){1 + h, 0, 0, 1}) - energy_of(model, x, (double[4]){1 - h, 0, 0, 1});
        const double yy =
            energy_of(model, x, (double[4]){1, 0, 0, 1 + h}) - energy_of(model, x, (double[4]){1, 0, 0, 1 - h});
        const double xy = energy_of(model, x, (double[4]){1, h, 0, 1}) - energy_of(model, x, (double[4]){1, -h, 0, 1});
        const double yx = energy_of(model, x, (double[4]){1, 0, h, 1}) - energy_of(model, x, (double[4]){1, 0, -h, 1});
        total_at(model, x, total);
        assert_close(total[0], xx / (2.0 * h), 1e-8 * W);
        assert_close(total[1], yy / (2.0 * h), 1e-8 * W);
        assert_close(total[2], xy / (2.0 * h), 1e-8 * W);
        assert_close(total[2], yx / (2.0 * h), 1e-8 * W);
        free(x);
    }
}

/* Squeezed to J = 0.3 all round every triangle pushes back with sigma = J g w'(J)/h, at every node the same, beside the
 * springs, whose stress is that without a guard. Rounding. */
TEST(the_guard_adds_a_pressure)
{
    const double s = sqrt(0.3), F[4] = {s, 0.0, 0.0, s};
    CLEANUP(free_model) dem_model *model = make_holed(0.02, 1.0 / 3.0), *bare = make_holed(0.0, 1.0 / 3.0);
    CLEANUP(free_memory) double *x = copy_positions(model);
    deform(x, model->lattice.n_nodes, F);
    const double slope = look_guard_slope(0.3);
    const double pressure = -0.3 * 0.02 * rubber.youngs_modulus * slope; /* g/h = 0.02 E */
    assert_true(pressure > 0.0);
    for (dem_index i = 0; i < model->lattice.n_nodes; i++) {
        double with[3], without[3];
        stress_at(model, i, x, with);
        stress_at(bare, i, x, without);
        for (int c = 0; c < 2; c++) assert_close(with[c], without[c] - pressure, 1e-11 * pressure);
        assert_close(with[2], without[2], 0.0);
    }
}

/* ---- whose springs are whose ---- */

/* The left half of a block of other modulus and thickness. A spring between the halves is the sum of what either gives
 * it. */
static void make_two_materials(dem_lattice *lattice, const double modulus[2], const double thickness[2])
{
    *lattice = make_solid(0.02, 0.02, 2.5e-3);
    memset(lattice->stiffness, 0, (size_t)lattice->n_springs * sizeof *lattice->stiffness);
    for (dem_index t = 0; t < lattice->n_triangles; t++) {
        const dem_index *c = &lattice->triangles[3 * t];
        const int right = lattice->x[2 * c[0]] + lattice->x[2 * c[1]] + lattice->x[2 * c[2]] > 0.0;
        lattice->modulus[t] = modulus[right];
        lattice->thickness[t] = thickness[right];
        for (dem_index k = 0; k < lattice->n_springs; k++) {
            int ends = 0;
            for (int q = 0; q < 6; q++) ends += c[q % 3] == lattice->ends[2 * k + q / 3];
            if (ends == 2)
                lattice->stiffness[k] +=
                    modulus[right] * thickness[right] * area_of(lattice, t) / lattice->rest_length[k];
        }
    }
}

/* With a uniform strain a triangle has the stress of its own material, and so has every node whose triangles are all of
 * one; a node between them has the mean by volume. */
TEST(materials_do_not_take_each_others_stress)
{
    static const double modulus[2] = {1e7, 1e9}, thickness[2] = {0.5, 0.02}, F[4] = {1.02, 0.03, 0.0, 0.99};
    double sample[2][3];
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    for (int side = 0; side < 2; side++) {
        dem_material material = rubber;
        material.youngs_modulus = modulus[side];
        material.thickness = thickness[side];
        CLEANUP(dem_lattice_free) dem_lattice plain = make_rectangle(0.02, 0.02, 2.5e-3);
        assert_ok(dem_lattice_assemble(&plain, &material));
        CLEANUP(free_model) dem_model *model = make_model(&plain);
        CLEANUP(free_memory) double *x = copy_positions(model);
        deform(x, plain.n_nodes, F);
        stress_at(model, 30, x, sample[side]);
    }
    make_two_materials(&lattice, modulus, thickness);
    CLEANUP(free_model) dem_model *model = make_model(&lattice);
    CLEANUP(free_memory) double *x = copy_positions(model);
    deform(x, lattice.n_nodes, F);
    for (dem_index i = 0; i < lattice.n_nodes; i++) {
        double stress[3], volume[2] = {0.0, 0.0};
        for (dem_index k = 0; k < 3 * lattice.n_triangles; k++)
            if (lattice.triangles[k] == i)
                volume[lattice.modulus[k / 3] == modulus[1]] +=
                    lattice.thickness[k / 3] * area_of(&lattice, k / 3) / 3.0;
        stress_at(model, i, x, stress);
        for (int c = 0; c < 3; c++) {
            const double mean = (volume[0] * sample[0][c] + volume[1] * sample[1][c]) / (volume[0] + volume[1]);
            assert_close(stress[c], mean, 1e-11 * (volume[1] > 0.0 ? 1e9 : 1e7) * 0.02);
        }
    }
}

/* A spring that hangs on a triangle: half of its r x f at the corner, over the corner's volume; its other end is in no
 * triangle and has no stress. Thickness and modulus are left out: 1. */
TEST(a_spring_outside_of_triangles_gives_half_to_each_end)
{
    static const double at[8] = {0.0, 0.0, 3.0, 0.0, 0.0, 2.0, 7.0, 0.0}, mass[4] = {1.0, 1.0, 1.0, 1.0};
    static const dem_index ends[8] = {0, 1, 1, 2, 2, 0, 1, 3};
    double stress[3];
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(4, at, mass, 4, ends, 1.0, 10.0, NULL);
    lattice.rest_length[0] = 3.0, lattice.rest_length[1] = sqrt(13.0), lattice.rest_length[2] = 2.0;
    lattice.rest_length[3] = 2.0; /* stretched to 4: a force of 10 N */
    lattice.triangles = malloc(3 * sizeof *lattice.triangles);
    assert_non_null(lattice.triangles);
    for (int c = 0; c < 3; c++) lattice.triangles[c] = c;
    lattice.n_triangles = 1;
    CLEANUP(free_model) dem_model *model = make_model(&lattice);
    assert_close(dem_model_volumes(model)[1], 1.0, 1e-15);
    stress_at(model, 1, model->lattice.x, stress);
    assert_close(stress[0], 0.5 * 10.0 * 4.0, 1e-13);
    assert_close(stress[1], 0.0, 1e-13);
    assert_close(stress[2], 0.0, 1e-13);
    stress_at(model, 3, model->lattice.x, stress);
    assert_close(dem_model_volumes(model)[3], 0.0, 0.0);
    for (int c = 0; c < 3; c++) assert_close(stress[c], 0.0, 0.0);
}

TEST(without_triangles_there_is_no_stress)
{
    static const double at[4] = {0.0, 0.0, 2.0, 0.0}, mass[2] = {1.0, 1.0};
    static const dem_index ends[2] = {0, 1};
    double stress[3];
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(2, at, mass, 1, ends, 1.0, 10.0, NULL);
    CLEANUP(free_model) dem_model *model = make_model(&lattice);
    stress_at(model, 0, model->lattice.x, stress);
    for (int c = 0; c < 3; c++) assert_close(stress[c], 0.0, 0.0);
}

/* ---- what is made of a stress ---- */

TEST(von_mises_is_that_of_plane_stress)
{
    assert_close(dem_stress_von_mises((double[3]){-5.0, 0.0, 0.0}), 5.0, 1e-15); /* uniaxial */
    assert_close(dem_stress_von_mises((double[3]){7.0, 7.0, 0.0}), 7.0, 1e-15);  /* equal in both directions */
    assert_close(dem_stress_von_mises((double[3]){0.0, 0.0, 2.0}), 2.0 * sqrt(3.0), 1e-15); /* shear */
    assert_close(dem_stress_von_mises((double[3]){0.0, 0.0, 0.0}), 0.0, 0.0);
}

/* A tensor of given values and direction: rounding of a few operations. */
TEST(principal_values_come_back_with_their_direction)
{
    static const double pairs[4][2] = {{3.0, 1.0}, {2.0, -5.0}, {-1.0, -1.5}, {1e6, 1e6 - 1.0}};
    for (int k = 0; k < 4; k++)
        for (int degrees = -89; degrees <= 90; degrees++) {
            const double angle = M_PI / 180.0 * degrees, c = cos(angle), s = sin(angle), p = pairs[k][0],
                         q = pairs[k][1];
            const double stress[3] = {p * c * c + q * s * s, p * s * s + q * c * c, (p - q) * s * c};
            const double rounding = 1e-15 * fmax(fabs(p), fabs(q));
            double value[2], direction[2];
            dem_stress_principal(stress, value, direction);
            assert_close(value[0], p, rounding);
            assert_close(value[1], q, rounding);
            if (degrees == 90) continue; /* up or down, as rounding has it */
            assert_close(direction[0], c, 2.0 * rounding / (p - q));
            assert_close(direction[1], s, 2.0 * rounding / (p - q));
        }
}

TEST(principal_directions_point_right_or_up)
{
    static const double cases[4][5] = {
        {2.0, 2.0, 0.0, 1.0, 0.0}, {0.0, 0.0, 0.0, 1.0, 0.0}, {-3.0, 1.0, 0.0, 0.0, 1.0}, {1.0, -3.0, 0.0, 1.0, 0.0}};
    double value[2], direction[2];
    for (int k = 0; k < 4; k++) {
        dem_stress_principal(cases[k], value, direction);
        assert_close(direction[0], cases[k][3], 0.0);
        assert_close(direction[1], cases[k][4], 0.0);
        assert_close(value[0], fmax(cases[k][0], cases[k][1]), 0.0);
        assert_close(value[1], fmin(cases[k][0], cases[k][1]), 0.0);
    }
}
