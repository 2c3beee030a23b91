/* SPDX-License-Identifier: BSD-3-Clause */
/* Each fact is found of one node, or spring, after the other, in their order: of a lattice in pieces it is the same. */
#include "lattice_facts.h"

#include <math.h>
#include <stdlib.h>

static const unsigned rigid_flags = DEM_NODE_RIGID | DEM_NODE_GUIDE_X | DEM_NODE_GUIDE_Y;

static dem_index body_of(const dem_lattice *l, dem_index node)
{
    return l->body != NULL ? l->body[node] : 0;
}

static unsigned flags_of(const dem_lattice *l, dem_index node)
{
    return l->flags != NULL ? l->flags[node] : 0;
}

static bool find_bodies(lattice_facts *f, const dem_lattice *l)
{
    for (dem_index i = 0; i < l->n_nodes; i++)
        if (body_of(l, i) >= f->n_bodies) f->n_bodies = body_of(l, i) + 1;
    f->bodies = calloc((size_t)f->n_bodies + 1, sizeof *f->bodies);
    for (dem_index i = 0; i < l->n_nodes && f->bodies != NULL; i++) {
        lattice_body *body = &f->bodies[body_of(l, i)];
        body->rigid |= flags_of(l, i) & rigid_flags;
        initial_motion_add(&body->motion, l, i);
        initial_motion_add(&f->motion, l, i);
    }
    return f->bodies != NULL;
}

static void find_box(lattice_facts *f, const dem_lattice *l)
{
    for (int c = 0; c < 2; c++) f->low[c] = (double)INFINITY, f->high[c] = -(double)INFINITY;
    for (dem_index k = 0; k < 2 * l->n_nodes; k++) {
        f->low[k % 2] = fmin(f->low[k % 2], l->x[k]);
        f->high[k % 2] = fmax(f->high[k % 2], l->x[k]);
    }
}

static double slowness_of(const dem_lattice *l, dem_index spring)
{
    const double mass = l->mass[l->ends[2 * spring]] + l->mass[l->ends[2 * spring + 1]];
    return sqrt(0.5 * mass / (l->stiffness[spring] * l->rest_length[spring]));
}

static void find_springs(lattice_facts *f, const dem_lattice *l)
{
    double least = (double)INFINITY, sum = 0.0;
    for (dem_index k = 0; k < l->n_springs; k++) {
        if (l->viscosity != NULL) f->damping_time = fmax(f->damping_time, l->viscosity[k] / l->stiffness[k]);
        const double slowness = slowness_of(l, k);
        least = fmin(least, slowness);
        sum += slowness;
    }
    f->share_of_fastest = l->n_springs > 0 ? least * (double)l->n_springs / sum : 1.0;
}

bool lattice_facts_find(lattice_facts *out, const dem_lattice *lattice)
{
    *out = (lattice_facts){0};
    out->may_break = lattice->strength != NULL || lattice->critical_stretch != NULL;
    out->may_soften = out->may_break && lattice->softening != NULL;
    find_box(out, lattice);
    find_springs(out, lattice);
    return find_bodies(out, lattice);
}

void lattice_facts_free(lattice_facts *facts)
{
    free(facts->bodies);
    *facts = (lattice_facts){0};
}

double lattice_facts_diagonal(const lattice_facts *facts)
{
    return hypot(facts->high[0] - facts->low[0], facts->high[1] - facts->low[1]);
}

bool lattice_facts_any_rigid(const lattice_facts *facts)
{
    for (dem_index b = 0; b < facts->n_bodies; b++)
        if (facts->bodies[b].rigid != 0) return true;
    return false;
}
