/* SPDX-License-Identifier: BSD-3-Clause */
/* Springs by rows as dem_csr shows them: with numbers of 64 bits, and what each spring has in every slot. Nothing is
 * computed from it, so it is made when it is first asked for. */
#ifndef DEM_MODEL_CSR_VIEW_H
#define DEM_MODEL_CSR_VIEW_H

#include "elastic/springs.h"

typedef struct csr_view csr_view;

/** Of springs that stay where they are, borrowed. Free with csr_view_free().  \return DEM_ERROR_MEMORY */
dem_status csr_view_create(csr_view **out, const springs *s);
void csr_view_free(csr_view *v);

/** From several threads at once, too.  \return DEM_ERROR_MEMORY */
dem_status csr_view_show(csr_view *v, dem_csr *out);

#endif
