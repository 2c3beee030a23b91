/* SPDX-License-Identifier: BSD-3-Clause */
/* Elements of a simulation break or soften: forces, the surfaces that touch, and overlaps go on with those that are
 * whole. The new state of elements and its surface are made beside the ones in force, which they replace when nothing
 * can fail any more. The energy that the broken elements had is entered as that of fracture, so that the ledger closes:
 * the change of the mechanical energy with the motion as it is, that of new surfaces near others with it. Masses stay.
 * All that follows from what is broken is a function of the flags alone, which are all that a checkpoint has. */
#include "simulation/breaking.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/reduce.h"
#include "base/status.h"
#include "simulation/body_contact.h"
#include "simulation/pausing.h"
#include "simulation/set_motion.h"
#include "simulation/shared_breaks.h"

static const char of_energy[] = "fracture", of_burials[] = "nodes buried";

/* ---- what depends on it ---- */

static dem_status break_surfaces(dem_simulation *s, const mesh_boundary *boundary, const unsigned char *broken,
                                 const double *y)
{
    return s->surfaces != NULL ? surface_contact_break(s->surfaces, boundary, broken, y) : DEM_OK;
}

/* Lists of surfaces fit a state, so that its energy is found without memory; NULL: that comes later. */
static dem_status follow_state(dem_simulation *s, const double *y)
{
    return y != NULL ? body_contact_follow(s, y) : DEM_OK;
}

/* What surfaces had before. */
static dem_status go_back(dem_simulation *s, const double *y)
{
    if (s->surfaces != NULL) surface_contact_mend(s->surfaces);
    return follow_state(s, y);
}

/* After a failure all is as it was, unless there is no memory to go back either.  \param outline  NULL: as it is */
static dem_status follow(dem_simulation *s, const element_state *next, const mesh_boundary *boundary,
                         const surface *outline, const double *y)
{
    dem_status status = break_surfaces(s, boundary, next->triangle, y);
    if (status == DEM_OK) status = follow_state(s, y);
    if (status == DEM_OK) status = overlap_reserve(&s->overlap, boundary);
    if (status == DEM_OK && outline != NULL) status = contact_source_follow_surface(&s->contact_events, outline);
    return status == DEM_OK ? DEM_OK : status_first(status, go_back(s, y));
}

static void free_outline(surface *outline)
{
    if (outline != NULL) surface_free(outline);
    free(outline);
}

/* Where the lattice is a part of one it does not know which of its sides are others' too: from the boundary of all. */
static dem_status find_boundary_of_part(const mesh_boundary *whole, const element_state *next, mesh_boundary *out)
{
    const dem_lattice *l = next->lattice;
    dem_index n = 0, *broken = malloc(((size_t)l->n_triangles + 1) * sizeof *broken);
    CHECK(broken != NULL, DEM_ERROR_MEMORY, "out of memory for %lld triangles", (long long)l->n_triangles);
    for (dem_index t = 0; t < l->n_triangles; t++)
        if (next->triangle[t]) broken[n++] = t;
    const dem_status status = mesh_boundary_follow(out, whole, next, broken, n);
    free(broken);
    return status;
}

/* Elements that break by themselves change the boundary that is known; else it is found anew. */
static dem_status find_boundary(const dem_simulation *s, const element_state *next, mesh_boundary *out)
{
    const fracture_source *breaks = &s->breaks;
    if (next == &s->elements && s->n_outside > 0 && s->n_outside + breaks->breaks.n == next->n_broken)
        return mesh_boundary_follow(out, &s->boundary, next, breaks->broken, breaks->breaks.n);
    if (s->model->domain != NULL) return find_boundary_of_part(&s->model->touching->boundary, next, out);
    return mesh_boundary_create(out, &s->model->lattice, next->triangle);
}

/* What may touch obstacles; NULL where there are none to touch. */
static dem_status make_outline(const dem_simulation *s, const element_state *next, const mesh_boundary *boundary,
                               surface **out)
{
    *out = NULL;
    if (s->model->obstacles.n == 0) return DEM_OK;
    *out = calloc(1, sizeof **out);
    CHECK(*out != NULL, DEM_ERROR_MEMORY, "out of memory for what may touch obstacles");
    return surface_compile_broken(*out, boundary, next->triangle, s->boundaries.held);
}

/* Makes the outline that of a state of elements.  \param y  [2 dim n_rows] the motion in it, or NULL */
static dem_status renew_outline(dem_simulation *s, const element_state *next, const double *y)
{
    mesh_boundary boundary = {0};
    surface *outline = NULL;
    dem_status status = find_boundary(s, next, &boundary);
    if (status == DEM_OK) status = make_outline(s, next, &boundary, &outline);
    if (status == DEM_OK) status = follow(s, next, &boundary, outline, y);
    free_outline(status == DEM_OK ? s->outline : outline);
    mesh_boundary_free(status == DEM_OK ? &s->boundary : &boundary);
    if (status != DEM_OK) return status;
    if (s->surfaces != NULL) surface_contact_keep(s->surfaces);
    s->outline = outline;
    s->boundary = boundary;
    overlap_break(&s->overlap, &s->boundary, next->triangle);
    s->n_outside = next->n_broken;
    return DEM_OK;
}

/* The state of elements becomes `next`, which is taken over or freed. */
static dem_status renew(dem_simulation *s, element_state *next, const double *y)
{
    const dem_status status = renew_outline(s, next, y);
    element_state_destroy(status == DEM_OK ? &s->elements : next);
    if (status != DEM_OK) return status;
    s->elements = *next;
    s->forces.elements = &s->elements;
    kernel_follow(&s->kernel, &s->elements, NULL, 0);
    return DEM_OK;
}

void breaking_destroy(dem_simulation *s)
{
    fracture_source_destroy(&s->breaks);
    break_list_destroy(&s->given);
    element_state_destroy(&s->elements);
    free_outline(s->outline);
    mesh_boundary_free(&s->boundary);
}

/* ---- by stress or strain ---- */

/* Beyond this share of all elements, or this number if it is larger, breaks in one step mean that it is too long. Fixed
 * steps cannot be shortened. */
static dem_index most_in_step(const dem_simulation *s)
{
    enum { SHARE = 20, FEW = 100 };
    const domain *d = s->model->domain;
    const dem_lattice *l = &s->model->lattice;
    const dem_index n = d != NULL ? d->n_triangles + d->n_springs : l->n_triangles + l->n_springs;
    return s->options.fixed_step > 0.0 ? -1 : n / SHARE > FEW ? n / SHARE : FEW;
}

dem_status breaking_create(dem_simulation *s)
{
    const dem_lattice *l = &s->model->lattice;
    if (!breakable_lattice(l)) return DEM_OK;
    TRY(element_state_begin(&s->elements, l, &s->model->springs));
    if (l->own_stress != NULL) TRY(element_state_prepare(&s->elements)); /* which needs the shares of springs */
    s->forces.elements = &s->elements;
    TRY(fracture_source_create(&s->breaks, s->model, &s->elements, &s->fracture, most_in_step(s), &s->kernel));
    TRY(reduce_status(s->model->ranks, fracture_source_check_start(&s->breaks, s->y), 0.0));
    return source_list_add(&s->sources, fracture_source_events(&s->breaks));
}

/* Contact comes first of events at the same time: what breaks then does at the start of the next step. */
void breaking_check_step(dem_simulation *s)
{
    s->at_break = false;
    if (!run_may_break(s)) return;
    const double first = fracture_source_first(&s->breaks, &s->path, s->frame);
    s->at_break = first < s->path.end || (first == s->path.end && !s->at_event);
    if (!s->at_break) return;
    s->path.end = first;
    s->at_event = false;
}

dem_status breaking_found(const dem_simulation *s)
{
    return run_may_break(s) ? fracture_source_found(&s->breaks) : DEM_OK;
}

/* New faces near others change the energy of contact: what it is less goes with that of the broken elements. Ranks,
 * which measure that together, all break the same: where one has no memory for it none goes on. Some may have made
 * their outlines anew by then, which nobody asks for any more. */
dem_status breaking_follow(dem_simulation *s, const double *y)
{
    const fracture_source *b = &s->breaks;
    const ranks *r = s->model->ranks;
    if (fracture_source_has_failed(b)) kernel_follow(&s->kernel, &s->elements, b->failed, b->n_failed);
    if (!fracture_source_has_broken(b)) return DEM_OK;
    TRY(reduce_status(r, body_contact_follow(s, y), 0.0));
    const double before = s->surfaces != NULL ? set_motion_energy(s, y) : 0.0;
    TRY(reduce_status(r, renew_outline(s, &s->elements, y), 0.0));
    if (s->surfaces != NULL) exact_sum_add(&s->fracture, before - set_motion_energy(s, y));
    return DEM_OK;
}

/* The state in which a step ends that a break ends. Energies are of all nodes. */
static void show_break(dem_simulation *s)
{
    dense_output_state(&s->path, s->path.end, s->frame);
    if (s->surfaces != NULL && s->model->domain != NULL) s->shared.fill_ghosts(s->frame, s);
}

dem_status breaking_end_step(dem_simulation *s)
{
    if (!s->at_break) return breaking_follow(s, s->path.y1);
    show_break(s);
    dem_status status = reduce_status(s->model->ranks, fracture_source_break(&s->breaks, s->frame), 0.0);
    if (status == DEM_OK) status = breaking_follow(s, s->frame);
    if (status != DEM_OK) fracture_source_undo(&s->breaks);
    return status;
}

/* Elements may be over their limits where a program has broken others or moved the bodies. A pause begins as after any
 * break. */
dem_status breaking_begin(dem_simulation *s)
{
    TRY(breaking_follow(s, s->y)); /* a motion may have been set inside a step */
    if (!run_may_break(s)) return DEM_OK;
    dem_status status = reduce_status(s->model->ranks, fracture_source_break_at_start(&s->breaks, s->t, s->y), 0.0);
    if (status == DEM_OK) status = breaking_follow(s, s->y);
    if (status != DEM_OK) fracture_source_undo(&s->breaks);
    if (fracture_source_has_broken(&s->breaks)) (void)pausing_begin(s, s->t, s->y);
    return status;
}

/* ---- by the program ---- */

/* Whether no triangle holds a spring, and it is broken. */
static bool is_broken_alone(const element_state *elements, dem_index spring)
{
    return springs_is_broken(element_state_springs(elements), spring) && !elements->held[spring];
}

/* Softens the triangles of a state in which none has softened or broken.  \param level  [n_triangles]; NULL: none */
static void soften_to(element_state *elements, const unsigned char *level)
{
    for (dem_index k = 0; level != NULL && k < elements->lattice->n_triangles; k++)
        while (elements->level[k] < level[k]) element_state_soften(elements, k);
}

/* A new state with what is broken or has softened already. */
static dem_status copy_elements(const dem_simulation *s, element_state *out)
{
    const dem_lattice *l = &s->model->lattice;
    const element_state *now = s->forces.elements;
    TRY(element_state_create(out, l, &s->model->springs));
    if (now != NULL) soften_to(out, now->level);
    for (dem_index k = 0; now != NULL && k < l->n_triangles; k++)
        if (now->triangle[k]) element_state_break_triangle(out, k);
    for (dem_index k = 0; now != NULL && k < l->n_springs; k++)
        if (is_broken_alone(now, k)) element_state_break_spring(out, k);
    return DEM_OK;
}

static dem_status check_triangle(const dem_simulation *s, dem_index triangle)
{
    const dem_lattice *l = &s->model->lattice;
    TRY(status_check_number("triangle", triangle, l->n_triangles));
    CHECK(!(l->flags[l->triangles[3 * triangle]] & DEM_NODE_RIGID), DEM_ERROR_ARGUMENT,
          "triangle %lld is of body %d, which is rigid and does not break", (long long)triangle,
          l->body[l->triangles[3 * triangle]]);
    return DEM_OK;
}

static dem_status check_spring(const dem_simulation *s, const element_state *elements, dem_index spring)
{
    const dem_lattice *l = &s->model->lattice;
    TRY(status_check_number("spring", spring, l->n_springs));
    const dem_index *ends = &l->ends[2 * spring];
    CHECK(!(l->flags[ends[0]] & DEM_NODE_RIGID), DEM_ERROR_ARGUMENT,
          "spring %lld is of body %d, which is rigid and does not break", (long long)spring, l->body[ends[0]]);
    CHECK(!elements->held[spring], DEM_ERROR_ARGUMENT,
          "spring %lld between nodes %lld and %lld is held by triangles: it breaks with them", (long long)spring,
          (long long)ends[0], (long long)ends[1]);
    return DEM_OK;
}

/* Breaks an element that is still whole in the new state, in the state of motion s->frame. */
static dem_status break_one(dem_simulation *s, element_state *elements, dem_index element)
{
    const dem_index spring = element - s->model->lattice.n_triangles;
    if (spring >= 0 ? elements->integrity[spring] == 0.0 : elements->triangle[element] != 0) return DEM_OK;
    TRY(break_list_note(&s->given, s->model, s->forces.elements, element, s->seen_t, s->frame));
    break_list_break(&s->given, s->given.n - 1, s->model, elements, s->frame);
    return DEM_OK;
}

static dem_status break_all(dem_simulation *s, element_state *elements, const dem_index *triangle,
                            dem_index n_triangles, const dem_index *spring, dem_index n_springs)
{
    TRY(stress_prepare(&s->model->stress)); /* breaks are noted with stresses */
    TRY(copy_elements(s, elements));
    for (dem_index k = 0; k < n_triangles; k++) {
        TRY(check_triangle(s, triangle[k]));
        TRY(break_one(s, elements, triangle[k]));
    }
    for (dem_index k = 0; k < n_springs; k++) {
        TRY(check_spring(s, elements, spring[k]));
        TRY(break_one(s, elements, s->model->lattice.n_triangles + spring[k]));
    }
    return DEM_OK;
}

static dem_status check_list(const char *what, const dem_index *list, dem_index n)
{
    CHECK(n == 0 || (n > 0 && list != NULL), DEM_ERROR_ARGUMENT,
          "dem_simulation_break: %lld %s, of which there is no list", (long long)n, what);
    return DEM_OK;
}

/* All that can be refused is refused before anything is replaced. What breaks by itself later in the step in hand is
 * taken back first. Where nothing is left to break nothing changes, contacts and ramps included. */
dem_status dem_simulation_break(dem_simulation *s, const dem_index *triangle, dem_index n_triangles,
                                const dem_index *spring, dem_index n_springs)
{
    dem_state seen = {.struct_size = sizeof seen};
    element_state next = {0};
    CHECK(s != NULL, DEM_ERROR_ARGUMENT, "dem_simulation_break: simulation is NULL");
    CHECK(!s->advancing, DEM_ERROR_ARGUMENT, "dem_simulation_break: an advance is under way");
    TRY(check_list("triangles", triangle, n_triangles));
    TRY(check_list("springs", spring, n_springs));
    if (n_triangles == 0 && n_springs == 0) return DEM_OK;
    TRY(set_motion_take_seen(s, &seen));
    TRY(reduce_status(s->model->ranks, body_contact_follow(s, s->frame), 0.0));
    const dem_index n_given = s->given.n;
    dem_status status =
        reduce_status(s->model->ranks, break_all(s, &next, triangle, n_triangles, spring, n_springs), 0.0);
    const bool all_broken = status == DEM_OK && !reduce_any(s->model->ranks, s->given.n > n_given);
    if (status != DEM_OK || all_broken) element_state_destroy(&next);
    if (all_broken) return DEM_OK;
    const double before = status == DEM_OK ? set_motion_energy(s, s->frame) : 0.0;
    if (status == DEM_OK) status = reduce_status(s->model->ranks, renew(s, &next, s->frame), 0.0);
    if (status != DEM_OK) {
        s->given.n = n_given;
        return status;
    }
    break_list_find_split(&s->given, n_given, s->model, &s->elements);
    exact_sum_add(&s->fracture, before - set_motion_energy(s, s->frame));
    (void)pausing_begin(s, s->seen_t, s->frame);
    return set_motion_begin_anew(s);
}

/* ---- checkpoints ---- */

static void list_springs(const element_state *elements, unsigned char *flags)
{
    for (dem_index k = 0; k < elements->lattice->n_springs; k++) flags[k] = is_broken_alone(elements, k);
}

/* Of a body that may soften, whether anything has or not. */
static dem_status save_levels(const element_state *elements, dem_checkpoint *checkpoint)
{
    const size_t n = (size_t)elements->lattice->n_triangles;
    if (elements->level != NULL) return dem_checkpoint_put(checkpoint, SHARED_BREAKS_LEVELS, elements->level, n);
    unsigned char *none = calloc(n + 1, sizeof *none);
    CHECK(none != NULL, DEM_ERROR_MEMORY, "out of memory for what has softened in a checkpoint");
    const dem_status status = dem_checkpoint_put(checkpoint, SHARED_BREAKS_LEVELS, none, n);
    free(none);
    return status;
}

/* A run in which nothing can break by itself, and no program has broken anything, puts nothing, so that its checkpoint
 * is that of a library which breaks nothing. */
dem_status breaking_save(const dem_simulation *s, dem_checkpoint *checkpoint)
{
    const element_state *elements = s->forces.elements;
    const dem_lattice *l = &s->model->lattice;
    contact_burials burials = s->automaton.set.burials;
    if (elements == NULL) return DEM_OK;
    if (burials.n > 0) burials.node = model_node(s->model, burials.node); /* none has the number 0 */
    unsigned char *flags = malloc((size_t)l->n_springs + 1);
    CHECK(flags != NULL, DEM_ERROR_MEMORY, "out of memory for what is broken in a checkpoint");
    list_springs(elements, flags);
    dem_status status = dem_checkpoint_put(checkpoint, SHARED_BREAKS_SPRINGS, flags, (size_t)l->n_springs);
    free(flags);
    if (status == DEM_OK)
        status = dem_checkpoint_put(checkpoint, SHARED_BREAKS_TRIANGLES, elements->triangle, (size_t)l->n_triangles);
    if (status == DEM_OK && l->softening != NULL) status = save_levels(elements, checkpoint);
    if (status == DEM_OK) status = dem_checkpoint_put(checkpoint, of_burials, &burials, sizeof burials);
    const double taken = exact_sum_value(&s->fracture); /* rounded: every run goes on from there */
    return status == DEM_OK ? dem_checkpoint_put(checkpoint, of_energy, &taken, sizeof taken) : status;
}

/* What a checkpoint has of elements. */
typedef struct element_flags {
    const unsigned char *triangle, *spring; /* [n_triangles], [n_springs] broken, springs that no triangle holds */
    const unsigned char *level;             /* [n_triangles] how many times they have softened; NULL: none does */
} element_flags;

/* Bytes in a checkpoint, which may be damaged. */
static dem_status find_bytes(const dem_checkpoint *checkpoint, const char *name, dem_index n, const unsigned char **out)
{
    size_t size = 0;
    *out = dem_checkpoint_find(checkpoint, name, &size);
    CHECK(*out != NULL && size == (size_t)n, DEM_ERROR_IO, "the checkpoint has %zu bytes of %s, %lld are expected",
          size, name, (long long)n);
    return DEM_OK;
}

static dem_status find_flags(const dem_checkpoint *checkpoint, const char *name, dem_index n, const unsigned char **out)
{
    TRY(find_bytes(checkpoint, name, n, out));
    for (dem_index k = 0; k < n; k++)
        CHECK((*out)[k] <= 1, DEM_ERROR_IO, "number %lld of the %s in the checkpoint is %d", (long long)k, name,
              (*out)[k]);
    return DEM_OK;
}

/* NULL where triangles do not soften. */
static dem_status find_levels(const dem_simulation *s, const dem_checkpoint *checkpoint, const unsigned char **out)
{
    const dem_lattice *l = &s->model->lattice;
    if (l->softening == NULL) return DEM_OK;
    TRY(find_bytes(checkpoint, SHARED_BREAKS_LEVELS, l->n_triangles, out));
    for (dem_index k = 0; k < l->n_triangles; k++)
        CHECK((*out)[k] <= softening_levels(l->softening[k]), DEM_ERROR_IO,
              "triangle %lld in the checkpoint has softened %d times, it does so %d times at most", (long long)k,
              (*out)[k], softening_levels(l->softening[k]));
    return DEM_OK;
}

/* Checkpoints of before these were counted have none of them. */
static dem_status get_burials(dem_simulation *s, const dem_checkpoint *checkpoint)
{
    contact_burials read = {0};
    size_t size;
    if (dem_checkpoint_find(checkpoint, of_burials, &size) != NULL)
        TRY(dem_checkpoint_get(checkpoint, of_burials, &read, sizeof read));
    if (read.n > 0) read.node = domain_node(s->model->domain, read.node);
    bool possible = read.n >= 0 && read.node >= 0 && read.node < s->model->lattice.n_nodes && isfinite(read.t);
    for (int d = 0; d < STATE_DIM_MOST; d++) possible = possible && isfinite(read.x[d]);
    CHECK(possible, DEM_ERROR_IO, "the checkpoint has impossible numbers of %s", of_burials);
    s->automaton.set.burials = read;
    return DEM_OK;
}

/* The checks of what a program breaks hold for files, too. */
static dem_status break_flagged(const dem_simulation *s, element_state *elements, const element_flags *flags)
{
    const dem_lattice *l = &s->model->lattice;
    TRY(element_state_create(elements, l, &s->model->springs));
    for (dem_index k = 0; flags->level != NULL && k < l->n_triangles; k++)
        if (flags->level[k] > 0) TRY(check_triangle(s, k));
    soften_to(elements, flags->level);
    for (dem_index k = 0; k < l->n_triangles; k++) {
        if (!flags->triangle[k]) continue;
        TRY(check_triangle(s, k));
        element_state_break_triangle(elements, k);
    }
    for (dem_index k = 0; k < l->n_springs; k++) {
        if (!flags->spring[k]) continue;
        TRY(check_spring(s, elements, k));
        element_state_break_spring(elements, k);
    }
    return DEM_OK;
}

static bool is_whole(const dem_lattice *l, const element_flags *flags)
{
    for (dem_index k = 0; k < l->n_triangles; k++)
        if (flags->triangle[k] || (flags->level != NULL && flags->level[k])) return false;
    for (dem_index k = 0; k < l->n_springs; k++)
        if (flags->spring[k]) return false;
    return true;
}

/* What is the same already is not made anew: the run that takes a checkpoint goes on from it, too. All else follows
 * from these flags. */
static bool is_the_same(const dem_simulation *s, const element_flags *flags)
{
    const element_state *now = s->forces.elements;
    const dem_lattice *l = &s->model->lattice;
    if (now == NULL) return is_whole(l, flags);
    if (memcmp(now->triangle, flags->triangle, (size_t)l->n_triangles) != 0) return false;
    for (dem_index k = 0; flags->level != NULL && k < l->n_triangles; k++)
        if (element_state_level(now, k) != flags->level[k]) return false;
    for (dem_index k = 0; k < l->n_springs; k++)
        if (is_broken_alone(now, k) != flags->spring[k]) return false;
    return true;
}

dem_status breaking_restore(dem_simulation *s, const dem_checkpoint *checkpoint)
{
    const dem_lattice *l = &s->model->lattice;
    element_flags flags = {NULL, NULL, NULL};
    element_state next = {0};
    size_t size;
    double taken;
    TRY(get_burials(s, checkpoint));
    if (dem_checkpoint_find(checkpoint, of_energy, &size) == NULL) return DEM_OK;
    TRY(find_flags(checkpoint, SHARED_BREAKS_TRIANGLES, l->n_triangles, &flags.triangle));
    TRY(find_flags(checkpoint, SHARED_BREAKS_SPRINGS, l->n_springs, &flags.spring));
    TRY(find_levels(s, checkpoint, &flags.level));
    TRY(dem_checkpoint_get(checkpoint, of_energy, &taken, sizeof taken));
    CHECK(isfinite(taken), DEM_ERROR_IO, "the energy of fracture in the checkpoint is not finite");
    s->fracture = exact_sum_of(taken);
    if (is_the_same(s, &flags)) return DEM_OK;
    const dem_status status = break_flagged(s, &next, &flags);
    if (status == DEM_OK) return renew(s, &next, NULL);
    element_state_destroy(&next);
    return status;
}
