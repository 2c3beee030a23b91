/* SPDX-License-Identifier: BSD-3-Clause */
/* Edges of the boundary are found from the triangles, not from the flags of contact: nodes that are held may not touch,
 * and yet the peak of a plate with lines of symmetry is at one of them. Without memory for an array that ranks have the
 * log goes without what is asked for. */
#include "whole_nodes.h"

#include <stddef.h>

#include "ask.h"
#include "lattice/lattice_source.h"

/* Items of n nodes or springs, which are left as they are without memory. */
static void pick(const dem_model *model, size_t member, const dem_index *list, dem_index n, void *out)
{
    const lattice_source from = dem_private_lattice_source(model);
    (void)dem_private_lattice_pick(&from, member, list, n, out);
}

/* \return NULL without memory */
static const void *open_array(source_array *a, const dem_model *model, size_t member)
{
    const lattice_source from = dem_private_lattice_source(model);
    return dem_private_lattice_open(a, &from, member) == DEM_OK ? a->items : NULL;
}

dem_index whole_nodes_body(const dem_model *model, dem_index node)
{
    int32_t body = 0;
    pick(model, offsetof(dem_lattice, body), &node, 1, &body);
    return body;
}

void whole_nodes_place(double x[2], const dem_model *model, dem_index node)
{
    x[0] = x[1] = 0.0;
    pick(model, offsetof(dem_lattice, x), &node, 1, x);
}

whole_spring whole_nodes_spring(const dem_model *model, dem_index spring)
{
    dem_index ends[2] = {0, 0};
    double x[4] = {0.0, 0.0, 0.0, 0.0};
    whole_spring s = {{0.0, 0.0}, 0.0};
    pick(model, offsetof(dem_lattice, ends), &spring, 1, ends);
    pick(model, offsetof(dem_lattice, x), ends, 2, x);
    pick(model, offsetof(dem_lattice, stiffness), &spring, 1, &s.stiffness);
    for (int c = 0; c < 2; c++) s.middle[c] = 0.5 * (x[c] + x[2 + c]);
    return s;
}

/* The other ends of the sides at a node, one for each triangle that has the side. \return their number */
static int find_ends(dem_index ends[WHOLE_NODES_SIDES], const dem_model *model, dem_index node)
{
    const dem_index n_triangles = dem_model_lattice(model)->n_triangles;
    source_array a;
    const dem_index *corners = open_array(&a, model, offsetof(dem_lattice, triangles));
    int n = 0;
    for (dem_index k = 0; k < 3 * n_triangles && corners != NULL; k++) {
        const dem_index *corner = corners + k / 3 * 3;
        if (corners[k] != node || n + 2 > WHOLE_NODES_SIDES) continue;
        ends[n++] = corner[(k + 1) % 3];
        ends[n++] = corner[(k + 2) % 3];
    }
    dem_private_lattice_close(&a);
    return n;
}

int whole_nodes_rim(double ends[WHOLE_NODES_SIDES][2], const dem_model *model, dem_index node)
{
    dem_index all[WHOLE_NODES_SIDES];
    const int n = find_ends(all, model, node);
    int found = 0;
    for (int k = 0; k < n; k++) {
        int shared = 0;
        for (int q = 0; q < n; q++) shared += all[q] == all[k];
        if (shared == 1) whole_nodes_place(ends[found++], model, all[k]);
    }
    return found;
}

bool whole_nodes_any_ahead(const dem_model *model, dem_index node, const double along[2], double slack)
{
    const dem_index n = dem_model_lattice(model)->n_nodes;
    source_array places, bodies;
    const double *x = open_array(&places, model, offsetof(dem_lattice, x));
    const int32_t *body = open_array(&bodies, model, offsetof(dem_lattice, body));
    bool found = false;
    for (dem_index i = 0; i < n && x != NULL && body != NULL && !found; i++)
        found = body[i] == body[node] &&
                (x[2 * i] - x[2 * node]) * along[0] + (x[2 * i + 1] - x[2 * node + 1]) * along[1] > slack;
    dem_private_lattice_close(&places);
    dem_private_lattice_close(&bodies);
    return found;
}

static double spin_of(const double *mass, dem_index n, const dem_state *state, const double v[2])
{
    double all = 0.0, centre[2] = {0.0, 0.0}, angular = 0.0, inertia = 0.0;
    for (dem_index i = 0; i < n; i++) {
        all += mass[i];
        for (int c = 0; c < 2; c++) centre[c] += mass[i] * state->x[2 * i + c];
    }
    for (dem_index i = 0; i < n; i++) {
        const double x = state->x[2 * i] - centre[0] / all, y = state->x[2 * i + 1] - centre[1] / all;
        angular += mass[i] * (x * (state->v[2 * i + 1] - v[1]) - y * (state->v[2 * i] - v[0]));
        inertia += mass[i] * (x * x + y * y);
    }
    return inertia > 0.0 ? angular / inertia : 0.0;
}

double whole_nodes_spin(const dem_simulation *simulation, const double v[2])
{
    const dem_model *model = dem_simulation_model(simulation);
    const dem_state state = ask_state(simulation);
    source_array a;
    const double *mass = open_array(&a, model, offsetof(dem_lattice, mass));
    const double spin = mass != NULL ? spin_of(mass, dem_model_lattice(model)->n_nodes, &state, v) : 0.0;
    dem_private_lattice_close(&a);
    return spin;
}
