/* SPDX-License-Identifier: BSD-3-Clause */
/* frames.c: which arrays are there and what the fields of stress hold; test_trajectory.c has the others. */
#include "unit/output/stored.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "ask.h"
#include "harness/cleanup_hdf5.h"
#include "output/frames.h"
#include "unit/solids.h"

/* A block that flies and vibrates. */
static void open_block(support_run *run)
{
    const dem_options options = dem_options_default();
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(0.03, 0.04, 0.01);
    const double velocity[2] = {1.0, 2.0};
    assert_ok(dem_lattice_launch(&lattice, velocity));
    for (dem_index i = 0; i < lattice.n_nodes; i++) lattice.velocity[2 * i] += 300.0 * lattice.x[2 * i + 1];
    support_open(run, &lattice, NULL, 0, &options);
}

typedef struct reader {
    support_run run;
    stored stored;
    frames frames;
} reader;

/* Two blocks near each other, of which one flies to the other. */
static void open_blocks(support_run *run)
{
    dem_options options = dem_options_default();
    CLEANUP(dem_lattice_free) dem_lattice left = make_solid(0.03, 0.04, 0.01), right = make_solid(0.03, 0.04, 0.01);
    options.bodies = DEM_BODIES_OTHERS;
    dem_lattice_move(&right, 0.0, (const double[2]){0.0335, 0.001});
    assert_ok(dem_lattice_launch(&left, (const double[2]){20.0, 0.0}));
    assert_ok(dem_lattice_append(&left, &right));
    support_open(run, &left, NULL, 0, &options);
}

/* Two frames, at 0 and 1e-4 s; the triangles 0 to n_broken - 1 break after the first. */
static reader *shoot_breaking(void (*open)(support_run *), uint32_t fields, int is_double, dem_index n_broken)
{
    static const dem_index first[3] = {0, 1, 2};
    reader *f = calloc(1, sizeof *f);
    assert_non_null(f);
    dem_trajectory_options options = dem_trajectory_options_default();
    options.fields = fields;
    options.double_precision = is_double;
    open(&f->run);
    stored_open(&f->stored);
    frames_init(&f->frames, f->run.model, &options);
    assert_ok(frames_create(&f->frames, &f->stored.file, &(lattice_source){dem_model_lattice(f->run.model), NULL}));
    for (f->frames.n = 0; f->frames.n < 2; f->frames.n++) {
        (void)support_at(&f->run, 1e-4 * (double)f->frames.n);
        assert_ok(frames_append(&f->frames, &f->stored.file, f->run.simulation));
        if (f->frames.n == 0 && n_broken > 0)
            assert_ok(dem_simulation_break(f->run.simulation, first, n_broken, NULL, 0));
    }
    assert_ok(frames_verify(&f->frames, &f->stored.file, 2));
    return f;
}

static reader *shoot_run(void (*open)(support_run *), uint32_t fields, int is_double)
{
    return shoot_breaking(open, fields, is_double, 0);
}

static reader *shoot(uint32_t fields, int is_double)
{
    return shoot_run(open_block, fields, is_double);
}

static void put_away(reader *f)
{
    stored_close(&f->stored);
    support_close(&f->run);
    free(f);
}

static const struct {
    const char *name;
    uint32_t field;
} arrays[] = {{"PointData/displacement", DEM_FIELD_DISPLACEMENT},
              {"PointData/velocity", DEM_FIELD_VELOCITY},
              {"PointData/stress", DEM_FIELD_STRESS},
              {"PointData/von_mises", DEM_FIELD_VON_MISES},
              {"PointData/principal_stress", DEM_FIELD_PRINCIPAL},
              {"PointData/contact_force", DEM_FIELD_CONTACT},
              {"PointData/contact_pressure", DEM_FIELD_CONTACT},
              {"CellData/strain", DEM_FIELD_STRAIN},
              {"CellData/force", DEM_FIELD_FORCE},
              {"Points", 0},
              {"PointData/id", 0},
              {"CellData/broken", 0},
              {"CellData/vtkGhostType", 0}};
enum { n_arrays = sizeof arrays / sizeof arrays[0] };

TEST(a_file_has_the_arrays_that_are_wanted_and_their_offsets)
{
    static const uint32_t wishes[5] = {0, DEM_FIELD_PRINCIPAL | DEM_FIELD_STRAIN, DEM_FIELD_ALL, DEM_FIELD_STRESS,
                                       DEM_FIELD_CONTACT};
    for (int w = 0; w < 5; w++) {
        reader *f = shoot(wishes[w], 0);
        for (int k = 0; k < n_arrays; k++) {
            char name[64], offset[64];
            const bool is_set = strchr(arrays[k].name, '/') != NULL;
            const char *last = is_set ? strchr(arrays[k].name, '/') + 1 : "";
            (void)snprintf(name, sizeof name, "/VTKHDF/%s", arrays[k].name);
            (void)snprintf(offset, sizeof offset, "/VTKHDF/Steps/%.*s%s%s",
                           is_set ? (int)(last - arrays[k].name) - 1 : 5, arrays[k].name,
                           is_set ? "Offsets/" : "Offsets", last);
            const int wanted = arrays[k].field == 0 || (wishes[w] & arrays[k].field) != 0;
            assert_int_equal(stored_has(&f->stored, name), wanted);
            assert_int_equal(stored_has(&f->stored, offset), wanted);
        }
        put_away(f);
    }
}

/* Of a spring that is broken neither strain nor force is left; the frame before has nothing of it. */
TEST(springs_that_are_broken_are_marked)
{
    reader *f = shoot_breaking(open_block, DEM_FIELD_STRAIN | DEM_FIELD_FORCE, 1, 3);
    const hsize_t n = (hsize_t)f->frames.n_springs;
    hsize_t n_broken = 0;
    unsigned char *expected = calloc(n, 1);
    assert_non_null(expected);
    assert_ok(dem_simulation_broken(f->run.simulation, NULL, expected));
    const double *broken = stored_values(&f->stored, "/VTKHDF/CellData/broken", 2 * n, 1, 0);
    for (hsize_t k = 0; k < n; k++) {
        assert_close(broken[k], 0.0, 0.0);
        assert_close(broken[n + k], (double)expected[k], 0.0);
        n_broken += expected[k];
    }
    assert_true(n_broken > 0 && n_broken < 9);
    const double *hidden = stored_values(&f->stored, "/VTKHDF/CellData/vtkGhostType", 2 * n, 1, 1);
    for (hsize_t k = 0; k < n; k++) assert_true(hidden[k] == 0.0 && hidden[n + k] == 32.0 * expected[k]);
    const double *force = stored_values(&f->stored, "/VTKHDF/CellData/force", 2 * n, 1, 0);
    for (hsize_t k = 0; k < n; k++)
        if (expected[k]) assert_close(force[n + k], 0.0, 0.0);
    free(expected);
    put_away(f);
}

/* Those of the first frame are of whole triangles. */
TEST(triangles_that_are_broken_are_marked_in_frames_of_their_own)
{
    reader *f = shoot_breaking(open_block, 0, 0, 3);
    const hsize_t n = (hsize_t)f->frames.n_triangles;
    const double *broken = stored_values(&f->stored, "/fracture/triangles", 2 * n, 1, 1);
    assert_true(n > 3);
    for (hsize_t k = 0; k < n; k++) {
        assert_close(broken[k], 0.0, 0.0);
        assert_close(broken[n + k], k < 3 ? 1.0 : 0.0, 0.0);
    }
    put_away(f);
}

/* As VTK reads it: cells, what is hidden of them, and by links all that springs have. */
TEST(triangles_are_the_cells_of_a_second_grid)
{
    static const char *const shared[] = {"Points",       "PointData",          "FieldData",
                                         "Steps/Values", "Steps/PointOffsets", "Steps/PointDataOffsets"};
    reader *f = shoot_breaking(open_block, DEM_FIELD_VELOCITY, 0, 3);
    const hsize_t n = (hsize_t)f->frames.n_triangles;
    const dem_index *triangles = dem_model_lattice(f->run.model)->triangles;
    const double *corners = stored_values(&f->stored, "/bodies/Connectivity", 3 * n, 1, 8);
    for (hsize_t k = 0; k < 3 * n; k++) assert_close(corners[k], (double)triangles[k], 0.0);
    const double *hidden = stored_values(&f->stored, "/bodies/CellData/vtkGhostType", 2 * n, 1, 1);
    for (hsize_t k = 0; k < 2 * n; k++) assert_close(hidden[k], n <= k && k < n + 3 ? 32.0 : 0.0, 0.0);
    const double *offset = stored_values(&f->stored, "/bodies/Steps/CellDataOffsets/vtkGhostType", 2, 1, 8);
    assert_true(offset[0] == 0.0 && offset[1] == (double)n);
    for (size_t k = 0; k < sizeof shared / sizeof *shared; k++) {
        char name[48], expected[48], found[48];
        (void)snprintf(name, sizeof name, "/bodies/%s", shared[k]);
        (void)snprintf(expected, sizeof expected, "/VTKHDF/%s", shared[k]);
        assert_true(H5Lget_val(f->stored.file.id, name, found, sizeof found, H5P_DEFAULT) >= 0);
        assert_string_equal(found, expected);
        assert_true(stored_has(&f->stored, expected));
    }
    put_away(f);
}

static void drop(const reader *f, const char *name)
{
    assert_true(H5Ldelete(f->stored.file.id, name, H5P_DEFAULT) >= 0);
}

/* As before springs were hidden, and as before there was a second grid. */
TEST(of_an_older_file_what_is_hidden_is_made_from_what_is_broken)
{
    static const char springs[] = "/VTKHDF/CellData/vtkGhostType", triangles[] = "/bodies/CellData/vtkGhostType";
    for (int age = 0; age < 2; age++) {
        reader *f = shoot_breaking(open_block, 0, 0, 3);
        const hsize_t n = (hsize_t)f->frames.n_triangles, m = (hsize_t)f->frames.n_springs;
        double *expected = malloc(m * sizeof *expected);
        stored copy;
        hsize_t count = 0;
        assert_non_null(expected);
        memcpy(expected, stored_values(&f->stored, springs, 2 * m, 1, 1) + m, m * sizeof *expected);
        drop(f, springs);
        drop(f, "/VTKHDF/Steps/CellDataOffsets/vtkGhostType");
        if (age > 0) drop(f, "/bodies");
        assert_int_equal(frames_verify(&f->frames, &f->stored.file, 2), DEM_ERROR_IO);
        assert_ok(frames_count(&f->frames, &f->stored.file, &count));
        assert_int_equal(count, 2);
        stored_open(&copy);
        assert_ok(frames_create(&f->frames, &copy.file, &(lattice_source){dem_model_lattice(f->run.model), NULL}));
        assert_ok(frames_copy(&f->frames, &f->stored.file, &copy.file, (hdf5_span){1, 1, 0}));
        assert_ok(frames_copy(&f->frames, &f->stored.file, &copy.file, (hdf5_span){0, 2, 1}));
        assert_ok(frames_verify(&f->frames, &copy.file, 3));
        const double *hidden = stored_values(&copy, triangles, 3 * n, 1, 1);
        for (hsize_t k = 0; k < 3 * n; k++) assert_close(hidden[k], k / n != 1 && k % n < 3 ? 32.0 : 0.0, 0.0);
        hidden = stored_values(&copy, springs, 3 * m, 1, 1);
        for (hsize_t k = 0; k < 3 * m; k++) assert_close(hidden[k], k / m != 1 ? expected[k % m] : 0.0, 0.0);
        free(expected);
        stored_close(&copy);
        drop(f, age > 0 ? "/fracture" : "/VTKHDF/CellData/broken");
        assert_int_equal(frames_count(&f->frames, &f->stored.file, &count), DEM_ERROR_IO);
        put_away(f);
    }
}

/* Half a metre of rubber. */
static void open_plate(support_run *run)
{
    const dem_options options = dem_options_default();
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(0.5, 0.5, 0.01);
    support_open(run, &lattice, NULL, 0, &options);
}

TEST(flags_of_whole_triangles_take_no_room)
{
    reader *f = shoot_run(open_plate, 0, 0);
    CLEANUP(free_h5) const hid_t flags = H5Dopen2(f->stored.file.id, "/fracture/triangles", H5P_DEFAULT);
    CLEANUP(free_h5) const hid_t hidden = H5Dopen2(f->stored.file.id, "/bodies/CellData/vtkGhostType", H5P_DEFAULT);
    assert_true(f->frames.n_triangles > 5000);
    assert_true(H5Dget_storage_size(flags) <= 2 * 60);
    assert_true(H5Dget_storage_size(hidden) <= 2 * 60);
    put_away(f);
}

/* Two masses and a spring. */
static void open_pair(support_run *run)
{
    const dem_options options = dem_options_default();
    const double x[4] = {0.0, 0.0, 0.01, 0.0}, mass[2] = {1.0, 1.0};
    CLEANUP(dem_lattice_free)
    dem_lattice lattice = support_lattice(2, x, mass, 1, (const dem_index[2]){0, 1}, 0.01, 100.0, NULL);
    support_open(run, &lattice, NULL, 0, &options);
}

TEST(a_body_without_triangles_has_no_flags_of_them)
{
    reader *f = shoot_run(open_pair, 0, 0);
    assert_false(stored_has(&f->stored, "/fracture"));
    assert_false(stored_has(&f->stored, "/bodies"));
    assert_true(stored_has(&f->stored, "/VTKHDF/Steps/CellDataOffsets/vtkGhostType")); /* of springs */
    put_away(f);
}

/* The last frame is the simulation's state. */
TEST(stresses_are_those_of_the_simulation)
{
    for (int is_double = 0; is_double < 2; is_double++) {
        reader *f = shoot(DEM_FIELD_ALL, is_double);
        const hsize_t n = (hsize_t)f->frames.n_nodes;
        const double accuracy = is_double ? 0.0 : 6e-8; /* half a unit of the last place */
        double *stress = malloc(3 * n * sizeof *stress), largest = 0.0;
        assert_non_null(stress);
        dem_simulation_stress(f->run.simulation, stress);
        const double *six =
            stored_values(&f->stored, "/VTKHDF/PointData/stress", 2 * n, 6, is_double ? 8U : 4U) + 6 * n;
        for (hsize_t i = 0; i < n; i++) {
            const double expected[6] = {stress[3 * i], stress[3 * i + 1], 0.0, stress[3 * i + 2], 0.0, 0.0};
            for (int c = 0; c < 6; c++)
                assert_close(six[6 * i + (hsize_t)c], expected[c], accuracy * fabs(expected[c]));
        }
        const double *size = stored_values(&f->stored, "/VTKHDF/PointData/von_mises", 2 * n, 1, 0) + n;
        for (hsize_t i = 0; i < n; i++) {
            const double expected = dem_stress_von_mises(stress + 3 * i);
            assert_close(size[i], expected, accuracy * expected);
            largest = fmax(largest, expected);
        }
        assert_true(largest > 1e4);
        const double *pair = stored_values(&f->stored, "/VTKHDF/PointData/principal_stress", 2 * n, 2, 0) + 2 * n;
        for (hsize_t i = 0; i < n; i++) {
            double value[2], direction[2];
            dem_stress_principal(stress + 3 * i, value, direction);
            for (int c = 0; c < 2; c++) assert_close(pair[2 * i + (hsize_t)c], value[c], accuracy * fabs(value[c]));
        }
        free(stress);
        put_away(f);
    }
}

/* In the last frame the blocks push each other; the third component is that out of the plane. */
TEST(forces_and_pressures_of_contact_are_those_of_the_simulation)
{
    reader *f = shoot_run(open_blocks, DEM_FIELD_CONTACT, 1);
    const hsize_t n = (hsize_t)f->frames.n_nodes;
    double force[256], pressure[128];
    assert_true(n <= 128);
    assert_true(ask_surfaces(f->run.simulation).pushing > 0);
    assert_ok(dem_simulation_contact_forces(f->run.simulation, force));
    assert_ok(dem_simulation_contact_pressures(f->run.simulation, pressure));
    const double *three = stored_values(&f->stored, "/VTKHDF/PointData/contact_force", 2 * n, 3, 8);
    for (hsize_t k = 0; k < 3 * n; k++) assert_close(three[k], 0.0, 0.0); /* at the start nothing touches */
    for (hsize_t i = 0; i < n; i++) {
        for (hsize_t c = 0; c < 2; c++) assert_close(three[3 * (n + i) + c], force[2 * i + c], 0.0);
        assert_close(three[3 * (n + i) + 2], 0.0, 0.0);
    }
    const double *shown = stored_values(&f->stored, "/VTKHDF/PointData/contact_pressure", 2 * n, 1, 8) + n;
    for (hsize_t i = 0; i < n; i++) assert_close(shown[i], pressure[i], 0.0);
    put_away(f);
}

TEST(forces_are_stiffness_times_strain)
{
    reader *f = shoot(DEM_FIELD_ALL, 1);
    const hsize_t m = (hsize_t)f->frames.n_springs;
    double strain[STORED_VALUES];
    memcpy(strain, stored_values(&f->stored, "/VTKHDF/CellData/strain", 2 * m, 1, 8), 2 * m * sizeof *strain);
    const double *force = stored_values(&f->stored, "/VTKHDF/CellData/force", 2 * m, 1, 8);
    for (hsize_t k = 0; k < 2 * m; k++)
        assert_close(force[k], strain[k] * dem_model_lattice(f->run.model)->stiffness[k % m], 1e-15 * fabs(force[k]));
    put_away(f);
}

TEST(a_constant_is_in_all_frames)
{
    const frames_constant constants[2] = {{"PointData", "peak", HDF5_F64, 2}, {"CellData", "time", HDF5_F32, 1}};
    reader *f = shoot(0, 0);
    const hsize_t n = (hsize_t)f->frames.n_nodes, m = (hsize_t)f->frames.n_springs;
    double value[STORED_VALUES];
    for (hsize_t k = 0; k < 2 * n || k < m; k++) value[k] = (double)k;
    for (int c = 0; c < 2; c++) {
        char name[FRAMES_NAME];
        hdf5_rows rows;
        assert_ok(frames_create_constant(&f->frames, &f->stored.file, &constants[c], &rows, name));
        assert_ok(hdf5_append(&f->stored.file, &rows, 0, c == 0 ? n : m, value));
    }
    assert_close(stored_values(&f->stored, "/VTKHDF/PointData/peak", n, 2, 8)[2 * n - 1], (double)(2 * n - 1), 0.0);
    assert_close(stored_values(&f->stored, "/VTKHDF/CellData/time", m, 1, 4)[m - 1], (double)(m - 1), 0.0);
    const double *offset = stored_values(&f->stored, "/VTKHDF/Steps/PointDataOffsets/peak", 2, 1, 8);
    assert_true(offset[0] == 0.0 && offset[1] == 0.0);
    offset = stored_values(&f->stored, "/VTKHDF/Steps/CellDataOffsets/time", 2, 1, 8);
    assert_true(offset[0] == 0.0 && offset[1] == 0.0);
    put_away(f);
}
