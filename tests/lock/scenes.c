/* SPDX-License-Identifier: BSD-3-Clause */
/* Random scenes, with boundaries and forces from outside in some, and resumed half-way. */
#include <stdio.h>

#include "cases.h"
#include "digest.h"
#include "kernels.h"
#include "property/field.h"
#include "property/scene.h"
#include "store.h"
#include "ask.h"
#include "trace.h"

enum { NAME = 64, MOST_NODES = 256 };

/* Those of the first in which much happens, after half of the time too. */
static const unsigned long seeds[] = {2, 4, 5, 6, 7, 10, 11, 16, 18, 23, 27, 28, 29, 32, 35, 36, 37, 39, 40, 45};
enum { N_SCENES = sizeof seeds / sizeof *seeds };

static const dem_method methods[] = {DEM_METHOD_FEHLBERG45, DEM_METHOD_VERLET, DEM_METHOD_RK4,     DEM_METHOD_HEUN12,
                                     DEM_METHOD_DOPRI45,    DEM_METHOD_BS23,   DEM_METHOD_VERNER56};
enum { N_METHODS = sizeof methods / sizeof *methods };

typedef struct task {
    unsigned long seed;
    dem_contact_method contact;
} task;

/* How often what scenes are there for has occurred. */
static struct coverage {
    dem_index rubbing, sticks, slips, vertices, viscous, drag, early, prescribed, loaded, outside, resumed;
} seen;

/* What is in a scene besides what scene_random() puts there. */
typedef struct extras {
    field field;
    dem_boundary boundary;
    dem_index nodes[MOST_NODES];
} extras;

/* ---- from a seed to a scene ---- */

/* The nodes within half a spacing of the highest one. */
static void find_top(extras *e, const scene *sc)
{
    const dem_lattice *l = &sc->body;
    double top = l->x[1];
    for (dem_index i = 0; i < l->n_nodes; i++) top = fmax(top, l->x[2 * i + 1]);
    for (dem_index i = 0; i < l->n_nodes; i++)
        if (l->x[2 * i + 1] > top - 0.5 * sc->spacing) {
            assert_true(e->boundary.n_nodes < MOST_NODES);
            e->nodes[e->boundary.n_nodes++] = i;
        }
}

/* By turns none, a velocity, a displacement and a force, of the top. */
static void add_boundary(extras *e, scene *sc, unsigned long seed)
{
    static const dem_boundary kinds[4] = {
        {.struct_size = sizeof(dem_boundary), .n_nodes = 0},
        {.struct_size = sizeof(dem_boundary),
         .kind = DEM_BOUNDARY_VELOCITY,
         .components = DEM_COMPONENT_Y,
         .value = {0.0, -2.0},
         .ramp = 1e-4},
        {.struct_size = sizeof(dem_boundary),
         .kind = DEM_BOUNDARY_DISPLACEMENT,
         .components = 3,
         .value = {2e-3, -2e-3},
         .ramp = 1e-3},
        {.struct_size = sizeof(dem_boundary), .kind = DEM_BOUNDARY_FORCE, .value = {100.0, -1000.0}, .ramp = 2e-4}};
    if (seed % 4 == 0) return;
    e->boundary = kinds[seed % 4];
    find_top(e, sc);
    e->boundary.nodes = e->nodes;
    if (e->boundary.kind != DEM_BOUNDARY_FORCE)
        assert_ok(dem_lattice_exclude(&sc->body, e->nodes, e->boundary.n_nodes));
    sc->options.n_boundaries = 1;
    sc->options.boundaries = &e->boundary;
}

static void make_scene(scene *sc, extras *e, const task *what, dem_kernel kernel)
{
    *e = (extras){.boundary = {.n_nodes = 0}};
    scene_random(sc, what->seed);
    add_boundary(e, sc, what->seed);
    if (what->seed % 5 == 0) {
        field_random(&e->field, sc, what->seed);
        sc->options.force = field_act;
        sc->options.force_context = &e->field;
    }
    sc->options.method = methods[what->seed % N_METHODS];
    sc->options.contact = what->contact;
    sc->options.kernel = kernel;
    if (what->seed % 2 == 0) sc->options.window = 1e-5;
    sc->options.checkpoint_steps = 16;
}

/* ---- runs ---- */

static void look(const scene *sc, const extras *e, const dem_simulation *simulation)
{
    const dem_counts counts = ask_counts(simulation);
    seen.rubbing += ask_energy(simulation).friction > 0.0;
    seen.sticks += counts.sticks;
    seen.slips += counts.slips;
    seen.vertices += counts.vertex_impacts;
    seen.early += counts.early;
    seen.viscous += sc->body.viscosity != NULL;
    seen.drag += sc->options.mass_damping > 0.0;
    seen.prescribed += e->boundary.n_nodes > 0 && e->boundary.kind != DEM_BOUNDARY_FORCE;
    seen.loaded += e->boundary.kind == DEM_BOUNDARY_FORCE;
    seen.outside += sc->options.force != NULL;
}

static uint64_t end_of(const dem_simulation *simulation)
{
    trace t = trace_begin();
    trace_add_all(&t, simulation);
    return t.hash;
}

static uint64_t run_scene(const void *what, dem_kernel kernel)
{
    CLEANUP(scene_free) scene sc;
    extras e;
    CLEANUP(support_close) support_run run;
    trace whole = trace_begin(), rest = trace_begin();
    CLEANUP(free_simulation) dem_simulation *resumed;
    make_scene(&sc, &e, what, kernel);
    const dem_observer first = trace_observer(&whole, sc.t_end / 8.0), second = trace_observer(&rest, sc.t_end / 8.0);
    support_open(&run, &sc.body, sc.obstacles, sc.n, &sc.options);
    assert_ok(dem_simulation_observe(run.simulation, &first));
    assert_ok(dem_simulation_advance(run.simulation, 0.5 * sc.t_end));
    assert_ok(dem_simulation_resume(&resumed, run.model, &sc.options, dem_simulation_checkpoint(run.simulation)));
    assert_ok(dem_simulation_observe(resumed, &second));
    assert_ok(dem_simulation_advance(resumed, sc.t_end));
    assert_ok(dem_simulation_advance(run.simulation, sc.t_end));
    assert_true(end_of(run.simulation) == end_of(resumed));
    trace_add_all(&whole, run.simulation);
    if (kernel == DEM_KERNEL_PORTABLE) look(&sc, &e, run.simulation);
    seen.resumed += kernel == DEM_KERNEL_PORTABLE && rest.n_events > 0;
    return digest_add(whole.hash, &rest.hash, sizeof rest.hash);
}

void cases_scenes(void)
{
    for (int s = 0; s < N_SCENES; s++)
        for (int c = 0; c < 2; c++) {
            char name[NAME];
            const task what = {seeds[s], c == 0 ? DEM_CONTACT_LOCAL : DEM_CONTACT_EXACT};
            (void)snprintf(name, sizeof name, "scene_%02lu.%s", seeds[s], c == 0 ? "local" : "exact");
            kernels_check(name, run_scene, &what);
        }
    print_message(
        "# sliding %lld, sticks %lld, slips %lld, vertices %lld, viscous %lld, drag %lld, taken together %lld, "
        "prescribed %lld, loaded %lld, forces from outside %lld, events after a resume %lld\n",
        (long long)seen.rubbing, (long long)seen.sticks, (long long)seen.slips, (long long)seen.vertices,
        (long long)seen.viscous, (long long)seen.drag, (long long)seen.early, (long long)seen.prescribed,
        (long long)seen.loaded, (long long)seen.outside, (long long)seen.resumed);
    assert_true(seen.rubbing > 0 && seen.sticks > 0 && seen.slips > 0 && seen.vertices > 0);
    assert_true(seen.viscous > 0 && seen.drag > 0 && seen.early > 0);
    assert_true(seen.prescribed > 0 && seen.loaded > 0 && seen.outside > 0 && seen.resumed > 0);
}
