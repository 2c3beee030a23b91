/* SPDX-License-Identifier: BSD-3-Clause */
#include "fracture_report.h"

#include "ask.h"

void fracture_report_note(fracture_report *r, const dem_break *what)
{
    if (r->breaks++ > 0) return;
    r->first_t = what->t;
    for (int d = 0; d < 2; d++) r->first_x[d] = what->x[d];
}

/* Where obstacles stand inside of bodies between their nodes. */
static void print_buried(FILE *out, const dem_fracture *broken)
{
    if (broken->buried == 0) return;
    (void)fprintf(
        out,
        "buried     nodes inside obstacles when they came to the surface, which they touch only once they are "
        "out: %lld; the first, node %lld, at %.4e s, (%g, %g) m\n",
        (long long)broken->buried, (long long)broken->buried_node, broken->buried_t, broken->buried_x[0],
        broken->buried_x[1]);
}

void fracture_report_print(FILE *out, const fracture_report *r, const dem_simulation *simulation)
{
    const dem_model_size size = ask_sizes(dem_simulation_model(simulation));
    const dem_fracture broken = ask_fracture(simulation);
    if (r->breaks == 0) return;
    (void)fprintf(out,
                  "fracture   %lld of %lld triangles and %lld of %lld springs are broken, which took %.4g J for %.4g m "
                  "of cracks; the first at %.4e s, (%g, %g) m\n",
                  (long long)broken.triangles, (long long)size.n_triangles, (long long)broken.springs,
                  (long long)size.n_springs, ask_energy(simulation).fracture, broken.crack_length, r->first_t,
                  r->first_x[0], r->first_x[1]);
    (void)fprintf(
        out, "fragments  %lld; the largest has %.3g of the mass, single nodes %.3g; half is in those up to %.4g kg\n",
        (long long)broken.fragments, broken.largest, broken.debris, broken.median);
    print_buried(out, &broken);
}
