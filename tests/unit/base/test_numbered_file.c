/* SPDX-License-Identifier: BSD-3-Clause */
#include "harness/test.h"

#include "base/numbered_file.h"

static void check(const char *ending, numbered_file file)
{
    char printed[NUMBERED_FILE];
    numbered_file read;
    numbered_file_print(printed, file);
    assert_string_equal(printed, ending);
    assert_true(numbered_file_read(&read, ending));
    assert_int_equal(read.segment, file.segment);
    assert_int_equal(read.stripe, file.stripe);
    assert_int_equal(read.n, file.n);
    assert_int_equal(read.is_temporary, file.is_temporary);
}

TEST(what_is_printed_is_read)
{
    check(".00001.vtkhdf", (numbered_file){.segment = 1});
    check(".123456.vtkhdf", (numbered_file){.segment = 123456});
    check(".1of4.h5", (numbered_file){.stripe = 1, .n = 4});
    check(".12of100.h5.new", (numbered_file){.stripe = 12, .n = 100, .is_temporary = true});
    check(".00007.4of4.h5", (numbered_file){.segment = 7, .stripe = 4, .n = 4});
}

TEST(other_names_are_no_files_of_a_run)
{
    static const char *const others[] = {"",
                                         ".vtkhdf",
                                         ".1.vtkhdf",
                                         ".00000.vtkhdf",
                                         ".5of4.h5",
                                         ".0of4.h5",
                                         ".1of.h5",
                                         ".of4.h5",
                                         ".1of4.h5x",
                                         ".1of4",
                                         ".00001.vtkhdfx",
                                         ".00001.vtkhdf.new",
                                         "00001.h5",
                                         ".part.vtkhdf",
                                         ".00001.00002.1of4.h5",
                                         ".-1of4.h5",
                                         ".1of4.h5.new.",
                                         ".9999999999.vtkhdf"};
    numbered_file read;
    for (size_t k = 0; k < sizeof others / sizeof *others; k++) assert_false(numbered_file_read(&read, others[k]));
}

int main(void)
{
    return test_run();
}
