/* SPDX-License-Identifier: BSD-3-Clause */
#include "piece.h"

#include <stdint.h>
#include <string.h>

static const char *const sections[] = {[PIECE_FIELD] = "FieldData",
                                       [PIECE_POINT_DATA] = "PointData",
                                       [PIECE_CELL_DATA] = "CellData",
                                       [PIECE_POINTS] = "Points",
                                       [PIECE_CELLS] = "Cells"};

static const struct form {
    const char *name;
    size_t size;
} forms[] = {[DEM_READER_F64] = {"Float64", 8}, [DEM_READER_F32] = {"Float32", 4}, [DEM_READER_I64] = {"Int64", 8},
             [DEM_READER_I32] = {"Int32", 4},   [DEM_READER_I8] = {"Int8", 1},     [DEM_READER_U8] = {"UInt8", 1}};

void piece_print_text(sheet *s, const char *text)
{
    for (; *text != '\0'; text++) {
        const char *entity = *text == '&' ? "&amp;" : *text == '<' ? "&lt;" : *text == '>' ? "&gt;" : "&quot;";
        if (strchr("&<>\"", *text) != NULL)
            sheet_print(s, "%s", entity);
        else
            sheet_print(s, "%c", *text);
    }
}

/* ---- what there is ---- */

static uint64_t bytes_of(const piece_array *a)
{
    return (uint64_t)a->n * (uint64_t)a->components * forms[a->type].size;
}

static void write_section(sheet *s, const piece *p, piece_section section, uint64_t *offset)
{
    sheet_print(s, "<%s>\n", sections[section]);
    for (dem_index k = 0; k < p->n_arrays; k++) {
        const piece_array *a = &p->arrays[k];
        if (a->section != section) continue;
        sheet_print(s, "<DataArray type=\"%s\" Name=\"", forms[a->type].name);
        piece_print_text(s, a->name);
        sheet_print(s, "\" NumberOfComponents=\"%d\"", a->components);
        if (section == PIECE_FIELD) sheet_print(s, " NumberOfTuples=\"%lld\"", (long long)a->n);
        sheet_print(s, " format=\"appended\" offset=\"%llu\"/>\n", (unsigned long long)*offset);
        *offset += sizeof(uint64_t) + bytes_of(a);
    }
    sheet_print(s, "</%s>\n", sections[section]);
}

static void write_head(sheet *s, const piece *p)
{
    const uint16_t one = 1;
    uint64_t offset = 0;
    sheet_print(s,
                "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"%s\" "
                "header_type=\"UInt64\">\n<UnstructuredGrid>\n",
                *(const unsigned char *)&one == 1 ? "LittleEndian" : "BigEndian");
    write_section(s, p, PIECE_FIELD, &offset);
    sheet_print(s, "<Piece NumberOfPoints=\"%lld\" NumberOfCells=\"%lld\">\n", (long long)p->n_points,
                (long long)p->n_cells);
    for (int section = PIECE_FIELD + 1; section < PIECE_SECTIONS; section++)
        write_section(s, p, (piece_section)section, &offset);
    sheet_print(s, "</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_");
}

/* ---- its numbers ---- */

static void write_number(sheet *s, double value, dem_reader_type type)
{
    const float single = (float)value;
    const int64_t large = type == DEM_READER_I64 ? (int64_t)value : 0;
    const int32_t whole = type == DEM_READER_I32 ? (int32_t)value : 0;
    const int8_t small = type == DEM_READER_I8 ? (int8_t)value : 0;
    const uint8_t byte = type == DEM_READER_U8 ? (uint8_t)value : 0;
    const void *forms_of_it[] = {[DEM_READER_F64] = &value, [DEM_READER_F32] = &single, [DEM_READER_I64] = &large,
                                 [DEM_READER_I32] = &whole, [DEM_READER_I8] = &small,   [DEM_READER_U8] = &byte};
    sheet_write(s, forms_of_it[type], forms[type].size);
}

static bool write_array(sheet *s, const task *t, const piece *p, const piece_array *a)
{
    const uint64_t bytes = bytes_of(a);
    const double *values = a->values != NULL ? a->values : p->scratch;
    if (a->values == NULL && !task_holds(t, dem_reader_read(t->reader, a->what, p->frame, p->scratch))) return false;
    sheet_write(s, &bytes, sizeof bytes);
    for (dem_index k = 0; k < a->n * a->components; k++) write_number(s, values[k], a->type);
    return true;
}

bool piece_write(const task *t, const char *behind, const piece *p)
{
    sheet s;
    bool good = true;
    if (!sheet_open(&s, t, "", behind)) return false;
    write_head(&s, p);
    for (int section = 0; section < PIECE_SECTIONS; section++)
        for (dem_index k = 0; good && k < p->n_arrays; k++)
            if (p->arrays[k].section == (piece_section)section) good = write_array(&s, t, p, &p->arrays[k]);
    sheet_print(&s, "\n</AppendedData>\n</VTKFile>\n");
    return sheet_close(&s, good);
}
