/* SPDX-License-Identifier: BSD-3-Clause */
/* survey.c and its passes: every kernel with 1, 2 and 3 threads against sums element by element, which are exact. All
 * numbers are to be equal, so that no tolerance is needed. */
#include <stdlib.h>
#include <string.h>

#include "unit/elastic/energy.h"
#include "unit/forces/measure.h"
#include "unit/forces/scenes.h"

static const double gravity[2] = {0.5, -9.81};

/* ---- element by element ---- */

static void expect_energies(const forces *f, const double *x, const double *v, dem_energy *e)
{
    const dem_model *m = f->model;
    const springs_integrity left = element_state_springs(f->elements);
    const triangles_integrity whole = element_state_triangles(f->elements);
    exact_sum elastic = {0}, areas[2] = {{.n_terms = 0}}, kinetic = {0}, weight = {0};
    energy_add_springs(&elastic, &m->lattice, left, x);
    energy_add_couplings(&elastic, &m->couplings, whole, x);
    energy_add_triangles(areas, &m->triangles, whole, x);
    for (dem_index i = 0; i < m->lattice.n_nodes; i++) {
        const double mass = m->lattice.mass[i];
        exact_sum_add(&kinetic, 0.5 * mass * vec2_dot(vec2_at(v, i), vec2_at(v, i)));
        exact_sum_add(&weight, -mass * vec2_dot((vec2){f->gravity[0], f->gravity[1]}, vec2_at(x, i)));
    }
    e->elastic = exact_sum_value(&elastic);
    e->area = exact_sum_value(&areas[0]);
    e->guard = exact_sum_value(&areas[1]);
    e->kinetic = exact_sum_value(&kinetic);
    e->gravity = exact_sum_value(&weight);
}

/* Of equal strains the first spring by its ends. */
static bool is_first(const dem_lattice *l, dem_index k, dem_index other)
{
    const dem_index *a = l->ends + 2 * k, *b = l->ends + 2 * other;
    const dem_index low[2] = {a[0] < a[1] ? a[0] : a[1], b[0] < b[1] ? b[0] : b[1]};
    return low[0] != low[1] ? low[0] < low[1] : a[0] + a[1] < b[0] + b[1];
}

static dem_strain expect_strains(const forces *f, const double *x)
{
    const dem_lattice *l = &f->model->lattice;
    const springs_integrity q = element_state_springs(f->elements);
    dem_strain s = {.spring_min = -1, .spring_max = -1};
    for (dem_index k = 0; k < l->n_springs; k++) {
        const double strain = springs_strain_of(l, k, x);
        if (springs_is_broken(q, k)) continue;
        if (s.spring_min < 0 || strain < s.min || (strain == s.min && is_first(l, k, s.spring_min))) {
            s.min = strain;
            s.spring_min = k;
        }
        if (s.spring_max < 0 || strain > s.max || (strain == s.max && is_first(l, k, s.spring_max))) {
            s.max = strain;
            s.spring_max = k;
        }
    }
    return s;
}

/* A ratio of areas may differ by rounding, 1e-15 here, as the corner from which it is computed is another one. */
static void check_areas(const forces *f, const double *x, const dem_strain *s)
{
    const dem_lattice *l = &f->model->lattice;
    double least = 1.0;
    dem_index guarded = 0, inverted = 0;
    for (dem_index k = 0; k < l->n_triangles; k++) {
        const dem_index *c = l->triangles + 3 * k;
        const double rest = vec2_triangle_area(vec2_at(l->x, c[0]), vec2_at(l->x, c[1]), vec2_at(l->x, c[2]));
        const double J = vec2_triangle_area(vec2_at(x, c[0]), vec2_at(x, c[1]), vec2_at(x, c[2])) / rest;
        if (f->elements != NULL && f->elements->triangle[k]) continue;
        least = fmin(least, J);
        guarded += J < TRIANGLES_GUARD_ONSET && l->guard != NULL && l->guard[k] > 0.0;
        inverted += J <= 0.0;
    }
    assert_close(s->area_min, least, 1e-14);
    assert_int_equal(s->guarded, guarded);
    assert_int_equal(s->inverted, inverted);
}

static void check_bodies(const forces *f, const double *x, const double *v, const dem_body_motion *body)
{
    const dem_lattice *l = &f->model->lattice;
    for (dem_index b = 0; b < f->model->n_bodies; b++) {
        exact_sum sum[5] = {{.n_terms = 0}}, spin = {0};
        for (dem_index i = 0; i < l->n_nodes; i++) {
            const double m = l->mass[i], terms[5] = {m, m * x[2 * i], m * x[2 * i + 1], m * v[2 * i], m * v[2 * i + 1]};
            for (int k = 0; k < 5 && l->body[i] == b; k++) exact_sum_add(&sum[k], terms[k]);
        }
        const double over = 1.0 / exact_sum_value(&sum[0]);
        const vec2 centre = {over * exact_sum_value(&sum[1]), over * exact_sum_value(&sum[2])};
        const vec2 velocity = {over * exact_sum_value(&sum[3]), over * exact_sum_value(&sum[4])};
        for (dem_index i = 0; i < l->n_nodes; i++)
            if (l->body[i] == b)
                exact_sum_add(
                    &spin, l->mass[i] * vec2_cross(vec2_sub(vec2_at(x, i), centre), vec2_sub(vec2_at(v, i), velocity)));
        assert_close(body[b].mass, exact_sum_value(&sum[0]), 0.0);
        assert_close(body[b].centre[0], centre.x, 0.0);
        assert_close(body[b].centre[1], centre.y, 0.0);
        assert_close(body[b].velocity[0], velocity.x, 0.0);
        assert_close(body[b].velocity[1], velocity.y, 0.0);
        assert_close(body[b].angular_momentum[2], exact_sum_value(&spin), 0.0);
    }
}

static void check_against(const forces *f, const scene *s, const measures *m)
{
    dem_energy e;
    expect_energies(f, s->x, s->v, &e);
    const dem_strain strain = expect_strains(f, s->x);
    assert_close(m->energy.kinetic, e.kinetic, 0.0);
    assert_close(m->energy.elastic, e.elastic, 0.0);
    assert_close(m->energy.area, e.area, 0.0);
    assert_close(m->energy.guard, e.guard, 0.0);
    assert_close(m->energy.gravity, e.gravity, 0.0);
    assert_close(m->strain.min, strain.min, 0.0);
    assert_close(m->strain.max, strain.max, 0.0);
    assert_int_equal(m->strain.spring_min, strain.spring_min);
    assert_int_equal(m->strain.spring_max, strain.spring_max);
    check_areas(f, s->x, &m->strain);
    check_bodies(f, s->x, s->v, m->body);
}

/* Alone, without energies. */
static void check_motions(const forces *f, const scene *s, const dem_body_motion *expected)
{
    dem_body_motion body[MEASURE_BODIES];
    CLEANUP(free_team) team *t = team_create(2, 1);
    CLEANUP(kernel_destroy) kernel k;
    CLEANUP(survey_destroy) survey own;
    assert_ok(kernel_create(&k, f->model, DEM_KERNEL_AUTO, t));
    assert_ok(survey_create(&own, &k));
    survey_take_motions(&own, s->x, s->v);
    survey_bodies(&own, s->x, s->v, body);
    assert_memory_equal(body, expected, (size_t)f->model->n_bodies * sizeof *body);
}

static void check_survey(const scene *s, const forces *load)
{
    forces f = *load;
    f.model = s->model;
    f.gravity[0] = gravity[0];
    f.gravity[1] = gravity[1];
    const measures first = measure_with(&f, s->x, s->v, DEM_KERNEL_PORTABLE, 1);
    check_against(&f, s, &first);
    check_motions(&f, s, first.body);
    for (dem_kernel kind = DEM_KERNEL_PORTABLE; dem_kernel_name(kind) != NULL; kind++)
        for (int n = 1; n <= 3 && dem_kernel_check(kind) == DEM_OK; n++) {
            const measures m = measure_with(&f, s->x, s->v, kind, n);
            assert_memory_equal(&m.energy, &first.energy, sizeof m.energy);
            assert_memory_equal(&m.strain, &first.strain, sizeof m.strain);
            assert_memory_equal(m.body, first.body, (size_t)f.model->n_bodies * sizeof *m.body);
        }
}

static void check_lattice(const dem_lattice *lattice, double share)
{
    CLEANUP(free_scene) scene s = make_scene(lattice, share);
    check_survey(&s, &(const forces){0});
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

/* Discs with holes; every law. */
TEST(every_law_agrees_on_bodies_with_holes)
{
    for (int laws = 0; laws < 8; laws++) {
        const dem_material material = law_of(laws);
        CLEANUP(dem_lattice_free) dem_lattice lattice = make_holed(&material);
        check_lattice(&lattice, 0.1);
    }
}

/* Some 6,000 nodes: several chunks of blocks and runs of nodes. */
TEST(large_bodies_agree)
{
    const dem_material material = law_of(5);
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(1.1, 0.5, &material);
    assert_true(lattice.n_nodes > 5 * SURVEY_CHUNK * 8);
    check_lattice(&lattice, 0.1);
}

/* Moved by up to 0.6 of a spacing, many triangles are below the guard's onset, and some are inverted. */
TEST(squeezed_triangles_agree)
{
    for (int laws = 0; laws < 4; laws++) {
        const dem_material material = law_of(laws);
        CLEANUP(dem_lattice_free) dem_lattice lattice = make_holed(&material);
        CLEANUP(free_scene) scene s = make_scene(&lattice, 0.6);
        check_survey(&s, &(const forces){0});
        const forces f = {.model = s.model};
        assert_true(measure_state(&f, s.x, s.v).strain.inverted > 3);
    }
}

/* At rest all strains are nearly the same, and many are equal: the first spring by its ends is named. */
TEST(a_body_at_rest_agrees)
{
    const dem_material material = law_of(0);
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_holed(&material);
    check_lattice(&lattice, 0.0);
}

TEST(broken_elements_agree)
{
    for (int laws = 0; laws < 8; laws++) {
        const dem_material material = law_of(laws);
        CLEANUP(dem_lattice_free) dem_lattice lattice = make_holed(&material);
        CLEANUP(element_state_destroy) element_state broken = break_some(&lattice);
        CLEANUP(free_scene) scene s = make_scene(&lattice, laws & 1 ? 0.1 : 0.6);
        check_survey(&s, &(const forces){.elements = &broken});
        assert_true(broken.n_damaged < lattice.n_nodes);
    }
}

/* A body whose nodes are numbered at random has a layout with an order of its own; areas are seen from the corner with
 * the lowest number all the same. */
TEST(any_numbering_agrees)
{
    for (int laws = 4; laws < 6; laws++) {
        const dem_material material = law_of(laws);
        CLEANUP(dem_lattice_free) dem_lattice lattice = make_shuffled(&material);
        CLEANUP(free_scene) scene s = make_scene(&lattice, 0.5);
        assert_non_null(s.model->layout.order);
        check_survey(&s, &(const forces){0});
    }
}

/* Three bodies, one of them rigid: no layout has its springs. */
TEST(bodies_agree)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_bodies();
    for (int rigid = 0; rigid < 2; rigid++) {
        if (rigid && lattice.flags == NULL) lattice.flags = calloc((size_t)lattice.n_nodes, sizeof *lattice.flags);
        assert_true(!rigid || lattice.flags != NULL);
        for (dem_index i = 0; rigid && i < lattice.n_nodes; i++)
            if (lattice.body[i] == 1) lattice.flags[i] |= DEM_NODE_RIGID;
        check_lattice(&lattice, 0.1);
    }
}
