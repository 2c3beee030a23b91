/* SPDX-License-Identifier: BSD-3-Clause */
/* A rubber block on every kind of ground with every kind of contact: each run completes, no impact gives energy, the
 * ledger closes and closes better at a smaller rtol. A table tells what the runs took.
 * `test_sweep [SPACING [SHARE [WINDOW]]]`: m; of the 80 cases the share that a seeded draw takes; s, < 0: default. */
#include <gsl/gsl_rng.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "harness/cleanup_gsl.h"
#include "harness/motion.h"
#include "support.h"

enum { n_restitutions = 5, n_frictions = 4, n_grounds = 4, most_points = 64 };

static double spacing = 5e-3, share = 0.25, window = 0.0;
static long n_faults;

static const double restitutions[n_restitutions] = {0.0, 0.5, 0.9, 0.99, 1.0};
static const struct {
    double friction;
    dem_friction_law law;
    const char *name;
} frictions[n_frictions] = {{0.0, DEM_FRICTION_COULOMB, "0"},
                            {0.3, DEM_FRICTION_COULOMB, "0.3"},
                            {1.0, DEM_FRICTION_COULOMB, "1"},
                            {0.4, DEM_FRICTION_PAPER, "paper 0.4"}};
static const char *const grounds[n_grounds] = {"flat", "uneven", "V groove", "spike"};

/* A graph y(x). */
typedef struct ground {
    dem_index n;
    double points[2 * most_points];
} ground;

typedef struct tally {
    double deepest; /* m */
    double fall;    /* J, largest fall of what impacts have taken so far */
    double taken;   /* J, by impacts so far */
    double gained;  /* J, the most that one impact gave */
    double start;   /* J, the ledger at first */
    double open;    /* J, largest difference from it at an accepted step */
    const ground *ground;
} tally;

typedef struct outcome {
    tally tally;
    dem_counts counts;
    double initial; /* J, kinetic energy at first */
    double spent;   /* s of processor time */
    dem_status status;
} outcome;

static void put_point(ground *g, double x, double y)
{
    g->points[2 * g->n] = x;
    g->points[2 * g->n + 1] = y;
    g->n++;
}

static void make_ground(ground *g, int kind)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    assert_non_null(rng);
    *g = (ground){0};
    put_point(g, -0.2, kind == 2 ? 0.1 : 0.0);
    for (int k = 0; k < 40 && kind == 1; k++) put_point(g, -0.0975 + 5e-3 * k, 3e-3 * gsl_rng_uniform(rng));
    if (kind == 2) put_point(g, 3e-3, 0.0);
    for (int k = 0; k < 3 && kind == 3; k++) put_point(g, 1.3e-3 + 4e-3 * (k - 1), k == 1 ? 0.01 : 0.0);
    put_point(g, 0.2, kind == 2 ? 0.1 : 0.0);
}

/* Depth of a point below the graph, measured at right angles to the segment below it, m. */
static double depth_below(const ground *g, const double x[2])
{
    for (dem_index k = 0; k + 1 < g->n; k++) {
        const double *a = &g->points[2 * k], *b = a + 2, slope = (b[1] - a[1]) / (b[0] - a[0]);
        if (x[0] >= a[0] && x[0] <= b[0]) return (a[1] + slope * (x[0] - a[0]) - x[1]) / sqrt(1.0 + slope * slope);
    }
    return -1.0;
}

static dem_status look(void *context, const dem_simulation *simulation)
{
    tally *t = context;
    motion state;
    motion_see(simulation, &state);
    const dem_lattice *l = dem_model_lattice(dem_simulation_model(simulation));
    for (dem_index i = 0; i < l->n_nodes; i++)
        if (l->flags[i] & DEM_NODE_CONTACT) t->deepest = fmax(t->deepest, depth_below(t->ground, &state.x[2 * i]));
    t->fall = fmax(t->fall, t->taken - state.energy.impact);
    t->taken = state.energy.impact;
    t->open = fmax(t->open, fabs(state.energy.ledger - t->start));
    return DEM_OK;
}

static dem_status weigh(void *context, const dem_simulation *simulation, const dem_event *event)
{
    tally *t = context;
    (void)simulation;
    t->gained = fmax(t->gained, -event->energy);
    return DEM_OK;
}

/* The block starts a little above the highest point below it, or within the groove. */
static void make_block(dem_lattice *l, const ground *g)
{
    const dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0,
                                      .density = 1050.0, .thickness = 1.0, .guard = 0.02);
    double lift = 0.0;
    assert_ok(dem_lattice_rectangle(l, 0.04, 0.04, spacing));
    assert_ok(dem_lattice_assemble(l, &rubber));
    for (dem_index i = 0; i < l->n_nodes; i++) lift = fmax(lift, depth_below(g, &l->x[2 * i]));
    for (dem_index k = 0; k < g->n; k++)
        if (fabs(g->points[2 * k]) < 0.02) lift = fmax(lift, g->points[2 * k + 1]);
    dem_lattice_move(l, 0.0, (const double[2]){0.0, 2.0 * lift + 1e-4});
    assert_ok(dem_lattice_launch(l, (const double[2]){0.0, -5.0}));
}

/* Whether the block flies away from the ground. */
static int has_left(const support_run *run)
{
    motion state;
    double gap = INFINITY;
    motion_see(run->simulation, &state);
    for (dem_index i = 0; i < ask_sizes(run->model).n_nodes; i++)
        gap = fmin(gap, dem_model_gap(run->model, &state.x[2 * i]));
    return state.n_contacts == 0 && gap > 2e-3 && ask_body(run->simulation, 0).velocity[1] > 0.0;
}

static void run_case(int restitution, int friction, int kind, double rtol, outcome *out)
{
    ground g;
    CLEANUP(dem_lattice_free) dem_lattice block = dem_lattice_empty();
    CLEANUP(support_close) support_run run;
    dem_options options = support_options();
    make_ground(&g, kind);
    make_block(&block, &g);
    const dem_obstacle obstacle =
        SIZED(dem_obstacle, .n_points = g.n, .points = g.points, .restitution = restitutions[restitution],
              .friction = frictions[friction].friction, .friction_law = frictions[friction].law);
    options.rtol = rtol;
    options.window = window;
    *out = (outcome){.tally = {.ground = &g}};
    const dem_observer observer =
        SIZED(dem_observer, .interval = 2e-6, .frame = NULL, .step = look, .event = weigh, .context = &out->tally);
    support_open(&run, &block, &obstacle, 1, &options);
    assert_ok(dem_simulation_observe(run.simulation, &observer));
    out->tally.start = ask_energy(run.simulation).ledger;
    out->initial = ask_energy(run.simulation).kinetic;
    const clock_t began = clock();
    for (int k = 1; k <= 20 && out->status == DEM_OK && !(k > 8 && has_left(&run)); k++)
        out->status = dem_simulation_advance(run.simulation, 2.5e-4 * k);
    out->spent = (double)(clock() - began) / CLOCKS_PER_SEC;
    out->counts = ask_counts(run.simulation);
}

static void tell(int restitution, int friction, int kind, const outcome *loose, const outcome *tight)
{
    const dem_counts *c = &tight->counts;
    print_message("# %-4g %-9s %-8s %6lld %5lld %5lld %5lld %5lld %8.1e %8.1e %8.1e %6lld %6.2f\n",
                  restitutions[restitution], frictions[friction].name, grounds[kind], (long long)c->impacts,
                  (long long)c->vertex_impacts, (long long)c->sticks, (long long)c->slips, (long long)c->late,
                  tight->tally.deepest / spacing, loose->tally.open / loose->initial,
                  tight->tally.open / tight->initial, (long long)c->steps, tight->spent);
}

/* Bounds of the ledger at rtol 1e-8, over the initial kinetic energy: 1e-6; near eta = 1 ten times that, as every short
 * flight of a pressed node restarts the integrator. Ten penetration tolerances are deep: one is taken at an impact.
 * Rounding of the energies is below 1e-12. */
static void judge(int restitution, int friction, int kind, const outcome *loose, const outcome *tight)
{
    const double bound = restitutions[restitution] > 0.5 ? 1e-5 : 1e-6;
    const tally *t = &tight->tally;
    const char *fault = NULL;
    if (loose->status != DEM_OK || tight->status != DEM_OK)
        fault = dem_status_message();
    else if (!(t->gained <= 1e-12 * tight->initial && t->fall <= 1e-12 * tight->initial))
        fault = "an impact gave energy";
    else if (!(fmax(t->deepest, loose->tally.deepest) <= 1e-5 * spacing))
        fault = "a node is too deep";
    else if (!(t->open <= bound * tight->initial))
        fault = "the ledger is open";
    else if (!(t->open < 0.5 * loose->tally.open))
        fault = "the ledger does not close better at a smaller rtol";
    if (fault == NULL) return;
    n_faults++;
    print_message("# eta %g, friction %s, %s: %s\n", restitutions[restitution], frictions[friction].name, grounds[kind],
                  fault);
}

TEST(blocks_on_every_ground_close_their_ledger)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    assert_non_null(rng);
    print_message(
        "# spacing %g mm; rtol 1e-6: closure; rtol 1e-8: the rest\n# eta  friction  ground   impact  vert stick "
        " slip  late    depth closure6 closure8  steps   time\n",
        1e3 * spacing);
    for (int r = 0; r < n_restitutions; r++)
        for (int f = 0; f < n_frictions; f++)
            for (int g = 0; g < n_grounds; g++) {
                outcome loose, tight;
                if (gsl_rng_uniform(rng) >= share) continue;
                run_case(r, f, g, 1e-6, &loose);
                run_case(r, f, g, 1e-8, &tight);
                tell(r, f, g, &loose, &tight);
                judge(r, f, g, &loose, &tight);
            }
    assert_int_equal(n_faults, 0);
}

int main(int argc, char **argv)
{
    if (argc > 1) spacing = atof(argv[1]);
    if (argc > 2) share = atof(argv[2]);
    if (argc > 3) window = atof(argv[3]);
    return test_run();
}
