/* SPDX-License-Identifier: BSD-3-Clause */
#include "snapshot.h"

#include <stdlib.h>
#include <string.h>

#include "digest.h"

dem_index snapshot_bare(const dem_lattice *l, unsigned char *is_bare)
{
    dem_index n = 0;
    memset(is_bare, 1, (size_t)l->n_nodes);
    for (dem_index k = 0; k < 2 * l->n_springs; k++) is_bare[l->ends[k]] = 0;
    for (dem_index k = 0; k < l->n_nodes; k++) n += is_bare[k];
    return n;
}

static bool fail_memory(outcome *o)
{
    outcome_fail(o, EXIT_MEMORY, "dem_plot", "out of memory");
    return false;
}

static bool shows_pieces(const snapshot *s)
{
    return s->shown->source != NULL && s->shown->scale == PALETTE_PIECES;
}

bool snapshot_create(snapshot *s, const dem_reader *reader, const quantity *shown, outcome *o)
{
    const dem_lattice *l = dem_reader_lattice(reader);
    const size_t nodes = (size_t)l->n_nodes, springs = (size_t)l->n_springs, triangles = (size_t)l->n_triangles;
    const size_t n = quantity_count(shown, l);
    const size_t components = shown->source != NULL ? (size_t)shown->source->components : 0;
    *s = (snapshot){.reader = reader, .shown = shown, .lattice = l, .n_values = n, .reach = colour_range_extent_none()};
    s->x = malloc(2 * nodes * sizeof *s->x);
    s->value = malloc((n + 1) * sizeof *s->value);
    s->work = malloc((n * components + 1) * sizeof *s->work);
    s->is_bare = malloc(nodes);
    s->broken_springs = calloc(springs + 1, sizeof *s->broken_springs);
    s->broken_triangles = calloc(triangles + 1, sizeof *s->broken_triangles);
    s->breaks = dem_reader_array_find(reader, "broken");
    if (s->x != NULL && s->value != NULL && s->work != NULL && s->is_bare != NULL && s->broken_springs != NULL &&
        s->broken_triangles != NULL && (!shows_pieces(s) || pieces_create(&s->pieces, l)))
        return (void)snapshot_bare(l, s->is_bare), true;
    return fail_memory(o);
}

bool snapshot_follow_cracks(snapshot *s, outcome *o)
{
    return cracks_create(&s->cracks, s->lattice) || fail_memory(o);
}

void snapshot_free(snapshot *s)
{
    free(s->x);
    free(s->value);
    free(s->work);
    free(s->broken_springs);
    free(s->broken_triangles);
    free(s->is_bare);
    pieces_free(&s->pieces);
    cracks_free(&s->cracks);
    *s = (snapshot){0};
}

static bool is_finite(size_t n, const double *x)
{
    size_t k = 0;
    while (k < n && isfinite(x[k])) k++;
    return k == n;
}

bool snapshot_load(snapshot *s, dem_index frame, outcome *o)
{
    dem_index n;
    dem_status status = dem_reader_positions(s->reader, frame, s->x);
    if (status == DEM_OK && s->n_values > 0) status = quantity_read(s->shown, s->reader, frame, s->value, s->work);
    if (status == DEM_OK && s->breaks != NULL && s->lattice->n_springs > 0)
        status = dem_reader_read(s->reader, s->breaks, frame, s->broken_springs);
    if (status == DEM_OK) status = dem_reader_broken_triangles(s->reader, frame, s->broken_triangles);
    if (status != DEM_OK) return outcome_fail_status(o, status, "dem_plot"), false;
    if (!is_finite(2 * (size_t)s->lattice->n_nodes, s->x)) {
        outcome_fail(o, EXIT_INVALID, "dem_plot", "frame %lld has places that are not finite", (long long)frame);
        return false;
    }
    if (shows_pieces(s)) pieces_shade(&s->pieces, s->work, s->value);
    s->frame = frame;
    s->t = dem_reader_times(s->reader, &n)[frame];
    s->bounds = box_around(s->lattice->n_nodes, s->x);
    s->reach = colour_range_extent_of(s->n_values, s->value, s->work);
    return true;
}

double snapshot_spacing(const snapshot *s)
{
    const dem_lattice *l = s->lattice;
    double sum = 0.0;
    for (dem_index k = 0; k < l->n_springs; k++) sum += l->rest_length[k];
    return l->n_springs > 0 ? sum / (double)l->n_springs : 0.0;
}

/* Numbers of what is broken, so that nothing is added while all is whole. */
static uint64_t add_broken(const snapshot *s, uint64_t hash)
{
    for (dem_index k = 0; k < s->lattice->n_springs; k++)
        if (s->broken_springs[k] != 0.0) hash = digest_add(hash, &k, sizeof k);
    for (dem_index k = 0; k < s->lattice->n_triangles; k++)
        if (s->broken_triangles[k] != 0) hash = digest_add(hash, &k, sizeof k);
    return hash;
}

uint64_t snapshot_hash(const snapshot *s, uint64_t hash)
{
    hash = digest_add(hash, &s->frame, sizeof s->frame);
    hash = digest_add(hash, &s->t, sizeof s->t);
    hash = digest_add(hash, s->x, 2 * (size_t)s->lattice->n_nodes * sizeof *s->x);
    hash = digest_add(hash, s->value, s->n_values * sizeof *s->value);
    return add_broken(s, hash);
}

static double mean_of_nodes(const snapshot *s, const dem_index *nodes, int n)
{
    double sum = 0.0;
    for (int k = 0; k < n; k++) sum += s->value[nodes[k]];
    return sum / n;
}

double snapshot_spring_value(const snapshot *s, dem_index spring)
{
    if (s->shown->source == NULL) return 0.0;
    if (s->shown->source->of_springs) return s->value[spring];
    return mean_of_nodes(s, s->lattice->ends + 2 * spring, 2);
}

double snapshot_triangle_value(const snapshot *s, dem_index triangle)
{
    return mean_of_nodes(s, s->lattice->triangles + 3 * triangle, 3);
}
