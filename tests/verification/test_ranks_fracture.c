/* SPDX-License-Identifier: BSD-3-Clause */
/* Ranks that share bodies which break, beside others which do not, as threads: the motion, every break with its stress,
 * energy and fragment, what is broken, and checkpoints have the bits of the whole model in one process, whoever owns
 * which node. `test_ranks_fracture [long]`. */
#include <string.h>

#include "rank_runs.h"
#include "scattered.h"
#include "support.h"

#include "base/checkpoint_entries.h"
#include "domain/partition.h"

static const double spacing = 8e-3;
static bool is_long = false;
static const double floor_points[4] = {-1.0, 0.0, 1.0, 0.0};

/* ---- scenes ---- */

typedef enum kind {
    SHATTERED, /* by stress: a block that falls on a floor, and one that does not break on it; all touch */
    STRETCHED, /* by strain: a block that flies apart in free space, and one that it hits, which does not break */
    SOFTENED,  /* a damped block with a fracture energy that falls on a floor; nothing touches but that */
    CRUSHED,   /* by pressure, too: a block that falls on a floor, and touches itself */
    N_KINDS
} kind;

static const double speeds[N_KINDS] = {-8.0, 0.0, -8.0, -9.0}; /* m/s, upwards */

static dem_material material_of(kind k)
{
    dem_material m = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0,
                           .thickness = 1.0, .guard = 0.02);
    if (k == STRETCHED) m.critical_stretch = 0.02;
    if (k != STRETCHED) m.strength = k == SHATTERED ? 1.2e5 : k == SOFTENED ? 9e4 : 3e5;
    if (k == CRUSHED) m.compressive_strength = 9e5;
    if (k == SOFTENED) {
        m.fracture_energy = 22.5;
        m.damping_time = 4e-6;
    }
    return m;
}

static void add(dem_lattice *to, dem_lattice body)
{
    assert_ok(dem_lattice_append(to, &body));
    dem_lattice_free(&body);
}

/* Strengths of triangles differ, so that not all of a row break at once. */
static dem_lattice make_brittle(kind k)
{
    const dem_material solid = material_of(k);
    dem_lattice l = support_rectangle(0.09, 0.06, spacing, &solid);
    dem_lattice_move(&l, 0.0, (const double[2]){0.0, 3e-4 - support_bottom(&l)});
    for (dem_index t = 0; t < l.n_triangles && k != STRETCHED && k != SOFTENED; t++)
        l.strength[t] *= 1.0 + 0.1 * sin(3.0 * (double)t);
    l.velocity = calloc(2 * (size_t)l.n_nodes, sizeof *l.velocity);
    for (dem_index i = 0; i < l.n_nodes; i++) {
        l.velocity[2 * i] = k == STRETCHED ? 60.0 * l.x[2 * i] + 900.0 * l.x[2 * i] * l.x[2 * i] : 0.3;
        l.velocity[2 * i + 1] = speeds[k];
    }
    return l;
}

/* So fine that not all of it is common. It comes first: what breaks has other numbers on ranks than in the whole. */
static void add_tough(dem_lattice *l, kind k)
{
    const dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0,
                                      .density = 1050.0, .thickness = 1.0, .guard = 0.02);
    const bool beside = k == STRETCHED;
    dem_lattice other = support_rectangle(0.08, 0.07, 0.5 * spacing, &rubber);
    dem_lattice_move(&other, 0.1, (const double[2]){beside ? 0.092 : 0.0, 0.0});
    dem_lattice_move(&other, 0.0,
                     (const double[2]){0.0, beside ? 0.0 : support_top(l) + 1.2e-3 - support_bottom(&other)});
    assert_ok(dem_lattice_launch(&other, beside ? (const double[2]){-4.0, 0.0} : (const double[2]){0.0, -9.0}));
    add(&other, *l);
    *l = other;
}

static bool has_broken(const dem_simulation *s, const rank_runs_outcome *so_far)
{
    (void)s;
    return so_far->n_breaks > 0;
}

static void open_scene(rank_runs_scene *s, kind k, dem_method method, dem_contact_method contact)
{
    const dem_obstacle floor =
        SIZED(dem_obstacle, .n_points = 2, .points = floor_points, .restitution = 0.2, .friction = 0.4);
    CLEANUP(dem_lattice_free) dem_lattice l = make_brittle(k);
    if (k <= STRETCHED) add_tough(&l, k);
    *s = (rank_runs_scene){.model = support_model(&l, &floor, k != STRETCHED),
                           .options = dem_options_default(),
                           .t_end = 0.9e-3,
                           .is_seen_at_events = true,
                           .keeps = has_broken};
    s->options.method = method;
    s->options.contact = contact;
    s->options.bodies = k == SOFTENED ? DEM_BODIES_NONE : DEM_BODIES_ALL;
    s->options.contact_friction = k == SHATTERED ? 0.3 : 0.0;
    s->options.checkpoint_steps = 6;
    s->options.gravity[1] = k == STRETCHED ? 0.0 : -9.81;
}

/* ---- the same bits ---- */

static void share(const rank_runs_scene *s, int n_ranks, const int32_t *owner, const rank_runs_outcome *whole)
{
    rank_runs_assert_shared(s, n_ranks,
                            &(domain_model_shares){.owner = owner, .touching = s->options.bodies != DEM_BODIES_NONE},
                            NULL, whole);
}

/* In compact domains, and in scattered tiles. */
static void check(kind k, dem_method method, dem_contact_method contact)
{
    static const int numbers[] = {3, 1, 2, 7};
    rank_runs_scene s;
    open_scene(&s, k, method, contact);
    const dem_lattice *l = dem_model_lattice(s.model);
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)l->n_nodes * sizeof *owner);
    rank_runs_outcome whole = rank_runs_alone(&s);
    const rank_runs_view *end = &whole.views[RANK_RUNS_STOPS - 1];
    assert_string_equal(whole.message, "");
    assert_true(k != SOFTENED || end->energy.fracture > 0.0);
    assert_true(k == SOFTENED || whole.n_breaks > 0);
    assert_true(k > STRETCHED || end->surfaces.pushing > 0 || contact == DEM_CONTACT_EXACT);
    for (int q = 0; q < (is_long ? 4 : 1); q++) {
        assert_ok(partition_bisect(l, numbers[q], owner));
        share(&s, numbers[q], owner, &whole);
        scatter(l, 4.1 * spacing, numbers[q], owner);
        share(&s, numbers[q], owner, &whole);
    }
    rank_runs_free_outcome(&whole);
    dem_model_destroy(s.model);
}

static void check_all(kind k)
{
    check(k, DEM_METHOD_FEHLBERG45, DEM_CONTACT_LOCAL);
    if (k == SOFTENED && !is_long) return; /* it has thousands of events */
    check(k, DEM_METHOD_VERLET, DEM_CONTACT_LOCAL);
    check(k, DEM_METHOD_FEHLBERG45, DEM_CONTACT_EXACT);
    if (is_long) check(k, DEM_METHOD_RK4, DEM_CONTACT_LOCAL);
}

TEST(blocks_that_break_by_stress_have_the_bits_of_one_process)
{
    check_all(SHATTERED);
}

TEST(springs_that_break_by_strain_have_the_bits_of_one_process)
{
    check_all(STRETCHED);
}

TEST(blocks_that_soften_have_the_bits_of_one_process)
{
    check_all(SOFTENED);
}

TEST(blocks_that_are_crushed_have_the_bits_of_one_process)
{
    check_all(CRUSHED);
}

/* Another number of ranks goes on with what is broken. */
TEST(led_runs_show_breaks_and_go_on_with_them)
{
    for (kind k = SHATTERED; k < N_KINDS; k++) {
        rank_runs_scene s;
        open_scene(&s, k, DEM_METHOD_FEHLBERG45, DEM_CONTACT_LOCAL);
        rank_runs_outcome whole = rank_runs_alone(&s);
        assert_true(whole.kept != NULL && (k == SOFTENED || whole.n_notes > whole.kept_notes));
        rank_runs_assert_led(&s, 3, NULL, &whole);
        rank_runs_assert_led(&s, 2, &whole, &whole);
        if (is_long) rank_runs_assert_led(&s, 7, &whole, &whole);
        rank_runs_free_outcome(&whole);
        dem_model_destroy(s.model);
    }
}

/* ---- what is refused ---- */

/* Stretched at the start by more than springs stand: all ranks say so of the spring that a process alone names. */
TEST(messages_name_elements_of_the_whole)
{
    rank_runs_scene s;
    open_scene(&s, STRETCHED, DEM_METHOD_FEHLBERG45, DEM_CONTACT_LOCAL);
    CLEANUP(dem_lattice_free) dem_lattice l = dem_lattice_empty();
    assert_ok(dem_lattice_append(&l, dem_model_lattice(s.model)));
    for (dem_index i = 0; i < l.n_nodes; i++)
        if (l.body[i] == 1) l.position[2 * i] *= 1.03;
    dem_model_destroy(s.model);
    s.model = support_model(&l, NULL, 0);
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)l.n_nodes * sizeof *owner);
    assert_ok(partition_bisect(&l, 3, owner));
    rank_runs_outcome whole = rank_runs_alone(&s);
    assert_int_equal(whole.status, DEM_ERROR_MODEL);
    assert_non_null(strstr(whole.message, "beyond its critical stretch"));
    share(&s, 3, owner, &whole);
    rank_runs_free_outcome(&whole);
    dem_model_destroy(s.model);
}

/* Not all ranks have what does not break by itself. */
TEST(what_a_program_has_broken_elsewhere_is_refused)
{
    static const dem_index first = 0;
    rank_runs_scene s;
    dem_simulation *alone;
    open_scene(&s, SHATTERED, DEM_METHOD_FEHLBERG45, DEM_CONTACT_LOCAL);
    rank_runs_outcome from = rank_runs_make_outcome(&s), led = rank_runs_make_outcome(&s);
    assert_ok(dem_simulation_create(&alone, s.model, &s.options));
    assert_ok(dem_simulation_break(alone, &first, 1, NULL, 0));
    assert_ok(dem_simulation_advance(alone, 1e-4));
    assert_ok(dem_checkpoint_create(&from.kept));
    assert_ok(checkpoint_entries_copy(from.kept, dem_simulation_checkpoint(alone)));
    rank_runs_led(&s, 2, &from, &led);
    assert_string_equal(led.message,
                        "in the checkpoint 1 of the broken triangles are not of what may break by itself: ranks cannot "
                        "share what a program breaks yet");
    dem_simulation_destroy(alone);
    rank_runs_free_outcome(&from);
    rank_runs_free_outcome(&led);
    dem_model_destroy(s.model);
}

int main(int argc, char **argv)
{
    is_long = argc > 1 && strcmp(argv[1], "long") == 0;
    return test_run();
}
