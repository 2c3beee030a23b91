/* SPDX-License-Identifier: BSD-3-Clause */
/* Edges of the boundary are found from the triangles, not from the flags of contact: nodes that are held may not touch,
 * and yet the peak of a plate with lines of symmetry is at one of them. */
#include "whole_nodes.h"

#include "ask.h"

dem_index whole_nodes_body(const dem_model *model, dem_index node)
{
    return dem_model_lattice(model)->body[node];
}

void whole_nodes_place(double x[2], const dem_model *model, dem_index node)
{
    const double *places = dem_model_lattice(model)->x;
    for (int c = 0; c < 2; c++) x[c] = places[2 * node + c];
}

whole_spring whole_nodes_spring(const dem_model *model, dem_index spring)
{
    const dem_lattice *l = dem_model_lattice(model);
    const double *a = l->x + 2 * l->ends[2 * spring], *b = l->x + 2 * l->ends[2 * spring + 1];
    return (whole_spring){{0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])}, l->stiffness[spring]};
}

/* The other ends of the sides at a node, one for each triangle that has the side. \return their number */
static int find_ends(dem_index ends[WHOLE_NODES_SIDES], const dem_lattice *l, dem_index node)
{
    int n = 0;
    for (dem_index t = 0; t < l->n_triangles; t++)
        for (int k = 0; k < 3; k++) {
            const dem_index *corner = l->triangles + 3 * t;
            if (corner[k] != node || n + 2 > WHOLE_NODES_SIDES) continue;
            ends[n++] = corner[(k + 1) % 3];
            ends[n++] = corner[(k + 2) % 3];
        }
    return n;
}

int whole_nodes_rim(double ends[WHOLE_NODES_SIDES][2], const dem_model *model, dem_index node)
{
    dem_index all[WHOLE_NODES_SIDES];
    const int n = find_ends(all, dem_model_lattice(model), node);
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
    const dem_lattice *l = dem_model_lattice(model);
    const double *x = l->x + 2 * node;
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const double *y = l->x + 2 * i;
        if (l->body[i] == l->body[node] && (y[0] - x[0]) * along[0] + (y[1] - x[1]) * along[1] > slack) return true;
    }
    return false;
}

double whole_nodes_spin(const dem_simulation *simulation, const double v[2])
{
    const dem_lattice *l = dem_model_lattice(dem_simulation_model(simulation));
    const dem_state state = ask_state(simulation);
    double mass = 0.0, centre[2] = {0.0, 0.0}, angular = 0.0, inertia = 0.0;
    for (dem_index i = 0; i < l->n_nodes; i++) {
        mass += l->mass[i];
        for (int c = 0; c < 2; c++) centre[c] += l->mass[i] * state.x[2 * i + c];
    }
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const double x = state.x[2 * i] - centre[0] / mass, y = state.x[2 * i + 1] - centre[1] / mass;
        angular += l->mass[i] * (x * (state.v[2 * i + 1] - v[1]) - y * (state.v[2 * i] - v[0]));
        inertia += l->mass[i] * (x * x + y * y);
    }
    return inertia > 0.0 ? angular / inertia : 0.0;
}
