/* SPDX-License-Identifier: BSD-3-Clause */
/* show.c: frames of a trajectory become files. */
#include "unit/drivers/plot/trajectory_fixture.h"

#include <string.h>

#include "palette.h"
#include "show.h"

static char *read_text(const char *path)
{
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    char *text = calloc(1, 1 << 20);
    assert_non_null(text);
    assert_true(fread(text, 1, (1 << 20) - 1, file) < (1 << 20) - 1);
    (void)fclose(file);
    (void)remove(path);
    return text;
}

static int count(const char *text, const char *word)
{
    int n = 0;
    for (const char *at = strstr(text, word); at != NULL; at = strstr(at + 1, word)) n++;
    return n;
}

/* The message about it begins with these words. */
static void draw(bool (*how)(const dem_reader *reader, const request *asked, FILE *log, outcome *o),
                 const trajectory_fixture *f, const request *asked, const char *words)
{
    char message[256] = "";
    outcome o = {0};
    FILE *log = tmpfile();
    assert_non_null(log);
    assert_true(how(f->reader, asked, log, &o));
    rewind(log);
    assert_non_null(fgets(message, sizeof message, log));
    assert_memory_equal(message, words, strlen(words));
    (void)fclose(log);
}

static request asking(const trajectory_fixture *f, request_action action, const char *output)
{
    return (request){.action = action, .input = f->path, .output = output, .width = 800.0};
}

TEST(a_strip_has_all_frames_of_a_short_run)
{
    trajectory_fixture *f = *test_state;
    const request r = asking(f, REQUEST_STRIP, trajectory_fixture_beside(f, "a.svg"));
    draw(show_strip, f, &r, r.output);
    CLEANUP(free_memory) char *text = read_text(r.output);
    assert_int_equal(count(text, "<g id=\"frame-"), TRAJECTORY_FIXTURE_FRAMES);
    assert_int_equal(count(text, "strain of springs"), 1);
    assert_int_equal(count(text, "<metadata>data "), 1);
    assert_non_null(strstr(text, ">0.2 ms<"));
}

TEST(frames_and_times_are_taken)
{
    trajectory_fixture *f = *test_state;
    outcome o = {0};
    request r = asking(f, REQUEST_STRIP, trajectory_fixture_beside(f, "a.svg"));
    r.times = "0,9e-4";
    draw(show_strip, f, &r, r.output);
    CLEANUP(free_memory) char *text = read_text(r.output);
    assert_int_equal(count(text, "<g id=\"frame-"), 2);
    assert_non_null(strstr(text, "<g id=\"frame-0\""));
    r.times = NULL, r.frames = "7";
    assert_false(show_strip(f->reader, &r, NULL, &o));
    assert_int_equal(o.code, EXIT_INVALID);
    assert_int_equal(access(r.output, F_OK), -1);
}

/* From 0 on, what is compressed is as grey as what is not strained; the block has springs of either sign. */
TEST(a_range_from_0_has_no_blue)
{
    trajectory_fixture *f = *test_state;
    request r = asking(f, REQUEST_STRIP, trajectory_fixture_beside(f, "a.svg"));
    const palette p = palette_make(PALETTE_DIVERGING);
    const colour blue = p.of[0], red = p.of[PALETTE_SIZE - 1];
    for (int k = 0; k < 2; k++) {
        char inks[2][16];
        (void)snprintf(inks[0], sizeof *inks, "#%02x%02x%02x", blue.red, blue.green, blue.blue);
        (void)snprintf(inks[1], sizeof *inks, "#%02x%02x%02x", red.red, red.green, red.blue);
        r.has_range = true, r.lo = k == 0 ? -1e-6 : 0.0, r.hi = 1e-6;
        draw(show_strip, f, &r, r.output);
        CLEANUP(free_memory) char *text = read_text(r.output);
        assert_int_equal(count(text, inks[0]) > 0, k == 0);
        assert_true(count(text, inks[1]) > 0);
    }
}

TEST(an_animation_has_a_file_for_each_frame)
{
    trajectory_fixture *f = *test_state;
    request r = asking(f, REQUEST_ANIMATION, NULL);
    r.folder = trajectory_fixture_beside(f, "animation");
    draw(show_animation, f, &r, r.folder);
    draw(show_animation, f, &r, r.folder); /* over an older one */
    for (int k = 0; k < TRAJECTORY_FIXTURE_FRAMES; k++) {
        char path[160];
        (void)snprintf(path, sizeof path, "%s/frame_%05d.png", r.folder, k);
        assert_int_equal(remove(path), 0);
    }
    assert_int_equal(rmdir(r.folder), 0);
}

TEST_GROUP(trajectory_fixture_begin, trajectory_fixture_end);
