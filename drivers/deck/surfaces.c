/* SPDX-License-Identifier: BSD-3-Clause */
#include "surfaces.h"

#include <stdlib.h>
#include <string.h>

#include "rigid_keys.h"

/* The key by which a deck asks for contact of bodies; NULL if it leaves that to the defaults. */
static const char *asking_key(const schema_instance *contact)
{
    static const char *const keys[] = {"bodies", "thickness", "stiffness", "friction"};
    for (size_t k = 0; k < sizeof keys / sizeof *keys; k++)
        if (schema_value_of(contact, keys[k])->given) return keys[k];
    return NULL;
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
    const schema_instance *contact = schema_get(groups, "contact", 0);
    const char *asking = asking_key(contact);
    if (options->bodies == DEM_BODIES_NONE) return true;
    const dem_index bare = find_bare(lattice);
    if (bare == -1) return true;
    if (bare < 0) return false;
    if (asking != NULL) {
        namelist_errors_add(errors, schema_place(contact, asking),
                            "'%s' in &contact: body %zu has no triangles, and so no surface that could touch bodies; "
                            "bodies = 'none' lets it run",
                            asking, number_of(bodies, schema_count(groups, "body"), bare));
        return true;
    }
    const schema_instance *rigid = rigid_keys_first(groups);
    if (rigid != NULL) {
        namelist_errors_add(errors, schema_place(rigid, "rigid"),
                            "'rigid' in &body needs contact of bodies, but body %zu has no triangles, and so no "
                            "surface that could touch bodies",
                            number_of(bodies, schema_count(groups, "body"), bare));
        return true;
    }
    options->bodies = DEM_BODIES_NONE;
    return give_up(groups);
}
