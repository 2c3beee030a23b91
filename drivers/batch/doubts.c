/* SPDX-License-Identifier: BSD-3-Clause */
#include "doubts.h"

#include <math.h>
#include <stdio.h>

#include "ask.h"
#include "rigid_keys.h"
#include "step_report.h"
#include "walls.h"

enum { most_listed = 16 }; /* bodies */

static const double light = 0.97;       /* mass over that of the true shape */
static const double least_across = 8.0; /* spacings of a wall */
static const double fast = 0.1;         /* of the wave speed */
static const double pressed = 0.1;      /* energy of contact over that of the motion */

/* Facts that were made without a deck belong to no group. */
static bool is_rigid(const deck *d, size_t k)
{
    return k < schema_count(&d->groups, "body") && rigid_keys_ask(schema_get(&d->groups, "body", k));
}

/* The key has a meaning, and a value, only where it can be chosen. */
static bool is_jagged(const deck *d, size_t k)
{
    return k < schema_count(&d->groups, "body") && schema_is(schema_get(&d->groups, "body", k), "outline", "lattice");
}

/* Numbered from 1, as decks are. */
static void warn_lattice(run_log *log, const deck *d, size_t k)
{
    const body_facts *b = &d->bodies[k];
    const double ratio = b->true_mass > 0.0 ? b->mass / b->true_mass : 1.0, wall = walls_thinnest(&d->groups, k);
    const double across = b->geometry.spacing > 0.0 ? wall / b->geometry.spacing : (double)INFINITY;
    char less[80] = "", thin[120] = "";
    if (ratio < light)
        (void)snprintf(less, sizeof less, "has %.1f %% less mass than its true shape", 100.0 * (1.0 - ratio));
    if (across < least_across)
        (void)snprintf(thin, sizeof thin, "%shas a wall of %g m, only %.3g spacings", less[0] != '\0' ? " and " : "",
                       wall, across);
    if (less[0] != '\0' || thin[0] != '\0')
        run_log_warn(log,
                     "body %zu %s%s: its stiffness is off, and stresses at its edges do not converge; "
                     "take a finer 'spacing' in &body, %sor a mesh (shape = 'mesh')",
                     k + 1, less, thin, is_jagged(d, k) ? "outline = 'smooth', " : "");
}

void doubts_of_lattices(run_log *log, const deck *d)
{
    for (size_t k = 0; k < d->n_bodies && k < most_listed; k++)
        if (!is_rigid(d, k)) warn_lattice(log, d, k);
}

/* What an obstacle has that is nothing for rigid bodies, or NULL. */
static const char *law_without_effect(const schema_instance *obstacle)
{
    if (schema_real(obstacle, "restitution") > 0.0) return "restitution";
    return schema_is(obstacle, "friction_law", "paper") && schema_real(obstacle, "friction") < 1.0 ? "friction_law"
                                                                                                   : NULL;
}

void doubts_of_rigid(run_log *log, const deck *d)
{
    const size_t n = lattice_facts_any_rigid(&d->facts) ? schema_count(&d->groups, "obstacle") : 0;
    for (size_t k = 0; k < n; k++) {
        const char *what = law_without_effect(schema_get(&d->groups, "obstacle", k));
        if (what == NULL) continue;
        run_log_warn(log, "the %s of obstacle %zu does not act on rigid bodies", what, k + 1);
        return;
    }
}

static bool has_triangles(const dem_simulation *simulation)
{
    return ask_sizes(dem_simulation_model(simulation)).n_triangles > 0;
}

/* The default of `bodies` has become 'none' (deck/surfaces.h). */
void doubts_of_surfaces(run_log *log, const deck *d, const dem_simulation *simulation)
{
    const schema_instance *contact = schema_get(&d->groups, "contact", 0);
    const bool settled = contact != NULL && !schema_value_of(contact, "bodies")->given &&
                         ask_options(simulation).bodies == DEM_BODIES_NONE;
    if (settled && has_triangles(simulation))
        run_log_warn(log, "bodies do not touch each other, since one of them has no triangles; say bodies = 'none' in "
                          "&contact if that is meant");
}

/* Pieces stay of the body that they come from. Who gives 'none' wants no contact of bodies at all. */
void doubts_of_pieces(run_log *log, const deck *d, const dem_simulation *simulation)
{
    if (ask_options(simulation).bodies == DEM_BODIES_OTHERS && has_triangles(simulation) && d->facts.may_break)
        run_log_warn(log, "pieces of one body pass through each other with bodies = 'others', as do the faces of a "
                          "crack; bodies = 'all' in &contact lets them touch");
}

void doubts_of_step(run_log *log, const dem_simulation *simulation)
{
    char why[STEP_REPORT_WHY];
    if (step_report_is_long(simulation, why)) run_log_warn(log, "%s: with it the run may overflow", why);
}

void doubts_of_overlap(run_log *log, const dem_simulation *simulation)
{
    const dem_overlap o = ask_overlap(simulation);
    if (o.node < 0 || o.t > 0.0) return;
    run_log_warn(log,
                 "bodies overlap at t = 0, which nothing undoes: node %lld is inside triangle %lld at (%g, %g) m; move "
                 "a body by 'position' in &body",
                 (long long)o.node, (long long)o.triangle, o.x[0], o.x[1]);
}

/* Surfaces nearer to each other than the contact thickness push each other, and what is stiff flies off. */
void doubts_of_pressing(run_log *log, const dem_simulation *simulation)
{
    const dem_energy e = ask_energy(simulation);
    if (ask_progress(simulation).t > 0.0 || !(e.contact > pressed * e.kinetic)) return;
    run_log_warn(log,
                 "surfaces are pressed together at t = 0 with %.4g J, and bodies move with %.4g J: they start nearer "
                 "than the contact thickness; if that is not meant move a body by 'position' in &body",
                 e.contact, e.kinetic);
}

void doubts_of_speed(run_log *log, const dem_model *model, const lattice_body *body, dem_index number,
                     double wave_speed)
{
    const dem_index n = ask_sizes(model).n_obstacles;
    double v[2], least = (double)INFINITY;
    initial_motion_velocity(v, &body->motion);
    for (dem_index o = 0; o < n; o++) {
        const dem_obstacle *obstacle = dem_model_obstacle(model, o);
        double w[2];
        ask_obstacle_velocity(obstacle, 0.0, obstacle->points, w);
        least = fmin(least, hypot(v[0] - w[0], v[1] - w[1]));
    }
    if (n == 0 || !(least > fast * wave_speed)) return;
    run_log_warn(log,
                 "body %lld moves at %.3g m/s, %.3g %s its wave speed of %.4g m/s (strains of that size): is E in Pa "
                 "(210e9, not 210e3)?",
                 (long long)number + 1, least, least / wave_speed, least < wave_speed ? "of" : "times", wave_speed);
}
