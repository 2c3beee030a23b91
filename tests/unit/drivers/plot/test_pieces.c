/* SPDX-License-Identifier: BSD-3-Clause */
/* pieces.c: which fragments are grey, and that others keep their colours. */
#include "unit/close.h"

#include "palette.h"
#include "pieces.h"

/* Two bodies of eight nodes of 1 kg each. */
enum { N = 16 };
static double mass[N];
static int32_t body[N];

static void open_pieces(pieces *p, dem_lattice *l)
{
    for (int i = 0; i < N; i++) {
        mass[i] = 1.0;
        body[i] = i / 8;
    }
    *l = (dem_lattice){.n_nodes = N, .mass = mass, .body = body};
    assert_true(pieces_create(p, l));
}

static void shade(const double *fragment, double *value)
{
    pieces p;
    dem_lattice l;
    open_pieces(&p, &l);
    pieces_shade(&p, fragment, value);
    pieces_free(&p);
    for (int i = 0; i < N; i++) assert_true(value[i] >= 0.0 && value[i] < PALETTE_SIZE && value[i] == floor(value[i]));
}

TEST(half_of_a_body_is_grey)
{
    const double whole[N] = {0, 0, 0, 0, 0, 0, 0, 0, 8, 8, 8, 8, 8, 8, 8, 8};
    const double parts[N] = {0, 0, 0, 0, 4, 4, 4, 7, 8, 8, 8, 8, 8, 13, 13, 13};
    double value[N];
    shade(whole, value);
    for (int i = 0; i < N; i++) assert_close(value[i], 0.0, 0.0);
    shade(parts, value);
    for (int i = 0; i < N; i++) {
        const bool grey = i < 4 || (i >= 8 && i < 13);
        assert_true((value[i] == 0.0) == grey);
    }
}

/* Of three nodes all but the one that is the key of their colour may break off. */
TEST(a_piece_keeps_its_colour_but_for_one_of_its_nodes)
{
    const double before[N] = {0, 0, 0, 3, 3, 3, 6, 6, 8, 8, 8, 11, 11, 11, 14, 14};
    double value[N], after[N];
    int kept = 0;
    shade(before, value);
    for (int i = 1; i < N; i++) assert_true((value[i] == value[i - 1]) || before[i] != before[i - 1]);
    for (int k = 0; k < 3; k++) {
        double broken[N];
        for (int i = 0; i < N; i++) broken[i] = before[i];
        broken[3 + k] = 3 + k; /* it is alone; the others are named by the lowest of them */
        for (int i = 3; i < 6; i++)
            if (i != 3 + k) broken[i] = k == 0 ? 4 : 3;
        shade(broken, after);
        kept += after[k == 0 ? 4 : 3] == value[3];
    }
    assert_int_equal(kept, 2);
}

/* Where all lose their lowest nodes, which name them, some keep their colours. */
TEST(a_colour_is_not_of_the_number)
{
    const double before[N] = {0, 0, 0, 3, 3, 3, 6, 6, 8, 8, 8, 11, 11, 11, 14, 14};
    const double after[N] = {0, 1, 1, 3, 4, 4, 6, 7, 8, 9, 9, 11, 12, 12, 14, 15};
    double was[N], is[N];
    int kept = 0;
    shade(before, was);
    shade(after, is);
    const int last[4] = {2, 5, 10, 13};
    for (int k = 0; k < 4; k++) kept += is[last[k]] == was[last[k]];
    assert_true(kept > 1);
}

TEST(numbers_that_name_no_fragment_are_grey)
{
    const double wild[N] = {0, NAN, -1, INFINITY, 1e300, 0.5, 7, 6, 9, 2, 10, 11, 12, 13, 14, 15};
    double value[N];
    shade(wild, value);
    for (int i = 1; i < 10; i++) assert_close(value[i], 0.0, 0.0);
    assert_true(value[11] > 0.0);
}
