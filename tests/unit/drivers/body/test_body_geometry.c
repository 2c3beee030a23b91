/* SPDX-License-Identifier: BSD-3-Clause */
/* body_geometry.c: from groups to a triangulation and its true area. What is wrong is looked at for its place and the
 * words that name it; whole sentences are test_refused's. */
#include "unit/reading.h"

#include <stdlib.h>
#include <unistd.h>

#include "body_checks.h"
#include "body_geometry.h"
#include "harness/lattice_area.h"
#include "unit/scratch.h"

#define RUN    "&run t_end = 1 /\n"
#define RUBBER "&material name = 'rubber', youngs_modulus = 1e7, density = 1000 /\n"
#define BODY   "&body material = 'rubber', spacing = 0.1, shape = "
#define BLOCK  BODY "'rectangle', size = 4, 2 /\n"
#define DISC   BODY "'disc', radius = 1 /\n"
#define MESH   "&body material = 'rubber', shape = 'mesh', scale = 0.5, file = "
#define MASK   BODY "'mask', scale = 0.5, file = "

static const double pi = 3.14159265358979323846;

typedef struct formed {
    dem_lattice lattice;
    body_geometry geometry;
} formed;

static void drop_formed(formed *f)
{
    dem_lattice_free(&f->lattice);
}

/* Body k of a text after the groups of RUN and RUBBER. */
static dem_status build(formed *out, const char *text, size_t k, namelist_errors *errors)
{
    char all[4096];
    (void)snprintf(all, sizeof all, RUN RUBBER "%s", text);
    CLEANUP(drop_resolved) resolved r = resolve_clean(all);
    body_checks_all(&r.deck, errors);
    if (errors->n > 0) fail_msg("'%s' gives '%s'", text, errors->list[0].text);
    body_checks_drop_unused(&r.deck);
    const dem_status status = body_geometry_triangulate(&out->lattice, &out->geometry, &r.deck, k, "", errors);
    assert_int_equal(errors->n > 0, status != DEM_OK);
    return status;
}

static formed build_good(const char *text)
{
    formed f;
    namelist_errors errors = {0};
    if (build(&f, text, 0, &errors) != DEM_OK) fail_msg("'%s' gives '%s'", text, errors.list[0].text);
    return f;
}

static void expect_fault(const char *text, size_t k, int line, const char *word)
{
    formed f;
    CLEANUP(namelist_errors_free) namelist_errors errors = {0};
    assert_int_equal(build(&f, text, k, &errors), DEM_ERROR_MODEL);
    assert_one_fault(&errors, text, line + 2, word);
    assert_null(f.lattice.x);
}

/* Distance of the node nearest to a point. */
static double distance_to(const dem_lattice *lattice, double x, double y)
{
    double least = INFINITY;
    for (dem_index i = 0; i < lattice->n_nodes; i++)
        least = fmin(least, hypot(lattice->x[2 * i] - x, lattice->x[2 * i + 1] - y));
    return least;
}

/* ---- shapes ---- */

static void expect_area(const char *text, double area, double off)
{
    formed f = build_good(text);
    assert_close(f.geometry.area / area, 1.0, 1e-5);
    assert_close(f.geometry.spacing, 0.1, 0.0);
    assert_close(lattice_area(&f.lattice) / area, 1.0, off); /* edges are jagged by up to a spacing */
    dem_lattice_free(&f.lattice);
}

TEST(every_shape_has_its_area)
{
    expect_area(BLOCK, 8.0, 0.05);
    expect_area(DISC, pi, 0.12);
    expect_area(BODY "'ring', radius = 2, inner_radius = 1 /", 3.0 * pi, 0.15);
    expect_area(BODY "'polygon', points = 0,0, 4,0, 4,4, 3,4, 2,1, 1,4, 0,4 /", 13.0, 0.08);
    expect_area(BODY "'polygon', points = 0,4, 1,4, 2,1, 3,4, 4,4, 4,0, 0,0, 0,4 /", 13.0, 0.08); /* back, closed */
}

TEST(voids_of_every_shape_are_turned_and_placed)
{
    expect_area(BLOCK "&void shape = 'rectangle', centre = 0, 1, size = 1, 0.5, angle = 30 /", 8.0 - 0.5, 0.08);
    expect_area(BLOCK "&void shape = 'polygon', centre = 0, 1, points = 0,0, 1,0, 0,1 /", 8.0 - 0.5, 0.08);
    expect_area(BLOCK "&void shape = 'ring', centre = 0, 1, radius = 0.8, inner_radius = 0.4 /", 8.0 - 0.48 * pi, 0.1);
    CLEANUP(drop_formed)
    formed f =
        build_good(BLOCK "&void shape = 'polygon', centre = 1, 1, points = 0.2,0, 0.8,0, 0.8,0.2, 0.2,0.2, "
                         "angle = 90 /\n&void shape = 'rectangle', centre = -1, 1, size = 1.4, 0.4, angle = 90 /");
    assert_true(distance_to(&f.lattice, 0.9, 1.5) > 0.09); /* (0.5, 0.1) turned by a quarter */
    assert_true(distance_to(&f.lattice, 1.5, 1.1) < 0.09);
    assert_true(distance_to(&f.lattice, -1.0, 1.6) > 0.09);
    assert_true(distance_to(&f.lattice, -1.6, 1.0) < 0.09);
}

/* What chords cut off is 0.5 a^2 of each circle, and straight edges lose nothing. */
TEST(smooth_outlines_have_their_areas)
{
    const char *smooth = BODY "'disc', radius = 1, outline = 'smooth' /";
    expect_area(smooth, pi, 2e-3);
    expect_area(BODY "'ring', radius = 2, inner_radius = 1, outline = 'smooth' /", 3.0 * pi, 1e-3);
    expect_area(BODY "'polygon', points = 0,0, 4,0, 4,4, 3,4, 2,1, 1,4, 0,4, outline = 'smooth' /", 13.0, 1e-12);
    expect_area(BODY "'rectangle', size = 4.03, 2.01, outline = 'smooth' /\n&void centre = 0, 1, radius = 0.5 /\n"
                     "&void shape = 'rectangle', centre = -1.2, 1, size = 0.7, 0.5, angle = 30 /",
                4.03 * 2.01 - 0.25 * pi - 0.35, 2e-3);
    CLEANUP(drop_formed)
    formed jagged = build_good(BODY "'disc', radius = 1, outline = 'lattice' /"), good = build_good(smooth);
    CLEANUP(drop_formed)
    formed porous = build_good(BODY "'rectangle', size = 4, 2, outline = 'smooth', jitter = 0.2 /\n"
                                    "&pores number = 3, radius = 0.3, 0.3, wall = 0.2 /");
    assert_int_equal(jagged.geometry.report.n_rim, 0);
    assert_true(good.geometry.report.n_rim > 60);
    assert_int_equal(porous.geometry.report.n_off, 0);
    assert_close(lattice_area(&porous.lattice) / (8.0 - 0.27 * pi), 1.0, 5e-3);
}

/* ---- pores ---- */

TEST(a_porosity_is_met_to_half_a_pore)
{
    CLEANUP(drop_formed)
    formed f =
        build_good(BODY "'disc', radius = 10 /\n&void centre = 0, 0, radius = 2 /\n&pores porosity = 0.2, radius = "
                        "0.4, 0.9, wall = 0.2, distribution = 'lognormal', mean = 0.5, deviation = 0.2 /");
    assert_close(f.geometry.pore_area, 0.2 * 96.0 * pi, 0.5 * pi * 0.81);
    assert_close(f.geometry.area + f.geometry.pore_area, 96.0 * pi, 1e-4 * 96.0 * pi);
    assert_true(f.geometry.n_pores > 40);
}

TEST(groups_of_pores_add_up)
{
    CLEANUP(drop_formed)
    formed f = build_good(BLOCK "&pores number = 2, radius = 0.2, 0.2, wall = 0.1 /\n"
                                "&pores number = 3, radius = 0.1, 0.1, wall = 0.1, seed = 2 /");
    assert_int_equal(f.geometry.n_pores, 5);
    assert_close(f.geometry.pore_area, 0.11 * pi, 1e-15);
    assert_close(f.geometry.area, 8.0 - 0.11 * pi, 1e-12);
}

TEST(pores_without_a_place_or_a_radius_are_reported)
{
    expect_fault(BLOCK "&pores porosity = 0.9, radius = 0.2, 0.2 /", 0, 2, "finds no place");
    expect_fault(BLOCK "&pores porosity = 0.5, radius = 1e-3, 1e-3 /", 0, 2, "10000");
    expect_fault(BLOCK "&pores number = 1, radius = 0.1, 0.2, distribution = 'normal',\nmean = 9, deviation = 1e-3 /",
                 0, 3, "'mean' and 'deviation'");
}

/* ---- masks and meshes ---- */

static const char *path;

static const char *with_file(const char *head, const char *content, const char *tail)
{
    static char text[2048];
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(content, file) >= 0 && fclose(file) == 0);
    (void)snprintf(text, sizeof text, "%s'%s'%s", head, path, tail);
    return text;
}

TEST(a_mask_stands_on_its_lower_edge)
{
    formed f = build_good(with_file(MASK, "P2 4 2 1  0 0 1 1  1 1 1 1", " /"));
    assert_close(f.geometry.area, 6.0 * 0.25, 0.0);
    assert_close(distance_to(&f.lattice, -1.0, 0.0), 0.0, 1e-12);
    assert_true(distance_to(&f.lattice, -0.5, 0.8) > 0.25);
    assert_true(distance_to(&f.lattice, 0.5, 0.8) < 0.09);
    dem_lattice_free(&f.lattice);
    f = build_good(with_file(MASK, "P2 4 2 9  1 2 3 4  5 6 7 8", ", threshold = 0.5\n/"));
    assert_close(f.geometry.area, 4.0 * 0.25, 0.0);
    dem_lattice_free(&f.lattice);
    f = build_good(with_file(MASK, "P2 4 2 9  1 2 3 4  5 6 7 8", ", threshold = 0.7, invert = .true.\n/"));
    assert_close(f.geometry.area, 6.0 * 0.25, 0.0); /* 1 to 6 */
    dem_lattice_free(&f.lattice);
    expect_fault(with_file(MASK, "P2 4 2 9  1 2 3 4  3 2 1 1", "\n/"), 0, 1, "give 'invert = .true.'");
    expect_fault(with_file(MASK, "P2 4 2 9  9 9 9 9  9 9 9 9", ", invert = T\n/"), 0, 1,
                 "dark pixels are material, as 'invert' asks");
    expect_fault(with_file(MASK, "P2 2 2 9\n1 2 3 10", "\n/"), 0, 1, ":2: a pixel must be in [0, 9], got 10");
    expect_fault(with_file(MASK, "P2 1 1 9\n1", "\n/"), 0, 1, "leave none of");
    expect_fault(
        with_file("&body material = 'rubber', shape = 'mask', spacing = 0.6, scale = 0.5, file = ", "P2 1 1 1 1", " /"),
        0, 1, "'spacing'");
}

#define SQUARE                                                                                                         \
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 4 1 4\n2 1 0 4\n1\n2\n3\n4\n0 0 0\n2 0 0\n2 2 0\n0 2 0\n"         \
    "$EndNodes\n$Elements\n1 2 1 2\n2 1 2 2\n1 1 2 3\n2 1 3 4\n$EndElements\n"

TEST(a_mesh_is_scaled_and_may_have_cracks)
{
    formed f = build_good(with_file(MESH, SQUARE, " /"));
    assert_close(f.geometry.area, 1.0, 1e-15);
    assert_close(f.geometry.spacing * f.geometry.spacing * 0.25 * sqrt(3.0), 0.5, 1e-15);
    assert_int_equal(f.geometry.n_cracked, 0);
    assert_close(distance_to(&f.lattice, 1.0, 1.0), 0.0, 0.0);
    dem_lattice_free(&f.lattice);
    f = build_good(with_file(MESH, SQUARE, " /\n&crack points = 0.8, 0.1, 0.9, 0.2 /"));
    assert_int_equal(f.geometry.n_cracked, 1);
    assert_int_equal(f.lattice.n_triangles, 1);
    assert_int_equal(f.lattice.n_nodes, 3);
    assert_close(f.geometry.area, 1.0, 1e-15); /* cracks have none */
    dem_lattice_free(&f.lattice);
    expect_fault(with_file(MESH, "$MeshFormat\n4.2", "\n/"), 0, 1, ":2: MSH version 4.1");
    expect_fault(with_file(MESH, SQUARE, " /\n&crack points = 0.1, 0.8, 0.8, 0.1 /"), 0, 1, "cracks leave none of 2");
}

/* By what a program calls. */
TEST(a_mesh_is_the_lattice_that_the_library_makes_of_it)
{
    formed f = build_good(with_file(MESH, SQUARE, " /"));
    CLEANUP(dem_lattice_free) dem_lattice own = dem_lattice_empty();
    const dem_mesh mesh = SIZED(dem_mesh, .text = SQUARE, .size = sizeof SQUARE - 1, .scale = 0.5, .numbered = true);
    assert_int_equal(dem_mesh_lattice(&own, &mesh), DEM_OK);
    assert_int_equal(f.lattice.n_nodes, own.n_nodes);
    assert_int_equal(f.lattice.n_triangles, own.n_triangles);
    assert_memory_equal(f.lattice.x, own.x, (size_t)own.n_nodes * 2 * sizeof *own.x);
    assert_memory_equal(f.lattice.triangles, own.triangles, (size_t)own.n_triangles * 3 * sizeof *own.triangles);
    assert_memory_equal(f.lattice.strength, own.strength, (size_t)own.n_triangles * sizeof *own.strength);
    dem_lattice_free(&f.lattice);
}

TEST(cracks_are_for_their_body_and_must_meet_it)
{
    formed whole = build_good(BLOCK DISC), f = build_good(BLOCK DISC "&crack body = 2, points = 0,0, 1,0 /");
    assert_int_equal(whole.lattice.n_triangles, f.lattice.n_triangles);
    dem_lattice_free(&f.lattice);
    f = build_good(BLOCK "&crack points = -1,1, 0,1 /\n&crack points = -0.5,0.5, -0.5,1.5 /");
    assert_int_equal(f.geometry.n_cracked, whole.lattice.n_triangles - f.lattice.n_triangles);
    assert_true(f.geometry.n_cracked > 30);
    dem_lattice_free(&f.lattice);
    dem_lattice_free(&whole.lattice);
    expect_fault(BLOCK DISC "&crack body = 2, points = 3,1, 4,1 /", 1, 3, "crosses no triangle of body 2");
}

/* ---- squares, jitter ---- */

#define SQUARES BODY "'rectangle', size = 4, 2, lattice = 'square'"

TEST(every_shape_may_be_of_squares)
{
    expect_area(SQUARES " /", 8.0, 1e-12);
    expect_area(BODY "'disc', radius = 1, lattice = 'square' /", pi, 0.13);
    expect_area(BODY "'ring', radius = 2, inner_radius = 1, lattice = 'square' /", 3.0 * pi, 0.15);
    expect_area(SQUARES " /\n&void centre = 0, 1, radius = 0.5 /", 8.0 - 0.25 * pi, 0.05);
}

TEST(cracks_take_whole_cells)
{
    CLEANUP(drop_formed)
    formed f = build_good(SQUARES " /\n&crack points = -0.27,1.02, -0.23,1.04 /"); /* a corner of one triangle */
    assert_int_equal(f.geometry.n_cracked, 2);
}

/* By at most the share of the spacing, the same for the same seed. */
TEST(jitter_moves_nodes_that_are_not_on_the_boundary)
{
    CLEANUP(drop_formed) formed f = build_good(BLOCK);
    CLEANUP(drop_formed) formed g = build_good(BODY "'rectangle', size = 4, 2, jitter = 0.2 /");
    CLEANUP(drop_formed) formed h = build_good(BODY "'rectangle', size = 4, 2, jitter = 0.2, seed = 1 /");
    CLEANUP(drop_formed) formed other = build_good(BODY "'rectangle', size = 4, 2, jitter = 0.2, seed = 2 /");
    const dem_index n = f.lattice.n_nodes;
    double most = 0.0;
    for (dem_index i = 0; i < n; i++)
        most =
            fmax(most, hypot(g.lattice.x[2 * i] - f.lattice.x[2 * i], g.lattice.x[2 * i + 1] - f.lattice.x[2 * i + 1]));
    assert_true(most > 0.018 && most <= 0.02);
    assert_memory_equal(g.lattice.x, h.lattice.x, 2 * (size_t)n * sizeof(double));
    assert_memory_not_equal(g.lattice.x, other.lattice.x, 2 * (size_t)n * sizeof(double));
    assert_memory_equal(g.lattice.x, f.lattice.x, 2 * 41 * sizeof(double)); /* the lowest row */
}

/* ---- inclusions ---- */

#define HEAVY "&material name = 'heavy', youngs_modulus = 1e9, density = 3000, thickness = 0.5 /\n"

/* Which material each triangle of the first body has. Caller frees. */
static dem_index *mark(formed *f, const char *text, size_t n)
{
    char all[4096];
    namelist_errors errors = {0};
    dem_material materials[4];
    (void)snprintf(all, sizeof all, RUN RUBBER "%s", text);
    CLEANUP(drop_resolved) resolved r = resolve_clean(all);
    *f = build_good(text);
    dem_index *of = calloc((size_t)f->lattice.n_triangles, sizeof *of);
    assert_non_null(of);
    assert_int_equal(body_geometry_mark(of, NULL, &f->lattice, &r.deck, 0, &errors), DEM_OK);
    assert_int_equal(f->geometry.n_inclusions, n);
    body_geometry_materials(materials, &r.deck, 0);
    assert_close(materials[0].density, 1000.0, 0.0);
    for (size_t k = 1; k <= n; k++) assert_true(materials[k].density == 1000.0 || materials[k].density == 3000.0);
    return of;
}

TEST(triangles_with_their_centres_in_an_inclusion_are_of_it)
{
    CLEANUP(drop_formed) formed f;
    CLEANUP(free_memory)
    dem_index *of = mark(&f,
                         HEAVY BLOCK DISC "&inclusion material = 'heavy', centre = 0, 1, radius = 0.6 /\n"
                                          "&inclusion body = 2, material = 'heavy', centre = 0, 0, radius = 9 /\n"
                                          "&inclusion material = 'rubber', shape = 'rectangle', centre = 0, 1, size = "
                                          "0.5, 0.28, angle = 90 /",
                         2);
    for (dem_index t = 0; t < f.lattice.n_triangles; t++) {
        double x[2] = {0.0, 0.0};
        for (int c = 0; c < 6; c++) x[c % 2] += f.lattice.x[2 * f.lattice.triangles[3 * t + c / 2] + c % 2] / 3.0;
        const bool inner = fabs(x[0]) < 0.14 && fabs(x[1] - 1.0) < 0.25, outer = hypot(x[0], x[1] - 1.0) < 0.6;
        assert_int_equal(of[t], inner ? 2 : (outer ? 1 : 0));
    }
}

TEST(of_squares_whole_cells_are_of_an_inclusion)
{
    CLEANUP(drop_formed) formed f;
    dem_index n = 0,
              *of =
                  mark(&f, HEAVY SQUARES " /\n&inclusion material = 'heavy', centre = 0.35, 1.05, radius = 0.12 /", 1);
    for (dem_index t = 0; t < f.lattice.n_triangles; t++) {
        assert_int_equal(of[t], of[t ^ 1]);
        n += of[t];
    }
    assert_int_equal(n, 2 * 5); /* the cell about its centre and its neighbours */
    free(of);
}

/* Ring of 3000 * 0.5 in 1000, a quarter of which a void takes; overlaps count once, what is outside does not. */
TEST(the_true_mass_is_that_of_all_materials)
{
    formed f = build_good(BLOCK);
    assert_close(f.geometry.mass, 8000.0, 1e-9);
    dem_lattice_free(&f.lattice);
    f = build_good(HEAVY BLOCK "&inclusion material = 'heavy', centre = 0, 1, radius = 0.8 /\n"
                               "&inclusion material = 'rubber', centre = 0, 1, radius = 0.4 /\n"
                               "&inclusion material = 'heavy', shape = 'rectangle', centre = 2, 1, size = 1, 1 /\n"
                               "&void shape = 'rectangle', centre = -0.5, 1.5, size = 1, 1 /");
    assert_close(f.geometry.mass, 7000.0 + 500.0 * (0.48 * pi * 0.75 + 0.5), 1e-2);
    dem_lattice_free(&f.lattice);
    f = build_good(
        with_file(HEAVY MESH, SQUARE,
                  " /\n&inclusion material = 'heavy', shape = 'rectangle', centre = 1, 0, size = 0.8, 0.8 /"));
    assert_close(f.geometry.mass, 0.5 * 1000.0 + 0.5 * 1500.0, 1e-9);
    dem_lattice_free(&f.lattice);
}

TEST(an_inclusion_without_a_triangle_is_reported)
{
    CLEANUP(namelist_errors_free) namelist_errors errors = {0};
    CLEANUP(drop_formed) formed f = build_good(BLOCK);
    CLEANUP(drop_resolved)
    resolved r = resolve_clean(RUN RUBBER BLOCK "&inclusion material = 'rubber', centre = 0, 5, radius = 1 /");
    CLEANUP(free_memory) dem_index *of = calloc((size_t)f.lattice.n_triangles, sizeof *of);
    assert_non_null(of);
    assert_int_equal(body_geometry_mark(of, NULL, &f.lattice, &r.deck, 0, &errors), DEM_ERROR_MODEL);
    assert_int_equal(errors.n, 1);
    assert_non_null(strstr(errors.list[0].text, "inclusion has no triangle of body 1"));
}

/* ---- files ---- */

TEST(relative_files_start_at_the_decks_folder)
{
    CLEANUP(drop_resolved)
    resolved r = resolve_clean(RUN "&body shape = 'file', file = 'a/b.h5' /\n&body shape = 'file', file = '/c.h5' /");
    CLEANUP(free_memory) char *relative = body_geometry_file("decks/", schema_get(&r.deck, "body", 0));
    CLEANUP(free_memory) char *absolute = body_geometry_file("decks/", schema_get(&r.deck, "body", 1));
    CLEANUP(free_memory) char *plain = body_geometry_file("", schema_get(&r.deck, "body", 0));
    assert_string_equal(relative, "decks/a/b.h5");
    assert_string_equal(absolute, "/c.h5");
    assert_string_equal(plain, "a/b.h5");
}

SCRATCH_GROUP({&path, "a"});
