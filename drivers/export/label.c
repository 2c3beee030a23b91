/* SPDX-License-Identifier: BSD-3-Clause */
#include "label.h"

#include <stdbool.h>
#include <string.h>

enum { MOST = 9 };

static bool ends_in(const char *name, const char *end)
{
    const size_t length = strlen(name), n = strlen(end);
    return length >= n && strcmp(name + length - n, end) == 0;
}

const char *label_component(const char *name, dem_index k, dem_index n)
{
    static const char *const axes[] = {"x", "y", "z"}, *const plane[] = {"xx", "yy", "xy"},
                             *const space[] = {"xx", "yy", "zz", "xy", "yz", "xz"}, *const numbers[MOST] = {"1", "2",
                                                                                                            "3", "4",
                                                                                                            "5", "6",
                                                                                                            "7", "8",
                                                                                                            "9"};
    const bool tensor = ends_in(name, "stress");
    if (n == 1 || k >= MOST) return "";
    if (tensor && n == 3) return plane[k];
    if (tensor && n == 6) return space[k];
    return !tensor && n <= 3 ? axes[k] : numbers[k];
}
