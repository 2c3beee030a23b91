/* SPDX-License-Identifier: BSD-3-Clause */
/* A bar that is cut in two by a row of triangles across its middle is pressed slowly until it is at rest. Where that
 * row has broken it is as stiff as the whole bar, as what is broken still fills the crack. Where it was left out, as by
 * a notch, the faces push from the contact thickness on: before it carries anything the bar is shorter by what is
 * between them. `long` as argument: longer bars. */
#include "clamped_strip.h"

#include <stdlib.h>
#include <string.h>

#include "ask.h"

static const double spacing = CLAMPED_STRIP_SPACING, c = CLAMPED_STRIP_SPEED, modulus = CLAMPED_STRIP_MODULUS;
static const double thickness = 0.2; /* of contact, in spacings, as bodies have it that give none */
enum { WIDE = 10 };                  /* spacings */

typedef enum cut { WHOLE, BROKEN, NOTCHED } cut;

typedef struct bar {
    dem_lattice lattice;
    clamped_strip strip;
    cut cut;
} bar;

/* Spacings long, nodes moved at random by up to this part of the spacing. */
typedef struct mesh {
    int length;
    double jitter;
} mesh;

static void take_row(dem_lattice *l)
{
    CLEANUP(clamped_strip_free) clamped_strip s = clamped_strip_of(l);
    CLEANUP(free_memory) bool *keep = calloc((size_t)l->n_triangles, sizeof *keep);
    assert_non_null(keep);
    for (dem_index t = 0; t < l->n_triangles; t++) keep[t] = !clamped_strip_crosses(&s, l, t);
    assert_ok(dem_lattice_trim(l, keep));
}

static void make_bar(bar *b, mesh m, cut how)
{
    dem_material material = clamped_strip_material(false, 1.0 / 3.0);
    material.strength = 0.0;
    *b = (bar){.lattice = dem_lattice_empty(), .cut = how};
    assert_ok(dem_lattice_rectangle(&b->lattice, WIDE * spacing, m.length * spacing, spacing));
    if (m.jitter > 0.0) assert_ok(dem_lattice_jitter(&b->lattice, m.jitter * spacing, 1));
    if (how == NOTCHED) take_row(&b->lattice);
    assert_ok(dem_lattice_assemble(&b->lattice, &material));
    b->strip = clamped_strip_of(&b->lattice);
}

static void free_bar(bar *b)
{
    dem_lattice_free(&b->lattice);
    clamped_strip_free(&b->strip);
}

/* Both ends go towards each other, and may widen; a node of each does not go along them. */
static void hold_ends(const clamped_strip *s, double way, dem_boundary ends[4])
{
    for (int k = 0; k < 4; k++) {
        const int side = k % 2;
        ends[k] = (dem_boundary)SIZED(dem_boundary, .kind = DEM_BOUNDARY_DISPLACEMENT, .nodes = s->sides[side],
                                      .n_nodes = k < 2 ? s->n_sides[side] : 1, .ramp = 30.0 * s->height / c,
                                      .components = k < 2 ? DEM_COMPONENT_Y : DEM_COMPONENT_X,
                                      .value = {0.0, k == 1 ? -way : 0.0});
    }
}

/* The force at rest of a bar that has been shortened by this way, N. A drag at its first frequency is what brings it to
 * rest. */
static double press(const bar *b, double way)
{
    const clamped_strip *s = &b->strip;
    const double crossing = s->height / c;
    dem_boundary ends[4];
    hold_ends(s, way, ends);
    dem_options options = dem_options_default();
    options.gravity[1] = 0.0;
    options.bodies = DEM_BODIES_ALL;
    options.n_boundaries = 4;
    options.boundaries = ends;
    options.mass_damping = M_PI / crossing;
    CLEANUP(support_close) support_run run;
    support_open(&run, &b->lattice, NULL, 0, &options);
    if (b->cut == BROKEN) (void)clamped_strip_cut(s, run.simulation, &b->lattice, s->begin - spacing, s->end + spacing);
    assert_ok(dem_simulation_advance(run.simulation, 45.0 * crossing));
    return -ask_boundary(run.simulation, 1).force[1];
}

/* Force of the whole bar by its strain, N. Every other row is a spacing narrower; outlines that are not straight take
 * a little more. */
static double stiffness_of(mesh m)
{
    CLEANUP(free_bar) bar b;
    make_bar(&b, m, WHOLE);
    const double stiffness = press(&b, 1e-4 * b.strip.height) / 1e-4;
    assert_close(stiffness, 0.95 * WIDE * spacing * modulus, (m.jitter > 0.0 ? 2e-2 : 2e-3) * stiffness);
    return stiffness;
}

/* What is left of the row is as stiff as the row itself; as nothing here is linear, to the strain. It is softer where
 * corners are not across from the middle of their edge, as T = 1 - 48 d^4, d edges aside of it: by 0.01 % of the bar at
 * a jitter of 0.1, 0.3 % at 0.2, or 0.1 % with another seed, 1.1 % at 0.25. */
static void check_broken(mesh m)
{
    CLEANUP(free_bar) bar b;
    make_bar(&b, m, BROKEN);
    const double height = b.strip.height, stiffness = stiffness_of(m);
    for (double strain = 1e-4; strain < 0.02; strain *= 10.0) {
        const double carried = press(&b, strain * height) / (strain * stiffness);
        print_message("# %d spacings, shorter by %.4g: carries %.5f of the whole\n", m.length, strain, carried);
        assert_close(carried, 1.0, strain + (m.jitter > 0.0 ? 5e-3 : 1e-5));
    }
}

TEST(what_is_broken_fills_a_crack_that_is_pressed)
{
    check_broken((mesh){20, 0.0});
    check_broken((mesh){20, 0.2});
}

/* Distance of surfaces over contact thickness that push like a strain of the solid: (1 - u)^2/u = strain, as the
 * modulus of contact is E h at nu = 1/3. */
static double share_at(double strain)
{
    const double b = 1.0 + 0.5 * strain;
    return b - sqrt(b * b - 1.0);
}

/* By what the notched bar is shorter than the whole one under the load of this strain, in spacings: the row that is
 * missing, which would itself be shorter, less what is left between the faces. */
static double closing_at(double strain)
{
    return 0.5 * sqrt(3.0) * (1.0 - strain) - thickness * share_at(strain);
}

/* Shortened by a hundredth of a spacing less than what is between its faces, it carries nothing but what is left of the
 * motion. By a load it is shorter by what is between them: to the square of the strain over all of its length, as
 * nothing here is linear, and 3e-5 of a spacing by faces that push at their nodes. */
static void check_notched(int length)
{
    CLEANUP(free_bar) bar b;
    make_bar(&b, (mesh){length, 0.0}, NOTCHED);
    const double height = b.strip.height, stiffness = stiffness_of((mesh){length, 0.0});
    assert_close(press(&b, (closing_at(0.0) - 0.01) * spacing), 0.0, 1e-6 * stiffness);
    for (double load = 1e-4; load < 0.02; load *= 10.0) {
        const double way = closing_at(load) * spacing + load * height;
        const double strain = press(&b, way) / stiffness, closing = (way - strain * height) / spacing;
        print_message(
            "# %d spacings, load of a strain of %.4g: shorter by %.5f spacings, %.4g times as much as whole\n", length,
            strain, closing, way / (strain * height));
        assert_close(closing, closing_at(strain), 3e-5 + strain * strain * height / spacing);
    }
}

TEST(a_notch_closes_by_a_row_less_the_contact_thickness)
{
    check_notched(20);
}

static void so_are_longer_bars(void **state)
{
    (void)state;
    for (int length = 40; length <= 80; length *= 2) {
        check_broken((mesh){length, 0.0});
        check_notched(length);
    }
}

int main(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "long") == 0)
        test_add(&(struct CMUnitTest)cmocka_unit_test(so_are_longer_bars), 1000);
    return test_run();
}
