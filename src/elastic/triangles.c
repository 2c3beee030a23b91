/* SPDX-License-Identifier: BSD-3-Clause */
/* What triangles add to springs: the area term, from which any Poisson's ratio other than 1/3 comes, and the folding
 * guard, which keeps squeezed triangles from turning inside out (docs/method.md, The solid). The energy of a triangle
 * depends on its area A alone, and so keeps momentum and angular momentum:
 *     W = A0 (kappa/2 (J - 1)^2 + g w(J)),   J = A/A0,   w = (-ln(J/Jc))^3 below Jc = 0.4 and 0 above.
 * Forces are gathered node by node in the fixed order of rows. The area term of the sweep is in sweep_body.h with the
 * same bits. kappa and g are chosen in lattice/solid_material.c and lattice/assemble.c. */
#include "elastic/triangles.h"

#include <stdlib.h>

#include "base/natural_log.h"
#include "base/status.h"
#include "elastic/rigid_nodes.h"

/* Below this J the guard's energy goes on as its Taylor polynomial of second degree. To turn a triangle inside out
 * takes w(0) = 184: with the default guard 3.7 E h A0, more than the kinetic energy of an impact at twice the speed of
 * sound. */
static const double taylor_below = 0.005;

/* With L = -ln(J/Jc) > 0:  w = L^3,  w' = -3 L^2/J,  w'' = (6 L + 3 L^2)/J^2, all 0 at the onset L = 0. `beyond` is how
 * far J is below the limit of Taylor's polynomial; there the energy stays finite and its slope goes on pushing J up,
 * even for a triangle that is inverted (J < 0). */
triangles_law triangles_guard_law(double area_ratio)
{
    if (area_ratio >= TRIANGLES_GUARD_ONSET) return (triangles_law){0.0, 0.0, 0.0};
    const double J = fmax(area_ratio, taylor_below), beyond = area_ratio - J;
    const double L = -natural_log(J / TRIANGLES_GUARD_ONSET);
    const double w = L * L * L, w1 = -3.0 * L * L / J, w2 = (6.0 * L + 3.0 * L * L) / (J * J);
    return (triangles_law){w + beyond * (w1 + 0.5 * beyond * w2), w1 + beyond * w2, w2};
}

/* Area A and rest area A0 of a triangle. */
typedef struct areas {
    double now, at_rest;
} areas;

static areas areas_at(const triangles *t, dem_index i, dem_index p, const double *x)
{
    return (areas){triangles_area(t, i, p, x), triangles_rest_area(t, i, p)};
}

/* Whether nothing resists a change of area of a triangle: it has no area term, and the guard does not act. */
static bool is_slack(const triangles *t, areas A)
{
    return t->area_stiffness_of == NULL && !(A.now < TRIANGLES_GUARD_ONSET * A.at_rest);
}

/* The larger of a square and that of a. */
static double larger_square(double square, vec2 a)
{
    const double own = vec2_dot(a, a);
    return own > square ? own : square;
}

/* Where the corners b and c move by w at most relative to the first one, twice the area falls by w (|b| + |c|) + w^2 at
 * most. If `spare` of it may be lost, and L^2 = 2 (b^2 + c^2) >= (|b| + |c|)^2, w may be
 *   spare L/(L^2 + spare) <= (sqrt(L^2 + 4 spare) - L)/2
 *  \return its square */
static double square_of_way(double spare, vec2 b, vec2 c)
{
    const double square = 2.0 * (vec2_dot(b, b) + vec2_dot(c, c)), left = spare > 0.0 ? spare : 0.0;
    const double part = left / (square + left);
    return part * part * square;
}

/* They are looked at whether or not they have a guard. */
triangles_room triangles_room_to_fold(const triangles *t, dem_index first, const double *x, const double *v)
{
    const double folded = 2.0 * TRIANGLES_ROUNDED * t->largest_onset;
    double way = (double)INFINITY, speed = 0.0;
    for (dem_index i = first; i < t->n_nodes; i++)
        for (dem_index p = t->row[i]; p < t->row[i + 1]; p++) {
            const dem_index j = t->next[p], k = t->last[p];
            const vec2 b = vec2_sub(vec2_at(x, j), vec2_at(x, i)), c = vec2_sub(vec2_at(x, k), vec2_at(x, i));
            const vec2 to_b = vec2_sub(vec2_at(v, j), vec2_at(v, i)), to_c = vec2_sub(vec2_at(v, k), vec2_at(v, i));
            way = fmin(way, square_of_way(vec2_cross(b, c) - folded, b, c));
            speed = larger_square(larger_square(larger_square(speed, to_b), to_c), vec2_sub(to_c, to_b));
        }
    return (triangles_room){sqrt(way), sqrt(speed)};
}

/* dA/dx_i = (z x (x_last - x_next))/2: the side opposite to node i, turned by 90 degrees towards it, and halved. */
static vec2 gradient_between(vec2 next, vec2 last)
{
    const vec2 opposite = vec2_sub(last, next);
    return (vec2){-0.5 * opposite.y, 0.5 * opposite.x};
}

static vec2 gradient(const triangles *t, dem_index p, const double *x)
{
    return gradient_between(vec2_at(x, t->next[p]), vec2_at(x, t->last[p]));
}

/* kappa, N/m, of the triangle in slot p, at an area ratio. */
static double area_stiffness_at(const triangles *t, triangles_integrity integrity, dem_index p, double J)
{
    const double kappa = t->area_stiffness_of[t->triangle[p]];
    return integrity.left != NULL ? triangles_area_left(t, integrity, p, J > 1.0) * kappa : kappa;
}

/* dW/dA = kappa (J - 1) + g w'(J), N/m: what area term and guard together resist a change of area with. */
static double slope_at(const triangles *t, triangles_integrity integrity, dem_index p, areas A)
{
    const double J = A.now / A.at_rest;
    double slope = t->area_stiffness_of != NULL ? area_stiffness_at(t, integrity, p, J) * (J - 1.0) : 0.0;
    if (A.now < TRIANGLES_GUARD_ONSET * A.at_rest) slope += triangles_guard(t, p) * triangles_guard_law(J).slope;
    return slope;
}

/* A0 d^2W/dA^2 = kappa + g w''(J), N/m. */
static double curvature_at(const triangles *t, dem_index p, areas A)
{
    const double curvature = triangles_guard(t, p) * triangles_guard_law(A.now / A.at_rest).curvature;
    return t->area_stiffness_of != NULL ? t->area_stiffness_of[t->triangle[p]] + curvature : curvature;
}

/* -dW/dA dA/dx_i. A triangle at its rest area is skipped. */
static inline vec2 add_force(const triangles *t, triangles_integrity integrity, dem_index p, areas A,
                             const vec2 corner[3], vec2 force)
{
    const double slope = is_slack(t, A) ? 0.0 : slope_at(t, integrity, p, A);
    return slope != 0.0 ? vec2_along(force, -slope, gradient_between(corner[1], corner[2])) : force;
}

vec2 triangles_add_force(const triangles *t, triangles_integrity integrity, dem_index p, double rest_area,
                         const vec2 corner[3], vec2 force)
{
    const areas A = {vec2_triangle_area(corner[0], corner[1], corner[2]), rest_area};
    return add_force(t, integrity, p, A, corner, force);
}

vec2 triangles_force(const triangles *t, triangles_integrity integrity, dem_index i, const double *x)
{
    vec2 force = {0.0, 0.0};
    for (dem_index p = t->row[i]; p < t->row[i + 1]; p++) {
        const vec2 corner[3] = {vec2_at(x, i), vec2_at(x, t->next[p]), vec2_at(x, t->last[p])};
        const double A = vec2_triangle_area(corner[0], corner[1], corner[2]);
        if (triangles_are_slack(t, A) || triangles_broken(t, integrity, p)) continue;
        force = add_force(t, integrity, p, (areas){A, triangles_rest_area(t, i, p)}, corner, force);
    }
    return force;
}

/* For an energy of the area alone r x f is A dW/dA times the unit tensor, since dA = A tr(e) under a strain e. */
double triangles_virial(const triangles *t, triangles_integrity integrity, dem_index i, dem_index p, const double *x)
{
    const double now = triangles_area(t, i, p, x);
    if (triangles_are_slack(t, now)) return 0.0;
    const areas A = {now, triangles_rest_area(t, i, p)};
    return is_slack(t, A) ? 0.0 : A.now * slope_at(t, integrity, p, A);
}

double triangles_virial_of(const dem_lattice *l, dem_index k, double rest_area, const double *x)
{
    const double A = vec2_area_of(x, &l->triangles[3 * k]), J = A / rest_area;
    double slope = l->area_stiffness != NULL ? l->area_stiffness[k] * (J - 1.0) : 0.0;
    if (l->guard != NULL && A < TRIANGLES_GUARD_ONSET * rest_area) slope += l->guard[k] * triangles_guard_law(J).slope;
    return A * slope;
}

/* Whether that is known of all triangles at a node, most often. */
static bool node_is_slack(const triangles *t, dem_index i, const double *x)
{
    bool slack = true;
    for (dem_index p = t->row[i]; p < t->row[i + 1]; p++) slack &= triangles_are_slack(t, triangles_area(t, i, p, x));
    return slack;
}

double triangles_node_virial(const triangles *t, dem_index i, const double *x, double divisor)
{
    double sum = 0.0;
    if (node_is_slack(t, i, x)) return 0.0;
    for (dem_index p = t->row[i]; p < t->row[i + 1]; p++) {
        const double virial = triangles_virial(t, TRIANGLES_WHOLE, i, p, x); /* most often 0 */
        if (virial != 0.0) sum += virial / divisor;
    }
    return sum;
}

/* d(dW/dA dA/dx_i) = d^2W/dA^2 (dA.u) dA/dx_i + dW/dA d(dA/dx_i). The area is quadratic in the positions: `change` =
 * dA.u is its first variation, and dA/dx_i is linear, so that its change is gradient() of u. */
vec2 triangles_tangent(const triangles *t, dem_index i, const double *x, const double *u)
{
    vec2 out = {0.0, 0.0};
    for (dem_index p = t->row[i]; p < t->row[i + 1]; p++) {
        const vec2 b = vec2_sub(vec2_at(x, t->next[p]), vec2_at(x, i)),
                   c = vec2_sub(vec2_at(x, t->last[p]), vec2_at(x, i));
        const vec2 ub = vec2_sub(vec2_at(u, t->next[p]), vec2_at(u, i)),
                   uc = vec2_sub(vec2_at(u, t->last[p]), vec2_at(u, i));
        const areas A = {0.5 * vec2_cross(b, c), triangles_rest_area(t, i, p)};
        const double change = 0.5 * (vec2_cross(ub, c) + vec2_cross(b, uc));
        out = vec2_along(out, curvature_at(t, p, A) * change / A.at_rest, gradient(t, p, x));
        out = vec2_along(out, slope_at(t, TRIANGLES_WHOLE, p, A), gradient(t, p, u));
    }
    return out;
}

/* With J = A/A0:  W = A0 (kappa/2 (J - 1)^2 + g w(J)) */
triangles_energies triangles_energies_at(const triangles *t, triangles_integrity integrity, dem_index i, dem_index p,
                                         const double *x)
{
    const double A0 = triangles_rest_area(t, i, p), J = triangles_area(t, i, p, x) / A0;
    const double kappa = t->area_stiffness_of != NULL ? area_stiffness_at(t, integrity, p, J) : 0.0;
    const double guard = J >= TRIANGLES_GUARD_ONSET ? 0.0 : A0 * triangles_guard(t, p) * triangles_guard_law(J).energy;
    return (triangles_energies){J, 0.5 * A0 * kappa * (J - 1.0) * (J - 1.0), guard};
}

/* Every triangle at the node counts in full: the energy that depends on this node. A rounded sum in the order of the
 * row. */
double triangles_node_energy(const triangles *t, triangles_integrity integrity, dem_index i, const double *x)
{
    double energy = 0.0;
    for (dem_index p = t->row[i]; p < t->row[i + 1]; p++) {
        if (triangles_broken(t, integrity, p)) continue;
        const triangles_energies own = triangles_energies_at(t, integrity, i, p, x);
        energy += own.area + own.guard;
    }
    return energy;
}

/* A negative kappa lowers frequencies and is left out of their upper bound. */
sym2 triangles_block(const triangles *t, dem_index i, const double *x)
{
    sym2 block = {0.0, 0.0, 0.0};
    for (dem_index p = t->row[i]; p < t->row[i + 1] && t->area_stiffness_of != NULL; p++) {
        const double kappa = fmax(t->area_stiffness_of[t->triangle[p]], 0.0);
        block = sym2_along(block, kappa / triangles_rest_area(t, i, p), gradient(t, p, x));
    }
    return block;
}

/* The second variation of A0 g w(A/A0) is g w'' (dA.u)^2/A0 + g w' u.A'' u. Here (dA.u)^2 <= 3 sum of (dA/dx_i.u_i)^2,
 * and A'' has the eigenvalues 0 and +-sqrt(3)/2. What falls to node i is the coefficient of u_i^2. */
double triangles_guard_bound(const triangles *t, triangles_integrity integrity, dem_index i, const double *x)
{
    const double turn = 0.8660254037844386;
    double bound = 0.0;
    for (dem_index p = t->row[i]; p < t->row[i + 1]; p++) {
        const areas A = areas_at(t, i, p, x);
        if (!(A.now < TRIANGLES_GUARD_ONSET * A.at_rest) || triangles_broken(t, integrity, p)) continue;
        const triangles_law l = triangles_guard_law(A.now / A.at_rest);
        const vec2 dA = gradient(t, p, x);
        bound += triangles_guard(t, p) * (3.0 * l.curvature * vec2_dot(dA, dA) / A.at_rest + turn * fabs(l.slope));
    }
    return bound;
}

/* ---- compilation ---- */

/* Triangles without area term and guard, and those of rigid bodies, are left out of the rows. */
static bool acts(const dem_lattice *lattice, dem_index k)
{
    if (rigid_nodes_have(lattice, lattice->triangles[3 * k])) return false;
    return (lattice->guard != NULL && lattice->guard[k] > 0.0) ||
           (lattice->area_stiffness != NULL && lattice->area_stiffness[k] != 0.0);
}

static dem_status allocate(triangles *t, dem_index slots)
{
    const size_t n = (size_t)slots + 1;
    t->row = calloc((size_t)t->n_nodes + 1, sizeof *t->row);
    t->next = malloc(n * sizeof *t->next);
    t->last = malloc(n * sizeof *t->last);
    t->triangle = malloc(n * sizeof *t->triangle);
    CHECK(t->row && t->next && t->last && t->triangle, DEM_ERROR_MEMORY, "out of memory for %lld triangles",
          (long long)(slots / 3));
    return DEM_OK;
}

/* The corners next and last follow corner c counter-clockwise. */
static void fill(triangles *t, const dem_lattice *lattice)
{
    for (dem_index k = 0; k < lattice->n_triangles; k++)
        for (int c = 0; c < 3 && acts(lattice, k); c++) t->row[lattice->triangles[3 * k + c] + 1]++;
    for (dem_index i = 0; i < t->n_nodes; i++) t->row[i + 1] += t->row[i];
    for (dem_index k = lattice->n_triangles - 1; k >= 0; k--) { /* backwards: row[i+1] counts down to the row's start */
        const dem_index *corner = &lattice->triangles[3 * k];
        for (int c = 0; c < 3 && acts(lattice, k); c++) {
            const dem_index p = --t->row[corner[c] + 1];
            t->next[p] = (int32_t)corner[(c + 1) % 3];
            t->last[p] = (int32_t)corner[(c + 2) % 3];
            t->triangle[p] = (int32_t)k;
            t->largest_onset = fmax(t->largest_onset, TRIANGLES_GUARD_ONSET * triangles_rest_area(t, corner[c], p));
        }
    }
}

/* fill() leaves the start of row i in row[i + 1]: moves it to row[i]. */
static void shift_rows(triangles *t, dem_index slots)
{
    for (dem_index i = 0; i < t->n_nodes; i++) t->row[i] = t->row[i + 1];
    t->row[t->n_nodes] = (int32_t)slots;
}

/* Three slots for each triangle that has an energy, one at each of its corners. */
dem_status triangles_compile(triangles *out, const dem_lattice *lattice)
{
    triangles t = {.n_nodes = lattice->n_nodes,
                   .x = lattice->x,
                   .guard_of = lattice->guard,
                   .area_stiffness_of = lattice->area_stiffness};
    dem_index slots = 0;
    CHECK(lattice->n_triangles < INT32_MAX / 6, DEM_ERROR_MODEL, "%lld triangles are more than the library takes",
          (long long)lattice->n_triangles);
    for (dem_index k = 0; k < lattice->n_triangles; k++) slots += acts(lattice, k) ? 3 : 0;
    const dem_status status = allocate(&t, slots);
    if (status != DEM_OK) {
        triangles_free(&t);
        return status;
    }
    fill(&t, lattice);
    shift_rows(&t, slots);
    *out = t;
    return DEM_OK;
}

void triangles_free(triangles *t)
{
    free(t->row);
    free(t->next);
    free(t->last);
    free(t->triangle);
    *t = (triangles){0};
}
