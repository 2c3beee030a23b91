/* SPDX-License-Identifier: BSD-3-Clause */
/* peaks_file.c: what dem_peaks knows, in the file. */
#include "unit/output/stored.h"

#include <stdlib.h>

#include "output/peaks_file.h"
#include "ask.h"
#include "unit/solids.h"

/* A block in vibration, its peaks over 2e-4 s, and a file of two frames. */
typedef struct stress_case {
    support_run run;
    dem_peaks *peaks;
    stored stored;
    frames frames;
    peaks_report report;
} stress_case;

static stress_case *begin(dem_index most)
{
    const dem_options options = dem_options_default();
    dem_trajectory_options options_of_file = dem_trajectory_options_default();
    stress_case *c = calloc(1, sizeof *c);
    assert_non_null(c);
    dem_lattice lattice = make_solid(0.03, 0.04, 0.01);
    const double none[2] = {0.0, 0.0};
    assert_ok(dem_lattice_launch(&lattice, none));
    for (dem_index i = 0; i < lattice.n_nodes; i++) lattice.velocity[2 * i] = 300.0 * lattice.x[2 * i + 1];
    support_open(&c->run, &lattice, NULL, 0, &options);
    dem_lattice_free(&lattice);
    assert_ok(dem_peaks_create(&c->peaks, c->run.model, 1));
    const dem_observer observer = ask_peaks_observer(c->peaks);
    assert_ok(dem_simulation_observe(c->run.simulation, &observer));
    (void)support_at(&c->run, 2e-4);
    stored_open(&c->stored);
    options_of_file.double_precision = 1;
    frames_init(&c->frames, c->run.model, &options_of_file);
    assert_ok(frames_create(&c->frames, &c->stored.file, &(lattice_source){dem_model_lattice(c->run.model), NULL}));
    c->frames.n = 2;
    c->report = (peaks_report){c->peaks, dem_private_lattice_source(c->run.model), most};
    return c;
}

static void end(stress_case *c)
{
    stored_close(&c->stored);
    dem_peaks_destroy(c->peaks);
    support_close(&c->run);
    free(c);
}

TEST(arrays_hold_every_peak)
{
    stress_case *c = begin(3);
    assert_ok(peaks_file_write_arrays(&c->stored.file, &c->report, &c->frames));
    const hsize_t n = (hsize_t)c->frames.n_nodes, m = (hsize_t)c->frames.n_springs;
    const dem_node_peak *nodes = dem_peaks_nodes(c->peaks);
    const dem_spring_peak *springs = dem_peaks_springs(c->peaks);
    const double *found = stored_values(&c->stored, "/VTKHDF/PointData/peak_von_mises", n, 1, 8);
    for (hsize_t i = 0; i < n; i++) assert_close(found[i], nodes[i].von_mises, 0.0);
    found = stored_values(&c->stored, "/VTKHDF/PointData/peak_von_mises_time", n, 1, 8);
    for (hsize_t i = 0; i < n; i++) assert_close(found[i], nodes[i].t, 0.0);
    found = stored_values(&c->stored, "/VTKHDF/PointData/peak_stress", n, 6, 8);
    for (hsize_t i = 0; i < n; i++) {
        const double *s = nodes[i].stress, expected[6] = {s[0], s[1], 0.0, s[2], 0.0, 0.0};
        assert_memory_equal(found + 6 * i, expected, sizeof expected);
    }
    found = stored_values(&c->stored, "/VTKHDF/CellData/peak_strain", m, 1, 8);
    for (hsize_t k = 0; k < m; k++) assert_close(found[k], springs[k].strain, 0.0);
    found = stored_values(&c->stored, "/VTKHDF/CellData/peak_strain_time", m, 1, 8);
    for (hsize_t k = 0; k < m; k++) assert_close(found[k], springs[k].t, 0.0);
    end(c);
}

TEST(lists_have_the_most_stressed_with_place_and_time)
{
    dem_index nodes[3], springs[3];
    stress_case *c = begin(3);
    const dem_lattice *l = c->report.lattice.lattice;
    assert_ok(peaks_file_write_lists(&c->stored.file, &c->report));
    assert_int_equal(dem_peaks_most_stressed_nodes(c->peaks, 3, nodes), 3);
    assert_int_equal(dem_peaks_most_strained_springs(c->peaks, 3, springs), 3);
    for (int k = 0; k < 3; k++) {
        const dem_node_peak *p = &dem_peaks_nodes(c->peaks)[nodes[k]];
        assert_close(stored_values(&c->stored, "/most_stressed/nodes/node", 3, 1, 8)[k], (double)nodes[k], 0.0);
        assert_close(stored_values(&c->stored, "/most_stressed/nodes/t", 3, 1, 8)[k], p->t, 0.0);
        assert_close(stored_values(&c->stored, "/most_stressed/nodes/von_mises", 3, 1, 8)[k], p->von_mises, 0.0);
        const double *stress = stored_values(&c->stored, "/most_stressed/nodes/stress", 3, 3, 8) + 3 * k;
        assert_memory_equal(stress, p->stress, sizeof p->stress);
        const double *x = stored_values(&c->stored, "/most_stressed/nodes/x", 3, 2, 8) + 2 * k;
        assert_memory_equal(x, l->x + 2 * nodes[k], 2 * sizeof *x);
    }
    for (int k = 0; k < 3; k++) {
        const dem_spring_peak *p = &dem_peaks_springs(c->peaks)[springs[k]];
        const double *a = l->x + 2 * l->ends[2 * springs[k]], *b = l->x + 2 * l->ends[2 * springs[k] + 1];
        const double force = l->stiffness[springs[k]] * p->strain;
        assert_close(stored_values(&c->stored, "/most_stressed/springs/spring", 3, 1, 8)[k], (double)springs[k], 0.0);
        assert_close(stored_values(&c->stored, "/most_stressed/springs/t", 3, 1, 8)[k], p->t, 0.0);
        assert_close(stored_values(&c->stored, "/most_stressed/springs/strain", 3, 1, 8)[k], p->strain, 0.0);
        assert_close(stored_values(&c->stored, "/most_stressed/springs/force", 3, 1, 8)[k], force, 0.0);
        const double *x = stored_values(&c->stored, "/most_stressed/springs/x", 3, 2, 8) + 2 * k;
        for (int d = 0; d < 2; d++) assert_close(x[d], 0.5 * (a[d] + b[d]), 1e-17);
    }
    end(c);
}

TEST(a_list_is_no_longer_than_there_are_and_may_be_empty)
{
    stress_case *all = begin(1000000000000), *none = begin(0);
    assert_ok(peaks_file_write_lists(&all->stored.file, &all->report));
    assert_ok(peaks_file_write_lists(&none->stored.file, &none->report));
    const hsize_t n = (hsize_t)all->frames.n_nodes;
    (void)stored_values(&all->stored, "/most_stressed/nodes/von_mises", n, 1, 8);
    (void)stored_values(&none->stored, "/most_stressed/nodes/von_mises", 0, 1, 8);
    (void)stored_values(&none->stored, "/most_stressed/springs/x", 0, 2, 8);
    end(all);
    end(none);
}
