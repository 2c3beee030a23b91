/* SPDX-License-Identifier: BSD-3-Clause */
#include "preview.h"

#include <gsl/gsl_version.h>
#include <math.h>
#include <string.h>

#include "ask.h"
#include "commit.h"
#include "doubts.h"
#include "estimate.h"
#include "loading.h"
#include "looks.h"
#include "memory.h"
#include "relaxation.h"
#include "step_report.h"
#include "surface_report.h"
#include "wall_clock.h"

enum { most_listed = 16 };            /* obstacles, bodies */
enum { most_in_short = 2 };           /* bodies, of which the constants are listed without details */
enum { most_measured = 1000 * 1000 }; /* nodes: 5 s of work where lattices are regular */

static bool has_friction(const dem_obstacle *o)
{
    return o->friction_law == DEM_FRICTION_PAPER ? o->friction < 1.0 : o->friction > 0.0;
}

static void print_friction(FILE *out, const dem_model *model)
{
    const dem_index n = ask_sizes(model).n_obstacles;
    dem_index n_rough = 0;
    for (dem_index o = 0; o < n; o++) {
        const dem_obstacle *obstacle = dem_model_obstacle(model, o);
        if (!has_friction(obstacle) || ++n_rough > most_listed) continue;
        (void)fprintf(out, "friction   obstacle %lld: %g (%s)\n", (long long)o + 1, obstacle->friction,
                      obstacle->friction_law == DEM_FRICTION_PAPER ? "paper" : "Coulomb");
    }
    if (n_rough > most_listed) (void)fprintf(out, "friction   on %lld obstacles in all\n", (long long)n_rough);
}

/* How an obstacle moves. */
static void print_fields(FILE *out, const dem_obstacle *obstacle)
{
    const char *before = "";
    const dem_motion_field *field;
    for (dem_index k = 0; (field = dem_motion_field_at(k)) != NULL; k++) {
        const double *value = (const double *)(const void *)((const char *)obstacle + field->offset);
        if (!dem_obstacle_moves(obstacle, field)) continue;
        (void)fprintf(out, "%s %s ", before, field->name);
        (void)(field->n == 1 ? fprintf(out, "%g %s", value[0], field->unit)
                             : fprintf(out, "(%g, %g) %s", value[0], value[1], field->unit));
        before = ",";
    }
}

static void print_motion(FILE *out, const dem_model *model)
{
    const dem_index n = ask_sizes(model).n_obstacles;
    dem_index n_moving = 0;
    for (dem_index o = 0; o < n; o++) {
        const dem_obstacle *obstacle = dem_model_obstacle(model, o);
        if (!dem_obstacle_moves(obstacle, NULL) || ++n_moving > most_listed) continue;
        (void)fprintf(out, "motion     obstacle %lld:", (long long)o + 1);
        print_fields(out, obstacle);
        (void)fputs("\n", out);
    }
    if (n_moving > most_listed) (void)fprintf(out, "motion     of %lld obstacles in all\n", (long long)n_moving);
}

static void print_damping(FILE *out, double of_masses, double of_springs)
{
    if (of_masses > 0.0) (void)fprintf(out, "damping    of masses: %g 1/s\n", of_masses);
    if (of_springs > 0.0) (void)fprintf(out, "damping    of springs: %g s\n", of_springs);
}

static void print_impacts(FILE *out, const dem_options *o, const dem_model *model)
{
    const dem_model_size size = ask_sizes(model);
    (void)fprintf(out, "impacts    %s, window %.4g s%s, vertices ", o->contact == DEM_CONTACT_LOCAL ? "local" : "exact",
                  fmax(o->window, 0.0), o->window > 0.0 ? "" : " (each by itself)");
    if (o->vertices)
        (void)fprintf(out, "on: %lld may touch %lld edges\n", (long long)size.n_vertices,
                      (long long)size.n_contact_edges);
    else
        (void)fprintf(out, "off\n");
}

/* In a body accelerations are larger than g, and the rule with them: this reports the least that it asks for. */
static void warn_rest_speed(run_log *log, const dem_options *o)
{
    const double kept_up = sqrt(2.0 * hypot(o->gravity[0], o->gravity[1]) * o->penetration_tolerance);
    if (o->rest_speed > 0.0 && o->rest_speed < kept_up)
        run_log_warn(log,
                     "'rest_speed' %.3g m/s is below sqrt(2 g penetration tolerance) = %.3g m/s and has little or no "
                     "effect: leave it out",
                     o->rest_speed, kept_up);
}

/* How impacts are taken; each by itself unless there is a window. */
static void print_method(FILE *out, const dem_options *o)
{
    const char *name = o->contact == DEM_CONTACT_LOCAL ? "local" : "exact";
    if (o->window > 0.0)
        (void)fprintf(out, "; impacts within %.3g s are taken together ('%s')", o->window, name);
    else
        (void)fprintf(out, "; each impact is taken by itself ('%s')", name);
}

static const char *plural(dem_index n)
{
    return n == 1 ? "" : "s";
}

static void print_contact(FILE *out, const dem_model_size *size, const dem_options *o)
{
    if (size->n_obstacles == 0) {
        (void)fprintf(out, "contact    none: there are no obstacles\n");
        return;
    }
    (void)fprintf(out, "contact    %lld node%s may touch %lld obstacle%s of %lld segment%s",
                  (long long)size->n_contact_nodes, plural(size->n_contact_nodes), (long long)size->n_obstacles,
                  plural(size->n_obstacles), (long long)size->n_segments, plural(size->n_segments));
    print_method(out, o);
    (void)fprintf(out, "\n");
}

/* The mass of all bodies over that of their true shapes; 0 where one of these is not known. */
static double mass_ratio(const deck *d)
{
    double mass = 0.0, true_mass = 0.0;
    for (size_t k = 0; k < d->n_bodies; k++) {
        if (!(d->bodies[k].true_mass > 0.0)) return 0.0;
        mass += (double)(1 + d->bodies[k].further) * d->bodies[k].mass;
        true_mass += (double)(1 + d->bodies[k].further) * d->bodies[k].true_mass;
    }
    return true_mass > 0.0 ? mass / true_mass : 0.0;
}

static void print_sizes(FILE *out, const deck *d, const dem_model *model, const dem_options *o)
{
    const dem_model_size size = ask_sizes(model);
    const double ratio = mass_ratio(d);
    (void)fprintf(out, "lattice    %lld nodes, %lld springs, %lld triangles, %lld bod%s, mass %.6g kg",
                  (long long)size.n_nodes, (long long)size.n_springs, (long long)size.n_triangles,
                  (long long)size.n_bodies, size.n_bodies == 1 ? "y" : "ies", dem_model_mass(model));
    if (ratio > 0.0) (void)fprintf(out, " (%.4f of the true shape)", ratio);
    (void)fprintf(out, ", spacing %.4g m\n", o->spacing);
}

/* What is probed, where at rest. */
static void print_probes(FILE *out, const deck *d)
{
    static const char *const kinds[] = {
        [DEM_PROBE_NODE] = "node", [DEM_PROBE_SPRING] = "spring", [DEM_PROBE_GAUGE] = "gauge from node"};
    for (dem_index k = 0; k < d->n_probes; k++) {
        const dem_probe *p = &d->probes[k];
        (void)fprintf(out, "probe      %s: %s %lld", p->name, kinds[p->kind], (long long)p->number[0]);
        if (p->kind == DEM_PROBE_GAUGE) (void)fprintf(out, " to %lld", (long long)p->number[1]);
        (void)fprintf(out, " at (%.6g, %.6g) m\n", d->probe_places[k][0], d->probe_places[k][1]);
    }
}

/* A body as the log numbers it: by its group in the deck, as copies are alike. */
typedef struct listed_body {
    dem_index number; /* from 0 */
    dem_index first;  /* of the bodies of the model that it stands for */
    bool slice;       /* of a long body */
} listed_body;

/* The first body of the model that is of group k. */
static dem_index first_of(const deck *d, dem_index k)
{
    dem_index n = 0;
    for (dem_index i = 0; i < k; i++) n += 1 + (dem_index)d->bodies[i].further;
    return n;
}

/* Where a lattice file has several bodies, those of the model have numbers of their own. */
static bool has_bodies_of_groups(const deck *d, dem_index n_bodies)
{
    return first_of(d, (dem_index)d->n_bodies) == n_bodies;
}

static listed_body list_body(const deck *d, dem_index n_bodies, dem_index number)
{
    if (!has_bodies_of_groups(d, n_bodies)) return (listed_body){number, number, false};
    return (listed_body){number, first_of(d, number), d->bodies[number].plane == DEM_PLANE_STRAIN};
}

/* The library has those of the plate in plane stress that moves alike: E/(1 - nu^2) and nu/(1 - nu) of a slice. */
static void print_modulus(FILE *out, const dem_constants *c, bool slice)
{
    const double plate = c->poissons_ratio, nu = slice ? plate / (1.0 + plate) : plate;
    const double modulus = slice ? c->youngs_modulus * (1.0 - nu * nu) : c->youngs_modulus;
    (void)fprintf(out, "E %.6g Pa, nu %.5g%s, anisotropy %.4f, waves %.5g and %.5g m/s\n", modulus, nu,
                  slice ? " in plane strain" : "", c->anisotropy, c->longitudinal_speed, c->transverse_speed);
}

/* A rigid body has none. */
static void print_rigid(FILE *out, const lattice_body *body)
{
    const bool x = (body->rigid & DEM_NODE_GUIDE_X) != 0, y = (body->rigid & DEM_NODE_GUIDE_Y) != 0;
    (void)fprintf(out, "none, it is rigid%s\n", x ? " and moves along x" : (y ? " and moves along y" : ""));
}

/* A request for the end ends the measuring after what is being measured. */
static bool is_wanted(const run_log *log)
{
    return log->requests == NULL || log->requests->end == 0;
}

/* As the library measures them, by loading the model. A body that is not listed may still be too fast. */
static void print_body_constants(run_log *log, const deck *d, const dem_model *model, listed_body body)
{
    const bool listed = log->verbose || body.number < most_in_short;
    const lattice_body *known = &d->facts.bodies[body.first];
    dem_constants c = {.struct_size = sizeof c};
    if (listed) (void)fprintf(log->out, "constants  body %lld: ", (long long)body.number + 1);
    if (listed && known->rigid != 0) print_rigid(log->out, known);
    if (known->rigid != 0) return;
    const dem_status status = dem_model_constants(model, body.first, &c);
    if (listed && status != DEM_OK) (void)fprintf(log->out, "not measured: %s\n", dem_status_message());
    if (listed && status == DEM_OK) print_modulus(log->out, &c, body.slice);
    if (status == DEM_OK) doubts_of_speed(log, model, known, body.number, c.longitudinal_speed);
}

static void print_constants(run_log *log, const deck *d, const dem_model *model)
{
    FILE *out = log->out;
    const dem_index n_bodies = ask_sizes(model).n_bodies;
    const dem_index n = has_bodies_of_groups(d, n_bodies) ? (dem_index)d->n_bodies : n_bodies;
    for (dem_index k = 0; k < n && k < most_listed && is_wanted(log); k++)
        print_body_constants(log, d, model, list_body(d, n_bodies, k));
    if (!log->verbose && n > most_in_short)
        (void)fprintf(out, "constants  of %lld more bodies: see --verbose\n", (long long)n - most_in_short);
    else if (n > most_listed)
        (void)fprintf(out, "constants  bodies %d to %lld: not measured\n", (int)most_listed + 1, (long long)n);
}

static void print_frequency(FILE *out, const dem_model *model)
{
    double omega;
    if (dem_model_omega(model, &omega) != DEM_OK)
        (void)fprintf(out, "frequency  not measured: %s\n", dem_status_message());
    else if (omega > 0.0)
        (void)fprintf(out, "frequency  highest %.6g rad/s, the bound is %.3f times that\n", omega,
                      dem_model_omega_max(model) / omega);
}

static void print_measured(run_log *log, const deck *d, const dem_model *model)
{
    FILE *out = log->out;
    const double start = wall_clock();
    const dem_index n = ask_sizes(model).n_nodes;
    if (!d->measure) return;
    if (d->slabs.are_made) {
        (void)fprintf(out, "constants  not measured of a body that ranks have made in slabs\n");
        return;
    }
    if (n > most_measured) {
        (void)fprintf(out, "constants  not measured: %lld nodes, the limit is %d\n", (long long)n, (int)most_measured);
        return;
    }
    print_constants(log, d, model);
    if (log->verbose && is_wanted(log)) print_frequency(out, model);
    if (log->verbose && wall_clock() - start > 1.0)
        (void)fprintf(out, "measured   constants and frequency, in %.1f s\n", wall_clock() - start);
}

static void print_outline(FILE *out, size_t number, const body_facts *b)
{
    const dem_shape_report *s = &b->geometry.report;
    if (s->n_rim == 0) return;
    (void)fprintf(out, "outline    body %zu: smooth, %lld nodes on it, least angle of a triangle %.1f degrees", number,
                  (long long)(s->n_rim - s->n_off), b->least_angle);
    if (s->n_off > 0)
        (void)fprintf(out, "; %lld node%s off it by up to %.3g m, so that triangles stay sound", (long long)s->n_off,
                      s->n_off == 1 ? "" : "s", s->farthest);
    if (s->n_cut > 0)
        (void)fprintf(out, "; %lld corner%s cut off, too sharp for the spacing", (long long)s->n_cut,
                      s->n_cut == 1 ? "" : "s");
    (void)fprintf(out, "\n");
}

/* Of those that are weaker than their material. */
static void print_weak(FILE *out, size_t number, const char *where, const weakness_counts *c)
{
    if (c->n_triangles + c->n_springs == 0) return;
    (void)fprintf(out, "%-10s body %zu: of ", where, number);
    if (c->n_triangles > 0) (void)fprintf(out, "%lld triangles", (long long)c->n_triangles);
    if (c->n_triangles > 0 && c->n_springs > 0) (void)fprintf(out, ", ");
    if (c->n_springs > 0) (void)fprintf(out, "%lld springs", (long long)c->n_springs);
    (void)fprintf(out, "\n");
}

/* Numbered from 1, as decks are. */
static void print_body(FILE *out, size_t number, const body_facts *b)
{
    if (b->further > 0)
        (void)fprintf(out, "copies     body %zu: %zu; of each holds what follows\n", number, 1 + b->further);
    if (b->true_mass > 0.0)
        (void)fprintf(out, "mass       body %zu: %.6g kg, of the true shape %.6g kg (ratio %.4f)\n", number, b->mass,
                      b->true_mass, b->mass / b->true_mass);
    print_outline(out, number, b);
    if (b->geometry.n_pores > 0)
        (void)fprintf(out, "pores      body %zu: %zu, of porosity %.4f\n", number, b->geometry.n_pores,
                      b->geometry.pore_area / (b->geometry.area + b->geometry.pore_area));
    if (b->geometry.n_inclusions > 0)
        (void)fprintf(out, "inclusions body %zu: %zu, of %lld triangles\n", number, b->geometry.n_inclusions,
                      (long long)b->n_included);
    if (b->geometry.n_cracked > 0)
        (void)fprintf(out, "cracks     body %zu: through %lld triangles, which are taken away\n", number,
                      (long long)b->geometry.n_cracked);
    print_weak(out, number, "weaknesses", &b->weak.weaknesses);
    print_weak(out, number, "interfaces", &b->weak.interfaces);
}

static void print_range(FILE *out, size_t number, const char *what, const strengths_range *r, const char *limit)
{
    if (r->n == 0) return;
    (void)fprintf(out, "strengths  body %zu: of %lld %s, from %.4g to %.4g%s", number, (long long)r->n, what, r->least,
                  r->most, strcmp(limit, "strength") == 0 ? " Pa" : "");
    if (r->n_raised > 0)
        (void)fprintf(out, "; %lld drawn below are raised to %g of '%s'", (long long)r->n_raised, STRENGTHS_LEAST,
                      limit);
    (void)fprintf(out, "\n");
}

/* Where the weakest is far below the others, or has been raised, is no matter of details. */
static void print_strengths(FILE *out, size_t number, const strengths *s)
{
    print_range(out, number, "triangles", &s->triangles, "strength");
    print_range(out, number, "springs", &s->springs, "critical_stretch");
}

/* What a deck does not ask for, and so the short log has it too. */
static void print_loose(FILE *out, size_t number, const body_facts *b)
{
    char list[PARTS_LIST];
    parts_print(list, &b->loose, b->true_mass > 0.0 ? "triangle" : "node");
    if (b->loose.n > 0)
        (void)fprintf(out, "parts      body %zu: %lld %s, of %s m in its own coordinates\n", number,
                      (long long)b->loose.n, b->removed ? "removed" : "apart from the largest", list);
    if (b->hinges.n > 0)
        (void)fprintf(out, "hinges     body %zu: %lld node%s between triangles that share no edge, one at (%g, %g) m\n",
                      number, (long long)b->hinges.n, b->hinges.n == 1 ? "" : "s", b->hinges.x[0], b->hinges.x[1]);
}

static void print_bodies(FILE *out, const deck *d, bool details)
{
    for (size_t k = 0; k < d->n_bodies && k < most_listed; k++) {
        if (details) print_body(out, k + 1, &d->bodies[k]);
        print_loose(out, k + 1, &d->bodies[k]);
        print_strengths(out, k + 1, &d->bodies[k].strengths);
    }
    if (details && d->n_bodies > most_listed)
        (void)fprintf(out, "bodies     of %zu the first %d are listed\n", d->n_bodies, most_listed);
}

/* Where a quasi-static run will end is not known, only about. */
static void print_time(FILE *out, const deck *d, const dem_simulation *simulation, double end, const estimate *e)
{
    char until[96];
    if (d->residual > 0.0)
        (void)snprintf(until, sizeof until, "at rest at about %.2g s, t_end %.6g s:", end, d->t_end);
    else
        (void)snprintf(until, sizeof until, "t_end %.6g s, at least", d->t_end);
    step_report_print(out, until, e->steps, e->undamped, simulation);
}

static void print_output(FILE *out, const char *path, const estimate *e)
{
    (void)fprintf(out, "output     %s%s%.0f frame%s, about %.3g MB\n", path != NULL ? path : "",
                  path != NULL ? ": " : "", e->frames, e->frames == 1.0 ? "" : "s", 1e-6 * e->output);
}

/* What the size has made rarer, though the deck does not say so, is in the short log too. */
static void print_looks(const run_log *log, const deck *d)
{
    const schema_instance *output = schema_get(&d->groups, "output", 0);
    const bool rows = d->history_interval > 0.0 && !schema_given(output, "history_interval");
    const bool peaks = d->peak_every > LOOKS_FEW_STEPS && !schema_given(output, "peak_every");
    if (!log->verbose && !rows && !peaks) return;
    if (d->history_interval > 0.0)
        (void)fprintf(log->out, "looks      rows of /history %.4g s apart%s, for peaks ", d->history_interval,
                      rows ? " by size ('history_interval' sets it)" : "");
    else
        (void)fprintf(log->out, "looks      a row of /history each step, for peaks ");
    if (d->peak_every > 0)
        (void)fprintf(log->out, "every %lld steps%s\n", (long long)d->peak_every,
                      peaks ? " by size ('peak_every' sets it)" : "");
    else
        (void)fprintf(log->out, "never\n");
}

/* All that is set up by now: a run takes no more, but for what HDF5 buffers. */
static void print_memory(FILE *out, const dem_simulation *simulation)
{
    const double bytes = memory_in_use();
    const dem_index n_nodes = ask_sizes(dem_simulation_model(simulation)).n_nodes;
    if (bytes > 0.0)
        (void)fprintf(out, "memory     at most %.4g MB, %.4g bytes a node\n", 1e-6 * bytes, bytes / (double)n_nodes);
}

/* The force of a boundary over its nodes, N; of one that is moved what stands in the deck. */
static double share_of(const dem_boundary *b)
{
    double share = b->share == NULL;
    for (dem_index k = 0; k < b->n_nodes && b->share != NULL; k++) share += b->share[k];
    return share;
}

/* Whether a traction asks for another force than the lattice's side gives; the ratio is given over asked. */
static bool is_off(const deck *d, dem_index k, double asked[2], double *ratio)
{
    const dem_boundary *b = &d->boundaries[k];
    if (!loading_asked(asked, &d->groups, (size_t)k)) return false;
    *ratio = share_of(b) * hypot(b->value[0], b->value[1]) / hypot(asked[0], asked[1]);
    return fabs(*ratio - 1.0) > 1e-3;
}

static void print_asked(FILE *out, const deck *d, dem_index k)
{
    double asked[2], ratio;
    if (is_off(d, k, asked, &ratio))
        (void)fprintf(out, ", of (%g, %g) N asked for: the side of the lattice is %.2f %% %s than that of the shape",
                      asked[0], asked[1], 100.0 * fabs(ratio - 1.0), ratio < 1.0 ? "shorter" : "longer");
}

static void print_boundary(FILE *out, const deck *d, dem_index number)
{
    const dem_boundary *b = &d->boundaries[number - 1];
    static const char *const kinds[] = {[DEM_BOUNDARY_VELOCITY] = "velocity",
                                        [DEM_BOUNDARY_DISPLACEMENT] = "displacement",
                                        [DEM_BOUNDARY_FORCE] = "force"};
    static const char *const units[] = {"m/s", "m", "N"};
    static const char *const axes[] = {"", " x", " y", " x and y"};
    const double share = share_of(b);
    (void)fprintf(out, "boundary   %lld: %lld node%s, ", (long long)number, (long long)b->n_nodes, plural(b->n_nodes));
    if (b->kind != DEM_BOUNDARY_FORCE && b->value[0] == 0.0 && b->value[1] == 0.0)
        (void)fprintf(out, "held in%s", axes[b->components & 3]);
    else
        (void)fprintf(out, "%s%s (%g, %g) %s", kinds[b->kind],
                      b->kind == DEM_BOUNDARY_FORCE ? "" : axes[b->components & 3], share * b->value[0],
                      share * b->value[1], units[b->kind]);
    if (b->ramp > 0.0) (void)fprintf(out, " within %g s", b->ramp);
    print_asked(out, d, number - 1);
    (void)fprintf(out, "\n");
}

void preview_versions(char *text, size_t size)
{
    (void)snprintf(text, size, "dem %s (%s), compiler %s, SUNDIALS %s, HDF5 %s, GSL %s", dem_version(), DEM_COMMIT,
                   __VERSION__, dem_version_sundials(), dem_version_hdf5(), GSL_VERSION);
}

/* A load that is not the one asked for is in the short log too. */
static void print_boundaries(FILE *out, const deck *d, bool details)
{
    double asked[2], ratio;
    for (dem_index k = 0; k < d->n_boundaries && k < most_listed; k++)
        if (details || is_off(d, k, asked, &ratio)) print_boundary(out, d, k + 1);
}

/* What the deck itself says of contact and damping. */
static void print_rules(FILE *out, const deck *d, const dem_simulation *simulation)
{
    const dem_model *model = dem_simulation_model(simulation);
    const dem_options o = ask_options(simulation);
    const dem_model_size size = ask_sizes(model);
    print_contact(out, &size, &o);
    print_friction(out, model);
    print_motion(out, model);
    print_damping(out, o.mass_damping, d->facts.damping_time);
}

static void print_details(FILE *out, const deck *d, const dem_simulation *simulation)
{
    const dem_model *model = dem_simulation_model(simulation);
    const dem_options o = ask_options(simulation);
    print_probes(out, d);
    print_impacts(out, &o, model);
    (void)fprintf(out,
                  "scales     spacing %.6g m, omega_max %.6g rad/s (upper bound), v_scale %.6g m/s, penetration "
                  "tolerance %.3g m\n",
                  o.spacing, dem_model_omega_max(model), o.v_scale, o.penetration_tolerance);
    step_report_print_details(out, simulation);
    print_memory(out, simulation);
}

static void print_title(const run_log *log, const deck *d)
{
    char versions[256];
    preview_versions(versions, sizeof versions);
    if (log->verbose) (void)fprintf(log->out, "%s\n", versions);
    (void)fprintf(log->out, "deck       %s%s%s", d->path, d->title[0] != '\0' ? ": " : "", d->title);
    if (log->verbose) (void)fprintf(log->out, ", problem %016llx", (unsigned long long)d->hash);
    (void)fprintf(log->out, "\n");
}

void preview_print(run_log *log, const deck *d, const dem_simulation *simulation, const char *output)
{
    const dem_model *model = dem_simulation_model(simulation);
    const dem_options o = ask_options(simulation);
    const double expected =
        d->residual > 0.0 ? relaxation_expected(simulation, &d->facts, &d->options, d->residual) : d->t_end;
    const estimate needed = estimate_run(d, simulation, fmin(expected, d->t_end));
    print_title(log, d);
    print_sizes(log->out, d, model, &o);
    print_bodies(log->out, d, log->verbose);
    if (log->verbose) print_rules(log->out, d, simulation);
    print_boundaries(log->out, d, log->verbose);
    if (log->verbose) surface_report_print(log->out, simulation);
    print_measured(log, d, model);
    print_time(log->out, d, simulation, fmin(expected, d->t_end), &needed);
    doubts_of_lattices(log, d);
    doubts_of_rigid(log, d);
    doubts_of_surfaces(log, d, simulation);
    doubts_of_pieces(log, d, simulation);
    warn_rest_speed(log, &o);
    doubts_of_step(log, simulation);
    doubts_of_overlap(log, simulation);
    doubts_of_pressing(log, simulation);
    if (log->verbose) print_details(log->out, d, simulation);
    print_looks(log, d);
    print_output(log->out, output, &needed);
}
