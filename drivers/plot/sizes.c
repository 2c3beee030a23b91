/* SPDX-License-Identifier: BSD-3-Clause */
#include "sizes.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "chart.h"
#include "choice.h"
#include "digest.h"
#include "picture.h"
#include "time_label.h"

enum { SAMPLES = 1024 }; /* over the axis of masses: as many as a picture has pixels */

/* The masses of a frame's fragments, ascending. */
typedef struct weights {
    dem_index n;
    double *mass;
} weights;

typedef struct sizes {
    const dem_reader *reader;
    outcome *o;
    frame_list chosen;
    weights of[CHART_LINES];
    double logarithm[SAMPLES]; /* of masses in kg, along the axis */
    double share[CHART_LINES][SAMPLES];
    char name[CHART_LINES][TIME_LABEL_TEXT];
    chart chart;
    uint64_t hash;
} sizes;

static bool fail_memory(outcome *o)
{
    outcome_fail(o, EXIT_MEMORY, "dem_plot", "out of memory");
    return false;
}

/* ---- what is drawn ---- */

static bool choose(sizes *s, const request *asked)
{
    dem_index n;
    (void)dem_reader_times(s->reader, &n);
    if (!choice_find(&s->chosen, s->reader, asked, s->o)) return false;
    if (s->chosen.n == 0 && !frame_list_usual(&s->chosen, n, -1)) return fail_memory(s->o);
    if (s->chosen.n <= CHART_LINES) return true;
    outcome_fail(s->o, EXIT_INVALID, "dem_plot", "'--fragments' shows at most %d frames, not %zu", CHART_LINES,
                 s->chosen.n);
    return false;
}

static int compare(const void *a, const void *b)
{
    const double one = *(const double *)a, other = *(const double *)b;
    return (one > other) - (one < other);
}

static bool read_weights(sizes *s, const dem_reader_column *mass, size_t k)
{
    dem_index first;
    weights *w = &s->of[k];
    dem_status status = dem_reader_fragments(s->reader, s->chosen.frame[k], &first, &w->n);
    if (status != DEM_OK) return outcome_fail_status(s->o, status, "dem_plot"), false;
    w->mass = malloc(((size_t)w->n + 1) * sizeof *w->mass);
    if (w->mass == NULL) return fail_memory(s->o);
    status = dem_reader_read_rows(s->reader, mass, first, w->n, w->mass);
    if (status != DEM_OK) return outcome_fail_status(s->o, status, "dem_plot"), false;
    qsort(w->mass, (size_t)w->n, sizeof *w->mass, compare);
    s->hash = digest_add(s->hash, &s->chosen.frame[k], sizeof s->chosen.frame[k]);
    s->hash = digest_add(s->hash, w->mass, (size_t)w->n * sizeof *w->mass);
    return true;
}

static bool read_all(sizes *s, const request *asked)
{
    const dem_reader_column *mass = dem_reader_column_find(s->reader, "fragments", "mass");
    if (mass == NULL || mass->width != 1) {
        outcome_fail(s->o, EXIT_INVALID, "dem_plot", "%s: has no masses of fragments: 'fragments' in &output has them",
                     asked->input);
        return false;
    }
    for (size_t k = 0; k < s->chosen.n; k++)
        if (!read_weights(s, mass, k)) return false;
    return true;
}

double sizes_share(dem_index n, const double *mass, double most)
{
    double part = 0.0, sum = 0.0;
    for (dem_index k = 0; k < n; k++) {
        sum += mass[k];
        if (mass[k] <= most) part = sum;
    }
    return sum > 0.0 ? part / sum : 0.0;
}

/* From the lightest fragment to the heaviest, and a tenth of that way more on both sides; only powers of ten have
 * ticks. */
void sizes_axis(double lo, double hi, double *begin, double *end)
{
    const double room = fmax(0.1 * log10(hi / lo), 0.2);
    *begin = log10(lo) - room;
    *end = log10(hi) + room;
    if (floor(*end) > ceil(*begin)) return;
    *begin = floor(*begin);
    *end = ceil(*end);
}

static bool set_axis(sizes *s)
{
    double lo = (double)INFINITY, hi = 0.0;
    for (size_t k = 0; k < s->chosen.n; k++)
        for (dem_index i = 0; i < s->of[k].n; i++)
            if (s->of[k].mass[i] > 0.0 && isfinite(s->of[k].mass[i]))
                lo = fmin(lo, s->of[k].mass[i]), hi = fmax(hi, s->of[k].mass[i]);
    if (!(lo <= hi)) return outcome_fail(s->o, EXIT_INVALID, "dem_plot", "no fragment has a mass"), false;
    double begin, end;
    sizes_axis(lo, hi, &begin, &end);
    for (int i = 0; i < SAMPLES; i++) s->logarithm[i] = begin + (end - begin) * i / (SAMPLES - 1);
    return true;
}

/* The later, the darker. */
static void add_lines(sizes *s)
{
    dem_index n;
    const double *all = dem_reader_times(s->reader, &n);
    const palette inks = palette_make(PALETTE_SEQUENTIAL);
    double t[CHART_LINES];
    for (size_t k = 0; k < s->chosen.n; k++) t[k] = all[s->chosen.frame[k]];
    const time_label label = time_label_for(s->chosen.n, t);
    for (size_t k = 0; k < s->chosen.n; k++) {
        const double u = s->chosen.n > 1 ? 0.25 + 0.75 * (double)k / (double)(s->chosen.n - 1) : 1.0;
        for (int i = 0; i < SAMPLES; i++)
            s->share[k][i] = sizes_share(s->of[k].n, s->of[k].mass, pow(10.0, s->logarithm[i]));
        time_label_print(&label, t[k], s->name[k]);
        s->chart.line[k] = (chart_line){s->name[k], inks.of[(int)(u * (PALETTE_SIZE - 1))], 1, s->share[k]};
    }
    s->chart.n_lines = (int)s->chosen.n;
}

static bool collect(sizes *s, const request *asked)
{
    if (!choose(s, asked) || !read_all(s, asked) || !set_axis(s)) return false;
    s->chart = (chart){.label = "share of the mass in fragments up to this",
                       .unit = "",
                       .across = "mass of a fragment, kg",
                       .n = SAMPLES,
                       .t = s->logarithm,
                       .begin = s->logarithm[0],
                       .end = s->logarithm[SAMPLES - 1]};
    add_lines(s);
    return true;
}

/* ---- the picture ---- */

static bool draw(sizes *s, const request *asked, FILE *log)
{
    const double margin = 14.0, width = 2.0 * ceil(0.5 * asked->width), height = 2.0 * ceil(0.25 * width);
    picture file;
    char note[80];
    (void)snprintf(note, sizeof note, "data %016" PRIx64, s->hash);
    if (!picture_open(&file, asked->output, width, height, s->o)) return false;
    if (!chart_draw(&s->chart, (box){margin, margin, width - margin, height - margin}, true, file.face)) {
        picture_drop(&file);
        return fail_memory(s->o);
    }
    if (!picture_close(&file, note, s->o)) return false;
    if (asked->prints_hash)
        (void)fprintf(log, "%016" PRIx64 "\n", s->hash);
    else
        (void)fprintf(log, "%s: %.0f x %.0f pixels, %zu frame%s, at last %lld fragment%s\n", asked->output, width,
                      height, s->chosen.n, s->chosen.n == 1 ? "" : "s", (long long)s->of[s->chosen.n - 1].n,
                      s->of[s->chosen.n - 1].n == 1 ? "" : "s");
    return true;
}

bool sizes_draw(const dem_reader *reader, const request *asked, FILE *log, outcome *o)
{
    sizes *s = calloc(1, sizeof *s);
    if (s == NULL) return fail_memory(o);
    *s = (sizes){.reader = reader, .o = o, .hash = DIGEST_BEGIN};
    const bool done = collect(s, asked) && draw(s, asked, log);
    for (size_t k = 0; k < CHART_LINES; k++) free(s->of[k].mass);
    frame_list_free(&s->chosen);
    free(s);
    return done;
}
