/* SPDX-License-Identifier: BSD-3-Clause */
/* See store.h. */
#include "store.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "unit/close.h"

enum { MOST = 512, NAME = 64 };

typedef struct list {
    int n;
    char name[MOST][NAME];
    uint64_t hash[MOST];
} list;

static list stored, found;
static const char *path;
static int replaces, n_differ;

static void append(list *l, const char *name, uint64_t hash)
{
    assert_true(l->n < MOST && strlen(name) < NAME);
    (void)strcpy(l->name[l->n], name);
    l->hash[l->n++] = hash;
}

/* -1 if there is none. */
static int find(const list *l, const char *name)
{
    for (int k = 0; k < l->n; k++)
        if (strcmp(l->name[k], name) == 0) return k;
    return -1;
}

void store_open(const char *file_path, int will_replace)
{
    char line[256], name[NAME];
    uint64_t hash;
    path = file_path;
    replaces = will_replace;
    FILE *file = fopen(path, "r");
    if (file == NULL) return; /* then each case is missing, and is reported */
    while (fgets(line, sizeof line, file) != NULL)
        if (line[0] != '#' && sscanf(line, "%63s %" SCNx64, name, &hash) == 2) append(&stored, name, hash);
    (void)fclose(file);
}

void store_check(const char *name, uint64_t hash)
{
    const int k = find(&stored, name);
    assert_true(find(&found, name) < 0);
    append(&found, name, hash);
    if (replaces || (k >= 0 && stored.hash[k] == hash)) return;
    n_differ++;
    if (k < 0)
        print_message("# %s: nothing is stored, found %016" PRIx64 "\n", name, hash);
    else
        print_message("# %s: stored %016" PRIx64 ", found %016" PRIx64 "\n", name, stored.hash[k], hash);
}

void store_disagree(const char *name, const char *kernel, uint64_t hash)
{
    n_differ++;
    print_message("# %s: found %016" PRIx64 " with the kernel %s, which the portable one does not give\n", name, hash,
                  kernel);
}

int store_differences(void)
{
    return n_differ;
}

int store_missing(void)
{
    int n = 0;
    for (int k = 0; k < stored.n && !replaces; k++) {
        if (find(&found, stored.name[k]) >= 0) continue;
        print_message("# %s: stored, but there is no such case\n", stored.name[k]);
        n++;
    }
    return n;
}

void store_replace(void)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    (void)fputs("# Hashes of results, by `meson compile -C build lock-update`. A commit that changes one says why.\n",
                file);
    for (int k = 0; k < found.n; k++) (void)fprintf(file, "%s %016" PRIx64 "\n", found.name[k], found.hash[k]);
    assert_int_equal(fclose(file), 0);
}
