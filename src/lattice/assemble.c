/* SPDX-License-Identifier: BSD-3-Clause */
/* The finite-element rule that turns a triangulation, or square cells, into a solid: masses, springs, and what
 * triangles have themselves (docs/method.md, The solid). A triangle of area A gives each of its edges e the stiffness
 * (8/3) G h A/|e| (in N, as E_ij of equation (1)) and each corner a third of its mass. A square cell gives k/2 to its
 * sides and r k to its diagonals, with k = E h/(1 + nu) in N/m. The shares of a pair of nodes add up to its spring, so
 * that springs on a boundary or between two materials come out right by themselves. In a block of equilateral triangles
 * or squares the springs and the area term then give exactly E and nu. What of a material is for this is in
 * solid_material.c, where nodes and triangles come from in generate.c and the programs; what a lattice must satisfy to
 * move is checked in model/model.c. */
#include <dem/dem.h>

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "base/status.h"
#include "base/struct_size.h"
#include "base/vec2.h"
#include "lattice/cell.h"
#include "lattice/crack_band.h"
#include "lattice/lattice.h"
#include "lattice/solid_material.h"
#include "lattice/triangle_share.h"

/* ---- the rule ---- */

/* What a triangle or a cell gives to the spring of two nodes, N. */
typedef struct share {
    dem_index lower, upper;
    double stiffness, viscosity; /* N, N s */
    double critical_stretch;
} share;

/* The work in hand. The caller's lattice is changed only at the end, when nothing can fail any more. */
typedef struct draft {
    const dem_lattice *lattice;
    const dem_material *materials;
    const dem_index *of; /* [n_triangles] number of each triangle's material; NULL: the first */
    bool cells;          /* of two triangles each, 2 k and 2 k + 1 */
    double diagonal;     /* stiffness of a diagonal over a side's, both in N/m; 1/2 is isotropic, as triangles are */
    share *shares;       /* [3 n_triangles] */
    dem_lattice solid;
} draft;

static const dem_material *material_of(const draft *d, dem_index t)
{
    return &d->materials[d->of != NULL ? d->of[t] : 0];
}

/* Signed area, m^2: positive for counter-clockwise corners. */
static double area_of(const dem_lattice *l, dem_index a, dem_index b, dem_index c)
{
    return vec2_triangle_area(vec2_at(l->x, a), vec2_at(l->x, b), vec2_at(l->x, c));
}

static double distance(const dem_lattice *l, dem_index i, dem_index j)
{
    return vec2_norm(vec2_sub(vec2_at(l->x, j), vec2_at(l->x, i)));
}

/* The nodes of a share are in ascending order, so that both triangles at an edge name its spring alike. Kelvin-Voigt: a
 * strain rate e' acts like the strain damping_time e'. */
static share share_of(dem_index i, dem_index j, double stiffness, const dem_material *m)
{
    return (share){i < j ? i : j, i < j ? j : i, stiffness, m->damping_time * stiffness,
                   solid_material_critical_stretch(m)};
}

/* A third of `weight` times the mass of a triangle to each of its corners, kg. */
static void give_mass(const draft *d, double weight, const dem_material *m, const dem_index corner[3])
{
    const double area = area_of(d->lattice, corner[0], corner[1], corner[2]);
    const double mass = weight * m->density * m->thickness * area / 3.0;
    for (int c = 0; c < 3; c++) d->solid.mass[corner[c]] += mass;
}

/* What the triangle gives to its edges over what an equilateral one would. */
static triangle_share share_of_triangle(const draft *d, dem_index t)
{
    const dem_index *c = d->lattice->triangles + 3 * t;
    const double *x = d->lattice->x;
    if (material_of(d, t)->springs == DEM_SPRINGS_INDEPENDENT) return triangle_share_independent();
    return triangle_share_coupled((const vec2[]){vec2_at(x, c[0]), vec2_at(x, c[1]), vec2_at(x, c[2])});
}

/* (8/3) G h A/|e| to each edge, times its weight. The energy of the three springs, and of their couplings, under a
 * uniform strain is that of Hooke's law at nu = 1/3; the area term adds what other ratios need. */
static void share_triangle(const draft *d, dem_index t)
{
    const dem_index *corner = d->lattice->triangles + 3 * t;
    const dem_material *m = material_of(d, t);
    const triangle_share own = share_of_triangle(d, t);
    const double modulus = solid_material_spring_modulus(m),
                 area = area_of(d->lattice, corner[0], corner[1], corner[2]);
    for (int c = 0; c < 3; c++) {
        const dem_index i = corner[c], j = corner[(c + 1) % 3];
        d->shares[3 * t + c] = share_of(i, j, own.weight[c] * (modulus * area / distance(d->lattice, i, j)), m);
    }
    give_mass(d, 1.0, m, corner);
}

/* The stiffness, N, is that in N/m times the rest length: k/2 times the length to each side, r k times the length to
 * both diagonals. A side between two cells thus has k. Mass is shared out for all four triangles of three successive
 * corners, with half weight: these are the two ways to cut the cell, and a square gets a quarter at each corner. */
static dem_status share_cell(const draft *d, dem_index k)
{
    const dem_lattice *l = d->lattice;
    const dem_material *m = material_of(d, 2 * k);
    /* In N/m; times a length it is a stiffness of springs in N. */
    const solid_plate p = solid_material_plate(m);
    const double side = p.modulus / (1.0 + p.ratio), diagonal = d->diagonal * side;
    dem_index q[4];
    CHECK(m == material_of(d, 2 * k + 1), DEM_ERROR_MODEL, "triangles %lld and %lld, of a cell, have two materials",
          (long long)(2 * k), (long long)(2 * k + 1));
    CHECK(cell_corners(l, 2 * k, 2 * k + 1, q), DEM_ERROR_MODEL,
          "triangles %lld and %lld, which are to be a cell, share no edge", (long long)(2 * k), (long long)(2 * k + 1));
    CHECK(cell_is_convex(l, q), DEM_ERROR_MODEL, "the cell of nodes %lld, %lld, %lld and %lld is not convex",
          (long long)q[0], (long long)q[1], (long long)q[2], (long long)q[3]);
    for (int c = 0; c < 4; c++) {
        const dem_index i = q[c], j = q[(c + 1) % 4], corner[3] = {i, j, q[(c + 2) % 4]};
        /* k/2 in N/m times the rest length. */
        d->shares[6 * k + c] = share_of(i, j, 0.5 * side * distance(l, i, j), m);
        give_mass(d, 0.5, m, corner);
    }
    for (int c = 0; c < 2; c++)
        d->shares[6 * k + 4 + c] = share_of(q[c], q[c + 2], diagonal * distance(l, q[c], q[c + 2]), m);
    return DEM_OK;
}

/* Every triangle must have a positive area, and every node a triangle: otherwise it would have no mass. */
static dem_status share_all(const draft *d)
{
    const dem_lattice *l = d->lattice;
    for (dem_index t = 0; t < l->n_triangles; t++) {
        const dem_index *corner = l->triangles + 3 * t;
        const double area = area_of(l, corner[0], corner[1], corner[2]);
        CHECK(lattice_is_positive(area), DEM_ERROR_MODEL,
              "triangle %lld (nodes %lld, %lld, %lld) has the area %g m^2; it must be > 0", (long long)t,
              (long long)corner[0], (long long)corner[1], (long long)corner[2], area);
        if (!d->cells) share_triangle(d, t);
    }
    for (dem_index k = 0; k < l->n_triangles / 2 && d->cells; k++) TRY(share_cell(d, k));
    for (dem_index i = 0; i < l->n_nodes; i++)
        CHECK(d->solid.mass[i] > 0.0, DEM_ERROR_MODEL, "node %lld belongs to no triangle", (long long)i);
    return DEM_OK;
}

/* ---- springs ---- */

static bool is_of_one_spring(const share *a, const share *b)
{
    return a->lower == b->lower && a->upper == b->upper;
}

/* Sorts by lower, then upper node: buckets of the lower node, each sorted by insertion since it is short. Shares of one
 * spring keep the order of the triangles, so that their sum has the same bits whenever the triangles have that
 * order. */
static dem_status sort_shares(draft *d)
{
    const dem_index n = d->lattice->n_nodes, m = 3 * d->lattice->n_triangles;
    dem_index *row = lattice_zeros(n + 2, sizeof *row);
    share *sorted = lattice_zeros(m, sizeof *sorted);
    const bool complete = row != NULL && sorted != NULL;
    for (dem_index k = 0; k < m && complete; k++) row[d->shares[k].lower + 2]++;
    for (dem_index i = 0; i < n && complete; i++) row[i + 2] += row[i + 1];
    for (dem_index k = 0; k < m && complete; k++) {
        const share current = d->shares[k];
        /* row[lower + 1] is where the bucket goes on. Upper nodes that are higher move up by one place. */
        dem_index p = row[current.lower + 1]++;
        for (; p > row[current.lower] && sorted[p - 1].lower == current.lower && sorted[p - 1].upper > current.upper;
             p--)
            sorted[p] = sorted[p - 1];
        sorted[p] = current;
    }
    free(row);
    if (complete) {
        free(d->shares);
        d->shares = sorted;
    } else {
        free(sorted);
    }
    CHECK(complete, DEM_ERROR_MEMORY, "out of memory for %lld springs", (long long)m / 2);
    return DEM_OK;
}

/* With a given bond stiffness all springs have it, whatever their triangles gave: the paper's lattices. */
static void make_equal(dem_lattice *solid, const dem_material *m)
{
    for (dem_index k = 0; k < solid->n_springs && m->bond_stiffness > 0.0; k++) {
        solid->stiffness[k] = m->bond_stiffness;
        solid->viscosity[k] = m->damping_time * m->bond_stiffness;
    }
}

/* An array of which all items are the usual number, 0 or "never", becomes NULL, which stands for it: later code then
 * skips damping, guard, area term or fracture altogether. */
static void drop_equal(double **array, dem_index n, double usual)
{
    for (dem_index k = 0; k < n; k++)
        if ((*array)[k] != usual) return;
    free(*array);
    *array = NULL;
}

/* One spring for each run of equal pairs among the sorted shares; their stiffnesses and viscosities are summed up, and
 * it breaks when the first of them does. */
static dem_status fill_springs(draft *d)
{
    const dem_index m = 3 * d->lattice->n_triangles;
    dem_lattice *s = &d->solid;
    TRY(sort_shares(d));
    for (dem_index p = 0; p < m; p++) s->n_springs += p == 0 || !is_of_one_spring(&d->shares[p - 1], &d->shares[p]);
    s->ends = lattice_zeros(s->n_springs, 2 * sizeof *s->ends);
    s->rest_length = lattice_zeros(s->n_springs, sizeof *s->rest_length);
    s->stiffness = lattice_zeros(s->n_springs, sizeof *s->stiffness);
    s->viscosity = lattice_zeros(s->n_springs, sizeof *s->viscosity);
    s->critical_stretch = lattice_zeros(s->n_springs, sizeof *s->critical_stretch);
    CHECK(s->ends && s->rest_length && s->stiffness && s->viscosity && s->critical_stretch, DEM_ERROR_MEMORY,
          "out of memory for %lld springs", (long long)s->n_springs);
    /* k is the spring of the share at p, which begins where the pair of nodes changes. */
    for (dem_index p = 0, k = -1; p < m; p++) {
        const share *here = &d->shares[p];
        if (p == 0 || !is_of_one_spring(here - 1, here)) {
            s->ends[2 * ++k] = here->lower;
            s->ends[2 * k + 1] = here->upper;
            s->rest_length[k] = distance(d->lattice, here->lower, here->upper);
            s->critical_stretch[k] = here->critical_stretch;
        }
        s->stiffness[k] += here->stiffness;
        s->viscosity[k] += here->viscosity;
        s->critical_stretch[k] = fmin(s->critical_stretch[k], here->critical_stretch);
    }
    make_equal(s, d->materials);
    drop_equal(&s->viscosity, s->n_springs, 0.0);
    drop_equal(&s->critical_stretch, s->n_springs, (double)INFINITY);
    return DEM_OK;
}

/* ---- triangles ---- */

/* E h of a triangle, N/m, for the strength of its guard. With equal springs it is estimated: inside a lattice a spring
 * has shares of two triangles, E_ij = 2 E h A/|e|, so that E h = E_ij |e|/(2 A) with the mean edge |e| =
 * perimeter/3. */
static double modulus_of(const draft *d, dem_index t)
{
    const dem_index *c = d->lattice->triangles + 3 * t;
    const dem_material *m = material_of(d, t);
    double perimeter = 0.0;
    if (m->bond_stiffness == 0.0) return m->youngs_modulus * m->thickness;
    /* The two shares inside a lattice, with |e| the mean edge: E h = E_ij (perimeter/3)/(2 A). */
    for (int k = 0; k < 3; k++) perimeter += distance(d->lattice, c[k], c[(k + 1) % 3]);
    return m->bond_stiffness * perimeter / (6.0 * area_of(d->lattice, c[0], c[1], c[2]));
}

/* N/m; 0 in cells and in equilateral triangles. */
static void fill_couplings(draft *d)
{
    for (dem_index t = 0; t < d->lattice->n_triangles && !d->cells; t++) {
        const triangle_share own = share_of_triangle(d, t);
        const double modulus = solid_material_spring_modulus(material_of(d, t));
        for (int c = 0; c < 3; c++) d->solid.coupling[3 * t + c] = modulus * own.coupling[c];
    }
}

static void limit_triangle(draft *d, dem_index t)
{
    const dem_index *c = d->lattice->triangles + 3 * t;
    const solid_limits own = solid_material_limits(material_of(d, t), d->cells, area_of(d->lattice, c[0], c[1], c[2]));
    d->solid.strength[t] = own.strength;
    d->solid.softening[t] = own.softening;
    d->solid.compressive_strength[t] = own.compressive_strength;
    d->solid.confinement[t] = own.confinement;
}

/* What limits pressure stays only where something does. */
static dem_status keep_pressure_limits(draft *d)
{
    const dem_index n = d->lattice->n_triangles;
    dem_lattice *s = &d->solid;
    drop_equal(&s->compressive_strength, n, (double)INFINITY);
    drop_equal(&s->confinement, n, 0.0);
    CHECK(s->compressive_strength == NULL || lattice_has_pressure_limits(d->lattice), DEM_ERROR_ARGUMENT,
          "dem_lattice: struct_size is %zu, without room for compressive strengths", d->lattice->struct_size);
    return DEM_OK;
}

/* Which triangles break by their own stress, if any do. */
static dem_status fill_own_stress(draft *d)
{
    const dem_index n = d->lattice->n_triangles;
    bool any = false;
    for (dem_index t = 0; t < n && !any; t++) any = solid_material_breaks_by_own_stress(material_of(d, t));
    if (!any) return DEM_OK;
    CHECK(lattice_has_own_stress(d->lattice), DEM_ERROR_ARGUMENT,
          "dem_lattice: struct_size is %zu, without room for own_stress", d->lattice->struct_size);
    d->solid.own_stress = lattice_zeros(n, sizeof *d->solid.own_stress);
    CHECK_MEMORY(d->solid.own_stress);
    for (dem_index t = 0; t < n; t++) d->solid.own_stress[t] = solid_material_breaks_by_own_stress(material_of(d, t));
    return DEM_OK;
}

/* What breaks triangles by their stress. */
static dem_status fill_limits(draft *d)
{
    const dem_index n = d->lattice->n_triangles;
    dem_lattice *s = &d->solid;
    s->strength = lattice_zeros(n, sizeof *s->strength);
    s->softening = lattice_zeros(n, sizeof *s->softening);
    s->compressive_strength = lattice_zeros(n, sizeof *s->compressive_strength);
    s->confinement = lattice_zeros(n, sizeof *s->confinement);
    CHECK(s->strength && s->softening && s->compressive_strength && s->confinement, DEM_ERROR_MEMORY,
          "out of memory for the strengths of %lld triangles", (long long)n);
    for (dem_index t = 0; t < n; t++) limit_triangle(d, t);
    drop_equal(&s->strength, n, (double)INFINITY);
    drop_equal(&s->softening, n, 1.0);
    CHECK((s->strength == NULL && s->critical_stretch == NULL) || lattice_has_limits(d->lattice), DEM_ERROR_ARGUMENT,
          "dem_lattice: struct_size is %zu, without room for strengths", d->lattice->struct_size);
    CHECK(s->softening == NULL || lattice_has_softening(d->lattice), DEM_ERROR_ARGUMENT,
          "dem_lattice: struct_size is %zu, without room for softening", d->lattice->struct_size);
    TRY(keep_pressure_limits(d));
    return fill_own_stress(d);
}

/* Guard, area term, couplings, thickness and the modulus by which stresses share springs out (model/stress.c). */
static dem_status fill_triangles(draft *d)
{
    const dem_index n = d->lattice->n_triangles;
    dem_lattice *s = &d->solid;
    s->guard = lattice_zeros(n, sizeof *s->guard);
    s->area_stiffness = lattice_zeros(n, sizeof *s->area_stiffness);
    s->thickness = lattice_zeros(n, sizeof *s->thickness);
    s->modulus = lattice_zeros(n, sizeof *s->modulus);
    s->coupling = lattice_zeros(3 * n, sizeof *s->coupling);
    CHECK(s->guard && s->area_stiffness && s->thickness && s->modulus && s->coupling, DEM_ERROR_MEMORY,
          "out of memory for %lld triangles", (long long)n);
    for (dem_index t = 0; t < n; t++) {
        const dem_material *m = material_of(d, t);
        s->guard[t] = m->guard * modulus_of(d, t);
        s->area_stiffness[t] = solid_material_area_modulus(m, d->diagonal);
        s->thickness[t] = m->thickness;
        /* Triangles share the stress of a spring as they have given to its stiffness: by (8/3) G h A. */
        s->modulus[t] = solid_material_spring_modulus(m) / m->thickness;
    }
    TRY(fill_limits(d));
    fill_couplings(d);
    drop_equal(&s->coupling, 3 * n, 0.0);
    CHECK(s->coupling == NULL || lattice_has_couplings(d->lattice), DEM_ERROR_ARGUMENT,
          "dem_lattice: struct_size is %zu, without room for couplings", d->lattice->struct_size);
    drop_equal(&s->guard, n, 0.0);
    drop_equal(&s->area_stiffness, n, 0.0);
    drop_equal(&s->modulus, n, 0.0);
    return DEM_OK;
}

/* ---- all of it ---- */

static void swap(double **a, double **b)
{
    double *const old = *a;
    *a = *b;
    *b = old;
}

/* The limits of triangles stay if the solid has none. */
static void give_limits(dem_lattice *lattice, dem_lattice *solid)
{
    if (lattice_has_limits(lattice)) swap(&lattice->critical_stretch, &solid->critical_stretch);
    if (solid->strength == NULL) return;
    swap(&lattice->strength, &solid->strength);
    if (lattice_has_softening(lattice)) swap(&lattice->softening, &solid->softening);
    if (!lattice_has_pressure_limits(lattice)) return;
    swap(&lattice->compressive_strength, &solid->compressive_strength);
    swap(&lattice->confinement, &solid->confinement);
    if (!lattice_has_own_stress(lattice)) return;
    unsigned char *const old = lattice->own_stress;
    lattice->own_stress = solid->own_stress;
    solid->own_stress = old;
}

/* Hands the arrays of a solid over to the caller's lattice; `solid` gets the old ones and is freed with them. */
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
    if (lattice_has_couplings(lattice)) swap(&lattice->coupling, &solid->coupling);
    give_limits(lattice, solid);
}

/* Shares first, then springs made of them, then triangles. */
static dem_status draw(draft *d)
{
    d->shares = lattice_zeros(3 * d->lattice->n_triangles, sizeof *d->shares);
    d->solid.mass = lattice_zeros(d->lattice->n_nodes, sizeof *d->solid.mass);
    CHECK(d->shares && d->solid.mass, DEM_ERROR_MEMORY, "out of memory for %lld nodes", (long long)d->lattice->n_nodes);
    TRY(share_all(d));
    TRY(fill_springs(d));
    return fill_triangles(d);
}

/* A bond stiffness belongs to the whole lattice, hence to bodies of one material. */
static dem_status check_materials(const draft *d, dem_index n_materials)
{
    CHECK(n_materials > 0, DEM_ERROR_ARGUMENT, "the number of materials must be > 0: %lld", (long long)n_materials);
    for (dem_index k = 0; k < n_materials; k++) {
        const dem_material *m = d->materials != NULL ? d->materials + k : NULL;
        TRY(d->cells ? solid_material_check_cells(m, d->diagonal) : solid_material_check(m));
        CHECK(n_materials == 1 || m->bond_stiffness == 0.0, DEM_ERROR_ARGUMENT,
              "a bond stiffness, %g N, is for bodies of one material", m->bond_stiffness);
    }
    for (dem_index t = 0; d->of != NULL && t < d->lattice->n_triangles; t++)
        CHECK(d->of[t] >= 0 && d->of[t] < n_materials, DEM_ERROR_ARGUMENT,
              "triangle %lld has material %lld, but there are %lld", (long long)t, (long long)d->of[t],
              (long long)n_materials);
    return DEM_OK;
}

/* The edge of an equilateral triangle of the mean area of those of a material, m; 0 if there are none. */
static double mean_size(const draft *d, const dem_material *m)
{
    const dem_index *c = d->lattice->triangles;
    double sum = 0.0;
    dem_index n = 0;
    for (dem_index t = 0; t < d->lattice->n_triangles; t++) {
        if (material_of(d, t) != m) continue;
        sum += area_of(d->lattice, c[3 * t], c[3 * t + 1], c[3 * t + 2]);
        n++;
    }
    return n > 0 ? crack_band_size(sum / (double)n) : 0.0;
}

static dem_status check_sizes(const draft *d, dem_index n_materials)
{
    for (dem_index k = 0; k < n_materials; k++) {
        const dem_material *m = &d->materials[k];
        if (solid_material_softens(m)) TRY(solid_material_check_size(m, d->cells, mean_size(d, m)));
    }
    return DEM_OK;
}

/* Springs that are there already would be lost, since assembling makes all of them. */
static dem_status check_lattice(const dem_lattice *lattice, bool cells)
{
    TRY(lattice_check(lattice));
    CHECK(lattice->n_springs == 0, DEM_ERROR_MODEL, "the lattice already has %lld springs",
          (long long)lattice->n_springs);
    CHECK(lattice->n_triangles > 0, DEM_ERROR_MODEL, "a lattice without triangles cannot be assembled");
    CHECK(!cells || lattice->n_triangles % 2 == 0, DEM_ERROR_MODEL, "%lld triangles do not pair up to cells",
          (long long)lattice->n_triangles);
    return DEM_OK;
}

/* On failure the lattice is as it was. */
static dem_status assemble(dem_lattice *lattice, draft *d, dem_index n_materials)
{
    TRY(check_lattice(d->lattice, d->cells));
    TRY(check_materials(d, n_materials));
    TRY(check_sizes(d, n_materials));
    d->solid = dem_lattice_empty();
    const dem_status status = draw(d);
    if (status == DEM_OK) give(lattice, &d->solid);
    dem_lattice_free(&d->solid);
    free(d->shares);
    return status;
}

/* `damping_time` is the last member of the first version. */
static const struct_kind kind = {"dem_material", STRUCT_SIZE_WITH(dem_material, damping_time), sizeof(dem_material)};

/* diagonal = 0 asks for triangles, which have the isotropic 1/2 where formulas need it. */
dem_status dem_lattice_assemble_mixed(dem_lattice *lattice, const dem_material *materials, dem_index n_materials,
                                      const dem_index *of, double diagonal)
{
    const bool cells = diagonal != 0.0;
    void *own = NULL;
    CHECK(!cells || lattice_is_positive(diagonal), DEM_ERROR_ARGUMENT,
          "the stiffness of a diagonal over a side's must be > 0: %g", diagonal);
    if (materials != NULL && n_materials > 0) TRY(struct_size_read_array(&kind, &own, materials, n_materials));
    draft d = {.lattice = lattice, .materials = own, .of = of, .cells = cells, .diagonal = cells ? diagonal : 0.5};
    const dem_status status = assemble(lattice, &d, n_materials);
    free(own);
    return status;
}

dem_status dem_lattice_assemble(dem_lattice *lattice, const dem_material *material)
{
    return dem_lattice_assemble_mixed(lattice, material, 1, NULL, 0.0);
}

dem_status dem_lattice_assemble_squares(dem_lattice *lattice, const dem_material *material, double diagonal)
{
    CHECK(lattice_is_positive(diagonal), DEM_ERROR_ARGUMENT,
          "the stiffness of a diagonal over a side's must be > 0: %g", diagonal);
    return dem_lattice_assemble_mixed(lattice, material, 1, NULL, diagonal);
}
