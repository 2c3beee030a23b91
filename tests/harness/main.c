/* SPDX-License-Identifier: BSD-3-Clause */
#include "harness/test.h"

int main(void)
{
    return test_run();
}
