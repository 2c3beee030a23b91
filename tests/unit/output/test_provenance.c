/* SPDX-License-Identifier: BSD-3-Clause */
/* provenance.c: strings under names, in every file that they are written to. */
#include "unit/output/stored.h"

#include "output/hdf5_attribute.h"
#include "output/provenance.h"

static void put(provenance *all, const char *name, const char *text)
{
    char path[PROVENANCE_PATH];
    assert_ok(provenance_path(path, name));
    assert_ok(provenance_put(all, path, text));
}

static void assert_note(const stored *s, const char *path, const char *expected)
{
    char text[64];
    assert_ok(hdf5_read_text(&s->file, path, text, sizeof text));
    assert_string_equal(text, expected);
}

TEST(notes_are_written_to_every_file_and_replaced_by_name)
{
    provenance all = {0};
    put(&all, "title", "first");
    put(&all, "deck", "&run\n/");
    put(&all, "nothing", "");
    put(&all, "title", "the second, longer");
    assert_int_equal(all.n, 3);
    for (int k = 0; k < 2; k++) {
        CLEANUP(stored_close) stored s;
        stored_open(&s);
        assert_ok(provenance_write(&all, &s.file));
        assert_note(&s, "/provenance/title", "the second, longer");
        assert_note(&s, "/provenance/deck", "&run\n/");
        assert_note(&s, "/provenance/nothing", "");
    }
    provenance_free(&all);
    assert_int_equal(all.n, 0);
}

/* A thousand notes and a long one: room is asked for all of it. */
TEST(the_bytes_of_notes_are_bounded)
{
    CLEANUP(provenance_free) provenance all = {0};
    CLEANUP(stored_close) stored s;
    hsize_t size = 0;
    CLEANUP(free_memory) char *text = calloc(100001, 1);
    assert_non_null(text);
    assert_int_equal(provenance_bytes(&all), 0);
    put(&all, "long", memset(text, 'x', 100000));
    for (int k = 0; k < 1000; k++) {
        char name[16];
        (void)snprintf(name, sizeof name, "n%d", k);
        put(&all, name, "short");
    }
    stored_open(&s);
    assert_ok(provenance_write(&all, &s.file));
    assert_true(H5Fflush(s.file.id, H5F_SCOPE_GLOBAL) >= 0 && H5Fget_filesize(s.file.id, &size) >= 0);
    assert_true(size <= provenance_bytes(&all));
}

TEST(a_bad_name_is_refused)
{
    char path[PROVENANCE_PATH], name[65];
    static const char *const bad[] = {"", "a/b", ".", "a.b"};
    for (size_t k = 0; k < sizeof bad / sizeof bad[0]; k++) {
        assert_int_equal(provenance_path(path, bad[k]), DEM_ERROR_ARGUMENT);
        assert_non_null(strstr(dem_status_message(), "cannot name a note: 1 to 63 characters"));
    }
    memset(name, 'n', 64);
    name[64] = '\0';
    assert_int_equal(provenance_path(path, name), DEM_ERROR_ARGUMENT);
    assert_ok(provenance_path(path, name + 1));
    assert_int_equal(strlen(path), 63 + strlen("/provenance/"));
}
