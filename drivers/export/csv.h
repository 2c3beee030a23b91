/* SPDX-License-Identifier: BSD-3-Clause */
/* Tables as RFC 4180 has them: nodes and springs with a row for each in each frame, and every table of the run. */
#ifndef DEM_CSV_H
#define DEM_CSV_H

#include "task.h"

/** False, and the outcome, if it fails. */
bool csv_export(const task *t);

#endif
