/* SPDX-License-Identifier: BSD-3-Clause */
/* mesh_lattice.c: lattices of meshes in files and in memory. What may be wrong in a mesh is test_msh's. */
#include "unit/close.h"

#include <string.h>

#include <dem/shape.h>

#include "harness/message.h"
#include "unit/scratch.h"

#define HEAD     "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 4 1 4\n2 1 0 4\n1\n2\n3\n4\n"
#define NODES    "0 0 0\n9 9 0\n0.1 0 0\n0 0.3 0\n$EndNodes\n"
#define ELEMENTS "$Elements\n1 1 1 1\n2 1 2 1\n1 1 4 3\n$EndElements\n"

static const char text[] = HEAD NODES ELEMENTS; /* node 2 is of no triangle, which is clockwise */

static dem_mesh text_of(const char *words)
{
    return (dem_mesh)SIZED(dem_mesh, .text = words, .size = (dem_index)strlen(words), .scale = 1.0);
}

static void expect_the_triangle(const dem_mesh *mesh)
{
    const double x[6] = {0.0, 0.0, 0.1 * 1e-3, 0.0, 0.0, 0.3 * 1e-3};
    static const dem_index corners[3] = {0, 1, 2};
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    if (dem_mesh_lattice(&lattice, mesh) != DEM_OK) fail_msg("%s", dem_status_message());
    assert_int_equal(lattice.n_nodes, 3);
    assert_int_equal(lattice.n_triangles, 1);
    assert_int_equal(lattice.n_springs, 0);
    assert_memory_equal(lattice.x, x, sizeof x);
    assert_memory_equal(lattice.triangles, corners, sizeof corners);
    if (mesh->numbered)
        assert_close(lattice.strength[0], 0.0, 0.0);
    else
        assert_null(lattice.strength);
}

static void expect_refused(const dem_mesh *mesh, dem_status expected, const char *parts)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    assert_int_equal(dem_mesh_lattice(&lattice, mesh), expected);
    assert_message_parts(parts);
    assert_int_equal(lattice.n_nodes, 0);
    assert_null(lattice.x);
    assert_null(lattice.triangles);
}

TEST(a_file_gives_the_lattice_of_its_text)
{
    CLEANUP(folder_close) scratch_folder f;
    folder_open(&f);
    dem_mesh mesh = SIZED(dem_mesh, .path = folder_file(&f, "a.msh"), .scale = 1e-3, .numbered = true);
    file_put(mesh.path, text, strlen(text));
    expect_the_triangle(&mesh);
    mesh = text_of(text), mesh.scale = 1e-3;
    expect_the_triangle(&mesh);
}

/* A text needs no zero at its end: what reads beyond it is seen. */
TEST(a_text_ends_where_its_size_says)
{
    CLEANUP(free_memory) char *part = malloc(strlen(text));
    assert_non_null(part);
    memcpy(part, text, strlen(text));
    dem_mesh mesh = text_of(text);
    mesh.text = part, mesh.scale = 1e-3;
    expect_the_triangle(&mesh);
    mesh.size = (dem_index)strlen(HEAD);
    expect_refused(&mesh, DEM_ERROR_MODEL, "the mesh:5: 4 nodes * 21 bytes");
    mesh.size = 0;
    expect_refused(&mesh, DEM_ERROR_MODEL, "the mesh:1: * ends * $MeshFormat");
}

TEST(what_is_wrong_in_a_file_is_said_with_its_line)
{
    CLEANUP(folder_close) scratch_folder f;
    char folder[SCRATCH_PATH + 300] = "", expected[SCRATCH_PATH + 64];
    folder_open(&f);
    dem_mesh mesh = SIZED(dem_mesh, .path = folder_file(&f, "bad.msh"), .scale = 1.0);
    (void)snprintf(expected, sizeof expected, "%s: No such file or directory", mesh.path);
    expect_refused(&mesh, DEM_ERROR_IO, expected);
    file_put(mesh.path, HEAD NODES, strlen(HEAD NODES));
    (void)snprintf(expected, sizeof expected, "%s:16: the mesh has no triangles", mesh.path);
    expect_refused(&mesh, DEM_ERROR_MODEL, expected);
    for (size_t k = 0; k < 200; k += 2) memcpy(folder + k, "./", 3);
    memcpy(folder + 200, "none.msh", sizeof "none.msh");
    mesh.path = folder;
    expect_refused(&mesh, DEM_ERROR_IO, "none.msh: No such file");
    assert_int_equal(strlen(dem_status_message()), 200 + strlen(": No such file or directory"));
}

TEST(members_out_of_range_are_refused)
{
    dem_mesh mesh = text_of(text);
    expect_refused(NULL, DEM_ERROR_ARGUMENT, "mesh * NULL");
    mesh.path = "a.msh";
    expect_refused(&mesh, DEM_ERROR_ARGUMENT, "path * text * not both");
    mesh.path = mesh.text = NULL;
    expect_refused(&mesh, DEM_ERROR_ARGUMENT, "path * text");
    mesh = text_of(text), mesh.size = -1;
    expect_refused(&mesh, DEM_ERROR_ARGUMENT, "0 bytes * -1");
    mesh = text_of(text), mesh.scale = 0.0;
    expect_refused(&mesh, DEM_ERROR_ARGUMENT, "scale * 0 m");
    mesh.scale = (double)NAN;
    expect_refused(&mesh, DEM_ERROR_ARGUMENT, "scale * nan");
    mesh = text_of(text), mesh.struct_size = 8;
    expect_refused(&mesh, DEM_ERROR_ARGUMENT, "dem_mesh");
    mesh = text_of(text);
    assert_int_equal(dem_mesh_lattice(NULL, &mesh), DEM_ERROR_ARGUMENT);
}
