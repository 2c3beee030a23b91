/* SPDX-License-Identifier: BSD-3-Clause */
/* Two equal discs without friction run into each other, head-on, obliquely and spinning: what their outlines do to
 * their spins and to restitution. Round bodies that push each other off without friction keep their spins; a stepped
 * rim turns them by its teeth. Momenta stay. */
#include "support.h"

#include <stdlib.h>

static const double radius = 0.02, speed = 2.5; /* m, m/s */
static const dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0,
                                         .density = 1050.0, .thickness = 1.0, .springs = DEM_SPRINGS_COUPLED);

static dem_lattice make_disc(double spacing, bool smooth)
{
    const dem_outline disc = SIZED(dem_outline, .kind = DEM_OUTLINE_DISC, .radius = radius);
    const dem_shape s =
        SIZED(dem_shape, .outline = &disc, .spacing = spacing, .edge = smooth ? DEM_EDGE_SMOOTH : DEM_EDGE_STEPPED);
    dem_lattice l = dem_lattice_empty();
    assert_ok(dem_shape_lattice(&l, &s, NULL));
    assert_ok(dem_lattice_assemble(&l, &rubber));
    return l;
}

/* What discs have at a time: spins about their own centres, and momenta of both about the origin. */
typedef struct moments {
    double velocity[2][2], spin[2];
    double linear[2], angular, scale; /* scale: sum of m |v|, kg m/s */
} moments;

/* Body k has the nodes from k n on. */
static moments measure(const dem_lattice *l, const motion *m)
{
    const dem_index n = l->n_nodes / 2;
    moments out = {.scale = 0.0};
    for (int k = 0; k < 2; k++) {
        double mass = 0.0, x[2] = {0.0, 0.0}, v[2] = {0.0, 0.0}, turn = 0.0, inertia = 0.0;
        for (dem_index i = k * n; i < (k + 1) * n; i++) {
            const double *at = m->x + 2 * i, *speed_of = m->v + 2 * i, w = l->mass[i];
            mass += w;
            turn += w * (at[0] * speed_of[1] - at[1] * speed_of[0]);
            inertia += w * (at[0] * at[0] + at[1] * at[1]);
            out.scale += w * hypot(speed_of[0], speed_of[1]);
            for (int c = 0; c < 2; c++) {
                x[c] += w * at[c];
                v[c] += w * speed_of[c];
            }
        }
        out.angular += turn;
        out.spin[k] = (turn - (x[0] * v[1] - x[1] * v[0]) / mass) / (inertia - (x[0] * x[0] + x[1] * x[1]) / mass);
        for (int c = 0; c < 2; c++) {
            out.linear[c] += v[c];
            out.velocity[k][c] = v[c] / mass;
        }
    }
    return out;
}

/* How two discs meet: the offset of their ways in radii, and the spins that they come with, 1/s. */
typedef struct meeting {
    double offset, spin[2];
} meeting;

/* What an impact did. */
typedef struct outcome {
    double spin;            /* change of that of the disc that it changes most, 1/s */
    double restitution;     /* of the speed along the line between the centres as they meet */
    double linear, angular; /* change of momenta of both, in sums of m |v| and of that times the radius */
} outcome;

/* Discs turned by angles. */
static outcome collide(const meeting *as, double spacing, bool smooth, double angle)
{
    CLEANUP(dem_lattice_free) dem_lattice a = make_disc(spacing, smooth), b = make_disc(spacing, smooth);
    const double across = as->offset * radius, along = sqrt(4.0 * radius * radius - across * across);
    const double gap = along + 0.5 * spacing;
    assert_ok(dem_lattice_launch(&a, (double[2]){speed, 0.0}));
    assert_ok(dem_lattice_launch(&b, (double[2]){-speed, 0.0}));
    dem_lattice_move(&a, angle, (double[2]){-0.5 * gap, 0.5 * across});
    dem_lattice_move(&b, 0.7 - 2.0 * angle, (double[2]){0.5 * gap, -0.5 * across});
    assert_ok(dem_lattice_spin(&a, as->spin[0]));
    assert_ok(dem_lattice_spin(&b, as->spin[1]));
    assert_ok(dem_lattice_append(&a, &b));
    dem_options options = support_options();
    options.gravity[1] = 0.0;
    options.rtol = 1e-7; /* the angular momentum is the integrator's: 4e-10 of the scale at 1e-6 */
    options.bodies = DEM_BODIES_OTHERS;
    CLEANUP(support_close) support_run run;
    support_open(&run, &a, NULL, 0, &options);
    const motion begin = support_at(&run, 0.0);
    const moments before = measure(&a, &begin);
    const motion end = support_at(&run, 6e-3);
    const moments after = measure(&a, &end);
    const double normal[2] = {along / (2.0 * radius), -across / (2.0 * radius)};
    double came = 0.0, went = 0.0, lost = 0.0;
    for (int c = 0; c < 2; c++) {
        came += normal[c] * (before.velocity[0][c] - before.velocity[1][c]);
        went += normal[c] * (after.velocity[1][c] - after.velocity[0][c]);
        lost = fmax(lost, fabs(after.linear[c] - before.linear[c]));
    }
    return (outcome){fmax(fabs(after.spin[0] - before.spin[0]), fabs(after.spin[1] - before.spin[1])), went / came,
                     lost / before.scale, fabs(after.angular - before.angular) / (before.scale * radius)};
}

/* The worst of some turns of the discs. */
static outcome worst(const meeting *as, int n, int n_turns, bool smooth)
{
    outcome all = {.restitution = 1.0};
    for (int k = 0; k < n_turns; k++) {
        const outcome one = collide(as, radius / n, smooth, 0.2 * k);
        all.spin = fmax(all.spin, one.spin);
        all.restitution = fmin(all.restitution, one.restitution);
        all.linear = fmax(all.linear, one.linear);
        all.angular = fmax(all.angular, one.angular);
    }
    print_message("# %s, spacing R/%d, offset %g R, spins %g, %g 1/s: changed by up to %.3f 1/s, restitution %.4f, "
                  "momenta by %.1e, %.1e\n",
                  smooth ? "smooth" : "stepped", n, as->offset, as->spin[0], as->spin[1], all.spin, all.restitution,
                  all.linear, all.angular);
    assert_true(all.linear < 1e-12); /* rounding */
    assert_true(all.angular < 1e-10);
    return all;
}

static const meeting head_on = {0.0, {0.0, 0.0}}, oblique = {0.5, {0.0, 0.0}}, spinning = {0.5, {60.0, -20.0}};

static void check_spin(const outcome *coarse, const outcome *fine)
{
    assert_true(coarse->spin < 3.5);
    assert_true(fine->spin < 0.5);
}

/* If discs of the oblique meeting stuck together they would leave with 21 1/s. Found are changes of up to 2.85, 1.40
 * and 0.76 1/s at R/8 for the three meetings, of 0.38, 0.34 and 0.29 at R/16, of 0.11, 0.08 and 0.06 at R/32. With
 * stepped rims they are 116, 132 and 160 at R/8, 51, 95 and 84 at R/16. */
TEST(smooth_discs_change_their_spins_by_next_to_nothing)
{
    static const meeting *const meetings[2] = {&oblique, &spinning}; /* head on: the next test */
    for (int k = 0; k < 2; k++) {
        const outcome coarse = worst(meetings[k], 8, 3, true), fine = worst(meetings[k], 16, 3, true);
        check_spin(&coarse, &fine);
    }
    assert_true(worst(&oblique, 8, 3, false).spin > 20.0);
}

static void so_at_a_finer_spacing(void **state)
{
    (void)state;
    assert_true(worst(&spinning, 32, 1, true).spin < 0.2);
}

/* Waves keep some of the energy of a central impact. Found are 0.954, 0.958 and, at R/32, 0.960, with stepped rims
 * 0.803 and 0.938 at R/8 and R/16. */
TEST(the_restitution_of_smooth_discs_hardly_depends_on_the_spacing)
{
    const outcome coarse = worst(&head_on, 8, 3, true), fine = worst(&head_on, 16, 3, true);
    check_spin(&coarse, &fine);
    assert_close(coarse.restitution, fine.restitution, 0.006);
    assert_true(worst(&head_on, 8, 3, false).restitution < fine.restitution - 0.1);
}

int main(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "long") == 0)
        test_add(&(struct CMUnitTest)cmocka_unit_test(so_at_a_finer_spacing), 1000);
    return test_run();
}
