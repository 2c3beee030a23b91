/* SPDX-License-Identifier: BSD-3-Clause */
/* body_files.c: what stands in the place of a file's name. */
#include "unit/reading.h"

#include <unistd.h>

#include "body_files.h"
#include "unit/scratch.h"

static const char *file_of(const resolved *r, size_t k)
{
    return schema_text(schema_get(&r->deck, "body", k), "file");
}

/* A body without a file keeps what it has, none. The hash is FNV-1a: of no bytes its offset basis, and of 'a' the value
 * that its authors publish. */
TEST(a_file_is_named_by_its_path_then_by_its_bytes)
{
    CLEANUP(drop_resolved)
    resolved r = resolve_clean("&run t_end = 1 /\n&body shape = 'disc', radius = 1 /\n"
                               "&body shape = 'file', file = 'a.h5' /\n&body shape = 'file', file = 'b.h5' /\n");
    char folder[1024], path[1024];
    (void)snprintf(folder, sizeof folder, "%s/", scratch.path);
    (void)snprintf(path, sizeof path, "%s", folder_at(&scratch, "a.h5"));
    file_put(folder_at(&scratch, "a.h5"), "a", 1);
    file_put(folder_at(&scratch, "b.h5"), "", 0);
    assert_true(body_files_name(&r.deck, folder, &r.errors));
    assert_string_equal(file_of(&r, 1), path);
    assert_true(body_files_hash(&r.deck, &r.errors));
    assert_int_equal(r.errors.n, 0);
    assert_string_equal(file_of(&r, 0), "");
    assert_string_equal(file_of(&r, 1), "fnv1a:af63dc4c8601ec8c");
    assert_string_equal(file_of(&r, 2), "fnv1a:cbf29ce484222325");
    assert_int_equal(unlink(path), 0);
    assert_int_equal(unlink(folder_at(&scratch, "b.h5")), 0);
}

TEST(a_relative_folder_gets_the_working_folder)
{
    CLEANUP(drop_resolved) resolved r = resolve_clean("&run t_end = 1 /\n&body shape = 'file', file = 'a.h5' /\n");
    assert_true(body_files_name(&r.deck, "decks/", &r.errors));
    const char *file = file_of(&r, 0), *end = "/decks/a.h5";
    assert_int_equal(file[0], '/');
    assert_string_equal(file + strlen(file) - strlen(end), end);
}

TEST(a_file_that_cannot_be_read_is_a_fault_of_its_key)
{
    CLEANUP(drop_resolved) resolved r = resolve_clean("&run t_end = 1 /\n&body shape = 'file', file = '/no.h5' /\n");
    assert_true(body_files_hash(&r.deck, &r.errors));
    assert_int_equal(r.errors.n, 1);
    assert_int_equal(r.errors.list[0].place.line, 2);
    assert_non_null(strstr(r.errors.list[0].text, "/no.h5: "));
}

TEST_GROUP(scratch_make, scratch_remove);
