/* SPDX-License-Identifier: BSD-3-Clause */
#include "show.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "choice.h"
#include "digest.h"
#include "legend.h"
#include "picture.h"
#include "time_label.h"
#include "strip.h"

/* Two passes over the frames: what all of them have in common is known before the first is drawn. */
typedef struct show {
    const dem_reader *reader;
    const request *asked;
    quantity shown;
    frame_list chosen;
    snapshot now;
    palette colours;
    panel_look look;
    time_label times;
    double letters; /* height of the times, pixels */
    box bodies;     /* in all frames */
    uint64_t hash;
} show;

static bool fail_memory(outcome *o)
{
    outcome_fail(o, EXIT_MEMORY, "dem_plot", "out of memory");
    return false;
}

/* ---- which frames ---- */

static bool read_column(const dem_reader *reader, const char *name, dem_index n, double *value)
{
    const dem_reader_column *column = dem_reader_column_find(reader, "history", name);
    return column != NULL && column->n_rows == n && column->width == 1 &&
           dem_reader_read_column(reader, column, value) == DEM_OK;
}

/* The frame nearest to the largest elastic energy, -1 if that is not known or never is any. */
static dem_index most_compressed(const dem_reader *reader, dem_index n_frames, const double *times)
{
    const dem_reader_column *column = dem_reader_column_find(reader, "history", "t");
    const dem_index n = column != NULL ? column->n_rows : 0;
    double *t = malloc(((size_t)n + 1) * sizeof *t), *energy = malloc(((size_t)n + 1) * sizeof *energy);
    dem_index found = -1, most = 0;
    if (t != NULL && energy != NULL && n > 0 && read_column(reader, "t", n, t) &&
        read_column(reader, "elastic", n, energy)) {
        for (dem_index k = 1; k < n; k++)
            if (energy[k] > energy[most]) most = k;
        if (energy[most] > 0.0) found = frame_list_nearest(n_frames, times, t[most]);
    }
    free(t);
    free(energy);
    return found;
}

static bool choose(show *s, outcome *o)
{
    dem_index n;
    const double *t = dem_reader_times(s->reader, &n);
    if (!choice_find(&s->chosen, s->reader, s->asked, o)) return false;
    if (s->chosen.n > 0) return true;
    const bool all = s->asked->action == REQUEST_ANIMATION;
    return (all ? frame_list_all(&s->chosen, n) : frame_list_usual(&s->chosen, n, most_compressed(s->reader, n, t))) ||
           fail_memory(o);
}

static bool set_times(show *s, outcome *o)
{
    dem_index n;
    const double *all = dem_reader_times(s->reader, &n);
    double *t = malloc(s->chosen.n * sizeof *t);
    if (t == NULL) return fail_memory(o);
    for (size_t k = 0; k < s->chosen.n; k++) t[k] = all[s->chosen.frame[k]];
    s->times = time_label_for(s->chosen.n, t);
    free(t);
    return true;
}

/* ---- what they have in common ---- */

static bool survey(show *s, outcome *o)
{
    colour_range_extent reach = colour_range_extent_none();
    s->bodies = box_empty();
    for (size_t k = 0; k < s->chosen.n; k++) {
        if (!snapshot_load(&s->now, s->chosen.frame[k], o)) return false;
        s->bodies = box_join(s->bodies, s->now.bounds);
        reach = colour_range_extent_join(reach, s->now.reach);
        s->hash = snapshot_hash(&s->now, s->hash);
    }
    s->look.range = choice_range(s->asked, s->shown.scale, reach);
    return true;
}

static bool open_show(show *s, const dem_reader *reader, const request *asked, outcome *o)
{
    *s = (show){.reader = reader, .asked = asked, .hash = DIGEST_BEGIN};
    if (!quantity_find(&s->shown, reader, asked->color, o) || !choose(s, o) || !set_times(s, o)) return false;
    if (!snapshot_create(&s->now, reader, &s->shown, o)) return false;
    if (asked->has_cracks && !snapshot_follow_cracks(&s->now, o)) return false;
    if (!survey(s, o)) return false;
    s->colours = choice_palette(&s->shown, s->look.range);
    s->look.colours = &s->colours;
    s->look.is_binned = s->now.lattice->n_springs > PANEL_BINNED_FROM;
    return true;
}

static void close_show(show *s)
{
    frame_list_free(&s->chosen);
    snapshot_free(&s->now);
}

/* So high that the longest has room above its panel. */
static double letters_for(const show *s, double room)
{
    dem_index n;
    const double *t = dem_reader_times(s->reader, &n);
    double longest = 0.0;
    for (size_t k = 0; k < s->chosen.n; k++) {
        char text[TIME_LABEL_TEXT];
        time_label_print(&s->times, t[s->chosen.frame[k]], text);
        longest = fmax(longest, canvas_length(text, LEGEND_LETTERS));
    }
    return LEGEND_LETTERS * fmin(1.0, room / longest);
}

/* What says how an obstacle moves. */
static uint64_t add_motion(uint64_t hash, const dem_obstacle *obstacle)
{
    const dem_motion_field *field;
    for (dem_index k = 0; (field = dem_motion_field_at(k)) != NULL; k++)
        hash = digest_add(hash, (const char *)obstacle + field->offset, (size_t)field->n * sizeof(double));
    return hash;
}

/* n panels to a picture; the hash takes in what all of them share. */
static strip plan(show *s, size_t n)
{
    const box view = s->asked->has_zoom ? s->asked->zoom : strip_view_of_all(s->bodies, s->reader);
    const strip planned = strip_plan(n, view, s->asked->width, s->asked->columns);
    const panel first = strip_panel(&planned, 0);
    s->look.thick = panel_thickness(panel_scale(&first) * snapshot_spacing(&s->now));
    s->letters = letters_for(s, planned.across);
    s->hash = digest_add(s->hash, s->shown.name, strlen(s->shown.name));
    if (s->asked->has_cracks) s->hash = digest_add(s->hash, "cracks", strlen("cracks"));
    s->hash = digest_add(s->hash, &s->look.range, 2 * sizeof(double));
    s->hash = digest_add(s->hash, &planned.view, sizeof planned.view);
    for (dem_index k = 0; k < dem_reader_n_obstacles(s->reader); k++) {
        const dem_obstacle *obstacle = dem_reader_obstacle(s->reader, k);
        s->hash = digest_add(s->hash, obstacle->points, 2 * (size_t)obstacle->n_points * sizeof(double));
        s->hash = add_motion(s->hash, obstacle);
    }
    return planned;
}

/* ---- drawing ---- */

static void draw_legend(const show *s, const strip *planned, canvas *c)
{
    const panel first = strip_panel(planned, 0);
    const box bar = strip_scale(planned);
    legend_draw_scale(panel_scale(&first), bar.x0, bar.y0, box_width(bar), c);
    if (s->shown.source != NULL)
        legend_draw_colours(&s->shown, s->look.colours, s->look.range, strip_colours(planned), c);
}

static bool draw_panel(show *s, const strip *planned, size_t k, dem_index frame, canvas *c, outcome *o)
{
    const panel p = strip_panel(planned, k);
    char text[TIME_LABEL_TEXT];
    if (s->now.frame != frame && !snapshot_load(&s->now, frame, o)) return false;
    time_label_print(&s->times, s->now.t, text);
    const double middle = 0.5 * (p.place.x0 + p.place.x1);
    c->write(c, &(canvas_label){middle, p.place.y0 - 8.0, s->letters, CANVAS_MIDDLE, false, canvas_black, text});
    return panel_draw(&p, &s->now, &s->look, c) || fail_memory(o);
}

static bool draw_file(show *s, const strip *planned, size_t first, const char *path, outcome *o)
{
    picture file;
    char note[80];
    (void)snprintf(note, sizeof note, "data %016" PRIx64, s->hash);
    if (!picture_open(&file, path, planned->width, planned->height, o)) return false;
    for (size_t k = 0; k < planned->n; k++) {
        if (draw_panel(s, planned, k, s->chosen.frame[first + k], file.face, o)) continue;
        picture_drop(&file);
        return false;
    }
    draw_legend(s, planned, file.face);
    return picture_close(&file, note, o);
}

static void report(const show *s, const char *path, const strip *planned, FILE *log)
{
    if (s->asked->prints_hash) {
        (void)fprintf(log, "%016" PRIx64 "\n", s->hash);
        return;
    }
    (void)fprintf(log, "%s: %.0f x %.0f pixels, %zu frame%s of %lld springs", path, planned->width, planned->height,
                  s->chosen.n, s->chosen.n == 1 ? "" : "s", (long long)s->now.lattice->n_springs);
    const bool of_pieces = s->shown.scale == PALETTE_PIECES;
    if (s->shown.source != NULL && of_pieces) (void)fprintf(log, ", %s", s->shown.name);
    if (s->shown.source != NULL && !of_pieces)
        (void)fprintf(log, ", %s %g to %g", s->shown.name, s->look.range.lo, s->look.range.hi);
    (void)fprintf(log, "%s\n", s->look.is_binned ? ", binned to pixels" : "");
}

bool show_strip(const dem_reader *reader, const request *asked, FILE *log, outcome *o)
{
    show s;
    bool done = open_show(&s, reader, asked, o);
    if (done) {
        const strip planned = plan(&s, s.chosen.n);
        done = draw_file(&s, &planned, 0, asked->output, o);
        if (done) report(&s, asked->output, &planned, log);
    }
    close_show(&s);
    return done;
}

static bool make_folder(const char *path, outcome *o)
{
    if (mkdir(path, 0777) == 0 || errno == EEXIST) return true;
    outcome_fail(o, EXIT_IO, "dem_plot", "%s: cannot be made (%s)", path, strerror(errno));
    return false;
}

static bool draw_all(show *s, const strip *planned, outcome *o)
{
    const char *folder = s->asked->folder;
    const size_t size = strlen(folder) + sizeof "/frame_00000000000000000000.png";
    char *path = malloc(size);
    if (path == NULL) return fail_memory(o);
    bool done = make_folder(folder, o);
    for (size_t k = 0; k < s->chosen.n && done; k++) {
        (void)snprintf(path, size, "%s/frame_%05zu.png", folder, k);
        done = draw_file(s, planned, k, path, o);
    }
    free(path);
    return done;
}

bool show_animation(const dem_reader *reader, const request *asked, FILE *log, outcome *o)
{
    show s;
    bool done = open_show(&s, reader, asked, o);
    if (done) {
        const strip planned = plan(&s, 1);
        done = draw_all(&s, &planned, o);
        if (done) report(&s, asked->folder, &planned, log);
        if (done && !asked->prints_hash)
            (void)fprintf(log, "ffmpeg -framerate 25 -i %s/frame_%%05d.png -c:v libx264 -pix_fmt yuv420p %s.mp4\n",
                          asked->folder, asked->folder);
    }
    close_show(&s);
    return done;
}
