/* SPDX-License-Identifier: BSD-3-Clause */
/* Ranks that share bodies which touch each other and themselves, also rigid ones, as threads: the motion, what is seen
 * of contact, and checkpoints have the bits of the whole model in one process, whoever owns which node.
 * `test_ranks_bodies [long]`. */
#include <string.h>

#include "ask.h"
#include "rank_runs.h"
#include "scattered.h"
#include "support.h"

#include "base/random.h"
#include "domain/partition.h"

static const double spacing = 5e-3;
static bool is_long = false;
static const dem_method methods[] = {DEM_METHOD_FEHLBERG45, DEM_METHOD_VERLET, DEM_METHOD_DOPRI45, DEM_METHOD_RK4};
static const double floor_points[4] = {-1.0, 0.0, 1.0, 0.0};

/* ---- scenes ---- */

typedef enum kind {
    FREE,     /* two squares in free space, one of which hits the other */
    FOLDING,  /* a body that touches itself */
    FALLING,  /* two squares, one above the other, that fall on a floor */
    HAMMERED, /* a rigid hammer on a guide hits a block on a floor */
    TOPPLING, /* a rigid block on its edge, beside a soft one */
    N_KINDS
} kind;

static dem_material rubber(double damping_time)
{
    return (dem_material)SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0,
                               .thickness = 1.0, .guard = 0.02, .damping_time = damping_time);
}

static dem_lattice make_block(double width, double height, const dem_material *material)
{
    dem_lattice l = support_rectangle(width, height, spacing, material);
    dem_lattice_move(&l, 0.0, (const double[2]){0.0, -support_bottom(&l)});
    return l;
}

static void add(dem_lattice *to, dem_lattice body)
{
    assert_ok(dem_lattice_append(to, &body));
    dem_lattice_free(&body);
}

/* Two legs on a foot, which come together. */
static dem_lattice make_fork(const dem_material *material)
{
    dem_lattice l = make_block(0.06, 0.07, material);
    CLEANUP(free_memory) bool *keep = malloc((size_t)l.n_nodes * sizeof *keep);
    for (dem_index i = 0; i < l.n_nodes; i++) keep[i] = l.x[2 * i + 1] < 0.021 || fabs(l.x[2 * i]) > 0.006;
    assert_ok(dem_lattice_select(&l, keep));
    l.velocity = calloc(2 * (size_t)l.n_nodes, sizeof *l.velocity);
    for (dem_index i = 0; i < l.n_nodes; i++)
        l.velocity[2 * i] = l.x[2 * i + 1] < 0.03 ? 0.0 : (l.x[2 * i] > 0.0 ? -8.0 : 8.0);
    return l;
}

static dem_lattice make_bodies(kind k)
{
    static const double along[2] = {6.0, 0.5}, down[2] = {0.3, -4.0}, back[2] = {-4.0, -4.0};
    const dem_material soft = rubber(k == FALLING ? 5e-6 : 0.0), hard = rubber(0.0);
    if (k == FOLDING) return make_fork(&soft);
    dem_lattice l = make_block(0.06, 0.05, &soft);
    dem_lattice above = make_block(k == HAMMERED ? 0.03 : 0.045, 0.03, &hard);
    if (k == FREE) {
        assert_ok(dem_lattice_launch(&l, along));
        dem_lattice_move(&above, 0.3, (const double[2]){0.065, 0.01});
        add(&l, above);
        return l;
    }
    dem_lattice_move(&l, 0.0, (const double[2]){0.0, 3e-4});
    if (k != HAMMERED) assert_ok(dem_lattice_launch(&l, k == TOPPLING ? back : down));
    if (k != FALLING) assert_ok(dem_lattice_stiffen(&above, k == HAMMERED ? DEM_GUIDE_Y : DEM_GUIDE_NONE));
    dem_lattice_move(&above, k == HAMMERED ? 0.0 : 0.2, (const double[2]){0.0, 0.0});
    dem_lattice_move(&above, 0.0, (const double[2]){k == TOPPLING ? -0.0575 : 0.0, 0.0});
    const double bottom = k == TOPPLING ? 1.5e-3 : support_top(&l) + 1.5e-3;
    dem_lattice_move(&above, 0.0, (const double[2]){0.0, bottom - support_bottom(&above)});
    assert_ok(dem_lattice_launch(&above, k == TOPPLING ? (const double[2]){6.0, -3.0} : (const double[2]){0.0, -6.0}));
    add(&l, above);
    return l;
}

static bool has_pushing_surfaces(const dem_simulation *s, const rank_runs_outcome *so_far)
{
    (void)so_far;
    return ask_surfaces(s).pushing > 0;
}

static void open_scene(rank_runs_scene *s, kind k, dem_method method, dem_contact_method contact)
{
    const dem_obstacle floor =
        SIZED(dem_obstacle, .n_points = 2, .points = floor_points, .restitution = 0.3, .friction = 0.4);
    CLEANUP(dem_lattice_free) dem_lattice l = make_bodies(k);
    *s = (rank_runs_scene){.model = support_model(&l, &floor, k >= FALLING),
                           .options = dem_options_default(),
                           .t_end = 1.2e-3,
                           .keeps = has_pushing_surfaces};
    s->options.method = method;
    s->options.contact = contact;
    s->options.bodies = k == FREE ? DEM_BODIES_OTHERS : DEM_BODIES_ALL;
    s->options.contact_friction = k == FOLDING ? 0.0 : 0.5;
    s->options.checkpoint_steps = 25;
    s->options.gravity[1] = k >= FALLING ? -9.81 : 0.0;
}

/* ---- the same bits ---- */

/* Each node to any rank. */
static void draw(dem_index n, int n_ranks, uint64_t seed, int32_t *owner)
{
    for (dem_index i = 0; i < n; i++) owner[i] = (int32_t)(random_mix(seed + (uint64_t)i) % (uint64_t)n_ranks);
}

static void share(const rank_runs_scene *s, int n_ranks, const int32_t *owner, const rank_runs_outcome *whole)
{
    const int n_rings = s->options.method == DEM_METHOD_FEHLBERG45 ? 3 : 0;
    rank_runs_assert_shared(s, n_ranks, &(domain_model_shares){.owner = owner, .touching = true, .n_rings = n_rings},
                            NULL, whole);
}

/* In compact domains, in scattered tiles, and by lot. */
static void check(kind k, dem_method method, dem_contact_method contact)
{
    static const int numbers[] = {3, 1, 2, 4, 7};
    rank_runs_scene s;
    open_scene(&s, k, method, contact);
    const dem_lattice *l = dem_model_lattice(s.model);
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)l->n_nodes * sizeof *owner);
    rank_runs_outcome whole = rank_runs_alone(&s);
    assert_string_equal(whole.message, "");
    assert_true(whole.kept != NULL && (k < FALLING || whole.n_notes > 0));
    for (int q = 0; q < (is_long ? 5 : 1); q++) {
        assert_ok(partition_bisect(l, numbers[q], owner));
        share(&s, numbers[q], owner, &whole);
        if (numbers[q] == 1) continue;
        scatter(l, 4.1 * spacing, numbers[q], owner);
        share(&s, numbers[q], owner, &whole);
        draw(l->n_nodes, numbers[q], (uint64_t)k, owner);
        share(&s, numbers[q], owner, &whole);
    }
    rank_runs_free_outcome(&whole);
    dem_model_destroy(s.model);
}

static void check_all(kind k)
{
    check(k, DEM_METHOD_FEHLBERG45, DEM_CONTACT_LOCAL);
    check(k, DEM_METHOD_VERLET, DEM_CONTACT_LOCAL);
    if (k >= FALLING) check(k, DEM_METHOD_FEHLBERG45, DEM_CONTACT_EXACT);
    for (int m = 2; m < 4 && is_long; m++) check(k, methods[m], DEM_CONTACT_LOCAL);
}

TEST(bodies_that_hit_each_other_have_the_bits_of_one_process)
{
    check_all(FREE);
}

TEST(a_body_that_touches_itself_has_the_bits_of_one_process)
{
    check_all(FOLDING);
}

TEST(bodies_that_fall_on_each_other_and_a_floor_have_the_bits_of_one_process)
{
    check_all(FALLING);
}

TEST(a_rigid_body_on_a_guide_has_the_bits_of_one_process)
{
    check_all(HAMMERED);
}

TEST(a_rigid_body_on_a_floor_with_friction_has_the_bits_of_one_process)
{
    check_all(TOPPLING);
}

/* Another number of ranks goes on with closed contacts and friction. */
TEST(led_runs_show_contact_and_go_on_from_it)
{
    for (kind k = FREE; k < N_KINDS; k++) {
        rank_runs_scene s;
        open_scene(&s, k, DEM_METHOD_FEHLBERG45, DEM_CONTACT_LOCAL);
        rank_runs_outcome whole = rank_runs_alone(&s);
        assert_true(whole.kept != NULL && whole.kept_t < 0.9 * s.t_end);
        rank_runs_assert_led(&s, 3, NULL, &whole);
        rank_runs_assert_led(&s, 2, &whole, &whole);
        if (is_long) rank_runs_assert_led(&s, 7, &whole, &whole);
        rank_runs_free_outcome(&whole);
        dem_model_destroy(s.model);
    }
}

/* ---- what is refused ---- */

/* All ranks of three end with a message. */
static void assert_said(const rank_runs_scene *s, bool touching, const char *message)
{
    const dem_lattice *l = dem_model_lattice(s->model);
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)l->n_nodes * sizeof *owner);
    rank_runs_outcome all[3];
    draw(l->n_nodes, 3, 1, owner);
    rank_runs_make_outcomes(s, 3, all);
    rank_runs_together(s, 3, &(domain_model_shares){.owner = owner, .touching = touching}, NULL, all);
    for (int k = 0; k < 3; k++) assert_string_equal(all[k].message, message);
    rank_runs_free_outcomes(all, 3);
}

TEST(a_model_without_surfaces_refuses_bodies_that_touch)
{
    rank_runs_scene s;
    open_scene(&s, FREE, DEM_METHOD_FEHLBERG45, DEM_CONTACT_LOCAL);
    assert_said(
        &s, false,
        "bodies touch in a model of which ranks share no surfaces: it has to be made for options in which they do");
    dem_model_destroy(s.model);
}

/* With the message of a process alone, and its numbers of nodes: steps so long that surfaces cross; and bodies that
 * overlap at the start. */
TEST(messages_name_nodes_of_the_whole)
{
    for (int overlaps = 0; overlaps < 2; overlaps++) {
        rank_runs_scene s;
        open_scene(&s, FREE, DEM_METHOD_VERLET, DEM_CONTACT_LOCAL);
        s.options.fixed_step = 2e-5;
        CLEANUP(dem_lattice_free) dem_lattice l = dem_lattice_empty();
        assert_ok(dem_lattice_append(&l, dem_model_lattice(s.model)));
        for (dem_index i = 0; i < l.n_nodes; i++) {
            if (l.body[i] == 1 && overlaps) l.position[2 * i] -= 0.01;
            if (l.body[i] == 0) l.velocity[2 * i] = 600.0;
        }
        dem_model_destroy(s.model);
        s.model = support_model(&l, NULL, 0);
        rank_runs_outcome whole = rank_runs_alone(&s);
        assert_int_equal(whole.status, overlaps ? DEM_ERROR_MODEL : DEM_ERROR_CONTACT);
        assert_said(&s, true, whole.message);
        rank_runs_free_outcome(&whole);
        dem_model_destroy(s.model);
    }
}

int main(int argc, char **argv)
{
    is_long = argc > 1 && strcmp(argv[1], "long") == 0;
    return test_run();
}
