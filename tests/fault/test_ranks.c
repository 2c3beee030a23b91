/* SPDX-License-Identifier: BSD-3-Clause */
/* One rank of several, which are threads, runs out of memory while what has broken gets new surfaces: all end with its
 * status and its message, and none waits for another. The linker wraps the functions that fail. */
#include <stdatomic.h>
#include <string.h>

#include "base/status.h"
#include "contact/contact_source.h"
#include "domain/partition.h"
#include "fracture/fracture_source.h"
#include "surface_contact/surface_contact.h"
#include "verification/rank_runs.h"
#include "verification/support.h"

enum { N_RANKS = 3 };

/* ---- functions that fail ---- */

typedef enum failing { BREAKS, BOUNDARY, SURFACES, CANDIDATES, N_FAILING } failing;

/* Calls of each that are still to come, of any rank, before one fails; 0: none does. */
static atomic_int left[N_FAILING];

static dem_status lack(failing which)
{
    if (atomic_load(&left[which]) == 0 || atomic_fetch_sub(&left[which], 1) != 1) return DEM_OK;
    return status_fail(DEM_ERROR_MEMORY, "out of memory for part %d of what has broken", (int)which);
}

dem_status __real_fracture_source_break(fracture_source *s, const double *y);
dem_status __wrap_fracture_source_break(fracture_source *s, const double *y);
dem_status __real_mesh_boundary_follow(mesh_boundary *out, const mesh_boundary *before, const element_state *elements,
                                       const dem_index *broken, dem_index n);
dem_status __wrap_mesh_boundary_follow(mesh_boundary *out, const mesh_boundary *before, const element_state *elements,
                                       const dem_index *broken, dem_index n);
dem_status __real_surface_contact_break(surface_contact *c, const mesh_boundary *boundary, const unsigned char *broken,
                                        const double *x);
dem_status __wrap_surface_contact_break(surface_contact *c, const mesh_boundary *boundary, const unsigned char *broken,
                                        const double *x);
dem_status __real_contact_source_follow_surface(contact_source *s, const surface *to);
dem_status __wrap_contact_source_follow_surface(contact_source *s, const surface *to);

dem_status __wrap_fracture_source_break(fracture_source *s, const double *y)
{
    const dem_status status = lack(BREAKS);
    return status == DEM_OK ? __real_fracture_source_break(s, y) : status;
}

dem_status __wrap_mesh_boundary_follow(mesh_boundary *out, const mesh_boundary *before, const element_state *elements,
                                       const dem_index *broken, dem_index n)
{
    const dem_status status = lack(BOUNDARY);
    return status == DEM_OK ? __real_mesh_boundary_follow(out, before, elements, broken, n) : status;
}

dem_status __wrap_surface_contact_break(surface_contact *c, const mesh_boundary *boundary, const unsigned char *broken,
                                        const double *x)
{
    const dem_status status = lack(SURFACES);
    return status == DEM_OK ? __real_surface_contact_break(c, boundary, broken, x) : status;
}

dem_status __wrap_contact_source_follow_surface(contact_source *s, const surface *to)
{
    const dem_status status = lack(CANDIDATES);
    return status == DEM_OK ? __real_contact_source_follow_surface(s, to) : status;
}

/* ---- runs ---- */

/* A block that shatters on a floor, and touches itself. */
static rank_runs_scene make_scene(dem_contact_method contact)
{
    static const double points[] = {-1.0, 0.0, 1.0, 0.0};
    const dem_material brittle = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0,
                                       .density = 1050.0, .thickness = 1.0, .guard = 0.02, .strength = 1.2e5);
    const dem_obstacle floor = SIZED(dem_obstacle, .n_points = 2, .points = points, .restitution = 0.2);
    CLEANUP(dem_lattice_free) dem_lattice l = support_rectangle(0.06, 0.05, 8e-3, &brittle);
    dem_lattice_move(&l, 0.0, (const double[]){0.0, 1e-4 - support_bottom(&l)});
    assert_ok(dem_lattice_launch(&l, (const double[]){0.3, -8.0}));
    rank_runs_scene s = {.model = support_model(&l, &floor, 1), .options = dem_options_default(), .t_end = 6e-4};
    s.options.contact = contact;
    s.options.bodies = DEM_BODIES_ALL;
    return s;
}

static void run(const rank_runs_scene *s, rank_runs_outcome *out)
{
    const dem_lattice *l = dem_model_lattice(s->model);
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)l->n_nodes * sizeof *owner);
    assert_ok(partition_bisect(l, N_RANKS, owner));
    rank_runs_make_outcomes(s, N_RANKS, out);
    rank_runs_together(s, N_RANKS, &(domain_model_shares){.owner = owner, .touching = true}, NULL, out);
}

/* The calls of all ranks in a run that none fails in. */
static int count_calls(const rank_runs_scene *s, failing which)
{
    enum { MANY = 1 << 30 };
    rank_runs_outcome all[N_RANKS];
    atomic_store(&left[which], MANY);
    run(s, all);
    const int n = MANY - atomic_load(&left[which]);
    assert_string_equal(all[0].message, "");
    assert_true(all[0].n_breaks > 0 && n > 0);
    rank_runs_free_outcomes(all, N_RANKS);
    return n;
}

/* At the first call, and at the last. */
static void check(dem_contact_method contact, failing which)
{
    rank_runs_scene s = make_scene(contact);
    const int n = count_calls(&s, which);
    for (int nth = 1; nth <= n; nth += n > 1 ? n - 1 : 1) {
        rank_runs_outcome all[N_RANKS];
        atomic_store(&left[which], nth);
        run(&s, all);
        atomic_store(&left[which], 0);
        for (int k = 0; k < N_RANKS; k++) {
            assert_int_equal(all[k].status, DEM_ERROR_MEMORY);
            assert_string_equal(all[k].message, all[0].message);
        }
        assert_non_null(strstr(all[0].message, "of what has broken"));
        rank_runs_free_outcomes(all, N_RANKS);
    }
    dem_model_destroy(s.model);
}

static void check_both(failing which)
{
    check(DEM_CONTACT_LOCAL, which);
    check(DEM_CONTACT_EXACT, which);
}

/* Where steps do not end at breaks they are events of the queue. */
TEST(a_rank_without_memory_for_a_break_ends_all)
{
    check(DEM_CONTACT_EXACT, BREAKS);
}

TEST(a_rank_without_memory_for_the_boundary_ends_all)
{
    check_both(BOUNDARY);
}

TEST(a_rank_without_memory_for_surfaces_ends_all)
{
    check_both(SURFACES);
}

TEST(a_rank_without_memory_for_what_touches_obstacles_ends_all)
{
    check_both(CANDIDATES);
}
