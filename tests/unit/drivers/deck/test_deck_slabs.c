/* SPDX-License-Identifier: BSD-3-Clause */
/* deck_slabs.c, slab_survey.c: what is found of a body slab by slab is what is found of the whole, to the bit; the
 * slabs that ranks make by the recipe have the nodes of the whole; and what a deck asks for beyond that takes the
 * whole. */
#include "deck_slabs.h"
#include "slab_nodes.h"

#include "unit/close.h"
#include "unit/deck_text.h"

#include <dem/trajectory.h>

#define RUN    "&run t_end = 1 /\n&material youngs_modulus = 1e7, density = 1000, damping_time = 1e-5 /\n"
#define GROUND "&obstacle points = -0.3, -0.02, -0.02, -0.012, 0, 0.02, 0.03, -0.01, 0.3, -0.02 /\n"

/* The disc and the ring begin with the ground in them, so that they go back before they come to their clearance. */
static const char *const suited[] = {
    RUN GROUND
    "&body shape = 'rectangle', size = 0.08, 0.13, spacing = 5e-3, outline = 'lattice', clearance = 2e-4, "
    "velocity = 0.3, -10, angle = 20, spin = -7 /\n&void shape = 'disc', centre = 0.01, 0.05, radius = 0.015 /\n"
    "&probe name = 'top', place = 0, 1 /\n&probe name = 'side', kind = 'spring', place = 1, 0.08 /\n"
    "&probe name = 'across', kind = 'gauge', place = -0.02, 0, -0.03, 0.06 /\n"
    "&probe name = 'this', kind = 'spring', number = 700 /\n",
    RUN GROUND "&body shape = 'disc', radius = 0.065, spacing = 4e-3, outline = 'lattice', clearance = 2e-4 /\n"
               "&void shape = 'disc', centre = 0, 0.01, radius = 0.025 /\n",
    RUN GROUND "&body shape = 'ring', radius = 0.06, inner_radius = 0.045, spacing = 3e-3, outline = 'lattice', "
               "clearance = 1e-3, position = 0.01, 0.02, jitter = 0.3, seed = 8 /\n",
    RUN GROUND "&body shape = 'rectangle', size = 0.11, 0.11, spacing = 4e-3, outline = 'lattice', clearance = 0 /\n"
               "&pores number = 8, radius = 4e-3, 8e-3, wall = 8e-3, seed = 3 /\n",
    RUN GROUND "&body shape = 'polygon', points = 0, 0, 0.1, 0, 0.05, 0.03, 0.1, 0.1, 0, 0.1, spacing = 3e-3, "
               "outline = 'lattice', position = 0, 0.1 /\n",
    /* A point reaches deep into the body, between its nodes. */
    RUN "&obstacle points = -0.3, -0.02, 0.0008, -0.02, 0.0012, 0.022, 0.0016, -0.02, 0.3, -0.02 /\n"
        "&body shape = 'rectangle', size = 0.06, 0.06, spacing = 5e-3, outline = 'lattice', clearance = 2e-4, "
        "position = 0, -0.003 /\n",
    RUN GROUND
    "&body shape = 'disc', radius = 0.05, spacing = 4e-3, lattice = 'square', diagonal = 0.4, "
    "clearance = 1e-4, angle = 30, jitter = 0.2, seed = 2 /\n&void shape = 'disc', centre = 0, 0, radius = 0.02 /\n",
    /* Of single triangles, where no spring is damped as long as their material is. */
    RUN "&material name = 'core', youngs_modulus = 3e7, density = 3000, damping_time = 4e-6 /\n"
        "&material name = 'spot', youngs_modulus = 3e7, density = 3000, damping_time = 1e-4 /\n"
        "&body shape = 'rectangle', size = 0.09, 0.1, spacing = 4e-3, outline = 'lattice', "
        "spin = 20 /\n"
        "&inclusion shape = 'disc', centre = 0.015, 0.05, radius = 0.025, material = 'core' /\n"
        "&inclusion shape = 'disc', centre = -0.03, 0.04619, radius = 1e-3, material = 'spot' /\n"
        "&inclusion shape = 'disc', centre = -0.028, 0.04965, radius = 1e-3, material = 'spot' /\n"
        "&inclusion shape = 'disc', centre = -0.03, 0.05312, radius = 1e-3, material = 'spot' /\n",
    RUN "&material name = 'core', youngs_modulus = 3e7, density = 3000, damping_time = 4e-5 /\n"
        "&body shape = 'rectangle', size = 0.06, 0.08, spacing = 4e-3, lattice = 'square' /\n"
        "&inclusion shape = 'rectangle', centre = 0.0, 0.045, size = 0.02, 0.03, material = 'core' /\n",
    /* Large and small ones, damped or not. */
    RUN GROUND "&material name = 'rigid', youngs_modulus = 1e9, density = 4000 /\n"
               "&body shape = 'disc', radius = 0.03, spacing = 5e-3, outline = 'lattice', clearance = 1e-3, spin = 4, "
               "position = -0.1, 0.1, material = 'rigid' /\n"
               "&body shape = 'rectangle', size = 0.1, 0.1, spacing = 5e-3, lattice = 'square', jitter = 0.1, "
               "clearance = 2e-3, position = 0.1, 0.1, velocity = 1, -3 /\n"
               "&body shape = 'ring', radius = 0.03, inner_radius = 0.015, spacing = 4e-3, outline = 'lattice', "
               "position = 0.1, 0.3, angle = 40 /\n"
               "&void shape = 'disc', body = 2, centre = 0, 0.05, radius = 0.02 /\n"
               "&inclusion shape = 'disc', body = 1, centre = 0, 0, radius = 0.01, material = 'solid' /\n"
               "&probe name = 'a', body = 2, place = 0, 0.01 /\n&probe name = 'b', number = 600 /\n"
               "&probe name = 'c', body = 3, kind = 'spring', place = -0.03, 0 /\n",
    RUN "&body shape = 'disc', radius = 0.02, spacing = 5e-3, outline = 'lattice', copies = 5, 3, pitch = 0.06, 0.05, "
        "scatter = 3e-3, seed = 4, jitter = 0.2, spin = -30, position = 0.01, 0.1, velocity = 2, 0 /\n"
        "&body shape = 'disc', radius = 0.05, spacing = 5e-3, outline = 'lattice', position = -0.2, 0 /\n"
        "&body shape = 'rectangle', size = 0.05, 0.09, spacing = 4e-3, outline = 'lattice', copies = 2, 1, "
        "pitch = 0.1, 1, position = 0.3, 0.3 /\n"
        "&probe name = 'a', body = 2, place = 0, 0.01 /\n",
    RUN "&body shape = 'disc', radius = 0.03, spacing = 5e-3, outline = 'lattice', copies = 2, 1, pitch = 0.08, 1, "
        "scatter = 8e-3, seed = 7, velocity = 0, -1 /\n",
    RUN GROUND
    "&body shape = 'mask', file = 'a.pgm', scale = 4e-3, spacing = 5e-3, invert = .true., angle = 15, "
    "clearance = 1e-3, spin = 2 /\n"
    "&body shape = 'mask', file = 'a.pgm', scale = 2e-3, spacing = 3e-3, invert = .true., lattice = 'square', "
    "position = 0.3, 0.2 /\n",
    /* Held, pulled, pushed; by sides, places and a number. */
    RUN GROUND "&body shape = 'rectangle', size = 0.12, 0.1, spacing = 5e-3, outline = 'lattice', angle = 30, "
               "clearance = 1e-3 /\n&void shape = 'disc', centre = 0, 0.05, radius = 0.02 /\n"
               "&body shape = 'disc', radius = 0.04, spacing = 4e-3, lattice = 'square', jitter = 0.2, "
               "position = 0.2, 0.2 /\n"
               "&boundary where = 'side', side = 'bottom' /\n"
               "&boundary where = 'side', side = 'right', kind = 'traction', traction = 100, 0, ramp = 1 /\n"
               "&boundary where = 'disc', centre = 0, 0.05, radius = 0.025, kind = 'traction', traction = 0, 9 /\n"
               "&boundary body = 2, where = 'side', side = 'top', kind = 'velocity', velocity = 1, 0, "
               "components = 'x' /\n"
               "&boundary body = 2, where = 'list', nodes = 3, 200, kind = 'force', force = 1, 2 /\n"
               "&boundary body = 2, where = 'box', box = -0.01, -0.05, 0.01, -0.03 /\n",
    /* With smooth edges and cracks. */
    RUN GROUND
    "&body shape = 'ring', radius = 0.06, inner_radius = 0.03, spacing = 3e-3, clearance = 1e-3, angle = 30, "
    "position = 0.01, 0.02, jitter = 0.05, seed = 8, spin = 7 /\n"
    "&crack points = 0.025, 0.01, 0.05, 0.012, 0.052, 0.02 /\n"
    "&pores number = 4, radius = 3e-3, 5e-3, wall = 5e-3, seed = 3 /\n"
    "&probe name = 'top', place = 0, 1 /\n&probe name = 'side', kind = 'spring', place = 1, 0.03 /\n",
    RUN GROUND "&material name = 'core', youngs_modulus = 3e7, density = 3000 /\n"
               "&body shape = 'polygon', points = 0, 0, 0.1, 0, 0.05, 0.03, 0.1, 0.1, 0, 0.1, spacing = 3e-3, "
               "position = 0, 0.1 /\n"
               "&inclusion shape = 'disc', centre = 0.02, 0.05, radius = 0.01, material = 'core' /\n"
               "&crack points = 0.03, 0.11, 0.031, 0.08 /\n&crack points = 0.005, 0.02, 0.03, 0.02 /\n"
               "&body shape = 'rectangle', size = 0.1, 0.1, spacing = 5e-3, lattice = 'square', position = -0.2, 0 /\n"
               "&crack body = 2, points = -0.02, 0.02, 0.02, 0.04 /\n"
               "&boundary body = 2, where = 'side', side = 'bottom' /\n"
               "&boundary where = 'side', side = 'left', kind = 'traction', traction = 100, 0, ramp = 1 /\n",
    /* Lattice files: alone, with all that may be asked for; beside other bodies, which have other arrays. */
    RUN GROUND "&body shape = 'file', file = 'smooth.vtkhdf', clearance = 2e-4, velocity = 0.3, -10, angle = 20 /\n",
    RUN GROUND
    "&body shape = 'file', file = 'square.vtkhdf', clearance = 2e-4, angle = 40, spin = -7, velocity = 0, -1 /\n"
    "&probe name = 'top', place = 0, 1 /\n&probe name = 'side', kind = 'spring', place = 1, 0.03 /\n"
    "&probe name = 'this', kind = 'spring', number = 700 /\n"
    "&boundary where = 'side', side = 'bottom' /\n"
    "&boundary where = 'side', side = 'right', kind = 'traction', traction = 100, 0, ramp = 1 /\n"
    "&boundary where = 'list', nodes = 3, 200, kind = 'force', force = 1, 2 /\n",
    RUN "&body shape = 'file', file = 'other.vtkhdf' /\n&probe name = 'top', place = 0, 1 /\n",
    RUN GROUND
    "&body shape = 'rectangle', size = 0.06, 0.05, spacing = 5e-3, outline = 'lattice', clearance = 1e-3 /\n"
    "&body shape = 'file', file = 'other.vtkhdf', position = -0.2, 0.1, velocity = 0, -2 /\n"
    "&body shape = 'file', file = 'square.vtkhdf', copies = 3, 1, pitch = 0.12, 0.12, scatter = 5e-3, seed = 3, "
    "spin = 5, position = 0.2, 0.2 /\n"
    "&body shape = 'file', file = 'smooth.vtkhdf', position = 0, 0.4 /\n"
    "&probe name = 'a', body = 1, place = 0, 0.01 /\n&probe name = 'b', body = 4, kind = 'spring', "
    "place = 0, 0 /\n"
    "&boundary body = 4, where = 'side', side = 'top', kind = 'velocity', velocity = 1, 0 /\n",
};

/* The sources of these files. */
static const char smooth[] = RUN "&body shape = 'disc', radius = 0.05, spacing = 5e-3, outline = 'smooth' /\n";
static const char square[] = RUN "&body shape = 'rectangle', size = 0.06, 0.07, spacing = 4e-3, lattice = 'square', "
                                 "jitter = 0.2, spin = 30, velocity = 1, 2 /\n";

/* A cross in a frame, 40 by 30 pixels, of which the dark ones are material. */
static void put_image(const char *path)
{
    enum { WIDTH = 40, HEIGHT = 30 };
    char text[16 + WIDTH * HEIGHT] = "P5 40 30 255\n";
    const size_t head = strlen(text);
    for (int row = 0; row < HEIGHT; row++)
        for (int column = 0; column < WIDTH; column++) {
            const bool frame = row < 6 || row >= HEIGHT - 6 || column < 6 || column >= WIDTH - 6;
            const bool cross = abs(row - HEIGHT / 2) < 3 || abs(column - WIDTH / 2) < 4;
            text[head + (size_t)(WIDTH * row + column)] = frame || cross ? 0 : (char)200;
        }
    file_put(path, text, head + WIDTH * HEIGHT);
}

enum { N_SUITED = sizeof suited / sizeof *suited, MOST_SLABS = 5 };

/* In so many slabs, and many ones of files are looked at in fewer; 0: as a whole. */
static deck read_in(dem_index n, const char *text)
{
    CLEANUP(namelist_errors_free) namelist_errors errors = {0};
    const char *path = folder_at(&scratch, "a.nml");
    deck d;
    file_put(path, text, strlen(text));
    deck_status status = deck_parse(&d, path, NULL, 0, &errors);
    if (status == DECK_OK) {
        d.slabs.n = deck_slabs_suit(&d.groups) ? n : 0;
        d.slabs.least = n > 3 ? 150 : 0;
        status = deck_build(&d, &errors);
    }
    if (errors.n > 0) fail_msg("%s", errors.list[0].text);
    assert_int_equal(status, DECK_OK);
    assert_int_equal(unlink(path), 0);
    return d;
}

/* ---- lattice files ---- */

static void ok(dem_status status)
{
    if (status != DEM_OK) fail_msg("%s", dem_status_message());
}

/* As the output of a run has it. */
static void put_lattice(const char *path, const dem_lattice *l)
{
    dem_options usual = dem_options_default();
    const dem_trajectory_options how = dem_trajectory_options_default();
    dem_model *model;
    dem_simulation *simulation;
    dem_trajectory *file;
    usual.max_step = 1e-6, usual.v_scale = 1.0, usual.bodies = DEM_BODIES_OTHERS; /* as rigid ones need */
    ok(dem_model_create(&model, l, NULL, 0));
    ok(dem_simulation_create(&simulation, model, &usual));
    ok(dem_trajectory_create(&file, path, simulation, &how));
    ok(dem_trajectory_finish(file));
    dem_trajectory_destroy(file);
    dem_simulation_destroy(simulation);
    dem_model_destroy(model);
}

static void put_deck(const char *path, const char *text)
{
    CLEANUP(deck_free) deck d = read_in(0, text);
    put_lattice(path, &d.lattice);
}

static int by_lowest(const void *a, const void *b)
{
    const dem_index *p = a, *q = b;
    dem_index lowest[2] = {p[0], q[0]};
    for (int c = 1; c < 3; c++) {
        lowest[0] = p[c] < lowest[0] ? p[c] : lowest[0];
        lowest[1] = q[c] < lowest[1] ? q[c] : lowest[1];
    }
    return (lowest[0] > lowest[1]) - (lowest[0] < lowest[1]);
}

/* A block without damping whose nodes have been numbered anew, by twos, so that the triangles of slabs have gaps. */
static void put_other(const char *path)
{
    const dem_material hard = {
        .struct_size = sizeof hard, .youngs_modulus = 1e8, .poissons_ratio = 0.2, .density = 3000.0, .thickness = 2.0};
    CLEANUP(dem_lattice_free) dem_lattice l = dem_lattice_empty();
    ok(dem_lattice_rectangle(&l, 0.05, 0.08, 4e-3));
    for (dem_index i = 0; i + 1 < l.n_nodes; i += 2)
        for (int c = 0; c < 2; c++) {
            const double kept = l.x[2 * i + c];
            l.x[2 * i + c] = l.x[2 * (i + 1) + c];
            l.x[2 * (i + 1) + c] = kept;
        }
    for (dem_index k = 0; k < 3 * l.n_triangles; k++)
        if ((l.triangles[k] ^ 1) < l.n_nodes) l.triangles[k] ^= 1;
    qsort(l.triangles, (size_t)l.n_triangles, 3 * sizeof *l.triangles, by_lowest);
    ok(dem_lattice_assemble(&l, &hard));
    put_lattice(path, &l);
}

static void put_files(void)
{
    put_image(folder_file(&scratch, "a.pgm"));
    put_deck(folder_file(&scratch, "smooth.vtkhdf"), smooth);
    put_deck(folder_file(&scratch, "square.vtkhdf"), square);
    put_other(folder_file(&scratch, "other.vtkhdf"));
}

/* ---- what is the same ---- */

static void check_body(const body_facts *a, const body_facts *b)
{
    assert_memory_equal(&a->mass, &b->mass, sizeof a->mass);
    assert_memory_equal(&a->true_mass, &b->true_mass, sizeof a->true_mass);
    assert_memory_equal(&a->least_angle, &b->least_angle, sizeof a->least_angle);
    assert_memory_equal(&a->geometry.area, &b->geometry.area, sizeof a->geometry.area);
    assert_int_equal(a->geometry.n_pores, b->geometry.n_pores);
    assert_int_equal(a->geometry.n_cracked, b->geometry.n_cracked);
    assert_int_equal(a->geometry.report.n_rim, b->geometry.report.n_rim);
    assert_int_equal(a->geometry.report.n_off, b->geometry.report.n_off);
    assert_int_equal(a->geometry.report.n_cut, b->geometry.report.n_cut);
    assert_memory_equal(&a->geometry.report.farthest, &b->geometry.report.farthest, sizeof(double));
    assert_int_equal(a->n_included, b->n_included);
    assert_int_equal(a->further, b->further);
    assert_int_equal(a->loose.n + b->loose.n + a->hinges.n + b->hinges.n, 0);
}

static void check_facts(const deck *whole, const deck *slabs)
{
    const lattice_facts *f = &whole->facts, *g = &slabs->facts;
    assert_int_equal(whole->n_bodies, slabs->n_bodies);
    for (size_t k = 0; k < whole->n_bodies; k++) check_body(&whole->bodies[k], &slabs->bodies[k]);
    assert_memory_equal(&f->motion, &g->motion, sizeof f->motion);
    assert_memory_equal(f->low, g->low, sizeof f->low);
    assert_memory_equal(f->high, g->high, sizeof f->high);
    assert_memory_equal(&f->damping_time, &g->damping_time, sizeof f->damping_time);
    assert_memory_equal(&f->share_of_fastest, &g->share_of_fastest, sizeof f->share_of_fastest);
    assert_int_equal(f->n_bodies, g->n_bodies);
    for (dem_index k = 0; k < f->n_bodies; k++) assert_memory_equal(&f->bodies[k], &g->bodies[k], sizeof f->bodies[k]);
}

static void check_boundaries(const deck *whole, const deck *slabs)
{
    assert_int_equal(whole->n_boundaries, slabs->n_boundaries);
    for (dem_index k = 0; k < whole->n_boundaries; k++) {
        const dem_boundary *a = &whole->boundaries[k], *b = &slabs->boundaries[k];
        assert_int_equal(a->n_nodes, b->n_nodes);
        assert_memory_equal(a->nodes, b->nodes, (size_t)a->n_nodes * sizeof *a->nodes);
        assert_int_equal(a->share != NULL, b->share != NULL);
        if (a->share != NULL) assert_memory_equal(a->share, b->share, (size_t)a->n_nodes * sizeof *a->share);
    }
}

static void check_probes(const deck *whole, const deck *slabs)
{
    assert_int_equal(whole->n_probes, slabs->n_probes);
    for (dem_index k = 0; k < whole->n_probes; k++) {
        assert_memory_equal(whole->probes[k].number, slabs->probes[k].number, sizeof whole->probes[k].number);
        assert_memory_equal(whole->probe_places[k], slabs->probe_places[k], sizeof *whole->probe_places);
    }
}

/* Own nodes, by their numbers, with all that they have in the whole. */
static void check_nodes(const dem_lattice *whole, dem_slab *slab)
{
    assert_null(slab->lattice.position);                                        /* as not all bodies may have any */
    if (whole->flags != NULL) ok(dem_lattice_exclude(&slab->lattice, NULL, 0)); /* has some then */
    const dem_lattice *l = &slab->lattice;
    const dem_index first = slab->first_node, own = slab->first_own;
    const size_t n = (size_t)slab->n_own;
    assert_memory_equal(whole->x + 2 * first, l->x + 2 * own, 2 * n * sizeof *l->x);
    assert_memory_equal(whole->mass + first, l->mass + own, n * sizeof *l->mass);
    assert_memory_equal(whole->velocity + 2 * first, l->velocity + 2 * own, 2 * n * sizeof *l->velocity);
    assert_int_equal(whole->flags != NULL, l->flags != NULL);
    if (l->flags != NULL) assert_memory_equal(whole->flags + first, l->flags + own, n * sizeof *l->flags);
    for (dem_index i = 0; i < slab->n_own; i++)
        assert_int_equal(whole->body != NULL ? whole->body[first + i] : 0, l->body[own + i]);
}

/* Of the rim places and bodies. */
static void check_rim(const dem_lattice *whole, const dem_slab *slab)
{
    const dem_lattice *l = &slab->lattice;
    for (dem_index r = 0; r < l->n_nodes - slab->n_own; r++) {
        const dem_index i = r < slab->first_own ? r : r + slab->n_own, number = slab->rim[r];
        assert_memory_equal(whole->x + 2 * number, l->x + 2 * i, 2 * sizeof *l->x);
        assert_int_equal(whole->body != NULL ? whole->body[number] : 0, l->body[i]);
    }
}

static long n_gaps; /* slabs whose triangles do not follow each other in the whole */

/* Those whose lowest node is an own one come behind those of the slabs before. \return how many there are in all */
static dem_index check_triangles(const dem_lattice *whole, const dem_slab *slab, dem_index before)
{
    const dem_lattice *l = &slab->lattice;
    for (dem_index k = 0; k < 3 * l->n_triangles && slab->first_triangle >= 0; k++)
        assert_int_equal(whole->triangles[3 * slab->first_triangle + k], slab_nodes_number(slab, l->triangles[k]));
    for (dem_index t = 0; t < l->n_triangles; t++) {
        if (!slab_nodes_owns(slab, l->triangles + 3 * t, 3)) continue;
        assert_true(before < whole->n_triangles);
        for (int c = 0; c < 3; c++)
            assert_int_equal(whole->triangles[3 * before + c], slab_nodes_number(slab, l->triangles[3 * t + c]));
        assert_memory_equal(whole->modulus + before, l->modulus + t, sizeof *l->modulus);
        assert_memory_equal(whole->thickness + before, l->thickness + t, sizeof *l->thickness);
        before++;
    }
    n_gaps += slab->first_triangle < 0;
    return before;
}

/* Those whose lower end is an own node come behind those of the slabs before. \return how many there are in all */
static dem_index check_springs(const dem_lattice *whole, const dem_slab *slab, dem_index before)
{
    const dem_lattice *l = &slab->lattice;
    for (dem_index k = 0; k < l->n_springs; k++) {
        const dem_index a = l->ends[2 * k], b = l->ends[2 * k + 1], lower = a < b ? a : b;
        if (lower < slab->first_own || lower >= slab->first_own + slab->n_own) continue;
        assert_true(before < whole->n_springs);
        assert_memory_equal(whole->stiffness + before, l->stiffness + k, sizeof *l->stiffness);
        assert_memory_equal(whole->rest_length + before, l->rest_length + k, sizeof *l->rest_length);
        const double viscosity = l->viscosity != NULL ? l->viscosity[k] : 0.0, none = 0.0;
        assert_memory_equal(whole->viscosity != NULL ? whole->viscosity + before : &none, &viscosity, sizeof viscosity);
        before++;
    }
    return before;
}

/* \param first  NULL: as the recipe's maker shares nodes out */
static void check_slabs(const deck *whole, const deck *slabs, const dem_index *first)
{
    size_t size;
    void *recipe = deck_slabs_recipe(&size, &slabs->slabs, slabs->echo);
    dem_index n_nodes = 0, n_springs = 0, n_triangles = 0;
    assert_non_null(recipe);
    for (dem_index part = 0; part < slabs->slabs.n; part++) {
        CLEANUP(dem_slab_free) dem_slab slab = dem_slab_empty();
        assert_int_equal(deck_slabs_make(NULL, recipe, size, &(slab_share){part, slabs->slabs.n, first}, &slab),
                         DEM_OK);
        assert_int_equal(slab.first_node, n_nodes);
        check_nodes(&whole->lattice, &slab);
        check_rim(&whole->lattice, &slab);
        n_nodes += slab.n_own;
        n_triangles = check_triangles(&whole->lattice, &slab, n_triangles);
        n_springs = check_springs(&whole->lattice, &slab, n_springs);
    }
    assert_int_equal(n_nodes, whole->lattice.n_nodes);
    assert_int_equal(n_springs, whole->lattice.n_springs);
    assert_int_equal(n_triangles, whole->lattice.n_triangles);
    free(recipe);
}

/* Ranges that grow, with nodes of any row at their ends. */
static void check_other_ranges(const deck *whole, const deck *slabs)
{
    dem_index first[MOST_SLABS + 1] = {0};
    const dem_index n = slabs->slabs.n, all = whole->lattice.n_nodes;
    for (dem_index k = 1; k <= n; k++) first[k] = all * (k * k + 2 * k) / (n * n + 2 * n);
    check_slabs(whole, slabs, first);
}

TEST(slabs_have_the_facts_and_the_nodes_of_the_whole)
{
    put_files();
    for (int k = 0; k < N_SUITED; k++) {
        CLEANUP(deck_free) deck whole = read_in(0, suited[k]);
        for (dem_index n = 1; n <= MOST_SLABS; n++) {
            CLEANUP(deck_free) deck slabs = read_in(n, suited[k]);
            assert_true(slabs.slabs.are_made);
            assert_int_equal(slabs.lattice.n_nodes, 0);
            assert_string_equal(whole.echo, slabs.echo);
            check_facts(&whole, &slabs);
            check_boundaries(&whole, &slabs);
            check_probes(&whole, &slabs);
            check_slabs(&whole, &slabs, NULL);
            check_other_ranges(&whole, &slabs);
        }
    }
    assert_true(n_gaps > 0);
}

/* As when slabs are made again, and the image has gone meanwhile: not as where a rank would have no rows. */
TEST(an_image_that_is_gone_is_an_error_of_its_own)
{
    const char *path = scratch.files[0]; /* "a.pgm", which is there since the test before */
    CLEANUP(deck_free)
    deck d = read_in(2, RUN "&body shape = 'mask', file = 'a.pgm', scale = 4e-3, spacing = 5e-3, invert = .true. /\n");
    size_t size;
    CLEANUP(free_memory) void *recipe = deck_slabs_recipe(&size, &d.slabs, d.echo);
    CLEANUP(dem_slab_free) dem_slab slab = dem_slab_empty();
    assert_true(d.slabs.are_made);
    assert_int_equal(unlink(path), 0);
    assert_int_equal(deck_slabs_make(NULL, recipe, size, &(slab_share){0, 2, NULL}, &slab), DEM_ERROR_IO);
    assert_non_null(strstr(dem_status_message(), "a.pgm"));
    put_image(path);
}

TEST(what_asks_for_more_is_built_as_a_whole)
{
    static const char *const others[] = {
        RUN "&body shape = 'rectangle', size = 0.05, 0.05, spacing = 5e-3 /\n&output fields = 'fragment' /\n",
        /* So much jitter would squeeze triangles at the edge. */
        RUN "&body shape = 'disc', radius = 0.05, spacing = 5e-3, jitter = 0.3 /\n",
        RUN "&body shape = 'disc', radius = 0.02, spacing = 5e-3, outline = 'lattice' /\n"
            "&body shape = 'disc', radius = 0.02, spacing = 5e-3, outline = 'lattice', position = 0.1, 0, "
            "rigid = .true. /\n",
        /* Rows of 1, 2 and 3 nodes: none begins in the share of the last rank. */
        RUN "&body shape = 'polygon', points = 0, 0, 4.1e-3, 7e-3, -4.1e-3, 7e-3, spacing = 4e-3, "
            "outline = 'lattice' /\n",
        RUN "&body shape = 'polygon', points = 0, 0, 4.1e-3, 7e-3, -4.1e-3, 7e-3, spacing = 4e-3, "
            "outline = 'lattice', spin = 1 /\n",
        /* A slit cuts the body in two. */
        RUN "&body shape = 'rectangle', size = 0.05, 0.1, spacing = 5e-3, outline = 'lattice', "
            "disconnected = 'keep' /\n"
            "&void shape = 'rectangle', size = 0.1, 0.012, centre = 0, 0.05 /\n",
    };
    for (size_t k = 0; k < sizeof others / sizeof *others; k++) {
        CLEANUP(deck_free) deck d = read_in(3, others[k]);
        assert_false(d.slabs.are_made);
        assert_true(d.lattice.n_nodes > 0);
    }
}

/* A file that is changed as one says, and put into a deck, is made by no rank. */
static void check_unsuited(const char *text, void (*change)(dem_lattice *l))
{
    CLEANUP(deck_free) deck source = read_in(0, text);
    change(&source.lattice);
    const char *path = folder_at(&scratch, "b.vtkhdf");
    put_lattice(path, &source.lattice);
    CLEANUP(deck_free) deck d = read_in(3, RUN "&body shape = 'file', file = 'b.vtkhdf', disconnected = 'keep' /\n");
    assert_false(d.slabs.are_made);
    assert_true(d.lattice.n_nodes > 0);
    assert_int_equal(unlink(path), 0);
}

static void leave(__attribute__((unused)) dem_lattice *l)
{
}

static void displace(dem_lattice *l)
{
    l->position = malloc(2 * (size_t)l->n_nodes * sizeof *l->position);
    assert_non_null(l->position);
    memcpy(l->position, l->x, 2 * (size_t)l->n_nodes * sizeof *l->position);
    l->position[40] += 1e-9;
}

/* Changes the first spring for the last one. */
static void disorder(dem_lattice *l)
{
    const dem_index last = l->n_springs - 1;
    double *arrays[] = {l->rest_length, l->stiffness, l->viscosity};
    for (int c = 0; c < 2; c++) {
        const dem_index kept = l->ends[c];
        l->ends[c] = l->ends[2 * last + c];
        l->ends[2 * last + c] = kept;
    }
    for (size_t a = 0; a < sizeof arrays / sizeof *arrays; a++) {
        const double kept = arrays[a][0];
        arrays[a][0] = arrays[a][last];
        arrays[a][last] = kept;
    }
}

static void exclude(dem_lattice *l)
{
    ok(dem_lattice_exclude(l, (const dem_index[]){0}, 1));
}

static void stiffen(dem_lattice *l)
{
    ok(dem_lattice_stiffen(l, DEM_GUIDE_NONE));
}

/* It keeps its springs. */
static void bare(dem_lattice *l)
{
    l->n_triangles -= 3;
}

static void forget_moduli(dem_lattice *l)
{
    free(l->modulus);
    l->modulus = NULL;
}

TEST(unusual_lattice_files_are_built_as_a_whole)
{
    static const char disc[] = RUN "&body shape = 'disc', radius = 0.03, spacing = 5e-3, outline = 'lattice' /\n";
    static const char brittle[] =
        "&run t_end = 1 /\n&material youngs_modulus = 1e7, density = 1000, fracture = 'stress', strength = 1e5 /\n"
        "&body shape = 'disc', radius = 0.03, spacing = 5e-3, outline = 'lattice' /\n";
    static const char two[] = RUN "&body shape = 'disc', radius = 0.03, spacing = 5e-3, outline = 'lattice' /\n"
                                  "&body shape = 'disc', radius = 0.03, spacing = 5e-3, outline = 'lattice', "
                                  "position = 0.1, 0 /\n";
    static const char parts[] = RUN "&body shape = 'rectangle', size = 0.05, 0.1, spacing = 5e-3, outline = 'lattice', "
                                    "disconnected = 'keep' /\n"
                                    "&void shape = 'rectangle', size = 0.1, 0.012, centre = 0, 0.05 /\n";
    const struct {
        const char *text;
        void (*change)(dem_lattice *l);
    } cases[] = {{brittle, leave}, {two, leave}, {parts, leave},  {disc, displace},     {disc, disorder},
                 {disc, exclude},  {disc, bare}, {disc, stiffen}, {disc, forget_moduli}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) check_unsuited(cases[k].text, cases[k].change);
    CLEANUP(namelist_errors_free) namelist_errors errors = {0};
    CLEANUP(deck_free) deck d;
    const char *path = folder_at(&scratch, "a.nml");
    static const char scaled[] = RUN "&solver v_scale = 1 /\n&body shape = 'file', file = 'b.vtkhdf' /\n";
    file_put(path, scaled, strlen(scaled));
    assert_int_equal(deck_parse(&d, path, NULL, 0, &errors), DECK_OK);
    assert_false(deck_slabs_suit(&d.groups));
    assert_int_equal(unlink(path), 0);
}

TEST(a_file_of_fewer_nodes_than_ranks_is_built_as_a_whole)
{
    CLEANUP(dem_lattice_free) dem_lattice l = dem_lattice_empty();
    const dem_material any = {
        .struct_size = sizeof any, .youngs_modulus = 1e7, .poissons_ratio = 0.3, .density = 1e3, .thickness = 1.0};
    ok(dem_lattice_rectangle(&l, 0.01, 0.01, 0.01));
    ok(dem_lattice_assemble(&l, &any));
    const char *path = folder_at(&scratch, "b.vtkhdf");
    put_lattice(path, &l);
    CLEANUP(deck_free) deck few = read_in(l.n_nodes, RUN "&body shape = 'file', file = 'b.vtkhdf' /\n");
    CLEANUP(deck_free) deck many = read_in(l.n_nodes + 1, RUN "&body shape = 'file', file = 'b.vtkhdf' /\n");
    assert_true(few.slabs.are_made);
    assert_false(many.slabs.are_made);
    assert_int_equal(unlink(path), 0);
}

/* The whole names the place, the obstacle and the depth: of a node, and of a point between nodes that lies deeper in
 * the body than its boundary strip does. */
TEST(what_is_wrong_is_reported_as_of_the_whole)
{
    static const char *const texts[] = {
        RUN GROUND "&body shape = 'disc', radius = 0.065, spacing = 4e-3, outline = 'lattice' /\n",
        RUN
        "&obstacle points = -0.3, -0.02, 0.0008, -0.02, 0.0012, 0.022, 0.0016, -0.02, 0.3, -0.02 /\n"
        "&body shape = 'rectangle', size = 0.06, 0.06, spacing = 5e-3, outline = 'lattice', position = 0, -0.003 /\n",
        RUN "&body shape = 'disc', radius = 0.05, spacing = 5e-3 /\n&crack points = 0, 0, 0.01, 0 /\n"
            "&crack points = 0.1, 0, 0.2, 0 /\n",
        RUN "&body shape = 'disc', radius = 0.05, spacing = 5e-3, outline = 'lattice' /\n"
            "&probe name = 'a', number = 99999 /\n&probe name = 'b', kind = 'spring', number = 99999 /\n",
        RUN "&body shape = 'disc', radius = 0.05, spacing = 5e-3, outline = 'lattice' /\n"
            "&boundary where = 'box', box = 0.1, 0.1, 0.2, 0.2 /\n&boundary where = 'side', side = 'left' /\n"
            "&boundary where = 'disc', centre = -0.05, 0, radius = 0.02 /\n"};
    for (size_t t = 0; t < sizeof texts / sizeof *texts; t++) {
        namelist_errors errors[2] = {{0}};
        const char *path = folder_at(&scratch, "a.nml");
        file_put(path, texts[t], strlen(texts[t]));
        for (int k = 0; k < 2; k++) {
            deck d;
            assert_int_equal(deck_parse(&d, path, NULL, 0, &errors[k]), DECK_OK);
            d.slabs.n = k == 0 ? 0 : 3;
            assert_int_equal(deck_build(&d, &errors[k]), DECK_INVALID);
        }
        assert_true(errors[0].n > 0);
        assert_int_equal(errors[0].n, errors[1].n);
        for (size_t e = 0; e < errors[0].n; e++) assert_string_equal(errors[0].list[e].text, errors[1].list[e].text);
        for (int k = 0; k < 2; k++) namelist_errors_free(&errors[k]);
        assert_int_equal(unlink(path), 0);
    }
}

TEST_GROUP(scratch_make, scratch_remove);
