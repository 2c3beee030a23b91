/* SPDX-License-Identifier: BSD-3-Clause */
/* The decks in inputs/, coarser and shorter, so that the suite takes seconds: the paper's bodies at 6 or 7 mm instead
 * of 2.5 or 5 mm, until 6 ms, when they have rebounded, instead of 20 ms; every_key as it is. These have stepped edges
 * here and do not touch each other, as all had before there was anything else. The discs and the mill have what came
 * then, smooth outlines, coupled springs, contact of bodies and an obstacle that turns; they run until they have parted
 * again. */
#include <stdio.h>

#include <dem/trajectory.h>

#include "cases.h"
#include "deck.h"
#include "kernels.h"
#include "store.h"
#include "trace.h"
#include "ask.h"
#include "verification/support.h"

enum { NAME = 64, PATH = 4096 };

enum { SETTINGS = 3 };

/* A deck, the share of its time that is run, and what is set otherwise. */
typedef struct source {
    const char *name;
    double share;
    const char *settings[SETTINGS]; /* the last ones may be NULL */
} source;

#define AS_BEFORE "contact.bodies=none", "body.outline=lattice"
static const source sources[] = {
    {"rectangle", 0.3, {"body.spacing=7e-3", AS_BEFORE}},
    {"disc", 0.3, {"body.spacing=7e-3", AS_BEFORE}},
    {"disc_friction", 0.3, {"body.spacing=7e-3", AS_BEFORE}},
    {"porous", 0.3, {"body.spacing=6e-3", AS_BEFORE}},
    {"every_key", 1.0, {"body.spacing=1e-2", AS_BEFORE}},
    {"two_discs", 0.3, {"body(1).spacing=4e-3", "body(2).spacing=4e-3"}},
    {"mill", 0.25, {"body.spacing=3e-3"}},
};
enum { N_SOURCES = sizeof sources / sizeof *sources };

static const struct {
    const char *name;
    dem_contact_method method;
} contacts[2] = {{"local", DEM_CONTACT_LOCAL}, {"exact", DEM_CONTACT_EXACT}};

static const struct {
    const char *name;
    dem_method method;
} integrators[3] = {{"fehlberg45", DEM_METHOD_FEHLBERG45}, {"verlet", DEM_METHOD_VERLET}, {"rk4", DEM_METHOD_RK4}};

static void read_deck(deck *d, const char *folder, const source *from)
{
    char path[PATH];
    setting settings[SETTINGS];
    size_t n = 0;
    CLEANUP(namelist_errors_free) namelist_errors errors = {0};
    (void)snprintf(path, sizeof path, "%s/%s.nml", folder, from->name);
    for (; n < SETTINGS && from->settings[n] != NULL; n++) assert_true(setting_parse(&settings[n], from->settings[n]));
    if (deck_parse(d, path, settings, n, &errors) != DECK_OK || deck_build(d, &errors) != DECK_OK)
        fail_msg("%s: %s", path, errors.n > 0 ? errors.list[0].text : "?");
    d->t_end *= from->share;
}

/* ---- what is seen of a run ---- */

static uint64_t run_deck(const void *what, dem_kernel kernel)
{
    const deck *d = what;
    trace t = trace_begin();
    CLEANUP(support_close) support_run run;
    dem_options options = d->options;
    const dem_observer observer = trace_observer(&t, d->t_end / 8.0);
    options.kernel = kernel;
    support_open(&run, &d->lattice, d->obstacles, d->n_obstacles, &options);
    assert_ok(dem_simulation_observe(run.simulation, &observer));
    assert_ok(dem_simulation_advance(run.simulation, d->t_end));
    trace_add_all(&t, run.simulation);
    assert_true(t.n_events > 0 || d->n_obstacles == 0);
    return t.hash;
}

void cases_decks(const char *folder)
{
    for (int s = 0; s < N_SOURCES; s++) {
        CLEANUP(deck_free) deck d;
        read_deck(&d, folder, &sources[s]);
        for (int m = 0; m < 3; m++)
            for (int c = 0; c < 2; c++) {
                char name[NAME];
                d.options.method = integrators[m].method;
                d.options.contact = contacts[c].method;
                (void)snprintf(name, sizeof name, "%s.%s.%s", sources[s].name, integrators[m].name, contacts[c].name);
                kernels_check(name, run_deck, &d);
            }
    }
}

/* ---- what is written of it ---- */

static dem_trajectory_options all_of(const deck *d, const dem_peaks *peaks)
{
    dem_trajectory_options options = dem_trajectory_options_default();
    options.frame_interval = d->t_end / 4.0;
    options.double_precision = 1;
    options.events = 1;
    /* The others came after the stored hashes. */
    options.fields = DEM_FIELD_ALL & ~(DEM_FIELD_CONTACT | DEM_FIELD_FRAGMENT | DEM_FIELD_DAMAGE);
    options.peaks = peaks;
    options.n_probes = d->n_probes;
    options.probes = d->probes;
    return options;
}

static void write_run(const deck *d, const char *path)
{
    CLEANUP(support_close) support_run run;
    CLEANUP(free_peaks) dem_peaks *peaks;
    CLEANUP(free_trajectory) dem_trajectory *trajectory;
    support_open(&run, &d->lattice, d->obstacles, d->n_obstacles, &d->options);
    assert_ok(dem_peaks_create(&peaks, run.model, 4));
    const dem_trajectory_options options = all_of(d, peaks);
    assert_ok(dem_trajectory_create(&trajectory, path, run.simulation, &options));
    const dem_observer observers[2] = {ask_peaks_observer(peaks), ask_trajectory_observer(trajectory)};
    for (int k = 0; k < 2; k++) assert_ok(dem_simulation_observe(run.simulation, &observers[k]));
    assert_ok(dem_simulation_advance(run.simulation, d->t_end));
    assert_ok(dem_trajectory_finish(trajectory));
}

static void check_file(const deck *d, const char *name)
{
    trace t = trace_begin();
    write_run(d, "lock.vtkhdf");
    trace_add_frames(&t, "lock.vtkhdf");
    (void)remove("lock.vtkhdf");
    (void)remove("lock.obstacle.vtkhdf");
    (void)remove("lock.body.vtkhdf");
    store_check(name, t.hash);
}

void cases_files(const char *folder)
{
    for (int s = 0; s < N_SOURCES; s++)
        for (int c = 0; c < 2; c++) {
            CLEANUP(deck_free) deck d;
            char name[NAME];
            read_deck(&d, folder, &sources[s]);
            d.options.contact = contacts[c].method;
            (void)snprintf(name, sizeof name, "%s.file.%s", sources[s].name, contacts[c].name);
            check_file(&d, name);
        }
}
