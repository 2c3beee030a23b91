/* SPDX-License-Identifier: BSD-3-Clause */
/* Each body is flooded from its lowest node along its springs: by its direction at rest each leads to the right, up
 * left or up right of its lower node, and so every node has a lattice row and a column. What contradicts this, a node
 * with two columns, neighbours in another order, or a spring or triangle that is not between the nodes of one upright
 * or overturned triangle, says that the body has no lattice rows. */
#include "elastic/lattice_rows.h"

#include <math.h>
#include <stdlib.h>

#include "base/grow.h"
#include "base/status.h"

static const double sixth_turn = 1.0471975511965977; /* pi/3 */

enum {
    NO_NODE = -1,
    MOST_PLACES = 2, /* for each node: where more of them are empty blocks of the layout take no longer */
    MOST_BYTES = 16  /* of sets, for each node */
};

/* Which neighbour of a node another one is, in the order in which its forces are summed up. */
typedef enum neighbour { DOWN_LEFT, DOWN_RIGHT, LEFT, RIGHT, UP_LEFT, UP_RIGHT, NOT_ONE } neighbour;

/* How many lattice rows and columns away it is. */
static const int32_t rows_away[] = {-1, -1, 0, 0, 1, 1}, columns_away[] = {0, 1, -1, 1, -1, 0};

/* What is known while lattice rows are found. */
typedef struct finder {
    const lattice_rows_input *from;
    dem_index n; /* nodes */
    lattice_rows *out;
    int32_t *row, *column;   /* [n] of nodes, */
    unsigned char *reached;  /* [n] 1: which are known */
    int32_t *by_row, *start; /* [n] nodes as they are reached, then by lattice rows; [n_rows + 2] where these begin */
    /* Nodes at the places of two lattice rows, from the first block on that is evaluated of the lower one, with one
     * place more on either side. */
    int32_t *at[2];
    dem_index n_springs, n_triangles; /* that have been found */
    dem_index segment_capacity, n_segments;
    bool fits;
} finder;

/* ---- flooding ---- */

static double direction_of(const finder *f, dem_index lower, dem_index upper)
{
    const vec2 d = vec2_sub(vec2_at(f->from->x, upper), vec2_at(f->from->x, lower));
    return atan2(d.y, d.x);
}

/* The direction of the lattice rows of a body, from its lowest node: that of the first spring up, which leads to the
 * right; or up left, if the next one is to the right of that. */
static double find_axis(const finder *f, dem_index root)
{
    const springs *s = f->from->springs;
    const dem_index first = s->row[root], n = s->row[root + 1] - first;
    if (n == 0) return 0.0;
    const double axis = direction_of(f, root, s->neighbour[first]);
    if (n == 1) return axis;
    const double turn = direction_of(f, root, s->neighbour[first + 1]) - axis;
    return sin(turn) < 0.0 ? axis - 2.0 * sixth_turn : axis;
}

/* Which neighbour of its lower node the upper one is. */
static neighbour upper_of(const finder *f, double axis, dem_index lower, dem_index upper)
{
    const double sixth = (direction_of(f, lower, upper) - axis) / sixth_turn;
    switch ((int)lround(sixth - 6.0 * floor((sixth + 0.5) / 6.0))) { /* 0 to 5, or 6 by rounding */
    case 0:
    case 6:
        return RIGHT;
    case 1:
        return UP_RIGHT;
    case 2:
        return UP_LEFT;
    default:
        return NOT_ONE;
    }
}

static neighbour neighbour_of(const finder *f, double axis, dem_index i, dem_index j)
{
    static const neighbour opposite[] = {UP_RIGHT, UP_LEFT, RIGHT, LEFT, DOWN_RIGHT, DOWN_LEFT, NOT_ONE};
    return j > i ? upper_of(f, axis, i, j) : opposite[upper_of(f, axis, j, i)];
}

/* Gives the neighbours of a node their places.  \return how many of them are new, at the end of the queue; -1: they
 * contradict others */
static int reach(finder *f, double axis, dem_index i, dem_index queued)
{
    const springs *s = f->from->springs;
    int n = 0, last = -1;
    for (dem_index p = s->row[i]; p < s->row[i + 1]; p++) {
        const dem_index j = s->neighbour[p];
        const neighbour kind = neighbour_of(f, axis, i, j);
        if (kind == NOT_ONE || (int)kind <= last) return -1;
        last = (int)kind;
        const int32_t row = f->row[i] + rows_away[kind], column = f->column[i] + columns_away[kind];
        if (f->reached[j] == 0) {
            f->row[j] = row;
            f->column[j] = column;
            f->reached[j] = 1;
            f->by_row[queued + n++] = (int32_t)j;
        } else if (f->row[j] != row || f->column[j] != column) {
            return -1;
        }
    }
    return n;
}

/* Moves the places of a body, whose nodes were reached from `first` to `end`, so that its rows begin at `row` and its
 * columns at 0.  \return the lattice row behind it */
static int32_t move_body(finder *f, dem_index first, dem_index end, int32_t row)
{
    int32_t lowest = INT32_MAX, highest = INT32_MIN, left = INT32_MAX;
    for (dem_index q = first; q < end; q++) {
        const int32_t i = f->by_row[q];
        if (f->row[i] < lowest) lowest = f->row[i];
        if (f->row[i] > highest) highest = f->row[i];
        if (f->column[i] < left) left = f->column[i];
    }
    for (dem_index q = first; q < end; q++) {
        f->row[f->by_row[q]] += row - lowest;
        f->column[f->by_row[q]] -= left;
    }
    return row + highest - lowest + 1;
}

/* Finds the lattice row and column of each node. */
static void flood(finder *f)
{
    dem_index queued = 0;
    int32_t row = 1;
    for (dem_index root = 0; root < f->n && f->fits; root++) {
        if (f->reached[root] != 0) continue;
        const dem_index first = queued;
        const double axis = find_axis(f, root);
        f->row[root] = f->column[root] = 0;
        f->reached[root] = 1;
        f->by_row[queued++] = (int32_t)root;
        for (dem_index q = first; q < queued && f->fits; q++) {
            const int n = reach(f, axis, f->by_row[q], queued);
            f->fits = n >= 0;
            queued += n;
        }
        if (f->fits) row = move_body(f, first, queued, row) + 1;
    }
    f->out->n_rows = row;
}

/* ---- lattice rows ---- */

static dem_status sort_by_row(finder *f)
{
    f->start = calloc((size_t)f->out->n_rows + 2, sizeof *f->start);
    CHECK_MEMORY(f->start);
    for (dem_index i = 0; i < f->n; i++) f->start[f->row[i] + 2]++;
    for (dem_index r = 2; r < f->out->n_rows + 2; r++) f->start[r] += f->start[r - 1];
    for (dem_index i = 0; i < f->n; i++) f->by_row[f->start[f->row[i] + 1]++] = (int32_t)i;
    return DEM_OK;
}

/* Blocks of columns, `end` is behind. */
typedef struct columns {
    int32_t first, end;
} columns;

static columns join(columns a, columns b)
{
    if (a.first == a.end) return b;
    if (b.first == b.end) return a;
    return (columns){a.first < b.first ? a.first : b.first, a.end > b.end ? a.end : b.end};
}

/* Those with nodes. Columns are 0 or more. */
static columns columns_of(const finder *f, dem_index row)
{
    if (row >= f->out->n_rows || f->start[row] == f->start[row + 1]) return (columns){0, 0};
    const int32_t first = f->column[f->by_row[f->start[row]]], last = f->column[f->by_row[f->start[row + 1] - 1]];
    return (columns){first / LAYOUT_LANES, last / LAYOUT_LANES + 1};
}

/* Those that are evaluated: of its nodes, and of springs to the next one. */
static columns evaluated_of(const finder *f, dem_index row)
{
    return row < 0 ? (columns){0, 0} : join(columns_of(f, row), columns_of(f, row + 1));
}

static dem_status add_segments(finder *f, dem_index row)
{
    lattice_rows *out = f->out;
    lattice_row *to = &out->row[row];
    to->segment = (int32_t)f->n_segments;
    for (int32_t q = f->start[row]; q < f->start[row + 1]; q++) {
        const int32_t i = f->by_row[q], place = f->column[i] - LAYOUT_LANES * to->stored;
        lattice_segment *last = to->n_segments > 0 ? &out->segment[f->n_segments - 1] : NULL;
        if (last != NULL && place < last->place + last->n) f->fits = false;
        if (last != NULL && i == last->node + last->n && place == last->place + last->n) {
            last->n++;
            continue;
        }
        CHECK(grow_array((void **)&out->segment, &f->segment_capacity, f->n_segments + 1, sizeof *out->segment),
              DEM_ERROR_MEMORY, "out of memory for %lld lattice rows", (long long)out->n_rows);
        out->segment[f->n_segments++] = (lattice_segment){i, 1, place};
        to->n_segments++;
    }
    return DEM_OK;
}

static dem_status lay_rows(finder *f)
{
    lattice_rows *out = f->out;
    out->row = calloc((size_t)out->n_rows, sizeof *out->row);
    CHECK_MEMORY(out->row);
    for (dem_index r = 0; r < out->n_rows; r++) {
        const columns own = evaluated_of(f, r), stored = join(evaluated_of(f, r - 1), own);
        out->row[r] = (lattice_row){.stored = stored.first,
                                    .n_stored = stored.end - stored.first,
                                    .first = own.first,
                                    .n_blocks = own.end - own.first,
                                    .block = (int32_t)out->n_blocks};
        out->n_blocks += out->row[r].n_blocks;
        if (out->row[r].n_stored > out->most_stored) out->most_stored = out->row[r].n_stored;
        TRY(add_segments(f, r));
    }
    if (LAYOUT_LANES * out->n_blocks > MOST_PLACES * f->n) f->fits = false;
    return DEM_OK;
}

/* ---- blocks ---- */

/* Puts the nodes of a lattice row at their places, from place -1 of the first block on. */
static void fill_places(const finder *f, dem_index row, const lattice_row *from, int32_t *at)
{
    const int32_t n = LAYOUT_LANES * from->n_blocks, base = LAYOUT_LANES * from->first;
    for (int32_t k = 0; k < n + 2; k++) at[k] = NO_NODE;
    for (int32_t q = f->start[row]; q < f->start[row + 1]; q++) at[f->column[f->by_row[q]] - base + 1] = f->by_row[q];
}

/* The stiffness and rest length of a spring into lane k of a set. */
static void take_spring(finder *f, double *set, int k, int32_t lower, int32_t upper)
{
    const springs *s = f->from->springs;
    const dem_index spring = lower != NO_NODE && upper != NO_NODE ? springs_between(s, lower, upper) : -1;
    set[k] = spring >= 0 ? s->stiffness_of[spring] : 0.0;
    set[LAYOUT_LANES + k] = spring >= 0 ? s->rest_length_of[spring] : 1.0;
    f->n_springs += spring >= 0;
}

static bool is_asked_for(const finder *f, int32_t node)
{
    return f->from->is_ghost == NULL || f->from->is_ghost[node] == 0;
}

/* Areas differ by rounding from corner to corner. Triangles of ghosts alone are judged by who owns a corner: here
 * ghosts on the outside go on without forces, so that triangles may fold that do not. */
static double onset_of(finder *f, int32_t lowest, int32_t next, int32_t last)
{
    const triangles *t = f->from->triangles;
    if (lowest == NO_NODE || next == NO_NODE || last == NO_NODE) return (double)-INFINITY;
    for (int32_t p = t->row[lowest]; p < t->row[lowest + 1]; p++) {
        if (t->next[p] != next || t->last[p] != last) continue;
        f->n_triangles++;
        if (!(triangles_guard(t, p) > 0.0)) break;
        if (!is_asked_for(f, lowest) && !is_asked_for(f, next) && !is_asked_for(f, last)) break;
        f->out->guarded = true;
        return TRIANGLES_ROUNDED * TRIANGLES_GUARD_ONSET * triangles_rest_area(t, lowest, p);
    }
    return (double)-INFINITY;
}

static dem_status find_set(finder *f, const double *numbers, dem_index n, int32_t *out)
{
    intern_span span;
    TRY(intern_find(&f->out->sets, numbers, n, &span));
    *out = LAYOUT_LANES * span.first;
    return DEM_OK;
}

/* The block whose first place is at `from`. */
static dem_status lay_block(finder *f, int32_t from, int32_t *number)
{
    const int32_t *here = f->at[0] + from + 1, *above = f->at[1] + from + 1;
    double right[2 * LAYOUT_LANES], up[2 * LAYOUT_LANES], back[2 * LAYOUT_LANES];
    double mass[LAYOUT_LANES], upright[LAYOUT_LANES], overturned[LAYOUT_LANES];
    lattice_block b;
    intern_span span;
    for (int k = 0; k < LAYOUT_LANES; k++) {
        take_spring(f, right, k, here[k], here[k + 1]);
        take_spring(f, up, k, here[k], above[k]);
        take_spring(f, back, k, here[k + 1], above[k]);
        upright[k] = onset_of(f, here[k], here[k + 1], above[k]);
        overturned[k] = onset_of(f, here[k], above[k], above[k - 1]);
        mass[k] = here[k] != NO_NODE ? f->from->inverse_mass[here[k]] : 0.0;
    }
    TRY(find_set(f, right, 2, &b.right));
    TRY(find_set(f, up, 2, &b.up));
    TRY(find_set(f, back, 2, &b.back));
    TRY(find_set(f, mass, 1, &b.inverse_mass));
    TRY(find_set(f, upright, 1, &b.upright));
    TRY(find_set(f, overturned, 1, &b.overturned));
    TRY(intern_find(&f->out->records, &b, 1, &span));
    *number = span.first;
    return DEM_OK;
}

static dem_status allocate_blocks(finder *f)
{
    lattice_rows *out = f->out;
    const size_t width = LAYOUT_LANES * (size_t)out->most_stored + 2;
    out->block = calloc((size_t)out->n_blocks, sizeof *out->block);
    for (int k = 0; k < 2; k++) f->at[k] = calloc(width, sizeof *f->at[k]);
    CHECK(out->block && f->at[0] && f->at[1], DEM_ERROR_MEMORY, "out of memory for %lld lattice rows",
          (long long)out->n_rows);
    return DEM_OK;
}

static dem_status lay_blocks(finder *f)
{
    lattice_rows *out = f->out;
    TRY(allocate_blocks(f));
    for (dem_index r = 0; r + 1 < out->n_rows && f->fits; r++) {
        const lattice_row *row = &out->row[r];
        fill_places(f, r, row, f->at[0]);
        fill_places(f, r + 1, row, f->at[1]);
        for (int32_t k = 0; k < row->n_blocks; k++) TRY(lay_block(f, LAYOUT_LANES * k, &out->block[row->block + k]));
        f->fits = out->sets.n * (dem_index)out->sets.unit <= MOST_BYTES * f->n + (1 << 20);
    }
    const dem_index n_slots = f->from->triangles->row[f->n], n_triangles = n_slots / 3;
    f->fits = f->fits && f->n_springs == f->from->springs->row[f->n] / 2 && f->n_triangles == n_triangles;
    TRY(intern_settle(&out->sets));
    return intern_settle(&out->records);
}

/* ---- all ---- */

static dem_status allocate(finder *f)
{
    const size_t n = (size_t)f->n;
    f->row = malloc(n * sizeof *f->row);
    f->column = malloc(n * sizeof *f->column);
    f->reached = calloc(n, 1);
    f->by_row = malloc(n * sizeof *f->by_row);
    CHECK(f->row && f->column && f->reached && f->by_row, DEM_ERROR_MEMORY, "out of memory for the rows of %zu nodes",
          n);
    return DEM_OK;
}

static dem_status find(finder *f)
{
    TRY(allocate(f));
    flood(f);
    if (f->fits) TRY(sort_by_row(f));
    if (f->fits) TRY(lay_rows(f));
    return f->fits ? lay_blocks(f) : DEM_OK;
}

dem_status lattice_rows_create(lattice_rows *out, const lattice_rows_input *from)
{
    *out = (lattice_rows){.records.unit = sizeof(lattice_block), .sets.unit = LAYOUT_LANES * sizeof(double)};
    finder f = {.from = from, .n = from->springs->n_nodes, .out = out, .fits = from->springs->n_nodes > 0};
    const dem_status status = f.fits ? find(&f) : DEM_OK;
    free(f.row);
    free(f.column);
    free(f.reached);
    free(f.by_row);
    free(f.start);
    free(f.at[0]);
    free(f.at[1]);
    if (status != DEM_OK || !f.fits) lattice_rows_destroy(out);
    return status;
}

void lattice_rows_destroy(lattice_rows *r)
{
    free(r->row);
    free(r->segment);
    free(r->block);
    intern_free(&r->records);
    intern_free(&r->sets);
    *r = (lattice_rows){0};
}
