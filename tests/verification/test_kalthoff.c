/* SPDX-License-Identifier: BSD-3-Clause */
/* The crack from a notch beside an impact, by Kalthoff and Winkler (1987): the upper half of a steel plate of 100 x 100
 * mm in plane strain, which a projectile hits below a notch of 50 mm with 16.5 m/s. The crack goes up at about 70
 * degrees to the notch in the experiment, at 60 to 70 in other computations, and should do so in whatever mesh: with
 * rows in three directions, with places moved at random, without rows. Triangles soften, with twice the strain of the
 * strength (q = 2). `long` as argument: five meshes of half the spacing. */
#include "clamped_strip.h"

#include <stdlib.h>
#include <string.h>

#include "strip_mesh.h"

static const double modulus = 190e9, nu = 0.3, density = 8000.0, energy = 22e3; /* Pa, kg/m^3, J/m^2 */
static const double side = 0.1, notch = 0.05, height = 0.0252, speed = 16.5;    /* m, m/s */
static const double way = 0.025, further = 0.036; /* m above the notch: where the crack is looked at, and when */

typedef struct kalthoff {
    double spacing; /* m */
    dem_lattice lattice;
    double corner[2]; /* m, of the plate */
    dem_index n_hit, n_bottom;
    dem_index *hit, *bottom;
    support_run run;
    double end[2]; /* m, of the notch */
    double n, sum; /* of what has broken within a spacing of `way`: how many; m, of how far they are from there */
} kalthoff;

/* strip_mesh_make() has a spacing of its own. q = 2 is G E'/(strength^2 a) = 4.14. */
static void make_plate(kalthoff *k, const strip_mesh *mesh)
{
    const double in_strain = modulus / (1.0 - nu * nu), wide = round(side / k->spacing);
    const dem_material steel = {.struct_size = sizeof steel,
                                .youngs_modulus = modulus,
                                .poissons_ratio = nu,
                                .plane = DEM_PLANE_STRAIN,
                                .density = density,
                                .thickness = 1.0,
                                .springs = DEM_SPRINGS_COUPLED,
                                .strength = sqrt(in_strain * energy / (4.14 * k->spacing)),
                                .fracture_energy = energy};
    k->lattice = strip_mesh_make(wide, wide, mesh);
    for (dem_index j = 0; j < 2 * k->lattice.n_nodes; j++) k->lattice.x[j] *= k->spacing / CLAMPED_STRIP_SPACING;
    assert_ok(dem_lattice_assemble(&k->lattice, &steel));
}

/* What the projectile hits, and the line of symmetry. */
static void find_sides(kalthoff *k)
{
    const dem_lattice *l = &k->lattice;
    k->corner[0] = k->corner[1] = (double)INFINITY;
    for (dem_index j = 0; j < 2 * l->n_nodes; j++) k->corner[j % 2] = fmin(k->corner[j % 2], l->x[j]);
    k->hit = calloc((size_t)l->n_nodes, sizeof *k->hit);
    k->bottom = calloc((size_t)l->n_nodes, sizeof *k->bottom);
    assert_true(k->hit != NULL && k->bottom != NULL);
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const double x = l->x[2 * i] - k->corner[0], y = l->x[2 * i + 1] - k->corner[1];
        if (x < 0.3 * k->spacing && y < height - 0.5 * k->spacing) k->hit[k->n_hit++] = i;
        if (y < 0.1 * k->spacing) k->bottom[k->n_bottom++] = i;
    }
}

/* Breaks what the line of the notch crosses. */
static void cut_notch(kalthoff *k)
{
    const dem_lattice *l = &k->lattice;
    dem_index *list = calloc((size_t)l->n_triangles, sizeof *list), n = 0;
    assert_non_null(list);
    k->end[1] = k->corner[1] + height;
    for (dem_index t = 0; t < l->n_triangles; t++) {
        const double x = clamped_strip_centre(l, t, 0);
        int above = 0;
        for (int c = 0; c < 3; c++) above += l->x[2 * l->triangles[3 * t + c] + 1] > k->end[1];
        if (above == 0 || above == 3 || x - k->corner[0] > notch + 1e-3 * k->spacing) continue;
        k->end[0] = n == 0 ? x : fmax(k->end[0], x);
        list[n++] = t;
    }
    assert_ok(dem_simulation_break(k->run.simulation, list, n, NULL, 0));
    free(list);
}

/* The crack is what breaks above the notch: what breaks ahead of it, and further on, is another one. */
static dem_status note(void *context, const dem_simulation *s, const dem_break *what)
{
    kalthoff *k = context;
    const double x = what->x[0] - k->end[0], y = what->x[1] - k->end[1];
    (void)s;
    if (what->t == 0.0 || y < 0.3 * fabs(x)) return DEM_OK;
    if (fabs(y - way) < k->spacing) {
        k->n += 1.0;
        k->sum += x;
    }
    return y > further ? DEM_STOPPED : DEM_OK;
}

static void hit_plate(kalthoff *k)
{
    const dem_observer observer = {.struct_size = sizeof observer, .broken = note, .context = k};
    const dem_boundary sides[2] = {SIZED(dem_boundary, .kind = DEM_BOUNDARY_VELOCITY, .components = DEM_COMPONENT_X,
                                         .nodes = k->hit, .n_nodes = k->n_hit, .value = {speed, 0.0}),
                                   SIZED(dem_boundary, .kind = DEM_BOUNDARY_VELOCITY, .components = DEM_COMPONENT_Y,
                                         .nodes = k->bottom, .n_nodes = k->n_bottom)};
    dem_options options = dem_options_default();
    options.gravity[1] = 0.0;
    options.method = DEM_METHOD_VERLET;
    options.n_boundaries = 2;
    options.boundaries = sides;
    support_open(&k->run, &k->lattice, NULL, 0, &options);
    assert_ok(dem_simulation_observe(k->run.simulation, &observer));
    cut_notch(k);
    assert_int_equal(dem_simulation_advance(k->run.simulation, 80e-6), DEM_STOPPED);
}

/* Degrees, of the chord from the end of the notch to the mean of what has broken at the height `way`: the crack begins
 * to branch there, and which branch breaks first is chance. */
static double angle(double spacing, const strip_mesh *mesh)
{
    kalthoff k = {.spacing = spacing};
    make_plate(&k, mesh);
    find_sides(&k);
    hit_plate(&k);
    const double found = atan2(way, k.sum / k.n) / M_PI * 180.0;
    support_close(&k.run);
    dem_lattice_free(&k.lattice);
    free(k.hit);
    free(k.bottom);
    print_message("# %.2f degrees\n", found);
    assert_true(found > 58.0 && found < 70.0);
    return found;
}

/* Found: 60.6, 59.8. */
TEST(a_crack_beside_an_impact_goes_up_whatever_the_direction_of_the_rows)
{
    const strip_mesh meshes[] = {{0.0, 0.0, true, 1}, {15.0, 0.0, true, 1}};
    for (size_t j = 0; j < sizeof meshes / sizeof *meshes; j++) angle(2e-3, &meshes[j]);
}

/* Found: 61.3, 60.2, 61.6, 60.3, 61.5; two other seeds of the fourth 62.8 and 63.2, one of the fifth 60.2. */
static void of_five_meshes(void **state)
{
    const strip_mesh meshes[] = {
        {0.0, 0.0, true, 1}, {15.0, 0.0, true, 1}, {30.0, 0.0, true, 1}, {0.0, 0.25, true, 1}, {0.0, 0.0, false, 1}};
    double least = 90.0, most = 0.0;
    (void)state;
    for (size_t j = 0; j < sizeof meshes / sizeof *meshes; j++) {
        const double found = angle(1e-3, &meshes[j]);
        least = fmin(least, found);
        most = fmax(most, found);
    }
    print_message("# spread %.2f degrees\n", most - least);
    assert_true(most - least < 4.0);
}

int main(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "long") == 0) test_add(&(struct CMUnitTest)cmocka_unit_test(of_five_meshes), 1000);
    return test_run();
}
