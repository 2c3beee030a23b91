/* SPDX-License-Identifier: BSD-3-Clause */
/* One rank of dem_batch runs out of memory. Preloaded, this fails the LACKING_NTH allocation that libdem asks for by
 * itself, on rank LACKING_RANK; 0: none. Their number goes to the file LACKING_COUNT when the process ends, or when one
 * has failed. Those of MPI, HDF5 and SUNDIALS are not counted. */
#define _GNU_SOURCE
#include <fcntl.h>
#include <link.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t n, size_t size);
void *__libc_realloc(void *old, size_t size);
void *__libc_memalign(size_t alignment, size_t size);

static uintptr_t begin, end; /* of libdem's code; 0, 0: not of this rank */
static atomic_long counted;
static long failing;

static void note(void)
{
    const char *path = getenv("LACKING_COUNT");
    char line[32];
    const int n = snprintf(line, sizeof line, "%ld\n", (long)counted);
    const int file = path != NULL ? open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666) : -1;
    if (file < 0) return;
    if (write(file, line, (size_t)n) != n) abort();
    (void)close(file);
}

static bool fails(const void *caller)
{
    const uintptr_t at = (uintptr_t)caller;
    if (at < begin || at >= end || atomic_fetch_add(&counted, 1) + 1 != failing) return false;
    note();
    return true;
}

void *malloc(size_t size)
{
    return fails(__builtin_return_address(0)) ? NULL : __libc_malloc(size);
}

void *calloc(size_t n, size_t size)
{
    return fails(__builtin_return_address(0)) ? NULL : __libc_calloc(n, size);
}

void *realloc(void *old, size_t size)
{
    return fails(__builtin_return_address(0)) ? NULL : __libc_realloc(old, size);
}

void *aligned_alloc(size_t alignment, size_t size)
{
    return fails(__builtin_return_address(0)) ? NULL : __libc_memalign(alignment, size);
}

static int look(struct dl_phdr_info *of, size_t size, void *context)
{
    (void)size;
    (void)context;
    if (strstr(of->dlpi_name, "/libdem.so") == NULL) return 0;
    for (int k = 0; k < of->dlpi_phnum; k++)
        if (of->dlpi_phdr[k].p_type == PT_LOAD && (of->dlpi_phdr[k].p_flags & PF_X) != 0) {
            begin = of->dlpi_addr + of->dlpi_phdr[k].p_vaddr;
            end = begin + of->dlpi_phdr[k].p_memsz;
        }
    return 1;
}

static const char *rank_here(void)
{
    const char *of_open_mpi = getenv("OMPI_COMM_WORLD_RANK"), *of_mpich = getenv("PMI_RANK");
    return of_open_mpi != NULL ? of_open_mpi : of_mpich;
}

__attribute__((constructor)) static void start(void)
{
    const char *wanted = getenv("LACKING_RANK"), *here = rank_here(), *nth = getenv("LACKING_NTH");
    if (wanted == NULL || here == NULL || strcmp(wanted, here) != 0) return;
    failing = nth != NULL ? strtol(nth, NULL, 10) : 0;
    (void)dl_iterate_phdr(look, NULL);
}

__attribute__((destructor)) static void finish(void)
{
    const bool has_failed = failing > 0 && counted >= failing;
    if (begin > 0 && !has_failed) note();
}
