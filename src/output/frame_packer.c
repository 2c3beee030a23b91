/* SPDX-License-Identifier: BSD-3-Clause */
/* A portion has for each array, in their order, and from a multiple of eight bytes on,
 *   packed   a note of each section, plane by plane, in each of them slice by slice; behind them all their bytes
 *   plain    the rows, as they are in memory. */
#include "output/frame_packer.h"

#include <stdlib.h>
#include <string.h>

#include "base/grow.h"
#include "base/status.h"

/* Of a section. */
typedef struct note {
    size_t size, n_packed;
    uint64_t checksum;
} note;

static size_t align(size_t bytes)
{
    return (bytes + 7) / 8 * 8;
}

/* Whether a field has rows of an array. */
static bool has(const field_arrays *a, int array)
{
    return frame_arrays_is_wanted(&a->frames, array) && frame_arrays_count(&a->frames, frame_arrays_of(array)) > 0;
}

bool frame_packer_packs(const field_arrays *a)
{
    const hdf5_rows rows = frame_arrays_rows(&a->frames, a->end - 1);
    return hdf5_packs(&rows);
}

hsize_t frame_packer_bytes(const field_arrays *a)
{
    hsize_t bytes = 0;
    for (int k = a->first; k < a->end; k++)
        if (has(a, k)) bytes += (hsize_t)frame_arrays_count(&a->frames, frame_arrays_of(k)) * frame_arrays_row_bytes(k);
    return bytes;
}

static int planes_of(const hdf5_rows *rows)
{
    return deflater_planes(hdf5_numbers(rows, rows->chunk, NULL));
}

static int slices_of(const field_portion *portion)
{
    return (int)((portion->n + ROWS_CHUNK - 1) / ROWS_CHUNK);
}

/* Row of the file at which the frame begins. */
static hsize_t first_row(const field_arrays *a, const hdf5_rows *rows)
{
    return (hsize_t)a->frames.n * rows->chunk;
}

/* ---- making ---- */

static dem_status make_room(unsigned char **bytes, dem_index *room, size_t needed)
{
    CHECK(grow_array((void **)bytes, room, (dem_index)needed, 1), DEM_ERROR_MEMORY,
          "out of memory for %zu bytes of a frame", needed);
    return DEM_OK;
}

static dem_status extend(frame_packer *p, const field_portion *portion, size_t more)
{
    return make_room(&p->portion, &p->portion_room, portion->size + align(more));
}

static dem_status add_packed(frame_packer *p, field_portion *portion)
{
    const deflater *d = &p->deflater;
    const int n = d->n_planes * d->n_slices;
    size_t bytes = (size_t)n * sizeof(note);
    for (int k = 0; k < n; k++) bytes += d->sections[k].n_packed;
    TRY(extend(p, portion, bytes));
    note *notes = (note *)(void *)(p->portion + portion->size);
    unsigned char *to = (unsigned char *)(notes + n);
    for (int k = 0; k < n; k++) {
        const section *s = &d->sections[k];
        notes[k] = (note){s->size, s->n_packed, s->checksum};
        memcpy(to, s->packed, s->n_packed);
        to += s->n_packed;
    }
    portion->size += align(bytes);
    return DEM_OK;
}

static dem_status add_plain(frame_packer *p, field_portion *portion, const void *data, size_t bytes)
{
    TRY(extend(p, portion, bytes));
    memcpy(p->portion + portion->size, data, bytes);
    portion->size += align(bytes);
    return DEM_OK;
}

static dem_status add_array(frame_packer *p, const field_arrays *a, int array, const void *of_field,
                            field_portion *portion, team *t)
{
    const hdf5_rows rows = frame_arrays_rows(&a->frames, array);
    const size_t bytes = (size_t)portion->n * frame_arrays_row_bytes(array);
    TRY(make_room(&p->converted, &p->converted_room, bytes));
    const void *data = frame_arrays_convert(array, portion->n, of_field, p->converted);
    if (!hdf5_packs(&rows)) return add_plain(p, portion, data, bytes);
    const deflater_numbers numbers = hdf5_numbers(&rows, (hsize_t)portion->n, data);
    TRY(deflater_pack(&p->deflater, numbers, planes_of(&rows), rows.deflate, t));
    return add_packed(p, portion);
}

dem_status frame_packer_make(frame_packer *p, const field_arrays *a, const void *rows, field_portion *portion, team *t)
{
    portion->size = 0;
    for (int k = a->first; k < a->end; k++)
        if (has(a, k)) TRY(add_array(p, a, k, rows, portion, t));
    portion->bytes = p->portion;
    return DEM_OK;
}

/* ---- taking ---- */

dem_status frame_packer_begin(frame_packer *p, const field_arrays *a, int n_shares)
{
    for (int k = a->first; k < a->end; k++) {
        const hdf5_rows rows = frame_arrays_rows(&a->frames, k);
        if (has(a, k)) TRY(deflated_chunk_begin(&p->chunks[k], planes_of(&rows), n_shares));
    }
    return DEM_OK;
}

/* \param[in,out] from  where they are; behind them */
static dem_status take_sections(deflated_chunk *c, const field_portion *portion, const unsigned char **from)
{
    const int n = c->n_planes * slices_of(portion);
    const note *notes = (const note *)(const void *)*from;
    const unsigned char *bytes = (const unsigned char *)(notes + n);
    section *sections = calloc((size_t)n, sizeof *sections);
    CHECK_MEMORY(sections);
    for (int k = 0; k < n; k++) {
        sections[k] = (section){.size = notes[k].size,
                                .packed = (unsigned char *)(uintptr_t)bytes,
                                .n_packed = notes[k].n_packed,
                                .checksum = (uint32_t)notes[k].checksum};
        bytes += notes[k].n_packed;
    }
    const dem_status status = deflated_chunk_add(c, portion->share, sections, slices_of(portion));
    free(sections);
    *from += align((size_t)(bytes - *from));
    return status;
}

dem_status frame_packer_take(frame_packer *p, const field_arrays *a, const field_portion *portion)
{
    const unsigned char *from = portion->bytes;
    for (int k = a->first; k < a->end; k++)
        if (has(a, k)) TRY(take_sections(&p->chunks[k], portion, &from));
    return DEM_OK;
}

static dem_status write_chunk(deflated_chunk *c, const field_arrays *a, const hdf5_file *file, const hdf5_rows *rows)
{
    dem_status status = deflated_chunk_end(c);
    if (status == DEM_OK) status = hdf5_append_packed(file, rows, first_row(a, rows), &c->all);
    deflated_chunk_free(c);
    return status;
}

dem_status frame_packer_end(frame_packer *p, const field_arrays *a, const hdf5_file *file)
{
    for (int k = a->first; k < a->end; k++) {
        const hdf5_rows rows = frame_arrays_rows(&a->frames, k);
        if (p->chunks[k].n_planes > 0) TRY(write_chunk(&p->chunks[k], a, file, &rows));
    }
    return DEM_OK;
}

/* ---- plain rows ---- */

dem_status frame_packer_extend(const field_arrays *a, const hdf5_file *file)
{
    for (int k = a->first; k < a->end; k++) {
        const hdf5_rows rows = frame_arrays_rows(&a->frames, k);
        if (has(a, k)) TRY(hdf5_extend(file, &rows, first_row(a, &rows) + rows.chunk));
    }
    return DEM_OK;
}

dem_status frame_packer_put(const field_arrays *a, const hdf5_file *file, const field_portion *portion)
{
    const unsigned char *from = portion->bytes;
    for (int k = a->first; k < a->end; k++) {
        const hdf5_rows rows = frame_arrays_rows(&a->frames, k);
        if (!has(a, k)) continue;
        TRY(hdf5_put(file, &rows, first_row(a, &rows) + (hsize_t)portion->first, (hsize_t)portion->n, from));
        from += align((size_t)portion->n * frame_arrays_row_bytes(k));
    }
    return DEM_OK;
}

void frame_packer_free(frame_packer *p)
{
    deflater_free(&p->deflater);
    for (int k = 0; k < FRAME_ARRAYS; k++) deflated_chunk_free(&p->chunks[k]);
    free(p->converted);
    free(p->portion);
    *p = (frame_packer){0};
}
