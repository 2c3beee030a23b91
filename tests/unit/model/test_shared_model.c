/* SPDX-License-Identifier: BSD-3-Clause */
/* shared_model.c: ranks that have the same lattice share it, and no others. */
#include "unit/domain/shared_lattice.h"

#include <string.h>

#include "harness/rank_threads.h"
#include "model/shared_model.h"

enum { N_RANKS = 4, TEXT = 200 };

/* Changes what a rank has of the lattice. */
typedef void change(dem_lattice *l);

typedef struct sharing {
    change *change;         /* on the last rank; NULL: none */
    dem_index own[N_RANKS]; /* nodes */
    dem_status status[N_RANKS];
    char messages[N_RANKS][TEXT];
} sharing;

static void count_end(void *self)
{
    ++*(dem_index *)self;
}

static void count_own(sharing *s, const dem_model *m)
{
    dem_index n;
    const dem_index *number;
    const unsigned char *is_own;
    const int rank = m->ranks->rank;
    s->status[rank] = dem_model_part(m, &n, &number, &is_own);
    for (dem_index i = 0; i < n; i++) s->own[rank] += is_own[i];
}

static void share(const ranks *r, void *context)
{
    sharing *s = context;
    dem_model *model = NULL;
    dem_lattice l = shared_disc();
    if (s->change != NULL && r->rank == N_RANKS - 1) s->change(&l);
    const dem_private_whole whole = {.lattice = &l};
    s->status[r->rank] = dem_private_share_model(&model, &whole, r);
    if (s->status[r->rank] != DEM_OK) (void)strncpy(s->messages[r->rank], dem_status_message(), TEXT - 1);
    if (model != NULL) count_own(s, model);
    dem_model_destroy(model);
    dem_lattice_free(&l);
}

TEST(every_node_is_shared_out_once)
{
    CLEANUP(dem_lattice_free) dem_lattice l = shared_disc();
    sharing s = {0};
    dem_index all = 0;
    rank_threads_run(N_RANKS, share, &s);
    for (int k = 0; k < N_RANKS; k++) {
        assert_int_equal(s.status[k], DEM_OK);
        assert_in_range(s.own[k], l.n_nodes / N_RANKS, l.n_nodes / N_RANKS + 1);
        all += s.own[k];
    }
    assert_int_equal(all, l.n_nodes);
}

static void assert_refused(change *how, dem_status status, const char *message)
{
    sharing s = {.change = how};
    rank_threads_run(N_RANKS, share, &s);
    for (int k = 0; k < N_RANKS; k++) {
        assert_int_equal(s.status[k], status);
        assert_string_equal(s.messages[k], message);
    }
}

static void measure_constants(const ranks *r, void *context)
{
    sharing *s = context;
    dem_constants c = SIZED(dem_constants, .youngs_modulus = 7.0);
    CLEANUP(free_model) dem_model *model = NULL;
    CLEANUP(dem_lattice_free) dem_lattice l = shared_disc();
    if (dem_private_share_model(&model, &(dem_private_whole){.lattice = &l}, r) != DEM_OK) return;
    s->status[r->rank] = dem_model_constants(model, 0, &c);
    s->own[r->rank] = c.youngs_modulus != 7.0;
}

/* A part has another boundary than the whole. */
TEST(constants_of_parts_are_refused)
{
    sharing several = {0}, one = {0};
    rank_threads_run(N_RANKS, measure_constants, &several);
    rank_threads_run(1, measure_constants, &one);
    for (int k = 0; k < N_RANKS; k++) {
        assert_int_equal(several.status[k], DEM_ERROR_ARGUMENT);
        assert_int_equal(several.own[k], 0);
    }
    assert_int_equal(one.status[0], DEM_OK);
    assert_int_equal(one.own[0], 1);
}

static void nudge(dem_lattice *l)
{
    l->rest_length[1] = nextafter(l->rest_length[1], 1.0);
}

static void turn_round(dem_lattice *l)
{
    const dem_index first = l->triangles[0];
    memmove(l->triangles, l->triangles + 1, 2 * sizeof first);
    l->triangles[2] = first;
}

static void fix(dem_lattice *l)
{
    l->flags = calloc((size_t)l->n_nodes, 1);
    l->flags[l->n_nodes - 1] = DEM_NODE_FIXED;
}

static void strengthen(dem_lattice *l)
{
    l->strength = malloc((size_t)l->n_triangles * sizeof *l->strength);
    for (dem_index k = 0; k < l->n_triangles; k++) l->strength[k] = 1e5;
}

static void take_mass(dem_lattice *l)
{
    l->mass[2] = 0.0;
}

TEST(other_lattices_on_one_rank_are_refused_by_all)
{
    const char *differ = "the lattices or obstacles of the 4 ranks differ";
    assert_refused(nudge, DEM_ERROR_ARGUMENT, differ);
    assert_refused(turn_round, DEM_ERROR_ARGUMENT, differ);
    assert_refused(fix, DEM_ERROR_ARGUMENT, differ);
    assert_refused(strengthen, DEM_ERROR_ARGUMENT, differ);
    assert_refused(take_mass, DEM_ERROR_MODEL, "node 2: mass must be > 0, got 0 kg");
}

/* A process alone has a table, whose end is that of the model; after a failure there is none. */
TEST(ranks_end_with_their_model)
{
    dem_index ends = 0;
    CLEANUP(dem_lattice_free) dem_lattice l = shared_disc();
    const dem_private_whole whole = {.lattice = &l}, nothing = {.lattice = NULL};
    ranks table = ranks_alone;
    table.self = &ends;
    table.end = count_end;
    dem_model *model = NULL;
    assert_int_equal(dem_private_share_model(&model, &nothing, &table), DEM_ERROR_ARGUMENT);
    assert_int_equal(ends, 0);
    assert_ok(dem_private_share_model(&model, &whole, &table));
    assert_int_equal(ends, 0);
    dem_model_destroy(model);
    assert_int_equal(ends, 1);
}

/* One body, or two. */
static bool has_surfaces(int n_bodies, dem_private_touching touching)
{
    CLEANUP(dem_lattice_free) dem_lattice l = shared_disc();
    CLEANUP(dem_lattice_free) dem_lattice other = shared_disc();
    dem_lattice_move(&other, 0.0, (const double[2]){0.1, 0.0});
    if (n_bodies > 1) assert_ok(dem_lattice_append(&l, &other));
    dem_model *model = NULL;
    assert_ok(dem_private_share_model(&model, &(dem_private_whole){.lattice = &l, .touching = touching}, &ranks_alone));
    const bool has = model->touching != NULL;
    dem_model_destroy(model);
    return has;
}

TEST(surfaces_are_shared_where_bodies_may_touch)
{
    for (int n = 1; n <= 2; n++) {
        assert_int_equal(has_surfaces(n, DEM_PRIVATE_TOUCHING_UNKNOWN), n == 2);
        assert_false(has_surfaces(n, DEM_PRIVATE_TOUCHING_NONE));
        assert_true(has_surfaces(n, DEM_PRIVATE_TOUCHING_SOME));
    }
}

TEST(a_process_alone_has_all_nodes)
{
    CLEANUP(dem_lattice_free) dem_lattice l = shared_disc();
    CLEANUP(free_model) dem_model *model = support_model(&l, NULL, 0);
    dem_index n;
    const dem_index *number = &n;
    const unsigned char *is_own = (const unsigned char *)&n;
    assert_int_equal(dem_model_part(model, &n, &number, NULL), DEM_ERROR_ARGUMENT);
    assert_ok(dem_model_part(model, &n, &number, &is_own));
    assert_int_equal(n, l.n_nodes);
    assert_null(number);
    assert_null(is_own);
}
