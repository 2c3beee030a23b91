/* SPDX-License-Identifier: BSD-3-Clause */
/* Programs built with other headers than this library's. Those of 0.1 had structs without a size, or others of the same
 * name: such a program is refused with a message. Those of later headers have longer structs, which are taken as long
 * as nothing is set that this library does not know. All structs are allocated with just their size, so that a memory
 * checker sees whatever is read or written beyond. */
#include "verification/support.h"

#include <stdlib.h>
#include <string.h>

#include "harness/cleanup.h"
#include "harness/message.h"
#include "harness/motion.h"

static const double line[4] = {-1.0, 0.0, 1.0, 0.0}, mass = 2.0, place[2] = {0.0, 1.0};

/* A copy of `bytes` bytes with `more` behind them, all `fill`. */
static void *longer(const void *from, size_t bytes, size_t more, int fill)
{
    char *copy = malloc(bytes + more);
    assert_non_null(copy);
    memcpy(copy, from, bytes);
    memset(copy + bytes, fill, more);
    return copy;
}

static dem_lattice one_node(void)
{
    return support_lattice(1, place, &mass, 0, NULL, 0.0, 0.0, NULL);
}

static dem_options steps_of_a_node(void)
{
    dem_options options = dem_options_default();
    options.spacing = 1.0;
    options.max_step = 0.03;
    options.v_scale = 1.0;
    return options;
}

/* ---- 0.1 ---- */

typedef struct old_material {
    double youngs_modulus, bond_stiffness, poissons_ratio;
    dem_plane plane;
    double density, thickness, guard, damping_time;
} old_material;

typedef struct old_obstacle {
    dem_index n_points;
    const double *points;
    double restitution, friction;
    dem_friction_law friction_law;
    double velocity[2];
} old_obstacle;

typedef struct old_boundary {
    dem_boundary_kind kind;
    int32_t components;
    dem_index n_nodes;
    const dem_index *nodes;
    const double *share;
    double value[2], ramp;
} old_boundary;

typedef struct old_observer {
    double interval;
    void (*calls[4])(void);
    void *context;
} old_observer;

enum { OLD_OPTIONS = 168, OLD_STATE = 136 }; /* bytes */

TEST(materials_and_obstacles_of_the_first_header_are_refused)
{
    const old_material rubber = {.youngs_modulus = 1e7, .poissons_ratio = 0.3, .density = 1e3, .thickness = 1.0};
    const old_obstacle ground = {.n_points = 2, .points = line};
    CLEANUP(free_memory) void *given = longer(&rubber, sizeof rubber, 0, 0);
    CLEANUP(free_memory) void *solid = longer(&ground, sizeof ground, 0, 0);
    CLEANUP(dem_lattice_free) dem_lattice block = dem_lattice_empty(), node = one_node();
    dem_model *model = NULL;
    assert_ok(dem_lattice_rectangle(&block, 0.1, 0.1, 0.05));
    assert_int_equal(dem_lattice_assemble(&block, given), DEM_ERROR_ARGUMENT);
    assert_message_parts("dem_material: struct_size");
    assert_null(block.mass);
    assert_int_equal(dem_model_create(&model, &node, solid, 1), DEM_ERROR_ARGUMENT);
    assert_message_parts("dem_obstacle: struct_size * 2");
    assert_null(model);
}

TEST(options_boundaries_and_observers_of_the_first_header_are_refused)
{
    const dem_index number = 0;
    const old_boundary pull = {.kind = DEM_BOUNDARY_FORCE, .components = 3, .n_nodes = 1, .nodes = &number};
    const old_observer watcher = {.interval = 1e-3};
    CLEANUP(free_memory) void *loads = longer(&pull, sizeof pull, 0, 0);
    CLEANUP(free_memory) void *observer = longer(&watcher, sizeof watcher, 0, 0);
    CLEANUP(dem_lattice_free) dem_lattice lattice = one_node();
    CLEANUP(free_model) dem_model *model = support_model(&lattice, NULL, 0);
    dem_options options = steps_of_a_node();
    dem_simulation *none = NULL;
    CLEANUP(free_simulation) dem_simulation *simulation = support_simulation(model, &options);
    options.n_boundaries = 1;
    options.boundaries = loads;
    assert_int_equal(dem_simulation_create(&none, model, &options), DEM_ERROR_ARGUMENT);
    assert_message_parts("dem_boundary: struct_size");
    options = steps_of_a_node();
    options.struct_size = OLD_OPTIONS;
    CLEANUP(free_memory) void *old = longer(&options, OLD_OPTIONS, 0, 0);
    assert_int_equal(dem_simulation_create(&none, model, old), DEM_ERROR_ARGUMENT);
    assert_message_parts("dem_options: struct_size * 168");
    assert_null(none);
    assert_int_equal(dem_simulation_observe(simulation, observer), DEM_ERROR_ARGUMENT);
    assert_message_parts("dem_observer: struct_size");
}

/* Time, step, positions and velocities stand where they stood; what followed is not written. */
TEST(a_state_of_the_first_header_is_written_as_far_as_it_is_the_same)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = one_node();
    CLEANUP(free_model) dem_model *model = support_model(&lattice, NULL, 0);
    const dem_options options = steps_of_a_node();
    CLEANUP(free_simulation) dem_simulation *simulation = support_simulation(model, &options);
    const size_t size = OLD_STATE;
    CLEANUP(free_memory) char *state = longer(&size, sizeof size, OLD_STATE - sizeof size, 0x5a);
    assert_ok(dem_simulation_advance(simulation, 0.5));
    assert_ok(dem_simulation_state(simulation, (dem_state *)(void *)state));
    assert_close(((const dem_state *)(const void *)state)->t, 0.5, 0.0);
    for (size_t k = sizeof(dem_state); k < OLD_STATE; k++) assert_int_equal(state[k], 0x5a);
}

/* ---- versions to come ---- */

/* Two obstacles of a header in which they are 16 bytes longer. */
TEST(longer_obstacles_are_taken_if_nothing_unknown_is_set)
{
    enum { MORE = 16 };
    const size_t size = sizeof(dem_obstacle) + MORE;
    const double other[4] = {-1.0, -1.0, 1.0, -1.0};
    dem_obstacle two[2] = {{.struct_size = size, .n_points = 2, .points = line},
                           {.struct_size = size, .n_points = 2, .points = other, .friction = 0.5}};
    CLEANUP(free_memory) char *list = calloc(2, size);
    CLEANUP(dem_lattice_free) dem_lattice lattice = one_node();
    CLEANUP(free_model) dem_model *model = NULL;
    assert_non_null(list);
    for (size_t k = 0; k < 2; k++) memcpy(list + k * size, &two[k], sizeof two[k]);
    assert_ok(dem_model_create(&model, &lattice, (const dem_obstacle *)(const void *)list, 2));
    assert_int_equal(ask_sizes(model).n_obstacles, 2);
    assert_close(dem_model_obstacle(model, 1)->friction, 0.5, 0.0);
    assert_int_equal(dem_model_obstacle(model, 1)->struct_size, sizeof(dem_obstacle));
    dem_model *none = NULL;
    list[2 * size - 1] = 1;
    assert_int_equal(dem_model_create(&none, &lattice, (const dem_obstacle *)(const void *)list, 2),
                     DEM_ERROR_ARGUMENT);
    assert_message_parts("dem_obstacle: struct_size * unknown");
    list[2 * size - 1] = 0;
    memcpy(list + size, &(size_t){size + 8}, sizeof size);
    assert_int_equal(dem_model_create(&none, &lattice, (const dem_obstacle *)(const void *)list, 2),
                     DEM_ERROR_ARGUMENT);
    assert_message_parts("dem_obstacle 1 * 2: struct_size");
    assert_null(none);
}

/* A lattice is made, edited and freed without a byte written behind what the caller's header has. */
TEST(a_longer_lattice_keeps_what_is_behind)
{
    enum { MORE = 24 };
    dem_lattice empty = dem_lattice_empty();
    empty.struct_size += MORE;
    CLEANUP(free_memory) char *bytes = longer(&empty, sizeof empty, MORE, 0);
    dem_lattice *lattice = (dem_lattice *)(void *)bytes;
    assert_ok(dem_lattice_disc(lattice, 0.1, 0.05));
    assert_int_equal(lattice->struct_size, sizeof empty + MORE);
    assert_ok(dem_lattice_append(lattice, lattice));
    dem_lattice_free(lattice);
    assert_int_equal(lattice->struct_size, sizeof empty + MORE);
    assert_int_equal(lattice->n_nodes, 0);
    for (size_t k = sizeof empty; k < sizeof empty + MORE; k++) assert_int_equal(bytes[k], 0);
    lattice->struct_size = 16; /* of no version */
    assert_int_equal(dem_lattice_disc(lattice, 0.1, 0.05), DEM_ERROR_ARGUMENT);
    assert_message_parts("dem_lattice: struct_size * 16");
    assert_null(lattice->x);
}

static bool is_left(void *context, const double *x)
{
    (void)context;
    return x[0] < 0.2;
}

/* A lattice of the first header, which ends before the couplings, is made, cut, assembled, joined and selected; what
 * would need them is refused, and leaves it as it was. */
TEST(an_older_lattice_has_no_couplings)
{
    double behind = 7.0;
    dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e7, .density = 1e3, .thickness = 1.0);
    CLEANUP(dem_lattice_free) dem_lattice coupled = dem_lattice_empty(), older = dem_lattice_empty();
    dem_lattice *lattice = &older;
    bool keep[64] = {false};
    older.struct_size = offsetof(dem_lattice, coupling);
    older.coupling = &behind; /* what the caller has there */
    assert_ok(dem_lattice_rectangle(lattice, 0.4, 0.4, 0.1));
    assert_ok(dem_lattice_cut(lattice, is_left, NULL));
    assert_ok(dem_lattice_jitter(lattice, 0.02, 1));
    rubber.springs = DEM_SPRINGS_COUPLED;
    assert_int_equal(dem_lattice_assemble(lattice, &rubber), DEM_ERROR_ARGUMENT);
    assert_message_parts("dem_lattice: struct_size * 160 * couplings");
    assert_int_equal(lattice->n_springs, 0);
    assert_ok(dem_lattice_append(&coupled, lattice));
    assert_ok(dem_lattice_assemble(&coupled, &rubber));
    rubber.springs = DEM_SPRINGS_INDEPENDENT;
    assert_ok(dem_lattice_assemble(lattice, &rubber));
    assert_ok(dem_lattice_append(lattice, lattice));
    assert_int_equal(dem_lattice_append(lattice, &coupled), DEM_ERROR_ARGUMENT);
    assert_message_parts("dem_lattice: struct_size * 160 * couplings");
    assert_true(lattice->n_nodes == 2 * coupled.n_nodes && lattice->n_nodes <= 64);
    for (dem_index i = 0; i < coupled.n_nodes; i++) keep[i] = true;
    assert_ok(dem_lattice_select(lattice, keep));
    assert_int_equal(lattice->n_triangles, coupled.n_triangles);
    dem_lattice_free(lattice);
    assert_true(older.coupling == &behind && behind == 7.0 && older.n_nodes == 0);
}
