/* SPDX-License-Identifier: BSD-3-Clause */
/* Arithmetic of vectors and symmetric matrices of two components. Rooms that must not know the number of dimensions do
 * not include this file (tests/style/rooms.py). Every function is a fixed sequence of operations: no bit depends on the
 * caller. */
#ifndef DEM_BASE_VEC2_H
#define DEM_BASE_VEC2_H

#include <math.h>
#include <stdbool.h>

#include <dem/dem.h>

typedef struct vec2 {
    double x, y;
} vec2;

/** Where vector i begins in an array [n][2]; also the number of doubles in i vectors. */
static inline dem_index vec2_row(dem_index i)
{
    return 2 * i;
}

static inline vec2 vec2_at(const double *array, dem_index i) /* array [n][2] */
{
    return (vec2){array[2 * i], array[2 * i + 1]};
}

static inline void vec2_put(double *array, dem_index i, vec2 a)
{
    array[2 * i] = a.x;
    array[2 * i + 1] = a.y;
}

static inline vec2 vec2_add(vec2 a, vec2 b)
{
    return (vec2){a.x + b.x, a.y + b.y};
}

static inline vec2 vec2_sub(vec2 a, vec2 b)
{
    return (vec2){a.x - b.x, a.y - b.y};
}

static inline vec2 vec2_scale(double s, vec2 a)
{
    return (vec2){s * a.x, s * a.y};
}

/** a + s b */
static inline vec2 vec2_along(vec2 a, double s, vec2 b)
{
    return (vec2){a.x + s * b.x, a.y + s * b.y};
}

static inline double vec2_dot(vec2 a, vec2 b)
{
    return a.x * b.x + a.y * b.y;
}

static inline double vec2_cross(vec2 a, vec2 b)
{
    return a.x * b.y - a.y * b.x;
}

static inline double vec2_norm(vec2 a)
{
    return sqrt(a.x * a.x + a.y * a.y);
}

/** Signed area of the triangle abc, m^2. */
static inline double vec2_triangle_area(vec2 a, vec2 b, vec2 c)
{
    return 0.5 * vec2_cross(vec2_sub(b, a), vec2_sub(c, a));
}

/** The same of the points of these numbers among x [n][2]. */
static inline double vec2_area_of(const double *x, const dem_index corner[3])
{
    return vec2_triangle_area(vec2_at(x, corner[0]), vec2_at(x, corner[1]), vec2_at(x, corner[2]));
}

/** Whether the segments ab and cd cross: each has the ends of the other on both sides. */
static inline bool vec2_segments_cross(vec2 a, vec2 b, vec2 c, vec2 d)
{
    return vec2_triangle_area(a, b, c) * vec2_triangle_area(a, b, d) < 0.0 &&
           vec2_triangle_area(c, d, a) * vec2_triangle_area(c, d, b) < 0.0;
}

/** A symmetric matrix. */
typedef struct sym2 {
    double xx, xy, yy;
} sym2;

/** A + s a a^T */
static inline sym2 sym2_along(sym2 A, double s, vec2 a)
{
    return (sym2){A.xx + s * a.x * a.x, A.xy + s * a.x * a.y, A.yy + s * a.y * a.y};
}

static inline sym2 sym2_add(sym2 A, sym2 B)
{
    return (sym2){A.xx + B.xx, A.xy + B.xy, A.yy + B.yy};
}

/** The larger eigenvalue: the mean of xx and yy plus the radius of Mohr's circle. */
static inline double sym2_largest(sym2 A)
{
    return 0.5 * (A.xx + A.yy) + sqrt(0.25 * (A.xx - A.yy) * (A.xx - A.yy) + A.xy * A.xy);
}

/** The vector a with a.n0 = p0 and a.n1 = p1; not finite where the directions are parallel. */
static inline vec2 vec2_with_products(double p0, vec2 n0, double p1, vec2 n1)
{
    const double d = vec2_cross(n0, n1);
    return (vec2){(p0 * n1.y - p1 * n0.y) / d, (p1 * n0.x - p0 * n1.x) / d};
}

/** The components of a along two directions: a = p[0] n0 + p[1] n1; not finite where they are parallel. */
static inline void vec2_parts(vec2 a, vec2 n0, vec2 n1, double p[2])
{
    const double d = vec2_cross(n0, n1);
    p[0] = vec2_cross(a, n1) / d;
    p[1] = vec2_cross(n0, a) / d;
}

#endif
