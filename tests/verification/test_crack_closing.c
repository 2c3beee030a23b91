/* SPDX-License-Identifier: BSD-3-Clause */
/* A bar that a crack has cut in two, by a row of triangles across its middle, is pressed slowly until it is at rest.
 * Its faces are born a row apart and push from the contact thickness on: before it carries anything the bar is shorter
 * by what is between. `long` as argument: longer bars. */
#include "clamped_strip.h"

#include <stdlib.h>
#include <string.h>

#include "ask.h"

static const double spacing = CLAMPED_STRIP_SPACING, c = CLAMPED_STRIP_SPEED, modulus = CLAMPED_STRIP_MODULUS;
static const double thickness = 0.2; /* of contact, in spacings, as bodies have it that give none */
enum { WIDE = 10 };                  /* spacings */

/* One of them is pressed. */
typedef struct bar {
    dem_lattice lattice;
    clamped_strip strip;
} bar;

static void make_bar(bar *b, int length)
{
    dem_material material = clamped_strip_material(false, 1.0 / 3.0);
    material.strength = 0.0;
    memset(b, 0, sizeof *b);
    b->lattice = support_rectangle(WIDE * spacing, length * spacing, spacing, &material);
    b->strip = clamped_strip_of(&b->lattice);
}

static void free_bar(bar *b)
{
    dem_lattice_free(&b->lattice);
    clamped_strip_free(&b->strip);
}

/* The force at rest of a bar that has been shortened by this way, whole or cut, N; its ends may widen. A drag at the
 * first frequency of the bar is what brings it to rest. */
static double press(const bar *b, double way, bool cut)
{
    const clamped_strip *s = &b->strip;
    const double crossing = s->height / c;
    dem_boundary ends[4];
    for (int side = 0; side < 2; side++) {
        const dem_boundary moved = SIZED(dem_boundary, .kind = DEM_BOUNDARY_DISPLACEMENT, .n_nodes = s->n_sides[side],
                                         .components = DEM_COMPONENT_Y, .nodes = s->sides[side],
                                         .ramp = 30.0 * crossing, .value = {0.0, side ? -way : 0.0});
        ends[side] = moved;
        ends[side + 2] = moved;
        ends[side + 2].components = DEM_COMPONENT_X;
        ends[side + 2].n_nodes = 1;
        ends[side + 2].value[1] = 0.0;
    }
    dem_options options = dem_options_default();
    options.gravity[1] = 0.0;
    options.bodies = DEM_BODIES_ALL;
    options.n_boundaries = 4;
    options.boundaries = ends;
    options.mass_damping = M_PI / crossing;
    CLEANUP(support_close) support_run run;
    support_open(&run, &b->lattice, NULL, 0, &options);
    if (cut) clamped_strip_cut(s, run.simulation, &b->lattice, s->begin - spacing, s->end + spacing);
    assert_ok(dem_simulation_advance(run.simulation, 45.0 * crossing));
    return -ask_boundary(run.simulation, 1).force[1];
}

/* Distance of surfaces over contact thickness that push like a strain of the solid: (1 - u)^2/u = strain, as the
 * modulus of contact is E h at nu = 1/3. */
static double share_at(double strain)
{
    const double b = 1.0 + 0.5 * strain;
    return b - sqrt(b * b - 1.0);
}

/* By what the cut bar is shorter than the whole one under the load of this strain, in spacings: the row that is broken,
 * which would itself be shorter, less what is left between the faces. */
static double closing_at(double strain)
{
    return 0.5 * sqrt(3.0) * (1.0 - strain) - thickness * share_at(strain);
}

/* Of the whole bar, by its length and a strain, N. It is 5 % narrower than it is wide, as every other row is. */
static double stiffness_of(const bar *b)
{
    const double way = 1e-4 * b->strip.height, stiffness = press(b, way, false) / 1e-4;
    assert_close(stiffness, 0.95 * WIDE * spacing * modulus, 2e-3 * stiffness);
    return stiffness;
}

/* Shortened by a hundredth of a spacing less than what is between its faces, it carries nothing but what is left of the
 * motion. By a load it is shorter by what is between them: to the square of the strain over all of its length, as
 * nothing here is linear, and 3e-5 of a spacing by faces that push at their nodes. */
static void check_bar(int length)
{
    static const double strains[] = {1e-4, 1e-3, 1e-2};
    CLEANUP(free_bar) bar b;
    make_bar(&b, length);
    const double height = b.strip.height, stiffness = stiffness_of(&b);
    assert_close(press(&b, (closing_at(0.0) - 0.01) * spacing, true), 0.0, 1e-6 * stiffness);
    for (size_t k = 0; k < sizeof strains / sizeof *strains; k++) {
        const double way = closing_at(strains[k]) * spacing + strains[k] * height;
        const double strain = press(&b, way, true) / stiffness, closing = (way - strain * height) / spacing;
        print_message(
            "# %d spacings, load of a strain of %.4g: shorter by %.5f spacings, %.4g times as much as whole\n", length,
            strain, closing, way / (strain * height));
        assert_close(closing, closing_at(strain), 3e-5 + strain * strain * height / spacing);
    }
}

TEST(a_bar_that_is_cut_is_shorter_by_a_row_less_the_contact_thickness)
{
    check_bar(20);
}

static void so_are_longer_ones(void **state)
{
    (void)state;
    check_bar(40);
    check_bar(80);
}

int main(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "long") == 0)
        test_add(&(struct CMUnitTest)cmocka_unit_test(so_are_longer_ones), 1000);
    return test_run();
}
