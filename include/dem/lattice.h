/* SPDX-License-Identifier: BSD-3-Clause */
/** dem/lattice.h -- what bodies are made of: materials, and lattices as plain arrays, generated, assembled, edited.
 *  A lattice becomes a model in dem/model.h; files of lattices are read in dem/trajectory.h. */
#ifndef DEM_LATTICE_H
#define DEM_LATTICE_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <dem/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- lattice: what the body is made of ------------------------------------------------------------------------ */

typedef enum dem_plane {
    DEM_PLANE_STRESS = 0, /**< a thin plate, free to change its thickness */
    DEM_PLANE_STRAIN      /**< a slice of a long body, which keeps its thickness */
} dem_plane;

/** How the three springs of a triangle answer to its strain. */
typedef enum dem_springs {
    DEM_SPRINGS_INDEPENDENT = 0, /**< each for itself: exact in equilateral triangles */
    DEM_SPRINGS_COUPLED          /**< the tension of each depends on all three: exact in any triangle */
} dem_springs;

/** Which stress breaks a triangle. */
typedef enum dem_stress_average {
    DEM_STRESS_AVERAGE_CORNERS = 0, /**< the mean of its three corners' stresses, each a mean of their triangles' */
    DEM_STRESS_AVERAGE_ELEMENT      /**< its own */
} dem_stress_average;

/** An isotropic solid; `plane` says how it is a body in the plane. */
typedef struct dem_material {
    size_t struct_size;    /**< to be set to sizeof(dem_material), in each of an array */
    double youngs_modulus; /**< E, Pa, > 0; 0 where the springs are given by bond_stiffness */
    double bond_stiffness; /**< 0, or E_ij, N, > 0: every spring has this, as the paper draws them, whatever its length;
                                nothing else is known then, neither E nor nu                                    (1) */
    double poissons_ratio; /**< nu, in (-1, 1) in plane stress, in (-1, 0.5) in plane strain. Springs alone have 1/3 in
                                plane stress, 1/4 in plane strain; any other needs the area term */
    dem_plane plane;
    double density;          /**< rho, kg/m^3, > 0 */
    double thickness;        /**< h, m, > 0 */
    double guard;            /**< strength of the folding guard over E h, >= 0; 0: none; usual: 0.02 */
    double damping_time;     /**< of the springs (Kelvin-Voigt), s, >= 0: a strain rate e' acts like a strain
                                damping_time e'; 0: none */
    dem_springs springs;     /**< of triangles; coupled ones go neither with bond_stiffness nor with cells */
    double strength;         /**< Pa, >= 0: of its triangles; 0: none breaks by its stress */
    double critical_stretch; /**< >= 0: strain at which its springs break; 0: none does */
    double fracture_energy;  /**< G_f, J/m^2, >= 0, that a crack takes for its area; 0: what follows from the strength.
                                  Without a strength triangles are brittle, with one that follows from it; with both
                                  they soften. Neither with critical_stretch nor with bond_stiffness */
    double compressive_strength;       /**< Pa, 0 or >= strength: under pressure alone, with a strength and without a
                                      fracture energy; 0: pressure breaks nothing. See dem_lattice */
    dem_stress_average stress_average; /**< of its triangles, not of cells; that of the element with a strength and a
                                            fracture energy */
} dem_material;

enum {
    DEM_NODE_FIXED = 1,   /**< never moves */
    DEM_NODE_CONTACT = 2, /**< may touch obstacles */
    DEM_NODE_RIGID = 4,   /**< of a rigid body: all nodes of a body are, or none */
    DEM_NODE_GUIDE_X = 8, /**< of a rigid body that only moves along x, or y, and does not turn */
    DEM_NODE_GUIDE_Y = 16
};

/** How a rigid body may move. */
typedef enum dem_guide {
    DEM_GUIDE_NONE = 0, /**< freely */
    DEM_GUIDE_X,        /**< along x alone, without turning */
    DEM_GUIDE_Y
} dem_guide;

/** Nodes, springs in triplet form (any order, no duplicates) and triangles. Every array is owned by the lattice and
 *  comes from malloc; dem_lattice_free() frees them all. */
typedef struct dem_lattice {
    size_t struct_size;     /**< set by dem_lattice_empty() */
    int dim;                /**< 2; 3 is reserved */
    dem_index n_nodes;      /**< > 0 */
    dem_index n_springs;    /**< >= 0 */
    dem_index n_triangles;  /**< >= 0 */
    double *x;              /**< [n_nodes][2]     rest position, m */
    double *mass;           /**< [n_nodes]        m_i > 0, kg */
    dem_index *ends;        /**< [n_springs][2]   the two nodes, distinct */
    double *rest_length;    /**< [n_springs]      d0_ij > 0, m                                   (1) */
    double *stiffness;      /**< [n_springs]      E_ij > 0, N: force at unit strain              (1) */
    dem_index *triangles;   /**< [n_triangles][3] counter-clockwise; NULL: none */
    double *viscosity;      /**< [n_springs]      force at unit strain rate >= 0, N s; NULL: undamped */
    double *guard;          /**< [n_triangles]    guard strength >= 0, N/m; NULL: none */
    double *area_stiffness; /**< [n_triangles]   kappa of the area term, of any sign, N/m: the energy
                                kappa/2 (A - A0)^2/A0 of a triangle of area A; NULL: none */
    double *thickness;      /**< [n_triangles]    > 0, m, for stresses and pressures; NULL: 1 m */
    double *modulus; /**< [n_triangles]    > 0, Pa, for stresses: each triangle of a spring has a share of its force
                                in proportion to modulus * thickness * area, and where springs are coupled to the
                                weight of docs/algorithms.md, Shares. No force depends on it. NULL: the same in all */
    unsigned char *flags; /**< [n_nodes] DEM_NODE_...; NULL: none fixed, contact on the boundary of
                                the triangulation, on every node where there are no triangles */
    int32_t *body;        /**< [n_nodes]        body number from 0; NULL: one body */
    double *position;     /**< [n_nodes][2]     where the motion starts, m; NULL: at x */
    double *velocity;     /**< [n_nodes][2]     with which velocity, m/s; NULL: at rest */
    double *coupling;     /**< [n_triangles][3] of any sign, N/m: at each corner the tension of one of its two edges
                                per change of length of the other. An edge that has one needs a spring; NULL: none */
    double *strength; /**< [n_triangles]    > 0, Pa: a triangle breaks when the largest principal value of the mean of
                                its corners' stresses reaches it; INFINITY: never; NULL: none breaks by its stress */
    double *critical_stretch; /**< [n_springs] > 0: a spring breaks when its strain reaches it, with the triangles that
                                hold it; INFINITY: never; NULL: none breaks by its strain */
    double *softening; /**< [n_triangles]   q >= 1: at its strength a triangle does not break yet, but has less and less
                            left in tension, nothing at q times the strain; 1: it breaks; NULL: 1 in all */
    double *compressive_strength; /**< [n_triangles] f_c >= strength, Pa: a triangle breaks when max(s1, 0)/strength -
                            min(s3, 0)/f_c reaches 1, s1 >= s3 being the principal values of the mean of its corners'
                            stresses. Of one that does not soften; INFINITY: pressure alone does not break it; NULL:
                            INFINITY in all */
    double *confinement; /**< [n_triangles] k >= 0: where s1 is a pressure, too, it breaks when -s3 is f_c - k s1. With
                            f_c/strength that is Mohr-Coulomb's law in plane strain, with 0 in plane stress, where the
                            largest principal stress is that of the free faces; NULL: 0 in all */
    unsigned char *own_stress; /**< [n_triangles] 1: its own stress breaks it or lets it soften, 0: the mean of its
                            corners' stresses; NULL: 0 in all */
} dem_lattice;

/** No nodes, all arrays NULL. Every lattice begins like this: functions that make one write no further than the
 *  struct_size that this sets. */
static inline dem_lattice dem_lattice_empty(void) /* inline: sizeof is the caller's */
{
    dem_lattice lattice;
    memset(&lattice, 0, sizeof lattice); /* C++ warns of = {0} */
    lattice.struct_size = sizeof lattice;
    lattice.dim = 2;
    return lattice;
}

/** Frees the arrays and leaves an empty lattice. Accepts NULL, and does nothing where there is no struct_size. */
DEM_API void dem_lattice_free(dem_lattice *lattice);

/** Equilateral triangulation of a rectangle standing on the origin: -width/2 <= x <= width/2, 0 <= y <= height.
 *  Rows alternate between round(width/spacing) + 1 nodes and one less, so that it is mirror symmetric; the spacing is
 *  kept and the height rounded to whole rows. Nodes and triangles only: dem_lattice_assemble() makes it a solid.
 *  \param[out] out  from dem_lattice_empty(); overwritten, not freed; caller owns it
 *  \return DEM_ERROR_ARGUMENT unless 0 < spacing <= width, height; DEM_ERROR_MEMORY */
DEM_API dem_status dem_lattice_rectangle(dem_lattice *out, double width, double height, double spacing);

/** The same of square cells: round(width/spacing) x round(height/spacing) of them, each of two triangles, 2 k and
 *  2 k + 1, whose common sides turn from cell to cell. dem_lattice_assemble_squares() makes it a solid. What cuts it
 *  should take both triangles of a cell or none. Otherwise as dem_lattice_rectangle(). */
DEM_API dem_status dem_lattice_squares(dem_lattice *out, double width, double height, double spacing);

/** Equilateral triangulation of a disc about the origin, with a node at its centre. Otherwise as
 *  dem_lattice_rectangle(), with 0 < spacing <= radius. */
DEM_API dem_status dem_lattice_disc(dem_lattice *out, double radius, double spacing);

/** Removes the nodes for which `keep` returns false, the triangles that lose a corner, and nodes left without a
 *  triangle. For triangulations not yet assembled; a lattice that has springs is refused.
 *  \return DEM_ERROR_MODEL if nothing is left */
DEM_API dem_status dem_lattice_cut(dem_lattice *lattice, bool (*keep)(void *context, const double *x), void *context);

/** Keeps the triangles for which keep[t], and the nodes that have one of them. For triangulations not yet
 *  assembled; a lattice that has springs is refused.
 *  \param keep  [n_triangles]
 *  \return DEM_ERROR_MODEL if nothing is left */
DEM_API dem_status dem_lattice_trim(dem_lattice *lattice, const bool *keep);

/** Number of pieces of a triangulation. Triangles that share an edge are of one piece; those that share but a node, a
 *  hinge, are not.
 *  \param[out] piece  [n_triangles] the piece of each triangle, numbered by their lowest ones; may be NULL */
DEM_API dem_status dem_lattice_pieces(const dem_lattice *lattice, dem_index *n_pieces, dem_index *piece);

/** Number of boundary edges at each node: 0 inside and without triangles, 2 on the boundary, more at a hinge.
 *  \param[out] n_edges  [n_nodes] */
DEM_API dem_status dem_lattice_rims(const dem_lattice *lattice, dem_index *n_edges);

/** Springs, masses and what triangles have, by the finite-element rule: a triangle of area A gives each edge e the
 *  stiffness (8/3) G h A/|e|^2 times the edge's length, in N, and each corner a third of its mass; its area
 *  stiffness is (lambda - G) h. G = E/(2 (1 + nu)) and lambda = E nu/(1 - nu^2) are those of plane stress; a solid in
 *  plane strain is a plate of E/(1 - nu^2) and nu/(1 - nu). A block of equilateral triangles then has exactly E and nu.
 *  With coupled springs the triangles that are not equilateral get other stiffnesses, and couplings, such that any
 *  block of triangles has exactly E and nu.
 *  With a damping time each spring gets the viscosity damping_time times its stiffness. A strength and a critical
 *  stretch are written beside every triangle and spring; without a strength those that the lattice has stay.    (1)
 *  With a compressive strength the confinement is what the plane makes it: see dem_lattice.
 *  \return DEM_ERROR_ARGUMENT where triangles are too large for their strength and fracture energy: the edge of an
 *  equilateral one of their mean area may be E G_f/(3.4 strength^2) at most, where their own stress breaks them
 *  E G_f/(1.64 strength^2) */
DEM_API dem_status dem_lattice_assemble(dem_lattice *lattice, const dem_material *material);

/** The same for cells of two triangles each, 2 k and 2 k + 1, that make a convex quadrilateral; both its diagonals are
 *  springs. A cell gives half of E h/(1 + nu) to each side, `diagonal` times E h/(1 + nu) to both diagonals, and each
 *  corner of a square a quarter of its mass. A block of squares then has exactly E and nu along its sides, and the
 *  shear stiffness diagonal E/(1 + nu): 0.5 is isotropic, and nu = diagonal/(1 + diagonal) needs no area term.
 *  \param diagonal  stiffness of a diagonal over that of a side, both in N/m, > 0 and less than (1 + nu)/(2 (1 - nu)),
 *                   or cells warp; usual: 0.5, for nu > 0. Not used with a bond stiffness
 *  \return as dem_lattice_assemble(); sides of squares may be E G_f/(3.55 strength^2) at most */
DEM_API dem_status dem_lattice_assemble_squares(dem_lattice *lattice, const dem_material *material, double diagonal);

/** The same of several materials. Every triangle gives stiffness, mass and damping by its own; so a spring between two
 *  materials is half of one and half of the other, and they hold together. A bond stiffness is for one material only.
 *  \param materials  [n_materials]
 *  \param of         [n_triangles] number of each triangle's material, from 0, the same for both triangles of a cell;
 *                    NULL: the first
 *  \param diagonal   of cells, as in dem_lattice_assemble_squares(); 0: triangles */
DEM_API dem_status dem_lattice_assemble_mixed(dem_lattice *lattice, const dem_material *materials,
                                              dem_index n_materials, const dem_index *of, double diagonal);

/** Strengths that scatter by Weibull's law of the weakest link: a piece of volume V stands the share s of the strength
 *  sigma_0 of its material with the probability exp(-(V/V_0) s^m). The strength of a body under uniform stress then
 *  depends on its volume, and not on the mesh. */
typedef struct dem_weibull {
    size_t struct_size; /**< to be set to sizeof(dem_weibull), in each of an array */
    double shape;       /**< m, >= 0: the larger, the less strengths scatter; 0: they do not, all factors are 1 */
    double volume;      /**< V_0, m^3, > 0: of a piece of which a share of 1/e stands sigma_0 */
    double section;     /**< m^2, >= 0: of springs that no triangle holds, whose volume is this times their rest length;
                           0: there are none. That of the first law counts */
    uint64_t seed;
    dem_index body; /**< lattices with different numbers draw differently by one seed */
    const dem_index
        *number; /**< [n_triangles] distinct, in [0, 2^60): by which they draw; NULL: their own. A part that is cut
                                out of a lattice draws like the whole where it keeps the numbers of that */
} dem_weibull;

/** Draws factors of strengths and critical stretches for dem_lattice_weaken(), which are the caller's to bound:
 *  ((V_0/V) (-ln u))^(1/m), with u uniform in (0, 1) by seed, body and number alone, the same bits on every machine. V
 *  is the volume of a triangle, thickness times area in the rest shape. Each triangle gives its volume to the springs
 *  that it holds in equal parts; what they have of it is the volume of springs.
 *  \param laws  [n_laws]
 *  \param of    [n_triangles] number of each triangle's law, from 0; NULL: the first. A spring between two laws has the
 *               smaller factor of both
 *  \param[out] triangle_factor  [n_triangles]; may be NULL
 *  \param[out] spring_factor    [n_springs]; may be NULL
 *  \return DEM_ERROR_ARGUMENT for a law that is none, DEM_ERROR_MODEL where a triangle or a spring has no volume;
 *          factors are then of no meaning */
DEM_API dem_status dem_lattice_weibull(const dem_lattice *lattice, const dem_weibull *laws, dem_index n_laws,
                                       const dem_index *of, double *triangle_factor, double *spring_factor);

/** Multiplies strengths, fracture energies and critical stretches by factors > 0, as dem_lattice_weibull() draws them.
 *  The compressive strength of a triangle has the factor of its strength.
 *  Only triangles that soften have an energy of their own: with another strength or energy they get another softening.
 *  One that would have to be stronger than a brittle triangle of its energy is brittle, and as strong as that; one that
 *  its own stress lets soften does so by 3 at least.
 *  \param strength_factor  [n_triangles]; NULL: 1
 *  \param energy_factor    [n_triangles]; NULL: 1
 *  \param stretch_factor   [n_springs]; NULL: 1
 *  \return DEM_ERROR_ARGUMENT; then nothing has changed */
DEM_API dem_status dem_lattice_weaken(dem_lattice *lattice, const double *strength_factor, const double *energy_factor,
                                      const double *stretch_factor);

/** Moves every node that is not on the boundary of the triangles to a random place within `radius`, m, >= 0, of it, the
 *  same on every machine. Where a triangle would keep less than a tenth of its area, its corners go half as far. For
 *  triangulations not yet assembled; a lattice that has springs is refused. */
DEM_API dem_status dem_lattice_jitter(dem_lattice *lattice, double radius, uint64_t seed);

/** Number of parts that springs do not connect.
 *  \param[out] part  [n_nodes] the part of each node, numbered by their lowest nodes; may be NULL */
DEM_API dem_status dem_lattice_parts(const dem_lattice *lattice, dem_index *n_parts, dem_index *part);

/** Keeps the nodes for which keep[i], with the springs and triangles among them.  \param keep [n_nodes] */
DEM_API dem_status dem_lattice_select(dem_lattice *lattice, const bool *keep);

/** Turns the lattice by `angle` (radians, about the origin) and shifts it; initial positions and velocities turn
 *  too. */
DEM_API void dem_lattice_move(dem_lattice *lattice, double angle, const double offset[2]);

/** Adds `velocity` (m/s) to the initial velocity of every node. */
DEM_API dem_status dem_lattice_launch(dem_lattice *lattice, const double velocity[2]);

/** Adds a rigid rotation about the centre of mass, where the nodes start, to the initial velocities. That centre is the
 *  sum of m_i x_i, in the order of the nodes, times 1/(the sum of m_i).
 *  \param angular_velocity  rad/s, counter-clockwise
 *  \return DEM_ERROR_MODEL without masses: dem_lattice_assemble() comes first */
DEM_API dem_status dem_lattice_spin(dem_lattice *lattice, double angular_velocity);

/** The same about a given place, to the same bits where that is the centre of mass: for a part of a body, of which the
 *  part alone does not know it.  \param centre  m */
DEM_API dem_status dem_lattice_spin_about(dem_lattice *lattice, double angular_velocity, const double centre[2]);

/** Takes nodes from contact: they may not touch obstacles, nor may the edges between them.  \param nodes [n] */
DEM_API dem_status dem_lattice_exclude(dem_lattice *lattice, const dem_index *nodes, dem_index n);

/** Makes all bodies of the lattice rigid: their springs and triangles carry nothing, and bound no step. Rigid bodies
 *  need the option `bodies`, by which they touch other bodies; obstacles they meet with their whole surface by the same
 *  law, with the obstacles' friction (Coulomb's) and without restitution.
 *  \param guide  how they may move */
DEM_API dem_status dem_lattice_stiffen(dem_lattice *lattice, dem_guide guide);

/** What each of some nodes has of the boundary edges between them, half of each edge: by its length in the rest shape,
 *  or, along a unit `direction` [2], by the length of its projection on that, times the thickness of its triangle. For
 *  tractions: dem_boundary's share.
 *  \param nodes      [n] distinct
 *  \param direction  may be NULL
 *  \param[out] area  [n] m^2, sum over the nodes: area of the edges */
DEM_API dem_status dem_lattice_edge_shares(const dem_lattice *lattice, const dem_index *nodes, dem_index n,
                                           const double *direction, double *area);

/** Appends a copy of `other`; its bodies are numbered after those of `lattice`. */
DEM_API dem_status dem_lattice_append(dem_lattice *lattice, const dem_lattice *other);

#ifdef __cplusplus
}
#endif

#endif
