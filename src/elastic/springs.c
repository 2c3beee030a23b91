/* SPDX-License-Identifier: BSD-3-Clause */
/* Springs in CSR form, compiled from the lattice's list: row i has the springs at node i, neighbours ascending, so each
 * spring is in two rows. Besides, what is computed of springs apart from forces: energy, strain, power of damping,
 * tangent stiffness and bounds of frequencies. The force (1) itself is inline in springs.h, and the same law for
 * vectors of springs is in sweep_body.h. */
#include "elastic/springs.h"

#include <stdbool.h>
#include <stdlib.h>

#include "base/array_ops.h"
#include "base/status.h"
#include "elastic/rigid_nodes.h"

/* row[i + 1] first counts the springs of node i and then, summed up, says where the next row begins. */
static void count_rows(springs *s, const dem_lattice *lattice)
{
    for (dem_index k = 0; k < 2 * lattice->n_springs; k++)
        if (!rigid_nodes_have(lattice, lattice->ends[k])) s->row[lattice->ends[k] + 1]++;
    for (dem_index i = 0; i < s->n_nodes; i++) s->row[i + 1] += s->row[i];
}

/* Neighbours come out ascending without a sort: the ends are visited in the order of the nodes j they are at, and each
 * j is appended to the row of its partner i. */
static void fill_rows(springs *s, const dem_lattice *lattice, const int32_t *by_node, int32_t *next)
{
    for (dem_index q = 0; q < s->row[s->n_nodes]; q++) {
        const dem_index k = by_node[q] / 2, end = by_node[q] % 2;
        const dem_index j = lattice->ends[2 * k + end], i = lattice->ends[2 * k + 1 - end], p = next[i]++;
        s->neighbour[p] = (int32_t)j;
        s->spring[p] = (int32_t)k;
    }
}

/* Lists spring ends, e = 2k + end, by the node they are at: a counting sort, which keeps the order of equal ones.
 * `next` is where each row goes on being filled, and is reset for fill_rows(). */
static void sort_ends(const springs *s, const dem_lattice *lattice, int32_t *by_node, int32_t *next)
{
    for (dem_index i = 0; i < s->n_nodes; i++) next[i] = s->row[i];
    for (dem_index e = 0; e < 2 * lattice->n_springs; e++)
        if (!rigid_nodes_have(lattice, lattice->ends[e])) by_node[next[lattice->ends[e]]++] = (int32_t)e;
    for (dem_index i = 0; i < s->n_nodes; i++) next[i] = s->row[i];
}

/* Neighbours are sorted, so two springs between the same nodes are next to each other. */
static dem_status refuse_duplicates(const springs *s)
{
    for (dem_index i = 0; i < s->n_nodes; i++)
        for (dem_index p = s->row[i] + 1; p < s->row[i + 1]; p++)
            CHECK(s->neighbour[p] != s->neighbour[p - 1], DEM_ERROR_MODEL,
                  "springs %lld and %lld both join nodes %lld and %lld", (long long)s->spring[p - 1],
                  (long long)s->spring[p], (long long)i, (long long)s->neighbour[p]);
    return DEM_OK;
}

static dem_status allocate(springs *s)
{
    const size_t n = (size_t)s->n_nodes, slots = 2 * (size_t)s->n_springs + 1;
    CHECK(s->n_nodes < INT32_MAX / 2 && s->n_springs < INT32_MAX / 2, DEM_ERROR_MODEL,
          "%lld nodes and %lld springs are more than the library takes", (long long)s->n_nodes,
          (long long)s->n_springs);
    s->row = calloc(n + 1, sizeof *s->row);
    s->neighbour = malloc(slots * sizeof *s->neighbour);
    s->spring = malloc(slots * sizeof *s->spring);
    CHECK(s->row && s->neighbour && s->spring, DEM_ERROR_MEMORY, "out of memory for %lld springs",
          (long long)s->n_springs);
    return DEM_OK;
}

/* Count, sort the ends by node, fill the rows: linear in the number of springs. */
dem_status springs_compile(springs *out, const dem_lattice *lattice)
{
    springs s = {.n_nodes = lattice->n_nodes,
                 .n_springs = lattice->n_springs,
                 .stiffness_of = lattice->stiffness,
                 .rest_length_of = lattice->rest_length,
                 .viscosity_of = lattice->viscosity};
    int32_t *next = malloc((size_t)s.n_nodes * sizeof *next);
    int32_t *by_node = malloc((2 * (size_t)s.n_springs + 1) * sizeof *by_node);
    dem_status status = allocate(&s);
    if (status == DEM_OK && !(next && by_node)) status = status_fail(DEM_ERROR_MEMORY, "out of memory");
    if (status != DEM_OK) goto out;
    count_rows(&s, lattice);
    sort_ends(&s, lattice, by_node, next);
    fill_rows(&s, lattice, by_node, next);
    status = refuse_duplicates(&s);
out:
    free(next);
    free(by_node);
    if (status == DEM_OK)
        *out = s;
    else
        springs_free(&s);
    return status;
}

void springs_free(springs *s)
{
    free(s->row);
    free(s->neighbour);
    free(s->spring);
    *s = (springs){0};
}

/* The force on node i is p d with d = x_j - x_i and p = E (|d| - d0)/(d0 |d|). With w = u_j - u_i it changes by
 *     p w + (dp/d|d|) (d.w/|d|) d = p w + (E/d0 - p) (d.w/|d|^2) d,
 * since dp/d|d| = E/|d|^2 = (E/d0 - p)/|d|. The first part is the stiffness of turning under tension, the second one of
 * stretching. The sum is returned with the opposite sign: K u. */
vec2 springs_tangent(const springs *s, dem_index i, const double *x, const double *u)
{
    vec2 out = {0.0, 0.0};
    for (dem_index p = s->row[i]; p < s->row[i + 1]; p++) {
        const vec2 d = vec2_sub(vec2_at(x, s->neighbour[p]), vec2_at(x, i));
        const vec2 w = vec2_sub(vec2_at(u, s->neighbour[p]), vec2_at(u, i));
        const double square = vec2_dot(d, d), length = sqrt(square), rest = s->rest_length_of[s->spring[p]];
        const double stiffness = s->stiffness_of[s->spring[p]];
        const double pull = stiffness * (length - rest) / (rest * length); /* tension over length */
        const double along = (stiffness / rest - pull) * vec2_dot(d, w) / square;
        out = vec2_along(vec2_along(out, -pull, w), -along, d);
    }
    return out;
}

/* A rounded sum in the order of the row. Each spring counts in full here, as the energy that depends on this node. */
double springs_node_energy(const springs *s, springs_integrity integrity, dem_index i, const double *x)
{
    double sum = 0.0;
    for (dem_index p = s->row[i]; p < s->row[i + 1]; p++) {
        const dem_index k = s->spring[p];
        if (springs_is_broken(integrity, k)) continue;
        const double strain = springs_strain(s, i, p, x), left = springs_left(integrity, k, strain);
        sum += springs_energy_of(left * s->stiffness_of[k], s->rest_length_of[k], strain);
    }
    return sum;
}

/* Squared lengths first; root and division go through all springs at once. */
void springs_strain_block(const dem_lattice *lattice, dem_index first, int n, const double *x, double *strain)
{
    const dem_index *ends = lattice->ends + 2 * first;
    for (int q = 0; q < n; q++) {
        const vec2 d = vec2_sub(vec2_at(x, ends[2 * q + 1]), vec2_at(x, ends[2 * q]));
        strain[q] = vec2_dot(d, d);
    }
    array_ops_fastest()->stretch(strain, lattice->rest_length + first, n);
}

void springs_strains(const dem_lattice *lattice, springs_integrity integrity, const double *x, double *strain)
{
    for (dem_index first = 0; first < lattice->n_springs; first += EXACT_SUM_BLOCK)
        springs_strain_block(lattice, first, exact_sum_block(first, lattice->n_springs), x, strain + first);
    for (dem_index k = 0; k < lattice->n_springs && integrity.pushed != NULL; k++)
        if (springs_is_broken(integrity, k)) strain[k] = 0.0;
}

void springs_forces(const dem_lattice *lattice, springs_integrity integrity, const double *x, double *force)
{
    springs_strains(lattice, integrity, x, force);
    for (dem_index k = 0; k < lattice->n_springs; k++)
        force[k] *= springs_left(integrity, k, force[k]) * lattice->stiffness[k];
}

/* d.v/(d0 |d|) of the spring in slot p of row i, with d and v from node i to its neighbour, 1/s. */
static double strain_rate(const springs *s, dem_index i, dem_index p, const double *x, const double *v)
{
    const vec2 d = vec2_sub(vec2_at(x, s->neighbour[p]), vec2_at(x, i));
    const vec2 dv = vec2_sub(vec2_at(v, s->neighbour[p]), vec2_at(v, i));
    return vec2_dot(d, dv) / (s->rest_length_of[s->spring[p]] * vec2_norm(d));
}

/* c e'^2 d0 of each spring: the force c e' times the rate e' d0 at which the length changes. A spring is taken from the
 * row of its lower node. */
void springs_add_damping_power(const springs *s, springs_integrity integrity, const dem_index range[2], const double *x,
                               const double *v, exact_terms *power)
{
    if (s->viscosity_of == NULL) return;
    for (dem_index i = range[0]; i < range[1]; i++)
        for (dem_index p = s->row[i]; p < s->row[i + 1]; p++) {
            const dem_index k = s->spring[p];
            const double left = springs_left(integrity, k, 1.0);
            if (s->neighbour[p] < i || left == 0.0) continue;
            const double rate = strain_rate(s, i, p, x, v);
            exact_terms_add(power, left * s->viscosity_of[k] * rate * rate * s->rest_length_of[k]);
        }
}

/* c/d0 n n^T with n = d/|d|, so that no root is needed. */
sym2 springs_block(const springs *s, const double *strength, dem_index i, const double *x)
{
    sym2 block = {0.0, 0.0, 0.0};
    for (dem_index p = s->row[i]; p < s->row[i + 1]; p++) {
        const vec2 d = vec2_sub(vec2_at(x, s->neighbour[p]), vec2_at(x, i));
        block = sym2_along(block, strength[s->spring[p]] / s->rest_length_of[s->spring[p]] / vec2_dot(d, d), d);
    }
    return block;
}

/* 2 |S_i|/m_i with S_i = sum of c/d0 n n^T: see docs/method.md, Damping. */
double springs_damping_bound(const springs *s, const double *x, const double *inverse_mass)
{
    double bound = 0.0;
    for (dem_index i = 0; s->viscosity_of != NULL && i < s->n_nodes; i++) {
        const double own = 2.0 * sym2_largest(springs_block(s, s->viscosity_of, i, x)) * inverse_mass[i];
        if (!isfinite(own)) return (double)INFINITY; /* fmax() would drop a NAN */
        bound = fmax(bound, own);
    }
    return bound;
}
