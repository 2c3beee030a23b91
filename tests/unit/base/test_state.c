/* SPDX-License-Identifier: BSD-3-Clause */
/* state.h: where things stand in a state, in two and in three dimensions. */
#include "verification/support.h"

#include "base/state.h"

enum { dim_most = STATE_DIM_MOST, most_numbers = 1024 };

/* 5 nodes, 3 rows of padding, 3 impulses, 3 of friction, 2 rows of totals: checkpoints of states have them so. */
TEST(two_components_stand_where_checkpoints_have_them)
{
    const state_layout l = state_layout_of(2, 5, 3, false);
    assert_int_equal(l.n_nodes, 5);
    assert_int_equal(l.n_rows, 16);
    assert_int_equal(state_velocities(&l), 32);
    assert_int_equal(state_size(&l), 64);
    assert_int_equal(state_impulse(&l, 0), 8);
    assert_int_equal(state_friction_impulse(&l, 0), 11);
    assert_int_equal(state_total_rows(&l), 14);
    assert_int_equal(state_total_index(&l, STATE_FRICTION), 28);
    assert_int_equal(state_total_index(&l, STATE_DAMPING), 29);
    assert_int_equal(state_total_index(&l, STATE_WORK), 30);
    assert_int_equal(state_total_index(&l, STATE_TIME), 31); /* the last of all */
    assert_false(state_has_total(&l, STATE_OBSTACLE));
}

TEST(velocities_begin_at_a_cache_line_behind_as_few_rows_as_will_do)
{
    const dem_index line = ALIGNED_TO / sizeof(double);
    for (int dim = 2; dim <= dim_most; dim++)
        for (dem_index n = 1; n < 20; n++)
            for (dem_index obstacles = 0; obstacles < 6; obstacles++) {
                const state_layout l = state_layout_of(dim, n, obstacles, n % 2 == 0);
                const dem_index padding = l.n_rows - n - state_n_quadratures(&l);
                assert_int_equal(state_velocities(&l) % line, 0);
                assert_true(padding >= 0 && padding < line);
                for (dem_index less = 1; less <= padding; less++)
                    assert_int_not_equal(dim * (l.n_rows - less) % line, 0);
            }
}

/* Counts what each number of v belongs to. */
static void count_uses(const state_layout *l, int *uses)
{
    for (dem_index i = 0; i < l->n_nodes; i++)
        for (int d = 0; d < l->dim; d++) uses[state_row(l, i) + d]++;
    for (dem_index k = 0; k < l->n_obstacles; k++)
        for (int d = 0; d < l->dim; d++) {
            uses[state_row(l, state_impulse(l, k)) + d]++;
            uses[state_row(l, state_friction_impulse(l, k)) + d]++;
        }
    for (int which = 0; which < l->n_totals; which++) uses[state_total_index(l, (state_total)which)]++;
}

TEST(nothing_shares_its_place)
{
    for (int dim = 2; dim <= dim_most; dim++)
        for (dem_index obstacles = 0; obstacles < 4; obstacles++) {
            const state_layout l = state_layout_of(dim, 7, obstacles, obstacles > 1);
            int uses[most_numbers] = {0};
            dem_index n = 0;
            assert_true(state_size(&l) <= most_numbers);
            count_uses(&l, uses);
            for (dem_index k = 0; k < state_velocities(&l); k++) {
                assert_true(uses[k] <= 1);
                n += uses[k];
            }
            assert_int_equal(n, dim * (7 + 2 * obstacles) + l.n_totals);
        }
}

/* Numbers that are their indices. */
TEST(values_are_those_at_their_indices)
{
    for (int dim = 2; dim <= dim_most; dim++) {
        const state_layout l = state_layout_of(dim, 7, 2, false);
        double y[most_numbers];
        for (dem_index k = 0; k < state_size(&l); k++) y[k] = (double)k;
        assert_close(state_x(&l, y, 3)[dim - 1], 4.0 * dim - 1.0, 0.0);
        assert_close(state_v(&l, y, 3)[0], (double)(dim * (l.n_rows + 3)), 0.0);
        assert_close(state_v(&l, y, 0)[state_total_index(&l, STATE_WORK)], state_total_of(&l, y, STATE_WORK), 0.0);
        assert_close(state_time(&l, y), state_total_of(&l, y, STATE_WORK) + 1.0, 0.0);
        assert_true(state_time(&l, y) >= (double)(state_size(&l) - dim)); /* in the last row */
    }
}
