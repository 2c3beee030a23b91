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
    SEVERED,   /* by stress: a band across a block of squares in free space, which does not break beside it */
    OPENED,    /* by stress: a piece of a ring in free space, which stays one body; nothing touches */
    DENTED,    /* by pressure, too: a part of a block below, which falls on a floor, and does not break above */
    N_KINDS
} kind;

static const double speeds[N_KINDS] = {-8.0, 0.0, -8.0, -9.0, 0.0, 0.0, -12.0}; /* m/s, upwards */

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

static bool is_brittle(kind k, const double x[2])
{
    if (k == SEVERED) return fabs(x[0] - 0.013) < 6e-3;
    return k == OPENED ? x[0] > 0.0 && fabs(x[1]) < 6e-3 : x[0] < -0.06 && x[1] < 0.03;
}

static void limit(dem_lattice *l, kind k)
{
    for (dem_index t = 0; t < l->n_triangles; t++) {
        double x[2] = {0.0, 0.0};
        for (int c = 0; c < 6; c++) x[c % 2] += l->x[2 * l->triangles[3 * t + c / 2] + c % 2] / 3.0;
        l->strength[t] *= 1.0 + 0.1 * sin(3.0 * (double)t);
        if (is_brittle(k, x)) continue;
        l->strength[t] = (double)INFINITY;
        if (l->compressive_strength != NULL) l->compressive_strength[t] = (double)INFINITY;
    }
}

/* What is beside that part flies apart, or down. */
static void launch(dem_lattice *l, kind k)
{
    l->velocity = calloc(2 * (size_t)l->n_nodes, sizeof *l->velocity);
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const double *x = l->x + 2 * i, v[2] = {x[0] > 0.013 ? 6.0 : -6.0, x[0] < 0.05 ? 0.0 : x[1] > 0.0 ? 6.0 : -6.0};
        l->velocity[2 * i] = k == SEVERED ? v[0] : 0.0;
        l->velocity[2 * i + 1] = k == OPENED ? v[1] : speeds[k];
    }
}

/* So fine that most of what does not break is not common. */
static dem_lattice make_partly_brittle(kind k)
{
    const dem_outline ring = SIZED(dem_outline, .kind = DEM_OUTLINE_RING, .radius = 0.1, .inner_radius = 0.06);
    const dem_shape shape = SIZED(dem_shape, .outline = &ring, .spacing = 0.5 * spacing);
    const dem_material solid = material_of(k == DENTED ? CRUSHED : SHATTERED);
    dem_lattice l = dem_lattice_empty();
    if (k == DENTED) l = support_rectangle(0.2, 0.14, 0.5 * spacing, &solid);
    if (k == OPENED) assert_ok(dem_shape_lattice(&l, &shape, NULL));
    if (k == OPENED) assert_ok(dem_lattice_assemble(&l, &solid));
    if (k == SEVERED) assert_ok(dem_lattice_squares(&l, 0.2, 0.14, 0.5 * spacing));
    if (k == SEVERED) assert_ok(dem_lattice_assemble_squares(&l, &solid, 0.5));
    if (k == DENTED) dem_lattice_move(&l, 0.0, (const double[2]){0.0, 3e-4 - support_bottom(&l)});
    limit(&l, k);
    launch(&l, k);
    return l;
}

static dem_lattice make_block(kind k)
{
    return k < SEVERED ? make_brittle(k) : make_partly_brittle(k);
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
    const bool falls = k != STRETCHED && k != SEVERED && k != OPENED;
    CLEANUP(dem_lattice_free) dem_lattice l = make_block(k);
    if (k <= STRETCHED) add_tough(&l, k);
    *s = (rank_runs_scene){.model = support_model(&l, &floor, falls),
                           .options = dem_options_default(),
                           .t_end = 0.9e-3,
                           .is_seen_at_events = true,
                           .keeps = has_broken};
    s->options.method = method;
    s->options.contact = contact;
    s->options.bodies = k == SOFTENED || k == OPENED ? DEM_BODIES_NONE : DEM_BODIES_ALL;
    s->options.contact_friction = k == SHATTERED ? 0.3 : 0.0;
    s->options.checkpoint_steps = 6;
    s->options.gravity[1] = falls ? -9.81 : 0.0;
}

/* ---- the same bits ---- */

static void share(const rank_runs_scene *s, int n_ranks, const int32_t *owner, const rank_runs_outcome *whole)
{
    rank_runs_assert_shared(s, n_ranks,
                            &(domain_model_shares){.owner = owner, .touching = s->options.bodies != DEM_BODIES_NONE},
                            NULL, whole);
}

/* Whether a break has split off a fragment. */
static bool has_split(const rank_runs_outcome *o)
{
    bool has = false;
    for (dem_index k = 0; k < o->n_notes; k++) has = has || o->notes[k].broken.fragment_new > 0;
    return has;
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
    assert_true(k < SEVERED || k > OPENED || has_split(&whole) == (k == SEVERED));
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

/* ---- bodies of which a part may break ---- */

static dem_index most_common = 0; /* nodes that all ranks have, as rank 0 counts them */

static void count_common(const ranks *r, void *context)
{
    const dem_model *whole = context;
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)whole->lattice.n_nodes * sizeof *owner);
    dem_model *part = NULL;
    if (partition_bisect(&whole->lattice, r->size, owner) != DEM_OK) return;
    if (domain_model_create(&part, r, whole, &(domain_model_shares){.owner = owner, .touching = true}) != DEM_OK)
        return;
    dem_index n = 0;
    for (dem_index i = 0; i < part->domain->n_nodes; i++) n += part->domain->is_common[i];
    if (r->rank == 0) most_common = n;
    dem_model_destroy(part);
}

/* What is not near what may break, nor at a surface, each rank has its own of. */
TEST(bodies_that_break_in_part_are_shared_out)
{
    rank_runs_scene s;
    open_scene(&s, SEVERED, DEM_METHOD_VERLET, DEM_CONTACT_LOCAL);
    rank_threads_run(3, count_common, (void *)(uintptr_t)s.model);
    assert_true(most_common > 0 && 3 * most_common < 2 * dem_model_lattice(s.model)->n_nodes);
    dem_model_destroy(s.model);
}

TEST(blocks_that_are_severed_have_the_bits_of_one_process)
{
    check_all(SEVERED);
}

TEST(rings_that_are_opened_have_the_bits_of_one_process)
{
    check_all(OPENED);
}

TEST(blocks_that_are_dented_have_the_bits_of_one_process)
{
    check_all(DENTED);
}

/* Another number of ranks goes on with what is broken. */
TEST(led_runs_show_breaks_and_go_on_with_them)
{
    for (kind k = SHATTERED; k < N_KINDS; k++) {
        rank_runs_scene s;
        open_scene(&s, k, DEM_METHOD_FEHLBERG45, DEM_CONTACT_LOCAL);
        rank_runs_outcome whole = rank_runs_alone(&s);
        assert_true(whole.kept != NULL &&
                    (k == SOFTENED || k == SEVERED || k == OPENED || whole.n_notes > whole.kept_notes));
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
