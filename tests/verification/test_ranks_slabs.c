/* SPDX-License-Identifier: BSD-3-Clause */
/* Ranks that make slabs of a lattice which nobody has run it with the bits of the whole in one process: free, and
 * falling on obstacles, with all events and the ledger; rectangles, what is cut out of rows, and what is read from a
 * file, in slabs that end anywhere in a row. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "slab_runs.h"
#include "support.h"

#include <dem/trajectory.h>

#include "harness/message.h"
#include "output/lattice_file.h"

enum { FLOOR_POINTS = 61 };

static const char path[] = "verify_ranks_slabs.h5";
static const double spacing = 2.5e-3, width = 0.07, height = 0.045;
static const double slit_height = 0.02, slit_angle = 0.1; /* m, of the middle */

/* ---- scenes ---- */

typedef struct kind {
    bool has_floor, is_square;
    const dem_shape *shape; /* NULL: a rectangle of whole rows */
    bool is_layered;        /* what is above the middle is of a material without guard, damping and area term */
    double jitter;          /* in spacings */
    double damping_time;    /* s, of springs */
    dem_springs springs;
    dem_method method;
    bool is_read;   /* the slabs are those of a file */
    double closing; /* m/s, at which what is above a slit falls on what is below it; nothing prevents that */
    int rings;      /* of ghosts, at most, if they are no more than all nodes; 0: as many as there is a use for */
} kind;

typedef struct scene {
    rank_runs_scene run;
    const kind *kind;
    double lift; /* m */
    dem_obstacle floor;
    double points[2 * FLOOR_POINTS];
} scene;

static void assemble(dem_lattice *l, const kind *k, const dem_material *below)
{
    const dem_outline upper = SIZED(dem_outline, .size = {1.0, 1.0}, .centre = {0.0, 0.5 + 0.5 * height});
    const dem_material above =
        SIZED(dem_material, .youngs_modulus = 3e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0, .thickness = 1.0);
    bool *is_upper = malloc((size_t)l->n_triangles * sizeof *is_upper);
    dem_index *of = malloc((size_t)l->n_triangles * sizeof *of);
    assert_ok(dem_lattice_inside(l, &upper, k->is_square ? 2 : 1, is_upper, NULL));
    for (dem_index t = 0; t < l->n_triangles; t++) of[t] = k->is_layered && is_upper[t];
    assert_ok(dem_lattice_assemble_mixed(l, (const dem_material[]){*below, above}, k->is_layered ? 2 : 1, of,
                                         k->is_square ? 0.5 : 0.0));
    free(is_upper);
    free(of);
}

/* The same of the whole and of slabs, node by node. */
static void finish_block(dem_lattice *l, const kind *k, double lift)
{
    static const double down[2] = {1.5, -4.0};
    const dem_material rubber =
        SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 0.3, .density = 1050.0, .thickness = 1.0,
              .guard = 0.02, .damping_time = k->damping_time, .springs = k->springs);
    assemble(l, k, &rubber);
    dem_lattice_move(l, 0.02, (double[]){0.0, lift});
    assert_ok(dem_lattice_launch(l, down));
    if (!k->has_floor) rank_runs_set_off(l, 20.0, 1.0);
    for (dem_index i = 0; i < l->n_nodes; i++)
        if (l->x[2 * i + 1] - lift > slit_height + (slit_angle + 0.02) * l->x[2 * i])
            l->velocity[2 * i + 1] -= k->closing;
}

static dem_status triangulate(dem_lattice *l, const kind *k)
{
    if (k->shape != NULL) return dem_shape_lattice(l, k->shape, NULL);
    return k->is_square ? dem_lattice_squares(l, width, height, spacing)
                        : dem_lattice_rectangle(l, width, height, spacing);
}

static dem_status triangulate_part(dem_slab *s, const kind *k, int part, int n_parts)
{
    if (k->shape != NULL) return dem_slab_shape(s, k->shape, part, n_parts);
    return k->is_square ? dem_slab_squares(s, width, height, spacing, part, n_parts)
                        : dem_slab_rectangle(s, width, height, spacing, part, n_parts);
}

static dem_lattice make_whole(const kind *k, double lift)
{
    dem_lattice l = dem_lattice_empty();
    assert_ok(triangulate(&l, k));
    assert_ok(dem_lattice_jitter(&l, k->jitter * spacing, 5));
    finish_block(&l, k, lift);
    return l;
}

static dem_slab make_slab(const void *of, int part, int n_parts)
{
    const scene *s = of;
    const kind *k = s->kind;
    dem_slab slab = dem_slab_empty();
    if (k->is_read) {
        assert_ok(dem_slab_read(&slab, path, part, n_parts));
        return slab;
    }
    assert_ok(triangulate_part(&slab, k, part, n_parts));
    assert_ok(dem_slab_jitter(&slab, k->jitter * spacing, 5));
    finish_block(&slab.lattice, k, s->lift);
    return slab;
}

static void make_floor(scene *s)
{
    for (int k = 0; k < FLOOR_POINTS; k++) {
        s->points[2 * k] = 0.004 * (k - FLOOR_POINTS / 2);
        s->points[2 * k + 1] = 3e-4 * sin(2.0 * k);
    }
    s->floor = (dem_obstacle)SIZED(dem_obstacle, .n_points = FLOOR_POINTS, .points = s->points, .restitution = 0.3,
                                   .friction = 0.4);
}

static void write_file(const dem_lattice *l)
{
    hdf5_file file;
    assert_ok(hdf5_open_new(&file, path, 4096));
    assert_ok(hdf5_close(&file, lattice_file_write(&file, &(lattice_source){l, NULL}, 1)));
}

static void open_scene(scene *s, const kind *k)
{
    CLEANUP(dem_lattice_free) dem_lattice flat = make_whole(k, 0.0);
    *s = (scene){.kind = k, .lift = 5e-4 - support_bottom(&flat)};
    CLEANUP(dem_lattice_free) dem_lattice l = make_whole(k, s->lift);
    if (k->is_read) write_file(&l);
    make_floor(s);
    s->run = (rank_runs_scene){
        .model = support_model(&l, &s->floor, k->has_floor ? 1 : 0), .options = dem_options_default(), .t_end = 3e-4};
    s->run.options.method = k->method;
    s->run.options.checkpoint_steps = 40;
}

/* ---- runs ---- */

static ring_use use_of(const kind *k)
{
    return k->rings > 0 ? (ring_use){k->rings, 1, {0, 1}, {0, 1}} : (ring_use){0};
}

static void open_runs(slab_runs_scene *out, const scene *s)
{
    *out = (slab_runs_scene){.run = s->run,
                             .obstacles = &s->floor,
                             .n_obstacles = s->kind->has_floor ? 1 : 0,
                             .use = use_of(s->kind),
                             .make = make_slab,
                             .of = s};
}

static void check(const kind *k)
{
    scene s;
    slab_runs_scene runs;
    open_scene(&s, k);
    open_runs(&runs, &s);
    rank_runs_outcome whole = rank_runs_alone(&s.run);
    assert_string_equal(whole.message, "");
    assert_true(!k->has_floor || whole.n_notes > 10);
    assert_true(!(k->closing > 0.0) || whole.views[RANK_RUNS_STOPS - 1].overlap.now > 3);
    for (int n = 1; n <= 4; n++) slab_runs_assert_same(&runs, n, &whole);
    rank_runs_free_outcome(&whole);
    dem_model_destroy(s.run.model);
    assert_true(!k->is_read || unlink(path) == 0);
}

TEST(a_free_block_in_slabs_moves_as_the_whole)
{
    check(&(kind){.method = DEM_METHOD_FEHLBERG45});
    check(&(kind){.method = DEM_METHOD_VERLET, .is_square = true, .jitter = 0.2});
    check(
        &(kind){.method = DEM_METHOD_FEHLBERG45, .jitter = 0.3, .springs = DEM_SPRINGS_COUPLED, .damping_time = 1e-6});
}

TEST(a_free_block_in_slabs_has_rings_of_ghosts_as_the_whole)
{
    check(&(kind){.method = DEM_METHOD_FEHLBERG45, .rings = 3});
    check(&(kind){.method = DEM_METHOD_VERLET, .rings = 8});
    check(&(kind){.method = DEM_METHOD_VERLET, .is_square = true, .rings = 4, .has_floor = true});
}

TEST(a_block_in_slabs_falls_on_obstacles_as_the_whole)
{
    check(&(kind){.has_floor = true, .method = DEM_METHOD_FEHLBERG45});
    check(&(kind){.has_floor = true, .method = DEM_METHOD_VERLET, .is_square = true});
    check(&(kind){.has_floor = true,
                  .method = DEM_METHOD_VERLET,
                  .jitter = 0.2,
                  .springs = DEM_SPRINGS_COUPLED,
                  .damping_time = 1e-6});
}

/* ---- what is cut out of rows ---- */

TEST(a_disc_in_slabs_falls_on_obstacles_as_the_whole)
{
    const dem_outline disc = SIZED(dem_outline, .kind = DEM_OUTLINE_DISC, .radius = 0.028, .centre = {0.003, 0.1});
    const dem_shape shape = SIZED(dem_shape, .outline = &disc, .spacing = spacing);
    check(&(kind){.has_floor = true, .shape = &shape, .method = DEM_METHOD_FEHLBERG45});
    check(&(kind){.has_floor = true,
                  .shape = &shape,
                  .method = DEM_METHOD_VERLET,
                  .jitter = 0.3,
                  .springs = DEM_SPRINGS_COUPLED,
                  .damping_time = 1e-6});
    check(&(kind){.shape = &shape, .method = DEM_METHOD_VERLET, .rings = 4});
}

TEST(a_porous_plate_in_slabs_falls_on_obstacles_as_the_whole)
{
    enum { n_pores = 8 };
    const dem_pores recipe = SIZED(dem_pores, .number = n_pores, .radius_min = 1.5 * spacing,
                                   .radius_max = 2.5 * spacing, .wall = spacing, .seed = 3);
    const dem_outline plate = SIZED(dem_outline, .size = {width, height}, .centre = {0.0, 0.5 * height});
    const dem_outline notch =
        SIZED(dem_outline, .kind = DEM_OUTLINE_DISC, .radius = 3.0 * spacing, .centre = {0.4 * width, 0.0});
    double pores[3 * n_pores];
    dem_index n;
    dem_shape shape = SIZED(dem_shape, .outline = &plate, .spacing = spacing, .n_voids = 1, .voids = &notch);
    assert_ok(dem_shape_place_pores(&shape, &recipe, pores, n_pores, &n));
    shape.n_pores = n;
    shape.pores = pores;
    check(&(kind){.has_floor = true, .shape = &shape, .method = DEM_METHOD_FEHLBERG45, .jitter = 0.2});
    shape.grid = DEM_GRID_SQUARES;
    check(&(kind){.has_floor = true, .shape = &shape, .is_square = true, .method = DEM_METHOD_VERLET});
}

/* The void goes through all of it: the lower part hits the floor, the upper one does not, or runs into the lower one
 * without a floor. */
TEST(parts_that_are_not_connected_move_in_slabs_as_in_the_whole)
{
    const double points[] = {-0.03, 0.0, 0.03, 0.0, 0.0, 0.05};
    const dem_outline triangle = SIZED(dem_outline, .kind = DEM_OUTLINE_POLYGON, .n_points = 3, .points = points);
    const dem_outline slit =
        SIZED(dem_outline, .size = {1.0, 1.8 * spacing}, .centre = {0.0, slit_height}, .angle = slit_angle);
    const dem_shape shape = SIZED(dem_shape, .outline = &triangle, .spacing = spacing, .n_voids = 1, .voids = &slit);
    check(&(kind){.has_floor = true, .shape = &shape, .method = DEM_METHOD_VERLET});
    check(&(kind){.shape = &shape, .method = DEM_METHOD_VERLET, .closing = 60.0});
    check(&(kind){.shape = &shape, .method = DEM_METHOD_FEHLBERG45, .closing = 60.0, .rings = 3});
}

/* Slabs of the upper one lack arrays that those of the lower one have. */
TEST(a_block_of_two_materials_in_slabs_moves_as_the_whole)
{
    check(&(kind){.has_floor = true, .is_layered = true, .method = DEM_METHOD_VERLET, .damping_time = 1e-6});
    check(&(kind){.is_layered = true,
                  .method = DEM_METHOD_FEHLBERG45,
                  .jitter = 0.2,
                  .springs = DEM_SPRINGS_COUPLED,
                  .damping_time = 1e-6});
}

/* ---- what is read from a file ---- */

TEST(a_block_in_slabs_of_a_file_moves_as_the_whole)
{
    check(&(kind){.is_read = true, .method = DEM_METHOD_VERLET, .is_square = true, .jitter = 0.2});
    check(&(kind){.is_read = true,
                  .method = DEM_METHOD_FEHLBERG45,
                  .jitter = 0.3,
                  .springs = DEM_SPRINGS_COUPLED,
                  .damping_time = 1e-6});
    check(&(kind){.is_read = true, .has_floor = true, .is_layered = true, .method = DEM_METHOD_VERLET, .rings = 4});
}

TEST(a_disc_in_slabs_of_a_file_falls_on_obstacles_as_the_whole)
{
    const dem_outline disc = SIZED(dem_outline, .kind = DEM_OUTLINE_DISC, .radius = 0.028, .centre = {0.003, 0.1});
    const dem_outline hole = SIZED(dem_outline, .kind = DEM_OUTLINE_DISC, .radius = 0.009, .centre = {0.003, 0.09});
    const dem_shape shape = SIZED(dem_shape, .outline = &disc, .spacing = spacing, .n_voids = 1, .voids = &hole);
    check(&(kind){.is_read = true,
                  .has_floor = true,
                  .shape = &shape,
                  .method = DEM_METHOD_FEHLBERG45,
                  .jitter = 0.2,
                  .springs = DEM_SPRINGS_COUPLED,
                  .damping_time = 1e-6});
}

/* ---- what is refused ---- */

static void add_strength(dem_slab *s)
{
    dem_lattice *l = &s->lattice;
    l->strength = malloc((size_t)l->n_triangles * sizeof *l->strength);
    for (dem_index t = 0; t < l->n_triangles; t++) l->strength[t] = 1e6;
}

static void take_masses(dem_slab *s)
{
    free(s->lattice.mass);
    s->lattice.mass = NULL;
}

static void stiffen(dem_slab *s)
{
    assert_ok(dem_lattice_stiffen(&s->lattice, DEM_GUIDE_NONE));
}

/* Of a slab of its own body, of which the number is too high. */
static void leave_a_hole(dem_slab *s)
{
    dem_lattice *l = &s->lattice;
    l->body = malloc((size_t)l->n_nodes * sizeof *l->body);
    for (dem_index i = 0; i < l->n_nodes; i++) l->body[i] = 2;
}

static void loosen(dem_slab *s)
{
    s->lattice.n_springs = 0;
}

static void displace(dem_slab *s)
{
    s->first_node++;
}

/* What one of two slabs has. */
static void expect_refusal(void (*change)(dem_slab *s), dem_status status, const char *message)
{
    const kind plain = {.method = DEM_METHOD_VERLET};
    const scene s = {.kind = &plain};
    slab_runs_scene runs;
    open_runs(&runs, &s);
    slab_runs run = slab_runs_make(&runs, 2);
    change(&run.slabs[1]);
    slab_runs_go(&run, 2);
    for (int k = 0; k < 2; k++) {
        assert_int_equal(run.outcomes[k].status, status);
        if (!message_has_parts(run.outcomes[k].message, message))
            fail_msg("'%s' has not the parts '%s'", run.outcomes[k].message, message);
        dem_slab_free(&run.slabs[k]);
    }
}

TEST(slabs_refuse_what_they_cannot_be_of_on_all_ranks)
{
    expect_refusal(add_strength, DEM_ERROR_MODEL, "may break are not supported");
    expect_refusal(take_masses, DEM_ERROR_ARGUMENT, "no array of masses");
    expect_refusal(stiffen, DEM_ERROR_MODEL, "rigid bodies are not supported");
    expect_refusal(leave_a_hole, DEM_ERROR_MODEL, "body 1 has no nodes, though there are bodies up to 2");
    expect_refusal(loosen, DEM_ERROR_MODEL, "has no springs, though body 0 has other nodes");
    expect_refusal(displace, DEM_ERROR_ARGUMENT, "no part of");
}
