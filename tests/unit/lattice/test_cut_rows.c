/* SPDX-License-Identifier: BSD-3-Clause */
/* cut_rows.c: which rows a slab has where some of them are empty, and what is refused; tests/property/test_slabs.c
 * compares slabs of shapes with the whole. */
#include "unit/solids.h"

#include "harness/message.h"
#include "lattice/cut_rows.h"

/* A band of rows that goes. */
typedef struct band {
    double low, high; /* m: nodes between them go, */
    dem_status status;
    int calls; /* and so often it has been asked */
} band;

static dem_status mark(void *context, const cut_range *range, dem_lattice *rows, bool *keep)
{
    band *b = context;
    (void)range;
    b->calls++;
    for (dem_index k = 0; k < 3 * rows->n_triangles; k++) {
        const double y = rows->x[2 * rows->triangles[k] + 1];
        if (y > b->low && y < b->high) keep[k / 3] = false;
    }
    return b->status;
}

/* Square cells of 1 m: 11 nodes in each of rows 0 to 20. */
static cut_rows make_rows(band *b)
{
    cut_rows c = {.mark = mark, .context = b, .height = 1};
    assert_int_equal(grid_of_squares(&c.whole, 10.0, 20.0, 1.0), DEM_OK);
    return c;
}

/* Rows 0 to 5 and 12 to 20 are left. */
static void expect_rows(dem_index part, dem_index n_parts, dem_index first, dem_index n)
{
    band b = {.low = 5.5, .high = 11.5};
    const cut_rows c = make_rows(&b);
    CLEANUP(dem_slab_free) dem_slab s = dem_slab_empty();
    assert_int_equal(cut_rows_slab(&s, &c, part, n_parts), DEM_OK);
    assert_int_equal(s.n_nodes, 15 * 11);
    assert_int_equal(s.n_triangles, (5 + 8) * 20);
    assert_int_equal(s.first_node, first * 11);
    assert_int_equal(s.n_own, n * 11);
    for (dem_index i = 0; i < s.n_own; i++) {
        const dem_index row = first + i / 11;
        assert_close(s.lattice.x[2 * (s.first_own + i) + 1], (double)(row < 6 ? row : row + 6), 0.0);
    }
}

TEST(each_slab_has_its_share_of_the_nodes_that_are_left)
{
    expect_rows(0, 1, 0, 15);
    expect_rows(0, 3, 0, 5);
    expect_rows(1, 3, 5, 5); /* on both sides of the band */
    expect_rows(2, 3, 10, 5);
    expect_rows(0, 2, 0, 8);
    expect_rows(1, 2, 8, 7);
    for (dem_index part = 0; part < 15; part++) expect_rows(part, 15, part, 1);
}

/* The row below the band has no triangle above, and the one above none below. */
TEST(rows_beside_a_band_have_no_rim_there)
{
    band b = {.low = 5.5, .high = 11.5};
    const cut_rows c = make_rows(&b);
    CLEANUP(dem_slab_free) dem_slab below = dem_slab_empty(), above = dem_slab_empty();
    assert_int_equal(cut_rows_slab(&below, &c, 5, 15), DEM_OK);
    assert_int_equal(cut_rows_slab(&above, &c, 6, 15), DEM_OK);
    assert_int_equal(below.lattice.n_nodes, 22);
    assert_int_equal(below.first_own, 11);
    assert_int_equal(below.first_triangle, 4 * 20);
    assert_int_equal(above.lattice.n_nodes, 22);
    assert_int_equal(above.first_own, 0);
    assert_int_equal(above.first_triangle, 5 * 20);
    assert_int_equal(above.rim[0], 7 * 11);
}

static void expect_refusal(band b, dem_index n_parts, dem_status status, const char *message)
{
    const cut_rows c = make_rows(&b);
    CLEANUP(dem_slab_free) dem_slab s = dem_slab_empty();
    assert_int_equal(cut_rows_slab(&s, &c, 0, n_parts), status);
    if (message != NULL) assert_message_parts(message);
    assert_int_equal(s.n_own, 0);
    assert_true(s.lattice.x == NULL && s.rim == NULL && b.calls > 0);
}

TEST(slabs_of_what_is_not_left_are_refused)
{
    expect_refusal((band){.low = 5.5, .high = 11.5}, 16, DEM_ERROR_MODEL, "15 rows * 16 slabs");
    expect_refusal((band){.low = -1.0, .high = 21.0}, 1, DEM_ERROR_MODEL, "none of 231 nodes");
    expect_refusal((band){.status = DEM_ERROR_MEMORY}, 1, DEM_ERROR_MEMORY, NULL);
}
