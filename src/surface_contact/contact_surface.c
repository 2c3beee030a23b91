/* SPDX-License-Identifier: BSD-3-Clause */
/* Compiles the surface of the bodies for contact with each other. The modulus of a body is
 *   M = (sum over its springs of E_ij d0_ij)/(3 A),
 * with A the area of its triangles: (8/3) G h of a regular lattice, so that its surface is about as stiff as what is
 * behind it. Thickness and modulus are those of the rest shape and never change. Which nodes are near which edges is
 * found in pair_list.c. */
#include "surface_contact/contact_surface.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"

static const double usual_thickness = 0.2;    /* of the mean edge of a body */
static const double largest_thickness = 0.45; /* of its shortest edge, if nothing is asked for */

/* The boundary edges of a body. */
typedef struct body_edges {
    double length, shortest; /* m, of all, and of one */
    dem_index n;
} body_edges;

/* Notes the triangle as that of its side behind a corner, if that side is an edge of the surface. */
static void note_triangle(contact_surface *c, dem_index triangle, int side)
{
    const surface *s = &c->surface;
    const dem_lattice *l = c->lattice;
    const dem_index *corner = &l->triangles[3 * triangle], i = corner[side], j = corner[(side + 1) % 3];
    for (dem_index p = s->row[i]; p < s->row[i + 1]; p++) {
        const dem_index edge = s->at[p];
        if (s->ends[2 * edge] != i || s->ends[2 * edge + 1] != j) continue;
        c->corner[edge] = corner[(side + 2) % 3];
        c->plate[edge] = l->thickness != NULL ? l->thickness[triangle] : 1.0;
    }
}

/* A side that runs along an edge of the surface is that of a whole triangle: no other triangle has it in this sense. */
static void find_triangles(contact_surface *c, const mesh_boundary *boundary)
{
    for (dem_index k = 0; k < boundary->n; k++)
        for (int side = 0; side < 3; side++) note_triangle(c, boundary->list[k].triangle, side);
}

static double rest_length(const contact_surface *c, dem_index edge)
{
    const double *x = c->lattice->x;
    return vec2_norm(vec2_sub(vec2_at(x, contact_surface_second(c, edge)), vec2_at(x, contact_surface_first(c, edge))));
}

/* A node has half of each of its edges, and feels half of the pressure on that: the other half comes from the other
 * surface's nodes. */
static void list_nodes(contact_surface *c)
{
    const surface *s = &c->surface;
    for (dem_index e = 0; e < s->n_edges; e++) c->length[e] = rest_length(c, e);
    for (dem_index i = 0; i < c->lattice->n_nodes; i++) {
        if (s->row[i] == s->row[i + 1]) continue;
        double length = 0.0;
        for (dem_index p = s->row[i]; p < s->row[i + 1]; p++) length += c->length[s->at[p]];
        c->nodes[c->n_nodes] = i;
        c->half_length[c->n_nodes++] = 0.25 * length;
    }
}

static dem_status allocate_outline(contact_surface *c)
{
    const size_t n = (size_t)c->surface.n_edges + 1; /* no more nodes than edges, where no two outlines meet */
    c->nodes = malloc(n * sizeof *c->nodes);
    c->half_length = malloc(n * sizeof *c->half_length);
    c->corner = malloc(n * sizeof *c->corner);
    c->length = malloc(n * sizeof *c->length);
    c->plate = malloc(n * sizeof *c->plate);
    c->opposite = malloc(n * sizeof *c->opposite);
    c->filled = malloc(n * sizeof *c->filled);
    CHECK(c->nodes && c->half_length && c->corner && c->length && c->plate && c->opposite && c->filled,
          DEM_ERROR_MEMORY, "out of memory for a surface of %lld edges", (long long)c->surface.n_edges);
    return DEM_OK;
}

void contact_surface_free_outline(contact_surface *c)
{
    surface_free(&c->surface);
    free(c->nodes);
    free(c->half_length);
    free(c->corner);
    free(c->length);
    free(c->plate);
    free(c->opposite);
    free(c->filled);
}

/* ---- what is broken beside it ---- */

double contact_surface_height(const contact_surface *c, dem_index edge)
{
    const double *x = c->lattice->x;
    const vec2 a = vec2_at(x, contact_surface_first(c, edge)), b = vec2_at(x, contact_surface_second(c, edge));
    return vec2_cross(vec2_sub(vec2_at(x, c->opposite[edge]), a), vec2_sub(b, a)) / c->length[edge];
}

/* A broken triangle runs along the edge the other way. */
static void note_broken(contact_surface *c, dem_index triangle, int side)
{
    const dem_index *corner = &c->lattice->triangles[3 * triangle], opposite = corner[(side + 2) % 3];
    const dem_index edge = contact_surface_edge(c, corner[(side + 1) % 3], corner[side]);
    if (edge >= 0 && c->surface.row[opposite] < c->surface.row[opposite + 1]) c->opposite[edge] = opposite;
}

/* Of what may be crushed nothing is left. */
static bool may_fill(const dem_lattice *l, dem_index triangle)
{
    return l->compressive_strength == NULL || !isfinite(l->compressive_strength[triangle]);
}

static dem_index next_broken(const unsigned char *broken, dem_index from, dem_index n)
{
    const unsigned char *next = from < n ? memchr(broken + from, 1, (size_t)(n - from)) : NULL;
    return next != NULL ? (dem_index)(next - broken) : n;
}

static void find_broken(contact_surface *c, const unsigned char *broken)
{
    const dem_index n = broken != NULL ? c->lattice->n_triangles : 0;
    for (dem_index e = 0; e < c->surface.n_edges; e++) c->opposite[e] = -1;
    for (dem_index t = next_broken(broken, 0, n); t < n; t = next_broken(broken, t + 1, n))
        for (int side = 0; may_fill(c->lattice, t) && side < 3; side++) note_broken(c, t, side);
}

/* How far an edge and the corner opposite are apart at positions x, m, where that is less than at rest. */
static double room_at(const contact_surface *c, dem_index edge, const double *x)
{
    const vec2 a = vec2_at(x, contact_surface_first(c, edge));
    const vec2 t = vec2_sub(vec2_at(x, contact_surface_second(c, edge)), a);
    const double gap = vec2_cross(vec2_sub(vec2_at(x, c->opposite[edge]), a), t) / vec2_norm(t);
    return fmin(fmax(gap, 0.0), contact_surface_height(c, edge));
}

/* What was filled before stays as it was; the rest is filled from now on. */
static double find_filled(const contact_surface *c, const contact_surface *before, dem_index edge, const double *x)
{
    if (c->opposite[edge] < 0) return 0.0;
    const dem_index first = contact_surface_first(c, edge), second = contact_surface_second(c, edge);
    const dem_index was = before != NULL ? contact_surface_edge(before, first, second) : -1;
    if (was >= 0 && before->opposite[was] == c->opposite[edge]) return before->filled[was];
    return x != NULL ? room_at(c, edge, x) : contact_surface_height(c, edge);
}

static void fill(contact_surface *c, const contact_surface *before, const double *x)
{
    c->highest = 0.0;
    for (dem_index e = 0; e < c->surface.n_edges; e++) {
        c->filled[e] = find_filled(c, before, e, x);
        c->highest = fmax(c->highest, c->filled[e]);
    }
}

/* Fills in edges and nodes; `out` has a lattice, and no edges as yet. */
static dem_status find_outline(contact_surface *out, const mesh_boundary *boundary, const unsigned char *broken)
{
    TRY(surface_compile_boundary(&out->surface, out->lattice, boundary, SURFACE_WHOLE));
    TRY(allocate_outline(out));
    list_nodes(out);
    find_triangles(out, boundary);
    find_broken(out, broken);
    return DEM_OK;
}

dem_status contact_surface_break(contact_surface *out, const contact_surface *c, const mesh_boundary *boundary,
                                 const unsigned char *broken, const double *x)
{
    contact_surface next = {.lattice = c->lattice,
                            .part = c->part,
                            .n_bodies = c->n_bodies,
                            .laws = c->laws,
                            .least = c->least,
                            .most = c->most,
                            .mean_length = c->mean_length};
    const dem_status status = find_outline(&next, boundary, broken);
    if (status == DEM_OK) {
        fill(&next, c, x);
        *out = next;
    } else {
        contact_surface_free_outline(&next);
    }
    return status;
}

/* ---- what a checkpoint has of it ---- */

static bool is_squeezed(const contact_surface *c, dem_index edge)
{
    return c->opposite[edge] >= 0 && c->filled[edge] < contact_surface_height(c, edge);
}

dem_index contact_surface_squeezed(const contact_surface *c, squeezed_filling *list)
{
    dem_index n = 0;
    for (dem_index e = 0; e < c->surface.n_edges; e++) {
        if (!is_squeezed(c, e)) continue;
        if (list != NULL)
            list[n] = (squeezed_filling){contact_surface_first(c, e), contact_surface_second(c, e), c->filled[e]};
        n++;
    }
    return n;
}

static dem_status squeeze(contact_surface *c, const squeezed_filling *of)
{
    const dem_index n = c->lattice->n_nodes;
    const bool possible = of->first >= 0 && of->first < n && of->second >= 0 && of->second < n;
    const dem_index edge = possible ? contact_surface_edge(c, of->first, of->second) : -1;
    CHECK(edge >= 0 && c->opposite[edge] >= 0 && of->height >= 0.0 && of->height <= contact_surface_height(c, edge),
          DEM_ERROR_IO, "the checkpoint has a filling of %g m at an edge between nodes %lld and %lld", of->height,
          (long long)of->first, (long long)of->second);
    c->filled[edge] = of->height;
    return DEM_OK;
}

dem_status contact_surface_squeeze(contact_surface *c, const squeezed_filling *list, dem_index n)
{
    fill(c, NULL, NULL);
    for (dem_index k = 0; k < n; k++) TRY(squeeze(c, &list[k]));
    return DEM_OK;
}

/* ---- laws ---- */

static void sum_up(contact_surface *c, body_edges *of)
{
    for (dem_index b = 0; b < c->n_bodies; b++) of[b].shortest = INFINITY;
    for (dem_index e = 0; e < c->surface.n_edges; e++) {
        body_edges *edges = &of[contact_surface_body(c, contact_surface_first(c, e))];
        edges->length += c->length[e];
        edges->shortest = fmin(edges->shortest, c->length[e]);
        edges->n++;
        c->mean_length += c->length[e] / (double)c->surface.n_edges;
    }
}

static dem_status choose_law(contact_surface *c, dem_index body, const body_edges *edges, double thickness,
                             double modulus)
{
    CHECK(edges->n > 0, DEM_ERROR_MODEL, "body %lld has no triangles, and so no surface that could touch bodies",
          (long long)body);
    const double usual = fmin(usual_thickness * edges->length / (double)edges->n, largest_thickness * edges->shortest);
    const surface_law law = {thickness > 0.0 ? thickness : usual, modulus, 0.0};
    CHECK(law.thickness < 0.5 * edges->shortest, DEM_ERROR_MODEL,
          "the contact thickness of %g m is not below half of the shortest boundary edge of body %lld, %g m",
          law.thickness, (long long)body, edges->shortest);
    c->laws[body] = law;
    return DEM_OK;
}

static void compare_laws(contact_surface *c)
{
    c->least = c->most = c->laws[0];
    for (dem_index b = 1; b < c->n_bodies; b++) {
        const surface_law law = c->laws[b];
        c->least = surface_law_smaller(c->least, law);
        c->most = (surface_law){fmax(c->most.thickness, law.thickness), fmax(c->most.modulus, law.modulus),
                                fmax(c->most.friction, law.friction)};
    }
}

static dem_status choose_laws(contact_surface *c, const body_content *content, double thickness, double stiffness)
{
    body_edges *edges = calloc((size_t)c->n_bodies, sizeof *edges);
    CHECK_MEMORY(edges);
    dem_status status = DEM_OK;
    sum_up(c, edges);
    for (dem_index b = 0; b < c->n_bodies && status == DEM_OK; b++)
        status = choose_law(c, b, &edges[b], thickness, stiffness * content[b].springs / (3.0 * content[b].area));
    free(edges);
    compare_laws(c);
    return status;
}

static dem_status compile(contact_surface *out, contact_surface c, const touching_bodies *bodies, double thickness,
                          double stiffness)
{
    c.n_bodies = bodies->n_bodies;
    c.laws = calloc((size_t)c.n_bodies + 1, sizeof *c.laws);
    CHECK_MEMORY(c.laws);
    dem_status status = find_outline(&c, &bodies->boundary, NULL);
    if (status == DEM_OK) {
        fill(&c, NULL, NULL);
        status = choose_laws(&c, bodies->bodies, thickness, stiffness);
    }
    if (status == DEM_OK)
        *out = c;
    else
        contact_surface_free(&c);
    return status;
}

dem_status contact_surface_compile(contact_surface *out, const dem_lattice *lattice, double thickness, double stiffness)
{
    touching_bodies bodies;
    TRY(touching_bodies_create(&bodies, lattice));
    const contact_surface c = {.lattice = lattice};
    const dem_status status = compile(out, c, &bodies, thickness, stiffness);
    touching_bodies_free(&bodies);
    return status;
}

dem_status contact_surface_compile_part(contact_surface *out, const dem_lattice *lattice, const touching_bodies *bodies,
                                        double thickness, double stiffness)
{
    const contact_surface c = {.lattice = lattice, .part = bodies};
    return compile(out, c, bodies, thickness, stiffness);
}

void contact_surface_free(contact_surface *c)
{
    contact_surface_free_outline(c);
    free(c->laws);
    *c = (contact_surface){0};
}

void contact_surface_set_friction(contact_surface *c, double of_all, const double *of_bodies)
{
    for (dem_index b = 0; b < c->n_bodies; b++) c->laws[b].friction = of_bodies != NULL ? of_bodies[b] : of_all;
    compare_laws(c);
}
