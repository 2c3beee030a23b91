/* SPDX-License-Identifier: BSD-3-Clause */
/* node_rows.c: what is at each node, against a look at all springs and triangles. */
#include "unit/domain/shared_lattice.h"

#include "lattice/node_rows.h"

static void assert_rows(const node_rows *r, const dem_index *node, int arity, dem_index n, dem_index n_nodes)
{
    for (dem_index i = 0; i < n_nodes; i++) {
        dem_index p = r->row[i];
        for (dem_index k = 0; k < arity * n; k++)
            if (node[k] == i) assert_int_equal(r->list[p++], k / arity);
        assert_int_equal(p, r->row[i + 1]);
    }
}

TEST(each_spring_and_triangle_is_at_its_nodes)
{
    CLEANUP(dem_lattice_free) dem_lattice l = shared_disc();
    CLEANUP(node_rows_free) node_rows springs, triangles;
    assert_ok(node_rows_create(&springs, l.ends, 2, l.n_springs, l.n_nodes));
    assert_rows(&springs, l.ends, 2, l.n_springs, l.n_nodes);
    assert_ok(node_rows_create(&triangles, l.triangles, 3, l.n_triangles, l.n_nodes));
    assert_rows(&triangles, l.triangles, 3, l.n_triangles, l.n_nodes);
}

/* Neither the first nor the last node has anything. */
TEST(nodes_without_anything_have_empty_rows)
{
    const dem_index ends[] = {3, 1};
    CLEANUP(node_rows_free) node_rows rows;
    assert_ok(node_rows_create(&rows, ends, 2, 1, 5));
    assert_rows(&rows, ends, 2, 1, 5);
    assert_int_equal(rows.row[5], 2);
}
