/* SPDX-License-Identifier: BSD-3-Clause */
/* The motion between the ends of an accepted step (docs/method.md, Dense output): x, v and a at both ends fix six
 * coefficients for each component, a quintic. It is written as the integral of the cubic Hermite interpolant of the
 * velocities plus a bump that closes the gap in position; so rounding of the positions, which the bump alone sees, can
 * be kept out of the velocity. For methods of order 2 there are two parabolas instead, one for x and one for v. Frames,
 * t_end and events are read off here; ARKODE's own interpolant is not used. Nodes that an event inside the step has
 * moved otherwise have polynomials of their own, in changed_motion.c. */
#include "time/dense_output.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/row_pair.h"

/* Coefficients at s = (t - t0)/h. Let w(s) be the cubic Hermite interpolant of the velocity,
 *   w(s) = v0 (1 - 3 s^2 + 2 s^3) + h a0 s (1 - s)^2 + v1 (3 s^2 - 2 s^3) - h a1 s^2 (1 - s),
 * and C the integral of w over s from 0 to 1. Then, with B = 10 s^3 - 15 s^4 + 6 s^5 and D = x1 - x0 - h C,
 *   x(s) = x0 + h (integral of w from 0 to s) + D B(s),   v(s) = w(s) + D B'(s)/h.
 * B goes from 0 to 1 and has B' = B'' = 0 at both ends: D closes the position and leaves v and a at the ends alone. */
typedef struct basis {
    double t, h, s;
    double v0, a0, v1, a1;     /* of the velocity: factors of v0, h a0, v1, h a1 in w */
    double iv0, ia0, iv1, ia1; /* of its integral from 0 to s */
    double bump, slope;        /* B, B' */
} basis;

/* Parabolas need h and s alone: where `parabolic` is a constant the compiler leaves out the rest. */
INLINE basis basis_at(bool parabolic, const dense_output *p, double t)
{
    const double h = p->t1 - p->t0, s = (t - p->t0) / h, s2 = s * s, s3 = s2 * s;
    if (parabolic) return (basis){.t = t, .h = h, .s = s};
    return (basis){.t = t,
                   .h = h,
                   .s = s,
                   .v0 = 1.0 - s2 * (3.0 - 2.0 * s),
                   .a0 = s * (1.0 - s) * (1.0 - s),
                   .v1 = s2 * (3.0 - 2.0 * s),
                   .a1 = -s2 * (1.0 - s),
                   .iv0 = s - s3 * (1.0 - 0.5 * s),
                   .ia0 = s2 * (0.5 - s * (2.0 / 3.0 - 0.25 * s)),
                   .iv1 = s3 * (1.0 - 0.5 * s),
                   .ia1 = -s3 * (1.0 / 3.0 - 0.25 * s),
                   .bump = s3 * (10.0 - s * (15.0 - 6.0 * s)),
                   .slope = 30.0 * s2 * (1.0 - s) * (1.0 - s)};
}

/* Both ends of the step: positions, velocities and accelerations. */
typedef struct ends {
    const double *x0, *v0, *a0, *x1, *v1, *a1;
} ends;

static inline ends ends_of(const dense_output *p)
{
    const dem_index v = state_velocities(&p->layout);
    return (ends){p->y0, p->y0 + v, p->f0 + v, p->y1, p->y1 + v, p->f1 + v};
}

/* D of basis, m: the part of the displacement that the integral of the velocities' cubic lacks,
 *   D = x1 - x0 - h ((v0 + v1)/2 + h (a0 - a1)/12).
 * Below the rounding of the positions it is noise, which the bump's slope D B'/h would turn into velocity when h is
 * tiny; there it counts as 0. */
static inline double defect(const ends *e, dem_index k, double h)
{
    const double x0 = e->x0[k], x1 = e->x1[k], v0 = e->v0[k], v1 = e->v1[k];
    const double d = x1 - x0 - h * (0.5 * (v0 + v1) + h * (e->a0[k] - e->a1[k]) / 12.0);
    const double larger = fabs(x0) > fabs(x1) ? fabs(x0) : fabs(x1); /* fmax() is a call */
    return fabs(d) > 4.0 * DBL_EPSILON * larger ? d : 0.0;
}

/* The parabola that is y0 at s = 0 with slope f0 (per second) and y1 at s = 1: y0 + s h f0 + s^2 (y1 - y0 - h f0). */
static inline double parabola(const basis *b, double y0, double f0, double y1)
{
    return y0 + b->s * (b->h * f0 + b->s * (y1 - y0 - b->h * f0));
}

/* One component of the position, m. `parabolic` is an argument of its own, and not read from the step, so that the loop
 * over all components is compiled once for each kind. */
static inline double position(bool parabolic, const ends *e, const basis *b, dem_index k)
{
    const double h = b->h;
    if (parabolic) return parabola(b, e->x0[k], e->v0[k], e->x1[k]);
    return e->x0[k] + h * (b->iv0 * e->v0[k] + b->iv1 * e->v1[k]) + h * h * (b->ia0 * e->a0[k] + b->ia1 * e->a1[k]) +
           b->bump * defect(e, k, h);
}

static inline double velocity(bool parabolic, const ends *e, const basis *b, dem_index k)
{
    const double h = b->h;
    if (parabolic) return parabola(b, e->v0[k], e->a0[k], e->v1[k]);
    return b->v0 * e->v0[k] + b->v1 * e->v1[k] + h * (b->a0 * e->a0[k] + b->a1 * e->a1[k]) +
           b->slope * defect(e, k, h) / h;
}

/* Whether an event inside the step has changed the motion of the row. */
static bool has_changed(const dense_output *p, dem_index i)
{
    return p->changed != NULL && changed_motion_has(p->changed, i);
}

/* If that is a node, a polynomial of its own counts; a quadrature has what events add to it. */
static bool turned(const dense_output *p, dem_index i)
{
    return i < p->layout.n_nodes && has_changed(p, i);
}

/* The third component, of three-dimensional states only; x or v may be NULL. Kept apart from the other two. */
static void interpolate_third(const dense_output *p, double t, dem_index k, double *x, double *v)
{
    const basis b = basis_at(p->parabolic, p, t);
    const ends e = ends_of(p);
    if (x != NULL) *x = position(p->parabolic, &e, &b, k);
    if (v != NULL) *v = velocity(p->parabolic, &e, &b, k);
}

/* Two components, in a loop for vector instructions. */
static inline void put_pair(bool parabolic, const ends *e, const basis *b, dem_index k, double *out)
{
    double x[2];
    for (int d = 0; d < 2; d++) x[d] = position(parabolic, e, b, k + d);
    for (int d = 0; d < 2; d++) out[d] = x[d];
}

/* As if no event inside had changed it. `parabolic` is a constant wherever these are called, too. */
INLINE void position_by(bool parabolic, const dense_output *p, const basis *b, dem_index i, double *out)
{
    const dem_index k = state_row(&p->layout, i);
    const ends e = ends_of(p);
    if (b->t == p->t0) {
        state_copy_row(&p->layout, out, p->y0 + k);
        return;
    }
    put_pair(parabolic, &e, b, k, out);
    if (p->layout.dim > 2) interpolate_third(p, b->t, k + 2, &out[2], NULL);
}

INLINE void velocity_by(bool parabolic, const dense_output *p, const basis *b, dem_index i, double *out)
{
    const dem_index k = state_row(&p->layout, i);
    const ends e = ends_of(p);
    if (b->t == p->t0) {
        state_copy_row(&p->layout, out, state_v(&p->layout, p->y0, i));
        return;
    }
    const double first = velocity(parabolic, &e, b, k), second = velocity(parabolic, &e, b, k + 1);
    out[0] = first;
    out[1] = second;
    if (p->layout.dim > 2) interpolate_third(p, b->t, k + 2, NULL, &out[2]);
}

INLINE void position_at(bool parabolic, const dense_output *p, double t, dem_index i, double *out)
{
    const basis b = basis_at(parabolic, p, t);
    position_by(parabolic, p, &b, i, out);
}

INLINE void velocity_at(bool parabolic, const dense_output *p, double t, dem_index i, double *out)
{
    const basis b = basis_at(parabolic, p, t);
    velocity_by(parabolic, p, &b, i, out);
}

void dense_output_position_inside(const dense_output *p, double t, dem_index i, double *out)
{
    if (turned(p, i))
        changed_motion_position(p->changed, t, i, out);
    else if (p->parabolic)
        position_at(true, p, t, i, out);
    else
        position_at(false, p, t, i, out);
    if (i >= p->layout.n_nodes && has_changed(p, i)) changed_motion_row_at(p->changed, t, i, out, NULL);
}

/* Of two dimensions, inside the step. `parabolic` is a constant wherever this is called. */
static inline void put_inside(bool parabolic, const dense_output *p, double t, const int32_t *list, int n, double *x)
{
    const ends e = ends_of(p);
    const basis b = basis_at(parabolic, p, t);
    for (int j = 0; j < n; j++) {
        double *out = x + 2 * (dem_index)list[j];
        if (has_changed(p, list[j]))
            changed_motion_position(p->changed, t, list[j], out);
        else
            put_pair(parabolic, &e, &b, 2 * (dem_index)list[j], out);
    }
}

void dense_output_put_positions(const dense_output *p, double t, const int32_t *list, int n, double *x)
{
    if (n == 0) return;
    if (p->layout.dim > 2 || t == p->t0 || t == p->t1)
        for (int j = 0; j < n; j++) dense_output_position(p, t, list[j], x + state_row(&p->layout, list[j]));
    else if (p->parabolic)
        put_inside(true, p, t, list, n, x);
    else
        put_inside(false, p, t, list, n, x);
}

void dense_output_velocity_inside(const dense_output *p, double t, dem_index i, double *out)
{
    if (turned(p, i))
        changed_motion_velocity(p->changed, t, i, out);
    else if (p->parabolic)
        velocity_at(true, p, t, i, out);
    else
        velocity_at(false, p, t, i, out);
    if (i >= p->layout.n_nodes && has_changed(p, i)) changed_motion_row_at(p->changed, t, i, NULL, out);
}

INLINE void put_node(bool parabolic, const dense_output *p, const basis *b, dem_index i, double *x, double *v)
{
    position_by(parabolic, p, b, i, x);
    velocity_by(parabolic, p, b, i, v);
}

/* One basis serves all nodes that no event has changed. */
void dense_output_put_nodes(const dense_output *p, double t, dem_index n, const dem_index *nodes, double *x, double *v)
{
    const basis b = p->parabolic ? basis_at(true, p, t) : basis_at(false, p, t);
    for (dem_index j = 0; j < n; j++, x += p->layout.dim, v += p->layout.dim)
        if (t == p->t1) {
            state_copy_row(&p->layout, x, state_x(&p->layout, p->y1, nodes[j]));
            state_copy_row(&p->layout, v, state_v(&p->layout, p->y1, nodes[j]));
        } else if (turned(p, nodes[j])) {
            changed_motion_position(p->changed, t, nodes[j], x);
            changed_motion_velocity(p->changed, t, nodes[j], v);
        } else if (p->parabolic)
            put_node(true, p, &b, nodes[j], x, v);
        else
            put_node(false, p, &b, nodes[j], x, v);
}

/* Interpolates all components of x and v, those of the quadratures too, as if no event inside had changed them. */
static inline void fill(bool parabolic, const dense_output *p, double t, double *restrict y)
{
    const dem_index n = state_velocities(&p->layout);
    const ends e = ends_of(p);
    const basis b = basis_at(parabolic, p, t);
    for (dem_index k = 0; k < n; k++) {
        y[k] = position(parabolic, &e, &b, k);
        y[n + k] = velocity(parabolic, &e, &b, k);
    }
}

/* Calls fill() with a constant, so that each of both loops is compiled without the choice inside. */
static void interpolate(const dense_output *p, double t, double *y)
{
    if (p->parabolic)
        fill(true, p, t, y);
    else
        fill(false, p, t, y);
}

/* All rows at once, for frames, observers and the end of a step that an event has cut short; then the rows that events
 * have changed. y1 has the changes already, but y0 has not: an event right at t0 counts there too. */
void dense_output_state(const dense_output *p, double t, double *y)
{
    if (t == p->t0 || t == p->t1)
        memcpy(y, t == p->t0 ? p->y0 : p->y1, (size_t)state_size(&p->layout) * sizeof *y);
    else
        interpolate(p, t, y);
    for (dem_index i = 0; i < p->layout.n_rows && p->changed != NULL && t != p->t1; i++) {
        if (!has_changed(p, i)) continue;
        double *x = y + state_row(&p->layout, i), *v = x + state_velocities(&p->layout);
        if (turned(p, i)) {
            changed_motion_position(p->changed, t, i, x);
            changed_motion_velocity(p->changed, t, i, v);
        } else
            changed_motion_row_at(p->changed, t, i, x, v);
    }
}

/* ---- hulls ---- */

/* The control points of Bezier's form, whose convex hull has the curve in it. Of a polynomial of degree n with the
 * coefficients c_j of s^j they are the sums over j of C(i,j) c_j/C(n,j), which are added up as in Pascal's triangle. */
INLINE void hull_of(const motion_polynomial *m, int n, const double *shares, double *hull)
{
    for (int d = 0; d < m->dim; d += 2) {
        row_pair sums[MOTION_TERMS];
        for (int j = 0; j < n; j++) sums[j] = shares[j] * row_pair_at(m->x[j], d);
        UNROLLED for (int k = 1; k < n; k++) UNROLLED for (int j = n - 1; j >= k; j--) sums[j] += sums[j - 1];
        for (int j = 0; j < n; j++) row_pair_put(hull + j * m->dim, d, sums[j]);
    }
}

static const double parabola_shares[MOTION_PARABOLA] = {1.0, 0.5, 1.0};
static const double quintic_shares[MOTION_TERMS] = {1.0, 0.2, 0.1, 0.1, 0.2, 1.0};

/* The same by values and derivatives at the ends. */
INLINE void hull_of_ends(bool parabolic, const dense_output *p, dem_index row, double *hull)
{
    const ends e = ends_of(p);
    const int dim = p->layout.dim;
    const double h = p->t1 - p->t0, a = h * h / 20.0;
    for (int d = 0; d < dim; d += 2) {
        const row_pair x0 = row_pair_at(e.x0 + row, d), v0 = h * row_pair_at(e.v0 + row, d),
                       x1 = row_pair_at(e.x1 + row, d);
        row_pair_put(hull, d, x0);
        row_pair_put(hull + dim, d, parabolic ? x0 + 0.5 * v0 : x0 + 0.2 * v0);
        row_pair_put(hull + (parabolic ? 2 : 5) * dim, d, x1);
        if (parabolic) continue;
        const row_pair v1 = h * row_pair_at(e.v1 + row, d);
        row_pair_put(hull + 2 * dim, d, x0 + 0.4 * v0 + a * row_pair_at(e.a0 + row, d));
        row_pair_put(hull + 3 * dim, d, x1 - 0.4 * v1 + a * row_pair_at(e.a1 + row, d));
        row_pair_put(hull + 4 * dim, d, x1 - 0.2 * v1);
    }
}

int dense_output_hull(const dense_output *p, dem_index node, double *hull)
{
    const dem_index row = state_row(&p->layout, node);
    const motion_polynomial *changed = turned(p, node) ? changed_motion_of(p->changed, node) : NULL;
    const bool parabolic = changed != NULL ? changed->parabolic : p->parabolic;
    if (changed != NULL && parabolic)
        hull_of(changed, MOTION_PARABOLA, parabola_shares, hull);
    else if (changed != NULL)
        hull_of(changed, MOTION_TERMS, quintic_shares, hull);
    else if (parabolic)
        hull_of_ends(true, p, row, hull);
    else
        hull_of_ends(false, p, row, hull);
    return parabolic ? MOTION_PARABOLA : DENSE_OUTPUT_HULL;
}

/* h of the step, and what follows from it alone: 1/h, h/q. */
typedef struct step_length {
    double h, per_h, parts[MOTION_TERMS];
} step_length;

static step_length length_of(const dense_output *p)
{
    step_length l = {.h = p->t1 - p->t0, .per_h = 1.0 / (p->t1 - p->t0)};
    for (int q = 1; q < MOTION_TERMS; q++) l.parts[q] = l.h / q;
    return l;
}

/* defect() of two components of a row that begins at k. */
INLINE row_pair defects(const ends *e, dem_index k, int d, double h)
{
    const row_pair x0 = row_pair_at(e->x0 + k, d), v0 = row_pair_at(e->v0 + k, d), a0 = row_pair_at(e->a0 + k, d);
    const row_pair x1 = row_pair_at(e->x1 + k, d), v1 = row_pair_at(e->v1 + k, d), a1 = row_pair_at(e->a1 + k, d);
    const row_pair gap = x1 - x0 - h * (0.5 * (v0 + v1) + h * (a0 - a1) / 12.0), size = row_pair_absolute(gap);
    const double rounding = 4.0 * DBL_EPSILON;
    const row_pair_bits counts = (size > rounding * row_pair_absolute(x0)) & (size > rounding * row_pair_absolute(x1));
    return (row_pair)((row_pair_bits)gap & counts);
}

/* The same quintic in powers of s, as changed motions are kept. With jump = v1 - v0, a0 and a1 times h, and b = 30 D/h
 * from B' = 30 (s^2 - 2 s^3 + s^4):
 *   v = v0 + a0 s + (3 jump - 2 a0 - a1 + b) s^2 + (a0 + a1 - 2 jump - 2 b) s^3 + b s^4,
 *   x = x0 + h (integral of v), term by term: x_q = h v_(q-1)/q. */
INLINE void write_quintic(const ends *e, const step_length *l, dem_index k, int d, motion_polynomial *out)
{
    const row_pair bump = 30.0 * l->per_h * defects(e, k, d, l->h), v0 = row_pair_at(e->v0 + k, d);
    const row_pair jump = row_pair_at(e->v1 + k, d) - v0, a0 = l->h * row_pair_at(e->a0 + k, d),
                   a1 = l->h * row_pair_at(e->a1 + k, d);
    const row_pair v[MOTION_SLOPES] = {v0, a0, 3.0 * jump - 2.0 * a0 - a1 + bump, a0 + a1 - 2.0 * jump - 2.0 * bump,
                                       bump};
    row_pair_put(out->x[0], d, row_pair_at(e->x0 + k, d));
    for (int q = 0; q < MOTION_SLOPES; q++) row_pair_put(out->v[q], d, v[q]);
    for (int q = 1; q < MOTION_TERMS; q++) row_pair_put(out->x[q], d, l->parts[q] * v[q - 1]);
}

/* The two parabolas in powers of s; see parabola(). */
INLINE void write_parabolas(const ends *e, double h, dem_index k, int d, motion_polynomial *out)
{
    const row_pair x0 = row_pair_at(e->x0 + k, d), v0 = row_pair_at(e->v0 + k, d);
    const row_pair x = h * v0, v = h * row_pair_at(e->a0 + k, d);
    row_pair_put(out->x[0], d, x0);
    row_pair_put(out->x[1], d, x);
    row_pair_put(out->x[2], d, row_pair_at(e->x1 + k, d) - x0 - x);
    row_pair_put(out->v[0], d, v0);
    row_pair_put(out->v[1], d, v);
    row_pair_put(out->v[2], d, row_pair_at(e->v1 + k, d) - v0 - v);
}

/* As if no event inside had changed it. */
static void write_motion(const dense_output *p, const step_length *l, dem_index i, motion_polynomial *out)
{
    const dem_index k = state_row(&p->layout, i);
    const ends e = ends_of(p);
    out->from = p->t0;
    out->dim = p->layout.dim;
    out->parabolic = p->parabolic;
    for (int d = 0; d < out->dim; d += 2)
        if (p->parabolic)
            write_parabolas(&e, l->h, k, d, out);
        else
            write_quintic(&e, l, k, d, out);
}

void dense_output_motions(const dense_output *p, dem_index n, const dem_index *nodes, motion_polynomial *out)
{
    const step_length l = length_of(p);
    for (dem_index j = 0; j < n; j++) {
        if (turned(p, nodes[j]))
            motion_polynomial_copy(&out[j], changed_motion_of(p->changed, nodes[j]));
        else
            write_motion(p, &l, nodes[j], &out[j]);
    }
}

/* s. Time itself has a rounding of eps t, the interpolant one of eps h. */
double dense_output_resolution(const dense_output *p)
{
    return 100.0 * DBL_EPSILON * (fabs(p->t1) + p->t1 - p->t0);
}
