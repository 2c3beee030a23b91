/* SPDX-License-Identifier: BSD-3-Clause */
/* msh.c: meshes as Gmsh writes them, and every fault with its line. */
#include "unit/close.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/message.h"
#include "shape/msh.h"

#define FORMAT "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n" /* lines 1 to 3 */

/* A unit square of two triangles, the second one clockwise; node 9 is of a line only, tags have holes. */
#define ENTITIES "$Entities\n1 2 1 0\n$EndEntities\n"
#define NODES                                                                                                          \
    "$Nodes\n2 5 1 40\n1 1 0 1\n9\n5 5 0\n2 1 0 4\n40\n10\n20\n30\n"                                                   \
    "0 1 0\n0 0 0\n1 0 0.0\n1 1 -0\n$EndNodes\n"
#define ELEMENTS                                                                                                       \
    "$Elements\n3 4 1 4\n0 1 15 1\n1 10\n1 1 1 1\n2 9 10\n"                                                            \
    "2 1 2 2\n3 10 20 30\n4 10 40 30\n$EndElements\n"

static dem_lattice read_good(const char *text)
{
    dem_lattice lattice = dem_lattice_empty();
    char fault[MSH_FAULT] = "";
    if (msh_parse(&lattice, fault, text, strlen(text)) != DEM_OK) fail_msg("%s", fault);
    return lattice;
}

static void expect_fault(const char *text, const char *expected)
{
    dem_lattice lattice = dem_lattice_empty();
    char fault[MSH_FAULT] = "";
    assert_int_equal(msh_parse(&lattice, fault, text, strlen(text)), DEM_ERROR_MODEL);
    assert_line_parts(fault, expected);
    assert_int_equal(lattice.n_nodes, 0);
    assert_null(lattice.x);
    assert_null(lattice.triangles);
}

TEST(a_mesh_becomes_a_counter_clockwise_triangulation)
{
    static const double x[8] = {0, 1, 0, 0, 1, 0, 1, 1}; /* in the order of the file, without node 9 */
    static const dem_index triangles[6] = {1, 2, 3, 1, 3, 0};
    CLEANUP(dem_lattice_free) dem_lattice lattice = read_good(FORMAT ENTITIES NODES ELEMENTS);
    assert_int_equal(lattice.n_nodes, 4);
    assert_int_equal(lattice.n_triangles, 2);
    assert_int_equal(lattice.n_springs, 0);
    for (int k = 0; k < 8; k++) assert_close(lattice.x[k], x[k], 0.0);
    assert_memory_equal(lattice.triangles, triangles, sizeof triangles);
}

TEST(other_sections_and_parameters_are_passed_over)
{
    CLEANUP(dem_lattice_free)
    dem_lattice lattice = read_good(
        FORMAT "$PhysicalNames\n1\n2 1 \"a name with blanks,"
               "and_more_bytes_than_any_word_that_is_read_may_have,_and_in_it_$EndPhysicalNames\"\n"
               "$EndPhysicalNames\n"
               "$Nodes\n3 3 1 3\n2 1 1 1\n1\n0 0 0 0.1 0.2\n1 1 1 1\n2\n1 0 0 0.5\n0 1 0 1\n3\n0 1 0\n$EndNodes\n"
               "$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 3\n$EndElements\n"
               "$NodeData\nanything\n$EndNodeData");
    assert_int_equal(lattice.n_nodes, 3);
    assert_int_equal(lattice.n_triangles, 1);
}

TEST(formats_at_fault_are_refused)
{
    expect_fault("", "1 * ends * $MeshFormat");
    expect_fault("\x7f"
                 "ELF",
                 "1 * '$MeshFormat' * '?ELF'");
    expect_fault("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n", "2 * MSH * version * 4.1 * 'gmsh -format msh41'");
    expect_fault("$MeshFormat\n4.1 1 8\n", "2 * binary * mesh * 'Mesh.Binary = 0'");
    expect_fault(FORMAT, "4 * mesh * triangles");
    expect_fault(FORMAT "nodes\n", "4 * section * '$'");
    expect_fault(FORMAT "$Entities\n1\n", "6 * ends * line * '$EndEntities'");
    expect_fault(FORMAT ELEMENTS, "4 * elements * nodes");
    expect_fault(FORMAT NODES NODES ELEMENTS, "19 * second * section * nodes");
    expect_fault(FORMAT NODES ELEMENTS ELEMENTS, "29 * second * section * elements");
    expect_fault(FORMAT NODES, "19 * mesh * triangles");
}

/* Nothing of such a size is asked for. */
TEST(absurd_counts_are_refused)
{
    expect_fault(FORMAT "$Nodes\n1 1000000000 1 5\n2 1 0 1\n1\n0 0 0\n", "5 * 1000000000 * nodes * fit * 21 * bytes");
    expect_fault(FORMAT "$Nodes\n9223372036854775807 1 1 5\n2 1 0 1\n1\n0 0 0\n", "9 * ends * dimension");
    expect_fault(FORMAT NODES "$Elements\n1 9223372036854775807 1 1\n",
                 "20 * 9223372036854775807 * elements * fit * 5 * bytes");
    expect_fault(FORMAT "$Nodes\n1 1 1 5\n2 1 0 7\n1\n0 0 0\n", "6 * nodes * [0, 1] * 7");
}

TEST(nodes_at_fault_are_refused)
{
    expect_fault(FORMAT "$Nodes\n1 1 1 1\n2 1 0 1\n1\n0 0 0.1\n$EndNodes", "8 * mesh * plane * 0 * node * 0.1");
    expect_fault(FORMAT "$Nodes\n1 1 1 1\n2 1 0 1\n1\n0 nan 0\n$EndNodes", "8 * finite * 'nan'");
    expect_fault(FORMAT "$Nodes\n1 2 1 7\n2 1 0 2\n7\n7\n0 0 0\n1 0 0\n$EndNodes", "11 * nodes * tag 7");
    expect_fault(FORMAT "$Nodes\n1 2 1 7\n2 1 0 1\n7\n0 0 0\n$EndNodes\n$Something\n", "8 * 2 * nodes * announced * 1");
    expect_fault(FORMAT "$Nodes\n1 1 1 7\n2 1 0 1\n0\n0 0 0\n$EndNodes",
                 "7 * tag * node * [1, 9223372036854775807] * 0");
    expect_fault(FORMAT "$Nodes\n1 1 1 1\n2 1 0 1\n1\n0 0 0\n$EndElements\n", "9 * '$EndNodes' * '$EndElements'");
}

#define SQUARE FORMAT NODES "$Elements\n" /* the counts stand in line 20 */

TEST(elements_at_fault_are_refused)
{
    expect_fault(SQUARE "1 1 1 1\n2 1 3 1\n1 10 20 30 40\n$EndElements\n",
                 "21 * elements * type 3 * only * triangles * 3 * nodes * type 2");
    expect_fault(SQUARE "1 1 1 1\n2 1 2 1\n1 10 20 31\n$EndElements\n", "22 * node 31");
    expect_fault(SQUARE "1 1 1 1\n2 1 2 1\n1 10 20 20\n$EndElements\n", "22 * triangle * area * 0");
    expect_fault(SQUARE "1 2 1 2\n2 1 2 1\n1 10 20 30\n$EndElements\n", "22 * 2 * elements * announced * 1");
    expect_fault(SQUARE "1 1 1 2\n2 1 2 2\n1 10 20 30\n2 10 30 40\n$EndElements\n", "21 * elements * [0, 1] * 2");
    expect_fault(SQUARE "1 1 1 1\n2 1 2 1\n1 10 20\n$EndElements\n", "23 * node * element * integer * '$EndElements'");
    expect_fault(SQUARE "1 1 1 1\n1 1 1 1\n1 10 20\n$EndElements\n", "24 * mesh * triangles");
}

TEST(triangles_on_the_same_side_of_an_edge_are_refused)
{
    expect_fault(SQUARE "1 2 1 2\n2 1 2 2\n1 10 20 30\n2 30 20 10\n$EndElements\n",
                 "23 * triangle * overlaps * line 22");
    expect_fault(SQUARE "1 2 1 2\n2 1 2 2\n1 10 20 30\n2 10 20 40\n$EndElements\n",
                 "23 * triangle * overlaps * line 22");
}

/* Every beginning of a good mesh is refused, or is one. */
TEST(no_beginning_of_a_mesh_is_harmful)
{
    static const char text[] = FORMAT ENTITIES NODES ELEMENTS;
    for (size_t n = 0; n + 1 < sizeof text; n++) {
        char fault[MSH_FAULT] = "", *part = malloc(n + 1); /* exact: what reads beyond is seen */
        CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
        assert_non_null(part);
        memcpy(part, text, n);
        part[n] = '\0';
        const dem_status status = msh_parse(&lattice, fault, part, n);
        assert_true(status == DEM_OK ? n == sizeof text - 2 : fault[0] != '\0');
        free(part);
    }
}
