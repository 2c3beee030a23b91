/* SPDX-License-Identifier: BSD-3-Clause */
/* A run of three nodes with springs of 3, 4 and 5 m, the last node fixed, over an obstacle, as dem_export finds it; and
 * what it makes of that. */
#ifndef DEM_TEST_EXPORTED_H
#define DEM_TEST_EXPORTED_H

#include "verification/support.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <dem/trajectory.h>

#include "ask.h"
#include "task.h"
#include "unit/scratch.h"

enum { EXPORTED_FRAMES = 3, EXPORTED_TEXT = 1 << 16 };

typedef struct exported {
    scratch_folder folder;
    const char *path;
    dem_reader *reader;
    outcome outcome;
    task task;
    char text[EXPORTED_TEXT]; /* of the file last read */
} exported;

/** How the run is written. */
typedef struct exported_how {
    const char *resolved; /* the deck; NULL: none */
    int double_precision, n_obstacles;
    double frame_interval;
    bool breaks; /* the triangle breaks at 0.3 s, with all springs */
} exported_how;

static inline exported_how exported_usual(void)
{
    return (exported_how){.n_obstacles = 1, .frame_interval = 0.25};
}

static inline void exported_lattice(dem_lattice *l)
{
    static double x[6] = {0.0, 1.0, 3.0, 1.0, 3.0, 5.0}, mass[3] = {1.0, 2.0, 2.0}, stiffness[3] = {6.0, 8.0, 6.0};
    static double rest[3] = {3.0, 4.0, 5.0}, guard[1] = {0.5}, velocity[6] = {0.1, -0.25, 0.1, -0.25, 0.0, 0.0};
    static dem_index ends[6] = {0, 1, 1, 2, 2, 0}, corners[3] = {0, 1, 2};
    static unsigned char flags[3] = {DEM_NODE_CONTACT, DEM_NODE_CONTACT, DEM_NODE_FIXED};
    *l = dem_lattice_empty();
    l->n_nodes = l->n_springs = 3, l->n_triangles = 1;
    l->x = x, l->mass = mass, l->velocity = velocity, l->flags = flags;
    l->ends = ends, l->rest_length = rest, l->stiffness = stiffness;
    l->triangles = corners, l->guard = guard;
}

static inline void exported_run(const exported *e, const exported_how *how)
{
    static const double floor[6] = {-9.0, -1.0, 0.0, -1.0, 9.0, -1.0};
    const dem_obstacle obstacle = {
        .struct_size = sizeof(dem_obstacle), .n_points = 3, .points = floor, .restitution = 0.5};
    const dem_probe probe = {"tip", DEM_PROBE_NODE, {0, 0}, 1};
    dem_trajectory_options options = dem_trajectory_options_default();
    dem_options usual = dem_options_default();
    dem_lattice lattice = dem_lattice_empty();
    dem_trajectory *trajectory;
    usual.gravity[1] = 0.0;
    options.frame_interval = how->frame_interval, options.double_precision = how->double_precision;
    options.n_probes = 1, options.probes = &probe;
    exported_lattice(&lattice);
    dem_model *model = support_model(&lattice, &obstacle, how->n_obstacles);
    dem_simulation *simulation = support_simulation(model, &usual);
    assert_ok(dem_trajectory_create(&trajectory, e->path, simulation, &options));
    const dem_observer observer = ask_trajectory_observer(trajectory);
    assert_ok(dem_simulation_observe(simulation, &observer));
    if (how->resolved != NULL) assert_ok(dem_trajectory_note(trajectory, "resolved", how->resolved));
    if (how->breaks) {
        assert_ok(dem_simulation_advance(simulation, 0.3));
        assert_ok(dem_simulation_break(simulation, (const dem_index[]){0}, 1, NULL, 0));
    }
    assert_ok(dem_simulation_advance(simulation, 0.6));
    assert_ok(dem_trajectory_finish(trajectory));
    dem_trajectory_destroy(trajectory);
    dem_simulation_destroy(simulation);
    dem_model_destroy(model);
}

/** \param e  set; the task refers to it */
static inline void exported_open(exported *e, exported_how how)
{
    static char folder[SCRATCH_FOLDER + 1];
    dem_index n = 0;
    *e = (exported){.path = NULL};
    folder_open(&e->folder);
    (void)snprintf(folder, sizeof folder, "%s/", e->folder.path);
    e->path = folder_file(&e->folder, "run.vtkhdf");
    exported_run(e, &how);
    assert_ok(dem_reader_open(&e->reader, e->path));
    (void)dem_reader_times(e->reader, &n);
    e->task = (task){.input = e->path, .reader = e->reader, .folder = folder, .name = "run", .outcome = &e->outcome};
    assert_true(frame_list_all(&e->task.frames, n));
}

static inline int exported_has(const exported *e, const char *name)
{
    return access(folder_at(&e->folder, name), F_OK) == 0;
}

static inline const char *exported_text(exported *e, const char *name)
{
    FILE *file = fopen(folder_at(&e->folder, name), "rb");
    if (file == NULL) fail_msg("there is no %s", name);
    const size_t n = fread(e->text, 1, EXPORTED_TEXT - 1, file);
    assert_int_equal(fclose(file), 0);
    e->text[n] = '\0';
    return e->text;
}

/** Fails unless the file has these lines, in this order and without others between. */
static inline void exported_expect(exported *e, const char *name, const char *lines)
{
    if (strstr(exported_text(e, name), lines) == NULL) fail_msg("%s has not\n%s\nbut\n%s", name, lines, e->text);
}

static inline void exported_put(const exported *e, const char *name, const char *text)
{
    file_put(folder_at(&e->folder, name), text, strlen(text));
}

static inline void exported_close(exported *e)
{
    DIR *list = opendir(e->folder.path);
    assert_non_null(list);
    frame_list_free(&e->task.frames);
    dem_reader_close(e->reader);
    for (struct dirent *entry; (entry = readdir(list)) != NULL;) {
        if (strstr(entry->d_name, ".new") != NULL) fail_msg("%s was left", entry->d_name);
        (void)unlinkat(dirfd(list), entry->d_name, 0);
    }
    (void)closedir(list);
    folder_close(&e->folder);
}

/** A run for each test, as its state. */
static inline int exported_begin_with(void **state, exported_how how)
{
    static exported e;
    exported_open(&e, how);
    *state = &e;
    return 0;
}

static inline int exported_begin(void **state)
{
    return exported_begin_with(state, exported_usual());
}

static inline int exported_end(void **state)
{
    exported_close(*state);
    return 0;
}

#endif
