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

/* Those of one copy: what it has, times factors, which it gets for it. What never breaks draws nothing. */
static void apply(strengths_range *range, double *out, const double *limits, dem_index n)
{
    const bool first = range->n == 0;
    dem_index drawn = 0;
    for (dem_index k = 0; k < n; k++) {
        const double factor = out[k];
        out[k] = limits[k] * fmax(factor, STRENGTHS_LEAST);
        if (!isfinite(limits[k]) || factor == 1.0) continue;
        range->n_raised += factor < STRENGTHS_LEAST;
        range->least = first && drawn == 0 ? out[k] : fmin(range->least, out[k]);
        range->most = fmax(range->most, out[k]);
        drawn++;
    }
    range->n = drawn;
}

static dem_status draw_copy(strengths *s, const dem_lattice *lattice, const strengths_rule *rule, size_t copy)
{
    double *triangles = s->of_triangles != NULL ? s->of_triangles + copy * (size_t)lattice->n_triangles : NULL;
    double *springs = s->of_springs != NULL ? s->of_springs + copy * (size_t)lattice->n_springs : NULL;
    for (dem_index k = 0; k < rule->n_laws; k++) rule->laws[k].body = (dem_index)(rule->body * COPIES_MAX + copy);
    const dem_status status = dem_lattice_weibull(lattice, rule->laws, rule->n_laws, rule->of, triangles, springs);
    if (status != DEM_OK) return status;
    if (triangles != NULL) apply(&s->triangles, triangles, lattice->strength, lattice->n_triangles);
    if (springs != NULL) apply(&s->springs, springs, lattice->critical_stretch, lattice->n_springs);
    return DEM_OK;
}

/* Room for those that the lattice has. */
static bool make_room(strengths *s, const dem_lattice *l, size_t n_copies)
{
    if (l->strength != NULL) s->of_triangles = calloc(n_copies * (size_t)l->n_triangles + 1, sizeof *s->of_triangles);
    if (l->critical_stretch != NULL) s->of_springs = calloc(n_copies * (size_t)l->n_springs + 1, sizeof *s->of_springs);
    return (l->strength == NULL || s->of_triangles != NULL) && (l->critical_stretch == NULL || s->of_springs != NULL);
}

dem_status strengths_draw(strengths *out, dem_lattice *lattice, const strengths_rule *rule)
{
    *out = (strengths){0};
    if (!scatters(rule)) return DEM_OK;
    dem_status status = make_room(out, lattice, rule->n_copies) ? DEM_OK : DEM_ERROR_MEMORY;
    for (size_t c = 0; status == DEM_OK && c < rule->n_copies; c++) status = draw_copy(out, lattice, rule, c);
    if (status == DEM_OK) strengths_put(lattice, out, 0);
    if (status != DEM_OK || rule->n_copies == 1) strengths_free(out);
    return status;
}

/* The ranges stay, for the log. */
void strengths_free(strengths *s)
{
    free(s->of_triangles);
    free(s->of_springs);
    s->of_triangles = s->of_springs = NULL;
}

static void put(double *limits, const double *all, dem_index n, size_t number)
{
    if (all != NULL) memcpy(limits, all + number * (size_t)n, (size_t)n * sizeof *limits);
}

void strengths_put(dem_lattice *lattice, const strengths *s, size_t number)
{
    put(lattice->strength, s->of_triangles, lattice->n_triangles, number);
    put(lattice->critical_stretch, s->of_springs, lattice->n_springs, number);
}
