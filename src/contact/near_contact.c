/* SPDX-License-Identifier: BSD-3-Clause */
/* A node is near if it may come to an obstacle within the time that is looked ahead, at the speed of the fastest node,
 * or if it is beside such a node. */
#include "contact/near_contact.h"

#include <math.h>
#include <stdlib.h>

#include "base/status.h"
#include "contact/surface_feature.h"
#include "model/breakable_nodes.h"
#include "model/whole_lattice.h"

enum { NOW = 1, AHEAD = 2 }; /* bits of a node */

/* Windows that are looked ahead at first; work for which it pays to make parts anew, over what that takes; by how much
 * looks reach farther at once, at least and at most; speeds and edges may become larger. */
static const double first_windows = 1.0, worth_it = 20.0, least_growth = 2.0, most_growth = 8.0, safety = 1.25;

/* Without checkpoints ranks cannot go back, and `exact` needs the neighbours of all contacts. Where something
 * breaks other nodes may touch. */
static bool is_worth_asking(const dem_model *whole, const dem_options *o)
{
    return whole->obstacles.n > 0 && o->contact == DEM_CONTACT_LOCAL && o->checkpoint_steps > 0 &&
           !breakable_lattice(&whole->lattice);
}

dem_status near_contact_create(near_contact *out, const dem_model *whole, const dem_options *options)
{
    const size_t n = (size_t)whole->lattice.n_nodes;
    *out = (near_contact){0};
    if (!is_worth_asking(whole, options)) return DEM_OK;
    *out = (near_contact){.model = whole,
                          .touching = options->bodies != DEM_BODIES_NONE,
                          .window = (double)options->checkpoint_steps * options->max_step,
                          .n_windows = first_windows,
                          .has_all = true,
                          .is_near = calloc(n, 1),
                          .ahead = calloc(n, 1)};
    CHECK(out->is_near != NULL && out->ahead != NULL, DEM_ERROR_MEMORY, "out of memory for what may touch soon");
    return DEM_OK;
}

void near_contact_free(near_contact *n)
{
    free(n->is_near);
    free(n->ahead);
    *n = (near_contact){0};
}

/* ---- a look ---- */

static double fastest(const surface *s, const double *v)
{
    double square = 0.0;
    for (dem_index k = 0; k < s->n_nodes; k++) {
        const vec2 at = vec2_at(v, s->nodes[k]);
        square = fmax(square, vec2_dot(at, at));
    }
    return sqrt(square);
}

/* The longest edge of the surface, or the spacing if that is longer, m. */
static double longest_edge(const dem_model *m, const double *x)
{
    double longest = m->spacing;
    for (dem_index e = 0; e < m->surface.n_edges; e++) {
        const dem_index *ends = &m->surface.ends[2 * e];
        longest = fmax(longest, vec2_norm(vec2_sub(vec2_at(x, ends[1]), vec2_at(x, ends[0]))));
    }
    return longest;
}

/* Distance of a point to the nearest obstacle, in front of it or behind, m. */
static double distance_to(const contact_scene *scene, surface_query at)
{
    double nearest = INFINITY;
    for (dem_index k = 0; k < scene->model->obstacles.n; k++)
        nearest = fmin(nearest, fabs(surface_gap_of(scene, at, k).distance));
    return nearest;
}

/* \param reach  m, of NOW and of AHEAD */
static void look_at_obstacles(near_contact *n, const near_contact_state *state, const double reach[2])
{
    const contact_scene scene = {.model = n->model};
    const surface *s = &n->model->surface;
    for (dem_index k = 0; k < s->n_nodes; k++) {
        const dem_index i = s->nodes[k];
        const double distance = distance_to(&scene, (surface_query){state->t, vec2_at(state->x, i)});
        n->ahead[i] = (unsigned char)((distance <= reach[0] ? NOW : 0) | (distance <= reach[1] ? AHEAD : 0));
    }
}

/* How far from what may touch events concern nodes: the edges beside it have further nodes, and where bodies touch each
 * other rings may go over to another one, whose nodes are then no farther from the obstacle than as many edges. */
static double concerned(const near_contact *n, double edge)
{
    enum { BESIDE = 2 };
    return edge * (n->touching ? 2 * BESIDE + whole_lattice_rings(&n->model->lattice) : BESIDE);
}

void near_contact_look(near_contact *n, const near_contact_state *state)
{
    if (n->model == NULL) return;
    const dem_model *m = n->model;
    const double beside = concerned(n, safety * longest_edge(m, state->x));
    const double way = safety * n->window * (fastest(&m->surface, state->v) + m->obstacles.bounds.speed);
    look_at_obstacles(n, state, (double[]){beside + way, beside + n->n_windows * way});
    n->n_ahead = 0;
    for (dem_index k = 0; k < m->surface.n_nodes; k++) n->n_ahead += n->ahead[m->surface.nodes[k]] != 0;
}

/* ---- what follows from it ---- */

static bool is_missing_some(const near_contact *n)
{
    const surface *s = &n->model->surface;
    for (dem_index k = 0; k < s->n_nodes; k++)
        if (n->ahead[s->nodes[k]] & NOW && !n->is_near[s->nodes[k]]) return true;
    return false;
}

bool near_contact_is_outdated(const near_contact *n, double worked, double price)
{
    if (n->model == NULL) return false;
    return n->has_all || is_missing_some(n) || (2 * n->n_ahead < n->n_near && worked > worth_it * price);
}

void near_contact_take(near_contact *n, double worked, double price)
{
    unsigned char *const before = n->is_near;
    if (!n->has_all && worked < worth_it * price)
        n->n_windows *= fmin(most_growth, fmax(least_growth, worth_it * price / worked));
    n->is_near = n->ahead;
    n->ahead = before;
    n->n_near = n->n_ahead;
    n->has_all = false;
}

void near_contact_take_all(near_contact *n)
{
    n->has_all = true;
    n->n_windows *= least_growth;
}
