/* SPDX-License-Identifier: BSD-3-Clause */
/* Couplings between the springs of a triangle. With s_k the stretch of edge k, its length less its rest length, the
 * energy of a triangle is
 *     W = sum over the pairs of edges k, l of k_kl s_k s_l,
 * and the tension that it gives to edge k is dW/ds_k = sum of k_kl s_l. It acts along the edge as it is now, so that
 * momentum and angular momentum are kept at any deformation. The springs' own energies are in springs.c; with them the
 * energy of a triangle is positive (docs/method.md, Coupled springs). Forces are gathered node by node in the order of
 * rows; the sweep of sweep_body.h has the same bits. The couplings themselves come from lattice/assemble.c. */
#include "elastic/couplings.h"

#include <stdlib.h>

#include "base/status.h"
#include "elastic/rigid_nodes.h"

/* ---- forces ---- */

vec2 couplings_add_force(const couplings *c, triangles_integrity integrity, dem_index i, const double *x, vec2 force)
{
    for (dem_index p = c->row[i]; p < c->row[i + 1]; p++) {
        const dem_index k = c->slot[p] / 3;
        if (couplings_broken(c, integrity, k)) continue;
        const coupled_edges e = couplings_edges(&c->list[k], x);
        force = vec2_add(force, couplings_force_at(&e, couplings_left(c, integrity, k), (int)(c->slot[p] % 3)));
    }
    return force;
}

void couplings_virial_of(const coupled_triangle *t, const double *x, double virial[3])
{
    const coupled_edges e = couplings_edges(t, x);
    virial[0] = virial[1] = virial[2] = 0.0;
    for (int k = 0; k < 3; k++) {
        const double pull = e.tension[k] / e.length[k]; /* N/m */
        virial[0] += pull * e.edge[k].x * e.edge[k].x;
        virial[1] += pull * e.edge[k].y * e.edge[k].y;
        virial[2] += pull * e.edge[k].x * e.edge[k].y;
    }
}

void couplings_virial(const couplings *c, dem_index p, const double *x, double virial[3])
{
    couplings_virial_of(&c->list[c->slot[p] / 3], x, virial);
}

/* With n the direction of an edge, T its tension and w the difference of u along it, the stretch changes by n.w, and
 * the force T n by
 *     dT n + T/|d| (w - (n.w) n),   dT = sum of k_kl n_l.w_l. */
vec2 couplings_tangent(const couplings *c, dem_index i, const double *x, const double *u)
{
    vec2 out = {0.0, 0.0};
    for (dem_index p = c->row[i]; p < c->row[i + 1]; p++) {
        const coupled_triangle *t = &c->list[c->slot[p] / 3];
        const coupled_edges e = couplings_edges(t, x);
        const int q = (int)(c->slot[p] % 3);
        vec2 w[3];
        double change[3]; /* of the stretches */
        for (int k = 0; k < 3; k++) {
            w[k] = vec2_sub(vec2_at(u, t->corner[(k + 1) % 3]), vec2_at(u, t->corner[k]));
            change[k] = vec2_dot(e.edge[k], w[k]) / e.length[k];
        }
        for (int end = 0; end < 2; end++) {
            const int k = (q + 2 * end) % 3, next = (k + 1) % 3, last = (k + 2) % 3;
            const double sign = end == 0 ? -1.0 : 1.0, pull = e.tension[k] / e.length[k];
            const double steeper = t->coupling[k] * change[last] + t->coupling[next] * change[next];
            out = vec2_along(out, sign * pull, w[k]);
            out = vec2_along(out, sign * (steeper - pull * change[k]) / e.length[k], e.edge[k]);
        }
    }
    return out;
}

/* ---- energies ---- */

static double energy(const coupled_triangle *t, const double *x)
{
    const coupled_edges e = couplings_edges(t, x);
    double sum = 0.0;
    for (int q = 0; q < 3; q++) sum += couplings_energy_term(t, &e, q);
    return sum;
}

/* Every triangle at the node counts in full, as in springs_node_energy(). */
double couplings_node_energy(const couplings *c, triangles_integrity integrity, dem_index i, const double *x)
{
    double sum = 0.0;
    for (dem_index p = c->row[i]; p < c->row[i + 1]; p++)
        if (!couplings_broken(c, integrity, c->slot[p] / 3))
            sum += couplings_left(c, integrity, c->slot[p] / 3) * energy(&c->list[c->slot[p] / 3], x);
    return sum;
}

void couplings_add_tensions(const couplings *c, triangles_integrity integrity, const double *x, double *force)
{
    for (dem_index k = 0; k < c->n; k++) {
        if (couplings_broken(c, integrity, k)) continue;
        const coupled_edges e = couplings_edges(&c->list[k], x);
        for (int q = 0; q < 3; q++) force[c->list[k].spring[q]] += couplings_left(c, integrity, k) * e.tension[q];
    }
}

/* The triangles at a node stand in the order of the list, so that the sum has the bits of that over all triangles. */
double couplings_add_tension(const couplings *c, triangles_integrity integrity, dem_index i, dem_index spring,
                             const double *x, double tension)
{
    for (dem_index p = c->row[i]; p < c->row[i + 1]; p++) {
        const dem_index k = c->slot[p] / 3;
        if (couplings_broken(c, integrity, k)) continue;
        const coupled_edges e = couplings_edges(&c->list[k], x);
        for (int q = 0; q < 3; q++)
            if (c->list[k].spring[q] == spring) tension += couplings_left(c, integrity, k) * e.tension[q];
    }
    return tension;
}

/* ---- compilation ---- */

static bool is_coupled(const dem_lattice *lattice, dem_index k)
{
    return triangles_are_coupled(lattice->coupling, k) && !rigid_nodes_have(lattice, lattice->triangles[3 * k]);
}

static dem_status allocate(couplings *c)
{
    c->list = malloc((size_t)(c->n + 1) * sizeof *c->list);
    c->row = calloc((size_t)c->n_nodes + 2, sizeof *c->row);
    c->slot = malloc((size_t)(3 * c->n + 1) * sizeof *c->slot);
    CHECK(c->list && c->row && c->slot, DEM_ERROR_MEMORY, "out of memory for %lld triangles", (long long)c->n);
    return DEM_OK;
}

static dem_status fill(coupled_triangle *t, const dem_lattice *lattice, const springs *s, dem_index k)
{
    t->triangle = k;
    for (int c = 0; c < 3; c++) {
        const dem_index i = lattice->triangles[3 * k + c], j = lattice->triangles[3 * k + (c + 1) % 3];
        const dem_index spring = springs_between(s, i, j);
        CHECK(spring >= 0, DEM_ERROR_MODEL, "triangle %lld has a coupling, but its nodes %lld and %lld no spring",
              (long long)k, (long long)i, (long long)j);
        t->corner[c] = i;
        t->spring[c] = spring;
        t->rest_length[c] = lattice->rest_length[spring];
        t->coupling[c] = lattice->coupling[3 * k + c];
    }
    return DEM_OK;
}

/* row[i + 2] counts the slots of node i first; summed up, row[i + 1] is where the next one of node i goes, and in the
 * end where its row ends. */
static void lay_rows(couplings *c)
{
    for (dem_index k = 0; k < 3 * c->n; k++) c->row[c->list[k / 3].corner[k % 3] + 2]++;
    for (dem_index i = 0; i < c->n_nodes; i++) c->row[i + 2] += c->row[i + 1];
    for (dem_index k = 0; k < 3 * c->n; k++) c->slot[c->row[c->list[k / 3].corner[k % 3] + 1]++] = (int32_t)k;
}

dem_status couplings_compile(couplings *out, const dem_lattice *lattice, const springs *s)
{
    couplings c = {.n_nodes = lattice->n_nodes};
    for (dem_index k = 0; k < lattice->n_triangles; k++) c.n += is_coupled(lattice, k);
    dem_status status = allocate(&c);
    for (dem_index k = 0, q = 0; k < lattice->n_triangles && status == DEM_OK; k++)
        if (is_coupled(lattice, k)) status = fill(&c.list[q++], lattice, s, k);
    if (status != DEM_OK) {
        couplings_free(&c);
        return status;
    }
    lay_rows(&c);
    *out = c;
    return DEM_OK;
}

void couplings_free(couplings *c)
{
    free(c->list);
    free(c->row);
    free(c->slot);
    *c = (couplings){0};
}
