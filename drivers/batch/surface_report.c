/* SPDX-License-Identifier: BSD-3-Clause */
#include "surface_report.h"

#include <math.h>

#include "ask.h"

void surface_report_print(FILE *out, const dem_simulation *simulation)
{
    const dem_options o = ask_options(simulation);
    const dem_surfaces s = ask_surfaces(simulation);
    if (o.bodies == DEM_BODIES_NONE) return;
    (void)fprintf(out, "surfaces   %s push each other off: %lld boundary edges, thickness %.4g m",
                  o.bodies == DEM_BODIES_ALL ? "all" : "those of different bodies", (long long)s.n_edges,
                  s.thickness_min);
    if (s.thickness_max > 1.001 * s.thickness_min) (void)fprintf(out, " to %.4g m", s.thickness_max);
    (void)fprintf(out, "; %lld pairs push at the start\n", (long long)s.pushing);
}

void surface_report_follow(surface_report *p, const dem_simulation *simulation, double t)
{
    const dem_surfaces s = ask_surfaces(simulation);
    if (s.pushing == 0) return;
    if (p->most == 0) p->first_t = t;
    if (p->most == 0 || s.gap_share < p->nearest) {
        p->nearest = s.gap_share;
        p->nearest_t = t;
    }
    if (s.pushing > p->most) p->most = s.pushing;
    p->energy = fmax(p->energy, ask_energy(simulation).contact);
}

void surface_report_print_nearest(FILE *out, const surface_report *p)
{
    if (p->most == 0) return;
    (void)fprintf(
        out,
        "surfaces   first push at %.4e s; nearest %.3g of the thickness at %.4e s, %lld pairs at most, energy "
        "up to %.4g J\n",
        p->first_t, p->nearest, p->nearest_t, (long long)p->most, p->energy);
}
