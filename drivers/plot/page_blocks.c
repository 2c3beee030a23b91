/* SPDX-License-Identifier: BSD-3-Clause */
#include "page_blocks.h"

#include <stdlib.h>

#include "base64.h"
#include "obstacle_fill.h"
#include "palette.h"
#include "snapshot.h"

enum {
    SCALE = 65535,         /* of places */
    ABSENT = PALETTE_SIZE, /* in place of a colour: what is broken, or a point without a value */
    LETTERS = 96,          /* around a block, at most */
    MARGIN = 20            /* sides of the view that a page can be moved and shrunk by, as its script has it */
};

_Static_assert(ABSENT < 256, "a byte");

static double block_length(double bytes)
{
    return LETTERS + base64_length(bytes);
}

/* ---- sizes ---- */

static double index_bytes(const page_content *p)
{
    return p->lattice->n_nodes > SCALE + 1 ? 4.0 : 2.0;
}

static double outline_bytes(const dem_obstacle *obstacle)
{
    return 8.0 * (1.0 + 2.0 * ((double)obstacle->n_points + OBSTACLE_FILL_MORE));
}

static double outlines_length(const page_content *p, bool moves)
{
    double length = 0.0;
    for (dem_index k = 0; k < dem_reader_n_obstacles(p->reader); k++) {
        const dem_obstacle *obstacle = dem_reader_obstacle(p->reader, k);
        if (dem_obstacle_moves(obstacle, NULL) == moves) length += block_length(outline_bytes(obstacle));
    }
    return length;
}

double page_blocks_fixed(const page_content *p)
{
    const dem_lattice *l = p->lattice;
    const double each = index_bytes(p), blocks = (double)p->n_quantities + (double)dem_reader_n_obstacles(p->reader);
    double length = outlines_length(p, false) + (LETTERS + 4) * blocks + block_length(each * (double)p->n_bare);
    if (page_content_draws(p, false)) length += block_length(2.0 * each * (double)l->n_springs);
    if (page_content_draws(p, true)) length += block_length(3.0 * each * (double)l->n_triangles);
    for (int k = 0; p->history != NULL && k < p->history->n_charts; k++)
        length += block_length(0.0) * (1 + p->history->chart[k].n_lines);
    return length;
}

double page_blocks_per_frame(const page_content *p)
{
    double bytes = 4.0 * (double)p->lattice->n_nodes;
    for (size_t k = 0; k < p->n_quantities; k++) bytes += (double)(p->quantity[k].n_cells + p->n_bare);
    return base64_length(bytes) + outlines_length(p, true);
}

double page_blocks_per_row(const page_content *p)
{
    double bytes = sizeof(double);
    for (int k = 0; p->history != NULL && k < p->history->n_charts; k++)
        bytes += (double)sizeof(float) * p->history->chart[k].n_lines;
    return bytes * 4.0 / 3.0;
}

/* ---- blocks ---- */

/* Names are a letter or two and numbers: nothing to be escaped. */
static base64 begin(FILE *out, const char *name, size_t k)
{
    (void)fprintf(out, "<script type=\"text/plain\" id=\"%s%zu\">", name, k);
    return (base64){.out = out};
}

static void end(base64 *b)
{
    base64_end(b);
    (void)fputs("</script>\n", b->out);
}

static void put_indices(const page_content *p, FILE *out, const char *name, dem_index n, const dem_index *index)
{
    base64 b = begin(out, name, 0);
    for (dem_index k = 0; k < n; k++) base64_whole(&b, (uint64_t)index[k], (int)index_bytes(p));
    end(&b);
}

static void put_lattice(const page_content *p, FILE *out)
{
    const dem_lattice *l = p->lattice;
    if (page_content_draws(p, false)) put_indices(p, out, "springs", 2 * l->n_springs, l->ends);
    if (page_content_draws(p, true)) put_indices(p, out, "triangles", 3 * l->n_triangles, l->triangles);
    base64 b = begin(out, "bare", 0);
    for (dem_index k = 0; k < l->n_nodes; k++)
        if (p->is_bare[k]) base64_whole(&b, (uint64_t)k, (int)index_bytes(p));
    end(&b);
}

static uint64_t share(double x, double from, double width)
{
    return width > 0.0 ? (uint64_t)lround(SCALE * (x - from) / width) : 0;
}

static bool put_places(const page_content *p, FILE *out, outcome *o)
{
    const quantity none = {.name = "", .label = ""};
    snapshot s;
    bool good = snapshot_create(&s, p->reader, &none, o);
    base64 b = begin(out, "places", 0);
    for (size_t k = 0; k < p->frames.n && good; k++) {
        const box all = p->box[k];
        good = snapshot_load(&s, p->frames.frame[k], o);
        for (dem_index i = 0; i < p->lattice->n_nodes && good; i++) {
            base64_whole(&b, share(s.x[2 * i], all.x0, box_width(all)), 2);
            base64_whole(&b, share(s.x[2 * i + 1], all.y0, box_height(all)), 2);
        }
    }
    end(&b);
    snapshot_free(&s);
    return good;
}

static int shade_of(const page_quantity *q, double value)
{
    if (q->shown.source == NULL) return PALETTE_SIZE / 2;
    return palette_index(value, q->range.lo, q->range.hi);
}

static void put_shades(const page_content *p, const page_quantity *q, const snapshot *s, base64 *b)
{
    const bool of_nodes = q->shown.source != NULL && !q->shown.source->of_springs;
    for (dem_index k = 0; k < (dem_index)q->n_cells; k++) {
        const bool is_broken = q->fills ? s->broken_triangles[k] != 0 : s->broken_springs[k] != 0.0;
        const double value = q->fills ? snapshot_triangle_value(s, k) : snapshot_spring_value(s, k);
        base64_whole(b, (uint64_t)(is_broken ? ABSENT : shade_of(q, value)), 1);
    }
    for (dem_index k = 0; k < p->lattice->n_nodes; k++)
        if (p->is_bare[k]) base64_whole(b, (uint64_t)(of_nodes ? shade_of(q, s->value[k]) : ABSENT), 1);
}

static bool put_quantity(const page_content *p, size_t number, FILE *out, outcome *o)
{
    const page_quantity *q = &p->quantity[number];
    snapshot s;
    bool good = snapshot_create(&s, p->reader, &q->shown, o);
    base64 b = begin(out, "shades", number);
    for (size_t k = 0; k < p->frames.n && good; k++) {
        good = snapshot_load(&s, p->frames.frame[k], o);
        if (good) put_shades(p, q, &s, &b);
    }
    end(&b);
    snapshot_free(&s);
    return good;
}

/* ---- obstacles ---- */

static box surroundings(box view)
{
    return box_grown(view, MARGIN * fmax(box_width(view), box_height(view)));
}

/* How many points, then the points. */
static bool put_outline(const page_content *p, const dem_obstacle *obstacle, double t, base64 *b)
{
    obstacle_fill solid;
    if (!obstacle_fill_at(obstacle, t, surroundings(p->view), &solid)) return false;
    base64_real(b, (double)solid.n);
    for (size_t k = 0; k < 2 * solid.n; k++) base64_real(b, solid.xy[k]);
    free(solid.xy);
    return true;
}

/* One outline of what is at rest, else one for each frame. */
static bool put_obstacle(const page_content *p, dem_index number, FILE *out)
{
    const dem_obstacle *obstacle = dem_reader_obstacle(p->reader, number);
    const size_t n = dem_obstacle_moves(obstacle, NULL) ? p->frames.n : 1;
    dem_index n_frames;
    const double *t = dem_reader_times(p->reader, &n_frames);
    base64 b = begin(out, "obstacle", (size_t)number);
    bool good = true;
    for (size_t k = 0; k < n && good; k++) good = put_outline(p, obstacle, t[p->frames.frame[k]], &b);
    end(&b);
    return good;
}

/* ---- history ---- */

/* Rows that are too many are binned: of each bin there are the least and the largest number, in their order. */
static void put_bin(const chart_line *line, size_t from, size_t to, base64 *b)
{
    size_t least = from, most = from;
    for (size_t k = from; k < to; k++) {
        const double y = line->y[line->stride * k];
        if (!(y >= line->y[line->stride * least])) least = k;
        if (!(y <= line->y[line->stride * most])) most = k;
    }
    base64_single(b, (float)line->y[line->stride * (least < most ? least : most)]);
    base64_single(b, (float)line->y[line->stride * (least < most ? most : least)]);
}

static size_t bin_begin(const page_content *p, size_t bin)
{
    return bin * p->history->n / (p->n_rows / 2);
}

static void put_line(const page_content *p, const chart_line *line, base64 *b)
{
    if (p->n_rows == p->history->n)
        for (size_t k = 0; k < p->n_rows; k++) base64_single(b, (float)line->y[line->stride * k]);
    else
        for (size_t k = 0; k < p->n_rows / 2; k++) put_bin(line, bin_begin(p, k), bin_begin(p, k + 1), b);
}

static void put_times(const page_content *p, base64 *b)
{
    const double *t = p->history->t;
    if (p->n_rows == p->history->n)
        for (size_t k = 0; k < p->n_rows; k++) base64_real(b, t[k]);
    else
        for (size_t k = 0; k < p->n_rows / 2; k++) {
            base64_real(b, t[bin_begin(p, k)]);
            base64_real(b, t[bin_begin(p, k + 1) - 1]);
        }
}

static void put_history(const page_content *p, FILE *out)
{
    base64 b = begin(out, "times", 0);
    put_times(p, &b);
    end(&b);
    for (int c = 0; c < p->history->n_charts; c++)
        for (int k = 0; k < p->history->chart[c].n_lines; k++) {
            b = begin(out, "line", (size_t)c * CHART_LINES + (size_t)k);
            put_line(p, &p->history->chart[c].line[k], &b);
            end(&b);
        }
}

bool page_blocks_write(const page_content *p, FILE *out, outcome *o)
{
    bool good = true;
    put_lattice(p, out);
    if (p->history != NULL) put_history(p, out);
    for (dem_index k = 0; k < dem_reader_n_obstacles(p->reader) && good; k++) good = put_obstacle(p, k, out);
    if (!good) return outcome_fail(o, EXIT_MEMORY, "dem_plot", "out of memory"), false;
    good = put_places(p, out, o);
    for (size_t k = 0; k < p->n_quantities && good; k++) good = put_quantity(p, k, out, o);
    return good;
}
