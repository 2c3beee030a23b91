/* SPDX-License-Identifier: BSD-3-Clause */
/* The whole surface of the bodies as their contact with each other needs it: all boundary edges, whether or not they
 * may touch obstacles, and the contact thickness and modulus of every body. */
#ifndef DEM_SURFACE_CONTACT_CONTACT_SURFACE_H
#define DEM_SURFACE_CONTACT_CONTACT_SURFACE_H

#include <stdbool.h>

#include "base/vec2.h"
#include "model/surface.h"
#include "model/touching_bodies.h"

/** What a body's surface pushes with. */
typedef struct surface_law {
    double thickness; /* m, distance at which it begins to push */
    double modulus;   /* N/m, scale of the pressure */
    double friction;  /* coefficient */
} surface_law;

/** The smaller thickness, modulus and friction. */
static inline surface_law surface_law_smaller(surface_law a, surface_law b)
{
    return (surface_law){a.thickness < b.thickness ? a.thickness : b.thickness,
                         a.modulus < b.modulus ? a.modulus : b.modulus,
                         a.friction < b.friction ? a.friction : b.friction};
}

typedef struct contact_surface {
    const dem_lattice *lattice;
    const touching_bodies *part; /* by which a part of a lattice has the surface of the whole; NULL: it is the whole */
    surface surface;             /* whole */
    dem_index n_nodes;           /* on edges */
    dem_index *nodes;            /* [n_nodes] their numbers in the lattice, ascending */
    double *half_length;         /* [n_nodes] m, half of what a node has of the surface at rest */
    dem_index *corner;           /* [n_edges] the third corner of the triangle of each edge */
    double *length;              /* [n_edges] m, at rest */
    double *plate;               /* [n_edges] m, thickness of the triangle of each edge */
    dem_index *opposite; /* [n_edges] the third corner of the broken triangle on the other side of each edge; -1: none,
                            or that corner is on no surface */
    double *filled; /* [n_edges] m, how far that corner and the edge were apart when the triangle broke, at most its
                            height at rest: it pushes below that; 0: it does not */
    double highest; /* m, these at most */
    dem_index n_bodies;
    surface_law *laws;       /* [n_bodies] */
    surface_law least, most; /* of all bodies, component by component */
    double mean_length;      /* m, of the edges at rest */
} contact_surface;

/** \param thickness  m, of all bodies; 0: a fifth of the mean edge of each body, and less than half of its shortest
 *  \param stiffness  factor of the modulus
 *  \return DEM_ERROR_MODEL if a body has no triangles, or the thickness is not below half of its shortest edge;
 *          DEM_ERROR_MEMORY. Borrows the lattice. Free with contact_surface_free(). */
dem_status contact_surface_compile(contact_surface *out, const dem_lattice *lattice, double thickness,
                                   double stiffness);
void contact_surface_free(contact_surface *c);

/** The same of the lattice that a rank has a part of, in which are all nodes of the surface: with the bits, and the
 *  order of edges and nodes, of the whole. Borrows the bodies. */
dem_status contact_surface_compile_part(contact_surface *out, const dem_lattice *lattice, const touching_bodies *bodies,
                                        double thickness, double stiffness);

/** Makes in `out` the surface that c becomes where triangles break: that of those that are whole, of which this is the
 *  boundary, as contact_surface_compile() finds it in a lattice without the others, in the same order.
 *  `broken` [n_triangles] are these others, 1: broken; NULL: there are none. What breaks fills its place as it is at
 *  positions x [n][2]; NULL: as at rest. What has filled its place before stays as it is. Bodies and laws are those of
 *  c, which stays: one of the two is freed with contact_surface_free_outline(). A node that is left without a triangle
 *  is on no surface.
 *  \return DEM_ERROR_MEMORY */
dem_status contact_surface_break(contact_surface *out, const contact_surface *c, const mesh_boundary *boundary,
                                 const unsigned char *broken, const double *x);
void contact_surface_free_outline(contact_surface *c);

/** What fills less than the height at rest, as a checkpoint has it: numbers of 8 bytes. */
typedef struct squeezed_filling {
    dem_index first, second; /* nodes of its edge */
    double height;           /* m, below which it pushes; 0: it does not */
} squeezed_filling;

/** Lists these, in the order of edges, if `list` is not NULL.  \return how many there are */
dem_index contact_surface_squeezed(const contact_surface *c, squeezed_filling *list);

/** Has n of a checkpoint in the place of all, on the surface of the same broken triangles.
 *  \return DEM_ERROR_IO for a filling that is not possible; some may have been changed then */
dem_status contact_surface_squeeze(contact_surface *c, const squeezed_filling *list, dem_index n);

/** The distance that nothing is to be nearer than in order to push, m: of surfaces, and of what fills cracks. */
static inline double contact_surface_reach(const contact_surface *c)
{
    return c->most.thickness > c->highest ? c->most.thickness : c->highest;
}

/** Height at rest of the broken triangle on the other side of an edge, m. */
double contact_surface_height(const contact_surface *c, dem_index edge);

/** The edge from one node to another; -1 if there is none. */
static inline dem_index contact_surface_edge(const contact_surface *c, dem_index first, dem_index second)
{
    for (dem_index p = c->surface.row[first]; p < c->surface.row[first + 1]; p++) {
        const dem_index *ends = &c->surface.ends[2 * c->surface.at[p]];
        if (ends[0] == first && ends[1] == second) return c->surface.at[p];
    }
    return -1;
}

/** Gives the bodies their friction: `of_bodies` [n_bodies], or `of_all` where that is NULL. At first they have none. */
void contact_surface_set_friction(contact_surface *c, double of_all, const double *of_bodies);

/** Whether any body has friction. */
static inline bool contact_surface_has_friction(const contact_surface *c)
{
    return c->most.friction > 0.0;
}

/** First and second end of an edge. */
static inline dem_index contact_surface_first(const contact_surface *c, dem_index edge)
{
    return c->surface.ends[2 * edge];
}

static inline dem_index contact_surface_second(const contact_surface *c, dem_index edge)
{
    return c->surface.ends[2 * edge + 1];
}

/** The number of a node in the whole lattice, for messages and reports. */
static inline dem_index contact_surface_number(const contact_surface *c, dem_index node)
{
    return touching_bodies_node(c->part, node);
}

/** The body of a node. */
static inline dem_index contact_surface_body(const contact_surface *c, dem_index node)
{
    return c->lattice->body[node];
}

/** The law between two bodies, or of a body with itself. It is the same for all edges of two bodies, since terms of
 *  different edges cancel each other. */
static inline surface_law contact_surface_law(const contact_surface *c, dem_index body, dem_index other)
{
    return surface_law_smaller(c->laws[body], c->laws[other]);
}

#endif
