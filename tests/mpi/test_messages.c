/* SPDX-License-Identifier: BSD-3-Clause */
/* How often ranks call MPI in a step, seen by MPI's profiling interface: the functions here take the place of MPI's own
 * for libdem_mpi, too. `mpirun -n N test_messages`. What each step needs is asserted to the number with ranks that are
 * threads (tests/verification/test_ranks.c, test_ranks_contact.c); here it is that no other call is made. */
#include "mpi_body.h"

enum { MOST_STEPS = 4000, FEW = 10 };

/* ---- MPI ---- */

/* Calls so far. */
typedef struct calls {
    long reductions, exchanges, messages, others;
} calls;

static calls made;

#define IN_PLACE_OF_MPI __attribute__((visibility("default")))

IN_PLACE_OF_MPI int MPI_Allreduce(const void *from, void *to, int n, MPI_Datatype type, MPI_Op op, MPI_Comm all)
{
    made.reductions++;
    return PMPI_Allreduce(from, to, n, type, op, all);
}

IN_PLACE_OF_MPI int MPI_Isend(const void *from, int n, MPI_Datatype type, int to, int tag, MPI_Comm all,
                              MPI_Request *request)
{
    made.messages++;
    return PMPI_Isend(from, n, type, to, tag, all, request);
}

IN_PLACE_OF_MPI int MPI_Waitall(int n, MPI_Request *requests, MPI_Status *statuses)
{
    made.exchanges += n > 0; /* an exchange ends with a wait for no further piece */
    return PMPI_Waitall(n, requests, statuses);
}

IN_PLACE_OF_MPI int MPI_Send(const void *from, int n, MPI_Datatype type, int to, int tag, MPI_Comm all)
{
    made.others++;
    return PMPI_Send(from, n, type, to, tag, all);
}

IN_PLACE_OF_MPI int MPI_Recv(void *to, int n, MPI_Datatype type, int from, int tag, MPI_Comm all, MPI_Status *status)
{
    made.others++;
    return PMPI_Recv(to, n, type, from, tag, all, status);
}

IN_PLACE_OF_MPI int MPI_Bcast(void *of, int n, MPI_Datatype type, int root, MPI_Comm all)
{
    made.others++;
    return PMPI_Bcast(of, n, type, root, all);
}

IN_PLACE_OF_MPI int MPI_Barrier(MPI_Comm all)
{
    made.others++;
    return PMPI_Barrier(all);
}

/* ---- a run ---- */

/* What there was up to the end of each step. */
typedef struct diary {
    int n;
    calls made[MOST_STEPS];
    dem_counts counts[MOST_STEPS];
} diary;

static dem_status note_step(void *context, const dem_simulation *s)
{
    diary *d = context;
    INSIST(d->n < MOST_STEPS);
    d->counts[d->n].struct_size = sizeof d->counts[d->n];
    INSIST(dem_simulation_counts(s, &d->counts[d->n]) == DEM_OK);
    d->made[d->n++] = made;
    return DEM_OK;
}

static void run(const dem_lattice *l, const dem_obstacle *floor, dem_method method, diary *d)
{
    dem_model *model = NULL;
    dem_simulation *s = NULL;
    dem_options options = dem_options_default();
    const dem_observer observer = {.struct_size = sizeof observer, .context = d, .step = note_step};
    options.method = method;
    options.checkpoint_steps = 0;
    d->n = 0;
    INSIST(dem_model_create_mpi(&model, l, floor, floor != NULL, MPI_COMM_WORLD) == DEM_OK);
    INSIST(dem_simulation_create(&s, model, &options) == DEM_OK && dem_simulation_observe(s, &observer) == DEM_OK);
    INSIST(dem_simulation_advance(s, 3e-4) == DEM_OK);
    dem_simulation_destroy(s);
    dem_model_destroy(model);
    INSIST(d->n > FEW);
}

/* ---- what a step takes ---- */

enum { AT_ONCE = 16 }; /* steps; overlaps are looked for after as many */

/* How many looks for overlaps there were up to the end of a step. */
static dem_index count_looks(const diary *d, int k)
{
    return d->counts[k].steps / AT_ONCE;
}

/* From the second step on, as the first evaluates where it begins. An exchange goes with each evaluation, of which an
 * attempt has 1 or 6; what is tried again counts. After events a step may take up to two exchanges and three reductions
 * more (docs/algorithms.md, Ranks), and a look for overlaps at the end of a step two and one. \return steps with events
 */
static int check(const diary *d, dem_method method, const team *t)
{
    const long stages = method == DEM_METHOD_VERLET ? 1 : 6;
    int n_busy = 0;
    for (int k = 2; k < d->n; k++) {
        const calls *now = &d->made[k], *before = &d->made[k - 1];
        const long evaluations = (long)(d->counts[k].evaluations - d->counts[k - 1].evaluations),
                   attempts = (evaluations + stages - 1) / stages;
        const int busy = d->counts[k].events > d->counts[k - 1].events,
                  was_busy = d->counts[k - 1].events > d->counts[k - 2].events;
        const long exchanges = now->exchanges - before->exchanges, reductions = now->reductions - before->reductions;
        const int n_looks = (int)(count_looks(d, k) - count_looks(d, k - 1));
        n_busy += busy;
        INSIST(exchanges <= evaluations + busy + 2 * was_busy + 2 * n_looks);
        INSIST(reductions <= attempts + busy + 3 * was_busy + n_looks);
        INSIST(now->messages - before->messages <= exchanges * (t->size - 1));
        INSIST(now->others == before->others);
        if (t->size > 1) INSIST(exchanges > 0 && reductions > 0 && now->messages > before->messages);
    }
    return n_busy;
}

/* ---- steps at once ---- */

/* Of a plate that is large enough for two ranks, in steps of which one in 16 is seen. */
static void run_at_once(diary *d)
{
    dem_model *model = NULL;
    dem_simulation *s = NULL;
    dem_lattice l = dem_lattice_empty();
    const dem_material solid = {.struct_size = sizeof solid,
                                .youngs_modulus = 1e7,
                                .poissons_ratio = 1.0 / 3.0,
                                .density = 1050.0,
                                .thickness = 1.0};
    dem_options options = dem_options_default();
    const dem_observer observer = {
        .struct_size = sizeof observer, .context = d, .step = note_step, .step_every = AT_ONCE};
    options.method = DEM_METHOD_VERLET;
    options.checkpoint_steps = 0;
    d->n = 0;
    INSIST(dem_lattice_rectangle(&l, 0.6, 0.53, 1e-3) == DEM_OK && l.n_nodes > 350000);
    INSIST(dem_lattice_assemble(&l, &solid) == DEM_OK);
    INSIST(dem_model_create_mpi_for(&model, &l, NULL, 0, &options, MPI_COMM_WORLD) == DEM_OK);
    dem_lattice_free(&l);
    INSIST(dem_simulation_create(&s, model, &options) == DEM_OK && dem_simulation_observe(s, &observer) == DEM_OK);
    options.struct_size = sizeof options;
    INSIST(dem_simulation_options(s, &options) == DEM_OK);
    INSIST(dem_simulation_advance(s, 5.5 * AT_ONCE * options.fixed_step) == DEM_OK);
    dem_simulation_destroy(s);
    dem_model_destroy(model);
}

/* One exchange, and a reduction before and behind; and two and one for a look for overlaps at their end. The start is
 * seen, and the first steps need its derivative. */
static void check_at_once(const diary *d)
{
    INSIST(d->n == 1 + 5);
    for (int k = 2; k < d->n; k++) {
        const calls *now = &d->made[k], *before = &d->made[k - 1];
        INSIST(d->counts[k].steps - d->counts[k - 1].steps == AT_ONCE);
        INSIST(now->exchanges - before->exchanges == 1 + 2 && now->messages - before->messages == 1 + 2);
        INSIST(now->reductions - before->reductions == 2 + 1 && now->others == before->others);
    }
}

int main(int argc, char **argv)
{
    static const dem_method methods[] = {DEM_METHOD_VERLET, DEM_METHOD_FEHLBERG45};
    static diary d;
    const team t = rank_test_begin(&argc, &argv);
    const double points[] = {-0.1, -1e-3, 0.0, -2e-4, 0.1, -1e-3};
    const dem_obstacle floor = {.struct_size = sizeof floor, .n_points = 3, .points = points, .restitution = 0.5};
    dem_lattice l = mpi_body_make(5.0);
    double lowest = l.x[1];
    for (dem_index i = 0; i < l.n_nodes; i++) {
        l.velocity[2 * i + 1] -= 10.0;
        lowest = fmin(lowest, l.x[2 * i + 1]);
    }
    dem_lattice_move(&l, 0.0, (const double[2]){0.0, -lowest});
    for (int m = 0; m < 2; m++) {
        run(&l, NULL, methods[m], &d);
        INSIST(check(&d, methods[m], &t) == 0);
        run(&l, &floor, methods[m], &d);
        INSIST(check(&d, methods[m], &t) > FEW);
    }
    dem_lattice_free(&l);
    if (t.size == 2) {
        run_at_once(&d);
        check_at_once(&d);
    }
    (void)MPI_Finalize();
    return 0;
}
