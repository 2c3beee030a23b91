/* SPDX-License-Identifier: BSD-3-Clause */
/* page.html as it was when the program was built. */
#ifndef DEM_PAGE_TEMPLATE_H
#define DEM_PAGE_TEMPLATE_H

/** Terminated. The run's data belong between its two halves. */
extern const char page_template_before[], page_template_behind[];

#endif
