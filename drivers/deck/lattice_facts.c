/* SPDX-License-Identifier: BSD-3-Clause */
/* Each fact is found of one node, or spring, after the other, in their order: of a lattice in pieces it is the same. */
#include "lattice_facts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/grow.h"
#include "slab_nodes.h"

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

/* ---- how fast springs are ---- */

static double mass_of(const dem_slab *slab, dem_index i)
{
    return slab_nodes_own(slab, i) ? slab->lattice.mass[i] : 0.0;
}

static void add_slowness(lattice_facts *f, const lattice_spring *s)
{
    const double slowness = sqrt(0.5 * (s->mass[0] + s->mass[1]) / s->scale);
    f->least_slowness = f->n_springs > 0 ? fmin(f->least_slowness, slowness) : slowness;
    f->sum_of_slowness += slowness;
    f->n_springs++;
}

/* Masses of a rim are not those of the whole, but slabs to come have the nodes above this one as their own. */
static void add_waiting(lattice_facts *f, const dem_slab *slab)
{
    dem_index n = 0;
    for (dem_index k = 0; k < f->n_waiting; k++) {
        lattice_spring *s = &f->waiting[k];
        if (s->upper < slab->first_node || s->upper >= slab->first_node + slab->n_own) continue;
        s->mass[1] = mass_of(slab, slab->first_own + s->upper - slab->first_node);
        s->upper = -1;
    }
    while (n < f->n_waiting && f->waiting[n].upper < 0) add_slowness(f, &f->waiting[n++]);
    f->n_waiting -= n;
    if (n > 0) memmove(f->waiting, f->waiting + n, (size_t)f->n_waiting * sizeof *f->waiting);
}

/* In their order: behind one that waits all wait. */
static bool add_spring(lattice_facts *f, const dem_slab *slab, dem_index k)
{
    const dem_lattice *l = &slab->lattice;
    const dem_index a = l->ends[2 * k], b = l->ends[2 * k + 1], lower = a < b ? a : b, upper = a < b ? b : a;
    const bool is_whole = slab_nodes_own(slab, upper);
    const lattice_spring s = {.mass = {mass_of(slab, lower), mass_of(slab, upper)},
                              .scale = l->stiffness[k] * l->rest_length[k],
                              .upper = is_whole ? -1 : slab_nodes_number(slab, upper)};
    if (!slab_nodes_own(slab, lower)) return true;
    if (is_whole && f->n_waiting == 0) {
        add_slowness(f, &s);
        return true;
    }
    if (!grow_array((void **)&f->waiting, &f->room, f->n_waiting + 1, sizeof s)) return false;
    f->waiting[f->n_waiting++] = s;
    return true;
}

/* ---- nodes and springs ---- */

/* Springs without an own node have not all of their triangles. */
static void note_damping(lattice_facts *f, const dem_slab *slab)
{
    const dem_lattice *l = &slab->lattice;
    for (dem_index k = 0; k < l->n_springs && l->viscosity != NULL; k++)
        if (slab_nodes_own(slab, l->ends[2 * k]) || slab_nodes_own(slab, l->ends[2 * k + 1]))
            f->damping_time = fmax(f->damping_time, l->viscosity[k] / l->stiffness[k]);
}

static bool add_node(lattice_facts *f, const dem_lattice *l, dem_index i)
{
    if (!make_bodies(f, body_of(l, i) + 1)) return false;
    lattice_body *body = &f->bodies[body_of(l, i)];
    body->rigid |= flags_of(l, i) & rigid_flags;
    initial_motion_add(&body->motion, l, i);
    initial_motion_add(&f->motion, l, i);
    return true;
}

bool lattice_facts_add(lattice_facts *f, const dem_slab *slab)
{
    const dem_lattice *l = &slab->lattice;
    bool good = true;
    f->may_break = l->strength != NULL || l->critical_stretch != NULL;
    f->may_soften = f->may_break && l->softening != NULL;
    note_damping(f, slab);
    for (dem_index i = 0; i < slab->n_own && good; i++) good = add_node(f, l, slab->first_own + i);
    add_waiting(f, slab);
    for (dem_index k = 0; k < l->n_springs && good; k++) good = add_spring(f, slab, k);
    f->share_of_fastest = f->n_springs > 0 ? f->least_slowness * (double)f->n_springs / f->sum_of_slowness : 1.0;
    return good;
}

void lattice_facts_find_box(lattice_facts *f, const dem_lattice *box)
{
    for (int c = 0; c < 2; c++) f->low[c] = (double)INFINITY, f->high[c] = -(double)INFINITY;
    for (dem_index k = 0; k < 2 * box->n_nodes; k++) {
        f->low[k % 2] = fmin(f->low[k % 2], box->x[k]);
        f->high[k % 2] = fmax(f->high[k % 2], box->x[k]);
    }
}

bool lattice_facts_find(lattice_facts *out, const dem_lattice *lattice)
{
    dem_slab all = dem_slab_empty();
    all.n_own = lattice->n_nodes;
    all.lattice = *lattice;
    *out = (lattice_facts){0};
    lattice_facts_find_box(out, lattice);
    return lattice_facts_add(out, &all);
}

void lattice_facts_free(lattice_facts *facts)
{
    free(facts->bodies);
    free(facts->waiting);
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
