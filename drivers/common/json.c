/* SPDX-License-Identifier: BSD-3-Clause */
#include "json.h"

#include <inttypes.h>
#include <math.h>

#include "decimal.h"
#include "utf8.h"

static void write_string(FILE *out, const char *text)
{
    (void)fputc('"', out);
    while (*text != '\0') {
        const size_t n = utf8_plain_length(text);
        const unsigned char c = (unsigned char)*text;
        if (c == '"' || c == '\\')
            (void)fprintf(out, "\\%c", c);
        else if (c < 0x20 || c == 0x7f)
            (void)fprintf(out, "\\u%04x", c);
        else if (n == 0)
            (void)fputs("\\ufffd", out);
        else
            (void)fwrite(text, 1, n, out);
        text += n > 0 ? n : 1;
    }
    (void)fputc('"', out);
}

static void begin(json *j, const char *key)
{
    if (j->inner) (void)fputc(',', j->out);
    j->inner = true;
    if (key == NULL) return;
    write_string(j->out, key);
    (void)fputc(':', j->out);
}

void json_open(json *j, const char *key, char bracket)
{
    begin(j, key);
    (void)fputc(bracket, j->out);
    j->inner = false;
}

void json_close(json *j, char bracket)
{
    (void)fputc(bracket, j->out);
    j->inner = true;
}

void json_text(json *j, const char *key, const char *text)
{
    begin(j, key);
    if (text == NULL)
        (void)fputs("null", j->out);
    else
        write_string(j->out, text);
}

void json_real(json *j, const char *key, double x)
{
    char number[DECIMAL_SIZE] = "null";
    if (isfinite(x)) decimal_print(number, x);
    begin(j, key);
    (void)fputs(number, j->out);
}

void json_reals(json *j, const char *key, const double *x, int n)
{
    json_open(j, key, '[');
    for (int k = 0; k < n; k++) json_real(j, NULL, x[k]);
    json_close(j, ']');
}

void json_integer(json *j, const char *key, int64_t n)
{
    begin(j, key);
    (void)fprintf(j->out, "%" PRId64, n);
}

void json_truth(json *j, const char *key, bool value)
{
    begin(j, key);
    (void)fputs(value ? "true" : "false", j->out);
}
