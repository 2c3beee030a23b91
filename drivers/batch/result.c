/* SPDX-License-Identifier: BSD-3-Clause */
#include "result.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <dem/checkpoint.h>

#include "ask.h"
#include "base/file.h"
#include "base/peak_source.h"
#include "json.h"
#include "output.h"
#include "preview.h"

enum { MOST_LINE = 64 << 20 }; /* bytes: obstacles and boundaries are listed */

static const char done[] = "done", overlapped[] = "overlapped"; /* both complete */

static const char *status_of(const result *r)
{
    if (r->outcome->code == EXIT_STOPPED) return "stopped";
    if (r->outcome->code != EXIT_DONE) return "failed";
    return r->report != NULL && ask_overlap(r->simulation).node >= 0 ? overlapped : done;
}

/* ---- the fields ---- */

static void write_hash(json *j, const char *key, uint64_t hash)
{
    char text[OUTPUT_HASH];
    output_print_hash(text, hash);
    json_text(j, key, text);
}

static void write_case(json *j, const result *r)
{
    char versions[256];
    preview_versions(versions, sizeof versions);
    json_text(j, "deck", r->deck);
    json_open(j, "set", '[');
    for (size_t k = 0; k < r->command->n_settings; k++) json_text(j, NULL, r->command->settings[k].text);
    json_close(j, ']');
    json_text(j, "name", r->read != NULL ? r->read->name : NULL);
    json_text(j, "output", r->output);
    json_text(j, "status", status_of(r));
    json_integer(j, "exit_code", (int64_t)r->outcome->code);
    json_text(j, "message", r->outcome->message);
    json_text(j, "versions", versions);
    if (r->read == NULL) return;
    json_text(j, "title", r->read->title);
    if (r->read->echo != NULL) write_hash(j, "problem", r->read->hash);
    if (r->read->echo != NULL) write_hash(j, "run", r->read->run_hash);
    json_real(j, "t_end", r->read->t_end);
}

static void write_counts(json *j, const dem_counts *c)
{
    const struct {
        const char *key;
        dem_index n;
    } all[] = {{"steps", c->steps},       {"rejected", c->rejected},
               {"retries", c->retries},   {"evaluations", c->evaluations},
               {"events", c->events},     {"impacts", c->impacts},
               {"early", c->early},       {"vertex_impacts", c->vertex_impacts},
               {"late", c->late},         {"behind", c->behind},
               {"closings", c->closings}, {"releases", c->releases},
               {"slips", c->slips},       {"sticks", c->sticks},
               {"passings", c->passings}, {"crossings", c->crossings}};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) json_integer(j, all[k].key, all[k].n);
}

static void write_contact(json *j, const rebound *r, const dem_progress *now, const dem_simulation *simulation)
{
    const double never = (double)NAN;
    json_integer(j, "contacts", now->n_contacts);
    json_real(j, "first_contact", r->touched ? r->first : never);
    json_real(j, "last_contact", r->touched ? r->last : never);
    json_real(j, "touching_time", r->touched ? r->touching : never);
    json_real(j, "rebound_speed", r->touched ? r->speed : never);
    json_real(j, "rising_speed", rebound_rising_speed(simulation));
}

static void write_rebound(json *j, const rebound *r, const dem_simulation *simulation)
{
    const rebound_normal along = rebound_along(r, simulation);
    if (!rebound_is_over(r)) {
        json_text(j, "rebound", NULL);
        return;
    }
    json_open(j, "rebound", '{');
    json_integer(j, "bounces", r->n_bounces);
    json_reals(j, "approach", r->approach, 2);
    json_reals(j, "velocity", r->velocity, 2);
    json_real(j, "spin", r->spin);
    json_integer(j, "obstacle", r->obstacle);
    json_reals(j, "normal", along.normal, 2);
    json_truth(j, "along_impulse", along.along_impulse);
    json_real(j, "normal_before", along.in);
    json_real(j, "normal_after", along.out);
    json_real(j, "ratio", along.ratio);
    json_close(j, '}');
}

static void write_force(json *j, const rebound *r)
{
    json_open(j, "largest_reaction", '{');
    json_reals(j, "force", r->reaction, 2);
    json_real(j, "t", r->reaction_t);
    json_close(j, '}');
    json_reals(j, "impact_impulse", r->impulse, 2);
}

static void write_energy(json *j, const report *r, const dem_energy *e)
{
    json_open(j, "energy", '{');
    json_real(j, "start", r->so_far.energy_start);
    json_real(j, "largest", r->so_far.energy_max);
    json_real(j, "kinetic", e->kinetic);
    json_real(j, "elastic", e->elastic);
    json_real(j, "area", e->area);
    json_real(j, "guard", e->guard);
    json_real(j, "contact", e->contact);
    json_real(j, "gravity", e->gravity);
    json_real(j, "impact", e->impact);
    json_real(j, "friction", e->friction);
    json_real(j, "damping", e->damping);
    json_real(j, "fracture", e->fracture);
    json_real(j, "projection", e->projection);
    json_real(j, "boundary", e->boundary);
    json_real(j, "obstacle", e->obstacle);
    json_close(j, '}');
    json_real(j, "closure", report_closure(r, *e));
    json_real(j, "elastic_share", r->so_far.elastic_share_max);
    json_real(j, "elastic_share_t", r->so_far.elastic_share_t);
}

static void write_extreme(json *j, const char *key, double strain, dem_index spring, double t)
{
    json_open(j, key, '{');
    json_real(j, "strain", strain);
    json_integer(j, "spring", spring);
    json_real(j, "t", t);
    json_close(j, '}');
}

static void write_strain(json *j, const report *r)
{
    if (r->so_far.strain_min.spring_min >= 0)
        write_extreme(j, "strain_min", r->so_far.strain_min.min, r->so_far.strain_min.spring_min,
                      r->so_far.strain_min_t);
    if (r->so_far.strain_max.spring_max >= 0)
        write_extreme(j, "strain_max", r->so_far.strain_max.max, r->so_far.strain_max.spring_max,
                      r->so_far.strain_max_t);
    json_real(j, "area_min", r->so_far.area_min);
    json_real(j, "area_min_t", r->so_far.area_min_t);
    json_integer(j, "guarded", r->so_far.guarded_max);
    json_integer(j, "inverted", r->so_far.inverted_max);
}

/* Numbered from 0, as all in the files; `null` where neither a boundary nor an obstacle gave a force. */
static void write_load(json *j, const fracture_report_load *load)
{
    if (load->boundary == 0 && load->obstacle == 0) {
        json_text(j, "load", NULL);
        return;
    }
    json_open(j, "load", '{');
    json_reals(j, "force", load->force, 2);
    json_integer(j, load->boundary > 0 ? "boundary" : "obstacle",
                 (load->boundary > 0 ? load->boundary : load->obstacle) - 1);
    json_close(j, '}');
}

/* `null` where nothing has broken. */
static void write_first_break(json *j, const fracture_report *first)
{
    if (first->breaks == 0) {
        json_text(j, "first_break", NULL);
        return;
    }
    json_open(j, "first_break", '{');
    json_real(j, "t", first->first_t);
    json_reals(j, "x", first->first_x, 2);
    write_load(j, &first->load);
    json_close(j, '}');
}

/* `null` where no node was inside an obstacle when it came to the surface. */
static void write_first_buried(json *j, const dem_fracture *broken)
{
    if (broken->buried == 0) {
        json_text(j, "first_buried", NULL);
        return;
    }
    json_open(j, "first_buried", '{');
    json_integer(j, "node", broken->buried_node);
    json_real(j, "t", broken->buried_t);
    json_reals(j, "x", broken->buried_x, 2);
    json_close(j, '}');
}

static void write_broken(json *j, const fracture_report *first, const dem_simulation *simulation)
{
    json_integer(j, "breaks", first->breaks);
    write_first_break(j, first);
    const dem_fracture broken = ask_fracture(simulation);
    json_integer(j, "broken_triangles", broken.triangles);
    json_integer(j, "broken_springs", broken.springs);
    json_integer(j, "fragments", broken.fragments);
    json_real(j, "largest_fragment", broken.largest);
    json_real(j, "debris", broken.debris);
    json_real(j, "median_fragment", broken.median);
    json_real(j, "crack_length", broken.crack_length);
    json_real(j, "crack_energy", ask_crack_energy(simulation));
    json_integer(j, "buried", broken.buried);
    write_first_buried(j, &broken);
}

static void write_node_peak(json *j, const report *r, const dem_model *model)
{
    dem_index n = 1, node;
    dem_node_peak peak;
    if (dem_private_peaks_largest_nodes(r->peaks, &n, &node, &peak) != DEM_OK || n == 0) return;
    json_open(j, "most_stressed", '{');
    json_integer(j, "node", node);
    json_real(j, "von_mises", peak.von_mises);
    json_real(j, "t", peak.t);
    json_reals(j, "stress", peak.stress, 3);
    json_truth(j, "stepped_edge", report_is_stepped(r, model, node));
    json_real(j, "touches", report_touched(r, node) > 0 ? (double)(report_touched(r, node) - 1) : (double)NAN);
    json_close(j, '}');
}

static void write_spring_peak(json *j, const report *r)
{
    dem_index n = 1, spring;
    dem_spring_peak peak;
    if (dem_private_peaks_largest_springs(r->peaks, &n, &spring, &peak) != DEM_OK || n == 0) return;
    write_extreme(j, "most_strained", peak.strain, spring, peak.t);
}

/* Of contact of bodies with each other and with themselves. */
static void write_surfaces(json *j, const surface_report *p, const dem_simulation *simulation)
{
    const double never = (double)NAN;
    json_integer(j, "pairs", ask_surfaces(simulation).pushing);
    json_integer(j, "pairs_most", p->most);
    json_real(j, "gap_min", p->most > 0 ? p->gap : never);
    json_real(j, "gap_min_t", p->most > 0 ? p->gap_t : never);
    json_real(j, "gap_share", p->most > 0 ? p->nearest : never);
    json_real(j, "pressure_share", p->most > 0 ? p->pressure : never);
}

/* Where an obstacle that moves is, and what it does. */
static void write_place(json *j, const dem_obstacle_load *load)
{
    json_reals(j, "displacement", load->displacement, 2);
    json_real(j, "angle", load->angle);
    json_real(j, "power", load->power);
}

static void write_loads(json *j, const dem_simulation *simulation)
{
    const dem_model *model = dem_simulation_model(simulation);
    const dem_index n_obstacles = ask_sizes(model).n_obstacles;
    const dem_index n_boundaries = ask_options(simulation).n_boundaries;
    json_open(j, "obstacles", '[');
    for (dem_index o = 0; o < n_obstacles; o++) {
        const dem_obstacle_load load = ask_obstacle(simulation, o);
        json_open(j, NULL, '{');
        json_reals(j, "impulse", load.impulse, 2);
        json_reals(j, "friction_impulse", load.friction_impulse, 2);
        json_reals(j, "reaction", load.reaction, 2);
        json_integer(j, "contacts", load.n_contacts);
        if (dem_obstacle_moves(dem_model_obstacle(model, o), NULL)) write_place(j, &load);
        json_close(j, '}');
    }
    json_close(j, ']');
    json_open(j, "boundaries", '[');
    for (dem_index k = 0; k < n_boundaries; k++) {
        const dem_boundary_load load = ask_boundary(simulation, k);
        json_open(j, NULL, '{');
        json_reals(j, "force", load.force, 2);
        json_reals(j, "displacement", load.displacement, 2);
        json_close(j, '}');
    }
    json_close(j, ']');
}

/* Numbers of the rigid bodies, from 0. */
static void write_rigid(json *j, const lattice_facts *facts)
{
    json_open(j, "rigid", '[');
    for (dem_index b = 0; b < facts->n_bodies; b++)
        if (facts->bodies[b].rigid != 0) json_integer(j, NULL, b);
    json_close(j, ']');
}

static void write_overlap(json *j, const dem_simulation *simulation)
{
    dem_overlap o = {.struct_size = sizeof o};
    if (dem_simulation_overlap(simulation, &o) != DEM_OK || o.node < 0) return;
    json_open(j, "overlap", '{');
    json_integer(j, "node", o.node);
    json_integer(j, "triangle", o.triangle);
    json_real(j, "t", o.t);
    json_integer(j, "most", o.most);
    json_close(j, '}');
}

static void write_warnings(json *j, const run_log *log)
{
    json_open(j, "warnings", '[');
    for (size_t k = 0; k < log->n_warnings; k++) json_text(j, NULL, log->warnings[k]);
    json_close(j, ']');
}

static void write_run(json *j, const result *r)
{
    const dem_counts counts = ask_counts(r->simulation);
    const dem_progress now = ask_progress(r->simulation);
    write_warnings(j, r->report->log);
    json_real(j, "t", now.t);
    write_counts(j, &counts);
    write_contact(j, &r->report->so_far.rebound, &now, r->simulation);
    write_rebound(j, &r->report->so_far.rebound, r->simulation);
    write_force(j, &r->report->so_far.rebound);
    const dem_energy energy = ask_energy(r->simulation);
    write_energy(j, r->report, &energy);
    write_strain(j, r->report);
    write_broken(j, &r->report->so_far.fracture_report, r->simulation);
    if (r->report->peaks != NULL) write_node_peak(j, r->report, dem_simulation_model(r->simulation));
    if (r->report->peaks != NULL) write_spring_peak(j, r->report);
    write_surfaces(j, &r->report->so_far.surface_report, r->simulation);
    write_loads(j, r->simulation);
    write_rigid(j, &r->read->facts);
    write_overlap(j, r->simulation);
    json_real(j, "history_interval", r->read->history_interval);
    json_integer(j, "peak_every", r->read->peak_every);
    json_real(j, "formula_6", r->report->so_far.step_report.largest);
    json_real(j, "formula_6_t", r->report->so_far.step_report.t);
    if (r->read->residual > 0.0) json_real(j, "residual", r->rest->reached);
    if (r->read->options.pause > 0.0) json_real(j, "ramp_time", dem_simulation_ramp_time(r->simulation));
}

static void write_wall(json *j, const result *r)
{
    char start[32];
    struct tm utc;
    (void)strftime(start, sizeof start, "%Y-%m-%dT%H:%M:%SZ", gmtime_r(&r->start, &utc));
    json_text(j, "wall_start", start);
    json_real(j, "wall_seconds", r->seconds);
}

/* ---- the line ---- */

char *result_line(const result *r)
{
    char *line = NULL;
    size_t size = 0;
    json j = {.out = open_memstream(&line, &size)};
    if (j.out == NULL) return NULL;
    json_open(&j, NULL, '{');
    write_case(&j, r);
    if (r->report != NULL) write_run(&j, r);
    write_wall(&j, r);
    json_close(&j, '}');
    (void)fputc('\n', j.out);
    const bool good = ferror(j.out) == 0;
    if (fclose(j.out) == 0 && good) return line;
    free(line);
    return NULL;
}

static bool write_part(const char *part, const char *line)
{
    FILE *file = fopen(part, "w");
    if (file == NULL) return false;
    const bool written = fputs(line, file) >= 0;
    return fclose(file) == 0 && written;
}

void result_write(const char *path, const char *line, outcome *o)
{
    char part[OUTPUT_PATH + 8];
    (void)snprintf(part, sizeof part, "%s.part", path);
    if (!write_part(part, line)) {
        outcome_fail(o, EXIT_IO, part, "cannot be written (%s)", strerror(errno));
        (void)unlink(part);
        return;
    }
    const dem_status status = dem_publish(part, path);
    if (status != DEM_OK) outcome_fail_status(o, status, path);
}

/* In a JSON text quotes within strings are escaped, so that a field cannot be mistaken. */
static bool has_field(const char *line, const char *key, const char *text)
{
    char field[128];
    (void)snprintf(field, sizeof field, "\"%s\":\"%s\"", key, text);
    return strstr(line, field) != NULL;
}

char *result_read_done(const char *path, const char *run_hash)
{
    char why[FILE_WHY], *line;
    size_t size;
    if (file_read(&line, &size, path, MOST_LINE, why) != FILE_READ) return NULL;
    const bool complete = has_field(line, "status", done) || has_field(line, "status", overlapped);
    if (complete && has_field(line, "run", run_hash)) return line;
    free(line);
    return NULL;
}
