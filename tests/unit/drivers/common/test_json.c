/* SPDX-License-Identifier: BSD-3-Clause */
/* json.c: against texts written by hand from RFC 8259. */
#include "unit/close.h"

#include <math.h>
#include <stdlib.h>

#include "json.h"

typedef struct text {
    char *bytes;
    size_t size;
    json json;
} text;

static void begin(text *t)
{
    *t = (text){0};
    t->json.out = open_memstream(&t->bytes, &t->size);
    assert_non_null(t->json.out);
}

static void expect(text *t, const char *expected)
{
    assert_int_equal(fclose(t->json.out), 0);
    assert_string_equal(t->bytes, expected);
    free(t->bytes);
}

TEST(values_stand_in_objects_and_arrays)
{
    const double pair[] = {0.5, -2.0};
    text t;
    begin(&t);
    json_open(&t.json, NULL, '{');
    json_integer(&t.json, "n", INT64_MIN);
    json_open(&t.json, "empty", '[');
    json_close(&t.json, ']');
    json_reals(&t.json, "x", pair, 2);
    json_open(&t.json, "o", '{');
    json_close(&t.json, '}');
    json_open(&t.json, "list", '[');
    json_open(&t.json, NULL, '{');
    json_text(&t.json, "a", "b");
    json_close(&t.json, '}');
    json_text(&t.json, NULL, NULL);
    json_close(&t.json, ']');
    json_close(&t.json, '}');
    expect(&t, "{\"n\":-9223372036854775808,\"empty\":[],\"x\":[0.5,-2],\"o\":{},\"list\":[{\"a\":\"b\"},null]}");
}

TEST(what_is_not_finite_is_null)
{
    const double x[] = {(double)INFINITY, -(double)INFINITY, (double)NAN, -0.0, 1e-300};
    text t;
    begin(&t);
    json_reals(&t.json, NULL, x, 5);
    expect(&t, "[null,null,null,-0.0,1e-300]");
}

TEST(truths_are_words)
{
    text t;
    begin(&t);
    json_open(&t.json, NULL, '{');
    json_truth(&t.json, "a", true);
    json_truth(&t.json, "b", false);
    json_close(&t.json, '}');
    expect(&t, "{\"a\":true,\"b\":false}");
}

static void expect_escaped(const char *from, const char *expected)
{
    text t;
    begin(&t);
    json_text(&t.json, NULL, from);
    expect(&t, expected);
}

TEST(strings_are_escaped)
{
    expect_escaped("", "\"\"");
    expect_escaped("a\"b\\c/", "\"a\\\"b\\\\c/\"");
    expect_escaped("\x01\t\r\n\r\x1f\x7f", "\"\\u0001\\u0009\\u000d\\u000a\\u000d\\u001f\\u007f\"");
    expect_escaped("\xce\xb1\xf0\x9f\x98\x80", "\"\xce\xb1\xf0\x9f\x98\x80\"");
    expect_escaped("\xff\xce", "\"\\ufffd\\ufffd\"");
}
