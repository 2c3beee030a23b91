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

/* A probe has one, a gauge two. */
struct probe_end {
    dem_index number;      /* as given, or of what is nearest so far; -1: of nothing */
    const placement *body; /* in which the nearest is looked for; NULL: the number is given */
    double at[2];          /* m, the place that it is to be nearest to, in the body's own coordinates */
    double least;          /* m, distance of what is nearest */
    double x[2];           /* m, where what has the number is */
};

static double distance(const double *a, const double *b)
{
    return hypot(a[0] - b[0], a[1] - b[1]);
}

/* At something of this number, with `node` in it, at x. */
static void look_at(probe_end *e, dem_index number, dem_index node, const double x[2])
{
    double own[2], d = 0.0;
    if (e->body != NULL) {
        if (node < e->body->first || node >= e->body->first + e->body->n_nodes) return;
        placement_own(e->body, x, own);
        d = distance(own, e->at);
        if (d >= e->least) return;
    } else if (number != e->number) {
        return;
    }
    e->number = number;
    e->least = d;
    for (int c = 0; c < 2; c++) e->x[c] = x[c];
}

static void look_at_nodes(probe_end *e, const dem_slab *slab)
{
    for (dem_index k = 0; k < slab->n_own; k++)
        look_at(e, slab->first_node + k, slab->first_node + k, slab->lattice.x + 2 * (slab->first_own + k));
}

/* At those whose lower end is an own node, the first of which has the number `first`. \return behind the last one */
static dem_index look_at_springs(probe_end *e, const dem_slab *slab, dem_index first)
{
    const dem_lattice *l = &slab->lattice;
    dem_index number = first;
    for (dem_index k = 0; k < l->n_springs; k++) {
        const dem_index i = l->ends[2 * k], j = l->ends[2 * k + 1], own = (i < j ? i : j) - slab->first_own;
        const double *a = l->x + 2 * i, *b = l->x + 2 * j, middle[2] = {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])};
        if (own < 0 || own >= slab->n_own) continue;
        if (e != NULL) look_at(e, number, slab->first_node + own, middle);
        number++;
    }
    return number;
}

void probes_look(probe_search *s, const dem_slab *slab)
{
    for (size_t k = 0; k < s->n; k++) {
        const dem_probe *p = &s->probes[k];
        for (probe_end *e = s->ends + 2 * k; e < s->ends + 2 * k + count_ends(schema_get(s->groups, "probe", k)); e++) {
            if (p->kind == DEM_PROBE_SPRING)
                (void)look_at_springs(e, slab, s->n_springs);
            else
                look_at_nodes(e, slab);
        }
    }
    s->n_nodes += slab->n_own;
    s->n_springs = look_at_springs(NULL, slab, s->n_springs);
}

/* ---- probes ---- */

static void begin_end(probe_end *e, const schema_instance *probe, const placement *bodies, int q)
{
    *e = (probe_end){.number = -1, .least = (double)INFINITY};
    if (schema_given(probe, "number")) {
        e->number = (dem_index)schema_reals(probe, "number")[q];
        return;
    }
    e->body = &bodies[(size_t)schema_real(probe, "body") - 1];
    for (int c = 0; c < 2; c++) e->at[c] = schema_reals(probe, "place")[2 * q + c];
}

bool probes_begin(probe_search *out, dem_probe *probes, const schema_deck *groups, const placement *bodies)
{
    const size_t n = schema_count(groups, "probe");
    *out = (probe_search){.groups = groups, .probes = probes, .n = n, .ends = calloc(2 * n + 1, sizeof *out->ends)};
    for (size_t k = 0; k < n && out->ends != NULL; k++) {
        const schema_instance *probe = schema_get(groups, "probe", k);
        probes[k] = (dem_probe){.name = strdup(schema_text(probe, "name")),
                                .kind = has_kind(probe, "gauge")    ? DEM_PROBE_GAUGE
                                        : has_kind(probe, "spring") ? DEM_PROBE_SPRING
                                                                    : DEM_PROBE_NODE,
                                .every = (dem_index)schema_real(probe, "every")};
        if (probes[k].name == NULL) return false;
        for (int q = 0; q < count_ends(probe); q++) begin_end(&out->ends[2 * k + (size_t)q], probe, bodies, q);
    }
    return out->ends != NULL;
}

static void check_found(const probe_search *s, size_t k, namelist_errors *errors)
{
    const schema_instance *probe = schema_get(s->groups, "probe", k);
    const probe_end *end = s->ends + 2 * k;
    const namelist_place where = schema_place(probe, schema_given(probe, "place") ? "place" : "number");
    const bool spring = s->probes[k].kind == DEM_PROBE_SPRING;
    const dem_index n = spring ? s->n_springs : s->n_nodes;
    for (int q = 0; q < count_ends(probe); q++)
        if (end[q].number < 0 || end[q].number >= n) {
            namelist_errors_add(errors, where,
                                "probe '%s': there is no such %s; they are numbered from 0, and there are %lld",
                                s->probes[k].name, spring ? "spring" : "node", (long long)n);
            return;
        }
    if (s->probes[k].kind != DEM_PROBE_GAUGE || distance(end[0].x, end[1].x) > 0.0) return;
    namelist_errors_add(errors, where, "probe '%s': both ends of the gauge are at node %lld", s->probes[k].name,
                        (long long)end[0].number);
}

void probes_end(probe_search *s, double (*places)[2], namelist_errors *errors)
{
    for (size_t k = 0; k < s->n; k++) {
        const probe_end *end = s->ends + 2 * k, *last = end + count_ends(schema_get(s->groups, "probe", k)) - 1;
        for (const probe_end *e = end; e <= last; e++) s->probes[k].number[e - end] = e->number;
        for (int c = 0; c < 2; c++) places[k][c] = 0.5 * (end->x[c] + last->x[c]);
        check_found(s, k, errors);
    }
}

void probes_forget(probe_search *s)
{
    free(s->ends);
    *s = (probe_search){0};
}

void probes_free(dem_probe *probes, size_t n)
{
    for (size_t k = 0; k < n && probes != NULL; k++) free((void *)probes[k].name);
    free(probes);
}
