/* SPDX-License-Identifier: BSD-3-Clause */
/* The finite-element rule that turns a triangulation, or square cells, into a solid: masses, springs, and what
 * triangles have themselves (docs/method.md, The solid). A triangle of area A gives each of its edges e the stiffness
 * (8/3) G h A/|e| (in N, as E_ij of equation (1)) and each corner a third of its mass. A square cell gives k/2 to its
 * sides and r k to its diagonals, with k = E h/(1 + nu) in N/m. The shares of a pair of nodes add up to its spring, so
 * that springs on a boundary or between two materials come out right by themselves. In a block of equilateral triangles
 * or squares the springs and the area term then give exactly E and nu. Where nodes and triangles come from is not here
 * but in generate.c and the programs; what a lattice must satisfy to move is checked in model/model.c. */
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
#include "lattice/triangle_share.h"

/* ---- materials ---- */

static bool is_positive(double value)
{
    return isfinite(value) && value > 0.0;
}

/* E and nu, or one stiffness for all springs, but not both. nu must be below 1 in plane stress and below 1/2 in plane
 * strain: there the material becomes incompressible. */
static dem_status check_elasticity(const dem_material *m)
{
    const double nu = m->poissons_ratio, highest = m->plane == DEM_PLANE_STRAIN ? 0.5 : 1.0;
    if (m->bond_stiffness != 0.0) {
        CHECK(is_positive(m->bond_stiffness), DEM_ERROR_ARGUMENT, "the bond stiffness must be > 0: %g N",
              m->bond_stiffness);
        CHECK(m->youngs_modulus == 0.0, DEM_ERROR_ARGUMENT,
              "a material has Young's modulus, %g Pa, or a bond stiffness, %g N, not both", m->youngs_modulus,
              m->bond_stiffness);
        return DEM_OK;
    }
    CHECK(is_positive(m->youngs_modulus), DEM_ERROR_ARGUMENT, "Young's modulus must be > 0: %g Pa", m->youngs_modulus);
    CHECK(m->plane == DEM_PLANE_STRESS || m->plane == DEM_PLANE_STRAIN, DEM_ERROR_ARGUMENT,
          "plane is %d, which is neither stress nor strain", (int)m->plane);
    CHECK(nu > -1.0 && nu < highest, DEM_ERROR_ARGUMENT, "Poisson's ratio must be in (-1, %g) in plane %s: %g", highest,
          m->plane == DEM_PLANE_STRAIN ? "strain" : "stress", nu);
    return DEM_OK;
}

/* What breaks it; 0: nothing does. */
static dem_status check_limits(const dem_material *m)
{
    CHECK(isfinite(m->strength) && m->strength >= 0.0, DEM_ERROR_ARGUMENT, "strength must be >= 0: %g Pa", m->strength);
    CHECK(isfinite(m->critical_stretch) && m->critical_stretch >= 0.0, DEM_ERROR_ARGUMENT,
          "critical_stretch must be >= 0: %g", m->critical_stretch);
    CHECK(isfinite(m->fracture_energy) && m->fracture_energy >= 0.0, DEM_ERROR_ARGUMENT,
          "fracture_energy must be >= 0: %g J/m^2", m->fracture_energy);
    CHECK(m->fracture_energy == 0.0 || (m->critical_stretch == 0.0 && m->bond_stiffness == 0.0), DEM_ERROR_ARGUMENT,
          "a fracture energy, %g J/m^2, goes neither with a critical stretch nor with a bond stiffness",
          m->fracture_energy);
    CHECK(m->stress_average == DEM_STRESS_AVERAGE_CORNERS || m->stress_average == DEM_STRESS_AVERAGE_ELEMENT,
          DEM_ERROR_ARGUMENT, "stress_average is %d, which is neither corners nor element", (int)m->stress_average);
    CHECK(m->stress_average == DEM_STRESS_AVERAGE_CORNERS || (m->strength > 0.0 && m->fracture_energy > 0.0),
          DEM_ERROR_ARGUMENT, "the stress of elements breaks them with a strength and a fracture energy only");
    CHECK(isfinite(m->compressive_strength) && m->compressive_strength >= 0.0, DEM_ERROR_ARGUMENT,
          "compressive_strength must be >= 0: %g Pa", m->compressive_strength);
    if (m->compressive_strength == 0.0) return DEM_OK;
    CHECK(m->strength > 0.0 && m->fracture_energy == 0.0, DEM_ERROR_ARGUMENT,
          "a compressive strength, %g Pa, goes with a strength, and without a fracture energy",
          m->compressive_strength);
    CHECK(m->compressive_strength >= m->strength, DEM_ERROR_ARGUMENT,
          "compressive_strength must be at least the strength, %g Pa: %g Pa", m->strength, m->compressive_strength);
    return DEM_OK;
}

/* What every rule of assembly needs: a mass and a thickness, and no negative guard or damping. */
static dem_status check_material(const dem_material *m)
{
    CHECK(m != NULL, DEM_ERROR_ARGUMENT, "material is NULL");
    TRY(check_elasticity(m));
    CHECK(m->springs == DEM_SPRINGS_INDEPENDENT || m->springs == DEM_SPRINGS_COUPLED, DEM_ERROR_ARGUMENT,
          "springs is %d, which is neither independent nor coupled", (int)m->springs);
    CHECK(m->springs == DEM_SPRINGS_INDEPENDENT || m->bond_stiffness == 0.0, DEM_ERROR_ARGUMENT,
          "springs of a given bond stiffness, %g N, cannot be coupled", m->bond_stiffness);
    CHECK(is_positive(m->density), DEM_ERROR_ARGUMENT, "density must be > 0: %g kg/m^3", m->density);
    CHECK(is_positive(m->thickness), DEM_ERROR_ARGUMENT, "thickness must be > 0: %g m", m->thickness);
    CHECK(isfinite(m->guard) && m->guard >= 0.0, DEM_ERROR_ARGUMENT, "guard must be >= 0: %g", m->guard);
    CHECK(isfinite(m->damping_time) && m->damping_time >= 0.0, DEM_ERROR_ARGUMENT, "damping_time must be >= 0: %g s",
          m->damping_time);
    return check_limits(m);
}

/* The plate in plane stress that moves like the solid: all formulas below are for plane stress. */
typedef struct plate {
    double modulus, ratio; /* E h, N/m; nu */
} plate;

/* Plane strain is plane stress with E/(1 - nu^2) and nu/(1 - nu). With a given stiffness of springs E and nu are
 * unknown. */
static plate plate_of(const dem_material *m)
{
    const double nu = m->poissons_ratio, modulus = m->youngs_modulus * m->thickness;
    if (m->bond_stiffness > 0.0) return (plate){0.0, 0.0};
    if (m->plane == DEM_PLANE_STRESS) return (plate){modulus, nu};
    return (plate){modulus / (1.0 - nu * nu), nu / (1.0 - nu)};
}

/* (8/3) G h = (4/3) E h/(1 + nu), N/m, which is E h at nu = 1/3, to the bit. */
static double spring_modulus(plate p)
{
    return p.modulus * ((4.0 / 3.0) / (1.0 + p.ratio));
}

/* A cell warps when its corners move by turns along the same direction. Both diagonals keep their lengths; the sides
 * resist alone, and the areas of the two triangles change by the same amount, one up, one down. The stiffness of this
 * is
 *     k + 2 kappa = E h ((1 + nu) - 2 r (1 - nu))/(1 - nu^2),
 * which is positive if r < (1 + nu)/(2 (1 - nu)). Bodies whose cells are stable are stable. */
static dem_status check_diagonal(plate p, double diagonal)
{
    const double limit = 0.5 * (1.0 + p.ratio) / (1.0 - p.ratio);
    CHECK(
        diagonal < limit, DEM_ERROR_ARGUMENT,
        "the stiffness of a diagonal over a side's must be less than %g, or cells warp, at Poisson's ratio %g in plane "
        "stress: %g",
        limit, p.ratio, diagonal);
    return DEM_OK;
}

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

/* A limit that is not given is never reached. */
static double limit_or_never(double given)
{
    return given > 0.0 ? given : (double)INFINITY;
}

/* The nodes of a share are in ascending order, so that both triangles at an edge name its spring alike. Kelvin-Voigt: a
 * strain rate e' acts like the strain damping_time e'. */
static share share_of(dem_index i, dem_index j, double stiffness, const dem_material *m)
{
    return (share){i < j ? i : j, i < j ? j : i, stiffness, m->damping_time * stiffness,
                   limit_or_never(m->critical_stretch)};
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
    const double modulus = spring_modulus(plate_of(m)), area = area_of(d->lattice, corner[0], corner[1], corner[2]);
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
    const plate p = plate_of(m);
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
        CHECK(is_positive(area), DEM_ERROR_MODEL,
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

/* kappa, N/m: what the springs leave of C12 h = nu E h/(1 - nu^2), to which diagonals give r E h/(1 + nu). At r = 1/2,
 * which is isotropic, it is (lambda - G) h and 0 at nu = 1/3, to the bit. With equal springs there is none. */
static double area_modulus(const draft *d, const dem_material *m)
{
    const plate p = plate_of(m);
    const double nu = p.ratio, r = d->diagonal;
    return m->bond_stiffness > 0.0 ? 0.0 : p.modulus * ((1.0 + r) * nu - r) / (1.0 - nu * nu);
}

/* N/m; 0 in cells and in equilateral triangles. */
static void fill_couplings(draft *d)
{
    for (dem_index t = 0; t < d->lattice->n_triangles && !d->cells; t++) {
        const triangle_share own = share_of_triangle(d, t);
        const double modulus = spring_modulus(plate_of(material_of(d, t)));
        for (int c = 0; c < 3; c++) d->solid.coupling[3 * t + c] = modulus * own.coupling[c];
    }
}

/* The modulus of the plate in plane stress that moves like the solid, Pa. */
static double plate_modulus(const dem_material *m)
{
    return plate_of(m).modulus / m->thickness;
}

static bool is_own(const dem_material *m)
{
    return m->stress_average == DEM_STRESS_AVERAGE_ELEMENT;
}

static const crack_band *band_of(const draft *d, const dem_material *m)
{
    return crack_band_of(d->cells ? CRACK_BAND_CELLS : is_own(m) ? CRACK_BAND_OWN_STRESS : CRACK_BAND_CORNERS);
}

/* Strength and softening of a triangle. */
static void limit_triangle(draft *d, dem_index t)
{
    const dem_material *m = material_of(d, t);
    const dem_index *c = d->lattice->triangles + 3 * t;
    const crack_band *band = band_of(d, m);
    const double modulus = plate_modulus(m), energy = m->fracture_energy;
    const double size = crack_band_size(area_of(d->lattice, c[0], c[1], c[2]));
    d->solid.strength[t] = limit_or_never(m->strength);
    d->solid.softening[t] = 1.0;
    if (energy > 0.0 && m->strength > 0.0)
        d->solid.softening[t] = crack_band_softening_of(band, modulus * energy / (m->strength * m->strength * size));
    else if (energy > 0.0)
        d->solid.strength[t] = crack_band_strength(band, modulus, energy, size);
    d->solid.compressive_strength[t] = limit_or_never(m->compressive_strength);
    d->solid.confinement[t] =
        m->plane == DEM_PLANE_STRAIN && m->compressive_strength > 0.0 ? m->compressive_strength / m->strength : 0.0;
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
    for (dem_index t = 0; t < n && !any; t++) any = is_own(material_of(d, t));
    if (!any) return DEM_OK;
    CHECK(lattice_has_own_stress(d->lattice), DEM_ERROR_ARGUMENT,
          "dem_lattice: struct_size is %zu, without room for own_stress", d->lattice->struct_size);
    d->solid.own_stress = lattice_zeros(n, sizeof *d->solid.own_stress);
    CHECK_MEMORY(d->solid.own_stress);
    for (dem_index t = 0; t < n; t++) d->solid.own_stress[t] = is_own(material_of(d, t));
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
        s->area_stiffness[t] = area_modulus(d, m);
        s->thickness[t] = m->thickness;
        /* Triangles share the stress of a spring as they have given to its stiffness: by (8/3) G h A. */
        s->modulus[t] = spring_modulus(plate_of(m)) / m->thickness;
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
        TRY(check_material(m));
        CHECK(n_materials == 1 || m->bond_stiffness == 0.0, DEM_ERROR_ARGUMENT,
              "a bond stiffness, %g N, is for bodies of one material", m->bond_stiffness);
        CHECK(!d->cells || m->springs == DEM_SPRINGS_INDEPENDENT, DEM_ERROR_ARGUMENT,
              "coupled springs are those of triangles, but cells are asked for");
        CHECK(!d->cells || m->stress_average == DEM_STRESS_AVERAGE_CORNERS, DEM_ERROR_ARGUMENT,
              "the stress of elements breaks triangles, but cells are asked for");
        if (d->cells && m->bond_stiffness == 0.0) TRY(check_diagonal(plate_of(m), d->diagonal));
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

/* Strength and fracture energy together need small triangles. */
static dem_status check_sizes(const draft *d, dem_index n_materials)
{
    for (dem_index k = 0; k < n_materials; k++) {
        const dem_material *m = &d->materials[k];
        if (!(m->fracture_energy > 0.0 && m->strength > 0.0)) continue;
        const double size = mean_size(d, m), edge = d->cells ? sqrt(0.5 * sqrt(3.0)) : 1.0;
        const double coarsest = crack_band_coarsest(band_of(d, m), plate_modulus(m), m->fracture_energy, m->strength);
        CHECK(size <= coarsest, DEM_ERROR_ARGUMENT,
              "%s of %g m are too large for a strength of %g Pa and a fracture energy of %g J/m^2, which need %g m at "
              "most",
              d->cells ? "squares" : "triangles with edges", edge * size, m->strength, m->fracture_energy,
              edge * coarsest);
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
    CHECK(!cells || is_positive(diagonal), DEM_ERROR_ARGUMENT,
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
    CHECK(is_positive(diagonal), DEM_ERROR_ARGUMENT, "the stiffness of a diagonal over a side's must be > 0: %g",
          diagonal);
    return dem_lattice_assemble_mixed(lattice, material, 1, NULL, diagonal);
}
