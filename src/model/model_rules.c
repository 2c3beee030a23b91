/* SPDX-License-Identifier: BSD-3-Clause */
/* Item by item, so that parts of a lattice can be checked by themselves. */
#include "model/model_rules.h"

#include <math.h>
#include <stdlib.h>

#include "base/reduce.h"
#include "base/status.h"
#include "base/vec2.h"
#include "lattice/lattice.h"

/* An array of vectors must be finite; a missing one is fine. */
static dem_status check_pairs(const char *what, const double *array, dem_index n)
{
    for (dem_index i = 0; array != NULL && i < n; i++)
        CHECK(isfinite(array[2 * i]) && isfinite(array[2 * i + 1]), DEM_ERROR_MODEL,
              "node %lld: %s (%g, %g) is not finite", (long long)i, what, array[2 * i], array[2 * i + 1]);
    return DEM_OK;
}

/* Positions, masses and numbers of bodies. Velocities come last: a spin about the centre of mass may have made them not
 * finite because of a bad mass, which is then named first. */
static dem_status check_nodes(const dem_lattice *l, dem_index n_whole)
{
    CHECK(l->n_nodes > 0, DEM_ERROR_MODEL, "the lattice has no nodes");
    CHECK(l->x != NULL && l->mass != NULL, DEM_ERROR_ARGUMENT, "the lattice has no array of %s",
          l->x == NULL ? "positions" : "masses");
    TRY(check_pairs("rest position", l->x, l->n_nodes));
    TRY(check_pairs("initial position", l->position, l->n_nodes));
    for (dem_index i = 0; i < l->n_nodes; i++) {
        CHECK(isfinite(l->mass[i]) && l->mass[i] > 0.0, DEM_ERROR_MODEL, "node %lld: mass must be > 0, got %g kg",
              (long long)i, l->mass[i]);
        CHECK(l->body == NULL || (l->body[i] >= 0 && l->body[i] < n_whole), DEM_ERROR_MODEL,
              "node %lld: body number %d is not in 0 to %lld", (long long)i, l->body[i], (long long)(n_whole - 1));
    }
    return check_pairs("initial velocity", l->velocity, l->n_nodes); /* masses may have made them */
}

/* A spring needs two different nodes at different places, of one body, and a positive rest length and stiffness. */
static dem_status check_springs(const dem_lattice *l)
{
    for (dem_index k = 0; k < l->n_springs; k++) {
        const dem_index i = l->ends[2 * k], j = l->ends[2 * k + 1];
        CHECK(i != j, DEM_ERROR_MODEL, "spring %lld joins node %lld to itself", (long long)k, (long long)i);
        CHECK(l->x[2 * i] != l->x[2 * j] || l->x[2 * i + 1] != l->x[2 * j + 1], DEM_ERROR_MODEL,
              "spring %lld: its nodes %lld and %lld are at the same place", (long long)k, (long long)i, (long long)j);
        CHECK(isfinite(l->rest_length[k]) && l->rest_length[k] > 0.0, DEM_ERROR_MODEL,
              "spring %lld: rest length must be > 0, got %g m", (long long)k, l->rest_length[k]);
        CHECK(isfinite(l->stiffness[k]) && l->stiffness[k] > 0.0, DEM_ERROR_MODEL,
              "spring %lld: stiffness must be > 0, got %g N", (long long)k, l->stiffness[k]);
        CHECK(l->viscosity == NULL || (isfinite(l->viscosity[k]) && l->viscosity[k] >= 0.0), DEM_ERROR_MODEL,
              "spring %lld: viscosity must be >= 0, got %g N s", (long long)k, l->viscosity[k]);
        CHECK(l->critical_stretch == NULL || l->critical_stretch[k] > 0.0, DEM_ERROR_MODEL,
              "spring %lld: critical stretch must be > 0, got %g", (long long)k, l->critical_stretch[k]);
        CHECK(l->body == NULL || l->body[i] == l->body[j], DEM_ERROR_MODEL, "spring %lld joins bodies %d and %d",
              (long long)k, l->body[i], l->body[j]);
    }
    return DEM_OK;
}

/* What triangles stand; INFINITY: they never break so. A compressive strength below that in tension would be no law of
 * Mohr and Coulomb, and a triangle that softens in tension keeps its stiffness under pressure. */
static dem_status check_limits(const dem_lattice *l, dem_index k)
{
    const double tension = l->strength != NULL ? l->strength[k] : (double)INFINITY;
    CHECK(tension > 0.0, DEM_ERROR_MODEL, "triangle %lld: strength must be > 0, got %g Pa", (long long)k, tension);
    CHECK(l->softening == NULL || (isfinite(l->softening[k]) && l->softening[k] >= 1.0), DEM_ERROR_MODEL,
          "triangle %lld: softening must be >= 1, got %g", (long long)k, l->softening[k]);
    CHECK(l->confinement == NULL || (isfinite(l->confinement[k]) && l->confinement[k] >= 0.0), DEM_ERROR_MODEL,
          "triangle %lld: confinement must be >= 0, got %g", (long long)k, l->confinement[k]);
    CHECK(l->own_stress == NULL || l->own_stress[k] <= 1, DEM_ERROR_MODEL,
          "triangle %lld: own_stress must be 0 or 1, got %d", (long long)k, l->own_stress[k]);
    if (l->compressive_strength == NULL || l->compressive_strength[k] == (double)INFINITY) return DEM_OK;
    CHECK(l->compressive_strength[k] >= tension, DEM_ERROR_MODEL,
          "triangle %lld: compressive strength must be at least its strength, %g Pa, got %g Pa", (long long)k, tension,
          l->compressive_strength[k]);
    CHECK(l->softening == NULL || l->softening[k] == 1.0, DEM_ERROR_MODEL,
          "triangle %lld: one that softens, by %g, has no compressive strength, got %g Pa", (long long)k,
          l->softening[k], l->compressive_strength[k]);
    return DEM_OK;
}

/* Areas must be positive, which also means counter-clockwise corners. */
static dem_status check_triangles(const dem_lattice *l)
{
    for (dem_index k = 0; k < l->n_triangles; k++) {
        const dem_index *c = &l->triangles[3 * k];
        const double area = vec2_area_of(l->x, c);
        CHECK(area > 0.0, DEM_ERROR_MODEL, "triangle %lld (nodes %lld, %lld, %lld): area must be > 0, got %g m^2",
              (long long)k, (long long)c[0], (long long)c[1], (long long)c[2], area);
        CHECK(l->guard == NULL || (isfinite(l->guard[k]) && l->guard[k] >= 0.0), DEM_ERROR_MODEL,
              "triangle %lld: guard must be >= 0, got %g N/m", (long long)k, l->guard[k]);
        CHECK(l->area_stiffness == NULL || isfinite(l->area_stiffness[k]), DEM_ERROR_MODEL,
              "triangle %lld: area stiffness must be finite, got %g N/m", (long long)k, l->area_stiffness[k]);
        for (int q = 0; q < 3 && l->coupling != NULL; q++)
            CHECK(isfinite(l->coupling[3 * k + q]), DEM_ERROR_MODEL,
                  "triangle %lld: coupling must be finite, got %g N/m", (long long)k, l->coupling[3 * k + q]);
        CHECK(l->thickness == NULL || (isfinite(l->thickness[k]) && l->thickness[k] > 0.0), DEM_ERROR_MODEL,
              "triangle %lld: thickness must be > 0, got %g m", (long long)k, l->thickness[k]);
        CHECK(l->modulus == NULL || (isfinite(l->modulus[k]) && l->modulus[k] > 0.0), DEM_ERROR_MODEL,
              "triangle %lld: modulus must be > 0, got %g Pa", (long long)k, l->modulus[k]);
        TRY(check_limits(l, k));
    }
    return DEM_OK;
}

/* Node numbers are checked by lattice_check() before springs and triangles use them. */
dem_status model_rules_check(const dem_lattice *l, dem_index n_whole)
{
    CHECK(l->dim == 2, DEM_ERROR_ARGUMENT, "the lattice has dimension %d, only 2 is supported", l->dim);
    TRY(check_nodes(l, n_whole));
    TRY(lattice_check(l));
    TRY(check_springs(l));
    return check_triangles(l);
}

/* ---- bodies ---- */

/* Loops go backwards so that the first fault is named.
 * \param size  [bodies] nodes of all ranks */
static dem_status check_sizes(const dem_lattice *l, const dem_index own[2], const unsigned char *is_loose,
                              const dem_index *size, dem_index n_bodies)
{
    dem_index loose = -1, empty = -1;
    for (dem_index i = own[1] - 1; i >= own[0]; i--)
        if (is_loose[i] && size[l->body[i]] > 1) loose = i;
    for (dem_index b = n_bodies - 1; b >= 0; b--)
        if (size[b] == 0) empty = b;
    CHECK(loose < 0, DEM_ERROR_MODEL, "node %lld at (%g, %g) m has no springs, though body %d has other nodes",
          (long long)loose, l->x[2 * loose], l->x[2 * loose + 1], l->body[loose]);
    CHECK(empty < 0, DEM_ERROR_MODEL, "body %lld has no nodes, though there are bodies up to %lld", (long long)empty,
          (long long)(n_bodies - 1));
    return DEM_OK;
}

dem_status model_rules_check_bodies(const dem_lattice *l, const ranks *r, const dem_index own[2],
                                    const unsigned char *is_loose)
{
    const dem_index n_bodies = (dem_index)reduce_max(r, (double)lattice_count_bodies(l));
    dem_index *size = lattice_zeros(n_bodies, sizeof *size);
    dem_status status =
        size != NULL ? DEM_OK : status_fail(DEM_ERROR_MEMORY, "out of memory for %lld bodies", (long long)n_bodies);
    status = reduce_status(r, status, 0.0);
    if (status == DEM_OK) {
        for (dem_index i = own[0]; i < own[1]; i++) size[l->body[i]]++;
        reduce_counts(r, size, n_bodies);
        status = reduce_status(r, check_sizes(l, own, is_loose, size, n_bodies), 0.0);
    }
    free(size);
    return status;
}
