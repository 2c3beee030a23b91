/* SPDX-License-Identifier: BSD-3-Clause */
/* The whole surface of the bodies as their contact with each other needs it: all boundary edges, whether or not they
 * may touch obstacles, and the contact thickness and modulus of every body. */
#ifndef DEM_SURFACE_CONTACT_CONTACT_SURFACE_H
#define DEM_SURFACE_CONTACT_CONTACT_SURFACE_H

#include "base/vec2.h"
#include "model/surface.h"

/** What a body's surface pushes with. */
typedef struct surface_law {
    double thickness; /* m, distance at which it begins to push */
    double modulus;   /* N/m, scale of the pressure */
} surface_law;

typedef struct contact_surface {
    const dem_lattice *lattice;
    surface surface;                        /* whole */
    dem_index n_nodes;                      /* on edges */
    dem_index *nodes;                       /* [n_nodes] their numbers in the lattice, ascending */
    double *half_length;                    /* [n_nodes] m, half of what a node has of the surface at rest */
    dem_index *corner;                      /* [n_edges] the third corner of the triangle of each edge */
    double *length;                         /* [n_edges] m, at rest */
    surface_law *laws;                      /* [n_bodies] */
    double mean_length;                     /* m, of the edges at rest */
    double least_thickness, most_thickness; /* m, of all bodies */
} contact_surface;

/** \param thickness  m, of all bodies; 0: a fifth of the mean edge of each body, and less than half of its shortest
 *  \param stiffness  factor of the modulus
 *  \return DEM_ERROR_MODEL if a body has no triangles, or the thickness is not below half of its shortest edge;
 *          DEM_ERROR_MEMORY. Borrows the lattice. Free with contact_surface_free(). */
dem_status contact_surface_compile(contact_surface *out, const dem_lattice *lattice, double thickness,
                                   double stiffness);
void contact_surface_free(contact_surface *c);

/** First and second end of an edge. */
static inline dem_index contact_surface_first(const contact_surface *c, dem_index edge)
{
    return c->surface.ends[2 * edge];
}

static inline dem_index contact_surface_second(const contact_surface *c, dem_index edge)
{
    return c->surface.ends[2 * edge + 1];
}

/** The body of a node. */
static inline dem_index contact_surface_body(const contact_surface *c, dem_index node)
{
    return c->lattice->body[node];
}

/** The law between two bodies, or of a body with itself: the smaller thickness, and the smaller modulus. It is the same
 *  for all edges of two bodies, since terms of different edges cancel each other. */
static inline surface_law contact_surface_law(const contact_surface *c, dem_index body, dem_index other)
{
    const surface_law a = c->laws[body], b = c->laws[other];
    return (surface_law){fmin(a.thickness, b.thickness), fmin(a.modulus, b.modulus)};
}

#endif
