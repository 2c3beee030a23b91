/* SPDX-License-Identifier: BSD-3-Clause */
/* contact_set.c: the list of candidates, contacts that open and close, groups and corners, and what is noted of them.
 * Numbers are worked out by hand; tolerances of 1e-15 to 1e-13 are rounding. */
#include "unit/contact/scene_fixture.h"

#include "lattice/mesh_edges.h"

static const double g = scene_gravity, masses[6] = {1.0, 3.0, 2.0, 1.0, 3.0, 2.0};

static const double floor_points[4] = {-8.0, 0.0, 8.0, 0.0};
static const dem_obstacle plane = SIZED(dem_obstacle, .n_points = 2, .points = floor_points, .restitution = 0.5);

/* A roof with its ridge in the origin, and one with its ridge at (1, 0). */
static const double roof_points[6] = {-4.0, -4.0, 0.0, 0.0, 0.5, -0.5},
                    beside_points[6] = {0.5, -0.5, 1.0, 0.0, 4.0, -3.0};
static const dem_obstacle roofs[2] = {
    {.struct_size = sizeof(dem_obstacle), .n_points = 3, .points = roof_points},
    SIZED(dem_obstacle, .n_points = 3, .points = beside_points, .friction = 0.5, .friction_law = DEM_FRICTION_COULOMB)};

/* A groove of 90 degrees with its bottom in the origin. */
static const double groove_points[6] = {-4.0, 4.0, 0.0, 0.0, 4.0, 4.0};
static const dem_obstacle groove = {.struct_size = sizeof(dem_obstacle), .n_points = 3, .points = groove_points},
                          rough_groove = SIZED(dem_obstacle, .n_points = 3, .points = groove_points, .friction = 0.5,
                                               .friction_law = DEM_FRICTION_COULOMB);

/* A square of two triangles: nodes 0 (0, 0), 1 (1, 0), 2 (1, 1), 3 (0, 1). */
static void open_square(scene *s, const dem_obstacle *obstacles, dem_index n)
{
    const double x[8] = {0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0};
    const dem_index corners[6] = {0, 1, 2, 0, 2, 3};
    scene_open(s, 4, x, masses, 2, corners, obstacles, n);
}

static void close_contact(scene *s, dem_index k, dem_index feature, int sign)
{
    assert_ok(contact_set_close(&s->c.set, k, (contact_point){.feature = feature, .slide = sign}));
}

/* ---- the list ---- */

TEST(nodes_come_first_and_then_edges_that_know_their_neighbours)
{
    CLEANUP(scene_close) scene s;
    open_square(&s, roofs, 2);
    const contact_set *c = &s.c.set;
    assert_int_equal(c->n, 8);
    for (dem_index k = 0; k < 4; k++) {
        assert_int_equal(c->list[k].node, k);
        assert_false(candidate_is_edge(&c->list[k]));
        assert_int_equal(c->of_node[k], k);
        const contact_candidate *edge = &c->list[scene_edge(&s, k, (k + 1) % 4)];
        assert_int_equal(edge->previous, (k + 3) % 4);
        assert_int_equal(edge->next, (k + 2) % 4);
    }
    for (dem_index k = 0; k < 8; k++) {
        assert_int_equal(c->list[k].n_closed, 0);
        assert_int_equal(c->list[k].behind[0], -1);
        assert_int_equal(c->list[k].behind[1], -1);
    }
}

TEST(edges_are_candidates_only_where_there_are_vertices_and_if_asked_for)
{
    CLEANUP(scene_close) scene flat, s;
    CLEANUP(automaton_destroy) automaton without;
    open_square(&flat, &plane, 1);
    open_square(&s, roofs, 2);
    assert_int_equal(flat.c.set.n, 4);
    contact_rule rule = s.c.set.scene.rule;
    rule.vertices = false;
    assert_ok(automaton_create(&without, &s.acting, &rule));
    assert_int_equal(without.set.n, 4);
}

TEST(a_node_that_may_not_touch_is_no_candidate)
{
    const double x[4] = {0.0, 1.0, 1.0, 1.0};
    const unsigned char fixed[2] = {1, 0};
    CLEANUP(scene_close) scene s;
    CLEANUP(dem_lattice_free)
    dem_lattice lattice = support_lattice(2, x, masses, 1, (dem_index[]){0, 1}, 1.0, 1.0, fixed);
    scene_start(&s, &lattice, &plane, 1);
    assert_int_equal(s.c.set.n, 1);
    assert_int_equal(s.c.set.of_node[0], -1);
    assert_int_equal(s.c.set.of_node[1], 0);
}

/* An edge runs one way, and 0-2 is inside. */
TEST(a_key_finds_its_candidate_and_no_other)
{
    CLEANUP(scene_close) scene s;
    open_square(&s, roofs, 2);
    const contact_set *c = &s.c.set;
    for (dem_index k = 0; k < c->n; k++) assert_int_equal(contact_set_find(c, candidate_key(&c->list[k])), k);
    assert_int_equal(contact_set_find(c, (contact_key){1, 0}), -1);
    assert_int_equal(contact_set_find(c, (contact_key){0, 2}), -1);
}

/* ---- another surface ---- */

/* That of the square's first triangle alone: edges 0-1, 1-2 and 2-0, and no node 3. */
static surface half_surface(const scene *s)
{
    unsigned char flags[4];
    dem_lattice lattice = s->model->lattice;
    surface half;
    lattice.n_triangles = 1;
    lattice.flags = flags;
    assert_ok(mesh_edges_contact_flags(flags, &lattice));
    assert_ok(surface_compile(&half, &lattice, SURFACE_TOUCHING));
    return half;
}

TEST(candidates_of_both_surfaces_stay_what_they_are_under_new_numbers)
{
    CLEANUP(scene_close) scene s;
    open_square(&s, roofs, 2);
    contact_set *c = &s.c.set;
    CLEANUP(surface_free) surface half = half_surface(&s);
    const contact_key kept[5] = {{0, -1}, {1, -1}, {2, -1}, {0, 1}, {1, 2}};
    contact_candidate before[5];
    assert_ok(contact_set_close(c, 1, (contact_point){.feature = 3, .slide = -1, .force = 5.0}));
    assert_ok(
        contact_set_close(c, scene_edge(&s, 1, 2), (contact_point){.feature = 1, .place = 0.25, .friction = 2.0}));
    for (int k = 0; k < 5; k++) {
        contact_candidate *candidate = &c->list[contact_set_find(c, kept[k])];
        candidate->storm = (contact_storm){.start = 0.5, .n = k};
        candidate->clearance = (contact_clearance){true, 1.0 + k, 2.0 + k, {{3.0, 4.0}, {5.0, 6.0}}, 7.0 + k};
        c->forces.force[contact_set_find(c, kept[k])][0] = (contact_force){k, -k};
        before[k] = *candidate;
    }
    assert_ok(contact_set_follow_surface(c, &half));
    assert_int_equal(c->n, 6);
    assert_int_equal(c->of_node[3], -1);
    assert_int_equal(contact_set_find(c, (contact_key){2, 3}), -1);
    assert_int_equal(c->forces.n_groups, 1);
    const contact_candidate inner = c->list[contact_set_find(c, (contact_key){2, 0})];
    assert_int_equal(inner.n_closed, 0);
    assert_false(inner.clearance.inactive);
    for (int k = 0; k < 5; k++) {
        const dem_index number = contact_set_find(c, kept[k]);
        contact_candidate *candidate = &c->list[number], then = before[k];
        if (k >= 3) { /* the boundary goes on otherwise */
            then.previous = k == 3 ? 2 : 0;
            then.next = k == 3 ? 2 : 0;
            candidate_forget_clearance(&then);
        }
        assert_memory_equal(candidate, &then, sizeof then);
        assert_close(c->forces.force[number][0].normal, k, 0.0);
        assert_close(c->forces.force[number][0].tangent, -k, 0.0);
    }
    assert_ok(contact_set_follow_surface(c, &s.model->surface));
    assert_int_equal(c->n, 8);
    for (dem_index k = 0; k < 4; k++) assert_int_equal(c->list[scene_edge(&s, k, (k + 1) % 4)].next, (k + 2) % 4);
    assert_int_equal(c->list[scene_edge(&s, 1, 2)].closed[0].feature, 1);
}

static dem_status count_event(void *context, const dem_event *event)
{
    dem_index *n = context; /* [2] of node 3, of edge 2-3 */
    assert_int_equal(event->kind, DEM_EVENT_RELEASE);
    assert_int_equal(event->state, DEM_CONTACT_FREE);
    assert_int_equal(event->node, event->other < 0 ? 3 : 2);
    assert_true(event->other < 0 || event->other == 3);
    n[event->other >= 0]++;
    return DEM_OK;
}

static void release_orphans(scene *s, dem_index n[2])
{
    const event_listener listener = {count_event, n};
    n[0] = n[1] = 0;
    assert_ok(automaton_release_orphans(&s->c, 0.0, s->y, &listener));
}

/* A vertex in the notch between edges 1-2 and 2-3, and node 3 on a floor beside it. The surface may have changed again,
 * or come back, before they are released. */
TEST(contacts_of_candidates_that_go_are_released)
{
    for (int way = 0; way < 3; way++) {
        CLEANUP(scene_close) scene s;
        open_square(&s, roofs, 2);
        contact_set *c = &s.c.set;
        CLEANUP(surface_free) surface half = half_surface(&s);
        CLEANUP(surface_free) surface again = half_surface(&s);
        dem_index n[2];
        close_contact(&s, 3, 0, 1);
        close_contact(&s, scene_edge(&s, 1, 2), 0, -1);
        close_contact(&s, scene_edge(&s, 2, 3), 0, 1);
        close_contact(&s, scene_edge(&s, 2, 3), 1, 1);
        assert_ok(contact_set_follow_surface(c, &half));
        if (way > 0) assert_ok(contact_set_follow_surface(c, way == 1 ? &again : &s.model->surface));
        release_orphans(&s, n);
        assert_int_equal(n[0], way < 2 ? 1 : 0);
        assert_int_equal(n[1], way < 2 ? 2 : 0);
        assert_int_equal(c->ledger.counts.releases, way < 2 ? 3 : 0);
        release_orphans(&s, n);
        assert_int_equal(n[0] + n[1], 0);
    }
}

TEST(contacts_of_candidates_that_go_are_open)
{
    CLEANUP(scene_close) scene s;
    open_square(&s, roofs, 2);
    contact_set *c = &s.c.set;
    CLEANUP(surface_free) surface half = half_surface(&s);
    close_contact(&s, 3, 0, 1);
    close_contact(&s, scene_edge(&s, 1, 2), 0, -1);
    close_contact(&s, scene_edge(&s, 2, 3), 0, 1);
    assert_true(c->list[scene_edge(&s, 1, 2)].closed[0].held);
    assert_ok(contact_set_follow_surface(c, &half));
    assert_false(c->list[scene_edge(&s, 1, 2)].closed[0].held);
    assert_int_equal(contact_set_group_at(c, 3), -1);
    dem_index n_closed = 0;
    for (dem_index k = 0; k < c->n; k++) n_closed += c->list[k].n_closed;
    assert_int_equal(n_closed, 1);
}

TEST(a_new_edge_knows_what_its_nodes_are_behind)
{
    CLEANUP(scene_close) scene s;
    open_square(&s, roofs, 2);
    contact_set *c = &s.c.set;
    CLEANUP(surface_free) surface half = half_surface(&s);
    contact_set_pass_behind(c, 2, 1);
    contact_set_pass_behind(c, 3, 0);
    assert_ok(contact_set_follow_surface(c, &half));
    const contact_candidate *inner = &c->list[contact_set_find(c, (contact_key){2, 0})];
    assert_int_equal(inner->behind[0], 1);
    assert_int_equal(inner->behind[1], -1);
    assert_int_equal(c->ledger.counts.behind, 1);
}

/* ---- opening and closing ---- */

TEST(a_candidate_reports_which_of_its_contacts_is_on_a_feature)
{
    CLEANUP(scene_close) scene s;
    open_square(&s, roofs, 2);
    const dem_index k = scene_edge(&s, 0, 1);
    const contact_candidate *edge = &s.c.set.list[k];
    close_contact(&s, k, 1, 1);
    assert_int_equal(candidate_point_on(edge, 0), -1); /* there is a 0 behind the closed ones */
    close_contact(&s, k, 0, 1);
    assert_int_equal(candidate_point_on(edge, 0), 1);
    assert_int_equal(candidate_point_on(edge, 1), 0);
}

TEST(closing_appends_and_opening_keeps_the_other)
{
    CLEANUP(scene_close) scene s;
    open_square(&s, roofs, 2);
    const dem_index k = scene_edge(&s, 0, 1);
    contact_candidate *edge = &s.c.set.list[k];
    edge->clearance.inactive = true;
    close_contact(&s, k, 0, 1);
    assert_false(edge->clearance.inactive);
    close_contact(&s, k, 1, -1);
    assert_int_equal(edge->n_closed, 2);
    assert_int_equal(s.c.set.forces.n_groups, 1);
    assert_ok(contact_set_open(&s.c.set, k, 0));
    assert_int_equal(edge->n_closed, 1);
    assert_int_equal(edge->closed[0].feature, 1);
    assert_int_equal(edge->closed[0].slide, -1);
    assert_ok(contact_set_open(&s.c.set, k, 0));
    assert_int_equal(edge->n_closed, 0);
    assert_int_equal(s.c.set.forces.n_groups, 0);
    close_contact(&s, k, 0, 1);
    close_contact(&s, k, 1, -1);
    assert_ok(contact_set_open(&s.c.set, k, 1));
    assert_int_equal(edge->n_closed, 1);
    assert_int_equal(edge->closed[0].feature, 0);
}

/* Edge 0-1 joins its nodes; edge 2-3 is a group of its own until 1-2 closes as well. */
TEST(contacts_that_share_nodes_are_one_group)
{
    CLEANUP(scene_close) scene s;
    open_square(&s, roofs, 2);
    const contact_set *c = &s.c.set;
    const dem_index low = scene_edge(&s, 0, 1), right = scene_edge(&s, 1, 2), high = scene_edge(&s, 2, 3);
    close_contact(&s, 0, 0, 1);
    assert_false(contact_set_coupled(c, 0));
    assert_true(contact_set_coupled(c, low)); /* though it is open itself */
    assert_false(contact_set_coupled(c, right));
    close_contact(&s, low, 0, 1);
    close_contact(&s, high, 1, 1);
    assert_int_equal(c->forces.n_groups, 2);
    assert_int_equal(c->forces.group[0], c->forces.group[low]);
    assert_int_not_equal(c->forces.group[high], c->forces.group[low]);
    assert_true(contact_set_coupled(c, 0));
    assert_true(contact_set_coupled(c, 1)); /* a free node of a closed edge */
    assert_true(contact_set_coupled(c, right));
    assert_false(contact_set_coupled(c, high));
    close_contact(&s, right, 1, 1);
    assert_int_equal(c->forces.n_groups, 1);
    dem_index n_candidates = 0;
    for (dem_index k = c->forces.groups[0]; k >= 0; k = c->forces.next[k]) n_candidates++;
    assert_int_equal(n_candidates, 4);
    assert_true(contact_set_coupled(c, high));
}

/* ---- corners ---- */

static void check_touch(const contact_point *point, bool held, int sign)
{
    assert_int_equal(point->held, held);
    assert_int_equal(point->slide, sign);
}

/* One that stays when the other opens is at rest: with friction it sticks, without it slides. */
TEST(a_node_on_two_segments_is_held_by_both)
{
    for (int k = 0; k < 2; k++) {
        CLEANUP(scene_close) scene s;
        open_square(&s, k == 0 ? &groove : &rough_groove, 1);
        contact_candidate *candidate = &s.c.set.list[0];
        close_contact(&s, 0, 0, k == 0 ? 1 : 0);
        check_touch(&candidate->closed[0], false, k == 0 ? 1 : 0);
        close_contact(&s, 0, 1, -1);
        check_touch(&candidate->closed[0], true, 1);
        check_touch(&candidate->closed[1], true, 1);
        assert_ok(contact_set_open(&s.c.set, 0, 0));
        assert_int_equal(candidate->closed[0].feature, 1);
        check_touch(&candidate->closed[0], false, k == 0 ? 1 : 0);
    }
}

/* A vertex in the notch between edges 0-1 and 1-2. */
TEST(a_vertex_on_two_edges_that_meet_is_held_by_both)
{
    for (dem_index feature = 0; feature < 2; feature++) {
        CLEANUP(scene_close) scene s;
        open_square(&s, roofs, 2);
        const dem_index low = scene_edge(&s, 0, 1), right = scene_edge(&s, 1, 2);
        close_contact(&s, low, feature, -1);
        close_contact(&s, right, 1 - feature, 1);
        check_touch(&s.c.set.list[low].closed[0], false, -1); /* two different ones are no corner */
        check_touch(&s.c.set.list[right].closed[0], false, 1);
        close_contact(&s, right, feature, -1);
        check_touch(&s.c.set.list[low].closed[0], true, 1);
        check_touch(&s.c.set.list[right].closed[0], false, 1);
        check_touch(&s.c.set.list[right].closed[1], true, 1);
        assert_ok(contact_set_open(&s.c.set, right, 1));
        check_touch(&s.c.set.list[low].closed[0], false, feature == 1 ? 0 : 1); /* the second roof is rough */
    }
}

TEST(a_vertex_on_opposite_edges_is_not_held)
{
    CLEANUP(scene_close) scene s;
    open_square(&s, roofs, 2);
    const dem_index low = scene_edge(&s, 0, 1), high = scene_edge(&s, 2, 3);
    close_contact(&s, low, 0, 1);
    close_contact(&s, high, 0, 1);
    check_touch(&s.c.set.list[low].closed[0], false, 1);
    check_touch(&s.c.set.list[high].closed[0], false, 1);
}

/* ---- behind ---- */

TEST(what_a_node_is_behind_its_edges_know)
{
    CLEANUP(scene_close) scene s;
    open_square(&s, roofs, 2);
    contact_candidate *list = s.c.set.list;
    const dem_index before = scene_edge(&s, 0, 1), after = scene_edge(&s, 1, 2), far = scene_edge(&s, 2, 3);
    for (dem_index k = 0; k < s.c.set.n; k++) list[k].clearance.inactive = true;
    contact_set_pass_behind(&s.c.set, 1, 1);
    assert_int_equal(s.c.set.ledger.counts.behind, 1);
    assert_int_equal(list[1].behind[0], 1);
    assert_int_equal(list[before].behind[0], -1);
    assert_int_equal(list[before].behind[1], 1);
    assert_int_equal(list[after].behind[0], 1);
    assert_int_equal(list[after].behind[1], -1);
    assert_int_equal(list[far].behind[0], -1);
    assert_int_equal(list[far].behind[1], -1);
    assert_false(list[1].clearance.inactive || list[before].clearance.inactive || list[after].clearance.inactive);
    assert_true(list[far].clearance.inactive);
    contact_set_pass_behind(&s.c.set, 1, -1);
    assert_int_equal(s.c.set.ledger.counts.behind, 0);
    assert_int_equal(list[before].behind[1], -1);
    assert_int_equal(list[after].behind[0], -1);
}

/* ---- ledger and forces ---- */

/* 2 kg at 1.5 m above 3 kg on the floor, at rest; the spring of 100 N and 1 m between them is stretched to 1.5 m. */
static void open_stretched(scene *s)
{
    const double x[4] = {0.0, 0.0, 0.0, 1.0}, mass[2] = {3.0, 2.0};
    CLEANUP(dem_lattice_free)
    dem_lattice lattice = support_lattice(2, x, mass, 1, (dem_index[]){0, 1}, 1.0, 100.0, NULL);
    scene_start(s, &lattice, &plane, 1);
    scene_put(s, 0, 0.0, 0.0, 0.0, 0.0);
    scene_put(s, 1, 0.0, 1.5, 0.0, 0.0);
}

/* The upper node moved by (0, -0.25): m g dy = 2 * 10 * -0.25 and the spring's 50 (0.25^2 - 0.5^2). */
TEST(a_move_enters_the_energy_that_it_puts_in)
{
    CLEANUP(scene_close) scene s;
    open_stretched(&s);
    s.c.set.ledger.projection = exact_sum_of(1.0);
    contact_set_move(&s.c.set, 1, (vec2){0.0, -0.25}, s.y);
    assert_close(s.y[2], 0.0, 0.0);
    assert_close(s.y[3], 1.25, 0.0);
    assert_close(exact_sum_value(&s.c.set.ledger.projection), 1.0 - 5.0 - 9.375, 1e-13);
}

/* The spring, stretched to 1.5 m, pulls node 0 up with 50 N against its 30 N of weight, and nothing holds it down; a
 * sideways gravity of 0.5 m/s^2 does nothing to a smooth floor. */
TEST(the_force_on_a_contact_is_elastic_and_weight)
{
    CLEANUP(scene_close) scene s;
    open_stretched(&s);
    s.acting.gravity[0] = 0.5;
    close_contact(&s, 0, 0, 1);
    contact_set_solve_forces(&s.c.set, 0, (scene_state){0.0, s.y, scene_v(&s)});
    const contact_point *point = &s.c.set.list[0].closed[0];
    assert_close(point->force, 30.0 - 50.0, 1e-13);
    assert_close(point->friction, 0.0, 0.0);
}

/* The rough roof's ridge under (1 - s, s) of edge 0-1, masses 1 and 3 kg, that slides with u: N from
 * W N = g, W = (1 - s)^2/1 + s^2/3; friction -sign N/2. */
TEST(a_sliding_edge_stores_force_and_friction)
{
    const double fraction = 0.25, W = 0.5625 + 0.0625 / 3.0, u = -0.8;
    CLEANUP(scene_close) scene s;
    open_square(&s, roofs, 2);
    const dem_index k = scene_edge(&s, 0, 1);
    for (dem_index i = 0; i < 4; i++) {
        const vec2 at = vec2_at(s.y, i);
        scene_put(&s, i, at.x + 1.0 - fraction, at.y, u, 0.0);
    }
    close_contact(&s, k, 1, -1);
    contact_set_solve_forces(&s.c.set, k, (scene_state){0.0, s.y, scene_v(&s)});
    const contact_point *point = &s.c.set.list[k].closed[0];
    assert_close(point->force, g / W, 1e-13);
    assert_close(point->friction, 0.5 * g / W, 1e-13);
}

/* ---- events ---- */

TEST(an_event_of_a_node_reports_where_it_is_and_how_it_moves)
{
    CLEANUP(scene_close) scene s;
    open_square(&s, &rough_groove, 1);
    scene_put(&s, 2, 3.0, 3.0, 0.5, -0.25);
    const contact_instant now = {.t = 0.5, .x = s.y, .v = scene_v(&s)};
    dem_event event = contact_set_event(&s.c.set, 2, 1, DEM_EVENT_PASS, &now);
    assert_close(event.t, 0.5, 0.0);
    assert_int_equal(event.kind, DEM_EVENT_PASS);
    assert_int_equal(event.state, DEM_CONTACT_FREE);
    assert_int_equal(event.node, 2);
    assert_int_equal(event.other, -1);
    assert_int_equal(event.obstacle, 0);
    assert_int_equal(event.segment, 1);
    const double expected[10] = {3.0, 3.0, -sqrt(0.5), sqrt(0.5), 0.5, -0.25, 0.5, -0.25, 0.0, 0.0};
    const double actual[10] = {event.x[0],      event.x[1],     event.normal[0], event.normal[1], event.before[0],
                               event.before[1], event.after[0], event.after[1],  event.weight,    event.energy};
    for (int k = 0; k < 10; k++) assert_close(actual[k], expected[k], 1e-15);
    close_contact(&s, 2, 1, 1);
    event = contact_set_event(&s.c.set, 2, 1, DEM_EVENT_SLIP, &now);
    assert_int_equal(event.state, DEM_CONTACT_SLIP);
    s.c.set.list[2].closed[0].slide = 0;
    event = contact_set_event(&s.c.set, 2, 1, DEM_EVENT_STICK, &now);
    assert_int_equal(event.state, DEM_CONTACT_STICK);
    close_contact(&s, 2, 0, 1); /* held */
    event = contact_set_event(&s.c.set, 2, 1, DEM_EVENT_CLOSE, &now);
    assert_int_equal(event.state, DEM_CONTACT_STICK);
}

/* The second roof's ridge, the end of its first segment, under 0.75 of edge 0-1; the velocity is 1/4 and 3/4 of the
 * nodes'. */
TEST(an_event_of_an_edge_reports_the_vertex_and_the_weight_of_its_second_node)
{
    CLEANUP(scene_close) scene s;
    open_square(&s, roofs, 2);
    const dem_index k = scene_edge(&s, 0, 1);
    scene_put(&s, 0, 0.25, 0.0, 0.5, 0.0);
    scene_put(&s, 1, 1.25, 0.0, 0.5, -1.0);
    const contact_instant now = {.t = 0.25, .x = s.y, .v = scene_v(&s)};
    const dem_event event = contact_set_event(&s.c.set, k, 1, DEM_EVENT_RELEASE, &now);
    assert_int_equal(event.node, 0);
    assert_int_equal(event.other, 1);
    assert_int_equal(event.obstacle, 1);
    assert_int_equal(event.segment, 0);
    const double expected[7] = {0.75, 1.0, 0.0, 0.0, 1.0, 0.5, -0.75};
    const double actual[7] = {event.weight,    event.x[0],      event.x[1],     event.normal[0],
                              event.normal[1], event.before[0], event.before[1]};
    for (int q = 0; q < 7; q++) assert_close(actual[q], expected[q], 1e-15);
}
