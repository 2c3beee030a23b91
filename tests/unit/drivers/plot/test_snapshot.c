/* SPDX-License-Identifier: BSD-3-Clause */
/* snapshot.c: a frame as it is drawn. */
#include "unit/drivers/plot/trajectory_fixture.h"

#include "digest.h"
#include "snapshot.h"

static void load(snapshot *s, const trajectory_fixture *f, const quantity *q, dem_index frame)
{
    outcome o = {0};
    assert_true(snapshot_create(s, f->reader, q, &o));
    assert_true(snapshot_load(s, frame, &o));
}

static quantity find(const trajectory_fixture *f, const char *name)
{
    quantity q;
    outcome o = {0};
    assert_true(quantity_find(&q, f->reader, name, &o));
    return q;
}

TEST(places_and_bounds_are_those_of_the_frame)
{
    trajectory_fixture *f = *test_state;
    const quantity q = find(f, "strain");
    CLEANUP(snapshot_free) snapshot s;
    load(&s, f, &q, 3);
    const dem_index n = s.lattice->n_nodes;
    CLEANUP(free_memory) double *x = malloc(2 * (size_t)n * sizeof *x);
    trajectory_fixture_ok(dem_reader_positions(f->reader, 3, x));
    assert_memory_equal(s.x, x, 2 * (size_t)n * sizeof *x);
    assert_close(s.t, 6e-4, 1e-15);
    for (dem_index k = 0; k < n; k++) {
        assert_true(s.bounds.x0 <= x[2 * k] && x[2 * k] <= s.bounds.x1);
        assert_true(s.bounds.y0 <= x[2 * k + 1] && x[2 * k + 1] <= s.bounds.y1);
        assert_int_equal(s.is_bare[k], k == n - 1);
    }
    assert_close(snapshot_spacing(&s), 4e-3, 1e-12);
}

/* A number of nodes gives springs and triangles their means. */
TEST(nodes_lend_their_numbers)
{
    trajectory_fixture *f = *test_state;
    const quantity q = find(f, "von_mises"), none = find(f, "none");
    CLEANUP(snapshot_free) snapshot s;
    load(&s, f, &q, TRAJECTORY_FIXTURE_FRAMES - 1);
    const dem_index *ends = s.lattice->ends + 2 * 5, *corners = s.lattice->triangles + 3 * 4;
    assert_close(snapshot_spring_value(&s, 5), 0.5 * (s.value[ends[0]] + s.value[ends[1]]), 1e-9);
    const double sum = s.value[corners[0]] + s.value[corners[1]] + s.value[corners[2]];
    assert_close(snapshot_triangle_value(&s, 4), sum / 3.0, 1e-9);
    assert_true(s.reach.usual > 0.0);
    snapshot_free(&s);
    load(&s, f, &none, 0);
    assert_close(snapshot_spring_value(&s, 5), 0.0, 0.0);
}

/* Back and forth: frames do not remember what was loaded before. */
TEST(triangles_are_broken_in_the_frames_in_which_they_were)
{
    static const dem_index frames[] = {2, 3, 0, TRAJECTORY_FIXTURE_FRAMES - 1};
    CLEANUP(trajectory_fixture_close) trajectory_fixture f = trajectory_fixture_run(true);
    const quantity q = find(&f, "speed");
    CLEANUP(snapshot_free) snapshot s;
    load(&s, &f, &q, 1);
    for (size_t k = 0; k < sizeof frames / sizeof frames[0]; k++) {
        outcome o = {0};
        assert_true(snapshot_load(&s, frames[k], &o));
        for (dem_index n = 0; n < s.lattice->n_triangles; n++)
            assert_int_equal(s.broken_triangles[n], frames[k] > 2 && n < TRAJECTORY_FIXTURE_BROKEN);
    }
}

static uint64_t hash_of(const trajectory_fixture *f, const char *name, dem_index frame)
{
    const quantity q = find(f, name);
    CLEANUP(snapshot_free) snapshot s;
    load(&s, f, &q, frame);
    const uint64_t hash = snapshot_hash(&s, DIGEST_BEGIN);
    return hash;
}

TEST(hashes_tell_frames_and_quantities)
{
    trajectory_fixture *f = *test_state;
    assert_true(hash_of(f, "strain", 2) == hash_of(f, "strain", 2));
    assert_true(hash_of(f, "strain", 2) != hash_of(f, "strain", 3));
    assert_true(hash_of(f, "strain", 2) != hash_of(f, "force", 2));
}

TEST(hashes_tell_what_is_broken)
{
    trajectory_fixture *f = *test_state;
    const quantity q = find(f, "speed");
    CLEANUP(snapshot_free) snapshot s;
    load(&s, f, &q, 3);
    const uint64_t whole = snapshot_hash(&s, DIGEST_BEGIN);
    s.broken_triangles[5] = 1;
    const uint64_t one = snapshot_hash(&s, DIGEST_BEGIN);
    s.broken_triangles[5] = 0, s.broken_triangles[6] = 1;
    assert_true(whole != one && one != snapshot_hash(&s, DIGEST_BEGIN));
    s.broken_triangles[6] = 0, s.broken_springs[5] = 1.0;
    assert_true(whole != snapshot_hash(&s, DIGEST_BEGIN));
}

TEST(a_frame_that_is_not_there_is_refused)
{
    trajectory_fixture *f = *test_state;
    const quantity q = find(f, "strain");
    CLEANUP(snapshot_free) snapshot s;
    outcome o = {0};
    load(&s, f, &q, 0);
    assert_false(snapshot_load(&s, TRAJECTORY_FIXTURE_FRAMES, &o));
    assert_int_equal(o.code, EXIT_INVALID);
}

TEST_GROUP(trajectory_fixture_begin, trajectory_fixture_end);
