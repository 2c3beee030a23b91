/* SPDX-License-Identifier: BSD-3-Clause */
#include "gsl_errors.h"

#include <pthread.h>

#include <gsl/gsl_errno.h>

static pthread_mutex_t turn = PTHREAD_MUTEX_INITIALIZER;
static gsl_error_handler_t *before; /* of who has the turn */

void gsl_errors_return(void)
{
    (void)pthread_mutex_lock(&turn);
    before = gsl_set_error_handler_off();
}

void gsl_errors_restore(void)
{
    (void)gsl_set_error_handler(before);
    (void)pthread_mutex_unlock(&turn);
}
