/* SPDX-License-Identifier: BSD-3-Clause */
/* The slabs of a lattice are what the whole has at their nodes, to the bit, and each node is one slab's own: random
 * rectangles of triangles and squares, jittered or not, in 1 to 9 parts, as they are made and as solids.
 * `test_slabs [CASES [FIRST_SEED]]`. */
#include "verification/support.h"

#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_rng.h>

#include "harness/cleanup.h"
#include "harness/cleanup_gsl.h"
#include "lattice/lattice_arrays.h"

static long n_cases = 20000, first_seed = 1;

/* ---- cases ---- */

typedef struct recipe {
    double width, height, spacing, jitter, diagonal; /* diagonal = 0: triangles */
    uint64_t seed;
    dem_index n_parts;
    dem_material solid;
} recipe;

static recipe draw(gsl_rng *random)
{
    recipe r = {.spacing = 1e-3 * (0.5 + gsl_rng_uniform(random)), .seed = gsl_rng_get(random)};
    const double columns = 1.0 + 9.0 * gsl_rng_uniform(random), rows = 1.0 + 19.0 * gsl_rng_uniform(random);
    r.width = columns * r.spacing;
    r.height = rows * r.spacing;
    r.jitter = gsl_rng_uniform_int(random, 3) > 0 ? 0.3 * gsl_rng_uniform(random) * r.spacing : 0.0;
    r.diagonal = gsl_rng_uniform_int(random, 2) > 0 ? 0.5 : 0.0;
    r.n_parts = 1 + (dem_index)gsl_rng_uniform_int(random, 9);
    r.solid = (dem_material)SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 0.3, .density = 1050.0,
                                  .thickness = 0.1, .guard = 0.02, .damping_time = 1e-6);
    if (r.diagonal == 0.0 && gsl_rng_uniform_int(random, 2) > 0) r.solid.springs = DEM_SPRINGS_COUPLED;
    return r;
}

static void assemble(dem_lattice *l, const recipe *r)
{
    assert_ok(r->diagonal > 0.0 ? dem_lattice_assemble_squares(l, &r->solid, r->diagonal)
                                : dem_lattice_assemble(l, &r->solid));
}

static dem_lattice make_whole(const recipe *r)
{
    dem_lattice l = dem_lattice_empty();
    assert_ok(r->diagonal > 0.0 ? dem_lattice_squares(&l, r->width, r->height, r->spacing)
                                : dem_lattice_rectangle(&l, r->width, r->height, r->spacing));
    assert_ok(dem_lattice_jitter(&l, r->jitter, r->seed));
    return l;
}

/* Of more parts than rows none is made. */
static bool make_slab(dem_slab *s, const recipe *r, dem_index part)
{
    *s = dem_slab_empty();
    const dem_status status = r->diagonal > 0.0
                                  ? dem_slab_squares(s, r->width, r->height, r->spacing, part, r->n_parts)
                                  : dem_slab_rectangle(s, r->width, r->height, r->spacing, part, r->n_parts);
    if (status == DEM_ERROR_MODEL) return false;
    assert_ok(status);
    assert_ok(dem_slab_jitter(s, r->jitter, r->seed));
    return true;
}

static dem_index count_rows(const dem_lattice *l, const recipe *r)
{
    return (dem_index)lround(l->x[2 * l->n_nodes - 1] / (r->diagonal > 0.0 ? r->spacing : sqrt(0.75) * r->spacing)) + 1;
}

/* ---- comparison ---- */

static bool is_own(const dem_slab *s, dem_index number)
{
    const dem_index i = number - s->first_node - s->first_own;
    return i >= 0 && i < s->n_own;
}

static bool any_is_own(const dem_slab *s, const dem_index *number, int n)
{
    bool any = false;
    for (int k = 0; k < n; k++) any = any || is_own(s, number[k]);
    return any;
}

/* One item in all arrays of its kind but those of numbers of nodes. An array that is NULL is one of zeros: no strengths
 * are made here. */
static void assert_same_item(const dem_lattice *whole, dem_index at, const dem_lattice *slab, dem_index k,
                             lattice_items of)
{
    static const char zeros[3 * sizeof(double)] = {0};
    for (int a = 0; a < LATTICE_ARRAYS; a++) {
        const lattice_array *array = &lattice_arrays[a];
        const char *there = lattice_array_of(whole, array), *here = lattice_array_of(slab, array);
        if (array->of != of || (const void *)there == whole->ends || (const void *)there == whole->triangles) continue;
        assert_memory_equal(here != NULL ? here + (size_t)k * array->size : zeros,
                            there != NULL ? there + (size_t)at * array->size : zeros, array->size);
    }
}

static void assert_same_nodes(const dem_lattice *whole, const dem_slab *s, dem_index *next)
{
    const size_t place = 2 * sizeof(double);
    assert_int_equal(s->n_nodes, whole->n_nodes);
    assert_int_equal(s->n_triangles, whole->n_triangles);
    assert_int_equal(s->first_node + s->first_own, *next);
    *next += s->n_own;
    assert_memory_equal(s->lattice.x, whole->x + 2 * s->first_node, (size_t)s->lattice.n_nodes * place);
    for (dem_index i = s->first_own; i < s->first_own + s->n_own; i++)
        assert_same_item(whole, s->first_node + i, &s->lattice, i, LATTICE_NODES);
}

/* All that are at own nodes, in the order of the whole, and no others. */
static void assert_same_triangles(const dem_lattice *whole, const dem_slab *s)
{
    dem_index k = 0;
    for (dem_index t = 0; t < whole->n_triangles; t++) {
        if (!any_is_own(s, whole->triangles + 3 * t, 3)) continue;
        assert_int_equal(t, s->first_triangle + k);
        for (int c = 0; c < 3; c++)
            assert_int_equal(s->lattice.triangles[3 * k + c] + s->first_node, whole->triangles[3 * t + c]);
        assert_same_item(whole, t, &s->lattice, k++, LATTICE_TRIANGLES);
    }
    assert_int_equal(k, s->lattice.n_triangles);
}

/* The next spring of a slab from k on that is at an own node. */
static dem_index next_own(const dem_slab *s, dem_index k)
{
    for (; k < s->lattice.n_springs; k++) {
        const dem_index *end = s->lattice.ends + 2 * k;
        if (any_is_own(s, (const dem_index[]){end[0] + s->first_node, end[1] + s->first_node}, 2)) break;
    }
    return k;
}

static void assert_same_springs(const dem_lattice *whole, const dem_slab *s)
{
    dem_index k = next_own(s, 0);
    for (dem_index w = 0; w < whole->n_springs; w++) {
        if (!any_is_own(s, whole->ends + 2 * w, 2)) continue;
        assert_true(k < s->lattice.n_springs);
        for (int e = 0; e < 2; e++)
            assert_int_equal(s->lattice.ends[2 * k + e] + s->first_node, whole->ends[2 * w + e]);
        assert_same_item(whole, w, &s->lattice, k, LATTICE_SPRINGS);
        k = next_own(s, k + 1);
    }
    assert_int_equal(k, s->lattice.n_springs);
}

/* ---- tests ---- */

static void check(unsigned long seed)
{
    CLEANUP(free_rng) gsl_rng *random = gsl_rng_alloc(gsl_rng_taus);
    gsl_rng_set(random, seed);
    const recipe r = draw(random);
    CLEANUP(dem_lattice_free) dem_lattice whole = make_whole(&r), solid = make_whole(&r);
    dem_index next = 0, next_solid = 0;
    assemble(&solid, &r);
    for (dem_index part = 0; part < r.n_parts; part++) {
        CLEANUP(dem_slab_free) dem_slab s;
        if (!make_slab(&s, &r, part)) {
            assert_true(r.n_parts > count_rows(&whole, &r));
            return;
        }
        assert_same_nodes(&whole, &s, &next);
        assert_same_triangles(&whole, &s);
        assemble(&s.lattice, &r);
        assert_same_nodes(&solid, &s, &next_solid);
        assert_same_triangles(&solid, &s);
        assert_same_springs(&solid, &s);
    }
    assert_int_equal(next, whole.n_nodes);
}

TEST(slabs_are_the_rows_of_the_whole)
{
    for (long k = 0; k < n_cases; k++) check((unsigned long)(first_seed + k));
}

int main(int n_arguments, char **arguments)
{
    if (n_arguments > 1) n_cases = atol(arguments[1]);
    if (n_arguments > 2) first_seed = atol(arguments[2]);
    return test_run();
}
