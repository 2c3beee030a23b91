/* SPDX-License-Identifier: BSD-3-Clause */
/* Who sleeps, and until when. */
#include "contact/broad_phase.h"

#include <stdlib.h>

#include "base/status.h"

dem_status watch_create(contact_watch *out, dem_index n_sites)
{
    contact_watch w = {.awake = malloc(((size_t)n_sites + 1) * sizeof *w.awake)};
    CHECK(w.awake != NULL, DEM_ERROR_MEMORY, "out of memory for %lld contact sites", (long long)n_sites);
    *out = w;
    return DEM_OK;
}

void watch_destroy(contact_watch *w)
{
    free(w->awake);
    *w = (contact_watch){0};
}

double watch_speed(const contact_sites *c, const double *v)
{
    double square = 0.0;
    for (dem_index k = 0; k < c->scene.model->n_sites; k++) {
        const vec2 vi = vec2_at(v, c->list[k].node);
        square = fmax(square, vec2_dot(vi, vi));
    }
    return sqrt(square);
}

/* A node that was behind an obstacle and is in front of it, or round the free end again, is in front. */
static void come_back(contact_sites *c, dem_index k, vec2 x)
{
    const double margin = scene_margin(&c->scene);
    if (obstacles_gap_of(&c->scene.model->obstacles, x, margin, c->list[k].behind[0]).distance > 0.0)
        sites_go_behind(c, k, -1);
}

/* Looks how far a site is from everything else, and lets it sleep if that is further than `reach`. */
static void look_at(contact_watch *w, contact_sites *c, dem_index k, const double *x, double reach)
{
    contact_site *site = &c->list[k];
    const contact_spot spot = site_spot(site, x);
    dem_index nearest;
    double clear = site_clearance(&c->scene, site, &spot, &nearest);
    const bool untouched = site->asleep ? site->wake > w->travelled : site_moved(site, &spot) < site->clear;
    if (clear < 0.0 && untouched && site->n_closed == 0 && !site_is_edge(site)) {
        sites_go_behind(c, k, scene_segment(&c->scene, nearest)->obstacle);
        clear = site_clearance(&c->scene, site, &spot, &nearest);
    }
    clear -= 2.0 * scene_margin(&c->scene);
    site->asleep = clear > reach;
    site->wake = w->travelled + clear;
    site->clear = fmax(0.0, clear);
    site->clear_at[0] = spot.a;
    site->clear_at[1] = spot.b;
}

/* What sleeps until it may wake, and what is awake until it has moved half as far as it was clear. */
static bool worth_a_look(const contact_watch *w, const contact_site *site, const double *x, double reach)
{
    if (site->asleep) return site->wake <= w->travelled + reach;
    const contact_spot spot = site_spot(site, x);
    return site_moved(site, &spot) >= 0.5 * site->clear;
}

void watch_look(contact_watch *w, contact_sites *c, const double *x, const double *v)
{
    w->speed = watch_speed(c, v);
    const double reach = 1.25 * c->scene.rule.max_step * w->speed; /* further is found after the step */
    w->n = 0;
    w->earliest = (double)INFINITY;
    for (dem_index k = 0; k < c->scene.model->n_sites && c->books.counts.behind > 0; k++)
        if (c->list[k].behind[0] >= 0) come_back(c, k, vec2_at(x, c->list[k].node));
    for (dem_index k = 0; k < c->n; k++) {
        const contact_site *site = &c->list[k];
        if (worth_a_look(w, site, x, reach)) look_at(w, c, k, x, reach);
        if (site->n_closed > 0 || !site->asleep)
            w->awake[w->n++] = k;
        else
            w->earliest = fmin(w->earliest, site->wake);
    }
}
