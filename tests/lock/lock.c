/* SPDX-License-Identifier: BSD-3-Clause */
/* No bit of a result changes unnoticed: hashes of runs are compared with those that are stored. `lock INPUTS EXPECTED
 * [update]`: the folder of the decks, and the file, which `update` writes anew. */
#include <string.h>

#include "cases.h"
#include "kernels.h"
#include "store.h"
#include "unit/close.h"

static const char *inputs;

TEST(decks_give_the_stored_bits)
{
    kernels_tell();
    cases_decks(inputs);
    assert_int_equal(store_differences(), 0);
}

TEST(files_of_decks_hold_the_stored_bits)
{
    const int before = store_differences();
    cases_files(inputs);
    assert_int_equal(store_differences() - before, 0);
}

TEST(random_scenes_give_the_stored_bits)
{
    const int before = store_differences();
    cases_scenes();
    assert_int_equal(store_differences() - before, 0);
}

TEST(every_stored_case_was_run)
{
    assert_int_equal(store_missing(), 0);
}

int main(int argc, char **argv)
{
    if (argc < 3) return 2;
    const int replaces = argc > 3 && strcmp(argv[3], "update") == 0;
    inputs = argv[1];
    store_open(argv[2], replaces);
    const int failed = test_run();
    if (failed == 0 && replaces) store_replace();
    return failed;
}
