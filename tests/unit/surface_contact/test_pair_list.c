/* SPDX-License-Identifier: BSD-3-Clause */
/* pair_list.c, pair_rows.c, contact_surface.c: the candidates against a look at every node and edge; when the list is
 * made anew. */
#include "surface_contact/pair_list.h"

#include "curves.h"
#include "harness/cleanup_gsl.h"
#include "harness/message.h"
#include "verification/support.h"

/* A list with what it stands on, moved from rest by random ways. */
typedef struct scene {
    dem_lattice lattice;
    contact_surface surface;
    pair_list list;
    double *x;
} scene;

static void open_scene(scene *s, gsl_rng *rng, double margin, bool within_bodies)
{
    *s = (scene){.lattice = curves_make(rng, 9, 24, 2.1)};
    assert_ok(contact_surface_compile(&s->surface, &s->lattice, 0.0, 1.0));
    assert_ok(pair_list_create(&s->list, &s->surface, within_bodies, margin));
    s->x = curves_shift(rng, &s->lattice, 0.1);
}

static void close_scene(scene *s)
{
    pair_list_destroy(&s->list);
    contact_surface_free(&s->surface);
    dem_lattice_free(&s->lattice);
    free(s->x);
}

static double distance(const double *x, dem_index i, const dem_index *ends)
{
    return contact_pair_distance(vec2_at(x, i), vec2_at(x, ends[0]), vec2_at(x, ends[1]));
}

/* Whether a pair belongs into the list, from the lattice alone: edge k of body b is side k of its outline. */
static bool is_candidate(const scene *s, dem_index i, dem_index edge, bool within_bodies)
{
    const dem_index *ends = &s->surface.surface.ends[2 * edge], n = 24;
    const double thickness =
        fmin(s->surface.laws[s->lattice.body[i]].thickness, s->surface.laws[s->lattice.body[ends[0]]].thickness);
    if (i % (n + 1) == 0 || i == ends[0] || i == ends[1]) return false; /* a middle, or an end */
    if (distance(s->x, i, ends) > thickness + s->list.margin) return false;
    if (s->lattice.body[i] != s->lattice.body[ends[0]]) return true;
    return within_bodies && distance(s->lattice.x, i, ends) >= thickness;
}

/* Whether an edge of a node's own body is one that the node never touches: its own, or one near it at rest. */
static bool is_never_touched(const scene *s, dem_index i, dem_index edge)
{
    const dem_index *ends = &s->surface.surface.ends[2 * edge];
    return s->lattice.body[i] == s->lattice.body[ends[0]] &&
           (i == ends[0] || i == ends[1] ||
            distance(s->lattice.x, i, ends) < s->surface.laws[s->lattice.body[i]].thickness);
}

static void check_list(const scene *s, bool within_bodies)
{
    const pair_rows *r = &s->list.pairs;
    dem_index k = 0;
    for (dem_index i = 0; i < s->lattice.n_nodes; i++)
        for (dem_index edge = 0; edge < s->surface.surface.n_edges; edge++) {
            if (!is_candidate(s, i, edge, within_bodies)) continue;
            assert_true(k < r->n);
            assert_int_equal(r->list[k].nodes[CONTACT_PAIR_NODE], i);
            assert_int_equal(r->list[k].nodes[CONTACT_PAIR_FIRST], s->surface.surface.ends[2 * edge]);
            assert_int_equal(r->list[k].nodes[CONTACT_PAIR_SECOND], s->surface.surface.ends[2 * edge + 1]);
            assert_int_equal(r->list[k].nodes[CONTACT_PAIR_BEFORE],
                             s->surface.surface.ends[2 * s->surface.surface.previous[edge]]);
            assert_int_equal(r->list[k].nodes[CONTACT_PAIR_AFTER],
                             s->surface.surface.ends[2 * s->surface.surface.next[edge] + 1]);
            assert_int_equal(r->list[k].ends_at_first, is_never_touched(s, i, s->surface.surface.previous[edge]));
            assert_int_equal(r->list[k].ends_at_second, is_never_touched(s, i, s->surface.surface.next[edge]));
            k++;
        }
    assert_int_equal(k, r->n);
}

/* Each slot is in the row of its node, and rows are ascending. */
static void check_rows(const pair_rows *r)
{
    dem_index n = 0;
    for (dem_index i = 0; i < r->n_nodes; i++)
        for (dem_index slot = r->first[i], last = -1; slot >= 0; last = slot, slot = r->next[slot], n++) {
            assert_true(slot > last);
            assert_int_equal(pair_rows_pair(r, slot)->nodes[pair_rows_which(slot)], i);
        }
    assert_int_equal(n, CONTACT_PAIR_NODES * r->n);
}

TEST(the_list_has_every_pair_that_is_near_in_the_order_of_node_and_edge)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (int turn = 0; turn < 12; turn++) {
        CLEANUP(close_scene) scene s;
        open_scene(&s, rng, turn % 3 == 0 ? 0.02 : 0.15 * turn, turn % 2 == 0);
        assert_ok(pair_list_follow(&s.list, s.x, 0.0));
        assert_true(s.list.pairs.n > 10);
        check_list(&s, turn % 2 == 0);
        check_rows(&s.list.pairs);
    }
}

/* An edge a hundred cells long goes through the cells piece by piece. */
TEST(a_long_edge_finds_the_nodes_beside_it)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(close_scene) scene s;
    open_scene(&s, rng, 0.3, true);
    vec2_put(s.x, 1, (vec2){6.0, 6.5}); /* across the grid: its two edges are long, too */
    assert_ok(pair_list_follow(&s.list, s.x, 0.0));
    check_list(&s, true);
}

/* That all move alike does not count. */
TEST(the_list_holds_until_two_nodes_have_moved_by_the_margin)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(close_scene) scene s;
    open_scene(&s, rng, 0.1, true);
    assert_ok(pair_list_follow(&s.list, s.x, 0.0));
    s.x[2 * 30] += 0.04;
    s.x[2 * 31] -= 0.04;
    for (dem_index k = 0; k < 2 * s.lattice.n_nodes; k++) s.x[k] += 3.0;
    assert_ok(pair_list_follow(&s.list, s.x, 0.0));
    assert_int_equal(s.list.n_made, 1);
    assert_ok(pair_list_follow(&s.list, s.x, 0.25)); /* only 0.075 m are free then */
    assert_int_equal(s.list.n_made, 2);
    s.x[2 * 25] += 1.0; /* the middle of a body is on no edge */
    assert_ok(pair_list_follow(&s.list, s.x, 0.0));
    assert_int_equal(s.list.n_made, 2);
    s.x[2 * 30 + 1] += 0.101;
    assert_ok(pair_list_follow(&s.list, s.x, 0.0));
    assert_int_equal(s.list.n_made, 3);
    check_list(&s, true);
    check_rows(&s.list.pairs);
}

TEST(positions_that_blow_up_are_refused_and_forgotten)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(close_scene) scene s;
    open_scene(&s, rng, 0.1, true);
    const double kept = s.x[2 * 30];
    s.x[2 * 30] = 1e9;
    assert_int_equal(pair_list_follow(&s.list, s.x, 0.0), DEM_ERROR_INTEGRATOR);
    assert_message_parts("edge * nodes * 30 * its length at rest");
    assert_int_equal(s.list.pairs.n, 0);
    s.x[2 * 30] = (double)NAN;
    assert_int_equal(pair_list_follow(&s.list, s.x, 0.0), DEM_ERROR_INTEGRATOR);
    s.x[2 * 30] = kept;
    assert_ok(pair_list_follow(&s.list, s.x, 0.0));
    check_list(&s, true);
}

/* Stars that are squeezed, so that their surfaces are near each other at rest. */
TEST(pairs_near_at_rest_are_counted_and_left_out)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(dem_lattice_free) dem_lattice lattice = curves_make(rng, 9, 24, 2.5);
    for (dem_index i = 0; i < lattice.n_nodes; i++) lattice.x[2 * i] *= 0.005;
    for (int within = 0; within < 2; within++) {
        contact_surface of;
        pair_list list;
        dem_index n = 0, counted;
        assert_ok(contact_surface_compile(&of, &lattice, 0.0, 1.0));
        assert_ok(pair_list_create(&list, &of, within, 0.01));
        for (dem_index k = 0; k < of.n_nodes; k++)
            for (dem_index e = 0; e < of.surface.n_edges; e++) {
                const dem_index *ends = &of.surface.ends[2 * e], i = of.nodes[k];
                const bool own = lattice.body[i] == lattice.body[ends[0]] && i != ends[0] && i != ends[1];
                n += own && distance(lattice.x, i, ends) < of.laws[lattice.body[i]].thickness;
            }
        assert_ok(pair_list_count_left_out(&list, &counted));
        assert_true(n > 10);
        assert_int_equal(counted, within ? n : 0);
        pair_list_destroy(&list);
        contact_surface_free(&of);
    }
}

/* ---- what fills cracks ---- */

/* A block across which a row of triangles breaks: each has one side left, that of a face. */
typedef struct crack {
    dem_lattice block;
    unsigned char *broken;
    dem_index n_broken;
    mesh_boundary boundary;
    contact_surface whole, faces; /* `faces` as of open_crack() */
} crack;

static const double row_height = 0.0025 * 1.7320508075688772; /* m */

static void break_row(crack *c)
{
    const dem_lattice *l = &c->block;
    for (dem_index t = 0; t < l->n_triangles; t++) {
        int n_above = 0;
        for (int k = 0; k < 3; k++) n_above += l->x[2 * l->triangles[3 * t + k] + 1] > 0.024;
        c->broken[t] = n_above == 1 || n_above == 2;
        c->n_broken += c->broken[t];
    }
}

static double *stretched(const dem_lattice *l, double stretch)
{
    double *x = calloc((size_t)l->n_nodes, 2 * sizeof *x);
    assert_non_null(x);
    for (dem_index k = 0; k < 2 * l->n_nodes; k++) x[k] = l->x[k] * (k % 2 == 1 ? 1.0 + stretch : 1.0);
    return x;
}

/* As the row breaks while the block is longer by this part in its direction; 0: at rest.  \param strengths  Pa */
static void open_crack(crack *c, double stretch, const double strengths[2])
{
    const dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 0.2, .density = 1050.0,
                                      .thickness = 1.0, .strength = strengths[0], .compressive_strength = strengths[1]);
    *c = (crack){.block = support_rectangle(0.05, 0.052, 0.005, &rubber)};
    CLEANUP(free_memory) double *x = stretched(&c->block, stretch);
    c->broken = calloc((size_t)c->block.n_triangles, 1);
    c->block.body = calloc((size_t)c->block.n_nodes, sizeof *c->block.body);
    c->block.flags = calloc((size_t)c->block.n_nodes, sizeof *c->block.flags);
    assert_true(c->broken != NULL && c->block.body != NULL && c->block.flags != NULL);
    break_row(c);
    assert_ok(mesh_boundary_create(&c->boundary, &c->block, c->broken));
    assert_ok(contact_surface_compile(&c->whole, &c->block, 0.0, 1.0));
    assert_ok(contact_surface_break(&c->faces, &c->whole, &c->boundary, c->broken, x));
}

static void close_crack(crack *c)
{
    contact_surface_free_outline(&c->faces);
    contact_surface_free(&c->whole);
    mesh_boundary_free(&c->boundary);
    dem_lattice_free(&c->block);
    free(c->broken);
}

static const double no_strength[2] = {0.0, 0.0};

TEST(broken_triangles_fill_the_cracks_of_bodies_that_touch_themselves)
{
    for (int within = 0; within < 2; within++) {
        CLEANUP(close_crack) crack c;
        CLEANUP(pair_list_destroy) pair_list list;
        dem_index n = 0;
        open_crack(&c, 0.0, no_strength);
        assert_ok(pair_list_create(&list, &c.faces, within, 1e-3));
        assert_ok(pair_list_follow(&list, c.block.x, 0.0));
        for (dem_index k = 0; k < list.pairs.n; k++) {
            const contact_pair *p = &list.pairs.list[k];
            assert_true(k == 0 || p->fills || !list.pairs.list[k - 1].fills); /* behind all others */
            if (!p->fills) continue;
            n++;
            assert_close(p->thickness, row_height, 1e-15);
            assert_close(p->weight, 0.0025 * c.faces.laws[0].modulus, 1e-9 * p->weight);
            assert_close(contact_pair_gap(p, c.block.x), p->thickness, 1e-15);
        }
        assert_int_equal(n, within ? c.n_broken : 0);
    }
}

/* The energy of n pairs of this stiffness that push by so much, J; the middle of its edge is below each corner. */
static void check_fillings(const crack *c, const pair_list *list, const double *x, double height)
{
    const double stiffness = 0.0025 * c->faces.laws[0].modulus / row_height;
    dem_index n = 0;
    for (dem_index k = 0; k < list->pairs.n; k++) {
        const contact_pair *p = &list->pairs.list[k];
        if (!p->fills) continue;
        const double pushed = fmax(height - row_height * (1.0 - 0.02), 0.0), energy = 0.5 * stiffness * pushed * pushed;
        assert_close(p->thickness, height, 1e-15);
        assert_close(contact_pair_energy(p, x), energy, 1e-9 * stiffness * 1e-8);
        n++;
    }
    assert_int_equal(n, c->n_broken);
}

/* A row that is stretched as it breaks pushes from its height on, one that is shorter by 1 % from there on, both as
 * stiff. Nothing changes when more breaks. */
TEST(what_is_squeezed_when_it_breaks_fills_the_room_that_it_had)
{
    for (int k = -1; k < 2; k++) {
        CLEANUP(close_crack) crack c;
        CLEANUP(contact_surface_free_outline) contact_surface later;
        CLEANUP(pair_list_destroy) pair_list list;
        open_crack(&c, 0.01 * k, no_strength);
        assert_ok(contact_surface_break(&later, &c.faces, &c.boundary, c.broken, c.block.x));
        assert_ok(pair_list_create(&list, &later, true, 1e-3));
        CLEANUP(free_memory) double *x = stretched(&c.block, -0.02);
        assert_ok(pair_list_follow(&list, x, 0.0));
        check_fillings(&c, &list, x, row_height * (1.0 + 0.01 * fmin(k, 0)));
    }
}

/* What has been squeezed is listed, and taken from a list; impossible ones are refused. */
TEST(what_is_squeezed_can_be_had_again)
{
    CLEANUP(close_crack) crack c;
    CLEANUP(contact_surface_free_outline) contact_surface other;
    CLEANUP(free_memory) squeezed_filling *list = NULL;
    open_crack(&c, -0.01, no_strength);
    assert_ok(contact_surface_break(&other, &c.whole, &c.boundary, c.broken, NULL));
    assert_int_equal(contact_surface_squeezed(&other, NULL), 0);
    assert_int_equal(contact_surface_squeezed(&c.faces, NULL), c.n_broken);
    list = calloc((size_t)c.n_broken, sizeof *list);
    assert_non_null(list);
    (void)contact_surface_squeezed(&c.faces, list);
    assert_ok(contact_surface_squeeze(&other, list, c.n_broken));
    assert_memory_equal(other.filled, c.faces.filled, (size_t)c.faces.surface.n_edges * sizeof *other.filled);
    assert_ok(contact_surface_squeeze(&other, NULL, 0));
    assert_int_equal(contact_surface_squeezed(&other, NULL), 0);
    const squeezed_filling wrong[] = {{list->first, list->second, 2.0 * row_height},
                                      {list->first, list->second, -row_height},
                                      {list->first, list->second, (double)NAN},
                                      {list->second, list->first, row_height},
                                      {-1, list->second, row_height},
                                      {list->first, c.block.n_nodes, row_height}};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        assert_int_equal(contact_surface_squeeze(&other, &wrong[k], 1), DEM_ERROR_IO);
        assert_message_parts("checkpoint * filling * nodes");
    }
}

/* Of a triangle that may be crushed nothing is left. */
TEST(triangles_with_a_compressive_strength_fill_nothing)
{
    static const double strengths[2] = {1e5, 1e6};
    CLEANUP(close_crack) crack c;
    open_crack(&c, 0.0, strengths);
    assert_true(c.n_broken > 10);
    for (dem_index e = 0; e < c.faces.surface.n_edges; e++) assert_close(c.faces.filled[e], 0.0, 0.0);
}
