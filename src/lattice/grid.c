/* SPDX-License-Identifier: BSD-3-Clause */
/* Whoever needs some rows of a triangulation makes these alone, by the loops that make all of them: a row follows from
 * its number. Coordinates are whole multiples of half a spacing, and of the height of a row, rounded once, so that they
 * are mirror symmetric to the bit. */
#include "lattice/grid.h"

#include <math.h>
#include <stdlib.h>

#include "base/status.h"
#include "base/vec2.h"
#include "lattice/lattice.h"

static const double max_nodes = 1099511627776.0; /* 2^40: no byte count of an array overflows */
/* Height of a row of equilateral triangles, in spacings. */
static const double sqrt3_2 = 0.86602540378443864676;

/* ---- rows ---- */

/* Wide rows have a node more than others. */
static bool is_wide(const grid *g, dem_index row)
{
    return g->is_square || row % 2 == 0;
}

grid grid_between(const grid *whole, dem_index first, dem_index last)
{
    grid rows = *whole;
    rows.first = first > whole->first ? first : whole->first;
    rows.last = last < whole->last ? last : whole->last;
    return rows;
}

double grid_height(const grid *g)
{
    return g->is_square ? g->spacing : sqrt3_2 * g->spacing;
}

/* A row counts `reach` nodes, and a wide one one more. Every other row of triangles is wide. */
dem_index grid_count_nodes(const grid *g)
{
    const dem_index rows = g->last - g->first + 1;
    const dem_index wide = g->is_square ? rows : (rows + (is_wide(g, g->first) ? 1 : 0)) / 2;
    return rows > 0 ? rows * g->reach + wide : 0;
}

dem_index grid_count_triangles(const grid *g)
{
    const dem_index in_strip = g->is_square ? 2 * g->reach : 2 * g->reach - 1;
    return g->last > g->first ? (g->last - g->first) * in_strip : 0;
}

dem_index grid_nodes_below(const grid *g, dem_index row)
{
    const grid before = grid_between(g, g->first, row - 1);
    return grid_count_nodes(&before);
}

dem_index grid_triangles_below(const grid *g, dem_index row)
{
    const grid strips = grid_between(g, g->first, row);
    return grid_count_triangles(&strips);
}

static double *make_nodes(const grid *g)
{
    const double height = grid_height(g);
    double *x = lattice_zeros(grid_count_nodes(g), 2 * sizeof *x), *next = x;
    for (dem_index row = g->first; x != NULL && row <= g->last; row++) {
        const dem_index reach = is_wide(g, row) ? g->reach : g->reach - 1;
        for (dem_index s = -reach; s <= reach; s += 2) {
            *next++ = (double)s * (0.5 * g->spacing);
            *next++ = (double)row * height;
        }
    }
    return x;
}

/* ---- triangles ---- */

static dem_index *put_triangle(dem_index *next, dem_index i, dem_index j, dem_index k)
{
    next[0] = i;
    next[1] = j;
    next[2] = k;
    return next + 3;
}

/* Between two rows, of which one is wider. `low` and `high` are the first nodes of the lower and the upper row. */
static dem_index *put_equilateral(const grid *g, dem_index *next, bool wide, dem_index low, dem_index high)
{
    for (dem_index k = 0; k < g->reach; k++) { /* on the wider row, then on the narrower */
        next = wide ? put_triangle(next, low + k, low + k + 1, high + k)
                    : put_triangle(next, low + k, high + k + 1, high + k);
        if (k + 1 == g->reach) break;
        next = wide ? put_triangle(next, low + k + 1, high + k + 1, high + k)
                    : put_triangle(next, low + k, low + k + 1, high + k + 1);
    }
    return next;
}

/* Two triangles for each cell, next to each other in the list, as dem_lattice_assemble_squares() needs them. They meet
 * along one diagonal or the other by turns, as the fields of a chessboard, so that no direction is preferred. */
static dem_index *put_squares(const grid *g, dem_index *next, dem_index row, dem_index low, dem_index high)
{
    for (dem_index c = 0; c < g->reach; c++) {
        const dem_index a = low + c, b = a + 1, d = high + c;
        /* The diagonal rises from a to d + 1, or falls from d to b. */
        const bool rising = (row + c) % 2 == 0;
        next = put_triangle(next, a, b, rising ? d + 1 : d);
        next = put_triangle(next, rising ? a : b, d + 1, d);
    }
    return next;
}

/* Strip by strip; node numbers begin with the first row. */
static dem_index *make_triangles(const grid *g)
{
    dem_index *triangles = lattice_zeros(grid_count_triangles(g), 3 * sizeof *triangles), *next = triangles, low = 0;
    for (dem_index row = g->first; triangles != NULL && row < g->last; row++) {
        const bool wide = is_wide(g, row);
        const dem_index high = low + g->reach + (wide ? 1 : 0);
        next = g->is_square ? put_squares(g, next, row, low, high) : put_equilateral(g, next, wide, low, high);
        low = high;
    }
    return triangles;
}

/* ---- sizes ---- */

static dem_status check_rectangle(double width, double height, double spacing)
{
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

/* The lowest row is wide. */
dem_status grid_of_rectangle(grid *out, double width, double height, double spacing)
{
    TRY(check_rectangle(width, height, spacing));
    const double columns = round(width / spacing), strips = round(height / (sqrt3_2 * spacing));
    TRY(check_size(width, height, spacing, (strips + 1.0) * (columns + 1.0)));
    *out = (grid){.reach = (dem_index)columns, .last = (dem_index)strips, .spacing = spacing};
    return DEM_OK;
}

dem_status grid_of_squares(grid *out, double width, double height, double spacing)
{
    TRY(check_rectangle(width, height, spacing));
    const double columns = round(width / spacing), rows = round(height / spacing);
    TRY(check_size(width, height, spacing, (columns + 1.0) * (rows + 1.0)));
    *out = (grid){.is_square = true, .reach = (dem_index)columns, .last = (dem_index)rows, .spacing = spacing};
    return DEM_OK;
}

/* Rows and columns on both sides of the centre, where a node is. */
dem_status grid_around_disc(grid *out, double reach, double spacing)
{
    const double steps = floor(reach / spacing), strips = floor(reach / (sqrt3_2 * spacing));
    const double nodes = (2.0 * strips + 1.0) * (2.0 * steps + 3.0);
    CHECK(nodes <= max_nodes, DEM_ERROR_MODEL,
          "a disc of radius %g m with the spacing %g m would have %.3g nodes; the limit is %.3g", reach, spacing, nodes,
          max_nodes);
    const dem_index columns = (dem_index)steps + 1, rows = (dem_index)strips;
    *out = (grid){.reach = 2 * columns, .first = -rows, .last = rows, .spacing = spacing};
    return DEM_OK;
}

/* The caller has added to the reach what rounding may take. */
bool grid_disc_has(void *reach, const double *x)
{
    return vec2_norm(vec2_at(x, 0)) <= *(const double *)reach;
}

/* ---- lattice ---- */

dem_status grid_lattice(dem_lattice *out, const grid *g)
{
    dem_lattice lattice = dem_lattice_empty();
    lattice.n_nodes = grid_count_nodes(g);
    lattice.n_triangles = grid_count_triangles(g);
    lattice.x = make_nodes(g);
    lattice.triangles = make_triangles(g);
    if (lattice.x == NULL || lattice.triangles == NULL) {
        const dem_index n = lattice.n_nodes;
        dem_lattice_free(&lattice);
        return status_fail(DEM_ERROR_MEMORY, "out of memory for %lld nodes", (long long)n);
    }
    *out = lattice;
    return DEM_OK;
}
