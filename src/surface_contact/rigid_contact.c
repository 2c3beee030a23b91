/* SPDX-License-Identifier: BSD-3-Clause */
/* Goes through the rigid bodies. What an obstacle does is what its vertices do: the forces on them, as on the ends of
 * edges that push, turned round, and the power of these at the velocities of the vertices. Ranks that share a model
 * have all rigid bodies, and sum up what is here each by itself. */
#include "surface_contact/rigid_contact.h"

#include <stdlib.h>

#include "base/status.h"

static dem_status set_up(rigid_contact *c, const contact_surface *of)
{
    const rigid_bodies *bodies = &c->model->rigid;
    TRY(obstacle_surface_compile(&c->obstacles, &c->model->obstacles));
    TRY(rate_sums_create(&c->rates, 2, c->model->obstacles.n));
    c->list = calloc((size_t)bodies->n, sizeof *c->list);
    CHECK_MEMORY(c->list);
    while (c->n < bodies->n) {
        const dem_index k = c->n++; /* it is freed even if it fails */
        TRY(rigid_pairs_create(&c->list[k], of, bodies->list[k].number, &c->obstacles));
    }
    return DEM_OK;
}

dem_status rigid_contact_create(rigid_contact **out, const dem_model *model, const contact_surface *of)
{
    *out = NULL;
    if (model->rigid.n == 0 || model->obstacles.n == 0) return DEM_OK;
    rigid_contact *c = calloc(1, sizeof *c);
    CHECK_MEMORY(c);
    c->model = model;
    const dem_status status = set_up(c, of);
    if (status == DEM_OK)
        *out = c;
    else
        rigid_contact_destroy(c);
    return status;
}

void rigid_contact_destroy(rigid_contact *c)
{
    if (c == NULL) return;
    for (dem_index k = 0; k < c->n; k++) rigid_pairs_free(&c->list[k]);
    free(c->list);
    rate_sums_free(&c->rates);
    obstacle_surface_free(&c->obstacles);
    free(c);
}

/* ---- forces ---- */

static dem_status note_status(rigid_contact *c, dem_status status)
{
    if (c->status != DEM_ERROR_MEMORY) c->status = status;
    return status;
}

static dem_status follow_body(rigid_contact *c, dem_index k, const double *x)
{
    return note_status(c, rigid_pairs_follow(&c->list[k], x));
}

static dem_status follow(rigid_contact *c, double t, const double *x)
{
    obstacle_surface_follow(&c->obstacles, t);
    for (dem_index k = 0; k < c->n; k++) TRY(follow_body(c, k, x));
    return DEM_OK;
}

static dem_status evaluate_body(rigid_contact *c, dem_index k, const double *x)
{
    TRY(follow_body(c, k, x));
    return note_status(c, rigid_pairs_push(&c->list[k]));
}

bool rigid_contact_evaluate(rigid_contact *c, double t, const double *x)
{
    obstacle_surface_follow(&c->obstacles, t);
    for (dem_index k = 0; k < c->n; k++)
        if (evaluate_body(c, k, x) != DEM_OK) return false;
    return true;
}

bool rigid_contact_evaluate_body(rigid_contact *c, dem_index k, double t, const double *x)
{
    obstacle_surface_follow(&c->obstacles, t);
    return evaluate_body(c, k, x) == DEM_OK;
}

double rigid_contact_accelerate(const rigid_contact *c, dem_index k, double *a)
{
    const rigid_pairs *p = &c->list[k];
    double sum = 0.0;
    for (dem_index j = 0; j < p->n_nodes; j++) {
        const dem_index i = p->nodes[j];
        vec2_put(a, i, vec2_along(vec2_at(a, i), c->model->inverse_mass[i], vec2_at(p->force, j)));
        sum += a[vec2_row(i)] + a[vec2_row(i) + 1];
    }
    return sum;
}

double rigid_contact_power(const rigid_contact *c, dem_index obstacle)
{
    const obstacle_surface *o = &c->obstacles;
    exact_sum sum = {0};
    for (dem_index b = 0; b < c->n; b++)
        for (dem_index q = 0; q < c->list[b].n_near; q++) {
            const dem_index v = c->list[b].near[q];
            if (o->obstacle[v] == obstacle)
                exact_sum_add(&sum, vec2_dot(rigid_contact_force(&c->list[b], q), obstacle_surface_velocity(o, v)));
        }
    return exact_sum_value(&sum);
}

static void add_row(const rigid_contact *c, const state_layout *l, dem_index row, vec2 term)
{
    rate_sums_add_row(&c->rates, l, row, (const double[]){term.x, term.y});
}

/* What obstacles do to one body. */
static void add_rates_of(const rigid_contact *c, const rigid_pairs *p, const state_layout *l)
{
    const obstacle_surface *o = &c->obstacles;
    for (dem_index q = 0; q < p->n_near; q++) {
        const dem_index v = p->near[q];
        const vec2 force = rigid_contact_force(p, q);
        add_row(c, l, state_impulse(l, o->obstacle[v]), force);
        if (state_has_total(l, STATE_OBSTACLE))
            rate_sums_add(&c->rates, l, state_total_index(l, STATE_OBSTACLE),
                          vec2_dot(force, obstacle_surface_velocity(o, v)));
    }
}

/* What friction does to one body, as a part of that, and what it takes: the powers on the body's nodes and on the
 * vertices of obstacles. */
static void add_friction_of(const rigid_contact *c, const rigid_pairs *p, const state_layout *l, const double *v)
{
    const obstacle_surface *o = &c->obstacles;
    const dem_index power = state_total_index(l, STATE_FRICTION);
    for (dem_index k = 0; k < p->n_nodes; k++)
        rate_sums_add(&c->rates, l, power, -vec2_dot(vec2_at(p->friction, k), vec2_at(v, p->nodes[k])));
    for (dem_index q = 0; q < p->n_near; q++) {
        const dem_index vertex = p->near[q];
        const vec2 on_vertex = vec2_at(p->friction, rigid_pairs_place(p, vertex));
        add_row(c, l, state_friction_impulse(l, o->obstacle[vertex]), vec2_scale(-1.0, on_vertex));
        rate_sums_add(&c->rates, l, power, -vec2_dot(on_vertex, obstacle_surface_velocity(o, vertex)));
    }
}

/* Away from obstacles there is nothing to add. */
void rigid_contact_add_rates(const rigid_contact *c, const state_layout *l, const double *v, double *a)
{
    dem_index n_near = 0;
    for (dem_index b = 0; b < c->n; b++) n_near += c->list[b].n_near;
    if (n_near == 0) return;
    for (dem_index b = 0; b < c->n; b++) {
        add_rates_of(c, &c->list[b], l);
        if (rigid_contact_has_friction(c)) add_friction_of(c, &c->list[b], l, v);
    }
    rate_sums_take(&c->rates, l, a);
}

/* ---- friction ---- */

dem_status rigid_contact_settle(rigid_contact *c, double t, const double *x)
{
    obstacle_surface_follow(&c->obstacles, t);
    for (dem_index k = 0; k < c->n; k++) TRY(rigid_pairs_settle(&c->list[k], x));
    return DEM_OK;
}

dem_status rigid_contact_restore(rigid_contact *c, dem_index k, const anchor_record *records, dem_index n, double t,
                                 const double *x)
{
    obstacle_surface_follow(&c->obstacles, t);
    return rigid_pairs_restore(&c->list[k], records, n, x);
}

double rigid_contact_stored(rigid_contact *c, double t, const double *x)
{
    exact_sum sum = {0};
    if (follow(c, t, x) != DEM_OK) return (double)NAN;
    for (dem_index k = 0; k < c->n; k++)
        anchor_set_add_energy(&c->list[k].anchors, &c->list[k].pairs, c->list[k].places, &sum);
    return exact_sum_value(&sum);
}

/* ---- energy and stiffness ---- */

double rigid_contact_energy(rigid_contact *c, double t, const double *x)
{
    exact_sum sum = {0};
    if (follow(c, t, x) != DEM_OK) return (double)NAN;
    for (dem_index k = 0; k < c->n; k++) rigid_pairs_add_energy(&c->list[k], &sum);
    return exact_sum_value(&sum);
}

double rigid_contact_stiffening(rigid_contact *c, double t, const double *x)
{
    double largest = 0.0;
    if (follow(c, t, x) != DEM_OK) return INFINITY;
    for (dem_index k = 0; k < c->n; k++)
        largest = fmax(largest, rigid_pairs_stiffening(&c->list[k], c->model->inverse_mass));
    return largest;
}

/* ---- steps ---- */

/* Whether a pair of body k crosses in the step, at whose start the obstacles are. */
static bool find_crossing(rigid_contact *c, dem_index k, rigid_crossing *out)
{
    rigid_pairs *p = &c->list[k];
    rigid_pairs_look_back(p);
    const contact_pair *pair = rigid_pairs_crossing(p, &out->part);
    if (pair == NULL) return false;
    out->body = p->body;
    out->obstacle = rigid_pairs_obstacle(p, pair);
    out->place = vec2_at(p->places, pair->nodes[CONTACT_PAIR_NODE]);
    return true;
}

dem_status rigid_contact_check_step(rigid_contact *c, const double *x0, double t0, const double *x1, double t1,
                                    rigid_crossing *crossing)
{
    obstacle_surface_follow(&c->obstacles, t0);
    for (dem_index k = 0; k < c->n; k++) rigid_pairs_begin_step(&c->list[k], x0);
    obstacle_surface_follow(&c->obstacles, t1);
    for (dem_index k = 0; k < c->n; k++) TRY(rigid_pairs_end_step(&c->list[k], x1));
    obstacle_surface_follow(&c->obstacles, t0);
    for (dem_index k = 0; k < c->n; k++)
        if (find_crossing(c, k, crossing)) return DEM_ERROR_CONTACT;
    return DEM_OK;
}

dem_status rigid_contact_check_start(rigid_contact *c, double t, const double *x)
{
    TRY(follow(c, t, x));
    for (dem_index k = 0; k < c->n; k++) TRY(rigid_pairs_check_start(&c->list[k]));
    return DEM_OK;
}
