/* SPDX-License-Identifier: BSD-3-Clause */
/* Runs of one scene by a process alone, by ranks that share its model, and by a leader with its followers, the ranks
 * being threads: what is seen of each, which is to be the same to the last bit. */
#ifndef DEM_TEST_RANK_RUNS_H
#define DEM_TEST_RANK_RUNS_H

#include "base/slab_recipe.h"
#include "base/state.h"
#include "harness/rank_threads.h"
#include "model/domain_model.h"

enum { RANK_RUNS_MOST = 7, RANK_RUNS_STOPS = 4, RANK_RUNS_LOOKS = RANK_RUNS_STOPS + 1, RANK_RUNS_TEXT = 256 };

/* Of which there are numbers. */
enum { RANK_RUNS_NODES, RANK_RUNS_SPRINGS, RANK_RUNS_TRIANGLES, RANK_RUNS_KINDS };
/* Which numbers. */
enum {
    RANK_RUNS_X,
    RANK_RUNS_V,
    RANK_RUNS_STRESS,
    RANK_RUNS_CONTACT_FORCE,
    RANK_RUNS_PRESSURE,
    RANK_RUNS_STRAIN,
    RANK_RUNS_FORCE,
    RANK_RUNS_BROKEN_SPRINGS,
    RANK_RUNS_BROKEN_TRIANGLES,
    RANK_RUNS_ROWS
};

typedef struct rank_runs_outcome rank_runs_outcome;

/** What is run, and what is seen of it besides the stops, at t_end k/(RANK_RUNS_STOPS - 1). */
typedef struct rank_runs_scene {
    dem_model *model; /* of the whole */
    dem_options options;
    double t_end;           /* s */
    int step;               /* at whose end all is looked at, too; 0: none */
    bool is_seen_at_events; /* likewise, but for rows; and at breaks */
    /** Whether a checkpoint is the one to keep; NULL: the third is. */
    bool (*keeps)(const dem_simulation *s, const rank_runs_outcome *so_far);
    bool counts_calls; /* up to the end of each step */
    int n_frames;      /* until t_end, behind the first one: these and steps are counted; 0: there are none */
    /** Whether the observer of a step ends the run; NULL: it does not. */
    bool (*stops)(const dem_simulation *s, const rank_runs_outcome *so_far);
    /** Is called after an advance that has failed, and says whether it is to be tried once more; NULL: it is not. Then
     *  the state that has been left is looked at as that of a step is. */
    bool (*mends)(const rank_runs_outcome *so_far);
} rank_runs_scene;

/** All that is seen at one time, but for nodes and elements; of lists the first and the last entry. */
typedef struct rank_runs_view {
    double t, step, residual;
    dem_counts counts;
    dem_energy energy;
    dem_strain strain;
    dem_surfaces surfaces;
    dem_overlap overlap;
    double totals[STATE_TOTALS], ledger[3]; /* J */
    dem_index n_contacts;
    dem_body_motion bodies[2];
    dem_pair pairs[2];
    dem_contact contacts[2];
    dem_boundary_load boundaries[2];
    dem_obstacle_load obstacle;
    double stress_at[3], force_at; /* of one node, of one spring */
} rank_runs_view;

/** What is reported to observers: an event, or a break; and what is seen then. */
typedef struct rank_runs_note {
    dem_event event;
    dem_break broken;
    rank_runs_view view;
} rank_runs_note;

/** How often a rank has called others up to the end of a step, but for looks; events and stops so far. */
typedef struct rank_runs_step {
    rank_threads_counts calls;
    dem_index n_events;
    int n_stops;
} rank_runs_step;

/** What one rank, or a process alone, sees of a run. */
struct rank_runs_outcome {
    rank_runs_view *views; /* [RANK_RUNS_LOOKS] at stops, and at a step */
    dem_index n[RANK_RUNS_KINDS];
    double *rows[RANK_RUNS_ROWS]; /* [RANK_RUNS_LOOKS][n of the whole][width]: ranks write what is their own */
    dem_index n_notes, n_breaks, capacity;
    rank_runs_note *notes; /* [n_notes] */
    dem_index n_steps;     /* seen by the observer, if there is one; */
    rank_runs_step *steps; /* [n_steps] if calls are counted */
    dem_index n_frames;    /* likewise seen */
    double n_common[2]; /* of a leader: nodes of others that a rank integrates, at most, at the start and at the end */
    dem_index n_checkpoints;
    dem_checkpoint *kept;
    double kept_t;                       /* s */
    dem_index kept_notes;                /* so many had been taken then */
    int n_stops;                         /* that have been looked at */
    rank_threads_counts calls, of_looks; /* in all, but for looks; and for looks */
    dem_status status;                   /* of the first advance that has failed, with */
    char message[RANK_RUNS_TEXT];        /* empty: the run has come to its end */
    const rank_runs_scene *scene;
};

/** Free with rank_runs_free_outcome(). */
rank_runs_outcome rank_runs_make_outcome(const rank_runs_scene *scene);
void rank_runs_free_outcome(rank_runs_outcome *o);

/** Outcomes of n ranks, which write into rows of the first. Free with rank_runs_free_outcomes(). */
void rank_runs_make_outcomes(const rank_runs_scene *scene, int n, rank_runs_outcome *out);
void rank_runs_free_outcomes(rank_runs_outcome *o, int n);

/** Runs a model: of the whole, or of this rank's domain, with others at once.
 *  \param leads  ranks that make the run, while this has the whole; NULL: it makes its own
 *  \param from   of whose checkpoint it goes on; NULL: it begins */
void rank_runs_go(const dem_model *model, const ranks *leads, const rank_runs_outcome *from, rank_runs_outcome *o);

/** A process alone runs the scene, to its end. */
rank_runs_outcome rank_runs_alone(const rank_runs_scene *scene);

/** How many looks for overlaps there are up to the end of a step, behind that at the start, where bodies do not touch
 *  each other; and what each of them takes beside a reduction, where some of the boundary is not common. */
static inline dem_index rank_runs_looks(dem_index steps)
{
    return steps / 16;
}
enum { RANK_RUNS_LOOK_EXCHANGES = 2, RANK_RUNS_START_EXCHANGES = 3 };

/** Sets a body off, so that it swings and shears: at 60 m/s some triangles of rubber fold.
 *  \param wave  of short waves, in 1/(50 mm) */
void rank_runs_set_off(dem_lattice *l, double speed, double wave);

/** Copies rows of own nodes to where the whole has them.  \param to  [n of the whole][width] */
void rank_runs_copy(const dem_model *model, int width, const double *from, double *to);

/** Ranks run it, each with its share.  \param[out] out  [n_ranks] of rank_runs_make_outcomes() */
void rank_runs_together(const rank_runs_scene *scene, int n_ranks, const domain_model_shares *shares,
                        const rank_runs_outcome *from, rank_runs_outcome *out);

/** Rank 0 of n does the work, in which it may lead the others, and dismisses them with a number that they get.
 *  \param maker  of slabs on the other ranks; NULL: none makes any */
void rank_runs_lead(int n_ranks, const slab_maker *maker, rank_threads_work *lead, void *context);

/** Rank 0 leads a run. */
void rank_runs_led(const rank_runs_scene *scene, int n_ranks, const rank_runs_outcome *from, rank_runs_outcome *out);

/** What is not the same, in words, from the first stop on that a run from a checkpoint comes to; NULL: all is.
 *  \param from  of whose checkpoint the first run went on; NULL: it began as the other */
const char *rank_runs_difference(const rank_runs_outcome *one, const rank_runs_outcome *whole,
                                 const rank_runs_outcome *from);

/** Ranks that share the scene see what a process alone has seen.  \return the calls that each has made */
rank_threads_counts rank_runs_assert_shared(const rank_runs_scene *scene, int n_ranks,
                                            const domain_model_shares *shares, const rank_runs_outcome *from,
                                            const rank_runs_outcome *whole);

/** And so does a leader. */
void rank_runs_assert_led(const rank_runs_scene *scene, int n_ranks, const rank_runs_outcome *from,
                          const rank_runs_outcome *whole);

#endif
