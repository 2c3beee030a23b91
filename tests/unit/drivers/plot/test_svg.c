/* SPDX-License-Identifier: BSD-3-Clause */
/* svg.c: what is drawn stands in the file. */
#include "unit/close.h"
#include "unit/drivers/plot/fill_box.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "svg.h"

static char text[8192];

static canvas *open_sheet(FILE **file)
{
    *file = tmpfile();
    assert_non_null(*file);
    canvas *c = svg_open(*file, 100.0, 50.0);
    assert_non_null(c);
    return c;
}

/* Ends it; its text. */
static const char *text_of(canvas *c, FILE *file)
{
    assert_true(c->close(c, "a < b & c"));
    rewind(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    (void)fclose(file);
    return text;
}

static void expect(const char *found, const char *expected)
{
    if (strstr(found, expected) == NULL) fail_msg("no '%s' in %s", expected, found);
}

TEST(numbers_are_short_and_do_not_drift)
{
    FILE *file;
    canvas *c = open_sheet(&file);
    const double xy[] = {1.0, 2.5, 0.994, 2.456, -0.02, 100.0};
    c->strokes(c, (canvas_pen){{255, 0, 16}, 1.5}, 3, 1, xy);
    expect(text_of(c, file), "<path stroke=\"#ff0010\" stroke-width=\"1.50\" d=\"M1 2.5l-.01-.04-1.01 97.54\"/>");
}

TEST(many_thirds_end_where_they_should)
{
    enum { STEPS = 300 };
    FILE *file;
    canvas *c = open_sheet(&file);
    double xy[2 * (STEPS + 1)], x = 0.0;
    for (int k = 0; k <= STEPS; k++) xy[2 * k] = k / 3.0, xy[2 * k + 1] = 7.0;
    c->strokes(c, (canvas_pen){{0, 0, 0}, 1.0}, STEPS + 1, 1, xy);
    const char *at = strstr(text_of(c, file), "d=\"M0 7l");
    assert_non_null(at);
    for (at += strlen("d=\"M0 7l"); *at != '"';) {
        char *end;
        x += strtod(at, &end);
        assert_close(strtod(end, &end), 0.0, 0.0);
        at = end;
    }
    assert_close(x, STEPS / 3.0, 0.005);
}

TEST(parts_have_their_names_and_clips)
{
    FILE *file;
    canvas *c = open_sheet(&file);
    const box clip = {1, 2, 11, 22};
    c->begin(c, "id=\"a\"", &clip);
    c->begin(c, "id=\"b\"", NULL);
    fill_box(c, (colour){0, 0, 0}, clip);
    c->end(c);
    c->end(c);
    const char *found = text_of(c, file);
    expect(found, "<clipPath id=\"clip1\"><rect x=\"1.00\" y=\"2.00\" width=\"10.00\" height=\"20.00\"/></clipPath>");
    expect(found, "<g id=\"a\" clip-path=\"url(#clip1)\">\n<g id=\"b\">");
    expect(found, "d=\"M1 2l10 0 0 20-10 0z\"");
}

TEST(texts_stay_texts)
{
    FILE *file;
    canvas *c = open_sheet(&file);
    c->write(c, &(canvas_label){5, 6, 15, CANVAS_END, true, {0, 0, 0}, "<1 µm & \n>"});
    const char *found = text_of(c, file);
    expect(found, "text-anchor=\"end\" transform=\"rotate(-90 5.00 6.00)\"");
    expect(found, ">&lt;1 µm &amp;  &gt;</text>");
    expect(found, "<metadata>a &lt; b &amp; c</metadata>");
}

/* The first bytes of a PNG in base64. */
TEST(images_are_inside)
{
    FILE *file;
    canvas *c = open_sheet(&file);
    uint32_t argb[2] = {0xff0000ffU, 0};
    c->image(c, (box){0, 0, 10, 5}, &(canvas_image){2, 1, argb});
    expect(text_of(c, file),
           "<image x=\"0.00\" y=\"0.00\" width=\"10.00\" height=\"5.00\" href=\"data:image/png;base64,iVBORw0KGgo");
}

TEST(a_full_disk_is_reported)
{
    FILE *file = fopen("/dev/full", "w");
    if (file == NULL) skip();
    canvas *c = svg_open(file, 100.0, 50.0);
    assert_false(c->close(c, ""));
    (void)fclose(file);
}
