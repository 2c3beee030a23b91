/* SPDX-License-Identifier: BSD-3-Clause */
/* Runs with their logs, and what stands in these. A number of n digits after the point of its mantissa is off by half
 * of the last at most; the runs themselves are better by orders (rtol 1e-12). */
#ifndef DEM_TEST_LOGGED_H
#define DEM_TEST_LOGGED_H

#include "verification/support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "report.h"

static const double mass = 2.0, drop = 0.5, eta = 0.5, six_digits = 6e-7;
static const double floor_points[4] = {-9.0, 0.0, 9.0, 0.0};

/* A run with its log. */
typedef struct logged {
    support_run run;
    report report;
    run_log log;
    deck deck;
    char text[1 << 16];
} logged;

static inline void follow(logged *l, bool terminal, double t_end)
{
    l->log = (run_log){.out = tmpfile(), .terminal = terminal, .verbose = true};
    assert_non_null(l->log.out);
    l->deck = (deck){.t_end = t_end, .closure = 1e-2};
    assert_true(lattice_facts_find(&l->deck.facts, dem_model_lattice(l->run.model)));
    report_start(&l->report, &l->log, &l->deck);
    const dem_observer observer = report_observer(&l->report, 0);
    assert_ok(dem_simulation_observe(l->run.simulation, &observer));
}

static inline void read_log(logged *l)
{
    rewind(l->log.out);
    const size_t n = fread(l->text, 1, sizeof l->text - 1, l->log.out);
    assert_true(n < sizeof l->text - 1);
    l->text[n] = '\0';
}

static inline void finish(logged *l, double t_end)
{
    assert_ok(dem_simulation_advance(l->run.simulation, t_end));
    report_summary(&l->report, l->run.simulation);
    read_log(l);
}

static inline logged *make_logged(void)
{
    logged *l = calloc(1, sizeof *l);
    assert_non_null(l);
    return l;
}

static inline void free_logged(logged **l)
{
    report_end(&(*l)->report);
    lattice_facts_free(&(*l)->deck.facts);
    assert_int_equal(fclose((*l)->log.out), 0);
    support_close(&(*l)->run);
    free(*l);
}

/* One node dropped from rest onto a floor. */
static inline logged *drop_node(bool terminal, double t_end)
{
    const double x[2] = {0.0, drop}, v[2] = {0.25, 0.0};
    logged *l = make_logged();
    support_point(&l->run, mass, x, v, floor_points, 2, eta);
    follow(l, terminal, t_end);
    return l;
}

/* The line of a topic that has `word`; its first number behind the word. */
static inline double number_in(const char *text, const char *topic, const char *word)
{
    const size_t n = strlen(topic);
    for (const char *line = text; line != NULL && *line != '\0';) {
        const char *end = strchr(line, '\n'), *at = strstr(line, word);
        if (strncmp(line, topic, n) == 0 && line[n] == ' ' && at != NULL && end != NULL && at < end) {
            at += strlen(word);
            at += strcspn(at, "+-0123456789");
            assert_true(at < end);
            return strtod(at, NULL);
        }
        line = end != NULL ? end + 1 : NULL;
    }
    fail_msg("there is no '%s' with '%s' in\n%s", topic, word, text);
    return NAN;
}

/* The number that stands before a word: "3 impacts". */
static inline double number_before(const char *text, const char *word)
{
    const char *at = strstr(text, word);
    if (at == NULL) fail_msg("there is no '%s' in\n%s", word, text);
    while (at > text && strchr("+-0123456789.e", at[-1]) != NULL) at--;
    return strtod(at, NULL);
}

static inline int has_line(const char *text, const char *topic)
{
    char start[32];
    (void)snprintf(start, sizeof start, "\n%s ", topic);
    return strncmp(text, start + 1, strlen(start + 1)) == 0 || strstr(text, start) != NULL;
}

static inline logged *press(double t_end)
{
    const dem_material rubber = {.struct_size = sizeof(dem_material),
                                 .youngs_modulus = 1e7,
                                 .poissons_ratio = 1.0 / 3.0,
                                 .density = 1000.0,
                                 .thickness = 1.0,
                                 .guard = 0.02};
    dem_options options = dem_options_default();
    logged *l = make_logged();
    options.max_step = 1e-5, options.v_scale = 1.0;
    dem_lattice lattice = support_rectangle(2.0, 2.0, 1.0, &rubber);
    support_start(&lattice, lattice.x, NULL);
    for (dem_index i = 0; i < lattice.n_nodes; i++) lattice.position[2 * i + 1] *= 0.9;
    support_open(&l->run, &lattice, NULL, 0, &options);
    dem_lattice_free(&lattice);
    follow(l, false, t_end);
    return l;
}

/* A node above n floors, whose friction the caller sets. */
static inline logged *new_floors(dem_index n, dem_obstacle *floors, const dem_options *changed)
{
    const double x[2] = {0.0, drop};
    dem_options options = *changed;
    logged *l = make_logged();
    options.spacing = 1.0, options.max_step = 0.01, options.v_scale = 1.0;
    double *points = calloc((size_t)n, 4 * sizeof *points);
    assert_non_null(points);
    for (dem_index o = 0; o < n; o++) {
        memcpy(points + 4 * o, floor_points, sizeof floor_points);
        points[4 * o + 1] = points[4 * o + 3] = -(double)o;
        floors[o].n_points = 2, floors[o].points = points + 4 * o;
    }
    dem_lattice lattice = support_lattice(1, x, &mass, 0, NULL, 0.0, 0.0, NULL);
    support_open(&l->run, &lattice, floors, n, &options);
    dem_lattice_free(&lattice);
    free(points);
    follow(l, false, 1.0);
    return l;
}

/* 20 bodies of a node each, held. */
static inline logged *new_held(void)
{
    enum { n = 20 };
    double x[2 * n] = {0.0}, masses[n];
    dem_boundary held[n];
    dem_index nodes[n];
    dem_options options = dem_options_default();
    logged *l = make_logged();
    for (dem_index k = 0; k < n; k++) {
        x[2 * k] = (double)k, masses[k] = 1.0, nodes[k] = k;
        held[k] = (dem_boundary){.struct_size = sizeof(dem_boundary),
                                 .kind = DEM_BOUNDARY_VELOCITY,
                                 .components = 3,
                                 .n_nodes = 1,
                                 .nodes = &nodes[k]};
    }
    dem_lattice lattice = support_lattice(n, x, masses, 0, NULL, 0.0, 0.0, NULL);
    lattice.body = malloc(n * sizeof *lattice.body);
    assert_non_null(lattice.body);
    for (int k = 0; k < n; k++) lattice.body[k] = k;
    options.spacing = 1.0, options.max_step = 0.01, options.v_scale = 1.0;
    options.n_boundaries = n, options.boundaries = held;
    support_open(&l->run, &lattice, NULL, 0, &options);
    dem_lattice_free(&lattice);
    follow(l, false, 0.1);
    return l;
}

#endif
