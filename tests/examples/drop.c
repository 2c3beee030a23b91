/* SPDX-License-Identifier: BSD-3-Clause */
/* The program of README.md: a disc falls on a slope; its file opens in ParaView. */
#include <dem/trajectory.h>
#include <stdio.h>

static int fail(void)
{
    fprintf(stderr, "%s\n", dem_status_message());
    return 1;
}

int main(void)
{
    const dem_material rubber = {.struct_size = sizeof(dem_material),
                                 .youngs_modulus = 1e7,
                                 .poissons_ratio = 1.0 / 3.0,
                                 .density = 1050,
                                 .thickness = 1,
                                 .guard = 0.02};
    const double slope[] = {-0.3, 0.1, 0.3, -0.1}, lift[] = {0, 0.1}, velocity[] = {0, -10};
    const dem_obstacle obstacle = {
        .struct_size = sizeof(dem_obstacle), .n_points = 2, .points = slope, .restitution = 0};
    const dem_options options = dem_options_default();
    dem_trajectory_options frames = dem_trajectory_options_default();
    frames.frame_interval = 1e-3;
    dem_lattice lattice = dem_lattice_empty();
    dem_model *model;
    dem_simulation *simulation;
    dem_trajectory *file;
    dem_observer observer = {.struct_size = sizeof observer};
    dem_body_motion body = {.struct_size = sizeof body};

    if (dem_lattice_disc(&lattice, 0.065, 5e-3) || dem_lattice_assemble(&lattice, &rubber)) return fail();
    dem_lattice_move(&lattice, 0, lift);
    if (dem_lattice_launch(&lattice, velocity)) return fail();
    if (dem_model_create(&model, &lattice, &obstacle, 1)) return fail();
    if (dem_simulation_create(&simulation, model, &options)) return fail();
    if (dem_trajectory_create(&file, "drop.vtkhdf", simulation, &frames)) return fail();
    if (dem_trajectory_observer(file, &observer)) return fail();
    if (dem_simulation_observe(simulation, &observer)) return fail();
    if (dem_simulation_advance(simulation, 20e-3)) return fail();
    if (dem_trajectory_finish(file)) return fail();
    if (dem_simulation_body(simulation, 0, &body)) return fail();
    printf("%g m/s\n", body.velocity[1]);
    dem_trajectory_destroy(file);
    dem_simulation_destroy(simulation);
    dem_model_destroy(model);
    dem_lattice_free(&lattice);
    return 0;
}
