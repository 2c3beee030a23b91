/* SPDX-License-Identifier: BSD-3-Clause */
/* Plain text for people and for grep: one topic a line, its name in the first column. */
#include "report.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <dem/trajectory.h>

#include "angle.h"
#include "ask.h"
#include "base/peak_source.h"
#include "edges.h"
#include "wall_clock.h"
#include "whole_nodes.h"

enum { most_listed = 16, most_in_short = 4 }; /* obstacles, boundaries */

static const char entry[] = "report", touched_entry[] = "report.touched"; /* of a checkpoint */

/* ---- following a run ---- */

static void follow_energy(report *r, const dem_simulation *simulation, const dem_progress *now)
{
    const dem_energy e = ask_energy(simulation);
    if (now->t == 0.0) r->so_far.energy_start = e.ledger;
    r->so_far.energy_max = fmax(r->so_far.energy_max, e.motion);
    const double share = r->so_far.energy_max > 0.0 ? (e.elastic + e.area + e.guard) / r->so_far.energy_max : 0.0;
    if (share <= r->so_far.elastic_share_max) return;
    r->so_far.elastic_share_max = share;
    r->so_far.elastic_share_t = now->t;
}

static void follow_strain(report *r, const dem_simulation *simulation, double t)
{
    const dem_strain strain = ask_strain(simulation);
    if (strain.min < r->so_far.strain_min.min) {
        r->so_far.strain_min = strain;
        r->so_far.strain_min_t = t;
    }
    if (strain.max > r->so_far.strain_max.max) {
        r->so_far.strain_max = strain;
        r->so_far.strain_max_t = t;
    }
    if (strain.area_min < r->so_far.area_min) {
        r->so_far.area_min = strain.area_min;
        r->so_far.area_min_t = t;
    }
    if (strain.guarded > r->so_far.guarded_max) r->so_far.guarded_max = strain.guarded;
    if (strain.inverted > r->so_far.inverted_max) r->so_far.inverted_max = strain.inverted;
}

static dem_index count_nodes(const dem_simulation *simulation)
{
    return ask_sizes(dem_simulation_model(simulation)).n_nodes;
}

int32_t report_touched(const report *r, dem_index node)
{
    return r->touched != NULL ? r->touched[node] : 0;
}

bool report_is_stepped(const report *r, const dem_model *model, dem_index node)
{
    return edges_stepped(&r->deck->groups, model, node);
}

static dem_status note_event(void *context, const dem_simulation *simulation, const dem_event *event)
{
    report *r = context;
    rebound_note(&r->so_far.rebound, &r->deck->facts.motion, simulation, event);
    if (r->touched == NULL) r->touched = calloc((size_t)count_nodes(simulation), sizeof *r->touched);
    if (r->touched == NULL) return DEM_ERROR_MEMORY;
    r->touched[event->node] = (int32_t)event->obstacle + 1;
    if (event->other >= 0) r->touched[event->other] = (int32_t)event->obstacle + 1;
    return DEM_OK;
}

static dem_status note_break(void *context, const dem_simulation *simulation, const dem_break *what)
{
    report *r = context;
    (void)simulation;
    fracture_report_note(&r->so_far.fracture_report, what);
    return DEM_OK;
}

double report_closure(const report *r, dem_energy e)
{
    return (e.ledger - r->so_far.energy_start) / fmax(r->so_far.energy_max, 1e-300);
}

static void warn_ledger(report *r, const dem_simulation *simulation)
{
    const bool fixed = ask_options(simulation).fixed_step > 0.0;
    run_log_warn(r->log, "the energy ledger is open by %+.2e at %.4e s: a %s closes it", r->so_far.warned_closure,
                 r->so_far.warned_t, fixed ? "shorter step" : "smaller 'rtol'");
}

static void warn_overlap(report *r, const dem_simulation *simulation)
{
    const dem_overlap o = ask_overlap(simulation);
    const bool touches = ask_options(simulation).bodies == DEM_BODIES_ALL;
    run_log_warn(r->log, "bodies overlap, %s: node %lld is inside triangle %lld at (%g, %g) m, %.4e s",
                 touches ? "as when a triangle is turned inside out" : "which bodies = 'all' in &contact prevents",
                 (long long)o.node, (long long)o.triangle, o.x[0], o.x[1], o.t);
}

/* What rounding may have added to the ledger or taken from it, J. Gravity counts from the origin: the weight of a body
 * at rest makes an entry that is far larger than the energy of its first motion. */
static double ledger_rounding(dem_energy e)
{
    const double entries[] = {e.motion, e.gravity, e.impact, e.friction, e.damping, e.boundary, e.obstacle};
    double largest = 0.0;
    for (size_t k = 0; k < sizeof entries / sizeof *entries; k++) largest = fmax(largest, fabs(entries[k]));
    return 64.0 * DBL_EPSILON * largest;
}

/* While a load grows from nothing the largest energy so far is no measure yet: the first steps of a ramp may be off by
 * all of the 1e-20 J that there are. */
static void watch_ledger(report *r, const dem_simulation *simulation, const dem_progress *now)
{
    const dem_energy e = ask_energy(simulation);
    const double closure = report_closure(r, e);
    if (r->so_far.warned || now->t < r->settled || !(fabs(closure) > r->closure)) return;
    if (fabs(e.ledger - r->so_far.energy_start) <= ledger_rounding(e)) return;
    r->so_far.warned = true;
    r->so_far.warned_closure = closure;
    r->so_far.warned_t = now->t;
    warn_ledger(r, simulation);
}

/* Of one at t = 0 the preview has warned. */
static void watch_overlap(report *r, const dem_simulation *simulation)
{
    const dem_overlap o = ask_overlap(simulation);
    if (r->so_far.overlapped || o.node < 0 || !(o.t > 0.0)) return;
    r->so_far.overlapped = true;
    warn_overlap(r, simulation);
}

/* On a terminal five times a second, in a file at every fifth of the run, or every twentieth. */
static bool is_due(const report *r, double now, double t)
{
    if (!(t > r->t_start)) return false;
    const double share = r->log->verbose ? 0.05 : 0.2;
    return r->log->terminal ? now - r->wall_shown > 0.2 : t - r->t_shown >= share * r->span;
}

/* What there is until its end. */
static void print_way(const report *r, const dem_simulation *simulation, const dem_progress *now)
{
    const double ramp = dem_simulation_ramp_time(simulation);
    if (r->rest == NULL)
        (void)fprintf(r->log->out, "%5.1f %%", 100.0 * fmin(1.0, now->t / r->t_end));
    else if (isfinite(r->rest->reached))
        (void)fprintf(r->log->out, "residual %.1e, at rest below %.1e", r->rest->reached, r->rest->residual);
    else if (ramp < now->t)
        (void)fprintf(r->log->out, "pauses, loads are at %.2e of %.2e s", ramp, r->settled);
    else
        (void)fprintf(r->log->out, "loads grow until %.2e s", r->settled);
}

static void show_progress(report *r, const dem_simulation *simulation, const dem_progress *now)
{
    const double wall = wall_clock(), spent = wall - r->wall_start;
    if (r->log->part != NULL) *r->log->part = fmin(1.0, now->t / r->t_end);
    if (!is_due(r, wall, now->t)) return;
    const dem_counts counts = ask_counts(simulation);
    r->wall_shown = wall;
    r->t_shown = now->t;
    r->log->inside = r->log->terminal;
    if (r->log->terminal) (void)fprintf(r->log->out, "\r");
    print_way(r, simulation, now);
    (void)fprintf(r->log->out, "  t %.4e s  step %lld  contacts %lld  energy error %+.1e  %.0f steps/s", now->t,
                  (long long)counts.steps, (long long)now->n_contacts, report_closure(r, ask_energy(simulation)),
                  (double)(counts.steps - r->steps_start) / fmax(spent, 1e-9));
    if (r->rest == NULL)
        (void)fprintf(r->log->out, "  %.0f s left", spent * (r->t_end - now->t) / (now->t - r->t_start));
    (void)fprintf(r->log->out, r->log->terminal ? "   " : "\n");
    (void)fflush(r->log->out);
}

static dem_status follow(void *context, const dem_simulation *simulation)
{
    report *r = context;
    const dem_progress now = ask_progress(simulation);
    /* At all nodes and springs at the steps that have a row in the history. */
    const bool looks = dem_history_row_due(r->deck->history_interval, r->so_far.looked_t, now.t);
    if (looks) follow_energy(r, simulation, &now);
    if (looks) follow_strain(r, simulation, now.t);
    if (looks || r->every == 0) step_report_follow(&r->so_far.step_report, simulation, &now);
    if (surface_report_follow(&r->so_far.surface_report, simulation, now.t))
        surface_report_warn(&r->so_far.surface_report, r->log);
    rebound_follow(&r->so_far.rebound, simulation, &now);
    if (r->deck->facts.may_break) fracture_report_follow(&r->so_far.fracture_report, simulation);
    if (looks) surface_report_look(&r->so_far.surface_report, simulation);
    if (looks) watch_ledger(r, simulation, &now);
    if (looks) r->so_far.looked_t = now.t;
    watch_overlap(r, simulation);
    show_progress(r, simulation, &now);
    return DEM_OK;
}

/* ---- before and after ---- */

void report_start(report *r, run_log *log, const deck *d)
{
    memset(r, 0, sizeof *r); /* gaps too: they get into checkpoints */
    r->log = log;
    r->deck = d;
    r->t_end = r->span = d->t_end;
    r->closure = d->closure;
    r->settled = relaxation_settled(&d->options);
    r->most_stressed = d->most_stressed;
    r->so_far.area_min = 1.0;
    r->so_far.looked_t = -(double)INFINITY;
    r->so_far.strain_min.spring_min = r->so_far.strain_max.spring_max = -1;
    r->wall_start = r->wall_shown = wall_clock();
}

void report_expect_rest(report *r, const relaxation *rest, double t)
{
    r->rest = rest;
    r->span = fmin(t, r->t_end);
}

void report_end(report *r)
{
    free(r->touched);
    r->touched = NULL;
}

/* Without an entry nothing had touched. */
static dem_status resume_touched(report *r, const dem_checkpoint *checkpoint, dem_index n_nodes)
{
    size_t size;
    const size_t expected = (size_t)n_nodes * sizeof *r->touched;
    if (dem_checkpoint_find(checkpoint, touched_entry, &size) == NULL) return DEM_OK;
    r->touched = malloc(expected);
    return r->touched != NULL ? dem_checkpoint_get(checkpoint, touched_entry, r->touched, expected) : DEM_ERROR_MEMORY;
}

dem_status report_resume(report *r, const dem_checkpoint *checkpoint, const dem_simulation *simulation)
{
    r->t_start = r->t_shown = ask_progress(simulation).t;
    r->steps_start = ask_counts(simulation).steps;
    dem_status status = dem_checkpoint_get(checkpoint, entry, &r->so_far, sizeof r->so_far);
    if (status == DEM_OK) status = resume_touched(r, checkpoint, count_nodes(simulation));
    return status;
}

static void warn_surfaces(report *r, const dem_simulation *simulation)
{
    (void)simulation;
    surface_report_warn(&r->so_far.surface_report, r->log);
}

void report_warn_again(report *r, const dem_simulation *simulation)
{
    const report_progress *p = &r->so_far;
    const double never = (double)INFINITY;
    struct {
        double t; /* s */
        void (*warn)(report *r, const dem_simulation *simulation);
    } all[] = {{p->warned ? p->warned_t : never, warn_ledger},
               {p->overlapped ? ask_overlap(simulation).t : never, warn_overlap},
               {p->surface_report.warning.given ? p->surface_report.warning.t : never, warn_surfaces}};
    enum { n = sizeof all / sizeof all[0] };
    r->log->quiet = true;
    for (int k = 0; k < n; k++) {
        int first = 0;
        for (int i = 1; i < n; i++)
            if (all[i].t < all[first].t) first = i;
        if (all[first].t < never) all[first].warn(r, simulation);
        all[first].t = never;
    }
    r->log->quiet = false;
}

static dem_status save(void *context, const dem_simulation *simulation, dem_checkpoint *checkpoint)
{
    const report *r = context;
    const size_t size = (size_t)count_nodes(simulation) * sizeof *r->touched;
    const dem_status status = dem_checkpoint_put(checkpoint, entry, &r->so_far, sizeof r->so_far);
    if (status != DEM_OK || r->touched == NULL) return status;
    return dem_checkpoint_put(checkpoint, touched_entry, r->touched, size);
}

dem_observer report_observer(report *r, dem_index every)
{
    r->every = every;
    return (dem_observer){.struct_size = sizeof(dem_observer),
                          .step = follow,
                          .event = note_event,
                          .checkpoint = save,
                          .context = r,
                          .broken = note_break,
                          .step_every = every,
                          .step_interval = every > 0 ? r->deck->history_interval : 0.0,
                          .step_touching = true};
}

static void print_strain(const report *r)
{
    if (r->so_far.strain_min.spring_min >= 0)
        (void)fprintf(r->log->out, "strain     smallest %+.4g in spring %lld at %.4e s\n", r->so_far.strain_min.min,
                      (long long)r->so_far.strain_min.spring_min, r->so_far.strain_min_t);
    if (r->so_far.strain_max.spring_max >= 0)
        (void)fprintf(r->log->out, "strain     largest %+.4g in spring %lld at %.4e s\n", r->so_far.strain_max.max,
                      (long long)r->so_far.strain_max.spring_max, r->so_far.strain_max_t);
    if (r->so_far.area_min < 1.0)
        (void)fprintf(
            r->log->out,
            "triangles  smallest area %.4f of its rest area at %.4e s, guard on %lld at most, %lld inverted\n",
            r->so_far.area_min, r->so_far.area_min_t, (long long)r->so_far.guarded_max,
            (long long)r->so_far.inverted_max);
}

/* Why a peak is not to be trusted. */
static void print_marks(const report *r, const dem_model *model, dem_index node)
{
    const bool stepped = report_is_stepped(r, model, node);
    const int32_t obstacle = report_touched(r, node);
    if (stepped) (void)fprintf(r->log->out, " (stepped edge: grows with refinement)");
    if (obstacle > 0) (void)fprintf(r->log->out, " (touches obstacle %ld)", (long)obstacle);
}

/* Place at rest. */
static void print_node_peak(const report *r, const dem_model *model, dem_index node, const dem_node_peak *peak)
{
    double x[2], value[2], direction[2];
    whole_nodes_place(x, model, node);
    dem_stress_principal(peak->stress, value, direction);
    (void)fprintf(r->log->out,
                  "stressed   node %lld at (%.6g, %.6g) m: von Mises %.4g Pa at %.4e s, principal %+.4g Pa at %.0f "
                  "degrees, %+.4g Pa",
                  (long long)node, x[0], x[1], peak->von_mises, peak->t, value[0],
                  atan2(direction[1], direction[0]) / angle_degree, value[1]);
    print_marks(r, model, node);
    (void)fprintf(r->log->out, "\n");
}

static void print_spring_peak(const report *r, const dem_model *model, dem_index spring, const dem_spring_peak *peak)
{
    const whole_spring at = whole_nodes_spring(model, spring);
    (void)fprintf(r->log->out, "strained   spring %lld at (%.6g, %.6g) m: strain %+.4g, force %+.4g N at %.4e s\n",
                  (long long)spring, at.middle[0], at.middle[1], peak->strain, at.stiffness * peak->strain, peak->t);
}

/* Whether bodies have deformed at all. In free flight coordinates are rounded: 1e4 steps of a ring, 100 spacings from
 * the origin, left strains of 2e-12, and its peaks were digits of that. */
static bool is_strained(const report *r)
{
    return fmax(r->so_far.strain_max.max, -r->so_far.strain_min.min) > 1e-10;
}

static void print_node_peaks(const report *r, const dem_model *model, dem_index most, dem_index *list)
{
    dem_index n = most;
    dem_node_peak *peaks = calloc((size_t)most + 1, sizeof *peaks);
    const bool good = peaks != NULL && dem_private_peaks_largest_nodes(r->peaks, &n, list, peaks) == DEM_OK;
    for (dem_index k = 0; k < n && good; k++) print_node_peak(r, model, list[k], &peaks[k]);
    free(peaks);
}

static void print_spring_peaks(const report *r, const dem_model *model, dem_index most, dem_index *list)
{
    dem_index n = most;
    dem_spring_peak *peaks = calloc((size_t)most + 1, sizeof *peaks);
    const bool good = peaks != NULL && dem_private_peaks_largest_springs(r->peaks, &n, list, peaks) == DEM_OK;
    for (dem_index k = 0; k < n && good; k++) print_spring_peak(r, model, list[k], &peaks[k]);
    free(peaks);
}

static void print_peaks(const report *r, const dem_model *model)
{
    const dem_index most = r->log->verbose || r->most_stressed == 0 ? r->most_stressed : 1;
    dem_index *list = calloc((size_t)most + 1, sizeof *list);
    if (r->peaks != NULL && is_strained(r) && list != NULL) {
        print_node_peaks(r, model, most, list);
        if (r->log->verbose) print_spring_peaks(r, model, most, list);
    }
    free(list);
}

/* What took energy, beside impacts, if it did. */
static void print_taken(FILE *out, const char *by, double energy)
{
    if (energy != 0.0) (void)fprintf(out, ", %s %.4g", by, energy);
}

static void print_ledger(const report *r, dem_energy e)
{
    (void)fprintf(r->log->out, "ledger     start %.9g J = now %.9g + taken by impacts %.4g", r->so_far.energy_start,
                  e.motion + e.gravity, e.impact);
    print_taken(r->log->out, "friction", e.friction);
    print_taken(r->log->out, "damping", e.damping);
    print_taken(r->log->out, "fracture", e.fracture);
    (void)fprintf(r->log->out, " - projection %.3g", e.projection);
    if (e.boundary != 0.0) (void)fprintf(r->log->out, " - put in by boundaries %.4g", e.boundary);
    if (e.obstacle != 0.0) (void)fprintf(r->log->out, " - put in by obstacles %.4g", e.obstacle);
    (void)fprintf(r->log->out, "; closure %+.2e\n", report_closure(r, e));
}

/* The ledger in plain words. */
static void print_balance(const report *r, dem_energy e)
{
    (void)fprintf(r->log->out, "balance    %.6g J at the start, %.6g J now; impacts took %.4g", r->so_far.energy_start,
                  e.motion + e.gravity, e.impact);
    print_taken(r->log->out, "friction", e.friction);
    print_taken(r->log->out, "damping", e.damping);
    print_taken(r->log->out, "fracture", e.fracture);
    print_taken(r->log->out, "boundaries gave", e.boundary);
    print_taken(r->log->out, "obstacles gave", e.obstacle);
    (void)fprintf(r->log->out, " J; error %+.1e of the largest energy\n", report_closure(r, e));
}

static void print_energies(const report *r, dem_energy e)
{
    (void)fprintf(r->log->out,
                  "energy     kinetic %.6g, elastic %.4g, area %.4g, guard %.4g, contact %.4g, gravity %.4g J\n",
                  e.kinetic, e.elastic, e.area, e.guard, e.contact, e.gravity);
    (void)fprintf(r->log->out,
                  "elastic    largest share %.4f of the largest kinetic and elastic energy so far, at %.4e s\n",
                  r->so_far.elastic_share_max, r->so_far.elastic_share_t);
}

static void print_events(FILE *out, const dem_counts *c)
{
    (void)fprintf(out, "events     %lld times: %lld impacts, %lld on vertices, %lld early, %lld late, %lld behind\n",
                  (long long)c->events, (long long)c->impacts, (long long)c->vertex_impacts, (long long)c->early,
                  (long long)c->late, (long long)c->behind);
    (void)fprintf(out, "lasting    %lld closings, %lld releases, %lld slips, %lld sticks, %lld ends passed\n",
                  (long long)c->closings, (long long)c->releases, (long long)c->slips, (long long)c->sticks,
                  (long long)c->passings);
}

/* Numbered from 1, as decks are. */
static void print_obstacle(FILE *out, dem_index number, const dem_obstacle_load *load)
{
    (void)fprintf(out, "obstacle   %lld: impulse (%.6g, %.6g) N s, by friction (%.4g, %.4g) N s, %lld contact%s",
                  (long long)number, load->impulse[0], load->impulse[1], load->friction_impulse[0],
                  load->friction_impulse[1], (long long)load->n_contacts, load->n_contacts == 1 ? "" : "s");
    if (load->n_contacts > 0)
        (void)fprintf(out, ", (%.6g, %.6g) N at (%.6g, %.6g) m", load->reaction[0], load->reaction[1], load->point[0],
                      load->point[1]);
    (void)fprintf(out, "\n");
}

/* Without details those that carry bodies at the end: what the others gave the rebound tells. */
static void print_obstacles(FILE *out, const dem_simulation *simulation, bool details)
{
    const dem_index n = ask_sizes(dem_simulation_model(simulation)).n_obstacles;
    const dem_index most = details ? most_listed : most_in_short;
    for (dem_index o = 0; o < n && o < most; o++) {
        const dem_obstacle_load load = ask_obstacle(simulation, o);
        if (details || load.n_contacts > 0) print_obstacle(out, o + 1, &load);
    }
    if (details && n > most)
        (void)fprintf(out, "obstacle   %lld to %lld: see /history\n", (long long)most + 1, (long long)n);
}

static void print_boundaries(FILE *out, const dem_simulation *simulation, bool details)
{
    const dem_index n = ask_options(simulation).n_boundaries;
    const dem_index most = details ? most_listed : most_in_short;
    for (dem_index k = 0; k < n && k < most; k++) {
        const dem_boundary_load load = ask_boundary(simulation, k);
        (void)fprintf(out, "boundary   %lld: force (%.6g, %.6g) N, moved by (%.6g, %.6g) m\n", (long long)k + 1,
                      load.force[0], load.force[1], load.displacement[0], load.displacement[1]);
    }
    if (n > most) (void)fprintf(out, "boundary   %lld to %lld: see /history\n", (long long)most + 1, (long long)n);
}

static void print_overlap(FILE *out, const dem_simulation *simulation)
{
    const dem_overlap o = ask_overlap(simulation);
    if (o.node >= 0)
        (void)fprintf(out, "overlap    first at %.4e s, node %lld in triangle %lld; %lld at most, %lld now\n", o.t,
                      (long long)o.node, (long long)o.triangle, (long long)o.most, (long long)o.now);
}

/* The line of the rebound says it in the log. */
static void warn_touching(report *r)
{
    const rebound *found = &r->so_far.rebound;
    if (r->rest != NULL || !found->touched || rebound_is_over(found)) return;
    r->log->quiet = true;
    run_log_warn(r->log, "no rebound yet: %lld contact%s at t_end; give a later t_end", (long long)found->n_contacts,
                 found->n_contacts == 1 ? "" : "s");
    r->log->quiet = false;
}

static void print_counts(const report *r, const dem_simulation *simulation)
{
    const dem_counts c = ask_counts(simulation);
    print_overlap(r->log->out, simulation);
    print_events(r->log->out, &c);
    step_report_print_largest(r->log->out, &r->so_far.step_report);
    (void)fprintf(r->log->out, "run        %lld steps, %lld rejected, %lld retried, %lld evaluations, %.2f s\n",
                  (long long)c.steps, (long long)c.rejected, (long long)c.retries, (long long)c.evaluations,
                  wall_clock() - r->wall_start);
}

void report_summary(report *r, const dem_simulation *simulation)
{
    const dem_model *model = dem_simulation_model(simulation);
    const dem_energy e = ask_energy(simulation);
    const bool details = r->log->verbose;
    FILE *out = r->log->out;
    run_log_begin(r->log);
    if (ask_sizes(model).n_obstacles > 0)
        rebound_print(out, &r->so_far.rebound, simulation, lattice_facts_diagonal(&r->deck->facts), r->rest != NULL);
    warn_touching(r);
    if (details) rebound_print_details(out, &r->so_far.rebound, simulation);
    if (details) print_strain(r);
    print_peaks(r, model);
    if (details) print_energies(r, e);
    if (details)
        print_ledger(r, e);
    else
        print_balance(r, e);
    fracture_report_print(out, &r->so_far.fracture_report, simulation);
    print_obstacles(out, simulation, details);
    print_boundaries(out, simulation, details);
    surface_report_print_nearest(out, &r->so_far.surface_report);
    if (details) print_counts(r, simulation);
    (void)fflush(out);
}
