/* SPDX-License-Identifier: BSD-3-Clause */
/* event_table.c: events made by hand, and what is in the file then. */
#include "verification/support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <unistd.h>

#include "harness/cleanup_hdf5.h"
#include "output/event_table.h"
#include "unit/scratch.h"

static const char *path;

/* An impact of an edge on a slope of 3 in 4 with friction. */
static const dem_event impact = {.t = 0.5,
                                 .kind = DEM_EVENT_IMPACT,
                                 .state = DEM_CONTACT_SLIP,
                                 .node = 7,
                                 .other = 9,
                                 .weight = 0.25,
                                 .obstacle = 1,
                                 .segment = 3,
                                 .x = {1.0, 2.0},
                                 .normal = {-0.6, 0.8},
                                 .impulse = {-3.0, 29.0},
                                 .before = {4.0, -5.0},
                                 .after = {6.0, 7.0},
                                 .energy = 8.0};
static const dem_event release = {.t = 0.75, .kind = DEM_EVENT_RELEASE, .node = 7, .other = -1, .normal = {0.0, 1.0}};

typedef struct stored {
    table table;
    hdf5_file file;
} stored;

static stored begin(void)
{
    stored s;
    assert_ok(event_table_init(&s.table));
    assert_ok(hdf5_open_new(&s.file, path, table_bytes(&s.table)));
    assert_ok(event_table_create(&s.table, &s.file));
    return s;
}

static void end(stored *s)
{
    assert_ok(table_verify(&s->table, &s->file, s->table.written));
    assert_ok(hdf5_close(&s->file, DEM_OK));
    table_free(&s->table);
    assert_int_equal(unlink(path), 0);
}

/* Row `row` of a dataset of two rows, stored as `type`, of n components. */
static void expect(const stored *s, const char *name, hid_t type, hsize_t row, const double *expected, hsize_t n)
{
    char whole[64];
    double value[4];
    hsize_t extent[3] = {0, 1, 1};
    (void)snprintf(whole, sizeof whole, "/events/%s", name);
    CLEANUP(free_h5) const hid_t id = H5Dopen2(s->file.id, whole, H5P_DEFAULT);
    if (id < 0) fail_msg("there is no %s", whole);
    CLEANUP(free_h5) const hid_t stored_type = H5Dget_type(id), space = H5Dget_space(id);
    assert_true(H5Tequal(stored_type, type) > 0);
    assert_int_equal(H5Sget_simple_extent_dims(space, extent, NULL), n > 1 ? 2 : 1);
    assert_int_equal(extent[0], 2);
    assert_int_equal(extent[1], n);
    assert_true(H5Dread(id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) >= 0);
    for (hsize_t k = 0; k < n; k++) assert_close(value[row * n + k], expected[k], 1e-14);
}

static void expect_number(const stored *s, const char *name, hid_t type, hsize_t row, double expected)
{
    expect(s, name, type, row, &expected, 1);
}

static stored two_events(void)
{
    stored s = begin();
    event_table_record(&s.table, &impact);
    event_table_record(&s.table, &release);
    assert_ok(table_flush(&s.table, &s.file));
    return s;
}

TEST(a_row_tells_what_happened_and_where)
{
    CLEANUP(end) stored s = two_events();
    expect_number(&s, "t", H5T_IEEE_F64LE, 0, 0.5);
    expect_number(&s, "kind", H5T_STD_I8LE, 0, 0.0);
    expect_number(&s, "state", H5T_STD_I8LE, 0, 1.0);
    expect_number(&s, "node", H5T_STD_I64LE, 0, 7.0);
    expect_number(&s, "other", H5T_STD_I64LE, 0, 9.0);
    expect_number(&s, "weight", H5T_IEEE_F64LE, 0, 0.25);
    expect_number(&s, "obstacle", H5T_STD_I64LE, 0, 1.0);
    expect_number(&s, "segment", H5T_STD_I64LE, 0, 3.0);
    expect(&s, "x", H5T_IEEE_F64LE, 0, impact.x, 2);
    expect(&s, "normal", H5T_IEEE_F64LE, 0, impact.normal, 2);
    expect(&s, "before", H5T_IEEE_F64LE, 0, impact.before, 2);
    expect(&s, "after", H5T_IEEE_F64LE, 0, impact.after, 2);
    expect_number(&s, "energy", H5T_IEEE_F64LE, 0, 8.0);
}

/* (-3, 29) = 25 (-0.6, 0.8) + 15 (0.8, 0.6) */
TEST(impulses_are_along_the_normal_and_the_tangent)
{
    CLEANUP(end) stored s = two_events();
    expect_number(&s, "normal_impulse", H5T_IEEE_F64LE, 0, 25.0);
    expect_number(&s, "tangential_impulse", H5T_IEEE_F64LE, 0, 15.0);
    expect_number(&s, "normal_impulse", H5T_IEEE_F64LE, 1, 0.0);
    expect_number(&s, "tangential_impulse", H5T_IEEE_F64LE, 1, 0.0);
}

TEST(a_node_alone_has_no_other)
{
    CLEANUP(end) stored s = two_events();
    expect_number(&s, "t", H5T_IEEE_F64LE, 1, 0.75);
    expect_number(&s, "kind", H5T_STD_I8LE, 1, 2.0);
    expect_number(&s, "state", H5T_STD_I8LE, 1, 0.0);
    expect_number(&s, "other", H5T_STD_I64LE, 1, -1.0);
    expect_number(&s, "weight", H5T_IEEE_F64LE, 1, 0.0);
}

/* The code-th word of the attribute `names` of a dataset. */
static void expect_name(const stored *s, const char *name, int code, const char *expected)
{
    char text[64] = "", *word = text;
    const hid_t id = H5Aopen_by_name(s->file.id, name, "names", H5P_DEFAULT, H5P_DEFAULT);
    assert_true(id >= 0);
    const hid_t type = H5Aget_type(id);
    assert_true(H5Tget_size(type) < sizeof text && H5Aread(id, type, text) >= 0);
    (void)H5Tclose(type);
    (void)H5Aclose(id);
    for (int k = 0; k < code; k++) word = strchr(word, ' ') + 1;
    word[strcspn(word, " ")] = '\0';
    assert_string_equal(word, expected);
}

TEST(codes_have_their_names_beside_them)
{
    CLEANUP(end) stored s = two_events();
    expect_name(&s, "/events/kind", DEM_EVENT_IMPACT, "impact");
    expect_name(&s, "/events/kind", DEM_EVENT_CLOSE, "close");
    expect_name(&s, "/events/kind", DEM_EVENT_RELEASE, "release");
    expect_name(&s, "/events/kind", DEM_EVENT_SLIP, "slip");
    expect_name(&s, "/events/kind", DEM_EVENT_STICK, "stick");
    expect_name(&s, "/events/kind", DEM_EVENT_PASS, "pass");
    expect_name(&s, "/events/state", DEM_CONTACT_FREE, "free");
    expect_name(&s, "/events/state", DEM_CONTACT_SLIP, "slip");
    expect_name(&s, "/events/state", DEM_CONTACT_STICK, "stick");
}

SCRATCH_GROUP({&path, "a.h5"});
