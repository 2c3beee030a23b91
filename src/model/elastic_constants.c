/* SPDX-License-Identifier: BSD-3-Clause */
/* Elastic constants of a body, measured and not taken from its deck (docs/method.md, The solid, Constants). All
 * boundary nodes are displaced by a uniform strain, the nodes inside find their equilibrium, and with u_i the
 * displacements of case i and K the tangent stiffness
 *     C_ij = u_i.K u_j/V,
 * the second derivative of the energy over the volume V. Three strains (xx, yy and the shear gamma_xy = 1) give the
 * whole matrix. E and nu are those of the isotropic plate nearest to C. The solver is in tangent_stiffness.c. What is
 * measured is the material, not the shape: pores are held at their rims. */
#include <stdlib.h>

#include "base/exact_terms.h"
#include "base/reduce.h"
#include "base/status.h"
#include "base/struct_size.h"
#include "lattice/lattice.h"
#include "lattice/mesh_edges.h"
#include "model/spring_share.h"
#include "model/tangent_stiffness.h"

/* Residual over the forces of the uniformly strained body. The error of C is of second order: found to be 5e-8 for a
 * lattice of 1e5 nodes jittered by a fifth of the spacing, at a sixth of the cost of 1e-6. */
static const double accepted = 1e-4;

/* The cases, in the order of the rows of C. */
enum { XX, YY, XY, N_CASES };

/* The work in hand; nodes of other bodies have no displacements. */
typedef struct loading {
    const dem_model *model;
    dem_index body;
    double volume, mass;    /* m^3, kg */
    vec2 centre;            /* m, of the nodes */
    unsigned char *held;    /* [n] all but the inside of the body */
    double *u[N_CASES];     /* [n][2] displacements of each case, m */
    double *force[N_CASES]; /* [n][2] K u, N */
} loading;

static bool is_of_body(const loading *l, dem_index i)
{
    return l->model->lattice.body[i] == l->body;
}

/* ---- the body ---- */

/* The nodes inside the body are those of its triangles that no boundary edge has. All others are held. */
static dem_status find_inside(loading *l)
{
    const dem_lattice *lattice = &l->model->lattice;
    mesh_edges s;
    for (dem_index i = 0; i < lattice->n_nodes; i++) l->held[i] = 1;
    for (dem_index k = 0; k < 3 * lattice->n_triangles; k++)
        if (is_of_body(l, lattice->triangles[k])) l->held[lattice->triangles[k]] = 0;
    TRY(mesh_edges_create(&s, lattice));
    for (dem_index i = 0; i < lattice->n_nodes; i++)
        for (dem_index p = s.row[i]; p < s.row[i + 1]; p++) {
            /* A slot that is the only one of its edge: the edge is on the boundary. */
            const bool last = p + 1 == s.row[i + 1] || mesh_edges_is_first(&s, i, p + 1);
            if (mesh_edges_is_first(&s, i, p) && last) l->held[i] = l->held[s.list[p].upper] = 1;
        }
    mesh_edges_free(&s);
    return DEM_OK;
}

/* Volume, from the thickness and area of the triangles at rest; mass; and mean place of the body's nodes. */
static dem_status measure(loading *l)
{
    const dem_lattice *lattice = &l->model->lattice;
    exact_sum volume = {0}, mass = {0}, places[2] = {{.n_terms = 0}};
    dem_index n = 0;
    for (dem_index k = 0; k < lattice->n_triangles; k++)
        if (is_of_body(l, lattice->triangles[3 * k])) exact_sum_add(&volume, spring_share_volume(lattice, k));
    l->volume = reduce_sum(l->model->ranks, &volume);
    CHECK(l->volume > 0.0, DEM_ERROR_MODEL, "the body has no triangles, whose volume its constants refer to");
    for (dem_index i = 0; i < lattice->n_nodes; i++) {
        if (!is_of_body(l, i)) continue;
        exact_sum_add(&mass, lattice->mass[i]);
        for (int c = 0; c < 2; c++) exact_sum_add(&places[c], lattice->x[2 * i + c]);
        n++;
    }
    l->mass = reduce_sum(l->model->ranks, &mass);
    l->centre = (vec2){reduce_sum(l->model->ranks, &places[0]), reduce_sum(l->model->ranks, &places[1])};
    l->centre = vec2_scale(1.0 / (double)reduce_count(l->model->ranks, n), l->centre);
    return DEM_OK;
}

/* ---- the loading ---- */

/* e d for the unit strain of a case. The shear is shared by both components: e_xy = 1/2, and no turning. */
static vec2 strained(int which, vec2 d)
{
    if (which == XX) return (vec2){d.x, 0.0};
    if (which == YY) return (vec2){0.0, d.y};
    return (vec2){0.5 * d.y, 0.5 * d.x};
}

/* Displaces the body uniformly and lets the inside relax: u becomes u + w, where w is 0 on held nodes and K w = -K u on
 * the others. `force` is K u first, the right-hand side and w in between, and K (u + w) at the end. The residual left
 * is `accepted` times the norm of the forces of the uniform strain. */
static dem_status load(loading *l, int which)
{
    const dem_lattice *lattice = &l->model->lattice;
    double *u = l->u[which], *force = l->force[which];
    for (dem_index i = 0; i < lattice->n_nodes; i++)
        if (is_of_body(l, i)) vec2_put(u, i, strained(which, vec2_sub(vec2_at(lattice->x, i), l->centre)));
    tangent_apply(l->model, lattice->x, u, force);
    const exact_sum square = exact_terms_product(force, force, 2 * lattice->n_nodes);
    for (dem_index k = 0; k < 2 * lattice->n_nodes; k++) force[k] = -force[k];
    TRY(tangent_solve(l->model, lattice->x, l->held, accepted * sqrt(reduce_sum(l->model->ranks, &square)), force));
    for (dem_index k = 0; k < 2 * lattice->n_nodes; k++) u[k] += force[k];
    tangent_apply(l->model, lattice->x, u, force);
    return DEM_OK;
}

/* u.K v/V, Pa. At equilibrium the energy is stationary in the displacements inside, so that their errors enter as
 * products. */
static double stiffness_of(const loading *l, const double *u, const double *force)
{
    const exact_sum sum = exact_terms_product(u, force, 2 * l->model->lattice.n_nodes);
    return reduce_sum(l->model->ranks, &sum) / l->volume;
}

/* ---- what follows from C ---- */

/* The compliance along the direction (c, s), 1/E = a.C^-1 a with a = (c^2, s^2, c s) the stress of uniaxial tension.
 * The adjugate of C stands for its inverse: the determinant cancels in the ratio that is asked for. */
static double compliance_along(double C[3][3], double angle)
{
    const double c = cos(angle), s = sin(angle), a[3] = {c * c, s * s, c * s};
    double sum = 0.0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            sum += a[i] * a[j] * (C[i1][j1] * C[i2][j2] - C[i1][j2] * C[i2][j1]);
        }
    return sum;
}

/* Largest over smallest Young's modulus along a direction. */
static double anisotropy_of(double C[3][3])
{
    const int n_directions = 360; /* over half a turn, both axes and both diagonals among them */
    const double half_turn = acos(-1.0);
    double least = INFINITY, most = 0.0;
    for (int k = 0; k < n_directions; k++) {
        const double compliance = compliance_along(C, half_turn * k / n_directions);
        least = fmin(least, compliance);
        most = fmax(most, compliance);
    }
    return most / least;
}

/* Averages of C over all directions are the constants of the nearest isotropic plate: with B = lambda + G its bulk
 * modulus in two dimensions, E = 4 B G/(B + G), nu = (B - G)/(B + G), and C11 = B + G gives the speed of longitudinal
 * waves. */
static dem_status conclude(const loading *l, dem_constants *out)
{
    double(*C)[3] = out->stiffness;
    const double bulk = 0.25 * (C[0][0] + C[1][1] + 2.0 * C[0][1]);
    const double shear = 0.125 * (C[0][0] + C[1][1] - 2.0 * C[0][1] + 4.0 * C[2][2]), density = l->mass / l->volume;
    CHECK(bulk > 0.0 && shear > 0.0, DEM_ERROR_MODEL,
          "the body is not stable: its bulk and shear modulus are %g and %g Pa", bulk, shear);
    out->youngs_modulus = 4.0 * bulk * shear / (bulk + shear);
    out->poissons_ratio = (bulk - shear) / (bulk + shear);
    out->anisotropy = anisotropy_of(C);
    out->longitudinal_speed = sqrt((bulk + shear) / density);
    out->transverse_speed = sqrt(shear / density);
    out->volume = l->volume;
    return DEM_OK;
}

/* C comes out symmetric up to rounding, since K is. */
static dem_status run(loading *l, dem_constants *out)
{
    TRY(measure(l));
    TRY(find_inside(l));
    for (int k = 0; k < N_CASES; k++) TRY(load(l, k));
    for (int i = 0; i < N_CASES; i++)
        for (int j = 0; j < N_CASES; j++) out->stiffness[i][j] = stiffness_of(l, l->u[i], l->force[j]);
    return conclude(l, out);
}

/* All vectors are one allocation. *out is written only if everything has gone well. */
dem_status dem_model_constants(const dem_model *model, dem_index body, dem_constants *out)
{
    CHECK(model != NULL && out != NULL, DEM_ERROR_ARGUMENT, "dem_model_constants: %s is NULL", model ? "out" : "model");
    CHECK(model->ranks->size == 1, DEM_ERROR_ARGUMENT,
          "dem_model_constants: %d ranks share the model, of which each has a part alone", model->ranks->size);
    TRY(status_check_number("body", body, model->n_bodies));
    TRY(model_rows_renew(model));
    for (dem_index k = 0; k < model->rigid.n; k++)
        CHECK(model->rigid.list[k].number != body, DEM_ERROR_MODEL, "body %lld is rigid: it has no elastic constants",
              (long long)body);
    const dem_index n = model->lattice.n_nodes;
    loading l = {.model = model, .body = body, .held = lattice_zeros(n, sizeof *l.held)};
    double *vectors = lattice_zeros(2 * N_CASES * n, 2 * sizeof *vectors);
    dem_constants found = {0};
    dem_status status = DEM_ERROR_MEMORY;
    if (vectors == NULL || l.held == NULL) {
        (void)status_fail(status, "out of memory for %lld nodes", (long long)n);
    } else {
        for (int k = 0; k < N_CASES; k++) {
            l.u[k] = vectors + 2 * n * k;
            l.force[k] = vectors + 2 * n * (N_CASES + k);
        }
        status = run(&l, &found);
        if (status == DEM_OK) status = struct_size_write(&STRUCT_KIND(dem_constants), out, &found);
    }
    free(vectors);
    free(l.held);
    return status;
}
