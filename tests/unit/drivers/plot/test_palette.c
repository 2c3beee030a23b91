/* SPDX-License-Identifier: BSD-3-Clause */
/* palette.c: what the colours promise, measured by way back to CIELAB and through the eyes of the colour-blind. */
#include "unit/close.h"

#include "palette.h"

typedef struct lab {
    double light, a, b;
} lab;

static double decode(double x)
{
    return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4);
}

static double bend(double t)
{
    return t > 216.0 / 24389.0 ? cbrt(t) : (24389.0 / 27.0 * t + 16.0) / 116.0;
}

static lab lab_of(const double linear[3])
{
    const double x = 0.4124564 * linear[0] + 0.3575761 * linear[1] + 0.1804375 * linear[2];
    const double y = 0.2126729 * linear[0] + 0.7151522 * linear[1] + 0.0721750 * linear[2];
    const double z = 0.0193339 * linear[0] + 0.1191920 * linear[1] + 0.9503041 * linear[2];
    const double fx = bend(x / 0.95047), fy = bend(y), fz = bend(z / 1.08883);
    return (lab){116.0 * fy - 16.0, 500.0 * (fx - fy), 200.0 * (fy - fz)};
}

/* How an eye that lacks a receptor sees it: G. M. Machado, M. M. Oliveira, L. A. F. Fernandes, IEEE Trans. Vis. Comput.
 * Graph. 15 (2009) 1291, severity 1: protanopia, deuteranopia, tritanopia; and the common eye. */
static const double eyes[][3][3] = {
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
    {{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}},
    {{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}},
    {{1.255528, -0.076749, -0.178779}, {-0.078411, 0.930809, 0.147602}, {0.004733, 0.691367, 0.303900}}};

static lab seen(colour c, int eye)
{
    const double rgb[3] = {decode(c.red / 255.0), decode(c.green / 255.0), decode(c.blue / 255.0)};
    double own[3];
    for (int i = 0; i < 3; i++) {
        own[i] = 0.0;
        for (int j = 0; j < 3; j++) own[i] += eyes[eye][i][j] * rgb[j];
        own[i] = fmin(fmax(own[i], 0.0), 1.0);
    }
    return lab_of(own);
}

static double distance(lab p, lab q)
{
    return sqrt((p.light - q.light) * (p.light - q.light) + (p.a - q.a) * (p.a - q.a) + (p.b - q.b) * (p.b - q.b));
}

TEST(the_middle_of_diverging_is_grey_and_lightest)
{
    const palette p = palette_make(PALETTE_DIVERGING);
    const lab middle = seen(p.of[PALETTE_SIZE / 2], 0);
    assert_close(middle.a, 0.0, 1.0); /* rounding to bytes */
    assert_close(middle.b, 0.0, 1.0);
    for (int k = 0; k < PALETTE_SIZE / 2; k++) {
        assert_true(seen(p.of[k], 0).light <= seen(p.of[k + 1], 0).light + 0.5);
        assert_true(seen(p.of[PALETTE_SIZE - 1 - k], 0).light <= seen(p.of[PALETTE_SIZE - 2 - k], 0).light + 0.5);
    }
}

/* Equal sizes are equally dark: to 2 of 100, where the blue leaves what a screen can show. */
TEST(both_sides_of_diverging_are_as_dark)
{
    const palette p = palette_make(PALETTE_DIVERGING);
    for (int k = 0; k < PALETTE_SIZE / 2; k++)
        assert_close(seen(p.of[k], 0).light, seen(p.of[PALETTE_SIZE - 1 - k], 0).light, 2.0);
}

TEST(a_half_of_diverging_has_its_colours)
{
    const palette whole = palette_make(PALETTE_DIVERGING), upper = palette_make(PALETTE_UPPER),
                  lower = palette_make(PALETTE_LOWER);
    for (int k = 0; k <= PALETTE_SIZE / 2; k++) {
        assert_memory_equal(&upper.of[2 * k], &whole.of[PALETTE_SIZE / 2 + k], sizeof(colour));
        assert_memory_equal(&lower.of[2 * k], &whole.of[k], sizeof(colour));
    }
}

TEST(a_limit_of_0_takes_a_half_of_diverging)
{
    assert_int_equal(palette_between(PALETTE_DIVERGING, -1.0, 1.0), PALETTE_DIVERGING);
    assert_int_equal(palette_between(PALETTE_DIVERGING, 0.5, 1.0), PALETTE_DIVERGING);
    assert_int_equal(palette_between(PALETTE_DIVERGING, 0.0, 1.0), PALETTE_UPPER);
    assert_int_equal(palette_between(PALETTE_DIVERGING, -1.0, 0.0), PALETTE_LOWER);
    assert_int_equal(palette_between(PALETTE_SEQUENTIAL, 0.0, 1.0), PALETTE_SEQUENTIAL);
}

/* 20 is a plain difference, 2 one that can just be seen. */
TEST(every_eye_tells_the_sides_apart)
{
    const palette p = palette_make(PALETTE_DIVERGING);
    for (int eye = 0; eye < 4; eye++)
        for (int k = 0; k < PALETTE_SIZE / 3; k++)
            assert_true(distance(seen(p.of[k], eye), seen(p.of[PALETTE_SIZE - 1 - k], eye)) > 20.0);
}

TEST(sequential_darkens_evenly_to_every_eye)
{
    const palette p = palette_make(PALETTE_SEQUENTIAL);
    for (int eye = 0; eye < 4; eye++)
        for (int k = 0; k + 16 < PALETTE_SIZE; k += 16)
            assert_true(seen(p.of[k], eye).light - seen(p.of[k + 16], eye).light > 2.0);
}

/* White paper: the lightest still stands out. */
TEST(nothing_vanishes_on_paper)
{
    const lab white = {100.0, 0.0, 0.0};
    for (int kind = PALETTE_DIVERGING; kind <= PALETTE_SEQUENTIAL; kind++) {
        const palette p = palette_make((palette_kind)kind);
        for (int k = 0; k < PALETTE_SIZE; k++) assert_true(distance(seen(p.of[k], 0), white) > 20.0);
    }
}

TEST(places_are_linear_and_end_at_the_limits)
{
    assert_int_equal(palette_index(-2.0, -2.0, 2.0), 0);
    assert_int_equal(palette_index(0.0, -2.0, 2.0), PALETTE_SIZE / 2);
    assert_int_equal(palette_index(2.0, -2.0, 2.0), PALETTE_SIZE - 1);
    assert_int_equal(palette_index(1.0, -2.0, 2.0), PALETTE_SIZE / 2 + (PALETTE_SIZE - 1) / 4 + 1);
    assert_int_equal(palette_index(-1e300, -2.0, 2.0), 0);
    assert_int_equal(palette_index((double)INFINITY, -2.0, 2.0), PALETTE_SIZE - 1);
    assert_int_equal(palette_index((double)NAN, -2.0, 2.0), 0);
}

TEST(plain_has_one_colour)
{
    const palette p = palette_plain((colour){1, 2, 3});
    assert_memory_equal(&p.of[0], &((colour){1, 2, 3}), sizeof(colour));
    for (int k = 1; k < PALETTE_SIZE; k++) assert_memory_equal(&p.of[k], &p.of[0], sizeof(colour));
}
