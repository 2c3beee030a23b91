/* SPDX-License-Identifier: BSD-3-Clause */
/* surface_feature.c: what contacts ask of surfaces. Tolerances of 0 are copies. */
#include "unit/contact/bench.h"

TEST(a_vertex_belongs_to_the_obstacle_of_the_segment_that_ends_there)
{
    bench b;
    bench_open(&b, 2);
    const dem_index edge = bench_edge(&b, 0, 1);
    b.segments[3].obstacle = 2;
    b.segments[5].obstacle = 1;
    b.vertices[3] = (obstacle_vertex){.before = 5, .after = 0};
    const surface_feature below = contact_point_feature(&b.candidates[0], 3);
    const surface_feature under = contact_point_feature(&b.candidates[edge], 3);
    assert_int_equal(surface_segment(&b.scene, below), 3);
    assert_int_equal(surface_segment(&b.scene, under), 5);
    assert_int_equal(surface_obstacle(&b.scene, below), 2);
    assert_int_equal(surface_obstacle(&b.scene, under), 1);
    assert_false(candidate_is_edge(&b.candidates[0]));
    assert_true(candidate_is_edge(&b.candidates[edge]));
}

TEST(a_law_is_that_of_the_obstacle)
{
    bench b;
    bench_open(&b, 1);
    b.list[2].restitution = 0.25;
    const contact_law law = contact_law_of(&b.scene, 2);
    assert_close(law.restitution, 0.25, 0.0);
    assert_close(law.friction, 0.9, 0.0);
    assert_int_equal(law.friction_law, DEM_FRICTION_PAPER);
    assert_close(contact_law_friction(law), 0.0, 0.0); /* (10) is no sustained friction */
    assert_close(contact_law_friction(contact_law_of(&b.scene, 1)), 0.3, 0.0);
}

/* Free at its start, buried by 1 mm at its end, and one that goes on at both. */
TEST(a_free_end_counts_as_far_as_the_segment_is_buried)
{
    const double tolerance = 1e-6, margin = 11e-6; /* ten penetration tolerances, and the tolerance */
    bench b;
    bench_open(&b, 1);
    b.segments[0] = (segment){.length = 1.0, .before = -1, .after = -1, .buried = {0.0, 1e-3}};
    b.segments[1] = (segment){.length = 1.0, .before = 0, .after = 2};
    assert_true(surface_at_free_end(&b.scene, 0, 0.99 * margin, tolerance));
    assert_true(surface_at_free_end(&b.scene, 0, -0.99 * margin, tolerance));
    assert_false(surface_at_free_end(&b.scene, 0, 1.01 * margin, tolerance));
    assert_true(surface_at_free_end(&b.scene, 0, 1.0 + 0.99e-3, tolerance));
    assert_false(surface_at_free_end(&b.scene, 0, 1.0 + 1.01e-3, tolerance));
    assert_false(surface_at_free_end(&b.scene, 1, 0.0, tolerance));
    assert_false(surface_at_free_end(&b.scene, 1, 1.0, tolerance));
}

TEST(the_cone_of_a_vertex_lies_between_the_normals_of_its_segments)
{
    bench b;
    bench_open(&b, 1);
    b.segments[0].normal = (vec2){-0.6, 0.8};
    b.segments[1].normal = (vec2){0.6, 0.8};
    b.vertices[4] = (obstacle_vertex){.before = 0, .after = 1};
    assert_true(surface_in_cone(&b.scene, 4, 0.0, (vec2){0.0, 1.0}));
    assert_true(surface_in_cone(&b.scene, 4, 0.0, (vec2){0.6, 0.8}));
    assert_false(surface_in_cone(&b.scene, 4, 0.0, (vec2){0.8, 0.6}));
    assert_false(surface_in_cone(&b.scene, 4, 0.0, (vec2){-0.8, 0.6}));
}
