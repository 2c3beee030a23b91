/* SPDX-License-Identifier: BSD-3-Clause */
#include "lammps.h"

#include <string.h>

#include "data.h"
#include "dump.h"
#include "script.h"
#include "sheet.h"

/* LAMMPS keeps tables of the square of this. */
static const dem_index many_types = 2000;

/* What an input of LAMMPS takes as a word. */
static bool can_be_named(const task *t)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._+-";
    if (t->name[strspn(t->name, letters)] == '\0') return true;
    outcome_fail(t->outcome, EXIT_USAGE, "dem_export",
                 "'%s' cannot be a name in LAMMPS: letters, digits, . _ + and -; '-o' gives another", t->name);
    return false;
}

static bool is_free(const task *t)
{
    return sheet_is_free(t, "", ".data") && sheet_is_free(t, "in.", "") && sheet_is_free(t, "", ".dump") &&
           sheet_is_free(t, "", ".local.dump");
}

static bool write_all(const molecule *m)
{
    if (m->omissions[0] != '\0') task_warn(m->task, m->omissions);
    if (m->atoms.n > many_types)
        task_warn(m->task, "so many masses that LAMMPS may not have the memory for a type of each");
    if (!data_write(m) || !script_write(m)) return false;
    return m->task->frames.n == 0 || (dump_atoms(m) && dump_bonds(m));
}

bool lammps_export(const task *t)
{
    molecule m = {0};
    if (!can_be_named(t) || !is_free(t)) return false;
    const bool good = molecule_make(&m, t) && write_all(&m);
    molecule_free(&m);
    return good;
}
