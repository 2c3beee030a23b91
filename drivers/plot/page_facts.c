/* SPDX-License-Identifier: BSD-3-Clause */
#include "page_facts.h"

#include <stdlib.h>
#include <string.h>

#include <dem/trajectory.h>

#include "choice.h"
#include "base/file.h"
#include "json.h"
#include "legend.h"
#include "palette.h"

static const size_t least_note = 1 << 12, most_note = 1 << 26; /* bytes */
static const size_t most_summary = 1 << 20;

static bool fail_memory(outcome *o)
{
    outcome_fail(o, EXIT_MEMORY, "dem_plot", "out of memory");
    return false;
}

/* A JSON text in memory. */
typedef struct memo {
    json json;
    size_t size;
} memo;

static bool memo_open(memo *m, char **text, outcome *o)
{
    *text = NULL;
    *m = (memo){{open_memstream(text, &m->size), false}, 0};
    if (m->json.out == NULL) return fail_memory(o);
    json_open(&m->json, NULL, '{');
    return true;
}

static bool memo_close(memo *m, char **text, outcome *o)
{
    json_close(&m->json, '}');
    if (fclose(m->json.out) == 0) return true;
    free(*text);
    *text = NULL;
    return fail_memory(o);
}

/* ---- texts of the file ---- */

/* NULL where there is none of that name; so is one of more than 64 MiB. False without memory. */
static bool read_note(const char *path, const char *name, char **text)
{
    dem_status status = DEM_ERROR_ARGUMENT;
    *text = NULL;
    for (size_t size = least_note; size <= most_note && status == DEM_ERROR_ARGUMENT; size *= 4) {
        free(*text);
        *text = malloc(size);
        if (*text == NULL) return false;
        status = dem_trajectory_read_note(path, name, *text, size);
    }
    if (status == DEM_OK) return true;
    free(*text);
    *text = NULL;
    return true;
}

bool page_facts_notes(const char *path, char **text, outcome *o)
{
    static const char *const names[] = {"title", "versions", "kernel",   "problem", "run",
                                        "start", "t_end",    "resolved", "deck"};
    memo m;
    bool good = true;
    if (!memo_open(&m, text, o)) return false;
    for (size_t k = 0; k < sizeof names / sizeof *names && good; k++) {
        char *note;
        good = read_note(path, names[k], &note);
        if (good) json_text(&m.json, names[k], note);
        free(note);
    }
    good = memo_close(&m, text, o) && (good || fail_memory(o));
    if (!good) free(*text), *text = NULL;
    return good;
}

static size_t length_without(const char *path, size_t n, const char *ending)
{
    const size_t m = strlen(ending);
    return n >= m && strncmp(path + n - m, ending, m) == 0 ? n - m : n;
}

bool page_facts_summary(const char *path, char **text, outcome *o)
{
    const size_t n = length_without(path, length_without(path, strlen(path), ".vtkhdf"), ".part");
    const size_t room = n + sizeof ".json";
    char why[FILE_WHY], *name = malloc(room);
    size_t size;
    if (name == NULL) return fail_memory(o);
    (void)snprintf(name, room, "%.*s.json", (int)n, path);
    const file_status status = file_read(text, &size, name, most_summary, why);
    free(name);
    if (status == FILE_REFUSED) *text = strdup("null");
    return *text != NULL || fail_memory(o);
}

/* ---- frames, quantities, charts ---- */

static const char *name_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash != NULL ? slash + 1 : path;
}

static void put_box(json *j, const char *key, box b)
{
    json_reals(j, key, (const double[]){b.x0, b.y0, b.x1, b.y1}, 4);
}

static void put_frames(const page_content *p, json *j)
{
    dem_index n;
    const double *t = dem_reader_times(p->reader, &n);
    json_integer(j, "frames_in_file", n);
    json_integer(j, "frames_asked", (int64_t)p->n_asked);
    json_open(j, "frames", '[');
    for (size_t k = 0; k < p->frames.n; k++) {
        json_open(j, NULL, '{');
        json_integer(j, "number", p->frames.frame[k]);
        json_real(j, "t", t[p->frames.frame[k]]);
        put_box(j, "box", p->box[k]);
        json_close(j, '}');
    }
    json_close(j, ']');
}

static void put_palette(json *j, const palette *colours)
{
    char text[6 * PALETTE_SIZE + 1];
    for (int k = 0; k < PALETTE_SIZE; k++) {
        const colour ink = colours->of[k];
        (void)snprintf(text + (size_t)(6 * k), 7, "%02x%02x%02x", ink.red, ink.green, ink.blue);
    }
    json_text(j, "palette", text);
}

static void put_quantity(const page_quantity *q, json *j)
{
    static const char *const kinds[] = {[PALETTE_DIVERGING] = "diverging",
                                        [PALETTE_SEQUENTIAL] = "sequential",
                                        [PALETTE_UPPER] = "upper",
                                        [PALETTE_LOWER] = "lower",
                                        [PALETTE_PIECES] = "pieces"};
    const palette colours = choice_palette(&q->shown, q->range);
    const bool has_scale = q->shown.source != NULL && q->shown.scale != PALETTE_PIECES;
    char unit[LEGEND_UNIT] = "";
    double factor = 1.0;
    if (has_scale) factor = legend_unit(unit, fmax(fabs(q->range.lo), fabs(q->range.hi)), q->shown.source->unit);
    json_open(j, NULL, '{');
    json_text(j, "name", q->shown.name);
    json_text(j, "label", q->shown.label);
    json_text(j, "unit", unit);
    json_real(j, "factor", factor);
    json_reals(j, "range", (const double[]){q->range.lo, q->range.hi}, 2);
    json_truth(j, "below", q->range.below);
    json_truth(j, "above", q->range.above);
    json_truth(j, "has_scale", has_scale);
    json_text(j, "kind", kinds[colours.kind]);
    json_truth(j, "fills", q->fills);
    json_integer(j, "cells", (int64_t)q->n_cells);
    put_palette(j, &colours);
    json_close(j, '}');
}

static void put_quantities(const page_content *p, json *j)
{
    json_open(j, "quantities", '[');
    for (size_t k = 0; k < p->n_quantities; k++) put_quantity(&p->quantity[k], j);
    json_close(j, ']');
    json_open(j, "left_out", '[');
    for (size_t k = p->n_quantities; k < p->n_found; k++) json_text(j, NULL, p->quantity[k].shown.name);
    json_close(j, ']');
}

static void put_chart(const chart *c, int number, json *j)
{
    json_open(j, NULL, '{');
    json_text(j, "label", c->label);
    json_text(j, "unit", c->unit);
    json_truth(j, "by_decades", c->by_decades);
    json_open(j, "lines", '[');
    for (int k = 0; k < c->n_lines; k++) {
        char ink[8];
        (void)snprintf(ink, sizeof ink, "#%02x%02x%02x", c->line[k].ink.red, c->line[k].ink.green, c->line[k].ink.blue);
        json_open(j, NULL, '{');
        json_text(j, "name", c->line[k].name);
        json_text(j, "ink", ink);
        json_integer(j, "block", (int64_t)number * CHART_LINES + k);
        json_close(j, '}');
    }
    json_close(j, ']');
    json_close(j, '}');
}

static void put_history(const page_content *p, json *j)
{
    json_integer(j, "rows_in_file", p->history != NULL ? (int64_t)p->history->n : 0);
    json_integer(j, "rows", (int64_t)p->n_rows);
    json_open(j, "charts", '[');
    for (int k = 0; p->history != NULL && k < p->history->n_charts; k++) put_chart(&p->history->chart[k], k, j);
    json_close(j, ']');
}

static void put_lattice(const page_content *p, json *j)
{
    const dem_lattice *l = p->lattice;
    double mass = 0.0;
    for (dem_index k = 0; k < l->n_nodes; k++) mass += l->mass[k];
    json_integer(j, "nodes", l->n_nodes);
    json_integer(j, "springs", l->n_springs);
    json_integer(j, "triangles", l->n_triangles);
    json_integer(j, "bare", (int64_t)p->n_bare);
    json_real(j, "mass", mass);
}

bool page_facts_content(const page_content *p, char **text, outcome *o)
{
    memo m;
    if (!memo_open(&m, text, o)) return false;
    json *j = &m.json;
    json_text(j, "file", name_of(p->asked->input));
    json_text(j, "program", dem_version());
    json_real(j, "max_size", p->asked->max_size);
    put_lattice(p, j);
    put_box(j, "view", p->view);
    put_frames(p, j);
    put_quantities(p, j);
    json_open(j, "moves", '[');
    for (dem_index k = 0; k < dem_reader_n_obstacles(p->reader); k++)
        json_truth(j, NULL, dem_obstacle_moves(dem_reader_obstacle(p->reader, k), NULL));
    json_close(j, ']');
    put_history(p, j);
    return memo_close(&m, text, o);
}

/* ---- within a page ---- */

void page_facts_write(const char *text, FILE *out)
{
    for (const char *at = text;; at++) {
        const size_t n = strcspn(at, "<");
        (void)fwrite(at, 1, n, out);
        at += n;
        if (*at == '\0') break;
        (void)fputs("\\u003c", out);
    }
}

double page_facts_length(const char *text)
{
    double length = 0.0;
    for (; *text != '\0'; text++) length += *text == '<' ? 6.0 : 1.0;
    return length;
}
