/* SPDX-License-Identifier: BSD-3-Clause */
#include "view.h"

#include <math.h>

#include "support.h"

static const double flat[4] = {-0.3, 0.0, 0.3, 0.0}, teeth[14] = {-0.3,  -0.01, -0.021, -0.01, -0.013, 0.0, -0.002,
                                                                  -0.01, 0.008, 0.0,    0.017, -0.01,  0.3, -0.01},
                    groove[6] = {-0.05, 0.05, 0.0, 0.0, 0.05, 0.05}, post[4] = {0.02, 0.0, 0.02, 0.06},
                    plate[4] = {0.3, 0.032, -0.3, 0.033};

#define GROUND(line, e, mu)                                                                                            \
    {                                                                                                                  \
        .struct_size = sizeof(dem_obstacle), .n_points = (dem_index)(sizeof(line) / sizeof *(line) / 2),               \
        .points = line, .restitution = e, .friction = mu                                                               \
    }

const view views[VIEWS] = {
    {"flat, bouncing", {GROUND(flat, 0.5, 0.3)}, 1, 0.005, 0.1, {1.0, -3.0}, 9.81, 0.006},
    {"flat, lasting", {GROUND(flat, 0.0, 0.3)}, 1, 0.0002, 0.0, {1.0, -0.5}, 9.81, 0.02},
    {"teeth", {GROUND(teeth, 0.2, 0.3)}, 1, 0.002, 0.05, {0.5, -2.0}, 9.81, 0.01},
    {"groove", {GROUND(groove, 0.0, 0.2)}, 1, 0.02, 0.2, {0.0, -2.0}, 9.81, 0.02},
    {"floor and post", {GROUND(flat, 0.0, 0.5), GROUND(post, 0.3, 0.0)}, 2, 0.0002, 0.0, {2.0, -0.5}, 9.81, 0.01},
    {"from afar", {GROUND(teeth, 0.5, 0.3)}, 1, 0.1, 0.3, {0.0, -20.0}, 0.0, 0.01},
    {"press",
     {GROUND(teeth, 0.0, 0.3),
      {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = plate, .friction = 0.5, .velocity = {0.3, -2.0}}},
     2,
     0.002,
     0.05,
     {0.0, -1.0},
     9.81,
     0.006},
};

void view_make_body(dem_lattice *out, const view *v)
{
    const dem_material rubber =
        SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0, .thickness = 1.0);
    assert_ok(dem_lattice_rectangle(out, 0.02, 0.025, 5e-3));
    for (dem_index i = 0; i < out->n_nodes; i++) {
        const double x = out->x[2 * i], y = out->x[2 * i + 1];
        out->x[2 * i] = cos(v->tilt) * x - sin(v->tilt) * y;
        out->x[2 * i + 1] = sin(v->tilt) * x + cos(v->tilt) * y + v->height;
    }
    assert_ok(dem_lattice_assemble(out, &rubber));
    CLEANUP(free_memory) double *velocity = malloc(2 * (size_t)out->n_nodes * sizeof *velocity);
    assert_non_null(velocity);
    for (dem_index k = 0; k < 2 * out->n_nodes; k++) velocity[k] = v->velocity[k % 2];
    support_start(out, NULL, velocity);
}
