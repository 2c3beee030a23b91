/* SPDX-License-Identifier: BSD-3-Clause */
/* slab_file.c: what slabs have of small files, files in many pieces, and files that must be refused;
 * tests/property/test_slabs.c compares slabs of files with the whole. */
#include "verification/support.h"

#include <dem/shape.h>
#include <dem/trajectory.h>

#define WRITTEN_PATH "test_slab_file.h5"
#include "unit/output/written.h"

#include "harness/message.h"
#include "output/lattice_datasets.h"
#include "output/lattice_file.h"
#include "output/slab_file.h"

#include <stdlib.h>
#include <string.h>

enum { F = DEM_NODE_FIXED, C = DEM_NODE_CONTACT, R = DEM_NODE_RIGID, GX = DEM_NODE_GUIDE_X };

/* ---- a square of two triangles, with a tail ---- */

/* The springs of write_lattice() in the order of their lowest nodes. */
static const int64_t ordered[12] = {0, 1, 3, 0, 0, 2, 1, 2, 2, 3, 3, 4};

static int write_ordered(void **state)
{
    (void)write_lattice(state);
    put_whole("ends", 6, 2, ordered);
    put_real("stiffness", 6, 0, (double[6]){10, 11, 12, 13, 14, 15});
    put_real("mass", 5, 0, (double[5]){1, 2, 3, 4, 5});
    put_whole("triangles", 2, 3, corners);
    put_real("coupling", 2, 3, (double[6]){1, 2, 3, 4, 5, 6});
    return 0;
}

static dem_slab read_slab(dem_index part, dem_index n_parts)
{
    dem_slab s = dem_slab_empty();
    assert_ok(dem_slab_read(&s, path, part, n_parts));
    return s;
}

/* Refused by every reader of slabs, with nothing changed. */
static void assert_refused(dem_index part, dem_index n_parts, dem_status status, const char *message)
{
    dem_slab s = dem_slab_empty();
    s.n_own = -7;
    assert_int_equal(dem_slab_read(&s, path, part, n_parts), status);
    assert_message_parts(message);
    assert_int_equal(s.n_own, -7);
    assert_null(s.lattice.x);
}

TEST_WITH(the_second_half_has_what_is_at_its_nodes, write_ordered, remove_lattice)
{
    CLEANUP(dem_slab_free) dem_slab s = read_slab(1, 2);
    const dem_lattice *l = &s.lattice;
    assert_int_equal(s.n_nodes, 5);
    assert_int_equal(s.n_triangles, 2);
    assert_int_equal(s.first_node, 3);
    assert_int_equal(s.n_own, 2);
    assert_int_equal(s.first_own, 2);
    assert_int_equal(s.first_triangle, 1);
    assert_memory_equal(s.rim, ((dem_index[2]){0, 2}), 2 * sizeof *s.rim);
    assert_null(s.rim_boundary);
    assert_int_equal(l->n_nodes, 4);
    assert_int_equal(l->n_springs, 3);
    assert_int_equal(l->n_triangles, 1);
    assert_memory_equal(l->x, ((double[8]){0, 0, 1, 1, 0, 1, 0.5, 2}), 8 * sizeof *l->x);
    assert_memory_equal(l->mass, ((double[4]){1, 3, 4, 5}), 4 * sizeof *l->mass);
    assert_memory_equal(l->ends, ((dem_index[6]){2, 0, 1, 2, 2, 3}), 6 * sizeof *l->ends);
    assert_memory_equal(l->stiffness, ((double[3]){11, 14, 15}), 3 * sizeof *l->stiffness);
    assert_memory_equal(l->triangles, ((dem_index[3]){0, 1, 2}), 3 * sizeof *l->triangles);
    assert_memory_equal(l->coupling, ((double[3]){4, 5, 6}), 3 * sizeof *l->coupling);
    assert_null(l->flags);
    assert_null(l->velocity);
    assert_null(l->guard);
}

/* Node 0 is next to nodes 1, 2 and 3 of four parts. */
TEST_WITH(the_first_slab_has_its_rim_behind_it, write_ordered, remove_lattice)
{
    CLEANUP(dem_slab_free) dem_slab s = read_slab(0, 5);
    assert_int_equal(s.first_own, 0);
    assert_int_equal(s.n_own, 1);
    assert_memory_equal(s.rim, ((dem_index[3]){1, 2, 3}), 3 * sizeof *s.rim);
    assert_int_equal(s.first_triangle, 0);
    assert_int_equal(s.lattice.n_triangles, 2);
    assert_int_equal(s.lattice.n_springs, 3);
}

TEST_WITH(one_slab_is_the_whole, write_ordered, remove_lattice)
{
    CLEANUP(dem_slab_free) dem_slab s = read_slab(0, 1);
    assert_int_equal(s.n_own, 5);
    assert_int_equal(s.lattice.n_nodes, 5);
    assert_memory_equal(s.lattice.x, x, sizeof x);
    assert_memory_equal(s.lattice.ends, ordered, sizeof ordered);
    assert_memory_equal(s.lattice.triangles, corners, sizeof corners);
}

/* Triangles 0 and 2 are at node 4, triangle 1 is not. */
TEST_WITH(triangles_with_gaps_have_no_first_one, write_ordered, remove_lattice)
{
    drop("coupling");
    put_whole("triangles", 3, 3, (int64_t[9]){0, 1, 4, 0, 1, 2, 0, 3, 4});
    CLEANUP(dem_slab_free) dem_slab s = read_slab(4, 5);
    assert_int_equal(s.lattice.n_triangles, 2);
    assert_int_equal(s.first_triangle, -1);
    assert_memory_equal(s.rim, ((dem_index[3]){0, 1, 3}), 3 * sizeof *s.rim);
}

/* ---- flags ---- */

/* Those of the n own nodes. */
static void assert_flags(dem_index part, dem_index n_parts, const unsigned char *expected)
{
    CLEANUP(dem_slab_free) dem_slab s = read_slab(part, n_parts);
    assert_non_null(s.lattice.flags);
    assert_memory_equal(s.lattice.flags + s.first_own, expected, (size_t)s.n_own);
}

TEST_WITH(own_nodes_have_the_flags_of_the_whole, write_ordered, remove_lattice)
{
    put_whole("fixed", 5, 0, (int64_t[5]){0, 2, 0, 0, 1});
    assert_flags(0, 2, (unsigned char[3]){C, F | C, C});
    assert_flags(1, 2, (unsigned char[2]){C, F});
    put_whole("contact_nodes", 3, 0, (int64_t[3]){3, 1, 3});
    assert_flags(0, 2, (unsigned char[3]){0, F | C, 0});
    assert_flags(1, 2, (unsigned char[2]){C, F});
    put_whole("rigid", 5, 0, (int64_t[5]){1, 1, 0, 2, 1});
    assert_flags(0, 2, (unsigned char[3]){R, F | C | R, 0});
    assert_flags(1, 2, (unsigned char[2]){C | R | GX, F | R});
    put_whole("contact_nodes", 0, 0, NULL);
    assert_flags(1, 2, (unsigned char[2]){R | GX, F | R});
}

TEST_WITH(nodes_of_the_rim_have_their_own_flags_where_contacts_are_listed, write_ordered, remove_lattice)
{
    put_whole("fixed", 5, 0, (int64_t[5]){1, 0, 0, 0, 0});
    put_whole("contact_nodes", 2, 0, (int64_t[2]){2, 4});
    CLEANUP(dem_slab_free) dem_slab s = read_slab(1, 2);
    assert_memory_equal(s.lattice.flags, ((unsigned char[4]){F, C, 0, C}), 4);
}

/* Without triangles all nodes would be on the boundary. */
TEST_WITH(a_slab_without_triangles_is_not_the_boundary_of_those_of_others, write_ordered, remove_lattice)
{
    assert_flags(4, 5, (unsigned char[1]){0});
    put_whole("fixed", 5, 0, (int64_t[5]){0, 0, 0, 0, 1});
    assert_flags(4, 5, (unsigned char[1]){F});
    drop("coupling");
    drop("triangles");
    assert_flags(4, 5, (unsigned char[1]){F | C});
    drop("fixed");
    CLEANUP(dem_slab_free) dem_slab s = read_slab(4, 5);
    assert_null(s.lattice.flags);
}

/* ---- many pieces ---- */

enum { CHAIN = 200000 }; /* nodes, of which each has a spring to the next one */

static void write_chain(const hid_t layout[2], int64_t (*ends_of)[2], const int64_t *touching)
{
    double *zeros = calloc(2 * CHAIN, sizeof *zeros), *many = malloc(CHAIN * sizeof *many);
    for (int k = 0; k < CHAIN; k++) many[k] = k + 1.0;
    put_as("x", layout[1], H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, CHAIN, 2, zeros);
    put_as("mass", layout[0], H5T_IEEE_F32BE, H5T_NATIVE_DOUBLE, CHAIN, 0, many);
    put_as("ends", layout[1], H5T_STD_I32LE, H5T_NATIVE_INT64, CHAIN - 1, 2, ends_of);
    put_as("rest_length", layout[0], H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, CHAIN - 1, 0, many);
    put_as("stiffness", layout[0], H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, CHAIN - 1, 0, many);
    put_as("contact_nodes", layout[0], H5T_STD_I64LE, H5T_NATIVE_INT64, CHAIN, 0, touching);
    free(zeros);
    free(many);
}

/* Of the middle third. */
static void check_chain(void)
{
    const dem_index first = CHAIN / 3 + 1; /* 2 parts of 3 have one more */
    CLEANUP(dem_slab_free) dem_slab s = read_slab(1, 3);
    assert_int_equal(s.first_node, first);
    assert_int_equal(s.n_own, CHAIN / 3 + 1);
    assert_int_equal(s.first_own, 1);
    assert_int_equal(s.rim[0], first - 1);
    assert_int_equal(s.rim[1], first + s.n_own);
    assert_int_equal(s.lattice.n_springs, s.n_own + 1);
    for (dem_index i = 0; i < s.lattice.n_nodes; i++) {
        assert_close(s.lattice.mass[i], (double)(first + i), 0.0);
        assert_int_equal(s.lattice.flags[i], C);
    }
    for (dem_index k = 0; k < s.lattice.n_springs; k++) {
        assert_int_equal(s.lattice.ends[2 * k], k);
        assert_int_equal(s.lattice.ends[2 * k + 1], k + 1);
        assert_close(s.lattice.stiffness[k], (double)(first + k), 0.0);
    }
}

/* Chunks of `rows`, 0: none. */
static void make_layouts(hid_t layout[2], hsize_t rows, bool deflate)
{
    for (int k = 0; k < 2; k++) {
        layout[k] = H5Pcreate(H5P_DATASET_CREATE);
        if (rows > 0) assert_true(H5Pset_chunk(layout[k], k + 1, (hsize_t[2]){rows, 2}) >= 0);
        if (deflate) assert_true(H5Pset_shuffle(layout[k]) >= 0 && H5Pset_deflate(layout[k], 1) >= 0);
    }
}

TEST_WITH(pieces_are_read_from_chunks_of_any_size, write_lattice, remove_lattice)
{
    static const hsize_t rows[] = {0, 100, 1000, 65536, 100000, CHAIN - 1, CHAIN - 1};
    static const bool deflates[] = {false, false, true, true, true, true, false};
    int64_t(*chain)[2] = malloc(CHAIN * sizeof *chain), *touching = malloc(CHAIN * sizeof *touching);
    for (int k = 0; k < CHAIN; k++) {
        chain[k][0] = k;
        chain[k][1] = k + 1;
        touching[k] = CHAIN - 1 - k;
    }
    for (size_t k = 0; k < sizeof rows / sizeof rows[0]; k++) {
        hid_t layout[2];
        make_layouts(layout, rows[k], deflates[k]);
        write_chain(layout, chain, touching);
        for (int d = 0; d < 2; d++) (void)H5Pclose(layout[d]);
        check_chain();
    }
    chain[150000][0] = 20;
    put_whole("ends", CHAIN - 1, 2, chain[0]);
    assert_refused(0, 3, DEM_ERROR_MODEL, "/lattice/ends * spring 150000 * 20 * 149999");
    chain[150000][0] = CHAIN;
    put_whole("ends", CHAIN - 1, 2, chain[0]);
    assert_refused(0, 3, DEM_ERROR_MODEL, "/lattice: spring 150000 has node 200000, but there are 200000 nodes");
    chain[150000][0] = 150000;
    touching[199000] = -1;
    put_whole("ends", CHAIN - 1, 2, chain[0]);
    put_whole("contact_nodes", CHAIN, 0, touching);
    assert_refused(0, 3, DEM_ERROR_MODEL, "/lattice/contact_nodes: entry 199000 is -1 * 200000");
    free(chain);
    free(touching);
}

/* ---- ranges of nodes ---- */

/* Node 4 has but a spring, and is in no triangle; the boundary has all others. */
TEST_WITH(a_range_knows_which_nodes_of_its_rim_are_on_the_boundary, write_ordered, remove_lattice)
{
    CLEANUP(free_memory) dem_index *node_ranges = NULL;
    CLEANUP(dem_slab_free) dem_slab s = dem_slab_empty();
    CLEANUP(dem_slab_free) dem_slab none = dem_slab_empty();
    assert_ok(dem_private_slab_of_file(&s, path, &node_ranges, 3, 4));
    assert_int_equal(s.first_node, 3);
    assert_int_equal(s.n_own, 1);
    assert_memory_equal(s.rim, ((dem_index[3]){0, 2, 4}), 3 * sizeof *s.rim);
    assert_memory_equal(s.rim_boundary, ((unsigned char[3]){1, 1, 0}), 3);
    assert_ok(dem_private_slab_of_file(&none, path, &node_ranges, 2, 2));
    assert_int_equal(none.n_nodes, 5);
    assert_int_equal(none.n_triangles, 2);
    assert_int_equal(none.n_own, 0);
    assert_int_equal(none.lattice.n_nodes, 0);
}

TEST_WITH(ranges_that_there_are_not_are_refused, write_lattice, remove_lattice)
{
    CLEANUP(free_memory) dem_index *node_ranges = NULL;
    dem_slab s = dem_slab_empty();
    assert_int_equal(dem_private_slab_of_file(&s, path, &node_ranges, 2, 6), DEM_ERROR_MODEL);
    assert_message_parts("test_slab_file.h5: has no nodes from 2 to 5: there are 5");
    assert_int_equal(dem_private_slab_of_file(&s, path, &node_ranges, -1, 2), DEM_ERROR_MODEL);
    assert_int_equal(dem_private_slab_of_file(&s, path, &node_ranges, 3, 2), DEM_ERROR_MODEL);
    assert_int_equal(dem_private_slab_of_file(&s, path, &node_ranges, 0, 2), DEM_ERROR_MODEL);
    assert_message_parts("/lattice/ends: spring 3 * lowest node 0 * before it 2");
    assert_null(node_ranges); /* what is not known of all pieces is not kept */
    put_whole("ends", 6, 2, ordered);
    assert_ok(dem_private_slab_of_file(&s, path, &node_ranges, 0, 2));
    assert_non_null(node_ranges);
    dem_slab_free(&s);
}

enum { ROWS = 280 }; /* of as many nodes each: springs and triangles are in several pieces of the file */

static void write_block(void)
{
    CLEANUP(dem_lattice_free) dem_lattice l = dem_lattice_empty();
    const dem_material any = {
        .struct_size = sizeof any, .youngs_modulus = 1e7, .poissons_ratio = 0.3, .density = 1e3, .thickness = 1.0};
    hdf5_file file;
    assert_ok(dem_lattice_squares(&l, ROWS - 1.0, ROWS - 1.0, 1.0));
    assert_ok(dem_lattice_assemble_squares(&l, &any, 0.5));
    assert_true(l.n_triangles > 2 * LATTICE_PIECE);
    assert_ok(hdf5_open_new(&file, path, 4096));
    assert_ok(hdf5_close(&file, lattice_file_write(&file, &(lattice_source){&l, NULL}, 1)));
}

static void assert_same_slab(const dem_slab *a, const dem_slab *b)
{
    const dem_lattice *l = &a->lattice, *m = &b->lattice;
    assert_int_equal(a->n_own, b->n_own);
    assert_int_equal(a->first_triangle, b->first_triangle);
    assert_int_equal(l->n_nodes, m->n_nodes);
    assert_int_equal(l->n_springs, m->n_springs);
    assert_int_equal(l->n_triangles, m->n_triangles);
    assert_memory_equal(a->rim, b->rim, (size_t)(l->n_nodes - a->n_own) * sizeof *a->rim);
    assert_memory_equal(l->ends, m->ends, 2 * (size_t)l->n_springs * sizeof *l->ends);
    assert_memory_equal(l->triangles, m->triangles, 3 * (size_t)l->n_triangles * sizeof *l->triangles);
    assert_memory_equal(l->mass, m->mass, (size_t)l->n_nodes * sizeof *l->mass);
    assert_memory_equal(l->stiffness, m->stiffness, (size_t)l->n_springs * sizeof *l->stiffness);
}

/* Of rows of ROWS nodes: the first and last ones of each, and the first and last row. */
static void assert_block_boundary(const dem_slab *s)
{
    for (dem_index k = 0; k < s->lattice.n_nodes - s->n_own; k++) {
        const dem_index row = s->rim[k] / ROWS, column = s->rim[k] % ROWS;
        const bool is_outer = row == 0 || row == ROWS - 1 || column == 0 || column == ROWS - 1;
        assert_int_equal(s->rim_boundary[k], is_outer);
    }
}

TEST_WITH(ranges_are_the_same_by_what_is_known_of_the_pieces, write_lattice, remove_lattice)
{
    CLEANUP(free_memory) dem_index *node_ranges = NULL;
    write_block();
    for (dem_index part = 0; part < 40; part += 3) {
        CLEANUP(dem_slab_free) dem_slab range = dem_slab_empty();
        CLEANUP(dem_slab_free) dem_slab read = read_slab(part, 40);
        assert_ok(dem_private_slab_of_file(&range, path, &node_ranges, read.first_node, read.first_node + read.n_own));
        assert_same_slab(&read, &range);
        assert_block_boundary(&range);
    }
}

/* Triangles at a rim may be in the piece behind all that own nodes have, which begins in row 117. */
TEST_WITH(ranges_that_end_with_a_piece_know_the_boundary, write_lattice, remove_lattice)
{
    CLEANUP(free_memory) dem_index *node_ranges = NULL;
    write_block();
    for (dem_index end = 115 * ROWS; end < 120 * ROWS; end += 60) {
        CLEANUP(dem_slab_free) dem_slab range = dem_slab_empty();
        assert_ok(dem_private_slab_of_file(&range, path, &node_ranges, end - 50, end));
        assert_block_boundary(&range);
    }
}

/* Which shows where something far away has become wrong. */
TEST_WITH(pieces_without_anything_of_a_range_are_not_looked_at_again, write_lattice, remove_lattice)
{
    CLEANUP(free_memory) dem_index *node_ranges = NULL;
    CLEANUP(dem_lattice_free) dem_lattice whole = dem_lattice_empty();
    CLEANUP(dem_slab_free) dem_slab before = dem_slab_empty();
    CLEANUP(dem_slab_free) dem_slab after = dem_slab_empty();
    dem_slab refused = dem_slab_empty();
    write_block();
    assert_ok(dem_lattice_read(&whole, path));
    assert_ok(dem_private_slab_of_file(&before, path, &node_ranges, 500, 1000));
    whole.ends[2 * whole.n_springs - 1] = -1;
    whole.triangles[3 * whole.n_triangles - 1] = -1;
    put_whole("ends", (hsize_t)whole.n_springs, 2, whole.ends);
    put_whole("triangles", (hsize_t)whole.n_triangles, 3, whole.triangles);
    assert_ok(dem_private_slab_of_file(&after, path, &node_ranges, 500, 1000));
    assert_same_slab(&before, &after);
    assert_int_equal(dem_private_slab_of_file(&refused, path, &node_ranges, whole.n_nodes - 9, whole.n_nodes),
                     DEM_ERROR_MODEL);
    assert_int_equal(dem_slab_read(&refused, path, 0, 160), DEM_ERROR_MODEL);
}

/* ---- refused ---- */

TEST_WITH(parts_that_there_are_not_are_refused, write_ordered, remove_lattice)
{
    dem_slab s = dem_slab_empty(), bare = {0};
    assert_refused(0, 6, DEM_ERROR_MODEL, "test_slab_file.h5: 5 nodes cannot be 6 slabs");
    assert_refused(5, 5, DEM_ERROR_ARGUMENT, "no part 5 of 5");
    assert_refused(-1, 5, DEM_ERROR_ARGUMENT, "no part -1 of 5");
    assert_refused(0, 0, DEM_ERROR_ARGUMENT, "no part 0 of 0");
    assert_int_equal(dem_slab_read(&s, NULL, 0, 1), DEM_ERROR_ARGUMENT);
    assert_message_parts("path is NULL");
    assert_int_equal(dem_slab_read(NULL, path, 0, 1), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_slab_read(&bare, path, 0, 1), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_slab_read(&s, "none.h5", 0, 1), DEM_ERROR_IO);
    assert_message_parts("none.h5: cannot be opened");
}

/* On all parts alike. */
TEST_WITH(springs_and_triangles_in_another_order_are_refused, write_lattice, remove_lattice)
{
    for (dem_index part = 0; part < 5; part++)
        assert_refused(part, 5, DEM_ERROR_MODEL,
                       "test_slab_file.h5: /lattice/ends: spring 3 * lowest node 0 * before it 2");
    put_whole("ends", 6, 2, ordered);
    put_whole("triangles", 2, 3, (int64_t[6]){3, 2, 1, 2, 0, 3});
    for (dem_index part = 0; part < 5; part++)
        assert_refused(part, 5, DEM_ERROR_MODEL, "/lattice/triangles: triangle 1 * lowest node 0 * before it 1");
}

/* What is wrong with others than the slab's own, too. */
TEST_WITH(node_numbers_of_all_are_checked, write_ordered, remove_lattice)
{
    put_whole("ends", 6, 2, (int64_t[12]){0, 1, 3, 0, 0, 2, 1, 2, 2, 3, 3, -4});
    assert_refused(0, 5, DEM_ERROR_MODEL, "test_slab_file.h5: /lattice: spring 5 has node -4, but there are 5 nodes");
    put_whole("ends", 6, 2, ordered);
    put_whole("triangles", 2, 3, (int64_t[6]){0, 1, 2, 0, 2, 5});
    assert_refused(4, 5, DEM_ERROR_MODEL, "/lattice: triangle 1 has node 5, but there are 5 nodes");
    put_whole("triangles", 2, 3, corners);
    put_whole("contact_nodes", 2, 0, (int64_t[2]){4, 5});
    assert_refused(0, 5, DEM_ERROR_MODEL, "/lattice/contact_nodes: entry 1 is 5, which is no node: there are 5");
}

TEST_WITH(numbers_of_own_and_rim_nodes_are_checked, write_ordered, remove_lattice)
{
    put_whole("rigid", 5, 0, (int64_t[5]){1, 0, 0, 0, 4});
    assert_refused(4, 5, DEM_ERROR_MODEL, "/lattice/rigid: entry 4 is 4, which is not in 0 to 3");
    assert_refused(3, 5, DEM_ERROR_MODEL, "/lattice/rigid: entry 4 is 4");
    drop("rigid");
    put_whole("body", 5, 0, (int64_t[5]){0, 0, 0, 0, 5000000000});
    assert_refused(4, 5, DEM_ERROR_IO, "/lattice/body: cannot be read");
    CLEANUP(dem_slab_free) dem_slab s = read_slab(0, 5); /* nodes 0 to 3 */
    assert_int_equal(s.lattice.body[3], 0);
}

TEST_WITH(what_the_whole_is_refused_for_slabs_are_refused_for, write_ordered, remove_lattice)
{
    drop("mass");
    assert_refused(0, 2, DEM_ERROR_IO, "test_slab_file.h5: /lattice/mass: is missing");
    put_real("mass", 4, 0, ones);
    assert_refused(0, 2, DEM_ERROR_MODEL, "/lattice/mass: has 4 rows where the datasets before it have 5");
    put_real("mass", 5, 1, ones);
    assert_refused(0, 2, DEM_ERROR_IO, "/lattice/mass: is not of shape [n]");
    put_real("mass", 5, 0, ones);
    put_real("masses", 5, 0, ones);
    assert_refused(0, 2, DEM_ERROR_IO, "/lattice/masses: is none of the datasets of a lattice");
    drop("masses");
    put_real("triangles", 2, 3, (double[6]){0});
    assert_refused(0, 2, DEM_ERROR_IO, "/lattice/triangles: is not integer");
    drop("triangles");
    assert_refused(0, 2, DEM_ERROR_IO, "/lattice/coupling: is there without triangles");
    drop("coupling");
    put_real("x", 0, 2, NULL);
    put_real("mass", 0, 0, NULL);
    assert_refused(0, 2, DEM_ERROR_MODEL, "/lattice/x: has no nodes");
    CLEANUP(free_h5) const hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
    assert_true(H5Pset_chunk(layout, 2, (hsize_t[2]){64, 2}) >= 0);
    put_as("ends", layout, H5T_STD_I64LE, H5T_NATIVE_INT64, (hsize_t)1 << 39, 2, NULL);
    assert_refused(0, 2, DEM_ERROR_IO, "/lattice/ends: claims more data than the file holds");
}
