/* SPDX-License-Identifier: BSD-3-Clause */
/* body_checks.c: which keys of a body's groups go together. What is wrong is looked at for its place and the words that
 * name it; whole sentences are test_refused's. */
#include "unit/reading.h"

#include "body_checks.h"

#define RUN    "&run t_end = 1 /\n"
#define RUBBER "&material name = 'rubber', youngs_modulus = 1e7, density = 1000 /\n"
#define BODY   "&body material = 'rubber', spacing = 0.1, shape = "
#define BLOCK  BODY "'rectangle', size = 4, 2 /\n"
#define DISC   BODY "'disc', radius = 1 /\n"
#define MESH   "&body material = 'rubber', shape = 'mesh', scale = 0.5, file = "
#define MASK   BODY "'mask', scale = 0.5, file = "

static void assert_checked(const char *text, int line, const char *word)
{
    char all[2048];
    CLEANUP(namelist_errors_free) namelist_errors errors = {0};
    (void)snprintf(all, sizeof all, RUN RUBBER "%s", text);
    CLEANUP(drop_resolved) resolved r = resolve_clean(all);
    body_checks_all(&r.deck, &errors);
    assert_one_fault(&errors, text, line + 2, word);
}

TEST(sizes_at_the_limit_pass)
{
    const char *head = "&body material = 'rubber', shape = ";
    static const struct {
        const char *keys;
        bool good;
    } cases[] = {{"'disc', radius = 1, spacing = 1", true},
                 {"'disc', radius = 1, spacing = 1.01", false},
                 {"'rectangle', size = 1, 1, spacing = 1", true},
                 {"'rectangle', size = 9, 1, spacing = 1.01", false},
                 {"'rectangle', size = 1, 9, spacing = 1.01", false},
                 {"'ring', radius = 3, inner_radius = 2, spacing = 1", true},
                 {"'ring', radius = 3, inner_radius = 2, spacing = 1.01", false},
                 {"'ring', radius = 3, inner_radius = 3, spacing = 1", false},
                 {"'polygon', points = 0,0, 1,0, 0,1, spacing = 1", true},
                 {"'polygon', points = 0,0, 1,0, 0,1, spacing = 1.01", false},
                 {"'polygon', points = 0,0, 1,0, 0,0, spacing = 0.1", false},
                 {"'polygon', points = 0,0, 1,1, 1,0, 0,1, spacing = 0.1", false},
                 {"'polygon', points = 0,0, 1,0, 1,0, 0,1, spacing = 0.1", false},
                 {"'polygon', points = 0,0, 1,0, 1,1, 0, spacing = 0.1", false}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[256];
        (void)snprintf(text, sizeof text, "%s%s /", head, cases[k].keys);
        assert_checked(text, 1, cases[k].good ? NULL : "&body");
    }
}

TEST(groups_name_a_body_that_can_have_them)
{
    assert_checked(BLOCK DISC "&void body = 2, centre = 0, 0, radius = 1 /", 0, NULL);
    assert_checked(BLOCK DISC "&void body = 3, centre = 0, 0, radius = 1 /", 3, "3");
    assert_checked(BLOCK "&pores number = 3, radius = 1, 1, body = 2 /", 2, "2");
    assert_checked(BLOCK "&crack points = 0,0, 1,1, body = 2 /", 2, "2");
    assert_checked(MESH "'a' /\n&crack points = 0,0, 1,1 /", 0, NULL);
    assert_checked(MESH "'a' /\n&void centre = 0,0, radius = 1 /", 2, "which is of shape 'mesh'");
    assert_checked("&body shape = 'file', file = 'a' /\n&crack points = 0,0, 1,1 /", 2, "which is of shape 'file'");
    assert_checked(MASK "'a' /\n&pores number = 1, radius = 1, 1 /", 0, NULL);
    assert_checked(MESH "'a' /\n&inclusion material = 'rubber', centre = 0,0, radius = 1 /", 0, NULL);
    assert_checked(BLOCK "&inclusion material = 'rubber', centre = 0,0, radius = 1, body = 2 /", 2, "2");
    assert_checked(BLOCK "&inclusion material = 'rubber', centre = 0,0 /", 2, "'radius' in &inclusion must be given");
    assert_checked(MASK "'' /", 1, "an image");
    assert_checked(MESH "'' /", 1, "a mesh");
}

TEST(a_weakness_has_the_keys_of_its_shape)
{
    assert_checked(BLOCK "&weakness strength = 0.5, points = 0,0, 1,1 /", 0, NULL);
    assert_checked(BLOCK "&weakness strength = 0.5, shape = 'disc', centre = 0,1, radius = 1 /", 0, NULL);
    assert_checked(MESH "'a' /\n&weakness strength = 0.5, points = 0,0, 1,1 /", 0, NULL);
    assert_checked("&body shape = 'file', file = 'a' /\n&weakness strength = 1, points = 0,0, 1,1 /", 2,
                   "shape 'file'");
    assert_checked(BLOCK "&weakness strength = 0.5 /", 2, "'points' in &weakness must be given for shape 'polyline'");
    assert_checked(BLOCK "&weakness strength = 0.5, shape = 'disc', radius = 1 /", 2, "'centre' in &weakness must be");
    assert_checked(BLOCK "&weakness strength = 0.5, points = 0,0, 1,1,\n centre = 0,0 /", 3,
                   "'centre' in &weakness is");
    assert_checked(BLOCK "&weakness strength = 0.5, points = 0,0, 1,1,\n angle = 3 /", 3, "'angle' in &weakness is");
    assert_checked(BLOCK "&weakness strength = 0.5,\n points = 0,0, 1,1, 2 /", 3, "must be pairs");
    assert_checked(BLOCK "&weakness strength = 0.5,\n points = 0,0, 0,0 /", 3, "no length");
    assert_checked(BLOCK "&weakness strength = 0.5, shape = 'polygon', centre = 0,0,\n points = 0,0, 1,1 /", 3,
                   "at least 3 points");
    assert_checked(BLOCK "&weakness strength = 0.5, shape = 'ring', centre = 0,0, radius = 1,\n inner_radius = 2 /", 3,
                   "'inner_radius' in &weakness must be less");
    assert_checked(BLOCK "&weakness strength = 0.5, points = 0,0, 1,1,\n body = 2 /", 3, "&weakness is for body 2");
    CLEANUP(drop_resolved) resolved r = resolve_clean(RUN RUBBER BLOCK "&weakness strength = 1, points = 0,0, 1,1 /");
    body_checks_drop_unused(&r.deck);
    assert_int_equal(schema_value_of(schema_get(&r.deck, "weakness", 0), "angle")->count, 0);
}

TEST(pores_have_a_number_or_a_porosity)
{
    assert_checked(BLOCK "&pores number = 3, radius = 1, 1 /", 0, NULL);
    assert_checked(BLOCK "&pores porosity = 0.3, radius = 1, 1 /", 0, NULL);
    assert_checked(BLOCK "&pores number = 3, radius = 1.1, 1 /", 2, "radius");
    assert_checked(BLOCK "&pores radius = 1, 1 /", 2, "must be given");
    assert_checked(BLOCK "&pores number = 3, porosity = 0.3, radius = 1, 1 /", 2, "does not go with");
    assert_checked(BLOCK "&pores number = 1, radius = 1, 1, mean = 1 /", 2, "'mean' in &pores is not used");
}

TEST(only_triangles_made_here_have_a_smooth_outline)
{
    assert_checked("&body shape = 'disc', radius = 1, spacing = 0.1, outline = 'smooth' /", 0, NULL);
    assert_checked("&body shape = 'disc', radius = 1, spacing = 0.1, lattice = 'square', outline = 'smooth' /", 1,
                   "'outline' in &body is not used by lattice 'square'");
    assert_checked("&body shape = 'mask', file = 'a', scale = 1, spacing = 0.1, outline = 'smooth' /", 1,
                   "'outline' in &body is not used by shape 'mask'");
    assert_checked("&body shape = 'mesh', file = 'a', scale = 1, outline = 'smooth' /", 1,
                   "'outline' in &body is not used by shape 'mesh'");
}

TEST(cracks_have_points_that_are_apart)
{
    assert_checked(BLOCK "&crack points = 0,0, 1,0, 0,0 /", 0, NULL); /* may meet itself */
    assert_checked(BLOCK "&crack points = 0,0, 1,0, 1,0 /", 2, "from point 2");
    assert_checked(BLOCK "&crack points = 0,0, 1,0, 1 /", 2, "pairs");
}
