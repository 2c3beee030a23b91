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

static int compare(const void *a, const void *b)
{
    const double first = *(const double *)a, second = *(const double *)b;
    return (first > second) - (first < second);
}

/* From the masses of fragments, each at its lowest node, and 0 at the others. They are sorted, so that the sums have
 * the same bits however nodes are numbered. */
static void measure(fracture_report *report, double *mass, dem_index n)
{
    double sum = 0.0, part = 0.0;
    qsort(mass, (size_t)n, sizeof *mass, compare);
    for (dem_index k = 0; k < n; k++) sum += mass[k];
    for (dem_index k = 0; k < n && part < 0.5 * sum; k++) {
        part += mass[k];
        report->median = mass[k];
    }
    report->largest = sum > 0.0 ? mass[n - 1] / sum : 0.0;
    report->debris = sum > 0.0 ? report->debris / sum : 0.0;
}

/* `mass` [n_nodes] is 0, and so is `nodes`: how many nodes a fragment has. */
static void weigh(fracture_report *report, const dem_lattice *l, const dem_index *fragment, double *mass,
                  dem_index *nodes)
{
    for (dem_index i = 0; i < l->n_nodes; i++) {
        mass[fragment[i]] += l->mass[i];
        nodes[fragment[i]]++;
    }
    for (dem_index i = 0; i < l->n_nodes; i++)
        if (nodes[i] == 1) report->debris += mass[i];
    measure(report, mass, l->n_nodes);
}

static void find_fragments(fracture_report *report, const dem_simulation *simulation)
{
    const dem_lattice *l = dem_model_lattice(dem_simulation_model(simulation));
    const size_t n = (size_t)l->n_nodes + 1;
    dem_index *fragment = calloc(n, sizeof *fragment), *nodes = calloc(n, sizeof *nodes);
    double *mass = calloc(n, sizeof *mass);
    if (fragment != NULL && nodes != NULL && mass != NULL && l->n_nodes > 0 &&
        dem_simulation_fragments(simulation, &report->fragments, fragment) == DEM_OK)
        weigh(report, l, fragment, mass, nodes);
    free(fragment);
    free(nodes);
    free(mass);
}

fracture_report fracture_report_of(const dem_simulation *simulation)
{
    const dem_model_size size = ask_sizes(dem_simulation_model(simulation));
    unsigned char *triangle = calloc((size_t)size.n_triangles + 1, 1), *spring = calloc((size_t)size.n_springs + 1, 1);
    fracture_report report = {0};
    if (triangle != NULL && spring != NULL && dem_simulation_broken(simulation, triangle, spring) == DEM_OK) {
        report.triangles = count(triangle, size.n_triangles);
        report.springs = count(spring, size.n_springs);
        find_fragments(&report, simulation);
    }
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
    (void)fprintf(
        out, "fragments  %lld; the largest has %.3g of the mass, single nodes %.3g; half is in those up to %.4g kg\n",
        (long long)report.fragments, report.largest, report.debris, report.median);
}
