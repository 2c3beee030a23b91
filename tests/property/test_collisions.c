/* SPDX-License-Identifier: BSD-3-Clause */
/* Random scenes of 2 to 12 bodies that run into each other, in a box or in free space: no surface crosses another, no
 * body overlaps one, the ledger closes, and without a box momentum stays. `test_collisions [N [SEED]]`: N scenes from a
 * seed on, 40 from 1 by default. */
#include <stdlib.h>

#include "ask.h"
#include "base/random.h"
#include "verification/support.h"

static int n_scenes = 40;
static uint64_t first_seed = 1;

/* A scene, all of which follows from its seed. */
typedef struct scene {
    uint64_t seed, state;
    dem_lattice lattice;
    dem_options options;
    bool boxed;
    bool folded; /* a triangle has been inside out */
    double friction, restitution, speed;
} scene;

static double draw(scene *s, double from, double to)
{
    return from + 0.5 * (to - from) * (1.0 + random_next(&s->state));
}

static const double step = 0.06; /* m, of the grid on which bodies start */

/* A disc or a rectangle that fits into its cell at any angle, of a spacing and a modulus of its own. */
static dem_lattice draw_body(scene *s, int column, int row)
{
    const double spacing = draw(s, 3e-3, 6e-3);
    const dem_material material =
        SIZED(dem_material, .youngs_modulus = 1e7 * pow(10.0, draw(s, -0.7, 0.7)), .poissons_ratio = draw(s, 0.2, 0.4),
              .density = draw(s, 800.0, 3000.0), .thickness = 1.0, .guard = 0.02);
    dem_lattice body = dem_lattice_empty();
    if (draw(s, 0.0, 1.0) < 0.5)
        assert_ok(dem_lattice_disc(&body, draw(s, 0.014, 0.022), spacing));
    else
        assert_ok(dem_lattice_rectangle(&body, draw(s, 0.018, 0.034), draw(s, 0.018, 0.03), spacing));
    assert_ok(dem_lattice_assemble(&body, &material));
    dem_lattice_move(&body, draw(s, -3.0, 3.0), (const double[2]){0.0, 0.0});
    double centre[2] = {0.0, 0.0};
    for (dem_index k = 0; k < 2 * body.n_nodes; k++) centre[k % 2] += body.x[k] / (double)body.n_nodes;
    dem_lattice_move(&body, 0.0, (const double[2]){step * column - centre[0], step * row - centre[1]});
    assert_ok(dem_lattice_launch(&body, (const double[2]){draw(s, -s->speed, s->speed), draw(s, -s->speed, s->speed)}));
    return body;
}

static void draw_scene(scene *s, uint64_t seed)
{
    static const dem_method methods[4] = {DEM_METHOD_FEHLBERG45, DEM_METHOD_FEHLBERG45, DEM_METHOD_DOPRI45,
                                          DEM_METHOD_VERLET};
    *s = (scene){.seed = seed, .state = seed * 1000003u, .options = dem_options_default()};
    s->options.method = methods[(int)draw(s, 0.0, 3.999)];
    s->speed = s->options.method == DEM_METHOD_VERLET ? 8.0 : 20.0; /* fixed steps do not adapt to violent impacts */
    const int n = 2 + (int)draw(s, 0.0, 10.999), columns = (int)ceil(sqrt(n));
    s->lattice = draw_body(s, 0, 0);
    for (int k = 1; k < n; k++) {
        CLEANUP(dem_lattice_free) dem_lattice next = draw_body(s, k % columns, k / columns);
        assert_ok(dem_lattice_append(&s->lattice, &next));
    }
    s->boxed = draw(s, 0.0, 1.0) < 0.6;
    s->friction = draw(s, 0.0, 1.0) < 0.5 ? 0.0 : draw(s, 0.0, 0.8);
    s->restitution = draw(s, 0.0, 1.0) < 0.5 ? 0.0 : draw(s, 0.0, 0.9);
    s->options.contact = draw(s, 0.0, 1.0) < 0.8 ? DEM_CONTACT_LOCAL : DEM_CONTACT_EXACT;
    s->options.bodies = draw(s, 0.0, 1.0) < 0.8 ? DEM_BODIES_ALL : DEM_BODIES_OTHERS;
    if (!s->boxed) s->options.gravity[1] = 0.0;
}

static double momentum(const dem_lattice *l, const double *v, int c, double *scale)
{
    double sum = 0.0;
    for (dem_index i = 0; i < l->n_nodes; i++) {
        sum += l->mass[i] * v[2 * i + c];
        *scale += l->mass[i] * fabs(v[2 * i + c]);
    }
    return sum;
}

/* A body may overlap itself if it does not touch itself, or if an impact has turned a triangle inside out: that is a
 * matter of the lattice, and no surface has crossed another. */
static bool overlaps(const scene *s, const dem_overlap *found)
{
    if (found->most == 0) return false;
    const bool within = s->lattice.body[found->node] == s->lattice.body[s->lattice.triangles[3 * found->triangle]];
    return !within || (s->options.bodies == DEM_BODIES_ALL && !s->folded);
}

static dem_status note_folding(void *context, const dem_simulation *simulation)
{
    scene *s = context;
    s->folded = s->folded || ask_strain(simulation).inverted > 0;
    return DEM_OK;
}

/* The ledger by the integrator's error at rtol 1e-6, or with Verlet by its swing; momentum by rounding. */
static void check_scene(uint64_t seed)
{
    scene s;
    CLEANUP(support_close) support_run run;
    draw_scene(&s, seed);
    const double low = -0.6 * step, high = 4.0 * step;
    const double box[10] = {low, low, high, low, high, high, low, high, low, low};
    const dem_obstacle walls =
        SIZED(dem_obstacle, .n_points = 5, .points = box, .restitution = s.restitution, .friction = s.friction);
    support_open(&run, &s.lattice, s.boxed ? &walls : NULL, s.boxed ? 1 : 0, &s.options);
    const dem_observer observer = {.struct_size = sizeof(dem_observer), .step = note_folding, .context = &s};
    assert_ok(dem_simulation_observe(run.simulation, &observer));
    const dem_energy start = ask_energy(run.simulation);
    const dem_status status = dem_simulation_advance(run.simulation, 6e-3);
    const dem_energy end = ask_energy(run.simulation);
    const dem_state state = ask_state(run.simulation);
    const dem_overlap overlap = ask_overlap(run.simulation);
    const double closure = fabs(end.ledger - start.ledger) / start.kinetic;
    double scale = 0.0;
    if (status != DEM_OK) fail_msg("seed %llu: %s", (unsigned long long)seed, dem_status_message());
    if (overlaps(&s, &overlap))
        fail_msg("seed %llu: node %lld in triangle %lld at %g s", (unsigned long long)seed, (long long)overlap.node,
                 (long long)overlap.triangle, overlap.t);
    if (!(closure < 1e-3)) fail_msg("seed %llu: closure %g", (unsigned long long)seed, closure);
    for (int c = 0; c < 2 && !s.boxed; c++) {
        const double before = momentum(&s.lattice, s.lattice.velocity, c, &scale);
        const double after = momentum(&s.lattice, state.v, c, &scale);
        if (!(fabs(after - before) < 1e-12 * scale))
            fail_msg("seed %llu: momentum off by %g of %g", (unsigned long long)seed, after - before, scale);
    }
    dem_lattice_free(&s.lattice);
}

TEST(random_bodies_keep_apart_and_keep_their_ledger)
{
    for (int k = 0; k < n_scenes; k++) check_scene(first_seed + (uint64_t)k);
}

int main(int argc, char **argv)
{
    if (argc > 1) n_scenes = atoi(argv[1]);
    if (argc > 2) first_seed = strtoull(argv[2], NULL, 10);
    return test_run();
}
