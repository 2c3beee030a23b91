/* SPDX-License-Identifier: BSD-3-Clause */
/* Calls the observers of a simulation in the order in which they were added, and knows whose frame is next. Frames are
 * numbered from 0 and due at number times interval: a product, not a sum, so that rounding does not add up and a
 * resumed run has frames at the same times. When events and steps are reported is decided in simulation.c; what
 * observers see, in query.c. */
#include "simulation/observers.h"

#include <math.h>

#include "base/status.h"
#include "base/struct_size.h"
#include "base/time_window.h"

static const double most_frames = 4503599627370496.0; /* 2^52: numbers beyond may not differ from the next */

/* The first frame later than `shown_until`. */
static dem_index frame_after(double interval, double shown_until)
{
    if (!(interval > 0.0) || shown_until < 0.0) return 0;
    dem_index k = (dem_index)(shown_until / interval);
    while (k > 0 && (double)(k - 1) * interval > shown_until) k--;
    while ((double)k * interval <= shown_until) k++;
    return k;
}

/* `context` is the last member of the first version. */
static const struct_kind kind = {"dem_observer", STRUCT_SIZE_WITH(dem_observer, context), sizeof(dem_observer)};

dem_status observers_add(observers *a, const dem_observer *observer, double shown_until)
{
    dem_observer own = {0};
    TRY(struct_size_read(&kind, &own, observer));
    const double interval = own.interval;
    CHECK(isfinite(interval), DEM_ERROR_ARGUMENT, "the interval between frames is %g s", interval);
    CHECK(own.step_every >= 0 && isfinite(own.step_interval) && own.step_interval >= 0.0, DEM_ERROR_ARGUMENT,
          "steps are to be seen every %lld of them and every %g s; both must be 0 or more", (long long)own.step_every,
          own.step_interval);
    CHECK(!(interval > 0.0) || shown_until < most_frames * interval, DEM_ERROR_ARGUMENT,
          "frames %g s apart cannot be numbered at %g s", interval, shown_until);
    CHECK(a->n < OBSERVERS_MOST, DEM_ERROR_ARGUMENT, "at most %d observers", (int)OBSERVERS_MOST);
    a->members[a->n++] = (observer_entry){own, frame_after(interval, shown_until), shown_until, -1};
    return DEM_OK;
}

bool observers_want_events(const observers *a)
{
    for (int k = 0; k < a->n; k++)
        if (a->members[k].observer.event != NULL) return true;
    return false;
}

dem_status observers_event(const observers *a, const dem_simulation *simulation, const dem_event *event)
{
    dem_status status = DEM_OK;
    for (int k = 0; k < a->n; k++) {
        const dem_observer *o = &a->members[k].observer;
        if (o->event != NULL) status = status_first(status, o->event(o->context, simulation, event));
    }
    return status;
}

/* Whether an observer sees every step. */
static bool sees_all(const dem_observer *o)
{
    return o->step_every == 0 && o->step_interval == 0.0;
}

bool observers_want_touching(const observers *a)
{
    for (int k = 0; k < a->n; k++) {
        const dem_observer *o = &a->members[k].observer;
        if (o->step != NULL && o->step_touching != 0 && !sees_all(o)) return true;
    }
    return false;
}

/* The step that it has seen last is in the same span of time as the step before this one. */
static bool is_due(const observer_entry *e, const accepted_step *step)
{
    const dem_observer *o = &e->observer;
    if (o->step == NULL) return false;
    if (sees_all(o) || (step->touches && o->step_touching != 0)) return true;
    if (o->step_every > 0 && step->number % o->step_every == 0) return true;
    const double before = e->seen_until < 0.0 ? -(double)INFINITY : e->seen_until;
    return o->step_interval > 0.0 && time_window_begins(o->step_interval, before, step->t);
}

bool observers_step_due(const observers *a, const accepted_step *step)
{
    for (int k = 0; k < a->n; k++)
        if (is_due(&a->members[k], step)) return true;
    return false;
}

bool observers_want_breaks(const observers *a)
{
    for (int k = 0; k < a->n; k++)
        if (a->members[k].observer.broken != NULL) return true;
    return false;
}

dem_status observers_broken(const observers *a, const dem_simulation *simulation, const dem_break *what)
{
    dem_status status = DEM_OK;
    for (int k = 0; k < a->n; k++) {
        const dem_observer *o = &a->members[k].observer;
        if (o->broken != NULL) status = status_first(status, o->broken(o->context, simulation, what));
    }
    return status;
}

static dem_status show(observer_entry *e, const dem_simulation *simulation, const accepted_step *step)
{
    e->seen_until = step->t;
    e->seen = step->number;
    return e->observer.step(e->observer.context, simulation);
}

dem_status observers_step(observers *a, const dem_simulation *simulation, const accepted_step *step)
{
    dem_status status = DEM_OK;
    for (int k = 0; k < a->n; k++)
        if (is_due(&a->members[k], step)) status = status_first(status, show(&a->members[k], simulation, step));
    return status;
}

dem_status observers_before_touching(observers *a, const dem_simulation *simulation, const accepted_step *step)
{
    dem_status status = DEM_OK;
    for (int k = 0; k < a->n; k++) {
        observer_entry *e = &a->members[k];
        const dem_observer *o = &e->observer;
        if (o->step != NULL && o->step_touching != 0 && e->seen != step->number)
            status = status_first(status, show(e, simulation, step));
    }
    return status;
}

dem_status observers_checkpoint(const observers *a, const dem_simulation *simulation, dem_checkpoint *checkpoint)
{
    dem_status status = DEM_OK;
    for (int k = 0; k < a->n; k++) {
        const dem_observer *o = &a->members[k].observer;
        if (o->checkpoint != NULL) status = status_first(status, o->checkpoint(o->context, simulation, checkpoint));
    }
    return status;
}

int observers_due(const observers *a, double end, double t_end, double *t)
{
    int first = -1;
    for (int k = 0; k < a->n; k++) {
        const dem_observer *o = &a->members[k].observer;
        if (o->frame == NULL || !(o->interval > 0.0)) continue;
        const double due = (double)a->members[k].next_frame * o->interval;
        if (due > end || due > t_end + 1e-9 * o->interval) continue;
        if (first >= 0 && due >= *t) continue;
        first = k;
        *t = due;
    }
    return first;
}

dem_status observers_frame(observers *a, int k, const dem_simulation *simulation)
{
    const dem_observer *o = &a->members[k].observer;
    a->members[k].next_frame++;
    return o->frame(o->context, simulation);
}
