/* SPDX-License-Identifier: BSD-3-Clause */
/* A few nodes with springs and triangles among obstacles, both methods of contact, all laws. Wherever it ends, nodes
 * are not deep in obstacles, the ledger closes, nothing is given energy, and there is an end: a storm of impacts and a
 * step that is too small are legal ones. */
#include <dem/dem.h>

#include "bytes.h"
#include "harness/motion.h"
#include "polygon.h"

enum { MOST_NODES = 6, MOST_SPRINGS = 15, MOST_POINTS = 8, MOST_OBSTACLES = 3, MOST_STEPS = 150 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

typedef struct scene {
    dem_lattice body;
    double x[2 * MOST_NODES], velocity[2 * MOST_NODES], mass[MOST_NODES];
    unsigned char flags[MOST_NODES];
    dem_index ends[2 * MOST_SPRINGS], triangles[12];
    double rest_length[MOST_SPRINGS], stiffness[MOST_SPRINGS], viscosity[MOST_SPRINGS];
    dem_index n_obstacles;
    dem_obstacle obstacles[MOST_OBSTACLES];
    double points[MOST_OBSTACLES][2 * MOST_POINTS];
    dem_boundary boundary;
    dem_index pulled;
    dem_options options;
} scene;

/* ---- obstacles ---- */

/* Star-shaped about a point: a room, counter-clockwise, or a block, clockwise. */
static dem_index put_star(bytes *from, double *points, const double *at, double radius, double sense)
{
    const dem_index n = 3 + bytes_below(from, MOST_POINTS - 3);
    for (dem_index k = 0; k < n; k++) {
        const double angle = sense * 6.283185307179586 * (double)k / (double)n,
                     r = bytes_between(from, 0.6, 1.4) * radius;
        points[2 * k] = at[0] + r * cos(angle);
        points[2 * k + 1] = at[1] + r * sin(angle);
    }
    memcpy(points + 2 * n, points, 2 * sizeof *points);
    return n + 1;
}

/* Of few numbers, since what is exact and what is equal makes the hard cases. */
static double choose(bytes *from, const double *list, unsigned n)
{
    const unsigned choice = bytes_take(from);
    return choice < 192 ? list[choice % n] : bytes_between(from, list[0], list[n - 1]);
}

static void add_obstacle(bytes *from, scene *sc, dem_index n_points)
{
    static const double restitutions[] = {0.0, 0.5, 0.9, 1.0}, frictions[] = {0.0, 0.3, 1.0};
    dem_obstacle *o = &sc->obstacles[sc->n_obstacles];
    *o = (dem_obstacle){
        .struct_size = sizeof(dem_obstacle), .n_points = n_points, .points = sc->points[sc->n_obstacles]};
    o->restitution = choose(from, restitutions, 4);
    o->friction = choose(from, frictions, 3);
    o->friction_law = bytes_below(from, 4) == 1 ? DEM_FRICTION_PAPER : DEM_FRICTION_COULOMB;
    sc->n_obstacles++;
}

/* A room round the body, blocks in it, a wall somewhere. */
static void put_obstacles(bytes *from, scene *sc)
{
    const unsigned choice = bytes_take(from);
    const double middle[2] = {0.01, 0.005};
    if (choice % 2 == 0)
        add_obstacle(from, sc,
                     put_star(from, sc->points[sc->n_obstacles], middle, bytes_between(from, 0.02, 0.06), 1.0));
    if (choice % 4 >= 2) {
        const double at[2] = {bytes_between(from, -0.05, 0.07), bytes_between(from, -0.05, 0.05)};
        add_obstacle(from, sc, put_star(from, sc->points[sc->n_obstacles], at, bytes_between(from, 0.002, 0.03), -1.0));
    }
    if (choice % 8 >= 4) {
        const dem_index n = 2 + bytes_below(from, 3);
        for (dem_index k = 0; k < 2 * n; k++) sc->points[sc->n_obstacles][k] = bytes_between(from, -0.05, 0.07);
        add_obstacle(from, sc, n);
    }
}

/* ---- body ---- */

static void put_nodes(bytes *from, scene *sc)
{
    const unsigned way = bytes_take(from);
    const double speed = way < 128 ? 2.0 : 0.0;
    sc->body.n_nodes = 1 + way % MOST_NODES;
    for (dem_index i = 0; i < sc->body.n_nodes; i++) {
        sc->x[2 * i] = 0.01 * (double)(i % 3);
        sc->x[2 * i + 1] = 0.01 * (double)(i / 3);
        for (int c = 0; c < 2 && way % 3 == 0; c++) sc->x[2 * i + c] += bytes_between(from, -0.004, 0.004);
        for (int c = 0; c < 2; c++) sc->velocity[2 * i + c] = bytes_between(from, -speed, speed);
        sc->mass[i] = bytes_between(from, 0.001, 0.1);
        sc->flags[i] = bytes_take(from) < 16 ? DEM_NODE_FIXED : DEM_NODE_CONTACT;
    }
}

/* Any two nodes may be joined. */
static void put_springs(bytes *from, scene *sc)
{
    uint16_t which;
    unsigned pair = 0;
    bytes_copy(from, &which, sizeof which);
    const double stiffness = bytes_between(from, 1.0, 1e3), damping = bytes_below(from, 4) == 1 ? 1e-5 : 0.0;
    for (dem_index i = 0; i < sc->body.n_nodes; i++)
        for (dem_index j = 0; j < i; j++) {
            if ((which >> pair++ & 1) == 0) continue;
            const dem_index k = sc->body.n_springs++;
            sc->ends[2 * k] = i;
            sc->ends[2 * k + 1] = j;
            sc->rest_length[k] = hypot(sc->x[2 * i] - sc->x[2 * j], sc->x[2 * i + 1] - sc->x[2 * j + 1]);
            if (which % 8 == 1) sc->rest_length[k] *= bytes_between(from, 0.7, 1.3);
            sc->stiffness[k] = stiffness;
            sc->viscosity[k] = damping * stiffness;
        }
}

static void put_triangles(bytes *from, scene *sc)
{
    static const dem_index corners[4][3] = {{0, 1, 3}, {1, 4, 3}, {1, 2, 4}, {2, 5, 4}};
    const unsigned which = bytes_below(from, 16);
    for (int k = 0; k < 4; k++) {
        const dem_index *c = corners[k];
        if ((which >> k & 1) == 0 || c[0] >= sc->body.n_nodes || c[1] >= sc->body.n_nodes || c[2] >= sc->body.n_nodes)
            continue;
        memcpy(sc->triangles + 3 * sc->body.n_triangles++, c, sizeof corners[k]);
    }
}

static void put_body(bytes *from, scene *sc)
{
    sc->body = dem_lattice_empty();
    put_nodes(from, sc);
    put_springs(from, sc);
    put_triangles(from, sc);
    sc->body.x = sc->x;
    sc->body.velocity = sc->velocity;
    sc->body.mass = sc->mass;
    sc->body.ends = sc->ends;
    sc->body.rest_length = sc->rest_length;
    sc->body.stiffness = sc->stiffness;
    sc->body.viscosity = sc->viscosity;
    if (sc->body.n_triangles > 0) sc->body.triangles = sc->triangles;
    if (bytes_below(from, 4) == 1) sc->body.flags = sc->flags;
}

/* ---- options ---- */

/* Beyond the last resorts that are there for long runs, storms come soon. */
static void put_options(bytes *from, scene *sc)
{
    static const dem_method methods[] = {DEM_METHOD_FEHLBERG45, DEM_METHOD_DOPRI45, DEM_METHOD_BS23, DEM_METHOD_VERLET};
    static const double tolerances[] = {1e-6, 1e-8, 1e-10}, damping[] = {0.0, 0.0, 100.0};
    dem_options *o = &sc->options;
    *o = dem_options_default();
    o->contact = bytes_below(from, 2) ? DEM_CONTACT_EXACT : DEM_CONTACT_LOCAL;
    o->method = methods[bytes_below(from, 4)];
    o->rtol = choose(from, tolerances, 3);
    o->gravity[0] = bytes_between(from, -10.0, 10.0);
    o->gravity[1] = bytes_between(from, -20.0, 10.0);
    o->mass_damping = choose(from, damping, 3);
    o->vertices = bytes_below(from, 8) != 1;
    o->max_impacts = 500;
    if (bytes_below(from, 4) == 1) o->window = bytes_between(from, 0.0, 1e-4);
    if (bytes_below(from, 4) == 1) o->rest_speed = bytes_between(from, 1e-6, 1e-1);
    if (bytes_below(from, 8) == 1) o->penetration_tolerance = bytes_between(from, 1e-9, 1e-6);
}

/* A node that is pulled. */
static void put_boundary(bytes *from, scene *sc)
{
    if (bytes_below(from, 8) != 1) return;
    sc->pulled = bytes_below(from, (unsigned)sc->body.n_nodes);
    sc->boundary = (dem_boundary){.struct_size = sizeof(dem_boundary),
                                  .kind = DEM_BOUNDARY_FORCE,
                                  .components = DEM_COMPONENT_X | DEM_COMPONENT_Y,
                                  .n_nodes = 1,
                                  .nodes = &sc->pulled,
                                  .value = {bytes_between(from, -1.0, 1.0), bytes_between(from, -1.0, 1.0)},
                                  .ramp = bytes_below(from, 2) ? 1e-3 : 0.0};
    sc->options.n_boundaries = 1;
    sc->options.boundaries = &sc->boundary;
}

/* ---- what must hold ---- */

typedef struct judge {
    const scene *scene;
    double deepest, error; /* m; share of the energy that may be wrong */
    double start, most;    /* J, the ledger at first, and the largest of its sums so far */
    long steps;
    int adaptive, round; /* nodes have passed an end of a wall: they may be behind it */
} judge;

/* m, in a block or out of a room; walls have no inside. */
static double depth(const dem_obstacle *o, const double *x)
{
    const double *last = o->points + 2 * o->n_points - 2;
    if (o->points[0] != last[0] || o->points[1] != last[1]) return 0.0;
    const int room = polygon_is_left(o->points, o->n_points), inside = polygon_has(o->points, o->n_points, x);
    return inside != room ? polygon_to_line(o->points, o->n_points, x) : 0.0;
}

static void check_depth(const judge *j, const dem_simulation *simulation, const motion *state)
{
    const dem_lattice *body = dem_model_lattice(dem_simulation_model(simulation));
    for (dem_index i = 0; i < body->n_nodes && !j->round; i++)
        for (dem_index k = 0; k < j->scene->n_obstacles && (body->flags[i] & DEM_NODE_CONTACT); k++)
            require(depth(&j->scene->obstacles[k], state->x + 2 * i) <= j->deepest);
}

/* 2e-3 is what the bodies of the paper are asked to hold; springs that nodes are pressed through have corners. */
static void check_energy(judge *j, dem_energy e)
{
    const double taken = e.impact + e.friction + e.damping, open = e.ledger - j->start;
    j->most = fmax(j->most, e.motion - 2.0 * fmin(e.area, 0.0) + fabs(e.gravity) + taken + fabs(e.boundary));
    require(isfinite(open) && isfinite(taken));
    require(fmin(e.impact, fmin(e.friction, e.damping)) >= -j->error * j->most);
    require(!j->adaptive || fabs(open) <= 2e-2 * j->most);
}

static dem_status look(void *context, const dem_simulation *simulation)
{
    judge *j = context;
    motion state;
    motion_see(simulation, &state);
    for (dem_index k = 0; k < 2 * j->scene->body.n_nodes; k++) require(isfinite(state.x[k]) && isfinite(state.v[k]));
    j->round |= ask_counts(simulation).behind > 0;
    check_depth(j, simulation, &state);
    check_energy(j, state.energy);
    return ++j->steps < MOST_STEPS ? DEM_OK : DEM_STOPPED;
}

/* What an impact gave is judged by the energy of the nodes that hit, at their speed and at the run's. */
static dem_status weigh(void *context, const dem_simulation *simulation, const dem_event *e)
{
    const judge *j = context;
    const double scale = ask_options(simulation).v_scale;
    const double m = j->scene->mass[e->node] + (e->other >= 0 ? j->scene->mass[e->other] : 0.0);
    const double before = e->before[0] * e->before[0] + e->before[1] * e->before[1];
    require(fabs(hypot(e->normal[0], e->normal[1]) - 1.0) < 1e-9);
    require(e->kind != DEM_EVENT_IMPACT || e->energy >= -1e-11 * 0.5 * m * (before + scale * scale));
    return DEM_OK;
}

/* An accepted state is as deep as the penetration tolerance and what rounding adds, an interpolated one as far off as
 * the method is; in fixed steps that is not controlled. A contact that turns back twice within a step may rub the
 * wrong way between. */
static judge make_judge(const scene *sc, const dem_simulation *simulation)
{
    const dem_options o = ask_options(simulation);
    dem_method_traits traits = {.struct_size = sizeof traits};
    require(dem_method_describe(&traits, o.method) == DEM_OK);
    return (judge){.scene = sc,
                   .deepest = 5.0 * o.penetration_tolerance + (traits.adaptive ? 0.0 : 1e-2 * o.spacing),
                   .error = traits.adaptive ? 1e-4 : 1e-2,
                   .start = ask_energy(simulation).ledger,
                   .adaptive = traits.adaptive};
}

static void run(const scene *sc, dem_simulation *simulation)
{
    const dem_options o = ask_options(simulation);
    judge j = make_judge(sc, simulation);
    const dem_observer observer = {.struct_size = sizeof(dem_observer), .step = look, .event = weigh, .context = &j};
    require(dem_simulation_observe(simulation, &observer) == DEM_OK);
    const dem_status status = dem_simulation_advance(simulation, 0.1);
    require(status == DEM_OK || status == DEM_STOPPED || status == DEM_ERROR_CONTACT || status == DEM_ERROR_INTEGRATOR);
    if (status == DEM_OK) j.deepest += 10.0 * o.rtol * o.spacing;
    (void)look(&j, simulation);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    bytes from = {data, size};
    scene sc = {0};
    dem_model *model = NULL;
    dem_simulation *simulation = NULL;
    put_options(&from, &sc);
    put_body(&from, &sc);
    put_obstacles(&from, &sc);
    put_boundary(&from, &sc);
    if (sc.body.n_springs == 0) sc.options.spacing = 0.01, sc.options.max_step = 2e-4;
    dem_status status = dem_model_create(&model, &sc.body, sc.obstacles, sc.n_obstacles);
    require(status == DEM_OK || status == DEM_ERROR_MODEL);
    if (status == DEM_OK) status = dem_simulation_create(&simulation, model, &sc.options);
    require(status == DEM_OK || status == DEM_ERROR_MODEL || status == DEM_ERROR_ARGUMENT);
    if (status == DEM_OK) run(&sc, simulation);
    dem_simulation_destroy(simulation);
    dem_model_destroy(model);
    return 0;
}
