/* SPDX-License-Identifier: BSD-3-Clause */
/* The search for contact pairs, and their evaluation: stars of 100 edges on a grid, so near that some touch.
 * `bench_surface EDGES` */
#include <string.h>

#include "../unit/surface_contact/curves.h"
#include "bench.h"
#include "surface_contact/surface_contact.h"

enum { corners = 100, turns = 10 };

int main(int argc, char **argv)
{
    must(argc == 2, "usage: bench_surface EDGES");
    const dem_index n_bodies = (dem_index)(atof(argv[1]) / corners);
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    dem_lattice l = curves_make(rng, n_bodies, corners, 2.35);
    surface_contact *c;
    ask(surface_contact_create(&c, &l, &(surface_contact_rule){.within_bodies = true, .stiffness = 1.0}));
    double spent[3] = {0.0};
    for (int turn = 0; turn < turns; turn++) {
        double at[4];
        surface_contact_forget(c);
        at[0] = seconds(CLOCK_PROCESS_CPUTIME_ID);
        ask(surface_contact_follow(c, l.x));
        at[1] = seconds(CLOCK_PROCESS_CPUTIME_ID);
        ask(surface_contact_follow(c, l.x));
        at[2] = seconds(CLOCK_PROCESS_CPUTIME_ID);
        must(surface_contact_evaluate(c, l.x), "the evaluation failed");
        at[3] = seconds(CLOCK_PROCESS_CPUTIME_ID);
        for (int k = 0; k < 3; k++)
            if (turn == 0 || at[k + 1] - at[k] < spent[k]) spent[k] = at[k + 1] - at[k];
    }
    const double n = (double)c->surface.surface.n_edges;
    (void)printf(
        "%.0f edges, %lld candidates, %lld close pairs, %lld nodes in them: lists %.1f ms, %.0f ns an edge; moved "
        "check %.2f ns a node; evaluation with it %.2f ns a node\n",
        n, (long long)c->candidates.pairs.n, (long long)c->close.n, (long long)c->compact.n_nodes, 1e3 * spent[0],
        1e9 * spent[0] / n, 1e9 * spent[1] / n, 1e9 * spent[2] / n);
    surface_contact_destroy(c);
    dem_lattice_free(&l);
    gsl_rng_free(rng);
    return 0;
}
