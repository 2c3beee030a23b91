/* SPDX-License-Identifier: BSD-3-Clause */
/* GSL ends the process where memory runs out, unless its handler of errors is taken away. */
#ifndef DEM_GSL_ERRORS_H
#define DEM_GSL_ERRORS_H

/** Between the two GSL returns its errors. What is set is the process's, so threads take turns; afterwards it is as it
 *  was before. */
void gsl_errors_return(void);
void gsl_errors_restore(void);

#endif
