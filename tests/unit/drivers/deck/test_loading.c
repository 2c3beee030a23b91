/* SPDX-License-Identifier: BSD-3-Clause */
/* loading.c: which nodes the groups &boundary choose, and what is done to them, worked out by hand on a block of 5 x 4
 * nodes turned by a right angle and shifted. Words of faults are test_refused.py's. */
#include "unit/reading.h"

#include <stdlib.h>

#include "harness/slab_cut.h"
#include "loading.h"

#define BASE "&run t_end = 1 /\n&body shape = 'file', file = 'x' /\n"

enum { columns = 5, rows = 4, n_nodes = columns * rows };

static const double spacing = 0.5;

/* Squares of two triangles each; own coordinates 0 to 2 and 0 to 1.5, behind three nodes of another body. */
static void make_block(dem_lattice *l, const placement *place)
{
    const dem_index first = place->first, n = first + n_nodes;
    *l = dem_lattice_empty();
    l->n_nodes = n;
    l->x = calloc((size_t)n, 2 * sizeof *l->x);
    l->ends = calloc(2, sizeof *l->ends);
    l->rest_length = calloc(1, sizeof *l->rest_length);
    l->stiffness = calloc(1, sizeof *l->stiffness);
    l->triangles = calloc(6 * (columns - 1) * (rows - 1), sizeof *l->triangles);
    l->thickness = calloc(2 * (columns - 1) * (rows - 1), sizeof *l->thickness);
    assert_true(l->x && l->ends && l->rest_length && l->stiffness && l->triangles && l->thickness);
    l->n_springs = 1, l->ends[0] = first, l->ends[1] = first + 1, l->rest_length[0] = spacing, l->stiffness[0] = 1.0;
    const double c = cos(place->angle), s = sin(place->angle);
    for (dem_index k = 0; k < n_nodes; k++) {
        const double x = spacing * (double)(k % columns), y = spacing * (double)(k / columns);
        l->x[2 * (first + k)] = place->offset[0] + c * x - s * y;
        l->x[2 * (first + k) + 1] = place->offset[1] + s * x + c * y;
    }
    for (dem_index j = 0; j + 1 < rows; j++)
        for (dem_index i = 0; i + 1 < columns; i++) {
            const dem_index a = first + j * columns + i, b = a + 1, u = a + columns, v = u + 1;
            const dem_index both[6] = {a, b, v, a, v, u};
            for (int q = 0; q < 6; q++) l->triangles[3 * l->n_triangles + q] = both[q];
            l->thickness[l->n_triangles] = l->thickness[l->n_triangles + 1] = i < 2 ? 0.25 : 0.5;
            l->n_triangles += 2;
        }
}

typedef struct loaded {
    resolved from;
    namelist_errors errors;
    dem_lattice lattice;
    dem_boundary *list;
    dem_index n;
} loaded;

static const placement place = {.first = 3, .n_nodes = n_nodes, .angle = 1.5707963267948966, .offset = {7.0, -2.0}};

/* In one slab, or in two of the first `first` nodes and the others. */
static void look(loaded *l, dem_index first)
{
    CLEANUP(loading_forget) loading_search search;
    dem_slab whole = dem_slab_empty();
    whole.n_nodes = l->lattice.n_nodes;
    whole.lattice = l->lattice;
    assert_true(loading_begin(&search, &l->from.deck, &place, &l->lattice, &place));
    for (dem_index begin = 0, end = first; begin < whole.n_nodes; begin = end, end = whole.n_nodes) {
        CLEANUP(dem_slab_free) dem_slab slab = slab_cut(&l->lattice, begin, end);
        assert_int_equal(slab.n_own, end - begin);
        assert_true(loading_look(&search, &slab));
    }
    assert_true(loading_end(&l->list, &l->n, &search, &whole, &l->errors));
}

static void build_in(loaded *l, dem_index first, const char *text)
{
    *l = (loaded){.from = resolve_clean(text)};
    loading_drop_unused(&l->from.deck);
    loading_check_all(&l->from.deck, &l->errors);
    make_block(&l->lattice, &place);
    look(l, first);
    assert_true(loading_hold(&l->lattice, l->list, l->n));
}

static void build(loaded *l, const char *text)
{
    build_in(l, place.first + n_nodes, text);
}

static void load(loaded *l, const char *text)
{
    build(l, text);
    if (l->errors.n > 0) fail_msg("'%s' gives '%s'", text, l->errors.list[0].text);
}

static void drop_loaded(loaded *l)
{
    loading_free(l->list, l->n);
    dem_lattice_free(&l->lattice);
    namelist_errors_free(&l->errors);
    drop_resolved(&l->from);
}

/* The nodes are first + every `step`-th of `n` from `from`. */
static void expect_nodes(const dem_boundary *b, dem_index from, dem_index step, dem_index n)
{
    assert_int_equal(b->n_nodes, n);
    for (dem_index k = 0; k < n; k++) assert_int_equal(b->nodes[k], place.first + from + k * step);
}

TEST(sides_are_those_of_the_body_itself)
{
    CLEANUP(drop_loaded) loaded l;
    load(&l, BASE
         "&boundary where = 'side', side = 'left' /\n&boundary where = 'side', side = 'right', components = 'x' /\n"
         "&boundary where = 'side', side = 'bottom', kind = 'force', force = 1, 2 /\n"
         "&boundary where = 'side', side = 'top', kind = 'force', force = 3, 4, ramp = 5 /\n");
    assert_int_equal(l.n, 4);
    expect_nodes(&l.list[0], 0, columns, rows);
    expect_nodes(&l.list[1], columns - 1, columns, rows);
    expect_nodes(&l.list[2], 0, 1, columns);
    expect_nodes(&l.list[3], n_nodes - columns, 1, columns);
    assert_int_equal(l.list[0].kind, DEM_BOUNDARY_VELOCITY);
    assert_int_equal(l.list[0].components, DEM_COMPONENT_X | DEM_COMPONENT_Y);
    assert_close(l.list[0].value[0], 0.0, 0.0);
    assert_int_equal(l.list[1].components, DEM_COMPONENT_X);
    assert_int_equal(l.list[3].kind, DEM_BOUNDARY_FORCE);
    assert_null(l.list[3].share);
    assert_close(l.list[3].value[1], 4.0, 0.0);
    assert_close(l.list[3].ramp, 5.0, 0.0);
}

static void check_same(const dem_boundary *a, const dem_boundary *b)
{
    assert_int_equal(a->kind, b->kind);
    assert_int_equal(a->n_nodes, b->n_nodes);
    assert_memory_equal(a->nodes, b->nodes, (size_t)a->n_nodes * sizeof *a->nodes);
    assert_int_equal(a->share != NULL, b->share != NULL);
    if (a->share != NULL) assert_memory_equal(a->share, b->share, (size_t)a->n_nodes * sizeof *a->share);
}

/* Edges between a node of either slab count in both of them. */
TEST(slabs_have_the_nodes_and_shares_of_the_whole)
{
    static const char text[] =
        BASE "&boundary where = 'side', side = 'left' /\n"
             "&boundary where = 'side', side = 'right', kind = 'traction', traction = 1, 2 /\n"
             "&boundary where = 'box', box = 0.4, 0.9, 3, 3, kind = 'traction', traction = 0, 1 /\n"
             "&boundary where = 'list', nodes = 12, 7, kind = 'displacement', displacement = 1, 0, ramp = 1 /\n"
             "&boundary where = 'disc', centre = 1, 1, radius = 0.6, kind = 'force', force = 0, 1 /\n";
    CLEANUP(drop_loaded) loaded whole;
    load(&whole, text);
    for (dem_index first = 1; first < place.first + n_nodes; first++) {
        CLEANUP(drop_loaded) loaded l;
        build_in(&l, first, text);
        assert_int_equal(l.errors.n, 0);
        assert_int_equal(l.n, whole.n);
        for (dem_index k = 0; k < l.n; k++) check_same(&whole.list[k], &l.list[k]);
    }
}

TEST(places_are_in_own_coordinates)
{
    CLEANUP(drop_loaded) loaded l;
    load(&l, BASE "&boundary where = 'box', box = 0.5, 0.5, 1.5, 0.5 /\n"
                  "&boundary where = 'disc', centre = 2, 1.5, radius = 0.5, kind = 'velocity', velocity = 1, 0 /\n"
                  "&boundary where = 'list', nodes = 12, kind = 'displacement', displacement = 1, 0, ramp = 1 /\n"
                  "&boundary where = 'all', kind = 'force', force = 0, 1 /\n");
    expect_nodes(&l.list[0], columns + 1, 1, 3);
    assert_int_equal(l.list[1].n_nodes, 3);
    assert_int_equal(l.list[1].nodes[0], place.first + 14);
    assert_int_equal(l.list[1].nodes[1], place.first + 18);
    assert_int_equal(l.list[1].nodes[2], place.first + 19);
    expect_nodes(&l.list[2], 12, 1, 1);
    assert_int_equal(l.list[2].kind, DEM_BOUNDARY_DISPLACEMENT);
    expect_nodes(&l.list[3], 0, 1, n_nodes);
}

/* 100 Pa on the top, 2 m long, half of it 0.25 m, half 0.5 m thick: half an edge to each of its ends. A box takes the
 * edges as they are. */
TEST(a_traction_is_shared_by_the_lengths_of_edges)
{
    static const double thick[columns] = {0.25, 0.25 + 0.25, 0.25 + 0.5, 0.5 + 0.5, 0.5}; /* of both edges of a node */
    CLEANUP(drop_loaded) loaded l;
    load(&l, BASE "&boundary where = 'side', side = 'top', kind = 'traction', traction = 100, 0 /\n"
                  "&boundary where = 'box', box = -1, -1, 0.1, 9, kind = 'traction', traction = 0, 7 /\n");
    for (int k = 0; k < columns; k++) assert_close(l.list[0].share[k], 0.5 * spacing * thick[k], 1e-14);
    for (int k = 0; k < rows; k++)
        assert_close(l.list[1].share[k], (k == 0 || k == rows - 1 ? 0.5 : 1.0) * spacing * 0.25, 1e-14);
}

/* Nodes with prescribed motion are taken from contact, loaded ones are not. */
TEST(what_is_prescribed_touches_nothing)
{
    CLEANUP(drop_loaded) loaded l;
    load(&l, BASE "&boundary where = 'side', side = 'top', components = 'y' /\n"
                  "&boundary where = 'side', side = 'bottom', kind = 'force', force = 0, 1 /\n");
    for (dem_index k = 0; k < columns; k++) {
        assert_int_equal(l.lattice.flags[place.first + n_nodes - columns + k], 0);
        assert_int_equal(l.lattice.flags[place.first + k], DEM_NODE_CONTACT);
    }
}

/* A corner may be held in x by one side and in y by the other, not twice in y. */
TEST(a_component_has_one_motion)
{
    static const char both[] = BASE "&boundary where = 'side', side = 'left', components = 'x' /\n"
                                    "&boundary where = 'side', side = 'bottom', components = 'y' /\n";
    static const char twice[] = BASE "&boundary where = 'side', side = 'left' /\n"
                                     "&boundary where = 'side', side = 'top', kind = 'force', force = 1, 1 /\n"
                                     "&boundary where = 'side', side = 'bottom', components = 'y' /\n";
    CLEANUP(drop_loaded) loaded l;
    load(&l, both);
    drop_loaded(&l);
    build(&l, twice);
    assert_int_equal(l.errors.n, 1);
    assert_int_equal(l.errors.list[0].place.line, 5);
    assert_string_equal(l.errors.list[0].text,
                        "&boundary prescribes the motion of node 3 at (7, -2) m, as the one in line 3 does");
}

/* Of a side of 3 m by 0.5 m a traction of (10, 20) Pa; other shapes, places and kinds ask for nothing of the sort. */
TEST(a_traction_on_a_side_of_a_rectangle_asks_for_a_force)
{
#define PLATE                                                                                                          \
    "&material youngs_modulus = 1, density = 1, thickness = 0.5 /\n&body shape = 'rectangle', size = 2, 3, spacing = " \
    "1 /\n"
#define DISC "&material youngs_modulus = 1, density = 1 /\n&body shape = 'disc', radius = 2, spacing = 1 /\n"
    static const struct {
        const char *text;
        double length; /* 0: no answer */
    } all[] = {{PLATE "&boundary where = 'side', side = 'left', kind = 'traction', traction = 10, 20 /\n", 3.0},
               {PLATE "&boundary where = 'side', side = 'top', kind = 'traction', traction = 10, 20 /\n", 2.0},
               {PLATE "&boundary where = 'all', kind = 'traction', traction = 10, 20 /\n", 0.0},
               {PLATE "&boundary where = 'side', side = 'top', kind = 'force', force = 10, 20 /\n", 0.0},
               {DISC "&boundary where = 'side', side = 'top', kind = 'traction', traction = 10, 20 /\n", 0.0}};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        double force[2] = {0.0, 0.0};
        char text[600];
        (void)snprintf(text, sizeof text, "&run t_end = 1 /\n%s", all[k].text);
        CLEANUP(drop_resolved) resolved r = resolve_clean(text);
        assert_int_equal(loading_asked(force, &r.deck, 0), all[k].length > 0.0);
        assert_false(loading_asked(force, &r.deck, 1)); /* there is no second one */
        assert_close(force[0], 5.0 * all[k].length, 1e-15);
        assert_close(force[1], 10.0 * all[k].length, 1e-15);
    }
}
