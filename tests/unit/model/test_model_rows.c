/* SPDX-License-Identifier: BSD-3-Clause */
/* model_rows.c: what a model gives up comes back as it was, when it is asked for. */
#include "verification/support.h"

#include "cut_solids.h"

#include <string.h>

#include "model/model.h"

static dem_model *make(const dem_lattice *lattice)
{
    dem_model *model = NULL;
    assert_ok(dem_model_create(&model, lattice, NULL, 0));
    return model;
}

static void give_up(const dem_model *model)
{
    model_rows_give_up(model);
    assert_null(model->springs.row);
    assert_null(model->triangles.row);
    assert_null(model->layout.order);
    assert_null(model->csr);
}

/* The accelerations at the start and after a while, energies, and what is measured by loading the model. */
static void measure(const dem_model *model, double out[6])
{
    dem_constants c = {.struct_size = sizeof c};
    dem_energy energy = {.struct_size = sizeof energy};
    dem_csr csr = {.struct_size = sizeof csr};
    dem_options options = dem_options_default();
    CLEANUP(free_simulation) dem_simulation *s = NULL;
    assert_ok(dem_model_omega(model, &out[0]));
    assert_ok(dem_model_constants(model, 0, &c));
    assert_ok(dem_simulation_create(&s, model, &options));
    assert_ok(dem_simulation_advance(s, 1e-5));
    assert_ok(dem_simulation_energy(s, &energy));
    assert_ok(dem_model_csr(model, &csr));
    out[1] = c.youngs_modulus;
    out[2] = energy.ledger;
    out[3] = energy.kinetic;
    out[4] = (double)csr.neighbour[csr.row[csr.n_nodes / 2]];
    out[5] = dem_model_volumes(model)[3];
}

TEST(rows_come_back_as_they_were)
{
    for (int kind = 0; kind < N_KINDS; kind++) {
        double before[6], after[6];
        CLEANUP(dem_lattice_free) dem_lattice lattice = solid_of(kind);
        assert_ok(dem_lattice_spin(&lattice, 50.0));
        CLEANUP(free_model) dem_model *model = make(&lattice);
        measure(model, before);
        give_up(model);
        give_up(model);
        measure(model, after);
        assert_memory_equal(after, before, sizeof before);
    }
}

/* Whoever comes first has them made: each by itself. */
TEST(each_question_has_them_made)
{
    double omega, again;
    CLEANUP(dem_lattice_free) dem_lattice lattice = solid_of(COUPLED);
    CLEANUP(free_model) dem_model *model = make(&lattice);
    dem_constants c = {.struct_size = sizeof c};
    dem_csr csr = {.struct_size = sizeof csr};
    dem_options options = dem_options_default();
    CLEANUP(free_simulation) dem_simulation *s = NULL;
    assert_ok(dem_model_omega(model, &omega));
    give_up(model);
    assert_ok(dem_model_omega(model, &again));
    assert_memory_equal(&again, &omega, sizeof omega);
    give_up(model);
    assert_ok(dem_model_constants(model, 0, &c));
    give_up(model);
    assert_ok(dem_model_csr(model, &csr));
    give_up(model);
    assert_ok(dem_simulation_create(&s, model, &options));
    assert_non_null(model->springs.row);
}

TEST(where_something_may_break_they_stay)
{
    dem_lattice lattice = dem_lattice_empty();
    dem_material brittle = rubber;
    brittle.strength = 1e5;
    assert_ok(dem_lattice_rectangle(&lattice, 0.1, 0.08, 0.01));
    assert_ok(dem_lattice_assemble(&lattice, &brittle));
    CLEANUP(free_model) dem_model *model = make(&lattice);
    model_rows_give_up(model);
    assert_non_null(model->springs.row);
    dem_lattice_free(&lattice);
}
