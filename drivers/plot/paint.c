/* SPDX-License-Identifier: BSD-3-Clause */
#include "paint.h"

#include <cairo-pdf.h>
#include <stdlib.h>

typedef struct paint {
    canvas face; /* first: a canvas is one of these */
    FILE *file;
    cairo_surface_t *surface;
    cairo_t *cairo;
    bool paged; /* PDF: written by cairo as it goes */
} paint;

static cairo_t *cairo_of(canvas *c)
{
    return ((paint *)c)->cairo;
}

static void set_ink(cairo_t *cairo, colour ink)
{
    cairo_set_source_rgb(cairo, ink.red / 255.0, ink.green / 255.0, ink.blue / 255.0);
}

static void begin(canvas *c, const char *attributes, const box *clip)
{
    cairo_t *cairo = cairo_of(c);
    (void)attributes;
    cairo_save(cairo);
    if (clip == NULL) return;
    cairo_rectangle(cairo, clip->x0, clip->y0, box_width(*clip), box_height(*clip));
    cairo_clip(cairo);
}

static void end(canvas *c)
{
    cairo_restore(cairo_of(c));
}

static void trace(cairo_t *cairo, size_t corners, size_t n, const double *xy, bool closed)
{
    for (size_t k = 0; k < n; k++) {
        cairo_new_sub_path(cairo);
        for (size_t i = 0; i < corners; i++, xy += 2) cairo_line_to(cairo, xy[0], xy[1]);
        if (closed) cairo_close_path(cairo);
    }
}

static void strokes(canvas *c, canvas_pen pen, size_t corners, size_t n, const double *xy)
{
    cairo_t *cairo = cairo_of(c);
    set_ink(cairo, pen.ink);
    cairo_set_line_width(cairo, pen.width);
    trace(cairo, corners, n, xy, false);
    cairo_stroke(cairo);
}

/* The thin line around each covers the seam that antialiasing would leave. */
static void fills(canvas *c, colour ink, size_t corners, size_t n, const double *xy)
{
    cairo_t *cairo = cairo_of(c);
    set_ink(cairo, ink);
    cairo_set_line_width(cairo, 0.4);
    trace(cairo, corners, n, xy, true);
    cairo_fill_preserve(cairo);
    cairo_stroke(cairo);
}

static void write_label(canvas *c, const canvas_label *label)
{
    cairo_t *cairo = cairo_of(c);
    cairo_text_extents_t extents;
    cairo_save(cairo);
    set_ink(cairo, label->ink);
    cairo_set_font_size(cairo, label->size);
    cairo_text_extents(cairo, label->text, &extents);
    cairo_translate(cairo, label->x, label->y);
    if (label->upright) cairo_rotate(cairo, -0.5 * acos(-1.0));
    cairo_move_to(cairo, -0.5 * (double)label->anchor * extents.x_advance, 0.0);
    cairo_show_text(cairo, label->text);
    cairo_restore(cairo);
}

static cairo_surface_t *surface_of(const canvas_image *image)
{
    unsigned char *bytes = (unsigned char *)image->argb;
    return cairo_image_surface_create_for_data(bytes, CAIRO_FORMAT_ARGB32, image->width, image->height,
                                               4 * image->width);
}

static void put_image(canvas *c, box place, const canvas_image *image)
{
    cairo_t *cairo = cairo_of(c);
    cairo_surface_t *surface = surface_of(image);
    cairo_save(cairo);
    cairo_translate(cairo, place.x0, place.y0);
    cairo_scale(cairo, box_width(place) / image->width, box_height(place) / image->height);
    cairo_set_source_surface(cairo, surface, 0.0, 0.0);
    cairo_pattern_set_extend(cairo_get_source(cairo), CAIRO_EXTEND_PAD); /* edges do not fade */
    cairo_rectangle(cairo, 0.0, 0.0, image->width, image->height);
    cairo_fill(cairo);
    cairo_restore(cairo);
    cairo_surface_destroy(surface);
}

static cairo_status_t put_file(void *file, const unsigned char *bytes, unsigned size)
{
    return fwrite(bytes, 1, size, file) == size ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_WRITE_ERROR;
}

static bool close_paint(canvas *c, const char *note)
{
    paint *own = (paint *)c;
    if (own->paged) {
        cairo_pdf_surface_set_metadata(own->surface, CAIRO_PDF_METADATA_SUBJECT, note);
        cairo_pdf_surface_set_metadata(own->surface, CAIRO_PDF_METADATA_CREATE_DATE, ""); /* same data, same bytes */
    }
    bool painted = cairo_status(own->cairo) == CAIRO_STATUS_SUCCESS;
    cairo_destroy(own->cairo);
    if (!own->paged)
        painted =
            painted && cairo_surface_write_to_png_stream(own->surface, put_file, own->file) == CAIRO_STATUS_SUCCESS;
    cairo_surface_finish(own->surface);
    painted = painted && cairo_surface_status(own->surface) == CAIRO_STATUS_SUCCESS;
    cairo_surface_destroy(own->surface);
    painted = fflush(own->file) == 0 && ferror(own->file) == 0 && painted;
    free(own);
    return painted;
}

static canvas *open_paint(FILE *file, cairo_surface_t *surface, bool paged)
{
    paint *own = malloc(sizeof *own);
    if (own == NULL) {
        cairo_surface_destroy(surface);
        return NULL;
    }
    cairo_t *cairo = cairo_create(surface);
    *own = (paint){{begin, end, strokes, fills, write_label, put_image, close_paint}, file, surface, cairo, paged};
    cairo_set_source_rgb(cairo, 1.0, 1.0, 1.0);
    cairo_paint(cairo);
    cairo_set_line_cap(cairo, CAIRO_LINE_CAP_ROUND);
    cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
    cairo_select_font_face(cairo, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    return &own->face;
}

canvas *paint_open_png(FILE *file, double width, double height)
{
    return open_paint(file, cairo_image_surface_create(CAIRO_FORMAT_RGB24, (int)lround(width), (int)lround(height)),
                      false);
}

canvas *paint_open_pdf(FILE *file, double width, double height)
{
    const double points = 0.75; /* 72 to the inch */
    cairo_surface_t *surface = cairo_pdf_surface_create_for_stream(put_file, file, points * width, points * height);
    cairo_pdf_surface_restrict_to_version(surface, CAIRO_PDF_VERSION_1_4); /* as text, whatever cairo's own choice */
    canvas *c = open_paint(file, surface, true);
    if (c != NULL) cairo_scale(cairo_of(c), points, points);
    return c;
}

typedef struct outlet {
    bool (*put)(void *to, const unsigned char *bytes, size_t size);
    void *to;
} outlet;

static cairo_status_t put_outlet(void *closure, const unsigned char *bytes, unsigned size)
{
    const outlet *out = closure;
    return out->put(out->to, bytes, size) ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_WRITE_ERROR;
}

bool paint_png(const canvas_image *image, bool (*put)(void *to, const unsigned char *bytes, size_t size), void *to)
{
    outlet out = {put, to};
    cairo_surface_t *surface = surface_of(image);
    const bool done = cairo_surface_write_to_png_stream(surface, put_outlet, &out) == CAIRO_STATUS_SUCCESS;
    cairo_surface_destroy(surface);
    return done;
}
