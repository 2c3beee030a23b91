/* SPDX-License-Identifier: BSD-3-Clause */
/* piece.c: the XML, and the numbers at the places that it names. Read by VTK in tests/deck/test_export.py. */
#include "unit/drivers/export/exported.h"

#include "piece.h"

TEST(arrays_stand_where_the_head_says)
{
    static const double points[6] = {0.0, 1.0, 0.0, 2.0, 3.0, 0.0}, ends[2] = {0.0, 1.0}, two = 2.0, type = 3.0;
    static const double sizes[2] = {0.5, -7.0};
    const piece_array arrays[] = {{PIECE_CELLS, "connectivity", DEM_READER_I64, 1, 2, ends, NULL},
                                  {PIECE_CELLS, "offsets", DEM_READER_I32, 1, 1, &two, NULL},
                                  {PIECE_CELLS, "types", DEM_READER_U8, 1, 1, &type, NULL},
                                  {PIECE_POINTS, "Points", DEM_READER_F64, 3, 2, points, NULL},
                                  {PIECE_POINT_DATA, "a<b", DEM_READER_F32, 1, 2, sizes, NULL},
                                  {PIECE_FIELD, "t", DEM_READER_I8, 1, 1, &sizes[1], NULL}};
    const piece p = {.n_points = 2, .n_cells = 1, .n_arrays = 6, .arrays = arrays};
    CLEANUP(exported_close) exported e;
    exported_open(&e, exported_usual());
    assert_true(piece_write(&e.task, ".vtu", &p));
    exported_expect(
        &e, "run.vtu",
        "<FieldData>\n<DataArray type=\"Int8\" Name=\"t\" NumberOfComponents=\"1\" NumberOfTuples=\"1\" "
        "format=\"appended\" offset=\"0\"/>\n</FieldData>\n<Piece NumberOfPoints=\"2\" NumberOfCells=\"1\">\n"
        "<PointData>\n<DataArray type=\"Float32\" Name=\"a&lt;b\" NumberOfComponents=\"1\" "
        "format=\"appended\" offset=\"9\"/>\n</PointData>\n<CellData>\n</CellData>\n<Points>\n");
    exported_expect(&e, "run.vtu", "Name=\"Points\" NumberOfComponents=\"3\" format=\"appended\" offset=\"25\"/>");
    exported_expect(&e, "run.vtu", "Name=\"types\" NumberOfComponents=\"1\" format=\"appended\" offset=\"117\"/>");
    const char *data = strstr(e.text, "encoding=\"raw\">\n_");
    assert_non_null(data);
    data += strlen("encoding=\"raw\">\n_");
    uint64_t size;
    float single[2];
    double whole[6];
    memcpy(&size, data + 9, sizeof size);
    memcpy(single, data + 17, sizeof single);
    assert_int_equal(size, 8);
    assert_true(single[0] == 0.5F && single[1] == -7.0F);
    memcpy(whole, data + 33, sizeof whole);
    assert_memory_equal(whole, points, sizeof whole);
    assert_int_equal((signed char)data[8], -7);
    assert_int_equal(data[125], 3);
    assert_memory_equal(data + 126, "\n</AppendedData>", 16);
}
