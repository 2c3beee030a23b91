/* SPDX-License-Identifier: BSD-3-Clause */
/* With m the largest |strain| of its springs, no principal stress of a triangle is larger in size than C m,
 *   V C = S (1 + m) + |kappa| A0 c (1 + c m)^2,
 *   S = sum over springs of w E d0 + sum over couplings of 2 |gamma| L1 L2,
 *   c = sum over edges of |s|,   s = d ln A/d ln L = L^2 cot(opposite angle)/(2 A).
 * That is used for m <= 0.1 and c m <= 0.3 alone, where the guard does not press yet. It takes all parts to be along
 * one direction. Where m is small, and the triangle holds its three edges alone, directions count. To first order its
 * stress is that of the strains e of the edges,
 *   V sigma = sum of e M,   M = w E d0 n n^T + gamma L L1 n1 n1^T + gamma' L L2 n2 n2^T + kappa A0 s I,
 * with n at rest, and edges 1 and 2 the other two: no principal value is larger than m times the largest one of the
 * sum of |M|, which has the eigenvectors of M, and their sizes. With M+ = (|M| + M)/2 and M- = (|M| - M)/2 none in
 * tension is larger than m C+ + r m C- with the largest ones of their sums, where no edge is shorter by more than r m:
 * pressure along an edge brings little tension, or none.
 * For what is left out let g be the largest Green strain: an edge adds E = L^2/(4 A^2) a b^T, made symmetric, for each
 * unit of its own, with a and b the other two turned by 90 degrees, so that g = k m (1 + m/2) with k the largest
 * principal value of the sum of |E|. For g <= 0.1
 *   - directions turn, and lengths grow: |F Q F^T - R Q R^T| <= 2.25 g |Q| for F = R U with U = sqrt(1 + 2 G), as
 *     |U - 1| <= 1.06 g and |U| + 1 <= 2.1; and the sum Q of all n n^T has |Q| <= S m/(1 - m);
 *   - tension over length is E e/(1 + e): S m^2/(1 - m);
 *   - J^2 = 1 + 2 tr G + 4 det G, so that |J (J - 1) - sum of s e| <= c m^2/2 + 2 g^2 + 20 g^2.
 * All bounds hold, and the largest strains are taken; more pressure is let in where that costs no more than a fourth of
 * the tension. */
#include "fracture/stress_bound.h"

#include <math.h>

#include "base/vec2.h"
#include "model/spring_share.h"

static const double most_strain = 0.1, most_growth = 0.3, most_turning = 0.09; /* m, c m, k m */

/* A triangle at rest. */
typedef struct shape {
    vec2 edge[3];          /* m, from corner c to the next */
    double length[3];      /* m */
    double sensitivity[3]; /* s above */
    double growth;         /* c */
    double turning;        /* k */
    double area;           /* m^2 */
    double springs;        /* S, N m */
    double compression;    /* |kappa| A0, N m */
} shape;

/* The matrix with the same eigenvectors and the sizes of the eigenvalues, mean +- radius: of different signs,
 * |M| = (mean M - (mean^2 - radius^2) I)/radius. */
static sym2 size_of(sym2 M)
{
    const double mean = 0.5 * (M.xx + M.yy), radius = sym2_largest(M) - mean, other = mean * mean - radius * radius;
    if (other >= 0.0) return mean >= 0.0 ? M : (sym2){-M.xx, -M.xy, -M.yy};
    return (sym2){(mean * M.xx - other) / radius, mean * M.xy / radius, (mean * M.yy - other) / radius};
}

/* k */
static double turning_of(const shape *s)
{
    sym2 sum = {0.0, 0.0, 0.0};
    for (int c = 0; c < 3; c++) {
        const vec2 a = s->edge[(c + 1) % 3], b = s->edge[(c + 2) % 3];
        const double factor = s->length[c] * s->length[c] / (4.0 * s->area * s->area);
        const sym2 E = {factor * a.y * b.y, -0.5 * factor * (a.x * b.y + a.y * b.x), factor * a.x * b.x};
        sum = sym2_add(sum, size_of(E));
    }
    return sym2_largest(sum);
}

/* S. */
static double sum_of_sizes(const dem_lattice *l, const element_state *e, const shape *s, dem_index triangle)
{
    double sum = 0.0;
    for (dem_index p = e->row[triangle]; p < e->row[triangle + 1]; p++)
        sum += e->share[p] * l->stiffness[e->spring[p]] * l->rest_length[e->spring[p]];
    for (int c = 0; c < 3 && l->coupling != NULL; c++)
        sum += 2.0 * fabs(l->coupling[3 * triangle + c]) * s->length[c] * s->length[(c + 2) % 3];
    return sum;
}

static shape shape_of(const dem_lattice *l, const element_state *e, dem_index triangle)
{
    const dem_index *corner = &l->triangles[3 * triangle];
    shape s = {.growth = 0.0};
    for (int c = 0; c < 3; c++) {
        s.edge[c] = vec2_sub(vec2_at(l->x, corner[(c + 1) % 3]), vec2_at(l->x, corner[c]));
        s.length[c] = vec2_norm(s.edge[c]);
    }
    s.area = 0.5 * vec2_cross(s.edge[0], s.edge[1]);
    const double *L = s.length, squared = s.area * s.area;
    for (int c = 0; c < 3; c++) {
        const double a = L[c], b = L[(c + 1) % 3], d = L[(c + 2) % 3];
        s.sensitivity[c] = a * a * (b * b + d * d - a * a) / (8.0 * squared);
        s.growth += fabs(s.sensitivity[c]);
    }
    s.turning = turning_of(&s);
    s.springs = sum_of_sizes(l, e, &s, triangle);
    if (l->area_stiffness != NULL) s.compression = fabs(l->area_stiffness[triangle]) * s.area;
    return s;
}

/* The edge that a spring is, which is as long at rest as it; -1: none. */
static int edge_of(const dem_lattice *l, const shape *s, dem_index triangle, dem_index spring)
{
    const dem_index *corner = &l->triangles[3 * triangle], *end = &l->ends[2 * spring];
    for (int c = 0; c < 3; c++) {
        const dem_index a = corner[c], b = corner[(c + 1) % 3];
        const bool is_it = (a == end[0] && b == end[1]) || (a == end[1] && b == end[0]);
        if (is_it && fabs(l->rest_length[spring] - s->length[c]) < 1e-12 * s->length[c]) return c;
    }
    return -1;
}

/* w E d0 by edges.  \return whether the triangle holds these alone */
static bool find_stiffness(const dem_lattice *l, const element_state *e, const shape *s, dem_index triangle,
                           double stiffness[3])
{
    if (e->row[triangle + 1] - e->row[triangle] != 3) return false;
    for (dem_index p = e->row[triangle]; p < e->row[triangle + 1]; p++) {
        const dem_index k = e->spring[p];
        const int c = edge_of(l, s, triangle, k);
        if (c < 0) return false;
        stiffness[c] = e->share[p] * l->stiffness[k] * l->rest_length[k];
    }
    return true;
}

/* M of edge c. */
static sym2 response(const dem_lattice *l, const shape *s, dem_index triangle, const double stiffness[3], int c)
{
    const int next = (c + 1) % 3, last = (c + 2) % 3;
    const double *L = s->length, *coupling = l->coupling != NULL ? &l->coupling[3 * triangle] : NULL;
    const double own = l->area_stiffness != NULL ? l->area_stiffness[triangle] * s->area * s->sensitivity[c] : 0.0;
    sym2 M = sym2_along((sym2){own, 0.0, own}, stiffness[c] / (L[c] * L[c]), s->edge[c]);
    if (coupling == NULL) return M;
    M = sym2_along(M, coupling[c] * L[c] / L[last], s->edge[last]);
    return sym2_along(M, coupling[next] * L[c] / L[next], s->edge[next]);
}

/* What edges do to stress: the largest principal values of the sums of |M|, M+ and M-. */
typedef struct responses {
    double both, pulled, pushed;
} responses;

static responses add_up(const dem_lattice *l, const shape *s, dem_index triangle, const double stiffness[3])
{
    sym2 both = {0.0, 0.0, 0.0}, difference = both;
    for (int c = 0; c < 3; c++) {
        const sym2 M = response(l, s, triangle, stiffness, c);
        both = sym2_add(both, size_of(M));
        difference = sym2_add(difference, M);
    }
    const sym2 turned = {-difference.xx, -difference.xy, -difference.yy};
    return (responses){sym2_largest(both), 0.5 * sym2_largest(sym2_add(both, difference)),
                       fmax(0.5 * sym2_largest(sym2_add(both, turned)), 0.0)};
}

/* The strain m for which first m + second (r m)^2 is at most stress times V, with k r m small enough. */
static double strain_for(const shape *s, double stress_volume, double first, double r)
{
    const double k = s->turning, most = fmin(stress_volume / first, most_turning / (k * r)), m = r * most;
    const double of_springs = s->springs * (2.25 * k * (1.0 + 0.5 * m) + 1.0) / (1.0 - m);
    const double of_area = s->compression * (0.5 * s->growth + 22.0 * 1.1 * k * k);
    return fmin(most, stress_volume / (first + (of_springs + of_area) * r * m));
}

/* The second bound. */
static stress_bound directed_bound(const dem_lattice *l, const element_state *e, const shape *s, dem_index triangle,
                                   double stress_volume, bool pressure)
{
    static const double ratios[3] = {4.0, 2.0, 1.5};
    double stiffness[3];
    if (!find_stiffness(l, e, s, triangle, stiffness)) return (stress_bound){0.0, 0.0};
    const responses of = add_up(l, s, triangle, stiffness);
    const double equal = strain_for(s, stress_volume, of.both, 1.0);
    for (int k = 0; k < 3 && !pressure; k++) {
        const double r = ratios[k], m = strain_for(s, stress_volume, of.pulled + r * of.pushed, r);
        if (m >= 0.75 * equal) return (stress_bound){m, r * m};
    }
    return (stress_bound){equal, equal};
}

/* The first one. */
static double plain_strain(const shape *s, double stress_volume)
{
    const double growth = 1.0 + most_growth;
    const double most = s->springs * (1.0 + most_strain) + s->compression * s->growth * growth * growth;
    return fmin(stress_volume / most, fmin(most_strain, most_growth / s->growth));
}

stress_bound stress_bound_of(const dem_lattice *l, const element_state *e, dem_index triangle, double stress,
                             bool pressure)
{
    const shape s = shape_of(l, e, triangle);
    const double stress_volume = stress * spring_share_volume(l, triangle);
    const double plain = plain_strain(&s, stress_volume);
    const stress_bound directed = directed_bound(l, e, &s, triangle, stress_volume, pressure);
    return directed.stretch > plain ? directed : (stress_bound){plain, plain};
}
