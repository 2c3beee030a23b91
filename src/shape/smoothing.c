/* SPDX-License-Identifier: BSD-3-Clause */
/* The nodes of the rim go to the nearest point of their edge, and one node to each corner. Then rim nodes slide along
 * their edges to the middle between their neighbours, and nodes in a few layers behind them go to the mean of theirs.
 * Pairs of triangles that are still poor get their other diagonal. In the end nodes of triangles that are too flat go
 * back towards their places in the grid, where all triangles are sound. */
#include "shape/smoothing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "shape/crossings.h"
#include "shape/least_angle.h"
#include "shape/shape.h"
#include "shape/shape_trim.h"
#include "shape/stars.h"

enum { layers = 3, sweeps = 8, last_sweeps = 2 };
enum { ear_passes = 4, sound_passes = 5 }; /* of a part: SMOOTHING_ROWS has to do with all of these numbers */

static const double reach = 1.0, corner_reach = 1.5; /* of the spacing: farther no node is moved */
/* Cotangents of the least angle of a triangle. */
static const double flat = 2.4750868534162958;    /* 22 degrees: an ear of the rim with a smaller angle goes */
static const double poor = 1.7320508075688773;    /* 30 degrees: a pair with a smaller one may get its other diagonal */
static const double unsound = 2.7474774194546221; /* 20 degrees: no triangle keeps a smaller one */
static const double better = 0.95;                /* of the cotangent: what another diagonal must gain */

/* What a node of the rim has beside its place. */
typedef struct rim_node {
    dem_index before, behind; /* the rim nodes next to it; -1: none */
    size_t edge;              /* of the shape: the one that it belongs to */
    double turn;              /* cosine of the corner that it is at; 2: none */
    bool held;                /* does not slide */
} rim_node;

/* What is gained where the side of a pair of triangles goes: see `pair`. */
typedef struct gain_at {
    double gain;
    dem_index side; /* -1: none */
} gain_at;

typedef struct draft {
    const shape *shape;
    const smoothing_part *part; /* NULL: the lattice is the whole */
    dem_lattice *lattice;       /* its nodes are where the grid has them */
    stars stars;
    double *x;               /* [n_nodes][2] m, where nodes are moved to */
    double *sum;             /* [n_nodes][3] of the places of neighbours, m, and their number */
    unsigned char *depth;    /* [n_nodes] sides away from the rim, 0 to layers; layers + 1: farther */
    rim_node *at;            /* [n_nodes] for those of the rim */
    dem_index n_rim, *rim;   /* the nodes at the rim */
    dem_index n_cut;         /* corners without a node */
    dem_index n_unsettled;   /* triangles as `smoothing` has them */
    dem_index n_near, *near; /* triangles with a node that may move */
    dem_index *choice;       /* [n_triangles] of a poor one the side that is to go; -1: none */
    gain_at *best;           /* [n_triangles] of its sides that are to go */
    bool *marked;            /* [n_nodes] at an unsound triangle */
} draft;

static void draft_free(draft *d)
{
    stars_free(&d->stars);
    free(d->x);
    free(d->sum);
    free(d->depth);
    free(d->at);
    free(d->rim);
    free(d->near);
    free(d->choice);
    free(d->best);
    free(d->marked);
    *d = (draft){0};
}

static bool draft_create(draft *d, dem_lattice *lattice, const shape *s, const smoothing_part *part)
{
    const size_t n = (size_t)lattice->n_nodes, m = (size_t)lattice->n_triangles;
    *d = (draft){.shape = s, .part = part, .lattice = lattice};
    d->x = calloc(n + 1, 2 * sizeof *d->x);
    d->sum = calloc(n + 1, 3 * sizeof *d->sum);
    d->depth = calloc(n + 1, sizeof *d->depth);
    d->at = calloc(n + 1, sizeof *d->at);
    d->rim = calloc(n + 1, sizeof *d->rim);
    d->near = calloc(m + 1, sizeof *d->near);
    d->choice = calloc(m + 1, sizeof *d->choice);
    d->best = calloc(m + 1, sizeof *d->best);
    d->marked = calloc(n + 1, sizeof *d->marked);
    const bool has_room = d->x && d->sum && d->depth && d->at && d->rim && d->near && d->choice && d->best && d->marked;
    return has_room && stars_create(&d->stars, lattice);
}

static bool is_rim(const draft *d, dem_index i)
{
    return d->depth[i] == 0;
}

static bool is_in_part(const smoothing_part *part, double y)
{
    return part == NULL || (y >= part->from && y < part->to);
}

static bool is_own(const draft *d, dem_index i)
{
    return is_in_part(d->part, d->lattice->x[2 * i + 1]);
}

static bool has_own(const draft *d, dem_index t)
{
    const dem_index *corner = d->lattice->triangles + 3 * t;
    return is_own(d, corner[0]) || is_own(d, corner[1]) || is_own(d, corner[2]);
}

static double distance(const double *a, const double *b)
{
    const double dx = b[0] - a[0], dy = b[1] - a[1];
    return sqrt(dx * dx + dy * dy);
}

static double cotangent_of(const draft *d, dem_index t)
{
    return least_angle_cotangent(d->x, d->lattice->triangles + 3 * t);
}

/* ---- rim ---- */

/* A node that the rim passes more than once is a hinge and does not slide. */
static void link_rim(draft *d, dem_index from, dem_index to)
{
    rim_node *a = &d->at[from], *b = &d->at[to];
    d->depth[from] = d->depth[to] = 0;
    a->held = a->held || a->behind >= 0;
    b->held = b->held || b->before >= 0;
    a->behind = to;
    b->before = from;
}

static void find_rim(draft *d)
{
    const dem_lattice *l = d->lattice;
    memset(d->depth, layers + 1, (size_t)l->n_nodes);
    for (dem_index i = 0; i < l->n_nodes; i++) d->at[i] = (rim_node){.before = -1, .behind = -1, .turn = 2.0};
    for (dem_index side = 0; side < 3 * l->n_triangles; side++)
        if (stars_across(&d->stars, l, side) < 0) link_rim(d, l->triangles[side], stars_end(l, side));
    for (dem_index i = 0; i < l->n_nodes; i++)
        if (is_rim(d, i)) d->rim[d->n_rim++] = i;
}

static bool is_on_edge(const shape *s, const double x[2])
{
    return fabs(shape_distance(s, x)) <= shape_slack(s);
}

/* The nearest point that is an edge of the material. The nearest edge has it, unless there it is in another void or
 * beyond the outline. \return the edge */
static size_t find_place(const shape *s, const double x[2], double near[2])
{
    size_t edge = shape_edge(s, x);
    double least = (double)INFINITY, other[2];
    outline_nearest(shape_edge_at(s, edge), x, near);
    if (is_on_edge(s, near)) return edge;
    for (size_t k = 0; k <= s->n_voids; k++) {
        outline_nearest(shape_edge_at(s, k), x, other);
        if (!is_on_edge(s, other) || distance(x, other) >= least) continue;
        memcpy(near, other, sizeof other);
        edge = k;
    }
    return edge;
}

/* On to the edge, if that is near enough. */
static void place_rim(draft *d)
{
    const dem_lattice *l = d->lattice;
    memcpy(d->x, l->x, 2 * (size_t)l->n_nodes * sizeof *d->x);
    for (dem_index k = 0; k < d->n_rim; k++) {
        const dem_index i = d->rim[k];
        double near[2];
        d->at[i].edge = find_place(d->shape, l->x + 2 * i, near);
        if (distance(near, l->x + 2 * i) <= reach * d->shape->spacing)
            memcpy(d->x + 2 * i, near, sizeof near);
        else
            d->at[i].held = true;
    }
}

/* A corner of an edge, or of two that cross. */
typedef struct joint {
    draft *draft;
    size_t edges[2];
} joint;

/* The rim node of its edges that is nearest to a corner gets it, unless that has a sharper one. */
static void place_corner(const joint *j, const outline_corner *corner)
{
    draft *d = j->draft;
    double least = corner_reach * d->shape->spacing;
    dem_index nearest = -1;
    if (!is_on_edge(d->shape, corner->x)) return; /* in a void, or beyond the outline */
    for (dem_index k = 0; k < d->n_rim; k++) {
        const dem_index i = d->rim[k];
        const double away = distance(corner->x, d->lattice->x + 2 * i);
        if ((d->at[i].edge != j->edges[0] && d->at[i].edge != j->edges[1]) || away >= least) continue;
        least = away;
        nearest = i;
    }
    d->n_cut += nearest < 0 && is_in_part(d->part, corner->x[1]);
    if (nearest < 0 || d->at[nearest].turn <= corner->cosine) return;
    memcpy(d->x + 2 * nearest, corner->x, sizeof corner->x);
    d->at[nearest].turn = corner->cosine;
    d->at[nearest].held = true;
}

/* Taken as sharp as a right angle. */
static void place_crossing(void *context, const double x[2])
{
    place_corner(context, &(outline_corner){{x[0], x[1]}, 0.0});
}

static void place_corners(draft *d)
{
    for (size_t e = 0; e <= d->shape->n_voids; e++) {
        const outline *o = shape_edge_at(d->shape, e);
        for (size_t k = 0; k < outline_corners(o); k++) {
            const outline_corner corner = outline_corner_at(o, k);
            place_corner(&(joint){d, {e, e}}, &corner);
        }
        for (size_t f = e + 1; f <= d->shape->n_voids; f++)
            crossings_find(o, shape_edge_at(d->shape, f), place_crossing, &(joint){d, {e, f}});
    }
}

/* ---- ears ---- */

/* Whether a triangle has two sides on the rim, an ear, and is flat. Without it its neighbour is on the rim. */
static bool is_flat_ear(const draft *d, dem_index t)
{
    int n = 0;
    for (dem_index side = 3 * t; side < 3 * t + 3; side++) n += stars_across(&d->stars, d->lattice, side) < 0;
    return n == 2 && cotangent_of(d, t) > flat;
}

/* \param[out] n  of ears that were taken away, or are left by the last pass over a part */
static dem_status drop_flat_ears(draft *d, bool is_last, dem_index *n)
{
    const dem_index n_triangles = d->lattice->n_triangles;
    bool *keep = calloc((size_t)n_triangles + 1, sizeof *keep);
    if (keep == NULL) return DEM_ERROR_MEMORY;
    *n = 0;
    for (dem_index t = 0; t < n_triangles; t++) {
        keep[t] = !is_flat_ear(d, t);
        *n += !keep[t];
        d->n_unsettled += is_last && !keep[t] && has_own(d, t);
    }
    const dem_status status = *n > 0 && !is_last ? dem_lattice_trim(d->lattice, keep) : DEM_OK;
    free(keep);
    return status;
}

/* The rim in its place, and no flat ears at it any more. */
static dem_status settle_rim(draft *d, dem_lattice *lattice, const shape *s, const smoothing_part *part)
{
    dem_status status = DEM_OK;
    bool is_last = false;
    dem_index n_ears = 1;
    for (int pass = 1; status == DEM_OK && n_ears > 0 && !is_last; pass++) {
        draft_free(d);
        if (!draft_create(d, lattice, s, part)) return DEM_ERROR_MEMORY;
        find_rim(d);
        place_rim(d);
        place_corners(d);
        is_last = part != NULL && pass == ear_passes;
        status = drop_flat_ears(d, is_last, &n_ears);
    }
    return status;
}

/* ---- relaxing ---- */

static void find_layers(draft *d)
{
    const dem_lattice *l = d->lattice;
    for (int depth = 1; depth <= layers; depth++)
        for (dem_index k = 0; k < 3 * l->n_triangles; k++) {
            if (d->depth[l->triangles[k]] != depth - 1) continue;
            for (dem_index c = 3 * (k / 3); c < 3 * (k / 3) + 3; c++)
                if (d->depth[l->triangles[c]] > depth) d->depth[l->triangles[c]] = (unsigned char)depth;
        }
    for (dem_index t = 0; t < l->n_triangles; t++) {
        bool is_near = false;
        for (int c = 0; c < 3; c++) is_near = is_near || d->depth[l->triangles[3 * t + c]] <= layers;
        if (is_near) d->near[d->n_near++] = t;
    }
}

/* Places are added as multiples of a power of two, so that a sum is exact and the same in any order: mirrored bodies
 * stay so to the bit. */
static void add_place(double sum[3], const double *x, double grain)
{
    for (int c = 0; c < 2; c++) sum[c] += rint(x[c] / grain) * grain;
    sum[2] += 1.0;
}

/* Both ends of each side inside are counted twice, since two triangles have it. */
static void add_neighbours(draft *d)
{
    const double grain = ldexp(1.0, ilogb(d->shape->spacing) - 30);
    memset(d->sum, 0, 3 * (size_t)d->lattice->n_nodes * sizeof *d->sum);
    for (dem_index k = 0; k < d->n_near; k++) {
        const dem_index *corner = d->lattice->triangles + 3 * d->near[k];
        for (int c = 0; c < 6; c++) /* each corner with its next one, then with the one before */
            add_place(d->sum + 3 * corner[c % 3], d->x + 2 * corner[(c % 3 + 1 + c / 3) % 3], grain);
    }
}

/* To the middle of its neighbours on the rim, half of the way, and back on to its edge. */
static void slide(const draft *d, dem_index i, double to[2])
{
    const rim_node *node = &d->at[i];
    const double *x = d->x + 2 * i, *before = d->x + 2 * node->before, *behind = d->x + 2 * node->behind;
    double middle[2];
    for (int c = 0; c < 2; c++) middle[c] = 0.5 * x[c] + 0.25 * (before[c] + behind[c]);
    outline_nearest(shape_edge_at(d->shape, node->edge), middle, to);
}

/* All nodes move at once: where one goes depends on where its neighbours were. */
static void relax(draft *d)
{
    add_neighbours(d);
    for (dem_index i = 0; i < d->lattice->n_nodes; i++) {
        double *sum = d->sum + 3 * i;
        if (is_rim(d, i) && !d->at[i].held)
            slide(d, i, sum);
        else if (!is_rim(d, i) && d->depth[i] <= layers)
            for (int c = 0; c < 2; c++) sum[c] /= sum[2];
        else
            memcpy(sum, d->x + 2 * i, 2 * sizeof *sum);
    }
    for (dem_index i = 0; i < d->lattice->n_nodes; i++) memcpy(d->x + 2 * i, d->sum + 3 * i, 2 * sizeof *d->x);
}

/* ---- other diagonals ---- */

/* Two triangles at a common side, whose ends are a and b: (a, b, c) and (b, a, e). */
typedef struct pair {
    dem_index t, u, a, b, c, e;
    double gain; /* cotangent with the other diagonal over that of now */
} pair;

static bool is_deep(const draft *d, const pair *p)
{
    return d->depth[p->a] > layers || d->depth[p->b] > layers || d->depth[p->c] > layers || d->depth[p->e] > layers;
}

/* Of triangle t and its neighbour at a side. \return false where there is no such pair */
static bool find_pair(const draft *d, pair *p, dem_index side)
{
    const dem_lattice *l = d->lattice;
    const dem_index other = stars_across(&d->stars, l, side);
    if (other < 0) return false;
    *p = (pair){.t = side / 3, .u = other / 3, .a = l->triangles[side], .b = l->triangles[other]};
    p->c = stars_end(l, 3 * p->t + (side + 1) % 3);
    p->e = stars_end(l, 3 * p->u + (other + 1) % 3);
    if (is_deep(d, p)) return false;
    const double now = fmax(cotangent_of(d, p->t), cotangent_of(d, p->u));
    const double then = fmax(least_angle_cotangent(d->x, (dem_index[]){p->a, p->e, p->c}),
                             least_angle_cotangent(d->x, (dem_index[]){p->e, p->b, p->c}));
    p->gain = then / now;
    return isfinite(then);
}

/* Notes of each poor triangle the side at whose pair another diagonal gains most, of a pair of two poor ones once. */
static void choose_sides(draft *d)
{
    pair p;
    for (dem_index t = 0; t < d->lattice->n_triangles; t++) d->choice[t] = -1;
    for (dem_index k = 0; k < d->n_near; k++) {
        const dem_index t = d->near[k];
        double gain = better;
        dem_index choice = -1;
        for (dem_index side = 3 * t; side < 3 * t + 3 && cotangent_of(d, t) > poor; side++) {
            if (!find_pair(d, &p, side) || !(p.gain < gain)) continue;
            gain = p.gain;
            choice = side;
        }
        const dem_index other = choice >= 0 ? stars_across(&d->stars, d->lattice, choice) : -1;
        if (other >= 0 && d->choice[other / 3] != other) d->choice[t] = choice;
    }
}

/* Of the sides chosen at each triangle the one that gains most, of several of them the first. */
static void rank_sides(draft *d)
{
    pair p;
    for (dem_index t = 0; t < d->lattice->n_triangles; t++) d->best[t] = (gain_at){better, -1};
    for (dem_index k = 0; k < d->n_near; k++) {
        const dem_index side = d->choice[d->near[k]];
        if (side < 0 || !find_pair(d, &p, side)) continue;
        if (p.gain < d->best[p.t].gain) d->best[p.t] = (gain_at){p.gain, side};
        if (p.gain < d->best[p.u].gain) d->best[p.u] = (gain_at){p.gain, side};
    }
}

static void put_triangle(draft *d, dem_index t, dem_index i, dem_index j, dem_index k)
{
    dem_index *corner = d->lattice->triangles + 3 * t;
    corner[0] = i;
    corner[1] = j;
    corner[2] = k;
}

/* Pairs of triangles get their other diagonal where none of these two takes part in a pair that gains more. So what
 * becomes of a pair depends on triangles near it alone. A triangle changes once, so that it has at least 30 degrees
 * where nodes are at their places in the grid. */
static void flip(draft *d)
{
    pair p;
    choose_sides(d);
    rank_sides(d);
    for (dem_index k = 0; k < d->n_near; k++) {
        const dem_index t = d->near[k], side = d->choice[t];
        if (side < 0 || d->best[t].side != side || !find_pair(d, &p, side) || d->best[p.u].side != side) continue;
        put_triangle(d, p.t, p.a, p.e, p.c);
        put_triangle(d, p.u, p.e, p.b, p.c);
    }
}

/* ---- soundness ---- */

/* Marks the corners of unsound triangles.
 * \param[out] n_own  of these in the part
 * \return whether there are any */
static bool mark_unsound(const draft *d, bool *marked, dem_index *n_own)
{
    bool any = false;
    *n_own = 0;
    memset(marked, 0, (size_t)d->lattice->n_nodes * sizeof *marked);
    for (dem_index k = 0; k < d->n_near; k++) {
        const dem_index *corner = d->lattice->triangles + 3 * d->near[k];
        if (cotangent_of(d, d->near[k]) <= unsound) continue;
        any = true;
        *n_own += has_own(d, d->near[k]);
        for (int c = 0; c < 3; c++) marked[corner[c]] = true;
    }
    return any;
}

static void move_marked_back(draft *d)
{
    for (dem_index i = 0; i < d->lattice->n_nodes; i++) {
        const double *home = d->lattice->x + 2 * i;
        double *x = d->x + 2 * i;
        for (int c = 0; c < 2 && d->marked[i]; c++) x[c] = home[c] + 0.5 * (x[c] - home[c]);
    }
}

/* Corners of unsound triangles go half way back to the grid, all of them at once, until there are none: the order of
 * triangles does not matter. It ends, since there all triangles are sound. */
static void move_unsound_back(draft *d)
{
    dem_index n_own;
    for (int pass = 1; mark_unsound(d, d->marked, &n_own); pass++) {
        if (d->part != NULL && pass == sound_passes) {
            d->n_unsettled += n_own;
            return;
        }
        move_marked_back(d);
    }
}

static void measure(smoothing *out, const draft *d)
{
    *out = (smoothing){.n_cut = d->n_cut, .n_unsettled = d->n_unsettled};
    for (dem_index k = 0; k < d->n_rim; k++) {
        const dem_index i = d->rim[k];
        if (!is_own(d, i)) continue;
        out->n_rim++;
        const double *x = d->x + 2 * i,
                     off = fabs(outline_distance(shape_edge_at(d->shape, d->at[i].edge), x[0], x[1]));
        if (off <= shape_slack(d->shape)) continue;
        out->n_off++;
        out->farthest = fmax(out->farthest, off);
    }
}

/* Of a part of which nothing is left no corner has a node. */
static void measure_nothing(smoothing *out, const shape *s, const smoothing_part *part)
{
    draft d = {.shape = s, .part = part};
    place_corners(&d);
    *out = (smoothing){.n_cut = d.n_cut};
}

dem_status smoothing_apply(smoothing *out, dem_lattice *lattice, const struct shape *s, const smoothing_part *part)
{
    draft d = {0};
    dem_status status = shape_trim(lattice, s, part != NULL);
    if (status == DEM_OK) status = settle_rim(&d, lattice, s, part);
    if (status == DEM_OK) {
        find_layers(&d);
        for (int k = 0; k < sweeps; k++) relax(&d);
        flip(&d);
        for (int k = 0; k < last_sweeps; k++) relax(&d);
        move_unsound_back(&d);
        measure(out, &d);
        memcpy(lattice->x, d.x, 2 * (size_t)lattice->n_nodes * sizeof *d.x);
    }
    draft_free(&d);
    if (status == DEM_ERROR_MODEL && part != NULL) measure_nothing(out, s, part);
    return status;
}
