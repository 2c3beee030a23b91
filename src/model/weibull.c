/* SPDX-License-Identifier: BSD-3-Clause */
/* Weibull's weakest link. A piece of volume V stands the stress s with the probability exp(-(V/V_0) (s/sigma_0)^m). A
 * body of several pieces under one stress breaks with the first of them: probabilities multiply, so volumes add up, and
 * into whatever pieces a body is divided, its strength has the same distribution. A triangle of volume V has
 *     s/sigma_0 = ((V_0/V) (-ln u))^(1/m)
 * with a uniform u in (0, 1), which belongs to the number of the triangle: it depends on no order of draws. */
#include <dem/dem.h>

#include <math.h>
#include <stdlib.h>

#include "base/natural_power.h"
#include "base/random.h"
#include "base/status.h"
#include "base/struct_size.h"
#include "lattice/lattice.h"
#include "model/spring_holders.h"
#include "model/spring_share.h"

enum { of_triangles, of_springs, of_loose, n_streams }; /* of numbers, of each body */

/* What draws. */
typedef struct drawing {
    const dem_lattice *lattice;
    const dem_weibull *laws;
    const dem_index *of; /* [n_triangles]; NULL: the first law */
    double *factor;      /* [n_springs] */
    double *volume;      /* [n_springs] m^3 */
    dem_index *number;   /* [n_springs] by which a spring draws */
    int *n_held;         /* [n_triangles] springs that it holds */
} drawing;

static const dem_weibull *law_of(const drawing *d, dem_index triangle)
{
    return &d->laws[d->of != NULL && triangle >= 0 ? d->of[triangle] : 0];
}

static double factor_of(const dem_weibull *w, int stream, dem_index number, double volume)
{
    if (w->shape == 0.0) return 1.0;
    const double u = random_at(w->seed, n_streams * (uint64_t)w->body + (uint64_t)stream, (uint64_t)number);
    return natural_power(w->volume / volume * -natural_log(u), 1.0 / w->shape);
}

/* Beyond the range of doubles it would be no strength. */
static dem_status check_factor(const char *what, dem_index k, double factor)
{
    CHECK(isfinite(factor) && factor > 0.0, DEM_ERROR_MODEL,
          "%s %lld: its volume, or the law's, gives the factor %g to its strength", what, (long long)k, factor);
    return DEM_OK;
}

/* ---- triangles ---- */

static dem_index number_of(const dem_weibull *w, dem_index triangle)
{
    return w->number != NULL ? w->number[triangle] : triangle;
}

static dem_status draw_triangles(const drawing *d, double *factor)
{
    for (dem_index t = 0; t < d->lattice->n_triangles; t++) {
        const dem_weibull *w = law_of(d, t);
        factor[t] = factor_of(w, of_triangles, number_of(w, t), spring_share_volume(d->lattice, t));
        TRY(check_factor("triangle", t, factor[t]));
    }
    return DEM_OK;
}

/* ---- springs ---- */

/* Its side, or 3: the second diagonal of a cell. */
static int side_of(const dem_lattice *l, dem_index triangle, dem_index spring)
{
    const dem_index *c = &l->triangles[3 * triangle], *ends = &l->ends[2 * spring];
    for (int k = 0; k < 3; k++) {
        const dem_index i = c[k], j = c[(k + 1) % 3];
        if ((i == ends[0] && j == ends[1]) || (i == ends[1] && j == ends[0])) return k;
    }
    return 3;
}

static void count_held(void *context, dem_index spring, dem_index triangle, double share)
{
    const drawing *d = context;
    (void)spring, (void)share;
    if (triangle >= 0) d->n_held[triangle]++;
}

/* A triangle gives its volume to the springs that it holds, in equal parts. The number is that of the triangle with the
 * lowest one, and of the side that the spring is there. */
static void give_volume(void *context, dem_index spring, dem_index triangle, double share)
{
    const drawing *d = context;
    if (triangle < 0) {
        d->number[spring] = spring;
        d->volume[spring] += share * d->laws[0].section * d->lattice->rest_length[spring];
        return;
    }
    const dem_index number = 4 * number_of(law_of(d, triangle), triangle) + side_of(d->lattice, triangle, spring);
    if (d->volume[spring] == 0.0 || number < d->number[spring]) d->number[spring] = number;
    d->volume[spring] += spring_share_volume(d->lattice, triangle) / d->n_held[triangle];
}

/* Between two laws the smaller factor counts. */
static void draw_spring(void *context, dem_index spring, dem_index triangle, double share)
{
    const drawing *d = context;
    const double factor =
        factor_of(law_of(d, triangle), triangle < 0 ? of_loose : of_springs, d->number[spring], d->volume[spring]);
    (void)share;
    d->factor[spring] = fmin(d->factor[spring], factor);
}

static dem_status visit_springs(const drawing *d, spring_holders *h)
{
    drawing context = *d;
    spring_holders_count(h, count_held, &context);
    spring_holders_visit(h, give_volume, &context);
    for (dem_index k = 0; k < d->lattice->n_springs; k++) {
        CHECK(d->volume[k] > 0.0 || d->laws[0].shape == 0.0, DEM_ERROR_MODEL,
              "spring %lld has no triangle, and so no volume: the law needs a section", (long long)k);
        d->factor[k] = (double)INFINITY;
    }
    spring_holders_visit(h, draw_spring, &context);
    for (dem_index k = 0; k < d->lattice->n_springs; k++) TRY(check_factor("spring", k, d->factor[k]));
    return DEM_OK;
}

/* Those of rigid bodies, too, which are springs only without the flags. */
static dem_status draw_with_holders(const drawing *d)
{
    dem_lattice elastic = *d->lattice;
    elastic.flags = NULL;
    springs all;
    spring_holders h;
    TRY(springs_compile(&all, &elastic));
    dem_status status = spring_holders_create(&h, &elastic, &all);
    if (status == DEM_OK) {
        status = visit_springs(d, &h);
        spring_holders_free(&h);
    }
    springs_free(&all);
    return status;
}

static dem_status draw_springs(drawing *d, double *factor)
{
    const dem_index n = d->lattice->n_springs;
    d->factor = factor;
    d->volume = lattice_zeros(n, sizeof *d->volume);
    d->number = lattice_zeros(n, sizeof *d->number);
    d->n_held = lattice_zeros(d->lattice->n_triangles, sizeof *d->n_held);
    const bool complete = d->volume != NULL && d->number != NULL && d->n_held != NULL;
    const dem_status status = complete ? draw_with_holders(d) : status_fail(DEM_ERROR_MEMORY, "out of memory");
    free(d->volume);
    free(d->number);
    free(d->n_held);
    return status;
}

/* ---- public ---- */

static dem_status check_law(const dem_weibull *w, dem_index k)
{
    CHECK(isfinite(w->shape) && w->shape >= 0.0, DEM_ERROR_ARGUMENT, "law %lld: shape must be >= 0: %g", (long long)k,
          w->shape);
    CHECK(w->shape == 0.0 || (isfinite(w->volume) && w->volume > 0.0), DEM_ERROR_ARGUMENT,
          "law %lld: volume must be > 0: %g m^3", (long long)k, w->volume);
    CHECK(isfinite(w->section) && w->section >= 0.0, DEM_ERROR_ARGUMENT, "law %lld: section must be >= 0: %g m^2",
          (long long)k, w->section);
    return DEM_OK;
}

static dem_status check_laws(const drawing *d, dem_index n_laws)
{
    for (dem_index k = 0; k < n_laws; k++) TRY(check_law(&d->laws[k], k));
    for (dem_index t = 0; d->of != NULL && t < d->lattice->n_triangles; t++)
        CHECK(d->of[t] >= 0 && d->of[t] < n_laws, DEM_ERROR_ARGUMENT, "triangle %lld has law %lld, but there are %lld",
              (long long)t, (long long)d->of[t], (long long)n_laws);
    for (dem_index t = 0; t < d->lattice->n_triangles; t++)
        CHECK(spring_share_volume(d->lattice, t) > 0.0, DEM_ERROR_MODEL,
              "triangle %lld has the volume %g m^3; it must be > 0", (long long)t, spring_share_volume(d->lattice, t));
    return DEM_OK;
}

static const struct_kind kind = {"dem_weibull", STRUCT_SIZE_WITH(dem_weibull, number), sizeof(dem_weibull)};

dem_status dem_lattice_weibull(const dem_lattice *lattice, const dem_weibull *laws, dem_index n_laws,
                               const dem_index *of, double *triangle_factor, double *spring_factor)
{
    dem_lattice own_lattice;
    void *own_laws;
    TRY(lattice_check(lattice));
    TRY(lattice_read(&own_lattice, lattice));
    CHECK(laws != NULL && n_laws > 0, DEM_ERROR_ARGUMENT, "dem_lattice_weibull: at least one law must be given: %lld",
          (long long)n_laws);
    TRY(struct_size_read_array(&kind, &own_laws, laws, n_laws));
    drawing d = {.lattice = &own_lattice, .laws = own_laws, .of = of};
    dem_status status = check_laws(&d, n_laws);
    if (status == DEM_OK && triangle_factor != NULL) status = draw_triangles(&d, triangle_factor);
    if (status == DEM_OK && spring_factor != NULL) status = draw_springs(&d, spring_factor);
    free(own_laws);
    return status;
}
