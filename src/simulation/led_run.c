/* SPDX-License-Identifier: BSD-3-Clause */
/* While a part is advanced its observers on rank 0 call those of the whole (leader_observers.c), and on other ranks
 * they take calls until the leader lets them go on. */
#include "simulation/led_run.h"

#include <stdlib.h>
#include <string.h>

#include "base/checkpoint_entries.h"
#include "base/reduce.h"
#include "base/status.h"
#include "simulation/leader_checkpoint.h"
#include "simulation/leader_observers.h"
#include "simulation/leader_peaks.h"
#include "simulation/led_parts.h"
#include "simulation/rank_shares.h"
#include "simulation/shared_field.h"
#include "simulation/shared_orders.h"
#include "simulation/shared_problem.h"
#include "simulation/step_parts.h"

/* Whether an event has stopped all parts, as it concerns nodes that not all of them have. */
static bool goes_back(led_run *l)
{
    if (l->part == NULL || !event_queue_lacks_nodes(&l->part->queue)) return false;
    led_ranks_go_back(l);
    return true;
}

/* ---- followers ---- */

static rank_call serve(led_run *l);

static dem_status wait_for_leader(led_run *l)
{
    led_ranks_leave(l);
    const rank_call last = serve(l);
    led_ranks_enter(l);
    return last.number == DEM_OK ? DEM_OK : status_repeat((dem_status)last.number, "rank 0 has ended the run");
}

/* An observer of the leader's, seen from a follower. */
static dem_status follow_observer(led_run *l)
{
    return led_ranks_have_seen(l) ? DEM_OK : wait_for_leader(l);
}

static dem_status follow_step(void *context, const dem_simulation *part)
{
    return led_ranks_have_seen_step(context, part) ? DEM_OK : wait_for_leader(context);
}

static dem_status follow_before(void *context, const dem_simulation *part)
{
    return led_ranks_are_before(context, part) ? wait_for_leader(context) : DEM_OK;
}

static dem_status follow_event(void *context, const dem_simulation *part, const dem_event *event)
{
    (void)part;
    (void)event;
    return follow_observer(context);
}

static dem_status follow_break(void *context, const dem_simulation *part, const dem_break *what)
{
    (void)part;
    (void)what;
    return follow_observer(context);
}

static dem_status follow_frame(void *context, const dem_simulation *part)
{
    (void)part;
    return follow_observer(((const frame_relay *)context)->run);
}

static dem_status follow_checkpoint(void *context, const dem_simulation *part, dem_checkpoint *checkpoint)
{
    (void)part;
    (void)checkpoint;
    (void)led_ranks_collect_busy(context);
    led_ranks_pass_checkpoint(context);
    return wait_for_leader(context);
}

/* ---- what all ranks do ---- */

static const led_observers follower_observers = {.step = follow_step,
                                                 .before = follow_before,
                                                 .event = follow_event,
                                                 .broken = follow_break,
                                                 .frame = follow_frame,
                                                 .checkpoint = follow_checkpoint};

static dem_status observe(led_run *l, const rank_call *o)
{
    const led_observers *own = l->whole != NULL ? &leader_observers : &follower_observers;
    dem_observer steps = {.struct_size = sizeof steps, .step = own->step, .checkpoint = own->checkpoint, .context = l};
    if (o->number & RANK_CALL_WITH_EVENTS) steps.event = own->event;
    if (o->number & RANK_CALL_WITH_BREAKS) steps.broken = own->broken;
    for (int k = 0; k < OBSERVERS_MOST; k++) {
        l->frames[k] = (frame_relay){l, k};
        const dem_observer frame = {
            .struct_size = sizeof frame, .interval = o->intervals[k], .frame = own->frame, .context = &l->frames[k]};
        if (o->intervals[k] > 0.0) TRY(dem_simulation_observe(l->part, &frame));
    }
    TRY(dem_simulation_observe(l->part, &steps));
    const dem_observer before = {
        .struct_size = sizeof before, .step = own->before, .step_every = INT64_MAX, .step_touching = 1, .context = l};
    if (o->number & RANK_CALL_WITH_TOUCHING) TRY(dem_simulation_observe(l->part, &before));
    l->is_observed = true;
    return DEM_OK;
}

/* Rows of all nodes to rank 0, whose quadratures are those of all. */
static dem_status gather(const led_run *l)
{
    const dem_simulation *whole = l->whole;
    double *x = whole != NULL ? whole->frame : NULL;
    TRY(dem_simulation_gather(l->part, x, x != NULL ? x + state_velocities(&whole->layout) : NULL));
    if (whole != NULL) state_copy_quadratures(x, &whole->layout, l->part->seen, &l->part->layout);
    return DEM_OK;
}

/* What an order is about is known to rank 0. */
static dem_status obey(led_run *l, const rank_call *call, const field_order *given)
{
    field_order o = {.field = (field_kind)call->number, .n_stripes = call->n_stripes, .size = call->size};
    if (given != NULL) o = *given;
    o.kept = &l->kept;
    o.team = l->part->team;
    return shared_field_obey(l->part, &o);
}

/* The largest struct that an answer fills, and its size first. */
typedef union answer {
    size_t struct_size;
    dem_energy energy;
    dem_strain strain;
    dem_counts counts;
    dem_body_motion body;
    dem_boundary_load load;
    rank_shares shares;
    double numbers[6];
} answer;

static void create_follower(led_run *l, const rank_call *o)
{
    dem_checkpoint *entries = NULL;
    if (l->is_of_slabs && !(o->number & RANK_CALL_OF_SLABS)) led_parts_drop_model(l);
    if (reduce_status(&l->ranks, dem_checkpoint_create(&entries), 0.0) == DEM_OK)
        (void)led_parts_create(l, entries, (o->number & RANK_CALL_RESUMED) != 0, NULL);
    dem_checkpoint_destroy(entries);
}

static void take_part(led_run *l, const rank_call *o)
{
    answer ignored = {.struct_size = sizeof ignored};
    led_ranks_enter(l);
    switch (o->kind) {
    case RANK_CALL_CREATE:
        create_follower(l, o);
        break;
    case RANK_CALL_SLABS:
        led_parts_make_slab(l, o->number != RANK_CALL_SLABS_AGAIN);
        break;
    case RANK_CALL_MIGRATE:
        (void)led_parts_migrate(l);
        break;
    case RANK_CALL_ARRAY:
        (void)whole_of_parts_visit(l->model, (int)o->number, NULL, NULL);
        break;
    case RANK_CALL_OBSERVE:
        (void)observe(l, o);
        break;
    case RANK_CALL_ADVANCE:
        (void)dem_simulation_advance(l->part, o->t);
        (void)goes_back(l);
        break;
    case RANK_CALL_GATHER:
        (void)gather(l);
        break;
    case RANK_CALL_STATE:
        (void)leader_checkpoint_answer(l, o->number, NULL, NULL);
        break;
    case RANK_CALL_PEAKS_TAKE:
    case RANK_CALL_PEAKS_NODES:
    case RANK_CALL_PEAKS_SPRINGS:
    case RANK_CALL_PEAKS_KEEP:
    case RANK_CALL_PEAKS_KEPT_NODES:
    case RANK_CALL_PEAKS_KEPT_SPRINGS:
    case RANK_CALL_PEAKS_LOOK:
        (void)shared_peaks_answer(&l->peaks, l->part, o);
        break;
    case RANK_CALL_ORDER:
        (void)obey(l, o, NULL);
        break;
    case RANK_CALL_OBEY:
        (void)shared_orders_pass(&l->ranks, &l->kept, NULL, 0);
        break;
    case RANK_CALL_DROP:
        led_parts_drop(l);
        break;
    default:
        (void)rank_call_answer(l->part, o, &ignored);
        break;
    }
    led_ranks_leave(l);
}

/* Takes calls until one lets this rank go on, or ends its work. */
static rank_call serve(led_run *l)
{
    for (;;) {
        const rank_call o = rank_call_send(&l->ranks, (rank_call){.kind = RANK_CALL_GO_ON});
        if (o.kind == RANK_CALL_GO_ON || o.kind == RANK_CALL_END) return o;
        take_part(l, &o);
    }
}

/* ---- of a simulation ---- */

static dem_status attach(led_run *l)
{
    const observers *a = &l->whole->observers;
    rank_call o = {.kind = RANK_CALL_OBSERVE};
    if (observers_want_events(a)) o.number |= RANK_CALL_WITH_EVENTS;
    if (observers_want_breaks(a)) o.number |= RANK_CALL_WITH_BREAKS;
    if (observers_want_touching(a)) o.number |= RANK_CALL_WITH_TOUCHING;
    for (int k = 0; k < a->n; k++)
        if (a->members[k].observer.frame != NULL) o.intervals[k] = a->members[k].observer.interval;
    o = rank_call_send(&l->ranks, o);
    led_ranks_enter(l);
    const dem_status status = observe(l, &o);
    led_ranks_leave(l);
    return status;
}

dem_status led_run_ask(const dem_simulation *whole, rank_call_kind what, dem_index number, void *out)
{
    led_run *l = whole->leads;
    const rank_call o = rank_call_send(&l->ranks, (rank_call){.kind = what, .number = number});
    led_ranks_enter(l);
    const dem_status status = rank_call_answer(l->part, &o, out);
    led_ranks_leave(l);
    return status;
}

const dem_simulation *led_run_part(const led_run *l)
{
    return l->part;
}

dem_status led_run_spread(const dem_simulation *whole, led_run_getter *get, int n_components, double *out)
{
    const dem_simulation *part = whole->leads->part;
    const domain *d = part->model->domain;
    const size_t row = (size_t)n_components * sizeof *out;
    double *here = malloc((size_t)d->n_nodes * row);
    CHECK_MEMORY(here);
    const dem_status status = get(part, here);
    memset(out, 0, (size_t)d->n_whole * row);
    for (dem_index i = 0; i < d->n_nodes && status == DEM_OK; i++)
        memcpy(out + n_components * d->number[i], here + n_components * i, row);
    free(here);
    return status;
}

void led_run_gather(dem_simulation *whole)
{
    led_run *l = whole->leads;
    (void)rank_call_send(&l->ranks, (rank_call){.kind = RANK_CALL_GATHER});
    led_ranks_enter(l);
    (void)gather(l);
    led_ranks_leave(l);
}

dem_status led_run_order(const dem_simulation *whole, const field_order *o)
{
    led_run *l = whole->leads;
    TRY(led_ranks_check(l));
    const rank_call call = {
        .kind = RANK_CALL_ORDER, .number = (dem_index)o->field, .n_stripes = o->n_stripes, .size = o->size};
    (void)rank_call_send(&l->ranks, call);
    led_ranks_enter(l);
    const dem_status status = obey(l, &call, o);
    led_ranks_leave(l);
    return status;
}

int rank_order_ranks(const dem_simulation *simulation)
{
    return simulation->leads != NULL ? simulation->leads->ranks.size : 1;
}

dem_status rank_order_give(const dem_simulation *simulation, const rank_order *orders, int n)
{
    led_run *l = simulation->leads;
    (void)rank_call_send(&l->ranks, (rank_call){.kind = RANK_CALL_OBEY});
    led_ranks_enter(l);
    const dem_status status = shared_orders_pass(&l->ranks, &l->kept, orders, n);
    led_ranks_leave(l);
    return status;
}

/* ---- parts that begin, from the start or from a checkpoint ---- */

static dem_status begin_parts(led_run *l, dem_checkpoint *entries, const dem_checkpoint *checkpoint)
{
    if (l->part != NULL) {
        TRY(leader_peaks_bring_all(l));
        TRY(checkpoint_entries_bring(l->whole->checkpoint));
        (void)rank_call_send(&l->ranks, (rank_call){.kind = RANK_CALL_DROP});
        led_parts_drop(l);
    }
    const dem_index number = (checkpoint != NULL ? RANK_CALL_RESUMED : 0) | (l->is_of_slabs ? RANK_CALL_OF_SLABS : 0);
    (void)rank_call_send(&l->ranks, (rank_call){.kind = RANK_CALL_CREATE, .number = number});
    TRY(reduce_status(&l->ranks, DEM_OK, 0.0));
    return led_parts_create(l, entries, checkpoint != NULL, checkpoint);
}

static dem_status put_problem(led_run *l, dem_checkpoint **entries)
{
    led_ranks_enter(l);
    dem_status status = dem_checkpoint_create(entries);
    const obstacle_set *obstacles = &l->whole->model->obstacles;
    if (status == DEM_OK) status = shared_problem_put(*entries, obstacles->list, obstacles->n, l->options);
    led_ranks_leave(l);
    return status;
}

/* In place of the parts that there are. */
static dem_status begin(led_run *l, const dem_checkpoint *checkpoint)
{
    dem_checkpoint *entries = NULL;
    dem_status status = put_problem(l, &entries);
    if (status == DEM_OK) status = begin_parts(l, entries, checkpoint);
    dem_checkpoint_destroy(entries);
    return status;
}

static dem_status weigh_anew(led_run *l)
{
    led_ranks_enter(l);
    const dem_status status = balance_weigh(&l->balance, &l->whole->model->lattice);
    led_ranks_leave(l);
    return status;
}

/* ---- slabs that are shared out anew ---- */

static dem_status remake_slabs(led_run *l, const dem_index *first)
{
    (void)rank_call_send(&l->ranks, (rank_call){.kind = RANK_CALL_SLABS, .number = RANK_CALL_SLABS_AGAIN});
    led_ranks_enter(l);
    const dem_status status = led_parts_remake_slab(l, first);
    led_ranks_leave(l);
    return status;
}

/* Where rows are long a rank may have none in its new range. */
static dem_status cut_anew(led_run *l)
{
    dem_index *first = calloc((size_t)l->ranks.size + 1, sizeof *first);
    CHECK_MEMORY(first);
    balance_cut(&l->balance, first);
    dem_status status = remake_slabs(l, first);
    balance_ranges(&l->balance, first);
    if (status == DEM_ERROR_MODEL) status = remake_slabs(l, first);
    free(first);
    return status;
}

static dem_status migrate(led_run *l)
{
    (void)rank_call_send(&l->ranks, (rank_call){.kind = RANK_CALL_MIGRATE});
    led_ranks_enter(l);
    const dem_status status = led_parts_migrate(l);
    led_ranks_leave(l);
    return status;
}

static dem_status share_slabs_anew(led_run *l)
{
    l->shares_anew = false;
    l->busy = 0.0; /* from here on it is what this takes */
    TRY(migrate(l));
    TRY(cut_anew(l));
    return begin(l, l->whole->checkpoint);
}

/* ---- beginning, and going on ---- */

static dem_status share_anew(led_run *l)
{
    if (l->is_of_slabs) return share_slabs_anew(l);
    near_contact_take(&l->near, l->busy, l->balance.price);
    l->shares_anew = false;
    l->busy = 0.0; /* from here on it is what this takes */
    if (l->weighs_anew) TRY(weigh_anew(l));
    return begin(l, l->whole->checkpoint);
}

/* What an event concerns is common in the parts that are made now. */
static dem_status go_back(led_run *l)
{
    near_contact_take_all(&l->near);
    l->busy = 0.0;
    return begin(l, l->whole->checkpoint);
}

static dem_status advance_parts(led_run *l, double t_end)
{
    (void)rank_call_send(&l->ranks, (rank_call){.kind = RANK_CALL_ADVANCE, .t = t_end});
    led_ranks_enter(l);
    const dem_status status = dem_simulation_advance(l->part, t_end);
    led_ranks_leave(l);
    leader_observers_show(l);
    return status;
}

dem_status led_run_advance(dem_simulation *whole, double t_end)
{
    led_run *l = whole->leads;
    TRY(led_ranks_check(l));
    if (!l->is_of_slabs) model_rows_give_up(whole->model);
    for (;;) {
        if (!l->is_observed) TRY(attach(l));
        const dem_status status = advance_parts(l, t_end);
        const bool back = goes_back(l);
        /* Without such nodes all that may touch is common as it is. */
        if (back ? near_contact_nodes(&l->near) == NULL : !l->shares_anew) return status;
        TRY(back ? go_back(l) : share_anew(l));
    }
}

static void free_run(led_run *l)
{
    balance_free(&l->balance);
    near_contact_free(&l->near);
    free(l);
}

static dem_status lead(led_run *l, const dem_checkpoint *checkpoint)
{
    /* Functions whose addresses mean nothing to the others. */
    CHECK(!l->whole->model->obstacles.is_asked, DEM_ERROR_MODEL,
          "rank 0 cannot lead a run with obstacles whose motion a function computes");
    CHECK(l->options->force == NULL, DEM_ERROR_ARGUMENT, "rank 0 cannot lead a run with an external force");
    TRY(balance_create(&l->balance, l->ranks.size));
    if (l->ranks.size > 1 && !l->is_of_slabs) TRY(near_contact_create(&l->near, l->whole->model, &l->whole->options));
    TRY(leader_observers_look_ahead(l, checkpoint));
    near_contact_take(&l->near, 0.0, 0.0);
    TRY(begin(l, checkpoint));
    if (l->is_of_slabs) l->whole->options = l->part->options; /* which depend on arrays */
    return DEM_OK;
}

void led_run_destroy(led_run *l)
{
    if (l == NULL) return;
    if (l->part != NULL) (void)leader_peaks_bring_all(l);
    leader_peaks_forget_run(l);
    (void)rank_call_send(&l->ranks, (rank_call){.kind = RANK_CALL_DROP});
    led_parts_drop(l);
    free_run(l);
}

dem_status dem_private_lead(dem_simulation *whole, const ranks *r, const dem_options *options,
                            const dem_checkpoint *checkpoint)
{
    led_run *l = calloc(1, sizeof *l);
    CHECK_MEMORY(l);
    *l = (led_run){.ranks = *r,
                   .whole = whole,
                   .options = options,
                   .weighs_anew = true,
                   .model = whole->model->part,
                   .is_of_slabs = whole->model->part != NULL,
                   .busy = whole->model->slabs.price};
    l->ranks.end = NULL;
    led_ranks_pass_checkpoint(l);
    step_parts_destroy(whole); /* before there is memory for parts */
    const dem_status status = lead(l, checkpoint);
    if (status != DEM_OK) {
        free_run(l);
        return status;
    }
    whole->leads = l;
    leader_observers_show(l);
    return DEM_OK;
}

void dem_private_shares(const dem_simulation *whole, double *least, double *most)
{
    rank_shares s;
    (void)led_run_ask(whole, RANK_CALL_SHARES, 0, &s);
    memcpy(least, s.least, sizeof s.least);
    memcpy(most, s.most, sizeof s.most);
}

/* Rank 0 has the others take part in it. */
static dem_status ask_array(const dem_model *whole, int array, rows_taker *take, void *context)
{
    (void)rank_call_send(whole->part->ranks, (rank_call){.kind = RANK_CALL_ARRAY, .number = array});
    return whole_of_parts_visit(whole->part, array, take, context);
}

/* For slabs that are made again. */
static dem_status keep_recipe(dem_model *whole, const ranks *r, const slab_maker *maker, const slab_recipe *recipe)
{
    slab_source *s = &whole->slabs;
    s->ranks = r;
    s->maker = *maker;
    s->size = recipe->size;
    s->recipe = malloc(recipe->size + 1);
    CHECK_MEMORY(s->recipe);
    memcpy(s->recipe, recipe->bytes, recipe->size);
    return DEM_OK;
}

dem_status dem_private_lead_slabs(dem_model **out, const ranks *r, const slab_maker *maker, const slab_recipe *recipe)
{
    dem_model *part = NULL, *whole = NULL;
    const double begun = ranks_busy(r);
    (void)rank_call_send(r, (rank_call){.kind = RANK_CALL_SLABS});
    TRY(shared_slabs_create(&part, r, maker, recipe));
    dem_index hash;
    dem_status status = whole_of_parts_hash(part, &hash);
    if (status == DEM_OK) status = whole_of_parts_create(&whole, part, ask_array);
    if (status != DEM_OK) {
        dem_model_destroy(part);
        return status;
    }
    whole->slabs.price = ranks_busy(r) - begun;
    whole->slabs.hash = hash;
    status = keep_recipe(whole, r, maker, recipe);
    if (status == DEM_OK)
        *out = whole;
    else
        dem_model_destroy(whole);
    return status;
}

dem_index dem_private_follow(const ranks *r, const slab_maker *maker)
{
    led_run l = {.ranks = *r, .maker = maker};
    l.ranks.end = NULL;
    led_ranks_pass_checkpoint(&l);
    const rank_call last = serve(&l);
    led_parts_drop(&l);
    led_parts_drop_model(&l);
    return last.number;
}

void dem_private_dismiss(const ranks *r, dem_index number)
{
    (void)rank_call_send(r, (rank_call){.kind = RANK_CALL_END, .number = number});
}
