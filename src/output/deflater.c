/* SPDX-License-Identifier: BSD-3-Clause */
/* Shuffled, the first bytes of all numbers stand one behind the other, then their second bytes, and so on. */
#include "output/deflater.h"

#include "base/status.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

static void shuffle_8(unsigned char *out, const unsigned char *data, size_t n)
{
    for (size_t k = 0; k < n; k++) {
        uint64_t bits;
        memcpy(&bits, data + 8 * k, sizeof bits);
        for (int b = 0; b < 8; b++) out[(size_t)b * n + k] = (unsigned char)(bits >> 8 * b);
    }
}

static void put_4(unsigned char *out, size_t n, size_t k, uint32_t bits)
{
    for (int b = 0; b < 4; b++) out[(size_t)b * n + k] = (unsigned char)(bits >> 8 * b);
}

static void shuffle_4(unsigned char *out, const unsigned char *data, size_t n)
{
    for (size_t k = 0; k < n; k++) {
        uint32_t bits;
        memcpy(&bits, data + 4 * k, sizeof bits);
        put_4(out, n, k, bits);
    }
}

static void shuffle_narrowed(unsigned char *out, const double *data, size_t n)
{
    for (size_t k = 0; k < n; k++) {
        const float value = (float)data[k];
        uint32_t bits;
        memcpy(&bits, &value, sizeof bits);
        put_4(out, n, k, bits);
    }
}

/* HDF5 leaves single bytes as they are. */
static void shuffle(unsigned char *out, deflater_numbers m)
{
    if (m.narrows)
        shuffle_narrowed(out, m.data, m.count);
    else if (m.width == 8)
        shuffle_8(out, m.data, m.count);
    else if (m.width == 4)
        shuffle_4(out, m.data, m.count);
    else
        memcpy(out, m.data, m.count);
}

/* Room for so many bytes; what was there is lost. */
static dem_status make_room(unsigned char **buffer, size_t *room, size_t bytes)
{
    if (bytes <= *room) return DEM_OK;
    free(*buffer);
    *room = 0;
    *buffer = malloc(bytes);
    CHECK_MEMORY(*buffer);
    *room = bytes;
    return DEM_OK;
}

static void end(deflater *d)
{
    if (d->stream != NULL) (void)deflateEnd(d->stream);
    free(d->stream);
    d->stream = NULL;
}

static dem_status begin(deflater *d, int level)
{
    enum { WINDOW = 15, MEMORY = 8 }; /* zlib's defaults */
    if (d->stream != NULL && d->level == level) return DEM_OK;
    end(d);
    d->stream = calloc(1, sizeof *d->stream);
    CHECK_MEMORY(d->stream);
    const bool begun = deflateInit2(d->stream, level, Z_DEFLATED, WINDOW, MEMORY, Z_DEFAULT_STRATEGY) == Z_OK;
    if (!begun) end(d);
    CHECK(begun, DEM_ERROR_MEMORY, "out of memory to deflate");
    d->level = level;
    return DEM_OK;
}

/* Whether most sequences of four bytes come again, as those of a lattice at rest do row by row. Of computed numbers
 * some do, beside the zeros of the third direction. */
static bool repeats(const unsigned char *bytes, size_t n)
{
    enum { LOOK = 16384, SLOTS = 4096 };
    const size_t end = n < LOOK ? n : LOOK;
    uint32_t seen[SLOTS] = {0}, four;
    size_t again = 0;
    for (size_t k = 0; k + sizeof four <= end; k++) {
        memcpy(&four, bytes + k, sizeof four);
        uint32_t *slot = &seen[four * 2654435761u >> 20];
        again += *slot == four;
        *slot = four;
    }
    return 2 * again > end;
}

/* At level 1 the bytes in the middle of the numbers tell whether more is to be found than runs of equal bytes. */
static int strategy_of(const deflater *d, deflater_numbers numbers)
{
    const unsigned char *middle = d->shuffled + numbers.width / 2 * numbers.count;
    return d->level > 1 || repeats(middle, numbers.count) ? Z_DEFAULT_STRATEGY : Z_RLE;
}

/* The room is what a stream of so many bytes can take at most, so that one call is enough. */
dem_status deflater_pack(deflater *d, deflater_numbers numbers, int level)
{
    const size_t bytes = numbers.count * numbers.width;
    TRY(begin(d, level));
    TRY(make_room(&d->shuffled, &d->room, bytes));
    TRY(make_room(&d->packed, &d->packed_room, deflateBound(d->stream, bytes)));
    shuffle(d->shuffled, numbers);
    (void)deflateReset(d->stream);
    d->stream->next_in = d->shuffled;
    d->stream->avail_in = (uInt)bytes;
    d->stream->next_out = d->packed;
    d->stream->avail_out = (uInt)d->packed_room;
    (void)deflateParams(d->stream, level, strategy_of(d, numbers));
    CHECK(deflate(d->stream, Z_FINISH) == Z_STREAM_END, DEM_ERROR_IO, "%zu bytes cannot be deflated", bytes);
    d->n_packed = d->stream->total_out;
    return DEM_OK;
}

void deflater_free(deflater *d)
{
    end(d);
    free(d->shuffled);
    free(d->packed);
    *d = (deflater){0};
}
