/* SPDX-License-Identifier: BSD-3-Clause */
/* The highest angular frequency about the rest shape, by Lanczos iteration on A = M^-1/2 K M^-1/2: in the basis q_1,
 * q_2, ... of the iterates A is tridiagonal, with `diagonal` and `beside` it, and the largest eigenvalue theta of this
 * matrix rises to that of A, omega^2. Some eigenvalue of A is within the residual beside_m |s_m| of theta, where s is
 * the unit eigenvector of the tridiagonal matrix. No orthogonalisation is needed for the largest eigenvalue alone. The
 * rigorous upper bound, which limits steps, is cheaper and not here: frequency_bound() in model_scales.c. */
#include <stdlib.h>

#include "base/exact_terms.h"
#include "base/random.h"
#include "base/reduce.h"
#include "base/status.h"
#include "domain/halo.h"
#include "lattice/lattice.h"
#include "model/tangent_stiffness.h"

enum { most_iterations = 2000 };

static const double accepted = 1e-6; /* residual over theta; the error of theta is of the order of its square */

/* The iteration; nothing of it grows with the number of iterations but the tridiagonal matrix. */
typedef struct lanczos {
    const dem_model *model;
    dem_index m;                      /* iterations */
    double diagonal[most_iterations]; /* 1/s^2 */
    double beside[most_iterations];   /* beside[k] joins k and k + 1 */
    double *vector, *last;            /* [n][2] q_m, q_(m-1) */
    double *scaled, *image;           /* [n][2] */
    halo halo;                        /* of a model that ranks share */
} lanczos;

/* ---- the tridiagonal matrix ---- */

/* Whether an eigenvalue is above x. x - T is positive definite if and only if all pivots of its factorisation are. */
static bool is_below_the_largest(const lanczos *l, double x)
{
    double pivot = x - l->diagonal[0];
    for (dem_index k = 1; k < l->m && pivot > 0.0; k++)
        pivot = x - l->diagonal[k] - l->beside[k - 1] * l->beside[k - 1] / pivot;
    return !(pivot > 0.0);
}

/* The largest eigenvalue by bisection to the last bit, between 0 and the bound of Gershgorin's circles. */
static double largest_of(const lanczos *l)
{
    double low = 0.0, high = 0.0; /* Gershgorin's circles */
    for (dem_index k = 0; k < l->m; k++)
        high = fmax(high, l->diagonal[k] + (k > 0 ? l->beside[k - 1] : 0.0) + (k + 1 < l->m ? l->beside[k] : 0.0));
    while (true) {
        const double middle = 0.5 * (low + high);
        if (!(middle > low && middle < high)) return high;
        if (is_below_the_largest(l, middle))
            low = middle;
        else
            high = middle;
    }
}

/* |s_m| of the unit eigenvector of theta. Row k of T s = theta s gives
 *     s_(k-1) = ((theta - diagonal_k) s_k - beside_k s_(k+1))/beside_(k-1),
 * from the last row upwards: in this direction the components grow, and rounding errors with them die out. Where they
 * have fallen to 1e-3 of their peak, the rest adds nothing to the norm. */
static double last_component(const lanczos *l, double theta)
{
    double here = 1.0, below = 0.0, squares = 1.0, peak = 1.0;
    for (dem_index k = l->m - 1; k > 0 && fabs(here) > 1e-3 * peak; k--) {
        const double above =
            ((theta - l->diagonal[k]) * here - (k + 1 < l->m ? l->beside[k] * below : 0.0)) / l->beside[k - 1];
        below = here;
        here = above;
        squares += here * here;
        peak = fmax(peak, fabs(here));
    }
    return 1.0 / sqrt(squares);
}

/* ---- the iteration ---- */

/* Over own nodes. */
static double product(const lanczos *l, const double *a, const double *b)
{
    const dem_model *model = l->model;
    exact_sum sum = {0};
    for (dem_index i = 0, end; i < model->lattice.n_nodes; i = end) {
        if (!domain_run(model->domain, i, model->lattice.n_nodes, &end)) continue;
        exact_sum part = exact_terms_product(a + 2 * i, b + 2 * i, 2 * (end - i));
        exact_sum_join(&sum, &part);
    }
    return reduce_sum(model->ranks, &sum);
}

/* A random unit vector, so that every mode is in it; 0 where a node is fixed. The seed is constant: every run finds the
 * same bits. Each number is drawn without those before it, so that who has which nodes does not matter. */
static void start(lanczos *l)
{
    for (dem_index k = 0; k < 2 * l->model->lattice.n_nodes; k++) {
        const dem_index number = 2 * model_node(l->model, k / 2) + k % 2;
        uint64_t state = 1 + (uint64_t)number * random_stride;
        const double value = random_next(&state);
        l->vector[k] = l->model->inverse_mass[k / 2] > 0.0 ? value : 0.0;
    }
    const double size = sqrt(product(l, l->vector, l->vector));
    for (dem_index k = 0; k < 2 * l->model->lattice.n_nodes && size > 0.0; k++) l->vector[k] /= size;
}

/* image = M^-1/2 K M^-1/2 vector. Of ghosts the owners have what neighbours need. */
static void apply(lanczos *l)
{
    const dem_model *model = l->model;
    const dem_index n = model->lattice.n_nodes;
    for (dem_index i = 0; i < n; i++)
        vec2_put(l->scaled, i, vec2_scale(sqrt(model->inverse_mass[i]), vec2_at(l->vector, i)));
    if (model->domain != NULL) halo_exchange(&l->halo, &l->scaled, 1);
    tangent_apply(model, model->lattice.x, l->scaled, l->image);
    for (dem_index i = 0; i < n; i++)
        vec2_put(l->image, i, vec2_scale(sqrt(model->inverse_mass[i]), vec2_at(l->image, i)));
}

/* One iteration: the image A q_m, less what it has of q_m and q_(m-1), is beside_m q_(m+1).
 * \return beside_m, the size of what is left */
static double next(lanczos *l)
{
    const dem_index n = 2 * l->model->lattice.n_nodes;
    /* `here` is q_m.A q_m, the next number on the diagonal. */
    const double before = l->m > 0 ? l->beside[l->m - 1] : 0.0, here = product(l, l->image, l->vector);
    for (dem_index k = 0; k < n; k++) l->image[k] -= here * l->vector[k] + before * l->last[k];
    const double size = sqrt(product(l, l->image, l->image));
    for (dem_index k = 0; k < n; k++) {
        l->last[k] = l->vector[k];
        l->vector[k] = size > 0.0 ? l->image[k] / size : 0.0;
    }
    l->diagonal[l->m] = here;
    l->beside[l->m++] = size;
    return size;
}

/* Stops when the residual is below `accepted` theta; the error of theta is then of the order of the square of that. */
static dem_status iterate(lanczos *l, double *omega)
{
    start(l);
    while (l->m < most_iterations) {
        apply(l);
        const double size = next(l), theta = largest_of(l);
        *omega = sqrt(theta);
        if (size * last_component(l, theta) <= accepted * theta) return DEM_OK;
    }
    return status_fail(DEM_ERROR_MODEL, "the highest frequency is not found in %d iterations; it is near %g rad/s",
                       (int)most_iterations, *omega);
}

/* The four vectors are one allocation. */
static dem_status allocate(lanczos *l)
{
    const dem_index n = l->model->lattice.n_nodes;
    double *vectors = lattice_zeros(4 * n, 2 * sizeof *vectors);
    CHECK(vectors, DEM_ERROR_MEMORY, "out of memory for %lld nodes", (long long)n);
    l->vector = vectors;
    l->last = vectors + 2 * n;
    l->scaled = vectors + 4 * n;
    l->image = vectors + 6 * n;
    return l->model->domain != NULL ? halo_create(&l->halo, l->model->ranks, l->model->domain, 2, 1) : DEM_OK;
}

/* The tridiagonal matrix is too large for the stack. */
dem_status dem_model_omega(const dem_model *model, double *omega)
{
    CHECK(model != NULL && omega != NULL, DEM_ERROR_ARGUMENT, "dem_model_omega: %s is NULL", model ? "omega" : "model");
    TRY(model_rows_renew(model));
    lanczos *l = calloc(1, sizeof *l);
    CHECK_MEMORY(l);
    double found = 0.0;
    l->model = model;
    dem_status status = allocate(l);
    if (status == DEM_OK) status = iterate(l, &found);
    if (status == DEM_OK) *omega = found;
    free(l->vector);
    halo_destroy(&l->halo);
    free(l);
    return status;
}
