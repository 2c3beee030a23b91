/* SPDX-License-Identifier: BSD-3-Clause */
/* A machine that fails one process as asked by the environment:
 *
 *    FAULTY_FAIL=write FAULTY_NTH=7 LD_PRELOAD=faulty.so PROGRAM
 *
 *    FAULTY_FAIL    what fails: memory, open, read, write, sync, rename, close, link, resize, lock; any: all but memory
 *    FAULTY_NTH     which one of these, from 1
 *    FAULTY_HOW     once (the default), always (from that one on), short (half of a write), kill (the process, before
 *                   the call), torn (the process, after half of a write)
 *    FAULTY_ERROR   the number of the error; EIO is the default
 *    FAULTY_BUDGET  bytes that the files in the working folder may have together: what does not fit gets ENOSPC
 *    FAULTY_COUNTS  a file that gets the number of each kind of call when the program ends
 *    FAULTY_LOG     a file that gets every call that changes a file, with its data
 *    FAULTY_STACKS  a file that gets, for each allocation, 8 bytes: a hash of its eight innermost callers
 *    FAULTY_CRASH   a file that gets the library and the function where a signal, or exit(), ended the process
 *
 * Allocations are those of the whole process, from main() on. The other calls are caught where they enter the system,
 * so that no library's way round the C library is missed; those count that name a file by a relative path, or a
 * descriptor that was opened by one, so the program's own files and nothing of /proc, say. */
#define _GNU_SOURCE /* REG_RAX, syscall() */

#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <ucontext.h>
#include <unistd.h>

typedef enum kind { MEMORY, OPEN, READ, WRITE, SYNC, RENAME, CLOSE, LINK, RESIZE, LOCK, ANY, N_KINDS } kind;
static const char *const kind_names[N_KINDS] = {"memory", "open", "read",   "write", "sync", "rename",
                                                "close",  "link", "resize", "lock",  "any"};

typedef enum manner { ONCE, ALWAYS, SHORT, KILL, TORN, N_MANNERS } manner;
static const char *const manner_names[N_MANNERS] = {"once", "always", "short", "kill", "torn"};

typedef struct call {
    long number;
    kind kind;
    int path; /* argument that is a path; -1: the first argument is a descriptor */
} call;

static const call calls[] = {
    {SYS_open, OPEN, 0},        {SYS_openat, OPEN, 1},     {SYS_creat, OPEN, 0},        {SYS_read, READ, -1},
    {SYS_pread64, READ, -1},    {SYS_write, WRITE, -1},    {SYS_pwrite64, WRITE, -1},   {SYS_writev, WRITE, -1},
    {SYS_fsync, SYNC, -1},      {SYS_fdatasync, SYNC, -1}, {SYS_rename, RENAME, 0},     {SYS_renameat, RENAME, 1},
    {SYS_renameat2, RENAME, 1}, {SYS_close, CLOSE, -1},    {SYS_unlink, LINK, 0},       {SYS_unlinkat, LINK, 1},
    {SYS_link, LINK, 0},        {SYS_linkat, LINK, 1},     {SYS_ftruncate, RESIZE, -1}, {SYS_fallocate, RESIZE, -1},
    {SYS_flock, LOCK, -1},      {SYS_fcntl, LOCK, -1}};
enum {
    N_CALLS = sizeof calls / sizeof calls[0],
    N_DESCRIPTORS = 1024,
    SELF = 64 /* bytes of syscall() */,
    CALLERS = 8
};

static bool active; /* main() has begun */
static kind failing = N_KINDS;
static manner how;
static long nth, error = EIO, budget = -1;
static const char *counts_path, *crash_path;
static int log_to = -1, stacks_to = -1;
static char folder[4096];
static bool watched[N_DESCRIPTORS];
static atomic_long counted[N_KINDS];

/* ---- which call fails ---- */

static void die(void)
{
    (void)syscall(SYS_kill, getpid(), SIGKILL);
}

static bool due(kind k)
{
    const long mine = ++counted[k], all = k == MEMORY ? 0 : ++counted[ANY];
    const long now = failing == k ? mine : failing == ANY ? all : 0;
    if (how == TORN && k != WRITE) return false;
    return now > 0 && (now == nth || (how == ALWAYS && now > nth));
}

/* ---- memory ---- */

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t n, size_t size);
void *__libc_realloc(void *old, size_t size);
void *__libc_memalign(size_t alignment, size_t size);

static void keep_stack(void)
{
    void *frames[CALLERS + 2]; /* this function and malloc() */
    uint64_t hash = UINT64_C(0xcbf29ce484222325);
    const int n = backtrace(frames, CALLERS + 2);
    for (int k = 0; k < n; k++) hash = (hash ^ (uint64_t)(uintptr_t)frames[k]) * UINT64_C(0x100000001b3);
    (void)syscall(SYS_write, stacks_to, &hash, sizeof hash);
}

static bool out_of_memory(void)
{
    if (!active) return false;
    if (stacks_to >= 0) keep_stack();
    if (!due(MEMORY)) return false;
    if (how == KILL) die();
    errno = ENOMEM;
    return true;
}

void *malloc(size_t size)
{
    return out_of_memory() ? NULL : __libc_malloc(size);
}

void *calloc(size_t n, size_t size)
{
    return out_of_memory() ? NULL : __libc_calloc(n, size);
}

void *realloc(void *old, size_t size)
{
    return out_of_memory() ? NULL : __libc_realloc(old, size);
}

void *aligned_alloc(size_t alignment, size_t size)
{
    return out_of_memory() ? NULL : __libc_memalign(alignment, size);
}

int posix_memalign(void **out, size_t alignment, size_t size)
{
    void *made = out_of_memory() ? NULL : __libc_memalign(alignment, size);
    if (made != NULL) *out = made;
    return made != NULL ? 0 : ENOMEM;
}

/* ---- files: what a call is about ---- */

static long enter(long number, const long a[6])
{
    const long result = syscall(number, a[0], a[1], a[2], a[3], a[4], a[5]);
    return result == -1 ? -errno : result;
}

static bool concerns(const call *c, const long a[6])
{
    if (c->number == SYS_fcntl && a[1] != F_SETLK && a[1] != F_SETLKW && a[1] != F_OFD_SETLK && a[1] != F_OFD_SETLKW)
        return false;
    if (c->path < 0) return a[0] >= 0 && a[0] < N_DESCRIPTORS && watched[a[0]];
    const char *path = (const char *)a[c->path];
    return path != NULL && path[0] != '/';
}

static long size_of(int descriptor)
{
    struct stat now = {0};
    (void)fstat(descriptor, &now);
    return now.st_size;
}

static long place_of(long number, const long a[6])
{
    const int descriptor = (int)a[0];
    if (number == SYS_pwrite64) return a[3];
    const bool appends = (fcntl(descriptor, F_GETFL) & O_APPEND) != 0;
    return appends ? size_of(descriptor) : lseek(descriptor, 0, SEEK_CUR);
}

/* A vector's first part stands for it: a shorter write is none that fails. */
static struct iovec data_of(long number, const long a[6])
{
    if (number == SYS_writev) return *(const struct iovec *)a[1];
    return (struct iovec){(void *)a[1], (size_t)a[2]};
}

/* Relative to the working folder. */
static const char *name_of(int descriptor, char *path, size_t size)
{
    char link[64];
    (void)snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
    const ssize_t n = readlink(link, path, size - 1);
    path[n > 0 ? n : 0] = '\0';
    const size_t start = strlen(folder);
    return strncmp(path, folder, start) == 0 ? path + start + (path[start] == '/') : path;
}

/* ---- a disk of a few bytes ---- */

struct entry {
    uint64_t inode;
    int64_t next;
    unsigned short length;
    unsigned char type;
    char name[];
};

static long folder_size(void)
{
    _Alignas(struct entry) char block[4096];
    long sum = 0, n;
    const int descriptor = (int)syscall(SYS_openat, AT_FDCWD, ".", O_RDONLY | O_DIRECTORY, 0);
    while ((n = syscall(SYS_getdents64, descriptor, block, sizeof block)) > 0) {
        const struct entry *e;
        for (long k = 0; k < n; k += e->length) {
            struct stat now;
            e = (const struct entry *)(block + k);
            if (fstatat(descriptor, e->name, &now, 0) == 0 && S_ISREG(now.st_mode)) sum += now.st_size;
        }
    }
    (void)syscall(SYS_close, descriptor);
    return sum;
}

/* How far beyond its end a call makes a file longer, of what there is no room for. */
static long lacking(long number, const long a[6])
{
    long end = 0;
    if (number == SYS_ftruncate) end = a[1];
    if (number == SYS_fallocate) end = a[2] + a[3];
    if (number == SYS_write || number == SYS_pwrite64 || number == SYS_writev)
        end = place_of(number, a) + (long)data_of(number, a).iov_len;
    const long growth = end - size_of((int)a[0]);
    return growth > 0 ? growth - (budget - folder_size()) : 0;
}

/* ---- the log: a line for each call, and behind it the data of a write ---- */

static void keep(const char *line, int length, struct iovec data)
{
    (void)syscall(SYS_write, log_to, line, length);
    if (data.iov_len > 0) (void)syscall(SYS_write, log_to, data.iov_base, data.iov_len);
}

static void keep_call(const call *c, const long a[6], long place, long result)
{
    char line[2 * sizeof folder], path[sizeof folder];
    const char *name = c->path < 0 ? name_of((int)a[0], path, sizeof path) : (const char *)a[c->path];
    const int second = c->number == SYS_rename || c->number == SYS_link ? 1 : 3;
    struct iovec data = {NULL, 0};
    int n = 0;
    if (c->kind == WRITE) {
        data = data_of(c->number, a);
        data.iov_len = (size_t)result;
        n = snprintf(line, sizeof line, "write\t%s\t%ld\t%ld\n", name, place, result);
    } else if (c->kind == OPEN) {
        const long flags = c->number == SYS_openat ? a[2] : c->number == SYS_open ? a[1] : O_CREAT | O_TRUNC;
        if ((flags & (O_CREAT | O_TRUNC)) != 0)
            n = snprintf(line, sizeof line, "open\t%s\t%d\n", name, (flags & O_TRUNC) != 0);
    } else if (c->kind == SYNC) {
        n = snprintf(line, sizeof line, "sync\t%s\n", name);
    } else if (c->kind == RESIZE) {
        n = snprintf(line, sizeof line, "resize\t%s\t%ld\n", name, size_of((int)a[0]));
    } else if (c->number == SYS_unlink || c->number == SYS_unlinkat) {
        n = snprintf(line, sizeof line, "remove\t%s\n", name);
    } else if (c->kind == RENAME || c->kind == LINK) {
        n = snprintf(line, sizeof line, "%s\t%s\t%s\n", c->kind == RENAME ? "rename" : "link", name,
                     (const char *)a[second]);
    }
    if (n > 0) keep(line, n, data);
}

/* ---- files: what becomes of a call ---- */

static long write_part(const call *c, const long a[6], size_t size, bool then_die)
{
    const struct iovec data = data_of(c->number, a);
    const long number = c->number == SYS_pwrite64 ? SYS_pwrite64 : SYS_write;
    const long result = enter(number, (const long[6]){a[0], (long)data.iov_base, (long)size, a[3]});
    if (then_die) die();
    return result;
}

static long carry_out(const call *c, const long a[6])
{
    const long place = log_to >= 0 && c->kind == WRITE ? place_of(c->number, a) : 0;
    const long result = enter(c->number, a);
    if (c->kind == OPEN && result >= 0 && result < N_DESCRIPTORS) watched[result] = true;
    if (c->kind == CLOSE) watched[a[0]] = false;
    if (log_to >= 0 && result >= 0) keep_call(c, a, place, result);
    return result;
}

static long fail(const call *c, const long a[6])
{
    if (c->kind == CLOSE) (void)carry_out(c, a); /* as Linux does, whatever it says */
    return -error;
}

static long answer(const call *c, const long a[6])
{
    if (!concerns(c, a)) return enter(c->number, a);
    const bool hit = due(c->kind);
    if (hit && how == KILL) die();
    if (hit && (how == SHORT || how == TORN) && c->kind == WRITE)
        return write_part(c, a, data_of(c->number, a).iov_len / 2, how == TORN);
    if (hit && how != SHORT) return fail(c, a);
    if (budget < 0 || (c->kind != WRITE && c->kind != RESIZE)) return carry_out(c, a);
    const long over = lacking(c->number, a);
    if (over <= 0) return carry_out(c, a);
    const long fits = c->kind == WRITE ? (long)data_of(c->number, a).iov_len - over : 0;
    return fits > 0 ? write_part(c, a, (size_t)fits, false) : -ENOSPC;
}

static void on_call(int signal_number, siginfo_t *info, void *context)
{
    greg_t *registers = ((ucontext_t *)context)->uc_mcontext.gregs;
    const long a[6] = {(long)registers[REG_RDI], (long)registers[REG_RSI], (long)registers[REG_RDX],
                       (long)registers[REG_R10], (long)registers[REG_R8],  (long)registers[REG_R9]};
    const int saved = errno;
    (void)signal_number;
    for (int k = 0; k < N_CALLS; k++)
        if (calls[k].number == info->si_syscall) registers[REG_RAX] = answer(&calls[k], a);
    errno = saved;
}

/* ---- who ends the process ---- */

/* Who has called what is no code is not found by backtrace(), but the address to return to is on the stack. */
static int list_frames(void **frames, int most, const ucontext_t *context)
{
    const int n = backtrace(frames, most - 1);
    if (context == NULL) return n;
    frames[n] = *(void **)context->uc_mcontext.gregs[REG_RSP];
    return n + 1;
}

/* Of the innermost frame beyond the C library and this file. */
static void name_culprit(int signal_number, siginfo_t *info, void *context)
{
    void *frames[64];
    char line[256] = "";
    Dl_info where = {0};
    const int n = list_frames(frames, 64, context);
    (void)info;
    for (int k = 0; k < n; k++) {
        if (dladdr(frames[k], &where) == 0 || where.dli_fname == NULL) continue;
        const char *name = strrchr(where.dli_fname, '/');
        name = name != NULL ? name + 1 : where.dli_fname;
        if (strncmp(name, "libc.", 5) == 0 || strncmp(name, "faulty.", 7) == 0) continue;
        const char *function = where.dli_sname != NULL ? where.dli_sname : "?";
        (void)snprintf(line, sizeof line, "%s %s %s\n", name, function,
                       signal_number != 0 ? strsignal(signal_number) : "exit");
        break;
    }
    const int descriptor = (int)syscall(SYS_openat, AT_FDCWD, crash_path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    (void)syscall(SYS_write, descriptor, line, strlen(line));
    (void)syscall(SYS_close, descriptor);
}

/* main() returns and never calls it. */
void exit(int code)
{
    void (*next)(int) = NULL;
    active = false;
    if (crash_path != NULL) name_culprit(0, NULL, NULL);
    *(void **)&next = dlsym(RTLD_NEXT, "exit");
    if (next != NULL) next(code);
    _exit(code);
}

static void watch_crashes(void)
{
    static const int fatal[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
    const struct sigaction action = {.sa_sigaction = name_culprit,
                                     .sa_flags = SA_SIGINFO | SA_ONSTACK | (int)SA_RESETHAND};
    static char stack[1 << 16]; /* the process may have run out of its own */
    const stack_t other = {.ss_sp = stack, .ss_size = sizeof stack};
    crash_path = getenv("FAULTY_CRASH");
    if (crash_path == NULL) return;
    (void)sigaltstack(&other, NULL);
    for (size_t k = 0; k < sizeof fatal / sizeof fatal[0]; k++) (void)sigaction(fatal[k], &action, NULL);
}

/* ---- the beginning and the end ---- */

/* Traps the calls of the table, wherever they come from but syscall() itself, by which this file makes them. */
static bool catch_calls(void)
{
    const uint64_t self = (uint64_t)(uintptr_t)&syscall;
    struct sock_filter filter[N_CALLS + 10] = {
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, instruction_pointer) + 4),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, (uint32_t)(self >> 32), 0, 4),
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, instruction_pointer)),
        BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, (uint32_t)self, 0, 2),
        BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, (uint32_t)self + SELF, 1, 0),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr))};
    int n = 7;
    for (int k = 0; k < N_CALLS; k++)
        filter[n++] = (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, (uint32_t)calls[k].number,
                                                   (unsigned char)(N_CALLS - k), 0);
    filter[n++] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
    filter[n++] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP);
    const struct sock_fprog program = {(unsigned short)n, filter};
    struct sigaction action = {.sa_sigaction = on_call, .sa_flags = SA_SIGINFO | SA_NODEFER | SA_RESTART};
    return sigaction(SIGSYS, &action, NULL) == 0 && prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
           prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

static int chosen(const char *variable, const char *const *names, int n)
{
    const char *word = getenv(variable);
    for (int k = 0; word != NULL && k < n; k++)
        if (strcmp(word, names[k]) == 0) return k;
    return n;
}

static long number(const char *variable, long otherwise)
{
    const char *word = getenv(variable);
    return word != NULL ? strtol(word, NULL, 10) : otherwise;
}

/* Beyond the descriptors that are watched. */
static int open_aside(const char *path)
{
    if (path == NULL) return -1;
    return fcntl(open(path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666), F_DUPFD_CLOEXEC, N_DESCRIPTORS);
}

__attribute__((constructor)) static void begin(void)
{
    void *frame;
    failing = (kind)chosen("FAULTY_FAIL", kind_names, N_KINDS);
    how = (manner)(chosen("FAULTY_HOW", manner_names, N_MANNERS) % N_MANNERS);
    nth = number("FAULTY_NTH", 0);
    error = number("FAULTY_ERROR", EIO);
    budget = number("FAULTY_BUDGET", -1);
    counts_path = getenv("FAULTY_COUNTS");
    if (getcwd(folder, sizeof folder) == NULL) _exit(127);
    log_to = open_aside(getenv("FAULTY_LOG"));
    stacks_to = open_aside(getenv("FAULTY_STACKS"));
    (void)backtrace(&frame, 1); /* allocates when it is called first */
    watch_crashes();
    if (!catch_calls()) _exit(127);
    active = true;
}

__attribute__((destructor)) static void end(void)
{
    active = false;
    if (counts_path == NULL) return;
    const int descriptor = (int)syscall(SYS_openat, AT_FDCWD, counts_path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    for (int k = 0; k < N_KINDS; k++) {
        char line[64];
        const int n = snprintf(line, sizeof line, "%s %ld\n", kind_names[k], (long)counted[k]);
        (void)syscall(SYS_write, descriptor, line, n);
    }
}
