/* SPDX-License-Identifier: BSD-3-Clause */
/* What the impact window costs and saves: the paper's three decks, each impact by itself against windows of
 * kappa/omega_max. First come the errors that a run has anyway, single impacts at rtol 1e-8 and at half the spacing;
 * every row is compared with single impacts at rtol 1e-6: the centre of mass and its velocity after the last contact,
 * the nodes at t_end (root mean square over spacing). `bench_window INPUTS [SPACING [ETA]...]` */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/vec2.h"
#include "harness/motion.h"
#include "unit/whole_deck.h"

enum { path_size = 4096 };

typedef struct run {
    double window, rtol, spacing;
    dem_index n;
    double *x; /* [n][2] m, at t_end */
    double last, seconds, closure, taken;
    dem_body_motion body; /* at t_end */
    double rebound[2];    /* m/s, after the last contact */
    dem_counts counts;
} run;

static void must(bool good, const char *what)
{
    if (good) return;
    (void)fprintf(stderr, "bench_window: %s: %s\n", what, dem_status_message());
    exit(1);
}

/* The deck of that name at another spacing. */
static void read_deck(deck *d, const char *inputs, const char *name, double spacing)
{
    char path[path_size], text[8192], number[7];
    namelist_errors errors = {0};
    (void)snprintf(path, sizeof path, "%s/%s.nml", inputs, name);
    FILE *file = fopen(path, "r");
    must(file != NULL, path);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    (void)fclose(file);
    char *at = strstr(text, "2.5e-3");
    must(at != NULL, "no spacing in the deck");
    (void)snprintf(number, sizeof number, "%.4f", spacing);
    memcpy(at, number, 6);
    (void)snprintf(path, sizeof path, "window_%s_%ld.nml", name, (long)clock());
    file = fopen(path, "w");
    must(file != NULL && fputs(text, file) >= 0 && fclose(file) == 0, path);
    must(whole_deck_read(d, path, &errors) == DECK_OK, path);
    namelist_errors_free(&errors);
    (void)remove(path);
}

static dem_status note(void *context, const dem_simulation *simulation, const dem_event *event)
{
    (void)simulation;
    if (event->kind == DEM_EVENT_IMPACT || event->kind == DEM_EVENT_RELEASE) *(double *)context = event->t;
    return DEM_OK;
}

/* \param kappa  window in units of 1/omega_max */
static run take(const char *inputs, const char *name, double spacing, double eta, double rtol, double kappa)
{
    deck d;
    dem_model *model;
    dem_simulation *simulation;
    motion state;
    run r = {.rtol = rtol, .spacing = spacing};
    const dem_observer observer = {.struct_size = sizeof(dem_observer), .event = note, .context = &r.last};
    read_deck(&d, inputs, name, spacing);
    d.obstacles[0].restitution = eta;
    must(dem_model_create(&model, &d.lattice, d.obstacles, d.n_obstacles) == DEM_OK, name);
    d.options.rtol = rtol;
    d.options.contact = DEM_CONTACT_EXACT;
    d.options.window = r.window = kappa / dem_model_omega_max(model);
    must(dem_simulation_create(&simulation, model, &d.options) == DEM_OK, name);
    must(dem_simulation_observe(simulation, &observer) == DEM_OK, name);
    const dem_energy start = ask_energy(simulation);
    const clock_t begin = clock();
    if (dem_simulation_advance(simulation, d.t_end) != DEM_OK) (void)printf("FAILED: %s\n", dem_status_message());
    r.seconds = (double)(clock() - begin) / CLOCKS_PER_SEC;
    motion_see(simulation, &state);
    r.closure = (state.energy.ledger - start.ledger) / start.kinetic;
    r.taken = state.energy.impact / start.kinetic;
    r.body = ask_body(simulation, 0);
    r.counts = ask_counts(simulation);
    for (int k = 0; k < 2; k++) r.rebound[k] = r.body.velocity[k] - d.options.gravity[k] * (state.t - r.last);
    r.n = d.lattice.n_nodes;
    r.x = malloc(2 * (size_t)r.n * sizeof *r.x);
    must(r.x != NULL, "memory");
    memcpy(r.x, state.x, 2 * (size_t)r.n * sizeof *r.x);
    dem_simulation_destroy(simulation);
    dem_model_destroy(model);
    deck_free(&d);
    return r;
}

static double distance(const double *a, const double *b)
{
    return vec2_norm(vec2_sub(vec2_at(a, 0), vec2_at(b, 0)));
}

static double apart(const run *a, const run *b)
{
    double sum = 0.0;
    if (a->n != b->n) return NAN;
    for (dem_index i = 0; i < a->n; i++) sum += pow(distance(&a->x[2 * i], &b->x[2 * i]), 2.0);
    return sqrt(sum / (double)a->n) / b->spacing;
}

static void print(const char *name, double eta, const char *what, const run *r, const run *reference)
{
    (void)printf("| %s | %g | %s | %.4f | %.1e | %.1e | %.1e | %lld | %lld | %lld | %lld | %lld | %lld | %.2f | %+.0e "
                 "| %.4f |\n",
                 name, eta, what, r->rebound[1], distance(r->rebound, reference->rebound),
                 distance(r->body.centre, reference->body.centre) / reference->spacing, apart(r, reference),
                 (long long)r->counts.impacts, (long long)r->counts.early, (long long)r->counts.events,
                 (long long)r->counts.late, (long long)r->counts.steps, (long long)r->counts.evaluations, r->seconds,
                 r->closure, r->taken);
    (void)fflush(stdout);
}

static void compare(const char *inputs, const char *name, double spacing, double eta)
{
    static const double kappas[] = {0.01, 0.03, 0.1, 0.3, 1.0};
    const run single = take(inputs, name, spacing, eta, 1e-6, 0.0);
    run tight = take(inputs, name, spacing, eta, 1e-8, 0.0);
    print(name, eta, "rtol 1e-8", &tight, &single);
    free(tight.x);
    if (spacing > 3e-3) {
        run fine = take(inputs, name, 0.5 * spacing, eta, 1e-6, 0.0);
        print(name, eta, "spacing/2", &fine, &single);
        free(fine.x);
    }
    print(name, eta, "0", &single, &single);
    for (size_t k = 0; k < sizeof kappas / sizeof *kappas; k++) {
        char what[32];
        run r = take(inputs, name, spacing, eta, 1e-6, kappas[k]);
        (void)snprintf(what, sizeof what, "%g", kappas[k]);
        print(name, eta, what, &r, &single);
        free(r.x);
    }
    free(single.x);
}

int main(int argc, char **argv)
{
    static const char *const names[] = {"rectangle", "disc", "porous"};
    static const double usual[] = {0.0, 0.5, 0.9, 1.0};
    const char *inputs = argc > 1 ? argv[1] : "inputs";
    const double spacing = argc > 2 ? atof(argv[2]) : 5e-3;
    const int n = argc > 3 ? argc - 3 : 4;
    (void)printf("| deck | eta | kappa | rebound, m/s | its difference | centre | nodes | impacts | early | stops | "
                 "late | steps "
                 "| evaluations | CPU s | closure | taken |\n");
    (void)printf("|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (int k = 0; k < n; k++)
        for (int q = 0; q < 3; q++) compare(inputs, names[q], spacing, argc > 3 ? atof(argv[3 + k]) : usual[k]);
    return 0;
}
