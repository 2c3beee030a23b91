/* SPDX-License-Identifier: BSD-3-Clause */
/* Whether mpirun, mpiexec or srun has started several processes of this program: ranks, or copies, which would write
 * one output. */
#ifndef DEM_LAUNCHER_H
#define DEM_LAUNCHER_H

#include <stdbool.h>

/** What the environment says of the launcher that started this process. */
typedef struct launcher {
    const char *variable; /* that says so; NULL: there is no launcher that is known */
    long processes;       /* at least so many */
    bool reports;         /* this one speaks for all of them */
} launcher;

/** Of launchers within each other, as mpirun in a job of Slurm's, that of MPI decides. */
launcher launcher_find(void);

/** Whether the environment tells all processes how many there are, so that all of them know of each other. */
bool launcher_knows_all(const launcher *l);

/** Whether standard output is a terminal that the launcher has made, whatever its own is: a file, too. */
bool launcher_makes_terminal(const launcher *l);

/** Launchers end all processes when one of them fails: those that do not report let the one that does be the first, and
 *  wait for two seconds. */
void launcher_let_report(const launcher *l);

#endif
