/* SPDX-License-Identifier: BSD-3-Clause */
/* Ranks that have slabs of bodies which touch themselves and each other run them with the bits of the whole in one
 * process: what closes on the ground, what folds in free space, and two bodies, of which slabs have parts of both. */
#include <stdlib.h>

#include "ask.h"
#include "slab_runs.h"
#include "support.h"

#include "harness/message.h"
#include "harness/slab_cut.h"

enum { FLOOR_POINTS = 31 };
static const double spacing = 2.5e-3;
static const int numbers[] = {1, 2, 3, 5};

/* ---- scenes ---- */

typedef struct kind {
    const dem_shape *shape; /* NULL: two bodies */
    bool has_floor;
    double squeeze; /* 1/s, by which what is above the middle comes down, and what is below goes up */
    double friction;
    double damping_time; /* s, of springs */
    dem_method method;
    dem_contact_method contact;
    int rings; /* of ghosts, whatever they cost; 0: as many as there is a use for */
    dem_bodies bodies;
    bool is_excluded; /* whether nothing but what is low may touch obstacles */
    bool by_parts;    /* whether each slab is made of one body alone */
    bool has_pellet;  /* whether there is a third body, of one node */
    double t_end;     /* s */
} kind;

typedef struct scene {
    slab_runs_scene runs;
    const kind *kind;
    double lift; /* m */
    dem_lattice whole;
    dem_index n_lower; /* nodes of the lower of two bodies, */
    double top;        /* m, and its top */
    dem_obstacle floor;
    double points[2 * FLOOR_POINTS];
} scene;

static void assemble(dem_lattice *l, double damping_time)
{
    const dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e6, .poissons_ratio = 1.0 / 3.0,
                                      .density = 1050.0, .thickness = 1.0, .guard = 0.05, .damping_time = damping_time);
    assert_ok(dem_lattice_assemble(l, &rubber));
}

/* The same of the whole and of slabs, node by node. */
static void finish_shape(dem_lattice *l, const kind *k, double lift)
{
    assemble(l, k->damping_time);
    l->velocity = calloc(2 * (size_t)l->n_nodes, sizeof *l->velocity);
    for (dem_index i = 0; i < l->n_nodes; i++) {
        l->velocity[2 * i] = k->has_floor ? 1.0 : 0.3;
        l->velocity[2 * i + 1] = -k->squeeze * l->x[2 * i + 1] - (k->has_floor ? 8.0 : 0.0);
    }
    dem_lattice_move(l, 0.02, (const double[2]){0.0, lift});
}

/* ---- two blocks ---- */

typedef struct block {
    double width, height, angle, where[2], velocity[2];
} block;

/* One above the other, which is tilted and comes down sideways. */
static block block_of(const scene *s, bool is_upper)
{
    if (is_upper) return (block){0.03, 0.02, 0.2, {0.005, s->top + 5e-3}, {3.0, -12.0}};
    return (block){0.055, 0.045, 0.01, {0.0, 1e-3}, {0.5, -3.0}};
}

static void finish_block(dem_lattice *l, const scene *s, bool is_upper)
{
    const block b = block_of(s, is_upper);
    assemble(l, is_upper ? 0.0 : s->kind->damping_time);
    dem_lattice_move(l, b.angle, b.where);
    assert_ok(dem_lattice_launch(l, b.velocity));
}

static void add_block(scene *s, bool is_upper)
{
    const block b = block_of(s, is_upper);
    CLEANUP(dem_lattice_free) dem_lattice l = dem_lattice_empty();
    assert_ok(dem_lattice_rectangle(&l, b.width, b.height, spacing));
    finish_block(&l, s, is_upper);
    assert_ok(dem_lattice_append(&s->whole, &l));
}

/* Of two slabs each has a body; others have as many nodes each, and end within rows. */
static dem_slab cut_blocks(const scene *s, int part, int n_parts)
{
    const dem_index n = s->whole.n_nodes;
    dem_index ends[2];
    for (int k = 0; k < 2; k++) {
        ends[k] = n * (part + k) / n_parts;
        if (n_parts == 2 && part + k == 1) ends[k] = s->n_lower;
    }
    const dem_slab slab = slab_cut(&s->whole, ends[0], ends[1]);
    assert_true(slab.n_own > 0);
    return slab;
}

/* Of one body, of which numbers come behind those of the other. */
static dem_slab make_part(const scene *s, int part, int n_parts)
{
    const int n_below = n_parts / 2;
    const bool is_upper = part >= n_below;
    const block b = block_of(s, is_upper);
    const dem_index before = is_upper ? s->n_lower : 0;
    dem_slab slab = dem_slab_empty();
    assert_ok(dem_slab_rectangle(&slab, b.width, b.height, spacing, is_upper ? part - n_below : part,
                                 is_upper ? n_parts - n_below : n_below));
    finish_block(&slab.lattice, s, is_upper);
    slab.n_nodes = s->whole.n_nodes;
    slab.n_triangles = s->whole.n_triangles;
    slab.first_node += before;
    for (dem_index k = 0; k < slab.lattice.n_nodes - slab.n_own; k++) slab.rim[k] += before;
    slab.lattice.body = malloc((size_t)slab.lattice.n_nodes * sizeof *slab.lattice.body);
    for (dem_index i = 0; i < slab.lattice.n_nodes; i++) slab.lattice.body[i] = is_upper;
    return slab;
}

static dem_slab make_slab(const void *of, int part, int n_parts)
{
    const scene *s = of;
    const kind *k = s->kind;
    dem_slab slab = dem_slab_empty();
    if (k->shape == NULL && k->by_parts && n_parts > 1) return make_part(s, part, n_parts);
    if (k->shape == NULL) return cut_blocks(s, part, n_parts);
    assert_ok(dem_slab_shape(&slab, k->shape, part, n_parts));
    assert_ok(dem_slab_jitter(&slab, 0.1 * spacing, 5));
    finish_shape(&slab.lattice, k, s->lift);
    return slab;
}

static dem_lattice make_shape(const kind *k, double lift)
{
    dem_lattice l = dem_lattice_empty();
    assert_ok(dem_shape_lattice(&l, k->shape, NULL));
    assert_ok(dem_lattice_jitter(&l, 0.1 * spacing, 5));
    finish_shape(&l, k, lift);
    return l;
}

static void add_pellet(dem_lattice *to)
{
    double x[] = {0.05, 0.05}, mass = 0.01;
    dem_lattice l = dem_lattice_empty();
    l.n_nodes = 1;
    l.x = x;
    l.mass = &mass;
    assert_ok(dem_lattice_append(to, &l));
}

static void exclude_all_above(dem_lattice *l, double height)
{
    CLEANUP(free_memory) dem_index *list = malloc((size_t)l->n_nodes * sizeof *list);
    dem_index n = 0;
    for (dem_index i = 0; i < l->n_nodes; i++)
        if (l->x[2 * i + 1] > height) list[n++] = i;
    assert_ok(dem_lattice_exclude(l, list, n));
}

static void make_blocks(scene *s)
{
    add_block(s, false);
    s->n_lower = s->whole.n_nodes;
    s->top = support_top(&s->whole);
    add_block(s, true);
    if (s->kind->has_pellet) add_pellet(&s->whole);
    if (s->kind->is_excluded) exclude_all_above(&s->whole, 2.5 * spacing);
}

static void make_floor(scene *s)
{
    for (int k = 0; k < FLOOR_POINTS; k++) {
        s->points[2 * k] = 0.006 * (k - FLOOR_POINTS / 2);
        s->points[2 * k + 1] = 3e-4 * sin(2.0 * k);
    }
    s->floor = (dem_obstacle)SIZED(dem_obstacle, .n_points = FLOOR_POINTS, .points = s->points, .restitution = 0.3,
                                   .friction = 0.4);
}

static bool has_pushing_surfaces(const dem_simulation *s, const rank_runs_outcome *so_far)
{
    (void)so_far;
    return ask_surfaces(s).pushing > 0;
}

static void make_whole(scene *s)
{
    const kind *k = s->kind;
    if (k->shape == NULL) {
        make_blocks(s);
        return;
    }
    CLEANUP(dem_lattice_free) dem_lattice flat = make_shape(k, 0.0);
    s->lift = 5e-4 - support_bottom(&flat);
    s->whole = make_shape(k, s->lift);
}

static void open_scene(scene *s, const kind *k)
{
    *s = (scene){.kind = k, .whole = dem_lattice_empty()};
    make_whole(s);
    make_floor(s);
    rank_runs_scene *run = &s->runs.run;
    s->runs = (slab_runs_scene){.obstacles = &s->floor, .n_obstacles = k->has_floor, .make = make_slab, .of = s};
    *run = (rank_runs_scene){.model = support_model(&s->whole, &s->floor, k->has_floor),
                             .options = dem_options_default(),
                             .t_end = k->t_end,
                             .keeps = has_pushing_surfaces};
    if (k->rings > 0) s->runs.use = (ring_use){k->rings, 1, {0, 1}, {0, 1}};
    run->options.method = k->method;
    run->options.contact = k->contact;
    run->options.bodies = k->bodies;
    run->options.contact_friction = k->friction;
    run->options.checkpoint_steps = 25;
}

static void close_scene(scene *s)
{
    dem_model_destroy(s->runs.run.model);
    dem_lattice_free(&s->whole);
}

static void check(const kind *k)
{
    scene s;
    open_scene(&s, k);
    rank_runs_outcome whole = rank_runs_alone(&s.runs.run);
    assert_string_equal(whole.message, "");
    assert_true(k->has_floor ? whole.n_notes > 10 : whole.n_notes == 0);
    assert_true(k->bodies == DEM_BODIES_NONE || whole.views[RANK_RUNS_STOPS - 1].surfaces.pushing > 0);
    for (size_t q = 0; q < sizeof numbers / sizeof *numbers; q++) slab_runs_assert_same(&s.runs, numbers[q], &whole);
    rank_runs_free_outcome(&whole);
    close_scene(&s);
}

/* ---- bodies that touch themselves ---- */

/* Slits, and a pore, that close. */
TEST(a_porous_disc_in_slabs_closes_on_uneven_ground_as_the_whole)
{
    const dem_outline disc = SIZED(dem_outline, .kind = DEM_OUTLINE_DISC, .radius = 0.02, .centre = {0.0, 0.02});
    const dem_outline slits[] = {
        SIZED(dem_outline, .size = {0.022, 1.2 * spacing}, .centre = {0.0, 0.015}, .angle = 0.02),
        SIZED(dem_outline, .size = {0.012, 1.2 * spacing}, .centre = {-0.004, 0.027}, .angle = -0.1)};
    const double pore[] = {0.008, 0.024, 1.5 * spacing};
    const dem_shape shape = SIZED(dem_shape, .outline = &disc, .spacing = spacing, .n_voids = 2, .voids = slits,
                                  .n_pores = 1, .pores = pore);
    kind k = {.shape = &shape,
              .has_floor = true,
              .bodies = DEM_BODIES_ALL,
              .friction = 0.3,
              .method = DEM_METHOD_FEHLBERG45,
              .t_end = 1.2e-3};
    check(&k);
    k.method = DEM_METHOD_VERLET;
    k.damping_time = 1e-5;
    check(&k);
}

TEST(a_ring_in_slabs_folds_as_the_whole)
{
    const dem_outline ring =
        SIZED(dem_outline, .kind = DEM_OUTLINE_RING, .radius = 0.02, .inner_radius = 0.0135, .centre = {0.0, 0.0});
    const dem_shape shape = SIZED(dem_shape, .outline = &ring, .spacing = spacing);
    kind k = {.shape = &shape,
              .squeeze = 600.0,
              .bodies = DEM_BODIES_ALL,
              .friction = 0.3,
              .method = DEM_METHOD_FEHLBERG45,
              .t_end = 2e-3};
    check(&k);
    k.method = DEM_METHOD_VERLET;
    check(&k);
}

/* ---- two bodies ---- */

TEST(two_bodies_in_slabs_hit_each_other_and_the_ground_as_the_whole)
{
    kind k = {
        .has_floor = true, .bodies = DEM_BODIES_ALL, .friction = 0.5, .method = DEM_METHOD_FEHLBERG45, .t_end = 9e-4};
    check(&k);
    k.by_parts = true;
    check(&k);
    k.bodies = DEM_BODIES_OTHERS;
    k.by_parts = false;
    k.is_excluded = true;
    k.contact = DEM_CONTACT_EXACT;
    check(&k);
    k.method = DEM_METHOD_VERLET;
    k.contact = DEM_CONTACT_LOCAL;
    k.damping_time = 1e-5;
    check(&k);
}

/* Common nodes have no rings about them then. */
TEST(two_bodies_in_slabs_meet_in_free_space_as_in_the_whole)
{
    kind k = {.bodies = DEM_BODIES_OTHERS, .friction = 0.5, .method = DEM_METHOD_FEHLBERG45, .t_end = 9e-4};
    check(&k);
    k.rings = 3;
    check(&k);
    k.method = DEM_METHOD_VERLET;
    k.rings = 4;
    check(&k);
}

/* A node is a body without a surface, which only simulations without contact of bodies can have. */
TEST(bodies_in_slabs_that_do_not_touch_each_other_fall_as_those_of_the_whole)
{
    check(&(kind){.has_floor = true, .has_pellet = true, .method = DEM_METHOD_VERLET, .t_end = 6e-4});
}

/* ---- what is not asked for ---- */

/* What comes without options is for simulations in which bodies do not touch. */
TEST(a_model_of_slabs_without_options_has_no_surfaces)
{
    scene s;
    open_scene(&s, &(kind){.bodies = DEM_BODIES_OTHERS, .t_end = 1e-5});
    slab_runs runs = slab_runs_make(&s.runs, 2);
    runs.has_no_options = true;
    rank_runs_make_outcomes(&s.runs.run, 2, runs.outcomes);
    slab_runs_go(&runs, 2);
    for (int k = 0; k < 2; k++) assert_true(message_has_parts(runs.outcomes[k].message, "ranks share no surfaces"));
    rank_runs_free_outcomes(runs.outcomes, 2);
    close_scene(&s);
}
