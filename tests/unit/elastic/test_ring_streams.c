/* SPDX-License-Identifier: BSD-3-Clause */
/* ring_streams.c: which stream a block gets, and where in it a force is. */
#include "unit/close.h"

#include "elastic/ring_streams.h"

static int32_t find(ring_streams *r, int64_t key, dem_index block)
{
    int32_t start = -1;
    assert_int_equal(ring_streams_find(r, key, block, &start), DEM_OK);
    return start;
}

/* A stream has 16 rows, and the first eight of them again. */
TEST(blocks_that_do_the_same_use_the_same_streams)
{
    CLEANUP(ring_streams_free) ring_streams r = {.rows = 16};
    for (dem_index block = 0; block < 4; block++) {
        assert_int_equal(find(&r, 5, block), 0);
        assert_int_equal(find(&r, 9, block), 24);
    }
    assert_int_equal(ring_streams_length(&r), 48);
}

TEST(another_key_gets_the_stream_not_used_for_longest)
{
    CLEANUP(ring_streams_free) ring_streams r = {.rows = 16};
    assert_int_equal(find(&r, 1, 0), 0);
    assert_int_equal(find(&r, 2, 0), 24);
    assert_int_equal(find(&r, 1, 1), 0);
    assert_int_equal(find(&r, 3, 2), 24); /* that of 2 */
    assert_int_equal(find(&r, 3, 2), 0);  /* a block writes into a stream once */
    assert_int_equal(find(&r, 3, 2), 48);
}

TEST(a_run_begins_round_the_ring)
{
    const ring_streams r = {.rows = 16};
    assert_int_equal(ring_streams_base(&r, 24 + 9, 4), 24 + 5);
    assert_int_equal(ring_streams_base(&r, 24 + 2, 4), 24 + 14);
}

TEST(more_forces_than_places_have_numbers_are_refused)
{
    CLEANUP(ring_streams_free) ring_streams r = {.rows = (dem_index)1 << 29};
    int32_t start = 0;
    assert_int_equal(find(&r, 1, 0), 0);
    assert_int_equal(ring_streams_find(&r, 2, 0, &start), DEM_ERROR_MODEL);
}
