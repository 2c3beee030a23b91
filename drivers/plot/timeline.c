/* SPDX-License-Identifier: BSD-3-Clause */
#include "timeline.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "digest.h"
#include "picture.h"

enum { VECTORS = 4 };

static double *keep(timeline *of, size_t numbers)
{
    double *made = of->n_arrays < TIMELINE_ARRAYS ? malloc((numbers + 1) * sizeof *made) : NULL;
    if (made == NULL)
        outcome_fail(of->o, EXIT_MEMORY, "dem_plot", "out of memory");
    else
        of->array[of->n_arrays++] = made;
    return made;
}

/* A column of the history, NULL if it is not there or after a fault. */
static double *read_column(timeline *of, const char *name, size_t *width)
{
    const dem_reader_column *column = dem_reader_column_find(of->reader, "history", name);
    if (column == NULL || of->o->code != EXIT_DONE) return NULL;
    *width = (size_t)column->width;
    double *value = keep(of, of->n * *width);
    if (value == NULL) return NULL;
    const dem_status status = dem_reader_read_column(of->reader, column, value);
    if (status != DEM_OK) return outcome_fail_status(of->o, status, "dem_plot"), NULL;
    of->hash = digest_add(of->hash, value, of->n * *width * sizeof *value);
    return value;
}

/* The last row, or the last frame, which is interpolated and may be later. */
static double end_of(const timeline *of)
{
    dem_index n;
    const double *frames = dem_reader_times(of->reader, &n);
    return fmax(of->t[of->n - 1], n > 0 ? frames[n - 1] : 0.0);
}

static chart *add_chart(timeline *of, const char *label, const char *unit)
{
    chart *made = &of->chart[of->n_charts++];
    *made = (chart){.label = label, .unit = unit, .n = of->n, .t = of->t, .begin = of->t[0], .end = end_of(of)};
    return made;
}

static void add_line(chart *to, const char *name, int ink, const double *y, size_t stride)
{
    to->line[to->n_lines++] = (chart_line){name, chart_ink(ink), stride, y};
}

/* ---- energies ---- */

static const struct {
    const char *column, *name;
    double sign; /* in what stays constant */
} energies[] = {{"kinetic", "kinetic", 1},
                {"elastic", "springs", 1},
                {"area", "area term", 1},
                {"guard", "folding guard", 1},
                {"contact", "bodies touching", 1},
                {"gravity", "gravity", 1},
                {"impact", "lost: impacts", 1},
                {"friction", "lost: friction", 1},
                {"damping", "lost: damping", 1},
                {"fracture", "lost: fracture", 1},
                {"boundary", "by boundaries", -1},
                {"obstacle", "by obstacles", -1},
                {"projection", "", -1}};

enum { ENERGIES = sizeof energies / sizeof *energies };

static double largest_of(const double *y, size_t n)
{
    double most = 0.0;
    for (size_t k = 0; k < n; k++) most = fmax(most, fabs(y[k]));
    return most;
}

/* All from what they begin with, gravity at 0: its zero is where the deck put the origin. Those that never make a
 * thousandth of the sum's largest size, or of the largest of them, are left out. */
static void add_energies(timeline *of)
{
    double *value[ENERGIES] = {NULL}, *sum = keep(of, of->n), largest = 0.0;
    size_t width;
    if (sum == NULL) return;
    memset(sum, 0, of->n * sizeof *sum);
    for (int e = 0; e < ENERGIES; e++) {
        value[e] = read_column(of, energies[e].column, &width);
        if (value[e] == NULL) continue;
        const double shift = strcmp(energies[e].column, "gravity") == 0 ? value[e][0] : 0.0;
        for (size_t k = 0; k < of->n; k++) value[e][k] -= shift, sum[k] += energies[e].sign * value[e][k];
        largest = fmax(largest, largest_of(value[e], of->n));
    }
    chart *to = add_chart(of, "energy", "J");
    add_line(to, "sum", 0, sum, 1);
    for (int e = 0; e < ENERGIES; e++)
        if (value[e] != NULL && energies[e].name[0] != '\0' && largest_of(value[e], of->n) > 1e-3 * largest)
            add_line(to, energies[e].name, to->n_lines, value[e], 1);
}

/* ---- forces ---- */

/* The sizes of vectors, [n][width] numbers in pairs. */
static double *sizes_of(timeline *of, const double *vector, size_t width)
{
    double *size = keep(of, of->n * width / 2);
    for (size_t k = 0; size != NULL && k < of->n * width / 2; k++) size[k] = hypot(vector[2 * k], vector[2 * k + 1]);
    return size;
}

/* Of one both components, of several the sizes, numbered from 1, as decks are. */
static void add_vectors(timeline *of, const char *column, const char *label, const char *each)
{
    size_t width;
    const double *vector = read_column(of, column, &width);
    if (vector == NULL || width < 2) return;
    chart *to = add_chart(of, label, "N");
    if (width == 2) {
        add_line(to, "along x", 1, vector, 2);
        add_line(to, "along y", 2, vector + 1, 2);
        return;
    }
    const double *size = sizes_of(of, vector, width);
    for (size_t k = 0; k < width / 2 && k < VECTORS && size != NULL; k++) {
        char *name = of->name[of->n_charts - 1][k];
        (void)snprintf(name, TIMELINE_NAME, "%s %zu", each, k + 1);
        add_line(to, name, (int)k + 1, size + k, width / 2);
    }
}

/* ---- counts and steps ---- */

/* A run in which no contact lasted has no chart of them. */
static void add_contacts(timeline *of)
{
    size_t width;
    const double *contacts = read_column(of, "contacts", &width);
    if (contacts != NULL && largest_of(contacts, of->n * width) > 0.0)
        add_line(add_chart(of, "contacts", ""), "", 0, contacts, width);
}

/* The row of the beginning has no step before it. */
static void add_steps(timeline *of)
{
    size_t width;
    double *h = read_column(of, "h", &width);
    if (h == NULL || of->n < 2) return;
    h[0] = (double)NAN;
    double least = h[1];
    for (size_t k = 1; k < of->n; k++) least = fmin(least, h[k]);
    chart *to = add_chart(of, "step", "s");
    to->by_decades = largest_of(h + 1, of->n - 1) > 30.0 * least;
    add_line(to, "", 0, h, width);
}

static bool collect(timeline *of, const char *path)
{
    size_t width;
    const dem_reader_column *column = dem_reader_column_find(of->reader, "history", "t");
    of->n = column != NULL ? (size_t)column->n_rows : 0;
    if (of->n == 0) return outcome_fail(of->o, EXIT_INVALID, "dem_plot", "%s: has no history", path), false;
    of->t = read_column(of, "t", &width);
    add_energies(of);
    add_vectors(of, "obstacle_reaction", "reaction", "obstacle");
    add_vectors(of, "boundary_force", "boundaries", "boundary");
    add_contacts(of);
    add_steps(of);
    return of->o->code == EXIT_DONE;
}

timeline *timeline_open(const dem_reader *reader, const char *path, outcome *o)
{
    timeline *of = calloc(1, sizeof *of);
    if (of == NULL) return outcome_fail(o, EXIT_MEMORY, "dem_plot", "out of memory"), NULL;
    *of = (timeline){.reader = reader, .o = o, .hash = DIGEST_BEGIN};
    if (collect(of, path)) return of;
    timeline_close(of);
    return NULL;
}

void timeline_close(timeline *of)
{
    for (int k = 0; of != NULL && k < of->n_arrays; k++) free(of->array[k]);
    free(of);
}

/* ---- the picture ---- */

static void report(const timeline *of, const request *asked, double width, double height, FILE *log)
{
    if (asked->prints_hash)
        (void)fprintf(log, "%016" PRIx64 "\n", of->hash);
    else
        (void)fprintf(log, "%s: %.0f x %.0f pixels, %d charts of %zu steps\n", asked->output, width, height,
                      of->n_charts, of->n - 1);
}

/* The first is twice as high as the others. */
static bool draw(timeline *of, const request *asked, FILE *log)
{
    const double margin = 14.0, gap = 16.0, unit = fmin(fmax(0.12 * asked->width, 90.0), 150.0), times = 44.0;
    const double width = 2.0 * ceil(0.5 * asked->width), count = of->n_charts;
    const double height = 2.0 * ceil(0.5 * (2.0 * margin + (count + 1.0) * unit + (count - 1.0) * gap + times));
    picture file;
    char note[80];
    (void)snprintf(note, sizeof note, "data %016" PRIx64, of->hash);
    if (!picture_open(&file, asked->output, width, height, of->o)) return false;
    double y = margin;
    for (int k = 0; k < of->n_charts; k++) {
        const bool is_last = k == of->n_charts - 1;
        const double below = y + (k == 0 ? 2.0 : 1.0) * unit + (is_last ? times : 0.0);
        if (!chart_draw(&of->chart[k], (box){margin, y, width - margin, below}, is_last, file.face)) {
            picture_drop(&file);
            return outcome_fail(of->o, EXIT_MEMORY, "dem_plot", "out of memory"), false;
        }
        y = below + gap;
    }
    if (!picture_close(&file, note, of->o)) return false;
    report(of, asked, width, height, log);
    return true;
}

bool timeline_draw(const dem_reader *reader, const request *asked, FILE *log, outcome *o)
{
    timeline *of = timeline_open(reader, asked->input, o);
    const bool done = of != NULL && draw(of, asked, log);
    timeline_close(of);
    return done;
}
