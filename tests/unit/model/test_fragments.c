/* SPDX-License-Identifier: BSD-3-Clause */
/* fragments.c: the same pieces as a fill that goes from node to node, named by their lowest nodes. */
#include "verification/support.h"

#include <stdlib.h>
#include <string.h>

#include "ask.h"
#include "model/fragments.h"

enum { max_nodes = 40, max_springs = 120, n_lattices = 500 };

typedef struct random_lattice {
    dem_lattice lattice;
    dem_index ends[2 * max_springs], fragment[max_nodes];
    double integrity[max_springs];
    uint64_t seed;
} random_lattice;

static dem_index draw(random_lattice *r, dem_index n)
{
    r->seed = r->seed * 6364136223846793005u + 1442695040888963407u;
    return (dem_index)((r->seed >> 33) % (uint64_t)n);
}

/* Any two nodes may have a spring, so that pieces are of all sizes; a spring is broken, softened or as it was. */
static void make_random(random_lattice *r)
{
    dem_lattice *l = &r->lattice;
    *l = (dem_lattice){.dim = 2, .n_nodes = 2 + draw(r, max_nodes - 1), .ends = r->ends};
    l->n_springs = draw(r, 3 * l->n_nodes + 1);
    for (dem_index k = 0; k < l->n_springs; k++) {
        r->ends[2 * k] = draw(r, l->n_nodes);
        r->ends[2 * k + 1] = (r->ends[2 * k] + 1 + draw(r, l->n_nodes - 1)) % l->n_nodes;
        r->integrity[k] = 0.25 * (double)(draw(r, 8) > 4 ? 1 + draw(r, 4) : 0);
    }
}

/* Sweeps over the springs until no number spreads any more. */
static void fill(const random_lattice *r, dem_index *number, dem_index from)
{
    number[from] = from;
    for (bool grows = true; grows;) {
        grows = false;
        for (dem_index k = 0; k < r->lattice.n_springs; k++) {
            const dem_index i = r->ends[2 * k], j = r->ends[2 * k + 1];
            if (r->integrity[k] == 0.0 || (number[i] == from) == (number[j] == from)) continue;
            number[i] = number[j] = from;
            grows = true;
        }
    }
}

static void check_against_fill(const random_lattice *r, dem_index n_fragments)
{
    dem_index number[max_nodes], n = 0;
    for (dem_index i = 0; i < r->lattice.n_nodes; i++) number[i] = -1;
    for (dem_index i = 0; i < r->lattice.n_nodes; i++) {
        if (number[i] >= 0) continue;
        fill(r, number, i);
        n++;
    }
    assert_int_equal(n_fragments, n);
    assert_memory_equal(r->fragment, number, (size_t)r->lattice.n_nodes * sizeof *number);
}

TEST(fragments_are_those_of_a_fill_and_have_the_number_of_their_lowest_node)
{
    random_lattice r = {.seed = 1};
    for (int k = 0; k < n_lattices; k++) {
        make_random(&r);
        check_against_fill(&r, fragments_find(&r.lattice, r.integrity, r.fragment));
    }
}

/* The springs in the reverse order, in an array that has numbers of other pieces. */
TEST(fragments_do_not_depend_on_the_order_of_springs_or_what_was_found_before)
{
    random_lattice r = {.seed = 2}, back;
    for (int k = 0; k < n_lattices; k++) {
        make_random(&r);
        back = r;
        back.lattice.ends = back.ends;
        const dem_index n = r.lattice.n_springs;
        for (dem_index q = 0; q < n; q++) {
            memcpy(&back.ends[2 * q], &r.ends[2 * (n - 1 - q)], 2 * sizeof *r.ends);
            back.integrity[q] = r.integrity[n - 1 - q];
        }
        const dem_index found = fragments_find(&r.lattice, r.integrity, r.fragment);
        assert_int_equal(fragments_find(&back.lattice, back.integrity, back.fragment), found);
        assert_memory_equal(back.fragment, r.fragment, (size_t)r.lattice.n_nodes * sizeof *r.fragment);
    }
}

/* A chain whose nodes are numbered from its far end is a long way to the lowest node. */
TEST(a_body_without_breaks_is_one_fragment)
{
    random_lattice r = {.lattice = {.dim = 2, .n_nodes = max_nodes, .n_springs = max_nodes - 1}};
    r.lattice.ends = r.ends;
    for (dem_index k = 0; k < max_nodes - 1; k++) {
        r.ends[2 * k] = max_nodes - 1 - k;
        r.ends[2 * k + 1] = max_nodes - 2 - k;
    }
    assert_int_equal(fragments_find(&r.lattice, NULL, r.fragment), 1);
    for (dem_index i = 0; i < max_nodes; i++) assert_int_equal(r.fragment[i], 0);
}

/* ---- how much is broken, and into what ---- */

/* A chain of six masses, 1 to 6 kg, broken behind the first and behind the third. */
enum { N = 6 };

static void open_chain(support_run *run)
{
    double x[2 * N], masses[N];
    dem_index ends[2 * (N - 1)];
    for (dem_index i = 0; i < N; i++) {
        x[2 * i] = (double)i;
        x[2 * i + 1] = 0.0;
        masses[i] = (double)(i + 1);
    }
    for (dem_index k = 0; k < 2 * (N - 1); k++) ends[k] = (k + 1) / 2;
    CLEANUP(dem_lattice_free) dem_lattice chain = support_lattice(N, x, masses, N - 1, ends, 1.0, 1.0, NULL);
    const dem_options options = dem_options_default();
    support_open(run, &chain, NULL, 0, &options);
}

TEST(a_whole_chain_is_one_fragment)
{
    CLEANUP(support_close) support_run run;
    open_chain(&run);
    const dem_fracture report = ask_fracture(run.simulation);
    assert_int_equal(report.springs, 0);
    assert_int_equal(report.fragments, 1);
    assert_close(report.largest, 1.0, 0.0);
    assert_close(report.debris, 0.0, 0.0);
    assert_close(report.median, 21.0, 0.0);
}

/* Pieces of 1, 5 and 15 of 21 kg: half of that is reached with the last one. */
TEST(masses_of_fragments_are_those_of_their_nodes)
{
    const dem_index which[] = {0, 2};
    CLEANUP(support_close) support_run run;
    open_chain(&run);
    assert_ok(dem_simulation_break(run.simulation, NULL, 0, which, 2));
    const dem_fracture report = ask_fracture(run.simulation);
    assert_int_equal(report.springs, 2);
    assert_int_equal(report.fragments, 3);
    assert_close(report.largest, 15.0 / 21.0, 1e-16);
    assert_close(report.debris, 1.0 / 21.0, 1e-16);
    assert_close(report.median, 15.0, 0.0);
}

/* All nodes by themselves: 1 + 2 + 3 + 4 kg are less than half of 21, with 5 it is more. */
TEST(single_nodes_are_debris)
{
    const dem_index which[] = {0, 1, 2, 3, 4};
    CLEANUP(support_close) support_run run;
    open_chain(&run);
    assert_ok(dem_simulation_break(run.simulation, NULL, 0, which, 5));
    const dem_fracture report = ask_fracture(run.simulation);
    assert_int_equal(report.fragments, N);
    assert_close(report.largest, 6.0 / 21.0, 1e-16);
    assert_close(report.debris, 1.0, 1e-15);
    assert_close(report.median, 5.0, 0.0);
}

/* A row of triangles of 5 mm is broken across a block: twelve triangles between rows of seven and six nodes are a
 * crack of 30 mm, to rounding. */
TEST(a_row_of_triangles_is_as_long_as_its_springs)
{
    const dem_material rubber = {.struct_size = sizeof(dem_material),
                                 .youngs_modulus = 1e7,
                                 .poissons_ratio = 0.2,
                                 .density = 1050.0,
                                 .thickness = 1.0};
    const dem_options options = dem_options_default();
    CLEANUP(dem_lattice_free) dem_lattice block = support_rectangle(0.03, 0.052, 0.005, &rubber);
    CLEANUP(support_close) support_run run;
    dem_index row[64], n = 0;
    for (dem_index t = 0; t < block.n_triangles; t++) {
        int above = 0;
        for (int c = 0; c < 3; c++) above += block.x[2 * block.triangles[3 * t + c] + 1] > 0.026;
        if (above == 1 || above == 2) row[n++] = t;
        assert_true(n < 64);
    }
    support_open(&run, &block, NULL, 0, &options);
    assert_ok(dem_simulation_break(run.simulation, row, n, NULL, 0));
    const dem_fracture report = ask_fracture(run.simulation);
    assert_int_equal(report.triangles, n);
    assert_int_equal(report.fragments, 2);
    assert_close(report.crack_length, 0.0025 * (double)n, 1e-15);
    assert_close(report.crack_length, 0.03, 0.0026);
}

/* Of few springs there are many pieces, of many one. */
TEST(arrays_chunk_by_chunk_give_the_same)
{
    random_lattice r = {.seed = 77};
    dem_index n_whole = 0;
    for (int k = 0; k < n_lattices; k++) {
        double mass[max_nodes];
        dem_fracture one, other;
        make_random(&r);
        for (dem_index i = 0; i < r.lattice.n_nodes; i++) mass[i] = 0.1 * (double)(1 + draw(&r, 9));
        r.lattice.mass = mass;
        r.lattice.struct_size = sizeof r.lattice;
        const lattice_source from = {.lattice = &r.lattice};
        assert_ok(fragments_measure(&r.lattice, NULL, &one));
        assert_ok(fragments_measure_source(&from, &other));
        assert_int_equal(one.fragments, other.fragments);
        assert_close(one.largest, other.largest, 0.0);
        assert_close(one.median, other.median, 0.0);
        assert_close(one.debris, other.debris, 0.0);
        n_whole += one.fragments == 1;
    }
    assert_in_range(n_whole, n_lattices / 10, n_lattices - n_lattices / 10);
}
