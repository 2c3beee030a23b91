/* SPDX-License-Identifier: BSD-3-Clause */
#include "raster.h"

#include <stdlib.h>

bool raster_create(raster *r, int width, int height)
{
    const size_t n = (size_t)width * (size_t)height;
    *r = (raster){width, height, malloc(n * sizeof *r->value)};
    if (r->value == NULL) return false;
    for (size_t k = 0; k < n; k++) r->value[k] = NAN;
    return true;
}

void raster_free(raster *r)
{
    free(r->value);
    *r = (raster){0};
}

static void touch(raster *r, int column, int row, float value)
{
    if (column < 0 || column >= r->width || row < 0 || row >= r->height) return;
    float *here = &r->value[(size_t)row * (size_t)r->width + (size_t)column];
    if (isnan(*here) || fabsf(value) > fabsf(*here)) *here = value;
}

static box box_of(const raster *r)
{
    return (box){0.0, 0.0, r->width, r->height};
}

enum { LONGEST = 1 << 16 }; /* pixels; beyond that a line is seen from so near that nobody looks at all of it */

/* As many points as the line has pixels along its longer side, in the middle of each a brush. */
void raster_line(raster *r, const double xy[4], int thick, double value)
{
    if (!box_meets(box_grown(box_around(2, xy), thick), box_of(r))) return;
    const double dx = xy[2] - xy[0], dy = xy[3] - xy[1];
    const int n = (int)ceil(fmin(fmax(fabs(dx), fabs(dy)), LONGEST)) + 1;
    for (int k = 0; k <= n; k++) {
        const double u = (double)k / n, shift = 0.5 * (thick - 1);
        const int column = (int)floor(xy[0] + u * dx - shift), row = (int)floor(xy[1] + u * dy - shift);
        for (int i = 0; i < thick; i++)
            for (int j = 0; j < thick; j++) touch(r, column + i, row + j, (float)value);
    }
}

/* Twice the area of a, b, c. */
static double cross(const double *a, const double *b, double x, double y)
{
    return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
}

/* The pixels whose middles are inside, by their barycentric coordinates; how many there are. */
static long fill(raster *r, const double xy[6], const double value[3], box seen)
{
    const double whole = cross(xy, xy + 2, xy[4], xy[5]);
    long n = 0;
    if (whole == 0.0) return 0;
    for (int row = (int)seen.y0; row <= (int)seen.y1; row++)
        for (int column = (int)seen.x0; column <= (int)seen.x1; column++) {
            const double x = column + 0.5, y = row + 0.5;
            const double w0 = cross(xy + 2, xy + 4, x, y) / whole, w1 = cross(xy + 4, xy, x, y) / whole;
            const double w2 = 1.0 - w0 - w1;
            if (w0 < 0.0 || w1 < 0.0 || w2 < 0.0) continue;
            touch(r, column, row, (float)(w0 * value[0] + w1 * value[1] + w2 * value[2]));
            n++;
        }
    return n;
}

/* One without any is drawn by its sides. */
void raster_triangle(raster *r, const double xy[6], const double value[3])
{
    const box b = box_around(3, xy), all = box_of(r);
    if (!box_meets(b, all)) return;
    const box seen = {fmax(b.x0, 0.0), fmax(b.y0, 0.0), fmin(b.x1, all.x1), fmin(b.y1, all.y1)};
    if (fill(r, xy, value, seen) > 0) return;
    const double mean = (value[0] + value[1] + value[2]) / 3.0;
    for (int k = 0; k < 3; k++) {
        const double *from = xy + 2 * k, *to = xy + 2 * ((k + 1) % 3);
        raster_line(r, (const double[]){from[0], from[1], to[0], to[1]}, 1, mean);
    }
}

long raster_count(const raster *r)
{
    long n = 0;
    for (size_t k = 0; k < (size_t)r->width * (size_t)r->height; k++) n += !isnan(r->value[k]);
    return n;
}

bool raster_render(const raster *r, const palette *colours, double lo, double hi, canvas_image *out)
{
    const size_t n = (size_t)r->width * (size_t)r->height;
    *out = (canvas_image){r->width, r->height, calloc(n, sizeof *out->argb)};
    if (out->argb == NULL) return false;
    for (size_t k = 0; k < n; k++) {
        if (isnan(r->value[k])) continue;
        const colour c = colours->of[palette_index(r->value[k], lo, hi)];
        out->argb[k] = UINT32_C(0xff000000) | (uint32_t)c.red << 16 | (uint32_t)c.green << 8 | c.blue;
    }
    return true;
}
