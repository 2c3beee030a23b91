/* SPDX-License-Identifier: BSD-3-Clause */
/* Each fact is found of one node, or spring, after the other, in their order: of a lattice in pieces it is the same. */
#include "lattice_facts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const unsigned rigid_flags = DEM_NODE_RIGID | DEM_NODE_GUIDE_X | DEM_NODE_GUIDE_Y;

static dem_index body_of(const dem_lattice *l, dem_index node)
{
    return l->body != NULL ? l->body[node] : 0;
}

static unsigned flags_of(const dem_lattice *l, dem_index node)
{
    return l->flags != NULL ? l->flags[node] : 0;
}

static bool make_bodies(lattice_facts *f, dem_index n)
{
    if (n <= f->n_bodies) return true;
    lattice_body *more = realloc(f->bodies, (size_t)n * sizeof *more);
    if (more == NULL) return false;
    memset(more + f->n_bodies, 0, (size_t)(n - f->n_bodies) * sizeof *more);
    f->bodies = more;
    f->n_bodies = n;
    return true;
}

static bool is_in(dem_index node, dem_index first, dem_index n)
{
    return node >= first && node < first + n;
}

/* Nodes from `first` on, and springs that have one of them: others have not all of their triangles. */
static bool add(lattice_facts *f, const dem_lattice *l, dem_index first, dem_index n)
{
    f->may_break = l->strength != NULL || l->critical_stretch != NULL;
    f->may_soften = f->may_break && l->softening != NULL;
    for (dem_index k = 0; k < l->n_springs && l->viscosity != NULL; k++)
        if (is_in(l->ends[2 * k], first, n) || is_in(l->ends[2 * k + 1], first, n))
            f->damping_time = fmax(f->damping_time, l->viscosity[k] / l->stiffness[k]);
    for (dem_index i = first; i < first + n; i++) {
        if (!make_bodies(f, body_of(l, i) + 1)) return false;
        lattice_body *body = &f->bodies[body_of(l, i)];
        body->rigid |= flags_of(l, i) & rigid_flags;
        initial_motion_add(&body->motion, l, i);
        initial_motion_add(&f->motion, l, i);
    }
    return true;
}

bool lattice_facts_add(lattice_facts *facts, const dem_slab *slab)
{
    return add(facts, &slab->lattice, slab->first_own, slab->n_own);
}

void lattice_facts_find_box(lattice_facts *f, const dem_lattice *box)
{
    for (int c = 0; c < 2; c++) f->low[c] = (double)INFINITY, f->high[c] = -(double)INFINITY;
    for (dem_index k = 0; k < 2 * box->n_nodes; k++) {
        f->low[k % 2] = fmin(f->low[k % 2], box->x[k]);
        f->high[k % 2] = fmax(f->high[k % 2], box->x[k]);
    }
}

static double slowness_of(const dem_lattice *l, dem_index spring)
{
    const double mass = l->mass[l->ends[2 * spring]] + l->mass[l->ends[2 * spring + 1]];
    return sqrt(0.5 * mass / (l->stiffness[spring] * l->rest_length[spring]));
}

static void find_share(lattice_facts *f, const dem_lattice *l)
{
    double least = (double)INFINITY, sum = 0.0;
    for (dem_index k = 0; k < l->n_springs; k++) {
        const double slowness = slowness_of(l, k);
        least = fmin(least, slowness);
        sum += slowness;
    }
    f->share_of_fastest = l->n_springs > 0 ? least * (double)l->n_springs / sum : 1.0;
}

bool lattice_facts_find(lattice_facts *out, const dem_lattice *lattice)
{
    *out = (lattice_facts){0};
    lattice_facts_find_box(out, lattice);
    find_share(out, lattice);
    return add(out, lattice, 0, lattice->n_nodes);
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
