/* SPDX-License-Identifier: BSD-3-Clause */
/* Runs for other programs. Exit codes: docs/cluster.md. */
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <dem/trajectory.h>

#include "commit.h"
#include "export.h"
#include "streams.h"

enum { MOST_PATH = 4096 };

static bool is_folder(const char *path)
{
    struct stat about;
    return path[strlen(path) - 1] == '/' || (stat(path, &about) == 0 && S_ISDIR(about.st_mode));
}

static const char *behind_folder(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash != NULL ? slash + 1 : path;
}

/* Of RUN.vtkhdf, RUN. */
static void name_run(char name[MOST_PATH], const char *input)
{
    static const char suffix[] = ".vtkhdf";
    (void)snprintf(name, MOST_PATH, "%s", behind_folder(input));
    char *end = strstr(name, suffix);
    if (end != NULL && end != name && end[sizeof suffix - 1] == '\0') *end = '\0';
}

/* Where files go to. */
typedef struct target {
    char folder[MOST_PATH], name[MOST_PATH];
} target;

static void find_target(target *out, const export *e)
{
    out->folder[0] = '\0';
    if (e->output == NULL || is_folder(e->output)) {
        name_run(out->name, e->input);
        if (e->output == NULL) return;
        const bool ends = e->output[strlen(e->output) - 1] == '/';
        (void)snprintf(out->folder, MOST_PATH, "%s%s", e->output, ends ? "" : "/");
        return;
    }
    const char *name = behind_folder(e->output);
    (void)snprintf(out->folder, MOST_PATH, "%.*s", (int)(name - e->output), e->output);
    (void)snprintf(out->name, MOST_PATH, "%s", name);
}

static bool choose_frames(task *t, const export *e)
{
    const char *fault = NULL;
    dem_index n = 0;
    (void)dem_reader_times(t->reader, &n);
    if (e->frames == NULL) {
        if (frame_list_all(&t->frames, n)) return true;
        outcome_fail(t->outcome, EXIT_MEMORY, "dem_export", "out of memory");
    } else if (n == 0) {
        outcome_fail(t->outcome, EXIT_INVALID, "dem_export", "%s: has no frames", e->input);
    } else if (frame_list_parse(&t->frames, e->frames, n, &fault)) {
        return true;
    } else {
        outcome_fail(t->outcome, EXIT_INVALID, "dem_export", "%s: '--frames %s' %s: there are %lld", e->input,
                     e->frames, fault, (long long)n);
    }
    return false;
}

static void write_files(const export *e, outcome *o)
{
    target where;
    dem_reader *reader = NULL;
    find_target(&where, e);
    const dem_status status = dem_reader_open(&reader, e->input);
    task t = {.input = e->input,
              .reader = reader,
              .folder = where.folder,
              .name = where.name,
              .overwrite = e->overwrite,
              .outcome = o};
    if (task_holds(&t, status) && choose_frames(&t, e)) (void)e->write(&t);
    frame_list_free(&t.frames);
    dem_reader_close(reader);
}

int main(int argc, char **argv)
{
    export e;
    streams_begin();
    dem_hdf5_skip_exit();
    outcome o = {.code = export_parse(&e, argc > 0 ? argv + 1 : argv)};
    if (o.code != EXIT_DONE) return (int)o.code;
    if (e.action == EXPORT_HELP)
        export_help(stdout);
    else if (e.action == EXPORT_VERSION)
        (void)printf("dem_export of dem %s (%s)\n", dem_version(), DEM_COMMIT);
    else
        write_files(&e, &o);
    return streams_end("dem_export", o.code);
}
