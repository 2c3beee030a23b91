/* SPDX-License-Identifier: BSD-3-Clause */
/* model.c, model.h: what a lattice must satisfy, what the model makes of it, and the force on a node. */
#include "verification/support.h"

#include <string.h>

#include "ask.h"
#include "forces/forces.h"
#include "harness/message.h"
#include "model/model_rules.h"

enum { n_nodes = 4, n_springs = 5, n_triangles = 2 };

/* A square of 1 m with one diagonal, every array given: the lattice points into the arrays beside it. */
typedef struct square {
    double x[2 * n_nodes], mass[n_nodes], rest_length[n_springs], stiffness[n_springs], guard[n_triangles];
    double area_stiffness[n_triangles];
    double viscosity[n_springs];
    double position[2 * n_nodes], velocity[2 * n_nodes];
    dem_index ends[2 * n_springs], triangles[3 * n_triangles];
    unsigned char flags[n_nodes];
    int32_t body[n_nodes];
    dem_lattice lattice;
} square;

static const square plain = {.x = {0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0},
                             .mass = {1.0, 2.0, 3.0, 4.0},
                             .rest_length = {1.0, 1.0, 0.5, 1.0, 1.5},
                             .stiffness = {10.0, 20.0, 30.0, 40.0, 50.0},
                             .guard = {0.1, 0.2},
                             .area_stiffness = {-3.0, 6.0},
                             .viscosity = {1.0, 2.0, 0.0, 4.0, 5.0},
                             .position = {0.0, 5.0, 1.0, 5.0, 1.0, 6.0, 0.0, 6.0},
                             .velocity = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0},
                             .ends = {0, 1, 1, 2, 2, 3, 3, 0, 0, 2},
                             .triangles = {0, 1, 2, 0, 2, 3},
                             .flags = {DEM_NODE_CONTACT, DEM_NODE_FIXED, 0, DEM_NODE_CONTACT | DEM_NODE_FIXED},
                             .body = {0, 0, 0, 0}};

static void make_square(square *s)
{
    *s = plain;
    s->lattice = dem_lattice_empty();
    s->lattice.n_nodes = n_nodes;
    s->lattice.n_springs = n_springs;
    s->lattice.n_triangles = n_triangles;
    s->lattice.x = s->x;
    s->lattice.mass = s->mass;
    s->lattice.ends = s->ends;
    s->lattice.rest_length = s->rest_length;
    s->lattice.stiffness = s->stiffness;
    s->lattice.triangles = s->triangles;
    s->lattice.guard = s->guard;
}

static void refuse(const square *s, dem_status status, const char *message)
{
    dem_model *model = (dem_model *)(uintptr_t)s; /* stays what it was */
    assert_int_equal(dem_model_create(&model, &s->lattice, NULL, 0), status);
    assert_message_parts(message);
    assert_ptr_equal(model, s);
}

static dem_model *compile(const square *s)
{
    dem_model *model;
    assert_ok(dem_model_create(&model, &s->lattice, NULL, 0));
    return model;
}

static const double not_a_number = (double)NAN, infinite = (double)INFINITY;

/* ---- validation ---- */

TEST(null_arguments_are_named)
{
    const double points[4] = {0.0, 0.0, 1.0, 0.0};
    const dem_obstacle obstacle = SIZED(dem_obstacle, .n_points = 2, .points = points, .restitution = 0.0);
    dem_model *model;
    square s;
    make_square(&s);
    assert_int_equal(dem_model_create(NULL, &s.lattice, NULL, 0), DEM_ERROR_ARGUMENT);
    assert_message_parts("dem_model_create: out is NULL");
    assert_int_equal(dem_model_create(&model, NULL, NULL, 0), DEM_ERROR_ARGUMENT);
    assert_message_parts("dem_model_create: lattice is NULL");
    assert_int_equal(dem_model_create(&model, &s.lattice, NULL, 2), DEM_ERROR_ARGUMENT);
    assert_message_parts("dem_model_create: 2 obstacles, obstacles is NULL");
    assert_int_equal(dem_model_create(&model, &s.lattice, &obstacle, -1), DEM_ERROR_ARGUMENT);
    assert_message_parts("dem_model_create: -1 obstacles, obstacles is given");
    dem_model_destroy(NULL);
}

TEST(a_lattice_needs_two_dimensions_nodes_and_masses)
{
    square s;
    make_square(&s);
    s.lattice.struct_size = 0;
    refuse(&s, DEM_ERROR_ARGUMENT, "dem_lattice: struct_size * 0 * 160");
    make_square(&s);
    s.lattice.dim = 3;
    refuse(&s, DEM_ERROR_ARGUMENT, "dimension 3 * 2");
    make_square(&s);
    s.lattice.n_nodes = 0;
    refuse(&s, DEM_ERROR_MODEL, "the lattice has no nodes");
    make_square(&s);
    s.lattice.mass = NULL;
    refuse(&s, DEM_ERROR_ARGUMENT, "the lattice has no array of masses");
    s.lattice.x = NULL;
    refuse(&s, DEM_ERROR_ARGUMENT, "the lattice has no array of positions");
}

TEST(coordinates_and_velocities_must_be_finite)
{
    square s;
    make_square(&s);
    s.x[3] = not_a_number;
    refuse(&s, DEM_ERROR_MODEL, "node 1: rest position (1, nan) * not finite");
    make_square(&s);
    s.lattice.position = s.position;
    s.position[4] = -infinite;
    refuse(&s, DEM_ERROR_MODEL, "node 2: initial position (-inf, 6) * not finite");
    make_square(&s);
    s.lattice.velocity = s.velocity;
    s.velocity[6] = infinite;
    refuse(&s, DEM_ERROR_MODEL, "node 3: initial velocity (inf, 8) * not finite");
}

TEST(masses_must_be_positive)
{
    const double wrong[4] = {0.0, -1.5, infinite, not_a_number};
    const char *const message[4] = {"node 2: mass must be > 0, got 0 kg", "node 2: mass must be > 0, got -1.5 kg",
                                    "node 2: mass must be > 0, got inf kg", "node 2: mass must be > 0, got nan kg"};
    square s;
    make_square(&s);
    for (int k = 0; k < 4; k++) {
        s.mass[2] = wrong[k];
        refuse(&s, DEM_ERROR_MODEL, message[k]);
    }
    s.mass[1] = 0.0; /* the first one is named */
    refuse(&s, DEM_ERROR_MODEL, "node 1: mass * > 0 * 0 kg");
}

TEST(bodies_are_numbered_below_the_number_of_nodes)
{
    square s;
    make_square(&s);
    s.lattice.body = s.body;
    s.body[0] = 4;
    refuse(&s, DEM_ERROR_MODEL, "node 0: body number 4 * 0 * 3");
    s.body[0] = -1;
    refuse(&s, DEM_ERROR_MODEL, "node 0: body number -1 * 0 * 3");
}

TEST(a_part_may_have_bodies_as_many_as_the_whole_has_nodes)
{
    square s;
    make_square(&s);
    s.lattice.body = s.body;
    for (int i = 0; i < n_nodes; i++) s.body[i] = 4;
    assert_ok(model_rules_check(&s.lattice, 5));
    assert_int_equal(model_rules_check(&s.lattice, 4), DEM_ERROR_MODEL);
    assert_message_parts("node 0: body number 4 * 0 * 3");
}

TEST(springs_join_two_nodes_of_one_body_with_length_and_stiffness)
{
    square s;
    make_square(&s);
    s.ends[4] = 9;
    refuse(&s, DEM_ERROR_MODEL, "spring 2 * node 9 * 4 nodes");
    make_square(&s);
    s.ends[4] = 3;
    refuse(&s, DEM_ERROR_MODEL, "spring 2 joins node 3 * itself");
    make_square(&s);
    s.rest_length[1] = 0.0;
    refuse(&s, DEM_ERROR_MODEL, "spring 1: rest length * > 0 * 0 m");
    s.rest_length[1] = infinite;
    refuse(&s, DEM_ERROR_MODEL, "spring 1: rest length * > 0 * inf m");
    make_square(&s);
    s.stiffness[3] = -2.0;
    refuse(&s, DEM_ERROR_MODEL, "spring 3: stiffness * > 0 * -2 N");
    s.stiffness[3] = not_a_number;
    refuse(&s, DEM_ERROR_MODEL, "spring 3: stiffness * > 0 * nan N");
    make_square(&s);
    s.lattice.body = s.body;
    s.body[2] = 1;
    refuse(&s, DEM_ERROR_MODEL, "spring 1 joins bodies 0 and 1");
    make_square(&s);
    s.ends[8] = 2;
    s.ends[9] = 1;
    refuse(&s, DEM_ERROR_MODEL, "springs 1 and 4 * nodes 1 and 2");
}

TEST(viscosities_are_finite_and_not_negative)
{
    square s;
    make_square(&s);
    s.lattice.viscosity = s.viscosity;
    s.viscosity[4] = -0.5;
    refuse(&s, DEM_ERROR_MODEL, "spring 4: viscosity * >= 0 * -0.5 N s");
    s.viscosity[4] = infinite;
    refuse(&s, DEM_ERROR_MODEL, "spring 4: viscosity * >= 0 * inf N s");
    s.viscosity[3] = not_a_number;
    refuse(&s, DEM_ERROR_MODEL, "spring 3: viscosity * >= 0 * nan N s");
}

TEST(spring_and_triangle_arrays_must_be_there)
{
    square s;
    make_square(&s);
    s.lattice.n_springs = -1;
    refuse(&s, DEM_ERROR_ARGUMENT, "the number of springs is negative: -1");
    make_square(&s);
    s.lattice.ends = NULL;
    refuse(&s, DEM_ERROR_ARGUMENT, "5 springs * NULL");
    make_square(&s);
    s.lattice.stiffness = NULL;
    refuse(&s, DEM_ERROR_ARGUMENT, "5 springs * rest_length * stiffness is NULL");
    make_square(&s);
    s.lattice.triangles = NULL;
    refuse(&s, DEM_ERROR_ARGUMENT, "2 triangles * NULL");
}

TEST(triangles_are_counter_clockwise_with_numbers_in_range)
{
    square s;
    make_square(&s);
    s.triangles[3] = 2;
    s.triangles[4] = 0;
    refuse(&s, DEM_ERROR_MODEL, "triangle 1 (nodes 2, 0, 3): area * > 0 * -0.5 m^2");
    s.triangles[4] = 2;
    refuse(&s, DEM_ERROR_MODEL, "triangle 1 (nodes 2, 2, 3): area * > 0 * 0 m^2");
    make_square(&s);
    s.triangles[5] = -1;
    refuse(&s, DEM_ERROR_MODEL, "triangle 1 * node -1 * 4 nodes");
    make_square(&s);
    s.guard[0] = -0.25;
    refuse(&s, DEM_ERROR_MODEL, "triangle 0: guard * >= 0 * -0.25 N/m");
    s.guard[0] = infinite;
    refuse(&s, DEM_ERROR_MODEL, "triangle 0: guard * >= 0 * inf N/m");
    s.guard[0] = 0.0;
    s.lattice.area_stiffness = s.area_stiffness;
    s.area_stiffness[1] = -infinite;
    refuse(&s, DEM_ERROR_MODEL, "triangle 1: area stiffness * finite * -inf N/m");
    make_square(&s);
    s.lattice.thickness = (double[2]){1.0, 0.0};
    refuse(&s, DEM_ERROR_MODEL, "triangle 1: thickness * > 0 * 0 m");
    s.lattice.thickness = (double[2]){1.0, 2.0};
    s.lattice.modulus = (double[2]){-3.0, 1.0};
    refuse(&s, DEM_ERROR_MODEL, "triangle 0: modulus * > 0 * -3 Pa");
    s.lattice.modulus = NULL;
    s.lattice.coupling = (double[6]){1.0, 2.0, 3.0, 4.0, infinite, 6.0};
    refuse(&s, DEM_ERROR_MODEL, "triangle 1: coupling * finite * inf N/m");
}

/* What triangles stand: infinity is never, but no other number may be none. */
TEST(limits_of_triangles_are_those_of_a_law)
{
    const double never = infinite, none = not_a_number;
    const struct {
        double strength, softening, compressive, confinement;
        const char *reason; /* NULL: it is one */
    } cases[] = {{1e5, 1.0, 1e5, 1.0, NULL},
                 {1e5, 1.0, 1e6, 0.0, NULL},
                 {1e5, 4.0, never, 0.0, NULL},
                 {never, 1.0, never, 0.0, NULL},
                 {0.0, 1.0, 1e6, 0.0, "triangle 0: strength must be > 0"},
                 {none, 1.0, never, 0.0, "triangle 0: strength must be > 0"},
                 {1e5, 0.5, never, 0.0, "triangle 0: softening must be >= 1"},
                 {1e5, 1.0, 9e4, 0.0, "triangle 0: compressive strength must be at least its strength, 100000 Pa"},
                 {1e5, 1.0, -1e6, 0.0, "triangle 0: compressive strength"},
                 {1e5, 1.0, none, 0.0, "triangle 0: compressive strength"},
                 {never, 1.0, 1e6, 0.0, "triangle 0: compressive strength must be at least its strength, inf"},
                 {1e5, 4.0, 1e6, 0.0, "triangle 0: one that softens, by 4, has no compressive strength"},
                 {1e5, 1.0, 1e6, -1.0, "triangle 0: confinement must be >= 0"},
                 {1e5, 1.0, 1e6, never, "triangle 0: confinement must be >= 0"}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        square s;
        make_square(&s);
        s.lattice.strength = (double[2]){cases[k].strength, 1.0};
        s.lattice.softening = (double[2]){cases[k].softening, 1.0};
        s.lattice.compressive_strength = (double[2]){cases[k].compressive, 1.0};
        s.lattice.confinement = (double[2]){cases[k].confinement, 0.0};
        if (cases[k].reason != NULL)
            refuse(&s, DEM_ERROR_MODEL, cases[k].reason);
        else
            dem_model_destroy(compile(&s));
    }
}

TEST(own_stress_is_a_flag)
{
    square s;
    make_square(&s);
    s.lattice.own_stress = (unsigned char[2]){1, 2};
    refuse(&s, DEM_ERROR_MODEL, "triangle 1: own_stress must be 0 or 1, got 2");
}

TEST(a_node_without_springs_must_be_a_body_of_its_own)
{
    square s;
    make_square(&s);
    s.lattice.n_springs = 2; /* 0-1 and 1-2 are left */
    refuse(&s, DEM_ERROR_MODEL, "node 3 * (0, 1) m * no springs * body 0");
    s.lattice.n_springs = 1; /* the first one is named */
    refuse(&s, DEM_ERROR_MODEL, "node 2 * (1, 1) m * no springs * body 0");
    s.lattice.n_springs = 2;
    s.lattice.body = s.body;
    s.body[3] = 1;
    CLEANUP(free_model) dem_model *model = compile(&s);
    assert_int_equal(ask_sizes(model).n_bodies, 2);
}

TEST(body_numbers_have_no_holes)
{
    square s;
    make_square(&s);
    s.lattice.body = s.body;
    for (int i = 0; i < 4; i++) s.body[i] = 1;
    refuse(&s, DEM_ERROR_MODEL, "body 0 * no nodes * 1");
}

TEST(obstacles_are_validated_too)
{
    const double points[4] = {0.0, 0.0, 0.0, 0.0};
    const dem_obstacle obstacle = SIZED(dem_obstacle, .n_points = 2, .points = points, .restitution = 0.0);
    dem_model *model;
    square s;
    make_square(&s);
    assert_int_equal(dem_model_create(&model, &s.lattice, &obstacle, 1), DEM_ERROR_MODEL);
    assert_message_parts("obstacle 0: segment 0 * length 0 m");
}

/* ---- what the model holds ---- */

TEST(absent_arrays_get_their_defaults)
{
    square s;
    make_square(&s);
    CLEANUP(free_model) dem_model *model = compile(&s);
    const dem_lattice *l = dem_model_lattice(model);
    assert_memory_equal(l->position, s.x, sizeof s.x);
    assert_null(l->viscosity);
    assert_null(ask_csr(model).viscosity);
    for (int k = 0; k < 2 * n_nodes; k++) assert_close(l->velocity[k], 0.0, 0.0);
    for (int i = 0; i < n_nodes; i++) {
        assert_int_equal(l->body[i], 0);
        assert_int_equal(l->flags[i], DEM_NODE_CONTACT);
    }
}

TEST(by_default_the_boundary_may_touch)
{
    const dem_material rubber =
        SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0, .thickness = 1.0);
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    CLEANUP(free_model) dem_model *model;
    assert_ok(dem_lattice_rectangle(&lattice, 4.0, 4.0, 1.0));
    assert_ok(dem_lattice_assemble(&lattice, &rubber));
    assert_ok(dem_model_create(&model, &lattice, NULL, 0));
    double top = 0.0;
    for (dem_index i = 0; i < lattice.n_nodes; i++) top = fmax(top, lattice.x[2 * i + 1]);
    dem_index n = 0;
    for (dem_index i = 0; i < lattice.n_nodes; i++) {
        const double y = lattice.x[2 * i + 1];
        const int outer = fabs(lattice.x[2 * i]) > 1.4 || y < 0.1 || y > top - 0.1; /* rows end at 2.0 or 1.5 */
        assert_int_equal(dem_model_lattice(model)->flags[i], outer ? DEM_NODE_CONTACT : 0);
        if (outer) assert_int_equal(model->surface.nodes[n++], i);
    }
    assert_int_equal(ask_sizes(model).n_contact_nodes, n);
    assert_true(n < lattice.n_nodes);
}

TEST(fixed_nodes_are_at_rest_take_no_force_and_never_touch)
{
    square s;
    make_square(&s);
    s.lattice.flags = s.flags;
    s.lattice.velocity = s.velocity;
    CLEANUP(free_model) dem_model *model = compile(&s);
    const forces down = {.model = model, .gravity = {0.0, -9.81}};
    const double velocity[2 * n_nodes] = {1.0, 2.0, 0.0, 0.0, 5.0, 6.0, 0.0, 0.0};
    assert_memory_equal(dem_model_lattice(model)->velocity, velocity, sizeof velocity);
    assert_int_equal(model->surface.n_nodes, 1);
    assert_int_equal(model->surface.nodes[0], 0);
    for (dem_index i = 0; i < n_nodes; i++) {
        const vec2 a = forces_acceleration(&down, i, s.position, s.velocity);
        assert_close(model->inverse_mass[i], i % 2 == 1 ? 0.0 : 1.0 / s.mass[i], 0.0);
        assert_int_equal(a.x == 0.0 && a.y == 0.0, i % 2 == 1);
    }
    assert_close(dem_model_mass(model), 10.0, 0.0);
}

TEST(the_model_is_independent_of_what_it_was_made_from)
{
    double points[4] = {-5.0, 0.0, 5.0, 0.0};
    const dem_obstacle obstacle = SIZED(dem_obstacle, .n_points = 2, .points = points, .restitution = 0.25);
    const double at[2] = {0.5, 2.0};
    CLEANUP(free_model) dem_model *model;
    square s;
    make_square(&s);
    s.lattice.position = s.position;
    s.lattice.viscosity = s.viscosity;
    s.lattice.area_stiffness = s.area_stiffness;
    assert_ok(dem_model_create(&model, &s.lattice, &obstacle, 1));
    points[1] = points[3] = 100.0;
    memset(s.x, 0xff, offsetof(square, lattice));
    const dem_lattice *l = dem_model_lattice(model);
    assert_memory_equal(l->x, plain.x, sizeof plain.x);
    assert_memory_equal(l->mass, plain.mass, sizeof plain.mass);
    assert_memory_equal(l->ends, plain.ends, sizeof plain.ends);
    assert_memory_equal(l->rest_length, plain.rest_length, sizeof plain.rest_length);
    assert_memory_equal(l->stiffness, plain.stiffness, sizeof plain.stiffness);
    assert_memory_equal(l->viscosity, plain.viscosity, sizeof plain.viscosity);
    assert_memory_equal(l->triangles, plain.triangles, sizeof plain.triangles);
    assert_memory_equal(l->guard, plain.guard, sizeof plain.guard);
    assert_memory_equal(l->area_stiffness, plain.area_stiffness, sizeof plain.area_stiffness);
    assert_memory_equal(l->position, plain.position, sizeof plain.position);
    assert_close(dem_model_gap(model, at), 2.0, 0.0);
    assert_close(dem_model_obstacle(model, 0)->points[1], 0.0, 0.0);
    assert_close(dem_model_obstacle(model, 0)->restitution, 0.25, 0.0);
    for (dem_index k = -1; k <= 1; k += 2) {
        assert_null(dem_model_obstacle(model, k));
        assert_non_null(strstr(dem_status_message(), ": there are 1"));
    }
}

/* The square has a fixed node, whose velocity is none; where the lattice has no array the model has its own. */
TEST(a_model_may_borrow_its_lattice)
{
    square s;
    make_square(&s);
    s.lattice.velocity = s.velocity;
    s.lattice.flags = s.flags;
    CLEANUP(free_model) dem_model *model = NULL, *copying = NULL;
    assert_ok(dem_model_create(&copying, &s.lattice, NULL, 0));
    assert_ok(dem_model_create_borrowing(&model, &s.lattice, NULL, 0));
    const dem_lattice *l = dem_model_lattice(model), *other = dem_model_lattice(copying);
    assert_ptr_equal(l->x, s.x);
    assert_ptr_equal(l->position, s.x);
    assert_ptr_equal(l->ends, s.ends);
    assert_ptr_equal(l->triangles, s.triangles);
    assert_ptr_equal(l->flags, s.flags);
    assert_memory_equal(l->velocity, other->velocity, sizeof s.velocity);
    assert_memory_equal(l->body, other->body, sizeof s.body);
    assert_close(l->velocity[2], 0.0, 0.0);
    assert_memory_equal(s.velocity, plain.velocity, sizeof s.velocity);
    assert_close(dem_model_omega_max(model), dem_model_omega_max(copying), 0.0);
    dem_model_destroy(model);
    model = NULL;
    assert_memory_equal(s.x, plain.x, sizeof s.x);
    s.lattice.n_springs = 0; /* arrays of nothing are as missing ones */
    s.lattice.n_nodes = 1, s.lattice.n_triangles = 0;
    assert_ok(dem_model_create_borrowing(&model, &s.lattice, NULL, 0));
    assert_null(dem_model_lattice(model)->ends);
    assert_null(dem_model_lattice(model)->guard);
}

TEST(sizes_and_csr_tell_what_is_there)
{
    const double points[6] = {-5.0, 0.0, 0.0, 0.0, 5.0, 0.0};
    const dem_obstacle obstacles[2] = {
        {.struct_size = sizeof(dem_obstacle), .n_points = 3, .points = points, .restitution = 0.0},
        {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = points, .restitution = 0.0}};
    static const dem_index row[n_nodes + 1] = {0, 3, 5, 8, 10},
                                         neighbour[2 * n_springs] = {1, 2, 3, 0, 2, 0, 1, 3, 0, 2};
    static const dem_index spring[2 * n_springs] = {0, 4, 3, 0, 1, 4, 1, 2, 3, 2};
    CLEANUP(free_model) dem_model *model;
    square s;
    make_square(&s);
    s.lattice.viscosity = s.viscosity;
    assert_ok(dem_model_create(&model, &s.lattice, obstacles, 2));
    const dem_model_size size = ask_sizes(model);
    const dem_index expected[7] = {n_nodes, n_springs, n_triangles, 1, n_nodes, 2, 3};
    const dem_index actual[7] = {size.n_nodes,         size.n_springs,   size.n_triangles, size.n_bodies,
                                 size.n_contact_nodes, size.n_obstacles, size.n_segments};
    for (int k = 0; k < 7; k++) assert_int_equal(actual[k], expected[k]);
    const dem_csr csr = ask_csr(model);
    assert_int_equal(csr.n_nodes, n_nodes);
    assert_memory_equal(csr.row, row, sizeof row);
    assert_memory_equal(csr.neighbour, neighbour, sizeof neighbour);
    assert_memory_equal(csr.spring, spring, sizeof spring);
    for (int p = 0; p < 2 * n_springs; p++) {
        assert_close(csr.stiffness[p], plain.stiffness[spring[p]], 0.0);
        assert_close(csr.rest_length[p], plain.rest_length[spring[p]], 0.0);
        assert_close(csr.viscosity[p], plain.viscosity[spring[p]], 0.0);
    }
    const dem_csr again = ask_csr(model);
    assert_memory_equal(&again, &csr, sizeof csr); /* the same arrays */
}

/* Springs 0-1 (k = 10 N/m) and 1-2 (20 N/m) at a right angle: node 0 of 1 kg has 2 * 10, node 1 of 2 kg 2 * 20/2,
 * node 2 of 3 kg less; a fixed node does not count. */
TEST(spacing_mass_and_the_frequency_bound_are_those_of_the_springs)
{
    square s;
    make_square(&s);
    CLEANUP(free_model) dem_model *model = compile(&s);
    assert_close(dem_model_spacing(model), 0.5, 0.0);
    assert_close(dem_model_mass(model), 10.0, 0.0);
    dem_model_destroy(model);
    s.lattice.n_springs = 2;
    s.lattice.n_nodes = 3;
    s.lattice.n_triangles = 1;
    model = compile(&s);
    assert_close(dem_model_omega_max(model), sqrt(20.0), 1e-15);
    assert_close(dem_model_spacing(model), 1.0, 0.0);
    assert_close(dem_model_mass(model), 6.0, 0.0);
    dem_model_destroy(model);
    s.lattice.flags = s.flags;
    s.flags[0] = DEM_NODE_FIXED;
    model = compile(&s);
    assert_close(dem_model_omega_max(model), sqrt(2.0 * 20.0 / 3.0), 1e-15); /* node 1 is fixed as well */
}

/* The triangle 0 1 2 of 0.5 m^2: |g| is half the opposite side, so that node 0, of 1 kg, with its spring along x and
 * g = (-1/2, 0), has 2 * 10 + 3 * 40/0.5 * 1/4; a negative stiffness counts as none. */
TEST(area_stiffness_raises_the_frequency_bound)
{
    square s;
    make_square(&s);
    s.lattice.area_stiffness = s.area_stiffness;
    s.area_stiffness[0] = 40.0;
    s.lattice.n_springs = 2;
    s.lattice.n_nodes = 3;
    s.lattice.n_triangles = 1;
    CLEANUP(free_model) dem_model *model = compile(&s);
    assert_close(dem_model_omega_max(model), sqrt(80.0), 1e-14);
    dem_model_destroy(model);
    s.area_stiffness[0] = -40.0;
    model = compile(&s);
    assert_close(dem_model_omega_max(model), sqrt(20.0), 1e-15);
}

TEST(without_springs_spacing_and_frequency_are_zero)
{
    const double anywhere[2] = {3.0, 4.0};
    square s;
    make_square(&s);
    s.lattice.n_nodes = 1;
    s.lattice.n_springs = s.lattice.n_triangles = 0;
    CLEANUP(free_model) dem_model *model = compile(&s);
    assert_close(dem_model_spacing(model), 0.0, 0.0);
    assert_close(dem_model_omega_max(model), 0.0, 0.0);
    assert_true(dem_model_gap(model, anywhere) == infinite);
}

/* ---- force ---- */

/* Central differences over 1e-6 m: truncation of order 1e-12 * 1e3 N/m^2, rounding 1e-16 * 1e3 J/1e-6 m. Node 2
 * moved so that triangle 0 1 2 is squeezed to 0.1: springs, area
 * term, guard and weight all act. */
TEST(force_and_weight_are_minus_the_gradient_of_the_energy_at_a_node)
{
    const double step = 1e-6, v[2 * n_nodes] = {0};
    const double gravity[2] = {0.5, -9.81};
    double x[2 * n_nodes];
    square s;
    make_square(&s);
    s.guard[0] = 30.0;
    s.lattice.area_stiffness = s.area_stiffness;
    CLEANUP(free_model) dem_model *model = compile(&s);
    const forces acting = {.model = model, .gravity = {gravity[0], gravity[1]}};
    memcpy(x, s.x, sizeof x);
    x[5] = 0.1;
    assert_true(triangles_node_energy(&model->triangles, TRIANGLES_WHOLE, 2, x) > 1.0);
    for (dem_index i = 0; i < n_nodes; i++) {
        const vec2 a = forces_acceleration(&acting, i, x, v), force = forces_of_elements(&acting, i, x, v);
        for (int k = 0; k < 2; k++) {
            const double here = x[2 * i + k], f = k == 0 ? force.x : force.y;
            x[2 * i + k] = here + step;
            const double above = forces_node_energy(&acting, i, x);
            x[2 * i + k] = here - step;
            const double below = forces_node_energy(&acting, i, x);
            x[2 * i + k] = here;
            assert_close(f + s.mass[i] * gravity[k], (below - above) / (2.0 * step), 1e-6);
            assert_close((k == 0 ? a.x : a.y) * s.mass[i], f + s.mass[i] * gravity[k], 1e-12);
        }
    }
}

/* Node 1 of 2 kg moves with (3, 4) m/s away from node 0 (c = 1 N s) and along the spring to node 2 (c = 2 N s), both
 * of 1 m: damping (-1 * 3, -2 * 4) N, and -0.5/s of the velocity. Exact. */
TEST(damping_of_springs_and_mass_slow_a_node)
{
    const double v[2 * n_nodes] = {0.0, 0.0, 3.0, 4.0};
    square s;
    make_square(&s);
    s.lattice.viscosity = s.viscosity;
    CLEANUP(free_model) dem_model *model = compile(&s);
    const forces acting = {.model = model, .gravity = {0.0, -10.0}, .mass_damping = 0.5};
    const vec2 force = forces_of_elements(&acting, 1, s.x, v), a = forces_acceleration(&acting, 1, s.x, v);
    assert_close(force.x, -3.0, 0.0);
    assert_close(force.y, -8.0, 0.0);
    assert_close(a.x, -3.0 / 2.0 - 0.5 * 3.0, 0.0);
    assert_close(a.y, -8.0 / 2.0 - 0.5 * 4.0 - 10.0, 0.0);
}
