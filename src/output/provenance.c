/* SPDX-License-Identifier: BSD-3-Clause */
/* Texts that say what made a file: versions, deck, hashes. They are kept in memory, so that every file of a run gets
 * all of them. An array that is searched from its start: a run has a dozen entries. Which texts there are is decided by
 * the programs, through dem_trajectory_note(). */
#include "output/provenance.h"

#include "base/grow.h"
#include "base/status.h"
#include "output/hdf5_attribute.h"

#include <stdio.h>
#include <string.h>

/* The name of a note becomes that of a dataset, so path separators and dots are refused. */
dem_status provenance_path(char path[PROVENANCE_PATH], const char *name)
{
    CHECK(*name != '\0' && strpbrk(name, "/.") == NULL && strlen(name) < 64, DEM_ERROR_ARGUMENT,
          "\"%s\" cannot name a note: 1 to 63 characters, none of them / or .", name);
    (void)snprintf(path, PROVENANCE_PATH, "/provenance/%s", name);
    return DEM_OK;
}

/* Memory for the entry and the text is there before anything is changed. */
dem_status provenance_put(provenance *all, const char *path, const char *text)
{
    dem_index k = 0;
    CHECK(grow_array((void **)&all->entries, &all->capacity, all->n + 1, sizeof *all->entries), DEM_ERROR_MEMORY,
          "out of memory");
    char *copy = strdup(text);
    CHECK_MEMORY(copy);
    while (k < all->n && strcmp(all->entries[k].path, path) != 0) k++;
    provenance_entry *entry = &all->entries[k];
    if (k < all->n)
        free(entry->text);
    else
        all->n++;
    (void)snprintf(entry->path, sizeof entry->path, "%s", path);
    entry->text = copy;
    return DEM_OK;
}

void provenance_free(provenance *all)
{
    for (dem_index k = 0; k < all->n; k++) free(all->entries[k].text);
    free(all->entries);
    *all = (provenance){0};
}

dem_status provenance_write(const provenance *all, const hdf5_file *file)
{
    for (dem_index k = 0; k < all->n; k++) TRY(hdf5_write_text(file, all->entries[k].path, all->entries[k].text));
    return DEM_OK;
}

hsize_t provenance_bytes(const provenance *all)
{
    hsize_t bytes = 0;
    for (dem_index k = 0; k < all->n; k++) bytes += strlen(all->entries[k].text) + 1024; /* and the dataset's header */
    return bytes;
}
