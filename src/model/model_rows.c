/* SPDX-License-Identifier: BSD-3-Clause */
/* A model whose forces nobody computes, as that of the whole on a rank that leads a run, can do without what they are
 * computed with until somebody does. */
#include "base/status.h"
#include "model/breakable_nodes.h"
#include "model/model.h"

dem_status model_rows_compile(dem_model *m)
{
    TRY(springs_compile(&m->springs, &m->lattice));
    TRY(csr_view_create(&m->csr, &m->springs));
    TRY(triangles_compile(&m->triangles, &m->lattice));
    TRY(couplings_compile(&m->couplings, &m->lattice, &m->springs));
    return layout_compile(&m->layout, &m->springs, &m->triangles, &m->couplings);
}

void model_rows_free(dem_model *m)
{
    csr_view_free(m->csr);
    m->csr = NULL;
    springs_free(&m->springs);
    triangles_free(&m->triangles);
    couplings_free(&m->couplings);
    layout_free(&m->layout);
}

/* Shares in stresses are made from them. */
void model_rows_give_up(const dem_model *m)
{
    dem_model *own = (dem_model *)(uintptr_t)m;
    if (m->lacks_rows || breakable_lattice(&m->lattice)) return;
    stress_forget(&m->stress);
    model_rows_free(own);
    own->lacks_rows = true;
}

dem_status model_rows_renew(const dem_model *m)
{
    dem_model *own = (dem_model *)(uintptr_t)m;
    if (!m->lacks_rows) return DEM_OK;
    const dem_status status = model_rows_compile(own);
    if (status != DEM_OK) model_rows_free(own);
    own->lacks_rows = status != DEM_OK;
    return status;
}
