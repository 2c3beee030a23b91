/* SPDX-License-Identifier: BSD-3-Clause */
/* An obstacle's vertex against edges of bodies: the impact of one edge against its algebra, and blocks that fall on a
 * wedge, watched by a polygon test of our own at frames and at every accepted step. With an argument: the longer runs
 * too. */
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "outline.h"
#include "harness/motion.h"
#include "support.h"

static bool everything; /* with the long runs */

/* ---- one edge ---- */

/* A and B of mass 0.3 and 0.7 kg at distance 1, turned by `angle`, over an apex at the origin on which they fall at
 * s = 0.25; C, the third corner of the triangle, touches nothing; its springs, and
 * without `spring` that of the edge too, are of 1e-30 N: nothing. */
typedef struct fall {
    double angle, va[2], vb[2], restitution, friction;
    dem_friction_law law;
    bool spring;
} fall;

static const double mass_a = 0.3, mass_b = 0.7, share = 0.25, drop_time = 0.01;

static const double apex[6] = {-1.0, -2.0, 0.0, 0.0, 1.0, -2.0};

typedef struct outcome {
    dem_index n;
    dem_event event;
    double v[6];
} outcome;

static dem_status first_impact(void *context, const dem_simulation *simulation, const dem_event *event)
{
    outcome *o = context;
    motion state;
    if (event->kind != DEM_EVENT_IMPACT || o->n++ > 0) return DEM_OK;
    motion_see(simulation, &state);
    o->event = *event;
    memcpy(o->v, state.v, sizeof o->v);
    return DEM_OK;
}

/* Where the nodes must start so that they touch at `drop_time`, without gravity. */
static void set_up(const fall *f, double x[6], double v[6])
{
    const double c = cos(f->angle), s = sin(f->angle);
    const double a[2] = {-share * c, -share * s}, b[2] = {(1.0 - share) * c, (1.0 - share) * s};
    for (int d = 0; d < 2; d++) {
        x[d] = a[d] - drop_time * f->va[d];
        x[2 + d] = b[d] - drop_time * f->vb[d];
        v[d] = f->va[d];
        v[2 + d] = f->vb[d];
        v[4 + d] = 0.0;
    }
    x[4] = -5.0 * s;
    x[5] = 5.0 * c;
}

static outcome run_fall(const fall *f)
{
    double x[6], v[6];
    const double mass[3] = {mass_a, mass_b, 1e-3};
    const dem_index ends[6] = {0, 1, 0, 2, 1, 2}, corners[3] = {0, 1, 2};
    const dem_obstacle obstacle = SIZED(dem_obstacle, .n_points = 3, .points = apex, .restitution = f->restitution,
                                        .friction = f->friction, .friction_law = f->law);
    dem_options options = support_options();
    outcome o = {0};
    const dem_observer observer = {.struct_size = sizeof(dem_observer), .event = first_impact, .context = &o};
    CLEANUP(support_close) support_run run;
    options.gravity[1] = 0.0;
    options.spacing = options.v_scale = 1.0;
    options.max_step = 1e-3;
    options.penetration_tolerance = 1e-14;
    options.rtol = 1e-12;
    options.window = 0.0; /* as good as no springs set its scale */
    set_up(f, x, v);
    dem_lattice lattice = support_lattice(3, x, mass, 3, ends, 1.0, 1e-30, NULL);
    if (f->spring) lattice.stiffness[0] = 100.0;
    lattice.n_triangles = 1;
    lattice.triangles = malloc(sizeof corners);
    assert_non_null(lattice.triangles);
    memcpy(lattice.triangles, corners, sizeof corners);
    support_start(&lattice, NULL, v);
    support_open(&run, &lattice, &obstacle, 1, &options);
    dem_lattice_free(&lattice);
    assert_ok(dem_simulation_observe(run.simulation, &observer));
    (void)support_at(&run, 1.5 * drop_time);
    assert_int_equal(o.n, 1);
    return o;
}

/* J = -(1 + eta) v_n/W, W = (1 - s)^2/m_A + s^2/m_B, shared (1 - s, s); along the edge at most mu J, and not more than
 * stops it. Speeds are of order 1; the penetration tolerance of 1e-14 m delays by 1e-14 s, over which the edge turns
 * by as much. */
static void check_fall(const fall *f)
{
    const outcome o = run_fall(f);
    const double n[2] = {-sin(f->angle), cos(f->angle)}, t[2] = {n[1], -n[0]}, wa = 1.0 - share, wb = share;
    const double mobility = wa * wa / mass_a + wb * wb / mass_b;
    const double vp[2] = {wa * f->va[0] + wb * f->vb[0], wa * f->va[1] + wb * f->vb[1]};
    const double vn = vp[0] * n[0] + vp[1] * n[1], vt = vp[0] * t[0] + vp[1] * t[1];
    const double j = -(1.0 + f->restitution) * vn / mobility, stop = -vt / mobility;
    double along = fabs(stop) < f->friction * j ? stop : copysign(f->friction * j, stop);
    if (f->law == DEM_FRICTION_PAPER) along = (1.0 - f->friction) * stop;
    double taken = 0.0;
    for (int d = 0; d < 2; d++) {
        const double impulse = j * n[d] + along * t[d];
        assert_close(o.event.impulse[d], impulse, 1e-12);
        assert_close(o.v[d], f->va[d] + wa * impulse / mass_a, 1e-12);
        assert_close(o.v[2 + d], f->vb[d] + wb * impulse / mass_b, 1e-12);
        assert_close(o.v[4 + d], 0.0, 1e-20);
        assert_close(o.event.before[d], vp[d], 1e-12);
        assert_close(o.event.after[d], vp[d] + mobility * impulse, 1e-12);
        assert_close(o.event.normal[d], n[d], 1e-12);
        assert_close(o.event.x[d], 0.0, 0.0);
        taken -= impulse * (vp[d] + 0.5 * mobility * impulse);
    }
    assert_close(o.event.energy, taken, 1e-12);
    assert_close(o.event.weight, share, 1e-12);
    assert_close(o.event.t, drop_time, 1e-12);
    assert_int_equal(o.event.node, 0);
    assert_int_equal(o.event.other, 1);
    assert_int_equal(o.event.segment, 0);
}

TEST(an_edge_on_an_apex_gets_the_impulse_of_its_weights)
{
    for (int k = 0; k <= 4; k++)
        for (int spring = 0; spring < 2; spring++) {
            const double eta = 0.25 * k;
            check_fall(&(fall){0.0, {0.0, -1.0}, {0.0, -1.0}, eta, 0.0, DEM_FRICTION_COULOMB, spring});
            check_fall(&(fall){0.4, {0.3, -1.0}, {0.3, -1.0}, eta, 0.0, DEM_FRICTION_COULOMB, spring});
        }
}

/* An edge that turns as it falls, by at most 0.02 rad on the way: without a spring both nodes fly straight. */
TEST(a_turning_edge_on_an_apex_gets_the_impulse_of_its_point)
{
    for (int k = 0; k <= 4; k++) {
        check_fall(&(fall){0.0, {0.0, -2.0}, {0.0, -0.5}, 0.25 * k, 0.0, DEM_FRICTION_COULOMB, false});
        check_fall(&(fall){-0.3, {0.2, -0.7}, {-0.4, -1.5}, 0.25 * k, 0.3, DEM_FRICTION_COULOMB, false});
    }
}

TEST(friction_of_an_edge_on_an_apex_is_capped_by_coulomb)
{
    for (int k = 0; k <= 10; k++)
        for (int side = -1; side <= 1; side += 2) {
            const double mu = 0.1 * k, u = 0.9 * side;
            check_fall(&(fall){0.0, {u, -1.0}, {u, -1.0}, 0.0, mu, DEM_FRICTION_COULOMB, false});
            check_fall(&(fall){0.2, {u, -1.0}, {u, -1.0}, 0.5, mu, DEM_FRICTION_COULOMB, true});
            check_fall(&(fall){-0.2, {u, -1.0}, {u, -1.0}, 1.0, mu, DEM_FRICTION_COULOMB, false});
        }
}

TEST(friction_of_an_edge_on_an_apex_follows_the_papers_law)
{
    for (int k = 0; k <= 4; k++)
        check_fall(&(fall){0.1, {0.8, -1.0}, {0.8, -1.0}, 0.5, 0.25 * k, DEM_FRICTION_PAPER, true});
}

/* ---- a block on a wedge ---- */

static const double spacing = 5e-3, speed = 3.0;

typedef struct wedge {
    double flank, at, restitution, friction, rtol;
    int cells; /* of the lower face */
    int32_t vertices;
} wedge;

typedef struct watch {
    outline body;
    double slope, at;
    double deepest_apex, deepest_node; /* m, of the apex in the body, of a node in the wedge */
    double impulse[2], least_energy, worst_balance, start[2];
    dem_index lasting;
} watch;

static dem_status look(void *context, const dem_simulation *simulation)
{
    watch *w = context;
    const dem_lattice *l = dem_model_lattice(dem_simulation_model(simulation));
    const double tip[2] = {w->at, 0.0};
    motion state;
    motion_see(simulation, &state);
    w->deepest_apex = fmax(w->deepest_apex, outline_depth(&w->body, state.x, tip));
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const double below = -w->slope * fabs(state.x[2 * i] - w->at) - state.x[2 * i + 1];
        w->deepest_node = fmax(w->deepest_node, below / hypot(1.0, w->slope));
    }
    return DEM_OK;
}

/* Momentum less what the obstacle and weight have given, over the initial one. */
static double imbalance(const watch *w, const dem_simulation *simulation, const double impulse[2])
{
    motion state;
    motion_see(simulation, &state);
    const dem_body_motion m = ask_body(simulation, 0);
    const double scale = hypot(w->start[0], w->start[1]);
    return hypot(m.mass * m.velocity[0] - w->start[0] - impulse[0],
                 m.mass * m.velocity[1] - w->start[1] + m.mass * 9.81 * state.t - impulse[1]) /
           scale;
}

static dem_status look_and_weigh(void *context, const dem_simulation *simulation)
{
    watch *w = context;
    const dem_obstacle_load load = ask_obstacle(simulation, 0);
    w->worst_balance = fmax(w->worst_balance, imbalance(w, simulation, load.impulse));
    return look(context, simulation);
}

static dem_status add_event(void *context, const dem_simulation *simulation, const dem_event *event)
{
    watch *w = context;
    (void)simulation;
    w->lasting += event->state != DEM_CONTACT_FREE;
    for (int d = 0; d < 2; d++) w->impulse[d] += event->impulse[d];
    if (event->other >= 0)
        assert_close(event->weight, 0.5, 0.5 + 1e-4); /* on the edge, but for penetration tolerances */
    if (event->kind == DEM_EVENT_IMPACT) w->least_energy = fmin(w->least_energy, event->energy);
    return DEM_OK;
}

static const double frame_interval = 2e-6, block_height = 0.03, start_gap = 1e-6;

static void make_block(const wedge *c, dem_lattice *lattice)
{
    const dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0,
                                      .density = 1050.0, .thickness = 1.0, .guard = 0.02);
    const double up[2] = {0.0, start_gap}, down[2] = {0.0, -speed};
    assert_ok(dem_lattice_rectangle(lattice, c->cells * spacing, block_height, spacing));
    assert_ok(dem_lattice_assemble(lattice, &rubber));
    dem_lattice_move(lattice, 0.0, up);
    assert_ok(dem_lattice_launch(lattice, down));
}

/* Largest difference between the motion and its mirror image, m. */
static double asymmetry(const dem_lattice *l, const double *x)
{
    double worst = 0.0;
    for (dem_index i = 0; i < l->n_nodes; i++)
        for (dem_index j = 0; j < l->n_nodes; j++)
            if (fabs(l->x[2 * i] + l->x[2 * j]) < 1e-6 && fabs(l->x[2 * i + 1] - l->x[2 * j + 1]) < 1e-6)
                worst = fmax(worst, hypot(x[2 * i] + x[2 * j], x[2 * i + 1] - x[2 * j + 1]));
    return worst;
}

typedef struct verdict {
    double apex, node, balance, reported, skew, closure, rebound;
    double tilt; /* of the first impact's normal from the vertical */
    dem_index lasting;
    dem_counts counts;
} verdict;

static verdict run_wedge(const wedge *c, double t_end)
{
    const double tall = tan(c->flank * M_PI / 180.0);
    const double points[6] = {c->at - 0.2, -0.2 * tall, c->at, 0.0, c->at + 0.2, -0.2 * tall};
    const dem_obstacle obstacle = SIZED(dem_obstacle, .n_points = 3, .points = points, .restitution = c->restitution,
                                        .friction = c->friction, .friction_law = DEM_FRICTION_COULOMB);
    dem_options options = support_options();
    dem_lattice lattice = dem_lattice_empty();
    support_run run;
    options.rtol = c->rtol;
    options.vertices = c->vertices;
    make_block(c, &lattice);
    support_open(&run, &lattice, &obstacle, 1, &options);
    watch w = {.body = outline_create(&lattice), .slope = tall, .at = c->at};
    dem_lattice_free(&lattice);
    const dem_observer observer = SIZED(dem_observer, .interval = frame_interval, .frame = look, .step = look_and_weigh,
                                        .event = add_event, .context = &w);
    const dem_body_motion start = ask_body(run.simulation, 0);
    for (int d = 0; d < 2; d++) w.start[d] = start.mass * start.velocity[d];
    assert_ok(dem_simulation_observe(run.simulation, &observer));
    const double before = ask_energy(run.simulation).ledger;
    const double kinetic = ask_energy(run.simulation).kinetic;
    motion state = support_at(&run, t_end);
    const double penetration_tolerance = ask_options(run.simulation).penetration_tolerance;
    const verdict v = {.apex = w.deepest_apex / penetration_tolerance,
                       .node = w.deepest_node / penetration_tolerance,
                       .balance = w.worst_balance,
                       .reported = imbalance(&w, run.simulation, w.impulse),
                       .skew = asymmetry(dem_model_lattice(run.model), state.x) / spacing,
                       .closure = fabs(state.energy.ledger - before) / kinetic,
                       .rebound = ask_body(run.simulation, 0).velocity[1],
                       .tilt = fabs(run.impacts[0].normal[0]),
                       .lasting = w.lasting,
                       .counts = ask_counts(run.simulation)};
    assert_true(w.least_energy >= -1e-15 * kinetic); /* rounding */
    outline_free(&w.body);
    support_close(&run);
    print_message("# flank %g, at %g, eta %g, mu %g, rtol %g, %d cells: apex %.3g node %.3g penetration tolerances, "
                  "balance %.1e, reported %.1e, "
                  "skew %.1e, closure %.1e, rebound %.3f, %lld impacts (%lld of vertices), %lld passings, %lld late, "
                  "%lld lasting\n",
                  c->flank, c->at / spacing, c->restitution, c->friction, c->rtol, c->cells, v.apex, v.node, v.balance,
                  v.reported, v.skew, v.closure, v.rebound, (long long)v.counts.impacts,
                  (long long)v.counts.vertex_impacts, (long long)v.counts.passings, (long long)v.counts.late,
                  (long long)v.lasting);
    return v;
}

/* Node and apex at most twice the penetration tolerance deep. Momentum: rounding of a hundred restarts is 1e-12 at
 * most, and every further hundred add as much. The ledger: row d's 1e-6 at rtol 1e-9, and proportional to rtol. */
static verdict check_wedge(const wedge *c, double t_end)
{
    const verdict v = run_wedge(c, t_end);
    const double rounding = 1e-12 * (1.0 + 0.01 * (double)v.counts.events);
    assert_true(v.apex < 2.0 && v.node < 2.0);
    assert_true(v.balance < rounding);
    if (v.lasting == 0) assert_true(v.reported < rounding);
    assert_true(v.closure < 1e3 * c->rtol);
    assert_true(v.counts.vertex_impacts >= 1);
    return v;
}

static const double flanks[3] = {30.0, 60.0, 80.0}, landing = 4e-3;

/* Mirror symmetry holds to rounding as long as the apex stays on the middle edge: one contact, and nothing to its
 * right is done before its left. */
TEST(an_apex_midway_between_two_nodes_never_sinks_in)
{
    for (int k = 0; k < 3; k++)
        for (int e = 0; e <= 2; e++) {
            const verdict v = check_wedge(&(wedge){flanks[k], 0.0, 0.5 * e, 0.0, 1e-6, 9, 1}, landing);
            assert_true(v.skew < 1e-12);
            assert_true(v.rebound > 0.85 * speed); /* not impaled, as nodes alone are at 80 degrees: 0.22 */
        }
}

TEST(the_ledger_on_an_apex_closes_better_as_rtol_falls)
{
    for (int e = 0; e <= 2; e++) {
        const verdict loose = check_wedge(&(wedge){60.0, 0.0, 0.5 * e, 0.0, 1e-6, 9, 1}, landing);
        const verdict tight = check_wedge(&(wedge){60.0, 0.0, 0.5 * e, 0.0, 1e-8, 9, 1}, landing);
        assert_true(tight.closure < 0.1 * loose.closure); /* row i asks for 30 of 100 in the error of a smooth motion */
        assert_true(loose.counts.impacts < 100 && tight.counts.impacts < 100);
    }
}

/* Along the edge, and at 0.5 exactly under a node; the longer runs go over all of it. */
TEST(an_apex_anywhere_under_the_face_never_sinks_in)
{
    for (int k = 0; k <= (everything ? 40 : 5); k++)
        for (int f = 0; f < (everything ? 3 : 1); f++)
            for (int e = 0; e <= 2; e++) {
                const double at = (everything ? 0.05 : 0.1) * k * spacing, mu = 0.3 * (k % 3);
                (void)check_wedge(&(wedge){everything ? flanks[f] : 80.0, at, 0.5 * e, mu, 1e-6, 9, 1}, landing);
            }
}

/* The apex hits the middle node: what a perfect symmetry leaves open is decided by the order of candidates, so there is
 * no mirror image to compare with. The face lies on the apex, not the node on a flank: the first normal is upright. */
TEST(an_apex_exactly_under_the_middle_node_never_sinks_in)
{
    for (int k = 0; k < 3; k++)
        for (int e = 0; e <= 2; e++) (void)check_wedge(&(wedge){flanks[k], 0.0, 0.5 * e, 0.0, 1e-6, 10, 1}, landing);
}

/* With nodes alone the wedge is deep in the body before a node touches it, which the polygon test notices. */
TEST(without_vertices_the_apex_is_seen_to_sink_in)
{
    assert_true(run_wedge(&(wedge){30.0, 0.0, 0.0, 0.0, 1e-6, 9, 0}, landing).apex > 0.1e6);
    assert_true(run_wedge(&(wedge){80.0, 0.0, 0.0, 0.0, 1e-6, 9, 0}, landing).apex > 0.5e6);
}

int main(int argc, char **argv)
{
    everything = argc > 1 && argv[1][0] != '\0';
    return test_run();
}
