/* SPDX-License-Identifier: BSD-3-Clause */
#include "sheet.h"

#include <errno.h>
#include <stdarg.h>
#include <string.h>
#include <unistd.h>

static const char unfinished[] = ".new";

static bool name_file(const task *t, char path[SHEET_PATH], const char *before, const char *behind)
{
    const int n = snprintf(path, SHEET_PATH, "%s%s%s%s", t->folder, before, t->name, behind);
    if (n > 0 && (size_t)n + sizeof unfinished < SHEET_PATH) return true;
    outcome_fail(t->outcome, EXIT_IO, "dem_export", "the name of an output is longer than %d bytes", SHEET_PATH);
    return false;
}

static void name_unfinished(char name[SHEET_PATH], const sheet *s)
{
    (void)snprintf(name, SHEET_PATH, "%.*s%s", SHEET_PATH - (int)sizeof unfinished, s->path, unfinished);
}

bool sheet_is_free(const task *t, const char *before, const char *behind)
{
    char path[SHEET_PATH];
    if (!name_file(t, path, before, behind)) return false;
    if (t->overwrite || access(path, F_OK) != 0) return true;
    outcome_fail(t->outcome, EXIT_TAKEN, "dem_export", "%s: is there already; --overwrite replaces it", path);
    return false;
}

static bool fail(const sheet *s, int cause)
{
    outcome_fail(s->task->outcome, EXIT_IO, "dem_export", "%s: cannot be written (%s)", s->path, strerror(cause));
    return false;
}

bool sheet_open(sheet *s, const task *t, const char *before, const char *behind)
{
    char name[SHEET_PATH];
    *s = (sheet){.task = t};
    if (!name_file(t, s->path, before, behind)) return false;
    name_unfinished(name, s);
    s->file = fopen(name, "wb");
    return s->file != NULL || fail(s, errno);
}

void sheet_print(sheet *s, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    (void)vfprintf(s->file, format, arguments);
    va_end(arguments);
}

void sheet_write(sheet *s, const void *bytes, size_t n)
{
    if (n > 0) (void)fwrite(bytes, n, 1, s->file);
}

void sheet_number(sheet *s, double value, dem_reader_type type)
{
    (void)fprintf(s->file, "%.*g", type == DEM_READER_F32 ? 9 : 17, value);
}

bool sheet_close(sheet *s, bool good)
{
    char name[SHEET_PATH];
    int cause = 0;
    errno = EIO;
    if (fflush(s->file) != 0 || ferror(s->file) != 0) cause = errno;
    if (fclose(s->file) != 0 && cause == 0) cause = errno;
    name_unfinished(name, s);
    good = good && (cause == 0 || fail(s, cause)) && task_holds(s->task, dem_publish(name, s->path));
    if (!good) (void)unlink(name);
    return good;
}
