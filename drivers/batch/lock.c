/* SPDX-License-Identifier: BSD-3-Clause */
#include "lock.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { HOST = 256 };

/* Locks of the system are those of a process: they keep out no thread of it, and all of a file go where any descriptor
 * of it is closed. So a process does not open again what it holds. A process that is forked holds nothing. */
static pthread_mutex_t turn = PTHREAD_MUTEX_INITIALIZER;
static lock *ours;

static bool is_ours(const char *path)
{
    struct stat named;
    if (stat(path, &named) != 0) return false;
    for (const lock *l = ours; l != NULL; l = l->next)
        if (l->device == named.st_dev && l->inode == named.st_ino && l->process == getpid()) return true;
    return false;
}

static void note(lock *l)
{
    struct stat taken;
    if (fstat(l->file, &taken) != 0) return;
    l->device = taken.st_dev;
    l->inode = taken.st_ino;
    l->process = getpid();
    l->next = ours;
    ours = l;
}

static void forget(const lock *l)
{
    lock **at = &ours;
    while (*at != NULL && *at != l) at = &(*at)->next;
    if (*at != NULL) *at = l->next;
}

/* Says in the file who holds it: the system knows no more than the process, and not on which machine. */
static void sign(int file)
{
    char host[HOST] = "?", text[HOST + 32];
    (void)gethostname(host, sizeof host - 1);
    const int n = snprintf(text, sizeof text, "process %ld on %s\n", (long)getpid(), host);
    if (ftruncate(file, 0) == 0) (void)!pwrite(file, text, (size_t)n, 0);
}

static void read_holder(int file, char *why, size_t size)
{
    char text[HOST + 32];
    const ssize_t n = pread(file, text, sizeof text - 1, 0);
    text[n > 0 ? n : 0] = '\0';
    text[strcspn(text, "\n")] = '\0';
    (void)snprintf(why, size, "%s is writing this output", text[0] != '\0' ? text : "another process");
}

/* Whether the file is still the one of that name: who held it before may have removed it in the meantime. */
static bool is_at(int file, const char *path)
{
    struct stat held, named;
    return fstat(file, &held) == 0 && stat(path, &named) == 0 && held.st_ino == named.st_ino &&
           held.st_dev == named.st_dev;
}

static bool is_unsupported(int error)
{
    return error == ENOLCK || error == ENOSYS || error == EOPNOTSUPP || error == EINVAL;
}

static lock_status take(lock *l, const char *path, char *why, size_t size)
{
    const struct flock whole = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    (void)snprintf(l->path, sizeof l->path, "%s", path);
    for (;;) {
        const int file = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (file < 0) {
            (void)snprintf(why, size, "cannot be created (%s)", strerror(errno));
            return LOCK_FAILED;
        }
        const int error = fcntl(file, F_SETLK, &whole) != 0 ? errno : 0;
        if (error != 0 && !is_unsupported(error)) {
            const bool taken = error == EACCES || error == EAGAIN;
            if (taken) read_holder(file, why, size);
            if (!taken) (void)snprintf(why, size, "cannot be locked (%s)", strerror(error));
            (void)close(file);
            return taken ? LOCK_TAKEN : LOCK_FAILED;
        }
        if (is_at(file, path)) {
            l->file = file;
            sign(file);
            return LOCK_HELD;
        }
        (void)close(file);
    }
}

lock_status lock_take(lock *l, const char *path, char *why, size_t size)
{
    lock_status status = LOCK_TAKEN;
    (void)pthread_mutex_lock(&turn);
    if (is_ours(path))
        (void)snprintf(why, size, "another run of this process is writing this output");
    else
        status = take(l, path, why, size);
    if (status == LOCK_HELD) note(l);
    (void)pthread_mutex_unlock(&turn);
    return status;
}

void lock_clear(const char *path)
{
    char why[128];
    lock l;
    if (access(path, F_OK) == 0 && lock_take(&l, path, why, sizeof why) == LOCK_HELD) lock_release(&l);
}

void lock_release(lock *l)
{
    if (l->file < 0) return;
    (void)pthread_mutex_lock(&turn);
    (void)unlink(l->path); /* before the lock goes: later the name may be another's */
    (void)close(l->file);
    forget(l);
    (void)pthread_mutex_unlock(&turn);
    l->file = -1;
}
