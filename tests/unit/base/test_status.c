/* SPDX-License-Identifier: BSD-3-Clause */
/* status.c, status.h: the message of the last failure, how a failure travels, the version. */
#include "unit/close.h"

#include <pthread.h>
#include <string.h>

#include "base/status.h"

TEST(a_failure_stores_its_text_and_gives_its_status_back)
{
    assert_int_equal(status_fail(DEM_ERROR_CONTACT, "node %d at %g m", 7, 0.25), DEM_ERROR_CONTACT);
    assert_string_equal(dem_status_message(), "node 7 at 0.25 m");
    assert_int_equal(status_fail(DEM_ERROR_IO, "gone"), DEM_ERROR_IO);
    assert_string_equal(dem_status_message(), "gone");
}

TEST(a_message_too_long_is_cut_and_terminated)
{
    char text[2000];
    memset(text, 'a', sizeof text - 1);
    text[sizeof text - 1] = '\0';
    (void)status_fail(DEM_ERROR_MODEL, "%s", text);
    assert_int_equal(strlen(dem_status_message()), 511);
    assert_memory_equal(dem_status_message(), text, 511);
    (void)status_fail(DEM_ERROR_MODEL, "short");
    assert_string_equal(dem_status_message(), "short");
}

static void *fail_elsewhere(void *seen)
{
    const char **before = seen;
    *before = strcmp(dem_status_message(), "") == 0 ? "empty" : "not empty";
    (void)status_fail(DEM_ERROR_MEMORY, "elsewhere");
    return NULL;
}

TEST(each_thread_has_a_message_of_its_own_that_starts_empty)
{
    pthread_t thread;
    const char *before = NULL;
    (void)status_fail(DEM_ERROR_MODEL, "here");
    assert_int_equal(pthread_create(&thread, NULL, fail_elsewhere, &before), 0);
    assert_int_equal(pthread_join(thread, NULL), 0);
    assert_string_equal(before, "empty");
    assert_string_equal(dem_status_message(), "here");
}

static dem_status pass_up(dem_status status, int *reached)
{
    TRY(status);
    *reached = 1;
    return DEM_OK;
}

TEST(try_returns_what_is_not_ok_and_goes_on_otherwise)
{
    int reached = 0;
    assert_int_equal(pass_up(DEM_STOPPED, &reached), DEM_STOPPED);
    assert_int_equal(pass_up(DEM_ERROR_IO, &reached), DEM_ERROR_IO);
    assert_int_equal(reached, 0);
    assert_int_equal(pass_up(DEM_OK, &reached), DEM_OK);
    assert_int_equal(reached, 1);
}

static dem_status check_positive(double number)
{
    CHECK(number > 0.0, DEM_ERROR_ARGUMENT, "must be > 0, got %g", number);
    return DEM_OK;
}

static dem_status check_memory(const void *pointer)
{
    CHECK_MEMORY(pointer);
    return DEM_OK;
}

TEST(check_fails_with_its_message_unless_the_condition_holds)
{
    (void)status_fail(DEM_ERROR_IO, "earlier");
    assert_int_equal(check_positive(1.0), DEM_OK);
    assert_string_equal(dem_status_message(), "earlier");
    assert_int_equal(check_positive(-2.0), DEM_ERROR_ARGUMENT);
    assert_string_equal(dem_status_message(), "must be > 0, got -2");
    assert_int_equal(check_memory(""), DEM_OK);
    assert_int_equal(check_memory(NULL), DEM_ERROR_MEMORY);
    assert_string_equal(dem_status_message(), "out of memory");
}

TEST(every_status_has_the_name_of_its_constant)
{
    static const char *const errors[] = {"DEM_ERROR_MEMORY",     "DEM_ERROR_ARGUMENT", "DEM_ERROR_MODEL",
                                         "DEM_ERROR_INTEGRATOR", "DEM_ERROR_CONTACT",  "DEM_ERROR_IO"};
    assert_string_equal(dem_status_name(DEM_OK), "DEM_OK");
    assert_string_equal(dem_status_name(DEM_STOPPED), "DEM_STOPPED");
    for (int k = 0; k < 6; k++) assert_string_equal(dem_status_name((dem_status)(DEM_ERROR_MEMORY - k)), errors[k]);
    assert_null(dem_status_name((dem_status)2));
    assert_null(dem_status_name((dem_status)(DEM_ERROR_IO - 1)));
}

TEST(the_version_is_the_one_of_the_build)
{
    assert_string_equal(dem_version(), DEM_VERSION);
}

static void count(void *context)
{
    ++*(int *)context;
}

TEST(a_lack_of_memory_is_seen_at_once_by_who_watches)
{
    int times = 0;
    status_watch_memory(count, &times);
    assert_int_equal(status_fail(DEM_ERROR_MODEL, "%s", "a mass"), DEM_ERROR_MODEL);
    assert_int_equal(status_repeat(DEM_ERROR_MEMORY, "no %d"), DEM_ERROR_MEMORY); /* of another rank */
    assert_string_equal(dem_status_message(), "no %d");
    assert_int_equal(times, 0);
    assert_int_equal(status_fail(DEM_ERROR_MEMORY, "no %d", 3), DEM_ERROR_MEMORY);
    assert_string_equal(dem_status_message(), "no 3");
    assert_int_equal(times, 1);
    status_watch_memory(NULL, NULL);
    assert_int_equal(status_fail(DEM_ERROR_MEMORY, "no %d", 4), DEM_ERROR_MEMORY);
    assert_int_equal(times, 1);
}
