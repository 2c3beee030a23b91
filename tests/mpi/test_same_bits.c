/* SPDX-License-Identifier: BSD-3-Clause */
/* Ranks that are processes: positions, velocities, times, lengths of steps and their counts, events, energies, strains
 * and the loads of boundaries have the bits of one process, which every rank computes beside it. They take checkpoints.
 * `mpirun -n N test_same_bits`. */
#include "mpi_body.h"

enum { N_STOPS = 2, N_FRAMES = 3, MOST_EVENTS = 2000 };

/* Of the whole. */
typedef struct motion {
    double t, step;
    double *x, *v; /* [n][2] */
    dem_energy energy;
    dem_strain strain;
    dem_body_motion body;
    double inertia;
    dem_boundary_load load;
} motion;

typedef struct run {
    dem_index n; /* nodes of the whole */
    bool is_held;
    int n_seen;
    motion seen[N_STOPS + N_FRAMES]; /* in frames and at stops */
    dem_counts counts;
    int n_events;
    dem_event events[MOST_EVENTS];
} run;

/* ---- a run, of one process or of ranks ---- */

static void look(run *r, const dem_simulation *s)
{
    const size_t size = 2 * (size_t)r->n * sizeof(double);
    motion *m = &r->seen[r->n_seen++];
    dem_state state = {.struct_size = sizeof state};
    INSIST(r->n_seen <= N_STOPS + N_FRAMES);
    *m = (motion){.x = malloc(size), .v = malloc(size)};
    INSIST(m->x != NULL && m->v != NULL);
    INSIST(dem_simulation_state(s, &state) == DEM_OK && dem_simulation_gather(s, m->x, m->v) == DEM_OK);
    m->energy.struct_size = sizeof m->energy;
    m->strain.struct_size = sizeof m->strain;
    m->body.struct_size = sizeof m->body;
    m->load.struct_size = sizeof m->load;
    INSIST(dem_simulation_energy(s, &m->energy) == DEM_OK && dem_simulation_strain(s, &m->strain) == DEM_OK);
    INSIST(dem_simulation_body(s, 0, &m->body) == DEM_OK);
    INSIST(dem_simulation_inertia(s, 0, &m->inertia) == DEM_OK);
    if (r->is_held) INSIST(dem_simulation_boundary(s, 0, &m->load) == DEM_OK);
    m->t = state.t;
    m->step = state.step;
}

static dem_status look_at_frame(void *context, const dem_simulation *s)
{
    look(context, s);
    return DEM_OK;
}

static dem_status note_event(void *context, const dem_simulation *s, const dem_event *event)
{
    run *r = context;
    (void)s;
    INSIST(r->n_events < MOST_EVENTS);
    r->events[r->n_events++] = *event;
    return DEM_OK;
}

static void finish(run *r, const dem_model *model, const dem_options *options)
{
    dem_simulation *s = NULL;
    const dem_observer observer = {
        .struct_size = sizeof observer, .context = r, .interval = 1.2e-4, .frame = look_at_frame, .event = note_event};
    INSIST(dem_simulation_create(&s, model, options) == DEM_OK && dem_simulation_observe(s, &observer) == DEM_OK);
    for (int k = 1; k <= N_STOPS; k++) {
        INSIST(dem_simulation_advance(s, 1.5e-4 * k) == DEM_OK);
        look(r, s);
    }
    r->counts.struct_size = sizeof r->counts;
    INSIST(dem_simulation_counts(s, &r->counts) == DEM_OK);
    dem_simulation_destroy(s);
}

static void free_run(run *r)
{
    for (int k = 0; k < r->n_seen; k++) {
        free(r->seen[k].x);
        free(r->seen[k].v);
    }
}

/* ---- comparison ---- */

static void compare(const run *ranks, const run *one, int rank)
{
    const size_t size = 2 * (size_t)one->n * sizeof(double);
    INSIST(ranks->n_seen == one->n_seen && one->n_seen == N_STOPS + N_FRAMES);
    for (int k = 0; k < one->n_seen; k++) {
        const motion *a = &ranks->seen[k], *b = &one->seen[k];
        INSIST(memcmp(&a->energy, &b->energy, sizeof a->energy) == 0);
        INSIST(memcmp(&a->strain, &b->strain, sizeof a->strain) == 0);
        INSIST(a->inertia > 0.0 && a->inertia == b->inertia);
        INSIST(memcmp(&a->body, &b->body, sizeof a->body) == 0 && memcmp(&a->load, &b->load, sizeof a->load) == 0);
        INSIST(ranks->seen[k].t == one->seen[k].t && ranks->seen[k].step == one->seen[k].step);
        INSIST(rank != 0 || memcmp(ranks->seen[k].x, one->seen[k].x, size) == 0);
        INSIST(rank != 0 || memcmp(ranks->seen[k].v, one->seen[k].v, size) == 0);
    }
    INSIST(memcmp(&ranks->counts, &one->counts, sizeof one->counts) == 0);
    INSIST(ranks->n_events == one->n_events);
    INSIST(memcmp(ranks->events, one->events, (size_t)one->n_events * sizeof *one->events) == 0);
    INSIST(one->counts.steps > 5);
}

/* Each node is the own one of one rank, which has it at its place. */
static void check_part(const dem_model *model, const dem_lattice *whole)
{
    dem_index n, own = 0, all = 0;
    const dem_index *number;
    const unsigned char *is_own;
    INSIST(dem_model_part(model, &n, &number, &is_own) == DEM_OK);
    INSIST(n == dem_model_lattice(model)->n_nodes);
    for (dem_index i = 0; i < n; i++) {
        INSIST(dem_model_lattice(model)->x[2 * i] == whole->x[2 * number[i]]);
        own += is_own[i];
    }
    (void)MPI_Allreduce(&own, &all, 1, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
    INSIST(all == whole->n_nodes);
}

static void share(const dem_lattice *l, const dem_obstacle *floor, const dem_options *options, int rank)
{
    dem_model *model = NULL;
    static run one, ranks;
    one = ranks = (run){.n = l->n_nodes, .is_held = options->n_boundaries > 0};
    INSIST(dem_model_create(&model, l, floor, floor != NULL) == DEM_OK);
    finish(&one, model, options);
    dem_model_destroy(model);
    if (floor != NULL)
        INSIST(dem_model_create_mpi(&model, l, floor, 1, MPI_COMM_WORLD) == DEM_OK);
    else
        INSIST(dem_model_create_mpi_for(&model, l, NULL, 0, options, MPI_COMM_WORLD) == DEM_OK);
    check_part(model, l);
    finish(&ranks, model, options);
    dem_model_destroy(model);
    INSIST((one.n_events > 20) == (floor != NULL));
    compare(&ranks, &one, rank);
    free_run(&one);
    free_run(&ranks);
}

/* It depends on a node's number, place and velocity, and on time. */
static dem_status push(void *context, const dem_force_query *q, double *force)
{
    (void)context;
    for (dem_index k = 0; k < q->n; k++) {
        force[2 * k] = 10.0 * sin(1e4 * q->t + (double)q->nodes[k]) - 0.1 * q->v[2 * k];
        force[2 * k + 1] = 100.0 * q->x[2 * k];
    }
    return DEM_OK;
}

/* A body that falls on a floor of which the edges of the body touch vertices, by both methods of contact, with a force
 * in one. */
static void fall(int rank)
{
    const double points[] = {-0.1, 0.0, -0.004, 0.0005, 0.003, -0.0004, 0.009, 0.0, 0.1, 0.002};
    const dem_obstacle floor = {
        .struct_size = sizeof floor, .n_points = 5, .points = points, .restitution = 0.5, .friction = 0.3};
    dem_lattice l = mpi_body_make(5.0);
    double lowest = l.x[1];
    for (dem_index i = 0; i < l.n_nodes; i++) {
        lowest = fmin(lowest, l.x[2 * i + 1]);
        l.velocity[2 * i + 1] -= 10.0;
    }
    dem_lattice_move(&l, 0.0, (const double[2]){0.0, 6e-4 - lowest});
    for (int exact = 0; exact < 2; exact++) {
        dem_options options = dem_options_default();
        options.checkpoint_steps = 0;
        options.contact = exact ? DEM_CONTACT_EXACT : DEM_CONTACT_LOCAL;
        if (!exact) options.force = push;
        share(&l, &floor, &options, rank);
    }
    dem_lattice_free(&l);
}

/* Free, where the body may touch itself, and held at one end and pulled; then every rank has two threads. */
int main(int argc, char **argv)
{
    static const dem_method methods[] = {DEM_METHOD_FEHLBERG45, DEM_METHOD_VERLET};
    const team t = rank_test_begin(&argc, &argv);
    for (int is_held = 0; is_held < 2; is_held++) {
        dem_index n = 0;
        dem_lattice l = mpi_body_make(is_held ? 1.0 : 20.0);
        dem_index *held = mpi_body_left(&l, &n);
        const dem_boundary pull = {.struct_size = sizeof pull,
                                   .kind = DEM_BOUNDARY_DISPLACEMENT,
                                   .components = DEM_COMPONENT_X | DEM_COMPONENT_Y,
                                   .n_nodes = n,
                                   .nodes = held,
                                   .value = {-1e-3, 5e-4, 0.0},
                                   .ramp = 2e-4};
        for (size_t k = 0; k < sizeof methods / sizeof *methods; k++) {
            dem_options options = dem_options_default();
            options.method = methods[k];
            options.checkpoint_steps = 6;
            options.bodies = is_held ? DEM_BODIES_NONE : DEM_BODIES_ALL;
            options.n_boundaries = is_held;
            options.boundaries = &pull;
            options.threads = is_held + 1;
            options.thread_nodes = 20;
            share(&l, NULL, &options, t.rank);
        }
        free(held);
        dem_lattice_free(&l);
    }
    fall(t.rank);
    (void)MPI_Finalize();
    return 0;
}
