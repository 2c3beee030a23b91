/* SPDX-License-Identifier: BSD-3-Clause */
#include "png.h"

#include <stdio.h>
#include <string.h>

static const char magic[8] = "\x89PNG\r\n\x1a\n";

bool png_begins(const char *bytes, size_t size)
{
    return size >= sizeof magic && memcmp(bytes, magic, sizeof magic) == 0;
}

/* The highest byte first. */
static size_t number_at(const char *bytes, size_t at)
{
    const unsigned char *b = (const unsigned char *)bytes + at;
    return ((size_t)b[0] << 24) + ((size_t)b[1] << 16) + ((size_t)b[2] << 8) + b[3];
}

enum { SIZES_END = 24 }; /* bytes */

/* The header is the first chunk: behind the magic its length and name, then width and height. libpng takes others
 * before it, which could state any size. */
bool png_measure(image *out, const char *bytes, size_t size)
{
    if (size < SIZES_END || memcmp(bytes + 12, "IHDR", 4) != 0) return false;
    *out = (image){.width = number_at(bytes, 16), .height = number_at(bytes, 20), .white = 255};
    return true;
}

static image_status refuse(char *fault, const char *why)
{
    (void)snprintf(fault, IMAGE_FAULT, "%s", why);
    return IMAGE_REFUSED;
}

#ifdef DEM_CAIRO
#include <cairo.h>

typedef struct source {
    const char *at;
    size_t left;
} source;

static cairo_status_t give(void *closure, unsigned char *data, unsigned length)
{
    source *from = closure;
    if (length > from->left) return CAIRO_STATUS_READ_ERROR;
    memcpy(data, from->at, length);
    from->at += length;
    from->left -= length;
    return CAIRO_STATUS_SUCCESS;
}

/* Rec. 601 in 256ths; colours are multiplied by their opacity. */
static uint16_t luminance(uint32_t pixel)
{
    const uint32_t red = pixel >> 16 & 255, green = pixel >> 8 & 255, blue = pixel & 255;
    return (uint16_t)((77 * red + 150 * green + 29 * blue + 128) >> 8);
}

/* Newer cairo has channels of sixteen bits as floating numbers; painted, they become their upper eight. NULL without
 * memory. */
static cairo_surface_t *paint(cairo_surface_t *surface)
{
    cairo_surface_t *out = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, cairo_image_surface_get_width(surface),
                                                      cairo_image_surface_get_height(surface));
    cairo_t *brush = cairo_create(out);
    cairo_set_source_surface(brush, surface, 0, 0);
    cairo_paint(brush);
    const bool painted = cairo_status(brush) == CAIRO_STATUS_SUCCESS;
    cairo_destroy(brush);
    if (painted) return out;
    cairo_surface_destroy(out);
    return NULL;
}

static cairo_surface_t *of_eight_bits(cairo_surface_t *surface)
{
    const cairo_format_t format = cairo_image_surface_get_format(surface);
    const bool it_is = format == CAIRO_FORMAT_ARGB32 || format == CAIRO_FORMAT_RGB24;
    return it_is ? cairo_surface_reference(surface) : paint(surface);
}

static bool copy(image *out, cairo_surface_t *surface)
{
    const unsigned char *data = cairo_image_surface_get_data(surface);
    const int width = cairo_image_surface_get_width(surface), height = cairo_image_surface_get_height(surface);
    const int stride = cairo_image_surface_get_stride(surface);
    *out = (image){.width = (size_t)width, .height = (size_t)height, .white = 255};
    if (!image_create(out)) return false;
    for (int row = 0; row < height; row++)
        for (int column = 0; column < width; column++) {
            uint32_t pixel;
            memcpy(&pixel, data + (ptrdiff_t)row * stride + (ptrdiff_t)column * 4, sizeof pixel);
            out->grey[(size_t)row * out->width + (size_t)column] = luminance(pixel);
        }
    return true;
}

static image_status convert(image *out, cairo_surface_t *surface)
{
    cairo_surface_t *pixels = of_eight_bits(surface);
    const bool complete = pixels != NULL && copy(out, pixels);
    cairo_surface_destroy(pixels);
    return complete ? IMAGE_READ : IMAGE_MEMORY;
}

image_status png_parse(image *out, char *fault, const char *bytes, size_t size)
{
    source from = {bytes, size};
    *out = (image){0};
    image own;
    if (!png_measure(&own, bytes, size))
        return refuse(fault, size < SIZES_END ? "the PNG image ends too early"
                                              : "the PNG image does not begin with its header");
    const bool sides = own.width >= 1 && own.width < IMAGE_MAX_SIDE && own.height >= 1 && own.height < IMAGE_MAX_SIDE;
    if (!sides || own.width * own.height > PNG_MAX_PIXELS) {
        (void)snprintf(fault, IMAGE_FAULT, "a PNG image of %zu x %zu pixels; the limit is %d", own.width, own.height,
                       PNG_MAX_PIXELS);
        return IMAGE_REFUSED;
    }
    cairo_surface_t *surface = cairo_image_surface_create_from_png_stream(give, &from);
    const image_status result =
        cairo_surface_status(surface) == CAIRO_STATUS_SUCCESS
            ? convert(out, surface)
            : refuse(fault, "the PNG image is damaged"); /* cairo calls that out of memory, too */
    cairo_surface_destroy(surface);
    return result;
}
#else
image_status png_parse(image *out, char *fault, const char *bytes, size_t size)
{
    (void)bytes;
    (void)size;
    *out = (image){0};
    return refuse(fault, "PNG images need cairo, which is not built in; PGM is always understood");
}
#endif
