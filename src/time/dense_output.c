/* SPDX-License-Identifier: BSD-3-Clause */
/* Quintic Hermite interpolation of x'' = a, written as the cubic of the velocities plus a bump that closes the
 * positions. */
#include "time/dense_output.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Coefficients at s = (t - t0)/h.  With v(s) the cubic through v0, h a0, v1, h a1 and C its integral over the step,
 *   x(s) = x0 + h int_0^s v + D B(s),  v += D B'(s)/h,  D = x1 - x0 - h C,  B = 10 s^3 - 15 s^4 + 6 s^5. */
typedef struct basis {
    double h, s;
    double v0, a0, v1, a1;     /* of the velocity */
    double iv0, ia0, iv1, ia1; /* of its integral */
    double bump, slope;        /* B, B' */
} basis;

static basis basis_at(const dense_output *p, double t)
{
    const double h = p->t1 - p->t0, s = (t - p->t0) / h, s2 = s * s, s3 = s2 * s;
    return (basis){.h = h,
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

/* The part of the displacement that the integral of the velocities' cubic lacks, m. Below the rounding of the positions
 * it is noise, which the bump's slope would turn into velocity when h is tiny. */
static inline double defect(const ends *e, dem_index k, double h)
{
    const double x0 = e->x0[k], x1 = e->x1[k], v0 = e->v0[k], v1 = e->v1[k];
    const double d = x1 - x0 - h * (0.5 * (v0 + v1) + h * (e->a0[k] - e->a1[k]) / 12.0);
    const double larger = fabs(x0) > fabs(x1) ? fabs(x0) : fabs(x1); /* fmax() is a call */
    return fabs(d) > 4.0 * DBL_EPSILON * larger ? d : 0.0;
}

/* From y0 with slope f0 to y1. */
static inline double parabola(const basis *b, double y0, double f0, double y1)
{
    return y0 + b->s * (b->h * f0 + b->s * (y1 - y0 - b->h * f0));
}

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

static bool turned(const dense_output *p, dem_index i)
{
    return p->changed != NULL && changed_motion_has(p->changed, i);
}

static void interpolate_third(const dense_output *p, double t, dem_index k, double *x, double *v)
{
    const basis b = basis_at(p, t);
    const ends e = ends_of(p);
    if (x != NULL) *x = position(p->parabolic, &e, &b, k);
    if (v != NULL) *v = velocity(p->parabolic, &e, &b, k);
}

void dense_output_position_inside(const dense_output *p, double t, dem_index i, double *out)
{
    const dem_index k = state_row(&p->layout, i);
    if (turned(p, i)) {
        changed_motion_position(p->changed, t, i, out);
        return;
    }
    if (t == p->t0) {
        state_copy_row(&p->layout, out, p->y0 + k);
        return;
    }
    const basis b = basis_at(p, t);
    const ends e = ends_of(p);
    const double first = position(p->parabolic, &e, &b, k), second = position(p->parabolic, &e, &b, k + 1);
    out[0] = first;
    out[1] = second;
    if (p->layout.dim > 2) interpolate_third(p, t, k + 2, &out[2], NULL);
}

void dense_output_velocity_inside(const dense_output *p, double t, dem_index i, double *out)
{
    const dem_index k = state_row(&p->layout, i);
    if (turned(p, i)) {
        changed_motion_velocity(p->changed, t, i, out);
        return;
    }
    if (t == p->t0) {
        state_copy_row(&p->layout, out, state_v(&p->layout, p->y0, i));
        return;
    }
    const basis b = basis_at(p, t);
    const ends e = ends_of(p);
    const double first = velocity(p->parabolic, &e, &b, k), second = velocity(p->parabolic, &e, &b, k + 1);
    out[0] = first;
    out[1] = second;
    if (p->layout.dim > 2) interpolate_third(p, t, k + 2, NULL, &out[2]);
}

/* Interpolates all numbers of x and v. */
static inline void fill(bool parabolic, const dense_output *p, double t, double *restrict y)
{
    const dem_index n = state_velocities(&p->layout);
    const ends e = ends_of(p);
    const basis b = basis_at(p, t);
    for (dem_index k = 0; k < n; k++) {
        y[k] = position(parabolic, &e, &b, k);
        y[n + k] = velocity(parabolic, &e, &b, k);
    }
}

/* As if no event inside had changed it. */
static void interpolate(const dense_output *p, double t, double *y)
{
    if (p->parabolic)
        fill(true, p, t, y);
    else
        fill(false, p, t, y);
}

void dense_output_state(const dense_output *p, double t, double *y)
{
    if (t == p->t0 || t == p->t1)
        memcpy(y, t == p->t0 ? p->y0 : p->y1, (size_t)state_size(&p->layout) * sizeof *y);
    else
        interpolate(p, t, y);
    for (dem_index i = 0; i < p->layout.n_rows && p->changed != NULL && t != p->t1; i++) {
        if (!changed_motion_has(p->changed, i)) continue;
        changed_motion_position(p->changed, t, i, y + state_row(&p->layout, i));
        changed_motion_velocity(p->changed, t, i, y + state_velocities(&p->layout) + state_row(&p->layout, i));
    }
}

/* The same for one number, in powers of s: the velocity's cubic and the slope of the bump, and the integral of both. */
static inline void write_quintic(const ends *e, double h, dem_index k, motion_component c)
{
    const double bump = 30.0 * (1.0 / h) * defect(e, k, h), jump = e->v1[k] - e->v0[k];
    const double a0 = h * e->a0[k], a1 = h * e->a1[k];
    const double v[MOTION_TERMS] = {e->v0[k], a0, 3.0 * jump - 2.0 * a0 - a1 + bump, a0 + a1 - 2.0 * jump - 2.0 * bump,
                                    bump,     0.0};
    c[0][0] = e->x0[k];
    for (int q = 0; q < MOTION_TERMS; q++) c[q][1] = v[q];
    for (int q = 1; q < MOTION_TERMS; q++) c[q][0] = h / q * v[q - 1];
}

static inline void write_parabolas(const ends *e, double h, dem_index k, motion_component c)
{
    const double v0 = e->v0[k], x[2] = {e->x0[k], h * v0}, v[2] = {v0, h * e->a0[k]};
    const double last[2] = {e->x1[k] - x[0] - x[1], e->v1[k] - v[0] - v[1]};
    for (int q = 0; q < 2; q++) {
        c[q][0] = x[q];
        c[q][1] = v[q];
        c[2][q] = last[q];
    }
    for (int q = 3; q < MOTION_TERMS; q++) c[q][0] = c[q][1] = 0.0;
}

static inline void write_component(const dense_output *p, dem_index k, motion_component c)
{
    const ends e = ends_of(p);
    if (p->parabolic)
        write_parabolas(&e, p->t1 - p->t0, k, c);
    else
        write_quintic(&e, p->t1 - p->t0, k, c);
}

void dense_output_motion(const dense_output *p, dem_index i, motion_polynomial *out)
{
    const dem_index k = state_row(&p->layout, i);
    out->from = p->t0;
    out->dim = p->layout.dim;
    for (int d = 0; d < 2; d++) write_component(p, k + d, out->c[d]);
    if (out->dim > 2) write_component(p, k + 2, out->c[2]);
}
