/* SPDX-License-Identifier: BSD-3-Clause */
#include "crowd.h"

#include <string.h>

#include "base/random.h"
#include "verification/support.h"

static double draw(crowd *s, double from, double to)
{
    return from + 0.5 * (to - from) * (1.0 + random_next(&s->state));
}

static const double step = 0.06; /* m, of the grid on which bodies start */

/* A disc or a rectangle that fits into its cell at any angle, of a spacing and a modulus of its own. */
static dem_lattice draw_body(crowd *s, int column, int row)
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

/* The box goes by up to 3 m/s, swings by up to 6, turns by up to 4 at its corners, or all of it. With fixed steps,
 * which do not adapt to violent impacts, less: by the same share as the bodies. */
static void draw_motion(crowd *s)
{
    const double share = s->speed / 20.0;
    dem_obstacle *w = &s->walls;
    for (int c = 0; c < 2 && draw(s, 0.0, 1.0) < 0.7; c++) w->velocity[c] = share * draw(s, -3.0, 3.0);
    if (draw(s, 0.0, 1.0) < 0.5) {
        w->frequency = draw(s, 50.0, 300.0);
        for (int c = 0; c < 2; c++) w->amplitude[c] = share * draw(s, -1.0, 1.0) / w->frequency;
    }
    if (draw(s, 0.0, 1.0) < 0.5) {
        w->spin = share * draw(s, -20.0, 20.0);
        for (int c = 0; c < 2; c++) w->pivot[c] = draw(s, 0.0, 3.0 * step);
    }
    if (draw(s, 0.0, 1.0) < 0.3) w->ramp = draw(s, 0.0, 3e-3);
}

static void draw_walls(crowd *s)
{
    const double low = -0.6 * step, high = 4.0 * step;
    const double corners[10] = {low, low, high, low, high, high, low, high, low, low};
    const dem_obstacle walls = SIZED(dem_obstacle, .n_points = 5, .points = s->corners);
    memcpy(s->corners, corners, sizeof corners);
    s->walls = walls;
    s->walls.friction = draw(s, 0.0, 1.0) < 0.5 ? 0.0 : draw(s, 0.0, 0.8);
    s->walls.restitution = draw(s, 0.0, 1.0) < 0.5 ? 0.0 : draw(s, 0.0, 0.9);
}

void crowd_draw(crowd *s, uint64_t seed)
{
    static const dem_method methods[4] = {DEM_METHOD_FEHLBERG45, DEM_METHOD_FEHLBERG45, DEM_METHOD_DOPRI45,
                                          DEM_METHOD_VERLET};
    *s = (crowd){.seed = seed, .state = seed * 1000003u, .options = dem_options_default()};
    s->options.method = methods[(int)draw(s, 0.0, 3.999)];
    s->speed = s->options.method == DEM_METHOD_VERLET ? 8.0 : 20.0; /* fixed steps do not adapt to violent impacts */
    const int n = 2 + (int)draw(s, 0.0, 10.999), columns = (int)ceil(sqrt(n));
    s->lattice = draw_body(s, 0, 0);
    for (int k = 1; k < n; k++) {
        CLEANUP(dem_lattice_free) dem_lattice next = draw_body(s, k % columns, k / columns);
        assert_ok(dem_lattice_append(&s->lattice, &next));
    }
    s->boxed = draw(s, 0.0, 1.0) < 0.6;
    draw_walls(s);
    s->options.contact = draw(s, 0.0, 1.0) < 0.8 ? DEM_CONTACT_LOCAL : DEM_CONTACT_EXACT;
    s->options.bodies = draw(s, 0.0, 1.0) < 0.8 ? DEM_BODIES_ALL : DEM_BODIES_OTHERS;
    if (!s->boxed) s->options.gravity[1] = 0.0;
    if (draw(s, 0.0, 1.0) < 0.6) draw_motion(s);
    if (draw(s, 0.0, 1.0) < 0.5) s->options.contact_friction = draw(s, 0.05, 1.0);
}
