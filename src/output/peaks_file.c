/* SPDX-License-Identifier: BSD-3-Clause */
/* The peaks of a run in its file (docs/output.md, /most_stressed), written once, when the run is finished: arrays of
 * nodes and springs that are the same in all frames, and lists of the most stressed nodes and springs, the largest
 * first. Peaks are kept as one entry for each node or spring, the file has a column for each of their numbers. They are
 * found in simulation/peaks.c. */
#include "output/peaks_file.h"

#include "base/status.h"

#include <stdlib.h>
#include <string.h>

/* ---- arrays ---- */

/* Columns are gathered in the scratch of the frames, one after another. */
static dem_status write_nodes(const hdf5_file *file, const dem_node_peak *peaks, const frames *f)
{
    const frames_constant size = {"PointData", "peak_von_mises", f->real, 1};
    const frames_constant time = {"PointData", "peak_von_mises_time", HDF5_F64, 1};
    const frames_constant stress = {"PointData", "peak_stress", f->real, 6};
    for (dem_index i = 0; i < f->n_nodes; i++) f->scratch[i] = peaks[i].von_mises;
    TRY(frames_write_constant(f, file, &size, f->scratch));
    for (dem_index i = 0; i < f->n_nodes; i++) f->scratch[i] = peaks[i].t;
    TRY(frames_write_constant(f, file, &time, f->scratch));
    for (dem_index i = 0; i < f->n_nodes; i++) memcpy(f->stress + 3 * i, peaks[i].stress, sizeof peaks[i].stress);
    frame_arrays_spread_stress(f->scratch, f->n_nodes, f->stress);
    return frames_write_constant(f, file, &stress, f->scratch);
}

/* The strain of the largest size, with its sign, and when that was. */
static dem_status write_springs(const hdf5_file *file, const dem_spring_peak *peaks, const frames *f)
{
    const frames_constant strain = {"CellData", "peak_strain", f->real, 1};
    const frames_constant time = {"CellData", "peak_strain_time", HDF5_F64, 1};
    for (dem_index k = 0; k < f->n_springs; k++) f->scratch[k] = peaks[k].strain;
    TRY(frames_write_constant(f, file, &strain, f->scratch));
    for (dem_index k = 0; k < f->n_springs; k++) f->scratch[k] = peaks[k].t;
    return frames_write_constant(f, file, &time, f->scratch);
}

dem_status peaks_file_write_arrays(const hdf5_file *file, const peaks_report *report, const frames *f)
{
    TRY(write_nodes(file, dem_peaks_nodes(report->peaks), f));
    return write_springs(file, dem_peaks_springs(report->peaks), f);
}

/* ---- lists ---- */

/* A column of reals in one chunk. */
static dem_status write_column(const hdf5_file *file, const char *name, dem_index n, int components,
                               const double *values)
{
    const hdf5_rows rows = {name, HDF5_F64, components > 1 ? 2 : 1, {(hsize_t)components}, 0, 0};
    return hdf5_write(file, rows, (hsize_t)n, values);
}

static dem_status write_numbers(const hdf5_file *file, const char *name, dem_index n, const dem_index *numbers)
{
    return hdf5_write(file, (hdf5_rows){name, HDF5_I64, 1, {0}, 0, 0}, (hsize_t)n, numbers);
}

/* `list` gets the numbers of the nodes, the largest stress first; then each column follows this order. */
static dem_status write_node_list(const hdf5_file *file, const peaks_report *r, dem_index *list, double *column)
{
    const dem_index n = dem_peaks_most_stressed_nodes(r->peaks, r->most, list);
    const dem_node_peak *peaks = dem_peaks_nodes(r->peaks);
    TRY(write_numbers(file, "/most_stressed/nodes/node", n, list));
    TRY(dem_private_lattice_pick(&r->lattice, offsetof(dem_lattice, x), list, n, column));
    TRY(write_column(file, "/most_stressed/nodes/x", n, 2, column));
    for (dem_index k = 0; k < n; k++) column[k] = peaks[list[k]].t;
    TRY(write_column(file, "/most_stressed/nodes/t", n, 1, column));
    for (dem_index k = 0; k < n; k++) column[k] = peaks[list[k]].von_mises;
    TRY(write_column(file, "/most_stressed/nodes/von_mises", n, 1, column));
    for (dem_index k = 0; k < n; k++) memcpy(column + 3 * k, peaks[list[k]].stress, 3 * sizeof *column);
    return write_column(file, "/most_stressed/nodes/stress", n, 3, column);
}

/* The place of a spring is its middle at rest. */
static dem_status find_middles(const peaks_report *r, const dem_index *list, dem_index n, double *middle)
{
    dem_index *ends = malloc(2 * (size_t)(n + 1) * sizeof *ends);
    double *x = malloc(4 * (size_t)(n + 1) * sizeof *x);
    dem_status status = ends != NULL && x != NULL ? DEM_OK : status_fail(DEM_ERROR_MEMORY, "out of memory");
    if (status == DEM_OK) status = dem_private_lattice_pick(&r->lattice, offsetof(dem_lattice, ends), list, n, ends);
    if (status == DEM_OK) status = dem_private_lattice_pick(&r->lattice, offsetof(dem_lattice, x), ends, 2 * n, x);
    for (dem_index k = 0; k < 2 * n && status == DEM_OK; k++)
        middle[k] = 0.5 * (x[4 * (k / 2) + k % 2] + x[4 * (k / 2) + 2 + k % 2]);
    free(ends);
    free(x);
    return status;
}

/* The stiffness times the strain. */
static dem_status find_forces(const peaks_report *r, const dem_index *list, dem_index n, double *force)
{
    const dem_spring_peak *peaks = dem_peaks_springs(r->peaks);
    TRY(dem_private_lattice_pick(&r->lattice, offsetof(dem_lattice, stiffness), list, n, force));
    for (dem_index k = 0; k < n; k++) force[k] = peaks[list[k]].strain * force[k];
    return DEM_OK;
}

static dem_status write_spring_list(const hdf5_file *file, const peaks_report *r, dem_index *list, double *column)
{
    const dem_index n = dem_peaks_most_strained_springs(r->peaks, r->most, list);
    const dem_spring_peak *peaks = dem_peaks_springs(r->peaks);
    TRY(write_numbers(file, "/most_stressed/springs/spring", n, list));
    TRY(find_middles(r, list, n, column));
    TRY(write_column(file, "/most_stressed/springs/x", n, 2, column));
    for (dem_index k = 0; k < n; k++) column[k] = peaks[list[k]].t;
    TRY(write_column(file, "/most_stressed/springs/t", n, 1, column));
    for (dem_index k = 0; k < n; k++) column[k] = peaks[list[k]].strain;
    TRY(write_column(file, "/most_stressed/springs/strain", n, 1, column));
    TRY(find_forces(r, list, n, column));
    return write_column(file, "/most_stressed/springs/force", n, 1, column);
}

/* Room for as many as are asked for, or as there are; a column has three components at most. */
dem_status peaks_file_write_lists(const hdf5_file *file, const peaks_report *report)
{
    const dem_index n = report->lattice.lattice->n_nodes, m = report->lattice.lattice->n_springs,
                    largest = n > m ? n : m;
    /* One more, so that nothing is allocated without bytes. */
    const size_t most = (size_t)(report->most < largest ? report->most : largest) + 1;
    dem_index *list = malloc(most * sizeof *list);
    double *column = malloc(3 * most * sizeof *column);
    dem_status status = DEM_OK;
    if (list == NULL || column == NULL)
        status = status_fail(DEM_ERROR_MEMORY, "out of memory for the %lld most stressed", (long long)report->most);
    if (status == DEM_OK) status = write_node_list(file, report, list, column);
    if (status == DEM_OK) status = write_spring_list(file, report, list, column);
    free(list);
    free(column);
    return status;
}

/* An upper bound: all reals as doubles, the offsets of n frames, and the lists. */
hsize_t peaks_file_bytes(const peaks_report *report, hsize_t n)
{
    const dem_lattice *l = report->lattice.lattice;
    return 64 * (hsize_t)l->n_nodes + 16 * (hsize_t)l->n_springs + 40 * n + 104 * (hsize_t)report->most;
}
