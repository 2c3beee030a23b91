/* SPDX-License-Identifier: BSD-3-Clause */
#include "surfaces.h"

#include <stdlib.h>
#include <string.h>

#include "rigid_keys.h"

/* A key that is in vain where bodies do not touch. */
typedef struct asking_key {
    const schema_instance *group; /* NULL: there is none */
    const char *key;
} asking_key;

static bool asks(asking_key *out, const schema_instance *group, const char *key)
{
    if (schema_given(group, key)) *out = (asking_key){group, key};
    return schema_given(group, key);
}

static int32_t body_of(const dem_lattice *l, dem_index node)
{
    return l->body != NULL ? l->body[node] : 0;
}

/* The first node of the bodies without triangles, or -1; -2 when memory runs out. Bodies of the library are meant: a
 * lattice file may have several. */
static dem_index find_bare(const dem_lattice *l)
{
    bool *covered = calloc((size_t)l->n_nodes + 1, sizeof *covered); /* [body] */
    dem_index bare = -1;
    if (covered == NULL) return -2;
    for (dem_index k = 0; k < l->n_triangles; k++) covered[body_of(l, l->triangles[3 * k])] = true;
    for (dem_index i = l->n_nodes; i-- > 0;)
        if (!covered[body_of(l, i)]) bare = i;
    free(covered);
    return bare;
}

/* Number of the &body that has a node, from 1. */
static size_t number_of(const placement *bodies, size_t n, dem_index node)
{
    size_t number = 1;
    while (number < n && node >= bodies[number].first) number++;
    return number;
}

/* The first key by which a deck asks for contact of bodies, if it does not leave that to the defaults. */
static asking_key find_asking_key(const schema_deck *groups, const dem_lattice *lattice, const placement *bodies)
{
    static const char *const keys[] = {"bodies", "thickness", "stiffness", "friction"};
    const dem_index rigid = rigid_keys_node(lattice);
    asking_key found = {NULL, "rigid"};
    if (rigid >= 0)
        found.group = schema_get(groups, "body", number_of(bodies, schema_count(groups, "body"), rigid) - 1);
    bool any = found.group != NULL;
    for (size_t k = 0; k < sizeof keys / sizeof *keys && !any; k++)
        any = asks(&found, schema_get(groups, "contact", 0), keys[k]);
    for (size_t k = 0; k < schema_count(groups, "material") && !any; k++)
        any = asks(&found, schema_get(groups, "material", k), "friction");
    return found;
}

static bool give_up(schema_deck *groups)
{
    for (size_t k = 0; k < groups->n_instances; k++)
        if (strcmp(groups->instances[k].group->name, "contact") == 0 &&
            !schema_set_text(&groups->instances[k], "bodies", "none"))
            return false;
    return true;
}

bool surfaces_settle(dem_options *options, schema_deck *groups, const dem_lattice *lattice, const placement *bodies,
                     namelist_errors *errors)
{
    const asking_key asking = find_asking_key(groups, lattice, bodies);
    if (options->bodies == DEM_BODIES_NONE) return true;
    const dem_index bare = find_bare(lattice);
    if (bare == -1) return true;
    if (bare < 0) return false;
    if (asking.group != NULL) {
        namelist_errors_add(errors, schema_place(asking.group, asking.key),
                            "'%s' in &%s is for bodies that touch, but body %zu has no triangles, and so no surface",
                            asking.key, asking.group->group->name,
                            number_of(bodies, schema_count(groups, "body"), bare));
        return true;
    }
    options->bodies = DEM_BODIES_NONE;
    return give_up(groups);
}
