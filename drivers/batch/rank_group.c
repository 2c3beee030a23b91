/* SPDX-License-Identifier: BSD-3-Clause */
/* libdem_mpi stands beside libdem, and has the functions that are declared here again: src/mpi/mpi_program.h. */
#include "rank_group.h"

#include <dlfcn.h>
#include <stdio.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "deck_slabs.h"
#include "outcome.h"

static const char library[] = "libdem_mpi.so.2";

/* A function of the library. ISO C has no conversion from the address of an object. */
static bool find(const rank_group *g, const char *name, void *function)
{
    void *const found = dlsym(g->library, name);
    *(void **)function = found;
    return found != NULL;
}

static void end_all(void *group)
{
    const rank_group *g = group;
    (void)fprintf(g->host->err, "dem_batch: error: rank %d: %s\n", g->rank, dem_status_message());
    (void)fflush(g->host->err);
    g->abort(EXIT_MEMORY);
}

/* What set-up has freed is to be free for others on the machine, and for messages: left to itself the C library keeps
 * arrays of up to 32 MB, in holes that others do not fit into. */
static void keep_no_freed_arrays(void)
{
#ifdef __GLIBC__
    enum { KEPT = 1 << 20 }; /* bytes of the largest that are kept */
    (void)mallopt(M_MMAP_THRESHOLD, KEPT);
#endif
}

bool rank_group_begin(rank_group *g, const host *h, char why[RANK_GROUP_REASON])
{
    void *(*begin)(int *rank, int *size, volatile sig_atomic_t *const *requests, const slab_maker *maker,
                   void (*lacks_memory)(void *program), void *program) = NULL;
    keep_no_freed_arrays();
    *g = (rank_group){.host = h, .library = dlopen(library, RTLD_NOW | RTLD_GLOBAL)};
    if (g->library == NULL || !find(g, "dem_private_program_begin", (void *)&begin) ||
        !find(g, "dem_private_program_slabs", (void *)&g->slabs) ||
        !find(g, "dem_private_program_lead", (void *)&g->lead) ||
        !find(g, "dem_private_program_shares", (void *)&g->shares) ||
        !find(g, "dem_private_program_abort", (void *)&g->abort) ||
        !find(g, "dem_private_program_end", (void *)&g->end)) {
        const char *reason = dlerror();
        (void)snprintf(why, RANK_GROUP_REASON, "%s", reason != NULL ? reason : library);
        return false;
    }
    volatile sig_atomic_t *const both[] = {&h->requests->end, &h->requests->checkpoint};
    g->self = begin(&g->rank, &g->size, both, &(slab_maker){deck_slabs_make, NULL}, end_all, g);
    if (g->self == NULL) (void)snprintf(why, RANK_GROUP_REASON, "%s has another version, or no memory", library);
    return g->self != NULL;
}

dem_status rank_group_slabs(const rank_group *g, dem_model **out, const slab_recipe *recipe)
{
    return g->slabs(g->self, out, recipe);
}

dem_status rank_group_lead(const rank_group *g, dem_simulation *whole, const dem_options *options,
                           const dem_checkpoint *checkpoint)
{
    return g->lead(g->self, whole, options, checkpoint);
}

void rank_group_print(const rank_group *g, const dem_simulation *whole, bool of_slabs, FILE *out)
{
    enum { OWN, GHOSTS, COMMON, MEMORY, ALL }; /* as dem_private_program_shares() has them */
    static const char *const what[] = {[OWN] = "own nodes", [GHOSTS] = "ghosts", [COMMON] = "common nodes of others"};
    double least[ALL], most[ALL];
    g->shares(whole, least, most);
    (void)fprintf(out, "ranks      %d%s:", g->size, of_slabs ? ", of slabs" : "");
    for (int k = OWN; k <= COMMON; k++) {
        (void)fprintf(out, "%s %.0f", k == OWN ? "" : ",", least[k]);
        if (most[k] > least[k]) (void)fprintf(out, " to %.0f", most[k]);
        (void)fprintf(out, " %s", what[k]);
    }
    (void)fprintf(out, "; memory so far %.4g to %.4g MB\n", 1e-6 * least[MEMORY], 1e-6 * most[MEMORY]);
}

int rank_group_end(rank_group *g, int code)
{
    return (int)g->end(g->self, code);
}
