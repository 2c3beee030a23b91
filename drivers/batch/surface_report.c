/* SPDX-License-Identifier: BSD-3-Clause */
#include "surface_report.h"

#include <math.h>

#include "ask.h"

/* Over the contact thickness: the potential bears it, but the pressure is 18 times the modulus, and no lattice is still
 * a solid under that. */
static const double too_near = 0.05;

static const char *plural(dem_index n)
{
    return n == 1 ? "" : "s";
}

void surface_report_print(FILE *out, const dem_simulation *simulation)
{
    const dem_options o = ask_options(simulation);
    const dem_surfaces s = ask_surfaces(simulation);
    if (o.bodies == DEM_BODIES_NONE) return;
    (void)fprintf(out, "surfaces   %s push each other off: %lld boundary edges, thickness %.4g m",
                  o.bodies == DEM_BODIES_ALL ? "all" : "those of different bodies", (long long)s.n_edges,
                  s.thickness_min);
    if (s.thickness_max > 1.001 * s.thickness_min) (void)fprintf(out, " to %.4g m", s.thickness_max);
    (void)fprintf(out, ", modulus %.4g N/m", s.modulus_min);
    if (s.modulus_max > 1.001 * s.modulus_min) (void)fprintf(out, " to %.4g N/m", s.modulus_max);
    if (s.friction_max > 0.0) (void)fprintf(out, ", friction %.4g", s.friction_min);
    if (s.friction_max > s.friction_min) (void)fprintf(out, " to %.4g", s.friction_max);
    (void)fprintf(out, "; %lld pair%s at the start", (long long)s.pushing, s.pushing == 1 ? " pushes" : "s push");
    if (s.left_out > 0)
        (void)fprintf(out, "; %lld pair%s never, nearer than the thickness at rest", (long long)s.left_out,
                      plural(s.left_out));
    (void)fprintf(out, "\n");
}

/* The pair that is nearest in units of its thickness. */
static dem_pair find_nearest(const dem_simulation *simulation, dem_index n)
{
    dem_pair nearest = ask_pair(simulation, 0);
    for (dem_index k = 1; k < n; k++) {
        const dem_pair p = ask_pair(simulation, k);
        if (p.gap * nearest.thickness < nearest.gap * p.thickness) nearest = p;
    }
    return nearest;
}

static surface_report_warning warning_of(const dem_simulation *simulation, const dem_surfaces *s, double t)
{
    const dem_pair p = find_nearest(simulation, s->pushing);
    return (surface_report_warning){true, p.node, p.body, {p.x[0], p.x[1]}, t, s->gap_share};
}

bool surface_report_follow(surface_report *p, const dem_simulation *simulation, double t)
{
    const dem_surfaces s = ask_surfaces(simulation);
    if (s.pushing == 0) return false;
    const bool first = p->most == 0;
    if (first) p->first_t = t;
    if (first || s.gap_share < p->nearest) {
        p->nearest = s.gap_share;
        p->pressure = s.pressure_share;
        p->nearest_t = t;
    }
    if (first || s.gap_min < p->gap) {
        p->gap = s.gap_min;
        p->gap_t = t;
    }
    if (s.pushing > p->most) p->most = s.pushing;
    if (p->warning.given || !(s.gap_share < too_near)) return false;
    p->warning = warning_of(simulation, &s, t);
    return true;
}

void surface_report_look(surface_report *p, const dem_simulation *simulation)
{
    if (ask_surfaces(simulation).pushing > 0) p->energy = fmax(p->energy, ask_energy(simulation).contact);
}

void surface_report_warn(const surface_report *p, run_log *log)
{
    const surface_report_warning *w = &p->warning;
    run_log_warn(log,
                 "surfaces are only %.2g of the contact thickness apart at node %lld of body %lld, (%g, %g) m, %.4e s: "
                 "they are pressed together harder than a lattice bears",
                 w->share, (long long)w->node, (long long)w->body, w->x[0], w->x[1], w->t);
}

void surface_report_print_nearest(FILE *out, const surface_report *p)
{
    if (p->most == 0) return;
    (void)fprintf(
        out,
        "surfaces   first push at %.4e s; nearest %.3g of the thickness at %.4e s, pressure there %.3g of the modulus, "
        "%lld pair%s at most, energy up to %.4g J\n",
        p->first_t, p->nearest, p->nearest_t, p->pressure, (long long)p->most, plural(p->most), p->energy);
}
