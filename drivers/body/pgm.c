/* SPDX-License-Identifier: BSD-3-Clause */
#include "pgm.h"

#include <stdio.h>

#include "base/text_reader.h"

bool pgm_begins(const char *bytes, size_t size)
{
    return size > 2 && bytes[0] == 'P' && (bytes[1] == '2' || bytes[1] == '5');
}

static bool read_header(image *out, text_reader *w, char *magic)
{
    int64_t width, height, white;
    if (!text_reader_next(w, magic) || magic[0] != 'P' || (magic[1] != '2' && magic[1] != '5') || magic[2] != '\0')
        return text_reader_fail(w, "'P2' or 'P5' is expected at the beginning");
    if (!text_reader_integer(w, "the width", 1, IMAGE_MAX_SIDE, &width)) return false;
    if (!text_reader_integer(w, "the height", 1, IMAGE_MAX_SIDE, &height)) return false;
    if (!text_reader_integer(w, "the largest value", 1, 65535, &white)) return false;
    *out = (image){.width = (size_t)width, .height = (size_t)height, .white = (unsigned)white};
    return true;
}

/* A pixel of text takes two bytes, but for the last one. */
static bool has_room(const image *out, text_reader *w, bool text)
{
    const size_t n = out->width * out->height, width = out->white > 255 ? 2 : 1, left = text_reader_left(w);
    if (text)
        return left + 1 >= 2 * n ||
               text_reader_fail(w, "%zu bytes cannot hold %zu x %zu pixels", left, out->width, out->height);
    if (left > 0 && *w->at == '#') return text_reader_fail(w, "a comment behind the largest value");
    if (left == n * width + 1) return true;
    return text_reader_fail(w, "%zu x %zu pixels take %zu bytes, but %zu follow the header", out->width, out->height,
                            n * width, left > 0 ? left - 1 : 0);
}

static bool read_text(image *out, text_reader *w)
{
    char word[TEXT_READER_LONGEST + 1];
    const size_t n = out->width * out->height;
    for (size_t k = 0; k < n; k++) {
        int64_t value;
        if (!text_reader_integer(w, "a pixel", 0, out->white, &value)) return false;
        out->grey[k] = (uint16_t)value;
    }
    return text_reader_next(w, word)
               ? text_reader_fail(w, "there are more than %zu x %zu pixels", out->width, out->height)
               : w->fault[0] == '\0';
}

/* Behind the one blank that ends the header; of two bytes the higher one comes first. */
static bool read_bytes(image *out, text_reader *w)
{
    const unsigned char *from = (const unsigned char *)w->at + 1;
    const size_t n = out->width * out->height;
    for (size_t k = 0; k < n; k++) {
        const unsigned value = out->white > 255 ? 256U * from[2 * k] + from[2 * k + 1] : from[k];
        if (value > out->white)
            return text_reader_fail(w, "the pixel in column %zu of row %zu is %u, larger than %u", k % out->width + 1,
                                    k / out->width + 1, value, out->white);
        out->grey[k] = (uint16_t)value;
    }
    return true;
}

bool pgm_measure(image *out, const char *bytes, size_t size)
{
    char word[TEXT_READER_LONGEST + 1];
    text_reader w = text_reader_begin(bytes, size, '#');
    return read_header(out, &w, word);
}

image_status pgm_parse(image *out, char *fault, const char *bytes, size_t size)
{
    char magic[TEXT_READER_LONGEST + 1];
    text_reader w = text_reader_begin(bytes, size, '#');
    *out = (image){0};
    bool good = read_header(out, &w, magic) && has_room(out, &w, magic[1] == '2');
    if (good && !image_create(out)) return IMAGE_MEMORY;
    good = good && (magic[1] == '2' ? read_text(out, &w) : read_bytes(out, &w));
    if (good) return IMAGE_READ;
    image_free(out);
    (void)snprintf(fault, IMAGE_FAULT, "%zu: %s", w.last, w.fault);
    return IMAGE_REFUSED;
}
