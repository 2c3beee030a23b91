/* SPDX-License-Identifier: BSD-3-Clause */
#include "strengths.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "copies.h"

static bool scatters(const strengths_rule *rule)
{
    for (dem_index k = 0; k < rule->n_laws; k++)
        if (rule->laws[k].shape > 0.0) return true;
    return false;
}

/* What never breaks draws nothing.  \param limits  [n] before */
static void raise(strengths_range *range, double *factor, const double *limits, dem_index n)
{
    for (dem_index k = 0; k < n && limits != NULL; k++) {
        if (isfinite(limits[k])) range->n_raised += factor[k] < STRENGTHS_LEAST;
        factor[k] = fmax(factor[k], STRENGTHS_LEAST);
    }
}

/* Of one copy.  \param drawn  [n] \param limits  [n] before */
static void measure(strengths_range *range, const double *drawn, const double *limits, const double *factor,
                    dem_index n)
{
    dem_index count = 0;
    for (dem_index k = 0; k < n && limits != NULL; k++) {
        if (!isfinite(limits[k]) || factor[k] == 1.0) continue;
        range->least = range->n + count == 0 ? drawn[k] : fmin(range->least, drawn[k]);
        range->most = fmax(range->most, drawn[k]);
        count++;
    }
    range->n = count;
}

/* ---- copies ---- */

static double *part_of(double *all, dem_index n, size_t copy)
{
    return all != NULL ? all + copy * (size_t)n : NULL;
}

static void put(double *limits, const double *all, dem_index n, size_t copy)
{
    if (all != NULL) memcpy(limits, all + copy * (size_t)n, (size_t)n * sizeof *limits);
}

/* The lattice with the arrays of a copy in the place of its own. */
static dem_lattice view_of(const strengths *s, const dem_lattice *lattice, size_t copy)
{
    dem_lattice view = *lattice;
    view.strength = part_of(s->of_triangles, lattice->n_triangles, copy);
    view.softening = part_of(s->softening, lattice->n_triangles, copy);
    view.compressive_strength = part_of(s->compressive, lattice->n_triangles, copy);
    view.critical_stretch = part_of(s->of_springs, lattice->n_springs, copy);
    return view;
}

static void begin_copy(dem_lattice *view, const dem_lattice *lattice)
{
    put(view->strength, lattice->strength, lattice->n_triangles, 0);
    put(view->softening, lattice->softening, lattice->n_triangles, 0);
    put(view->compressive_strength, lattice->compressive_strength, lattice->n_triangles, 0);
    put(view->critical_stretch, lattice->critical_stretch, lattice->n_springs, 0);
}

/* Room for what the lattice has. */
static double *make_like(const double *array, dem_index n, size_t n_copies, bool *complete)
{
    double *made = array != NULL ? calloc(n_copies * (size_t)n + 1, sizeof *made) : NULL;
    *complete = *complete && (array == NULL || made != NULL);
    return made;
}

static bool make_room(strengths *s, const dem_lattice *l, size_t n_copies)
{
    bool complete = true;
    s->of_triangles = make_like(l->strength, l->n_triangles, n_copies, &complete);
    s->softening = make_like(l->softening, l->n_triangles, n_copies, &complete);
    s->compressive = make_like(l->compressive_strength, l->n_triangles, n_copies, &complete);
    s->of_springs = make_like(l->critical_stretch, l->n_springs, n_copies, &complete);
    return complete;
}

/* ---- draws ---- */

/* Of triangles and springs, where these can break. */
typedef struct factors {
    double *triangles, *springs;
} factors;

static dem_status draw_copy(strengths *s, const dem_lattice *lattice, const strengths_rule *rule, size_t copy,
                            const factors *f)
{
    dem_lattice view = view_of(s, lattice, copy);
    for (dem_index k = 0; k < rule->n_laws; k++) rule->laws[k].body = (dem_index)(rule->body * COPIES_MAX + copy);
    dem_status status = dem_lattice_weibull(lattice, rule->laws, rule->n_laws, rule->of, f->triangles, f->springs);
    if (status != DEM_OK) return status;
    begin_copy(&view, lattice);
    raise(&s->triangles, f->triangles, lattice->strength, lattice->n_triangles);
    raise(&s->springs, f->springs, lattice->critical_stretch, lattice->n_springs);
    status = dem_lattice_weaken(&view, f->triangles, NULL, f->springs);
    measure(&s->triangles, view.strength, lattice->strength, f->triangles, lattice->n_triangles);
    measure(&s->springs, view.critical_stretch, lattice->critical_stretch, f->springs, lattice->n_springs);
    return status;
}

static dem_status draw_copies(strengths *s, const dem_lattice *lattice, const strengths_rule *rule)
{
    bool complete = make_room(s, lattice, rule->n_copies);
    const factors f = {.triangles = make_like(lattice->strength, lattice->n_triangles, 1, &complete),
                       .springs = make_like(lattice->critical_stretch, lattice->n_springs, 1, &complete)};
    dem_status status = complete ? DEM_OK : DEM_ERROR_MEMORY;
    for (size_t c = 0; status == DEM_OK && c < rule->n_copies; c++) status = draw_copy(s, lattice, rule, c, &f);
    free(f.triangles);
    free(f.springs);
    return status;
}

dem_status strengths_draw(strengths *out, dem_lattice *lattice, const strengths_rule *rule)
{
    *out = (strengths){0};
    if (!scatters(rule)) return DEM_OK;
    const dem_status status = draw_copies(out, lattice, rule);
    if (status == DEM_OK) strengths_put(lattice, out, 0);
    if (status != DEM_OK || rule->n_copies == 1) strengths_free(out);
    return status;
}

/* The ranges stay, for the log. */
void strengths_free(strengths *s)
{
    free(s->of_triangles);
    free(s->softening);
    free(s->compressive);
    free(s->of_springs);
    s->of_triangles = s->softening = s->compressive = s->of_springs = NULL;
}

void strengths_put(dem_lattice *lattice, const strengths *s, size_t number)
{
    put(lattice->strength, s->of_triangles, lattice->n_triangles, number);
    put(lattice->softening, s->softening, lattice->n_triangles, number);
    put(lattice->compressive_strength, s->compressive, lattice->n_triangles, number);
    put(lattice->critical_stretch, s->of_springs, lattice->n_springs, number);
}
