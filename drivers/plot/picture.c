/* SPDX-License-Identifier: BSD-3-Clause */
#include "picture.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "paint.h"
#include "svg.h"

static const char end_of_part[] = ".part";

static const struct {
    const char *end;
    picture_format format;
    canvas *(*open)(FILE *file, double width, double height);
} formats[] = {
    {".png", PICTURE_PNG, paint_open_png}, {".svg", PICTURE_SVG, svg_open}, {".pdf", PICTURE_PDF, paint_open_pdf}};

enum { FORMATS = sizeof formats / sizeof *formats };

static size_t find_format(const char *path)
{
    const char *dot = strrchr(path, '.');
    size_t k = 0;
    while (k < FORMATS && (dot == NULL || strcasecmp(dot, formats[k].end) != 0)) k++;
    return k;
}

picture_format picture_format_of(const char *path)
{
    const size_t k = find_format(path);
    return k < FORMATS ? formats[k].format : PICTURE_NONE;
}

static bool refuse(outcome *o, const char *path)
{
    outcome_fail(o, EXIT_IO, "dem_plot", "%s: cannot be written (%s)", path,
                 errno != 0 ? strerror(errno) : "the picture is too large");
    return false;
}

static void forget(picture *p)
{
    free(p->part);
    *p = (picture){0};
}

bool picture_open(picture *p, const char *path, double width, double height, outcome *o)
{
    const size_t size = strlen(path) + sizeof end_of_part;
    *p = (picture){.path = path, .part = malloc(size)};
    if (p->part == NULL) return outcome_fail(o, EXIT_MEMORY, "dem_plot", "out of memory"), false;
    (void)snprintf(p->part, size, "%s%s", path, end_of_part);
    p->file = fopen(p->part, "wb");
    if (p->file == NULL) return forget(p), refuse(o, path);
    p->face = formats[find_format(path)].open(p->file, width, height);
    if (p->face != NULL) return true;
    picture_drop(p);
    outcome_fail(o, EXIT_MEMORY, "dem_plot", "out of memory");
    return false;
}

bool picture_close(picture *p, const char *note, outcome *o)
{
    errno = 0;
    const bool drawn = p->face->close(p->face, note);
    const bool written = fclose(p->file) == 0 && drawn && rename(p->part, p->path) == 0;
    if (!written) {
        (void)refuse(o, p->path);
        (void)remove(p->part);
    }
    forget(p);
    return written;
}

void picture_drop(picture *p)
{
    if (p->face != NULL) (void)p->face->close(p->face, "");
    (void)fclose(p->file);
    (void)remove(p->part);
    forget(p);
}
