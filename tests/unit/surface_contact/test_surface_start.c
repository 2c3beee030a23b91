/* SPDX-License-Identifier: BSD-3-Clause */
/* surface_start.c: which surfaces are refused at the start, and what the message names. */
#include "surface_contact/surface_start.h"

#include "harness/message.h"
#include "verification/support.h"

static const dem_material rubber =
    SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0, .thickness = 1.0);

/* Two squares of 50 mm with the spacing 10 mm, the second moved to a place. */
typedef struct squares {
    dem_lattice lattice;
    surface_contact *contact;
} squares;

static dem_status open_squares(squares *s, const double place[2], bool within_bodies)
{
    const surface_contact_rule rule = {.within_bodies = within_bodies, .stiffness = 1.0};
    *s = (squares){.lattice = support_squares(0.05, 0.01, &rubber, place)};
    s->lattice.flags = calloc((size_t)s->lattice.n_nodes, 1);
    assert_ok(surface_contact_create(&s->contact, &s->lattice, &rule));
    assert_ok(surface_contact_follow(s->contact, s->lattice.x));
    return surface_start_check(s->contact, s->lattice.x);
}

static void close_squares(squares *s)
{
    surface_contact_destroy(s->contact);
    dem_lattice_free(&s->lattice);
}

TEST(surfaces_apart_may_start)
{
    const double places[3][2] = {{0.06, 0.0}, {0.0, 0.055}, {0.0511, 0.02}};
    for (int k = 0; k < 3; k++) {
        CLEANUP(close_squares) squares s;
        assert_ok(open_squares(&s, places[k], true));
    }
}

/* The corners of the second are up to 2 mm inside those of the first, where their outlines cross. */
TEST(surfaces_that_cross_are_refused_with_node_place_depth_and_edge)
{
    CLEANUP(close_squares) squares s;
    assert_int_equal(open_squares(&s, (const double[2]){0.048, 0.002}, true), DEM_ERROR_MODEL);
    assert_message_parts("node * of body * m inside body * edge between nodes");
}

/* A twentieth of the thickness of 2 mm is 0.1 mm. */
TEST(surfaces_that_nearly_touch_are_refused_with_their_distance)
{
    CLEANUP(close_squares) squares s;
    assert_int_equal(open_squares(&s, (const double[2]){0.05005, 0.0}, true), DEM_ERROR_MODEL);
    assert_message_parts("node * of body * m from the edge between nodes * of body * 0.0001 m apart");
}
