/* SPDX-License-Identifier: BSD-3-Clause */
/* lattice_source.c: arrays of a lattice that is here, of more items than a piece has. Those that ranks have are in
 * test_shared_slabs.c. */
#include "verification/support.h"

#include <stddef.h>
#include <stdlib.h>

#include "lattice/lattice_source.h"

enum { MANY = 150001 };

typedef struct seen {
    dem_index n, n_calls;
    bool is_next;
    dem_index fails_at;
} seen;

static dem_status take(void *context, dem_index first, dem_index n, const void *items)
{
    seen *s = context;
    const double *mass = items;
    s->is_next = s->is_next && first == s->n && n <= ROWS_CHUNK;
    for (dem_index k = 0; k < n; k++) s->is_next = s->is_next && mass[k] == 1.0 / (double)(1 + first + k);
    s->n += n;
    return ++s->n_calls == s->fails_at ? DEM_ERROR_IO : DEM_OK;
}

static double *make_masses(void)
{
    double *mass = malloc(MANY * sizeof *mass);
    for (dem_index k = 0; k < MANY; k++) mass[k] = 1.0 / (double)(1 + k);
    return mass;
}

TEST(all_items_come_in_their_order)
{
    CLEANUP(free_memory) double *mass = make_masses();
    dem_lattice l = dem_lattice_empty();
    const lattice_source from = {.lattice = &l};
    seen s = {.is_next = true};
    l.n_nodes = MANY;
    l.mass = mass;
    assert_ok(dem_private_lattice_visit(&from, offsetof(dem_lattice, mass), take, &s));
    assert_true(s.is_next);
    assert_int_equal(s.n, MANY);
    assert_int_equal(s.n_calls, 3);
    s = (seen){.is_next = true, .fails_at = 2};
    assert_int_equal(dem_private_lattice_visit(&from, offsetof(dem_lattice, mass), take, &s), DEM_ERROR_IO);
    assert_int_equal(s.n_calls, 2);
}

TEST(items_are_picked_in_any_order)
{
    CLEANUP(free_memory) double *mass = make_masses();
    dem_lattice l = dem_lattice_empty();
    const lattice_source from = {.lattice = &l};
    const dem_index list[] = {MANY - 1, 0, 65536, 0};
    double out[4];
    l.n_nodes = MANY;
    l.mass = mass;
    assert_ok(dem_private_lattice_pick(&from, offsetof(dem_lattice, mass), list, 4, out));
    for (int k = 0; k < 4; k++) assert_true(out[k] == mass[list[k]]);
}

TEST(what_is_not_there_gives_nothing)
{
    dem_lattice l = dem_lattice_empty();
    const lattice_source from = {.lattice = &l};
    seen s = {.is_next = true};
    l.n_nodes = 3;
    assert_false(dem_private_lattice_has(&from, offsetof(dem_lattice, mass)));
    assert_ok(dem_private_lattice_visit(&from, offsetof(dem_lattice, mass), take, &s));
    assert_int_equal(s.n_calls, 0);
}
