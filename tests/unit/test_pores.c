/* SPDX-License-Identifier: BSD-3-Clause */
/* pores.c: where random pores lie, and that a seed always gives the same ones. */
#include "close.h"

#include "pores.h"

static const pores_recipe fourteen = {
    .box = {-0.055, 0.0, 0.055, 0.11}, .number = 14, .radius_min = 4e-3, .radius_max = 8e-3, .wall = 5e-3, .seed = 1};

static double inside_square(void *context, const double x[2])
{
    const double half = *(const double *)context;
    return fmin(half - fabs(x[0]), half - fabs(x[1] - half));
}

static void place(pore *out, const pores_recipe *recipe)
{
    double half = 0.055;
    size_t n;
    assert_int_equal(pores_place(out, &n, recipe, inside_square, &half), DEM_OK);
    assert_int_equal(n, recipe->number);
}

static void pores_keep_the_wall_between_them_and_the_boundary(void **state)
{
    (void)state;
    pore list[14];
    double half = 0.055;
    place(list, &fourteen);
    for (int i = 0; i < 14; i++) {
        assert_true(list[i].radius >= 4e-3 && list[i].radius <= 8e-3);
        assert_true(inside_square(&half, list[i].centre) >= list[i].radius + 5e-3);
        if (i > 0) assert_true(list[i].radius <= list[i - 1].radius);
        for (int j = 0; j < i; j++) {
            const double dx = list[i].centre[0] - list[j].centre[0], dy = list[i].centre[1] - list[j].centre[1];
            assert_true(sqrt(dx * dx + dy * dy) >= list[i].radius + list[j].radius + 5e-3);
        }
    }
}

/* MT19937 with seed 5489, as in the C++ standard's mt19937, begins 3499211612, 581869302, 3890346734. */
static void a_seed_gives_the_numbers_of_the_published_generator(void **state)
{
    (void)state;
    const double scale = 4294967296.0;
    double half = 0.5;
    const pores_recipe recipe = {
        .box = {-0.5, 0.0, 0.5, 1.0}, .number = 1, .radius_min = 0.01, .radius_max = 0.03, .seed = 5489};
    pore one;
    size_t n;
    assert_int_equal(pores_place(&one, &n, &recipe, inside_square, &half), DEM_OK);
    assert_close(one.radius, 0.01 + 0.02 * 3499211612.0 / scale, 1e-15);
    assert_close(one.centre[0], -0.5 + 581869302.0 / scale, 1e-15);
    assert_close(one.centre[1], 3890346734.0 / scale, 1e-15);
}

static void the_same_seed_gives_the_same_pores_and_another_one_others(void **state)
{
    (void)state;
    pore a[14], b[14];
    pores_recipe other = fourteen;
    other.seed = 2;
    place(a, &fourteen);
    place(b, &fourteen);
    assert_memory_equal(a, b, sizeof a);
    place(b, &other);
    assert_true(a[0].centre[0] != b[0].centre[0]);
}

static void equal_radii_are_legal_and_no_pores_are_too(void **state)
{
    (void)state;
    pore list[14];
    pores_recipe recipe = fourteen;
    recipe.radius_max = recipe.radius_min;
    place(list, &recipe);
    for (int i = 0; i < 14; i++) assert_close(list[i].radius, 4e-3, 0.0);
    recipe.number = 0;
    place(list, &recipe);
}

static void a_pore_that_finds_no_place_is_reported_with_its_radius(void **state)
{
    (void)state;
    double half = 0.055;
    pore list[14];
    pores_recipe recipe = fourteen;
    size_t n = 99;
    recipe.number = 5;
    recipe.radius_min = 0.02, recipe.radius_max = 0.021;
    assert_int_equal(pores_place(list, &n, &recipe, inside_square, &half), DEM_ERROR_MODEL);
    assert_true(n >= 1 && n < 5);
    assert_true(list[n].radius >= 0.02 && list[n].radius <= 0.021);
}

static void impossible_recipes_are_refused(void **state)
{
    (void)state;
    pore list[14];
    double half = 0.055;
    size_t n;
    pores_recipe bad[7] = {fourteen, fourteen, fourteen, fourteen, fourteen, fourteen, fourteen};
    bad[0].radius_min = 0.0;
    bad[1].radius_max = 3e-3;
    bad[2].wall = -1.0;
    bad[3].number = PORES_MAX + 1;
    bad[4].box[2] = -1.0;
    bad[5].radius_max = (double)INFINITY;
    bad[6].wall = (double)NAN;
    for (int k = 0; k < 7; k++)
        assert_int_equal(pores_place(list, &n, &bad[k], inside_square, &half), DEM_ERROR_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pores_keep_the_wall_between_them_and_the_boundary),
        cmocka_unit_test(a_seed_gives_the_numbers_of_the_published_generator),
        cmocka_unit_test(the_same_seed_gives_the_same_pores_and_another_one_others),
        cmocka_unit_test(equal_radii_are_legal_and_no_pores_are_too),
        cmocka_unit_test(a_pore_that_finds_no_place_is_reported_with_its_radius),
        cmocka_unit_test(impossible_recipes_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
