/* SPDX-License-Identifier: BSD-3-Clause */
/* A point mass on an incline of 30 degrees (rows f1 and f2), and oblique impacts (row f3), against closed forms, with
 * the ledger: friction takes mu N times the way, an obstacle's impulse is what momentum asks for. Where no reason is
 * given the tolerance is the table's. */
#include <stdbool.h>

#include "harness/motion.h"
#include "support.h"

enum { most_events = 4096 };

static const double g = 9.81, mass = 2.0, sine = 0.5;

/* What an observer follows; the tangent points down the incline. */
typedef struct slide {
    support_run run;
    double normal[2], tangent[2];
    double mu, v0[2], last;     /* last: m, place along the incline at the last step */
    double sliding;             /* m, way in lasting contacts till then */
    double balance, work;       /* worst of m (v - v0) - m g t - impulse, N s, and of friction energy - mu N way, J */
    double ledger, drift, turn; /* J: at the start, worst of it less that; N s, normal part of the friction impulse */
    bool lasted;                /* a contact lasted at the last step */
    int n_events;
    dem_event events[most_events];
} slide;

static double dot(const double a[2], const double b[2])
{
    return a[0] * b[0] + a[1] * b[1];
}

/* The ledger in a state that is seen, `way` after the last step along the incline. */
static void look(slide *s, const dem_simulation *simulation, const motion *state, double way)
{
    const dem_obstacle_load load = ask_obstacle(simulation, 0);
    const dem_options options = ask_options(simulation);
    const double *gravity = options.gravity, pressure = -mass * dot(gravity, s->normal);
    for (int d = 0; d < 2; d++)
        s->balance = fmax(s->balance, fabs(mass * (state->v[d] - s->v0[d] - gravity[d] * state->t) - load.impulse[d]));
    if (!s->lasted) way = 0.0;
    s->work = fmax(s->work, fabs(state->energy.friction - s->mu * pressure * (s->sliding + way)));
    s->turn = fmax(s->turn, fabs(dot(load.friction_impulse, s->normal)));
    s->turn = fmax(s->turn, fabs(dot(load.friction_impulse, s->tangent) - dot(load.impulse, s->tangent)));
    s->drift = fmax(s->drift, fabs(state->energy.ledger - s->ledger));
}

static dem_status note_step(void *context, const dem_simulation *simulation)
{
    slide *s = context;
    motion state;
    motion_see(simulation, &state);
    if (state.t == 0.0) s->ledger = state.energy.ledger;
    const double place = dot(state.x, s->tangent), step = fabs(place - s->last);
    look(s, simulation, &state, step);
    if (s->lasted) s->sliding += step;
    s->last = place;
    s->lasted = state.n_contacts > 0;
    return DEM_OK;
}

static dem_status note_event(void *context, const dem_simulation *simulation, const dem_event *event)
{
    slide *s = context;
    if (s->n_events < most_events) s->events[s->n_events] = *event;
    s->n_events++;
    return note_step(context, simulation);
}

static motion slide_at(slide *s, double t)
{
    const motion state = support_at(&s->run, t);
    look(s, s->run.simulation, &state, fabs(dot(state.x, s->tangent) - s->last));
    return state;
}

/* From height h0 over a straight obstacle with normal (sin a, cos a), v0 = (along, across); `points` 20 m each way. */
static void open_slide(slide *s, double a, const dem_obstacle *law, double h0, const double v0[2], double gravity)
{
    *s = (slide){.normal = {sin(a), cos(a)}, .tangent = {cos(a), -sin(a)}, .mu = law->friction};
    const double *n = s->normal, *t = s->tangent, points[4] = {-20.0 * t[0], -20.0 * t[1], 20.0 * t[0], 20.0 * t[1]};
    const double x[2] = {h0 * n[0], h0 * n[1]};
    const dem_observer observer = SIZED(dem_observer, .step = note_step, .event = note_event, .context = s);
    dem_obstacle obstacle = *law;
    dem_options options = support_options();
    for (int d = 0; d < 2; d++) s->v0[d] = v0[0] * t[d] + v0[1] * n[d];
    obstacle.n_points = 2;
    obstacle.points = points;
    options.gravity[1] = -gravity;
    options.spacing = options.v_scale = 1.0;
    options.max_step = 0.01;
    options.rtol = 1e-12;
    options.penetration_tolerance = 1e-13;
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(1, x, &mass, 0, NULL, 0.0, 0.0, NULL);
    support_start(&lattice, NULL, s->v0);
    support_open(&s->run, &lattice, &obstacle, 1, &options);
    assert_ok(dem_simulation_observe(s->run.simulation, &observer));
}

/* On the incline of 30 degrees; eta = 0 */
static void open_incline(slide *s, double mu, double v0)
{
    const double v[2] = {v0, 0.0};
    open_slide(s, M_PI / 6.0, &(dem_obstacle){.struct_size = sizeof(dem_obstacle), .friction = mu}, 0.0, v, g);
}

static double acceleration(double mu)
{
    return g * (sine - mu * cos(M_PI / 6.0));
}

/* Sums over at most 1000 steps of quantities of order 100, each with a rounding error of 1e-16 of that. */
static void check_ledger(const slide *s)
{
    assert_close(s->balance, 0.0, 1e-11);
    assert_close(s->work, 0.0, 1e-11);
    assert_close(s->turn, 0.0, 1e-11);
}

static void check_place(slide *s, double t, double way, double speed, double tolerance)
{
    const motion state = slide_at(s, t);
    assert_close(dot(state.x, s->tangent), way, tolerance);
    assert_close(dot(state.v, s->tangent), speed, tolerance);
    assert_close(dot(state.x, s->normal), 0.0, 1e-12);
    assert_close(dot(state.v, s->normal), 0.0, 1e-12);
}

TEST(a_block_above_the_friction_angle_slides_down_from_rest_with_the_exact_acceleration)
{
    static const double mu[3] = {0.0, 0.2, 0.577}; /* tan 30 = 0.57735 */
    static slide s;
    for (int k = 0; k < 3; k++) {
        const double a = acceleration(mu[k]);
        open_incline(&s, mu[k], 0.0);
        for (double t = 0.25; t < 1.9; t += 0.25) check_place(&s, t, 0.5 * a * t * t, a * t, 1e-11);
        const motion state = slide_at(&s, 2.0);
        assert_int_equal(state.n_contacts, 1);
        assert_int_equal(state.contacts[0].state, DEM_CONTACT_SLIP);
        assert_close(state.contacts[0].force, mass * g * cos(M_PI / 6.0), 1e-12);
        assert_close(state.contacts[0].friction[0], -mu[k] * mass * g * cos(M_PI / 6.0), 1e-12);
        check_ledger(&s);
        assert_close(s.drift, 0.0, 1e-10); /* rtol times the energies, 50 J */
        support_close(&s.run);
    }
    open_incline(&s, 0.2, 0.0);
    check_place(&s, 1.5, 3.6065904274967973, 4.808787236662397, 1e-8);
    support_close(&s.run);
}

TEST(a_block_below_the_friction_angle_sticks_from_the_start)
{
    static const double mu[2] = {0.7, 0.5774}; /* tan 30 = 0.57735 */
    static slide s;
    for (int k = 0; k < 2; k++) {
        open_incline(&s, mu[k], 0.0);
        motion state = slide_at(&s, 0.0);
        const double x = state.x[0], y = state.x[1];
        assert_close(hypot(x, y), 0.0, 1e-14); /* the surface through points 20 m away */
        state = slide_at(&s, 10.0);
        assert_close(state.x[0], x, 0.0);
        assert_close(state.x[1], y, 0.0);
        assert_int_equal(state.n_contacts, 1);
        assert_int_equal(state.contacts[0].state, DEM_CONTACT_STICK);
        assert_close(state.contacts[0].force, mass * g * cos(M_PI / 6.0), 1e-12);
        assert_close(state.contacts[0].friction[0], -mass * g * sine, 1e-12);
        assert_int_equal(ask_counts(s.run.simulation).slips, 0);
        assert_close(state.energy.friction, 0.0, 0.0);
        check_ledger(&s);
        support_close(&s.run);
    }
}

TEST(a_sliding_block_stops_after_the_exact_way_and_sticks_for_ever)
{
    static slide s;
    open_incline(&s, 0.7, 3.0);
    check_place(&s, 1.5, 3.327753996238792, 1.437005328318389, 1e-8);
    check_place(&s, 3.0, 4.318632764587572, 0.0, 1e-8);
    assert_true(s.n_events >= 1);
    const dem_event last = s.events[s.n_events - 1];
    const int n_events = s.n_events;
    assert_int_equal(last.kind, DEM_EVENT_STICK);
    assert_int_equal(last.state, DEM_CONTACT_STICK);
    assert_close(last.t, 2.8790885097250483, 1e-8);
    const motion at_stop = slide_at(&s, 3.0);
    const double x = at_stop.x[0], y = at_stop.x[1];
    const motion state = slide_at(&s, 60.0);
    assert_close(state.x[0], x, 0.0);
    assert_close(state.x[1], y, 0.0);
    assert_close(state.v[0], 0.0, 0.0);
    assert_close(state.v[1], 0.0, 0.0);
    assert_int_equal(s.n_events, n_events);
    assert_close(state.contacts[0].friction[0], -mass * g * sine, 1e-12);
    assert_close(state.energy.friction, 0.7 * mass * g * cos(M_PI / 6.0) * 4.318632764587572, 1e-8);
    assert_close(s.work, 0.0, 1e-11);
    assert_close(s.balance, 0.0, 1e-9); /* an impulse of 1000 N s from 6000 steps */
    support_close(&s.run);
}

TEST(a_block_sent_up_turns_back_where_friction_cannot_hold_it)
{
    const double up = g * (sine + 0.2 * cos(M_PI / 6.0)), turn = 2.0 / up, height = 2.0 / up;
    static slide s;
    open_incline(&s, 0.2, -2.0);
    check_place(&s, 0.1, -0.2 + 0.5 * up * 0.01, -2.0 + up * 0.1, 1e-10);
    const double down = 1.5 - turn, a = acceleration(0.2);
    check_place(&s, 1.5, -height + 0.5 * a * down * down, a * down, 1e-10);
    assert_close(a * down, 3.837924334452, 1e-10);
    const dem_counts counts = ask_counts(s.run.simulation);
    assert_int_equal(counts.sticks, 1);
    assert_int_equal(counts.releases, 0);
    for (int k = 0; k < s.n_events; k++)
        if (s.events[k].kind == DEM_EVENT_STICK) {
            assert_close(s.events[k].t, turn, 1e-10);
            assert_int_equal(s.events[k].state, DEM_CONTACT_SLIP);
        }
    check_ledger(&s);
    assert_close(s.drift, 0.0, 1e-10);
    support_close(&s.run);
}

/* Every impact by its closed form: the tangential impulse is mu times the normal one, which the event holds. */
static void check_impulses(const slide *s)
{
    for (dem_index k = 0; k < s->run.n_impacts && k < SUPPORT_IMPACTS; k++) {
        const dem_event *e = &s->run.impacts[k];
        const double normal = dot(e->impulse, s->normal), along = dot(e->impulse, s->tangent);
        const double before = dot(e->before, s->tangent), after = dot(e->after, s->tangent);
        const double up = dot(e->after, s->normal), down = dot(e->before, s->normal);
        assert_close(normal, mass * (up - down), 1e-13);
        assert_close(along, -s->mu * normal, 1e-13);
        assert_close(after - before, along / mass, 1e-13);
        assert_close(e->energy, 0.5 * mass * (down * down - up * up) - along * 0.5 * (before + after), 1e-12);
    }
}

TEST(a_bouncing_block_slides_down_as_fast_as_one_that_stays_whatever_the_restitution)
{
    static const double eta[5] = {0.0, 0.3, 0.5, 0.7, 0.8}; /* the last ends its bouncing at 0.98 s */
    static const double v0[2] = {1.0, 0.0};
    static slide s;
    for (int k = 0; k < 5; k++) {
        open_slide(&s, M_PI / 6.0,
                   &(dem_obstacle){.struct_size = sizeof(dem_obstacle), .friction = 0.2, .restitution = eta[k]}, 0.05,
                   v0, g);
        const motion state = slide_at(&s, 1.5);
        assert_int_equal(state.n_contacts, 1);
        assert_close(dot(state.v, s.tangent), 5.808787237, 1e-7);
        assert_close(dot(state.v, s.tangent), 1.0 + 1.5 * acceleration(0.2), 1e-7);
        check_impulses(&s);
        check_ledger(&s);
        /* rtol times the energies, and friction across the penetration tolerance of each impact: mu m g 1e-13 m */
        assert_close(s.drift, 0.0, 1e-10);
        support_close(&s.run);
    }
}

typedef struct oblique {
    dem_friction_law law;
    double mu, eta, after[2];
} oblique;

static const oblique rows[5] = {{DEM_FRICTION_COULOMB, 0.3, 0.5, {2.1, 1.0}},
                                {DEM_FRICTION_COULOMB, 0.9, 0.5, {0.3, 1.0}},
                                {DEM_FRICTION_COULOMB, 1.5, 0.8, {0.0, 1.6}},
                                {DEM_FRICTION_PAPER, 0.3, 0.5, {0.9, 1.0}},
                                {DEM_FRICTION_PAPER, 1.0, 1.0, {3.0, 2.0}}};

static void check_oblique(const oblique *row, double angle, double side)
{
    static slide s;
    const dem_obstacle law =
        SIZED(dem_obstacle, .friction = row->mu, .restitution = row->eta, .friction_law = row->law);
    const double v0[2] = {3.0 * side, -2.0};
    open_slide(&s, angle, &law, 0.5, v0, 0.0);
    const motion state = slide_at(&s, 0.5);
    assert_int_equal(s.run.n_impacts, 1);
    const dem_event *e = &s.run.impacts[0];
    assert_close(e->t, 0.25, 1e-12);
    assert_close(dot(e->after, s.tangent), side * row->after[0], 1e-12);
    assert_close(dot(e->after, s.normal), row->after[1], 1e-12);
    assert_close(dot(state.v, s.tangent), side * row->after[0], 1e-12);
    assert_close(dot(state.v, s.normal), row->after[1], 1e-12);
    assert_close(e->energy, 0.5 * mass * (13.0 - dot(row->after, row->after)), 1e-11);
    assert_close(s.balance, 0.0, 1e-11);
    assert_close(s.turn, 0.0, 1e-11);
    assert_close(s.drift, 0.0, 1e-11);
    support_close(&s.run);
}

TEST(an_oblique_impact_follows_each_law_of_friction)
{
    for (int k = 0; k < 5; k++) {
        check_oblique(&rows[k], 0.0, 1.0);
        check_oblique(&rows[k], 0.0, -1.0);
        check_oblique(&rows[k], M_PI / 6.0, 1.0);
        check_oblique(&rows[k], -2.0, -1.0);
    }
}

/* (10) acts once, at the impact that closes the contact: from then on the node slides freely. */
TEST(the_law_of_the_paper_has_no_sustained_friction)
{
    static const double v0[2] = {3.0, 0.0};
    const double fall = sqrt(2.0 * 0.2 / g);
    static slide s;
    open_slide(
        &s, 0.0,
        &(dem_obstacle){.struct_size = sizeof(dem_obstacle), .friction = 0.3, .friction_law = DEM_FRICTION_PAPER}, 0.2,
        v0, g);
    check_place(&s, fall + 1.0, 3.0 * fall + 0.9, 0.9, 1e-10);
    check_place(&s, fall + 5.0, 3.0 * fall + 4.5, 0.9, 1e-10);
    const motion state = slide_at(&s, 6.0);
    assert_int_equal(s.run.n_impacts, 1);
    assert_int_equal(state.contacts[0].state, DEM_CONTACT_SLIP);
    assert_close(state.contacts[0].friction[0], 0.0, 0.0);
    assert_close(state.energy.friction, 0.0, 0.0);
    support_close(&s.run);
    open_slide(
        &s, M_PI / 6.0,
        &(dem_obstacle){.struct_size = sizeof(dem_obstacle), .friction = 0.3, .friction_law = DEM_FRICTION_PAPER}, 0.0,
        (double[2]){0.0, 0.0}, g);
    check_place(&s, 1.0, 0.25 * g, 0.5 * g, 1e-10);
    support_close(&s.run);
}
