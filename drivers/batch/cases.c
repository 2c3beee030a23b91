/* SPDX-License-Identifier: BSD-3-Clause */
#include "cases.h"

#include <stdlib.h>
#include <string.h>

#include "base/file.h"

enum { MOST_LIST = 64 << 20 }; /* bytes */

static const char blanks[] = " \t\r";

/* Takes the folder, of n characters, and the name over into one path. */
static bool append(cases *all, const char *folder, size_t n, const char *name)
{
    const size_t size = n + strlen(name) + 1;
    char **paths =
        (all->n & (all->n - 1)) != 0 ? all->paths : realloc(all->paths, (all->n == 0 ? 1 : 2 * all->n) * sizeof *paths);
    if (paths == NULL) return false;
    all->paths = paths;
    paths[all->n] = malloc(size);
    if (paths[all->n] == NULL) return false;
    (void)snprintf(paths[all->n++], size, "%.*s%s", (int)n, folder, name);
    return true;
}

static bool append_line(cases *all, const char *list, char *line)
{
    const char *slash = strrchr(list, '/');
    line += strspn(line, blanks);
    size_t n = strlen(line);
    while (n > 0 && strchr(blanks, line[n - 1]) != NULL) n--;
    line[n] = '\0';
    if (n == 0 || line[0] == '#') return true;
    return append(all, list, slash == NULL || line[0] == '/' ? 0 : (size_t)(slash - list) + 1, line);
}

static bool append_list(cases *all, const char *list, outcome *o)
{
    char why[FILE_WHY], *bytes, *rest;
    size_t size;
    const size_t before = all->n;
    const file_status status = file_read(&bytes, &size, list, MOST_LIST, why);
    bool good = status == FILE_READ;
    for (char *line = good ? strtok_r(bytes, "\n", &rest) : NULL; line != NULL && good;
         line = strtok_r(NULL, "\n", &rest))
        good = append_line(all, list, line);
    if (status == FILE_REFUSED)
        outcome_fail(o, EXIT_INVALID, list, "%s", why);
    else if (!good)
        outcome_fail(o, EXIT_MEMORY, list, "out of memory");
    else if (all->n == before)
        outcome_fail(o, EXIT_INVALID, list, "the list names no deck");
    free(bytes);
    return good && all->n > before;
}

/* Leaves only the one asked for. */
static bool pick(cases *all, long index, outcome *o)
{
    if (index == 0) return true;
    if ((size_t)index > all->n) {
        outcome_fail(o, EXIT_USAGE, "dem_batch", "'--index' is %ld, but there %s %zu deck%s", index,
                     all->n == 1 ? "is" : "are", all->n, all->n == 1 ? "" : "s");
        return false;
    }
    char *picked = all->paths[index - 1];
    all->paths[index - 1] = all->paths[0];
    all->paths[0] = picked;
    while (all->n > 1) free(all->paths[--all->n]);
    return true;
}

bool cases_find(cases *out, const command *c, outcome *o)
{
    *out = (cases){0};
    for (size_t k = 0; k < c->n_decks; k++) {
        const char *deck = c->decks[k];
        if (deck[0] == '@') {
            if (!append_list(out, deck + 1, o)) return false;
        } else if (!append(out, "", 0, deck)) {
            outcome_fail(o, EXIT_MEMORY, deck, "out of memory");
            return false;
        }
    }
    return pick(out, c->index, o);
}

void cases_free(cases *all)
{
    for (size_t k = 0; k < all->n; k++) free(all->paths[k]);
    free(all->paths);
    *all = (cases){0};
}
