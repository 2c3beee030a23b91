/* SPDX-License-Identifier: BSD-3-Clause */
#include "panel.h"

#include <stdio.h>
#include <stdlib.h>

#include "obstacle_fill.h"
#include "raster.h"
#include "shape_batch.h"

enum { FINE = 2 }; /* pixels of a raster to one of the picture */

double panel_scale(const panel *p)
{
    return box_width(p->place) / box_width(p->view);
}

double panel_thickness(double length)
{
    return fmin(fmax(0.26 * length, 1.2), 3.0);
}

static void place(const panel *p, const double x[2], double out[2])
{
    const double scale = panel_scale(p);
    out[0] = p->place.x0 + scale * (x[0] - p->view.x0);
    out[1] = p->place.y1 - scale * (x[1] - p->view.y0);
}

/* Corners of a spring or a triangle in the picture; whether it can be seen. */
static bool place_all(const panel *p, const snapshot *s, const dem_index *nodes, int n, double *out)
{
    for (int k = 0; k < n; k++) place(p, s->x + 2 * nodes[k], out + 2 * k);
    return box_meets(box_around(n, out), p->place);
}

/* ---- vectors ---- */

static unsigned char shade_of(const panel_look *look, double value)
{
    return (unsigned char)palette_index(value, look->range.lo, look->range.hi);
}

static bool has_spring(const snapshot *s, dem_index spring)
{
    return s->broken_springs[spring] == 0.0;
}

static bool has_triangle(const snapshot *s, dem_index triangle)
{
    return s->broken_triangles[triangle] == 0;
}

static bool gather_springs(const panel *p, const snapshot *s, const panel_look *look, shape_batch *h)
{
    const dem_lattice *l = s->lattice;
    if (!shape_batch_create(h, (size_t)l->n_springs, 2)) return false;
    for (dem_index k = 0; k < l->n_springs; k++) {
        if (!has_spring(s, k) || !place_all(p, s, l->ends + 2 * k, 2, h->xy + 4 * h->n)) continue;
        h->shade[h->n++] = shade_of(look, snapshot_spring_value(s, k));
    }
    return true;
}

static bool gather_triangles(const panel *p, const snapshot *s, const panel_look *look, shape_batch *h)
{
    const dem_lattice *l = s->lattice;
    if (!shape_batch_create(h, (size_t)l->n_triangles, 3)) return false;
    for (dem_index k = 0; k < l->n_triangles; k++) {
        if (!has_triangle(s, k) || !place_all(p, s, l->triangles + 3 * k, 3, h->xy + 6 * h->n)) continue;
        h->shade[h->n++] = shade_of(look, snapshot_triangle_value(s, k));
    }
    return true;
}

static bool draw_vectors(const panel *p, const snapshot *s, const panel_look *look, canvas *c)
{
    const bool filled = quantity_fills_triangles(s->shown, s->lattice);
    shape_batch h;
    char attributes[80];
    if (!(filled ? gather_triangles : gather_springs)(p, s, look, &h)) return false;
    (void)snprintf(attributes, sizeof attributes, "class=\"%s\" data-count=\"%zu\"", filled ? "triangles" : "springs",
                   h.n);
    c->begin(c, attributes, NULL);
    const bool drawn = shape_batch_draw(&h, look->colours, filled ? 0.0 : look->thick, c);
    c->end(c);
    shape_batch_free(&h);
    return drawn;
}

/* ---- pixels ---- */

static void bin(const panel *p, const snapshot *s, const panel_look *look, raster *r)
{
    const dem_lattice *l = s->lattice;
    const panel fine = {p->view, {0.0, 0.0, r->width, r->height}};
    const int thick = (int)fmax(1.0, round(FINE * look->thick));
    double xy[6];
    if (quantity_fills_triangles(s->shown, s->lattice)) {
        for (dem_index k = 0; k < l->n_triangles; k++) {
            const dem_index *corner = l->triangles + 3 * k;
            const double value[] = {s->value[corner[0]], s->value[corner[1]], s->value[corner[2]]};
            if (has_triangle(s, k) && place_all(&fine, s, corner, 3, xy)) raster_triangle(r, xy, value);
        }
        return;
    }
    for (dem_index k = 0; k < l->n_springs; k++)
        if (has_spring(s, k) && place_all(&fine, s, l->ends + 2 * k, 2, xy))
            raster_line(r, xy, thick, snapshot_spring_value(s, k));
}

static bool draw_pixels(const panel *p, const snapshot *s, const panel_look *look, canvas *c)
{
    raster r;
    canvas_image image = {0};
    char attributes[80];
    if (!raster_create(&r, (int)lround(FINE * box_width(p->place)), (int)lround(FINE * box_height(p->place))))
        return false;
    bin(p, s, look, &r);
    const bool drawn = raster_render(&r, look->colours, look->range.lo, look->range.hi, &image);
    (void)snprintf(attributes, sizeof attributes, "class=\"pixels\" data-count=\"%ld\"", raster_count(&r));
    raster_free(&r);
    if (!drawn) return false;
    c->begin(c, attributes, NULL);
    c->image(c, p->place, &image);
    c->end(c);
    free(image.argb);
    return true;
}

/* ---- all of it ---- */

static bool draw_ground(const panel *p, const snapshot *s, canvas *c)
{
    const dem_index n = dem_reader_n_obstacles(s->reader);
    for (dem_index k = 0; k < n; k++) {
        obstacle_fill solid;
        if (!obstacle_fill_at(dem_reader_obstacle(s->reader, k), s->t, p->view, &solid)) return false;
        for (size_t i = 0; i < solid.n; i++) place(p, solid.xy + 2 * i, solid.xy + 2 * i);
        if (solid.n > 0) c->fills(c, canvas_dark, solid.n, 1, solid.xy);
        free(solid.xy);
    }
    return true;
}

/* Nodes without springs, as dots. */
static void draw_points(const panel *p, const snapshot *s, const panel_look *look, canvas *c)
{
    const bool has_value = s->shown->source != NULL && !s->shown->source->of_springs;
    const double size = 7.0;
    for (dem_index k = 0; k < s->lattice->n_nodes; k++) {
        double xy[4];
        if (!s->is_bare[k]) continue;
        place(p, s->x + 2 * k, xy);
        xy[2] = xy[0], xy[3] = xy[1];
        const colour ink = has_value ? look->colours->of[shade_of(look, s->value[k])] : canvas_grey;
        c->strokes(c, (canvas_pen){ink, size}, 2, 1, xy);
    }
}

/* Over all triangles, so that both sides of a crack are seen. */
static bool draw_cracks(const panel *p, const snapshot *s, canvas *c)
{
    const double width = fmin(fmax(0.08 * panel_scale(p) * snapshot_spacing(s), 0.8), 2.5);
    char attributes[80];
    shape_batch h;
    if (s->cracks.n == 0) return true;
    if (!shape_batch_create(&h, (size_t)s->cracks.n, 2)) return false;
    for (dem_index k = 0; k < s->cracks.n; k++) {
        const cracks_side *side = &s->cracks.side[k];
        h.n += cracks_open(side, s->broken_triangles) && place_all(p, s, side->node, 2, h.xy + 4 * h.n);
    }
    (void)snprintf(attributes, sizeof attributes, "class=\"cracks\" data-count=\"%zu\"", h.n);
    c->begin(c, attributes, NULL);
    if (h.n > 0) c->strokes(c, (canvas_pen){canvas_black, width}, 2, h.n, h.xy);
    c->end(c);
    shape_batch_free(&h);
    return true;
}

bool panel_draw(const panel *p, const snapshot *s, const panel_look *look, canvas *c)
{
    char attributes[400];
    const box b = s->bounds, v = p->view, at = p->place;
    (void)snprintf(attributes, sizeof attributes,
                   "id=\"frame-%lld\" data-time=\"%.9g\" data-bounds=\"%.9g %.9g %.9g %.9g\" "
                   "data-view=\"%.9g %.9g %.9g %.9g\" data-place=\"%.2f %.2f %.2f %.2f\"",
                   (long long)s->frame, s->t, b.x0, b.y0, b.x1, b.y1, v.x0, v.y0, v.x1, v.y1, at.x0, at.y0, at.x1,
                   at.y1);
    c->begin(c, attributes, &at);
    const bool drawn =
        draw_ground(p, s, c) && (look->is_binned ? draw_pixels : draw_vectors)(p, s, look, c) && draw_cracks(p, s, c);
    draw_points(p, s, look, c);
    c->end(c);
    canvas_outline(c, (canvas_pen){canvas_light, 1.0}, at);
    return drawn;
}
