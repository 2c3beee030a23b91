/* SPDX-License-Identifier: BSD-3-Clause */
/* Appends one lattice to another. The arrays of both are copied one behind the other, and numbers of nodes and bodies
 * in the second one are shifted. An array that only one of them has is completed with what its absence stands for:
 * zeros, ones, infinities, rest positions, or contact flags of the boundary. Nodes are not merged, so the two become
 * separate bodies. */
#include "lattice/lattice.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/status.h"
#include "lattice/mesh_edges.h"

/* n items of `a` and m of `b` one behind the other, with zeros in place of an array that is NULL. */
static void *join(const void *a, dem_index n, const void *b, dem_index m, size_t size)
{
    unsigned char *joined = lattice_zeros(n + m, size);
    if (joined != NULL && a != NULL) memcpy(joined, a, (size_t)n * size);
    if (joined != NULL && b != NULL) memcpy(joined + (size_t)n * size, b, (size_t)m * size);
    return joined;
}

/* The same of numbers whose absence stands for `absent`; NULL if both are missing. */
static dem_status join_numbers(double **out, const double *a, dem_index n, const double *b, dem_index m, double absent)
{
    if (a == NULL && b == NULL) return DEM_OK;
    *out = join(a, n, b, m, sizeof **out);
    CHECK_MEMORY(*out);
    for (dem_index k = 0; k < n && a == NULL; k++) (*out)[k] = absent;
    for (dem_index k = n; k < n + m && b == NULL; k++) (*out)[k] = absent;
    return DEM_OK;
}

/* The flags of a lattice, or those that their absence stands for. */
static dem_status copy_flags(unsigned char *flags, const dem_lattice *lattice)
{
    if (lattice->flags == NULL) return mesh_edges_contact_flags(flags, lattice);
    memcpy(flags, lattice->flags, (size_t)lattice->n_nodes);
    return DEM_OK;
}

/* Flags stay away if both are missing and mean the same for the whole: "the boundary" with triangles, "all" without. */
static dem_status join_flags(dem_lattice *out, const dem_lattice *a, const dem_lattice *b)
{
    const bool same_rule = (a->n_triangles == 0) == (b->n_triangles == 0);
    if (a->flags == NULL && b->flags == NULL && (same_rule || a->n_nodes == 0 || b->n_nodes == 0)) return DEM_OK;
    out->flags = lattice_zeros(a->n_nodes + b->n_nodes, sizeof *out->flags);
    CHECK_MEMORY(out->flags);
    TRY(copy_flags(out->flags, a));
    return copy_flags(out->flags + a->n_nodes, b);
}

/* Two lattices make two bodies or more. Where one of them has no nodes, no numbers are needed. */
static dem_status join_bodies(dem_lattice *out, const dem_lattice *a, const dem_lattice *b)
{
    const dem_index n = a->n_nodes, shift = lattice_count_bodies(a);
    if (b->n_nodes == 0 && a->body == NULL) return DEM_OK;
    if (n == 0 && b->body == NULL) return DEM_OK;
    /* The bodies of the second lattice get the numbers after those of the first. */
    CHECK(shift + lattice_count_bodies(b) <= INT32_MAX, DEM_ERROR_MODEL, "more than %ld bodies", (long)INT32_MAX);
    out->body = join(a->body, n, b->body, b->n_nodes, sizeof *out->body);
    CHECK_MEMORY(out->body);
    for (dem_index i = n; i < n + b->n_nodes; i++) out->body[i] += (int32_t)shift;
    return DEM_OK;
}

/* The position of a node, where its motion starts, is the rest position if none is given. */
static dem_status join_nodes(dem_lattice *out, const dem_lattice *a, const dem_lattice *b)
{
    const dem_index n = a->n_nodes, m = b->n_nodes;
    const size_t scalar = sizeof(double), vector = 2 * sizeof(double);
    out->n_nodes = n + m;
    out->x = join(a->x, n, b->x, m, vector);
    CHECK_MEMORY(out->x);
    if (a->mass != NULL || b->mass != NULL) {
        out->mass = join(a->mass, n, b->mass, m, scalar);
        CHECK_MEMORY(out->mass);
    }
    if (a->position != NULL || b->position != NULL) {
        out->position = join(a->position ? a->position : a->x, n, b->position ? b->position : b->x, m, vector);
        CHECK_MEMORY(out->position);
    }
    if (a->velocity != NULL || b->velocity != NULL) {
        out->velocity = join(a->velocity, n, b->velocity, m, vector);
        CHECK_MEMORY(out->velocity);
    }
    return DEM_OK;
}

/* Undamped springs beside damped ones have the viscosity 0; those without a critical stretch never break. */
static dem_status join_springs(dem_lattice *out, const dem_lattice *a, const dem_lattice *b)
{
    const dem_index n = a->n_springs, m = b->n_springs;
    out->n_springs = n + m;
    if (n + m == 0) return DEM_OK;
    out->ends = join(a->ends, n, b->ends, m, 2 * sizeof *out->ends);
    out->rest_length = join(a->rest_length, n, b->rest_length, m, sizeof *out->rest_length);
    out->stiffness = join(a->stiffness, n, b->stiffness, m, sizeof *out->stiffness);
    CHECK_MEMORY(out->ends);
    CHECK_MEMORY(out->rest_length);
    CHECK_MEMORY(out->stiffness);
    /* The nodes of the second lattice follow those of the first. */
    for (dem_index k = 2 * n; k < 2 * (n + m); k++) out->ends[k] += a->n_nodes;
    TRY(join_numbers(&out->viscosity, a->viscosity, n, b->viscosity, m, 0.0));
    return join_numbers(&out->critical_stretch, a->critical_stretch, n, b->critical_stretch, m, (double)INFINITY);
}

/* Without a strength triangles never break, without softening they break at once, without a compressive strength
 * pressure does not break them, and without a flag the mean of their corners' stresses does. */
static dem_status join_limits(dem_lattice *out, const dem_lattice *a, const dem_lattice *b)
{
    const dem_index n = a->n_triangles, m = b->n_triangles;
    const double never = (double)INFINITY;
    TRY(join_numbers(&out->strength, a->strength, n, b->strength, m, never));
    TRY(join_numbers(&out->softening, a->softening, n, b->softening, m, 1.0));
    TRY(join_numbers(&out->compressive_strength, a->compressive_strength, n, b->compressive_strength, m, never));
    TRY(join_numbers(&out->confinement, a->confinement, n, b->confinement, m, 0.0));
    if (a->own_stress == NULL && b->own_stress == NULL) return DEM_OK;
    out->own_stress = join(a->own_stress, n, b->own_stress, m, sizeof *out->own_stress);
    CHECK_MEMORY(out->own_stress);
    return DEM_OK;
}

/* A guard, an area stiffness and couplings that are missing are 0. */
static dem_status join_triangles(dem_lattice *out, const dem_lattice *a, const dem_lattice *b)
{
    const dem_index n = a->n_triangles, m = b->n_triangles;
    out->n_triangles = n + m;
    if (n + m == 0) return DEM_OK;
    out->triangles = join(a->triangles, n, b->triangles, m, 3 * sizeof *out->triangles);
    CHECK_MEMORY(out->triangles);
    for (dem_index k = 3 * n; k < 3 * (n + m); k++) out->triangles[k] += a->n_nodes;
    TRY(join_numbers(&out->thickness, a->thickness, n, b->thickness, m, 1.0));
    TRY(join_numbers(&out->modulus, a->modulus, n, b->modulus, m, 1.0));
    TRY(join_numbers(&out->guard, a->guard, n, b->guard, m, 0.0));
    TRY(join_numbers(&out->area_stiffness, a->area_stiffness, n, b->area_stiffness, m, 0.0));
    TRY(join_limits(out, a, b));
    if (a->coupling != NULL || b->coupling != NULL) {
        out->coupling = join(a->coupling, n, b->coupling, m, 3 * sizeof *out->coupling);
        CHECK_MEMORY(out->coupling);
    }
    return DEM_OK;
}

/* Nodes come first, since the others shift their numbers by those of the first lattice. On failure the caller frees
 * what has been made. */
static dem_status join_all(dem_lattice *out, const dem_lattice *a, const dem_lattice *b)
{
    TRY(join_nodes(out, a, b));
    TRY(join_flags(out, a, b));
    TRY(join_bodies(out, a, b));
    TRY(join_springs(out, a, b));
    return join_triangles(out, a, b);
}

/* The joined lattice is made apart, so that a failure leaves both lattices as they were. A missing mass has no
 * default. */
dem_status dem_lattice_append(dem_lattice *lattice, const dem_lattice *other)
{
    dem_lattice joined, first, second; /* the latter two as this version of the library has them */
    TRY(lattice_check(lattice));
    TRY(lattice_check(other));
    TRY(lattice_read(&first, lattice));
    TRY(lattice_read(&second, other));
    /* An empty lattice takes whatever it is joined with. */
    const bool both = lattice->n_nodes > 0 && other->n_nodes > 0;
    CHECK(!both || (lattice->mass == NULL) == (other->mass == NULL), DEM_ERROR_MODEL,
          "one lattice has masses, the other has none");
    joined = dem_lattice_empty();
    dem_status status = join_all(&joined, &first, &second);
    if (status == DEM_OK && joined.coupling != NULL && !lattice_has_couplings(lattice))
        status = status_fail(DEM_ERROR_ARGUMENT, "dem_lattice: struct_size is %zu, without room for couplings",
                             lattice->struct_size);
    if (status == DEM_OK && (joined.strength || joined.critical_stretch) && !lattice_has_limits(lattice))
        status = status_fail(DEM_ERROR_ARGUMENT, "dem_lattice: struct_size is %zu, without room for strengths",
                             lattice->struct_size);
    if (status == DEM_OK && joined.softening != NULL && !lattice_has_softening(lattice))
        status = status_fail(DEM_ERROR_ARGUMENT, "dem_lattice: struct_size is %zu, without room for softening",
                             lattice->struct_size);
    if (status == DEM_OK && (joined.compressive_strength || joined.confinement) &&
        !lattice_has_pressure_limits(lattice))
        status =
            status_fail(DEM_ERROR_ARGUMENT, "dem_lattice: struct_size is %zu, without room for compressive strengths",
                        lattice->struct_size);
    if (status == DEM_OK && joined.own_stress != NULL && !lattice_has_own_stress(lattice))
        status = status_fail(DEM_ERROR_ARGUMENT, "dem_lattice: struct_size is %zu, without room for own_stress",
                             lattice->struct_size);
    if (status == DEM_OK) {
        dem_lattice_free(lattice);
        lattice_give(lattice, &joined);
    } else {
        dem_lattice_free(&joined);
    }
    return status;
}
