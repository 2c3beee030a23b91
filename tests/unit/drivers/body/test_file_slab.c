/* SPDX-License-Identifier: BSD-3-Clause */
/* file_slab.c: which slabs are plain, each fault for itself, in the slab that has it and in no other; and springs of
 * strips. Slabs of a block of rows stand for those of files. */
#include "file_slab.h"

#include "harness/test.h"
#include "unit/close.h"

#include <stdlib.h>
#include <string.h>

enum { PARTS = 3 };

static const dem_material rubber = {
    .struct_size = sizeof rubber, .youngs_modulus = 1e7, .poissons_ratio = 0.3, .density = 1000.0, .thickness = 1.0};

/* With a body and positions at rest, and the flags of the boundary of the whole. */
static dem_slab make_slab(dem_index part)
{
    dem_slab s = dem_slab_empty();
    assert_int_equal(dem_slab_rectangle(&s, 0.1, 0.1, 0.01, part, PARTS), DEM_OK);
    dem_lattice *l = &s.lattice;
    const size_t n = (size_t)l->n_nodes;
    assert_int_equal(dem_lattice_assemble(l, &rubber), DEM_OK);
    l->body = calloc(n, sizeof *l->body);
    l->position = malloc(2 * n * sizeof *l->position);
    l->coupling = calloc(3 * (size_t)l->n_triangles, sizeof *l->coupling);
    assert_true(l->body != NULL && l->position != NULL && l->coupling != NULL);
    memcpy(l->position, l->x, 2 * n * sizeof *l->position);
    assert_int_equal(dem_lattice_exclude(l, NULL, 0), DEM_OK);
    return s;
}

/* A node inside. */
static dem_index inner(const dem_slab *s)
{
    return s->first_own + 3;
}

static void add_body(dem_slab *s)
{
    s->lattice.body[inner(s)] = 1;
}

static void move(dem_slab *s)
{
    s->lattice.position[2 * inner(s) + 1] += 1e-12;
}

static void fix(dem_slab *s)
{
    s->lattice.flags[inner(s)] |= DEM_NODE_FIXED;
}

static void exclude(dem_slab *s)
{
    s->lattice.flags[s->first_own] = 0; /* at the end of a row */
}

static void include(dem_slab *s)
{
    s->lattice.flags[inner(s)] = DEM_NODE_CONTACT;
}

static void forget_thickness(dem_slab *s)
{
    free(s->lattice.thickness);
    s->lattice.thickness = NULL;
}

static double *limits(dem_index n)
{
    double *all = calloc((size_t)n, sizeof *all);
    assert_non_null(all);
    for (dem_index k = 0; k < n; k++) all[k] = 1e5;
    return all;
}

static void limit_stress(dem_slab *s)
{
    s->lattice.strength = limits(s->lattice.n_triangles);
}

static void limit_stretch(dem_slab *s)
{
    s->lattice.critical_stretch = limits(s->lattice.n_springs);
}

static void slacken(dem_slab *s)
{
    s->lattice.stiffness[s->lattice.n_springs / 2] = 0.0;
}

static void overturn(dem_slab *s)
{
    dem_index *corner = s->lattice.triangles + 3 * (s->lattice.n_triangles / 2), kept = corner[0];
    corner[0] = corner[1];
    corner[1] = kept;
}

/* Which needs springs that are between nodes of the rim, too. */
static void couple(dem_slab *s)
{
    for (dem_index k = 0; k < 3 * s->lattice.n_triangles; k++) s->lattice.coupling[k] = 1e3;
}

static void spoil_coupling(dem_slab *s)
{
    s->lattice.coupling[3 * (s->lattice.n_triangles / 2)] = (double)NAN;
}

/* Without the triangles at a node, whose springs stay. */
static void bare(dem_slab *s)
{
    dem_lattice *l = &s->lattice;
    const dem_index node = inner(s);
    dem_index n = 0;
    for (dem_index t = 0; t < l->n_triangles; t++) {
        const dem_index *corner = l->triangles + 3 * t;
        if (corner[0] == node || corner[1] == node || corner[2] == node) continue;
        memmove(l->triangles + 3 * n++, corner, 3 * sizeof *corner);
    }
    l->n_triangles = n;
    free(l->flags);
    l->flags = NULL;
}

TEST(slabs_of_a_plain_body_are_plain)
{
    for (dem_index part = 0; part < PARTS; part++) {
        CLEANUP(dem_slab_free) dem_slab s = make_slab(part);
        assert_int_equal(file_slab_check(&s), DEM_OK);
        couple(&s);
        assert_int_equal(file_slab_check(&s), DEM_OK);
    }
}

TEST(what_is_not_plain_is_seen_in_the_slab_that_has_it)
{
    static void (*const faults[])(dem_slab *) = {add_body,         move,         fix,           exclude, include,
                                                 forget_thickness, limit_stress, limit_stretch, slacken, overturn,
                                                 spoil_coupling,   bare};
    for (size_t k = 0; k < sizeof faults / sizeof *faults; k++) {
        CLEANUP(dem_slab_free) dem_slab s = make_slab(1);
        faults[k](&s);
        if (file_slab_check(&s) != DEM_ERROR_MODEL) fail_msg("fault %zu is not seen", k);
    }
}

/* Another slab has it, which knows its edges. */
TEST(flags_of_the_rim_are_not_looked_at)
{
    CLEANUP(dem_slab_free) dem_slab s = make_slab(1);
    for (dem_index i = 0; i < s.first_own; i++) s.lattice.flags[i] ^= DEM_NODE_CONTACT;
    assert_int_equal(file_slab_check(&s), DEM_OK);
}

TEST(positions_are_those_of_rest_afterwards)
{
    CLEANUP(dem_slab_free) dem_slab s = make_slab(0);
    file_slab_forget_start(&s);
    assert_null(s.lattice.position);
    file_slab_forget_start(&s);
    assert_int_equal(file_slab_check(&s), DEM_OK);
}

TEST(springs_of_a_strip_have_the_shortest_length)
{
    CLEANUP(dem_lattice_free) dem_lattice strip = dem_lattice_empty();
    dem_model *model;
    assert_int_equal(dem_lattice_rectangle(&strip, 0.05, 0.02, 0.01), DEM_OK);
    assert_int_equal(file_slab_join_strip(&strip, 0.0071), DEM_OK);
    assert_int_equal(dem_model_create(&model, &strip, NULL, 0), DEM_OK);
    assert_close(dem_model_spacing(model), 0.0071, 0.0);
    dem_model_destroy(model);
}
