/* SPDX-License-Identifier: BSD-3-Clause */
/* checkpoint.c and publish.c: entries in memory, and files that are whole or refused. */
#include "verification/support.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/checkpoint_entries.h"
#include "harness/cleanup.h"
#include "harness/message.h"
#include "harness/rank_threads.h"
#include "unit/scratch.h"

#define FILE_NAME "test_checkpoint.checkpoint"
#define PREVIOUS  FILE_NAME ".prev"

/* Messages name the files as the tests do: by their names in the folder. */
static int enter_folder(void **state)
{
    if (scratch_make(state) != 0) return 1;
    (void)scratch_file(FILE_NAME);
    (void)scratch_file(PREVIOUS);
    (void)scratch_file("test_checkpoint.bad");
    (void)scratch_file("test_checkpoint.good");
    return chdir(scratch.path);
}

/* An entry of 5 and one of 0 bytes, and the numbers 1 to 1000. */
static dem_checkpoint *make(void)
{
    dem_checkpoint *checkpoint;
    double numbers[1000];
    for (int k = 0; k < 1000; k++) numbers[k] = k + 1.0;
    assert_ok(dem_checkpoint_create(&checkpoint));
    assert_ok(dem_checkpoint_put(checkpoint, "word", "spring", 5));
    assert_ok(dem_checkpoint_put(checkpoint, "nothing", NULL, 0));
    assert_ok(dem_checkpoint_put(checkpoint, "numbers", numbers, sizeof numbers));
    return checkpoint;
}

static void check(const dem_checkpoint *checkpoint)
{
    char word[5];
    double numbers[1000];
    size_t size;
    assert_ok(dem_checkpoint_get(checkpoint, "word", word, 5));
    assert_memory_equal(word, "sprin", 5);
    assert_ok(dem_checkpoint_get(checkpoint, "nothing", NULL, 0));
    assert_ok(dem_checkpoint_get(checkpoint, "numbers", numbers, sizeof numbers));
    for (int k = 0; k < 1000; k++) assert_close(numbers[k], k + 1.0, 0.0);
    assert_non_null(dem_checkpoint_find(checkpoint, "nothing", &size));
    assert_int_equal(size, 0);
    assert_int_equal((uintptr_t)dem_checkpoint_find(checkpoint, "numbers", &size) % 8, 0);
    assert_int_equal(size, sizeof numbers);
}

static void assert_same_files(const char *a, const char *b)
{
    unsigned char bytes[2][16384];
    size_t size[2];
    for (int k = 0; k < 2; k++) {
        FILE *file = fopen(k == 0 ? a : b, "rb");
        assert_non_null(file);
        size[k] = fread(bytes[k], 1, sizeof bytes[k], file);
        assert_int_equal(fclose(file), 0);
    }
    assert_int_equal(size[0], size[1]);
    assert_memory_equal(bytes[0], bytes[1], size[0]);
}

/* ---- entries ---- */

typedef struct sharing {
    dem_checkpoint *from;
    bool is_same[4]; /* of each rank */
} sharing;

static void share_as_rank(const ranks *r, void *context)
{
    sharing *c = context;
    dem_checkpoint *into = NULL;
    size_t size[3];
    const bool is_made = dem_checkpoint_create(&into) == DEM_OK;
    dem_checkpoint *got = r->rank == 0 ? c->from : into;
    const bool is_shared = is_made && checkpoint_entries_share(r, got) == DEM_OK;
    const char *word = dem_checkpoint_find(got, "word", &size[0]);
    const void *nothing = dem_checkpoint_find(got, "nothing", &size[1]);
    const double *numbers = dem_checkpoint_find(got, "numbers", &size[2]);
    c->is_same[r->rank] = is_shared && word != NULL && size[0] == 5 && memcmp(word, "sprin", 5) == 0 &&
                          nothing != NULL && size[1] == 0 && size[2] == 8000 && numbers[999] == 1000.0;
    dem_checkpoint_destroy(into);
}

TEST(ranks_get_all_entries_of_rank_0)
{
    dem_checkpoint *from = make();
    sharing c = {.from = from};
    rank_threads_run(4, share_as_rank, &c);
    for (int k = 0; k < 4; k++) assert_true(c.is_same[k]);
    dem_checkpoint_destroy(from);
}

TEST(entries_are_copied_replaced_and_found)
{
    dem_checkpoint *checkpoint = make(), *other;
    int number = 3;
    size_t size = 1;
    check(checkpoint);
    assert_ok(dem_checkpoint_put(checkpoint, "word", &number, sizeof number));
    number = 4;
    assert_ok(dem_checkpoint_get(checkpoint, "word", &number, sizeof number));
    assert_int_equal(number, 3);
    assert_ok(dem_checkpoint_put(checkpoint, "word", "springs", 5));
    assert_null(dem_checkpoint_find(checkpoint, "words", &size));
    assert_int_equal(size, 0);
    assert_ok(dem_checkpoint_create(&other));
    assert_ok(checkpoint_entries_copy(other, checkpoint));
    dem_checkpoint_destroy(checkpoint);
    check(other);
    dem_checkpoint_destroy(other);
    dem_checkpoint_destroy(NULL);
}

static bool is_no_word(const char *name)
{
    return strcmp(name, "word") != 0;
}

TEST(some_entries_are_copied)
{
    CLEANUP(free_checkpoint) dem_checkpoint *from = make();
    CLEANUP(free_checkpoint) dem_checkpoint *into = NULL;
    size_t size;
    assert_ok(dem_checkpoint_create(&into));
    assert_ok(checkpoint_entries_choose(into, from, is_no_word));
    assert_null(dem_checkpoint_find(into, "word", &size));
    assert_non_null(dem_checkpoint_find(into, "nothing", &size));
    (void)dem_checkpoint_find(into, "numbers", &size);
    assert_int_equal(size, 8000);
    assert_ok(checkpoint_entries_move(into, from, is_no_word));
    assert_null(dem_checkpoint_find(from, "numbers", &size));
    assert_non_null(dem_checkpoint_find(from, "word", &size));
    assert_ok(checkpoint_entries_move(into, from, NULL));
    check(into);
}

enum { AWAY = 1000 };

typedef struct elsewhere {
    double number[AWAY];
    int n_visits;
    dem_status fails;
} elsewhere;

static dem_status visit(void *context, rows_taker *take, void *taker)
{
    elsewhere *e = context;
    e->n_visits++;
    const dem_status status = take(taker, 0, 300, e->number);
    if (status != DEM_OK || e->fails != DEM_OK) return status != DEM_OK ? status : e->fails;
    return take(taker, 300, AWAY - 300, e->number + 300);
}

static void refer_numbers(dem_checkpoint *checkpoint, elsewhere *e)
{
    const checkpoint_rows rows = {visit, e, sizeof *e->number, AWAY};
    assert_ok(checkpoint_entries_refer(checkpoint, "numbers", &rows));
}

/* A file has what is elsewhere without a copy of it here; who looks at it makes one. */
TEST(entries_may_be_elsewhere)
{
    CLEANUP(free_checkpoint) dem_checkpoint *checkpoint = make();
    CLEANUP(free_checkpoint) dem_checkpoint *same = make();
    elsewhere e = {.fails = DEM_OK};
    size_t size;
    for (int k = 0; k < AWAY; k++) e.number[k] = (double)(k + 1);
    refer_numbers(checkpoint, &e);
    assert_ok(dem_checkpoint_write(checkpoint, FILE_NAME));
    assert_ok(dem_checkpoint_write(same, "test_checkpoint.good"));
    assert_same_files(FILE_NAME, "test_checkpoint.good");
    (void)unlink("test_checkpoint.good");
    assert_int_equal(e.n_visits, 1);
    check(checkpoint);
    assert_int_equal(e.n_visits, 2);
    check(checkpoint);
    assert_int_equal(e.n_visits, 2);
    refer_numbers(checkpoint, &e);
    assert_ok(checkpoint_entries_bring(checkpoint));
    assert_int_equal(e.n_visits, 3);
    check(checkpoint);
    assert_int_equal(e.n_visits, 3);
    e.fails = DEM_ERROR_MEMORY;
    refer_numbers(checkpoint, &e);
    assert_int_equal(dem_checkpoint_write(checkpoint, FILE_NAME), DEM_ERROR_MEMORY);
    assert_null(dem_checkpoint_find(checkpoint, "numbers", &size));
    assert_int_equal(checkpoint_entries_bring(checkpoint), DEM_ERROR_MEMORY);
    assert_ok(dem_checkpoint_put(checkpoint, "numbers", e.number, sizeof e.number));
    check(checkpoint);
}

/* ---- large entries, which stay in the file ---- */

enum { LARGE = 10000 };

static dem_checkpoint *make_large(void)
{
    dem_checkpoint *checkpoint = make();
    CLEANUP(free_memory) double *numbers = malloc(LARGE * sizeof *numbers);
    assert_non_null(numbers);
    for (int k = 0; k < LARGE; k++) numbers[k] = k + 0.5;
    assert_ok(dem_checkpoint_put(checkpoint, "state", numbers, LARGE * sizeof *numbers));
    return checkpoint;
}

static dem_checkpoint *read_large(void)
{
    CLEANUP(free_checkpoint) dem_checkpoint *written = make_large();
    dem_checkpoint *checkpoint;
    assert_ok(dem_checkpoint_write(written, FILE_NAME));
    assert_ok(dem_checkpoint_read(&checkpoint, FILE_NAME));
    return checkpoint;
}

static void check_large(const dem_checkpoint *checkpoint)
{
    size_t size;
    const double *numbers = dem_checkpoint_find(checkpoint, "state", &size);
    assert_non_null(numbers);
    assert_int_equal(size, LARGE * sizeof *numbers);
    for (int k = 0; k < LARGE; k++) assert_close(numbers[k], k + 0.5, 0.0);
    check(checkpoint);
}

/* The file of this name is another one by then. */
TEST(entries_that_are_read_stay_what_they_were_in_their_file)
{
    CLEANUP(free_checkpoint) dem_checkpoint *checkpoint = read_large(), *copy = NULL, *moved = NULL;
    double few[3];
    assert_ok(dem_checkpoint_create(&copy));
    assert_ok(dem_checkpoint_create(&moved));
    assert_ok(checkpoint_entries_copy(copy, checkpoint));
    assert_ok(dem_checkpoint_write(checkpoint, "test_checkpoint.good"));
    assert_same_files(FILE_NAME, "test_checkpoint.good");
    assert_ok(dem_checkpoint_put(checkpoint, "state", "less", 4));
    assert_ok(dem_checkpoint_write(checkpoint, FILE_NAME));
    assert_int_equal(unlink(FILE_NAME) + unlink(PREVIOUS), 0);
    assert_ok(checkpoint_entries_move(moved, copy, NULL));
    assert_ok(checkpoint_entries_read(moved, "state", 700 * sizeof *few, sizeof few, few));
    assert_close(few[0], 700.5, 0.0);
    assert_close(few[2], 702.5, 0.0);
    assert_ok(checkpoint_entries_check(moved, "state", LARGE * sizeof *few));
    assert_ok(dem_checkpoint_write(moved, FILE_NAME));
    assert_same_files(FILE_NAME, "test_checkpoint.good");
    check_large(moved);
    assert_ok(dem_checkpoint_write(moved, FILE_NAME));
    assert_same_files(FILE_NAME, "test_checkpoint.good");
    (void)unlink("test_checkpoint.good");
}

static void share_large(const ranks *r, void *context)
{
    sharing *c = context;
    CLEANUP(free_checkpoint) dem_checkpoint *own = NULL;
    if (dem_checkpoint_create(&own) != DEM_OK) return;
    dem_checkpoint *here = r->rank == 0 ? c->from : own;
    double last = 0.0;
    c->is_same[r->rank] =
        checkpoint_entries_share(r, here) == DEM_OK &&
        checkpoint_entries_read(here, "state", (LARGE - 1) * sizeof last, sizeof last, &last) == DEM_OK &&
        fabs(last - (LARGE - 0.5)) < 1e-9;
}

TEST(ranks_get_entries_that_are_in_a_file_of_rank_0)
{
    CLEANUP(free_checkpoint) dem_checkpoint *from = read_large();
    sharing c = {.from = from};
    rank_threads_run(3, share_large, &c);
    for (int k = 0; k < 3; k++) assert_true(c.is_same[k]);
}

static void refuse_large(dem_status got, const char *message)
{
    assert_int_equal(got, DEM_ERROR_IO);
    assert_message_parts(message);
}

/* By somebody who writes to the file itself. */
TEST(entries_of_a_file_that_has_been_cut_are_missed)
{
    CLEANUP(free_checkpoint) dem_checkpoint *checkpoint = read_large();
    double last;
    size_t size;
    assert_int_equal(truncate(FILE_NAME, LARGE * sizeof last), 0);
    refuse_large(checkpoint_entries_read(checkpoint, "state", (LARGE - 1) * sizeof last, sizeof last, &last),
                 FILE_NAME ": cannot be read any more (it has been cut short");
    refuse_large(dem_checkpoint_get(checkpoint, "state", &last, sizeof last), "80000 bytes of state, 8 are expected");
    refuse_large(checkpoint_entries_read(checkpoint, "state", LARGE * sizeof last, 1, &last),
                 "no 1 bytes of state from byte 80000 on");
    refuse_large(checkpoint_entries_read(checkpoint, "small", 0, 1, &last), "no 1 bytes of small");
    assert_null(dem_checkpoint_find(checkpoint, "state", &size));
    assert_int_equal(size, 0);
    refuse_large(dem_checkpoint_write(checkpoint, "test_checkpoint.good"), "cut short");
    assert_int_not_equal(access("test_checkpoint.good", F_OK), 0);
    check(checkpoint);
}

/* In the order that they had, as files of them are compared; what the other one had besides stays. */
TEST(entries_are_moved_in_their_order)
{
    CLEANUP(free_checkpoint) dem_checkpoint *from = make(), *into, *copy;
    size_t size;
    void *data;
    assert_ok(dem_checkpoint_create(&into));
    assert_ok(dem_checkpoint_create(&copy));
    assert_ok(dem_checkpoint_put(into, "more", "12345678", 8));
    assert_ok(dem_checkpoint_put(into, "word", "w", 1));
    assert_ok(checkpoint_entries_copy(copy, into));
    assert_ok(checkpoint_entries_copy(copy, from));
    const void *numbers = dem_checkpoint_find(from, "numbers", &size);
    assert_ok(checkpoint_entries_move(into, from, NULL));
    assert_null(dem_checkpoint_find(from, "numbers", &size));
    assert_ptr_equal(dem_checkpoint_find(into, "numbers", &size), numbers);
    check(into);
    assert_memory_equal(dem_checkpoint_find(into, "more", &size), "12345678", 8);
    assert_ok(dem_checkpoint_write(into, FILE_NAME));
    assert_ok(dem_checkpoint_write(copy, "test_checkpoint.good"));
    assert_same_files(FILE_NAME, "test_checkpoint.good");
    assert_ok(checkpoint_entries_make(from, "numbers", 3, &data));
    memcpy(data, "abc", 3);
    assert_ok(checkpoint_entries_move(into, from, NULL));
    assert_memory_equal(dem_checkpoint_find(into, "numbers", &size), "abc", 3);
    assert_int_equal(size, 3);
}

static void refuse(dem_status got, dem_status status, const char *message)
{
    assert_int_equal(got, status);
    assert_string_equal(dem_status_message(), message);
}

TEST(what_is_no_entry_is_refused)
{
    CLEANUP(free_checkpoint) dem_checkpoint *checkpoint = make();
    int number = 0;
    refuse(dem_checkpoint_get(checkpoint, "words", &number, 4), DEM_ERROR_IO, "the checkpoint has no words");
    refuse(dem_checkpoint_get(checkpoint, "word", &number, 4), DEM_ERROR_IO,
           "the checkpoint has 5 bytes of word, 4 are expected");
    refuse(dem_checkpoint_put(checkpoint, "", &number, 4), DEM_ERROR_ARGUMENT,
           "\"\" cannot name an entry: 1 to 31 characters");
    refuse(dem_checkpoint_put(checkpoint, "0123456789012345678901234567890_", &number, 4), DEM_ERROR_ARGUMENT,
           "\"0123456789012345678901234567890_\" cannot name an entry: 1 to 31 characters");
    refuse(dem_checkpoint_put(checkpoint, "word", NULL, 4), DEM_ERROR_ARGUMENT,
           "dem_checkpoint_put: an argument is NULL");
    refuse(dem_checkpoint_get(checkpoint, "word", NULL, 4), DEM_ERROR_ARGUMENT,
           "dem_checkpoint_get: an argument is NULL");
    refuse(dem_checkpoint_create(NULL), DEM_ERROR_ARGUMENT, "dem_checkpoint_create: out is NULL");
    refuse(dem_checkpoint_write(NULL, "x"), DEM_ERROR_ARGUMENT, "dem_checkpoint_write: checkpoint is NULL");
    refuse(dem_checkpoint_read(&checkpoint, NULL), DEM_ERROR_ARGUMENT, "dem_checkpoint_read: path is NULL");
    refuse(dem_publish(NULL, "x"), DEM_ERROR_ARGUMENT, "dem_publish: part is NULL");
    check(checkpoint);
}

/* ---- files ---- */

static long size_of(const char *path)
{
    struct stat about;
    return stat(path, &about) == 0 ? (long)about.st_size : -1;
}

TEST(a_file_holds_all_and_the_one_before_is_kept)
{
    CLEANUP(free_checkpoint) dem_checkpoint *checkpoint = make(), *back;
    (void)unlink(FILE_NAME);
    (void)unlink(PREVIOUS);
    assert_ok(dem_checkpoint_write(checkpoint, FILE_NAME));
    assert_int_equal(size_of(PREVIOUS), -1);
    assert_ok(dem_checkpoint_read(&back, FILE_NAME));
    check(back);
    dem_checkpoint_destroy(back);
    assert_int_equal(size_of(FILE_NAME), 64 + 3 * 40 + 8 + 8000);
    assert_ok(dem_checkpoint_put(checkpoint, "more", "12345678", 8));
    assert_ok(dem_checkpoint_write(checkpoint, FILE_NAME));
    assert_int_equal(size_of(PREVIOUS), 64 + 3 * 40 + 8 + 8000);
    assert_int_equal(size_of(FILE_NAME), 64 + 4 * 40 + 16 + 8000);
    assert_int_equal(size_of(FILE_NAME ".part"), -1);
    assert_ok(dem_checkpoint_read(&back, PREVIOUS));
    check(back);
}

static void put_file(const unsigned char *bytes, size_t size)
{
    FILE *file = fopen("test_checkpoint.bad", "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static void refuse_file(const unsigned char *bytes, size_t size, const char *message)
{
    dem_checkpoint *checkpoint = NULL;
    put_file(bytes, size);
    refuse(dem_checkpoint_read(&checkpoint, "test_checkpoint.bad"), DEM_ERROR_IO, message);
    assert_null(checkpoint);
}

/* Every bit counts, and every byte that lacks or is too many. */
TEST(damaged_files_are_refused)
{
    dem_checkpoint *checkpoint, *back;
    unsigned char bytes[512];
    assert_ok(dem_checkpoint_create(&checkpoint));
    assert_ok(dem_checkpoint_put(checkpoint, "word", "spring", 6));
    assert_ok(dem_checkpoint_put(checkpoint, "number", "12345678", 8));
    assert_ok(dem_checkpoint_write(checkpoint, FILE_NAME));
    const size_t size = (size_t)size_of(FILE_NAME);
    FILE *file = fopen(FILE_NAME, "rb");
    assert_non_null(file);
    assert_int_equal(fread(bytes, 1, sizeof bytes, file), size);
    (void)fclose(file);
    for (size_t k = 0; k < 8 * size; k++) {
        bytes[k / 8] ^= (unsigned char)(1u << k % 8);
        put_file(bytes, size);
        assert_int_equal(dem_checkpoint_read(&back, "test_checkpoint.bad"), DEM_ERROR_IO);
        bytes[k / 8] ^= (unsigned char)(1u << k % 8);
    }
    for (size_t k = 0; k < size; k++) {
        put_file(bytes, k);
        assert_int_equal(dem_checkpoint_read(&back, "test_checkpoint.bad"), DEM_ERROR_IO);
    }
    refuse_file(bytes, 10, "test_checkpoint.bad: is no checkpoint, or has been cut short");
    bytes[size] = 0;
    refuse_file(bytes, size + 1, "test_checkpoint.bad: has 161 bytes, 160 were written");
    bytes[size - 1] ^= 1;
    refuse_file(bytes, size, "test_checkpoint.bad: is damaged");
    bytes[size - 1] ^= 1;
    bytes[12] = 2;
    refuse_file(bytes, size, "test_checkpoint.bad: has format 2, this version reads 1");
    bytes[12] = 1;
    bytes[8] = 1;
    bytes[11] = 4;
    refuse_file(bytes, size, "test_checkpoint.bad: was written on a machine of another byte order");
    bytes[0] = 'D';
    refuse_file(bytes, size, "test_checkpoint.bad: is no checkpoint");
    dem_checkpoint_destroy(checkpoint);
}

TEST(files_that_are_none_are_refused)
{
    dem_checkpoint *checkpoint = make(), *back;
    refuse(dem_checkpoint_read(&back, "no/file"), DEM_ERROR_IO,
           "no/file: cannot be opened (No such file or directory)");
    refuse(dem_checkpoint_read(&back, "/tmp"), DEM_ERROR_IO, "/tmp: is not a regular file");
    refuse(dem_checkpoint_write(checkpoint, "no/file"), DEM_ERROR_IO,
           "no/file.part: cannot be opened for writing (No such file or directory)");
    refuse(dem_checkpoint_write(checkpoint, "/dev/full/x"), DEM_ERROR_IO,
           "/dev/full/x.part: cannot be opened for writing (Not a directory)");
    refuse(dem_publish("no/file", "no/other"), DEM_ERROR_IO,
           "no/file: cannot be opened to sync it (No such file or directory)");
    put_file((const unsigned char *)"x", 1);
    refuse(dem_publish("test_checkpoint.bad", "no/file"), DEM_ERROR_IO,
           "test_checkpoint.bad: cannot be renamed to no/file (No such file or directory)");
    assert_ok(dem_publish("test_checkpoint.bad", "test_checkpoint.good"));
    assert_int_equal(size_of("test_checkpoint.good"), 1);
    dem_checkpoint_destroy(checkpoint);
}

/* RLIMIT_FSIZE stands in for a full disk; what is short comes to the disk as the file is closed. */
TEST(a_disk_that_is_full_leaves_the_file_of_before)
{
    dem_checkpoint *checkpoint = make(), *little;
    struct rlimit kept, small;
    assert_ok(dem_checkpoint_write(checkpoint, FILE_NAME));
    assert_ok(dem_checkpoint_create(&little));
    assert_ok(dem_checkpoint_put(little, "word", "spring", 5));
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &kept), 0);
    small = kept;
    small.rlim_cur = 10;
    void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    const dem_status status = dem_checkpoint_write(little, FILE_NAME);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &kept), 0);
    (void)signal(SIGXFSZ, handler);
    refuse(status, DEM_ERROR_IO, FILE_NAME ".part: cannot be written (File too large)");
    dem_checkpoint_destroy(little);
    dem_checkpoint_destroy(checkpoint);
    assert_ok(dem_checkpoint_read(&checkpoint, FILE_NAME));
    check(checkpoint);
    dem_checkpoint_destroy(checkpoint);
}

TEST_GROUP(enter_folder, scratch_remove);
