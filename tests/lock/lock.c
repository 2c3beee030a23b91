/* SPDX-License-Identifier: BSD-3-Clause */
/* No bit of a result changes unnoticed: hashes of runs are compared with those that are stored. `lock INPUTS EXPECTED
 * [update]`: the folder of the decks, and the file, which `update` writes anew. */
#include <string.h>

#include "cases.h"
#include "kernels.h"
#include "store.h"
#include "unit/close.h"

static const char *inputs;

static void decks_give_the_stored_bits(void **state)
{
    (void)state;
    kernels_tell();
    cases_decks(inputs);
    assert_int_equal(store_differences(), 0);
}

static void files_of_decks_hold_the_stored_bits(void **state)
{
    const int before = store_differences();
    (void)state;
    cases_files(inputs);
    assert_int_equal(store_differences() - before, 0);
}

static void random_scenes_give_the_stored_bits(void **state)
{
    const int before = store_differences();
    (void)state;
    cases_scenes();
    assert_int_equal(store_differences() - before, 0);
}

static void every_stored_case_was_run(void **state)
{
    (void)state;
    assert_int_equal(store_missing(), 0);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(decks_give_the_stored_bits),
        cmocka_unit_test(files_of_decks_hold_the_stored_bits),
        cmocka_unit_test(random_scenes_give_the_stored_bits),
        cmocka_unit_test(every_stored_case_was_run),
    };
    if (argc < 3) return 2;
    const int replaces = argc > 3 && strcmp(argv[3], "update") == 0;
    inputs = argv[1];
    store_open(argv[2], replaces);
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    if (failed == 0 && replaces) store_replace();
    return failed;
}
