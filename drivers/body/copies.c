/* SPDX-License-Identifier: BSD-3-Clause */
#include "copies.h"

#include <gsl/gsl_rng.h>

#include "gsl_errors.h"

static size_t count(const schema_instance *body, int axis)
{
    return (size_t)schema_reals(body, "copies")[axis];
}

size_t copies_count(const schema_instance *body)
{
    return count(body, 0) * count(body, 1);
}

size_t copies_total(const schema_deck *groups)
{
    size_t n = 0;
    for (size_t k = 0; k < schema_count(groups, "body"); k++) n += copies_count(schema_get(groups, "body", k));
    return n;
}

copies_origin copies_find(const schema_deck *groups, size_t number)
{
    copies_origin at = {0, number};
    for (size_t n; at.copy >= (n = copies_count(schema_get(groups, "body", at.group))); at.group++) at.copy -= n;
    return at;
}

/* ---- checks ---- */

static void check_body(const schema_instance *body, namelist_errors *errors)
{
    const double *copies = schema_reals(body, "copies");
    const bool alone = copies[0] * copies[1] == 1.0;
    static const char *const needs[] = {"pitch", "scatter"};
    if (schema_value_of(body, "copies")->faulty) return;
    if (copies[0] * copies[1] > COPIES_MAX)
        namelist_errors_add(errors, schema_place(body, "copies"), "'copies' in &body make %.0f bodies; the limit is %d",
                            copies[0] * copies[1], COPIES_MAX);
    for (size_t k = 0; k < sizeof needs / sizeof *needs; k++)
        if (alone && schema_given(body, needs[k]))
            namelist_errors_add(errors, schema_place(body, needs[k]), "'%s' in &body is not used without 'copies'",
                                needs[k]);
    if (!alone && !schema_given(body, "pitch") && !schema_value_of(body, "pitch")->faulty)
        namelist_errors_add(errors, body->place, "'pitch' in &body must be given for 'copies'");
    if (!alone && schema_given(body, "clearance"))
        namelist_errors_add(errors, schema_place(body, "clearance"),
                            "'clearance' in &body does not go with 'copies': give 'position'");
}

/* Which copy would be held, or looked at? */
static void check_user(const schema_deck *groups, const schema_instance *user, namelist_errors *errors)
{
    const double number = schema_real(user, "body");
    if (schema_count(groups, "body") == 0 || number < 1.0 || number > (double)schema_count(groups, "body")) return;
    const size_t n = copies_count(schema_get(groups, "body", (size_t)number - 1));
    if (n > 1)
        namelist_errors_add(errors, schema_given(user, "body") ? schema_place(user, "body") : user->place,
                            "&%s is for body %.0f, of which there are %zu copies; write the one that is meant as a "
                            "&body of its own",
                            user->group->name, number, n);
}

void copies_check(const schema_deck *groups, namelist_errors *errors)
{
    for (size_t k = 0; k < schema_count(groups, "body"); k++) check_body(schema_get(groups, "body", k), errors);
    for (size_t k = 0; k < schema_count(groups, "boundary"); k++)
        check_user(groups, schema_get(groups, "boundary", k), errors);
    for (size_t k = 0; k < schema_count(groups, "probe"); k++) {
        const schema_instance *probe = schema_get(groups, "probe", k);
        if (schema_given(probe, "place")) check_user(groups, probe, errors);
    }
}

/* ---- places ---- */

/* The numbers of a copy follow those of the copies before it, so that more rows leave the others where they are. */
static bool scatter(double shift[2], const schema_instance *body, size_t k)
{
    const double most = schema_real(body, "scatter");
    if (!(most > 0.0)) return true;
    gsl_errors_return();
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_errors_restore();
    if (rng == NULL) return false;
    gsl_rng_set(rng, (unsigned long)schema_real(body, "seed"));
    for (size_t draws = 0; draws < 2 * k; draws++) (void)gsl_rng_get(rng);
    for (int c = 0; c < 2; c++) shift[c] += most * (2.0 * gsl_rng_uniform(rng) - 1.0);
    gsl_rng_free(rng);
    return true;
}

bool copies_shift(double shift[2], const schema_instance *body, size_t k)
{
    const double *pitch = schema_reals(body, "pitch");
    const size_t at[2] = {k % count(body, 0), k / count(body, 0)};
    for (int c = 0; c < 2; c++) shift[c] = pitch != NULL ? pitch[c] * (double)at[c] : 0.0;
    return scatter(shift, body, k);
}
