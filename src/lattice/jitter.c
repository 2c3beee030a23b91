/* SPDX-License-Identifier: BSD-3-Clause */
/* Jitter: nodes off the boundary are moved at random (docs/algorithms.md, Shapes). */
#include "lattice/jitter.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "base/status.h"
#include "base/vec2.h"
#include "lattice/lattice.h"
#include "lattice/mesh_edges.h"

static const double least_area = 0.1; /* of a triangle, over what it was before its nodes were moved */

static const uint64_t jitter_stream = UINT64_MAX; /* of numbers: bodies' strengths have those from 0 on */

/* Uniform in a disc: points of the square around it are drawn until one is in the disc. The numbers are the node's
 * own. */
static vec2 random_shift(uint64_t seed, dem_index node, double radius)
{
    uint64_t state = random_state_of(seed, jitter_stream, (uint64_t)node);
    vec2 place;
    do {
        place.x = random_next(&state);
        place.y = random_next(&state);
    } while (vec2_dot(place, place) > 1.0);
    return vec2_scale(radius, place);
}

/* Jitter is measured by the areas before it, so these must be positive. */
static dem_status check_areas(const dem_lattice *l)
{
    for (dem_index t = 0; t < l->n_triangles; t++)
        CHECK(lattice_is_positive(vec2_area_of(l->x, l->triangles + 3 * t)), DEM_ERROR_MODEL,
              "triangle %lld has the area %g m^2; it must be > 0 to be jittered", (long long)t,
              vec2_area_of(l->x, l->triangles + 3 * t));
    return DEM_OK;
}

/* Marks the corners of triangles that have kept less than `least_area` of their area.  \return whether there are any */
static bool mark_squeezed(const dem_lattice *l, const double *x, unsigned char *marked)
{
    bool any = false;
    memset(marked, 0, (size_t)l->n_nodes);
    for (dem_index t = 0; t < l->n_triangles; t++) {
        const dem_index *corner = l->triangles + 3 * t;
        if (vec2_area_of(x, corner) >= least_area * vec2_area_of(l->x, corner)) continue;
        any = true;
        for (int c = 0; c < 3; c++) marked[corner[c]] = 1;
    }
    return any;
}

/* Moves the corners of such triangles half way back, all of them at once, until there are none: the order of triangles
 * does not matter. It ends, since the shifts of such corners go to 0 and their areas to what they were. A part does not
 * know whether other triangles at these corners move them, too. */
static dem_status move_back(const dem_lattice *l, const jitter_part *part, double *x, unsigned char *marked)
{
    while (mark_squeezed(l, x, marked)) {
        CHECK(part->end - part->begin == l->n_nodes, DEM_ERROR_MODEL,
              "triangles of a slab would keep less than %g of their areas: its lattice can be jittered as a whole",
              least_area);
        for (dem_index i = 0; i < l->n_nodes; i++) {
            const vec2 before = vec2_at(l->x, i), shift = vec2_sub(vec2_at(x, i), before);
            if (marked[i] != 0) vec2_put(x, i, vec2_along(before, 0.5, shift));
        }
    }
    return DEM_OK;
}

static bool is_rim(const jitter_part *part, dem_index i)
{
    return i < part->begin || i >= part->end;
}

/* Where a node is among those of the rim. */
static dem_index rim_place(const jitter_part *part, dem_index i)
{
    return i < part->begin ? i : i - (part->end - part->begin);
}

static dem_index number_of(const jitter_part *part, dem_index i)
{
    return is_rim(part, i) ? part->rim[rim_place(part, i)] : part->first + (i - part->begin);
}

/* Nodes of the boundary stay. Edges at nodes that have all of their triangles tell of these. */
static dem_status mark_boundary(unsigned char *stays, const dem_lattice *l, const jitter_part *part)
{
    TRY(mesh_edges_contact_flags(stays, l));
    for (dem_index i = 0; i < l->n_nodes; i++)
        if (is_rim(part, i)) stays[i] = part->rim_boundary[rim_place(part, i)];
    return DEM_OK;
}

static dem_status check(const dem_lattice *lattice, double radius)
{
    CHECK(isfinite(radius) && radius >= 0.0, DEM_ERROR_ARGUMENT, "the radius of the jitter must be >= 0: %g m", radius);
    CHECK(lattice->n_springs == 0, DEM_ERROR_MODEL, "a lattice that has springs cannot be jittered: %lld springs",
          (long long)lattice->n_springs);
    CHECK(lattice->n_triangles > 0, DEM_ERROR_MODEL, "a lattice without triangles cannot be jittered");
    return check_areas(lattice);
}

/* The shift of a node depends on its number and the seed alone, but for triangles that it would squeeze. */
dem_status jitter_move(dem_lattice *lattice, const jitter_part *part, double radius, uint64_t seed)
{
    TRY(check(lattice, radius));
    unsigned char *stays = lattice_zeros(lattice->n_nodes, sizeof *stays);
    double *x = lattice_zeros(lattice->n_nodes, 2 * sizeof *x);
    dem_status status = stays != NULL && x != NULL ? mark_boundary(stays, lattice, part)
                                                   : status_fail(DEM_ERROR_MEMORY, "out of memory");
    for (dem_index i = 0; status == DEM_OK && i < lattice->n_nodes; i++) {
        const vec2 shift = stays[i] != 0 ? (vec2){0.0, 0.0} : random_shift(seed, number_of(part, i), radius);
        vec2_put(x, i, vec2_add(vec2_at(lattice->x, i), shift));
    }
    if (status == DEM_OK) status = move_back(lattice, part, x, stays);
    if (status == DEM_OK) {
        double *const old = lattice->x;
        lattice->x = x;
        x = old;
    }
    free(stays);
    free(x);
    return status;
}

dem_status dem_lattice_jitter(dem_lattice *lattice, double radius, uint64_t seed)
{
    TRY(lattice_check(lattice));
    return jitter_move(lattice, &(jitter_part){.begin = 0, .end = lattice->n_nodes}, radius, seed);
}
