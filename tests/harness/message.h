/* SPDX-License-Identifier: BSD-3-Clause */
/* Messages by their key parts, numbers and names, so that a better sentence around them breaks no test. */
#ifndef DEM_TEST_MESSAGE_H
#define DEM_TEST_MESSAGE_H

#include <stdbool.h>

#include <dem/status.h>

#include "harness/test.h"

/** Whether a text has the parts of a pattern, which " * " separates, in their order and as whole words and numbers:
 *  "node 0 * 0.5 m" are parts of "node 0 is 0.5 m below", and not of "node 0 is 10.5 m below". */
bool message_has_parts(const char *text, const char *pattern);

/** Whether a text has as many lines as there are patterns, and each line the parts of its own. A pattern that begins
 *  with a number, the place of a fault such as "3:41" or "22", is one of a line that begins with that place. */
bool message_lines_have_parts(const char *text, const char *patterns);

/** Fails unless each line of a text has the parts of its pattern. */
#define assert_line_parts(text, patterns)                                                                              \
    do {                                                                                                               \
        if (!message_lines_have_parts(text, patterns)) fail_msg("'%s' has not the parts '%s'", text, patterns);        \
    } while (0)

/** Fails unless dem_status_message() has the parts of a pattern. */
#define assert_message_parts(pattern)                                                                                  \
    do {                                                                                                               \
        if (!message_has_parts(dem_status_message(), pattern))                                                         \
            fail_msg("'%s' has not the parts '%s'", dem_status_message(), pattern);                                    \
    } while (0)

#endif
