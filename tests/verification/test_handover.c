/* SPDX-License-Identifier: BSD-3-Clause */
/* How bodies that touch hand on momentum: two halves of a block against the block in one piece, and a row of four bars,
 * of which the first one comes. */
#include "ask.h"
#include "support.h"

static dem_material rubber_of(double poissons_ratio)
{
    return (dem_material)SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = poissons_ratio, .density = 1050.0,
                               .thickness = 1.0, .guard = 0.02);
}

static dem_options free_options(void)
{
    dem_options o = support_options();
    o.gravity[1] = 0.0;
    o.bodies = DEM_BODIES_OTHERS;
    return o;
}

/* Sets the nodes below a height in motion upwards. */
static void launch_below(dem_lattice *l, double height, double speed)
{
    assert_ok(dem_lattice_launch(l, (const double[2]){0.0, 0.0}));
    for (dem_index i = 0; i < l->n_nodes; i++)
        if (l->x[2 * i + 1] < height) l->velocity[2 * i + 1] = speed;
}

/* Share of the momentum that nodes above a height at rest have at x, v. */
static double share_above(const dem_lattice *l, double height, const double *v)
{
    double above = 0.0, all = 0.0;
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const double p = l->mass[i] * v[2 * i + 1];
        all += p;
        if (l->x[2 * i + 1] > height) above += p;
    }
    return above / all;
}

/* ---- two halves ---- */

/* The lower one of two blocks of 40 x 78 mm moves up with 1 m/s; the upper one is as far from it as the usual
 * thickness, and its mirror image. */
static dem_lattice make_halves(double spacing, double *middle)
{
    const dem_material rubber = rubber_of(1.0 / 3.0);
    const double height = 0.07794 - 0.5 * sqrt(3.0) * spacing; /* one row less than half of the whole block has */
    dem_lattice lower = support_rectangle(0.04, height, spacing, &rubber);
    CLEANUP(dem_lattice_free) dem_lattice upper = support_rectangle(0.04, height, spacing, &rubber);
    *middle = support_top(&lower) + 0.1 * spacing;
    dem_lattice_move(&upper, M_PI, (const double[2]){0.0, 2.0 * *middle});
    assert_ok(dem_lattice_append(&lower, &upper));
    return lower;
}

/* The same in one piece: the middle is between two rows. */
static dem_lattice make_whole(double spacing, double *middle)
{
    const dem_material rubber = rubber_of(1.0 / 3.0);
    dem_lattice l = support_rectangle(0.04, 2.0 * 0.07794 - 0.5 * sqrt(3.0) * spacing, spacing, &rubber);
    *middle = 0.5 * (support_bottom(&l) + support_top(&l));
    return l;
}

/* The largest difference of the shares that the upper halves have of the momentum within 1.4 ms. */
static double largest_delay(double spacing)
{
    double middle[2], most = 0.0;
    CLEANUP(support_close) support_run one, two;
    CLEANUP(dem_lattice_free) dem_lattice whole = make_whole(spacing, &middle[0]);
    CLEANUP(dem_lattice_free) dem_lattice halves = make_halves(spacing, &middle[1]);
    const dem_options o = free_options();
    assert_int_equal(whole.n_nodes, halves.n_nodes);
    launch_below(&whole, middle[0], 1.0);
    launch_below(&halves, middle[1], 1.0);
    support_open(&one, &whole, NULL, 0, &o);
    support_open(&two, &halves, NULL, 0, &o);
    for (int k = 1; k <= 7; k++) {
        const double share = share_above(&whole, middle[0], support_at(&one, 2e-4 * k).v);
        const double behind = share - share_above(&halves, middle[1], support_at(&two, 2e-4 * k).v);
        print_message("# %g m, %.1f ms: share %.4f in one piece, %.4f less in two\n", spacing, 0.2 * k, share, behind);
        assert_true(behind > 0.0);
        most = fmax(most, behind);
    }
    return most;
}

/* Surfaces a fifth of a spacing thick give way before they push. Asked for are 0.037 and 0.02, found 0.020 and 0.009:
 * half as much with half the spacing. */
TEST(halves_that_touch_hand_on_a_wave_nearly_as_one_piece)
{
    const double coarse = largest_delay(2.5e-3), fine = largest_delay(1.25e-3);
    assert_true(coarse < 0.037);
    assert_true(fine < 0.02);
    assert_true(fine < 0.6 * coarse);
}

/* ---- a row of bars ---- */

enum { BARS = 4 };

/* Bars of 20 x 80 mm a row apart, of which the lowest moves up with the speed. Its momentum in the end, in units of
 * that at the start, by bars. */
static void hit_row(double spacing, double speed, double poissons_ratio, double share[BARS])
{
    const dem_material rubber = rubber_of(poissons_ratio);
    const double row = 0.5 * sqrt(3.0) * spacing;
    const dem_options o = free_options();
    double sum = 0.0;
    CLEANUP(support_close) support_run run;
    CLEANUP(dem_lattice_free) dem_lattice bars = support_rectangle(0.02, 0.08, spacing, &rubber);
    for (int k = 1; k < BARS; k++) {
        CLEANUP(dem_lattice_free) dem_lattice next = support_rectangle(0.02, 0.08, spacing, &rubber);
        dem_lattice_move(&next, 0.0, (const double[2]){0.0, support_top(&bars) + row - support_bottom(&next)});
        assert_ok(dem_lattice_append(&bars, &next));
    }
    launch_below(&bars, support_bottom(&bars) + 0.08 + 0.5 * row, speed);
    support_open(&run, &bars, NULL, 0, &o);
    assert_close(support_at(&run, (BARS - 1) * row / speed + 9e-3).energy.contact, 0.0, 0.0);
    for (int k = 0; k < BARS; k++) sum += share[k] = ask_body(run.simulation, k).velocity[1] / speed;
    print_message("# %g m, %g m/s, nu %.2f: %.4f %.4f %.4f %.4f\n", spacing, speed, poissons_ratio, share[0], share[1],
                  share[2], share[3]);
    assert_close(sum, 1.0, 1e-11); /* rounding of forces over ten thousand steps, found 1e-12 */
}

/* Bars of one dimension hand on all. Found is 0.967 in the last one at 0.5 m/s: what is missing has gone into waves
 * across, which each impact leaves behind. It is more at higher speeds (0.946 at 1, 0.939 at 2 m/s), whose impacts are
 * sharper, and less in bars that do not get thicker when they get shorter. */
TEST(a_row_of_bars_hands_on_the_momentum_of_the_first)
{
    double share[BARS];
    hit_row(5e-3, 0.5, 1.0 / 3.0, share);
    assert_close(share[BARS - 1], 0.97, 0.015);
    for (int k = 0; k < BARS - 1; k++) assert_true(share[k] > 0.0 && share[k] < 0.04);
    hit_row(2.5e-3, 1.0, 0.01, share);
    assert_true(share[BARS - 1] > 0.98);
}
