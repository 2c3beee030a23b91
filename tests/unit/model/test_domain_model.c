/* SPDX-License-Identifier: BSD-3-Clause */
/* domain_model.c, domain_message.c: a rank's model has of its own nodes what the model of the whole has, whether each
 * rank has that one or rank 0 alone. */
#include "unit/domain/shared_lattice.h"

#include <string.h>

#include "harness/rank_threads.h"
#include "model/domain_model.h"
#include "model/whole_lattice.h"
#include "simulation/private.h"

enum { N_RANKS = 5, TEXT = 200 };

/* Ranks work one after the other here, as creating a model is all that they do together. */
typedef struct shared {
    const dem_model *whole;
    const int32_t *owner;
    const unsigned char *is_near; /* [nodes] */
    bool touching, is_sent;       /* whether bodies may touch; whether rank 0 alone has the whole */
    int n_rings;
    dem_model *models[N_RANKS];
    dem_status status[N_RANKS];
    char messages[N_RANKS][TEXT];
} shared;

static void create(const ranks *r, void *context)
{
    shared *s = context;
    const dem_model *whole = s->is_sent && r->rank > 0 ? NULL : s->whole;
    const domain_model_shares shares = {.owner = whole != NULL ? s->owner : NULL,
                                        .is_near = whole != NULL ? s->is_near : NULL,
                                        .touching = s->touching,
                                        .n_rings = s->n_rings};
    dem_model **out = &s->models[r->rank];
    s->status[r->rank] =
        s->is_sent ? domain_model_distribute(out, r, whole, &shares, s->whole->obstacles.list, s->whole->obstacles.n)
                   : domain_model_create(out, r, whole, &shares);
    if (s->status[r->rank] != DEM_OK) (void)strncpy(s->messages[r->rank], dem_status_message(), TEXT - 1);
}

static void destroy(shared *s)
{
    for (int k = 0; k < N_RANKS; k++) dem_model_destroy(s->models[k]);
}

static void assert_same_rows(const dem_model *m, const dem_model *whole)
{
    const domain *d = m->domain;
    const double *volume = stress_volumes(&m->stress), *volume_of_whole = stress_volumes(&whole->stress);
    for (dem_index i = 0; i < d->n_nodes; i++) {
        const dem_index of = d->number[i], from = whole->springs.row[of], row = m->springs.row[i];
        assert_true(m->inverse_mass[i] == (d->is_outer[i] ? 0.0 : whole->inverse_mass[of]));
        assert_true(volume[i] == volume_of_whole[of]);
        if (d->is_outer[i]) continue;
        assert_int_equal(m->springs.row[i + 1] - row, whole->springs.row[of + 1] - from);
        for (dem_index p = 0; p < m->springs.row[i + 1] - row; p++) {
            assert_int_equal(d->number[m->springs.neighbour[row + p]], whole->springs.neighbour[from + p]);
            const dem_index own = m->springs.spring[row + p], there = whole->springs.spring[from + p];
            assert_true(m->springs.stiffness_of[own] == whole->springs.stiffness_of[there]);
            assert_true(m->springs.rest_length_of[own] == whole->springs.rest_length_of[there]);
        }
    }
}

/* At positions that are not the rest ones. */
static void assert_same_stresses(const dem_model *m, const dem_model *whole, const double *x)
{
    const domain *d = m->domain;
    CLEANUP(free_memory) double *own = malloc(2 * (size_t)d->n_nodes * sizeof *own);
    assert_ok(stress_prepare(&m->stress));
    for (dem_index i = 0; i < d->n_nodes; i++) memcpy(own + 2 * i, x + 2 * d->number[i], 2 * sizeof *x);
    for (dem_index i = 0; i < d->n_nodes; i++) {
        double here[3], there[3];
        if (!d->is_own[i]) continue;
        stress_of_node(&m->stress, &m->lattice, &m->triangles, i, own, here);
        stress_of_node(&whole->stress, &whole->lattice, &whole->triangles, d->number[i], x, there);
        assert_memory_equal(here, there, sizeof here);
    }
}

/* The edge of the whole surface from node to node; -1: none. */
static dem_index find_edge(const surface *s, dem_index from, dem_index to)
{
    for (dem_index k = 0; k < s->n_edges; k++)
        if (s->ends[2 * k] == from && s->ends[2 * k + 1] == to) return k;
    return -1;
}

/* Where the domain ends there is no boundary, and no edge between own nodes is missing. */
static void assert_same_surface(const dem_model *m, const dem_model *whole)
{
    const domain *d = m->domain;
    dem_index n_own = 0, n_whole = 0;
    for (dem_index k = 0; k < m->surface.n_edges; k++) {
        const dem_index a = m->surface.ends[2 * k], b = m->surface.ends[2 * k + 1];
        assert_true(find_edge(&whole->surface, d->number[a], d->number[b]) >= 0);
        n_own += !d->is_ghost[a];
    }
    for (dem_index k = 0; k < whole->surface.n_edges; k++) n_whole += domain_node(d, whole->surface.ends[2 * k]) >= 0;
    assert_int_equal(n_own, n_whole);
    for (dem_index i = 0; i < d->n_nodes; i++)
        assert_int_equal(m->lattice.flags[i], whole->lattice.flags[d->number[i]]);
}

static void assert_same_model(const dem_model *m, const dem_model *whole, const double *x)
{
    assert_same_rows(m, whole);
    assert_same_stresses(m, whole, x);
    assert_same_surface(m, whole);
    assert_true(m->omega_max == whole->omega_max && m->spacing == whole->spacing && m->mass == whole->mass);
    assert_int_equal(m->n_bodies, whole->n_bodies);
    assert_int_equal(m->edges_are_springs, whole->edges_are_springs);
    assert_int_equal(m->domain->n_surface_nodes, whole->surface.n_nodes);
}

/* However domains are made. */
static void check_own_nodes(const dem_lattice *l, const int32_t *owner)
{
    CLEANUP(free_model) dem_model *whole = support_model(l, NULL, 0);
    CLEANUP(free_memory) double *x = malloc(2 * (size_t)l->n_nodes * sizeof *x);
    for (dem_index k = 0; k < 2 * l->n_nodes; k++) x[k] = l->x[k] * (1.0 + 0.01 * sin((double)k));
    assert_ok(stress_prepare(&whole->stress));
    for (int is_sent = 0; is_sent < 2; is_sent++) {
        shared s = {.whole = whole, .owner = owner, .is_sent = is_sent};
        rank_threads_run(N_RANKS, create, &s);
        for (int k = 0; k < N_RANKS; k++) {
            assert_int_equal(s.status[k], DEM_OK);
            assert_same_model(s.models[k], whole, x);
        }
        destroy(&s);
    }
}

TEST(own_nodes_have_what_they_have_in_the_whole)
{
    CLEANUP(dem_lattice_free) dem_lattice l = shared_disc();
    CLEANUP(free_memory) int32_t *owner = shared_owners(&l, N_RANKS);
    check_own_nodes(&l, owner);
    for (dem_index i = 0; i < l.n_nodes; i++) owner[i] = (int32_t)(7 * i % N_RANKS);
    check_own_nodes(&l, owner);
}

/* Springs beside own nodes have shares of triangles that are not in the domain. */
TEST(own_nodes_have_what_they_have_in_a_whole_of_coupled_springs)
{
    const dem_material stiff = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 0.45, .density = 1050.0,
                                     .thickness = 1.0, .springs = DEM_SPRINGS_COUPLED);
    CLEANUP(dem_lattice_free) dem_lattice l = dem_lattice_empty();
    assert_ok(dem_lattice_disc(&l, 0.04, 5e-3));
    assert_ok(dem_lattice_jitter(&l, 1e-3, 3));
    assert_ok(dem_lattice_assemble(&l, &stiff));
    assert_non_null(l.coupling);
    CLEANUP(free_memory) int32_t *owner = shared_owners(&l, N_RANKS);
    check_own_nodes(&l, owner);
    for (dem_index i = 0; i < l.n_nodes; i++) owner[i] = (int32_t)(7 * i % N_RANKS);
    check_own_nodes(&l, owner);
}

/* The triangles of a cell share the spring across it, which is a side of neither. */
TEST(own_nodes_have_what_they_have_in_a_whole_of_squares)
{
    const dem_material rubber =
        SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0, .thickness = 1.0);
    CLEANUP(dem_lattice_free) dem_lattice l = dem_lattice_empty();
    assert_ok(dem_lattice_squares(&l, 0.05, 0.08, 5e-3));
    assert_ok(dem_lattice_assemble(&l, &rubber));
    CLEANUP(free_memory) int32_t *owner = shared_owners(&l, N_RANKS);
    check_own_nodes(&l, owner);
    for (dem_index i = 0; i < l.n_nodes; i++) owner[i] = (int32_t)(7 * i % N_RANKS);
    check_own_nodes(&l, owner);
}

static bool same_neighbour(const domain_neighbour *a, const domain_neighbour *b)
{
    return a->rank == b->rank && a->n_sent == b->n_sent && a->n_received == b->n_received &&
           memcmp(a->sent, b->sent, (size_t)a->n_sent * sizeof *a->sent) == 0 &&
           memcmp(a->received, b->received, (size_t)a->n_received * sizeof *a->received) == 0;
}

/* All ranks list the same for each other, whoever has cut their domains. */
TEST(a_domain_that_is_sent_is_the_one_that_is_cut)
{
    CLEANUP(dem_lattice_free) dem_lattice l = shared_disc();
    CLEANUP(free_memory) int32_t *owner = shared_owners(&l, N_RANKS);
    CLEANUP(free_model) dem_model *whole = support_model(&l, NULL, 0);
    shared cut = {.whole = whole, .owner = owner, .touching = true, .n_rings = 3}, sent = cut;
    sent.is_sent = true;
    rank_threads_run(N_RANKS, create, &cut);
    rank_threads_run(N_RANKS, create, &sent);
    for (int k = 0; k < N_RANKS; k++) {
        const domain *a = cut.models[k]->domain, *b = sent.models[k]->domain;
        assert_int_equal(a->n_nodes, b->n_nodes);
        assert_int_equal(cut.models[k]->lattice.n_springs, sent.models[k]->lattice.n_springs);
        assert_memory_equal(a->number, b->number, (size_t)a->n_nodes * sizeof *a->number);
        assert_memory_equal(a->is_own, b->is_own, (size_t)a->n_nodes);
        assert_memory_equal(a->is_ghost, b->is_ghost, (size_t)a->n_nodes);
        assert_memory_equal(a->is_common, b->is_common, (size_t)a->n_nodes);
        assert_memory_equal(a->is_outer, b->is_outer, (size_t)a->n_nodes);
        assert_int_equal(a->n_rings, 3);
        assert_int_equal(b->n_rings, 3);
        assert_memory_equal(a->triangle, b->triangle, (size_t)cut.models[k]->lattice.n_triangles * sizeof *a->triangle);
        assert_memory_equal(cut.models[k]->touching->boundary.outer, sent.models[k]->touching->boundary.outer,
                            (size_t)a->n_nodes);
        assert_memory_equal(a->spring, b->spring, (size_t)cut.models[k]->lattice.n_springs * sizeof *a->spring);
        assert_int_equal(a->n_neighbours, b->n_neighbours);
        for (int n = 0; n < a->n_neighbours; n++) assert_true(same_neighbour(&a->neighbours[n], &b->neighbours[n]));
        assert_int_equal(a->n_whole, l.n_nodes);
        assert_int_equal(b->n_whole, l.n_nodes);
    }
    destroy(&cut);
    destroy(&sent);
}

static const double floor_points[] = {-1.0, -1.0, 1.0, -1.0};

/* All that may touch is on every rank, with the edges in the order of the whole. */
static void assert_whole_surface(const dem_model *m, const dem_model *whole)
{
    const domain *d = m->domain;
    assert_int_equal(m->surface.n_nodes, whole->surface.n_nodes);
    assert_int_equal(m->surface.n_edges, whole->surface.n_edges);
    for (dem_index k = 0; k < whole->surface.n_nodes; k++)
        assert_int_equal(d->number[m->surface.nodes[k]], whole->surface.nodes[k]);
    for (dem_index k = 0; k < 2 * whole->surface.n_edges; k++)
        assert_int_equal(d->number[m->surface.ends[k]], whole->surface.ends[k]);
    for (dem_index k = 0; k < whole->surface.n_edges; k++) {
        assert_int_equal(m->surface.next[k], whole->surface.next[k]);
        assert_int_equal(m->surface.previous[k], whole->surface.previous[k]);
    }
}

TEST(what_may_touch_obstacles_is_on_all_ranks)
{
    CLEANUP(dem_lattice_free) dem_lattice l = shared_disc();
    CLEANUP(free_memory) int32_t *owner = shared_owners(&l, N_RANKS);
    const dem_obstacle floor = SIZED(dem_obstacle, .n_points = 2, .points = floor_points, .restitution = 1.0);
    CLEANUP(free_model) dem_model *whole = support_model(&l, &floor, 1);
    for (int is_sent = 0; is_sent < 2; is_sent++) {
        shared s = {.whole = whole, .owner = owner, .is_sent = is_sent};
        rank_threads_run(N_RANKS, create, &s);
        for (int k = 0; k < N_RANKS; k++) {
            assert_int_equal(s.status[k], DEM_OK);
            assert_int_equal(s.models[k]->obstacles.n, 1);
            assert_same_rows(s.models[k], whole);
            assert_whole_surface(s.models[k], whole);
        }
        destroy(&s);
    }
}

/* As far from marked nodes as the rings say, by a look at all springs again and again. */
static void mark_rings(const dem_lattice *l, int n_rings, unsigned char *marks)
{
    CLEANUP(free_memory) unsigned char *before = malloc((size_t)l->n_nodes);
    for (int ring = 0; ring < n_rings; ring++) {
        memcpy(before, marks, (size_t)l->n_nodes);
        for (dem_index k = 0; k < 2 * l->n_springs; k++)
            if (before[l->ends[k ^ 1]]) marks[l->ends[k]] = 1;
    }
}

TEST(rings_are_common_about_what_is_near_alone)
{
    CLEANUP(dem_lattice_free) dem_lattice l = shared_disc();
    CLEANUP(free_memory) int32_t *owner = shared_owners(&l, N_RANKS);
    const dem_obstacle floor = SIZED(dem_obstacle, .n_points = 2, .points = floor_points, .restitution = 1.0);
    CLEANUP(free_model) dem_model *whole = support_model(&l, &floor, 1);
    const unsigned char *flags = whole->lattice.flags;
    CLEANUP(free_memory) unsigned char *is_near = calloc((size_t)l.n_nodes, 1);
    CLEANUP(free_memory) unsigned char *expected = calloc((size_t)l.n_nodes, 1);
    for (dem_index i = 0; i < l.n_nodes; i++)
        is_near[i] = expected[i] = flags[i] & DEM_NODE_CONTACT && l.x[2 * i + 1] < -0.03;
    mark_rings(&whole->lattice, whole_lattice_rings(&l), expected);
    for (dem_index i = 0; i < l.n_nodes; i++) expected[i] |= (flags[i] & DEM_NODE_CONTACT) != 0;
    for (int is_sent = 0; is_sent < 2; is_sent++) {
        shared s = {.whole = whole, .owner = owner, .is_near = is_near, .touching = true, .is_sent = is_sent};
        rank_threads_run(N_RANKS, create, &s);
        for (int k = 0; k < N_RANKS; k++) {
            const domain *d = s.models[k]->domain;
            dem_index n_common = 0;
            assert_int_equal(s.status[k], DEM_OK);
            assert_whole_surface(s.models[k], whole);
            for (dem_index i = 0; i < d->n_nodes; i++) {
                assert_int_equal(d->is_common[i], expected[d->number[i]]);
                n_common += d->is_common[i];
            }
            for (dem_index i = 0; i < l.n_nodes; i++) n_common -= expected[i];
            assert_int_equal(n_common, 0);
        }
        destroy(&s);
    }
}

/* A disc whose nodes have far neighbours by number, so that layouts renumber them. */
static dem_lattice make_shuffled(void)
{
    const dem_material rubber =
        SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 0.3, .density = 1050.0, .thickness = 1.0);
    dem_lattice l = dem_lattice_empty();
    assert_ok(dem_lattice_disc(&l, 0.06, 1e-3));
    CLEANUP(free_memory) double *x = malloc(2 * (size_t)l.n_nodes * sizeof *x);
    memcpy(x, l.x, 2 * (size_t)l.n_nodes * sizeof *x);
    for (dem_index i = 0; i < l.n_nodes; i++) memcpy(&l.x[2 * (i * 997 % l.n_nodes)], &x[2 * i], 2 * sizeof *x);
    for (dem_index k = 0; k < 3 * l.n_triangles; k++) l.triangles[k] = l.triangles[k] * 997 % l.n_nodes;
    assert_ok(dem_lattice_assemble(&l, &rubber));
    return l;
}

/* Each has nodes at the places that its own springs and nothing else ask for. */
TEST(the_layout_of_a_domain_has_an_order_of_its_own)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make_shuffled();
    CLEANUP(free_memory) int32_t *owner = shared_owners(&l, N_RANKS);
    CLEANUP(free_model) dem_model *whole = support_model(&l, NULL, 0);
    for (int is_sent = 0; is_sent < 2; is_sent++) {
        shared s = {.whole = whole, .owner = owner, .is_sent = is_sent};
        rank_threads_run(N_RANKS, create, &s);
        for (int k = 0; k < N_RANKS; k++) {
            const dem_model *m = s.models[k];
            assert_int_equal(s.status[k], DEM_OK);
            CLEANUP(layout_free) layout own;
            assert_ok(layout_compile(&own, &m->springs, &m->triangles, &m->couplings));
            assert_true(own.order != NULL && m->layout.order != NULL);
            assert_memory_equal(m->layout.order, own.order, (size_t)m->lattice.n_nodes * sizeof *own.order);
        }
        destroy(&s);
    }
}

/* ---- bodies that touch ---- */

/* A soft disc, and a rigid one beside it. */
static dem_lattice make_two(void)
{
    dem_lattice l = shared_disc();
    CLEANUP(dem_lattice_free) dem_lattice other = shared_disc();
    assert_ok(dem_lattice_stiffen(&other, DEM_GUIDE_Y));
    dem_lattice_move(&other, 0.2, (const double[2]){0.09, 0.01});
    assert_ok(dem_lattice_append(&l, &other));
    return l;
}

static void assert_same_bodies(const dem_model *m, const touching_bodies *whole)
{
    const touching_bodies *own = m->touching;
    assert_ptr_equal(own->domain, m->domain);
    assert_int_equal(own->n_bodies, whole->n_bodies);
    assert_memory_equal(own->bodies, whole->bodies, (size_t)whole->n_bodies * sizeof *whole->bodies);
    assert_int_equal(own->boundary.n, whole->boundary.n);
    for (dem_index k = 0; k < whole->boundary.n; k++) {
        const mesh_boundary_edge *here = &own->boundary.list[k], *there = &whole->boundary.list[k];
        const dem_index *corner = &m->lattice.triangles[3 * here->triangle];
        assert_int_equal(touching_bodies_node(own, here->lower), there->lower);
        assert_int_equal(touching_bodies_node(own, here->upper), there->upper);
        assert_false(m->domain->is_ghost[here->lower] || m->domain->is_ghost[here->upper]);
        for (int c = 0; c < 3; c++)
            assert_int_equal(m->domain->number[corner[c]], whole->boundary.lattice->triangles[3 * there->triangle + c]);
    }
}

static void assert_same_rigid(const dem_model *m, const dem_model *whole)
{
    const rigid_body *here = &m->rigid.list[0], *there = &whole->rigid.list[0];
    assert_int_equal(m->rigid.n, 1);
    assert_int_equal(here->number, 1);
    assert_int_equal(here->guide, DEM_GUIDE_Y);
    assert_int_equal(here->n_nodes, there->n_nodes);
    assert_int_equal(m->domain->number[here->middle], there->middle);
    assert_true(here->mass == there->mass && here->inertia == there->inertia);
    assert_memory_equal(here->masses, there->masses, (size_t)there->n_nodes * sizeof *there->masses);
    assert_memory_equal(here->shape, there->shape, 2 * (size_t)there->n_nodes * sizeof *there->shape);
    for (dem_index k = 0; k < there->n_nodes; k++) {
        assert_int_equal(m->domain->number[here->nodes[k]], there->nodes[k]);
        assert_false(m->domain->is_ghost[here->nodes[k]]);
    }
    for (dem_index i = 0; i < m->lattice.n_nodes; i++)
        assert_int_equal(rigid_bodies_at(&m->rigid, i) != NULL, m->lattice.body[i] == 1);
}

/* And nothing else where there is no obstacle: the soft body has other nodes inside. */
static void assert_only_these(const dem_model *m, const dem_model *whole)
{
    const domain *d = m->domain;
    for (dem_index i = 0; i < d->n_nodes; i++)
        if (!d->is_own[i] && !d->is_ghost[i])
            assert_true(m->lattice.body[i] == 1 || (whole->lattice.flags[d->number[i]] & DEM_NODE_CONTACT));
}

TEST(surfaces_and_rigid_bodies_are_on_all_ranks)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make_two();
    CLEANUP(free_memory) int32_t *owner = shared_owners(&l, N_RANKS);
    CLEANUP(free_model) dem_model *whole = support_model(&l, NULL, 0);
    CLEANUP(touching_bodies_free) touching_bodies bodies;
    assert_ok(touching_bodies_create(&bodies, &whole->lattice));
    for (int way = 0; way < 4; way++) {
        const bool touching = way % 2;
        shared s = {.whole = whole, .owner = owner, .touching = touching, .is_sent = way / 2};
        rank_threads_run(N_RANKS, create, &s);
        for (int k = 0; k < N_RANKS; k++) {
            assert_int_equal(s.status[k], DEM_OK);
            assert_same_rigid(s.models[k], whole);
            assert_only_these(s.models[k], whole);
            assert_int_equal(s.models[k]->touching != NULL, touching);
            if (touching) assert_same_bodies(s.models[k], &bodies);
        }
        destroy(&s);
    }
}

/* The last ring that a correction reads is the last common one, whose accelerations it computes again. */
TEST(rings_reach_as_far_as_the_correction_for_an_event)
{
    static const dem_method methods[] = {DEM_METHOD_FEHLBERG45, DEM_METHOD_VERLET};
    const dem_obstacle floor = SIZED(dem_obstacle, .n_points = 2, .points = floor_points, .restitution = 1.0);
    for (int damped = 0; damped < 2; damped++)
        for (int m = 0; m < 2; m++) {
            CLEANUP(dem_lattice_free) dem_lattice l = shared_disc();
            l.viscosity = damped ? calloc((size_t)l.n_springs, sizeof *l.viscosity) : NULL;
            CLEANUP(free_model) dem_model *model = support_model(&l, &floor, 1);
            dem_options options = dem_options_default();
            options.method = methods[m];
            dem_simulation *run = support_simulation(model, &options);
            const int n_rings = run->queue.correction.near.n_rings, n_common = whole_lattice_rings(&l);
            assert_true(m == 0 ? n_rings == n_common : n_rings < n_common);
            dem_simulation_destroy(run);
        }
}

/* One rank alone has no node: all hear of it. */
TEST(a_failure_of_one_rank_is_that_of_all)
{
    CLEANUP(dem_lattice_free) dem_lattice l = shared_disc();
    CLEANUP(free_memory) int32_t *owner = shared_owners(&l, N_RANKS - 1);
    CLEANUP(free_model) dem_model *whole = support_model(&l, NULL, 0);
    for (int is_sent = 0; is_sent < 2; is_sent++) {
        shared s = {.whole = whole, .owner = owner, .is_sent = is_sent};
        rank_threads_run(N_RANKS, create, &s);
        for (int k = 0; k < N_RANKS; k++) {
            assert_null(s.models[k]);
            assert_string_equal(s.messages[k], "rank 4 has no node of its own");
        }
    }
}
