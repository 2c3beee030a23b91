/* SPDX-License-Identifier: BSD-3-Clause */
/* Ramps, prescribed components, forces on nodes, and what is refused. */
#include <stdlib.h>

#include "forces/boundary_conditions.h"
#include "harness/message.h"
#include "unit/close.h"

enum { n_nodes = 4 };

static unsigned char flags[n_nodes] = {DEM_NODE_CONTACT, 0, 0, DEM_NODE_FIXED};
static const dem_lattice lattice = {.dim = 2, .n_nodes = n_nodes, .flags = flags};

static void compiled(boundary_conditions *out, const dem_boundary *list, dem_index n)
{
    assert_int_equal(boundary_conditions_compile(out, list, n, &lattice, NULL, 1), DEM_OK);
}

/* The ramp rises from 0 to 1 as its symmetric polynomial does, and stays there. */
TEST(a_ramp_rises_smoothly_from_0_to_1)
{
    const boundary_condition b = {.ramp = 2.0}, none = {.ramp = 0.0};
    assert_close(boundary_condition_ramp(&b, 0.0), 0.0, 0.0);
    assert_close(boundary_condition_ramp(&b, 0.5), 53.0 / 512.0, 1e-16);
    assert_close(boundary_condition_ramp(&b, 1.0), 0.5, 1e-16);
    assert_close(boundary_condition_ramp(&b, 1.5), 1.0 - 53.0 / 512.0, 1e-15);
    assert_close(boundary_condition_ramp(&b, 2.0), 1.0, 0.0);
    assert_close(boundary_condition_ramp(&b, 9.0), 1.0, 0.0);
    assert_close(boundary_condition_ramp(&none, 0.0), 1.0, 0.0);
}

/* Central differences of the way give velocity and acceleration, before, on and beyond the ramp; their error is h^2/6
 * times a derivative of at most 360/ramp^3 and 1080/ramp^4. */
TEST(velocity_and_acceleration_are_derivatives_of_the_way)
{
    static const double times[] = {0.2, 0.9, 1.3, 1.9, 2.7};
    const double h = 1e-4;
    for (int kind = DEM_BOUNDARY_VELOCITY; kind <= DEM_BOUNDARY_DISPLACEMENT; kind++)
        for (size_t k = 0; k < sizeof times / sizeof *times; k++) {
            const boundary_condition b = {.kind = (dem_boundary_kind)kind, .value = {3.0, -2.0}, .ramp = 2.0};
            const double t = times[k];
            const vec2 before = boundary_condition_displacement(&b, t - h),
                       after = boundary_condition_displacement(&b, t + h);
            const vec2 slower = boundary_condition_velocity(&b, t - h), faster = boundary_condition_velocity(&b, t + h);
            assert_close(boundary_condition_velocity(&b, t).x, (after.x - before.x) / (2.0 * h), 1e-6);
            assert_close(boundary_condition_velocity(&b, t).y, (after.y - before.y) / (2.0 * h), 1e-6);
            assert_close(boundary_condition_acceleration(&b, t).x, (faster.x - slower.x) / (2.0 * h), 1e-6);
            assert_close(boundary_condition_acceleration(&b, t).y, (faster.y - slower.y) / (2.0 * h), 1e-6);
        }
}

TEST(a_constant_velocity_goes_on_from_half_its_ramp)
{
    const boundary_condition ramped = {.kind = DEM_BOUNDARY_VELOCITY, .value = {3.0, 0.0}, .ramp = 2.0};
    const boundary_condition sudden = {.kind = DEM_BOUNDARY_VELOCITY, .value = {3.0, 0.0}};
    assert_close(boundary_condition_displacement(&ramped, 2.0).x, 3.0, 1e-15);
    assert_close(boundary_condition_displacement(&ramped, 5.0).x, 12.0, 1e-15);
    assert_close(boundary_condition_displacement(&sudden, 5.0).x, 15.0, 1e-15);
    assert_close(boundary_condition_velocity(&sudden, 0.0).x, 3.0, 0.0);
    assert_close(boundary_condition_acceleration(&sudden, 0.0).x, 0.0, 0.0);
}

/* At 1 s.  \return the power */
static double prescribe(const boundary_conditions *b, const double *mass, const double *v, double *f, double *a)
{
    exact_sum power = {0};
    exact_terms terms;
    exact_terms_begin(&terms, &power);
    boundary_conditions_prescribe(b, mass, 1.0, v, &(boundary_derivative){f, a, &terms});
    exact_terms_end(&terms);
    return exact_sum_value(&power);
}

TEST(forces_add_up_on_a_node_and_follow_their_ramps)
{
    static const dem_index nodes[] = {0, 2}, one[] = {2};
    static const double share[] = {0.25, 3.0};
    const dem_boundary list[] = {
        SIZED(dem_boundary, .kind = DEM_BOUNDARY_FORCE, .n_nodes = 2, .nodes = nodes, .share = share,
              .value = {4.0, 8.0}, .ramp = 2.0),
        SIZED(dem_boundary, .kind = DEM_BOUNDARY_FORCE, .n_nodes = 1, .nodes = one, .value = {0.0, 1.0})};
    CLEANUP(boundary_conditions_free) boundary_conditions b;
    compiled(&b, list, 2);
    assert_close(boundary_conditions_force(&b, 0, 1.0).x, 0.5, 1e-15);
    assert_close(boundary_conditions_force(&b, 1, 1.0).x, 0.0, 0.0);
    assert_close(boundary_conditions_force(&b, 2, 1.0).x, 6.0, 1e-14);
    assert_close(boundary_conditions_force(&b, 2, 1.0).y, 13.0, 1e-14);
    const double v[2 * n_nodes] = {1.0, 0.0, 9.0, 9.0, 0.0, 2.0}, mass[n_nodes] = {1.0, 1.0, 1.0, 1.0};
    double f[2 * n_nodes] = {0.0}, a[2 * n_nodes] = {0.0};
    assert_close(prescribe(&b, mass, v, f, a), 0.5 * 1.0 + 13.0 * 2.0, 1e-14); /* sum of F.v */
    assert_close(boundary_conditions_speed(&b), 0.0, 0.0);
}

/* Only the component named is prescribed; the power is what its force, m times the change of acceleration, does. */
TEST(a_prescribed_component_leaves_the_other_one_free)
{
    static const dem_index nodes[] = {1};
    const dem_boundary list[] = {SIZED(dem_boundary, .kind = DEM_BOUNDARY_VELOCITY, .components = DEM_COMPONENT_Y,
                                       .n_nodes = 1, .nodes = nodes, .value = {7.0, 5.0})};
    const double mass[n_nodes] = {1.0, 2.0, 1.0, 1.0};
    double v[2 * n_nodes] = {0.0}, f[2 * n_nodes] = {0.0}, a[2 * n_nodes] = {0.0};
    exact_sum energy = {0};
    CLEANUP(boundary_conditions_free) boundary_conditions b;
    compiled(&b, list, 1);
    boundary_conditions_give_velocities(&b, mass, 0.0, v, &energy);
    assert_close(exact_sum_value(&energy), 25.0, 0.0); /* 2 kg (5 m/s)^2/2 */
    assert_close(v[2], 0.0, 0.0);
    assert_close(v[3], 5.0, 0.0);
    f[2] = 1.0, f[3] = 4.9, a[2] = 11.0, a[3] = -3.0;
    assert_close(prescribe(&b, mass, v, f, a), 2.0 * 3.0 * 5.0, 1e-14);
    assert_close(f[2], 1.0, 0.0);
    assert_close(f[3], 5.0, 0.0);
    assert_close(a[2], 11.0, 0.0);
    assert_close(a[3], 0.0, 0.0);
    assert_close(boundary_conditions_speed(&b), hypot(7.0, 5.0), 1e-15);
}

/* The fastest point of a displacement's ramp is its middle. */
TEST(the_speed_of_a_displacement_is_that_of_its_middle)
{
    static const dem_index nodes[] = {1};
    const dem_boundary list[] = {SIZED(dem_boundary, .kind = DEM_BOUNDARY_DISPLACEMENT, .components = DEM_COMPONENT_X,
                                       .n_nodes = 1, .nodes = nodes, .value = {-4.0, 0.0}, .ramp = 2.0)};
    CLEANUP(boundary_conditions_free) boundary_conditions b;
    compiled(&b, list, 1);
    assert_close(boundary_conditions_speed(&b), -boundary_condition_velocity(&b.list[0], 1.0).x, 1e-15);
}

static void refused(dem_boundary one, dem_status status, const char *message)
{
    boundary_conditions b;
    assert_int_equal(boundary_conditions_compile(&b, &one, 1, &lattice, NULL, 1), status);
    assert_message_parts(message);
    assert_null(b.list);
}

TEST(faults_are_named)
{
    static const dem_index nodes[] = {1, 2}, twice[] = {2, 2}, beyond[] = {4}, touching[] = {0}, fixed[] = {3};
    const dem_boundary good =
        SIZED(dem_boundary, .kind = DEM_BOUNDARY_VELOCITY, .components = DEM_COMPONENT_X, .n_nodes = 2, .nodes = nodes);
    dem_boundary bad = good;
    bad.kind = (dem_boundary_kind)9;
    refused(bad, DEM_ERROR_ARGUMENT, "boundary 0 * kind 9");
    bad = good, bad.n_nodes = 0;
    refused(bad, DEM_ERROR_ARGUMENT, "boundary 0 * no nodes");
    bad = good, bad.components = 4;
    refused(bad, DEM_ERROR_ARGUMENT, "boundary 0: components * DEM_COMPONENT_X, DEM_COMPONENT_Y * 4");
    bad = good, bad.value[1] = (double)NAN;
    refused(bad, DEM_ERROR_ARGUMENT, "boundary 0: value (0, nan) * not finite");
    bad = good, bad.value[2] = 2.5;
    refused(bad, DEM_ERROR_ARGUMENT, "boundary 0: value * third component * 2.5");
    bad = good, bad.ramp = -1.0;
    refused(bad, DEM_ERROR_ARGUMENT, "boundary 0: ramp * >= 0 * -1 s");
    bad = good, bad.kind = DEM_BOUNDARY_DISPLACEMENT;
    refused(bad, DEM_ERROR_ARGUMENT, "boundary 0 * displacement * ramp > 0");
    bad = good, bad.nodes = twice;
    refused(bad, DEM_ERROR_ARGUMENT, "boundary 0: node 2 * twice");
    bad = good, bad.n_nodes = 1, bad.nodes = beyond;
    refused(bad, DEM_ERROR_ARGUMENT, "boundary 0: node 4 * 0 * 3");
    bad.nodes = touching;
    refused(bad, DEM_ERROR_MODEL, "boundary 0: node 0 * touch * motion * prescribed; dem_lattice_exclude()");
    bad.nodes = fixed;
    refused(bad, DEM_ERROR_MODEL, "boundary 0: node 3 * fixed already");
}

TEST(a_component_is_prescribed_once)
{
    static const dem_index nodes[] = {1, 2};
    dem_boundary list[] = {
        SIZED(dem_boundary, .kind = DEM_BOUNDARY_VELOCITY, .components = DEM_COMPONENT_X, .n_nodes = 2, .nodes = nodes),
        SIZED(dem_boundary, .kind = DEM_BOUNDARY_VELOCITY, .components = DEM_COMPONENT_Y, .n_nodes = 2,
              .nodes = nodes)};
    boundary_conditions b;
    compiled(&b, list, 2);
    boundary_conditions_free(&b);
    list[1].components = DEM_COMPONENT_X | DEM_COMPONENT_Y;
    assert_int_equal(boundary_conditions_compile(&b, list, 2, &lattice, NULL, 1), DEM_ERROR_MODEL);
    assert_message_parts("boundary 1 * motion * node 1 * prescribed * another one already");
}
