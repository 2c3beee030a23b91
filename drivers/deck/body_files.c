/* SPDX-License-Identifier: BSD-3-Clause */
#include "body_files.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "body_geometry.h"
#include "digest.h"

/* Puts a file's whole path in the place of its name. */
static bool name_file(schema_instance *body, const char *folder, namelist_errors *errors)
{
    char here[4096] = "", *path = body_geometry_file(folder, body);
    if (path == NULL) return false;
    if (path[0] != '/' && getcwd(here, sizeof here) == NULL)
        namelist_errors_add(errors, schema_value_of(body, "file")->place, "%s: %s", path, strerror(errno));
    const size_t size = strlen(here) + strlen(path) + 2;
    char *whole = malloc(size);
    if (whole != NULL) (void)snprintf(whole, size, "%s%s%s", here, path[0] == '/' ? "" : "/", path);
    const bool good = whole != NULL && schema_set_text(body, "file", whole);
    free(whole);
    free(path);
    return good;
}

/* Puts the hash of its bytes there: where a file lies makes no other problem. */
static bool hash_file(schema_instance *body, namelist_errors *errors)
{
    const char *path = schema_text(body, "file");
    char bytes[4096], text[32];
    uint64_t hash = DIGEST_BEGIN;
    FILE *file = fopen(path, "rb");
    for (size_t n; file != NULL && (n = fread(bytes, 1, sizeof bytes, file)) > 0;) hash = digest_add(hash, bytes, n);
    if (file == NULL || ferror(file))
        namelist_errors_add(errors, schema_value_of(body, "file")->place, "%s: %s", path, strerror(errno));
    if (file != NULL) (void)fclose(file);
    (void)snprintf(text, sizeof text, "fnv1a:%016llx", (unsigned long long)hash);
    return schema_set_text(body, "file", text);
}

/* Whether a group is a body that is made from a file. */
static bool is_file(const schema_instance *group)
{
    return strcmp(group->group->name, "body") == 0 && schema_given(group, "file");
}

bool body_files_name(schema_deck *groups, const char *folder, namelist_errors *errors)
{
    for (size_t k = 0; k < groups->n_instances; k++)
        if (is_file(&groups->instances[k]) && !name_file(&groups->instances[k], folder, errors)) return false;
    return true;
}

bool body_files_hash(schema_deck *groups, namelist_errors *errors)
{
    for (size_t k = 0; k < groups->n_instances; k++)
        if (is_file(&groups->instances[k]) && !hash_file(&groups->instances[k], errors)) return false;
    return true;
}
