/* SPDX-License-Identifier: BSD-3-Clause */
#include "fracture_report.h"

#include <stdlib.h>

#include "ask.h"

static dem_index count(const unsigned char *flags, dem_index n)
{
    dem_index set = 0;
    for (dem_index k = 0; k < n; k++) set += flags[k];
    return set;
}

fracture_report fracture_report_of(const dem_simulation *simulation)
{
    const dem_model_size size = ask_sizes(dem_simulation_model(simulation));
    unsigned char *triangle = calloc((size_t)size.n_triangles + 1, 1), *spring = calloc((size_t)size.n_springs + 1, 1);
    fracture_report report = {0, 0};
    if (triangle != NULL && spring != NULL && dem_simulation_broken(simulation, triangle, spring) == DEM_OK)
        report = (fracture_report){count(triangle, size.n_triangles), count(spring, size.n_springs)};
    free(triangle);
    free(spring);
    return report;
}

void fracture_report_print(FILE *out, const dem_simulation *simulation)
{
    const dem_model_size size = ask_sizes(dem_simulation_model(simulation));
    const fracture_report report = fracture_report_of(simulation);
    if (report.springs == 0 && report.triangles == 0) return;
    (void)fprintf(out, "fracture   %lld of %lld triangles and %lld of %lld springs are broken, which took %.4g J\n",
                  (long long)report.triangles, (long long)size.n_triangles, (long long)report.springs,
                  (long long)size.n_springs, ask_energy(simulation).fracture);
}
