/* SPDX-License-Identifier: BSD-3-Clause */
#include "request.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "picture.h"
#include "quantity.h"

static const char usage[] =
    "usage: dem_plot RUN.vtkhdf -o FILE.png|.svg|.pdf [OPTION]...            a film strip\n"
    "       dem_plot RUN.vtkhdf --animate FOLDER [OPTION]...                 a numbered PNG of every frame\n"
    "       dem_plot RUN.vtkhdf --history -o FILE.png|.svg|.pdf [OPTION]...  energies, reaction, contacts, steps\n"
    "       dem_plot RUN.vtkhdf --fragments -o FILE.png|.svg|.pdf [OPTION]... sizes of fragments\n"
    "       dem_plot RUN.vtkhdf --html FILE.html [OPTION]...                 a page for a browser: all of it, to look "
    "at\n"
    "       dem_plot --version | --help\n"
    "options:\n"
    "  --frames LIST          0,5,10 or 0:20:5; -1 is the last (default: six about the greatest compression)\n"
    "  --times LIST           the frames nearest to these times, s\n"
    "  --color WHAT           one of the names below (default: strain)\n"
    "  --range LIMIT|LO:HI    of the colours, SI units (default: round limits for 99.5 % of the values of every "
    "frame)\n"
    "  --cracks               draw the sides of triangles beside broken ones in black\n"
    "  --zoom X0:X1,Y0:Y1     show this, m (default: all that is in the frames, and the obstacles near it)\n"
    "  --width PIXELS         of the picture, 400 to 20000 (default: 1200)\n"
    "  --columns N            of the strip (default: what fits)\n"
    "  --max-size MB          of a page, 0.1 to 1000 (default: 20): above it quantities, then frames are left out\n"
    "  --hash                 print the hash of the data plotted\n"
    "files: a picture takes the place of an older one of its name\n"
    "film of the numbered ones:\n"
    "  ffmpeg -framerate 25 -i FOLDER/frame_%05d.png -c:v libx264 -pix_fmt yuv420p FILM.mp4\n"
    "exit codes: 0 done, 2 usage, 3 not in the file, 5 input or output, 6 out of memory\n"
    "colors: ";

void request_help(FILE *out)
{
    (void)fputs(usage, out);
    quantity_list(out);
    (void)fputc('\n', out);
}

static const double default_max_size = 20e6; /* bytes */

__attribute__((format(printf, 1, 2))) static bool refuse(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    (void)fprintf(stderr, "dem_plot: error: ");
    (void)vfprintf(stderr, format, arguments);
    (void)fprintf(stderr, "\n");
    va_end(arguments);
    return false;
}

/* What is drawn, unless something else is asked for as well. */
static bool choose_action(request *r, request_action wanted)
{
    static const char *const words[] = {[REQUEST_ANIMATION] = "--animate",
                                        [REQUEST_HISTORY] = "--history",
                                        [REQUEST_SIZES] = "--fragments",
                                        [REQUEST_PAGE] = "--html"};
    const request_action before = r->action;
    r->action = wanted;
    if (before == REQUEST_STRIP || before == wanted) return true;
    return refuse("'%s' does not go with '%s'", words[before < wanted ? before : wanted],
                  words[before < wanted ? wanted : before]);
}

/* ---- options with a value, which is not NULL ---- */

/* n finite numbers with these marks between them, and nothing behind the last. */
static bool read_numbers(const char *text, const char *marks, double *out)
{
    for (;; out++, marks++, text++) {
        char *end;
        *out = strtod(text, &end);
        if (end == text || *end != *marks || !isfinite(*out)) return false;
        if (*marks == '\0') return true;
        text = end;
    }
}

static bool parse_output(request *r, const char *text)
{
    r->output = text;
    return picture_format_of(text) != PICTURE_NONE || refuse("'-o' needs a name in .png, .svg or .pdf, got '%s'", text);
}

static bool parse_animate(request *r, const char *text)
{
    r->folder = text;
    return choose_action(r, REQUEST_ANIMATION);
}

static bool ends_in(const char *text, const char *ending)
{
    const size_t n = strlen(text), m = strlen(ending);
    return n > m && strcasecmp(text + n - m, ending) == 0;
}

static bool parse_html(request *r, const char *text)
{
    r->page = text;
    if (!ends_in(text, ".html") && !ends_in(text, ".htm"))
        return refuse("'--html' needs a name in .html, got '%s'", text);
    return choose_action(r, REQUEST_PAGE);
}

static bool parse_max_size(request *r, const char *text)
{
    double megabytes;
    if (!read_numbers(text, "", &megabytes) || !(megabytes >= 0.1 && megabytes <= 1000.0))
        return refuse("'--max-size' needs 0.1 to 1000 MB, got '%s'", text);
    r->max_size = 1e6 * megabytes;
    return true;
}

static bool parse_frames(request *r, const char *text)
{
    r->frames = text;
    return true;
}

static bool parse_times(request *r, const char *text)
{
    r->times = text;
    return true;
}

static bool parse_color(request *r, const char *text)
{
    r->color = text;
    if (quantity_is_known(text)) return true;
    (void)fprintf(stderr, "dem_plot: error: '--color' knows no '%s', but ", text);
    quantity_list(stderr);
    (void)fputc('\n', stderr);
    return false;
}

static bool parse_range(request *r, const char *text)
{
    double limit[2];
    r->has_range = true;
    if (read_numbers(text, "", limit) && limit[0] > 0.0) {
        r->lo = -(double)INFINITY, r->hi = limit[0];
        return true;
    }
    if (!read_numbers(text, ":", limit) || !(limit[0] < limit[1]))
        return refuse("'--range' needs LIMIT > 0, or LO:HI with LO < HI, got '%s'", text);
    r->lo = limit[0], r->hi = limit[1];
    return true;
}

static bool parse_zoom(request *r, const char *text)
{
    double side[4];
    r->has_zoom = true;
    if (!read_numbers(text, ":,:", side) || !(side[0] < side[1]) || !(side[2] < side[3]))
        return refuse("'--zoom' needs X0:X1,Y0:Y1 with X0 < X1 and Y0 < Y1, got '%s'", text);
    r->zoom = (box){side[0], side[2], side[1], side[3]};
    return true;
}

static bool parse_width(request *r, const char *text)
{
    if (!read_numbers(text, "", &r->width) || !(r->width >= 400.0 && r->width <= 20000.0))
        return refuse("'--width' needs 400 to 20000 pixels, got '%s'", text);
    return true;
}

static bool parse_columns(request *r, const char *text)
{
    double n;
    if (!read_numbers(text, "", &n) || !(n >= 1.0 && n <= 100.0) || n != floor(n))
        return refuse("'--columns' needs a number from 1 to 100, got '%s'", text);
    r->columns = (size_t)n;
    return true;
}

static const struct {
    const char *word, *what;
    bool (*parse)(request *r, const char *value);
} options[] = {{"-o", "a file", parse_output},
               {"--animate", "a folder", parse_animate},
               {"--frames", "a list", parse_frames},
               {"--times", "a list", parse_times},
               {"--color", "a name", parse_color},
               {"--range", "limits", parse_range},
               {"--zoom", "a rectangle", parse_zoom},
               {"--width", "a number", parse_width},
               {"--columns", "a number", parse_columns},
               {"--html", "a file", parse_html},
               {"--max-size", "a number", parse_max_size}};

/* ---- words ---- */

static bool parse_word(request *r, const char *word)
{
    if (strcmp(word, "--help") == 0) return r->action = REQUEST_HELP, true;
    if (strcmp(word, "--version") == 0) return r->action = REQUEST_VERSION, true;
    if (strcmp(word, "--hash") == 0) return r->prints_hash = true;
    if (strcmp(word, "--cracks") == 0) return r->has_cracks = true;
    if (strcmp(word, "--history") == 0) return choose_action(r, REQUEST_HISTORY);
    if (strcmp(word, "--fragments") == 0) return choose_action(r, REQUEST_SIZES);
    if (word[0] == '-') return refuse("'%s' is no option: dem_plot --help", word);
    if (r->input != NULL) return refuse("one run at a time: '%s' and '%s'", r->input, word);
    r->input = word;
    return true;
}

/* What makes no difference to a page, or only to one. */
static bool check_page(const request *r)
{
    if (r->action != REQUEST_PAGE) return r->max_size == 0.0 || refuse("'--max-size' is for '--html'");
    if (r->output != NULL) return refuse("'-o' does not go with '--html'");
    const char *without = r->has_cracks ? "--cracks" : r->prints_hash ? "--hash" : r->columns > 0 ? "--columns" : NULL;
    return without == NULL || refuse("'%s' does not go with '--html'", without);
}

static bool check(const request *r)
{
    if (r->action == REQUEST_HELP || r->action == REQUEST_VERSION) return true;
    if (r->input == NULL) return refuse("no run: dem_plot --help");
    if (r->output != NULL && r->folder != NULL) return refuse("'-o' does not go with '--animate'");
    if (!check_page(r)) return false;
    if (r->output == NULL && r->folder == NULL && r->page == NULL)
        return refuse("where to? -o FILE.png, .svg or .pdf, --animate FOLDER, or --html FILE.html");
    if (r->has_range && r->color != NULL && quantity_is_unordered(r->color))
        return refuse("'--range' does not go with '--color %s', whose colours have no order", r->color);
    if (r->frames != NULL && r->times != NULL) return refuse("'--frames' does not go with '--times'");
    return true;
}

static bool parse_all(request *r, char **argv)
{
    for (char **word = argv; *word != NULL; word++) {
        const size_t n = sizeof options / sizeof *options;
        size_t k = 0;
        while (k < n && strcmp(*word, options[k].word) != 0) k++;
        if (k < n && (word[1] == NULL || word[1][0] == '\0')) return refuse("'%s' needs %s", *word, options[k].what);
        if (!(k < n ? options[k].parse(r, *++word) : parse_word(r, *word))) return false;
    }
    if (!check(r)) return false;
    if (r->max_size == 0.0) r->max_size = default_max_size;
    return true;
}

exit_code request_parse(request *r, char **argv)
{
    *r = (request){.action = REQUEST_STRIP, .width = 1200.0};
    return parse_all(r, argv) ? EXIT_DONE : EXIT_USAGE;
}
