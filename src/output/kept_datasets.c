/* SPDX-License-Identifier: BSD-3-Clause */
/* A list by name, in the order in which datasets were first opened, which is that of every frame: the next one to be
 * looked for is mostly the next of the list. */
#include "output/kept_datasets.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 256, NAME = 96 };

struct kept_datasets {
    int n, next;
    struct {
        hid_t id;
        char name[NAME];
    } list[MOST];
};

kept_datasets *kept_datasets_create(void)
{
    return calloc(1, sizeof(kept_datasets));
}

herr_t kept_datasets_close(kept_datasets *kept)
{
    herr_t result = 0;
    for (int k = 0; kept != NULL && k < kept->n; k++)
        if (H5Dclose(kept->list[k].id) < 0) result = -1;
    free(kept);
    return result;
}

static hid_t find(kept_datasets *kept, const char *name)
{
    for (int k = 0; k < kept->n; k++) {
        const int at = (kept->next + k) % kept->n;
        if (strcmp(kept->list[at].name, name) != 0) continue;
        kept->next = at + 1;
        return kept->list[at].id;
    }
    return H5I_INVALID_HID;
}

/* Where the list is full, or a name too long, a dataset is opened each time. */
hid_t kept_datasets_open(kept_datasets *kept, hid_t file, const char *name)
{
    hid_t id = kept != NULL ? find(kept, name) : H5I_INVALID_HID;
    if (id >= 0) return id;
    id = H5Dopen2(file, name, H5P_DEFAULT);
    if (kept == NULL || id < 0 || kept->n == MOST || strlen(name) >= NAME) return id;
    kept->list[kept->n].id = id;
    memcpy(kept->list[kept->n++].name, name, strlen(name) + 1);
    return id;
}

herr_t kept_datasets_leave(const kept_datasets *kept, hid_t dataset)
{
    bool is_kept = false;
    for (int k = 0; kept != NULL && k < kept->n && !is_kept; k++) is_kept = kept->list[k].id == dataset;
    return is_kept ? 0 : H5Dclose(dataset);
}
