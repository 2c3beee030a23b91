/* SPDX-License-Identifier: BSD-3-Clause */
/* lattice_file.c: files that others wrote, and files that must be refused. */
#include "unit/close.h"

#include <dem/trajectory.h>

#define WRITTEN_PATH "test_lattice_file.h5"
#include "unit/output/written.h"

#include "output/lattice_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static dem_lattice read_lattice(void)
{
    dem_lattice lattice = dem_lattice_empty();
    const dem_status status = dem_lattice_read(&lattice, path);
    if (status != DEM_OK) fail_msg("%s", dem_status_message());
    return lattice;
}

static void assert_refused(const char *file, dem_status status, const char *message)
{
    dem_lattice lattice = {.struct_size = sizeof lattice, .n_nodes = -7};
    dem_index size[2] = {-7, -7};
    const dem_status measured = dem_lattice_measure(file, &size[0], &size[1]);
    if (status == DEM_ERROR_IO) assert_int_equal(measured, status);
    if (measured != DEM_OK) assert_int_equal(size[0], -7);
    assert_int_equal(dem_lattice_read(&lattice, file), status);
    assert_string_equal(dem_status_message(), message);
    assert_int_equal(lattice.n_nodes, -7);
}

#define REFUSED(reason)      assert_refused(path, DEM_ERROR_IO, "test_lattice_file.h5: /lattice/" reason)
#define INCONSISTENT(reason) assert_refused(path, DEM_ERROR_MODEL, "test_lattice_file.h5: /lattice" reason)

/* ---- accepted ---- */

TEST_WITH(what_is_not_there_is_null, write_lattice, remove_lattice)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = read_lattice();
    assert_int_equal(lattice.n_nodes, 5);
    assert_int_equal(lattice.n_springs, 6);
    assert_int_equal(lattice.n_triangles, 0);
    assert_memory_equal(lattice.x, x, sizeof x);
    assert_memory_equal(lattice.ends, ends, sizeof ends);
    assert_null(lattice.viscosity);
    assert_null(lattice.triangles);
    assert_null(lattice.guard);
    assert_null(lattice.area_stiffness);
    assert_null(lattice.thickness);
    assert_null(lattice.modulus);
    assert_null(lattice.coupling);
    assert_null(lattice.flags);
    assert_null(lattice.body);
    assert_null(lattice.position);
    assert_null(lattice.velocity);
}

TEST_WITH(any_width_of_number_is_read, write_lattice, remove_lattice)
{
    const double body[5] = {0, 0, 0, 1, 1};
    const hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
    assert_true(H5Pset_chunk(layout, 2, (hsize_t[2]){2, 1}) >= 0);
    assert_true(H5Pset_shuffle(layout) >= 0 && H5Pset_deflate(layout, 6) >= 0 && H5Pset_fletcher32(layout) >= 0);
    put_as("x", layout, H5T_IEEE_F32BE, H5T_NATIVE_DOUBLE, 5, 2, x);
    put_as("ends", layout, H5T_STD_U16BE, H5T_NATIVE_INT64, 6, 2, ends);
    put_as("body", H5P_DEFAULT, H5T_STD_U64LE, H5T_NATIVE_DOUBLE, 5, 0, body);
    (void)H5Pclose(layout);
    CLEANUP(dem_lattice_free) dem_lattice lattice = read_lattice();
    assert_memory_equal(lattice.x, x, sizeof x);
    assert_memory_equal(lattice.ends, ends, sizeof ends);
    assert_int_equal(lattice.body[2], 0);
    assert_int_equal(lattice.body[3], 1);
}

TEST_WITH(integers_do_for_reals, write_lattice, remove_lattice)
{
    put_whole("mass", 5, 0, (int64_t[5]){1, 2, 3, 4, 5});
    put_as("velocity", H5P_DEFAULT, H5T_STD_I16BE, H5T_NATIVE_INT64, 5, 2, ends);
    CLEANUP(dem_lattice_free) dem_lattice lattice = read_lattice();
    for (int k = 0; k < 5; k++) assert_close(lattice.mass[k], k + 1.0, 0.0);
    for (int k = 0; k < 10; k++) assert_close(lattice.velocity[k], (double)ends[k], 0.0);
}

TEST_WITH(optional_numbers_are_read_and_come_back_as_they_were_written, write_lattice, remove_lattice)
{
    const double viscosity[6] = {0.5, 0.0, 1e-3, 2.0, 3.0, 4.0}, thickness[2] = {0.1, 3.0}, modulus[2] = {1e7, 2e9};
    const double coupling[6] = {3.0, -1.0, 0.0, 5.0, 1e9, -2.5};
    const double strength[2] = {1e6, INFINITY}, critical_stretch[6] = {0.1, 0.2, INFINITY, 0.3, 0.4, 0.5};
    const double softening[2] = {1.0, 2.5};
    const double compressive[2] = {INFINITY, 8e6}, confinement[2] = {0.0, 7.5};
    put_real("softening", 2, 0, softening);
    put_real("compressive_strength", 2, 0, compressive);
    put_real("confinement", 2, 0, confinement);
    put_whole("own_stress", 2, 0, (int64_t[2]){1, 0});
    put_real("strength", 2, 0, strength);
    put_real("critical_stretch", 6, 0, critical_stretch);
    put_real("viscosity", 6, 0, viscosity);
    put_whole("triangles", 2, 3, corners);
    put_real("thickness", 2, 0, thickness);
    put_real("modulus", 2, 0, modulus);
    put_real("coupling", 2, 3, coupling);
    for (int deflate = 0; deflate < 2; deflate++) {
        hdf5_file file;
        CLEANUP(dem_lattice_free) dem_lattice lattice = read_lattice();
        assert_memory_equal(lattice.viscosity, viscosity, sizeof viscosity);
        assert_memory_equal(lattice.thickness, thickness, sizeof thickness);
        assert_memory_equal(lattice.modulus, modulus, sizeof modulus);
        assert_memory_equal(lattice.coupling, coupling, sizeof coupling);
        assert_memory_equal(lattice.strength, strength, sizeof strength);
        assert_memory_equal(lattice.softening, softening, sizeof softening);
        assert_memory_equal(lattice.compressive_strength, compressive, sizeof compressive);
        assert_memory_equal(lattice.confinement, confinement, sizeof confinement);
        assert_memory_equal(lattice.own_stress, "\1\0", 2);
        assert_memory_equal(lattice.critical_stretch, critical_stretch, sizeof critical_stretch);
        assert_int_equal(hdf5_open_new(&file, path, 4096), DEM_OK);
        assert_int_equal(hdf5_close(&file, lattice_file_write(&file, &(lattice_source){&lattice, NULL}, deflate)),
                         DEM_OK);
    }
    CLEANUP(dem_lattice_free) dem_lattice back = read_lattice();
    assert_memory_equal(back.viscosity, viscosity, sizeof viscosity);
    assert_memory_equal(back.thickness, thickness, sizeof thickness);
    assert_memory_equal(back.modulus, modulus, sizeof modulus);
    assert_memory_equal(back.coupling, coupling, sizeof coupling);
    assert_memory_equal(back.strength, strength, sizeof strength);
    assert_memory_equal(back.softening, softening, sizeof softening);
    assert_memory_equal(back.compressive_strength, compressive, sizeof compressive);
    assert_memory_equal(back.confinement, confinement, sizeof confinement);
    assert_memory_equal(back.own_stress, "\1\0", 2);
    assert_memory_equal(back.critical_stretch, critical_stretch, sizeof critical_stretch);
}

static void assert_flags(const unsigned char expected[5])
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = read_lattice();
    assert_non_null(lattice.flags);
    assert_memory_equal(lattice.flags, expected, 5);
}

TEST_WITH(fixed_nodes_leave_the_rule_of_contact_as_it_is, write_lattice, remove_lattice)
{
    enum { F = DEM_NODE_FIXED, C = DEM_NODE_CONTACT };
    put_whole("fixed", 5, 0, (int64_t[5]){0, 2, 0, 0, 1});
    assert_flags((unsigned char[5]){C, F | C, C, C, F | C});
    put_whole("triangles", 2, 3, corners);
    assert_flags((unsigned char[5]){C, F | C, C, C, F});
    put_whole("contact_nodes", 2, 0, (int64_t[2]){1, 3});
    assert_flags((unsigned char[5]){0, F | C, 0, C, F});
    put_flags("fixed", "FALSE", "TRUE");
    assert_flags((unsigned char[5]){0, F | C, 0, C, 0});
    drop("fixed");
    assert_flags((unsigned char[5]){0, C, 0, C, 0});
    put_whole("contact_nodes", 0, 0, NULL);
    assert_flags((unsigned char[5]){0});
}

TEST_WITH(rigid_nodes_come_back_as_they_were_written, write_lattice, remove_lattice)
{
    enum { C = DEM_NODE_CONTACT, R = DEM_NODE_RIGID, X = DEM_NODE_GUIDE_X, Y = DEM_NODE_GUIDE_Y };
    const unsigned char expected[5] = {C | R, C, C | R | Y, C | R | X, C};
    put_whole("rigid", 5, 0, (int64_t[5]){1, 0, 3, 2, 0});
    assert_flags(expected);
    CLEANUP(dem_lattice_free) dem_lattice lattice = read_lattice();
    hdf5_file file;
    assert_int_equal(hdf5_open_new(&file, path, 4096), DEM_OK);
    assert_int_equal(hdf5_close(&file, lattice_file_write(&file, &(lattice_source){&lattice, NULL}, 0)), DEM_OK);
    assert_flags(expected);
    put_whole("rigid", 5, 0, (int64_t[5]){1, 0, 4, 2, 0});
    INCONSISTENT("/rigid: entry 2 is 4, which is not in 0 to 3");
}

TEST_WITH(a_body_of_one_node_needs_no_springs, write_lattice, remove_lattice)
{
    put_real("x", 1, 2, x);
    put_real("mass", 1, 0, ones);
    put_whole("ends", 0, 2, NULL);
    put_real("rest_length", 0, 0, NULL);
    put_real("stiffness", 0, 0, NULL);
    for (int k = 0; k < 2; k++) {
        CLEANUP(dem_lattice_free) dem_lattice lattice = read_lattice();
        assert_int_equal(lattice.n_nodes, 1);
        assert_int_equal(lattice.n_springs, 0);
        if (k == 0) drop("ends"), drop("rest_length"), drop("stiffness");
    }
}

/* ---- refused ---- */

TEST_WITH(files_that_are_none_are_refused, write_lattice, remove_lattice)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    (void)fputs("node,x,y\n0,0,0\n", file);
    (void)fclose(file);
    assert_refused(path, DEM_ERROR_IO, "test_lattice_file.h5: cannot be opened (file signature not found)");
    assert_refused("none.h5", DEM_ERROR_IO, "none.h5: cannot be opened (No such file or directory)");
    assert_refused(".", DEM_ERROR_IO, ".: is not a regular file");
    assert_refused(NULL, DEM_ERROR_ARGUMENT, "dem_lattice_read: an argument is NULL");
    assert_int_equal(unlink(path), 0);
    assert_int_equal(mkfifo(path, 0600), 0);
    assert_refused(path, DEM_ERROR_IO, "test_lattice_file.h5: is not a regular file"); /* and nobody waits */
}

TEST_WITH(missing_datasets_are_refused, write_lattice, remove_lattice)
{
    static const char *const names[] = {"x", "mass", "ends", "rest_length", "stiffness"};
    for (size_t k = 0; k < sizeof names / sizeof names[0]; k++) {
        char message[80];
        (void)snprintf(message, sizeof message, "%s: /lattice/%s: is missing", path, names[k]);
        (void)write_lattice(NULL);
        drop(names[k]);
        assert_refused(path, DEM_ERROR_IO, message);
    }
    const hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    (void)H5Fclose(file);
    assert_refused(path, DEM_ERROR_IO, "test_lattice_file.h5: /lattice: is missing");
}

TEST_WITH(unknown_names_are_refused, write_lattice, remove_lattice)
{
    static const char *const names[][2] = {
        {"velocities", "velocities"}, {"Fixed", "Fixed"}, {"a\nb \xff", "a?b??"}, {"m", "m"}};
    for (size_t k = 0; k < sizeof names / sizeof names[0]; k++) {
        char message[512];
        (void)snprintf(
            message, sizeof message,
            "%s: /lattice/%s: is none of the datasets of a lattice: x, mass, ends, rest_length, stiffness, "
            "viscosity, critical_stretch, triangles, guard, area_stiffness, "
            "thickness, modulus, coupling, strength, softening, compressive_strength, confinement, own_stress, body, "
            "position, velocity, fixed, rigid, contact_nodes",
            path, names[k][1]);
        put_real(names[k][0], 5, 2, x);
        assert_refused(path, DEM_ERROR_IO, message);
        drop(names[k][0]);
    }
}

TEST_WITH(wrong_types_and_shapes_are_refused, write_lattice, remove_lattice)
{
    put_real("ends", 6, 2, (double[12]){0});
    REFUSED("ends: is not integer");
    put_whole("ends", 6, 2, ends);
    put_flags("mass", "FALSE", "TRUE");
    REFUSED("mass: is neither floating-point nor integer");
    put_real("mass", 5, 0, ones);
    put_flags("fixed", "NO", "YES");
    REFUSED("fixed: is neither integer nor boolean");
    put_real("fixed", 5, 0, ones);
    REFUSED("fixed: is neither integer nor boolean");
    drop("fixed");
    put_real("mass", 5, 1, ones);
    REFUSED("mass: is not of shape [n]");
    put_real("mass", 5, 0, ones);
    put_real("x", 2, 3, x);
    REFUSED("x: is not of shape [n][2]");
    put_real("x", 5, 2, x);
    put_whole("triangles", 3, 2, corners);
    REFUSED("triangles: is not of shape [n][3]");
    drop("triangles");
    put_real("guard", 2, 0, ones);
    REFUSED("guard: is there without triangles");
    drop("guard");
    put_real("area_stiffness", 2, 0, ones);
    REFUSED("area_stiffness: is there without triangles");
}

TEST_WITH(a_number_that_does_not_fit_is_refused, write_lattice, remove_lattice)
{
    dem_lattice lattice = dem_lattice_empty();
    put_whole("body", 5, 0, (int64_t[5]){0, 0, 5000000000, 0, 0});
    assert_int_equal(dem_lattice_read(&lattice, path), DEM_ERROR_IO);
    assert_non_null(strstr(dem_status_message(), "/lattice/body: cannot be read"));
    drop("body");
    put_whole("fixed", 5, 0, (int64_t[5]){0, 0, -1, 0, 0});
    assert_int_equal(dem_lattice_read(&lattice, path), DEM_ERROR_IO);
    assert_non_null(strstr(dem_status_message(), "/lattice/fixed: cannot be read"));
}

TEST_WITH(inconsistent_extents_and_indices_are_refused, write_lattice, remove_lattice)
{
    put_real("mass", 4, 0, ones);
    INCONSISTENT("/mass: has 4 rows where the datasets before it have 5");
    put_real("mass", 5, 0, ones);
    put_real("stiffness", 5, 0, ones);
    INCONSISTENT("/stiffness: has 5 rows where the datasets before it have 6");
    put_real("stiffness", 6, 0, ones);
    put_real("viscosity", 5, 0, ones);
    INCONSISTENT("/viscosity: has 5 rows where the datasets before it have 6");
    drop("viscosity");
    put_whole("contact_nodes", 2, 0, (int64_t[2]){4, 5});
    INCONSISTENT("/contact_nodes: entry 1 is 5, which is no node: there are 5");
    drop("contact_nodes");
    put_whole("ends", 6, 2, (int64_t[12]){0, 1, 1, 2, 2, 3, 3, 0, 0, 2, 3, -4});
    INCONSISTENT(": spring 5 has node -4, but there are 5 nodes");
    put_whole("ends", 6, 2, ends);
    put_whole("triangles", 2, 3, (int64_t[6]){0, 1, 2, 0, 2, 5});
    put_whole("fixed", 5, 0, (int64_t[5]){0});
    INCONSISTENT(": triangle 1 has node 5, but there are 5 nodes");
    put_real("x", 0, 2, NULL);
    drop("triangles");
    drop("fixed");
    put_real("mass", 0, 0, NULL);
    INCONSISTENT("/x: has no nodes");
}

TEST_WITH(links_are_refused, write_lattice, remove_lattice)
{
    hid_t group = open_group();
    assert_true(H5Lmove(group, "x", group, "/elsewhere", H5P_DEFAULT, H5P_DEFAULT) >= 0);
    assert_true(H5Lcreate_soft("/elsewhere", group, "x", H5P_DEFAULT, H5P_DEFAULT) >= 0);
    (void)H5Gclose(group);
    REFUSED("x: is a soft or external link");
    group = open_group();
    assert_true(H5Ldelete(group, "x", H5P_DEFAULT) >= 0);
    assert_true(H5Lcreate_external("/etc/passwd", "/x", group, "x", H5P_DEFAULT, H5P_DEFAULT) >= 0);
    (void)H5Gclose(group);
    REFUSED("x: is a soft or external link");
    const hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
    assert_true(H5Lmove(file, "lattice", file, "other", H5P_DEFAULT, H5P_DEFAULT) >= 0);
    assert_true(H5Lcreate_soft("other", file, "lattice", H5P_DEFAULT, H5P_DEFAULT) >= 0);
    (void)H5Fclose(file);
    assert_refused(path, DEM_ERROR_IO, "test_lattice_file.h5: /lattice: is a soft or external link");
}

TEST_WITH(a_group_in_place_of_a_dataset_is_refused, write_lattice, remove_lattice)
{
    dem_lattice lattice = dem_lattice_empty();
    drop("x");
    const hid_t group = open_group(), inner = H5Gcreate2(group, "x", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    (void)H5Gclose(inner);
    (void)H5Gclose(group);
    assert_int_equal(dem_lattice_read(&lattice, path), DEM_ERROR_IO);
    assert_non_null(strstr(dem_status_message(), "/lattice/x: is not a readable dataset"));
}

TEST_WITH(storage_elsewhere_is_refused, write_lattice, remove_lattice)
{
    hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
    assert_true(H5Pset_external(layout, "test_lattice_file.raw", 0, 80) >= 0);
    put_as("x", layout, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 5, 2, NULL);
    (void)H5Pclose(layout);
    REFUSED("x: keeps its data in an external file");
    layout = H5Pcreate(H5P_DATASET_CREATE);
    const hid_t space = H5Screate_simple(2, (hsize_t[2]){5, 2}, NULL);
    assert_true(H5Pset_virtual(layout, space, "test_lattice_other.h5", "/x", space) >= 0);
    put_as("x", layout, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 5, 2, NULL);
    (void)H5Sclose(space);
    (void)H5Pclose(layout);
    REFUSED("x: has a virtual or unknown layout");
}

TEST_WITH(other_filters_are_refused, write_lattice, remove_lattice)
{
    const hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
    assert_true(H5Pset_chunk(layout, 2, (hsize_t[2]){6, 2}) >= 0);
    assert_true(H5Pset_scaleoffset(layout, H5Z_SO_INT, 0) >= 0);
    put_as("ends", layout, H5T_STD_I64LE, H5T_NATIVE_INT64, 6, 2, ends);
    (void)H5Pclose(layout);
    REFUSED("ends: uses a filter other than deflate, shuffle and fletcher32");
}

TEST_WITH(sizes_without_data_behind_them_are_refused, write_lattice, remove_lattice)
{
    CLEANUP(free_h5) const hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
    assert_true(H5Pset_chunk(layout, 2, (hsize_t[2]){64, 2}) >= 0);
    put_as("x", layout, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, (hsize_t)1 << 39, 2, NULL);
    REFUSED("x: claims more data than the file holds");
    put_as("x", layout, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, ((hsize_t)1 << 40) + 1, 2, NULL);
    REFUSED("x: has more than 2^40 rows");
}

TEST_WITH(a_lattice_is_measured_without_its_numbers, write_lattice, remove_lattice)
{
    dem_index n_nodes, n_springs;
    put_whole("ends", 6, 2, (int64_t[12]){99});
    assert_int_equal(dem_lattice_measure(path, &n_nodes, &n_springs), DEM_OK);
    assert_int_equal(n_nodes, 5);
    assert_int_equal(n_springs, 6);
    assert_int_equal(dem_lattice_measure(path, NULL, &n_springs), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_lattice_measure(path, &n_nodes, NULL), DEM_ERROR_ARGUMENT);
}

TEST_WITH(plugins_are_as_they_were, write_lattice, remove_lattice)
{
    unsigned before = 0, after = 1;
    assert_true(H5PLget_loading_state(&before) >= 0);
    CLEANUP(dem_lattice_free) dem_lattice lattice = read_lattice();
    assert_true(H5PLget_loading_state(&after) >= 0);
    assert_int_equal(after, before);
}
