/* SPDX-License-Identifier: BSD-3-Clause */
#include "frame_list.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void frame_list_free(frame_list *m)
{
    free(m->frame);
    *m = (frame_list){0};
}

static bool reserve(frame_list *m, size_t n)
{
    *m = (frame_list){0, malloc((n > 0 ? n : 1) * sizeof *m->frame)};
    return m->frame != NULL;
}

static bool refuse(frame_list *m, const char **fault, const char *what)
{
    frame_list_free(m);
    *fault = what;
    return false;
}

static size_t count(const char *text, char c)
{
    size_t n = 0;
    for (; *text != '\0'; text++) n += *text == c;
    return n;
}

/* One integer; `text` moves behind it. */
static bool take(const char **text, dem_index *value)
{
    char *end;
    *value = strtoll(*text, &end, 10);
    const bool taken = end != *text;
    *text = end;
    return taken;
}

typedef struct range {
    dem_index first, last, step;
} range;

/* FIRST, FIRST:LAST or FIRST:LAST:STEP, up to a comma or the end. */
static bool take_range(const char **text, dem_index n_frames, range *out)
{
    bool good = take(text, &out->first);
    out->last = out->first, out->step = 1;
    if (good && **text == ':') ++*text, good = take(text, &out->last);
    if (good && **text == ':') ++*text, good = take(text, &out->step);
    if (out->first < 0) out->first += n_frames;
    if (out->last < 0) out->last += n_frames;
    return good && (**text == ',' || **text == '\0') && out->step > 0;
}

/* NULL if it is done, or what is wrong. */
static const char *append(frame_list *m, const range *r, dem_index n_frames)
{
    if (r->first < 0 || r->last >= n_frames || r->last < r->first) return "names frames that are not there";
    const size_t more = (size_t)((r->last - r->first) / r->step) + 1;
    dem_index *larger = realloc(m->frame, (m->n + more) * sizeof *larger);
    if (larger == NULL) return "takes too much memory";
    m->frame = larger;
    for (size_t k = 0; k < more; k++) m->frame[m->n++] = r->first + (dem_index)k * r->step;
    return NULL;
}

bool frame_list_parse(frame_list *m, const char *text, dem_index n_frames, const char **fault)
{
    *m = (frame_list){0};
    for (bool more = true; more; text++) {
        range r;
        if (!take_range(&text, n_frames, &r)) return refuse(m, fault, "is no list of frames as 0,5,10 or 0:20:5");
        if ((*fault = append(m, &r, n_frames)) != NULL) return refuse(m, fault, *fault);
        more = *text == ',';
    }
    return true;
}

dem_index frame_list_nearest(dem_index n_frames, const double *t, double instant)
{
    dem_index nearest = 0;
    for (dem_index k = 1; k < n_frames; k++)
        if (fabs(t[k] - instant) < fabs(t[nearest] - instant)) nearest = k;
    return nearest;
}

bool frame_list_parse_times(frame_list *m, const char *text, dem_index n_frames, const double *t, const char **fault)
{
    const size_t n = count(text, ',') + 1;
    if (!reserve(m, n)) return refuse(m, fault, "takes too much memory");
    for (size_t k = 0; k < n; k++, text++) {
        char *end;
        const double instant = strtod(text, &end);
        if (end == text || (*end != ',' && *end != '\0') || !isfinite(instant))
            return refuse(m, fault, "is no list of times in s as 0,2.5e-3");
        m->frame[m->n++] = frame_list_nearest(n_frames, t, instant);
        text = end;
    }
    return true;
}

bool frame_list_all(frame_list *m, dem_index n_frames)
{
    if (!reserve(m, (size_t)n_frames)) return false;
    while (m->n < (size_t)n_frames) {
        m->frame[m->n] = (dem_index)m->n;
        m->n++;
    }
    return true;
}

/* Evenly from the last one up to `to`, which is included. */
static void fill(frame_list *m, dem_index to, size_t n)
{
    const dem_index from = m->n > 0 ? m->frame[m->n - 1] : 0;
    for (size_t k = 1; k <= n; k++)
        m->frame[m->n++] = from + (dem_index)llround((double)(to - from) * (double)k / (double)n);
}

static void drop_doubles(frame_list *m)
{
    size_t kept = 1;
    for (size_t k = 1; k < m->n; k++)
        if (m->frame[k] > m->frame[kept - 1]) m->frame[kept++] = m->frame[k];
    m->n = kept;
}

bool frame_list_usual(frame_list *m, dem_index n_frames, dem_index middle)
{
    const dem_index last = n_frames - 1;
    if (n_frames <= FRAME_LIST_USUAL) return frame_list_all(m, n_frames);
    if (!reserve(m, FRAME_LIST_USUAL)) return false;
    m->frame[m->n++] = 0;
    if (middle <= 0 || middle >= last) {
        fill(m, last, FRAME_LIST_USUAL - 1);
        return true;
    }
    fill(m, middle, 2);
    if (2 * middle < last) {
        fill(m, 2 * middle, 2);
        fill(m, last, 1);
    } else {
        fill(m, last, 3);
    }
    drop_doubles(m);
    return true;
}
