/* SPDX-License-Identifier: BSD-3-Clause */
/* Boundaries: a driven oscillator, a suddenly loaded one, a block pulled to rest, friction under a growing force. */
#include <stdlib.h>

#include "harness/motion.h"
#include "support.h"

/* Two masses on a line: a spring of stiffness E/d0 between them, which (1) makes linear as long as it keeps its
 * direction. Node 0 is driven, node 1 free. */
static const double mass = 2.0, stiffness = 50.0, length = 0.5;

static void open_pair(support_run *run, const dem_boundary *boundary, const double *velocity)
{
    const double x[] = {0.0, 0.0, 0.5, 0.0}, masses[] = {3.0, mass};
    const dem_index ends[] = {0, 1};
    dem_options options = support_options();
    options.gravity[1] = 0.0;
    options.rtol = 1e-11;
    options.n_boundaries = 1;
    options.boundaries = boundary;
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(2, x, masses, 1, ends, length, stiffness, NULL);
    support_start(&lattice, NULL, velocity);
    support_open(run, &lattice, NULL, 0, &options);
}

static double closure(const dem_simulation *simulation, double start)
{
    return ask_energy(simulation).ledger - start;
}

/* Node 0 goes with V from t = 0: node 1 follows by V (t - sin(w t)/w), w^2 = E/(d0 m); the spring pulls the driven node
 * with m V w sin(w t), and the work is m V^2 (1 - cos(w t)). Errors of rtol 1e-11 of the spacing over 20 periods: twice
 * that of the way, 1e-8 of the rest. */
TEST(a_mass_follows_a_driven_one)
{
    static const dem_index node[] = {0};
    const double v = 0.01, w = sqrt(stiffness / (length * mass));
    const double start[] = {v, 0.0, 0.0, 0.0};
    const dem_boundary drive = SIZED(dem_boundary, .components = DEM_COMPONENT_X | DEM_COMPONENT_Y, .n_nodes = 1,
                                     .nodes = node, .value = {v, 0.0});
    CLEANUP(support_close) support_run run;
    open_pair(&run, &drive, NULL);
    const double initial = ask_energy(run.simulation).ledger;
    assert_close(initial, 0.5 * 3.0 * start[0] * start[0], 1e-18); /* it moves from the start */
    for (double t = 0.1; t < 20.0 * 2.0 * M_PI / w; t += 0.37) {
        const motion s = support_at(&run, t);
        const dem_boundary_load load = ask_boundary(run.simulation, 0);
        assert_close(s.x[0], v * t, 1e-14);
        assert_close(s.x[2] - 0.5, v * (t - sin(w * t) / w), 2.0 * 1e-11 * length);
        assert_close(load.force[0], mass * v * w * sin(w * t), 1e-8 * mass * v * w);
        assert_close(load.displacement[0], v * t, 1e-14);
        assert_close(s.energy.boundary, mass * v * v * (1.0 - cos(w * t)), 1e-8 * mass * v * v);
        assert_close(closure(run.simulation, initial), 0.0, 1e-8 * mass * v * v);
    }
}

/* A displacement by a ramp is its polynomial to rounding, whatever the steps: a method of order 5 is exact for it, but
 * for the step in which the ramp ends, where the fourth derivative jumps. */
TEST(a_ramp_is_followed)
{
    static const dem_index node[] = {0};
    const double way = 0.02, ramp = 1.5;
    const dem_boundary drive = SIZED(dem_boundary, .kind = DEM_BOUNDARY_DISPLACEMENT, .components = DEM_COMPONENT_X,
                                     .n_nodes = 1, .nodes = node, .value = {way, 0.0}, .ramp = ramp);
    CLEANUP(support_close) support_run run;
    open_pair(&run, &drive, NULL);
    const double initial = ask_energy(run.simulation).ledger;
    for (double t = 0.1; t < 4.0; t += 0.1) {
        const motion s = support_at(&run, t);
        const double u = fmin(t / ramp, 1.0);
        assert_close(s.x[0], way * u * u * u * (10.0 - 15.0 * u + 6.0 * u * u), 1e-9 * way);
        assert_close(closure(run.simulation, initial), 0.0, 1e-9 * stiffness * way * way);
    }
}

/* A force F on node 1 from t = 0, node 0 held: F/k (1 - cos(w t)), k = E/d0; the force's work is F times the way. */
TEST(a_sudden_force_swings_to_twice_the_static_way)
{
    static const dem_index held[] = {0}, pulled[] = {1};
    const double force = 0.05, k = stiffness / length, w = sqrt(k / mass);
    const dem_boundary both[] = {
        SIZED(dem_boundary, .components = DEM_COMPONENT_X | DEM_COMPONENT_Y, .n_nodes = 1, .nodes = held),
        SIZED(dem_boundary, .kind = DEM_BOUNDARY_FORCE, .n_nodes = 1, .nodes = pulled, .value = {force, 0.0})};
    const double x[] = {0.0, 0.0, 0.5, 0.0}, masses[] = {3.0, mass};
    const dem_index ends[] = {0, 1};
    dem_options options = support_options();
    CLEANUP(support_close) support_run run;
    options.gravity[1] = 0.0;
    options.rtol = 1e-11;
    options.v_scale = force / k * w;
    options.n_boundaries = 2;
    options.boundaries = both;
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(2, x, masses, 1, ends, length, stiffness, NULL);
    support_open(&run, &lattice, NULL, 0, &options);
    for (double t = 0.1; t < 30.0 / w; t += 0.21) {
        const motion s = support_at(&run, t);
        const double way = force / k * (1.0 - cos(w * t));
        assert_close(s.x[2] - 0.5, way, 1e-7 * force / k); /* rtol is of the spacing, 1000 times the way */
        assert_close(s.energy.boundary, force * way, 1e-7 * force * force / k);
        assert_close(ask_boundary(run.simulation, 1).force[0], force, 0.0);
        assert_close(ask_boundary(run.simulation, 0).force[0], -k * way, 1e-7 * force);
    }
}

/* A mass on a floor, pushed along it by a ramp: friction holds it until F r(t) = mu m g, and not longer. The root of
 * the grip is found to rounding of the time; then it slides with m a = F r(t) - mu m g. */
TEST(friction_holds_until_the_force_exceeds_it)
{
    static const dem_index node[] = {0};
    const double x[] = {0.0, 0.0}, one[] = {mass}, floor[] = {-10.0, 0.0, 100.0, 0.0};
    const double mu = 0.4, g = 10.0, force = 20.0, ramp = 1.0;
    const dem_boundary push = SIZED(dem_boundary, .kind = DEM_BOUNDARY_FORCE, .n_nodes = 1, .nodes = node,
                                    .value = {force, -5.0}, .ramp = ramp);
    const dem_obstacle ground = {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = floor, .friction = mu};
    dem_options options = support_options();
    CLEANUP(support_close) support_run run;
    options.gravity[1] = -g;
    options.rtol = 1e-10;
    options.spacing = options.v_scale = 1.0;
    options.max_step = 0.01;
    options.n_boundaries = 1;
    options.boundaries = &push;
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(1, x, one, 0, NULL, 0.0, 0.0, NULL);
    support_open(&run, &lattice, &ground, 1, &options);
    double lo = 0.0, hi = 1.0; /* the ramp at which F r = mu (m g + 5 r) */
    const double r = mu * mass * g / (force - 5.0 * mu);
    for (int k = 0; k < 60; k++) {
        const double s = 0.5 * (lo + hi);
        *(s * s * s * (10.0 - 15.0 * s + 6.0 * s * s) < r ? &lo : &hi) = s;
    }
    const double slips = lo * ramp;
    motion s = support_at(&run, slips - 1e-9);
    assert_int_equal(s.contacts[0].state, DEM_CONTACT_STICK);
    assert_close(s.x[0], 0.0, 1e-15);
    s = support_at(&run, slips + 1e-9);
    assert_int_equal(s.contacts[0].state, DEM_CONTACT_SLIP);
    s = support_at(&run, 1.0);
    const double v1 = s.v[0];
    s = support_at(&run, 3.0); /* the ramp is over: constant acceleration */
    assert_close((s.v[0] - v1) / 2.0, (force - mu * (mass * g + 5.0)) / mass, 1e-9);
    const dem_obstacle_load load = ask_obstacle(run.simulation, 0);
    assert_close(load.impulse[1], mass * g * 3.0 + 5.0 * (0.5 * ramp + 2.0), 1e-9);
}

/* A block of equilateral triangles, its foot on rollers, pulled by a traction at its head and damped to rest, is as
 * long and as wide as E and nu = 1/3 ask for. Its sides are zigzags, so the outermost nodes of its head carry the
 * stress of a quarter of a spacing: a half, less what their slanted edge would take if the stress went on beyond it.
 * The strain of 1e-7 is the error of small strains; rounding of the coordinates is 1e-9 of it. */
TEST(a_pulled_block_comes_to_rest_with_its_modulus)
{
    const dem_material rubber =
        SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1000.0, .thickness = 0.5);
    const double a = 0.01, width = 0.08, traction = 1.0; /* Pa: a strain of 1e-7 */
    dem_index foot[32], head[32], corner[1] = {0}, n_foot = 0, n_head = 0;
    double share[32], top = 0.0;
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_rectangle(width, 0.09, a, &rubber);
    for (dem_index i = 0; i < lattice.n_nodes; i++) top = fmax(top, lattice.x[2 * i + 1]);
    for (dem_index i = 0; i < lattice.n_nodes; i++) {
        if (lattice.x[2 * i + 1] < 0.1 * a) foot[n_foot++] = i;
        if (lattice.x[2 * i + 1] > top - 0.1 * a) head[n_head++] = i;
    }
    for (dem_index k = 0; k < n_head; k++) share[k] = (k == 0 || k == n_head - 1 ? 0.25 : 1.0) * a * rubber.thickness;
    const dem_boundary list[] = {
        {.struct_size = sizeof(dem_boundary), .components = DEM_COMPONENT_Y, .n_nodes = n_foot, .nodes = foot},
        {.struct_size = sizeof(dem_boundary), .components = DEM_COMPONENT_X, .n_nodes = 1, .nodes = corner},
        SIZED(dem_boundary, .kind = DEM_BOUNDARY_FORCE, .n_nodes = n_head, .nodes = head, .share = share,
              .value = {0.0, traction})};
    dem_options options = support_options();
    options.gravity[1] = 0.0;
    options.v_scale = 1e-5; /* of the wave that the sudden traction sends, traction/(rho c) */
    options.mass_damping = 1000.0;
    options.n_boundaries = 3;
    options.boundaries = list;
    CLEANUP(support_close) support_run run;
    support_open(&run, &lattice, NULL, 0, &options);
    const motion s = support_at(&run, 0.1);
    assert_true(dem_simulation_residual(run.simulation) > 1.0); /* between steps it is not known */
    const double strain = (s.x[2 * head[0] + 1] - top) / top;
    const double wide = s.x[2 * foot[n_foot - 1]] - s.x[2 * foot[0]] - width;
    assert_close(strain, traction / rubber.youngs_modulus, 1e-6 * strain);
    assert_close(-wide / width / strain, 1.0 / 3.0, 1e-6);
    const double pull = traction * ((double)n_head - 1.5) * a * rubber.thickness;
    assert_close(ask_boundary(run.simulation, 0).force[1], -pull, 1e-6 * pull);
}
