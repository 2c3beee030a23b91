/* SPDX-License-Identifier: BSD-3-Clause */
/* The paper's three bodies, whose voids close in the impact: with contact of a body with itself no surfaces overlap,
 * and the porous one rebounds as an independent program of the same law found. `test_porous FOLDER [SPACING]`: of the
 * decks; m, instead of 5 and 2.5 mm. */
#include "ask.h"
#include "coarse.h"
#include "support.h"

static const char *inputs;
static double spacings[2] = {5e-3, 2.5e-3};
static int n_spacings = 2;

/* What a run of 10 ms shows. */
typedef struct outcome {
    double rebound, closure;
    dem_index overlaps;
} outcome;

static outcome fall(const char *name, double spacing, dem_bodies bodies, dem_contact_method method)
{
    CLEANUP(deck_free) deck d;
    CLEANUP(support_close) support_run run;
    coarse_read(&d, inputs, name, spacing);
    d.options.bodies = bodies;
    d.options.contact = method;
    support_open(&run, &d.lattice, d.obstacles, d.n_obstacles, &d.options);
    const dem_energy start = ask_energy(run.simulation), end = support_at(&run, 0.01).energy;
    const outcome o = {.rebound = ask_body(run.simulation, 0).velocity[1],
                       .closure = fabs(end.ledger - start.ledger) / start.kinetic,
                       .overlaps = ask_overlap(run.simulation).most};
    print_message("# %s at %g m, bodies %d, method %d: rebound %.5f m/s, %lld overlaps, closure %.1e\n", name, spacing,
                  (int)bodies, (int)method, o.rebound, (long long)o.overlaps, o.closure);
    return o;
}

/* The program had its own search for pairs, and reached the library as an external force. By both methods of contact
 * its digits are found, to 2e-5 m/s. A law of a tenth of the pressure gives 9.3183 m/s at 2.5 mm. */
static void check_rebound(const outcome *o, double spacing)
{
    if (spacing == 2.5e-3) assert_close(o->rebound, 9.32170, 2e-3);
    if (spacing == 1.25e-3) assert_close(o->rebound, 9.29877, 2e-3);
}

/* Closures by the integrator at rtol 1e-6: found are 4e-6 to 4e-5, the largest ones at 1.25 mm. */
TEST(voids_close_without_overlap)
{
    static const char *names[3] = {"rectangle", "disc", "porous"};
    for (int s = 0; s < n_spacings; s++)
        for (int k = 0; k < 3; k++) {
            const outcome o = fall(names[k], spacings[s], DEM_BODIES_ALL, DEM_CONTACT_LOCAL);
            assert_int_equal(o.overlaps, 0);
            assert_true(o.closure < 1e-4);
            if (k == 2) check_rebound(&o, spacings[s]);
        }
}

TEST(the_porous_body_rebounds_alike_by_both_methods_of_contact)
{
    const double spacing = spacings[n_spacings - 1];
    const outcome o = fall("porous", spacing, DEM_BODIES_ALL, DEM_CONTACT_EXACT);
    assert_int_equal(o.overlaps, 0);
    check_rebound(&o, spacing);
}

/* So what is above is the work of the contact. */
TEST(without_contact_of_bodies_pores_run_into_each_other)
{
    const outcome o = fall("porous", 2.5e-3, DEM_BODIES_NONE, DEM_CONTACT_LOCAL);
    assert_true(o.overlaps > 10);
    assert_true(o.rebound < 9.0);
}

int main(int argc, char **argv)
{
    inputs = argc > 1 ? argv[1] : "inputs";
    if (argc > 2) {
        n_spacings = 1;
        spacings[0] = atof(argv[2]);
    }
    return test_run();
}
