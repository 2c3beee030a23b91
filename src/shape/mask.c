/* SPDX-License-Identifier: BSD-3-Clause */
#include "shape/mask.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

/* Rows of an image are turned over: y points up. */
bool mask_create(mask *out, const dem_image *image)
{
    mask m = {.width = (size_t)image->width, .height = (size_t)image->height, .scale = image->pixel};
    m.solid = calloc(m.width * m.height, sizeof *m.solid);
    for (size_t k = 0; m.solid != NULL && k < m.width * m.height; k++) {
        const size_t row = m.height - 1 - k / m.width;
        m.solid[row * m.width + k % m.width] = image->solid[k] != 0;
        m.n_solid += image->solid[k] != 0;
    }
    *out = m;
    return m.solid != NULL;
}

void mask_free(mask *m)
{
    free(m->solid);
    *m = (mask){0};
}

/* A place in pixels from the image's left lower corner. */
static void to_pixels(double at[2], const mask *m, const double x[2])
{
    at[0] = x[0] / m->scale + 0.5 * (double)m->width;
    at[1] = x[1] / m->scale;
}

/* The pixel of n in a row that holds a place; the first and the last one hold what lies beyond. */
static size_t pixel_at(double at, size_t n)
{
    return at >= (double)n ? n - 1 : (at > 0.0 ? (size_t)at : 0);
}

bool mask_has(const mask *m, const double x[2], double slack)
{
    double at[2];
    const double s = slack / m->scale;
    to_pixels(at, m, x);
    if (!(at[0] >= -s && at[0] <= (double)m->width + s && at[1] >= -s && at[1] <= (double)m->height + s)) return false;
    for (size_t row = pixel_at(at[1] - s, m->height); row <= pixel_at(at[1] + s, m->height); row++)
        for (size_t k = pixel_at(at[0] - s, m->width); k <= pixel_at(at[0] + s, m->width); k++)
            if (m->solid[row * m->width + k]) return true;
    return false;
}

/* Distance of a place from pixel k along a row. */
static double away(double at, size_t k)
{
    return fmax(fmax((double)k - at, at - (double)(k + 1)), 0.0);
}

bool mask_fits(const mask *m, const double x[2], double radius)
{
    double at[2];
    const double r = radius / m->scale;
    to_pixels(at, m, x);
    if (!(at[0] >= r && at[0] + r <= (double)m->width && at[1] >= r && at[1] + r <= (double)m->height)) return false;
    for (size_t row = pixel_at(at[1] - r, m->height); row <= pixel_at(at[1] + r, m->height); row++)
        for (size_t k = pixel_at(at[0] - r, m->width); k <= pixel_at(at[0] + r, m->width); k++) {
            const double dx = away(at[0], k), dy = away(at[1], row);
            if (!m->solid[row * m->width + k] && dx * dx + dy * dy < r * r) return false;
        }
    return true;
}

size_t mask_slice(const mask *m, size_t k, double *x)
{
    const unsigned char *solid = m->solid + k * m->width;
    size_t n = 0;
    for (size_t i = 0; i <= m->width; i++) {
        const bool here = i < m->width && solid[i], before = i > 0 && solid[i - 1];
        if (here != before) x[n++] = ((double)i - 0.5 * (double)m->width) * m->scale;
    }
    return n;
}
