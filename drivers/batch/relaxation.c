/* SPDX-License-Identifier: BSD-3-Clause */
/* When damped bodies have come to rest. */
#include "relaxation.h"

#include <math.h>

#include "ask.h"

enum { between_looks = 16 }; /* steps: a look costs as much as half an evaluation */

static const char entry[] = "relaxation"; /* of a checkpoint */
static const double pi = 3.14159265358979323846;

double relaxation_damping(const dem_model *model, const lattice_facts *facts)
{
    const double fastest = 0.5 * dem_model_omega_max(model) * dem_model_spacing(model);
    const double extent = lattice_facts_diagonal(facts);
    return extent > 0.0 ? pi * fastest * facts->share_of_fastest / extent : 0.0;
}

double relaxation_settled(const dem_options *options)
{
    double last = 0.0;
    for (dem_index k = 0; k < options->n_boundaries; k++) last = fmax(last, options->boundaries[k].ramp);
    return last;
}

double relaxation_expected(const dem_simulation *simulation, const lattice_facts *facts, const dem_options *options,
                           double residual)
{
    const double critical = relaxation_damping(dem_simulation_model(simulation), facts);
    const double alpha = ask_options(simulation).mass_damping;
    const double rate = 0.5 * (alpha - sqrt(fmax(alpha * alpha - critical * critical, 0.0)));
    return relaxation_settled(options) - log(residual) / rate;
}

relaxation relaxation_start(double residual, const dem_options *options)
{
    return (relaxation){.residual = residual, .reached = (double)INFINITY, .settled = relaxation_settled(options)};
}

static dem_status look(void *context, const dem_simulation *simulation)
{
    relaxation *r = context;
    if (++r->steps < between_looks) return DEM_OK;
    if (dem_simulation_ramp_time(simulation) < r->settled) return DEM_OK;
    const double residual = dem_simulation_residual(simulation);
    if (isinf(residual)) return DEM_OK;
    r->steps = 0;
    r->reached = residual;
    r->t = ask_progress(simulation).t;
    r->done = residual <= r->residual;
    return r->done ? DEM_STOPPED : DEM_OK;
}

static dem_status save(void *context, const dem_simulation *simulation, dem_checkpoint *checkpoint)
{
    const relaxation *r = context;
    const double memory[] = {(double)r->steps, r->reached, r->t};
    (void)simulation;
    return dem_checkpoint_put(checkpoint, entry, memory, sizeof memory);
}

dem_status relaxation_resume(relaxation *r, const dem_checkpoint *checkpoint)
{
    double memory[3];
    const dem_status status = dem_checkpoint_get(checkpoint, entry, memory, sizeof memory);
    if (status != DEM_OK) return status;
    r->steps = (long)memory[0];
    r->reached = memory[1];
    r->t = memory[2];
    return DEM_OK;
}

dem_observer relaxation_observer(relaxation *r)
{
    return (dem_observer){.struct_size = sizeof(dem_observer), .step = look, .checkpoint = save, .context = r};
}
