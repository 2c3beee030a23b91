/* SPDX-License-Identifier: BSD-3-Clause */
#include "checkpoint_file.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "ask.h"
#include "difference.h"
#include "preview.h"
#include "wall_clock.h"

enum { VERSIONS = 256 };

static const double patience = 10.0;    /* s: a scheduler that asks for the end waits 30 */
static const double first_after = 30.0; /* s */

static const char time_entry[] = "driver.time", course_entry[] = "driver.course", lineage_entry[] = "driver.lineage";

/* ---- what is there ---- */

/* A text among the entries; NULL if it is none. */
static const char *find_text(const dem_checkpoint *checkpoint, const char *name)
{
    size_t size;
    const char *text = dem_checkpoint_find(checkpoint, name, &size);
    return text != NULL && size > 0 && text[size - 1] == '\0' ? text : NULL;
}

static const char *last_line(const char *lineage)
{
    const char *last = strrchr(lineage, '\n');
    return last == NULL ? lineage : last + 1;
}

/* Adds the version at work, if it is another than the last. */
static bool extend_lineage(checkpoint_source *s, const char *lineage, const char *versions)
{
    const bool other = strcmp(last_line(lineage), versions) != 0;
    const size_t size = strlen(lineage) + strlen(versions) + 2;
    s->lineage = malloc(size);
    if (s->lineage != NULL)
        (void)snprintf(s->lineage, size, "%s%s%s", lineage, other ? "\n" : "", other ? versions : "");
    return s->lineage != NULL;
}

static checkpoint_state examine(checkpoint_source *s, const deck *d, bool anyway, char reason[OUTPUT_REASON])
{
    char versions[VERSIONS], difference[DIFFERENCE];
    const char *course = find_text(s->checkpoint, course_entry), *lineage = find_text(s->checkpoint, lineage_entry);
    if (course == NULL || lineage == NULL ||
        dem_checkpoint_get(s->checkpoint, time_entry, &s->t, sizeof s->t) != DEM_OK) {
        (void)snprintf(reason, OUTPUT_REASON, "it is not of this program; " OUTPUT_WAY_OUT);
        return CHECKPOINT_OTHER;
    }
    preview_versions(versions, sizeof versions);
    if (difference_find(course, d->course, difference)) {
        (void)snprintf(reason, OUTPUT_REASON, "the run that it is of has %s; " OUTPUT_WAY_OUT, difference);
        return CHECKPOINT_OTHER;
    }
    if (strcmp(last_line(lineage), versions) != 0 && !anyway) {
        (void)snprintf(reason, OUTPUT_REASON, "it is of '%s', this is '%s'; --resume-anyway goes on all the same",
                       last_line(lineage), versions);
        return CHECKPOINT_OTHER;
    }
    if (s->t > d->t_end) {
        (void)snprintf(reason, OUTPUT_REASON, "the run is at %g s already, beyond t_end = %g s; " OUTPUT_WAY_OUT, s->t,
                       d->t_end);
        return CHECKPOINT_OTHER;
    }
    return extend_lineage(s, lineage, versions) ? CHECKPOINT_FOUND : CHECKPOINT_MEMORY;
}

/* Reads the checkpoint or the one before; that must not be replaced by a damaged one when the next is written. */
static dem_status read_either(dem_checkpoint **out, const char *path, char reason[OUTPUT_REASON])
{
    char file[OUTPUT_PATH], before[OUTPUT_PATH], damaged[OUTPUT_PATH];
    output_beside(file, path, ".checkpoint");
    output_beside(before, path, ".checkpoint.prev");
    output_beside(damaged, path, ".checkpoint.damaged");
    dem_status status = dem_checkpoint_read(out, file);
    if (status != DEM_ERROR_IO) return status;
    (void)snprintf(reason, OUTPUT_REASON, "%s; " OUTPUT_WAY_OUT, dem_status_message());
    status = dem_checkpoint_read(out, before);
    if (status == DEM_OK && rename(file, damaged) != 0 && errno != ENOENT) status = DEM_ERROR_IO;
    return status;
}

checkpoint_state checkpoint_file_find(checkpoint_source *out, const char *path, const deck *d, bool anyway,
                                      char reason[OUTPUT_REASON])
{
    char file[OUTPUT_PATH], before[OUTPUT_PATH];
    *out = (checkpoint_source){0};
    output_beside(file, path, ".checkpoint");
    output_beside(before, path, ".checkpoint.prev");
    if (access(file, F_OK) != 0 && access(before, F_OK) != 0) return CHECKPOINT_NONE;
    const dem_status status = read_either(&out->checkpoint, path, reason);
    if (status == DEM_ERROR_MEMORY) return CHECKPOINT_MEMORY;
    return status == DEM_OK ? examine(out, d, anyway, reason) : CHECKPOINT_DAMAGED;
}

void checkpoint_file_source_free(checkpoint_source *source)
{
    dem_checkpoint_destroy(source->checkpoint);
    free(source->lineage);
    *source = (checkpoint_source){0};
}

/* ---- what is written ---- */

checkpoint_file checkpoint_file_start(const command *c, const char *path, const deck *d,
                                      const checkpoint_source *source)
{
    checkpoint_file new = {.deck = d,
                           .source = source,
                           .requests = c->host->requests,
                           .interval = c->checkpoint_interval,
                           .deadline = c->wall_start + c->max_wall,
                           .wall_next = wall_clock() + fmin(c->checkpoint_interval, first_after),
                           .t_written = source->checkpoint != NULL ? source->t : -1.0};
    output_beside(new.path, path, ".checkpoint");
    preview_versions(new.versions, sizeof new.versions);
    return new;
}

static double time_of(const dem_checkpoint *checkpoint)
{
    double t = -1.0;
    (void)dem_checkpoint_get(checkpoint, time_entry, &t, sizeof t);
    return t;
}

static dem_status put_on_disk(checkpoint_file *c, const dem_checkpoint *checkpoint)
{
    const double t = time_of(checkpoint);
    if (t == c->t_written) return DEM_OK;
    const dem_status status = dem_checkpoint_write(checkpoint, c->path);
    if (status != DEM_OK) return status;
    c->t_written = t;
    c->wall_next = wall_clock() + c->interval;
    return DEM_OK;
}

static dem_status save(checkpoint_file *c, const dem_checkpoint *checkpoint)
{
    if (time_of(checkpoint) == c->t_written) return DEM_OK;
    dem_status status = dem_trajectory_segment(c->trajectory, checkpoint);
    if (status == DEM_OK) status = put_on_disk(c, checkpoint);
    if (status == DEM_OK) run_log_tell(c->log, "checkpoint t %.6g s in %s\n", c->t_written, c->path);
    return status;
}

/* Whether the end is asked for. */
static bool is_ending(checkpoint_file *c, const char **why)
{
    *why = requests_end(c->requests);
    const double now = wall_clock();
    if (*why == NULL && now >= c->deadline) *why = "--max-wall";
    if (*why != NULL && c->wall_ending == 0.0) c->wall_ending = now;
    return *why != NULL;
}

static dem_status put_entries(const checkpoint_file *c, const dem_simulation *simulation, dem_checkpoint *checkpoint)
{
    const double t = ask_progress(simulation).t;
    const char *lineage = c->source->lineage != NULL ? c->source->lineage : c->versions;
    dem_status status = dem_checkpoint_put(checkpoint, time_entry, &t, sizeof t);
    if (status == DEM_OK)
        status = dem_checkpoint_put(checkpoint, course_entry, c->deck->course, strlen(c->deck->course) + 1);
    if (status == DEM_OK) status = dem_checkpoint_put(checkpoint, lineage_entry, lineage, strlen(lineage) + 1);
    return status;
}

static dem_status on_checkpoint(void *context, const dem_simulation *simulation, dem_checkpoint *checkpoint)
{
    checkpoint_file *c = context;
    const char *why;
    dem_status status = put_entries(c, simulation, checkpoint);
    const bool ending = is_ending(c, &why), wanted = requests_checkpoint(c->requests);
    if (status == DEM_OK && (ending || wanted || wall_clock() >= c->wall_next)) status = save(c, checkpoint);
    if (status != DEM_OK || !ending) return status;
    c->ended = why;
    return DEM_STOPPED;
}

static dem_status on_step(void *context, const dem_simulation *simulation)
{
    checkpoint_file *c = context;
    const char *why;
    if (!is_ending(c, &why) || wall_clock() - c->wall_ending < patience) return DEM_OK;
    const dem_status status = checkpoint_file_save(c, simulation);
    if (status != DEM_OK) return status;
    c->ended = why;
    return DEM_STOPPED;
}

dem_observer checkpoint_file_observer(checkpoint_file *c, dem_index every)
{
    return (dem_observer){.struct_size = sizeof(dem_observer),
                          .step = on_step,
                          .checkpoint = on_checkpoint,
                          .context = c,
                          .step_every = every};
}

dem_status checkpoint_file_save(checkpoint_file *c, const dem_simulation *simulation)
{
    const dem_checkpoint *checkpoint = dem_simulation_checkpoint(simulation);
    return checkpoint == NULL ? DEM_OK : save(c, checkpoint);
}

dem_status checkpoint_file_close(checkpoint_file *c, const dem_simulation *simulation)
{
    const dem_checkpoint *checkpoint = dem_simulation_checkpoint(simulation);
    const dem_status status = checkpoint == NULL ? DEM_OK : put_on_disk(c, checkpoint);
    char before[OUTPUT_PATH + 8];
    (void)snprintf(before, sizeof before, "%s.prev", c->path);
    if (status == DEM_OK) (void)unlink(before);
    return status;
}
