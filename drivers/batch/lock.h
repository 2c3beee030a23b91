/* SPDX-License-Identifier: BSD-3-Clause */
/* A file that only one run at a time holds locked: NAME.lock against a second one of the same output. The system lets
 * go of it however the process ends. */
#ifndef DEM_LOCK_H
#define DEM_LOCK_H

#include <stddef.h>
#include <sys/types.h>

typedef enum lock_status {
    LOCK_HELD,  /* by us, or by nobody where the file system has no locks */
    LOCK_TAKEN, /* by another process, or thread */
    LOCK_FAILED /* the file cannot be created or locked */
} lock_status;

/** To be set to {.file = -1}. */
typedef struct lock {
    int file; /* -1: not held */
    char path[4096];
    struct lock *next; /* that the same process holds */
    dev_t device;
    ino_t inode;
    pid_t process;
} lock;

/** \param l         stays where it is as long as it is held
 *  \param[out] why  [size] who holds it, or what failed */
lock_status lock_take(lock *l, const char *path, char *why, size_t size);

/** Removes the file and lets go, if it is held. */
void lock_release(lock *l);

/** Removes a file that a process has left behind which was killed. */
void lock_clear(const char *path);

#endif
