/* SPDX-License-Identifier: BSD-3-Clause */
/** dem/slab.h -- a lattice made in slabs, so that none of several processes has to have the whole of it. Slabs of a
 *  file are read by dem_slab_read() of dem/trajectory.h. */
#ifndef DEM_SLAB_H
#define DEM_SLAB_H

#include <dem/lattice.h>
#include <dem/shape.h>

#ifdef __cplusplus
extern "C" {
#endif

/** What a range of the nodes of a whole lattice has of it: these nodes, its *own* ones, the nodes that share a
 *  triangle or a spring with one of them, its *rim*, and the triangles at own nodes. Both have the order of the whole,
 *  own nodes without gaps, and triangles too, but for some slabs of files and of smooth edges. The lattice is assembled
 *  and edited as any other, by functions that look at nodes and triangles one by one (dem_lattice_assemble(), and
 *  dem_lattice_inside() with dem_lattice_assemble_mixed(); dem_lattice_move(), dem_lattice_launch(),
 *  dem_lattice_spin_about(), dem_lattice_exclude(); dem_lattice_weibull() with numbers). Own nodes, and springs and
 *  triangles at them, then have the bits that they have in the whole. Of the rim only places and bodies have: masses,
 *  flags, and springs between two of its nodes, lack what other ranges have of them. Numbers in messages are those of
 *  the slab. */
typedef struct dem_slab {
    size_t struct_size;       /**< set by dem_slab_empty() */
    dem_index n_nodes;        /**< of the whole, */
    dem_index n_triangles;    /**< likewise */
    dem_index first_node;     /**< the number in the whole of the first own node; the others follow it there */
    dem_index first_triangle; /**< the number in the whole of triangle 0 of `lattice`; the others follow it there. In
                                   slabs of files and of smooth edges it is -1 if they do not, or if there are none */
    dem_index first_own;      /**< in `lattice`, of the n_own nodes that are own ones, one behind the other */
    dem_index n_own;          /**< > 0 */
    dem_index *rim; /**< [lattice.n_nodes - n_own] numbers in the whole of the other nodes of `lattice`, ascending */
    unsigned char *rim_boundary; /**< [the same] 1: on the boundary of the triangles of the whole, where
                                    dem_slab_jitter() leaves it; NULL: not known */
    dem_lattice lattice;         /**< all is to be freed with dem_slab_free() */
} dem_slab;

/** No nodes. Every slab begins like this. */
static inline dem_slab dem_slab_empty(void) /* inline: sizeof is the caller's */
{
    dem_slab slab;
    memset(&slab, 0, sizeof slab);
    slab.struct_size = sizeof slab;
    slab.lattice = dem_lattice_empty();
    return slab;
}

/** Frees the arrays and leaves an empty slab. Accepts NULL, and does nothing where there is no struct_size. */
DEM_API void dem_slab_free(dem_slab *slab);

/** Of n_parts slabs of dem_lattice_rectangle(), the lowest first, the one with number `part`. Each has the same number
 *  of rows, or one more; own nodes are whole rows, and the rim is a row below them and one above. No more than these,
 *  and for a moment a further row on each side, is made. Assembled by dem_lattice_assemble().
 *  \param[out] out  from dem_slab_empty(); overwritten, not freed; caller owns it
 *  \param part      0 <= part < n_parts
 *  \return as dem_lattice_rectangle(); DEM_ERROR_MODEL for more parts than rows of nodes */
DEM_API dem_status dem_slab_rectangle(dem_slab *out, double width, double height, double spacing, dem_index part,
                                      dem_index n_parts);

/** The same of dem_lattice_squares(). Assembled by dem_lattice_assemble_squares(). */
DEM_API dem_status dem_slab_squares(dem_slab *out, double width, double height, double spacing, dem_index part,
                                    dem_index n_parts);

/** The same of dem_shape_lattice(): whole rows of what is left where the outline, voids and pores have cut the grid,
 *  about as many nodes in each slab. Parts of the body that are not connected stay, as they do there. To number its
 *  nodes a slab counts what is left of the rows of all: it looks at each place, as cutting the whole does, but at some
 *  rows at a time. Its own rows it makes from one end of the grid to the other, before they are cut. Smooth edges are
 *  made in 72 rows more on each side, which tell what becomes of these rows in the whole; nodes of its rim are in two
 *  rows on each side.
 *  \param shape  not numbered, as triangles are numbered in the whole
 *  \return as dem_shape_lattice(), also where a void lies wholly outside of the body; DEM_ERROR_MODEL for more parts
 *          than rows in which something is left, and where triangles at a smooth edge depend on what is farther off,
 *          as in about one of 1000 random shapes with pores that overlap */
DEM_API dem_status dem_slab_shape(dem_slab *out, const dem_shape *shape, dem_index part, dem_index n_parts);

/** Moves nodes as dem_lattice_jitter() moves those of the whole. For slabs as they are made.
 *  \param radius  m, 0 to 0.3 of the shortest side of a triangle
 *  \return DEM_ERROR_ARGUMENT, also for a slab that has no place in a whole, or without rim_boundary; DEM_ERROR_MODEL
 *          for one that has springs, and where a triangle would keep less than a tenth of its area, as some at smooth
 *          edges do; DEM_ERROR_MEMORY; then nothing has changed */
DEM_API dem_status dem_slab_jitter(dem_slab *slab, double radius, uint64_t seed);

#ifdef __cplusplus
}
#endif

#endif
