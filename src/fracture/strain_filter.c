/* SPDX-License-Identifier: BSD-3-Clause */
/* No principal stress of a triangle is larger than C m, nor a larger pressure, with m the largest |strain| of its
 * springs:
 *   C = (1/V) (sum over springs of w E d0 (1 + m) + sum over couplings of 2 |gamma| L1 L2 (1 + m)
 *              + |kappa| A0 c (1 + c m)^2),   c = sum over edges of |d ln A/d ln L| = L^2 |cot(opposite angle)|/(2 A).
 * The bound is used for m <= 0.1 and c m <= 0.3 alone, where the guard does not press yet. A node's stress is a mean
 * of those of its triangles, and a triangle's utilisation that of a mean of nodes' stresses. Without confinement,
 * which only lowers it, the utilisation is a sum of convex functions of the stress, and so at most the mean of the
 * utilisations by those stresses: if a triangle is near its limit, one of those with which it shares a corner is by
 * the same limits, and has a spring strained by near_limit/(C/strength + C/compressive strength). A spring that no
 * triangle holds adds to the stress without a bound; beside it, and at a triangle of which an edge has no spring,
 * every step takes a look: the threshold is 0. By the same means, of triangles with a strained spring only those need
 * a look around them whose own utilisation, by the least limits around, is near_limit (may_drive() in
 * fracture_source.c): most are strained by compression, and do not break by that. */
#include "fracture/strain_filter.h"

#include <math.h>
#include <stdlib.h>

#include "base/status.h"
#include "base/vec2.h"
#include "fracture/utilisation.h"
#include "model/spring_share.h"

static const double most_strain = 0.1, most_growth = 0.3; /* m, c m */

/* A triangle at rest. */
typedef struct shape {
    double length[3];   /* m, of the edge from corner c to the next */
    double sensitivity; /* c above */
    double area;
} shape;

static shape shape_of(const dem_lattice *l, dem_index triangle)
{
    const dem_index *corner = &l->triangles[3 * triangle];
    shape s = {.sensitivity = 0.0};
    vec2 x[3];
    for (int c = 0; c < 3; c++) x[c] = vec2_at(l->x, corner[c]);
    s.area = vec2_triangle_area(x[0], x[1], x[2]);
    for (int c = 0; c < 3; c++) s.length[c] = vec2_norm(vec2_sub(x[(c + 1) % 3], x[c]));
    for (int c = 0; c < 3; c++) {
        const double a = s.length[c], b = s.length[(c + 1) % 3], d = s.length[(c + 2) % 3];
        s.sensitivity += a * a * fabs(b * b + d * d - a * a) / (8.0 * s.area * s.area);
    }
    return s;
}

/* Whether all edges of a triangle have springs: those that it holds between its own corners are three. */
static bool has_all_edges(const dem_lattice *l, const element_state *s, dem_index triangle)
{
    const dem_index *corner = &l->triangles[3 * triangle];
    int n = 0;
    for (dem_index p = s->row[triangle]; p < s->row[triangle + 1]; p++) {
        int inside = 0;
        for (int k = 0; k < 6; k++) inside += l->ends[2 * s->spring[p] + k / 3] == corner[k % 3];
        n += inside == 2;
    }
    return n == 3;
}

/* The strain below which neither tension nor pressure of a triangle reaches `stress`. */
static double strain_for(const dem_lattice *l, const element_state *s, dem_index triangle, double stress)
{
    const shape at_rest = shape_of(l, triangle);
    const double growth = 1.0 + most_growth;
    double sum = 0.0;
    if (!has_all_edges(l, s, triangle)) return 0.0;
    for (dem_index p = s->row[triangle]; p < s->row[triangle + 1]; p++)
        sum += s->share[p] * l->stiffness[s->spring[p]] * l->rest_length[s->spring[p]] * (1.0 + most_strain);
    for (int c = 0; c < 3 && l->coupling != NULL; c++)
        sum += 2.0 * fabs(l->coupling[3 * triangle + c]) * at_rest.length[c] * at_rest.length[(c + 2) % 3] *
               (1.0 + most_strain);
    if (l->area_stiffness != NULL)
        sum += fabs(l->area_stiffness[triangle]) * at_rest.area * at_rest.sensitivity * growth * growth;
    const double strain = stress * spring_share_volume(l, triangle) / sum;
    return fmin(strain, fmin(most_strain, most_growth / at_rest.sensitivity));
}

/* The least limit of the triangles at a node that may break; infinity: none does.
 * \param limits  [n_triangles] their strengths, or compressive strengths */
static double weakest_at(const dem_lattice *l, const double *limits, const element_state *s, dem_index i)
{
    double least = (double)INFINITY;
    for (dem_index p = s->at_row[i]; p < s->at_row[i + 1]; p++)
        if (utilisation_is_limited(l, s->at[p])) least = fmin(least, limits[s->at[p]]);
    return least;
}

/* The same of the triangles that share a corner with one. */
static double weakest_around(const dem_lattice *l, const double *limits, const element_state *s, dem_index triangle)
{
    double least = (double)INFINITY;
    for (int c = 0; c < 3; c++) least = fmin(least, weakest_at(l, limits, s, l->triangles[3 * triangle + c]));
    return least;
}

/* Not above the number. */
static float round_down(double number)
{
    const float near = (float)number;
    return (double)near > number ? nextafterf(near, -INFINITY) : near;
}

/* Lowers the thresholds of the springs of a triangle to what its neighbours stand. */
static void enter_triangle(strain_filter *f, const dem_lattice *l, const element_state *s, dem_index triangle,
                           double near_limit)
{
    const utilisation_limits weakest = strain_filter_weakest(f, triangle);
    if (isinf(weakest.tension)) return;
    const double stress = near_limit * weakest.tension / (1.0 + weakest.tension / weakest.pressure);
    const float strain = round_down(strain_for(l, s, triangle, stress));
    for (dem_index p = s->row[triangle]; p < s->row[triangle + 1]; p++)
        f->threshold[s->spring[p]] = fminf(f->threshold[s->spring[p]], strain);
}

/* All springs at a corner are always over their threshold. */
static void enter_corner(strain_filter *f, const springs *all, dem_index i)
{
    for (dem_index p = all->row[i]; p < all->row[i + 1]; p++) f->threshold[all->spring[p]] = 0.0f;
}

/* A triangle of which an edge has no spring may be stressed whatever its springs are. */
static void enter_corners(strain_filter *f, const dem_model *m, const element_state *s, dem_index triangle)
{
    if (isinf(f->least[triangle]) || has_all_edges(&m->lattice, s, triangle)) return;
    for (int c = 0; c < 3; c++) enter_corner(f, &m->springs, m->lattice.triangles[3 * triangle + c]);
}

/* Springs at a node beside one that no triangle holds are always over their threshold. */
static void enter_loose(strain_filter *f, const dem_model *m, const element_state *s, dem_index spring)
{
    for (int end = 0; end < 2 && !s->held[spring]; end++) {
        const dem_index i = m->lattice.ends[2 * spring + end];
        if (isfinite(weakest_at(&m->lattice, m->lattice.strength, s, i))) enter_corner(f, &m->springs, i);
    }
}

/* Triangles without a strength have no limits, and nothing to be asked. */
static void enter_triangles(strain_filter *f, const dem_model *m, const element_state *s, double near_limit)
{
    const dem_lattice *l = &m->lattice;
    for (dem_index t = 0; t < l->n_triangles && l->strength != NULL; t++) {
        f->least[t] = round_down(weakest_around(l, l->strength, s, t));
        if (f->least_pressure != NULL)
            f->least_pressure[t] = round_down(weakest_around(l, l->compressive_strength, s, t));
        enter_triangle(f, l, s, t, near_limit);
        enter_corners(f, m, s, t);
    }
    for (dem_index k = 0; k < l->n_springs && l->strength != NULL; k++) enter_loose(f, m, s, k);
}

static dem_status allocate(strain_filter *f, const dem_lattice *l)
{
    const size_t n = (size_t)l->n_triangles + 1;
    const bool pressed = l->compressive_strength != NULL;
    f->threshold = malloc(((size_t)l->n_springs + 1) * sizeof *f->threshold);
    f->least = malloc(n * sizeof *f->least);
    if (pressed) f->least_pressure = malloc(n * sizeof *f->least_pressure);
    if (f->threshold != NULL && f->least != NULL && (f->least_pressure != NULL || !pressed)) return DEM_OK;
    strain_filter_destroy(f);
    return status_fail(DEM_ERROR_MEMORY, "out of memory for the limits of %lld springs", (long long)l->n_springs);
}

dem_status strain_filter_create(strain_filter *out, const dem_model *model, const element_state *elements,
                                double near_limit)
{
    const dem_lattice *l = &model->lattice;
    strain_filter f = {0};
    TRY(allocate(&f, l));
    for (dem_index k = 0; k < l->n_springs; k++) {
        const bool limited = l->critical_stretch != NULL && utilisation_is_limited(l, l->n_triangles + k);
        f.threshold[k] = limited ? round_down(near_limit * l->critical_stretch[k]) : INFINITY;
    }
    enter_triangles(&f, model, elements, near_limit);
    *out = f;
    return DEM_OK;
}

void strain_filter_destroy(strain_filter *f)
{
    free(f->threshold);
    free(f->least);
    free(f->least_pressure);
    *f = (strain_filter){0};
}
