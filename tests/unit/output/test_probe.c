/* SPDX-License-Identifier: BSD-3-Clause */
/* probe.c: rows against what the simulation shows step by step. */
#include "unit/output/stored.h"

#include <stdlib.h>

#include "harness/message.h"
#include "output/probe.h"
#include "harness/motion.h"
#include "unit/solids.h"

enum { n_kinds = 3, most_steps = 200 };

/* One probe of each kind. */
static const dem_probe probes[n_kinds] = {{"a_node", DEM_PROBE_NODE, {5, 0}, 1},
                                          {"a-spring", DEM_PROBE_SPRING, {7, 0}, 3},
                                          {"G", DEM_PROBE_GAUGE, {1, 12}, 2}};

/* What is seen at every step, beside the probes: t; x, v, stress of the node; strain and force of the
 * spring; gauge's length. */
typedef struct journal {
    support_run run;
    stored stored;
    probe probes[n_kinds];
    hsize_t n;
    double t[most_steps], node[most_steps][7], strain[most_steps], force[most_steps], length[most_steps];
} journal;

static dem_status note(void *context, const dem_simulation *simulation)
{
    journal *j = context;
    motion state;
    double strains[64], forces[64], stress[3 * 64];
    assert_true(j->n < most_steps);
    motion_see(simulation, &state);
    dem_simulation_strains(simulation, strains);
    dem_simulation_forces(simulation, forces);
    dem_simulation_stress(simulation, stress);
    for (int k = 0; k < 2; k++) /* an instant counts once */
        for (int p = 0; p < n_kinds; p++) assert_ok(probe_record(&j->probes[p], simulation));
    j->t[j->n] = state.t;
    memcpy(j->node[j->n], state.x + 10, 2 * sizeof(double));
    memcpy(j->node[j->n] + 2, state.v + 10, 2 * sizeof(double));
    memcpy(j->node[j->n] + 4, stress + 15, 3 * sizeof(double));
    j->strain[j->n] = strains[7];
    j->force[j->n] = forces[7];
    j->length[j->n] = hypot(state.x[24] - state.x[2], state.x[25] - state.x[3]);
    j->n++;
    return DEM_OK;
}

static journal *keep_of(dem_lattice lattice)
{
    const dem_options options = dem_options_default();
    journal *j = calloc(1, sizeof *j);
    assert_non_null(j);
    const double velocity[2] = {1.0, 2.0};
    assert_ok(dem_lattice_launch(&lattice, velocity));
    for (dem_index i = 0; i < lattice.n_nodes; i++) lattice.velocity[2 * i] += 300.0 * lattice.x[2 * i + 1];
    support_open(&j->run, &lattice, NULL, 0, &options);
    stored_open(&j->stored);
    for (int p = 0; p < n_kinds; p++) {
        assert_ok(probe_init(&j->probes[p], &probes[p], &(lattice_source){&lattice, NULL}));
        assert_ok(probe_create(&j->probes[p], &j->stored.file));
    }
    dem_lattice_free(&lattice);
    const dem_observer observer = {.struct_size = sizeof(dem_observer), .step = note, .context = j};
    assert_ok(dem_simulation_observe(j->run.simulation, &observer));
    (void)support_at(&j->run, 5e-4);
    for (int p = 0; p < n_kinds; p++) {
        assert_ok(table_flush(&j->probes[p].table, &j->stored.file));
        assert_ok(table_verify(&j->probes[p].table, &j->stored.file, j->probes[p].table.written));
    }
    assert_true(j->n > 20);
    return j;
}

static void drop(journal *j)
{
    for (int p = 0; p < n_kinds; p++) probe_free(&j->probes[p]);
    stored_close(&j->stored);
    support_close(&j->run);
    free(j);
}

static journal *keep(void)
{
    return keep_of(make_solid(0.03, 0.04, 0.01));
}

TEST(a_node_tells_its_motion_and_stress)
{
    journal *j = keep();
    const double *t = stored_values(&j->stored, "/probes/a_node/t", j->n, 1, 8);
    for (hsize_t k = 0; k < j->n; k++) assert_close(t[k], j->t[k], 0.0);
    const double *x = stored_values(&j->stored, "/probes/a_node/x", j->n, 2, 8);
    for (hsize_t k = 0; k < j->n; k++) assert_memory_equal(x + 2 * k, j->node[k], 2 * sizeof *x);
    const double *v = stored_values(&j->stored, "/probes/a_node/v", j->n, 2, 8);
    for (hsize_t k = 0; k < j->n; k++) assert_memory_equal(v + 2 * k, j->node[k] + 2, 2 * sizeof *v);
    const double *stress = stored_values(&j->stored, "/probes/a_node/stress", j->n, 3, 8);
    for (hsize_t k = 0; k < j->n; k++) assert_memory_equal(stress + 3 * k, j->node[k] + 4, 3 * sizeof *stress);
    const double *size = stored_values(&j->stored, "/probes/a_node/von_mises", j->n, 1, 8);
    for (hsize_t k = 0; k < j->n; k++) assert_close(size[k], dem_stress_von_mises(j->node[k] + 4), 0.0);
    assert_true(size[j->n - 1] > 1e3);
    drop(j);
}

TEST(springs_and_gauges_tell_strains_every_so_many_steps)
{
    journal *j = keep();
    const hsize_t n = (j->n + 2) / 3, m = (j->n + 1) / 2;
    const dem_lattice *l = dem_model_lattice(j->run.model);
    const double rest = hypot(l->x[24] - l->x[2], l->x[25] - l->x[3]);
    const double *t = stored_values(&j->stored, "/probes/a-spring/t", n, 1, 8);
    for (hsize_t k = 0; k < n; k++) assert_close(t[k], j->t[3 * k], 0.0);
    const double *strain = stored_values(&j->stored, "/probes/a-spring/strain", n, 1, 8);
    for (hsize_t k = 0; k < n; k++) assert_close(strain[k], j->strain[3 * k], 1e-15);
    const double *force = stored_values(&j->stored, "/probes/a-spring/force", n, 1, 8);
    for (hsize_t k = 0; k < n; k++) assert_close(force[k], l->stiffness[7] * j->strain[3 * k], 1e-9);
    const double *length = stored_values(&j->stored, "/probes/G/length", m, 1, 8);
    for (hsize_t k = 0; k < m; k++) assert_close(length[k], j->length[2 * k], 1e-17);
    strain = stored_values(&j->stored, "/probes/G/strain", m, 1, 8);
    for (hsize_t k = 0; k < m; k++) assert_close(strain[k], (j->length[2 * k] - rest) / rest, 1e-15);
    drop(j);
}

TEST(columns_have_units_and_the_group_says_what_is_probed)
{
    journal *j = keep();
    found_text(&j->stored.file, "/probes/a_node", "kind", "node");
    found_text(&j->stored.file, "/probes/a-spring", "kind", "spring");
    found_text(&j->stored.file, "/probes/G", "kind", "gauge");
    stored_expect_wholes(&j->stored, "/probes/a_node", "number", 1, probes[0].number);
    stored_expect_wholes(&j->stored, "/probes/G", "number", 2, probes[2].number);
    stored_expect_wholes(&j->stored, "/probes/G", "every", 1, &probes[2].every);
    found_text(&j->stored.file, "/probes/a_node/stress", "unit", "Pa");
    found_text(&j->stored.file, "/probes/a_node/v", "unit", "m/s");
    found_text(&j->stored.file, "/probes/a-spring/force", "unit", "N");
    found_text(&j->stored.file, "/probes/G/length", "unit", "m");
    drop(j);
}

TEST(what_cannot_be_probed_is_refused)
{
    static const char name[] = "123456789_123456789_123456789_123456789_123456789_123456789_123";
    const struct {
        dem_probe probe;
        const char *message;
    } cases[] = {
        {{NULL, DEM_PROBE_NODE, {0, 0}, 1}, "a probe has no name"},
        {{"", DEM_PROBE_NODE, {0, 0}, 1}, "\"\" cannot name a probe: 1 to 63 letters, digits, _ and -"},
        {{"a/b", DEM_PROBE_NODE, {0, 0}, 1}, "\"a/b\" cannot name a probe: 1 to 63 letters, digits, _ and -"},
        {{"123456789_123456789_123456789_123456789_123456789_123456789_1234", DEM_PROBE_NODE, {0, 0}, 1},
         "\"123456789_123456789_123456789_123456789_123456789_123456789_1234\" cannot name a probe: 1 to 63 letters, "
         "digits, _ and -"},
        {{"p", (dem_probe_kind)3, {0, 0}, 1}, "probe p: kind 3 is unknown"},
        {{"p", DEM_PROBE_NODE, {0, 0}, 0}, "probe p: a row every 0 steps; it must be 1 or more"},
        {{"p", DEM_PROBE_NODE, {-1, 0}, 1}, "probe p: there is no node -1; they are 0 to 2"},
        {{"p", DEM_PROBE_NODE, {3, 0}, 1}, "probe p: there is no node 3; they are 0 to 2"},
        {{"p", DEM_PROBE_SPRING, {3, 0}, 1}, "probe p: there is no spring 3; they are 0 to 2"},
        {{"p", DEM_PROBE_GAUGE, {0, 3}, 1}, "probe p: there is no node 3; they are 0 to 2"},
        {{"p", DEM_PROBE_GAUGE, {2, 2}, 1}, "probe p: a gauge from node 2 to node 2 has no length"},
    };
    CLEANUP(probe_free) probe p;
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(1.0, 1.0, 1.0);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        assert_int_equal(probe_init(&p, &cases[k].probe, &(lattice_source){&lattice, NULL}), DEM_ERROR_ARGUMENT);
        assert_message_parts(cases[k].message);
        assert_null(p.text);
    }
    const dem_probe longest = {name, DEM_PROBE_NODE, {0, 0}, 1};
    assert_ok(probe_init(&p, &longest, &(lattice_source){&lattice, NULL}));
    assert_string_equal(p.what.name, name);
    assert_ptr_not_equal(p.what.name, name);
}

/* Of triangles that are not equilateral, whose springs are coupled, the force is not E_ij times the strain. */
TEST(the_force_of_a_spring_has_what_couplings_add)
{
    dem_material coupled = rubber;
    dem_lattice lattice = make_rectangle(0.03, 0.04, 0.01);
    coupled.springs = DEM_SPRINGS_COUPLED;
    for (dem_index i = 0; i < lattice.n_nodes; i++) lattice.x[2 * i] *= 1.2;
    assert_int_equal(dem_lattice_assemble(&lattice, &coupled), DEM_OK);
    const double stiffness = lattice.stiffness[7];
    double coupling = 0.0;
    journal *j = keep_of(lattice);
    const hsize_t n = (j->n + 2) / 3;
    const double *force = stored_values(&j->stored, "/probes/a-spring/force", n, 1, 8);
    for (hsize_t k = 0; k < n; k++) {
        assert_close(force[k], j->force[3 * k], 0.0);
        coupling = fmax(coupling, fabs(force[k] - stiffness * j->strain[3 * k]));
    }
    assert_true(coupling > 1.0);
    drop(j);
}
