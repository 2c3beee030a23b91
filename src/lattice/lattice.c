/* SPDX-License-Identifier: BSD-3-Clause */
/* Editable lists of nodes, springs and triangles: checking, freeing, moving and spinning them, and what their boundary
 * edges give to nodes. Only what is needed to stay inside the arrays is checked here; what a lattice must satisfy to
 * move is checked by model/model.c. Generating, assembling, joining and selecting have files of their own. */
#include "lattice/lattice.h"

#include <math.h>
#include <stdlib.h>

#include "base/status.h"
#include "base/struct_size.h"
#include "base/vec2.h"
#include "lattice/lattice_arrays.h"
#include "lattice/mesh_edges.h"

/* The shortest struct that is accepted ends with `velocity`, the last member of the first version. */
static const struct_kind kind = {"dem_lattice", STRUCT_SIZE_WITH(dem_lattice, velocity), sizeof(dem_lattice)};

/* A list of tuples of `arity` nodes: springs have 2, triangles 3. */
static dem_status check_list_of(const char *what, dem_index n, int arity, const dem_index *corner, dem_index n_nodes)
{
    CHECK(n >= 0, DEM_ERROR_ARGUMENT, "the number of %ss is negative: %lld", what, (long long)n);
    CHECK(n == 0 || corner != NULL, DEM_ERROR_ARGUMENT, "%lld %ss, but their nodes are NULL", (long long)n, what);
    return lattice_check_corners(what, arity, corner, 0, n, n_nodes);
}

/* ---- moving ---- */

/* Turns n vectors by `angle`, rad, counter-clockwise about the origin, and shifts them. */
static void turn(double *array, dem_index n, double angle, vec2 shift)
{
    const double c = cos(angle), s = sin(angle);
    for (dem_index i = 0; array != NULL && i < n; i++) {
        const vec2 a = vec2_at(array, i);
        vec2_put(array, i, (vec2){c * a.x - s * a.y + shift.x, s * a.x + c * a.y + shift.y});
    }
}

/* ---- public ---- */

/* Never asks for no bytes, for which calloc() may return NULL. */
void *lattice_zeros(dem_index n, size_t size)
{
    return calloc(n > 0 ? (size_t)n : 1, size);
}

dem_status lattice_check_corners(const char *what, int arity, const dem_index *corner, dem_index first, dem_index n,
                                 dem_index n_nodes)
{
    for (dem_index k = 0; k < n * arity; k++)
        CHECK(corner[k] >= 0 && corner[k] < n_nodes, DEM_ERROR_MODEL, "%s %lld has node %lld, but there are %lld nodes",
              what, (long long)(first + k / arity), (long long)corner[k], (long long)n_nodes);
    return DEM_OK;
}

/* Numbers and arrays first, then the node numbers in them; masses and other values are not looked at. */
dem_status lattice_check(const dem_lattice *lattice)
{
    CHECK(lattice != NULL, DEM_ERROR_ARGUMENT, "lattice is NULL");
    TRY(struct_size_check(&kind, lattice));
    CHECK(lattice->n_nodes >= 0, DEM_ERROR_ARGUMENT, "the number of nodes is negative: %lld",
          (long long)lattice->n_nodes);
    CHECK(lattice->n_nodes == 0 || lattice->x != NULL, DEM_ERROR_ARGUMENT, "%lld nodes, but x is NULL",
          (long long)lattice->n_nodes);
    TRY(check_list_of("spring", lattice->n_springs, 2, lattice->ends, lattice->n_nodes));
    CHECK(lattice->n_springs == 0 || (lattice->rest_length != NULL && lattice->stiffness != NULL), DEM_ERROR_ARGUMENT,
          "%lld springs, but rest_length or stiffness is NULL", (long long)lattice->n_springs);
    return check_list_of("triangle", lattice->n_triangles, 3, lattice->triangles, lattice->n_nodes);
}

bool lattice_has_couplings(const dem_lattice *lattice)
{
    return lattice->struct_size >= STRUCT_SIZE_WITH(dem_lattice, coupling);
}

bool lattice_has_limits(const dem_lattice *lattice)
{
    return lattice->struct_size >= STRUCT_SIZE_WITH(dem_lattice, critical_stretch);
}

bool lattice_has_softening(const dem_lattice *lattice)
{
    return lattice->struct_size >= STRUCT_SIZE_WITH(dem_lattice, softening);
}

bool lattice_has_pressure_limits(const dem_lattice *lattice)
{
    return lattice->struct_size >= STRUCT_SIZE_WITH(dem_lattice, confinement);
}

bool lattice_has_own_stress(const dem_lattice *lattice)
{
    return lattice->struct_size >= STRUCT_SIZE_WITH(dem_lattice, own_stress);
}

dem_status lattice_read(dem_lattice *ours, const dem_lattice *theirs)
{
    *ours = dem_lattice_empty();
    return struct_size_read(&kind, ours, theirs);
}

dem_status lattice_check_out(const dem_lattice *out)
{
    CHECK(out != NULL, DEM_ERROR_ARGUMENT, "out is NULL");
    return struct_size_check(&kind, out);
}

/* The size has been checked before. */
void lattice_give(dem_lattice *out, const dem_lattice *made)
{
    (void)struct_size_write(&kind, out, made);
}

/* What has no size is no lattice, or not one yet; that is no failure, so that the message of one stays. */
void dem_lattice_free(dem_lattice *lattice)
{
    const dem_lattice empty = dem_lattice_empty();
    dem_lattice own = empty;
    if (lattice == NULL || !struct_size_fits(&kind, lattice)) return;
    (void)struct_size_read(&kind, &own, lattice);
    for (int k = 0; k < LATTICE_ARRAYS; k++) free(lattice_array_of(&own, &lattice_arrays[k]));
    lattice_give(lattice, &empty);
}

/* Velocities are turned with the body but not shifted. */
void dem_lattice_move(dem_lattice *lattice, double angle, const double offset[2])
{
    const vec2 shift = {offset[0], offset[1]}, none = {0.0, 0.0};
    turn(lattice->x, lattice->n_nodes, angle, shift);
    turn(lattice->position, lattice->n_nodes, angle, shift);
    turn(lattice->velocity, lattice->n_nodes, angle, none);
}

/* Adds to the velocities, so that several motions can be put on a lattice one after another. */
dem_status dem_lattice_launch(dem_lattice *lattice, const double velocity[2])
{
    TRY(lattice_check(lattice));
    CHECK(velocity != NULL && isfinite(velocity[0]) && isfinite(velocity[1]), DEM_ERROR_ARGUMENT,
          "the velocity must be two finite numbers");
    if (lattice->velocity == NULL) lattice->velocity = lattice_zeros(lattice->n_nodes, 2 * sizeof *lattice->velocity);
    CHECK_MEMORY(lattice->velocity);
    for (dem_index i = 0; i < lattice->n_nodes; i++) {
        lattice->velocity[2 * i] += velocity[0];
        lattice->velocity[2 * i + 1] += velocity[1];
    }
    return DEM_OK;
}

/* Spinning is about where the body starts, not about its rest shape. */
static const double *start_of(const dem_lattice *lattice)
{
    return lattice->position != NULL ? lattice->position : lattice->x;
}

/* Adds omega z x (x - x_c), which leaves the momentum what it was where x_c is the centre of mass. */
static dem_status add_rotation(dem_lattice *lattice, double angular_velocity, vec2 centre)
{
    TRY(dem_lattice_launch(lattice, (const double[2]){0.0, 0.0})); /* there are velocities then */
    for (dem_index i = 0; i < lattice->n_nodes; i++) {
        const vec2 arm = vec2_sub(vec2_at(start_of(lattice), i), centre), before = vec2_at(lattice->velocity, i);
        vec2_put(lattice->velocity, i, vec2_along(before, angular_velocity, (vec2){-arm.y, arm.x}));
    }
    return DEM_OK;
}

static dem_status check_rotation(const dem_lattice *lattice, double angular_velocity)
{
    TRY(lattice_check(lattice));
    CHECK(isfinite(angular_velocity), DEM_ERROR_ARGUMENT, "the angular velocity %g rad/s is not finite",
          angular_velocity);
    return DEM_OK;
}

dem_status dem_lattice_spin_about(dem_lattice *lattice, double angular_velocity, const double centre[2])
{
    TRY(check_rotation(lattice, angular_velocity));
    CHECK(centre != NULL && isfinite(centre[0]) && isfinite(centre[1]), DEM_ERROR_ARGUMENT,
          "the centre of a rotation must be two finite numbers");
    return add_rotation(lattice, angular_velocity, vec2_at(centre, 0));
}

dem_status dem_lattice_spin(dem_lattice *lattice, double angular_velocity)
{
    TRY(check_rotation(lattice, angular_velocity));
    CHECK(lattice->mass != NULL, DEM_ERROR_MODEL, "a lattice without masses has no centre of mass to turn about");
    vec2 sum = {0.0, 0.0};
    double mass = 0.0;
    for (dem_index i = 0; i < lattice->n_nodes; i++) {
        sum = vec2_along(sum, lattice->mass[i], vec2_at(start_of(lattice), i));
        mass += lattice->mass[i];
    }
    return add_rotation(lattice, angular_velocity, vec2_scale(1.0 / mass, sum));
}

/* A list of nodes that the caller has given. */
static dem_status check_list(const dem_lattice *lattice, const dem_index *nodes, dem_index n)
{
    TRY(lattice_check(lattice));
    CHECK(n >= 0 && (n == 0 || nodes != NULL), DEM_ERROR_ARGUMENT, "%lld nodes are meant, the list is %s", (long long)n,
          nodes != NULL ? "given" : "NULL");
    for (dem_index k = 0; k < n; k++)
        CHECK(nodes[k] >= 0 && nodes[k] < lattice->n_nodes, DEM_ERROR_ARGUMENT, "node %lld is not in 0 to %lld",
              (long long)nodes[k], (long long)(lattice->n_nodes - 1));
    return DEM_OK;
}

/* Half of every boundary edge between nodes of the list goes to each of its ends, times the thickness of its triangle:
 * an area in m^2. With a unit vector `direction` it is the projection of the edge on it. */
static void share_edges(const dem_lattice *l, const mesh_edges *s, const dem_index *place, const double *direction,
                        double *area)
{
    for (dem_index i = 0; i < l->n_nodes; i++)
        for (dem_index p = s->row[i]; p < s->row[i + 1]; p++) {
            const dem_index j = s->list[p].upper;
            if (!mesh_edges_is_boundary(s, i, p) || place[i] < 0 || place[j] < 0) continue;
            const double way[2] = {l->x[2 * j] - l->x[2 * i], l->x[2 * j + 1] - l->x[2 * i + 1]};
            /* The length of the edge, or of its projection, m. */
            const double length =
                direction == NULL ? hypot(way[0], way[1]) : fabs(way[0] * direction[0] + way[1] * direction[1]);
            const double half = 0.5 * length * (l->thickness != NULL ? l->thickness[s->list[p].triangle] : 1.0);
            area[place[i]] += half;
            area[place[j]] += half;
        }
}

/* `place` finds a node in the list; -1 if it is not in it. */
dem_status dem_lattice_edge_shares(const dem_lattice *lattice, const dem_index *nodes, dem_index n,
                                   const double *direction, double *area)
{
    mesh_edges s;
    TRY(check_list(lattice, nodes, n));
    CHECK(area != NULL, DEM_ERROR_ARGUMENT, "dem_lattice_edge_shares: area is NULL");
    dem_index *place = malloc((size_t)lattice->n_nodes * sizeof *place);
    CHECK_MEMORY(place);
    const dem_status status = mesh_edges_create(&s, lattice);
    if (status == DEM_OK) {
        for (dem_index i = 0; i < lattice->n_nodes; i++) place[i] = -1;
        for (dem_index k = 0; k < n; k++) place[nodes[k]] = k;
        for (dem_index k = 0; k < n; k++) area[k] = 0.0;
        share_edges(lattice, &s, place, direction, area);
        mesh_edges_free(&s);
    }
    free(place);
    return status;
}

/* Flags that are missing are written out as what they stand for. */
static dem_status make_flags(dem_lattice *lattice)
{
    if (lattice->flags != NULL) return DEM_OK;
    unsigned char *flags = lattice_zeros(lattice->n_nodes, sizeof *flags);
    CHECK_MEMORY(flags);
    const dem_status status = mesh_edges_contact_flags(flags, lattice);
    if (status != DEM_OK) free(flags);
    TRY(status);
    lattice->flags = flags;
    return DEM_OK;
}

dem_index lattice_count_bodies(const dem_lattice *lattice)
{
    int32_t last = 0;
    for (dem_index i = 0; lattice->body != NULL && i < lattice->n_nodes; i++)
        if (lattice->body[i] > last) last = lattice->body[i];
    return lattice->n_nodes > 0 ? last + 1 : 0;
}

dem_status dem_lattice_exclude(dem_lattice *lattice, const dem_index *nodes, dem_index n)
{
    TRY(check_list(lattice, nodes, n));
    TRY(make_flags(lattice));
    for (dem_index k = 0; k < n; k++) lattice->flags[nodes[k]] &= (unsigned char)~DEM_NODE_CONTACT;
    return DEM_OK;
}

dem_status dem_lattice_stiffen(dem_lattice *lattice, dem_guide guide)
{
    enum { guides = DEM_NODE_GUIDE_X | DEM_NODE_GUIDE_Y };
    static const int flag[] = {0, DEM_NODE_GUIDE_X, DEM_NODE_GUIDE_Y};
    TRY(lattice_check(lattice));
    CHECK(guide >= DEM_GUIDE_NONE && guide <= DEM_GUIDE_Y, DEM_ERROR_ARGUMENT, "unknown guide %d", (int)guide);
    TRY(make_flags(lattice));
    for (dem_index i = 0; i < lattice->n_nodes; i++)
        lattice->flags[i] = (unsigned char)((lattice->flags[i] & ~guides) | DEM_NODE_RIGID | flag[guide]);
    return DEM_OK;
}
