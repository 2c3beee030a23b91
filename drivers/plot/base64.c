/* SPDX-License-Identifier: BSD-3-Clause */
#include "base64.h"

#include <math.h>
#include <string.h>

static void flush(base64 *b)
{
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const uint32_t bits = (uint32_t)b->kept[0] << 16 | (uint32_t)b->kept[1] << 8 | b->kept[2];
    const char four[4] = {letters[bits >> 18], letters[bits >> 12 & 63], b->n > 1 ? letters[bits >> 6 & 63] : '=',
                          b->n > 2 ? letters[bits & 63] : '='};
    (void)fwrite(four, 1, sizeof four, b->out);
    memset(b->kept, 0, sizeof b->kept);
    b->n = 0;
}

void base64_whole(base64 *b, uint64_t number, int bytes)
{
    for (; bytes > 0; bytes--, number >>= 8) {
        b->kept[b->n++] = (unsigned char)(number & 0xff);
        if (b->n == 3) flush(b);
    }
}

void base64_single(base64 *b, float number)
{
    uint32_t bits;
    memcpy(&bits, &number, sizeof bits);
    base64_whole(b, bits, sizeof bits);
}

void base64_real(base64 *b, double number)
{
    uint64_t bits;
    memcpy(&bits, &number, sizeof bits);
    base64_whole(b, bits, sizeof bits);
}

void base64_end(base64 *b)
{
    if (b->n > 0) flush(b);
}

double base64_length(double bytes)
{
    return 4.0 * ceil(bytes / 3.0);
}
