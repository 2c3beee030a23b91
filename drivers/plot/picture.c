/* SPDX-License-Identifier: BSD-3-Clause */
#include "picture.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "paint.h"
#include "svg.h"

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

bool picture_open(picture *p, const char *path, double width, double height, outcome *o)
{
    *p = (picture){0};
    if (!part_file_open(&p->place, path, o)) return false;
    p->face = formats[find_format(path)].open(p->place.file, width, height);
    if (p->face != NULL) return true;
    part_file_drop(&p->place);
    outcome_fail(o, EXIT_MEMORY, "dem_plot", "out of memory");
    return false;
}

bool picture_close(picture *p, const char *note, outcome *o)
{
    errno = 0;
    const bool drawn = p->face->close(p->face, note);
    return part_file_close(&p->place, drawn, "the picture is too large", o);
}

void picture_drop(picture *p)
{
    (void)p->face->close(p->face, "");
    part_file_drop(&p->place);
}
