/* SPDX-License-Identifier: BSD-3-Clause */
/** dem/simulation.h -- the moving state of a model: options, the time loop, and what can be asked of the motion.
 *  Those who are shown a run while it goes on are observers: dem/observer.h. */
#ifndef DEM_SIMULATION_H
#define DEM_SIMULATION_H

#include <string.h>

#include <dem/checkpoint.h>
#include <dem/method.h>
#include <dem/model.h>

#ifdef __cplusplus
extern "C" {
#endif

/** What is done to nodes from outside. */
typedef enum dem_boundary_kind {
    DEM_BOUNDARY_VELOCITY = 0, /**< components of the velocity are `value` times the ramp; 0 holds them still */
    DEM_BOUNDARY_DISPLACEMENT, /**< components of the way from the initial position are `value` times the ramp */
    DEM_BOUNDARY_FORCE         /**< node k feels the force share[k] * `value` times the ramp */
} dem_boundary_kind;

enum { DEM_COMPONENT_X = 1, DEM_COMPONENT_Y = 2 };

/** The ramp is 10 s^3 - 15 s^4 + 6 s^5, s = t/ramp, up to s = 1 and 1 from there; 1 at all times for ramp = 0. Nodes
 *  with prescribed components do not touch obstacles: dem_lattice_exclude(). */
typedef struct dem_boundary {
    size_t struct_size; /**< to be set to sizeof(dem_boundary), in each of an array */
    dem_boundary_kind kind;
    int32_t components; /**< which are prescribed, DEM_COMPONENT_X | DEM_COMPONENT_Y; a force has both */
    dem_index n_nodes;
    const dem_index *nodes; /**< [n_nodes] distinct; a component of a node is prescribed only once */
    const double *share;    /**< [n_nodes] of a force; NULL: 1/n_nodes each */
    double value[3];        /**< m/s, m, or N; the third 0 */
    double ramp;            /**< s, >= 0; > 0 for a displacement */
} dem_boundary;

/** Where an external force is wanted: n nodes with their places and velocities at an instant. Where ranks share the
 *  model (dem/mpi.h) "all" are those that this rank integrates, whoever owns them. */
typedef struct dem_force_query {
    double t;               /**< s */
    dem_index n;            /**< nodes asked about: all of them in ascending order, or those near a contact */
    const dem_index *nodes; /**< [n] their numbers in the lattice, of ranks in the whole one */
    const double *x, *v;    /**< [n][2] m, m/s: of nodes[k] at x[2 k], x[2 k + 1] */
} dem_force_query;

/** A force from outside, by which other programs act on the nodes. It may depend on t, the node's number, its x and its
 *  v, and on nothing that changes during an advance: the same query has the same answer, whatever else is asked about
 *  beside it. It is asked for states that are then thrown away, and not in the order of time. What varies in x, v or t
 *  faster than the bodies themselves wants a `max_step` of its own. Called by
 *  dem_simulation_advance() and dem_simulation_resume(), in their thread and never from several at once; by nothing
 *  that only looks at a simulation. Of ranks each calls its own, which answers as those of the others do: several ranks
 *  ask about the same nodes. Whether it does is seen once, before the first step, where a rank asks about nodes next to
 *  its own, too; a difference ends the call on all ranks with DEM_ERROR_ARGUMENT.
 *  \param[out] force  [n][2] N, zero at entry
 *  \return other than DEM_OK to end the advance, which returns it */
typedef dem_status (*dem_force)(void *context, const dem_force_query *query, double *force);

/** With which instructions forces are evaluated. All give the same results to the bit. */
typedef enum dem_kernel {
    DEM_KERNEL_AUTO = 0, /**< the last of these that the machine has */
    DEM_KERNEL_PORTABLE, /**< C, on any machine */
    DEM_KERNEL_AVX2,
    DEM_KERNEL_AVX512 /**< F, DQ and VL */
} dem_kernel;

/** The kernel of a name, as in decks: "avx2"; on this machine or not.  \return DEM_ERROR_ARGUMENT if there is none */
DEM_API dem_status dem_kernel_find(dem_kernel *out, const char *name);

/** NULL if there is no such kernel. */
DEM_API const char *dem_kernel_name(dem_kernel kind);

/** How contact events inside a step are taken. */
typedef enum dem_contact_method {
    DEM_CONTACT_LOCAL, /**< each where and when it happens; what follows is corrected near it, at a cost that does not
                            grow with the body */
    DEM_CONTACT_EXACT  /**< the step of the whole body ends at each, located by root functions */
} dem_contact_method;

/** Which surfaces of bodies push each other off. */
typedef enum dem_bodies {
    DEM_BODIES_NONE = 0, /**< none: bodies pass through each other */
    DEM_BODIES_OTHERS,   /**< those of different bodies */
    DEM_BODIES_ALL       /**< all: a body touches itself, too */
} dem_bodies;

/** \return DEM_ERROR_ARGUMENT if this machine, or this build of the library, does not have the kernel */
DEM_API dem_status dem_kernel_check(dem_kernel kind);

typedef struct dem_options {
    size_t struct_size; /**< set by dem_options_default(); docs/linking.md says how structs may grow */
    dem_method method;  /**< default DEM_METHOD_FEHLBERG45 */
    double gravity[3];  /**< m/s^2, default {0, -9.81, 0}; the third is 0 in the plane                    (2) */
    double rtol;        /**< default 1e-6: error of a position over spacing, of a velocity over v_scale */
    double spacing;     /**< m, default 0: shortest rest length; required for a model without springs */
    double v_scale;     /**< m/s, default 0: largest of initial speed, sqrt(2 g drop), 1e-3 sound speed */
    double max_step;    /**< s, default 0: 0.5/omega_max; required for a model without springs. Damping may shorten it:
                               docs/method.md */
    double fixed_step;  /**< s, default 0: adaptive; > 0: steps of this length, no error control. A method that is not
                               adaptive takes max_step, which then is by default stable/(8 omega_max) */
    double penetration_tolerance; /**< m, default 0: 1e-6 spacing. An impact is taken at this depth, which delays it
                               by penetration tolerance/|v_n|, and the node put back on the surface */
    double rest_speed; /**< m/s, default 0: a rebound not faster than this becomes a lasting contact, beside those that
                               do by the rule of docs/method.md. What is below the rule's speed has no effect */
    dem_index max_impacts; /**< default 10000: changes of the contacts of one node or edge within
                               1/omega_max that count as a storm */
    double window;         /**< s, default < 0: see docs/method.md. At an impact, what would arrive within this time
                               is reflected at once, and hops of less than twice this become lasting contacts;
                               0: every impact by itself */
    double mass_damping;   /**< 1/s, default 0: each node feels -mass_damping m v, so that bodies come to rest */
    bool vertices; /**< default true: convex vertices of obstacles touch the edges of bodies; false: only nodes touch */
    dem_contact_method contact; /**< default DEM_CONTACT_LOCAL */
    dem_kernel kernel;          /**< default DEM_KERNEL_AUTO */
    int32_t threads;            /**< default 1, 1 to 1024: threads that work at once, at most; as many are used as pay
                                     (thread_nodes). The results are the same to the bit */
    dem_index checkpoint_steps; /**< default 256: accepted steps between checkpoints, of which the bits of a run depend
                                     as on a tolerance; 0: no checkpoints */
    dem_index n_boundaries;     /**< default 0 */
    const dem_boundary *boundaries; /**< [n_boundaries] copied by dem_simulation_create() */
    dem_force force;                /**< default NULL: no external force */
    void *force_context;            /**< handed to it */
    dem_bodies bodies;              /**< default DEM_BODIES_NONE. The other two need triangles in every body */
    double contact_thickness;   /**< m, default 0: of each body a fifth of its mean boundary edge. The distance at which
                                   surfaces begin to push: less than half of the shortest boundary edge */
    double contact_stiffness;   /**< default 0: 1. Factor of the modulus with which they push, 0.01 to 100 */
    double contact_friction;    /**< default 0: none. Coefficient of friction of bodies with each other and with
                                   themselves, >= 0; not without `bodies` */
    dem_index n_body_frictions; /**< default 0; else the number of bodies */
    const double *body_friction; /**< [n_body_frictions] of each body instead, copied; of two bodies the smaller */
    double pause; /**< default 0: none; else up to 0.1: from a break on the ramps of all boundaries stand still, until
                     dem_simulation_residual() is at most this. Looked at after every 16th step; needs damping to end.
                     Obstacles move on */
    dem_index thread_nodes; /**< default 0; else the nodes that a thread has to have before there is another one. By
                               default 2500, and no more threads than cores that this process may use, by affinity and
                               by the quota of its control group */
} dem_options;

static inline dem_options dem_options_default(void) /* inline: sizeof is the caller's */
{
    dem_options options;
    memset(&options, 0, sizeof options); /* C++ warns of = {0} */
    options.struct_size = sizeof options;
    options.gravity[1] = -9.81;
    options.rtol = 1e-6;
    options.max_impacts = 10000;
    options.window = -1.0;
    options.vertices = true;
    options.threads = 1;
    options.checkpoint_steps = 256;
    return options;
}

/** Energies in J, of the state that is seen, and what has been taken and put in since the start. The ledger is computed
 *  by the library, so that it closes for a program whose header does not know all entries. */
typedef struct dem_energy {
    size_t struct_size; /**< to be set to sizeof(dem_energy) */
    double ledger;   /**< motion + gravity + impact + friction + damping + fracture - projection - boundary - obstacle:
                            what stays constant in a run, up to the integrator's error */
    double motion;   /**< kinetic + elastic + area + guard + contact: what the ledger is compared with */
    double kinetic;  /**< sum m_i v_i.v_i/2 */
    double elastic;  /**< of the springs and their couplings                                           (1) */
    double area;     /**< of the area term; < 0 where nu < 1/3 in plane stress */
    double guard;    /**< of the folding guard */
    double contact;  /**< of surfaces that push each other off, and of what holds bodies by friction */
    double gravity;  /**< -sum m_i g.x_i, zero of height at the origin                                 (2) */
    double impact;   /**< taken by impacts so far, restitution and friction, >= 0                (9), (10) */
    double friction; /**< taken by lasting contacts and bodies that slide so far, >= 0; for bodies it may fall a bit */
    double damping;  /**< taken by the damping of springs and masses so far, >= 0 */
    double fracture; /**< taken by breaking so far: what the broken elements had */
    double projection; /**< put in by returning nodes from the penetration tolerance to the surface so far */
    double boundary;   /**< put in from outside so far: work of what prescribes motions, and of forces */
    double obstacle;   /**< put in by moving obstacles so far, by impacts and in lasting contacts */
} dem_energy;

typedef enum dem_contact_state { DEM_CONTACT_FREE = 0, DEM_CONTACT_SLIP, DEM_CONTACT_STICK } dem_contact_state;

/** A lasting contact: a weighted combination of nodes held by a partner. A node on a segment is one node of weight 1;
 *  an obstacle's vertex on a body's edge is two nodes of weights 1 - s and s. */
typedef struct dem_contact {
    size_t struct_size; /**< to be set to sizeof(dem_contact) */
    dem_contact_state state;
    int32_t n_nodes;      /**< 1 to 4 */
    dem_index nodes[4];   /**< that touch */
    double weights[4];    /**< sum 1 */
    dem_index body;       /**< of these nodes */
    dem_index obstacle;   /**< the partner; -1 if that is a body */
    dem_index segment;    /**< of the obstacle; of a vertex, the segment that ends there */
    dem_index other_body; /**< the partner; -1 if that is an obstacle, as in every contact yet */
    double x[3];          /**< m, where it acts */
    double normal[3];     /**< unit, out of the partner */
    double force;         /**< N, reaction along the normal at the last accepted step, >= 0 */
    double friction[2];   /**< N, reaction along the tangents, the first of which is (normal[1], -normal[0], 0) and the
                               second the third axis, along which nothing acts in the plane */
} dem_contact;

/** What can happen to a contact. */
typedef enum dem_event_kind {
    DEM_EVENT_IMPACT,  /**< a velocity jumped; the contact lasts if `state` is not FREE */
    DEM_EVENT_CLOSE,   /**< a contact begins to last without an impact */
    DEM_EVENT_RELEASE, /**< a lasting contact opens */
    DEM_EVENT_SLIP,    /**< a sticking contact begins to slide */
    DEM_EVENT_STICK,   /**< a sliding contact comes to rest, or turns back if `state` is SLIP */
    DEM_EVENT_PASS     /**< a lasting contact reaches the end of a segment or of a body's edge */
} dem_event_kind;

/** Events are the library's: a program reads of them what its header knows, and struct_size tells what there is. */
typedef struct dem_event {
    size_t struct_size; /**< bytes that the library has filled */
    double t;           /**< s */
    dem_event_kind kind;
    dem_contact_state state;    /**< of the contact afterwards */
    dem_index node;             /**< that touches; of an edge its first */
    dem_index other;            /**< the second node of the edge, or -1 */
    double weight;              /**< of `other`, s; 0 without it */
    dem_index body;             /**< of the node */
    dem_index obstacle;         /**< the partner; -1 if that is a body */
    dem_index segment;          /**< of the obstacle; of a vertex, the segment that ends there */
    dem_index other_body;       /**< the partner; -1 if that is an obstacle, as in every event yet */
    double x[3];                /**< m, place on the partner */
    double normal[3];           /**< unit, out of the partner; in a corner that of the faster approached segment */
    double impulse[3];          /**< N s, given to the body; 0 but for impacts */
    double before[3], after[3]; /**< m/s, of the body at the contact */
    double energy;              /**< J, taken by the impact, >= 0 */
} dem_event;

/** The motion that is seen; arrays are views, valid until the simulation's next non-const call. */
typedef struct dem_state {
    size_t struct_size;   /**< to be set to sizeof(dem_state) */
    double t;             /**< s */
    double step;          /**< s, length of the last accepted step */
    const double *x, *v;  /**< [n_nodes][dim] m, m/s */
    dem_index n_contacts; /**< closed now: dem_simulation_contact() */
} dem_state;

/** How far a run is. */
typedef struct dem_progress {
    size_t struct_size;   /**< to be set to sizeof(dem_progress) */
    double t;             /**< s */
    double step;          /**< s, length of the last accepted step */
    dem_index n_contacts; /**< closed now: dem_simulation_contact() */
} dem_progress;

/** Mean motion of a body. */
typedef struct dem_body_motion {
    size_t struct_size;         /**< to be set to sizeof(dem_body_motion) */
    double mass;                /**< kg */
    double centre[3];           /**< centre of mass, m */
    double velocity[3];         /**< of the centre of mass, m/s */
    double angular_momentum[3]; /**< about the centre of mass, kg m^2/s; in the plane the third alone is not 0 */
} dem_body_motion;

/** What an obstacle gives to the bodies, and where it is. */
typedef struct dem_obstacle_load {
    size_t struct_size;         /**< to be set to sizeof(dem_obstacle_load) */
    double reaction[3];         /**< N, instantaneous sum over lasting contacts, with rigid bodies too */
    double point[3];            /**< m, where that resultant acts: on its line of action, nearest to the mean place of
                                     the contacts weighted by their forces; 0 without contacts */
    double impulse[3];          /**< N s, so far: impacts, and the reactions integrated over time */
    double friction_impulse[3]; /**< N s, the tangential part of it */
    dem_index n_contacts;       /**< closed now */
    double displacement[3];     /**< m, way of its pivot from where its points were given; with a motion by a function
                                     NaN, as angle and power, from set_motion() to the next advance */
    double angle;               /**< rad, by which it has turned about it */
    double power;               /**< W, of its reaction: what it puts into the bodies through lasting contacts */
} dem_obstacle_load;

/** What a boundary does to its nodes. */
typedef struct dem_boundary_load {
    size_t struct_size;     /**< to be set to sizeof(dem_boundary_load) */
    double force[3];        /**< N, on its nodes now: given, or what the prescribed motion takes; where an external
                                 force adds to that, NaN before the first advance, and from set_motion() to the next */
    double displacement[3]; /**< m, mean way of its nodes from where they started */
} dem_boundary_load;

typedef struct dem_counts {
    size_t struct_size;           /**< to be set to sizeof(dem_counts) */
    dem_index steps;              /**< accepted by the integrator */
    dem_index rejected;           /**< by its error test */
    dem_index evaluations;        /**< of the right-hand side (4) */
    dem_index events;             /**< resolved: each with DEM_CONTACT_LOCAL, with DEM_CONTACT_EXACT their times */
    dem_index impacts;            /**< of nodes on segments and of edges on vertices */
    dem_index vertex_impacts;     /**< of edges on vertices */
    dem_index early;              /**< of all impacts, those taken together with another one within the window */
    dem_index closings, releases; /**< contacts that began and ceased to last */
    dem_index slips, sticks;      /**< lasting contacts that began to slide, that stopped or turned back */
    dem_index passings;           /**< of a segment's or an edge's end by a lasting contact */
    dem_index late;      /**< events that the root finder of DEM_CONTACT_EXACT had not seen, but the check of a step */
    dem_index retries;   /**< attempts repeated with a smaller step after a non-finite force */
    dem_index behind;    /**< nodes that have passed round the end of an open obstacle, or have come to the surface
                              inside one, now */
    dem_index crossings; /**< steps rejected because surfaces of bodies crossed in them */
} dem_counts;

/** Extremes over the springs and triangles, at one instant. */
typedef struct dem_strain {
    size_t struct_size;               /**< to be set to sizeof(dem_strain) */
    double min, max;                  /**< (d - d0)/d0 */
    dem_index spring_min, spring_max; /**< where; -1 without springs */
    double area_min;                  /**< smallest area over rest area; 1 without triangles, < 0: inverted */
    dem_index guarded;                /**< triangles on which the guard acts */
    dem_index inverted;               /**< triangles of area <= 0 */
} dem_strain;

/** Bodies that run into each other, or into themselves, which only the option `bodies` prevents. Nodes on
 *  the boundary of the triangulation inside triangles of which they are no corners; looked for at the start and after
 *  every 16th accepted step, every 256th where bodies touch each other and themselves. */
typedef struct dem_overlap {
    size_t struct_size;       /**< to be set to sizeof(dem_overlap) */
    dem_index now, most;      /**< pairs of node and triangle when last looked at, and the most of a look */
    double t;                 /**< s, of the first; 0 without one */
    dem_index node, triangle; /**< of the first; -1 without one */
    double x[3];              /**< m, where that node was */
} dem_overlap;

/** Contact of bodies with each other and with themselves now; without the option `bodies` nothing pushes. */
typedef struct dem_surfaces {
    size_t struct_size;   /**< to be set to sizeof(dem_surfaces) */
    double gap_min;       /**< m, smallest distance of a node from an edge that pushes it; infinity: none does */
    double gap_share;     /**< smallest distance over contact thickness; infinity: as above */
    double thickness_min; /**< m, smallest and largest contact thickness of the bodies */
    double thickness_max;
    dem_index pushing;  /**< pairs of a node and an edge that push each other */
    dem_index n_edges;  /**< boundary edges of all bodies */
    dem_index left_out; /**< pairs of a node and an edge of one body that never push each other, as they are nearer than
                             the contact thickness at rest: in notches narrower than that */
    double modulus_min; /**< N/m, smallest and largest contact modulus of the bodies; two bodies push each other with
                             the smaller one of theirs */
    double modulus_max;
    double pressure_share; /**< largest pressure between surfaces over their contact modulus, (1 - u)^2/u for u =
                                gap_share: 0.05 at u = 0.8, 0.5 at u = 0.5; 0: nothing pushes */
    double friction_min; /**< coefficient of friction of the bodies with each other, of two the smaller: the smallest */
    double friction_max; /**< and the largest one */
} dem_surfaces;

/** A node and a boundary edge that push each other. Where a surface is concave two edges push a node, and the vertex
 *  between them takes back what would count twice: the forces of the two together have a meaning. */
typedef struct dem_pair {
    size_t struct_size;   /**< to be set to sizeof(dem_pair) */
    dem_index node;       /**< that is pushed */
    dem_index edge[2];    /**< ends of the edge, which runs with its body on the left */
    dem_index body;       /**< of the node */
    dem_index other_body; /**< of the edge; the same where a body touches itself */
    double x[3];          /**< m, place of the edge nearest to the node */
    double normal[3];     /**< unit, from there to the node */
    double gap;           /**< m, distance of the node from there */
    double thickness;     /**< m, contact thickness of the two bodies, below which they push */
    double force[3];      /**< N, on the node, without friction; the edge feels the opposite */
    double friction[3];   /**< N, on the node; the edge feels the opposite */
    int32_t slides;       /**< 1: the node slides along the surfaces of the other body, friction is all that its
                               coefficient allows; 0: it holds, or there is none */
} dem_pair;

/** How much is broken, and into what. */
typedef struct dem_fracture {
    size_t struct_size;  /**< to be set to sizeof(dem_fracture) */
    dem_index triangles; /**< that are broken */
    dem_index springs;   /**< of which nothing is left */
    dem_index fragments; /**< as dem_simulation_fragments() has them */
    double largest;      /**< share of the mass that the largest fragment has */
    double debris;       /**< share of the mass in fragments of a single node */
    double median;       /**< kg, mass of the fragment with which, from the smallest on, half of all is reached: d50 */
    double crack_length; /**< m, sum of sqrt(A/sqrt(3)) over the broken triangles, A the area at rest: what a row of
                              equilateral triangles of that area is long */
    dem_index buried;    /**< nodes that were inside an obstacle when they came to the surface: they touch it only once
                                they have come out */
    dem_index buried_node; /**< the first of them; -1 without one */
    double buried_t;       /**< s, and when, */
    double buried_x[3];    /**< m, and where that was; 0 without one */
} dem_fracture;

typedef struct dem_simulation dem_simulation;

/** Starts at t = 0 in the lattice's initial state. Touching an obstacle there is legal, deeper than the penetration
 *  tolerance is not: DEM_ERROR_MODEL names the node or the vertex. With contact of `bodies` so are surfaces that
 *  cross or are nearer than a twentieth of the contact thickness, and bodies without triangles. The model is borrowed
 *  and must outlive the simulation. */
DEM_API dem_status dem_simulation_create(dem_simulation **out, const dem_model *model, const dem_options *options);

/** Goes on from a checkpoint of a simulation of the same model and options, whose further motion is repeated to the
 *  bit. Where ranks share the model (dem/mpi.h) any number of them may go on.
 *  \param checkpoint  there on rank 0, and not looked at elsewhere
 *  \return DEM_ERROR_IO if the checkpoint is of another model, or damaged */
DEM_API dem_status dem_simulation_resume(dem_simulation **out, const dem_model *model, const dem_options *options,
                                         const dem_checkpoint *checkpoint);

/** Accepts NULL. */
DEM_API void dem_simulation_destroy(dem_simulation *simulation);

/** Integrates (4) to t_end, with (9) and friction at every impact. The state there is interpolated, never stepped to,
 *  so a run to t1 continued to t2 is a run to t2.
 *  \return DEM_STOPPED if an observer asked for it; DEM_ERROR_INTEGRATOR, DEM_ERROR_CONTACT with the last good state,
 *          and what the external force returned, or DEM_ERROR_INTEGRATOR if it is not finite, with that before the step
 *          in which it was asked for: another advance goes on from there */
DEM_API dem_status dem_simulation_advance(dem_simulation *simulation, double t_end);

/** Puts nodes elsewhere, or gives them other velocities, where the last advance has ended: not from an observer.
 *  Contacts are looked for at the next advance, as at the start, and until then there are none; then observers are
 *  shown the step, and a checkpoint is taken: an older one is of the motion that was. What it changes of the energy
 *  counts as put in from outside (`boundary`). Copies both.
 *  \param x  [n_nodes][2] m, no deeper in obstacles than the penetration tolerance; NULL: as it is
 *  \param v  [n_nodes][2] m/s; NULL: as it is. Fixed nodes keep both, as do prescribed components.
 *  \return DEM_ERROR_ARGUMENT, DEM_ERROR_MODEL inside an obstacle or where surfaces of bodies cross; then nothing has
 *          changed */
DEM_API dem_status dem_simulation_set_motion(dem_simulation *simulation, const double *x, const double *v);

/** Breaks elements, for good, where the last advance has ended: not from an observer. A triangle takes along what it
 *  gave to its springs, so that what is left is the body without it; a spring is broken when all of its triangles are.
 *  Masses stay. Nodes and edges that come to the surface touch obstacles from then on, and bodies with the option
 *  `bodies`. The energy of what breaks counts as taken by `fracture`. What is over its limit in consequence breaks when
 *  the run goes on, at the same instant. Otherwise it goes on as after dem_simulation_set_motion(). What is broken
 *  already stays so; where all of it is nothing changes.
 *  \param triangle  [n_triangles] numbers in the lattice; of cells both triangles should break
 *  \param spring    [n_springs] numbers of springs that no triangle holds
 *  \return DEM_ERROR_ARGUMENT for a number that is out of range, an element of a rigid body, or a spring that triangles
 *          hold, DEM_ERROR_MEMORY; then nothing has changed */
DEM_API dem_status dem_simulation_break(dem_simulation *simulation, const dem_index *triangle, dem_index n_triangles,
                                        const dem_index *spring, dem_index n_springs);

/** The last checkpoint, valid and unchanged until the next advance; NULL before the first, and after
 *  dem_simulation_set_motion(). Where ranks share the model rank 0 has that of all nodes, and the others have none. */
DEM_API const dem_checkpoint *dem_simulation_checkpoint(const dem_simulation *simulation);

/* ---- what can be asked of the motion ---- */

/* A struct that these functions fill has its size in struct_size, which the caller sets: what lies within it is
 * written, and nothing beyond. All return DEM_ERROR_ARGUMENT for a NULL, a struct_size too small for the first member,
 * and a number that is out of range; then nothing has been written. None of them changes the motion, or calls a
 * function of the program: neither its external force nor its motions of obstacles. */

/** What is seen of the motion now. */
DEM_API dem_status dem_simulation_state(const dem_simulation *simulation, dem_state *out);

/** The same without positions and velocities. */
DEM_API dem_status dem_simulation_progress(const dem_simulation *simulation, dem_progress *out);

/** The motion that is seen of all nodes, on rank 0 where ranks share the model (dem/mpi.h); then all ranks call it.
 *  \param[out] x  [nodes of the whole lattice][dim] m; not looked at on other ranks than 0
 *  \param[out] v  the same, m/s
 *  \return also DEM_ERROR_MEMORY */
DEM_API dem_status dem_simulation_gather(const dem_simulation *simulation, double *x, double *v);

DEM_API dem_status dem_simulation_energy(const dem_simulation *simulation, dem_energy *out);
DEM_API dem_status dem_simulation_strain(const dem_simulation *simulation, dem_strain *out);

/** A closed contact.  \param contact  0 <= contact < n_contacts of the dem_state of the same instant */
DEM_API dem_status dem_simulation_contact(const dem_simulation *simulation, dem_index contact, dem_contact *out);

/** Strain (d - d0)/d0 of every spring.  \param[out] strain  [n_springs], in the order of the lattice */
DEM_API dem_status dem_simulation_strains(const dem_simulation *simulation, double *strain);

/** Force (1) along every spring, with what couplings add to it, > 0 in tension; what damping adds is left out.
 *  \param[out] force  [n_springs] N, in the order of the lattice */
DEM_API dem_status dem_simulation_forces(const dem_simulation *simulation, double *force);

/** The same of one spring.  \param spring  0 <= spring < n_springs */
DEM_API dem_status dem_simulation_force_at(const dem_simulation *simulation, dem_index spring, double *out);

/** What is broken; either may be NULL.
 *  \param[out] triangle  [n_triangles] 1: broken, else 0
 *  \param[out] spring    [n_springs] 1: none of the triangles that held it is whole, else 0 */
DEM_API dem_status dem_simulation_broken(const dem_simulation *simulation, unsigned char *triangle,
                                         unsigned char *spring);

/** Damage: what is gone of triangles in tension, 0 of one that is whole, 1 of one that is broken, and of nodes, the
 *  mean of their triangles by rest volume; 0 of a node without triangles. Each may be NULL.
 *  \param[out] triangle  [n_triangles]
 *  \param[out] node      [n_nodes] */
DEM_API dem_status dem_simulation_damage(const dem_simulation *simulation, double *triangle, double *node);

/** Fragments: nodes that springs join which are not broken; a node without such a spring is one of its own. Without
 *  breaks every connected body is one.
 *  \param[out] n_fragments  how many there are
 *  \param[out] fragment     [n_nodes] the lowest node of the fragment of each, whatever broke before */
DEM_API dem_status dem_simulation_fragments(const dem_simulation *simulation, dem_index *n_fragments,
                                            dem_index *fragment);

/** \return also DEM_ERROR_MEMORY */
DEM_API dem_status dem_simulation_fracture(const dem_simulation *simulation, dem_fracture *out);

/** What cracks take by the fracture energies of what is broken, which those of brittle triangles have from their
 *  strength (docs/fracture.md): the sum over broken triangles of fracture energy times `crack_length` times thickness.
 *  Beside it `fracture` of dem_energy is what has been taken. Of squares it is that of isotropic ones.
 *  \param[out] energy  J, >= 0; 0 where a triangle is broken that has no strength, or where the lattice has no moduli
 *  \return also DEM_ERROR_MEMORY */
DEM_API dem_status dem_simulation_crack_energy(const dem_simulation *simulation, double *energy);

/** Virial stress of every node in the axes of space: its share of r x f over its share of the rest volume. That is the
 *  Kirchhoff stress: Cauchy's times the ratio of the volumes now and at rest. Of springs and triangles; of neither
 *  damping nor motion. Exact where the strain is uniform, on boundaries too; 0 at a node in no triangle.
 *  What a model needs for stresses is made when they are first asked for.
 *  \param[out] stress  [n_nodes][dim (dim + 1)/2] Pa, > 0 in tension: xx, yy, xy
 *  \return DEM_ERROR_MEMORY */
DEM_API dem_status dem_simulation_stress(const dem_simulation *simulation, double *stress);

/** The same of one node.  \param node  0 <= node < n_nodes  \param[out] stress  [dim (dim + 1)/2]
 *  \return DEM_ERROR_MEMORY */
DEM_API dem_status dem_simulation_stress_at(const dem_simulation *simulation, dem_index node, double *stress);

DEM_API dem_status dem_simulation_overlap(const dem_simulation *simulation, dem_overlap *out);

DEM_API dem_status dem_simulation_surfaces(const dem_simulation *simulation, dem_surfaces *out);

/** A pair of surfaces that push each other.  \param pair  0 <= pair < `pushing` of the dem_surfaces of the same
 *  instant  \return also DEM_ERROR_MEMORY */
DEM_API dem_status dem_simulation_pair(const dem_simulation *simulation, dem_index pair, dem_pair *out);

/** Force on every node by contact of bodies with each other and with themselves; obstacles have no part in it. The sum
 *  over all nodes is 0.  \param[out] force  [n_nodes][dim] N */
DEM_API dem_status dem_simulation_contact_forces(const dem_simulation *simulation, double *force);

/** The pressure that this force means: the part of it along the normals of surfaces, over the node's share of the
 *  surface of the plate at rest; 0 at nodes that are on none.
 *  \param[out] pressure  [n_nodes] Pa, >= 0  \return also DEM_ERROR_MEMORY */
DEM_API dem_status dem_simulation_contact_pressures(const dem_simulation *simulation, double *pressure);

DEM_API dem_status dem_simulation_counts(const dem_simulation *simulation, dem_counts *out);

/** \param body  0 <= body < n_bodies */
DEM_API dem_status dem_simulation_body(const dem_simulation *simulation, dem_index body, dem_body_motion *out);

/** Moment of inertia of a body about its centre of mass, the sum of m |x - c|^2 over its nodes: its angular momentum
 *  over this is its mean angular velocity.
 *  \param body          0 <= body < n_bodies
 *  \param[out] inertia  kg m^2 */
DEM_API dem_status dem_simulation_inertia(const dem_simulation *simulation, dem_index body, double *inertia);

/** \param obstacle  0 <= obstacle < n_obstacles */
DEM_API dem_status dem_simulation_obstacle(const dem_simulation *simulation, dem_index obstacle,
                                           dem_obstacle_load *out);

/** \param boundary  0 <= boundary < n_boundaries */
DEM_API dem_status dem_simulation_boundary(const dem_simulation *simulation, dem_index boundary,
                                           dem_boundary_load *out);

/** The largest |v_x| + |v_y| of a node, m/s. */
DEM_API double dem_simulation_fastest(const dem_simulation *simulation);

/** How far from equilibrium: the largest force on a node that may move, without drag and with what contacts give, over
 *  the largest force of a spring; 0 where there is neither. Known after an accepted step without contact event, else
 *  infinity. */
DEM_API double dem_simulation_residual(const dem_simulation *simulation);

/** Time, s, at which the ramps of boundaries are in the state that is seen: with the option `pause` behind that of the
 *  state by all pauses so far, else the same. */
DEM_API double dem_simulation_ramp_time(const dem_simulation *simulation);

DEM_API const dem_model *dem_simulation_model(const dem_simulation *simulation);

/** The options in force: those of dem_simulation_create() with every default replaced by its value, and
 *  `boundaries` NULL. */
DEM_API dem_status dem_simulation_options(const dem_simulation *simulation, dem_options *out);

/* ---- stress ----------------------------------------------------------------------------------------------------- */

/** Von Mises' equivalent of a plane stress xx, yy, xy: sqrt(xx^2 - xx yy + yy^2 + 3 xy^2). */
DEM_API double dem_stress_von_mises(const double stress[3]);

/** Principal values, the larger first, and the unit vector along which the first acts: to the right, or up; along x if
 *  both are equal. */
DEM_API void dem_stress_principal(const double stress[3], double value[2], double direction[2]);

#ifdef __cplusplus
}
#endif

#endif
