/* SPDX-License-Identifier: BSD-3-Clause */
/* overlap.c against every pair of boundary node and triangle. */
#include <stdlib.h>

#include <gsl/gsl_rng.h>

#include "elastic/triangles.h"
#include "harness/cleanup_gsl.h"
#include "lattice/mesh_edges.h"
#include "model/overlap.h"
#include "verification/support.h"

/* Two discs of unit spacing, beside each other. */
static void make_discs(dem_lattice *l, double radius)
{
    CLEANUP(dem_lattice_free) dem_lattice other = dem_lattice_empty();
    assert_ok(dem_lattice_disc(l, radius, 1.0));
    assert_ok(dem_lattice_disc(&other, radius, 1.0));
    dem_lattice_move(&other, 0.0, (const double[2]){2.0 * radius + 1.0, 0.0});
    assert_ok(dem_lattice_append(l, &other));
}

/* Brute force: strictly on the left of all three sides of a triangle that has any area. */
static dem_index count_pairs(const dem_lattice *l, const unsigned char *flags, const double *x)
{
    dem_index n = 0;
    for (dem_index k = 0; k < l->n_triangles; k++)
        for (dem_index i = 0; i < l->n_nodes; i++) {
            const dem_index *c = &l->triangles[3 * k];
            const vec2 p = vec2_at(x, i), a = vec2_at(x, c[0]), b = vec2_at(x, c[1]), d = vec2_at(x, c[2]);
            if (!(flags[i] & DEM_NODE_CONTACT) || i == c[0] || i == c[1] || i == c[2]) continue;
            n += vec2_cross(vec2_sub(b, a), vec2_sub(p, a)) > 1e-8 &&
                 vec2_cross(vec2_sub(d, b), vec2_sub(p, b)) > 1e-8 && vec2_cross(vec2_sub(a, d), vec2_sub(p, d)) > 1e-8;
        }
    return n;
}

/* Looks at 100 random places of the discs, one of them moved by up to `reach` towards the other or off it, every other
 * time with some nodes so far off that their triangles are larger than the cells.
 * \param whole  the triangles that count, with their flags */
static void check_counts(overlap *o, const dem_lattice *l, const dem_lattice *whole, double reach)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    assert_non_null(rng);
    CLEANUP(free_memory) double *x = malloc(2 * (size_t)l->n_nodes * sizeof *x);
    assert_non_null(x);
    dem_index most = 0;
    for (int k = 0; k < 100; k++) {
        const double shift[2] = {reach * (2.0 * gsl_rng_uniform(rng) - 1.0), reach * (gsl_rng_uniform(rng) - 0.5)};
        for (dem_index i = 0; i < l->n_nodes; i++) {
            const double off = k % 2 == 1 && gsl_rng_uniform(rng) < 0.3 ? 8.0 : 0.4;
            for (int c = 0; c < 2; c++)
                x[2 * i + c] =
                    l->x[2 * i + c] + (i < l->n_nodes / 2 ? shift[c] : 0.0) + off * (gsl_rng_uniform(rng) - 0.5);
        }
        const dem_index n = count_pairs(whole, whole->flags, x);
        overlap_look(o, l, (double)k, x);
        assert_int_equal(o->found.now, n);
        most = n > most ? n : most;
        assert_int_equal(o->found.most, most);
    }
    assert_true(most > 10);
}

TEST(every_pair_is_counted)
{
    CLEANUP(dem_lattice_free) dem_lattice l = dem_lattice_empty();
    CLEANUP(overlap_destroy) overlap o;
    make_discs(&l, 3.0);
    assert_ok(dem_lattice_exclude(&l, NULL, 0)); /* fills the flags */
    assert_ok(overlap_create(&o, &l, &ranks_alone, NULL));
    check_counts(&o, &l, &l, 4.0);
}

/* Most triangles are far from all boundary nodes, until the other disc comes. */
TEST(every_pair_is_counted_far_inside_of_bodies)
{
    CLEANUP(dem_lattice_free) dem_lattice l = dem_lattice_empty();
    CLEANUP(overlap_destroy) overlap o;
    make_discs(&l, 9.0);
    assert_ok(dem_lattice_exclude(&l, NULL, 0));
    assert_ok(overlap_create(&o, &l, &ranks_alone, NULL));
    check_counts(&o, &l, &l, 16.0);
}

/* A third of the triangles: nothing is inside them, and the boundary runs round what is left. */
TEST(broken_triangles_do_not_count)
{
    CLEANUP(dem_lattice_free) dem_lattice l = dem_lattice_empty();
    CLEANUP(overlap_destroy) overlap o;
    CLEANUP(mesh_boundary_free) mesh_boundary boundary;
    make_discs(&l, 3.0);
    assert_ok(dem_lattice_exclude(&l, NULL, 0));
    assert_ok(overlap_create(&o, &l, &ranks_alone, NULL));
    CLEANUP(free_memory) unsigned char *broken = calloc((size_t)l.n_triangles, 1);
    assert_non_null(broken);
    for (dem_index k = 0; k < l.n_triangles; k++) broken[k] = k * k % 7 < 3 && k % 2 == 0;
    dem_lattice whole = l;
    CLEANUP(free_memory) dem_index *corners = malloc(3 * (size_t)l.n_triangles * sizeof *corners);
    assert_non_null(corners);
    whole.triangles = corners;
    whole.n_triangles = 0;
    for (dem_index k = 0; k < l.n_triangles; k++)
        if (!broken[k]) memcpy(corners + 3 * whole.n_triangles++, l.triangles + 3 * k, 3 * sizeof *corners);
    assert_ok(mesh_boundary_create(&boundary, &l, broken));
    assert_ok(overlap_reserve(&o, &boundary));
    overlap_break(&o, &boundary, broken);
    assert_ok(mesh_edges_contact_flags(l.flags, &whole));
    check_counts(&o, &l, &whole, 4.0);
}

TEST(the_first_is_kept)
{
    CLEANUP(dem_lattice_free) dem_lattice l = dem_lattice_empty();
    CLEANUP(overlap_destroy) overlap o;
    make_discs(&l, 3.0);
    assert_ok(overlap_create(&o, &l, &ranks_alone, NULL));
    overlap_look(&o, &l, 1.0, l.x);
    assert_int_equal(o.found.now, 0);
    assert_int_equal(o.found.node, -1);
    for (dem_index i = 0; i < l.n_nodes / 2; i++) l.x[2 * i] += 1.7, l.x[2 * i + 1] += 0.1;
    overlap_look(&o, &l, 2.0, l.x);
    const dem_overlap first = o.found;
    assert_true(first.now > 0);
    assert_true(first.node >= 0);
    assert_close(first.t, 2.0, 0.0);
    assert_close(first.x[0], l.x[2 * first.node], 0.0);
    for (dem_index i = 0; i < l.n_nodes / 2; i++) l.x[2 * i] -= 1.7;
    overlap_look(&o, &l, 3.0, l.x);
    assert_int_equal(o.found.now, 0);
    assert_int_equal(o.found.most, first.most);
    assert_int_equal(o.found.node, first.node);
    assert_close(o.found.t, 2.0, 0.0);
}

/* A body turned and moved as a whole does not overlap itself: touching is not inside. */
TEST(a_whole_body_does_not_overlap_itself)
{
    CLEANUP(dem_lattice_free) dem_lattice l = dem_lattice_empty();
    CLEANUP(overlap_destroy) overlap o;
    assert_ok(dem_lattice_rectangle(&l, 5.0, 5.0, 1.0));
    assert_ok(overlap_create(&o, &l, &ranks_alone, NULL));
    for (int k = 0; k < 10; k++) {
        dem_lattice_move(&l, 0.3, (const double[2]){1e3, -7.0});
        overlap_look(&o, &l, 0.0, l.x);
        assert_int_equal(o.found.now, 0);
    }
}
