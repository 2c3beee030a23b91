/* SPDX-License-Identifier: BSD-3-Clause */
#include "shape/shape_trim.h"

#include <stdlib.h>
#include <string.h>

enum { small_piece = 4 /* triangles */ };

static dem_index count(const bool *flag, dem_index n)
{
    dem_index sum = 0;
    for (dem_index t = 0; t < n; t++) sum += flag[t];
    return sum;
}

/* The triangles on one side of the cut, and their pieces. */
typedef struct half {
    dem_lattice lattice; /* the nodes of all, but its own triangles */
    dem_index *number;   /* [n_triangles] of each of its triangles among all */
    dem_index *piece;    /* [n_triangles] */
    dem_index *size;     /* [n_pieces] triangles */
    dem_index *at;       /* [n_nodes] a piece that has the node, or -1 */
    bool *touches;       /* [n_pieces] another piece in a node */
    dem_index largest;   /* triangles */
} half;

static void half_free(half *s)
{
    free(s->lattice.triangles);
    free(s->number);
    free(s->piece);
    free(s->size);
    free(s->at);
    free(s->touches);
}

/* Pieces share no edge. */
static dem_status find_pieces(half *s)
{
    dem_index n_pieces;
    const dem_status status = dem_lattice_pieces(&s->lattice, &n_pieces, s->piece);
    for (dem_index i = 0; i < s->lattice.n_nodes; i++) s->at[i] = -1;
    for (dem_index t = 0; status == DEM_OK && t < s->lattice.n_triangles; t++) {
        const dem_index piece = s->piece[t], now = ++s->size[piece];
        if (now > s->largest) s->largest = now;
        for (int c = 0; c < 3; c++) {
            dem_index *at = &s->at[s->lattice.triangles[3 * t + c]];
            if (*at >= 0 && *at != piece) s->touches[*at] = s->touches[piece] = true;
            *at = piece;
        }
    }
    return status;
}

/* The triangles for which keep[t] is `kept`. */
static dem_status half_create(half *s, const dem_lattice *l, const bool *keep, bool kept)
{
    const dem_index n_kept = count(keep, l->n_triangles), n = kept ? n_kept : l->n_triangles - n_kept;
    *s = (half){.lattice = *l};
    s->lattice.n_triangles = 0;
    s->lattice.triangles = calloc((size_t)n + 1, 3 * sizeof *s->lattice.triangles);
    s->number = calloc((size_t)n + 1, sizeof *s->number);
    s->piece = calloc((size_t)n + 1, sizeof *s->piece);
    s->size = calloc((size_t)n + 1, sizeof *s->size);
    s->at = calloc((size_t)l->n_nodes + 1, sizeof *s->at);
    s->touches = calloc((size_t)n + 1, sizeof *s->touches);
    if (!s->lattice.triangles || !s->number || !s->piece || !s->size || !s->at || !s->touches) return DEM_ERROR_MEMORY;
    for (dem_index t = 0; t < l->n_triangles; t++) {
        if (keep[t] != kept) continue;
        const dem_index to = s->lattice.n_triangles++;
        memcpy(s->lattice.triangles + 3 * to, l->triangles + 3 * t, 3 * sizeof *l->triangles);
        s->number[to] = t;
    }
    return find_pieces(s);
}

/* Cutting leaves pieces of a few triangles in sharp corners, which go to the other side of the cut. Those of the
 * material are taken out. Those of a void are filled if they meet others in a node: the rim would pass it twice. */
static dem_status move_small_pieces(bool *keep, const dem_lattice *l, bool kept, bool is_part)
{
    half s;
    const dem_status status = half_create(&s, l, keep, kept);
    for (dem_index t = 0; status == DEM_OK && t < s.lattice.n_triangles; t++) {
        const dem_index size = s.size[s.piece[t]];
        const bool is_small = size <= small_piece && (is_part || size < s.largest);
        if (is_small && (kept || s.touches[s.piece[t]])) keep[s.number[t]] = !kept;
    }
    half_free(&s);
    return status;
}

dem_status shape_trim(dem_lattice *l, const shape *s, bool is_part)
{
    bool *keep = calloc((size_t)l->n_triangles + 1, sizeof *keep);
    if (keep == NULL) return DEM_ERROR_MEMORY;
    for (dem_index t = 0; t < l->n_triangles; t++) {
        double centre[2] = {0.0, 0.0};
        for (int k = 0; k < 6; k++) centre[k % 2] += l->x[2 * l->triangles[3 * t + k / 2] + k % 2] / 3.0;
        keep[t] = shape_distance(s, centre) < -shape_slack(s);
    }
    dem_status status = move_small_pieces(keep, l, true, is_part);
    if (status == DEM_OK) status = move_small_pieces(keep, l, false, is_part);
    if (status == DEM_OK) status = dem_lattice_trim(l, keep);
    free(keep);
    return status;
}
