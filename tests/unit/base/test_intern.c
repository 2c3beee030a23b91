/* SPDX-License-Identifier: BSD-3-Clause */
/* intern.c: what was put in is found again, once; beside a list of lists that is searched from its start. */
#include "unit/close.h"

#include <gsl/gsl_rng.h>
#include <string.h>

#include "base/aligned.h"
#include "base/intern.h"
#include "harness/cleanup_gsl.h"

enum { most = 5, n_lists = 3000 };

typedef struct pair {
    int64_t a, b;
} pair;

typedef struct kept {
    pair items[most];
    dem_index n;
    intern_span span;
} kept;

static kept lists[n_lists];

/* Few enough values that lists recur, and that some begin as others do. */
static kept draw(gsl_rng *r)
{
    kept list = {.n = (dem_index)gsl_rng_uniform_int(r, most + 1)};
    for (dem_index k = 0; k < list.n; k++)
        list.items[k] = (pair){(int64_t)gsl_rng_uniform_int(r, 3), (int64_t)gsl_rng_uniform_int(r, 2)};
    return list;
}

static const kept *search(const kept *list, int n)
{
    for (int k = 0; k < n; k++)
        if (lists[k].n == list->n && memcmp(lists[k].items, list->items, (size_t)list->n * sizeof(pair)) == 0)
            return &lists[k];
    return NULL;
}

static void assert_holds(const intern *p, const kept *list)
{
    const pair *items = p->items;
    assert_int_equal(list->span.end - list->span.first, list->n);
    assert_in_range(list->span.end, 0, p->n);
    if (list->n > 0) assert_memory_equal(items + list->span.first, list->items, (size_t)list->n * sizeof(pair));
}

TEST(a_list_is_held_once)
{
    CLEANUP(free_rng) gsl_rng *r = gsl_rng_alloc(gsl_rng_mt19937);
    intern p = {.unit = sizeof(pair)};
    dem_index n_items = 0;
    for (int k = 0; k < n_lists; k++) {
        kept list = draw(r);
        const kept *known = search(&list, k);
        assert_int_equal(intern_find(&p, list.items, list.n, &list.span), DEM_OK);
        if (known == NULL)
            n_items += list.n;
        else
            assert_memory_equal(&list.span, &known->span, sizeof list.span);
        lists[k] = list;
        assert_int_equal(p.n, n_items);
    }
    for (int k = 0; k < n_lists; k++) assert_holds(&p, &lists[k]);
    assert_int_equal(intern_settle(&p), DEM_OK);
    assert_int_equal(p.n, n_items);
    assert_int_equal((uintptr_t)p.items % ALIGNED_TO, 0);
    for (int k = 0; k < n_lists; k++) assert_holds(&p, &lists[k]);
    intern_free(&p);
    assert_null(p.items);
}

/* 0.0 and -0.0 are equal numbers, but not the same. */
TEST(lists_are_distinguished_by_their_bits)
{
    const double plus = 0.0, minus = -0.0;
    CLEANUP(intern_free) intern p = {.unit = sizeof(double)};
    intern_span a, b, none;
    assert_int_equal(intern_find(&p, &plus, 1, &a), DEM_OK);
    assert_int_equal(intern_find(&p, &minus, 1, &b), DEM_OK);
    assert_int_equal(intern_find(&p, NULL, 0, &none), DEM_OK);
    assert_int_not_equal(a.first, b.first);
    assert_int_equal(none.first, none.end);
}

TEST(an_empty_pool_settles)
{
    CLEANUP(intern_free) intern p = {.unit = sizeof(double)};
    assert_int_equal(intern_settle(&p), DEM_OK);
    assert_int_equal(p.n, 0);
}
