/* SPDX-License-Identifier: BSD-3-Clause */
/* Rings, stages and the change. */
#include "patch.h"

#include <stdlib.h>
#include <string.h>

#include "status.h"

enum { END = PATCH_STAGES, LAST = PATCH_STAGES - 2 }; /* the end of the step, and a stage that is there as well */

dem_status patch_create(patch *out, contact_sites *sites, const unsigned char *held, double position_error,
                        double velocity_error)
{
    const dem_model *model = sites->scene.model;
    patch p = {.sites = sites,
               .held = held,
               .position_error = position_error,
               .velocity_error = velocity_error,
               .n_rings = model->springs.viscosity != NULL ? 6 : 3};
    TRY(method_load(&p.table, DEM_METHOD_FEHLBERG45));
    p.ring = malloc((size_t)model->lattice.n_nodes);
    CHECK_MEMORY(p.ring);
    for (dem_index i = 0; i < model->lattice.n_nodes; i++) p.ring[i] = -1;
    *out = p;
    return DEM_OK;
}

void patch_destroy(patch *p)
{
    free(p->ring);
    free(p->nodes);
    free(p->block);
    free(p->groups);
    *p = (patch){0};
}

/* Rings on which accelerations change at a stage: one more for every two stages, the first because a node may be put
 * back on its surface; damped springs one more for each. */
static int reach(const patch *p, int stage)
{
    const int rings = p->n_rings > 3 ? stage + 1 : 1 + stage / 2;
    return rings < p->n_rings ? rings : p->n_rings;
}

/* ---- memory ---- */

enum { ARRAYS = 6 * PATCH_STAGES + 3 };

static double **array_of(patch *p, int k)
{
    double **const groups[] = {p->x, p->v, p->a, p->dx, p->dv, p->da};
    return k < 3 * PATCH_STAGES
               ? &groups[k / PATCH_STAGES][k % PATCH_STAGES]
               : &groups[3 + (k - 3 * PATCH_STAGES) / (PATCH_STAGES + 1)][(k - 3 * PATCH_STAGES) % (PATCH_STAGES + 1)];
}

/* Room for one more node, or pair of the books. */
static dem_status reserve(patch *p)
{
    const dem_index used = p->n + p->n_books, more = 2 * p->capacity + 64;
    if (used < p->capacity) return DEM_OK;
    patch_node *nodes = realloc(p->nodes, (size_t)more * sizeof *nodes);
    CHECK(nodes != NULL, DEM_ERROR_MEMORY, "out of memory for what is near a contact");
    p->nodes = nodes;
    double *block = calloc(2 * (size_t)more * ARRAYS, sizeof *block);
    CHECK(block != NULL, DEM_ERROR_MEMORY, "out of memory for what is near a contact");
    for (int k = 0; k < ARRAYS; k++) {
        double **array = array_of(p, k), *moved = block + 2 * (size_t)more * (size_t)k;
        if (used > 0) memcpy(moved, *array, 2 * (size_t)used * sizeof *moved);
        *array = moved;
    }
    free(p->block);
    p->block = block;
    p->capacity = more;
    return DEM_OK;
}

/* ---- rings ---- */

static dem_status add_node(patch *p, dem_index i, int ring)
{
    if (p->ring[i] >= 0) return DEM_OK;
    TRY(reserve(p));
    p->ring[i] = (signed char)ring;
    p->nodes[p->n].place = i;
    p->nodes[p->n].held = p->held != NULL ? p->held[i] : 0;
    p->n++;
    return DEM_OK;
}

static dem_status add_neighbours(patch *p, dem_index i, int ring)
{
    const springs *s = &p->sites->scene.model->springs;
    const triangles *tri = &p->sites->scene.model->triangles;
    for (dem_index q = s->row[i]; q < s->row[i + 1]; q++) TRY(add_node(p, s->neighbour[q], ring));
    for (dem_index q = tri->row[i]; q < tri->row[i + 1]; q++) {
        TRY(add_node(p, tri->next[q], ring));
        TRY(add_node(p, tri->last[q], ring));
    }
    return DEM_OK;
}

/* Notes a group; returns whether it is new. */
static dem_status note_group(patch *p, dem_index group, int ring, bool *is_new)
{
    *is_new = false;
    for (dem_index g = 0; g < p->n_groups; g++)
        if (p->groups[g].group == group) return DEM_OK;
    if (p->n_groups == p->group_capacity) {
        const dem_index more = 2 * p->group_capacity + 16;
        patch_group *groups = realloc(p->groups, (size_t)more * sizeof *groups);
        CHECK(groups != NULL, DEM_ERROR_MEMORY, "out of memory for what is near a contact");
        p->groups = groups;
        p->group_capacity = more;
    }
    p->groups[p->n_groups++] = (patch_group){group, ring};
    *is_new = true;
    return DEM_OK;
}

/* All nodes of a group move at once. */
static dem_status add_group(patch *p, dem_index node, int ring)
{
    const reactions *r = &p->sites->reactions;
    const dem_index group = sites_group_at(p->sites, node);
    bool is_new;
    if (group < 0) return DEM_OK;
    TRY(note_group(p, group, ring, &is_new));
    for (dem_index m = r->row[group]; m < r->row[group + 1] && is_new; m++) {
        const contact_site *site = &p->sites->list[r->members[m]];
        TRY(add_node(p, site->node, ring));
        if (site_is_edge(site)) TRY(add_node(p, site->other, ring));
    }
    return DEM_OK;
}

static dem_status close_ring(patch *p, int ring)
{
    const dem_index first = ring > 0 ? p->end[ring - 1] : 0;
    for (dem_index j = first; j < p->n && ring <= p->n_rings; j++) TRY(add_group(p, p->nodes[j].place, ring));
    p->end[ring] = p->n;
    for (dem_index j = first; j < p->end[ring]; j++)
        p->nodes[j].grouped = sites_group_at(p->sites, p->nodes[j].place) >= 0;
    return DEM_OK;
}

/* What an event at a site may change at once: its nodes, and where obstacles have vertices those of the edges there. */
static dem_status add_seeds(patch *p, dem_index k)
{
    const contact_site *site = &p->sites->list[k];
    const surface *s = &p->sites->scene.model->surface;
    const dem_index nodes[2] = {site->node, site_is_edge(site) ? site->other : site->node};
    for (int e = 0; e < 2; e++) {
        TRY(add_node(p, nodes[e], 0));
        for (dem_index q = s->row[nodes[e]]; q < s->row[nodes[e] + 1] && p->sites->n > p->sites->scene.model->n_sites;
             q++)
            for (int end = 0; end < 2; end++) TRY(add_node(p, s->ends[2 * s->at[q] + end], 0));
    }
    return close_ring(p, 0);
}

static dem_status gather(patch *p, dem_index site)
{
    for (dem_index j = 0; j < p->n; j++) p->ring[p->nodes[j].place] = -1;
    p->n = p->n_books = p->n_groups = 0;
    TRY(add_seeds(p, site));
    for (int ring = 1; ring <= p->n_rings + 1; ring++) {
        const dem_index first = ring > 1 ? p->end[ring - 2] : 0, last = p->end[ring - 1];
        for (dem_index j = first; j < last; j++) TRY(add_neighbours(p, p->nodes[j].place, ring));
        TRY(close_ring(p, ring));
    }
    return DEM_OK;
}

/* The groups as they are now. */
static dem_status find_groups(patch *p)
{
    bool is_new;
    p->n_groups = 0;
    for (int ring = 0; ring <= p->n_rings; ring++)
        for (dem_index j = ring > 0 ? p->end[ring - 1] : 0; j < p->end[ring]; j++) {
            const dem_index group = sites_group_at(p->sites, p->nodes[j].place);
            p->nodes[j].grouped = group >= 0;
            if (group >= 0) TRY(note_group(p, group, ring, &is_new));
        }
    return DEM_OK;
}

/* ---- books ---- */

/* The pair of the books at a place; one that is new has not changed. */
static dem_status find_book(patch *p, dem_index place, dem_index *out)
{
    for (*out = p->n; *out < p->n + p->n_books; (*out)++)
        if (p->nodes[*out].place == place) return DEM_OK;
    TRY(reserve(p));
    p->nodes[*out] = (patch_node){.place = place};
    for (int k = 3 * PATCH_STAGES; k < ARRAYS; k++) vec2_put(*array_of(p, k), *out, (vec2){0.0, 0.0});
    p->n_books++;
    return DEM_OK;
}

static dem_status add_rate(patch *p, dem_index place, int stage, double sign, vec2 rate)
{
    dem_index book;
    if (rate.x == 0.0 && rate.y == 0.0) return DEM_OK;
    TRY(find_book(p, place, &book));
    vec2_put(p->da[stage], book, vec2_along(vec2_at(p->da[stage], book), sign, rate));
    return DEM_OK;
}

/* What damping takes at a node, and boundaries put in, W; of these what no event changes is left out. */
static vec2 node_powers(const patch *p, const patch_node *node, const double *x, const double *v)
{
    const contact_scene *scene = &p->sites->scene;
    const dem_model *model = scene->model;
    const model_load *load = &scene->rule.load;
    const dem_index i = node->place;
    const vec2 vi = vec2_at(v, i);
    vec2 power = {model->inverse_mass[i] > 0.0 ? load->mass_damping * model->lattice.mass[i] * vec2_dot(vi, vi) : 0.0,
                  0.0};
    if (model->springs.viscosity != NULL) power.x -= vec2_dot(springs_damping(&model->springs, i, x, v), vi);
    if (load->boundaries != NULL) power.y += vec2_dot(boundaries_force(load->boundaries, i, v[load->clock]), vi);
    if (node->held != 0) {
        const vec2 a = model_acceleration(model, load, i, x, v);
        if (node->held & DEM_COMPONENT_X) power.y -= model->lattice.mass[i] * a.x * vi.x;
        if (node->held & DEM_COMPONENT_Y) power.y -= model->lattice.mass[i] * a.y * vi.y;
    }
    return power;
}

/* Adds the rates of the books that come from the patch, in a state whose contact forces are known. */
static dem_status add_rates(patch *p, int stage, double sign, const double *y)
{
    const contact_sites *c = p->sites;
    const reactions *r = &c->reactions;
    const double *v = y + scene_velocities(&c->scene);
    const dem_index first = scene_books(&c->scene), n_obstacles = c->scene.model->obstacles.n;
    const int rings = reach(p, stage);
    vec2 totals[2] = {{0.0, 0.0}, {0.0, 0.0}};
    for (dem_index g = 0; g < p->n_groups; g++) {
        if (p->groups[g].ring > rings) continue;
        for (dem_index m = r->row[p->groups[g].group]; m < r->row[p->groups[g].group + 1]; m++)
            for (int q = 0; q < c->list[r->members[m]].n_closed; q++) {
                const sites_share of = sites_share_of(c, r->members[m], q, y, v);
                TRY(add_rate(p, first + of.obstacle, stage, sign, of.force));
                TRY(add_rate(p, first + n_obstacles + of.obstacle, stage, sign, of.friction));
                totals[0].x += of.power;
            }
    }
    if (p->held != NULL || c->scene.model->springs.viscosity != NULL || c->scene.rule.load.mass_damping > 0.0)
        for (dem_index j = 0; j < p->end[rings]; j++) {
            const vec2 powers = node_powers(p, &p->nodes[j], y, v);
            totals[0].y += powers.x;
            totals[1].x += powers.y;
        }
    for (int k = 0; k < 2; k++) TRY(add_rate(p, first + 2 * n_obstacles + k, stage, sign, totals[k]));
    return DEM_OK;
}

/* ---- stages ---- */

static double stage_time(const patch *p, const path *step, int stage)
{
    return stage == LAST ? step->t1 : p->t + p->table.c[stage] * p->h;
}

/* Puts the time into a state, for those who are driven by it. */
static void put_time(const patch *p, const path *step, int stage, double *y)
{
    const dem_index last = step->n_nodes - 1;
    if (p->sites->scene.rule.load.boundaries == NULL) return;
    vec2_put(y, step->n_nodes + last, path_velocity(step, stage_time(p, step, stage), last));
}

/* Puts n nodes into a state as they are at a stage without the event. */
static void fetch_stage(patch *p, const path *step, int stage, dem_index n, double *y)
{
    const double s = p->table.c[stage];
    double *x = p->x[stage], *v = p->v[stage];
    for (dem_index j = 0; j < n; j++) {
        const dem_index i = p->nodes[j].place;
        trail_at(&p->nodes[j].motion, s, x + 2 * j, v + 2 * j);
        vec2_put(y, i, vec2_at(x, j));
        vec2_put(y, step->n_nodes + i, vec2_at(v, j));
    }
    put_time(p, step, stage, y);
}

/* The contact forces in a state; then accelerate() gives the accelerations. */
static void solve_groups(patch *p, int stage, const double *y)
{
    const double *v = y + scene_velocities(&p->sites->scene);
    for (dem_index g = 0; g < p->n_groups; g++)
        if (p->groups[g].ring <= reach(p, stage)) reactions_solve(&p->sites->reactions, p->groups[g].group, y, v);
}

static vec2 accelerate(const patch *p, const patch_node *node, const double *y)
{
    const contact_scene *scene = &p->sites->scene;
    if (node->grouped) return vec2_at(p->sites->reactions.a, node->place);
    return model_acceleration(scene->model, &scene->rule.load, node->place, y, y + scene_velocities(scene));
}

/* How the patch would go on. */
static dem_status open_stage(patch *p, const path *step, int stage, double *y)
{
    fetch_stage(p, step, stage, p->end[reach(p, stage) + 1], y);
    solve_groups(p, stage, y);
    for (dem_index j = 0; j < p->end[reach(p, stage)]; j++) vec2_put(p->a[stage], j, accelerate(p, &p->nodes[j], y));
    return add_rates(p, stage, -1.0, y);
}

/* At the end of the step that is known. */
static dem_status open_end(patch *p, const path *step)
{
    for (dem_index j = 0; j < p->n; j++) {
        const dem_index i = p->nodes[j].place;
        vec2_put(p->x[LAST], j, vec2_at(step->y1, i));
        vec2_put(p->v[LAST], j, vec2_at(step->y1, step->n_nodes + i));
        vec2_put(p->a[LAST], j, vec2_at(step->f1, step->n_nodes + i));
    }
    TRY(add_rates(p, END, -1.0, step->y1));
    return add_rates(p, LAST, -1.0, step->y1);
}

static trail_motion motion_of(const patch *p, const path *step, dem_index place)
{
    const bool turned = trail_has(step->trail, place);
    const trail_motion motion = turned ? *trail_of(step->trail, place) : path_motion(step, place);
    return trail_later(&motion, p->t, step->t1);
}

/* What the event is due by has the bits that it was found with. */
static void fetch_start(patch *p, const path *step, double *y)
{
    for (dem_index j = 0; j < p->end[1]; j++) {
        const dem_index i = p->nodes[j].place;
        vec2_put(p->x[0], j, path_position(step, p->t, i));
        vec2_put(p->v[0], j, path_velocity(step, p->t, i));
        vec2_put(y, i, vec2_at(p->x[0], j));
        vec2_put(y, step->n_nodes + i, vec2_at(p->v[0], j));
    }
}

dem_status patch_open(patch *p, const path *step, dem_index site, double t, double *state)
{
    p->t = t;
    p->h = step->t1 - t;
    TRY(gather(p, site));
    for (dem_index j = 0; j < p->n; j++) p->nodes[j].motion = motion_of(p, step, p->nodes[j].place);
    TRY(open_end(p, step));
    for (int stage = 0; stage < PATCH_STAGES; stage++)
        if (stage != LAST) TRY(open_stage(p, step, stage, state));
    fetch_stage(p, step, 0, p->n, state);
    fetch_start(p, step, state);
    return DEM_OK;
}

/* ---- the change ---- */

/* to = from + h sum of weights rates over the stages before, of nodes first to last - 1. */
static void combine(const patch *p, int stage, double *const rates[], double *const change[], dem_index first,
                    dem_index last)
{
    const double *weights = stage == END ? p->table.b : p->table.a + stage * PATCH_STAGES;
    double *restrict to = change[stage];
    memcpy(to + 2 * first, change[0] + 2 * first, 2 * (size_t)(last - first) * sizeof *to);
    for (int q = 0; q < stage; q++) {
        const double *restrict rate = rates[q], weight = p->h * weights[q];
        for (dem_index k = 2 * first; k < 2 * last && weight != 0.0; k++) to[k] += weight * rate[k];
    }
}

static void advance(patch *p, int stage)
{
    const dem_index moving = p->end[p->n_rings];
    combine(p, stage, p->dv, p->dx, 0, moving);
    combine(p, stage, p->da, p->dv, 0, moving);
    if (p->n_books == 0) return;
    combine(p, stage, p->dv, p->dx, p->n, p->n + p->n_books);
    combine(p, stage, p->da, p->dv, p->n, p->n + p->n_books);
}

/* Puts the changed state at a stage in place, as far as accelerations depend on it. */
static void put_stage(const patch *p, const path *step, int stage, double *y)
{
    const int at = stage == END ? LAST : stage;
    const dem_index needed = p->end[reach(p, stage) + 1], moving = p->end[p->n_rings];
    for (dem_index j = 0; j < needed; j++) {
        const dem_index i = p->nodes[j].place;
        vec2 x = vec2_at(p->x[at], j), v = vec2_at(p->v[at], j);
        if (j < moving) {
            x = vec2_add(x, vec2_at(p->dx[stage], j));
            v = vec2_add(v, vec2_at(p->dv[stage], j));
        }
        vec2_put(y, i, x);
        vec2_put(y, step->n_nodes + i, v);
    }
    put_time(p, step, at, y);
}

/* Rates of the change at a stage. */
static dem_status change_stage(patch *p, const path *step, int stage, double *y)
{
    const int at = stage == END ? LAST : stage;
    put_stage(p, step, stage, y);
    solve_groups(p, stage, y);
    for (dem_index j = 0; j < p->end[p->n_rings]; j++) {
        const patch_node *node = &p->nodes[j];
        vec2 change = {0.0, 0.0};
        if (j < p->end[reach(p, stage)]) change = vec2_sub(accelerate(p, node, y), vec2_at(p->a[at], j));
        if (node->held & DEM_COMPONENT_X) change.x = 0.0;
        if (node->held & DEM_COMPONENT_Y) change.y = 0.0;
        vec2_put(p->da[stage], j, change);
    }
    return add_rates(p, stage, 1.0, y);
}

static trail_jump jump_at(const patch *p, int stage, dem_index j)
{
    return (trail_jump){vec2_at(p->dx[stage], j), vec2_at(p->dv[stage], j), vec2_at(p->da[stage], j)};
}

/* Makes the change of a node one of the step. */
static dem_status leave(const patch *p, const path *step, trail *tr, dem_index j)
{
    const dem_index place = p->nodes[j].place;
    const trail_jump at = jump_at(p, 0, j), end = jump_at(p, END, j);
    const trail_jump by = {vec2_sub(end.x, at.x), vec2_sub(end.v, at.v), vec2_sub(end.a, at.a)};
    trail_motion motion = j < p->n ? p->nodes[j].motion : motion_of(p, step, place);
    trail_bend(&motion, step->t1, &at, &by);
    TRY(trail_turn(tr, place, &motion));
    trail_move_end(tr, place, &end);
    return DEM_OK;
}

static double squared_error(const patch *p)
{
    const dem_index n = p->sites->scene.model->lattice.n_nodes;
    double weights[PATCH_STAGES], x_sum = 0.0, v_sum = 0.0;
    for (int q = 0; q < PATCH_STAGES; q++) weights[q] = p->h * (p->table.b[q] - p->table.d[q]);
    for (dem_index k = 0; k < 2 * p->end[p->n_rings]; k++) {
        double x = 0.0, v = 0.0;
        for (int q = 0; q < PATCH_STAGES; q++) {
            x += weights[q] * p->dv[q][k];
            v += weights[q] * p->da[q][k];
        }
        x_sum += x * x;
        v_sum += v * v;
    }
    return (x_sum / (p->position_error * p->position_error) + v_sum / (p->velocity_error * p->velocity_error)) /
           (4.0 * (double)n);
}

dem_status patch_close(patch *p, const path *step, trail *tr, double *state, double *error)
{
    TRY(find_groups(p));
    for (dem_index j = 0; j < p->end[p->n_rings]; j++) {
        const dem_index i = p->nodes[j].place;
        vec2_put(p->dx[0], j, vec2_sub(vec2_at(state, i), vec2_at(p->x[0], j)));
        vec2_put(p->dv[0], j, vec2_sub(vec2_at(state, step->n_nodes + i), vec2_at(p->v[0], j)));
    }
    for (int stage = 0; stage <= END; stage++) {
        if (stage > 0) advance(p, stage);
        TRY(change_stage(p, step, stage, state));
    }
    for (dem_index j = 0; j < p->end[p->n_rings]; j++) TRY(leave(p, step, tr, j));
    for (dem_index j = p->n; j < p->n + p->n_books; j++) TRY(leave(p, step, tr, j));
    *error = squared_error(p);
    return DEM_OK;
}
