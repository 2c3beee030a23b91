/* SPDX-License-Identifier: BSD-3-Clause */
/* surfaces.c: what becomes of `bodies` in &contact where a body has no triangles. Body 1 of the deck is a triangle, and
 * body 2 is two point masses, which the library counts as two bodies. */
#include "unit/reading.h"

#include "surfaces.h"

enum { TRIANGLE = 3, N_NODES = 5 };

static double positions[2 * N_NODES] = {0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 5.0, 0.0, 6.0, 0.0};
static int32_t numbers[N_NODES] = {0, 0, 0, 1, 2};
static dem_index corners[3] = {0, 1, 2};
static const placement places[2] = {{.first = 0, .n_nodes = TRIANGLE}, {.first = TRIANGLE, .n_nodes = 2}};

#define BODY "&body shape = 'file', file = 'a' /\n"

/* What is settled for a lattice of so many nodes and triangles, and what stands in the groups then. */
static dem_bodies settle(const char *contact, dem_index n_nodes, dem_index n_triangles, const char *refusal)
{
    char text[256], faults[1024];
    dem_options options = {.bodies = DEM_BODIES_ALL};
    (void)snprintf(text, sizeof text, "%s%s%s", contact, BODY, n_nodes == N_NODES ? BODY : "");
    resolved r = resolve(text);
    namelist_errors_free(&r.errors);
    r.errors = (namelist_errors){0};
    const dem_lattice lattice = {.n_nodes = n_nodes,
                                 .n_triangles = n_triangles,
                                 .x = positions,
                                 .body = n_nodes == N_NODES ? numbers : NULL,
                                 .triangles = corners};
    if (schema_is(schema_get(&r.deck, "contact", 0), "bodies", "none")) options.bodies = DEM_BODIES_NONE;
    assert_true(surfaces_settle(&options, &r.deck, &lattice, places, &r.errors));
    list_faults(&r.errors, faults, sizeof faults);
    assert_line_parts(faults, refusal);
    const char *said = schema_text(schema_get(&r.deck, "contact", 0), "bodies");
    assert_string_equal(said, options.bodies == DEM_BODIES_NONE ? "none" : "all");
    drop_resolved(&r);
    return options.bodies;
}

TEST(bodies_of_triangles_touch_by_default)
{
    assert_int_equal(settle("", TRIANGLE, 1, ""), DEM_BODIES_ALL);
}

TEST(a_default_gives_way_to_a_body_without_triangles)
{
    assert_int_equal(settle("", TRIANGLE, 0, ""), DEM_BODIES_NONE);
    assert_int_equal(settle("", N_NODES, 1, ""), DEM_BODIES_NONE);
    assert_int_equal(settle("&contact bodies = 'none' /\n", N_NODES, 1, ""), DEM_BODIES_NONE);
}

TEST(what_is_asked_for_is_refused_for_a_body_without_triangles)
{
    settle("&contact bodies = 'all' /\n", N_NODES, 1, "1:10 'bodies' * body 2 has no triangles");
    settle("&contact thickness = 1e-3 /\n", N_NODES, 1, "1:10 'thickness' * body 2 has no triangles");
    settle("&contact stiffness = 2 /\n", TRIANGLE, 0, "1:10 'stiffness' * body 1 has no triangles");
    settle("&material friction = 0.3 /\n", N_NODES, 1, "1:11 'friction' in &material * body 2 has no triangles");
}

/* Rigid bodies of a lattice file have no key in the deck. */
TEST(a_rigid_body_needs_triangles_of_all_bodies)
{
    static unsigned char rigid[N_NODES] = {DEM_NODE_RIGID, DEM_NODE_RIGID, DEM_NODE_RIGID, 0, 0};
    CLEANUP(drop_resolved) resolved r = resolve_clean("&run t_end = 1 /\n" BODY BODY);
    dem_options options = {.bodies = DEM_BODIES_ALL};
    const dem_lattice lattice = {
        .n_nodes = N_NODES, .n_triangles = 1, .x = positions, .body = numbers, .flags = rigid, .triangles = corners};
    assert_true(surfaces_settle(&options, &r.deck, &lattice, places, &r.errors));
    assert_int_equal(r.errors.n, 1);
    assert_string_equal(r.errors.list[0].text,
                        "'rigid' in &body is for bodies that touch, but body 2 has no triangles, "
                        "and so no surface");
}
