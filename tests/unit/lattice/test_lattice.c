/* SPDX-License-Identifier: BSD-3-Clause */
/* lattice.c: parts and pieces, selecting, trimming, moving, joining. */
#include "unit/solids.h"
#include "harness/message.h"

#include <stdlib.h>
#include <string.h>

#define assert_refused(call, status, message)                                                                          \
    do {                                                                                                               \
        assert_int_equal(call, status);                                                                                \
        assert_message_parts(message);                                                                                 \
    } while (0)

/* 0.5, 1.5, ... N s */
static void give_viscosity(dem_lattice *lattice)
{
    lattice->viscosity = calloc((size_t)lattice->n_springs, sizeof *lattice->viscosity);
    assert_non_null(lattice->viscosity);
    for (dem_index k = 0; k < lattice->n_springs; k++) lattice->viscosity[k] = 0.5 + (double)k;
}

/* Area stiffnesses 0, -1, -2, ... and couplings 0, 1, 2, ... N/m */
static void give_triangles(dem_lattice *lattice)
{
    lattice->coupling = calloc(3 * (size_t)lattice->n_triangles, sizeof *lattice->coupling);
    assert_non_null(lattice->coupling);
    for (dem_index t = 0; t < 3 * lattice->n_triangles; t++) lattice->coupling[t] = (double)t;
    lattice->area_stiffness = calloc((size_t)lattice->n_triangles, sizeof *lattice->area_stiffness);
    assert_non_null(lattice->area_stiffness);
    for (dem_index t = 0; t < lattice->n_triangles; t++) lattice->area_stiffness[t] = -(double)t;
}

/* ---- parts, select ---- */

TEST(parts_are_numbered_by_their_lowest_nodes)
{
    const dem_index expected[7] = {0, 1, 0, 2, 1, 1, 3};
    double x[14] = {0}, ones[3] = {1, 1, 1};
    dem_index ends[6] = {2, 0, 5, 4, 4, 1}, part[7], n_parts;
    dem_lattice lattice = dem_lattice_empty();
    lattice.n_nodes = 7, lattice.n_springs = 3;
    lattice.x = x, lattice.ends = ends, lattice.rest_length = ones, lattice.stiffness = ones;
    assert_int_equal(dem_lattice_parts(&lattice, &n_parts, part), DEM_OK);
    assert_int_equal(n_parts, 4);
    assert_memory_equal(part, expected, sizeof part);
    assert_int_equal(dem_lattice_parts(&lattice, &n_parts, NULL), DEM_OK);
    assert_refused(dem_lattice_parts(&lattice, NULL, part), DEM_ERROR_ARGUMENT, "n_parts is NULL");
    ends[3] = 7;
    assert_refused(dem_lattice_parts(&lattice, &n_parts, part), DEM_ERROR_MODEL, "spring 1 * node 7 * 7 nodes");
}

TEST(select_keeps_every_array_in_step)
{
    const double v[2] = {3.0, -2.0}, offset[2] = {0.0, 0.0};
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(1.0, 1.6, 1.0);
    const double top_mass = lattice.mass[4], stiffness = lattice.stiffness[5];
    bool keep[5] = {0, 0, 1, 1, 1};
    assert_int_equal(dem_lattice_launch(&lattice, v), DEM_OK);
    lattice.velocity[8] = 7.0;
    lattice.guard[1] = 5.0;
    give_triangles(&lattice);
    lattice.thickness[1] = 6.0;
    lattice.modulus[1] = 7.0;
    give_viscosity(&lattice);
    lattice.body = calloc(5, sizeof *lattice.body);
    lattice.flags = calloc(5, sizeof *lattice.flags);
    lattice.position = calloc(10, sizeof *lattice.position);
    assert_true(lattice.body != NULL && lattice.flags != NULL && lattice.position != NULL);
    lattice.body[4] = 6, lattice.flags[4] = DEM_NODE_FIXED, lattice.position[9] = 8.0;
    assert_int_equal(dem_lattice_select(&lattice, keep), DEM_OK);
    assert_int_equal(lattice.n_nodes, 3);
    assert_int_equal(lattice.n_springs, 3);
    assert_int_equal(lattice.n_triangles, 1);
    assert_int_equal(lattice.ends[4], 1);
    assert_int_equal(lattice.ends[5], 2);
    assert_close(lattice.stiffness[2], stiffness, 0.0);
    assert_close(lattice.viscosity[2], 5.5, 0.0);
    assert_close(lattice.mass[2], top_mass, 0.0);
    assert_close(lattice.velocity[4], 7.0, 0.0);
    assert_close(lattice.position[5], 8.0, 0.0);
    assert_close(lattice.guard[0], 5.0, 0.0);
    assert_close(lattice.area_stiffness[0], -1.0, 0.0);
    for (int c = 0; c < 3; c++) assert_close(lattice.coupling[c], 3.0 + c, 0.0);
    assert_close(lattice.thickness[0], 6.0, 0.0);
    assert_close(lattice.modulus[0], 7.0, 0.0);
    assert_int_equal(lattice.body[2], 6);
    assert_int_equal(lattice.flags[2], DEM_NODE_FIXED);
    dem_lattice_move(&lattice, 0.0, offset);
    assert_close(area_of(&lattice, 0), sqrt(3.0) / 4.0, 1e-15);
    memset(keep, 0, sizeof keep);
    assert_refused(dem_lattice_select(&lattice, keep), DEM_ERROR_MODEL, "none of 3 nodes is left");
    assert_refused(dem_lattice_select(&lattice, NULL), DEM_ERROR_ARGUMENT, "keep is NULL");
    assert_int_equal(lattice.n_nodes, 3);
}

/* Two columns and two strips of spacing 1: two triangles that meet in node 2 alone, an hourglass. */
TEST(pieces_share_edges_and_a_hinge_has_more_than_two_rims)
{
    const dem_index expected[2] = {0, 1}, rims[5] = {2, 2, 4, 2, 2};
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_rectangle(1.0, 1.6, 1.0);
    dem_index n, piece[2], n_edges[5];
    assert_int_equal(dem_lattice_pieces(&lattice, &n, piece), DEM_OK);
    assert_int_equal(n, 2);
    assert_memory_equal(piece, expected, sizeof piece);
    assert_int_equal(dem_lattice_rims(&lattice, n_edges), DEM_OK);
    assert_memory_equal(n_edges, rims, sizeof rims);
    assert_refused(dem_lattice_pieces(&lattice, NULL, piece), DEM_ERROR_ARGUMENT, "n_pieces is NULL");
    assert_refused(dem_lattice_rims(&lattice, NULL), DEM_ERROR_ARGUMENT, "n_edges is NULL");
    lattice.triangles[0] = 5;
    assert_refused(dem_lattice_pieces(&lattice, &n, NULL), DEM_ERROR_MODEL, "triangle 0 * node 5 * 5 nodes");
}

TEST(a_hexagon_is_one_piece_without_a_rim_at_its_centre)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    dem_index n, n_edges[7];
    assert_int_equal(dem_lattice_disc(&lattice, 1.0, 1.0), DEM_OK);
    assert_int_equal(dem_lattice_pieces(&lattice, &n, NULL), DEM_OK);
    assert_int_equal(n, 1);
    assert_int_equal(dem_lattice_rims(&lattice, n_edges), DEM_OK);
    for (dem_index i = 0; i < 7; i++)
        assert_int_equal(n_edges[i], hypot(lattice.x[2 * i], lattice.x[2 * i + 1]) < 0.5 ? 0 : 2);
}

TEST(trimming_keeps_triangles_with_their_nodes)
{
    const bool upper[2] = {0, 3}, none[2] = {0, 0};
    const dem_index expected[3] = {0, 2, 1};
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_rectangle(1.0, 1.6, 1.0);
    lattice.guard = calloc(2, sizeof *lattice.guard);
    assert_non_null(lattice.guard);
    lattice.guard[1] = 5.0;
    const double corner = lattice.x[8];
    assert_refused(dem_lattice_trim(&lattice, NULL), DEM_ERROR_ARGUMENT, "keep is NULL");
    assert_refused(dem_lattice_trim(&lattice, none), DEM_ERROR_MODEL, "none of 5 nodes is left");
    assert_int_equal(lattice.n_triangles, 2);
    assert_int_equal(dem_lattice_trim(&lattice, upper), DEM_OK);
    assert_int_equal(lattice.n_nodes, 3);
    assert_int_equal(lattice.n_triangles, 1);
    assert_memory_equal(lattice.triangles, expected, sizeof expected);
    assert_close(lattice.x[4], corner, 0.0);
    assert_close(lattice.guard[0], 5.0, 0.0);
    assert_int_equal(dem_lattice_assemble(&lattice, &rubber), DEM_OK);
    assert_refused(dem_lattice_trim(&lattice, upper), DEM_ERROR_MODEL, "trimmed: 3 springs");
}

/* Nodes can lose triangles and all stay: here two of six, opposite to each other. */
TEST(a_node_stays_with_what_is_left_of_its_triangles)
{
    const bool keep[6] = {0, 1, 1, 1, 1, 0};
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    assert_int_equal(dem_lattice_disc(&lattice, 1.0, 1.0), DEM_OK);
    assert_int_equal(dem_lattice_trim(&lattice, keep), DEM_OK);
    assert_int_equal(lattice.n_triangles, 4);
    assert_int_equal(lattice.n_nodes, 7);
    for (dem_index t = 0; t < 4; t++) assert_close(area_of(&lattice, t), sqrt(3.0) / 4.0, 1e-15);
}

/* ---- move, launch, append ---- */

/* Masses 1 and 3 kg at 0 and 4 m turn about 3 m: at 2 rad/s the first goes down with 6 m/s, the second up with 2. */
TEST(spin_turns_about_the_centre_of_mass)
{
    double x[4] = {7.0, 0.0, 7.0, 0.0}, position[4] = {0.0, 5.0, 4.0, 5.0}, mass[2] = {1.0, 3.0};
    const double v[2] = {0.5, 0.25};
    dem_lattice lattice = dem_lattice_empty();
    lattice.n_nodes = 2, lattice.x = x, lattice.position = position;
    assert_refused(dem_lattice_spin(&lattice, 2.0), DEM_ERROR_MODEL,
                   "a lattice without masses has no centre of mass to turn about");
    lattice.mass = mass;
    assert_refused(dem_lattice_spin(&lattice, (double)INFINITY), DEM_ERROR_ARGUMENT,
                   "angular velocity inf rad/s * not finite");
    assert_int_equal(dem_lattice_launch(&lattice, v), DEM_OK);
    assert_int_equal(dem_lattice_spin(&lattice, 2.0), DEM_OK);
    assert_close(lattice.velocity[0], 0.5, 1e-15);
    assert_close(lattice.velocity[1], 0.25 - 6.0, 1e-15);
    assert_close(lattice.velocity[2], 0.5, 1e-15);
    assert_close(lattice.velocity[3], 0.25 + 2.0, 1e-15);
    free(lattice.velocity);
}

/* v + omega x r: at 2 rad/s what is 3 m right and 1 m above the centre moves with (-2, 6) m/s. No mass is needed. */
TEST(spin_turns_about_a_place)
{
    double x[4] = {4.0, 6.0, 1.0, 5.0};
    const double v[2] = {0.5, 0.25}, centre[2] = {1.0, 5.0}, nowhere[2] = {1.0, (double)NAN};
    dem_lattice lattice = dem_lattice_empty();
    lattice.n_nodes = 2, lattice.x = x;
    assert_int_equal(dem_lattice_launch(&lattice, v), DEM_OK);
    assert_int_equal(dem_lattice_spin_about(&lattice, 2.0, centre), DEM_OK);
    assert_refused(dem_lattice_spin_about(&lattice, 2.0, nowhere), DEM_ERROR_ARGUMENT, "centre * two finite numbers");
    assert_refused(dem_lattice_spin_about(&lattice, 2.0, NULL), DEM_ERROR_ARGUMENT, "centre * two finite numbers");
    assert_refused(dem_lattice_spin_about(&lattice, (double)INFINITY, centre), DEM_ERROR_ARGUMENT,
                   "angular velocity inf rad/s * not finite");
    assert_close(lattice.velocity[0], 0.5 - 2.0, 0.0);
    assert_close(lattice.velocity[1], 0.25 + 6.0, 0.0);
    assert_close(lattice.velocity[2], 0.5, 0.0);
    assert_close(lattice.velocity[3], 0.25, 0.0);
    free(lattice.velocity);
}

TEST(move_turns_about_the_origin_then_shifts)
{
    const double quarter = 1.5707963267948966, offset[2] = {10.0, 20.0}, v[2] = {1.0, 2.0};
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_rectangle(2.0, 2.0, 1.0);
    const double x0 = lattice.x[0], y0 = lattice.x[1];
    assert_int_equal(dem_lattice_launch(&lattice, v), DEM_OK);
    assert_int_equal(dem_lattice_launch(&lattice, v), DEM_OK);
    lattice.position = calloc((size_t)lattice.n_nodes, 2 * sizeof(double));
    assert_non_null(lattice.position);
    lattice.position[0] = 5.0;
    dem_lattice_move(&lattice, quarter, offset);
    assert_close(lattice.x[0], 10.0 - y0, 1e-15);
    assert_close(lattice.x[1], 20.0 + x0, 1e-14);
    assert_close(lattice.position[0], 10.0, 1e-14);
    assert_close(lattice.position[1], 25.0, 1e-14);
    assert_close(lattice.velocity[0], -4.0, 1e-15);
    assert_close(lattice.velocity[1], 2.0, 1e-15);
}

TEST(launch_refuses_what_is_no_velocity)
{
    const double bad[2] = {0.0, (double)NAN};
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_rectangle(1.0, 1.0, 1.0);
    assert_refused(dem_lattice_launch(&lattice, bad), DEM_ERROR_ARGUMENT, "the velocity must be two finite numbers");
    assert_refused(dem_lattice_launch(&lattice, NULL), DEM_ERROR_ARGUMENT, "the velocity must be two finite numbers");
    assert_null(lattice.velocity);
}

TEST(append_numbers_nodes_and_bodies_behind_the_others)
{
    const double v[2] = {0.0, -1.0};
    CLEANUP(dem_lattice_free) dem_lattice all, part = make_solid(1.0, 1.6, 1.0);
    all = dem_lattice_empty();
    assert_int_equal(dem_lattice_append(&all, &part), DEM_OK);
    assert_null(all.body);
    assert_null(all.flags);
    assert_int_equal(dem_lattice_launch(&part, v), DEM_OK);
    free(part.guard);
    part.guard = NULL;
    give_triangles(&part);
    assert_int_equal(dem_lattice_append(&all, &part), DEM_OK);
    assert_int_equal(dem_lattice_append(&all, &all), DEM_OK);
    assert_int_equal(all.n_nodes, 20);
    assert_int_equal(all.n_springs, 24);
    assert_int_equal(all.n_triangles, 8);
    for (dem_index i = 0; i < 20; i++) {
        assert_int_equal(all.body[i], i / 5);
        assert_close(all.x[2 * i], part.x[2 * (i % 5)], 0.0);
        assert_close(all.mass[i], part.mass[i % 5], 0.0);
        assert_close(all.velocity[2 * i + 1], i / 5 % 2 == 0 ? 0.0 : -1.0, 0.0);
    }
    for (dem_index k = 0; k < 48; k++) assert_int_equal(all.ends[k], part.ends[k % 12] + k / 12 * 5);
    for (dem_index k = 0; k < 24; k++) assert_int_equal(all.triangles[k], part.triangles[k % 6] + k / 6 * 5);
    for (dem_index t = 0; t < 8; t++) assert_close(all.guard[t], t / 2 % 2 == 0 ? 1e5 : 0.0, 1e-9);
    for (dem_index t = 0; t < 8; t++) assert_close(all.area_stiffness[t], t % 4 == 3 ? -1.0 : 0.0, 0.0);
    for (dem_index t = 0; t < 24; t++) assert_close(all.coupling[t], t / 6 % 2 == 1 ? (double)(t % 6) : 0.0, 0.0);
    assert_null(all.position);
    assert_null(all.flags);
}

TEST(append_keeps_who_may_touch_and_where_the_motion_starts)
{
    const double offset[2] = {4.0, 0.0};
    CLEANUP(dem_lattice_free) dem_lattice block = make_solid(2.0, 2.0, 1.0), point;
    point = dem_lattice_empty();
    point.n_nodes = 1;
    point.x = calloc(2, sizeof(double));
    point.position = calloc(2, sizeof(double));
    point.mass = calloc(1, sizeof(double));
    assert_true(point.x != NULL && point.position != NULL && point.mass != NULL);
    dem_lattice_move(&point, 0.0, offset);
    assert_int_equal(block.n_nodes, 8); /* rows of 3, 2, 3; every node on the boundary */
    assert_int_equal(dem_lattice_append(&block, &point), DEM_OK);
    assert_int_equal(block.flags[8], DEM_NODE_CONTACT);
    assert_int_equal(block.flags[0], DEM_NODE_CONTACT);
    assert_close(block.position[0], block.x[0], 0.0);
    assert_close(block.position[16], 4.0, 0.0);
    dem_lattice_free(&block);

    block = make_solid(3.0, 3.0, 1.0);
    assert_int_equal(block.n_nodes, 14); /* rows of 4, 3, 4, 3 */
    assert_int_equal(dem_lattice_append(&block, &point), DEM_OK);
    int n_contact = 0;
    for (dem_index i = 0; i < block.n_nodes; i++) n_contact += block.flags[i] == DEM_NODE_CONTACT;
    assert_int_equal(n_contact, 15 - 3); /* inside: one node of row 1, two of row 2 */
}

TEST(a_lattice_is_stiffened_as_a_whole)
{
    CLEANUP(dem_lattice_free) dem_lattice block = make_solid(2.0, 2.0, 1.0);
    assert_int_equal(dem_lattice_stiffen(&block, DEM_GUIDE_Y), DEM_OK);
    for (dem_index i = 0; i < block.n_nodes; i++)
        assert_int_equal(block.flags[i], DEM_NODE_CONTACT | DEM_NODE_RIGID | DEM_NODE_GUIDE_Y);
    block.flags[1] |= DEM_NODE_FIXED;
    assert_int_equal(dem_lattice_stiffen(&block, DEM_GUIDE_NONE), DEM_OK);
    assert_int_equal(block.flags[0], DEM_NODE_CONTACT | DEM_NODE_RIGID);
    assert_int_equal(block.flags[1], DEM_NODE_CONTACT | DEM_NODE_RIGID | DEM_NODE_FIXED);
    assert_int_equal(dem_lattice_stiffen(&block, (dem_guide)3), DEM_ERROR_ARGUMENT);
    assert_message_parts("guide 3");
}

TEST(append_gives_undamped_springs_no_viscosity_beside_damped_ones)
{
    dem_lattice all, damped = make_solid(1.0, 1.6, 1.0), plain = make_solid(1.0, 1.0, 1.0);
    all = dem_lattice_empty();
    give_viscosity(&damped);
    assert_int_equal(dem_lattice_append(&all, &plain), DEM_OK);
    assert_null(all.viscosity);
    assert_int_equal(dem_lattice_append(&all, &damped), DEM_OK);
    assert_int_equal(dem_lattice_append(&all, &plain), DEM_OK);
    assert_int_equal(plain.n_springs, 3);
    assert_int_equal(all.n_springs, 3 + 6 + 3);
    for (dem_index k = 0; k < 12; k++) assert_close(all.viscosity[k], k >= 3 && k < 9 ? (double)k - 2.5 : 0.0, 0.0);
    dem_lattice_free(&all);
    assert_null(all.viscosity);
    dem_lattice_free(&damped);
    dem_lattice_free(&plain);
}

TEST(append_gives_thickness_and_modulus_1_beside_given_ones)
{
    dem_lattice all, given = make_solid(1.0, 1.6, 1.0), plain = make_rectangle(1.0, 1.0, 1.0);
    all = dem_lattice_empty();
    plain.mass = calloc(3, sizeof *plain.mass);
    assert_non_null(plain.mass);
    given.modulus[1] = 3.0;
    assert_int_equal(dem_lattice_append(&all, &plain), DEM_OK);
    assert_null(all.thickness);
    assert_null(all.modulus);
    assert_int_equal(dem_lattice_append(&all, &given), DEM_OK);
    assert_int_equal(dem_lattice_append(&all, &plain), DEM_OK);
    assert_int_equal(all.n_triangles, 1 + 2 + 1);
    for (dem_index t = 0; t < 4; t++) assert_close(all.thickness[t], t == 0 || t == 3 ? 1.0 : rubber.thickness, 0.0);
    const double modulus[4] = {1.0, rubber.youngs_modulus, 3.0, 1.0};
    assert_memory_equal(all.modulus, modulus, sizeof modulus);
    dem_lattice_free(&all);
    assert_null(all.thickness);
    assert_null(all.modulus);
    dem_lattice_free(&given);
    dem_lattice_free(&plain);
}

/* By their numbers, and never reached where they are missing. */
TEST(limits_stay_with_their_elements)
{
    dem_lattice given = make_solid(1.0, 1.6, 1.0), plain = make_solid(1.0, 1.0, 1.0);
    CLEANUP(dem_lattice_free) dem_lattice all = dem_lattice_empty();
    given.strength = calloc((size_t)given.n_triangles, sizeof *given.strength);
    given.critical_stretch = calloc((size_t)given.n_springs, sizeof *given.critical_stretch);
    given.softening = calloc((size_t)given.n_triangles, sizeof *given.softening);
    given.compressive_strength = calloc((size_t)given.n_triangles, sizeof *given.compressive_strength);
    given.confinement = calloc((size_t)given.n_triangles, sizeof *given.confinement);
    assert_true(given.strength != NULL && given.critical_stretch != NULL && given.softening != NULL);
    given.own_stress = calloc((size_t)given.n_triangles, sizeof *given.own_stress);
    assert_true(given.compressive_strength != NULL && given.confinement != NULL && given.own_stress != NULL);
    given.own_stress[1] = 1;
    for (dem_index t = 0; t < given.n_triangles; t++) given.compressive_strength[t] = 5e6 + (double)t;
    for (dem_index t = 0; t < given.n_triangles; t++) given.confinement[t] = 7.0 + (double)t;
    for (dem_index t = 0; t < given.n_triangles; t++) given.strength[t] = 1e6 + (double)t;
    for (dem_index t = 0; t < given.n_triangles; t++) given.softening[t] = 2.0 + (double)t;
    for (dem_index k = 0; k < given.n_springs; k++) given.critical_stretch[k] = 0.1 + (double)k;
    assert_int_equal(dem_lattice_append(&all, &plain), DEM_OK);
    assert_null(all.strength);
    assert_null(all.critical_stretch);
    assert_int_equal(dem_lattice_append(&all, &given), DEM_OK);
    assert_int_equal(dem_lattice_append(&all, &plain), DEM_OK);
    const double strength[4] = {INFINITY, 1e6, 1e6 + 1.0, INFINITY};
    assert_memory_equal(all.strength, strength, sizeof strength);
    const double softening[4] = {1.0, 2.0, 3.0, 1.0};
    assert_memory_equal(all.softening, softening, sizeof softening);
    const double compressive[4] = {INFINITY, 5e6, 5e6 + 1.0, INFINITY}, confinement[4] = {0.0, 7.0, 8.0, 0.0};
    assert_memory_equal(all.compressive_strength, compressive, sizeof compressive);
    assert_memory_equal(all.confinement, confinement, sizeof confinement);
    assert_memory_equal(all.own_stress, "\0\0\1\0", 4);
    for (dem_index k = 0; k < 12; k++)
        assert_true(all.critical_stretch[k] == (k >= 3 && k < 9 ? 0.1 + (double)(k - 3) : (double)INFINITY));
    bool keep[32];
    for (dem_index i = 0; i < all.n_nodes; i++) keep[i] = i >= 3; /* without the first body */
    assert_int_equal(dem_lattice_select(&all, keep), DEM_OK);
    assert_memory_equal(all.strength, strength + 1, 3 * sizeof *strength);
    assert_memory_equal(all.softening, softening + 1, 3 * sizeof *softening);
    assert_memory_equal(all.compressive_strength, compressive + 1, 3 * sizeof *compressive);
    assert_memory_equal(all.confinement, confinement + 1, 3 * sizeof *confinement);
    assert_memory_equal(all.own_stress, "\0\1\0", 3);
    assert_true(all.critical_stretch[0] == 0.1 && all.critical_stretch[5] == 5.1);
    dem_lattice_free(&given);
    dem_lattice_free(&plain);
}

TEST(append_refuses_mixed_and_broken_lattices)
{
    dem_lattice solid = make_solid(1.0, 1.0, 1.0), bare = make_rectangle(1.0, 1.0, 1.0), broken;
    assert_refused(dem_lattice_append(&solid, &bare), DEM_ERROR_MODEL, "one lattice has masses, the other has none");
    assert_refused(dem_lattice_append(NULL, &bare), DEM_ERROR_ARGUMENT, "lattice is NULL");
    broken = dem_lattice_empty();
    broken.n_nodes = 3;
    assert_refused(dem_lattice_append(&solid, &broken), DEM_ERROR_ARGUMENT, "3 nodes * x is NULL");
    broken.n_nodes = -1;
    assert_refused(dem_lattice_append(&solid, &broken), DEM_ERROR_ARGUMENT, "the number of nodes is negative: -1");
    broken.n_nodes = 0, broken.n_springs = 2;
    assert_refused(dem_lattice_append(&solid, &broken), DEM_ERROR_ARGUMENT, "2 springs * NULL");
    broken.n_springs = -2;
    assert_refused(dem_lattice_append(&solid, &broken), DEM_ERROR_ARGUMENT, "the number of springs is negative: -2");
    assert_int_equal(solid.n_nodes, 3);
    dem_lattice_free(&solid);
    dem_lattice_free(&bare);
    dem_lattice_free(NULL);
}

/* A program of an older version has no place for limits, and a lattice with limits is not joined without them. */
TEST(append_loses_no_limits)
{
    const dem_material brittle = {
        .struct_size = sizeof(dem_material), .youngs_modulus = 1e7, .density = 1e3, .thickness = 1.0, .strength = 2e5};
    CLEANUP(dem_lattice_free) dem_lattice old = dem_lattice_empty(), other = dem_lattice_empty();
    old.struct_size = offsetof(dem_lattice, strength);
    assert_int_equal(dem_lattice_rectangle(&other, 1.0, 1.6, 1.0), DEM_OK);
    assert_int_equal(dem_lattice_assemble(&other, &brittle), DEM_OK);
    assert_int_equal(dem_lattice_append(&old, &other), DEM_ERROR_ARGUMENT);
    assert_int_equal(old.n_nodes, 0);
}
