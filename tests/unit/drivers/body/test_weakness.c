/* SPDX-License-Identifier: BSD-3-Clause */
/* weakness.c: which triangles and springs weaknesses and interfaces touch, and by how much they weaken them. */
#include "unit/reading.h"

#include <stdlib.h>

#include "body.h"

#define RUN   "&run t_end = 1 /\n"
#define STIFF "youngs_modulus = 1e7, density = 1000, thickness = 0.5"
#define GLASS "&material name = 'm', " STIFF ", fracture = 'stress', strength = 1e6 /\n"
#define WEB   "&material name = 'm', " STIFF ", fracture = 'stretch', critical_stretch = 0.1 /\n"
#define SOLID "&material name = 'm', " STIFF " /\n"
#define OTHER "&material name = 'n', " STIFF ", fracture = 'stress', strength = 3e6 /\n"
#define BLOCK "&body shape = 'rectangle', size = 8, 6, spacing = 0.5, outline = 'lattice', material = 'm' /\n"
#define CELLS "&body shape = 'rectangle', size = 8, 6, spacing = 0.5, lattice = 'square', material = 'm' /\n"

typedef struct built {
    resolved from;
    namelist_errors errors;
    body_scene scene;
    body_facts facts;
    body_start start;
    dem_lattice lattice;
} built;

static void build(built *b, const char *text)
{
    *b = (built){.from = resolve_clean(text)};
    b->scene = (body_scene){.groups = &b->from.deck, .folder = ""};
    body_check_all(&b->from.deck, &b->errors);
    if (b->errors.n > 0) fail_msg("'%s' gives '%s'", text, b->errors.list[0].text);
    assert_true(body_build(&b->lattice, &b->facts, &b->start, &b->scene, 0, &b->errors));
}

static void build_good(built *b, const char *text)
{
    build(b, text);
    if (b->errors.n > 0) fail_msg("'%s' gives '%s'", text, b->errors.list[0].text);
}

static void drop_built(built *b)
{
    dem_lattice_free(&b->lattice);
    strengths_free(&b->facts.strengths);
    namelist_errors_free(&b->errors);
    drop_resolved(&b->from);
}

static void find_middle(double middle[2], const dem_lattice *l, const dem_index *nodes, int n)
{
    middle[0] = middle[1] = 0.0;
    for (int k = 0; k < 2 * n; k++) middle[k % 2] += l->x[2 * nodes[k / 2] + k % 2] / n;
}

/* Least and largest height of n nodes. */
static void find_heights(double y[2], const dem_lattice *l, const dem_index *nodes, int n)
{
    y[0] = y[1] = l->x[2 * nodes[0] + 1];
    for (int k = 1; k < n; k++) {
        y[0] = fmin(y[0], l->x[2 * nodes[k] + 1]);
        y[1] = fmax(y[1], l->x[2 * nodes[k] + 1]);
    }
}

/* ---- weaknesses ---- */

TEST(a_shape_weakens_the_triangles_with_their_centres_in_it)
{
    CLEANUP(drop_built) built b;
    dem_index n = 0;
    build_good(&b, RUN GLASS BLOCK "&weakness shape = 'disc', centre = 1, 3, radius = 1.3, strength = 0.25 /");
    for (dem_index t = 0; t < b.lattice.n_triangles; t++) {
        double at[2];
        find_middle(at, &b.lattice, b.lattice.triangles + 3 * t, 3);
        const bool weak = hypot(at[0] - 1.0, at[1] - 3.0) <= 1.3;
        assert_close(b.lattice.strength[t], weak ? 0.25e6 : 1e6, 0.0);
        n += weak;
    }
    assert_true(n > 30);
    assert_int_equal(b.facts.weak.weaknesses.n_triangles, n);
    assert_int_equal(b.facts.weak.weaknesses.n_springs + b.facts.weak.interfaces.n_triangles, 0);
}

TEST(turned_shapes_are_taken_as_voids_are)
{
    CLEANUP(drop_built) built b;
    build_good(&b, RUN GLASS BLOCK
               "&weakness shape = 'rectangle', centre = 0, 3, size = 9, 0.9, angle = 90, strength = 0.5 /\n"
               "&weakness shape = 'polygon', centre = 3, 3, points = 0,-9, 9,-9, 9,9, 0,9, strength = 2 /\n"
               "&weakness shape = 'ring', centre = -2.5, 3, radius = 1.2, inner_radius = 0.6, strength = 3 /");
    for (dem_index t = 0; t < b.lattice.n_triangles; t++) {
        double at[2];
        find_middle(at, &b.lattice, b.lattice.triangles + 3 * t, 3);
        const double away = hypot(at[0] + 2.5, at[1] - 3.0);
        const double factor =
            fabs(at[0]) <= 0.45 ? 0.5 : (at[0] >= 3.0 ? 2.0 : (away > 0.6 && away <= 1.2 ? 3.0 : 1.0));
        assert_close(b.lattice.strength[t], factor * 1e6, 0.0);
    }
}

TEST(a_polyline_weakens_what_a_crack_would_take)
{
#define LINE "points = -3, 1.1, 0.2, 2.7, 2.2, 2.6"
    CLEANUP(drop_built) built weak;
    CLEANUP(drop_built) built cracked;
    dem_index n = 0;
    build_good(&weak, RUN GLASS BLOCK "&weakness " LINE ", strength = 0.5 /");
    build_good(&cracked, RUN GLASS BLOCK "&crack " LINE " /");
    for (dem_index t = 0; t < weak.lattice.n_triangles; t++) n += weak.lattice.strength[t] == 0.5e6;
    assert_true(n > 15);
    assert_int_equal(n, weak.lattice.n_triangles - cracked.lattice.n_triangles);
    assert_int_equal(weak.facts.weak.weaknesses.n_triangles, n);
#undef LINE
}

/* The row of nodes at 5 rows of sqrt(3)/4; on its left is what is above it. */
TEST(a_line_along_a_row_weakens_the_triangles_and_the_springs_across_on_its_left)
{
    const double y = 5.0 * sqrt(3.0) / 4.0, next = 6.0 * sqrt(3.0) / 4.0;
    char text[1024];
    for (int kind = 0; kind < 2; kind++) {
        CLEANUP(drop_built) built b;
        (void)snprintf(text, sizeof text, "%s&weakness points = -9, %.17g, 9, %.17g, strength = 0.5 /",
                       kind == 0 ? RUN GLASS BLOCK : RUN WEB BLOCK, y, y);
        build_good(&b, text);
        const dem_lattice *l = &b.lattice;
        const dem_index n = kind == 0 ? l->n_triangles : l->n_springs;
        for (dem_index k = 0; k < n; k++) {
            double of[2];
            find_heights(of, l, kind == 0 ? l->triangles + 3 * k : l->ends + 2 * k, kind == 0 ? 3 : 2);
            const bool weak = fabs(of[0] - y) < 1e-9 && fabs(of[1] - next) < 1e-9;
            assert_close(kind == 0 ? l->strength[k] / 1e6 : l->critical_stretch[k] / 0.1, weak ? 0.5 : 1.0, 1e-15);
        }
    }
}

TEST(a_shape_weakens_the_springs_with_their_middles_in_it)
{
    CLEANUP(drop_built) built b;
    dem_index n = 0;
    build_good(&b, RUN WEB BLOCK "&weakness shape = 'disc', centre = 1, 3, radius = 1.3, strength = 0.5 /");
    for (dem_index k = 0; k < b.lattice.n_springs; k++) {
        double at[2];
        find_middle(at, &b.lattice, b.lattice.ends + 2 * k, 2);
        const bool weak = hypot(at[0] - 1.0, at[1] - 3.0) <= 1.3;
        assert_close(b.lattice.critical_stretch[k], weak ? 0.05 : 0.1, 1e-17);
        n += weak;
    }
    assert_int_equal(b.facts.weak.weaknesses.n_springs, n);
    assert_int_equal(b.facts.weak.weaknesses.n_triangles, 0); /* none breaks by its stress */
    assert_null(b.lattice.strength);
}

TEST(factors_of_several_weaknesses_multiply)
{
    CLEANUP(drop_built) built b;
    build_good(&b, RUN GLASS BLOCK "&weakness shape = 'rectangle', centre = 0, 0, size = 4, 40, strength = 0.5 /\n"
                                   "&weakness shape = 'rectangle', centre = 0, 0, size = 40, 4, strength = 0.25 /");
    for (dem_index t = 0; t < b.lattice.n_triangles; t++) {
        double at[2];
        find_middle(at, &b.lattice, b.lattice.triangles + 3 * t, 3);
        assert_close(b.lattice.strength[t], 1e6 * (fabs(at[0]) <= 2.0 ? 0.5 : 1.0) * (at[1] <= 2.0 ? 0.25 : 1.0), 0.0);
    }
}

/* Two lines far from each other, along rows: neither weakens what the other one touches. */
TEST(each_weakness_has_its_own_factor)
{
    for (int kind = 0; kind < 2; kind++) {
        CLEANUP(drop_built) built b;
        char text[1024];
        (void)snprintf(text, sizeof text,
                       "%s&weakness points = -9, 1, 9, 1, strength = 0.5 /\n&weakness points = -9, 4, 9, 4, strength = "
                       "0.25 /\n&weakness body = 2, points = -9, 2, 9, 2, strength = 0.125 /\n",
                       kind == 0 ? RUN GLASS BLOCK BLOCK : RUN WEB BLOCK BLOCK);
        build_good(&b, text);
        const dem_lattice *l = &b.lattice;
        for (dem_index k = 0; k < (kind == 0 ? l->n_triangles : l->n_springs); k++) {
            double y[2];
            find_heights(y, l, kind == 0 ? l->triangles + 3 * k : l->ends + 2 * k, kind == 0 ? 3 : 2);
            const double factor = y[0] < 1.0 && y[1] > 1.0 ? 0.5 : (y[0] < 4.0 && y[1] > 4.0 ? 0.25 : 1.0);
            assert_close(kind == 0 ? l->strength[k] / 1e6 : l->critical_stretch[k] / 0.1, factor, 1e-15);
        }
    }
}

/* By the centre of the cell; of a line both triangles where it crosses one. */
TEST(cells_are_weakened_as_a_whole)
{
    CLEANUP(drop_built) built b;
    dem_index n = 0;
    build_good(&b, RUN GLASS CELLS "&weakness shape = 'disc', centre = 1, 3, radius = 1.3, strength = 0.5 /");
    for (dem_index t = 0; t < b.lattice.n_triangles; t++) {
        double of[2], next[2];
        find_middle(of, &b.lattice, b.lattice.triangles + 3 * t, 3);
        find_middle(next, &b.lattice, b.lattice.triangles + 3 * (t ^ 1), 3);
        const bool weak = hypot(0.5 * (of[0] + next[0]) - 1.0, 0.5 * (of[1] + next[1]) - 3.0) <= 1.3;
        assert_close(b.lattice.strength[t], weak ? 0.5e6 : 1e6, 0.0);
        n += weak;
    }
    assert_true(n > 10);
    CLEANUP(drop_built) built line;
    CLEANUP(drop_built) built cracked;
    build_good(&line, RUN GLASS CELLS "&weakness points = -3, 1.1, 0.2, 2.7, strength = 0.5 /");
    build_good(&cracked, RUN GLASS CELLS "&crack points = -3, 1.1, 0.2, 2.7 /");
    for (dem_index t = 0; t < line.lattice.n_triangles; t += 2)
        assert_close(line.lattice.strength[t], line.lattice.strength[t + 1], 0.0);
    assert_int_equal(line.facts.weak.weaknesses.n_triangles, line.lattice.n_triangles - cracked.lattice.n_triangles);
}

/* What is drawn is what would be drawn without, times the factor, and also where the draw has been raised. */
TEST(weak_places_scatter_as_their_surroundings)
{
#define DRAWN                                                                                                          \
    RUN "&material name = 'm', " STIFF                                                                                 \
        ", fracture = 'stress', strength = 1e6, weibull = 2, weibull_volume = 0.05 /\n" BLOCK
    CLEANUP(drop_built) built plain;
    CLEANUP(drop_built) built weak;
    build_good(&plain, DRAWN);
    build_good(&weak, DRAWN "&weakness shape = 'rectangle', centre = 0, 0, size = 4, 40, strength = 0.5 /");
    assert_true(plain.facts.strengths.triangles.n_raised > 0);
    for (dem_index t = 0; t < plain.lattice.n_triangles; t++) {
        double at[2];
        find_middle(at, &plain.lattice, plain.lattice.triangles + 3 * t, 3);
        assert_close(weak.lattice.strength[t], plain.lattice.strength[t] * (fabs(at[0]) <= 2.0 ? 0.5 : 1.0), 0.0);
    }
}

/* The toughness over strength^2 a/E (crack_band.c), from q = 2 on. */
static double toughness_of(double softening)
{
    return softening < 6.0 ? 2.0 + 1.07 * softening : 8.42 + 1.29 * (softening - 6.0);
}

TEST(where_a_fracture_energy_is_given_it_stays)
{
    CLEANUP(drop_built) built b;
    build_good(&b, RUN "&material name = 'm', " STIFF
                       ", fracture = 'stress', strength = 1e4, fracture_energy = 100 /\n" BLOCK
                       "&weakness shape = 'disc', centre = 1, 3, radius = 1.3, strength = 0.25 /");
    double before = 0.0;
    for (dem_index t = 0; t < b.lattice.n_triangles && before == 0.0; t++)
        if (b.lattice.strength[t] == 1e4) before = toughness_of(b.lattice.softening[t]);
    assert_true(before > 4.0);
    for (dem_index t = 0; t < b.lattice.n_triangles; t++) {
        const double f = b.lattice.strength[t] / 1e4;
        assert_close(toughness_of(b.lattice.softening[t]) * f * f, before, 1e-9 * before);
    }
    assert_true(b.facts.weak.weaknesses.n_triangles > 30);
}

TEST(a_toughness_is_a_factor_of_the_fracture_energy)
{
#define SOFT "&material name = 'm', " STIFF ", fracture = 'stress', strength = 1e4, fracture_energy = 100 /\n"
    CLEANUP(drop_built) built b;
    build_good(&b, RUN SOFT BLOCK
               "&weakness shape = 'disc', centre = 1, 3, radius = 1.3, strength = 0.5, toughness = 0.3 /\n"
               "&weakness shape = 'disc', centre = 1, 3, radius = 0.7, strength = 1, toughness = 0.9 /");
    double before = 0.0;
    for (dem_index t = 0; t < b.lattice.n_triangles && before == 0.0; t++)
        if (b.lattice.strength[t] == 1e4) before = toughness_of(b.lattice.softening[t]);
    for (dem_index t = 0; t < b.lattice.n_triangles; t++) {
        double at[2];
        find_middle(at, &b.lattice, b.lattice.triangles + 3 * t, 3);
        const double away = hypot(at[0] - 1.0, at[1] - 3.0), f = b.lattice.strength[t] / 1e4;
        const double factor = away <= 0.7 ? 0.27 : (away <= 1.3 ? 0.3 : 1.0);
        assert_close(f, away <= 1.3 ? 0.5 : 1.0, 1e-15);
        assert_close(toughness_of(b.lattice.softening[t]) * f * f, factor * before, 1e-9 * before);
    }
#undef SOFT
}

/* ---- interfaces ---- */

/* An inclusion of the triangles below a row: at its edge are the rows above and below it. */
TEST(an_interface_weakens_both_rows_at_its_edge)
{
    const double edge = 5.0 * sqrt(3.0) / 4.0;
    CLEANUP(drop_built) built b;
    char text[1024];
    dem_index n = 0;
    (void)snprintf(
        text, sizeof text,
        "%s&inclusion material = 'n', shape = 'rectangle', centre = 0, 0, size = 20, %.17g, interface = 0.5 /",
        RUN GLASS OTHER BLOCK, 2.0 * edge);
    build_good(&b, text);
    for (dem_index t = 0; t < b.lattice.n_triangles; t++) {
        double y[2];
        find_heights(y, &b.lattice, b.lattice.triangles + 3 * t, 3);
        const bool below = y[1] < edge + 1e-9, weak = fabs(y[0] - edge) < 1e-9 || fabs(y[1] - edge) < 1e-9;
        assert_close(b.lattice.strength[t], (below ? 3e6 : 1e6) * (weak ? 0.5 : 1.0), 0.0);
        n += weak;
    }
    assert_int_equal(b.facts.weak.interfaces.n_triangles, n);
    assert_int_equal(b.facts.weak.weaknesses.n_triangles, 0);
}

TEST(an_interface_weakens_the_springs_that_end_there)
{
    const double edge = 5.0 * sqrt(3.0) / 4.0;
    CLEANUP(drop_built) built b;
    char text[1024];
    (void)snprintf(
        text, sizeof text,
        "%s&inclusion material = 'm', shape = 'rectangle', centre = 0, 0, size = 20, %.17g, interface = 0.5 /",
        RUN WEB BLOCK, 2.0 * edge);
    build_good(&b, text);
    for (dem_index k = 0; k < b.lattice.n_springs; k++) {
        double y[2];
        find_heights(y, &b.lattice, b.lattice.ends + 2 * k, 2);
        const bool weak = fabs(y[0] - edge) < 1e-9 || fabs(y[1] - edge) < 1e-9;
        assert_close(b.lattice.critical_stretch[k], weak ? 0.05 : 0.1, 1e-17);
    }
}

/* Two grains of the matrix's own material, one above the other: between them the smaller factor counts, not both. */
TEST(of_two_interfaces_the_smaller_factor_counts)
{
    const double low = 4.0 * sqrt(3.0) / 4.0, high = 8.0 * sqrt(3.0) / 4.0;
    CLEANUP(drop_built) built b;
    char text[1024];
    (void)snprintf(
        text, sizeof text,
        "%s&inclusion material = 'm', shape = 'rectangle', centre = 0, 0, size = 20, %.17g, interface = 0.5 /\n"
        "&inclusion material = 'm', shape = 'rectangle', centre = 0, %.17g, size = 20, %.17g, interface = 0.75 "
        "/",
        RUN GLASS BLOCK, 2.0 * low, 0.5 * (low + high), high - low);
    build_good(&b, text);
    for (dem_index t = 0; t < b.lattice.n_triangles; t++) {
        double y[2];
        find_heights(y, &b.lattice, b.lattice.triangles + 3 * t, 3);
        const bool at_low = fabs(y[0] - low) < 1e-9 || fabs(y[1] - low) < 1e-9;
        const bool at_high = fabs(y[0] - high) < 1e-9 || fabs(y[1] - high) < 1e-9;
        assert_close(b.lattice.strength[t], 1e6 * (at_low ? 0.5 : (at_high ? 0.75 : 1.0)), 0.0);
    }
}

/* ---- what touches nothing ---- */

static void expect_fault(const char *text, int line, const char *parts)
{
    CLEANUP(drop_built) built b;
    char got[1024];
    build(&b, text);
    list_faults(&b.errors, got, sizeof got);
    assert_int_equal(b.errors.n, 1);
    assert_int_equal(b.errors.list[0].place.line, line);
    if (!message_has_parts(got, parts)) fail_msg("'%s' has not the parts '%s'", got, parts);
    assert_int_equal(b.lattice.n_nodes, 0);
}

TEST(what_touches_nothing_that_can_break_is_a_fault)
{
    expect_fault(RUN GLASS BLOCK "&weakness strength = 0.5,\n points = 90, 1, 91, 2 /", 5,
                 "weakness touches nothing of body 1 * points * own coordinates");
    expect_fault(RUN GLASS BLOCK "&weakness strength = 0.5, shape = 'disc', radius = 1,\n centre = 90, 1 /", 5,
                 "weakness touches nothing of body 1 * centre * own coordinates");
    expect_fault(RUN SOLID BLOCK "&weakness strength = 0.5,\n points = -9, 1, 9, 2 /", 5,
                 "weakness touches nothing of body 1 * 'fracture'");
    expect_fault(RUN GLASS BLOCK "&weakness strength = 0.5, points = -9, 1, 9, 2,\n toughness = 0.5 /", 5,
                 "'toughness' in &weakness * body 1 softens * 'fracture_energy'");
    expect_fault(RUN SOLID BLOCK "&inclusion material = 'm', centre = 0, 3, radius = 1,\n interface = 0.5 /", 5,
                 "'interface' in &inclusion * body 1 * 'fracture'");
    expect_fault(RUN GLASS BLOCK "&inclusion material = 'm', centre = 0, 3, radius = 100,\n interface = 0.5 /", 5,
                 "'interface' in &inclusion * nothing at its edge");
}

/* Only the inclusion breaks. */
TEST(a_weakness_may_be_in_what_breaks_of_a_body_that_does_not)
{
    CLEANUP(drop_built) built b;
    build_good(&b, RUN SOLID OTHER BLOCK "&inclusion material = 'n', centre = 0, 3, radius = 1, interface = 0.5 /\n"
                                         "&weakness strength = 0.5, points = -9, 3, 9, 3.1 /");
    dem_index n_weak = 0;
    for (dem_index t = 0; t < b.lattice.n_triangles; t++) n_weak += b.lattice.strength[t] == 0.75e6;
    assert_true(n_weak > 0);
    assert_true(b.facts.weak.weaknesses.n_triangles < 20);
}
