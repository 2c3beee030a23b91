/* SPDX-License-Identifier: BSD-3-Clause */
/* deck.c and body.c: what decks mean, and where and why some mean nothing. */
#include "unit/reading.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <hdf5.h>

#include "unit/deck_text.h"

#define RUN    "&run t_end = 1 /\n"
#define RUBBER "&material name = 'rubber', youngs_modulus = 1e7, density = 1000, guard = 0.5 /\n"
#define FLOOR  "&obstacle points = -9, 0, 9, 0 /\n"

static const char *path_of(const char *name)
{
    return folder_at(&scratch, name);
}

static void write_file(const char *name, const char *bytes, size_t n)
{
    file_put(path_of(name), bytes, n);
}

static void expect_text(const namelist_errors *errors, const char *expected)
{
    char all[4096];
    list_faults(errors, all, sizeof all);
    assert_line_parts(all, expected);
}

static void expect_errors(const char *text, const char *expected)
{
    CLEANUP(namelist_errors_free) namelist_errors errors = {0};
    deck d;
    assert_int_equal(deck_text_read(&d, text, &errors), DECK_INVALID);
    expect_text(&errors, expected);
    assert_null(d.source);
    assert_int_equal(d.lattice.n_nodes, 0);
}

/* ---- decks that mean something ---- */

TEST(every_key_finds_its_place)
{
    CLEANUP(deck_free)
    deck d =
        deck_text_good("&run title = 'A title', t_end = 2.5, gravity = 1, -2 /\n" RUBBER
                       "&body shape = 'rectangle', size = 2, 3, spacing = 1, material = 'rubber', velocity = 4, -5 /\n"
                       "&obstacle points = 0, -1, 1, -2, 2, -1, restitution = 0.25 /\n" FLOOR
                       "&contact penetration_tolerance = 1e-7, rest_speed = 1e-4, max_impacts = 77 /\n"
                       "&solver method = 'bs23', rtol = 1e-4, max_step = 1e-5, v_scale = 3, spacing = 0.5,\n"
                       "kernel = 'portable', threads = 2 /\n"
                       "&output name = 'n', frame_interval = 0.125, history_interval = 0.25, "
                       "precision = 'double', deflate = 4, events = T /\n");
    assert_string_equal(d.title, "A title");
    assert_string_equal(d.name, "n");
    assert_string_equal(strrchr(d.path, '/'), "/a.nml");
    assert_non_null(strstr(d.source, "&contact penetration_tolerance = 1e-7"));
    assert_non_null(strstr(d.echo, "A title"));
    assert_null(strstr(d.physics, "A title"));
    assert_close(d.t_end, 2.5, 0.0);
    assert_close(d.frame_interval, 0.125, 0.0);
    assert_close(d.history_interval, 0.25, 0.0);
    assert_int_equal(d.double_precision, 1);
    assert_int_equal(d.deflate, 4);
    assert_int_equal(d.events, 1);
    assert_int_equal(d.n_obstacles, 2);
    assert_int_equal(d.obstacles[0].n_points, 3);
    assert_close(d.obstacles[0].points[3], -2.0, 0.0);
    assert_close(d.obstacles[0].restitution, 0.25, 0.0);
    assert_close(d.obstacles[1].points[0], -9.0, 0.0);
    assert_int_equal(d.options.struct_size, sizeof(dem_options));
    assert_close(d.options.gravity[0], 1.0, 0.0);
    assert_close(d.options.gravity[1], -2.0, 0.0);
    assert_int_equal(d.options.method, DEM_METHOD_BS23);
    assert_int_equal(d.options.kernel, DEM_KERNEL_PORTABLE);
    assert_int_equal(d.options.threads, 2);
    assert_close(d.options.rtol, 1e-4, 0.0);
    assert_close(d.options.max_step, 1e-5, 0.0);
    assert_close(d.options.v_scale, 3.0, 0.0);
    assert_close(d.options.spacing, 0.5, 0.0);
    assert_close(d.options.penetration_tolerance, 1e-7, 0.0);
    assert_close(d.options.rest_speed, 1e-4, 0.0);
    assert_close(d.options.fixed_step, 0.0, 0.0);
    assert_int_equal(d.options.max_impacts, 77);
    assert_close(d.lattice.velocity[1], -5.0, 0.0);
    assert_close(d.lattice.guard[0], 0.5e7, 1e-6);
}

#define BODY "&body shape = 'disc', radius = 2, spacing = 1, material = 'rubber', clearance = 1 /\n"

TEST(friction_window_vertices_and_damping_find_their_places)
{
    CLEANUP(deck_free)
    deck d = deck_text_good(RUN RUBBER BODY
                            "&obstacle points = -9, 0, 9, 0, friction = 1.5 /\n"
                            "&obstacle points = -9, -1, 9, -1, friction = 0.25, friction_law = 'paper' /\n" FLOOR
                            "&contact method = 'exact', window = 2e-6, vertices = .false. /\n"
                            "&solver mass_damping = 12.5 /\n");
    assert_close(d.obstacles[0].friction, 1.5, 0.0);
    assert_int_equal(d.obstacles[0].friction_law, DEM_FRICTION_COULOMB);
    assert_close(d.obstacles[1].friction, 0.25, 0.0);
    assert_int_equal(d.obstacles[1].friction_law, DEM_FRICTION_PAPER);
    assert_close(d.obstacles[2].friction, 0.0, 0.0);
    assert_int_equal(d.obstacles[2].friction_law, DEM_FRICTION_COULOMB);
    assert_close(d.options.window, 2e-6, 0.0);
    assert_int_equal(d.options.vertices, 0);
    assert_close(d.options.mass_damping, 12.5, 0.0);
}

/* The window is the library's if it is not given; stated, 0 is 0. */
/* kappa = E h (3 nu - 1)/(2 (1 - nu^2)) of plane stress; a solid of nu = 1/3 in plane strain is a plate of 9/8 E and
 * 1/2, that is 9/8 E h/3. The default has none. */
TEST(poissons_ratio_and_plane_make_the_area_term)
{
    static const char *const keys[3] = {"", "poissons_ratio = 0.5 ", "plane = 'strain' "};
    const double kappa[3] = {0.0, 1e7 / 3.0, 9.0 / 8.0 * 1e7 / 3.0};
    for (int k = 0; k < 3; k++) {
        char text[512];
        (void)snprintf(text, sizeof text,
                       RUN "&material name = 'rubber', youngs_modulus = 1e7, density = 1000 %s/\n"
                           "&body shape = 'disc', radius = 2, spacing = 1, material = 'rubber' /\n",
                       keys[k]);
        CLEANUP(deck_free) deck d = deck_text_good(text);
        if (k == 0) assert_null(d.lattice.area_stiffness);
        if (k > 0) assert_close(d.lattice.area_stiffness[0], kappa[k], 1e-8);
    }
}

TEST(what_the_output_shows_finds_its_place)
{
    CLEANUP(deck_free)
    deck d = deck_text_good(
        RUN RUBBER
        "&body shape = 'rectangle', size = 2, 3, spacing = 1, material = 'rubber' /\n"
        "&body shape = 'disc', radius = 2, spacing = 1, material = 'rubber', position = 20, 5, angle = 90 /\n"
        "&output fields = 'strain', 'principal', 'contact', 'strain', peak_every = 9, most_stressed = 3 /\n"
        "&probe name = 'one', number = 2 /\n"
        "&probe name = 'two', kind = 'gauge', place = -2, 0, 2, 0, body = 2, every = 5 /\n");
    assert_int_equal(d.fields, DEM_FIELD_STRAIN | DEM_FIELD_PRINCIPAL | DEM_FIELD_CONTACT);
    assert_int_equal(d.peak_every, 9);
    assert_int_equal(d.most_stressed, 3);
    assert_int_equal(d.n_probes, 2);
    assert_string_equal(d.probes[0].name, "one");
    assert_int_equal(d.probes[0].number[0], 2);
    assert_string_equal(d.probes[1].name, "two");
    assert_int_equal(d.probes[1].kind, DEM_PROBE_GAUGE);
    assert_int_equal(d.probes[1].every, 5);
    for (int k = 0; k < 2; k++) { /* the ends of the disc's diameter along its own x are one above the other */
        assert_close(d.lattice.x[2 * d.probes[1].number[k]], 20.0, 1e-14);
        assert_close(d.lattice.x[2 * d.probes[1].number[k] + 1], k == 0 ? 3.0 : 7.0, 1e-14);
    }
}

/* The clearance moves the body by some metres; the place goes with it. */
TEST(a_probe_s_place_moves_with_the_clearance)
{
    CLEANUP(deck_free)
    deck d =
        deck_text_good(RUN RUBBER FLOOR "&body shape = 'disc', radius = 2, spacing = 1, material = 'rubber', "
                                        "position = 3, 50, clearance = 1 /\n&probe name = 'top', place = 0, 2 /\n");
    const dem_index top = d.probes[0].number[0];
    for (dem_index i = 0; i < d.lattice.n_nodes; i++)
        assert_true(d.lattice.x[2 * i + 1] <= d.lattice.x[2 * top + 1] + 1e-14);
    assert_true(d.lattice.x[2 * top + 1] < 10.0);
}

TEST(faults_of_probes_come_with_the_others)
{
    expect_errors(RUN RUBBER "&body shape = 'disc', radius = 2, spacing = 1, material = 'rubber' /\n"
                             "&probe name = 'a' /\n&probe name = 'b', number = 1, place = 0, 0 /\n",
                  "4:1 * &probe * needs * 'place' * 'number'\n"
                  "5:32 * &probe * needs * 'place' * 'number' * both");
    expect_errors(RUN RUBBER "&body shape = 'disc', radius = 2, spacing = 1, material = 'rubber' /\n"
                             "&probe name = 'a', number = 19 /\n",
                  "4:20 * probe * 'a' * node * 0 * 19");
}

/* The echo once stated the default of 'body' for a probe by number, which is not used there. */
TEST(the_echo_of_a_probe_by_number_is_a_deck)
{
    CLEANUP(deck_free)
    deck d = deck_text_good(RUN RUBBER "&body shape = 'disc', radius = 2, spacing = 1, material = 'rubber' /\n"
                                       "&probe name = 'a', number = 1 /\n");
    CLEANUP(deck_free) deck again = deck_text_good(d.echo);
    assert_non_null(strstr(d.echo, "    ! body = (not given)\n    number = 1\n"));
    assert_int_equal(again.run_hash, d.run_hash);
}

TEST(a_window_of_zero_is_not_the_default)
{
    CLEANUP(deck_free)
    deck chosen = deck_text_good(RUN RUBBER BODY FLOOR),
         single = deck_text_good(RUN RUBBER BODY FLOOR "&contact window = 0 /\n");
    assert_close(chosen.options.window, dem_options_default().window, 0.0);
    assert_true(chosen.options.window < 0.0);
    assert_close(single.options.window, 0.0, 0.0);
    assert_true(chosen.hash != single.hash);
    assert_non_null(strstr(chosen.echo, "    ! window = (not given)\n"));
    assert_non_null(strstr(chosen.echo, "    vertices = .true. ! default\n"));
    assert_non_null(strstr(chosen.echo, "    friction = 0 ! default\n    friction_law = 'coulomb' ! default\n"));
    assert_non_null(strstr(chosen.echo, "    mass_damping = 0 ! default\n"));
    assert_non_null(strstr(chosen.echo, "    damping_time = 0 ! default\n"));
    assert_non_null(strstr(single.echo, "    window = 0\n"));
}

TEST(friction_goes_with_its_law)
{
    expect_errors(RUN RUBBER BODY "&obstacle points = -9, 0, 9, 0, friction_law = 'paper' /\n"
                                  "&obstacle points = -9, 0, 9, 0, friction = 1.5, friction_law = 'paper' /\n"
                                  "&obstacle points = -9, 0, 9, 0, friction = 'high', friction_law = 'paper' /\n"
                                  "&obstacle points = -9, 0, 9, 0, friction = 1.5, friction_law = 'papper' /\n",
                  "4:1 * 'friction' * &obstacle * given * 'paper' * [0, 1] * 1\n"
                  "5:33 * 'friction' * &obstacle * [0, 1] * 'paper' * 1.5\n"
                  "6:44 * 'friction' * &obstacle * real * 'high'\n"
                  "7:64 * 'friction_law' * &obstacle * 'coulomb' * 'paper' * 'papper' * 'paper'");
}

TEST(keys_not_given_are_left_to_the_library)
{
    CLEANUP(deck_free)
    deck d = deck_text_good(RUN RUBBER "&body shape = 'disc', radius = 2, spacing = 1, material = 'rubber' /\n");
    const dem_options expected = dem_options_default();
    assert_int_equal(d.options.method, expected.method);
    assert_close(d.options.rtol, expected.rtol, 0.0);
    assert_close(d.options.gravity[1], expected.gravity[1], 0.0);
    assert_close(d.options.spacing + d.options.v_scale + d.options.max_step + d.options.penetration_tolerance +
                     d.options.rest_speed,
                 0.0, 0.0);
    assert_int_equal(d.options.max_impacts, expected.max_impacts);
    assert_int_equal(d.options.vertices, expected.vertices);
    assert_close(d.options.mass_damping, expected.mass_damping, 0.0);
    assert_int_equal(d.n_obstacles, 0);
    assert_int_equal(d.double_precision, 0);
    assert_int_equal(d.deflate, 1);
    assert_int_equal(d.events, 0);
    assert_int_equal(d.fields, dem_trajectory_options_default().fields);
    assert_int_equal(d.most_stressed, dem_trajectory_options_default().most_stressed);
    assert_int_equal(d.peak_every, -1); /* looks.c chooses */
    assert_close(d.history_interval, -1.0, 0.0);
    assert_int_equal(d.n_probes, 0);
    assert_string_equal(d.title, "");
    assert_int_equal(d.lattice.n_nodes, 19);
}

TEST(bodies_come_in_their_order_turned_and_placed)
{
    CLEANUP(deck_free)
    deck d = deck_text_good(
        RUN RUBBER "&body shape = 'rectangle', size = 4, 3, spacing = 1, material = 'rubber', position = 10, 20,\n"
                   "      angle = 90 /\n"
                   "&body shape = 'disc', radius = 1, spacing = 1, material = 'rubber', position = -5, 6 /\n");
    const dem_index first = 5 + 4 + 5 + 4;
    assert_int_equal(d.lattice.n_nodes, first + 7);
    assert_int_equal(d.lattice.body[first - 1], 0);
    assert_int_equal(d.lattice.body[first], 1);
    assert_close(d.lattice.x[0], 10.0, 1e-14); /* (-2, 0) turned by 90 degrees is (0, -2) */
    assert_close(d.lattice.x[1], 18.0, 1e-14);
    assert_close(d.lattice.x[2 * (first + 3)], -5.0, 1e-15);
    assert_close(d.lattice.x[2 * (first + 3) + 1], 6.0, 1e-15);
}

static double least_gap(const deck *d)
{
    CLEANUP(free_model) dem_model *model;
    double least = (double)INFINITY;
    assert_int_equal(dem_model_create(&model, &d->lattice, d->obstacles, d->n_obstacles), DEM_OK);
    for (dem_index i = 0; i < d->lattice.n_nodes; i++) least = fmin(least, dem_model_gap(model, d->lattice.x + 2 * i));
    return least;
}

TEST(clearance_is_the_smallest_gap_and_leaves_x_alone)
{
    CLEANUP(deck_free)
    deck d = deck_text_good(
        RUN RUBBER "&body shape = 'disc', radius = 2, spacing = 0.25, material = 'rubber', position = 0.3, 0,\n"
                   "      clearance = 1e-3, angle = 17, outline = 'lattice' /\n"
                   "&obstacle points = -9, 0, 0, 2, 1, -1, 9, 0.5 /\n");
    double centre = 0.0;
    for (dem_index i = 0; i < d.lattice.n_nodes; i++) centre += d.lattice.x[2 * i];
    assert_close(centre / (double)d.lattice.n_nodes, 0.3, 1e-12);
    assert_close(least_gap(&d), 1e-3, 1e-12);
}

TEST(voids_and_pores_leave_holes_in_their_body_only)
{
    const char *bodies =
        RUN RUBBER "&body shape = 'rectangle', size = 4, 4, spacing = 0.1, material = 'rubber' /\n"
                   "&body shape = 'rectangle', size = 4, 4, spacing = 0.1, material = 'rubber', position = 9, 0 /\n"
                   "&void body = 2, centre = 1, 1, radius = 0.5 /\n"
                   "&void body = 2, shape = 'rectangle', centre = -1, 3, size = 0.5, 1 /\n";
    char text[2048];
    (void)snprintf(text, sizeof text, "%s%s", bodies, "&pores body = 1, number = 3, radius = 0.2, 0.3, seed = 4 /\n");
    CLEANUP(deck_free) deck without = deck_text_good(bodies), with = deck_text_good(text);
    dem_index n[2][2] = {{0}};
    for (dem_index i = 0; i < without.lattice.n_nodes; i++) n[0][without.lattice.body[i]]++;
    for (dem_index i = 0; i < with.lattice.n_nodes; i++) n[1][with.lattice.body[i]]++;
    assert_true(n[0][1] < n[0][0] - 100);
    assert_true(n[1][0] < n[0][0] - 30);
    assert_int_equal(n[1][1], n[0][1]);
    for (dem_index i = n[0][0]; i < without.lattice.n_nodes; i++) {
        const double x = without.lattice.x[2 * i] - 9.0, y = without.lattice.x[2 * i + 1];
        assert_true(hypot(x - 1.0, y - 1.0) > 0.5 - 1e-9);
        assert_true(fabs(x + 1.0) > 0.25 - 1e-9 || fabs(y - 3.0) > 0.5 - 1e-9);
    }
}

TEST(the_hash_is_of_the_physics_alone)
{
    const char *rest = RUBBER "&body shape = 'disc', radius = 2, spacing = 1, material = 'rubber' /\n";
    const char *heads[4] = {"&run t_end = 1 /\n",
                            "! another text\n&run t_end = 3, title = 'x' /\n&output name = 'y' /\n",
                            "&run t_end = 1, gravity = 0, -9.8 /\n", "&run t_end = 1 /\n&solver rtol = 1e-7 /\n"};
    uint64_t hash[4], run_hash[4];
    for (int k = 0; k < 4; k++) {
        char text[512];
        (void)snprintf(text, sizeof text, "%s%s", heads[k], rest);
        CLEANUP(deck_free) deck d = deck_text_good(text);
        uint64_t expected = UINT64_C(0xcbf29ce484222325);
        for (const char *c = d.physics; *c != '\0'; c++) expected = (expected ^ (unsigned char)*c) * 1099511628211u;
        assert_true(d.hash == expected);
        hash[k] = d.hash;
        run_hash[k] = d.run_hash;
    }
    assert_true(hash[0] == hash[1]);
    assert_true(hash[0] != hash[2] && hash[0] != hash[3] && hash[2] != hash[3]);
    assert_true(run_hash[0] != run_hash[1] && run_hash[0] != run_hash[2]);
}

/* What makes strengths makes the problem, each number of it; a default that is stated is as one that is not. */
TEST(the_hash_knows_strengths)
{
    static const char *const keys[][2] = {
        {"", ""},
        {", weibull = 8, weibull_volume = 1", ""},
        {", weibull = 9, weibull_volume = 1", ""},
        {", weibull = 8, weibull_volume = 2", ""},
        {", weibull = 8, weibull_volume = 1, strength_seed = 2", ""},
        {", weibull = 8, weibull_volume = 1, strength_seed = 1", ""},
        {"", "&weakness strength = 0.5, points = -9, 0.1, 9, 0.1 /"},
        {"", "&weakness strength = 0.6, points = -9, 0.1, 9, 0.1 /"},
        {"", "&weakness strength = 0.5, points = -9, 0.2, 9, 0.1 /"},
        {"", "&weakness strength = 0.5, shape = 'disc', centre = 0, 0, radius = 1 /"},
        {"", "&inclusion material = 'rubber', centre = 0, 0, radius = 1 /"},
        {"", "&inclusion material = 'rubber', centre = 0, 0, radius = 1, interface = 1 /"},
        {"", "&inclusion material = 'rubber', centre = 0, 0, radius = 1, interface = 2 /"}};
    enum { n = sizeof keys / sizeof *keys };
    uint64_t hash[n];
    for (int k = 0; k < n; k++) {
        char text[1024];
        (void)snprintf(text, sizeof text,
                       RUN
                       "&material name = 'rubber', youngs_modulus = 1e7, density = 1000, fracture = 'stress', "
                       "strength = 1e5%s /\n&body shape = 'disc', radius = 2, spacing = 0.5, material = 'rubber' /\n%s",
                       keys[k][0], keys[k][1]);
        CLEANUP(deck_free) deck d = deck_text_good(text);
        hash[k] = d.hash;
        for (int i = 0; i < k; i++) assert_true((hash[i] == hash[k]) == (i == 1 && k == 5));
    }
}

TEST(the_echo_is_a_deck_of_the_same_problem)
{
    CLEANUP(deck_free)
    deck d = deck_text_good(RUN RUBBER
                            "&body shape = 'disc', radius = 2, spacing = 0.3, material = 'rubber', clearance = 1e-3 /\n"
                            "&void centre = 0, 0.1, radius = 0.7 /\n" FLOOR);
    CLEANUP(deck_free) deck again = deck_text_good(d.echo);
    assert_true(again.hash == d.hash && again.run_hash == d.run_hash);
    assert_string_equal(again.physics, d.physics);
    assert_int_equal(again.lattice.n_nodes, d.lattice.n_nodes);
    assert_memory_equal(again.lattice.x, d.lattice.x, (size_t)d.lattice.n_nodes * 2 * sizeof(double));
}

/* ---- parts ---- */

/* A bar of 6 m x 2 m cut in two at x = 1. */
#define BAR(wish)                                                                                                      \
    RUN RUBBER "&body shape = 'rectangle', size = 6, 2, outline = 'lattice', spacing = 1, material = 'rubber'" wish    \
               " /\n"                                                                                                  \
               "&void shape = 'rectangle', centre = 1, 1, size = 0.9, 4 /\n"

TEST(disconnected_parts_are_refused_removed_or_kept)
{
    expect_errors(BAR(""),
                  "3:1 * body 1 * 1 * shares * edge * largest * 4 * triangles * (2, 0) * coordinates * 'disconnected'");
    CLEANUP(deck_free)
    deck kept = deck_text_good(BAR(", disconnected = 'keep'")),
         removed = deck_text_good(BAR(", disconnected = 'remove'"));
    assert_int_equal(kept.lattice.n_nodes, removed.lattice.n_nodes + 6);
    for (dem_index i = 0; i < removed.lattice.n_nodes; i++) assert_true(removed.lattice.x[2 * i] < 1.0);
}

/* ---- faults without geometry ---- */

TEST(keys_that_a_shape_lacks_or_does_not_use_are_named)
{
    expect_errors(RUN RUBBER "&body shape = 'disc', size = 1, 1, material = 'rubber' /\n"
                             "&body shape = 'rectangle', radius = 1, material = 'rubber' /\n"
                             "&body shape = 'file', spacing = 1,\n"
                             "      lattice = 'triangular', material = 'rubber' /\n"
                             "&void centre = 0, 0, size = 1, 1 /\n"
                             "&void centre = 0, 0, shape = 'rectangle', radius = 1 /\n",
                  "3:1 * 'radius' * &body * given * 'disc'\n"
                  "3:1 * 'spacing' * &body * given * 'disc'\n"
                  "3:23 * 'size' * &body * used * 'disc'\n"
                  "4:1 * 'size' * &body * given * 'rectangle'\n"
                  "4:1 * 'spacing' * &body * given * 'rectangle'\n"
                  "4:28 * 'radius' * &body * used * 'rectangle'\n"
                  "5:1 * 'file' * &body * given * 'file'\n"
                  "5:23 * 'spacing' * &body * used * 'file'\n"
                  "6:7 * 'lattice' * &body * used * 'file'\n"
                  "6:31 * 'material' * &body * used * 'file'\n"
                  "7:1 * 'radius' * &void * given * 'disc'\n"
                  "7:22 * 'size' * &void * used * 'disc'\n"
                  "8:1 * 'size' * &void * given * 'rectangle'\n"
                  "8:43 * 'radius' * &void * used * 'rectangle'");
}

TEST(names_that_refer_to_nothing_are_named)
{
    expect_errors(RUN RUBBER RUBBER "&body shape = 'disc', radius = 1, spacing = 1, material = 'ruber' /\n"
                                    "&body shape = 'disc', radius = 1, spacing = 1 /\n",
                  "3:11 * material * 'rubber' * given * twice * line 2\n"
                  "4:48 * material * 'ruber' * 'rubber'\n"
                  "5:1 * material * 'solid' * default * 'material' * &body * 'rubber' * 'rubber'");
}

TEST(voids_and_pores_need_a_body_that_can_have_them)
{
    expect_errors(RUN RUBBER "&body shape = 'file', file = 'x.h5' /\n"
                             "&void body = 2, centre = 0, 0, radius = 1 /\n"
                             "&pores number = 20000, radius = 2, 1 /\n",
                  "4:7 * &void * body 2 * 1\n"
                  "5:1 * &pores * body 1 * 'file'\n"
                  "5:8 * 'number' * &pores * 10000 * 20000\n"
                  "5:24 * 'radius' * &pores * smallest * largest * 2 * 1");
}

TEST(numbers_that_do_not_go_together_are_named)
{
    expect_errors("&run t_end = 1, gravity = 0, 0 /\n" RUBBER
                  "&body shape = 'rectangle', size = 4, 1, spacing = 2, material = 'rubber', clearance = 1 /\n"
                  "&body shape = 'disc', radius = 1, spacing = 2, material = 'rubber' /\n"
                  "&output name = 'a/b' /\n",
                  "3:41 * 'spacing' * &body * exceed * size * 4 m x 1 m * 2 m\n"
                  "3:75 * 'clearance' * &body * needs * &obstacle\n"
                  "3:75 * 'clearance' * &body * needs * gravity * 0\n"
                  "4:35 * 'spacing' * &body * exceed * radius * 1 m * 2 m\n"
                  "5:9 * 'name' * &output * 1 * 100 * characters * '/' * '.' * '-'");
}

TEST(obstacles_must_be_polylines)
{
    expect_errors(
        RUN RUBBER "&body shape = 'disc', radius = 1, spacing = 1, material = 'rubber' /\n"
                   "&obstacle points = 0, 0, 1, 1, 2 /\n"
                   "&obstacle points = 0, 0, 0.5, 1, 0.5, 1, 2, 2, 2, 2 /\n",
        "4:11 * 'points' * &obstacle * pairs * 5 * values\n"
        "5:11 * 'points' * &obstacle * segment 2 * obstacle 2 * (0.5, 1) * (0.5, 1) * length * 2 * 4 * segments");
    expect_errors(RUN RUBBER "&body shape = 'disc', radius = 1, spacing = 1, material = 'rubber' /\n"
                             "&obstacle points = -1e300, 0, 1e300, 0 /\n"
                             "&obstacle points = 0, 0, 1e-300, 0 /\n",
                  "4:11 * 'points' * &obstacle * segment 1 * obstacle 1 * (-1e+300, 0) * (1e+300, 0) * long\n"
                  "5:11 * 'points' * &obstacle * segment 1 * obstacle 2 * (0, 0) * (1e-300, 0) * short");
}

/* ---- profiles ---- */

#define LIFTED "&body shape = 'disc', radius = 2, spacing = 1, material = 'rubber', clearance = 3 /\n"

TEST(a_polyline_is_taken_as_it_is)
{
    CLEANUP(deck_free)
    deck d = deck_text_good(RUN RUBBER LIFTED "&obstacle points = -9, 0, 9, 0, 9, -1, 8, -1, profile = 'polyline' /\n");
    const double expected[8] = {-9, 0, 9, 0, 9, -1, 8, -1};
    assert_int_equal(d.obstacles[0].n_points, 4);
    assert_memory_equal(d.obstacles[0].points, expected, sizeof expected);
    assert_non_null(strstr(d.echo, "    profile = 'polyline'\n    ! resolution = (not given)\n"));
    assert_non_null(strstr(d.echo, "    ! seed = (not given)\n"));
    assert_null(strstr(d.physics, "seed"));
}

/* By hand: Steffen's slopes are 1, 0, -1; half-way up he is at 1/2 + (1 - 0)/8. */
TEST(a_smooth_profile_is_compiled_to_segments)
{
    const char *points = "&obstacle points = -1, 0, 0, 1, 1, 0, restitution = 0.25, profile = 'smooth'";
    char text[600];
    (void)snprintf(text, sizeof text, "%s%s /\n", RUN RUBBER LIFTED, points);
    CLEANUP(deck_free) deck d = deck_text_good(text);
    assert_int_equal(d.obstacles[0].n_points, 201);
    assert_close(d.obstacles[0].restitution, 0.25, 0.0);
    assert_close(d.obstacles[0].points[2 * 50], -0.5, 1e-15);
    assert_close(d.obstacles[0].points[2 * 50 + 1], 0.625, 1e-15);
    deck_free(&d);
    (void)snprintf(text, sizeof text, "%s%s, resolution = 0.3 /\n", RUN RUBBER LIFTED, points);
    d = deck_text_good(text);
    assert_int_equal(d.obstacles[0].n_points, 8); /* 2/0.3 are 6.7 */
    assert_close(d.obstacles[0].points[14], 1.0, 0.0);
}

/* 18/0.018 is 1000 and a little in floating point: no segment more. */
TEST(a_rough_profile_is_compiled_to_segments)
{
    const char *deck_text = RUN RUBBER LIFTED "&obstacle points = -9, 0, 9, 1.8, profile = 'rough', roughness = 0.1,\n"
                                              "  correlation = 0.5, resolution = 0.018";
    uint64_t hash[2];
    double y[2];
    for (int k = 0; k < 2; k++) {
        char text[600];
        double squares = 0.0;
        (void)snprintf(text, sizeof text, "%s, seed = %d /\n", deck_text, k + 1);
        CLEANUP(deck_free) deck d = deck_text_good(text), again = deck_text_good(d.echo);
        const double *points = d.obstacles[0].points;
        assert_int_equal(d.obstacles[0].n_points, 1001);
        for (int i = 0; i <= 1000; i++) squares += pow(points[2 * i + 1] - 0.9 - 0.1 * points[2 * i], 2.0) / 1001.0;
        assert_close(sqrt(squares), 0.1,
                     0.053); /* of 36 correlation lengths: four times a tenth of sqrt(sqrt(pi/2)/72) */
        assert_int_equal(again.obstacles[0].n_points, 1001);
        assert_memory_equal(again.obstacles[0].points, points, 2002 * sizeof *points);
        assert_true(again.hash == d.hash);
        hash[k] = d.hash;
        y[k] = points[1];
    }
    assert_true(hash[0] != hash[1] && y[0] != y[1]);
}

TEST(keys_of_another_profile_are_refused)
{
    expect_errors(RUN RUBBER LIFTED "&obstacle points = -9, 0, 9, 0, resolution = 1, roughness = 1,\n"
                                    "  correlation = 1, seed = 1 /\n"
                                    "&obstacle points = -9, 0, 9, 0, profile = 'smooth', roughness = 1,\n"
                                    "  correlation = 1, seed = 1 /\n"
                                    "&obstacle points = -9, 0, 9, 0, profile = 'rough' /\n"
                                    "&obstacle points = -9, 0, 9, 0, profile = 'ruogh', seed = 1 /\n",
                  "4:33 * 'resolution' * &obstacle * used * 'polyline'\n"
                  "4:49 * 'roughness' * &obstacle * used * 'polyline'\n"
                  "5:3 * 'correlation' * &obstacle * used * 'polyline'\n"
                  "5:20 * 'seed' * &obstacle * used * 'polyline'\n"
                  "6:53 * 'roughness' * &obstacle * used * 'smooth'\n"
                  "7:3 * 'correlation' * &obstacle * used * 'smooth'\n"
                  "7:20 * 'seed' * &obstacle * used * 'smooth'\n"
                  "8:1 * 'roughness' * &obstacle * given * 'rough'\n"
                  "8:1 * 'correlation' * &obstacle * given * 'rough'\n"
                  "9:43 * 'profile' * &obstacle * 'polyline' * 'smooth' * 'rough' * 'ruogh' * 'rough'");
}

/* Their extent was once asked for all the same. */
TEST(a_profile_without_points_lacks_them)
{
    expect_errors(RUN RUBBER LIFTED "&obstacle profile = 'smooth', resolution = 1 /\n"
                                    "&obstacle points = 0, profile = 'smooth', resolution = 1 /\n",
                  "4:1 * 'points' * &obstacle * given\n"
                  "5:11 * 'points' * &obstacle * 4 * values * 1");
}

#define SMOOTH "profile = 'smooth'"
#define ROUGH  "profile = 'rough', roughness = 1e-3, correlation = 0.1"

TEST(profiles_that_cannot_be_compiled_are_named)
{
    expect_errors(RUN RUBBER LIFTED "&obstacle points = 0, 0, 1, 0, 0.5, 1, 0.5, 2, " SMOOTH " /\n"
                                    "&obstacle points = 0, 0, 1, 0, 1, 0, " SMOOTH " /\n"
                                    "&obstacle points = 0, 0, 1, 0, " SMOOTH ", resolution = 1.5 /\n"
                                    "&obstacle points = 0, 0, 1, 0, " SMOOTH ", resolution = 1e-6 /\n"
                                    "&obstacle points = 1e9, 0, 1000000001, 0, " SMOOTH " /\n"
                                    "&obstacle points = 0, 0, 20.1, 0, " ROUGH " /\n"
                                    "&obstacle points = 0, 0, 1, 0, " ROUGH ", resolution = 1.9e-4 /\n"
                                    "&obstacle points = 0, 0, 1, 0, 2, " ROUGH ", resolution = 3 /\n",
                  "4:11 * 'points' * &obstacle * increase * 'smooth' * point 3 * obstacle 1 * 0.5 m * 1 m\n"
                  "5:11 * 'points' * &obstacle * segment 2 * obstacle 2 * (1, 0) * (1, 0) * length\n"
                  "6:52 * 'resolution' * &obstacle * exceed * extent * points * 1 m * 1.5 m\n"
                  "7:52 * 'resolution' * &obstacle * 1e-06 m * 1e+06 * segments * obstacle 4 * limit * 100000\n"
                  "8:1 * obstacle 5 * points * 1e+09 m * rounding * blurs * segments * 0.005 m\n"
                  "9:1 * 'resolution' * &obstacle * 1 * 500 * 1 * 2 * 'correlation' * 0.1 m * 0.1005 m * default\n"
                  "10:88 * 'resolution' * &obstacle * 1 * 500 * 1 * 2 * 'correlation' * 0.1 m * 0.00019 m\n"
                  "11:11 * 'points' * &obstacle * pairs * 5 * values");
    expect_errors(RUN RUBBER LIFTED "&obstacle points = 0, 0, 1, 0, " ROUGH ", resolution = 'fine' /\n"
                                    "&obstacle points = 0, 0, 1, zero, " ROUGH " /\n",
                  "4:101 * 'resolution' * &obstacle * real * 'fine'\n"
                  "5:29 * 'points' * &obstacle * real * 'zero'");
}

/* Heights beyond what can be squared are found when they are there. */
TEST(a_profile_of_endless_segments_is_refused)
{
    expect_errors(
        RUN RUBBER LIFTED "&obstacle points = 0, 0, 1, 0, profile = 'rough', roughness = 1e200,\n"
                          "  correlation = 2, resolution = 1, seed = 5489 /\n",
        "4:11 * 'points' * &obstacle * segment 1 * obstacle 1 * (0, -7.20663e+199) * (1, -1.90369e+199) * long");
}

TEST(faults_of_syntax_keys_and_meaning_come_together_sorted)
{
    expect_errors("&run t_end = -1 /\n"
                  "&body shape = 'disc', size = 1, 1, radius = 1, spacing = 1, material = 'rubber' /\n"
                  "&material name = 'rubber', youngs_modulus = 1e7, density = 1000 /\n"
                  "&obstacle points = 0, 0, 1, 1, 2, restitution = 'x /\n",
                  "1:14 * 't_end' * &run * 0 * -1\n"
                  "2:23 * 'size' * &body * used * 'disc'\n"
                  "4:11 * 'points' * &obstacle * pairs * 5 * values\n"
                  "4:49 * string * closed");
}

/* ---- faults of geometry ---- */

TEST(faults_of_geometry_are_reported_for_all_bodies)
{
    expect_errors(
        RUN RUBBER
        "&body shape = 'rectangle', size = 1, 1, spacing = 1e-9, material = 'rubber' /\n"
        "&body shape = 'disc', radius = 1, spacing = 1e-9, material = 'rubber' /\n"
        "&body shape = 'disc', radius = 1, spacing = 0.1, material = 'rubber', position = 20, 0, clearance = 1 /\n"
        "&body shape = 'rectangle', size = 1, 1, spacing = 0.1, material = 'rubber' /\n"
        "&body shape = 'disc', radius = 1, spacing = 0.1, material = 'rubber' /\n"
        "&pores body = 4, number = 2, radius = 0.3, 0.3, wall = 0.1 /\n"
        "&void body = 5, centre = 0, 0, radius = 2 /\n" FLOOR,
        "3:41 * body 1 * nodes * 2^40 * 1e-09 m\n"
        "4:35 * body 2 * nodes * 2^40 * 1e-09 m\n"
        "5:89 * 'clearance' * &body * reached * gravity * obstacle * below * body 3 * move * reverse\n"
        "7:1 * body 5 * outline * pores * nodes\n"
        "8:1 * pore 2 of 2 * radius * 0.3 m * place * body 4 * 0.1 m * 'wall'");
}

#define DISC(keys) "&body shape = 'disc', radius = 1, spacing = 1, material = 'rubber'" keys " /\n"

TEST(bodies_that_start_in_an_obstacle_are_named)
{
    const char *bodies = RUN RUBBER DISC("") DISC(", position = 0, 1")
        DISC(", position = 0, 8.5") "&obstacle points = 2, 9, -2, 9 /\n" FLOOR
                                    "&contact penetration_tolerance = 0.25 /\n";
    expect_errors(bodies, "3:1 * body 1 * 0.866025 m * inside * obstacle 2 * (-0.5, -0.866025) * penetration * "
                          "tolerance * 0.25 m * 'position' * 'clearance' * reverse\n"
                          "5:1 * body 3 * 0.366025 m * inside * obstacle 1 * (-0.5, 9.36603) * penetration * tolerance "
                          "* 0.25 m * 'position' * 'clearance' * reverse");
    const char *cleared = RUN RUBBER DISC(", clearance = 1e-3") FLOOR;
    CLEANUP(deck_free) deck d = deck_text_good(cleared);
    deck_free(&d);
    expect_errors(RUN RUBBER DISC(", position = 0, 0.8660") FLOOR,
                  "3:1 * body 1 * 2.54038e-05 m * inside * obstacle 1 * (-0.5, -2.54038e-05) * penetration * tolerance "
                  "* 1e-06 m * 'position' * 'clearance' * reverse");
    d = deck_text_good(RUN RUBBER DISC(", position = 0, 0.8660") FLOOR "&solver spacing = 30 /\n");
}

TEST(sizes_that_cannot_be_computed_with_are_named)
{
    expect_errors(RUN RUBBER "&material youngs_modulus = 1, density = 1e-308, thickness = 1e-308 /\n"
                             "&material name = 'soft', youngs_modulus = 1e-308, density = 1, thickness = 1e-9 /\n"
                             "&body shape = 'disc', radius = 1, spacing = 1 /\n"
                             "&body shape = 'disc', radius = 1, spacing = 1, material = 'soft' /\n"
                             "&body shape = 'disc', radius = 1e-200, spacing = 1e-200, material = 'rubber' /\n" DISC(
                                 ", position = 0, 1e300"),
                  "5:1 * body 1 * mass * node * 0 kg * 1e-308 kg/m^3 * 1e-308 m * 1 m\n"
                  "6:48 * body 2 * stiffness * spring * 1e-317 N * 1e-308 Pa * 1e-09 m * 1 m\n"
                  "7:40 * body 3 * area * triangle * 0 m^2 * 1e-200 m\n"
                  "8:69 * body 4 * coordinates * 1e+300 m * rounding * blurs * 1 m");
}

TEST(one_fault_is_reported_once)
{
    expect_errors(RUN RUBBER "&body shape = 'disc', radus = 1, spacng = 1, material = 'rubber' /\n"
                             "&body shape = 'rectangle', size(0) = 1, spacing = 1, material = 'rubber' /\n",
                  "3:23 * unknown * key * 'radus' * &body * 'radius'\n"
                  "3:34 * unknown * key * 'spacng' * &body * 'spacing'\n"
                  "4:28 * subscript * 'size' * ascend * 1 * 100000");
    expect_errors(RUN "&material name = rubber, youngs_modulus = 1, density = 1 /\n" RUBBER
                      "&material nam = 'x', youngs_modulus = 1, density = 1 /\n" DISC(
                          "") "&body shape = 'disc', radius = 1, spacing = 1, material = 'x' /\n",
                  "2:18 * 'name' * &material * string * quotes * rubber\n"
                  "4:11 * unknown * key * 'nam' * &material * 'name'");
    expect_errors(RUN "&materal name = 'rubber', youngs_modulus = 1, density = 1 /\n" DISC(""),
                  "2:1 * unknown * group * &materal * &material");
    expect_errors(RUN RUBBER DISC("") "&boby /\n&void body = 2, centre = 0, 0, radius = 1 /\n",
                  "4:1 * unknown * group * &boby * &body");
}

TEST(names_and_numbers_of_the_output_are_checked)
{
    const char *expected = "4:9 * 'name' * &output * '.obstacle' * '.body' * '.part' * '.' * five digits";
    expect_errors(RUN RUBBER DISC("") "&output name = 'a.obstacle' /\n", expected);
    expect_errors(RUN RUBBER DISC("") "&output name = '.part' /\n",
                  "4:9 * 'name' * &output * 1 * 100 * characters * '/' * '.' * '-'");
    expect_errors(RUN RUBBER DISC("") "&output name = 'a.part' /\n", expected);
    expect_errors(RUN RUBBER DISC("") "&output name = 'a.00001' /\n", expected);
    expect_errors("&run t_end = 1e9 /\n" RUBBER DISC("") "&output frame_interval = 1e-3 /\n",
                  "4:9 * 'frame_interval' * &output * 0.001 s * 1e+12 * frames * 't_end' * limit * 10000000");
    CLEANUP(deck_free) deck d = deck_text_good("&run t_end = 1e4 /\n" RUBBER DISC("") "&output name = 'a.parts' /\n");
    deck_free(&d);
    d = deck_text_good("&run t_end = 1e4 /\n" RUBBER DISC("") "&output name = 'a.0001' /\n");
}

/* ---- lattice files ---- */

static void write_dataset(hid_t file, const char *name, hid_t type, int rank, hsize_t rows, hsize_t columns,
                          const void *data)
{
    const hsize_t extent[2] = {rows, columns};
    const hid_t space = H5Screate_simple(rank, extent, NULL);
    const hid_t set = H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0);
    assert_true(H5Dclose(set) >= 0 && H5Sclose(space) >= 0);
}

/* A triangle of springs at nodes 0 to 2, two nodes with a spring at 3 and 4. */
static void write_lattice(const char *name, double mass, const int32_t *body)
{
    const double x[10] = {0, 0, 1, 0, 0.5, 0.75, 5, 0, 6, 0}, masses[5] = {mass, 1, 1, 1, 1};
    const double length[4] = {1, 0.901387818865997, 0.901387818865997, 1}, stiffness[4] = {10, 10, 10, 10};
    const double velocity[10] = {1, 0, 1, 0, 1, 0, 1, 0, 1, 0};
    const int64_t ends[8] = {0, 1, 1, 2, 0, 2, 3, 4};
    const hid_t file = H5Fcreate(path_of(name), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t group = H5Gcreate2(file, "/lattice", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    write_dataset(file, "/lattice/x", H5T_NATIVE_DOUBLE, 2, 5, 2, x);
    write_dataset(file, "/lattice/mass", H5T_NATIVE_DOUBLE, 1, 5, 1, masses);
    write_dataset(file, "/lattice/velocity", H5T_NATIVE_DOUBLE, 2, 5, 2, velocity);
    write_dataset(file, "/lattice/ends", H5T_NATIVE_INT64, 2, 4, 2, ends);
    write_dataset(file, "/lattice/rest_length", H5T_NATIVE_DOUBLE, 1, 4, 1, length);
    write_dataset(file, "/lattice/stiffness", H5T_NATIVE_DOUBLE, 1, 4, 1, stiffness);
    if (body != NULL) write_dataset(file, "/lattice/body", H5T_NATIVE_INT32, 1, 5, 1, body);
    assert_true(H5Gclose(group) >= 0 && H5Fclose(file) >= 0);
}

TEST(a_lattice_file_is_turned_placed_cleared_and_launched)
{
    const int32_t bodies[5] = {0, 0, 0, 1, 1};
    write_lattice("a.h5", 1.0, bodies);
    CLEANUP(deck_free)
    deck d = deck_text_good(RUN RUBBER
                            "&body shape = 'disc', radius = 1, spacing = 1, material = 'rubber', position = 0, 8 /\n"
                            "&body shape = 'file', file = 'a.h5', position = 2, 3, angle = 90, velocity = 10, 20,\n"
                            "      clearance = 0.5 /\n" FLOOR);
    assert_int_equal(d.lattice.n_nodes, 12);
    assert_int_equal(d.lattice.body[7], 1);
    assert_int_equal(d.lattice.body[11], 2);
    assert_close(d.lattice.x[2 * 8], 2.0, 1e-15);
    assert_close(d.lattice.x[2 * 8 + 1], 1.5, 1e-12); /* (1, 0) turned and placed is (2, 4); the lowest was at 3 */
    assert_close(d.lattice.velocity[2 * 8], 10.0, 1e-15);
    assert_close(d.lattice.velocity[2 * 8 + 1], 21.0, 1e-15);
    assert_int_equal(unlink(path_of("a.h5")), 0);
}

TEST(a_material_is_needed_by_meshes_only)
{
    expect_errors(RUN DISC(""), "1:1 * &material * given");
    write_lattice("a.h5", 1.0, NULL);
    CLEANUP(deck_free) deck d = deck_text_good(RUN "&body shape = 'file', file = 'a.h5', disconnected = 'remove' /\n");
    assert_int_equal(unlink(path_of("a.h5")), 0);
}

TEST(the_hash_is_of_the_lattice_file_too)
{
    const char *text = RUN RUBBER "&body shape = 'file', file = 'a.h5', disconnected = 'remove' /\n";
    uint64_t hash[3], run_hash[3];
    for (int k = 0; k < 3; k++) {
        if (k != 1) write_lattice("a.h5", 1.0 + k, NULL);
        CLEANUP(deck_free) deck d = deck_text_good(text);
        assert_int_equal(d.lattice.n_nodes, 3);
        hash[k] = d.hash;
        run_hash[k] = d.run_hash;
    }
    assert_true(hash[0] == hash[1] && run_hash[0] == run_hash[1]);
    assert_true(hash[0] != hash[2] && run_hash[0] != run_hash[2]);
    assert_int_equal(unlink(path_of("a.h5")), 0);
}

TEST(the_echo_names_a_lattice_file_by_its_whole_path)
{
    CLEANUP(namelist_errors_free) namelist_errors errors = {0};
    write_lattice("a.h5", 1.0, NULL);
    CLEANUP(deck_free)
    deck d = deck_text_good(RUN "&body shape = 'file', file = 'a.h5', disconnected = 'remove' /\n"), again;
    assert_non_null(strstr(d.echo, path_of("a.h5")));
    assert_non_null(strstr(d.echo, "    ! material = (not given)\n"));
    assert_non_null(strstr(d.physics, "    file = 'fnv1a:"));
    assert_null(strstr(d.physics, "lattice"));
    assert_null(strstr(d.physics, scratch.path));
    CLEANUP(folder_close) scratch_folder other;
    folder_open(&other);
    const char *echo = folder_file(&other, "echo.nml");
    file_put(echo, d.echo, strlen(d.echo));
    assert_int_equal(whole_deck_read(&again, echo, &errors), DECK_OK);
    assert_true(again.hash == d.hash && again.run_hash == d.run_hash);
    assert_int_equal(unlink(path_of("a.h5")), 0);
}

TEST(what_is_wrong_with_a_lattice_file_is_reported_at_its_key)
{
    CLEANUP(namelist_errors_free) namelist_errors errors = {0};
    deck d;
    write_lattice("a.h5", -1.0, NULL);
    assert_int_equal(deck_text_read(&d,
                                    RUN RUBBER "&body shape = 'file', file = 'none.h5' /\n"
                                               "&body shape = 'file', file = 'a.h5' /\n"
                                               "&body shape = 'file', file = 'a.h5', disconnected = 'keep' /\n",
                                    &errors),
                     DECK_INVALID);
    assert_int_equal(errors.n, 3);
    assert_int_equal(errors.list[0].place.column, 23);
    assert_non_null(strstr(errors.list[0].text, path_of("none.h5")));
    assert_string_equal(errors.list[1].text,
                        "body 2 has 1 part that no spring connects to its largest, of 2 nodes at "
                        "(5, 0) m in its own coordinates; 'disconnected' can remove or keep such parts");
    assert_non_null(strstr(errors.list[2].text, "body 3: "));
    assert_non_null(strstr(errors.list[2].text, "mass"));
    assert_int_equal(errors.list[2].place.column, 23);
    assert_int_equal(unlink(path_of("a.h5")), 0);
}

/* ---- the file ---- */

static void expect_unreadable(const char *path, const char *expected)
{
    CLEANUP(namelist_errors_free) namelist_errors errors = {0};
    deck d;
    assert_int_equal(whole_deck_read(&d, path, &errors), DECK_UNREADABLE);
    expect_text(&errors, expected);
    assert_null(d.path);
}

TEST(what_is_no_readable_file_is_refused)
{
    const size_t size = NAMELIST_MAX_FILE + 1;
    CLEANUP(free_memory) char *big = calloc(1, size);
    assert_non_null(big);
    memset(big, ' ', size);
    expect_unreadable(path_of("none.nml"), "0:0 * No such file or directory");
    expect_unreadable(scratch.path, "0:0 * regular * file");
    write_file("empty.nml", "", 0);
    expect_unreadable(path_of("empty.nml"), "0:0 * file * empty");
    write_file("big.nml", big, size);
    expect_unreadable(path_of("big.nml"), "0:0 * file * larger * 4 MiB");
    assert_int_equal(mkfifo(path_of("pipe.nml"), 0600), 0);
    expect_unreadable(path_of("pipe.nml"), "0:0 * regular * file");
    assert_int_equal(unlink(path_of("empty.nml")), 0);
    assert_int_equal(unlink(path_of("big.nml")), 0);
    assert_int_equal(unlink(path_of("pipe.nml")), 0);
}

TEST_GROUP(scratch_make, scratch_remove);
