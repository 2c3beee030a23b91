/* SPDX-License-Identifier: BSD-3-Clause */
/* By the rows of triangles at nodes, and of shares of springs. */
#include "fracture/stress_nodes.h"

void stress_nodes_visit(const dem_model *model, const element_state *e, dem_index i, stress_nodes_visitor *visit,
                        void *context)
{
    const stress_rows *r = model->stress.rows;
    visit(context, i);
    for (dem_index p = e->at_row[i]; p < e->at_row[i + 1]; p++)
        for (int c = 0; c < 3; c++) visit(context, e->lattice->triangles[3 * e->at[p] + c]);
    for (dem_index p = r->row[i]; p < r->row[i + 1]; p++)
        for (int end = 0; end < 2; end++) visit(context, e->lattice->ends[2 * r->spring[p] + end]);
}
