/* SPDX-License-Identifier: BSD-3-Clause */
/* Generates triangulations: equilateral ones and square cells of simple shapes, holes cut into them, and nodes moved at
 * random (docs/method.md, Shapes). The coordinates are mirror symmetric to the bit, so that symmetric runs stay
 * symmetric. Springs and masses are not made here but in assemble.c; other shapes are cut out of such grids
 * by src/shape, and meshes come from the programs (drivers/body). */
#include <dem/dem.h>

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "base/status.h"
#include "base/vec2.h"
#include "lattice/lattice.h"
#include "lattice/mesh_edges.h"

static const double max_nodes = 1099511627776.0; /* 2^40: no byte count of an array overflows */
/* Height of a row of an equilateral grid, in spacings. */
static const double sqrt3_2 = 0.86602540378443864676;
static const double least_area = 0.1; /* of a triangle, over what it was before its nodes were moved */

/* ---- equilateral triangulations ---- */

/* Rows first <= 0 .. last >= 0 of an equilateral grid. Nodes are at x = s spacing/2 with whole s, |s| <= reach; s has
 * the parity of reach in even rows, the other one in odd rows. So x is mirror symmetric to the bit. */
typedef struct grid {
    dem_index reach, first, last;
    double spacing;
} grid;

/* Even rows have a node more than odd ones. */
static bool is_wide(dem_index row)
{
    return row % 2 == 0;
}

/* Whole multiples of half a spacing are rounded once, alike on both sides. */
static double *grid_nodes(const grid *g, dem_index n)
{
    double *x = lattice_zeros(n, 2 * sizeof *x), *next = x;
    if (x == NULL) return NULL;
    for (dem_index row = g->first; row <= g->last; row++) {
        const dem_index reach = is_wide(row) ? g->reach : g->reach - 1;
        for (dem_index s = -reach; s <= reach; s += 2) {
            *next++ = (double)s * (0.5 * g->spacing);
            *next++ = (double)row * (sqrt3_2 * g->spacing);
        }
    }
    return x;
}

static dem_index *put_triangle(dem_index *next, dem_index i, dem_index j, dem_index k)
{
    next[0] = i;
    next[1] = j;
    next[2] = k;
    return next + 3;
}

/* Strip by strip between two rows, of which one is wider. `low` and `high` are the first nodes of the lower and the
 * upper row. All triangles are counter-clockwise. */
static dem_index *grid_triangles(const grid *g, dem_index n)
{
    dem_index *triangles = lattice_zeros(n, 3 * sizeof *triangles), *next = triangles, low = 0;
    if (triangles == NULL) return NULL;
    for (dem_index row = g->first; row < g->last; row++) {
        const bool wide = is_wide(row);
        /* The first node of the upper row; a wide row has one node more than `reach`. */
        const dem_index high = low + g->reach + (wide ? 1 : 0);
        for (dem_index k = 0; k < g->reach; k++) { /* on the wider row, then on the narrower */
            next = wide ? put_triangle(next, low + k, low + k + 1, high + k)
                        : put_triangle(next, low + k, high + k + 1, high + k);
            if (k + 1 == g->reach) break;
            next = wide ? put_triangle(next, low + k + 1, high + k + 1, high + k)
                        : put_triangle(next, low + k, low + k + 1, high + k + 1);
        }
        low = high;
    }
    return triangles;
}

/* Hands over a lattice whose arrays may be missing for lack of memory. */
static dem_status finish(dem_lattice *out, dem_lattice *lattice)
{
    const dem_index n = lattice->n_nodes;
    if (lattice->x == NULL || lattice->triangles == NULL) {
        dem_lattice_free(lattice);
        return status_fail(DEM_ERROR_MEMORY, "out of memory for %lld nodes", (long long)n);
    }
    lattice_give(out, lattice);
    return DEM_OK;
}

/* Each row counts `reach` nodes and the wide ones one more; a strip has 2 reach - 1 triangles. */
static dem_status grid_lattice(dem_lattice *out, const grid *g)
{
    const dem_index wide = g->last / 2 - g->first / 2 + 1;
    dem_lattice lattice = dem_lattice_empty();
    lattice.n_nodes = (g->last - g->first + 1) * g->reach + wide;
    lattice.n_triangles = (g->last - g->first) * (2 * g->reach - 1);
    lattice.x = grid_nodes(g, lattice.n_nodes);
    lattice.triangles = grid_triangles(g, lattice.n_triangles);
    return finish(out, &lattice);
}

/* ---- square cells ---- */

/* Columns are placed symmetrically about x = 0; the lowest row has y = 0. */
static double *square_nodes(dem_index columns, dem_index rows, double spacing)
{
    double *x = lattice_zeros((columns + 1) * (rows + 1), 2 * sizeof *x), *next = x;
    for (dem_index r = 0; x != NULL && r <= rows; r++)
        for (dem_index c = 0; c <= columns; c++) {
            *next++ = (double)(2 * c - columns) * (0.5 * spacing);
            *next++ = (double)r * spacing;
        }
    return x;
}

/* Two triangles for each cell, next to each other in the list, as dem_lattice_assemble_squares() needs them. They meet
 * along one diagonal or the other by turns, as the fields of a chessboard, so that no direction is preferred. */
static dem_index *square_triangles(dem_index columns, dem_index rows)
{
    dem_index *triangles = lattice_zeros(2 * columns * rows, 3 * sizeof *triangles), *next = triangles;
    for (dem_index r = 0; triangles != NULL && r < rows; r++)
        for (dem_index c = 0; c < columns; c++) {
            const dem_index a = r * (columns + 1) + c, b = a + 1, d = a + columns + 1;
            /* The diagonal rises from a to d + 1, or falls from d to b. */
            const bool rising = (r + c) % 2 == 0;
            next = put_triangle(next, a, b, rising ? d + 1 : d);
            next = put_triangle(next, rising ? a : b, d + 1, d);
        }
    return triangles;
}

/* ---- equilateral triangles: shapes ---- */

/* Edges included; the caller has added what rounding may take. */
static bool is_in_disc(void *context, const double *x)
{
    const double *radius = context;
    return vec2_norm(vec2_at(x, 0)) <= *radius;
}

static dem_status check_rectangle(const dem_lattice *out, double width, double height, double spacing)
{
    TRY(lattice_check_out(out));
    CHECK(lattice_is_positive(spacing) && spacing <= width && spacing <= height && isfinite(width) && isfinite(height),
          DEM_ERROR_ARGUMENT, "a rectangle of %g m x %g m cannot have the spacing %g m", width, height, spacing);
    return DEM_OK;
}

/* `nodes` is a double, so that a number beyond 2^63 can be named. */
static dem_status check_size(double width, double height, double spacing, double nodes)
{
    CHECK(nodes <= max_nodes, DEM_ERROR_MODEL,
          "a rectangle of %g m x %g m with the spacing %g m would have %.3g nodes; the limit is %.3g", width, height,
          spacing, nodes, max_nodes);
    return DEM_OK;
}

/* ---- nodes moved at random ---- */

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

/* Signed area, m^2, of a triangle at the positions x. */
static double area_of(const double *x, const dem_index *corner)
{
    const vec2 a = vec2_at(x, corner[0]);
    return 0.5 * vec2_cross(vec2_sub(vec2_at(x, corner[1]), a), vec2_sub(vec2_at(x, corner[2]), a));
}

/* Jitter is measured by the areas before it, so these must be positive. */
static dem_status check_areas(const dem_lattice *l)
{
    for (dem_index t = 0; t < l->n_triangles; t++)
        CHECK(lattice_is_positive(area_of(l->x, l->triangles + 3 * t)), DEM_ERROR_MODEL,
              "triangle %lld has the area %g m^2; it must be > 0 to be jittered", (long long)t,
              area_of(l->x, l->triangles + 3 * t));
    return DEM_OK;
}

/* Marks the corners of triangles that have kept less than `least_area` of their area.  \return whether there are any */
static bool mark_squeezed(const dem_lattice *l, const double *x, unsigned char *marked)
{
    bool any = false;
    memset(marked, 0, (size_t)l->n_nodes);
    for (dem_index t = 0; t < l->n_triangles; t++) {
        const dem_index *corner = l->triangles + 3 * t;
        if (area_of(x, corner) >= least_area * area_of(l->x, corner)) continue;
        any = true;
        for (int c = 0; c < 3; c++) marked[corner[c]] = 1;
    }
    return any;
}

/* Moves the corners of such triangles half way back, all of them at once, until there are none: the order of triangles
 * does not matter. It ends, since the shifts of such corners go to 0 and their areas to what they were. */
static void move_back(const dem_lattice *l, double *x, unsigned char *marked)
{
    while (mark_squeezed(l, x, marked))
        for (dem_index i = 0; i < l->n_nodes; i++) {
            const vec2 before = vec2_at(l->x, i), shift = vec2_sub(vec2_at(x, i), before);
            if (marked[i] != 0) vec2_put(x, i, vec2_along(before, 0.5, shift));
        }
}

/* ---- public ---- */

/* Width and height are rounded to whole numbers of columns and rows. */
dem_status dem_lattice_rectangle(dem_lattice *out, double width, double height, double spacing)
{
    TRY(check_rectangle(out, width, height, spacing));
    const double columns = round(width / spacing), strips = round(height / (sqrt3_2 * spacing));
    TRY(check_size(width, height, spacing, (strips + 1.0) * (columns + 1.0)));
    /* The lowest row is wide and has y = 0. */
    const grid g = {.reach = (dem_index)columns, .first = 0, .last = (dem_index)strips, .spacing = spacing};
    return grid_lattice(out, &g);
}

/* Whole cells: width and height are rounded to multiples of the spacing. */
dem_status dem_lattice_squares(dem_lattice *out, double width, double height, double spacing)
{
    TRY(check_rectangle(out, width, height, spacing));
    const double columns = round(width / spacing), rows = round(height / spacing);
    TRY(check_size(width, height, spacing, (columns + 1.0) * (rows + 1.0)));
    dem_lattice lattice = dem_lattice_empty();
    lattice.n_nodes = ((dem_index)columns + 1) * ((dem_index)rows + 1);
    lattice.n_triangles = 2 * (dem_index)columns * (dem_index)rows;
    lattice.x = square_nodes((dem_index)columns, (dem_index)rows, spacing);
    lattice.triangles = square_triangles((dem_index)columns, (dem_index)rows);
    return finish(out, &lattice);
}

/* A grid around the disc, a column wider on each side, of which what is outside is cut. */
dem_status dem_lattice_disc(dem_lattice *out, double radius, double spacing)
{
    TRY(lattice_check_out(out));
    CHECK(lattice_is_positive(spacing) && spacing <= radius && isfinite(radius), DEM_ERROR_ARGUMENT,
          "a disc of radius %g m cannot have the spacing %g m", radius, spacing);
    double reach = radius + 1e-9 * spacing; /* a radius of whole spacings has its last nodes */
    const double steps = floor(reach / spacing), strips = floor(reach / (sqrt3_2 * spacing));
    const double nodes = (2.0 * strips + 1.0) * (2.0 * steps + 3.0);
    CHECK(nodes <= max_nodes, DEM_ERROR_MODEL,
          "a disc of radius %g m with the spacing %g m would have %.3g nodes; the limit is %.3g", radius, spacing,
          nodes, max_nodes);
    const dem_index columns = (dem_index)steps + 1, rows = (dem_index)strips;
    /* Rows and columns on both sides of the centre, where a node is. */
    const grid g = {.reach = 2 * columns, .first = -rows, .last = rows, .spacing = spacing};
    dem_lattice lattice = dem_lattice_empty();
    TRY(grid_lattice(&lattice, &g));
    const dem_status status = dem_lattice_cut(&lattice, is_in_disc, &reach);
    if (status == DEM_OK)
        lattice_give(out, &lattice);
    else
        dem_lattice_free(&lattice);
    return status;
}

/* A triangle stays if all its nodes do; nodes without a triangle go with the rest. */
dem_status dem_lattice_cut(dem_lattice *lattice, bool (*keep)(void *context, const double *x), void *context)
{
    TRY(lattice_check(lattice));
    CHECK(keep != NULL, DEM_ERROR_ARGUMENT, "keep is NULL");
    CHECK(lattice->n_springs == 0, DEM_ERROR_MODEL, "a lattice that has springs cannot be cut: %lld springs",
          (long long)lattice->n_springs);
    bool *stays = lattice_zeros(lattice->n_nodes, sizeof *stays);
    bool *whole = lattice_zeros(lattice->n_triangles, sizeof *whole);
    const bool complete = stays != NULL && whole != NULL;
    for (dem_index i = 0; complete && i < lattice->n_nodes; i++) stays[i] = keep(context, lattice->x + 2 * i);
    for (dem_index t = 0; complete && t < lattice->n_triangles; t++) {
        const dem_index *corner = lattice->triangles + 3 * t;
        whole[t] = stays[corner[0]] && stays[corner[1]] && stays[corner[2]];
    }
    const dem_status status =
        complete ? dem_lattice_trim(lattice, whole) : status_fail(DEM_ERROR_MEMORY, "out of memory");
    free(stays);
    free(whole);
    return status;
}

/* The shift of a node depends on its number and the seed alone, but for triangles that it would squeeze. */
dem_status dem_lattice_jitter(dem_lattice *lattice, double radius, uint64_t seed)
{
    TRY(lattice_check(lattice));
    CHECK(isfinite(radius) && radius >= 0.0, DEM_ERROR_ARGUMENT, "the radius of the jitter must be >= 0: %g m", radius);
    CHECK(lattice->n_springs == 0, DEM_ERROR_MODEL, "a lattice that has springs cannot be jittered: %lld springs",
          (long long)lattice->n_springs);
    CHECK(lattice->n_triangles > 0, DEM_ERROR_MODEL, "a lattice without triangles cannot be jittered");
    TRY(check_areas(lattice));
    unsigned char *rim = lattice_zeros(lattice->n_nodes, sizeof *rim);
    double *x = lattice_zeros(lattice->n_nodes, 2 * sizeof *x);
    dem_status status = rim != NULL && x != NULL ? mesh_edges_contact_flags(rim, lattice)
                                                 : status_fail(DEM_ERROR_MEMORY, "out of memory");
    for (dem_index i = 0; status == DEM_OK && i < lattice->n_nodes; i++) {
        const vec2 shift = rim[i] != 0 ? (vec2){0.0, 0.0} : random_shift(seed, i, radius);
        vec2_put(x, i, vec2_add(vec2_at(lattice->x, i), shift));
    }
    if (status == DEM_OK) {
        move_back(lattice, x, rim);
        double *const old = lattice->x;
        lattice->x = x;
        x = old;
    }
    free(rim);
    free(x);
    return status;
}
