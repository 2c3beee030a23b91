/* SPDX-License-Identifier: BSD-3-Clause */
/* Equilateral triangulations of simple shapes, holes in them, and the springs and masses that make them a solid. */
#include <dem/dem.h>

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "lattice.h"
#include "sides.h"
#include "status.h"
#include "vec2.h"

static const double max_nodes = 1099511627776.0; /* 2^40: no byte count of an array overflows */
static const double sqrt3_2 = 0.86602540378443864676;

/* ---- equilateral triangulations ---- */

/* Rows first <= 0 .. last >= 0 of an equilateral grid. Nodes are at x = s spacing/2 with whole s, |s| <= reach; s has
 * the parity of reach in even rows, the other one in odd rows. So x is mirror symmetric to the bit. */
typedef struct grid {
    dem_index reach, first, last;
    double spacing;
} grid;

static bool is_wide(dem_index row)
{
    return row % 2 == 0;
}

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

static dem_index *grid_triangles(const grid *g, dem_index n)
{
    dem_index *triangles = lattice_zeros(n, 3 * sizeof *triangles), *next = triangles, low = 0;
    if (triangles == NULL) return NULL;
    for (dem_index row = g->first; row < g->last; row++) {
        const bool wide = is_wide(row);
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

static dem_status grid_lattice(dem_lattice *out, const grid *g)
{
    const dem_index wide = g->last / 2 - g->first / 2 + 1;
    dem_lattice lattice;
    dem_lattice_init(&lattice);
    lattice.n_nodes = (g->last - g->first + 1) * g->reach + wide;
    lattice.n_triangles = (g->last - g->first) * (2 * g->reach - 1);
    lattice.x = grid_nodes(g, lattice.n_nodes);
    lattice.triangles = grid_triangles(g, lattice.n_triangles);
    if (lattice.x == NULL || lattice.triangles == NULL) {
        dem_lattice_free(&lattice);
        return status_fail(DEM_ERROR_MEMORY, "out of memory for %lld nodes", (long long)lattice.n_nodes);
    }
    *out = lattice;
    return DEM_OK;
}

static int is_in_disc(void *context, const double x[2])
{
    const double *radius = context;
    return vec2_norm(vec2_at(x, 0)) <= *radius;
}

/* ---- springs and masses of a triangulation ---- */

static double area_of(const dem_lattice *lattice, dem_index t)
{
    const dem_index *corner = lattice->triangles + 3 * t;
    const vec2 a = vec2_at(lattice->x, corner[0]), b = vec2_at(lattice->x, corner[1]),
               c = vec2_at(lattice->x, corner[2]);
    return 0.5 * vec2_cross(vec2_sub(b, a), vec2_sub(c, a));
}

static bool is_positive(double value)
{
    return isfinite(value) && value > 0.0;
}

static dem_status check_ratio(const dem_material *material)
{
    const double nu = material->poissons_ratio, highest = material->plane == DEM_PLANE_STRAIN ? 0.5 : 1.0;
    CHECK(material->plane == DEM_PLANE_STRESS || material->plane == DEM_PLANE_STRAIN, DEM_ERROR_ARGUMENT,
          "plane is %d, which is neither stress nor strain", (int)material->plane);
    CHECK(nu > -1.0 && nu < highest, DEM_ERROR_ARGUMENT, "Poisson's ratio must be in (-1, %g) in plane %s: %g", highest,
          material->plane == DEM_PLANE_STRAIN ? "strain" : "stress", nu);
    return DEM_OK;
}

static dem_status check_material(const dem_material *material)
{
    CHECK(material != NULL, DEM_ERROR_ARGUMENT, "material is NULL");
    CHECK(is_positive(material->youngs_modulus), DEM_ERROR_ARGUMENT, "Young's modulus must be > 0: %g Pa",
          material->youngs_modulus);
    TRY(check_ratio(material));
    CHECK(is_positive(material->density), DEM_ERROR_ARGUMENT, "density must be > 0: %g kg/m^3", material->density);
    CHECK(is_positive(material->thickness), DEM_ERROR_ARGUMENT, "thickness must be > 0: %g m", material->thickness);
    CHECK(isfinite(material->guard) && material->guard >= 0.0, DEM_ERROR_ARGUMENT, "guard must be >= 0: %g",
          material->guard);
    CHECK(isfinite(material->damping_time) && material->damping_time >= 0.0, DEM_ERROR_ARGUMENT,
          "damping_time must be >= 0: %g s", material->damping_time);
    return DEM_OK;
}

/* The plate in plane stress that moves like the solid. */
typedef struct plate {
    double modulus, ratio; /* E h, N/m; nu */
} plate;

static plate plate_of(const dem_material *m)
{
    const double nu = m->poissons_ratio, modulus = m->youngs_modulus * m->thickness;
    if (m->plane == DEM_PLANE_STRESS) return (plate){modulus, nu};
    return (plate){modulus / (1.0 - nu * nu), nu / (1.0 - nu)};
}

/* 8/3 G h, which is E h at nu = 1/3, to the bit. */
static double spring_modulus(plate p)
{
    return p.modulus * ((4.0 / 3.0) / (1.0 + p.ratio));
}

/* kappa = (lambda - G) h, which is 0 at nu = 1/3, to the bit. */
static double area_modulus(plate p)
{
    return p.modulus * (3.0 * p.ratio - 1.0) / (2.0 * (1.0 - p.ratio * p.ratio));
}

static dem_status fill_masses(double *mass, const dem_lattice *lattice, const dem_material *material)
{
    for (dem_index t = 0; t < lattice->n_triangles; t++) {
        const dem_index *corner = lattice->triangles + 3 * t;
        const double area = area_of(lattice, t);
        CHECK(is_positive(area), DEM_ERROR_MODEL,
              "triangle %lld (nodes %lld, %lld, %lld) has the area %g m^2; it must be > 0", (long long)t,
              (long long)corner[0], (long long)corner[1], (long long)corner[2], area);
        for (int c = 0; c < 3; c++) mass[corner[c]] += material->density * material->thickness * area / 3.0;
    }
    for (dem_index i = 0; i < lattice->n_nodes; i++)
        CHECK(mass[i] > 0.0, DEM_ERROR_MODEL, "node %lld belongs to no triangle", (long long)i);
    return DEM_OK;
}

static dem_index count_edges(const sides *edges, dem_index n_nodes)
{
    dem_index n = 0;
    for (dem_index i = 0; i < n_nodes; i++)
        for (dem_index p = edges->row[i]; p < edges->row[i + 1]; p++) n += sides_edge_begins(edges, i, p);
    return n;
}

static void fill_springs(dem_lattice *solid, const sides *edges, const dem_lattice *lattice, double modulus)
{
    dem_index k = -1;
    double length = 0.0;
    for (dem_index i = 0; i < lattice->n_nodes; i++)
        for (dem_index p = edges->row[i]; p < edges->row[i + 1]; p++) {
            const dem_index j = edges->list[p].upper;
            if (sides_edge_begins(edges, i, p)) {
                length = vec2_norm(vec2_sub(vec2_at(lattice->x, j), vec2_at(lattice->x, i)));
                solid->ends[2 * ++k] = i;
                solid->ends[2 * k + 1] = j;
                solid->rest_length[k] = length;
            }
            solid->stiffness[k] += modulus * area_of(lattice, edges->list[p].triangle) / length; /* 8/3 G h A/|e| */
        }
}

/* Kelvin-Voigt: a strain rate e' acts like the strain damping_time e'. */
static dem_status fill_viscosity(dem_lattice *solid, double damping_time)
{
    if (damping_time == 0.0) return DEM_OK;
    solid->viscosity = lattice_zeros(solid->n_springs, sizeof *solid->viscosity);
    CHECK_MEMORY(solid->viscosity);
    for (dem_index k = 0; k < solid->n_springs; k++) solid->viscosity[k] = damping_time * solid->stiffness[k];
    return DEM_OK;
}

/* An array of one strength for all triangles; none where that is 0. */
static dem_status fill_triangles(double **array, dem_index n_triangles, double strength)
{
    if (strength == 0.0) return DEM_OK;
    *array = lattice_zeros(n_triangles, sizeof **array);
    CHECK_MEMORY(*array);
    for (dem_index t = 0; t < n_triangles; t++) (*array)[t] = strength;
    return DEM_OK;
}

static void swap(double **a, double **b)
{
    double *const old = *a;
    *a = *b;
    *b = old;
}

/* Hands the arrays of a solid over; `solid` gets the old ones. */
static void give(dem_lattice *lattice, dem_lattice *solid)
{
    dem_index *const old = lattice->ends;
    lattice->n_springs = solid->n_springs;
    lattice->ends = solid->ends;
    solid->ends = old;
    swap(&lattice->mass, &solid->mass);
    swap(&lattice->rest_length, &solid->rest_length);
    swap(&lattice->stiffness, &solid->stiffness);
    swap(&lattice->viscosity, &solid->viscosity);
    swap(&lattice->guard, &solid->guard);
    swap(&lattice->area_stiffness, &solid->area_stiffness);
    swap(&lattice->thickness, &solid->thickness);
    swap(&lattice->modulus, &solid->modulus);
}

/* Into `solid`, which the caller frees after a failure: masses, springs, their damping, what triangles have. */
static dem_status assemble(dem_lattice *solid, const dem_lattice *lattice, const dem_material *material)
{
    const plate p = plate_of(material);
    sides edges;
    solid->mass = lattice_zeros(lattice->n_nodes, sizeof *solid->mass);
    CHECK_MEMORY(solid->mass);
    TRY(fill_masses(solid->mass, lattice, material));
    TRY(fill_triangles(&solid->guard, lattice->n_triangles,
                       material->guard * material->youngs_modulus * material->thickness));
    TRY(fill_triangles(&solid->area_stiffness, lattice->n_triangles, area_modulus(p)));
    TRY(fill_triangles(&solid->thickness, lattice->n_triangles, material->thickness));
    TRY(fill_triangles(&solid->modulus, lattice->n_triangles, spring_modulus(p) / material->thickness));
    TRY(sides_create(&edges, lattice));
    solid->n_springs = count_edges(&edges, lattice->n_nodes);
    solid->ends = lattice_zeros(solid->n_springs, 2 * sizeof *solid->ends);
    solid->rest_length = lattice_zeros(solid->n_springs, sizeof *solid->rest_length);
    solid->stiffness = lattice_zeros(solid->n_springs, sizeof *solid->stiffness);
    const bool complete = solid->ends != NULL && solid->rest_length != NULL && solid->stiffness != NULL;
    if (complete) fill_springs(solid, &edges, lattice, spring_modulus(p));
    sides_free(&edges);
    CHECK(complete, DEM_ERROR_MEMORY, "out of memory for %lld springs", (long long)solid->n_springs);
    return fill_viscosity(solid, material->damping_time);
}

dem_status dem_lattice_rectangle(dem_lattice *out, double width, double height, double spacing)
{
    CHECK(out != NULL, DEM_ERROR_ARGUMENT, "out is NULL");
    CHECK(is_positive(spacing) && spacing <= width && spacing <= height && isfinite(width) && isfinite(height),
          DEM_ERROR_ARGUMENT, "a rectangle of %g m x %g m cannot have the spacing %g m", width, height, spacing);
    const double columns = round(width / spacing), strips = round(height / (sqrt3_2 * spacing));
    const double nodes = (strips + 1.0) * (columns + 1.0);
    CHECK(nodes <= max_nodes, DEM_ERROR_MODEL,
          "a rectangle of %g m x %g m with the spacing %g m would have %.3g nodes; the limit is %.3g", width, height,
          spacing, nodes, max_nodes);
    const grid g = {.reach = (dem_index)columns, .first = 0, .last = (dem_index)strips, .spacing = spacing};
    return grid_lattice(out, &g);
}

dem_status dem_lattice_disc(dem_lattice *out, double radius, double spacing)
{
    CHECK(out != NULL, DEM_ERROR_ARGUMENT, "out is NULL");
    CHECK(is_positive(spacing) && spacing <= radius && isfinite(radius), DEM_ERROR_ARGUMENT,
          "a disc of radius %g m cannot have the spacing %g m", radius, spacing);
    double reach = radius + 1e-9 * spacing; /* a radius of whole spacings has its last nodes */
    const double steps = floor(reach / spacing), strips = floor(reach / (sqrt3_2 * spacing));
    const double nodes = (2.0 * strips + 1.0) * (2.0 * steps + 3.0);
    CHECK(nodes <= max_nodes, DEM_ERROR_MODEL,
          "a disc of radius %g m with the spacing %g m would have %.3g nodes; the limit is %.3g", radius, spacing,
          nodes, max_nodes);
    const dem_index columns = (dem_index)steps + 1, rows = (dem_index)strips;
    const grid g = {.reach = 2 * columns, .first = -rows, .last = rows, .spacing = spacing};
    dem_lattice lattice;
    TRY(grid_lattice(&lattice, &g));
    const dem_status status = dem_lattice_cut(&lattice, is_in_disc, &reach);
    if (status == DEM_OK)
        *out = lattice;
    else
        dem_lattice_free(&lattice);
    return status;
}

dem_status dem_lattice_cut(dem_lattice *lattice, int (*keep)(void *context, const double x[2]), void *context)
{
    TRY(lattice_check(lattice));
    CHECK(keep != NULL, DEM_ERROR_ARGUMENT, "keep is NULL");
    CHECK(lattice->n_springs == 0, DEM_ERROR_MODEL, "a lattice that has springs cannot be cut: %lld springs",
          (long long)lattice->n_springs);
    unsigned char *stays = lattice_zeros(lattice->n_nodes, sizeof *stays);
    unsigned char *whole = lattice_zeros(lattice->n_triangles, sizeof *whole);
    const bool complete = stays != NULL && whole != NULL;
    for (dem_index i = 0; complete && i < lattice->n_nodes; i++) stays[i] = keep(context, lattice->x + 2 * i) != 0;
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

dem_status dem_lattice_assemble(dem_lattice *lattice, const dem_material *material)
{
    dem_lattice solid;
    TRY(lattice_check(lattice));
    TRY(check_material(material));
    CHECK(lattice->n_springs == 0, DEM_ERROR_MODEL, "the lattice already has %lld springs",
          (long long)lattice->n_springs);
    CHECK(lattice->n_triangles > 0, DEM_ERROR_MODEL, "a lattice without triangles cannot be assembled");
    dem_lattice_init(&solid);
    const dem_status status = assemble(&solid, lattice, material);
    if (status == DEM_OK) give(lattice, &solid);
    dem_lattice_free(&solid);
    return status;
}
