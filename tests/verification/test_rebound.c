/* SPDX-License-Identifier: BSD-3-Clause */
/* The paper's three bodies, contacts taken where they happen and by stops of the whole body: they rebound alike, with
 * the same ledger and counts. `test_rebound FOLDER [SPACING]`: of the decks; m, 5 mm by default. */
#include <stdlib.h>

#include "coarse.h"
#include "ask.h"
#include "support.h"

static double rtol = 0.0; /* 0: the deck's */
static double spacing = 5e-3;
static const char *inputs;

typedef struct outcome {
    double first, last, rise; /* s, contact; m/s, of the body in the end */
    double closure, taken;    /* of the ledger, and by impacts, over the kinetic energy at first */
    double balance;           /* what is missing of the momentum, over that at first */
    dem_counts counts;
} outcome;

static dem_status note(void *context, const dem_simulation *simulation, const dem_event *event)
{
    outcome *o = context;
    (void)simulation;
    o->last = event->t;
    if (!(o->first > 0.0)) o->first = event->t;
    return DEM_OK;
}

static void run_deck(const char *name, double restitution, dem_contact_method method, outcome *out)
{
    CLEANUP(deck_free) deck d;
    CLEANUP(support_close) support_run run;
    *out = (outcome){.first = 0.0};
    const dem_observer observer = {.struct_size = sizeof(dem_observer), .event = note, .context = out};
    coarse_read(&d, inputs, name, spacing);
    d.obstacles[0].restitution = restitution;
    d.options.contact = method;
    d.options.window = 0.0;
    if (rtol > 0.0) d.options.rtol = rtol;
    support_open(&run, &d.lattice, d.obstacles, d.n_obstacles, &d.options);
    assert_ok(dem_simulation_observe(run.simulation, &observer));
    const dem_energy start = ask_energy(run.simulation);
    const dem_body_motion before = ask_body(run.simulation, 0);
    const dem_energy end = support_at(&run, 0.5 * d.t_end).energy;
    const dem_body_motion after = ask_body(run.simulation, 0);
    const dem_obstacle_load load = ask_obstacle(run.simulation, 0);
    const double given = load.impulse[1] / after.mass - 9.81 * 0.5 * d.t_end;
    out->rise = after.velocity[1];
    out->balance = fabs(after.velocity[1] - before.velocity[1] - given) / 10.0;
    out->closure = fabs(end.ledger - start.ledger) / start.kinetic;
    out->taken = end.impact / start.kinetic;
    out->counts = ask_counts(run.simulation);
}

/* Plastic bodies are not sensitive: 1e-3 of the rebound. Elastic ones, hit a thousand times, are, to the last digit:
 * what halving the spacing makes of the rebound, 3 percent. `share` of the impacts. */
static void compare(const char *name, double restitution, double share)
{
    outcome o[2];
    for (int m = 0; m < 2; m++) {
        run_deck(name, restitution, m == 0 ? DEM_CONTACT_LOCAL : DEM_CONTACT_EXACT, &o[m]);
        print_message("# %-9s eta %g, %s: contact %.6e to %.4e s, rebound %+.4f m/s, taken %.3e, closure %.1e, %lld "
                      "impacts, %lld evaluations\n",
                      name, restitution, m == 0 ? "local" : "exact", o[m].first, o[m].last, o[m].rise, o[m].taken,
                      o[m].closure, (long long)o[m].counts.impacts, (long long)o[m].counts.evaluations);
        assert_true(o[m].closure <= 2e-3);
        assert_true(o[m].balance <= 1e-8);
    }
    assert_close(o[0].first, o[1].first, 1e-9 * o[1].first); /* rigid flight until then */
    assert_close(o[0].rise, o[1].rise, (restitution > 0.0 ? 0.03 : 1e-3) * fabs(o[1].rise));
    assert_close(o[0].taken, o[1].taken, 0.01 * o[1].taken + 1e-12);
    const double impacts = (double)o[1].counts.impacts;
    assert_close((double)o[0].counts.impacts, impacts, share * impacts);
    assert_true(o[0].counts.evaluations < o[1].counts.evaluations);
}

TEST(plastic_bodies_rebound_alike)
{
    compare("rectangle", 0.0, 0.01);
    compare("disc", 0.0, 0.01);
    compare("porous", 0.0, 0.01);
}

/* How many impacts the porous body has is chance: with checkpoints at other steps, which change no more than the last
 * digits, `local` counts 1498 +- 64 at rtol 1e-6, 1408 +- 135 at 1e-7 and 1360 +- 72 at 1e-8, and `exact` 1281 +- 71,
 * 1319 +- 70 and 1286 +- 41. At 1e-8 three deviations of the difference of two such are a fifth; both means differ by
 * 6 percent. */
TEST(elastic_bodies_rebound_alike)
{
    compare("rectangle", 1.0, 0.01);
    compare("disc", 1.0, 0.01);
    rtol = 1e-8;
    compare("porous", 1.0, 0.26);
}

int main(int argc, char **argv)
{
    inputs = argc > 1 ? argv[1] : "inputs";
    if (argc > 2) spacing = atof(argv[2]);
    return test_run();
}
