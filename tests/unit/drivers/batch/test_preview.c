/* SPDX-License-Identifier: BSD-3-Clause */
/* preview.c: models of which all is known, and what is said of them. */
#include "preview.h"

#include "unit/drivers/batch/logged.h"

/* A deck of a quarter of a second, with what else it has: `name` and `title` stand beside it. */
#define DECK(...)                                                                                                      \
    {                                                                                                                  \
        .path = name, .title = title, .t_end = 0.25, .frame_interval = 0.01, .measure = true, __VA_ARGS__              \
    }

/* With the facts of the lattice that is run. */
static void print_preview(logged *l, const deck *d, const char *output)
{
    deck built = *d;
    built.facts = l->deck.facts;
    preview_print(&l->log, &built, l->run.simulation, output);
}

TEST(the_preview_tells_what_is_about_to_run)
{
    char name[] = "drops/drop.nml", title[] = "A title";
    const deck d = DECK(.hash = 0xabc);
    CLEANUP(free_logged) logged *l = drop_node(false, d.t_end);
    print_preview(l, &d, "there/drop.vtkhdf");
    read_log(l);
    assert_non_null(strstr(l->text, "drops/drop.nml"));
    assert_non_null(strstr(l->text, "A title"));
    assert_non_null(strstr(l->text, "0000000000000abc"));
    assert_non_null(strstr(l->text, "there/drop.vtkhdf"));
    assert_close(number_before(l->text, " nodes, "), 1.0, 0.0);
    assert_close(number_before(l->text, " springs"), 0.0, 0.0);
    assert_close(number_before(l->text, " segment"), 1.0, 0.0);
    assert_close(number_in(l->text, "lattice", "mass"), mass, 0.0);
    assert_close(number_in(l->text, "time", "t_end"), 0.25, 0.0);
    assert_close(number_before(l->text, " frames"), 26.0, 0.0);   /* the one at 0 too */
    assert_close(number_in(l->text, "time", "least"), 25.0, 0.0); /* steps of 0.01 s */
    /* one chunk of 1024 rows of 49 numbers, and 26 frames of three */
    assert_close(number_in(l->text, "output", "about"), 1e-6 * (1024 * 49 * 8 + 26 * 24), 5e-4);
}

/* Under a g of 5 m/s^2 a penetration tolerance of 1e-5 m keeps up hops of 1e-2 m/s. */
TEST(the_preview_warns_of_a_rest_speed_that_the_penetration_tolerance_keeps_up)
{
    static const double rest_speed[3] = {0.0, 9.9e-3, 1.01e-2};
    const double x[2] = {0.0, 1.0}, one = 1.0;
    char name[] = "a.nml", title[] = "";
    const deck d = DECK(.hash = 0);
    for (int k = 0; k < 3; k++) {
        dem_options options = dem_options_default();
        CLEANUP(free_logged) logged *l = make_logged();
        options.spacing = options.v_scale = 1.0;
        options.max_step = 0.01;
        options.gravity[0] = 3.0;
        options.gravity[1] = -4.0;
        options.penetration_tolerance = 1e-5;
        options.rest_speed = rest_speed[k];
        CLEANUP(dem_lattice_free) dem_lattice node = support_lattice(1, x, &one, 0, NULL, 0.0, 0.0, NULL);
        support_open(&l->run, &node, NULL, 0, &options);
        follow(l, false, d.t_end);
        print_preview(l, &d, NULL);
        read_log(l);
        const char *message = strstr(
            l->text,
            "\nwarning    'rest_speed' 0.0099 m/s is below sqrt(2 g penetration tolerance) = 0.01 m/s and has little");
        assert_int_equal(message != NULL, k == 1);
        assert_int_equal(strstr(l->text, "warning") != NULL, k == 1);
    }
}

TEST(the_preview_tells_what_is_probed_and_where)
{
    char name[] = "a.nml", title[] = "";
    dem_probe probes[3] = {{"foot", DEM_PROBE_NODE, {2, 0}, 1},
                           {"strut", DEM_PROBE_SPRING, {1, 0}, 30},
                           {"span", DEM_PROBE_GAUGE, {0, 2}, 1}};
    double at[3][2] = {{1.0, 0.0}, {0.25, -0.5}, {0.0, 0.0}};
    const deck d = DECK(.probes = probes, .probe_places = at, .n_probes = 3);
    CLEANUP(free_logged) logged *l = press(d.t_end);
    print_preview(l, &d, NULL);
    read_log(l);
    assert_non_null(strstr(l->text, "\nprobe      foot: node 2 at (1, 0) m\n"));
    assert_non_null(strstr(l->text, "\nprobe      span: gauge from node 0 to 2 at (0, 0) m\n"));
    assert_non_null(strstr(l->text, "\nprobe      strut: spring 1 at (0.25, -0.5) m\n"));
    /* 25000 steps: chunks of 1024 rows, of the history, foot and span, and one of the strut */
    assert_close(number_in(l->text, "output", "about"), 1e-6 * (25 * (40 + 9 + 3) + 3) * 1024 * 8, 0.05);
}

/* A block of nu = 0.1 and a node of its own: E, nu and waves of plane stress, and what cannot be measured. */
TEST(the_preview_tells_what_was_measured_of_each_body)
{
    const dem_material solid =
        SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 0.1, .density = 1000.0, .thickness = 0.5);
    char name[] = "a.nml", title[] = "";
    const deck d = DECK(.hash = 0);
    const double x[2] = {9.0, 9.0}, one = 1.0;
    dem_options options = dem_options_default();
    CLEANUP(free_logged) logged *l = make_logged();
    options.v_scale = 1.0;
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_rectangle(4.0, 4.0, 1.0, &solid);
    CLEANUP(dem_lattice_free) dem_lattice node = support_lattice(1, x, &one, 0, NULL, 0.0, 0.0, NULL);
    assert_ok(dem_lattice_append(&lattice, &node));
    support_open(&l->run, &lattice, NULL, 0, &options);
    follow(l, false, d.t_end);
    print_preview(l, &d, NULL);
    read_log(l);
    assert_close(number_in(l->text, "constants", "E"), 1e7, 1.0);
    assert_close(number_in(l->text, "constants", "nu"), 0.1, 1e-6);
    assert_close(number_in(l->text, "constants", "anisotropy"), 1.0, 1e-4);
    assert_close(number_in(l->text, "constants", "waves"), 100.0 / sqrt(0.99), 1e-2);
    assert_close(number_in(l->text, "constants", "and"), 100.0 / sqrt(2.2), 1e-2);
    assert_non_null(strstr(l->text, "\nconstants  body 2: not measured: the body has no triangles, "));
    assert_close(number_in(l->text, "frequency", "highest") * number_in(l->text, "frequency", "is"),
                 dem_model_omega_max(l->run.model), 1e-3 * dem_model_omega_max(l->run.model));
}

/* A slice of a long body: its own E and nu, not those of the plate that moves alike. */
TEST(the_preview_tells_the_constants_of_a_slice)
{
    const dem_material slice = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 0.45,
                                     .plane = DEM_PLANE_STRAIN, .density = 1000.0, .thickness = 1.0);
    char name[] = "a.nml", title[] = "";
    body_facts body = {.plane = DEM_PLANE_STRAIN};
    const deck d = DECK(.bodies = &body, .n_bodies = 1);
    dem_options options = dem_options_default();
    CLEANUP(free_logged) logged *l = make_logged();
    options.v_scale = 1.0;
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_rectangle(4.0, 4.0, 1.0, &slice);
    support_open(&l->run, &lattice, NULL, 0, &options);
    follow(l, false, d.t_end);
    print_preview(l, &d, NULL);
    read_log(l);
    assert_non_null(strstr(l->text, "\nconstants  body 1: E 1e+07 Pa, nu 0.45 in plane strain, anisotropy 1.0000, "));
}

/* Copies are alike: of them the first one is measured, and has the number of its group. */
TEST(the_preview_tells_the_constants_of_copies_once)
{
    const dem_material solid =
        SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 0.1, .density = 1000.0, .thickness = 1.0);
    dem_material soft = solid;
    char name[] = "a.nml", title[] = "";
    body_facts bodies[2] = {{.further = 1}, {.further = 0}};
    const deck d = DECK(.bodies = bodies, .n_bodies = 2);
    dem_options options = dem_options_default();
    CLEANUP(free_logged) logged *l = make_logged();
    options.v_scale = 1.0;
    soft.youngs_modulus = 2e6;
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_rectangle(4.0, 4.0, 1.0, &solid);
    CLEANUP(dem_lattice_free) dem_lattice copy = support_rectangle(4.0, 4.0, 1.0, &solid);
    CLEANUP(dem_lattice_free) dem_lattice other = support_rectangle(4.0, 4.0, 1.0, &soft);
    assert_ok(dem_lattice_append(&lattice, &copy));
    assert_ok(dem_lattice_append(&lattice, &other));
    support_open(&l->run, &lattice, NULL, 0, &options);
    follow(l, false, d.t_end);
    print_preview(l, &d, NULL);
    read_log(l);
    assert_non_null(strstr(l->text, "\nconstants  body 1: E 1e+07 Pa"));
    assert_non_null(strstr(l->text, "\nconstants  body 2: E 2e+06 Pa"));
    assert_null(strstr(l->text, "\nconstants  body 3"));
    assert_null(strstr(l->text, "\nconstants  of "));
}

/* A body with everything that there may be to tell, and one from a file. */
TEST(the_preview_tells_how_bodies_came_out)
{
    char name[] = "a.nml", title[] = "";
    body_facts bodies[2] = {
        {.mass = 2.5,
         .true_mass = 4.0,
         .geometry = {.area = 3.0, .pore_area = 1.0, .n_pores = 7, .n_cracked = 12},
         .loose = {.n = 2, .size = {5, 1}, .x = {{0.5, 2.0}, {3.0, 4.0}}},
         .removed = true,
         .hinges = {.n = 1, .x = {6.0, 7.0}},
         .weak = {.weaknesses = {.n_triangles = 20}, .interfaces = {.n_triangles = 8, .n_springs = 9}},
         .strengths = {.triangles = {.n = 30, .n_raised = 4, .least = 2e5, .most = 3.5e6},
                       .springs = {.n = 40, .least = 0.01, .most = 0.03}}},
        {.mass = 1.0,
         .least_angle = 26.54,
         .geometry = {.report = {.n_rim = 90, .n_off = 2, .n_cut = 1, .farthest = 0.125}},
         .loose = {.n = 1, .size = {3}}},
    };
    const deck d = DECK(.bodies = bodies, .n_bodies = 2);
    CLEANUP(free_logged) logged *l = drop_node(false, d.t_end);
    print_preview(l, &d, NULL);
    read_log(l);
    assert_non_null(strstr(l->text, "\nmass       body 1: 2.5 kg, of the true shape 4 kg (ratio 0.6250)\n"));
    assert_non_null(strstr(l->text, "\npores      body 1: 7, of porosity 0.2500\n"));
    assert_non_null(strstr(l->text, "\ncracks     body 1: through 12 triangles, which are taken away\n"));
    assert_non_null(strstr(l->text, "\nparts      body 1: 2 removed, of 5 triangles at (0.5, 2), 1 at (3, 4) m in its "
                                    "own coordinates\n"));
    assert_non_null(
        strstr(l->text, "\nhinges     body 1: 1 node between triangles that share no edge, one at (6, 7) m\n"));
    assert_non_null(strstr(l->text, "\nparts      body 2: 1 apart from the largest, of 3 nodes at (0, 0) m in its own "
                                    "coordinates\n"));
    assert_non_null(strstr(l->text, "\nstrengths  body 1: of 30 triangles, from 2e+05 to 3.5e+06 Pa; 4 drawn below are "
                                    "raised to 0.2 of 'strength'\n"));
    assert_non_null(strstr(l->text, "\nstrengths  body 1: of 40 springs, from 0.01 to 0.03\n"));
    assert_null(strstr(l->text, "strengths  body 2"));
    assert_non_null(strstr(l->text, "\nweaknesses body 1: of 20 triangles\n"));
    assert_non_null(strstr(l->text, "\ninterfaces body 1: of 8 triangles, 9 springs\n"));
    assert_null(strstr(l->text, "weaknesses body 2"));
    assert_null(strstr(l->text, "mass       body 2"));
    assert_null(strstr(l->text, "outline    body 1"));
    assert_non_null(strstr(l->text,
                           "\noutline    body 2: smooth, 88 nodes on it, least angle of a triangle 26.5 degrees; "
                           "2 nodes off it by up to 0.125 m, so that triangles stay sound; 1 corner cut off, too sharp "
                           "for the spacing\n"));
}

TEST(a_long_list_of_bodies_is_cut)
{
    char name[] = "a.nml", title[] = "";
    body_facts bodies[17];
    for (int k = 0; k < 17; k++) bodies[k] = (body_facts){.mass = 1.0, .true_mass = 2.0};
    const deck d = DECK(.bodies = bodies, .n_bodies = 17);
    CLEANUP(free_logged) logged *l = drop_node(false, d.t_end);
    print_preview(l, &d, NULL);
    read_log(l);
    assert_non_null(strstr(l->text, "mass       body 16: "));
    assert_null(strstr(l->text, "mass       body 17: "));
    assert_non_null(strstr(l->text, "\nbodies     of 17 the first 16 are listed\n"));
}

TEST(without_an_output_none_is_reported)
{
    char name[] = "a.nml", title[] = "";
    const deck d = DECK(.hash = 0);
    CLEANUP(free_logged) logged *l = drop_node(false, d.t_end);
    print_preview(l, &d, NULL);
    read_log(l);
    assert_non_null(strstr(l->text, "\noutput     26 frames, about "));
    assert_true(has_line(l->text, "deck"));
}

TEST(versions_are_those_in_use)
{
    char text[512], cut[16];
    preview_versions(text, sizeof text);
    assert_null(strchr(text, '\n'));
    assert_non_null(strstr(text, dem_version()));
    assert_non_null(strstr(text, dem_version_sundials()));
    assert_non_null(strstr(text, dem_version_hdf5()));
    preview_versions(cut, sizeof cut);
    assert_int_equal(strlen(cut), sizeof cut - 1);
}

/* The topics of all lines, in their order; not every C library tells the memory. */
static void expect_topics(const char *text, const char *expected)
{
    char found[1024] = "";
    size_t n = 0;
    for (const char *line = text; *line != '\0'; line += strcspn(line, "\n") + 1) {
        const int length = (int)strcspn(line, " \n");
        if (strncmp(line, "memory ", 7) == 0) continue;
        n += (size_t)snprintf(found + n, sizeof found - n, "%s%.*s", n > 0 ? " " : "", length, line);
    }
    assert_string_equal(found, expected);
}

TEST(details_are_left_out_unless_they_are_wanted)
{
    char name[] = "a.nml", title[] = "";
    body_facts body = {.mass = 2.5, .true_mass = 2.5};
    const deck d = DECK(.bodies = &body, .n_bodies = 1);
    for (int verbose = 0; verbose < 2; verbose++) {
        CLEANUP(free_logged) logged *l = drop_node(false, d.t_end);
        l->log.verbose = verbose;
        print_preview(l, &d, "there/a.vtkhdf");
        read_log(l);
        expect_topics(l->text, verbose ? "dem deck lattice mass contact constants time impacts scales method kernel "
                                         "formula looks output"
                                       : "deck lattice constants time output");
    }
}

static void print_header(logged *l)
{
    char name[] = "a.nml", title[] = "";
    const deck d = DECK(.hash = 0);
    print_preview(l, &d, NULL);
    read_log(l);
}

TEST(the_preview_tells_the_rules_of_impact)
{
    dem_obstacle floor = {.struct_size = sizeof(dem_obstacle)};
    dem_options options = dem_options_default();
    for (int on = 0; on <= 1; on++) {
        options.window = on ? 2.5e-5 : 0.0, options.vertices = on;
        options.contact = on ? DEM_CONTACT_EXACT : DEM_CONTACT_LOCAL;
        CLEANUP(free_logged) logged *l = new_floors(1, &floor, &options);
        print_header(l);
        assert_non_null(strstr(l->text, on ? "\nimpacts    exact, window 2.5e-05 s, vertices on: 0 may touch 0 edges\n"
                                           : "\nimpacts    local, window 0 s (each by itself), vertices off\n"));
        assert_non_null(strstr(l->text, on ? " of 1 segment; impacts within 2.5e-05 s are taken together ('exact')\n"
                                           : " of 1 segment; each impact is taken by itself ('local')\n"));
        assert_false(has_line(l->text, "friction") || has_line(l->text, "damping"));
    }
}

TEST(the_preview_tells_friction_and_damping)
{
    dem_obstacle floors[4] = {
        {.struct_size = sizeof(dem_obstacle), .friction = 0.3},
        {.struct_size = sizeof(dem_obstacle), .friction = 0.0, .velocity = {0.5, -2.0}},
        {.struct_size = sizeof(dem_obstacle), .friction = 0.5, .friction_law = DEM_FRICTION_PAPER},
        {.struct_size = sizeof(dem_obstacle), .friction = 1.0, .friction_law = DEM_FRICTION_PAPER}};
    dem_options options = dem_options_default();
    options.mass_damping = 0.75;
    CLEANUP(free_logged) logged *l = new_floors(4, floors, &options);
    print_header(l);
    assert_non_null(strstr(l->text, "\nfriction   obstacle 1: 0.3 (Coulomb)\nfriction   obstacle 3: 0.5 (paper)\n"
                                    "motion     obstacle 2: velocity (0.5, -2) m/s\n"
                                    "damping    of masses: 0.75 1/s\n"));
}

TEST(the_preview_tells_the_damping_of_springs)
{
    const dem_material solid = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 0.3, .density = 1000.0,
                                     .thickness = 1.0, .damping_time = 2e-6);
    const dem_options options = dem_options_default();
    CLEANUP(free_logged) logged *l = make_logged();
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_rectangle(0.04, 0.04, 0.01, &solid);
    support_open(&l->run, &lattice, NULL, 0, &options);
    follow(l, false, 1e-5);
    print_header(l);
    assert_non_null(strstr(l->text, "\ndamping    of springs: 2e-06 s\n"));
}

TEST(of_many_obstacles_only_the_first_are_listed)
{
    dem_obstacle floors[20];
    for (int o = 0; o < 20; o++)
        floors[o] = (dem_obstacle){.struct_size = sizeof(dem_obstacle), .friction = 0.25, .velocity = {1.0, 0.0}};
    const dem_options options = dem_options_default();
    CLEANUP(free_logged) logged *l = new_floors(20, floors, &options);
    print_header(l);
    assert_non_null(strstr(l->text, "\nfriction   obstacle 16: 0.25 (Coulomb)\nfriction   on 20 obstacles in all\n"));
    assert_non_null(
        strstr(l->text, "\nmotion     obstacle 16: velocity (1, 0) m/s\nmotion     of 20 obstacles in all\n"));
}

TEST(of_many_bodies_only_the_first_are_measured)
{
    CLEANUP(free_logged) logged *l = new_held();
    print_header(l);
    assert_non_null(strstr(l->text, "\nconstants  bodies 17 to 20: not measured\n"));
}

TEST(the_short_log_lists_few_bodies)
{
    CLEANUP(free_logged) logged *l = new_held();
    l->log.verbose = false;
    print_header(l);
    assert_non_null(strstr(l->text, "\nconstants  body 2: "));
    assert_null(strstr(l->text, "\nconstants  body 3: "));
    assert_non_null(strstr(l->text, "\nconstants  of 18 more bodies: see --verbose\n"));
}

/* The deck does not ask for loose parts; what it asks for is left out. */
TEST(the_short_log_has_parts_and_no_masses_of_bodies)
{
    char name[] = "a.nml", title[] = "";
    body_facts body = {.mass = 3.0, .true_mass = 4.0, .geometry = {.n_pores = 7}, .loose = {.n = 1, .size = {5}}};
    const deck d = DECK(.bodies = &body, .n_bodies = 1);
    CLEANUP(free_logged) logged *l = drop_node(false, d.t_end);
    l->log.verbose = false;
    print_preview(l, &d, NULL);
    read_log(l);
    assert_non_null(strstr(l->text, " kg (0.7500 of the true shape), spacing "));
    assert_true(has_line(l->text, "parts"));
    assert_false(has_line(l->text, "mass") || has_line(l->text, "pores"));
}
