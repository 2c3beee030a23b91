/* SPDX-License-Identifier: BSD-3-Clause */
#include "fracture_report.h"

#include <math.h>

#include "ask.h"

/* ---- under which load ---- */

/* Of equal ones the first stays. */
static void keep_larger(fracture_report_load *largest, const double *force, dem_index boundary, dem_index obstacle)
{
    if (!(hypot(force[0], force[1]) > hypot(largest->force[0], largest->force[1]))) return;
    *largest = (fracture_report_load){{force[0], force[1]}, boundary, obstacle};
}

/* The state at a break is that after it: the load of the step before is the last that all had to carry. */
void fracture_report_follow(fracture_report *r, const dem_simulation *simulation)
{
    if (r->breaks > 0) return;
    const dem_index n_boundaries = ask_options(simulation).n_boundaries;
    const dem_index n_obstacles = ask_sizes(dem_simulation_model(simulation)).n_obstacles;
    r->load = (fracture_report_load){0};
    for (dem_index k = 0; k < n_boundaries; k++) keep_larger(&r->load, ask_boundary(simulation, k).force, k + 1, 0);
    for (dem_index k = 0; k < n_obstacles; k++) keep_larger(&r->load, ask_obstacle(simulation, k).reaction, 0, k + 1);
}

/* ---- what has broken ---- */

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

/* Numbered from 1, as decks are. */
static void print_load(FILE *out, const fracture_report_load *load)
{
    const bool held = load->boundary > 0;
    if (!held && load->obstacle == 0) return;
    (void)fprintf(out, ", under (%.6g, %.6g) N of %s %lld", load->force[0], load->force[1],
                  held ? "boundary" : "obstacle", (long long)(held ? load->boundary : load->obstacle));
}

/* What was taken over what cracks of this length take. */
static void print_share(FILE *out, double taken, double crack_energy)
{
    if (crack_energy > 0.0) (void)fprintf(out, ", %.3g of their fracture energy", taken / crack_energy);
}

void fracture_report_print(FILE *out, const fracture_report *r, const dem_simulation *simulation)
{
    const dem_model_size size = ask_sizes(dem_simulation_model(simulation));
    const dem_fracture broken = ask_fracture(simulation);
    const double taken = ask_energy(simulation).fracture;
    if (r->breaks == 0) return;
    (void)fprintf(out,
                  "fracture   %lld of %lld triangles and %lld of %lld springs are broken, which took %.4g J for %.4g m "
                  "of cracks",
                  (long long)broken.triangles, (long long)size.n_triangles, (long long)broken.springs,
                  (long long)size.n_springs, taken, broken.crack_length);
    print_share(out, taken, ask_crack_energy(simulation));
    (void)fprintf(out, "; the first at %.4e s, (%g, %g) m", r->first_t, r->first_x[0], r->first_x[1]);
    print_load(out, &r->load);
    (void)fprintf(
        out, "\nfragments  %lld; the largest has %.3g of the mass, single nodes %.3g; half is in those up to %.4g kg\n",
        (long long)broken.fragments, broken.largest, broken.debris, broken.median);
    print_buried(out, &broken);
}
