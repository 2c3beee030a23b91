/* SPDX-License-Identifier: BSD-3-Clause */
/* body_outline.c: from the keys of a group to its outline. */
#include "unit/reading.h"

#include "body_outline.h"

#define BODY "&run t_end = 1 /\n&body material = 'm', spacing = 1, shape = "

static dem_outline outline_in(const resolved *r, const char *group)
{
    return body_outline(schema_get(&r->deck, group, 0));
}

TEST(a_rectangle_that_is_a_body_stands_on_its_origin_and_others_are_centred)
{
    CLEANUP(drop_resolved)
    resolved r =
        resolve_clean(BODY "'rectangle', size = 4, 3 /\n&void centre = 0, 1, shape = 'rectangle', size = 1, 2 /\n");
    const dem_outline body = outline_in(&r, "body"), hole = outline_in(&r, "void");
    assert_int_equal(body.kind, DEM_OUTLINE_RECTANGLE);
    assert_close(body.size[0], 4.0, 0.0);
    assert_close(body.centre[1], 1.5, 0.0);
    assert_int_equal(hole.kind, DEM_OUTLINE_RECTANGLE);
    assert_close(hole.size[1], 2.0, 0.0);
    assert_close(hole.centre[1], 0.0, 0.0);
}

TEST(round_outlines_have_their_radii)
{
    CLEANUP(drop_resolved)
    resolved r = resolve_clean(
        BODY "'ring', radius = 5, inner_radius = 3 /\n&void centre = 0, 1, shape = 'disc', radius = 0.5 /\n");
    const dem_outline ring = outline_in(&r, "body"), disc = outline_in(&r, "void");
    assert_int_equal(ring.kind, DEM_OUTLINE_RING);
    assert_close(ring.radius, 5.0, 0.0);
    assert_close(ring.inner_radius, 3.0, 0.0);
    assert_int_equal(disc.kind, DEM_OUTLINE_DISC);
    assert_close(disc.radius, 0.5, 0.0);
}

TEST(a_polygon_may_repeat_its_first_point)
{
    const char *points[] = {"0,0, 4,0, 0,3", "0,0, 4,0, 0,3, 0,0"};
    for (int k = 0; k < 2; k++) {
        char text[200];
        (void)snprintf(text, sizeof text, BODY "'polygon', points = %s /\n", points[k]);
        CLEANUP(drop_resolved) resolved r = resolve_clean(text);
        const dem_outline o = outline_in(&r, "body");
        assert_int_equal(o.kind, DEM_OUTLINE_POLYGON);
        assert_int_equal(dem_outline_corners(&o), 3);
        assert_close(o.points[2], 4.0, 0.0);
    }
}

TEST(a_void_is_turned_by_degrees_about_its_centre)
{
    CLEANUP(drop_resolved)
    resolved r = resolve_clean(
        BODY "'disc', radius = 5 /\n&void centre = 1, 2, shape = 'rectangle', size = 2, 4, angle = 90 /\n");
    const dem_outline hole = body_outline_placed(schema_get(&r.deck, "void", 0));
    double box[4];
    assert_int_equal(dem_outline_box(&hole, box), DEM_OK);
    assert_close(box[0], -1.0, 1e-15);
    assert_close(box[1], 1.0, 1e-15);
    assert_close(box[2], 3.0, 1e-15);
    assert_close(box[3], 3.0, 1e-15);
}
