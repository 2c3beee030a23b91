/* SPDX-License-Identifier: BSD-3-Clause */
/* Soft blocks whose faces lie on apexes of an obstacle: at rest, sliding over them, and falling off one. */
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "outline.h"
#include "harness/motion.h"
#include "support.h"

static const double g = 9.81, spacing = 5e-3;

static void make_block(dem_lattice *lattice, int cells, double youngs_modulus, double damping_time)
{
    const dem_material soft = SIZED(dem_material, .youngs_modulus = youngs_modulus, .poissons_ratio = 1.0 / 3.0,
                                    .density = 1050.0, .thickness = 1.0, .damping_time = damping_time);
    assert_ok(dem_lattice_rectangle(lattice, cells * spacing, 0.02, spacing));
    assert_ok(dem_lattice_assemble(lattice, &soft));
}

/* ---- at rest ---- */

/* Two apexes, with a valley between them. */
typedef struct rack {
    double points[10], friction;
    int cells;
    double youngs_modulus, damping_time; /* of the block */
} rack;

static rack make_rack(double x1, double y1, double x2, double y2, double friction, int cells)
{
    const double middle = 0.5 * (x1 + x2), down = -0.8 * (x2 - x1);
    return (rack){{x1 - 0.1, y1 - 0.1, x1, y1, middle, down, x2, y2, x2 + 0.1, y2 - 0.1}, friction, cells, 3e4, 0.0};
}

/* On both apexes, straight. */
static void lay(const rack *r, dem_lattice *lattice)
{
    const double *a = &r->points[2], *b = &r->points[6];
    const double angle = atan2(b[1] - a[1], b[0] - a[0]), up[2] = {0.0, a[1] - a[0] * tan(angle)};
    make_block(lattice, r->cells, r->youngs_modulus, r->damping_time);
    dem_lattice_move(lattice, angle, up);
}

static void open_block(support_run *run, const dem_lattice *lattice, const rack *r, double damping)
{
    const dem_obstacle obstacle = SIZED(dem_obstacle, .n_points = 5, .points = r->points, .restitution = 0.0,
                                        .friction = r->friction, .friction_law = DEM_FRICTION_COULOMB);
    dem_options options = support_options();
    options.penetration_tolerance = 1e-12;
    options.rtol = 1e-9;
    options.mass_damping = damping;
    support_open(run, lattice, &obstacle, 1, &options);
}

/* The lattice starts at rest where damping brings it. */
static void settle(const rack *r, dem_lattice *lattice, double duration)
{
    CLEANUP(support_close) support_run run;
    lay(r, lattice);
    open_block(&run, lattice, r, 300.0);
    const motion state = support_at(&run, duration); /* exp(-150 duration) is left of what vibrates slowly */
    free(lattice->position);
    lattice->position = NULL;
    support_start(lattice, state.x, NULL);
}

/* Forces sum to the weight and their moments about the centre of mass to nothing, over the weight. */
static double unbalance(const dem_simulation *simulation, const motion *state)
{
    const dem_body_motion m = ask_body(simulation, 0);
    double sum[2] = {0.0, -m.mass * g}, moment = 0.0;
    for (dem_index k = 0; k < state->n_contacts; k++) {
        const dem_contact *c = &state->contacts[k];
        const double n[2] = {c->normal[0], c->normal[1]}, t[2] = {n[1], -n[0]};
        const double f[2] = {c->force * n[0] + c->friction[0] * t[0], c->force * n[1] + c->friction[0] * t[1]};
        sum[0] += f[0];
        sum[1] += f[1];
        moment += (c->x[0] - m.centre[0]) * f[1] - (c->x[1] - m.centre[1]) * f[0];
    }
    return fmax(hypot(sum[0], sum[1]), fabs(moment) / spacing) / (m.mass * g);
}

static void check_rest(const rack *r)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    CLEANUP(support_close) support_run run;
    double creep = 0.0, worst = 0.0;
    settle(r, &lattice, 0.5);
    open_block(&run, &lattice, r, 0.0);
    for (int k = 0; k <= 20; k++) {
        const motion state = support_at(&run, 0.05 * k);
        assert_int_equal(state.n_contacts, 2);
        for (dem_index c = 0; c < 2; c++) {
            assert_int_equal(state.contacts[c].n_nodes, 2);
            assert_int_equal(state.contacts[c].state, r->friction > 0.0 ? DEM_CONTACT_STICK : DEM_CONTACT_SLIP);
        }
        for (dem_index i = 0; i < 2 * lattice.n_nodes; i++) creep = fmax(creep, fabs(state.x[i] - lattice.position[i]));
        worst = fmax(worst, unbalance(run.simulation, &state));
    }
    const dem_counts counts = ask_counts(run.simulation);
    print_message("# mu %g: creep %.1e m, unbalance %.1e, %lld steps, %lld events, %lld impacts\n", r->friction, creep,
                  worst, (long long)counts.steps, (long long)counts.events, (long long)counts.impacts);
    assert_true(creep < (r->friction > 0.0 ? 1e-14 : 1e-11)); /* rounding; 1e-12 g over 1 s where nothing holds it */
    assert_true(worst < 1e-9);                                /* rounding of positions in stiff springs: 1e-11 */
}

TEST(a_block_rests_on_two_apexes_without_friction)
{
    const rack wide = make_rack(-0.0113, 0.0, 0.0113, 0.0, 0.0, 8),
               narrow = make_rack(-0.0013, 0.0, 0.0013, 0.0, 0.0, 7);
    check_rest(&wide);
    check_rest(&narrow);
}

TEST(a_block_rests_on_two_apexes_with_friction)
{
    const rack level = make_rack(-0.0113, 0.0, 0.0071, 0.0, 0.5, 8),
               tilted = make_rack(-0.0113, 0.001, 0.0087, -0.003, 0.5, 8);
    const rack narrow = make_rack(-0.0013, 0.0, 0.0013, 0.0, 0.5, 7);
    check_rest(&level);
    check_rest(&tilted);
    check_rest(&narrow);
}

/* ---- sliding ---- */

enum { most_apexes = 2 };

/* One vertex that passes a node of the face. */
typedef struct passage {
    bool under_way;
    dem_index node, from, to; /* node passed; edges end in from and to */
    double force, bound;      /* N: the normal force before, how much it may change */
    double kick;              /* m/s: approach that the bend makes of the speed along the edge */
} passage;

typedef struct slide {
    double momentum, mu, ledger;
    double worst_ledger, worst_balance, worst_cap; /* J; of m v0; of N */
    double worst_jump, worst_kick;                 /* over what the bend justifies */
    passage at[most_apexes];
    dem_index passes[most_apexes], others; /* events that are not of a passage */
} slide;

static dem_index other_side(const dem_lattice *l, dem_index node, dem_index than)
{
    for (dem_index j = 0; j < l->n_nodes; j++) /* the lower face is the first row */
        if (j != node && j != than && fabs(l->x[2 * j + 1] - l->x[2 * node + 1]) < 1e-9 &&
            fabs(fabs(l->x[2 * j] - l->x[2 * node]) - spacing) < 1e-9)
            return j;
    return -1;
}

/* Turning rate of the line from p to q. */
static double turning(const motion *s, dem_index p, dem_index q)
{
    const double w[2] = {s->x[2 * q] - s->x[2 * p], s->x[2 * q + 1] - s->x[2 * p + 1]};
    const double u[2] = {s->v[2 * q] - s->v[2 * p], s->v[2 * q + 1] - s->v[2 * p + 1]};
    return (w[0] * u[1] - w[1] * u[0]) / (w[0] * w[0] + w[1] * w[1]);
}

/* At the node the force on it is the same before and after, but its part along the normal is not if the edge bends by
 * `angle`; with the edge the term 2 omega v_t changes, and with the velocity the damping of the node's springs. */
static passage begin_passage(const dem_simulation *simulation, const dem_event *e)
{
    const dem_lattice *l = dem_model_lattice(dem_simulation_model(simulation));
    motion s;
    motion_see(simulation, &s);
    const dem_index node = e->weight > 0.5 ? e->other : e->node, from = e->weight > 0.5 ? e->node : e->other;
    passage p = {.under_way = true, .node = node, .from = from, .to = other_side(l, node, from)};
    const double a[2] = {s.x[2 * node] - s.x[2 * p.from], s.x[2 * node + 1] - s.x[2 * p.from + 1]};
    const double b[2] = {s.x[2 * p.to] - s.x[2 * node], s.x[2 * p.to + 1] - s.x[2 * node + 1]};
    const double angle = fabs(atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]));
    const double along = hypot(e->before[0], e->before[1]);
    for (dem_index k = 0; k < s.n_contacts; k++)
        if (s.contacts[k].segment == e->segment) {
            p.force = s.contacts[k].force;
            p.bound = angle * 2.0 * hypot(p.force, s.contacts[k].friction[0]);
        }
    p.bound += 2.0 * l->mass[node] * along * (fabs(turning(&s, p.from, node)) + fabs(turning(&s, node, p.to)));
    p.kick = along * sin(angle);
    for (dem_index k = 0; k < l->n_springs; k++)
        if (l->ends[2 * k] == node || l->ends[2 * k + 1] == node)
            p.bound += p.kick * l->viscosity[k] / l->rest_length[k];
    return p;
}

static dem_status follow_passages(void *context, const dem_simulation *simulation, const dem_event *e)
{
    slide *w = context;
    passage *p = &w->at[e->segment / 2];
    if (e->kind == DEM_EVENT_PASS) {
        w->passes[e->segment / 2]++;
        *p = begin_passage(simulation, e);
        return DEM_OK;
    }
    if (!p->under_way) w->others++;
    if (p->under_way && e->kind == DEM_EVENT_IMPACT) {
        const double approach = -(e->before[0] * e->normal[0] + e->before[1] * e->normal[1]);
        w->worst_kick = fmax(w->worst_kick, approach / p->kick);
    }
    return DEM_OK;
}

static dem_status watch_slide(void *context, const dem_simulation *simulation)
{
    slide *w = context;
    motion s;
    motion_see(simulation, &s);
    const dem_body_motion m = ask_body(simulation, 0);
    const dem_obstacle_load load = ask_obstacle(simulation, 0);
    const double px = m.mass * m.velocity[0] - w->momentum - load.impulse[0];
    const double py = m.mass * (m.velocity[1] + g * s.t) - load.impulse[1];
    w->worst_balance = fmax(w->worst_balance, hypot(px, py) / w->momentum);
    w->worst_ledger = fmax(w->worst_ledger, fabs(s.energy.ledger - w->ledger));
    for (dem_index k = 0; k < s.n_contacts; k++) {
        const dem_contact *c = &s.contacts[k];
        passage *p = &w->at[c->segment / 2];
        const double limit = w->mu * c->force;
        if (c->state == DEM_CONTACT_SLIP)
            w->worst_cap = fmax(w->worst_cap, fabs(fabs(c->friction[0]) - limit) / fmax(limit, 1e-300));
        if (p->under_way) {
            w->worst_jump = fmax(w->worst_jump, fabs(c->force - p->force) / p->bound);
        }
        p->under_way = false;
    }
    return DEM_OK;
}

/* Settled on the rack where it starts, then launched. */
static void open_slide(support_run *run, slide *w, double friction, double speed)
{
    const double start = -0.012, v0[2] = {speed, 0.0};
    rack r = make_rack(-0.0303, 0.0, 0.0291, 0.0, friction, 20);
    r.youngs_modulus = 1e6;
    r.damping_time = 5e-5;
    rack shifted = r;
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    for (int k = 0; k < 10; k += 2) shifted.points[k] -= start;
    settle(&shifted, &lattice, 0.1);
    for (dem_index i = 0; i < lattice.n_nodes; i++) lattice.position[2 * i] += start;
    assert_ok(dem_lattice_launch(&lattice, v0));
    open_block(run, &lattice, &r, 0.0);
    *w = (slide){
        .momentum = dem_model_mass(run->model) * speed, .mu = friction, .ledger = ask_energy(run->simulation).ledger};
    const dem_observer observer = SIZED(dem_observer, .step = watch_slide, .event = follow_passages, .context = w);
    assert_ok(dem_simulation_observe(run->simulation, &observer));
}

TEST(a_block_slides_with_friction_over_apexes_past_its_nodes)
{
    CLEANUP(support_close) support_run run;
    slide w;
    open_slide(&run, &w, 0.2, 0.3);
    const double kinetic = ask_energy(run.simulation).kinetic;
    const double from = ask_body(run.simulation, 0).centre[0];
    (void)support_at(&run, 0.14);
    const dem_body_motion m = ask_body(run.simulation, 0);
    print_message("# slid %.5f m, v %.2e, passes %lld and %lld, %lld other events, jump %.2f, kick %.2f, balance %.1e, "
                  "ledger %.1e, cap %.1e\n",
                  m.centre[0] - from, m.velocity[0], (long long)w.passes[0], (long long)w.passes[1],
                  (long long)w.others, w.worst_jump, w.worst_kick, w.worst_balance, w.worst_ledger / kinetic,
                  w.worst_cap);
    assert_true(w.passes[0] >= 3 && w.passes[1] >= 3);
    assert_int_equal(w.others, 2); /* at the start the dents in the face are hit, and no release or impact after */
    assert_true(w.worst_kick < 1.0 + 1e-3); /* and the penetration tolerance */
    assert_true(w.worst_jump < 1.0);
    assert_true(w.worst_cap < 1e-14);
    assert_true(w.worst_ledger < 1e-6 * kinetic); /* rtol 1e-9: row d's */
    assert_true(w.worst_balance < 1e-9);          /* lasting contacts: to the integrator's tolerance */
}

/* ---- off the end of an edge ---- */

typedef struct drop {
    outline body;
    double slope, deepest_apex, deepest_node; /* m */
    dem_index corner, n;
    dem_event events[16];
} drop;

static const double steep = 1.7; /* slope of the flank on the left */

static dem_status look_at_drop(void *context, const dem_simulation *simulation)
{
    drop *w = context;
    const double origin[2] = {0.0, 0.0};
    motion s;
    motion_see(simulation, &s);
    w->deepest_apex = fmax(w->deepest_apex, outline_depth(&w->body, s.x, origin));
    for (dem_index i = 0; i < dem_model_lattice(dem_simulation_model(simulation))->n_nodes; i++) {
        const double x = s.x[2 * i], y = s.x[2 * i + 1], slope = x < 0.0 ? steep : w->slope;
        w->deepest_node = fmax(w->deepest_node, -(y + slope * fabs(x)) / hypot(1.0, slope));
    }
    return DEM_OK;
}

static dem_status note_drop(void *context, const dem_simulation *simulation, const dem_event *event)
{
    drop *w = context;
    (void)simulation;
    if (w->n < 16) w->events[w->n++] = *event;
    return DEM_OK;
}

static void open_drop(support_run *run, drop *w, double slope, double friction, double speed)
{
    const double points[6] = {-0.1, -0.1 * steep, 0.0, 0.0, 0.5, -0.5 * slope}, v[2] = {speed, 0.0};
    const double offset[2] = {0.5 * 8 * spacing - 0.004, 0.0};
    const dem_obstacle obstacle = SIZED(dem_obstacle, .n_points = 3, .points = points, .restitution = 0.0,
                                        .friction = friction, .friction_law = DEM_FRICTION_COULOMB);
    dem_options options = support_options();
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    options.rtol = 1e-9;
    make_block(&lattice, 8, 1e6, 0.0);
    dem_lattice_move(&lattice, 0.0, offset);
    assert_ok(dem_lattice_launch(&lattice, v));
    support_open(run, &lattice, &obstacle, 1, &options);
    *w = (drop){.body = outline_create(&lattice), .slope = slope};
    for (dem_index i = 0; i < lattice.n_nodes; i++)
        if (lattice.x[2 * i] + lattice.x[2 * i + 1] < lattice.x[2 * w->corner] + lattice.x[2 * w->corner + 1])
            w->corner = i;
    const dem_observer observer = SIZED(dem_observer, .interval = 1e-6, .frame = look_at_drop, .step = look_at_drop,
                                        .event = note_drop, .context = w);
    assert_ok(dem_simulation_observe(run->simulation, &observer));
}

/* The face slides off the apex at its corner; then nothing touches until the corner comes down on the flank. */
static void check_drop(double slope, double friction, double speed)
{
    CLEANUP(support_close) support_run run;
    drop w;
    open_drop(&run, &w, slope, friction, speed);
    (void)support_at(&run, 0.08);
    const double penetration_tolerance = ask_options(run.simulation).penetration_tolerance;
    dem_index k = 0;
    print_message("# slope %g, mu %g, %g m/s: apex %.2g and node %.2g penetration tolerances deep\n", slope, friction,
                  speed, w.deepest_apex / penetration_tolerance, w.deepest_node / penetration_tolerance);
    while (k < w.n && w.events[k].kind != DEM_EVENT_PASS) k++;
    assert_true(k + 2 < w.n);
    assert_int_equal(w.events[k].node, w.corner);
    assert_close(w.events[k].weight, 0.0, 1e-5); /* a penetration tolerance beyond the end: 1e-6 */
    assert_int_equal(w.events[k + 1].kind, DEM_EVENT_RELEASE);
    assert_int_equal(w.events[k + 2].kind, DEM_EVENT_IMPACT);
    assert_int_equal(w.events[k + 2].node, w.corner);
    assert_int_equal(w.events[k + 2].other, -1);
    assert_int_equal(w.events[k + 2].segment, 1);
    assert_true(w.events[k + 2].t > w.events[k].t + 1e-4);
    assert_true(w.deepest_apex < 2.0 * penetration_tolerance && w.deepest_node < 2.0 * penetration_tolerance);
    outline_free(&w.body);
}

TEST(a_body_that_slides_off_an_apex_falls_on_the_flank_with_its_corner)
{
    check_drop(0.3, 0.0, 0.3);
    check_drop(0.3, 0.3, 0.5);
    check_drop(1.0, 0.0, 0.2);
}
