/* SPDX-License-Identifier: BSD-3-Clause */
/* rigid_contact.c, rigid_pairs.c: forces of obstacles on rigid bodies against the gradient of their energy, what
 * obstacles feel, and what a step must not do. */
#include "surface_contact/rigid_contact.h"

#include <string.h>

#include "harness/cleanup_gsl.h"
#include "harness/message.h"
#include "verification/support.h"

static const dem_material rubber =
    SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0, .thickness = 1.0);
static const double wedge[8] = {-0.03, -0.02, 0.0, 0.004, 0.03, -0.02, -0.03, -0.02};
static const double wall[4] = {0.012, 0.006, 0.04, 0.007};

typedef struct scene {
    dem_lattice lattice;
    dem_model *model;
    contact_surface surface;
    rigid_contact *contact;
    double *x;
} scene;

/* A block of 30 x 15 mm at this place, turned, over a wedge and beside the free end of a wall that moves. */
static void open_scene(scene *s, double angle, const double place[2])
{
    dem_obstacle obstacles[2] = {SIZED(dem_obstacle, .n_points = 4, .points = wedge),
                                 SIZED(dem_obstacle, .n_points = 2, .points = wall)};
    obstacles[1].velocity[0] = -0.5;
    *s = (scene){.lattice = support_rectangle(0.03, 0.015, 5e-3, &rubber)};
    assert_ok(dem_lattice_stiffen(&s->lattice, DEM_GUIDE_NONE));
    dem_lattice_move(&s->lattice, angle, place);
    s->model = support_model(&s->lattice, obstacles, 2);
    assert_ok(contact_surface_compile(&s->surface, dem_model_lattice(s->model), 0.0, 1.0));
    assert_ok(rigid_contact_create(&s->contact, s->model, &s->surface));
    s->x = malloc(2 * (size_t)s->lattice.n_nodes * sizeof *s->x);
    memcpy(s->x, dem_model_lattice(s->model)->position, 2 * (size_t)s->lattice.n_nodes * sizeof *s->x);
}

static void close_scene(scene *s)
{
    rigid_contact_destroy(s->contact);
    contact_surface_free(&s->surface);
    dem_model_destroy(s->model);
    dem_lattice_free(&s->lattice);
    free(s->x);
}

static double energy_moved(scene *s, dem_index c, double by)
{
    const double here = s->x[c];
    s->x[c] = here + by;
    const double energy = rigid_contact_energy(s->contact, 0.01, s->x);
    s->x[c] = here;
    return energy;
}

/* Nodes move one by one here: the pairs do not know that the body is rigid. By differences of fourth order; energies of
 * up to 10 J are rounded by 1e-15 of that, which is 1e-8 N over steps of 1e-7 m.
 * \return how many forces were there */
static int compare_with_energy(scene *s)
{
    const double h = 1e-7;
    const rigid_pairs *p = &s->contact->list[0];
    int n = 0;
    assert_true(rigid_contact_evaluate(s->contact, 0.01, s->x));
    for (dem_index k = 0; k < p->n_nodes; k++)
        for (int d = 0; d < 2; d++) {
            const dem_index c = 2 * p->nodes[k] + d;
            const double near = energy_moved(s, c, h) - energy_moved(s, c, -h);
            const double far = energy_moved(s, c, 2.0 * h) - energy_moved(s, c, -2.0 * h);
            const double expected = -(8.0 * near - far) / (12.0 * h), force = p->force[2 * k + d];
            n += force != 0.0;
            assert_close(force, expected, 1e-6 * (1.0 + fabs(force)));
        }
    return n;
}

TEST(forces_are_minus_the_gradient_of_the_energy)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    int n = 0;
    for (int k = 0; k < 2000; k++) {
        CLEANUP(close_scene) scene s;
        const double place[2] = {0.02 * (gsl_rng_uniform(rng) - 0.5), 0.008 + 0.01 * gsl_rng_uniform(rng)};
        open_scene(&s, 6.3 * gsl_rng_uniform(rng), place);
        if (rigid_contact_check_start(s.contact, 0.01, s.x) == DEM_OK) n += compare_with_energy(&s);
    }
    print_message("# %d components of forces\n", n);
    assert_true(n > 100);
}

/* What obstacles push with is what they feel, and the power of the one that moves is its force times its velocity. */
TEST(obstacles_give_what_bodies_get)
{
    CLEANUP(close_scene) scene s;
    open_scene(&s, 0.0, (const double[2]){-0.0031, 0.0046});
    state_layout l = state_layout_of(2, s.lattice.n_nodes, 2, true);
    double *a = calloc((size_t)state_velocities(&l), sizeof *a);
    const rigid_pairs *p = &s.contact->list[0];
    vec2 on_body = {0.0, 0.0}, given = {0.0, 0.0};
    assert_true(rigid_contact_evaluate(s.contact, 0.0, s.x));
    for (dem_index k = 0; k < p->n_nodes; k++) on_body = vec2_add(on_body, vec2_at(p->force, k));
    for (dem_index q = 0; q < p->n_near; q++) given = vec2_add(given, rigid_contact_force(p, q));
    assert_true(on_body.y > 1.0 && fabs(on_body.x) > 1.0);
    assert_close(given.x, on_body.x, 1e-12 * vec2_norm(on_body));
    assert_close(given.y, on_body.y, 1e-12 * vec2_norm(on_body));
    rigid_contact_add_rates(s.contact, &l, s.x, a);
    const vec2 of_wall = vec2_at(a, state_impulse(&l, 1)), of_wedge = vec2_at(a, state_impulse(&l, 0));
    assert_close(of_wall.x + of_wedge.x, on_body.x, 1e-12 * vec2_norm(on_body));
    assert_true(of_wall.x < 0.0);
    assert_close(a[state_total_index(&l, STATE_OBSTACLE)], -0.5 * of_wall.x, 1e-14 * fabs(of_wall.x));
    assert_close(rigid_contact_power(s.contact, 0), 0.0, 0.0);
    free(a);
}

/* Through the wall and all of the list in one step. */
TEST(a_body_that_has_jumped_through_an_obstacle_has_crossed_it)
{
    CLEANUP(close_scene) scene s;
    open_scene(&s, 0.0, (const double[2]){0.025, 0.02});
    const size_t n = 2 * (size_t)s.lattice.n_nodes;
    rigid_crossing crossing;
    double *end = malloc(n * sizeof *end);
    for (size_t c = 0; c < n; c++) end[c] = s.x[c] - (c % 2 == 1 ? 0.001 : 0.0);
    assert_ok(rigid_contact_check_step(s.contact, s.x, 0.0, end, 1e-4, &crossing));
    for (size_t c = 1; c < n; c += 2) end[c] = s.x[c] - 0.06;
    assert_int_equal(rigid_contact_check_step(s.contact, s.x, 0.0, end, 1e-4, &crossing), DEM_ERROR_CONTACT);
    assert_int_equal(crossing.body, 0);
    assert_true(crossing.part > 0.0 && crossing.part < 1.0);
    free(end);
}

TEST(a_model_without_obstacles_has_no_rigid_contact)
{
    CLEANUP(close_scene) scene s;
    open_scene(&s, 0.0, (const double[2]){0.0, 0.1});
    CLEANUP(free_model) dem_model *alone = support_model(&s.lattice, NULL, 0);
    rigid_contact *contact = s.contact;
    assert_true(rigid_contact_is_driven(contact));
    assert_ok(rigid_contact_create(&contact, alone, &s.surface));
    assert_null(contact);
    assert_false(rigid_contact_is_driven(contact));
}

/* The largest second derivative of the energy along a coordinate, over the mass, by differences. */
static double largest_stiffness(scene *s)
{
    const double h = 1e-7, here = rigid_contact_energy(s->contact, 0.01, s->x);
    double largest = 0.0;
    for (dem_index c = 0; c < 2 * s->lattice.n_nodes; c++) {
        const double second = (energy_moved(s, c, h) - 2.0 * here + energy_moved(s, c, -h)) / (h * h);
        largest = fmax(largest, second / s->lattice.mass[c / 2]);
    }
    return largest;
}

/* As of elastic bodies, whose nodes move one by one: it is about twice the largest diagonal. Away from obstacles it is
 * 0. Differences are off by 1e-14 J/h^2 over the mass of a node, 0.02 kg: some 1e2 rad^2/s^2 of 1e6 and more. */
TEST(the_bound_of_the_stiffness_holds)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    double largest = 0.0;
    for (int k = 0; k < 2000; k++) {
        CLEANUP(close_scene) scene s;
        const double place[2] = {0.02 * (gsl_rng_uniform(rng) - 0.5), 0.008 + 0.01 * gsl_rng_uniform(rng)};
        open_scene(&s, 6.3 * gsl_rng_uniform(rng), place);
        if (rigid_contact_check_start(s.contact, 0.01, s.x) != DEM_OK) continue;
        const double bound = rigid_contact_stiffening(s.contact, 0.01, s.x), found = largest_stiffness(&s);
        assert_true(found <= bound + 1e3);
        if (bound > 1e6) largest = fmax(largest, found / bound);
    }
    assert_true(largest > 0.4); /* found 0.4994 */
    CLEANUP(close_scene) scene far;
    open_scene(&far, 0.0, (const double[2]){0.0, 0.1});
    assert_close(rigid_contact_stiffening(far.contact, 0.0, far.x), 0.0, 0.0);
}

/* ---- friction ---- */

/* The scene again, with friction, a little way after its anchors have been put where they are. */
static void open_rubbing(scene *s, vec2 way)
{
    dem_obstacle obstacles[2] = {SIZED(dem_obstacle, .n_points = 4, .points = wedge, .friction = 0.3),
                                 SIZED(dem_obstacle, .n_points = 2, .points = wall, .friction = 0.3)};
    obstacles[1].velocity[0] = -0.5;
    open_scene(s, 0.0, (const double[2]){-0.0031, 0.0046});
    rigid_contact_destroy(s->contact);
    contact_surface_free(&s->surface);
    dem_model_destroy(s->model);
    s->model = support_model(&s->lattice, obstacles, 2);
    assert_ok(contact_surface_compile(&s->surface, dem_model_lattice(s->model), 0.0, 1.0));
    assert_ok(rigid_contact_create(&s->contact, s->model, &s->surface));
    assert_true(rigid_contact_has_friction(s->contact));
    assert_ok(rigid_contact_settle(s->contact, 0.0, s->x));
    assert_close(rigid_contact_stored(s->contact, 0.0, s->x), 0.0, 0.0);
    for (dem_index i = 0; i < s->lattice.n_nodes; i++) vec2_put(s->x, i, vec2_add(vec2_at(s->x, i), way));
}

/* The wedge's tip rubs on an edge of the block, and the block's corner at the end of the wall: what friction does to
 * them adds up to nothing, and its power is that of its forces. */
TEST(friction_has_no_resultant_and_the_power_of_its_forces)
{
    CLEANUP(close_scene) scene s;
    open_rubbing(&s, (vec2){1e-6, 2e-6});
    const rigid_pairs *p = &s.contact->list[0];
    state_layout l = state_layout_of(2, s.lattice.n_nodes, 2, true);
    double *a = calloc((size_t)state_velocities(&l), sizeof *a), *v = malloc(2 * (size_t)s.lattice.n_nodes * sizeof *v);
    vec2 sum = {0.0, 0.0}, on_body = {0.0, 0.0};
    double moment = 0.0, size = 0.0, power = 0.0;
    for (dem_index i = 0; i < 2 * s.lattice.n_nodes; i++) v[i] = 0.1 * (double)i;
    assert_true(rigid_contact_evaluate(s.contact, 0.0, s.x));
    for (dem_index k = 0; k < p->n_places; k++) {
        const vec2 force = vec2_at(p->friction, k);
        sum = vec2_add(sum, force);
        moment += vec2_cross(vec2_at(p->places, k), force);
        size += vec2_norm(force);
        if (k < p->n_nodes) on_body = vec2_add(on_body, force);
        power -= vec2_dot(
            force, k < p->n_nodes ? vec2_at(v, p->nodes[k])
                                  : (vec2){k < rigid_pairs_place(p, p->obstacles->first_vertex[1]) ? 0.0 : -0.5, 0.0});
    }
    assert_true(p->anchors.now.n >= 2 && size > 1e-3);
    assert_close(vec2_norm(sum), 0.0, 1e-13 * size);
    assert_close(moment, 0.0, 1e-14 * size);
    rigid_contact_add_rates(s.contact, &l, v, a);
    const vec2 given = vec2_add(vec2_at(a, state_friction_impulse(&l, 0)), vec2_at(a, state_friction_impulse(&l, 1)));
    assert_close(vec2_norm(vec2_sub(given, on_body)), 0.0, 1e-13 * size);
    assert_close(a[state_total_index(&l, STATE_FRICTION)], power, 1e-12 * fabs(power));
    free(a);
    free(v);
}

/* What a step has reached changes no force and no energy, and lists made anew change no bit. */
TEST(neither_settling_nor_lists_change_friction)
{
    CLEANUP(close_scene) scene s;
    open_rubbing(&s, (vec2){3e-5, 2e-6});
    rigid_pairs *p = &s.contact->list[0];
    const size_t n = 2 * (size_t)p->n_nodes;
    double *before = malloc(n * sizeof *before);
    assert_true(rigid_contact_evaluate(s.contact, 0.0, s.x));
    memcpy(before, p->force, n * sizeof *before);
    const double stored = rigid_contact_stored(s.contact, 0.0, s.x);
    assert_true(stored > 0.0);
    for (int k = 0; k < 3; k++) {
        p->made = false;
        p->margin *= 0.1;
        assert_true(rigid_contact_evaluate(s.contact, 0.0, s.x));
        assert_memory_equal(p->force, before, n * sizeof *before);
    }
    assert_ok(rigid_contact_settle(s.contact, 0.0, s.x));
    assert_true(rigid_contact_evaluate(s.contact, 0.0, s.x));
    for (size_t c = 0; c < n; c++) assert_close(p->force[c], before[c], 1e-10 * (1.0 + fabs(before[c])));
    assert_close(rigid_contact_stored(s.contact, 0.0, s.x), stored, 1e-10 * stored);
    free(before);
}

/* The spring adds to what the pairs do. */
TEST(stiffening_knows_the_springs_of_friction)
{
    CLEANUP(close_scene) scene s;
    open_rubbing(&s, (vec2){0.0, 0.0});
    const double with = rigid_contact_stiffening(s.contact, 0.0, s.x);
    anchor_set_clear(&s.contact->list[0].anchors);
    assert_true(with > 1.001 * rigid_contact_stiffening(s.contact, 0.0, s.x));
}

/* Numbers from a file are not trusted. */
TEST(records_are_those_of_what_pushes)
{
    CLEANUP(close_scene) scene s;
    open_rubbing(&s, (vec2){0.0, 0.0});
    rigid_pairs *p = &s.contact->list[0];
    anchor_record good[16], bad[16];
    const dem_index n = p->anchors.now.n;
    assert_true(n >= 2 && n <= 16);
    for (dem_index k = 0; k < n; k++) good[k] = anchor_set_record(&p->anchors, k);
    const dem_index nodes[4] = {-1, p->n_nodes, p->n_places, good[0].node + 1};
    for (int k = 0; k < 4; k++) {
        memcpy(bad, good, sizeof bad);
        bad[0].node = nodes[k];
        assert_int_equal(rigid_contact_restore(s.contact, 0, bad, n, 0.0, s.x), DEM_ERROR_IO);
    }
    assert_int_equal(rigid_contact_restore(s.contact, 0, good, n - 1, 0.0, s.x), DEM_ERROR_IO);
    assert_ok(rigid_contact_restore(s.contact, 0, good, n, 0.0, s.x));
    assert_int_equal(p->anchors.now.n, n);
}

static void shift(scene *s, double dx, double dy)
{
    for (dem_index i = 0; i < s->lattice.n_nodes; i++) vec2_put(s->x, i, vec2_add(vec2_at(s->x, i), (vec2){dx, dy}));
}

/* A block that rubs on a corner goes along with it where the corner moves: that changes no force, though its vertices
 * have new places. */
TEST(friction_goes_along_with_an_obstacle)
{
    static const double corner[8] = {-0.0159, 0.1, -0.0159, -0.0085, -0.0139, -0.0085, 0.1, -0.0085};
    dem_obstacle obstacle = SIZED(dem_obstacle, .n_points = 4, .points = corner, .friction = 0.3);
    obstacle.velocity[0] = 1.0;
    obstacle.velocity[1] = 0.3;
    CLEANUP(close_scene) scene s;
    open_scene(&s, 0.0, (const double[2]){0.0, 0.0});
    rigid_contact_destroy(s.contact);
    contact_surface_free(&s.surface);
    dem_model_destroy(s.model);
    s.model = support_model(&s.lattice, &obstacle, 1);
    assert_ok(contact_surface_compile(&s.surface, dem_model_lattice(s.model), 0.0, 1.0));
    assert_ok(rigid_contact_create(&s.contact, s.model, &s.surface));
    vec2 low = {INFINITY, INFINITY};
    for (dem_index i = 0; i < s.lattice.n_nodes; i++) {
        low.x = fmin(low.x, s.x[2 * i]);
        low.y = fmin(low.y, s.x[2 * i + 1]);
    }
    shift(&s, corner[2] + 8e-4 - low.x, corner[3] + 9e-4 - low.y);
    const rigid_pairs *p = &s.contact->list[0];
    assert_ok(rigid_contact_settle(s.contact, 0.0, s.x));
    shift(&s, -1e-5, 0.0);
    assert_true(rigid_contact_evaluate(s.contact, 0.0, s.x));
    const vec2 before = vec2_at(p->friction, p->anchors.now.at[0].node);
    shift(&s, 0.01, 0.003);
    assert_true(rigid_contact_evaluate(s.contact, 0.01, s.x));
    const vec2 after = vec2_at(p->friction, p->anchors.now.at[0].node);
    assert_true(vec2_norm(before) > 0.0);
    assert_close(vec2_norm(vec2_sub(after, before)), 0.0, 1e-9 * vec2_norm(before));
}
