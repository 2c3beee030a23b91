/* SPDX-License-Identifier: BSD-3-Clause */
#include "rebound.h"

#include <math.h>
#include <string.h>

#include "ask.h"

/* ---- motion of all bodies ---- */

typedef struct mean_motion {
    double velocity[2]; /* m/s */
    double rising;      /* m/s, the part of it against gravity; where there is none, along y */
} mean_motion;

static mean_motion measure(const dem_simulation *simulation)
{
    const dem_options options = ask_options(simulation);
    const double g = hypot(options.gravity[0], options.gravity[1]);
    const double up[2] = {g > 0.0 ? -options.gravity[0] / g : 0.0, g > 0.0 ? -options.gravity[1] / g : 1.0};
    const dem_index n_bodies = ask_sizes(dem_simulation_model(simulation)).n_bodies;
    double mass = 0.0, x = 0.0, y = 0.0, rising = 0.0;
    for (dem_index b = 0; b < n_bodies; b++) {
        const dem_body_motion body = ask_body(simulation, b);
        mass += body.mass;
        x += body.mass * body.velocity[0];
        y += body.mass * body.velocity[1];
        rising += body.mass * (body.velocity[0] * up[0] + body.velocity[1] * up[1]);
    }
    return (mean_motion){{x / mass, y / mass}, rising / mass};
}

double rebound_rising_speed(const dem_simulation *simulation)
{
    return measure(simulation).rising;
}

/* ---- following a run ---- */

/* Where and when an obstacle is touched. */
typedef struct touch {
    dem_index obstacle;
    double t;
    const double *place;
} touch;

/* Velocity of the obstacle's point. */
static void move_ground(double ground[2], const dem_simulation *simulation, touch at)
{
    ask_obstacle_velocity(dem_model_obstacle(dem_simulation_model(simulation), at.obstacle), at.t, at.place, ground);
}

/* Velocity along a normal, against that of the ground. */
static double along(const double v[2], const double ground[2], const double normal[2])
{
    return (v[0] - ground[0]) * normal[0] + (v[1] - ground[1]) * normal[1];
}

/* Nodes part and touch again within a bounce: its centre of mass tells whether a body had left and comes back. */
static bool comes_back(const rebound *r, const dem_simulation *simulation, const dem_event *event, const double v[2])
{
    double left[2], met[2];
    if (r->n_contacts > 0 || r->last > r->t || event->t <= r->last) return false;
    move_ground(left, simulation, (touch){r->obstacle, r->last, r->place});
    move_ground(met, simulation, (touch){event->obstacle, event->t, event->x});
    return along(r->velocity, left, r->normal) > 0.0 && along(v, met, event->normal) < 0.0;
}

/* Where a bounce begins the bodies have been in free flight since the last step; bodies that touch from the beginning
 * have had no step before. */
static void meet(rebound *r, const initial_motion *initial, const dem_simulation *simulation, const dem_event *event)
{
    double v[2];
    const dem_options options = ask_options(simulation);
    if (!r->started) initial_motion_velocity(r->before, initial);
    for (int c = 0; c < 2; c++) v[c] = r->before[c] + options.gravity[c] * (event->t - r->t);
    if (r->touched && !comes_back(r, simulation, event, v)) return;
    if (!r->touched) r->first = event->t;
    r->touched = true;
    r->several = false;
    r->n_bounces++;
    r->begin = event->t;
    r->obstacle = event->obstacle;
    memcpy(r->approach, v, sizeof v);
    move_ground(r->ground, simulation, (touch){event->obstacle, event->t, event->x});
    memcpy(r->given_before, r->given, sizeof r->given);
}

void rebound_note(rebound *r, const initial_motion *initial, const dem_simulation *simulation, const dem_event *event)
{
    meet(r, initial, simulation, event);
    if (event->obstacle != r->obstacle) r->several = true;
    r->last = event->t;
    r->obstacle = event->obstacle;
    for (int c = 0; c < 2; c++) {
        r->normal[c] = event->normal[c];
        r->place[c] = event->x[c];
        r->impulse[c] += event->impulse[c];
    }
    if (event->state != DEM_CONTACT_FREE && r->opened < 0.0) r->opened = event->t;
    if (event->kind == DEM_EVENT_RELEASE) r->closed = event->t;
}

/* What of the step now ended had a lasting contact, to within the gaps that open and close in it. */
static double touching_in(const rebound *r, const dem_progress *now)
{
    const double begin = r->n_contacts > 0 ? r->t : r->opened;
    const double end = now->n_contacts > 0 ? now->t : r->closed;
    return begin >= 0.0 && end > begin ? end - begin : 0.0;
}

static void follow_reaction(rebound *r, const dem_simulation *simulation, const dem_progress *now)
{
    double sum[2] = {0.0, 0.0};
    for (dem_index k = 0; k < now->n_contacts; k++) {
        const dem_contact c = ask_contact(simulation, k);
        sum[0] += c.force * c.normal[0] + c.friction[0] * c.normal[1];
        sum[1] += c.force * c.normal[1] - c.friction[0] * c.normal[0];
    }
    if (hypot(sum[0], sum[1]) <= hypot(r->reaction[0], r->reaction[1])) return;
    memcpy(r->reaction, sum, sizeof sum);
    r->reaction_t = now->t;
}

/* Where contacts last, that of the largest force is the one touched last. */
static void follow_normal(rebound *r, const dem_simulation *simulation, const dem_progress *now)
{
    dem_contact most = ask_contact(simulation, 0);
    for (dem_index k = 1; k < now->n_contacts; k++) {
        const dem_contact c = ask_contact(simulation, k);
        if (c.force > most.force) most = c;
    }
    memcpy(r->normal, most.normal, sizeof r->normal);
    memcpy(r->place, most.x, sizeof r->place);
    r->obstacle = most.obstacle;
}

/* Angular momentum of all bodies as one over their moment of inertia, rad/s, both about their centre of mass, whose
 * velocity is v: those of each about its own centre, and of its mass there. */
static double spin_of_all(const dem_simulation *simulation, const double v[2])
{
    const dem_index n = ask_sizes(dem_simulation_model(simulation)).n_bodies;
    double mass = 0.0, centre[2] = {0.0, 0.0}, angular = 0.0, inertia = 0.0;
    for (dem_index b = 0; b < n; b++) {
        const dem_body_motion body = ask_body(simulation, b);
        mass += body.mass;
        for (int c = 0; c < 2; c++) centre[c] += body.mass * body.centre[c];
    }
    for (dem_index b = 0; b < n; b++) {
        const dem_body_motion body = ask_body(simulation, b);
        const double x = body.centre[0] - centre[0] / mass, y = body.centre[1] - centre[1] / mass;
        angular +=
            body.angular_momentum[2] + body.mass * (x * (body.velocity[1] - v[1]) - y * (body.velocity[0] - v[0]));
        inertia += ask_inertia(simulation, b) + body.mass * (x * x + y * y);
    }
    return inertia > 0.0 ? angular / inertia : 0.0;
}

static void follow_velocity(rebound *r, const dem_simulation *simulation, const dem_progress *now,
                            const mean_motion *mean)
{
    const dem_options options = ask_options(simulation);
    const double since = now->t - r->last; /* for which the bodies have been in free flight again */
    if (now->n_contacts == 0) r->spin = spin_of_all(simulation, mean->velocity);
    for (int c = 0; c < 2; c++) r->velocity[c] = mean->velocity[c] - options.gravity[c] * since;
    r->speed = mean->rising + hypot(options.gravity[0], options.gravity[1]) * since;
}

/* Asked for only where nothing touches any more: each obstacle looks through all contacts. */
static void follow_impulse(rebound *r, const dem_simulation *simulation)
{
    const dem_index n = ask_sizes(dem_simulation_model(simulation)).n_obstacles;
    r->given[0] = r->given[1] = 0.0;
    for (dem_index o = 0; o < n; o++) {
        const dem_obstacle_load load = ask_obstacle(simulation, o);
        for (int c = 0; c < 2; c++) r->given[c] += load.impulse[c];
    }
}

void rebound_follow(rebound *r, const dem_simulation *simulation, const dem_progress *now)
{
    const dem_index impacts = ask_counts(simulation).impacts;
    const bool contact = now->n_contacts > 0 || r->n_contacts > 0 || impacts > r->n_impacts;
    const mean_motion mean = measure(simulation);
    if (now->n_contacts > 0) r->last = now->t;
    if (now->n_contacts > 0) follow_normal(r, simulation, now);
    r->touching += touching_in(r, now);
    follow_reaction(r, simulation, now);
    if (contact) follow_velocity(r, simulation, now, &mean);
    if (contact && now->n_contacts == 0) follow_impulse(r, simulation);
    memcpy(r->before, mean.velocity, sizeof r->before);
    r->started = true;
    r->t = now->t;
    r->opened = r->closed = -1.0;
    r->n_contacts = now->n_contacts;
    r->n_impacts = impacts;
}

/* ---- what came of it ---- */

bool rebound_is_over(const rebound *r)
{
    return r->touched && r->n_contacts == 0;
}

/* To the rounding of coordinates. */
static bool is_straight(const dem_obstacle *o)
{
    const double *p = o->points, *last = p + 2 * (o->n_points - 1);
    const double x = last[0] - p[0], y = last[1] - p[1], square = x * x + y * y;
    for (dem_index k = 1; k < o->n_points - 1; k++) {
        const double dx = p[2 * k] - p[0], dy = p[2 * k + 1] - p[1], share = x * dx + y * dy;
        if (!(square > 0.0 && fabs(x * dy - y * dx) <= 1e-12 * square && share >= 0.0 && share <= square)) return false;
    }
    return true;
}

rebound_normal rebound_along(const rebound *r, const dem_simulation *simulation)
{
    const double none = (double)NAN;
    rebound_normal n = {.normal = {none, none}, .in = none, .out = none, .ratio = none};
    if (!rebound_is_over(r)) return n;
    const double given[2] = {r->given[0] - r->given_before[0], r->given[1] - r->given_before[1]};
    const double size = hypot(given[0], given[1]);
    const dem_obstacle *obstacle = dem_model_obstacle(dem_simulation_model(simulation), r->obstacle);
    n.along_impulse = size > 0.0 && (r->several || !is_straight(obstacle));
    for (int c = 0; c < 2; c++) n.normal[c] = n.along_impulse ? given[c] / size : r->normal[c];
    double left[2];
    move_ground(left, simulation, (touch){r->obstacle, r->last, r->place});
    n.in = along(r->approach, r->ground, n.normal);
    n.out = along(r->velocity, left, n.normal);
    if (n.in < 0.0) n.ratio = -n.out / n.in;
    return n;
}

/* ---- in the log ---- */

/* What is zero in exact arithmetic comes out as the rounding of a sum over all nodes: of 1e5 nodes about 1e-13 of the
 * largest term. Its digits would look like a result. */
static double clean(double value, double scale)
{
    return fabs(value) <= 1e-12 * scale ? 0.0 : value;
}

static double speed_scale(const rebound *r)
{
    return fmax(hypot(r->approach[0], r->approach[1]), hypot(r->velocity[0], r->velocity[1]));
}

/* At which the ends of the bodies, at rest this far apart, would move as fast as their centre of mass. */
static double spin_scale(const rebound *r, double extent)
{
    return extent > 0.0 ? speed_scale(r) / extent : 0.0;
}

static const char *say_direction(const rebound *r, const rebound_normal *n)
{
    if (!n->along_impulse) return "";
    return r->several ? " along the impulse of all obstacles" : " along its impulse";
}

static void print_normal(FILE *out, const rebound *r, const dem_simulation *simulation)
{
    const rebound_normal n = rebound_along(r, simulation);
    const double scale = fmax(speed_scale(r), fabs(n.in));
    (void)fprintf(out, "normal     of obstacle %lld, (%.4g, %.4g)%s: ", (long long)r->obstacle + 1,
                  clean(n.normal[0], 1.0), clean(n.normal[1], 1.0), say_direction(r, &n));
    if (r->n_bounces > 1) (void)fprintf(out, "%lld bounces; last: ", (long long)r->n_bounces);
    (void)fprintf(out, "%+.5g m/s before, %+.5g m/s after", clean(n.in, scale), clean(n.out, scale));
    if (isfinite(n.ratio)) (void)fprintf(out, ", ratio %.4f", clean(n.ratio, 1.0));
    (void)fprintf(out, "\n");
}

static void print_rebound(FILE *out, const rebound *r, const dem_simulation *simulation, double extent)
{
    const double scale = speed_scale(r);
    if (!rebound_is_over(r)) {
        (void)fprintf(out, "rebound    not yet: %lld contact%s at t_end; give a later t_end\n",
                      (long long)r->n_contacts, r->n_contacts == 1 ? "" : "s");
        return;
    }
    (void)fprintf(out, "rebound    (%+.5g, %+.5g) m/s of the centre of mass at the last contact, spin %+.4g rad/s\n",
                  clean(r->velocity[0], scale), clean(r->velocity[1], scale), clean(r->spin, spin_scale(r, extent)));
    print_normal(out, r, simulation);
}

void rebound_print(FILE *out, const rebound *r, const dem_simulation *simulation, double extent, bool rests)
{
    const double size = hypot(r->reaction[0], r->reaction[1]);
    if (!r->touched) {
        (void)fprintf(out, "contact    none\n");
        return;
    }
    (void)fprintf(out, "contact    first at %.6e s, last at %.6e s, touching %.4e s%s", r->first, r->last, r->touching,
                  r->n_contacts > 0 ? " (still touching)" : "");
    if (size > 0.0)
        (void)fprintf(out, "; largest force (%.6g, %.6g) N", clean(r->reaction[0], size), clean(r->reaction[1], size));
    (void)fprintf(out, "\n");
    if (!rests) print_rebound(out, r, simulation, extent);
}

void rebound_print_details(FILE *out, const rebound *r, const dem_simulation *simulation)
{
    const double given = hypot(r->impulse[0], r->impulse[1]);
    if (!r->touched) return;
    if (rebound_is_over(r))
        (void)fprintf(out,
                      "rebound    vertical velocity of the centre of mass %+.5g m/s at the last contact, %+.5g m/s at "
                      "t_end\n",
                      clean(r->speed, speed_scale(r)), rebound_rising_speed(simulation));
    (void)fprintf(out, "force      largest at %.4e s, by lasting contacts; impacts gave (%.6g, %.6g) N s\n",
                  r->reaction_t, clean(r->impulse[0], given), clean(r->impulse[1], given));
}
