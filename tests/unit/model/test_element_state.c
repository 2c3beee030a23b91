/* SPDX-License-Identifier: BSD-3-Clause */
/* element_state.c: what is left when triangles break is what would have been there without them from the start. */
#include "verification/support.h"

#include <stdlib.h>

#include "model/element_state.h"
#include "unit/model/cut_solids.h"

/* A lattice with its state. Stays where it is: it points to itself. */
typedef struct subject {
    dem_lattice lattice;
    springs springs;
    element_state state;
} subject;

static void open_subject(subject *s, dem_lattice lattice)
{
    *s = (subject){.lattice = lattice};
    assert_ok(springs_compile(&s->springs, &s->lattice));
    assert_ok(element_state_create(&s->state, &s->lattice, &s->springs));
}

static void close_subject(subject *s)
{
    element_state_destroy(&s->state);
    springs_free(&s->springs);
    dem_lattice_free(&s->lattice);
}

/* Stiffness of the spring between the same two nodes; 0: there is none. */
static double same_spring(const dem_lattice *l, const double *a, const double *b)
{
    const dem_index i = same_node(l, a), j = same_node(l, b);
    for (dem_index k = 0; k < l->n_springs; k++) {
        const dem_index *e = &l->ends[2 * k];
        if ((e[0] == i && e[1] == j) || (e[0] == j && e[1] == i)) return l->stiffness[k];
    }
    return 0.0;
}

/* Sums of two numbers that are rounded once each, and a share that is rounded to 2^-52. */
TEST(what_is_left_is_the_solid_without_the_broken_triangles)
{
    for (int kind = 0; kind < N_KINDS; kind++) {
        CLEANUP(close_subject) subject s;
        CLEANUP(dem_lattice_free) dem_lattice cut = cut_solid(kind);
        dem_index n_broken = 0, n_weaker = 0;
        open_subject(&s, solid_of(kind));
        for (dem_index t = 0; t < s.lattice.n_triangles; t++)
            if (breaks(kind, t)) element_state_break_triangle(&s.state, t);
        for (dem_index k = 0; k < s.lattice.n_springs; k++) {
            const dem_index *e = &s.lattice.ends[2 * k];
            const double left = s.state.integrity[k], own = s.lattice.stiffness[k];
            const double expected = same_spring(&cut, &s.lattice.x[2 * e[0]], &s.lattice.x[2 * e[1]]);
            assert_close(left * own, expected, 1e-15 * own);
            assert_int_equal(left == 0.0, expected == 0.0);
            n_broken += left == 0.0;
            n_weaker += left > 0.0 && left < 1.0;
        }
        assert_true(n_broken > 20 && n_weaker > 20);
    }
}

/* To the bit, and the list of nodes has the same ones. */
TEST(the_order_of_breaking_does_not_matter)
{
    for (int kind = 0; kind < N_KINDS; kind++) {
        CLEANUP(close_subject) subject s, other;
        open_subject(&s, solid_of(kind));
        open_subject(&other, solid_of(kind));
        const dem_index n = s.lattice.n_triangles;
        for (dem_index t = 0; t < n; t++) {
            if (breaks(kind, t)) element_state_break_triangle(&s.state, t);
            if (breaks(kind, n - 1 - t)) element_state_break_triangle(&other.state, n - 1 - t);
        }
        const size_t n_springs = (size_t)s.lattice.n_springs;
        assert_memory_equal(s.state.integrity, other.state.integrity, n_springs * sizeof(double));
        assert_memory_equal(s.state.node, other.state.node, (size_t)s.lattice.n_nodes);
        assert_int_equal(s.state.n_damaged, other.state.n_damaged);
    }
}

/* Breaks that are taken back, in any order, leave what was before to the bit. */
TEST(a_break_is_taken_back_to_the_bit)
{
    for (int kind = 0; kind < N_KINDS; kind++) {
        CLEANUP(close_subject) subject s, other;
        open_subject(&s, solid_of(kind));
        open_subject(&other, solid_of(kind));
        const dem_index n = s.lattice.n_triangles;
        const size_t n_springs = (size_t)s.lattice.n_springs;
        for (dem_index t = 0; t < n; t += 3) {
            element_state_break(&s.state, t);
            element_state_break(&other.state, t);
        }
        const dem_index n_damaged = s.state.n_damaged;
        for (dem_index t = 0; t < n; t++)
            if (t % 3 > 0) element_state_break(&s.state, t);
        for (dem_index t = 0; t < n; t++)
            if (t % 3 > 0) element_state_mend(&s.state, t);
        element_state_forget_nodes(&s.state, n_damaged);
        assert_memory_equal(s.state.integrity, other.state.integrity, n_springs * sizeof(double));
        assert_memory_equal(s.state.triangle, other.state.triangle, (size_t)n);
        assert_memory_equal(s.state.node, other.state.node, (size_t)s.lattice.n_nodes);
        assert_int_equal(s.state.n_damaged, other.state.n_damaged);
    }
}

/* Ratios that differ from triangle to triangle, some of them brittle. */
static void make_soft(dem_lattice *l)
{
    l->softening = malloc((size_t)l->n_triangles * sizeof *l->softening);
    assert_non_null(l->softening);
    for (dem_index t = 0; t < l->n_triangles; t++) l->softening[t] = t % 5 == 0 ? 1.0 : 1.5 + 0.37 * (double)(t % 7);
}

static void open_soft(subject *s, int kind)
{
    dem_lattice soft = solid_of(kind);
    make_soft(&soft);
    open_subject(s, soft);
}

/* A level for each triangle, and those that are broken besides; brittle ones have none. */
static void weaken_some(element_state *s, dem_index t)
{
    const int levels = softening_levels(s->lattice->softening[t]);
    for (int k = 0; k < (int)(t * 11 % 33) && k < levels; k++) element_state_soften(s, t);
    if (t % 4 == 0) element_state_break_triangle(s, t);
}

static void assert_same_state(const subject *s, const subject *other)
{
    const size_t n_springs = (size_t)s->lattice.n_springs, n_triangles = (size_t)s->lattice.n_triangles;
    assert_memory_equal(s->state.integrity, other->state.integrity, n_springs * sizeof(double));
    assert_memory_equal(s->state.tension, other->state.tension, n_springs * sizeof(double));
    assert_memory_equal(s->state.left, other->state.left, n_triangles * sizeof(double));
    assert_memory_equal(s->state.level, other->state.level, n_triangles);
    assert_memory_equal(s->state.triangle, other->state.triangle, n_triangles);
    assert_memory_equal(s->state.node, other->state.node, (size_t)s->lattice.n_nodes);
    assert_int_equal(s->state.n_damaged, other->state.n_damaged);
    assert_int_equal(element_state_n_failures(&s->state), element_state_n_failures(&other->state));
}

/* What is left of a spring in tension is the sum of its shares times what is left of the triangles that have them; each
 * of the two at most is rounded to 2^-52. */
TEST(a_spring_has_in_tension_what_its_triangles_leave)
{
    for (int kind = 0; kind < N_KINDS; kind++) {
        CLEANUP(close_subject) subject s;
        open_soft(&s, kind);
        for (dem_index t = 0; t < s.lattice.n_triangles; t++) weaken_some(&s.state, t);
        CLEANUP(free_memory) double *sum = calloc((size_t)s.lattice.n_springs, sizeof *sum);
        assert_non_null(sum);
        for (dem_index t = 0; t < s.lattice.n_triangles; t++)
            for (dem_index p = s.state.row[t]; p < s.state.row[t + 1] && !s.state.triangle[t]; p++)
                sum[s.state.spring[p]] += s.state.share[p] * softening_left(s.lattice.softening[t], s.state.level[t]);
        for (dem_index k = 0; k < s.lattice.n_springs; k++) {
            assert_close(s.state.tension[k], sum[k], 4e-16);
            assert_true(s.state.tension[k] <= s.state.integrity[k]);
            assert_int_equal(s.state.tension[k] == 0.0, s.state.integrity[k] == 0.0);
        }
    }
}

/* To the bit, as of breaks alone. */
TEST(the_order_of_softening_does_not_matter)
{
    for (int kind = 0; kind < N_KINDS; kind++) {
        CLEANUP(close_subject) subject s, other;
        open_soft(&s, kind);
        open_soft(&other, kind);
        for (dem_index t = 0; t < s.lattice.n_triangles; t++) {
            weaken_some(&s.state, t);
            weaken_some(&other.state, s.lattice.n_triangles - 1 - t);
        }
        assert_same_state(&s, &other);
    }
}

TEST(softening_is_taken_back_to_the_bit)
{
    for (int kind = 0; kind < N_KINDS; kind++) {
        CLEANUP(close_subject) subject s, other;
        open_soft(&s, kind);
        open_soft(&other, kind);
        const dem_index n = s.lattice.n_triangles;
        for (dem_index t = 0; t < n; t += 3) weaken_some(&s.state, t);
        for (dem_index t = 0; t < n; t += 3) weaken_some(&other.state, t);
        const dem_index n_damaged = s.state.n_damaged;
        for (dem_index t = 0; t < n; t++) {
            if (s.state.triangle[t] || t % 2 == 0 || element_state_is_last(&s.state, t))
                element_state_break(&s.state, t);
            else
                element_state_soften(&s.state, t);
        }
        for (dem_index t = n - 1; t >= 0; t--)
            if (s.state.triangle[t] != other.state.triangle[t] || s.state.level[t] != other.state.level[t])
                element_state_mend(&s.state, t);
        element_state_forget_nodes(&s.state, n_damaged);
        assert_same_state(&s, &other);
    }
}

/* With the triangles all of their springs go, of any shape and material. */
TEST(nothing_is_left_without_triangles)
{
    for (int kind = 0; kind < N_KINDS; kind++) {
        CLEANUP(close_subject) subject s;
        open_subject(&s, solid_of(kind));
        for (dem_index t = 0; t < s.lattice.n_triangles; t++) {
            element_state_break_triangle(&s.state, t);
            element_state_break_triangle(&s.state, t); /* once more changes nothing */
        }
        for (dem_index k = 0; k < s.lattice.n_springs; k++) assert_close(s.state.integrity[k], 0.0, 0.0);
        assert_int_equal(s.state.n_damaged, s.lattice.n_nodes);
    }
}

/* ---- nodes ---- */

/* Two triangles, 0 1 2 and 1 3 2, and their springs. */
static dem_lattice two_triangles(void)
{
    dem_lattice lattice = dem_lattice_empty();
    assert_ok(dem_lattice_squares(&lattice, 1.0, 1.0, 1.0));
    assert_int_equal(lattice.n_triangles, 2);
    assert_ok(dem_lattice_assemble(&lattice, &rubber));
    assert_int_equal(lattice.n_springs, 5);
    return lattice;
}

TEST(all_are_whole_at_first)
{
    CLEANUP(close_subject) subject s;
    open_subject(&s, two_triangles());
    assert_int_equal(s.state.n_damaged, 0);
    for (dem_index k = 0; k < 5; k++) assert_close(s.state.integrity[k], 1.0, 0.0);
    for (dem_index k = 0; k < 2; k++) assert_int_equal(s.state.triangle[k], 0);
    for (dem_index i = 0; i < 4; i++) assert_null(element_state_at(&s.state, i));
    element_state_destroy(&s.state);
    assert_null(s.state.integrity);
}

TEST(no_state_is_one_of_whole_elements)
{
    assert_null(element_state_at(NULL, 3));
    assert_null(element_state_springs(NULL).pushed);
    assert_null(element_state_triangles(NULL).broken);
}

/* The triangle that is left is beside all nodes of its own; the fourth one has lost all it had. */
TEST(a_node_beside_what_is_broken_is_listed_once)
{
    CLEANUP(close_subject) subject s;
    open_subject(&s, two_triangles());
    const dem_index *corner = s.lattice.triangles;
    element_state_break_triangle(&s.state, 0);
    assert_int_equal(s.state.n_damaged, 3);
    for (int c = 0; c < 3; c++) assert_ptr_equal(element_state_at(&s.state, corner[c]), &s.state);
    dem_index n_half = 0, n_gone = 0;
    for (dem_index k = 0; k < 5; k++) {
        n_half += s.state.integrity[k] == 0.5; /* the side between the two */
        n_gone += s.state.integrity[k] == 0.0;
    }
    assert_int_equal(n_half, 1);
    assert_int_equal(n_gone, 2);
    assert_ptr_equal(element_state_springs(&s.state).pushed, s.state.integrity);
    assert_ptr_equal(element_state_triangles(&s.state).broken, s.state.triangle);
}

/* A chain: no triangle holds its springs. */
TEST(a_spring_outside_of_triangles_breaks_alone)
{
    dem_index ends[4] = {0, 1, 1, 2};
    double x[6] = {0.0, 0.0, 1.0, 0.0, 2.0, 0.0}, ones[3] = {1.0, 1.0, 1.0};
    const dem_lattice chain = {.dim = 2,
                               .n_nodes = 3,
                               .n_springs = 2,
                               .x = x,
                               .ends = ends,
                               .rest_length = ones,
                               .stiffness = ones,
                               .mass = ones};
    CLEANUP(springs_free) springs list;
    CLEANUP(element_state_destroy) element_state s;
    assert_ok(springs_compile(&list, &chain));
    assert_ok(element_state_create(&s, &chain, &list));
    element_state_break_spring(&s, 1);
    element_state_break_spring(&s, 1);
    assert_close(s.integrity[0], 1.0, 0.0);
    assert_close(s.integrity[1], 0.0, 0.0);
    assert_int_equal(s.n_damaged, 2);
    assert_null(element_state_at(&s, 0));
}

/* As long as all are whole there is nothing of springs; then all is that of a state that was ready from the start. */
TEST(a_state_is_made_ready_when_something_breaks)
{
    for (int kind = 0; kind < N_KINDS; kind++) {
        CLEANUP(close_subject) subject s;
        CLEANUP(element_state_destroy) element_state later;
        open_subject(&s, solid_of(kind));
        const dem_index n = s.lattice.n_triangles, n_slots = s.state.row[n];
        assert_ok(element_state_begin(&later, &s.lattice, &s.springs));
        assert_null(element_state_springs(&later).pushed);
        assert_null(later.share);
        assert_int_equal(element_state_level(&later, n - 1), 0);
        for (int turn = 0; turn < 2; turn++) assert_ok(element_state_prepare(&later));
        assert_memory_equal(later.row, s.state.row, (size_t)(n + 1) * sizeof *later.row);
        assert_memory_equal(later.spring, s.state.spring, (size_t)n_slots * sizeof *later.spring);
        assert_memory_equal(later.share, s.state.share, (size_t)n_slots * sizeof *later.share);
        for (dem_index t = 0; t < n; t += 3) {
            element_state_break(&later, t);
            element_state_break(&s.state, t);
        }
        assert_memory_equal(later.integrity, s.state.integrity, (size_t)s.lattice.n_springs * sizeof(double));
    }
}
