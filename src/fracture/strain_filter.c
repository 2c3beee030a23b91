/* SPDX-License-Identifier: BSD-3-Clause */
/* Strains bound the stress of a triangle (stress_bound.c). A node's stress is a mean of those of its triangles, and a
 * triangle's utilisation that of a mean of nodes' stresses. Without confinement, which only lowers it, the utilisation
 * is a sum of convex functions of the stress, and so at most the mean of the utilisations by those stresses: if a
 * triangle is near its limit, so is one of its corners by the triangle's limits, and one of the triangles at that
 * corner. With all principal stresses below s in size it is below s (1/strength + 1/compressive strength); where
 * pressure breaks none, those in tension count. A spring that no triangle holds adds to the stress of its ends without
 * a bound, and so does a triangle of which an edge has no spring to that of its corners: these nodes are listed, and
 * get a look at every step. */
#include "fracture/strain_filter.h"

#include <math.h>
#include <stdlib.h>

#include "base/grow.h"
#include "base/status.h"
#include "fracture/stress_bound.h"
#include "fracture/utilisation.h"

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

static const utilisation_limits unlimited = {.tension = (double)INFINITY, .pressure = (double)INFINITY};

/* Of a triangle that may break, whatever the pressure across. */
static utilisation_limits limits_of(const dem_lattice *l, dem_index triangle)
{
    utilisation_limits limits = unlimited;
    if (!breakable_element(l, triangle)) return limits;
    limits.tension = l->strength[triangle];
    if (l->compressive_strength != NULL) limits.pressure = l->compressive_strength[triangle];
    return limits;
}

/* The lower one of each. */
static utilisation_limits weaker(utilisation_limits a, utilisation_limits b)
{
    return (utilisation_limits){.tension = fmin(a.tension, b.tension), .pressure = fmin(a.pressure, b.pressure)};
}

/* The least limits of the triangles at a node. */
static utilisation_limits weakest_at(const dem_lattice *l, const element_state *s, dem_index i)
{
    utilisation_limits least = unlimited;
    for (dem_index p = s->at_row[i]; p < s->at_row[i + 1]; p++) least = weaker(least, limits_of(l, s->at[p]));
    return least;
}

/* The same of the triangles that share a corner with one. */
static utilisation_limits weakest_around(const dem_lattice *l, const element_state *s, dem_index triangle)
{
    utilisation_limits least = unlimited;
    for (int c = 0; c < 3; c++) least = weaker(least, weakest_at(l, s, l->triangles[3 * triangle + c]));
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
    const utilisation_limits weakest = weakest_around(l, s, triangle);
    if (isinf(weakest.tension)) return;
    const double stress = near_limit * weakest.tension / (1.0 + weakest.tension / weakest.pressure);
    const stress_bound bound = stress_bound_of(l, s, triangle, stress, isfinite(weakest.pressure));
    for (dem_index p = s->row[triangle]; p < s->row[triangle + 1]; p++) {
        kernel_threshold *own = &f->threshold[s->spring[p]];
        own->stretch = fminf(own->stretch, round_down(bound.stretch));
        own->squeeze = fminf(own->squeeze, round_down(bound.squeeze));
    }
}

/* Triangles without a strength have no limits, and nothing to be asked. */
static void enter_triangles(strain_filter *f, const dem_lattice *l, const element_state *s, double near_limit)
{
    for (dem_index t = 0; t < l->n_triangles && l->strength != NULL; t++) {
        f->weakest = weaker(f->weakest, limits_of(l, t));
        const bool has_edges = has_all_edges(l, s, t), is_rigid = l->flags[l->triangles[3 * t]] & DEM_NODE_RIGID;
        f->have_edges = f->have_edges && (has_edges || is_rigid);
        if (has_edges) enter_triangle(f, l, s, t, near_limit);
    }
}

/* Marks the corners of triangles of which an edge has no spring, and the ends of springs that no triangle holds. */
static void mark_unbounded(unsigned char *marks, const dem_lattice *l, const element_state *s)
{
    for (dem_index k = 0; k < 3 * l->n_triangles; k++)
        if (!has_all_edges(l, s, k / 3)) marks[l->triangles[k]] = 1;
    for (dem_index k = 0; k < 2 * l->n_springs; k++)
        if (!s->held[k / 2]) marks[l->ends[k]] = 1;
}

/* Lists those of them at which a triangle may break. */
static dem_status list_unbounded(strain_filter *f, const dem_lattice *l, const element_state *s)
{
    dem_index capacity = 0;
    unsigned char *marks = calloc((size_t)l->n_nodes + 1, 1);
    CHECK(marks != NULL, DEM_ERROR_MEMORY, "out of memory for the limits of %lld nodes", (long long)l->n_nodes);
    mark_unbounded(marks, l, s);
    bool has_room = true;
    for (dem_index i = 0; i < l->n_nodes && has_room; i++) {
        if (!marks[i] || isinf(weakest_at(l, s, i).tension)) continue;
        has_room = grow_array((void **)&f->always, &capacity, f->n_always + 1, sizeof *f->always);
        if (has_room) f->always[f->n_always++] = i;
    }
    free(marks);
    CHECK(has_room, DEM_ERROR_MEMORY, "out of memory for the limits of %lld nodes", (long long)l->n_nodes);
    return DEM_OK;
}

static dem_status fill(strain_filter *f, const dem_lattice *l, const element_state *s, double near_limit)
{
    f->threshold = malloc(((size_t)l->n_springs + 1) * sizeof *f->threshold);
    CHECK(f->threshold != NULL, DEM_ERROR_MEMORY, "out of memory for the limits of %lld springs",
          (long long)l->n_springs);
    for (dem_index k = 0; k < l->n_springs; k++) {
        const bool limited = l->critical_stretch != NULL && breakable_element(l, l->n_triangles + k);
        f->threshold[k] = (kernel_threshold){INFINITY, INFINITY};
        if (limited) f->threshold[k].stretch = round_down(near_limit * l->critical_stretch[k]);
    }
    enter_triangles(f, l, s, near_limit);
    return l->strength != NULL ? list_unbounded(f, l, s) : DEM_OK;
}

dem_status strain_filter_create(strain_filter *out, const dem_model *model, const element_state *elements,
                                double near_limit)
{
    strain_filter f = {.have_edges = true, .weakest = unlimited};
    const dem_status status = fill(&f, &model->lattice, elements, near_limit);
    if (status == DEM_OK)
        *out = f;
    else
        strain_filter_destroy(&f);
    return status;
}

void strain_filter_forget_thresholds(strain_filter *f)
{
    free(f->threshold);
    f->threshold = NULL;
}

void strain_filter_destroy(strain_filter *f)
{
    free(f->threshold);
    free(f->always);
    *f = (strain_filter){0};
}
