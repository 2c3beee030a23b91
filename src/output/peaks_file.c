/* SPDX-License-Identifier: BSD-3-Clause */
/* The peaks of a run in its file (docs/output.md, /most_stressed), written once, when the run is finished: arrays of
 * nodes and springs that are the same in all frames, and lists of the most stressed nodes and springs, the largest
 * first. Peaks are kept as one entry for each node or spring, the file has a column for each of their numbers. They are
 * found in simulation/peaks.c, and may be those of ranks. */
#include "output/peaks_file.h"

#include "base/peak_source.h"
#include "base/status.h"

#include <stdlib.h>
#include <string.h>

/* ---- arrays ---- */

enum { COLUMNS = 3 };

/* Columns that are being written, each of which has a row for an entry. */
typedef struct columns {
    const hdf5_file *file;
    int n;
    hdf5_rows rows[COLUMNS];
    char names[COLUMNS][FRAMES_NAME];
    void (*fill)(double *out, int column, const void *entries, dem_index n); /* rows of entries */
    double *scratch;                                                         /* of a chunk of one column */
} columns;

/* Values are von Mises stresses, times, and VTK's tensors. */
static void fill_node_column(double *out, int column, const void *entries, dem_index n)
{
    const dem_node_peak *peak = entries;
    for (dem_index k = 0; k < n && column == 0; k++) out[k] = peak[k].von_mises;
    for (dem_index k = 0; k < n && column == 1; k++) out[k] = peak[k].t;
    for (dem_index k = 0; k < n && column == 2; k++) frame_arrays_spread_stress(out + 6 * k, 1, peak[k].stress);
}

/* The strain of the largest size, with its sign, and when that was. */
static void fill_spring_column(double *out, int column, const void *entries, dem_index n)
{
    const dem_spring_peak *peak = entries;
    for (dem_index k = 0; k < n; k++) out[k] = column == 0 ? peak[k].strain : peak[k].t;
}

static dem_status append_columns(void *context, dem_index first, dem_index n, const void *entries)
{
    const columns *c = context;
    for (int k = 0; k < c->n; k++) {
        c->fill(c->scratch, k, entries, n);
        TRY(hdf5_append(c->file, &c->rows[k], (hsize_t)first, (hsize_t)n, c->scratch));
    }
    return DEM_OK;
}

static dem_status create_columns(columns *c, const frames *f, const frames_constant *list)
{
    for (int k = 0; k < c->n; k++) TRY(frames_create_constant(f, c->file, &list[k], &c->rows[k], c->names[k]));
    return DEM_OK;
}

static dem_status write_nodes(columns c, const dem_peaks *peaks, const frames *f)
{
    const frames_constant list[] = {{"PointData", "peak_von_mises", f->real, 1},
                                    {"PointData", "peak_von_mises_time", HDF5_F64, 1},
                                    {"PointData", "peak_stress", f->real, 6}};
    c.n = 3;
    c.fill = fill_node_column;
    TRY(create_columns(&c, f, list));
    return dem_private_peaks_visit_nodes(peaks, append_columns, &c);
}

static dem_status write_springs(columns c, const dem_peaks *peaks, const frames *f)
{
    const frames_constant list[] = {{"CellData", "peak_strain", f->real, 1},
                                    {"CellData", "peak_strain_time", HDF5_F64, 1}};
    c.n = 2;
    c.fill = fill_spring_column;
    TRY(create_columns(&c, f, list));
    return dem_private_peaks_visit_springs(peaks, append_columns, &c);
}

dem_status peaks_file_write_arrays(const hdf5_file *file, const peaks_report *report, const frames *f)
{
    columns c = {.file = file, .scratch = malloc(6 * ROWS_CHUNK * sizeof *c.scratch)};
    CHECK_MEMORY(c.scratch);
    dem_status status = write_nodes(c, report->peaks, f);
    if (status == DEM_OK) status = write_springs(c, report->peaks, f);
    free(c.scratch);
    return status;
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

/* The numbers of the nodes, the largest stress first; each column follows this order. */
static dem_status write_node_rows(const hdf5_file *file, const peaks_report *r, const rows_pick *picked, double *column)
{
    const dem_index n = picked->n;
    const dem_node_peak *peak = picked->out;
    TRY(write_numbers(file, "/most_stressed/nodes/node", n, picked->list));
    TRY(dem_private_lattice_pick(&r->lattice, offsetof(dem_lattice, x), picked->list, n, column));
    TRY(write_column(file, "/most_stressed/nodes/x", n, 2, column));
    for (dem_index k = 0; k < n; k++) column[k] = peak[k].t;
    TRY(write_column(file, "/most_stressed/nodes/t", n, 1, column));
    for (dem_index k = 0; k < n; k++) column[k] = peak[k].von_mises;
    TRY(write_column(file, "/most_stressed/nodes/von_mises", n, 1, column));
    for (dem_index k = 0; k < n; k++) memcpy(column + 3 * k, peak[k].stress, 3 * sizeof *column);
    return write_column(file, "/most_stressed/nodes/stress", n, 3, column);
}

static dem_status write_node_list(const hdf5_file *file, const peaks_report *r, dem_index most, dem_index *list,
                                  double *column)
{
    rows_pick picked = {sizeof(dem_node_peak), list, most, NULL};
    dem_node_peak *peak = malloc((size_t)(most + 1) * sizeof *peak);
    CHECK_MEMORY(peak);
    picked.out = peak;
    dem_status status = dem_private_peaks_largest_nodes(r->peaks, &picked.n, list, peak);
    if (status == DEM_OK) status = write_node_rows(file, r, &picked, column);
    free(peak);
    return status;
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

/* The force is the stiffness times the strain. */
static dem_status write_spring_rows(const hdf5_file *file, const peaks_report *r, const rows_pick *picked,
                                    double *column)
{
    const dem_index n = picked->n;
    const dem_spring_peak *peak = picked->out;
    TRY(write_numbers(file, "/most_stressed/springs/spring", n, picked->list));
    TRY(find_middles(r, picked->list, n, column));
    TRY(write_column(file, "/most_stressed/springs/x", n, 2, column));
    for (dem_index k = 0; k < n; k++) column[k] = peak[k].t;
    TRY(write_column(file, "/most_stressed/springs/t", n, 1, column));
    for (dem_index k = 0; k < n; k++) column[k] = peak[k].strain;
    TRY(write_column(file, "/most_stressed/springs/strain", n, 1, column));
    TRY(dem_private_lattice_pick(&r->lattice, offsetof(dem_lattice, stiffness), picked->list, n, column));
    for (dem_index k = 0; k < n; k++) column[k] = peak[k].strain * column[k];
    return write_column(file, "/most_stressed/springs/force", n, 1, column);
}

static dem_status write_spring_list(const hdf5_file *file, const peaks_report *r, dem_index most, dem_index *list,
                                    double *column)
{
    rows_pick picked = {sizeof(dem_spring_peak), list, most, NULL};
    dem_spring_peak *peak = malloc((size_t)(most + 1) * sizeof *peak);
    CHECK_MEMORY(peak);
    picked.out = peak;
    dem_status status = dem_private_peaks_largest_springs(r->peaks, &picked.n, list, peak);
    if (status == DEM_OK) status = write_spring_rows(file, r, &picked, column);
    free(peak);
    return status;
}

/* Room for as many as are asked for, or as there are; a column has three components at most. */
dem_status peaks_file_write_lists(const hdf5_file *file, const peaks_report *report)
{
    const dem_index n = report->lattice.lattice->n_nodes, m = report->lattice.lattice->n_springs,
                    largest = n > m ? n : m;
    /* One more, so that nothing is allocated without bytes. */
    const dem_index most = report->most < largest ? report->most : largest;
    dem_index *list = malloc((size_t)(most + 1) * sizeof *list);
    double *column = malloc(3 * (size_t)(most + 1) * sizeof *column);
    dem_status status = DEM_OK;
    if (list == NULL || column == NULL)
        status = status_fail(DEM_ERROR_MEMORY, "out of memory for the %lld most stressed", (long long)report->most);
    if (status == DEM_OK) status = write_node_list(file, report, most, list, column);
    if (status == DEM_OK) status = write_spring_list(file, report, most, list, column);
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
