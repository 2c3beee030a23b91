/* SPDX-License-Identifier: BSD-3-Clause */
/* base64.c: against the examples of RFC 4648, and numbers written out by hand. */
#include "unit/close.h"

#include <stdlib.h>
#include <string.h>

#include "base64.h"

typedef struct text {
    char *bytes;
    size_t size;
    base64 letters;
} text;

static void begin(text *t)
{
    *t = (text){0};
    t->letters.out = open_memstream(&t->bytes, &t->size);
    assert_non_null(t->letters.out);
}

static void expect(text *t, const char *expected)
{
    base64_end(&t->letters);
    assert_int_equal(fclose(t->letters.out), 0);
    assert_string_equal(t->bytes, expected);
    free(t->bytes);
}

TEST(letters_are_those_of_the_standard)
{
    static const char *const pairs[][2] = {{"", ""},
                                           {"f", "Zg=="},
                                           {"fo", "Zm8="},
                                           {"foo", "Zm9v"},
                                           {"foob", "Zm9vYg=="},
                                           {"fooba", "Zm9vYmE="},
                                           {"foobar", "Zm9vYmFy"}};
    for (size_t k = 0; k < sizeof pairs / sizeof *pairs; k++) {
        text t;
        begin(&t);
        for (const char *c = pairs[k][0]; *c != '\0'; c++) base64_whole(&t.letters, (unsigned char)*c, 1);
        assert_close(base64_length((double)strlen(pairs[k][0])), (double)strlen(pairs[k][1]), 0.0);
        expect(&t, pairs[k][1]);
    }
}

/* The bytes fb ff fe, and 62 and 63 among the letters. */
TEST(the_lowest_byte_comes_first)
{
    text t;
    begin(&t);
    base64_whole(&t.letters, 0xfefffb, 3);
    expect(&t, "+//+");
    begin(&t);
    base64_whole(&t.letters, 0x0201, 2);
    base64_whole(&t.letters, 0x06050403, 4);
    expect(&t, "AQIDBAUG");
}

/* 1 is 00 00 80 3f, and 00 00 00 00 00 00 f0 3f. */
TEST(reals_are_those_of_ieee_754)
{
    text t;
    begin(&t);
    base64_single(&t.letters, 1.0F);
    expect(&t, "AACAPw==");
    begin(&t);
    base64_real(&t.letters, 1.0);
    expect(&t, "AAAAAAAA8D8=");
}
