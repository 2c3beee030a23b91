/* SPDX-License-Identifier: BSD-3-Clause */
/* A process prints into files without a name; what is there is printed when it and all before it have ended. Where
 * standard output is a terminal a line of progress stands there meanwhile. What the system asks of the command it asks
 * of all processes. This one does no case itself, so that there is nothing that a new process must not inherit. */
#include "case_pool.h"

#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "job.h"
#include "signals.h"
#include "streams.h"

static const double between_looks = 0.2; /* s, at most, from one line of progress to the next */

/* What a process prints: while it runs into the file, which is then read. Files would be too many for a long sweep. */
typedef struct case_text {
    FILE *file;
    char *bytes; /* [n] */
    size_t n;
} case_text;

typedef struct case_process {
    pid_t pid; /* 0: it does not run */
    case_text out, err;
    int status; /* as waitpid() has it, once it has ended */
    int error;  /* errno, where it could not begin or its text not be read; else 0 */
} case_process;

typedef struct case_pool {
    const command *command;
    const cases *all;
    case_process *list;        /* [all->n] */
    volatile double *part;     /* [all->n] of each case what is done, 0 to 1; the processes write it */
    size_t n_begun, n_running; /* the first n_begun have begun */
    size_t n_printed;          /* what the first ones print is on standard output */
    bool is_stopped;           /* no more is begun */
    bool is_end_passed_on;     /* the request for the end, to all processes */
    int width;                 /* characters of the line of progress that stands on the terminal */
    exit_code worst;
} case_pool;

/* ---- processes ---- */

/* The process of a case: it never returns. */
static void be_case(const case_pool *p, size_t k)
{
    const case_process *own = &p->list[k];
    host h = *p->command->host;
    command own_command = *p->command;
    h.terminal = false;
    h.part = &p->part[k];
    own_command.host = &h;
    signals_leave_children();
    const bool good =
        dup2(fileno(own->out.file), STDOUT_FILENO) >= 0 && dup2(fileno(own->err.file), STDERR_FILENO) >= 0;
    exit(good ? streams_end("dem_batch", job_do(&own_command, p->all->paths[k])) : (int)EXIT_IO);
}

/* Closes the file.  \return errno, or 0 */
static int read_text(case_text *t)
{
    int error = 0;
    if (t->file == NULL) return 0;
    const long n = fseek(t->file, 0, SEEK_END) == 0 ? ftell(t->file) : -1;
    rewind(t->file);
    t->bytes = n >= 0 ? malloc((size_t)n + 1) : NULL;
    if (t->bytes != NULL) t->n = fread(t->bytes, 1, (size_t)n, t->file);
    if (t->bytes == NULL || ferror(t->file)) error = errno;
    (void)fclose(t->file);
    t->file = NULL;
    return error;
}

static void begin(case_pool *p, size_t k)
{
    case_process *own = &p->list[k];
    (void)fflush(stdout); /* a copy of what waits there would be printed by the process, too */
    own->out.file = tmpfile();
    own->err.file = own->out.file != NULL ? tmpfile() : NULL;
    const pid_t pid = own->err.file != NULL ? fork() : -1;
    if (pid == 0) be_case(p, k);
    p->n_begun++;
    p->n_running += pid > 0;
    own->pid = pid > 0 ? pid : 0;
    if (pid > 0) return;
    own->error = errno;
    (void)read_text(&own->out);
    (void)read_text(&own->err);
}

static void end(case_pool *p, case_process *own, int status)
{
    const int out = read_text(&own->out), err = read_text(&own->err);
    own->pid = 0;
    own->status = status;
    own->error = out != 0 ? out : err;
    p->n_running--;
    if (WIFEXITED(status) && WEXITSTATUS(status) == EXIT_STOPPED) p->is_stopped = true;
}

/* Of a process that ended by a signal: what came out of it, and why. A kill is as good as a stop. */
static exit_code judge_signal(int number, const char *path)
{
    outcome o = {0};
    const bool killed = number == SIGKILL || number == SIGTERM || number == SIGINT || number == SIGHUP;
    outcome_fail(&o, killed ? EXIT_STOPPED : EXIT_NUMERICS, path, "its process ended by signal %d (%s)%s", number,
                 strsignal(number), killed ? "; the same command goes on with it" : "");
    return o.code;
}

static exit_code judge_error(int error, const char *path)
{
    outcome o = {0};
    outcome_fail(&o, EXIT_IO, path, "its process could not be begun, or what it printed not be read (%s)",
                 strerror(error));
    return o.code;
}

/* What is known of processes that have ended since the last call. */
static void gather(case_pool *p)
{
    int status;
    for (pid_t pid = waitpid(-1, &status, WNOHANG); pid > 0; pid = waitpid(-1, &status, WNOHANG))
        for (size_t k = 0; k < p->n_begun; k++)
            if (p->list[k].pid == pid) end(p, &p->list[k], status);
}

static void tell_all(const case_pool *p, int number)
{
    for (size_t k = 0; k < p->n_begun; k++)
        if (p->list[k].pid > 0) (void)kill(p->list[k].pid, number);
}

static void pass_on(case_pool *p)
{
    requests *asked = p->command->host->requests;
    if (requests_checkpoint(asked)) tell_all(p, SIGUSR1);
    if (asked->end == 0 || p->is_end_passed_on) return;
    tell_all(p, asked->end);
    p->is_stopped = p->is_end_passed_on = true;
}

/* ---- what is printed ---- */

static void clear_line(case_pool *p)
{
    if (p->width > 0) (void)printf("\r%*s\r", p->width, "");
    p->width = 0;
}

static void show_line(case_pool *p)
{
    const size_t n = p->all->n;
    double sum = 0.0;
    if (!p->command->host->terminal) return;
    for (size_t k = 0; k < p->n_begun; k++) sum += p->list[k].pid > 0 ? p->part[k] : 1.0;
    clear_line(p);
    p->width = printf("%5.1f %%  %zu of %zu done, %zu running", 100.0 * sum / (double)n, p->n_begun - p->n_running, n,
                      p->n_running);
    (void)fflush(stdout);
}

static void print_text(case_text *t, FILE *to)
{
    if (t->n > 0) (void)fwrite(t->bytes, 1, t->n, to);
    (void)fflush(to);
    free(t->bytes);
    *t = (case_text){0};
}

/* What a case has come to, with all that it prints. */
static exit_code print_case(const case_pool *p, size_t k)
{
    case_process *own = &p->list[k];
    const char *path = p->all->paths[k];
    if (k >= p->n_begun) return job_leave(p->command, path);
    print_text(&own->out, stdout);
    print_text(&own->err, stderr);
    if (own->error != 0) return judge_error(own->error, path);
    return WIFEXITED(own->status) ? (exit_code)WEXITSTATUS(own->status) : judge_signal(WTERMSIG(own->status), path);
}

/* Of all cases that are next in their order and have ended, or will not begin. */
static void print_ended(case_pool *p)
{
    const size_t end = p->is_stopped ? p->all->n : p->n_begun;
    for (; p->n_printed < end && p->list[p->n_printed].pid == 0; p->n_printed++) {
        clear_line(p);
        const exit_code code = print_case(p, p->n_printed);
        if (code > p->worst) p->worst = code;
    }
    (void)fflush(stdout);
}

/* ---- all ---- */

static void do_cases(case_pool *p)
{
    const size_t most = (size_t)p->command->jobs;
    while (p->n_printed < p->all->n) {
        while (!p->is_stopped && p->n_begun < p->all->n && p->n_running < most) begin(p, p->n_begun);
        gather(p);
        pass_on(p);
        print_ended(p);
        show_line(p);
        if (p->n_running > 0) signals_wait(between_looks);
    }
    clear_line(p);
}

/* Shared memory, all 0, by a file without a name.  \return NULL without it */
static void *share(size_t bytes)
{
    FILE *file = tmpfile();
    void *shared = MAP_FAILED;
    if (file != NULL && ftruncate(fileno(file), (off_t)bytes) == 0)
        shared = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, fileno(file), 0);
    if (file != NULL) (void)fclose(file);
    return shared != MAP_FAILED ? shared : NULL;
}

exit_code case_pool_do(const command *c, const cases *all)
{
    const size_t bytes = (all->n + 1) * sizeof(double);
    void *shared = share(bytes);
    case_pool p = {.command = c, .all = all, .list = calloc(all->n + 1, sizeof *p.list), .part = shared};
    if (shared == NULL || p.list == NULL) {
        outcome o = {0};
        outcome_fail(&o, EXIT_MEMORY, "dem_batch", "out of memory for %zu cases", all->n);
        p.worst = o.code;
    } else {
        signals_catch_children();
        do_cases(&p);
    }
    if (shared != NULL) (void)munmap(shared, bytes);
    free(p.list);
    return p.worst;
}
