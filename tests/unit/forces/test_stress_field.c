/* SPDX-License-Identifier: BSD-3-Clause */
/* stress_field.c and its passes: every kernel with 1, 2 and 3 threads against node_stress() and springs_strains(),
 * which go node by node and spring by spring. All numbers are to be equal, so that no tolerance is needed. */
#include <stdlib.h>

#include "forces/stress_field.h"
#include "model/node_stress.h"
#include "unit/forces/scenes.h"
#include "unit/free_team.h"

static void check_strains(const scene *s, const element_state *e, const stress_field *field)
{
    const dem_index n = s->model->lattice.n_springs;
    CLEANUP(free_memory) double *strain = malloc((size_t)n * sizeof *strain);
    CLEANUP(free_memory) double *expected = malloc((size_t)n * sizeof *expected);
    assert_true(strain != NULL && expected != NULL);
    stress_field_strains(field, e, strain);
    springs_strains(&s->model->lattice, element_state_springs(e), s->x, expected);
    for (dem_index k = 0; k < n; k++) assert_close(strain[k], expected[k], 0.0);
}

/* Of whole triangles, as they lie. */
static double smallest_area(const scene *s, const element_state *e)
{
    const dem_lattice *l = &s->model->lattice;
    double least = 1.0;
    for (dem_index k = 0; k < l->n_triangles; k++) {
        const dem_index *c = &l->triangles[3 * k];
        if (e != NULL && e->triangle[k]) continue;
        const double rest = vec2_triangle_area(vec2_at(l->x, c[0]), vec2_at(l->x, c[1]), vec2_at(l->x, c[2]));
        const double now = vec2_triangle_area(vec2_at(s->x, c[0]), vec2_at(s->x, c[1]), vec2_at(s->x, c[2]));
        least = fmin(least, now / rest);
    }
    return least;
}

static void check_kernel(const scene *s, const element_state *e, const kernel *k)
{
    const dem_index n = s->model->lattice.n_nodes;
    CLEANUP(free_memory) double *stress = malloc(3 * (size_t)n * sizeof *stress);
    CLEANUP(stress_field_destroy) stress_field field;
    assert_non_null(stress);
    assert_ok(stress_prepare(&s->model->stress));
    stress_field_create(&field, k);
    for (int round = 0; round < 3; round++) { /* what the one before has left does not matter */
        const double area_min = round == 1 ? smallest_area(s, e) : 0.0;
        for (dem_index c = 0; c < 3 * n; c++) stress[c] = (double)NAN;
        assert_true(stress_field_take(&field, e, s->x, area_min, stress));
        for (dem_index i = 0; i < n; i++) {
            double expected[3];
            node_stress(s->model, e, NODE_STRESS_CARRIED, i, s->x, expected);
            for (int c = 0; c < 3; c++) assert_close(stress[3 * i + c], expected[c], 0.0);
        }
        check_strains(s, e, &field);
    }
}

static void check_field(const scene *s, const element_state *e)
{
    for (dem_kernel kind = DEM_KERNEL_PORTABLE; dem_kernel_name(kind) != NULL; kind++)
        for (int n = 1; n <= 3 && dem_kernel_check(kind) == DEM_OK; n++) {
            CLEANUP(free_team) team *t = team_create(n, 1);
            CLEANUP(kernel_destroy) kernel k;
            assert_ok(kernel_create(&k, s->model, kind, t));
            check_kernel(s, e, &k);
        }
}

static void check_lattice(const dem_lattice *lattice, double share)
{
    CLEANUP(free_scene) scene s = make_scene(lattice, share);
    check_field(&s, NULL);
}

/* From one cell to rows longer than several blocks, with every number of nodes left over. */
TEST(rectangles_of_all_sizes_agree)
{
    const dem_material material = law_of(1);
    for (int rows = 1; rows <= 5; rows += 2)
        for (int columns = 1; columns <= 21; columns++) {
            CLEANUP(dem_lattice_free)
            dem_lattice lattice = make_solid(1e-2 * columns + 1e-4, 0.9e-2 * rows + 1e-2, &material);
            check_lattice(&lattice, 0.05);
        }
}

/* With and without area term, guard and couplings; moved by up to 0.6 of a spacing many triangles are below the guard's
 * onset. */
TEST(every_law_agrees_on_bodies_with_holes)
{
    for (int laws = 0; laws < 8; laws++)
        for (int squeezed = 0; squeezed < 2; squeezed++) {
            const dem_material material = law_of(laws);
            CLEANUP(dem_lattice_free) dem_lattice lattice = make_holed(&material);
            check_lattice(&lattice, squeezed ? 0.6 : 0.1);
        }
}

TEST(broken_elements_agree)
{
    for (int laws = 0; laws < 8; laws++) {
        const dem_material material = law_of(laws);
        CLEANUP(dem_lattice_free) dem_lattice lattice = make_holed(&material);
        CLEANUP(element_state_destroy) element_state broken = break_some(&lattice);
        CLEANUP(free_scene) scene s = make_scene(&lattice, laws & 1 ? 0.1 : 0.6);
        check_field(&s, &broken);
    }
}

/* Blocks have other nodes then, and area terms are added node by node. */
TEST(any_numbering_agrees)
{
    const dem_material material = law_of(5);
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_shuffled(&material);
    check_lattice(&lattice, 0.4);
}

/* Of a rigid one among them, too. */
TEST(bodies_agree)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_bodies();
    check_lattice(&lattice, 0.1);
    lattice.flags = calloc((size_t)lattice.n_nodes, sizeof *lattice.flags);
    assert_non_null(lattice.flags);
    for (dem_index i = 0; i < lattice.n_nodes; i++)
        if (lattice.body[i] == 1) lattice.flags[i] |= DEM_NODE_RIGID;
    check_lattice(&lattice, 0.1);
}
