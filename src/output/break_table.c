/* SPDX-License-Identifier: BSD-3-Clause */
/* The group /breaks: one row for each break, with the columns of docs/output.md. How rows reach the file is in table.c;
 * what breaks is decided in fracture/. */
#include "output/break_table.h"

/* In the order in which break_table_record() fills a row. */
static const table_column columns[] = {
    {"/breaks/t", HDF5_F64, 0, 1},      {"/breaks/x", HDF5_F64, 0, 2},
    {"/breaks/stress", HDF5_F64, 0, 3}, {"/breaks/energy", HDF5_F64, 0, 1},
    {"/breaks/body", HDF5_I64, 0, 1},   {"/breaks/triangle", HDF5_I64, 0, 1},
    {"/breaks/spring", HDF5_I64, 0, 1}, {"/breaks/fragment_new", HDF5_I64, 0, 1},
};

/* A row has one item in every column, so there are no counts. */
dem_status break_table_init(table *out)
{
    return table_init(out, columns, sizeof columns / sizeof columns[0], NULL);
}

/* Reals first, then whole numbers, as the columns are listed. */
void break_table_record(table *t, const dem_break *what)
{
    const double reals[] = {what->t,         what->x[0],      what->x[1],  what->stress[0],
                            what->stress[1], what->stress[2], what->energy};
    const dem_index wholes[] = {what->body, what->triangle, what->spring, what->fragment_new};
    table_cell *cell = table_put_reals(table_add(t), reals, sizeof reals / sizeof reals[0]);
    (void)table_put_wholes(cell, wholes, sizeof wholes / sizeof wholes[0]);
}
