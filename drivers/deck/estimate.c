/* SPDX-License-Identifier: BSD-3-Clause */
#include "estimate.h"

#include <math.h>
#include <stdlib.h>

#include "base/file.h"
#include "body_geometry.h"
#include "image_file.h"
#include "material.h"
#include "ask.h"
#include "body_outline.h"
#include "looks.h"

static const double pi = 3.14159265358979323846, sqrt3 = 1.73205080756887729353;

/* Bytes a node at the least: of a triangulation that is still to be cut, and of a run, whose share is that of what was
 * measured which a system really gives (docs/performance.md). */
static const double of_cover = 16.0 + 2.0 * 24.0, of_verlet = 500.0, of_pairs = 600.0;

static const double giga = 1e9;
static const double joined = 2.0; /* times the output are on disk while its parts are made into one file */

static const double most_nodes = 1e250; /* that are counted: what grows with them stays finite */

/* ---- bodies ---- */

static double area_of_polygon(const schema_value *points)
{
    double twice = 0.0;
    const int n = points->count / 2;
    for (int k = 0; k < n; k++) {
        const double *a = points->reals + 2 * k, *b = points->reals + 2 * ((k + 1) % n);
        twice += a[0] * b[1] - a[1] * b[0];
    }
    return 0.5 * fabs(twice);
}

/* Of a body or a void, m^2. */
static double area_of(const schema_instance *group)
{
    const double *size = schema_reals(group, "size");
    const double radius = schema_real(group, "radius"), inner = schema_real(group, "inner_radius");
    if (schema_is(group, "shape", "polygon")) return area_of_polygon(schema_value_of(group, "points"));
    return size != NULL ? size[0] * size[1] : pi * (radius * radius - inner * inner);
}

/* What its lattice covers before it is cut, m. False where it is unknown. */
static bool find_extent(double size[2], const schema_instance *body, const char *path)
{
    const double *given = schema_reals(body, "size"), diameter = 2.0 * schema_real(body, "radius");
    size[0] = given != NULL ? given[0] : diameter;
    size[1] = given != NULL ? given[1] : diameter;
    if (schema_is(body, "shape", "mask")) return image_file_measure(size, path, schema_real(body, "scale"));
    if (schema_is(body, "shape", "polygon")) {
        double box[4];
        const dem_outline o = body_outline(body);
        if (dem_outline_box(&o, box) != DEM_OK) return false;
        for (int c = 0; c < 2; c++) size[c] = box[c + 2] - box[c];
    }
    return size[0] > 0.0;
}

/* Of its triangles or squares, m^2 for each node. */
static double cell_of(const schema_instance *body)
{
    const double spacing = schema_real(body, "spacing");
    return (body_geometry_has_squares(body) ? 1.0 : 0.5 * sqrt3) * spacing * spacing;
}

/* Of the nodes that its lattice has before it is cut. */
static double count_cover(const double size[2], const schema_instance *body)
{
    const double spacing = schema_real(body, "spacing"), row = cell_of(body) / spacing;
    return (size[0] / spacing + 1.0) * (size[1] / row + 1.0);
}

/* Area that voids and pores take from body k at the most, m^2; they may overlap, or stick out. */
static double area_taken(const schema_deck *groups, size_t k, double area)
{
    double taken = 0.0;
    for (size_t i = 0; i < schema_count(groups, "void"); i++) {
        const schema_instance *hole = schema_get(groups, "void", i);
        if (schema_real(hole, "body") == (double)(k + 1)) taken += area_of(hole);
    }
    for (size_t i = 0; i < schema_count(groups, "pores"); i++) {
        const schema_instance *pores = schema_get(groups, "pores", i);
        const double largest = schema_reals(pores, "radius")[1], number = schema_real(pores, "number");
        if (schema_real(pores, "body") == (double)(k + 1))
            taken += number * pi * largest * largest + schema_real(pores, "porosity") * area;
    }
    return taken;
}

/* omega_max^2 of a body of one material is at least this, 1/s^2, 0 where it is unknown:
 *   omega^2 >= |B_i|/m_i >= tr B_i/(2 m_i) = sum over springs of k_ij/m_i
 * at every node, and each of its triangles or cells gives to both sums. With (8/3) G = (4/3) E/(1 + nu) a triangle has
 * two springs of (8/3) G h sqrt(3)/4 on a third of its mass, a cell two of G h and one of 2 G h diagonal on a
 * quarter of its own; with equal springs of E_ij it has at least one whole one, a cell one of each length. */
static double least_stiffness(const schema_instance *body, const dem_material *m)
{
    const double a = schema_real(body, "spacing"), mass = m->density * m->thickness * a * a;
    const double shear = 0.5 * m->youngs_modulus * m->thickness / (1.0 + m->poissons_ratio);
    const double bond = m->bond_stiffness / a;
    if (!isnormal(a) || !isnormal(mass)) return 0.0; /* the body will be refused */
    if (body_geometry_has_squares(body))
        return 4.0 * (2.0 * shear * (1.0 + schema_real(body, "diagonal")) + 1.7 * bond) / mass;
    return 4.0 * sqrt3 * (4.0 / sqrt3 * shear + bond) / mass;
}

static void add_lattice(estimate *e, const char *path)
{
    dem_index nodes, springs;
    if (dem_lattice_measure(path, &nodes, &springs) != DEM_OK) return;
    e->nodes += (double)nodes;
    e->springs += (double)springs;
}

/* Adds body k.  \param path  of its file; "" without one */
static void add_body(estimate *e, const deck *d, size_t k, const char *path)
{
    const schema_instance *body = schema_get(&d->groups, "body", k);
    const bool drawn = schema_is(body, "shape", "mask"), mesh = schema_is(body, "shape", "mesh");
    double size[2];
    e->memory = fmax(e->memory, mesh ? file_size(path) : 0.0);
    if (schema_is(body, "shape", "file")) add_lattice(e, path);
    if (!isnormal(cell_of(body)) || !find_extent(size, body, path)) return; /* else the body will be refused */
    const double cover = fmin(count_cover(size, body), most_nodes), area = drawn ? 0.0 : area_of(body);
    const double left = fmax(area - area_taken(&d->groups, k, area), 0.0);
    const double nodes = fmin(left / cell_of(body), most_nodes);
    if (cover > e->cover) e->largest = k;
    e->cover = fmax(e->cover, cover);
    e->nodes += nodes;
    e->springs += nodes * (body_geometry_has_squares(body) ? 4.0 : 3.0);
}

/* Of a body and its inclusions. */
static double least_stiffness_of(const deck *d, size_t k)
{
    const schema_instance *body = schema_get(&d->groups, "body", k);
    if (schema_is(body, "shape", "file")) return 0.0;
    dem_material material = material_of(&d->groups, body);
    double least = least_stiffness(body, &material);
    for (size_t i = 0; i < schema_count(&d->groups, "inclusion"); i++) {
        const schema_instance *inclusion = schema_get(&d->groups, "inclusion", i);
        material = material_of(&d->groups, inclusion);
        if (schema_real(inclusion, "body") == (double)(k + 1)) least = fmin(least, least_stiffness(body, &material));
    }
    return least;
}

/* By the defaults of dem_options. */
static double longest_step(const deck *d)
{
    const dem_options *o = &d->options;
    dem_method_traits method = {.struct_size = sizeof method};
    double stiffness = 0.0;
    if (o->fixed_step > 0.0) return o->fixed_step;
    if (o->max_step > 0.0) return o->max_step;
    for (size_t k = 0; k < schema_count(&d->groups, "body"); k++) stiffness = fmax(stiffness, least_stiffness_of(d, k));
    if (dem_method_describe(&method, o->method) != DEM_OK) return (double)INFINITY;
    if (!isnormal(stiffness)) return (double)INFINITY;
    return (method.adaptive ? 0.5 : 0.125 * method.stable) / sqrt(stiffness);
}

/* ---- output ---- */

/* What frames and tables are of. */
typedef struct contents {
    double nodes, springs, bodies, obstacles, boundaries;
    bool may_break; /* what may has all rows of the history (looks.c) */
} contents;

static double frame_bytes(const deck *d, const contents *c)
{
    static const struct {
        uint32_t field;
        double of_node, of_spring; /* numbers */
    } fields[] = {{DEM_FIELD_DISPLACEMENT, 3.0, 0.0}, {DEM_FIELD_VELOCITY, 3.0, 0.0},  {DEM_FIELD_STRESS, 6.0, 0.0},
                  {DEM_FIELD_VON_MISES, 1.0, 0.0},    {DEM_FIELD_PRINCIPAL, 2.0, 0.0}, {DEM_FIELD_STRAIN, 0.0, 1.0},
                  {DEM_FIELD_FORCE, 0.0, 1.0},        {DEM_FIELD_CONTACT, 4.0, 0.0},   {DEM_FIELD_FRAGMENT, 2.0, 0.0},
                  {DEM_FIELD_DAMAGE, 1.0, 0.0}};
    const double width = d->double_precision ? 8.0 : 4.0;
    double of_node = 24.0, of_spring = 1.0;
    for (size_t k = 0; k < sizeof fields / sizeof *fields; k++) {
        if ((d->fields & fields[k].field) == 0) continue;
        of_node += width * fields[k].of_node;
        of_spring += width * fields[k].of_spring;
    }
    return of_node * c->nodes + of_spring * c->springs;
}

/* Tables grow by whole chunks. */
static double table_bytes(double rows, double width)
{
    return 8.0 * width * 1024.0 * ceil(rows / 1024.0);
}

/* Of the history and the probes, in numbers a row. */
static double tables_bytes(const deck *d, const contents *c, double step, double steps)
{
    static const double of_probe[] = {[DEM_PROBE_NODE] = 9.0, [DEM_PROBE_SPRING] = 3.0, [DEM_PROBE_GAUGE] = 3.0};
    const double duration = estimate_duration(d);
    const bool given = d->history_interval >= 0.0;
    const double by_size = looks_row_interval(d->options.method, c->may_break ? 0.0 : c->nodes, step);
    const double interval = given ? d->history_interval : by_size;
    const double rows = interval > 0.0 ? fmin(steps, duration / interval + 2.0) : steps;
    double bytes = table_bytes(rows, 35.0 + 5.0 * c->bodies + 9.0 * c->obstacles + 4.0 * c->boundaries);
    for (dem_index k = 0; k < d->n_probes; k++)
        bytes += table_bytes(steps / (double)d->probes[k].every, of_probe[d->probes[k].kind]);
    return bytes;
}

static void settle(estimate *e, const deck *d, const contents *c, double duration)
{
    e->nodes = c->nodes;
    e->springs = c->springs;
    e->memory = fmax(e->memory, c->nodes * (d->options.method == DEM_METHOD_VERLET ? of_verlet : of_pairs));
    e->steps = ceil(duration / e->step);
    e->frames = floor(duration / d->frame_interval * (1.0 + 1e-9)) + 1.0;
    e->output = e->frames * frame_bytes(d, c) + tables_bytes(d, c, e->step, e->steps);
}

/* ---- all of it ---- */

double estimate_duration(const deck *d)
{
    double last = 0.0;
    if (!(d->residual > 0.0)) return d->t_end;
    for (size_t k = 0; k < schema_count(&d->groups, "boundary"); k++)
        last = fmax(last, schema_real(schema_get(&d->groups, "boundary", k), "ramp"));
    return fmin(last, d->t_end);
}

/* Whatever bodies are of, and without a look at strengths that a lattice file may have. */
static bool names_fracture(const deck *d)
{
    const size_t n = schema_count(&d->groups, "material");
    for (size_t k = 0; k < n; k++)
        if (!schema_is(schema_get(&d->groups, "material", k), "fracture", "none")) return true;
    return false;
}

bool estimate_deck(estimate *out, const deck *d)
{
    estimate e = {.step = longest_step(d)};
    const size_t n = schema_count(&d->groups, "body");
    for (size_t k = 0; k < n; k++) {
        char *path = body_geometry_file(d->folder, schema_get(&d->groups, "body", k));
        if (path == NULL) return false;
        add_body(&e, d, k, path);
        free(path);
    }
    e.memory = fmax(e.memory, of_cover * e.cover);
    const contents c = {.nodes = e.nodes,
                        .springs = e.springs,
                        .bodies = (double)n,
                        .obstacles = (double)schema_count(&d->groups, "obstacle"),
                        .boundaries = (double)schema_count(&d->groups, "boundary"),
                        .may_break = names_fracture(d)};
    settle(&e, d, &c, estimate_duration(d));
    *out = e;
    return true;
}

/* By the defaults of dem_options for bodies without damping; 0 where the deck gives the step. */
static double default_step(const deck *d, const dem_simulation *simulation)
{
    const double omega = dem_model_omega_max(dem_simulation_model(simulation));
    dem_method_traits method = {.struct_size = sizeof method};
    if (d->options.fixed_step > 0.0 || d->options.max_step > 0.0 || !(omega > 0.0)) return 0.0;
    if (dem_method_describe(&method, d->options.method) != DEM_OK) return 0.0;
    return (method.adaptive ? 0.5 : 0.125 * method.stable) / omega;
}

estimate estimate_run(const deck *d, const dem_simulation *simulation, double duration)
{
    const dem_model *model = dem_simulation_model(simulation);
    const dem_model_size size = ask_sizes(model);
    const contents c = {.nodes = (double)size.n_nodes,
                        .springs = (double)size.n_springs,
                        .bodies = (double)size.n_bodies,
                        .obstacles = (double)size.n_obstacles,
                        .boundaries = (double)d->n_boundaries,
                        .may_break = d->facts.may_break};
    estimate e = {.step = ask_options(simulation).max_step};
    const double undamped = default_step(d, simulation);
    if (e.step < undamped * (1.0 - 1e-9)) e.undamped = undamped; /* rounding is no damping */
    settle(&e, d, &c, duration);
    return e;
}

/* ---- what is refused ---- */

static namelist_place place_of(const deck *d, const char *group, size_t k, const char *key)
{
    const schema_instance *instance = schema_get(&d->groups, group, k);
    return schema_given(instance, key) ? schema_place(instance, key) : instance->place;
}

estimate_breach estimate_check(const estimate *needed, const limits *most, const deck *d, namelist_errors *errors)
{
    const double disk = joined * needed->output;
    char damped[100] = "";
    if (needed->undamped > 0.0)
        (void)snprintf(damped, sizeof damped, "; 'damping_time' or 'mass_damping' has shortened the steps from %.3g s",
                       needed->undamped);
    estimate_breach breach = ESTIMATE_KEPT;
    if (disk > most->disk) {
        namelist_errors_add(errors, place_of(d, "output", 0, "frame_interval"),
                            "the output takes about %.3g GB, %.0f frames and %.3g steps until 't_end', twice while it "
                            "is put together; the limit is %.3g GB, and --max-disk sets it%s",
                            needed->output / giga, needed->frames, needed->steps, most->disk / giga, damped);
        breach = ESTIMATE_DISK;
    }
    if (needed->steps > most->steps) {
        namelist_errors_add(errors, place_of(d, "run", 0, "t_end"),
                            "%s, %g s, takes at least %.3g steps of %.3g s; the limit is %.3g, and "
                            "--max-steps sets it%s",
                            d->residual > 0.0 ? "the longest 'ramp' in &boundary" : "'t_end' in &run",
                            estimate_duration(d), needed->steps, needed->step, most->steps, damped);
        breach = ESTIMATE_STEPS;
    }
    if (needed->memory > most->memory) {
        char nodes[40] = "";
        const double n = fmax(needed->nodes, needed->cover);
        if (n > 0.0) (void)snprintf(nodes, sizeof nodes, " for its %.3g nodes", n);
        namelist_errors_add(
            errors, place_of(d, "body", needed->largest, "spacing"),
            "the run takes at least %.3g GB of memory%s; the limit is %.3g GB, and --max-memory sets it",
            needed->memory / giga, nodes, most->memory / giga);
        breach = ESTIMATE_MEMORY;
    }
    namelist_errors_sort(errors);
    return breach;
}
