/* SPDX-License-Identifier: BSD-3-Clause */
/* Editable lists of nodes, springs and triangles: selecting, moving and joining them, and the parts they form. What a
 * lattice must satisfy to move is model.c's business; here only what is needed to stay inside the arrays is checked. */
#include "lattice/lattice.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "base/vec2.h"
#include "lattice/mesh_edges.h"

static dem_status check_corners(const char *what, dem_index n, int arity, const dem_index *corner, dem_index n_nodes)
{
    CHECK(n >= 0, DEM_ERROR_ARGUMENT, "the number of %ss is negative: %lld", what, (long long)n);
    CHECK(n == 0 || corner != NULL, DEM_ERROR_ARGUMENT, "%lld %ss, but their nodes are NULL", (long long)n, what);
    for (dem_index k = 0; k < n * arity; k++)
        CHECK(corner[k] >= 0 && corner[k] < n_nodes, DEM_ERROR_MODEL, "%s %lld has node %lld, but there are %lld nodes",
              what, (long long)(k / arity), (long long)corner[k], (long long)n_nodes);
    return DEM_OK;
}

/* ---- parts ---- */

static dem_index root_of(dem_index *parent, dem_index i)
{
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

/* A part's root is its lowest node. */
static void unite(dem_index *parent, dem_index i, dem_index j)
{
    const dem_index a = root_of(parent, i), b = root_of(parent, j);
    if (a < b)
        parent[b] = a;
    else
        parent[a] = b;
}

/* n things that are all apart; NULL without memory. */
static dem_index *make_parents(dem_index n)
{
    dem_index *parent = lattice_zeros(n, sizeof *parent);
    for (dem_index i = 0; parent != NULL && i < n; i++) parent[i] = i;
    return parent;
}

/* Numbers parts by their lowest members. \param[out] part  [n]; may be NULL */
static dem_index number_parts(dem_index *part, dem_index *parent, dem_index n)
{
    dem_index n_parts = 0;
    for (dem_index i = 0; i < n; i++) {
        const dem_index root = root_of(parent, i);
        if (part != NULL) part[i] = root == i ? n_parts : part[root];
        n_parts += root == i;
    }
    return n_parts;
}

/* ---- selection: arrays shrink in place ---- */

static void pack(void *array, size_t size, dem_index n, const unsigned char *keep)
{
    unsigned char *bytes = array;
    dem_index kept = 0;
    for (dem_index i = 0; array != NULL && i < n; i++)
        if (keep[i]) memmove(bytes + size * (size_t)kept++, bytes + size * (size_t)i, size);
}

/* Drops tuples not wanted or without a node, renumbers the others. \param whole  [n] in: wanted, out: stayed */
static dem_index pack_corners(dem_index *corner, int arity, dem_index n, const dem_index *number, unsigned char *whole)
{
    dem_index kept = 0;
    for (dem_index k = 0; k < n; k++) {
        for (int c = 0; c < arity; c++) whole[k] = whole[k] && number[corner[arity * k + c]] >= 0;
        if (!whole[k]) continue;
        for (int c = 0; c < arity; c++) corner[arity * kept + c] = number[corner[arity * k + c]];
        kept++;
    }
    return kept;
}

static void pack_nodes(dem_lattice *lattice, const unsigned char *keep)
{
    const dem_index n = lattice->n_nodes;
    pack(lattice->x, 2 * sizeof *lattice->x, n, keep);
    pack(lattice->mass, sizeof *lattice->mass, n, keep);
    pack(lattice->flags, sizeof *lattice->flags, n, keep);
    pack(lattice->body, sizeof *lattice->body, n, keep);
    pack(lattice->position, 2 * sizeof *lattice->position, n, keep);
    pack(lattice->velocity, 2 * sizeof *lattice->velocity, n, keep);
}

static void pack_springs(dem_lattice *lattice, const dem_index *number, unsigned char *whole)
{
    const dem_index n = lattice->n_springs;
    lattice->n_springs = pack_corners(lattice->ends, 2, n, number, whole);
    pack(lattice->rest_length, sizeof *lattice->rest_length, n, whole);
    pack(lattice->stiffness, sizeof *lattice->stiffness, n, whole);
    pack(lattice->viscosity, sizeof *lattice->viscosity, n, whole);
}

static void pack_triangles(dem_lattice *lattice, const dem_index *number, unsigned char *whole)
{
    const dem_index n = lattice->n_triangles;
    lattice->n_triangles = pack_corners(lattice->triangles, 3, n, number, whole);
    pack(lattice->guard, sizeof *lattice->guard, n, whole);
    pack(lattice->area_stiffness, sizeof *lattice->area_stiffness, n, whole);
    pack(lattice->thickness, sizeof *lattice->thickness, n, whole);
    pack(lattice->modulus, sizeof *lattice->modulus, n, whole);
}

/* Keeps nodes and, of the triangles among them, those for which wanted[t] != 0; NULL: all. At least one node stays. */
static dem_status select_both(dem_lattice *lattice, const unsigned char *keep, const unsigned char *wanted)
{
    const dem_index n_springs = lattice->n_springs, n_triangles = lattice->n_triangles;
    dem_index *number = lattice_zeros(lattice->n_nodes, sizeof *number), n = 0;
    unsigned char *whole = lattice_zeros(n_springs + n_triangles, sizeof *whole);
    dem_status status = DEM_OK;
    if (number == NULL || whole == NULL) {
        status = status_fail(DEM_ERROR_MEMORY, "out of memory");
        goto out;
    }
    for (dem_index i = 0; i < lattice->n_nodes; i++) number[i] = keep[i] ? n++ : -1;
    if (n == 0) {
        status = status_fail(DEM_ERROR_MODEL, "none of %lld nodes is left", (long long)lattice->n_nodes);
        goto out;
    }
    memset(whole, 1, (size_t)(n_springs + n_triangles));
    for (dem_index t = 0; wanted != NULL && t < n_triangles; t++) whole[n_springs + t] = wanted[t] != 0;
    pack_springs(lattice, number, whole);
    pack_triangles(lattice, number, whole + n_springs);
    pack_nodes(lattice, keep);
    lattice->n_nodes = n;
out:
    free(number);
    free(whole);
    return status;
}

/* ---- moving ---- */

static void turn(double *array, dem_index n, double angle, vec2 shift)
{
    const double c = cos(angle), s = sin(angle);
    for (dem_index i = 0; array != NULL && i < n; i++) {
        const vec2 a = vec2_at(array, i);
        vec2_put(array, i, (vec2){c * a.x - s * a.y + shift.x, s * a.x + c * a.y + shift.y});
    }
}

/* ---- joining ---- */

/* n items of `a` and m of `b` one behind the other; zeros in place of NULL. */
static void *join(const void *a, dem_index n, const void *b, dem_index m, size_t size)
{
    unsigned char *joined = lattice_zeros(n + m, size);
    if (joined != NULL && a != NULL) memcpy(joined, a, (size_t)n * size);
    if (joined != NULL && b != NULL) memcpy(joined + (size_t)n * size, b, (size_t)m * size);
    return joined;
}

/* The same of triangles' numbers that are 1 where they are NULL; NULL if both are. */
static dem_status join_ones(double **out, const double *a, dem_index n, const double *b, dem_index m)
{
    if (a == NULL && b == NULL) return DEM_OK;
    *out = join(a, n, b, m, sizeof **out);
    CHECK_MEMORY(*out);
    for (dem_index k = 0; k < n && a == NULL; k++) (*out)[k] = 1.0;
    for (dem_index k = n; k < n + m && b == NULL; k++) (*out)[k] = 1.0;
    return DEM_OK;
}

static dem_index count_bodies(const dem_lattice *lattice)
{
    int32_t last = 0;
    for (dem_index i = 0; lattice->body != NULL && i < lattice->n_nodes; i++)
        if (lattice->body[i] > last) last = lattice->body[i];
    return lattice->n_nodes > 0 ? last + 1 : 0;
}

static dem_status copy_flags(unsigned char *flags, const dem_lattice *lattice)
{
    if (lattice->flags == NULL) return mesh_edges_contact_flags(flags, lattice);
    memcpy(flags, lattice->flags, (size_t)lattice->n_nodes);
    return DEM_OK;
}

static dem_status join_flags(dem_lattice *out, const dem_lattice *a, const dem_lattice *b)
{
    const bool same_rule = (a->n_triangles == 0) == (b->n_triangles == 0);
    if (a->flags == NULL && b->flags == NULL && (same_rule || a->n_nodes == 0 || b->n_nodes == 0)) return DEM_OK;
    out->flags = lattice_zeros(a->n_nodes + b->n_nodes, sizeof *out->flags);
    CHECK_MEMORY(out->flags);
    TRY(copy_flags(out->flags, a));
    return copy_flags(out->flags + a->n_nodes, b);
}

static dem_status join_bodies(dem_lattice *out, const dem_lattice *a, const dem_lattice *b)
{
    const dem_index n = a->n_nodes, shift = count_bodies(a);
    if (b->n_nodes == 0 && a->body == NULL) return DEM_OK;
    if (n == 0 && b->body == NULL) return DEM_OK;
    CHECK(shift + count_bodies(b) <= INT32_MAX, DEM_ERROR_MODEL, "more than %ld bodies", (long)INT32_MAX);
    out->body = join(a->body, n, b->body, b->n_nodes, sizeof *out->body);
    CHECK_MEMORY(out->body);
    for (dem_index i = n; i < n + b->n_nodes; i++) out->body[i] += (int32_t)shift;
    return DEM_OK;
}

static dem_status join_nodes(dem_lattice *out, const dem_lattice *a, const dem_lattice *b)
{
    const dem_index n = a->n_nodes, m = b->n_nodes;
    const size_t scalar = sizeof(double), vector = 2 * sizeof(double);
    out->n_nodes = n + m;
    out->x = join(a->x, n, b->x, m, vector);
    CHECK_MEMORY(out->x);
    if (a->mass != NULL || b->mass != NULL) {
        out->mass = join(a->mass, n, b->mass, m, scalar);
        CHECK_MEMORY(out->mass);
    }
    if (a->position != NULL || b->position != NULL) {
        out->position = join(a->position ? a->position : a->x, n, b->position ? b->position : b->x, m, vector);
        CHECK_MEMORY(out->position);
    }
    if (a->velocity != NULL || b->velocity != NULL) {
        out->velocity = join(a->velocity, n, b->velocity, m, vector);
        CHECK_MEMORY(out->velocity);
    }
    return DEM_OK;
}

static dem_status join_springs(dem_lattice *out, const dem_lattice *a, const dem_lattice *b)
{
    const dem_index n = a->n_springs, m = b->n_springs;
    out->n_springs = n + m;
    if (n + m == 0) return DEM_OK;
    out->ends = join(a->ends, n, b->ends, m, 2 * sizeof *out->ends);
    out->rest_length = join(a->rest_length, n, b->rest_length, m, sizeof *out->rest_length);
    out->stiffness = join(a->stiffness, n, b->stiffness, m, sizeof *out->stiffness);
    CHECK_MEMORY(out->ends);
    CHECK_MEMORY(out->rest_length);
    CHECK_MEMORY(out->stiffness);
    for (dem_index k = 2 * n; k < 2 * (n + m); k++) out->ends[k] += a->n_nodes;
    if (a->viscosity == NULL && b->viscosity == NULL) return DEM_OK;
    out->viscosity = join(a->viscosity, n, b->viscosity, m, sizeof *out->viscosity);
    CHECK_MEMORY(out->viscosity);
    return DEM_OK;
}

static dem_status join_triangles(dem_lattice *out, const dem_lattice *a, const dem_lattice *b)
{
    const dem_index n = a->n_triangles, m = b->n_triangles;
    out->n_triangles = n + m;
    if (n + m == 0) return DEM_OK;
    out->triangles = join(a->triangles, n, b->triangles, m, 3 * sizeof *out->triangles);
    CHECK_MEMORY(out->triangles);
    for (dem_index k = 3 * n; k < 3 * (n + m); k++) out->triangles[k] += a->n_nodes;
    TRY(join_ones(&out->thickness, a->thickness, n, b->thickness, m));
    TRY(join_ones(&out->modulus, a->modulus, n, b->modulus, m));
    if (a->guard != NULL || b->guard != NULL) {
        out->guard = join(a->guard, n, b->guard, m, sizeof *out->guard);
        CHECK_MEMORY(out->guard);
    }
    if (a->area_stiffness != NULL || b->area_stiffness != NULL) {
        out->area_stiffness = join(a->area_stiffness, n, b->area_stiffness, m, sizeof *out->area_stiffness);
        CHECK_MEMORY(out->area_stiffness);
    }
    return DEM_OK;
}

static dem_status join_all(dem_lattice *out, const dem_lattice *a, const dem_lattice *b)
{
    TRY(join_nodes(out, a, b));
    TRY(join_flags(out, a, b));
    TRY(join_bodies(out, a, b));
    TRY(join_springs(out, a, b));
    return join_triangles(out, a, b);
}

/* ---- public ---- */

void *lattice_zeros(dem_index n, size_t size)
{
    return calloc(n > 0 ? (size_t)n : 1, size);
}

dem_status lattice_check(const dem_lattice *lattice)
{
    CHECK(lattice != NULL, DEM_ERROR_ARGUMENT, "lattice is NULL");
    CHECK(lattice->n_nodes >= 0, DEM_ERROR_ARGUMENT, "the number of nodes is negative: %lld",
          (long long)lattice->n_nodes);
    CHECK(lattice->n_nodes == 0 || lattice->x != NULL, DEM_ERROR_ARGUMENT, "%lld nodes, but x is NULL",
          (long long)lattice->n_nodes);
    TRY(check_corners("spring", lattice->n_springs, 2, lattice->ends, lattice->n_nodes));
    CHECK(lattice->n_springs == 0 || (lattice->rest_length != NULL && lattice->stiffness != NULL), DEM_ERROR_ARGUMENT,
          "%lld springs, but rest_length or stiffness is NULL", (long long)lattice->n_springs);
    return check_corners("triangle", lattice->n_triangles, 3, lattice->triangles, lattice->n_nodes);
}

void dem_lattice_init(dem_lattice *lattice)
{
    *lattice = (dem_lattice){.struct_size = sizeof *lattice, .dim = 2};
}

void dem_lattice_free(dem_lattice *lattice)
{
    if (lattice == NULL) return;
    free(lattice->x);
    free(lattice->mass);
    free(lattice->ends);
    free(lattice->rest_length);
    free(lattice->stiffness);
    free(lattice->viscosity);
    free(lattice->triangles);
    free(lattice->guard);
    free(lattice->area_stiffness);
    free(lattice->thickness);
    free(lattice->modulus);
    free(lattice->flags);
    free(lattice->body);
    free(lattice->position);
    free(lattice->velocity);
    dem_lattice_init(lattice);
}

dem_status dem_lattice_parts(const dem_lattice *lattice, dem_index *n_parts, dem_index *part)
{
    TRY(lattice_check(lattice));
    CHECK(n_parts != NULL, DEM_ERROR_ARGUMENT, "n_parts is NULL");
    dem_index *parent = make_parents(lattice->n_nodes);
    CHECK_MEMORY(parent);
    for (dem_index k = 0; k < lattice->n_springs; k++) unite(parent, lattice->ends[2 * k], lattice->ends[2 * k + 1]);
    *n_parts = number_parts(part, parent, lattice->n_nodes);
    free(parent);
    return DEM_OK;
}

dem_status dem_lattice_pieces(const dem_lattice *lattice, dem_index *n_pieces, dem_index *piece)
{
    mesh_edges s;
    TRY(lattice_check(lattice));
    CHECK(n_pieces != NULL, DEM_ERROR_ARGUMENT, "n_pieces is NULL");
    TRY(mesh_edges_create(&s, lattice));
    dem_index *parent = make_parents(lattice->n_triangles);
    for (dem_index i = 0; parent != NULL && i < lattice->n_nodes; i++)
        for (dem_index p = s.row[i]; p < s.row[i + 1]; p++)
            if (!mesh_edges_is_first(&s, i, p)) unite(parent, s.list[p - 1].triangle, s.list[p].triangle);
    mesh_edges_free(&s);
    CHECK_MEMORY(parent);
    *n_pieces = number_parts(piece, parent, lattice->n_triangles);
    free(parent);
    return DEM_OK;
}

dem_status dem_lattice_rims(const dem_lattice *lattice, dem_index *n_edges)
{
    mesh_edges s;
    TRY(lattice_check(lattice));
    CHECK(n_edges != NULL, DEM_ERROR_ARGUMENT, "n_edges is NULL");
    TRY(mesh_edges_create(&s, lattice));
    for (dem_index i = 0; i < lattice->n_nodes; i++) n_edges[i] = 0;
    for (dem_index i = 0; i < lattice->n_nodes; i++)
        for (dem_index p = s.row[i]; p < s.row[i + 1]; p++) {
            if (!mesh_edges_is_boundary(&s, i, p)) continue;
            n_edges[i]++;
            n_edges[s.list[p].upper]++;
        }
    mesh_edges_free(&s);
    return DEM_OK;
}

dem_status dem_lattice_select(dem_lattice *lattice, const unsigned char *keep)
{
    TRY(lattice_check(lattice));
    CHECK(keep != NULL, DEM_ERROR_ARGUMENT, "keep is NULL");
    return select_both(lattice, keep, NULL);
}

dem_status dem_lattice_trim(dem_lattice *lattice, const unsigned char *keep)
{
    TRY(lattice_check(lattice));
    CHECK(keep != NULL, DEM_ERROR_ARGUMENT, "keep is NULL");
    CHECK(lattice->n_springs == 0, DEM_ERROR_MODEL, "a lattice that has springs cannot be trimmed: %lld springs",
          (long long)lattice->n_springs);
    unsigned char *used = lattice_zeros(lattice->n_nodes, sizeof *used);
    CHECK_MEMORY(used);
    for (dem_index k = 0; k < 3 * lattice->n_triangles; k++)
        if (keep[k / 3]) used[lattice->triangles[k]] = 1;
    const dem_status status = select_both(lattice, used, keep);
    free(used);
    return status;
}

void dem_lattice_move(dem_lattice *lattice, double angle, const double offset[2])
{
    const vec2 shift = {offset[0], offset[1]}, none = {0.0, 0.0};
    turn(lattice->x, lattice->n_nodes, angle, shift);
    turn(lattice->position, lattice->n_nodes, angle, shift);
    turn(lattice->velocity, lattice->n_nodes, angle, none);
}

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

dem_status dem_lattice_spin(dem_lattice *lattice, double angular_velocity)
{
    TRY(lattice_check(lattice));
    CHECK(isfinite(angular_velocity), DEM_ERROR_ARGUMENT, "the angular velocity %g rad/s is not finite",
          angular_velocity);
    CHECK(lattice->mass != NULL, DEM_ERROR_MODEL, "a lattice without masses has no centre of mass to turn about");
    TRY(dem_lattice_launch(lattice, (const double[2]){0.0, 0.0})); /* there are velocities then */
    const double *x = lattice->position != NULL ? lattice->position : lattice->x;
    vec2 centre = {0.0, 0.0};
    double mass = 0.0;
    for (dem_index i = 0; i < lattice->n_nodes; i++) {
        centre = vec2_along(centre, lattice->mass[i], vec2_at(x, i));
        mass += lattice->mass[i];
    }
    for (dem_index i = 0; i < lattice->n_nodes; i++) {
        const vec2 arm = vec2_along(vec2_at(x, i), -1.0 / mass, centre), before = vec2_at(lattice->velocity, i);
        vec2_put(lattice->velocity, i, vec2_along(before, angular_velocity, (vec2){-arm.y, arm.x}));
    }
    return DEM_OK;
}

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

/* Half of every boundary edge between nodes that have a place in the list, to both, as thick as its triangle. */
static void share_edges(const dem_lattice *l, const mesh_edges *s, const dem_index *place, const double *direction,
                        double *area)
{
    for (dem_index i = 0; i < l->n_nodes; i++)
        for (dem_index p = s->row[i]; p < s->row[i + 1]; p++) {
            const dem_index j = s->list[p].upper;
            if (!mesh_edges_is_boundary(s, i, p) || place[i] < 0 || place[j] < 0) continue;
            const double way[2] = {l->x[2 * j] - l->x[2 * i], l->x[2 * j + 1] - l->x[2 * i + 1]};
            const double length =
                direction == NULL ? hypot(way[0], way[1]) : fabs(way[0] * direction[0] + way[1] * direction[1]);
            const double half = 0.5 * length * (l->thickness != NULL ? l->thickness[s->list[p].triangle] : 1.0);
            area[place[i]] += half;
            area[place[j]] += half;
        }
}

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

dem_status dem_lattice_exclude(dem_lattice *lattice, const dem_index *nodes, dem_index n)
{
    TRY(check_list(lattice, nodes, n));
    if (lattice->flags == NULL) {
        unsigned char *flags = lattice_zeros(lattice->n_nodes, sizeof *flags);
        CHECK_MEMORY(flags);
        const dem_status status = mesh_edges_contact_flags(flags, lattice);
        if (status != DEM_OK) free(flags);
        TRY(status);
        lattice->flags = flags;
    }
    for (dem_index k = 0; k < n; k++) lattice->flags[nodes[k]] &= (unsigned char)~DEM_NODE_CONTACT;
    return DEM_OK;
}

dem_status dem_lattice_append(dem_lattice *lattice, const dem_lattice *other)
{
    dem_lattice joined;
    TRY(lattice_check(lattice));
    TRY(lattice_check(other));
    const bool both = lattice->n_nodes > 0 && other->n_nodes > 0;
    CHECK(!both || (lattice->mass == NULL) == (other->mass == NULL), DEM_ERROR_MODEL,
          "one lattice has masses, the other has none");
    dem_lattice_init(&joined);
    const dem_status status = join_all(&joined, lattice, other);
    if (status == DEM_OK) {
        dem_lattice_free(lattice);
        *lattice = joined;
    } else {
        dem_lattice_free(&joined);
    }
    return status;
}
