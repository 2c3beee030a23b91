/* SPDX-License-Identifier: BSD-3-Clause */
#include "limits.h"

#include <dirent.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

static const double giga = 1e9;
static const double joined = 2.0; /* times the output are on disk while its parts are made into one file */

static const struct option {
    const char *word;
    size_t offset;
    double unit;
} options[] = {{"--max-memory", offsetof(limits, memory), 1e9},
               {"--max-steps", offsetof(limits, steps), 1.0},
               {"--max-disk", offsetof(limits, disk), 1e9}};

/* ---- what there is ---- */

/* Of one group; infinite where it has none, "max". */
static double limit_of_group(const char *root, const char *group)
{
    char path[8192];
    double bytes = (double)INFINITY;
    const int n = snprintf(path, sizeof path, "%s%s/memory.max", root, group);
    FILE *file = n > 0 && (size_t)n < sizeof path ? fopen(path, "r") : NULL;
    if (file == NULL) return bytes;
    if (fscanf(file, "%lf", &bytes) != 1) bytes = (double)INFINITY;
    (void)fclose(file);
    return bytes;
}

double limits_of_groups(const char *root, const char *list)
{
    char group[4096] = "";
    FILE *file = fopen(list, "r");
    while (file != NULL && fgets(group, sizeof group, file) != NULL && strncmp(group, "0::", 3) != 0) group[0] = '\0';
    if (file != NULL) (void)fclose(file);
    group[strcspn(group, "\n")] = '\0';
    double least = (double)INFINITY;
    for (char *end = strrchr(group, '/'); end != NULL; end = strrchr(group, '/')) {
        least = fmin(least, limit_of_group(root, group + 3));
        *end = '\0';
    }
    return group[0] != '\0' ? fmin(least, limit_of_group(root, "")) : least;
}

limits limits_default(void)
{
    struct rlimit space;
    const double machine = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    limits most = {.memory = fmin(machine, limits_of_groups("/sys/fs/cgroup", "/proc/self/cgroup")),
                   .steps = 1e10,
                   .disk = (double)INFINITY};
    if (getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY)
        most.memory = fmin(most.memory, (double)space.rlim_cur);
    return most;
}

/* Of the files NAME.*, bytes. */
static double taken_by(const char *folder, const char *name)
{
    const size_t n = strlen(name);
    double bytes = 0.0;
    DIR *files = opendir(folder);
    for (const struct dirent *entry; files != NULL && (entry = readdir(files)) != NULL;) {
        struct stat info;
        if (strncmp(entry->d_name, name, n) == 0 && entry->d_name[n] == '.' &&
            fstatat(dirfd(files), entry->d_name, &info, 0) == 0 && S_ISREG(info.st_mode))
            bytes += 512.0 * (double)info.st_blocks;
    }
    if (files != NULL) (void)closedir(files);
    return bytes;
}

bool limits_see_disk(limits *most, const char *folder, const char *name)
{
    struct statvfs system;
    if (statvfs(folder, &system) != 0 || system.f_blocks == 0) return false;
    most->disk = (double)system.f_bavail * (double)system.f_frsize + taken_by(folder, name);
    return true;
}

/* ---- what is asked for ---- */

static const struct option *find_option(const char *word)
{
    for (size_t k = 0; k < sizeof options / sizeof *options; k++)
        if (strcmp(word, options[k].word) == 0) return &options[k];
    return NULL;
}

bool limits_is_option(const char *word)
{
    return find_option(word) != NULL;
}

bool limits_set(limits *most, const char *option, const char *argument)
{
    const struct option *o = find_option(option);
    char *end = NULL;
    const double value = argument != NULL ? strtod(argument, &end) : 0.0;
    if (end == argument || *end != '\0' || !isfinite(value) || value <= 0.0) return false;
    *(double *)((char *)most + o->offset) = value * o->unit;
    return true;
}

/* ---- what is refused ---- */

static namelist_place place_of(const deck *d, const char *group, size_t k, const char *key)
{
    const schema_instance *instance = schema_get(&d->groups, group, k);
    return schema_given(instance, key) ? schema_place(instance, key) : instance->place;
}

limits_breach limits_check(const limits *most, const estimate *needed, const deck *d, namelist_errors *errors)
{
    const double disk = joined * needed->output;
    limits_breach breach = LIMITS_KEPT;
    if (disk > most->disk) {
        namelist_errors_add(errors, place_of(d, "output", 0, "frame_interval"),
                            "the output takes about %.3g GB, %.0f frames and %.3g steps until 't_end', twice while it "
                            "is put together; the limit is %.3g GB, and --max-disk sets it",
                            needed->output / giga, needed->frames, needed->steps, most->disk / giga);
        breach = LIMITS_DISK;
    }
    if (needed->steps > most->steps) {
        namelist_errors_add(errors, place_of(d, "run", 0, "t_end"),
                            "'t_end' in &run, %g s, takes at least %.3g steps of %.3g s; the limit is %.3g, and "
                            "--max-steps sets it",
                            d->t_end, needed->steps, needed->step, most->steps);
        breach = LIMITS_STEPS;
    }
    if (needed->memory > most->memory) {
        namelist_errors_add(errors, place_of(d, "body", needed->largest, "spacing"),
                            "the run takes at least %.3g GB of memory for its %.3g nodes; the limit is %.3g GB, and "
                            "--max-memory sets it",
                            needed->memory / giga, fmax(needed->nodes, needed->cover), most->memory / giga);
        breach = LIMITS_MEMORY;
    }
    return breach;
}
