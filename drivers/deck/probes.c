/* SPDX-License-Identifier: BSD-3-Clause */
#include "probes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
enum { most_letters = 63 };

static bool has_kind(const schema_instance *probe, const char *kind)
{
    return strcmp(schema_text(probe, "kind"), kind) == 0;
}

static int count_ends(const schema_instance *probe)
{
    return has_kind(probe, "gauge") ? 2 : 1;
}

/* ---- checks ---- */

static void check_name(const schema_deck *groups, size_t k, namelist_errors *errors)
{
    const schema_instance *probe = schema_get(groups, "probe", k);
    const schema_value *name = schema_value_of(probe, "name");
    const char *text = schema_text(probe, "name");
    const size_t n = strlen(text);
    if (name->faulty || name->count == 0) return;
    if (n == 0 || n > most_letters || strspn(text, letters) != n)
        namelist_errors_add(errors, name->place, "'name' in &probe must have 1 to %d letters, digits, '_' or '-'",
                            (int)most_letters);
    for (size_t q = 0; q < k; q++) {
        const schema_instance *other = schema_get(groups, "probe", q);
        if (strcmp(schema_text(other, "name"), text) != 0) continue;
        namelist_errors_add(errors, name->place, "two probes have the name '%.63s', the first in line %d", text,
                            other->place.line);
        return;
    }
}

static void check_count(const schema_instance *probe, const char *key, int expected, namelist_errors *errors)
{
    const schema_value *value = schema_value_of(probe, key);
    if (!value->given || value->faulty || value->count == expected) return;
    namelist_errors_add(errors, value->place, "'%s' in &probe expects %d value%s for kind '%s', got %d", key, expected,
                        expected == 1 ? "" : "s", schema_text(probe, "kind"), value->count);
}

static void check_choice(const schema_deck *groups, const schema_instance *probe, namelist_errors *errors)
{
    const schema_value *place = schema_value_of(probe, "place"), *number = schema_value_of(probe, "number");
    const schema_value *body = schema_value_of(probe, "body");
    const double n_bodies = (double)schema_count(groups, "body");
    if (place->given == number->given && !place->faulty && !number->faulty)
        namelist_errors_add(errors, place->given ? place->place : probe->place, "&probe needs 'place' or 'number'%s",
                            place->given ? ", not both" : "");
    if (number->given && !place->given && body->given)
        namelist_errors_add(errors, body->place, "'body' in &probe is not used with 'number'");
    if (!body->faulty && body->reals[0] > n_bodies)
        namelist_errors_add(errors, body->place, "'body' in &probe is %g, but there %s %g", body->reals[0],
                            n_bodies == 1.0 ? "is only" : "are only", n_bodies);
}

void probes_check(const schema_deck *groups, namelist_errors *errors)
{
    for (size_t k = 0; k < schema_count(groups, "probe"); k++) {
        const schema_instance *probe = schema_get(groups, "probe", k);
        check_name(groups, k, errors);
        check_choice(groups, probe, errors);
        if (schema_value_of(probe, "kind")->faulty) continue;
        check_count(probe, "place", 2 * count_ends(probe), errors);
        check_count(probe, "number", count_ends(probe), errors);
    }
}

void probes_drop_unused(schema_deck *groups)
{
    for (size_t i = 0; i < groups->n_instances; i++) {
        schema_instance *probe = &groups->instances[i];
        if (strcmp(probe->group->name, "probe") == 0 && schema_given(probe, "number")) schema_drop(probe, "body");
    }
}

/* ---- what is nearest ---- */

static double distance(const double *a, const double *b)
{
    return hypot(a[0] - b[0], a[1] - b[1]);
}

/* From the middle between nodes i and j, which may be the same, to a place in the body's own coordinates. */
static double distance_to(const dem_lattice *l, const placement *body, dem_index i, dem_index j, const double at[2])
{
    const double *a = l->x + 2 * i, *b = l->x + 2 * j, middle[2] = {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])};
    double own[2];
    placement_own(body, middle, own);
    return distance(own, at);
}

static dem_index nearest_node(const dem_lattice *l, const placement *body, const double at[2])
{
    dem_index nearest = -1;
    double least = (double)INFINITY;
    for (dem_index i = body->first; i < body->first + body->n_nodes; i++) {
        const double d = distance_to(l, body, i, i, at);
        if (d >= least) continue;
        nearest = i;
        least = d;
    }
    return nearest;
}

/* -1 in a body without springs. */
static dem_index nearest_spring(const dem_lattice *l, const placement *body, const double at[2])
{
    dem_index nearest = -1;
    double least = (double)INFINITY;
    for (dem_index k = 0; k < l->n_springs; k++) {
        const dem_index *ends = l->ends + 2 * k;
        if (ends[0] < body->first || ends[0] >= body->first + body->n_nodes) continue;
        const double d = distance_to(l, body, ends[0], ends[1], at);
        if (d >= least) continue;
        nearest = k;
        least = d;
    }
    return nearest;
}

static void find_nearest(dem_probe *p, const schema_instance *probe, const dem_lattice *lattice, const placement *body)
{
    const double *place = schema_value_of(probe, "place")->reals;
    for (int k = 0; k < count_ends(probe); k++) {
        const double *at = place + 2 * k;
        p->number[k] =
            p->kind == DEM_PROBE_SPRING ? nearest_spring(lattice, body, at) : nearest_node(lattice, body, at);
    }
}

/* ---- probes ---- */

static void check_found(const dem_probe *p, const schema_instance *probe, const dem_lattice *l, namelist_errors *errors)
{
    const bool placed = schema_value_of(probe, "place")->given;
    const namelist_place where = schema_value_of(probe, placed ? "place" : "number")->place;
    const bool spring = p->kind == DEM_PROBE_SPRING;
    const dem_index n = spring ? l->n_springs : l->n_nodes;
    for (int k = 0; k < count_ends(probe); k++)
        if (p->number[k] < 0 || p->number[k] >= n) {
            namelist_errors_add(errors, where,
                                "probe '%s': there is no such %s; they are numbered from 0, and there are %lld",
                                p->name, spring ? "spring" : "node", (long long)n);
            return;
        }
    if (p->kind != DEM_PROBE_GAUGE) return;
    if (distance(l->x + 2 * p->number[0], l->x + 2 * p->number[1]) > 0.0) return;
    namelist_errors_add(errors, where, "probe '%s': both ends of the gauge are at node %lld", p->name,
                        (long long)p->number[0]);
}

bool probes_find(dem_probe *out, const schema_deck *groups, const dem_lattice *lattice, const placement *bodies,
                 namelist_errors *errors)
{
    for (size_t k = 0; k < schema_count(groups, "probe"); k++) {
        const schema_instance *probe = schema_get(groups, "probe", k);
        const schema_value *number = schema_value_of(probe, "number");
        out[k] = (dem_probe){.name = strdup(schema_text(probe, "name")),
                             .kind = has_kind(probe, "gauge")    ? DEM_PROBE_GAUGE
                                     : has_kind(probe, "spring") ? DEM_PROBE_SPRING
                                                                 : DEM_PROBE_NODE,
                             .every = (dem_index)schema_real(probe, "every")};
        if (out[k].name == NULL) return false;
        if (number->given)
            for (int q = 0; q < count_ends(probe); q++) out[k].number[q] = (dem_index)number->reals[q];
        else
            find_nearest(&out[k], probe, lattice, &bodies[(size_t)schema_real(probe, "body") - 1]);
        check_found(&out[k], probe, lattice, errors);
    }
    return true;
}

void probes_place(double at[2], const dem_probe *p, const dem_lattice *lattice)
{
    const dem_index first = p->number[0];
    const dem_index node[2] = {first, p->kind == DEM_PROBE_GAUGE ? p->number[1] : first};
    const dem_index *ends = p->kind == DEM_PROBE_SPRING ? lattice->ends + 2 * first : node;
    for (int c = 0; c < 2; c++) at[c] = 0.5 * (lattice->x[2 * ends[0] + c] + lattice->x[2 * ends[1] + c]);
}

void probes_free(dem_probe *probes, size_t n)
{
    for (size_t k = 0; k < n && probes != NULL; k++) free((void *)probes[k].name);
    free(probes);
}
