/* SPDX-License-Identifier: BSD-3-Clause */
/* Checkpoints: any bytes with a header and checksum that are right, and checkpoints of a small run with numbers
 * changed, entries cut or grown. One from which a run goes on can go on for some steps, and so can its files; all
 * others are refused. */
#include <dem/trajectory.h>

#include <math.h>
#include <unistd.h>

#include "bytes.h"
#include "harness/motion.h"
#include "scratch.h"

enum { MOST_EDITS = 8, MOST_STEPS = 20, HEADER = 64, SIZE_AT = 16, CHECKSUM_AT = 32, MOST_FILE = 1 << 22 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* A block that has just landed in a valley, once for each method of contact. */
typedef struct base {
    dem_model *model;
    dem_options options;
    dem_simulation *simulation;
    dem_peaks *peaks;
    const char *path, *part, *segment; /* of the trajectory */
    unsigned char *segment_bytes;
    size_t segment_size;
} base;

static void watch(dem_simulation *simulation, dem_observer observer)
{
    require(dem_simulation_observe(simulation, &observer) == DEM_OK);
}

static dem_trajectory_options fuzz_options(void)
{
    static const dem_probe probe = {.name = "p", .kind = DEM_PROBE_NODE, .every = 3};
    dem_trajectory_options options = dem_trajectory_options_default();
    options.frame_interval = 1e-3;
    options.events = 1;
    options.n_probes = 1;
    options.probes = &probe;
    return options;
}

static dem_model *make_model(void)
{
    static const double points[] = {-1.0, 0.2, 0.0, 0.0, 0.004, 0.001, 0.008, 0.0, 1.0, 0.2};
    const dem_obstacle valley = {
        .struct_size = sizeof(dem_obstacle), .n_points = 5, .points = points, .restitution = 0.0, .friction = 0.3};
    const dem_material soft = {.struct_size = sizeof(dem_material),
                               .youngs_modulus = 1e5,
                               .poissons_ratio = 0.3,
                               .density = 1000.0,
                               .thickness = 0.01,
                               .guard = 0.02};
    const double lift[2] = {0.002, 0.0035}, velocity[2] = {0.3, -1.0};
    dem_lattice lattice = dem_lattice_empty();
    dem_model *model;
    require(dem_lattice_rectangle(&lattice, 0.02, 0.02, 0.01) == DEM_OK);
    require(dem_lattice_assemble(&lattice, &soft) == DEM_OK);
    dem_lattice_move(&lattice, 0.0, lift);
    require(dem_lattice_launch(&lattice, velocity) == DEM_OK);
    require(dem_model_create(&model, &lattice, &valley, 1) == DEM_OK);
    dem_lattice_free(&lattice);
    return model;
}

/* Until there is a checkpoint with lasting contacts. */
static void land(base *b)
{
    size_t contacts = 0;
    for (int k = 1; k < 1000 && contacts == 0; k++) {
        require(dem_simulation_advance(b->simulation, 1e-4 * k) == DEM_OK);
        (void)dem_checkpoint_find(dem_simulation_checkpoint(b->simulation), "contacts", &contacts);
    }
    require(contacts > 0);
}

/* Lands, with a trajectory of which there is one segment. */
static void checkpoint(base *b)
{
    const dem_trajectory_options options = fuzz_options();
    dem_trajectory *trajectory;
    require(dem_trajectory_create(&trajectory, b->path, b->simulation, &options) == DEM_OK);
    watch(b->simulation, ask_trajectory_observer(trajectory));
    land(b);
    require(dem_trajectory_segment(trajectory, dem_simulation_checkpoint(b->simulation)) == DEM_OK);
    dem_trajectory_destroy(trajectory);
    b->segment_bytes = malloc(MOST_FILE);
    require(b->segment_bytes != NULL);
    b->segment_size = scratch_read(b->segment, b->segment_bytes, MOST_FILE);
}

static void start(base *b, dem_contact_method contact)
{
    const int exact = contact == DEM_CONTACT_EXACT;
    b->path = scratch_path(exact ? "exact.vtkhdf" : "local.vtkhdf");
    b->part = scratch_path(exact ? "exact.part.vtkhdf" : "local.part.vtkhdf");
    b->segment = scratch_path(exact ? "exact.00001.vtkhdf" : "local.00001.vtkhdf");
    b->model = make_model();
    b->options = dem_options_default();
    b->options.contact = contact;
    b->options.checkpoint_steps = 16;
    require(dem_simulation_create(&b->simulation, b->model, &b->options) == DEM_OK);
    require(dem_peaks_create(&b->peaks, b->model, 4) == DEM_OK);
    watch(b->simulation, ask_peaks_observer(b->peaks));
    checkpoint(b);
}

static const base *base_of(dem_contact_method contact)
{
    static base bases[2];
    base *b = &bases[contact == DEM_CONTACT_EXACT];
    if (b->model == NULL) start(b, contact);
    return b;
}

/* ---- checkpoints ---- */

static const char *const names[] = {
    "sizes",       "numbers",     "counts",        "impulses",   "overlap",           "contacts", "state",
    "peaks.every", "peaks.nodes", "peaks.springs", "trajectory", "trajectory.probes", "motions"};
enum { N_NAMES = sizeof names / sizeof *names, MOST_BYTES = 1 << 16 };

static void change(bytes *from, unsigned char *data, size_t n)
{
    const unsigned how = bytes_below(from, 5), slot = bytes_take(from);
    unsigned char *at = data + slot % n * 8;
    double number;
    int64_t integer = (int8_t)bytes_take(from);
    memcpy(&number, at, sizeof number);
    if (how == 0) memcpy(at, &integer, sizeof integer);
    if (how == 1) number = bytes_real(from);
    if (how == 2) number *= bytes_between(from, -2.0, 2.0);
    if (how == 1 || how == 2) memcpy(at, &number, sizeof number);
    if (how == 3) at[slot % 8] ^= (unsigned char)integer;
    if (how == 4) memmove(at, data + bytes_take(from) % n * 8, 8);
}

static void edit(bytes *from, dem_checkpoint *checkpoint)
{
    static unsigned char copy[MOST_BYTES];
    const char *name = names[bytes_below(from, N_NAMES)];
    const unsigned choice = bytes_take(from);
    size_t size;
    const void *data = dem_checkpoint_find(checkpoint, name, &size);
    require(data != NULL && size + 256 < sizeof copy);
    memset(copy, 0, sizeof copy);
    memcpy(copy, data, size);
    if (choice == 1) size = bytes_take(from) * 8;
    if (choice == 2) size += bytes_take(from);
    if (choice > 2 && size >= 8) change(from, copy, size / 8);
    require(dem_checkpoint_put(checkpoint, name, copy, size) == DEM_OK);
}

/* Through a file, as it comes back in a later process. */
static dem_checkpoint *edited(bytes *from, const base *b)
{
    const char *path = scratch_path("edited.checkpoint");
    dem_checkpoint *checkpoint;
    require(dem_checkpoint_write(dem_simulation_checkpoint(b->simulation), path) == DEM_OK);
    require(dem_checkpoint_read(&checkpoint, path) == DEM_OK);
    for (unsigned k = 0; k < MOST_EDITS && from->left > 0; k++) edit(from, checkpoint);
    return checkpoint;
}

static uint32_t crc(const uint8_t *at, size_t n)
{
    uint32_t sum = UINT32_MAX;
    for (size_t k = 0; k < n; k++) {
        sum ^= at[k];
        for (int bit = 0; bit < 8; bit++) sum = sum >> 1 ^ (sum & 1 ? UINT32_C(0xedb88320) : 0);
    }
    return ~sum;
}

/* NULL if it is refused. */
static dem_checkpoint *read_bytes(const bytes *from)
{
    const char *path = scratch_path("raw.checkpoint");
    const uint64_t size = from->left;
    uint64_t sum = 0;
    dem_checkpoint *checkpoint = NULL;
    uint8_t *copy = malloc(from->left + 1);
    require(copy != NULL);
    if (size > 0) memcpy(copy, from->at, from->left);
    if (size >= HEADER) {
        memcpy(copy + SIZE_AT, &size, sizeof size);
        memcpy(copy + CHECKSUM_AT, &sum, sizeof sum);
        sum = crc(copy, from->left);
        memcpy(copy + CHECKSUM_AT, &sum, sizeof sum);
    }
    scratch_write(path, copy, from->left);
    const dem_status status = dem_checkpoint_read(&checkpoint, path);
    require(status == DEM_OK || (status == DEM_ERROR_IO && checkpoint == NULL));
    free(copy);
    return checkpoint;
}

/* ---- going on ---- */

static dem_status count(void *context, const dem_simulation *simulation)
{
    int *steps = context;
    (void)simulation;
    return ++*steps < MOST_STEPS ? DEM_OK : DEM_STOPPED;
}

static void go_on(dem_simulation *simulation)
{
    int steps = 0;
    motion state;
    const dem_observer counter = {.struct_size = sizeof(dem_observer), .step = count, .context = &steps};
    motion_see(simulation, &state);
    require(dem_simulation_observe(simulation, &counter) == DEM_OK);
    const dem_status status = dem_simulation_advance(simulation, state.t + 0.1);
    require(status == DEM_OK || status == DEM_STOPPED || status == DEM_ERROR_CONTACT || status == DEM_ERROR_INTEGRATOR);
    motion_see(simulation, &state);
    for (dem_index k = 0; k < 2 * ask_sizes(dem_simulation_model(simulation)).n_nodes; k++)
        require(isfinite(state.x[k]) && isfinite(state.v[k]));
}

/* With the files as they were. */
static dem_trajectory *resume_files(const base *b, const dem_simulation *simulation, const dem_checkpoint *checkpoint)
{
    const dem_trajectory_options options = fuzz_options();
    dem_trajectory *trajectory = NULL;
    (void)unlink(b->path);
    (void)unlink(b->part);
    scratch_write(b->segment, b->segment_bytes, b->segment_size);
    const dem_status status = dem_trajectory_resume(&trajectory, b->path, simulation, &options, checkpoint);
    require(status == DEM_OK || status == DEM_ERROR_IO || status == DEM_ERROR_ARGUMENT);
    require(status == DEM_OK || trajectory == NULL);
    return trajectory;
}

static void resume(const base *b, const dem_checkpoint *checkpoint, int with_files)
{
    dem_simulation *simulation = NULL;
    dem_peaks *peaks = NULL;
    dem_trajectory *trajectory = NULL;
    const dem_status looked = dem_peaks_resume(&peaks, b->model, 4, checkpoint);
    const dem_status status = dem_simulation_resume(&simulation, b->model, &b->options, checkpoint);
    require(looked == DEM_OK || peaks == NULL);
    require(looked == DEM_OK || looked == DEM_ERROR_IO || looked == DEM_ERROR_ARGUMENT); /* of another interval */
    require(status == DEM_OK || (status == DEM_ERROR_IO && simulation == NULL));
    if (status == DEM_OK && with_files) trajectory = resume_files(b, simulation, checkpoint);
    if (status == DEM_OK && peaks != NULL) watch(simulation, ask_peaks_observer(peaks));
    if (trajectory != NULL) {
        const dem_observer observer = ask_trajectory_observer(trajectory);
        const dem_status added = dem_simulation_observe(simulation, &observer);
        require(added == DEM_OK || added == DEM_ERROR_ARGUMENT); /* so late that frames cannot be numbered */
    }
    if (status == DEM_OK) go_on(simulation);
    if (trajectory != NULL) require(dem_trajectory_finish(trajectory) == DEM_OK);
    dem_trajectory_destroy(trajectory);
    dem_simulation_destroy(simulation);
    dem_peaks_destroy(peaks);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    bytes from = {data, size};
    const unsigned choice = bytes_take(&from);
    const base *b = base_of(choice & 2 ? DEM_CONTACT_EXACT : DEM_CONTACT_LOCAL);
    dem_checkpoint *checkpoint = choice & 1 ? read_bytes(&from) : edited(&from, b);
    if (checkpoint != NULL) resume(b, checkpoint, choice & 4);
    dem_checkpoint_destroy(checkpoint);
    return 0;
}
