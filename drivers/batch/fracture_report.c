/* SPDX-License-Identifier: BSD-3-Clause */
#include "fracture_report.h"

#include "ask.h"

void fracture_report_print(FILE *out, const dem_simulation *simulation)
{
    const dem_model_size size = ask_sizes(dem_simulation_model(simulation));
    const dem_fracture report = ask_fracture(simulation);
    if (report.springs == 0 && report.triangles == 0) return;
    (void)fprintf(out, "fracture   %lld of %lld triangles and %lld of %lld springs are broken, which took %.4g J\n",
                  (long long)report.triangles, (long long)size.n_triangles, (long long)report.springs,
                  (long long)size.n_springs, ask_energy(simulation).fracture);
    (void)fprintf(
        out, "fragments  %lld; the largest has %.3g of the mass, single nodes %.3g; half is in those up to %.4g kg\n",
        (long long)report.fragments, report.largest, report.debris, report.median);
}
