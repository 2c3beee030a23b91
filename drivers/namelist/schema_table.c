/* SPDX-License-Identifier: BSD-3-Clause */
/* The table of groups and keys of a deck, and nothing else. Each row is
 *     name, type, least and largest number of values, unit, default, range, choices, physics, sentence, example */
#include "schema.h"

#define NONE     ""
#define ANY      ""
#define REQUIRED NULL
#define PHYSICS  true

static const schema_key run_keys[] = {
    {"title", SCHEMA_STRING, 1, 1, "-", "''", ANY, NULL, false,
     "What the run is about; goes to the log and into the result.", "'Rubber rectangle with a void and three pores'"},
    {"t_end", SCHEMA_REAL, 1, 1, "s", REQUIRED, "> 0", NULL, false, "Time at which the run ends; it starts at 0.",
     "5e-3"},
    {"gravity", SCHEMA_REAL, 2, 2, "m/s^2", "0, -9.81", ANY, NULL, PHYSICS, "Acceleration of free fall, x and y.",
     NULL},
    {"residual", SCHEMA_REAL, 1, 1, "-", NONE, "[1e-12, 0.1]", NULL, PHYSICS,
     "Makes the run quasi-static: it ends at rest, by docs/method.md, and it is an error if t_end comes first.", NONE},
};

static const schema_key material_keys[] = {
    {"name", SCHEMA_STRING, 1, 1, "-", "'solid'", ANY, NULL, PHYSICS, "Name by which bodies refer to the material.",
     "'rubber'"},
    {"youngs_modulus", SCHEMA_REAL, 1, 1, "Pa", NONE, "> 0", NULL, PHYSICS,
     "Young's modulus E of the isotropic solid; it or the stiffness of a bond must be given.", "1e7"},
    {"bond_stiffness", SCHEMA_REAL, 1, 1, "N", NONE, "> 0", NULL, PHYSICS,
     "Instead of E and nu: E_ij of every spring, at the boundary too, as the paper draws them.", NONE},
    {"poissons_ratio", SCHEMA_REAL, 1, 1, "-", "0.3333333333333333", "(-1, 1)", NULL, PHYSICS,
     "Poisson's ratio nu of the solid, in plane strain below 0.5; springs alone have 1/3 in plane stress, 1/4 in "
     "strain.",
     NULL},
    {"plane", SCHEMA_CHOICE, 1, 1, "-", "'stress'", ANY, "stress|strain", PHYSICS,
     "Plane stress, of a thin plate, or plane strain, of a slice of a long body.", NULL},
    {"density", SCHEMA_REAL, 1, 1, "kg/m^3", REQUIRED, "> 0", NULL, PHYSICS, "Mass density.", "1050"},
    {"thickness", SCHEMA_REAL, 1, 1, "m", "1", "> 0", NULL, PHYSICS, "Thickness h of the plate.", NULL},
    {"guard", SCHEMA_REAL, 1, 1, "-", "0.02", ">= 0", NULL, PHYSICS,
     "Strength of the folding guard over E h, which keeps triangles from turning inside out; 0 switches it off.", NULL},
    {"damping_time", SCHEMA_REAL, 1, 1, "s", "0", ">= 0", NULL, PHYSICS,
     "Damping of the springs: a rate of strain acts like a strain of damping_time times it; 0 is none.", NULL},
};

static const schema_key body_keys[] = {
    {"shape", SCHEMA_CHOICE, 1, 1, "-", REQUIRED, ANY, "rectangle|disc|ring|polygon|mask|mesh|file", PHYSICS,
     "Shape; own origin: middle of a rectangle's or image's lower edge, centre of a disc or ring, else as given.",
     "'rectangle'"},
    {"size", SCHEMA_REAL, 2, 2, "m", NONE, "> 0", NULL, PHYSICS, "Width and height of a rectangle.", "0.08, 0.13"},
    {"radius", SCHEMA_REAL, 1, 1, "m", NONE, "> 0", NULL, PHYSICS, "Radius of a disc, outer radius of a ring.", NULL},
    {"inner_radius", SCHEMA_REAL, 1, 1, "m", NONE, "> 0", NULL, PHYSICS, "Radius of the hole of a ring.", NULL},
    {"points", SCHEMA_REAL, 6, 0, "m", NONE, ANY, NULL, PHYSICS,
     "x and y of each corner of a polygon, either way round, in the body's own coordinates.", NULL},
    {"lattice", SCHEMA_CHOICE, 1, 1, "-", "'triangular'", ANY, "triangular|square", PHYSICS,
     "Arrangement of the nodes of a body that is neither a mesh nor a file: triangles, or squares with both diagonals.",
     NULL},
    {"diagonal", SCHEMA_REAL, 1, 1, "-", "0.5", "> 0", NULL, PHYSICS,
     "Of squares: stiffness of a diagonal over that of a side, both in N/m; 0.5 is isotropic.", NONE},
    {"spacing", SCHEMA_REAL, 1, 1, "m", NONE, "> 0", NULL, PHYSICS,
     "Distance between neighbouring nodes of a body that is neither a mesh nor a file.", "0.01"},
    {"jitter", SCHEMA_REAL, 1, 1, "-", "0", "[0, 0.3]", NULL, PHYSICS,
     "Nodes that are not on the boundary are moved at random, by up to this share of the spacing.", NULL},
    {"seed", SCHEMA_INTEGER, 1, 1, "-", "1", ">= 0", NULL, PHYSICS,
     "Seed of the jitter; the same seed gives the same places on every machine.", NONE},
    {"material", SCHEMA_STRING, 1, 1, "-", "'solid'", ANY, NULL, PHYSICS,
     "Name of the material of a body that is no file.", "'rubber'"},
    {"position", SCHEMA_REAL, 2, 2, "m", "0, 0", ANY, NULL, PHYSICS, "Where the body's own origin is placed, x and y.",
     NULL},
    {"angle", SCHEMA_REAL, 1, 1, "degrees", "0", ANY, NULL, PHYSICS,
     "Turn of the body about its own origin, counter-clockwise.", NULL},
    {"clearance", SCHEMA_REAL, 1, 1, "m", NONE, ">= 0", NULL, PHYSICS,
     "If given, the body is then moved along gravity until its smallest gap to an obstacle is this.", "2e-4"},
    {"velocity", SCHEMA_REAL, 2, 2, "m/s", "0, 0", ANY, NULL, PHYSICS, "Initial velocity, x and y.", "0, -10"},
    {"spin", SCHEMA_REAL, 1, 1, "rad/s", "0", ANY, NULL, PHYSICS,
     "Initial rotation about the centre of mass, counter-clockwise.", NULL},
    {"disconnected", SCHEMA_CHOICE, 1, 1, "-", "'refuse'", ANY, "refuse|remove|keep", PHYSICS,
     "What becomes of parts that share no edge with the largest one: an error, taken away, or kept.", NULL},
    {"file", SCHEMA_STRING, 1, 1, "-", NONE, ANY, NULL, PHYSICS,
     "Lattice file, image (PGM, PNG) or Gmsh mesh (MSH 4.1, text); a relative path starts at the deck's folder.", NULL},
    {"scale", SCHEMA_REAL, 1, 1, "m", NONE, "> 0", NULL, PHYSICS,
     "Side of a pixel of a mask; length of 1 in the coordinates of a mesh.", NULL},
    {"threshold", SCHEMA_REAL, 1, 1, "-", "0.5", "[0, 1]", NULL, PHYSICS,
     "Pixels of a mask are material from this brightness on: 0 is black, 1 white.", NONE},
};

static const schema_key void_keys[] = {
    {"body", SCHEMA_INTEGER, 1, 1, "-", "1", ">= 1", NULL, PHYSICS,
     "Number of the body that has the void, in the order of the deck.", NULL},
    {"shape", SCHEMA_CHOICE, 1, 1, "-", "'disc'", ANY, "disc|rectangle|ring|polygon", PHYSICS, "Shape of the void.",
     NULL},
    {"centre", SCHEMA_REAL, 2, 2, "m", REQUIRED, ANY, NULL, PHYSICS,
     "Centre of the void, x and y in the body's own coordinates; a polygon's points are counted from it.", "0, 0.03"},
    {"radius", SCHEMA_REAL, 1, 1, "m", NONE, "> 0", NULL, PHYSICS, "Radius of a disc, outer radius of a ring.", "0.01"},
    {"inner_radius", SCHEMA_REAL, 1, 1, "m", NONE, "> 0", NULL, PHYSICS,
     "Inner radius of a ring, within which there is material.", NULL},
    {"size", SCHEMA_REAL, 2, 2, "m", NONE, "> 0", NULL, PHYSICS, "Width and height of a rectangle.", NULL},
    {"points", SCHEMA_REAL, 6, 0, "m", NONE, ANY, NULL, PHYSICS,
     "x and y of each corner of a polygon, counted from its centre, either way round.", NULL},
    {"angle", SCHEMA_REAL, 1, 1, "degrees", "0", ANY, NULL, PHYSICS,
     "Turn of a rectangle or a polygon about its centre, counter-clockwise.", NONE},
};

static const schema_key pores_keys[] = {
    {"body", SCHEMA_INTEGER, 1, 1, "-", "1", ">= 1", NULL, PHYSICS,
     "Number of the body that has the pores, in the order of the deck.", NULL},
    {"number", SCHEMA_INTEGER, 1, 1, "-", NONE, ">= 1", NULL, PHYSICS,
     "Number of round pores; it or the porosity must be given.", "3"},
    {"porosity", SCHEMA_REAL, 1, 1, "-", NONE, "(0, 1)", NULL, PHYSICS,
     "Area of the pores over that of the body, less its voids, without them: the nearest number of pores.", NULL},
    {"radius", SCHEMA_REAL, 2, 2, "m", REQUIRED, "> 0", NULL, PHYSICS, "Smallest and largest radius.", "0.006, 0.007"},
    {"distribution", SCHEMA_CHOICE, 1, 1, "-", "'uniform'", ANY, "uniform|lognormal|normal", PHYSICS,
     "Distribution of the radii between the smallest and the largest one.", NULL},
    {"mean", SCHEMA_REAL, 1, 1, "m", NONE, "> 0", NULL, PHYSICS,
     "Mean of a lognormal or normal distribution before it is cut off at the smallest and the largest radius.", NULL},
    {"deviation", SCHEMA_REAL, 1, 1, "m", NONE, "> 0", NULL, PHYSICS, "Its standard deviation.", NULL},
    {"wall", SCHEMA_REAL, 1, 1, "m", NONE, ">= 0", NULL, PHYSICS,
     "Least material between two pores, and between a pore and the boundary; default: twice the spacing.", "0.01"},
    {"seed", SCHEMA_INTEGER, 1, 1, "-", "1", ">= 0", NULL, PHYSICS,
     "Seed of the random numbers; the same seed gives the same pores on every machine.", NULL},
};

static const schema_key crack_keys[] = {
    {"body", SCHEMA_INTEGER, 1, 1, "-", "1", ">= 1", NULL, PHYSICS,
     "Number of the body that has the crack, in the order of the deck.", NULL},
    {"points", SCHEMA_REAL, 4, 0, "m", REQUIRED, ANY, NULL, PHYSICS,
     "x and y of its points in the body's own coordinates; along a row of nodes it takes what is on its left.",
     "-0.04, 0.085, -0.01, 0.085"},
};

static const schema_key inclusion_keys[] = {
    {"body", SCHEMA_INTEGER, 1, 1, "-", "1", ">= 1", NULL, PHYSICS,
     "Number of the body that has the inclusion, in the order of the deck.", NULL},
    {"material", SCHEMA_STRING, 1, 1, "-", REQUIRED, ANY, NULL, PHYSICS, "Name of its material.", "'rubber'"},
    {"shape", SCHEMA_CHOICE, 1, 1, "-", "'disc'", ANY, "disc|rectangle|ring|polygon", PHYSICS,
     "Shape of the inclusion: the triangles that have their centres in it; of two that overlap the later one counts.",
     NULL},
    {"centre", SCHEMA_REAL, 2, 2, "m", REQUIRED, ANY, NULL, PHYSICS,
     "Its centre, x and y in the body's own coordinates; a polygon's points are counted from it.", "0.02, 0.11"},
    {"radius", SCHEMA_REAL, 1, 1, "m", NONE, "> 0", NULL, PHYSICS, "Radius of a disc, outer radius of a ring.", "0.01"},
    {"inner_radius", SCHEMA_REAL, 1, 1, "m", NONE, "> 0", NULL, PHYSICS, "Inner radius of a ring.", NULL},
    {"size", SCHEMA_REAL, 2, 2, "m", NONE, "> 0", NULL, PHYSICS, "Width and height of a rectangle.", NULL},
    {"points", SCHEMA_REAL, 6, 0, "m", NONE, ANY, NULL, PHYSICS,
     "x and y of each corner of a polygon, counted from its centre, either way round.", NULL},
    {"angle", SCHEMA_REAL, 1, 1, "degrees", "0", ANY, NULL, PHYSICS,
     "Turn of a rectangle or a polygon about its centre, counter-clockwise.", NONE},
};

static const schema_key boundary_keys[] = {
    {"body", SCHEMA_INTEGER, 1, 1, "-", "1", ">= 1", NULL, PHYSICS, "Number of the body, in the order of the deck.",
     NULL},
    {"where", SCHEMA_CHOICE, 1, 1, "-", REQUIRED, ANY, "side|box|disc|list|all", PHYSICS,
     "Which nodes, by their places at rest in the body's own coordinates.", "'side'"},
    {"side", SCHEMA_CHOICE, 1, 1, "-", NONE, ANY, "left|right|bottom|top", PHYSICS,
     "The outermost nodes: those within half a spacing of the extreme coordinate.", "'top'"},
    {"box", SCHEMA_REAL, 4, 4, "m", NONE, ANY, NULL, PHYSICS,
     "x and y of the lower left and of the upper right corner.", NULL},
    {"centre", SCHEMA_REAL, 2, 2, "m", NONE, ANY, NULL, PHYSICS, "Centre of a disc.", NULL},
    {"radius", SCHEMA_REAL, 1, 1, "m", NONE, "> 0", NULL, PHYSICS, "Radius of a disc.", NULL},
    {"nodes", SCHEMA_INTEGER, 1, 0, "-", NONE, ">= 0", NULL, PHYSICS,
     "Numbers of nodes of the body, from 0 in the order of its lattice.", NULL},
    {"kind", SCHEMA_CHOICE, 1, 1, "-", "'fix'", ANY, "fix|velocity|displacement|force|traction", PHYSICS,
     "Motion held or prescribed, a force shared equally by the nodes, or a traction on the edges between them.",
     "'velocity'"},
    {"components", SCHEMA_CHOICE, 1, 1, "-", "'xy'", ANY, "x|y|xy", PHYSICS, "Components of the motion prescribed.",
     "'y'"},
    {"velocity", SCHEMA_REAL, 2, 2, "m/s", NONE, ANY, NULL, PHYSICS, "Velocity, x and y along the axes of space.",
     "0, -0.5"},
    {"displacement", SCHEMA_REAL, 2, 2, "m", NONE, ANY, NULL, PHYSICS,
     "Way from the initial positions, x and y along the axes of space.", NULL},
    {"force", SCHEMA_REAL, 2, 2, "N", NONE, ANY, NULL, PHYSICS, "Force on all the nodes together, x and y.", NULL},
    {"traction", SCHEMA_REAL, 2, 2, "Pa", NONE, ANY, NULL, PHYSICS,
     "Force over the area of the edges between the nodes, x and y; of a side, over its area along the side.", NULL},
    {"ramp", SCHEMA_REAL, 1, 1, "s", "0", ">= 0", NULL, PHYSICS,
     "Time over which it grows from 0, twice continuously differentiable.", "1e-4"},
};

static const schema_key obstacle_keys[] = {
    {"points", SCHEMA_REAL, 4, 0, "m", REQUIRED, ANY, NULL, PHYSICS,
     "x and y of each point of the polyline; bodies live on its left, and it is closed if the last point is the first.",
     "-0.3, -0.02, -0.05, 0.004, 0.045, 0.01, 0.3, -0.02"},
    {"profile", SCHEMA_CHOICE, 1, 1, "-", "'polyline'", ANY, "polyline|smooth|rough", PHYSICS,
     "Straight between points, Steffen's curve through them, or rough; x must increase for the last two.", NULL},
    {"resolution", SCHEMA_REAL, 1, 1, "m", NONE, "> 0", NULL, PHYSICS,
     "Length along x of the segments of a smooth or rough profile; default: 1/200 of the points' extent.", NULL},
    {"roughness", SCHEMA_REAL, 1, 1, "m", NONE, ">= 0", NULL, PHYSICS,
     "Root mean square of the Gaussian heights that a rough profile adds to the polyline.", NULL},
    {"correlation", SCHEMA_REAL, 1, 1, "m", NONE, "> 0", NULL, PHYSICS,
     "Correlation length of a rough profile: heights d apart correlate by exp(-(d/correlation)^2).", NULL},
    {"seed", SCHEMA_INTEGER, 1, 1, "-", "1", "[0, 4294967295]", NULL, PHYSICS,
     "Seed of the heights of a rough profile; the same seed gives the same heights on every machine.", NONE},
    {"restitution", SCHEMA_REAL, 1, 1, "-", "0", "[0, 1]", NULL, PHYSICS,
     "Coefficient of restitution: 0 is perfectly plastic, 1 perfectly elastic.", NULL},
    {"friction", SCHEMA_REAL, 1, 1, "-", "0", ">= 0", NULL, PHYSICS,
     "Coefficient of friction; 0 is none. By law 'paper' 1 is none: it must be given there, in [0, 1].", NULL},
    {"friction_law", SCHEMA_CHOICE, 1, 1, "-", "'coulomb'", ANY, "coulomb|paper", PHYSICS,
     "Coulomb's dry friction, or the paper's: an impact leaves `friction` of the tangential velocity.", NULL},
};

static const schema_key contact_keys[] = {
    {"method", SCHEMA_CHOICE, 1, 1, "-", "'local'", ANY, "local|exact", PHYSICS,
     "What a contact event in a step does: 'local' corrects the motion near it, 'exact' ends the step of all bodies.",
     NULL},
    {"window", SCHEMA_REAL, 1, 1, "s", NONE, ">= 0", NULL, PHYSICS,
     "Impacts nearer in time than this are taken together by 'exact', 0: each by itself; default: by docs/method.md.",
     "0"},
    {"vertices", SCHEMA_LOGICAL, 1, 1, "-", ".true.", ANY, NULL, PHYSICS,
     "Whether the edges of bodies touch convex vertices of obstacles; if not, only nodes touch.", NULL},
    {"overlap", SCHEMA_CHOICE, 1, 1, "-", "'warn'", ANY, "warn|stop", PHYSICS,
     "What follows when a body runs into another one or into itself, which nothing prevents.", NULL},
    {"penetration_tolerance", SCHEMA_REAL, 1, 1, "m", NONE, "> 0", NULL, PHYSICS,
     "Depth at which an impact is taken; default: 1e-6 of the spacing.", "1e-8"},
    {"rest_speed", SCHEMA_REAL, 1, 1, "m/s", NONE, "> 0", NULL, PHYSICS,
     "A rebound not faster than this becomes a lasting contact, beside those that do by the rule of docs/method.md.",
     "1e-3"},
    {"max_impacts", SCHEMA_INTEGER, 1, 1, "-", "10000", ">= 1", NULL, false,
     "Impacts of one node within 1/omega_max at which the run is given up.", NULL},
};

static const schema_key solver_keys[] = {
    {"method", SCHEMA_CHOICE, 1, 1, "-", "'fehlberg45'", ANY,
     "fehlberg45|dopri45|cashkarp45|zonneveld34|bs23|heun12|sayfyaburub34|ark23|ark34|ark34b|ark45|ark45b|verner56|"
     "verner67|verner78|verner89|fehlberg78|knothwolke3|rk4|verlet",
     PHYSICS, "By name and orders; knothwolke3, rk4 and verlet take fixed steps. The table is in docs/method.md.",
     NULL},
    {"rtol", SCHEMA_REAL, 1, 1, "-", "1e-6", "[1e-13, 1e-1]", NULL, PHYSICS,
     "Largest error of a step: of a position over `spacing`, of a velocity over `v_scale`.", NULL},
    {"max_step", SCHEMA_REAL, 1, 1, "s", NONE, "> 0", NULL, PHYSICS,
     "Longest step; default: 0.5/omega_max, half the inverse of the lattice's highest angular frequency.", "2e-5"},
    {"fixed_step", SCHEMA_REAL, 1, 1, "s", NONE, "> 0", NULL, PHYSICS,
     "Length of every step, without error control; default for methods of fixed steps: by docs/method.md.", NULL},
    {"v_scale", SCHEMA_REAL, 1, 1, "m/s", NONE, "> 0", NULL, PHYSICS,
     "Speed that velocity errors are measured in; default: by the rule of docs/method.md.", "10"},
    {"spacing", SCHEMA_REAL, 1, 1, "m", NONE, "> 0", NULL, PHYSICS,
     "Length that position errors are measured in; default: the shortest spring.", "0.01"},
    {"mass_damping", SCHEMA_REAL, 1, 1, "1/s", "0", ">= 0", NULL, PHYSICS,
     "Damping of the masses: each feels -mass_damping m v, so that bodies come to rest; 0 is none.", NULL},
    {"kernel", SCHEMA_CHOICE, 1, 1, "-", "'auto'", ANY, "auto|portable|avx2|avx512", false,
     "Instructions that forces are evaluated with; 'auto': the last that the machine has. Same bits with all.", NULL},
    {"threads", SCHEMA_INTEGER, 1, 1, "-", "1", "[1, 1024]", NULL, false,
     "Threads that work at once. Results are the same to the bit for any number.", NULL},
    {"record_steps", SCHEMA_INTEGER, 1, 1, "-", "256", "[0, 1e9]", NULL, true,
     "Steps between records, from which a run that was stopped goes on to the same bits; 0: none.", NULL},
};

static const schema_key output_keys[] = {
    {"name", SCHEMA_STRING, 1, 1, "-", "'dem'", ANY, NULL, false, "Beginning of the names of the files written.",
     "'every_key'"},
    {"frame_interval", SCHEMA_REAL, 1, 1, "s", "1e-3", "> 0", NULL, false, "Time between frames; the first is at 0.",
     NULL},
    {"precision", SCHEMA_CHOICE, 1, 1, "-", "'single'", ANY, "single|double", false,
     "Precision of the arrays in the frames; positions are always double.", NULL},
    {"deflate", SCHEMA_INTEGER, 1, 1, "-", "1", "[0, 9]", NULL, false,
     "Compression of the frames: 0 is none, 9 the smallest files.", NULL},
    {"events", SCHEMA_LOGICAL, 1, 1, "-", ".false.", ANY, NULL, false, "Write the table /events of all contact events.",
     NULL},
    {"closure", SCHEMA_REAL, 1, 1, "-", "1e-2", "> 0", NULL, false,
     "The log warns when the energy ledger is open by this share of the largest energy of motion and strain so far.",
     NULL},
    {"fields", SCHEMA_CHOICE, 1, 0, "-", "'displacement', 'velocity', 'stress', 'von_mises', 'strain', 'force'", ANY,
     "displacement|velocity|stress|von_mises|principal|strain|force", false,
     "What the frames show, beside the positions: the first five of nodes, the last two of springs.", NULL},
    {"peak_every", SCHEMA_INTEGER, 1, 1, "-", "4", ">= 0", NULL, false,
     "Accepted steps from one look for the largest stresses and strains of the run to the next; 0: no looks.", NULL},
    {"most_stressed", SCHEMA_INTEGER, 1, 1, "-", "5", "[0, 1000]", NULL, false,
     "How many of the most stressed nodes and most strained springs of the run are listed.", NULL},
};

static const schema_key probe_keys[] = {
    {"name", SCHEMA_STRING, 1, 1, "-", REQUIRED, ANY, NULL, false,
     "Name of the table in the output, /probes/NAME: letters, digits, '_' and '-'.", "'above_the_void'"},
    {"kind", SCHEMA_CHOICE, 1, 1, "-", "'node'", ANY, "node|spring|gauge", false,
     "A node, a spring, or a gauge: the distance between two nodes.", NULL},
    {"place", SCHEMA_REAL, 2, 4, "m", NONE, ANY, NULL, false,
     "The node or spring nearest to this place, x and y in the body's own coordinates; of a gauge two places.",
     "0, 0.05"},
    {"body", SCHEMA_INTEGER, 1, 1, "-", "1", ">= 1", NULL, false,
     "Number of the body that has the place, in the order of the deck.", NULL},
    {"number", SCHEMA_INTEGER, 1, 2, "-", NONE, ">= 0", NULL, false,
     "Instead of a place: number of the node or spring in the output, from 0; of a gauge two nodes.", NULL},
    {"every", SCHEMA_INTEGER, 1, 1, "-", "1", ">= 1", NULL, false, "Accepted steps from one row to the next.", NULL},
};

#define KEYS(keys) (int)(sizeof(keys) / sizeof(keys)[0]), keys

static const schema_group groups[] = {
    {"run", true, false, "What is run, and for how long.", KEYS(run_keys)},
    {"material", false, true, "A material; one group for each. Only bodies from lattice files need none.",
     KEYS(material_keys)},
    {"body", true, true, "An elastic body; one group for each.", KEYS(body_keys)},
    {"void", false, true, "A hole cut out of a body; one group for each.", KEYS(void_keys)},
    {"pores", false, true, "Round pores at random places in a body.", KEYS(pores_keys)},
    {"crack", false, true, "A crack: a polyline that takes away every triangle which it crosses, with its springs.",
     KEYS(crack_keys)},
    {"inclusion", false, true, "Another material in a part of a body, to which it holds; one group for each.",
     KEYS(inclusion_keys)},
    {"boundary", false, true, "Nodes that are held, moved or loaded; prescribed ones touch no obstacle.",
     KEYS(boundary_keys)},
    {"obstacle", false, true, "A rigid obstacle that never moves; one group for each.", KEYS(obstacle_keys)},
    {"contact", false, false,
     "How nodes and edges of bodies touch obstacles; free ends of open polylines touch no edges.", KEYS(contact_keys)},
    {"solver", false, false, "Integration in time.", KEYS(solver_keys)},
    {"output", false, false, "Files written, and the log.", KEYS(output_keys)},
    {"probe", false, true, "A table over time in the output, of a node, a spring or a gauge; one group for each.",
     KEYS(probe_keys)},
};

const schema_group *schema_groups(int *n_groups)
{
    *n_groups = (int)(sizeof groups / sizeof groups[0]);
    return groups;
}
