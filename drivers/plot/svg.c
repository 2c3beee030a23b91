/* SPDX-License-Identifier: BSD-3-Clause */
#include "svg.h"

#include <stdlib.h>

#include "paint.h"

typedef struct svg {
    canvas face; /* first: a canvas is one of these */
    FILE *file;
    int clips;   /* so far */
    bool failed; /* but for what the file itself keeps */
} svg;

static FILE *file_of(canvas *c)
{
    return ((svg *)c)->file;
}

/* Texts of ours and of files: five characters have a meaning in XML, and control characters have no place there. */
static void print_escaped(FILE *file, const char *text)
{
    for (; *text != '\0'; text++) {
        switch (*text) {
        case '&':
            (void)fputs("&amp;", file);
            break;
        case '<':
            (void)fputs("&lt;", file);
            break;
        case '>':
            (void)fputs("&gt;", file);
            break;
        default:
            (void)fputc((unsigned char)*text < ' ' ? ' ' : *text, file);
        }
    }
}

/* A coordinate, counted in hundredths, as short as it can be. */
static void print_hundredths(FILE *file, long n, char before)
{
    const long size = labs(n);
    if (n < 0) before = '-';
    if (before != '\0') (void)fputc(before, file);
    if (size % 100 == 0)
        (void)fprintf(file, "%ld", size / 100);
    else if (size % 10 == 0)
        (void)fprintf(file, size < 100 ? ".%ld" : "%ld.%ld", size < 100 ? size / 10 : size / 100, size / 10 % 10);
    else
        (void)fprintf(file, size < 100 ? ".%02ld" : "%ld.%02ld", size < 100 ? size : size / 100, size % 100);
}

/* What follows the first point is relative to the rounded one before it: short, and errors do not add up. */
static void print_path(FILE *file, size_t corners, const double *xy, const char *end)
{
    long x = 0, y = 0;
    for (size_t k = 0; k < corners; k++) {
        const long X = lround(100.0 * xy[2 * k]), Y = lround(100.0 * xy[2 * k + 1]);
        if (k < 2) (void)fputc(k == 0 ? 'M' : 'l', file);
        print_hundredths(file, X - x, k < 2 ? '\0' : ' ');
        print_hundredths(file, Y - y, ' ');
        x = X, y = Y;
    }
    (void)fputs(end, file);
}

static void print_ink(FILE *file, const char *what, colour ink)
{
    (void)fprintf(file, " %s=\"#%02x%02x%02x\"", what, ink.red, ink.green, ink.blue);
}

static void begin(canvas *c, const char *attributes, const box *clip)
{
    svg *own = (svg *)c;
    FILE *file = own->file;
    if (clip != NULL)
        (void)fprintf(
            file, "<clipPath id=\"clip%d\"><rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\"/></clipPath>\n",
            ++own->clips, clip->x0, clip->y0, box_width(*clip), box_height(*clip));
    (void)fprintf(file, "<g %s", attributes);
    if (clip != NULL) (void)fprintf(file, " clip-path=\"url(#clip%d)\"", own->clips);
    (void)fputs(">\n", file);
}

static void end(canvas *c)
{
    (void)fputs("</g>\n", file_of(c));
}

static void strokes(canvas *c, canvas_pen pen, size_t corners, size_t n, const double *xy)
{
    FILE *file = file_of(c);
    (void)fputs("<path", file);
    print_ink(file, "stroke", pen.ink);
    (void)fprintf(file, " stroke-width=\"%.2f\" d=\"", pen.width);
    for (size_t k = 0; k < n; k++) print_path(file, corners, xy + 2 * corners * k, "");
    (void)fputs("\"/>\n", file);
}

/* The thin line around each covers the seam that antialiasing would leave. */
static void fills(canvas *c, colour ink, size_t corners, size_t n, const double *xy)
{
    FILE *file = file_of(c);
    (void)fputs("<path", file);
    print_ink(file, "fill", ink);
    print_ink(file, "stroke", ink);
    (void)fputs(" stroke-width=\".4\" d=\"", file);
    for (size_t k = 0; k < n; k++) print_path(file, corners, xy + 2 * corners * k, "z");
    (void)fputs("\"/>\n", file);
}

static void write_label(canvas *c, const canvas_label *label)
{
    static const char *const anchors[] = {"start", "middle", "end"};
    FILE *file = file_of(c);
    (void)fprintf(file, "<text x=\"%.2f\" y=\"%.2f\" font-size=\"%.4g\" text-anchor=\"%s\"", label->x, label->y,
                  label->size, anchors[label->anchor]);
    if (label->upright) (void)fprintf(file, " transform=\"rotate(-90 %.2f %.2f)\"", label->x, label->y);
    print_ink(file, "fill", label->ink);
    (void)fputc('>', file);
    print_escaped(file, label->text);
    (void)fputs("</text>\n", file);
}

typedef struct base64 {
    FILE *file;
    uint32_t bits;
    int bytes; /* in `bits`, 0 to 2 */
} base64;

static void put_sextets(base64 *b, int n)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (int k = 0; k < 4; k++) (void)fputc(k < n ? digits[b->bits >> (18 - 6 * k) & 63] : '=', b->file);
    *b = (base64){.file = b->file};
}

static bool put_bytes(void *to, const unsigned char *bytes, size_t size)
{
    base64 *b = to;
    for (size_t k = 0; k < size; k++) {
        b->bits |= (uint32_t)bytes[k] << (16 - 8 * b->bytes++);
        if (b->bytes == 3) put_sextets(b, 4);
    }
    return true;
}

static void put_image(canvas *c, box place, const canvas_image *image)
{
    svg *own = (svg *)c;
    base64 to = {.file = own->file};
    (void)fprintf(own->file,
                  "<image x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" href=\"data:image/png;base64,", place.x0,
                  place.y0, box_width(place), box_height(place));
    if (!paint_png(image, put_bytes, &to)) own->failed = true;
    if (to.bytes > 0) put_sextets(&to, to.bytes + 1);
    (void)fputs("\"/>\n", own->file);
}

static bool close_svg(canvas *c, const char *note)
{
    svg *own = (svg *)c;
    (void)fputs("<metadata>", own->file);
    print_escaped(own->file, note);
    (void)fputs("</metadata>\n</svg>\n", own->file);
    const bool written = !own->failed && fflush(own->file) == 0 && ferror(own->file) == 0;
    free(own);
    return written;
}

canvas *svg_open(FILE *file, double width, double height)
{
    svg *own = malloc(sizeof *own);
    if (own == NULL) return NULL;
    *own = (svg){.face = {begin, end, strokes, fills, write_label, put_image, close_svg}, .file = file};
    (void)fprintf(file,
                  "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" viewBox=\"0 0 %.0f %.0f\" "
                  "font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\" fill=\"none\" stroke-linecap=\"round\" "
                  "stroke-linejoin=\"round\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n",
                  width, height, width, height);
    return &own->face;
}
