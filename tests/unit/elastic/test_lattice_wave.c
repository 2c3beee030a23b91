/* SPDX-License-Identifier: BSD-3-Clause */
/* lattice_rows.c and lattice_wave.c: which bodies have lattice rows, and how many steps their waves have. That steps
 * have the right bits is tested with single ones beside them (unit/forces/test_step_wave.c). */
#include "elastic/lattice_wave.h"
#include "model/model.h"
#include "unit/forces/scenes.h"

static lattice_rows_input input_of(const dem_model *m)
{
    return (lattice_rows_input){&m->springs, &m->triangles, m->lattice.x, m->inverse_mass, NULL};
}

/* The lattice rows of a lattice, which is freed; 0: it has none. */
static dem_index count_rows(dem_lattice lattice)
{
    CLEANUP(dem_lattice_free) dem_lattice own = lattice;
    CLEANUP(free_scene) scene s = make_scene(&own, 0.0);
    const lattice_rows_input from = input_of(s.model);
    lattice_rows rows;
    assert_ok(lattice_rows_create(&rows, &from));
    const dem_index n = rows.n_rows;
    lattice_rows_destroy(&rows);
    return n;
}

static dem_lattice make_squares(void)
{
    dem_lattice lattice = dem_lattice_empty();
    const dem_material material = law_of(0);
    assert_ok(dem_lattice_squares(&lattice, 0.2, 0.1, 1e-2));
    assert_ok(dem_lattice_assemble_squares(&lattice, &material, 0.5));
    return lattice;
}

/* The first lattice row is one node long if its other nodes are left out. */
static dem_lattice make_pointed(void)
{
    const dem_material material = law_of(0);
    dem_lattice lattice = make_solid(0.25, 0.25, &material);
    CLEANUP(free_memory) bool *keep = malloc((size_t)lattice.n_nodes * sizeof *keep);
    assert_non_null(keep);
    for (dem_index i = 0; i < lattice.n_nodes; i++)
        keep[i] = lattice.x[2 * i + 1] > lattice.x[1] + 1e-3 || fabs(lattice.x[2 * i] - lattice.x[4]) < 1e-3;
    assert_ok(dem_lattice_select(&lattice, keep));
    return lattice;
}

/* A row for each of nodes, one before each body, and one behind all. */
TEST(bodies_of_equilateral_triangles_have_lattice_rows)
{
    const dem_material material = law_of(0);
    assert_int_equal(count_rows(make_solid(0.1, 0.0868, &material)), 11 + 2); /* ten heights of triangles of 10 mm */
    assert_int_equal(count_rows(make_pointed()), count_rows(make_solid(0.25, 0.25, &material)));
    assert_true(count_rows(make_bodies()) > 3);
    for (int k = 0; k < 24; k++) {
        dem_lattice turned = make_pointed();
        dem_lattice_move(&turned, 0.26 * k, (const double[2]){0.0, 0.0});
        assert_true(count_rows(turned) > 0);
    }
}

TEST(other_bodies_have_none)
{
    const dem_material material = law_of(0);
    assert_int_equal(count_rows(make_squares()), 0);
    assert_int_equal(count_rows(make_shuffled(&material)), 0);
    assert_int_equal(count_rows(make_solid(0.01, 2.0, &material)), 0); /* nearly all places are empty */
}

static dem_lattice make_jittered(double width)
{
    const dem_material material = law_of(0);
    dem_lattice lattice = dem_lattice_empty();
    assert_ok(dem_lattice_rectangle(&lattice, width, width, 1e-2));
    assert_ok(dem_lattice_jitter(&lattice, 1e-3, 1));
    assert_ok(dem_lattice_assemble(&lattice, &material));
    return lattice;
}

/* Each block has springs, masses and areas of its own, 72 bytes a node: 16 bytes, and a megabyte, are allowed. */
TEST(where_all_springs_differ_large_bodies_have_none)
{
    assert_true(count_rows(make_jittered(1.2)) > 0);     /* 17,000 nodes */
    assert_int_equal(count_rows(make_jittered(1.4)), 0); /* 23,000 */
}

/* A triangle that is none of two lattice rows is found by their number. */
TEST(a_body_with_a_triangle_elsewhere_has_none)
{
    const dem_material material = law_of(0);
    for (int moved = 0; moved < 2; moved++) {
        dem_lattice lattice = make_solid(0.25, 0.25, &material);
        const dem_index *last = &lattice.triangles[3 * (lattice.n_triangles - 1)];
        if (moved == 1) memcpy(lattice.triangles, (const dem_index[]){0, 2, last[2]}, 3 * sizeof *last);
        assert_int_equal(count_rows(lattice) > 0, moved == 0);
    }
}

static int most_steps(double width)
{
    const dem_material material = law_of(0);
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(width, 0.05, &material);
    CLEANUP(free_scene) scene s = make_scene(&lattice, 0.0);
    const lattice_rows_input from = input_of(s.model);
    lattice_wave *w;
    assert_ok(lattice_wave_create(&w, &from, lattice_step_portable, NULL));
    assert_non_null(w);
    const int most = lattice_wave_most(w);
    lattice_wave_free(w);
    return most;
}

TEST(waves_of_longer_lattice_rows_have_fewer_steps)
{
    assert_int_equal(most_steps(1.0), LATTICE_WAVE_MOST);
    assert_in_range(most_steps(20.0), 5, LATTICE_WAVE_MOST - 1);
    assert_int_equal(most_steps(100.0), 4);
    lattice_wave_free(NULL);
}
