/* SPDX-License-Identifier: BSD-3-Clause */
/* Any bytes may come as a PNG image. Its checksums are made right, so that more than they are tested. One that is
 * accepted has the size that it states, and no pixel beyond white. */
#include "png.h"

#include "bytes.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static uint32_t crc(const uint8_t *at, size_t n)
{
    uint32_t sum = UINT32_MAX;
    for (size_t k = 0; k < n; k++) {
        sum ^= at[k];
        for (int bit = 0; bit < 8; bit++) sum = sum >> 1 ^ (sum & 1 ? UINT32_C(0xedb88320) : 0);
    }
    return ~sum;
}

static size_t number(const uint8_t *at)
{
    return (size_t)at[0] << 24 | (size_t)at[1] << 16 | (size_t)at[2] << 8 | at[3];
}

/* Chunks: length, name, content, checksum of name and content. */
static void mend(uint8_t *file, size_t size)
{
    for (size_t at = 8; at + 12 <= size && number(file + at) <= size - at - 12;) {
        const size_t length = number(file + at);
        const uint32_t sum = crc(file + at + 4, length + 4);
        for (int k = 0; k < 4; k++) file[at + 8 + length + (size_t)k] = (uint8_t)(sum >> (24 - 8 * k));
        at += length + 12;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    image picture;
    char fault[IMAGE_FAULT] = "";
    uint8_t *copy = malloc(size + 1);
    require(copy != NULL);
    if (size > 0) memcpy(copy, data, size);
    mend(copy, size);
    const image_status status = png_parse(&picture, fault, (const char *)copy, size);
    if (status == IMAGE_READ) {
        require(picture.width == number(copy + 16) && picture.height == number(copy + 20));
        require(picture.width * picture.height <= PNG_MAX_PIXELS && picture.white == 255);
        for (size_t k = 0; k < picture.width * picture.height; k++) require(picture.grey[k] <= picture.white);
    } else {
        require(picture.grey == NULL && fault[0] != '\0');
    }
    image_free(&picture);
    free(copy);
    return 0;
}
