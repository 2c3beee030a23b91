/* SPDX-License-Identifier: BSD-3-Clause */
/* surface_load.c: forces, pressures and pairs of two blocks, one above the other, against the law of contact and a look
 * at all nodes and edges. */
#include "surface_contact/surface_load.h"

#include "verification/support.h"

static const double spacing = 5e-3, thickness = 1e-3, modulus = 1e7, plate = 0.02;

typedef struct scene {
    dem_lattice lattice; /* its second half is the upper block */
    surface_contact *contact;
    const double *x;
    double *force;    /* [n][2] */
    double *pressure; /* [n] */
} scene;

/* Blocks of 30 x 26 mm, whose faces are flat; the upper one is shifted. */
static void open_scene(scene *s, double gap, double shift)
{
    const dem_material rubber = SIZED(dem_material, .youngs_modulus = modulus, .poissons_ratio = 1.0 / 3.0,
                                      .density = 1050.0, .thickness = plate);
    const surface_contact_rule rule = {.thickness = thickness, .stiffness = 1.0};
    CLEANUP(dem_lattice_free) dem_lattice upper = support_rectangle(0.03, 0.026, spacing, &rubber);
    *s = (scene){.lattice = support_rectangle(0.03, 0.026, spacing, &rubber)};
    dem_lattice_move(&upper, 0.0, (const double[2]){shift, support_top(&upper) + gap});
    assert_ok(dem_lattice_append(&s->lattice, &upper));
    s->lattice.flags = calloc((size_t)s->lattice.n_nodes, sizeof *s->lattice.flags);
    assert_ok(surface_contact_create(&s->contact, &s->lattice, &rule));
    s->x = s->lattice.x;
    s->force = calloc(2 * (size_t)s->lattice.n_nodes, sizeof *s->force);
    s->pressure = calloc((size_t)s->lattice.n_nodes, sizeof *s->pressure);
    assert_ok(surface_contact_follow(s->contact, s->x));
    surface_load_forces(s->contact, s->x, s->force);
    assert_ok(surface_load_pressures(s->contact, s->x, s->pressure));
}

static void close_scene(scene *s)
{
    surface_contact_destroy(s->contact);
    dem_lattice_free(&s->lattice);
    free(s->force);
    free(s->pressure);
}

/* Nodes right above nodes at half of the thickness: all of the law's pressure E (1 - u)^2/u acts on their length, and
 * it is 0 where nothing is near. */
TEST(a_uniform_gap_has_the_pressure_of_the_law)
{
    CLEANUP(close_scene) scene s;
    open_scene(&s, 0.5 * thickness, 0.0);
    const dem_index half = s.lattice.n_nodes / 2;
    dem_index n_pressed = 0;
    for (dem_index i = half; i < s.lattice.n_nodes; i++) {
        const bool inside = s.x[2 * i + 1] < s.x[2 * half + 1] + 1e-6 && fabs(s.x[2 * i]) < 0.014;
        if (s.x[2 * i + 1] > s.x[2 * half + 1] + 1e-6) assert_close(s.pressure[i], 0.0, 0.0);
        if (!inside) continue;
        n_pressed++;
        assert_close(s.pressure[i], 0.5 * modulus, 1e-9 * modulus); /* places are rounded to 1e-14 of u */
        assert_close(s.force[2 * i + 1], 0.5 * modulus * spacing * plate, 1e-9 * modulus * spacing * plate);
    }
    assert_int_equal(n_pressed, 5);
}

/* Without friction each force is its pressure times the area, corners included, and what the blocks do to each other
 * sums up to nothing. */
TEST(forces_cancel_and_are_pressures_times_areas)
{
    CLEANUP(close_scene) scene s;
    open_scene(&s, 0.4 * thickness, 0.37 * spacing);
    double sum[2] = {0.0, 0.0}, lift = 0.0;
    const dem_index half = s.lattice.n_nodes / 2;
    CLEANUP(free_memory) dem_index *nodes = malloc((size_t)s.lattice.n_nodes * sizeof *nodes);
    CLEANUP(free_memory) double *area = malloc((size_t)s.lattice.n_nodes * sizeof *area);
    for (dem_index i = 0; i < s.lattice.n_nodes; i++) nodes[i] = i;
    assert_ok(dem_lattice_edge_shares(&s.lattice, nodes, s.lattice.n_nodes, NULL, area));
    for (dem_index i = 0; i < s.lattice.n_nodes; i++) {
        for (int c = 0; c < 2; c++) sum[c] += s.force[2 * i + c];
        assert_close(s.pressure[i] * area[i], hypot(s.force[2 * i], s.force[2 * i + 1]), 1e-9);
        if (i >= half) lift += s.force[2 * i + 1];
    }
    assert_true(lift > 100.0);
    assert_close(sum[0], 0.0, 1e-11 * lift);
    assert_close(sum[1], 0.0, 1e-11 * lift);
}

/* Whether a node is beside an edge and in front of it, nearer than the thickness. No corner is near a node here. */
static bool pushes(const scene *s, dem_index node, const dem_index *ends)
{
    const vec2 a = vec2_at(s->x, ends[0]), t = vec2_sub(vec2_at(s->x, ends[1]), a);
    const vec2 r = vec2_sub(vec2_at(s->x, node), a);
    const double along = vec2_dot(r, t) / vec2_dot(t, t), front = vec2_cross(r, t) / vec2_norm(t);
    return along >= 0.0 && along < 1.0 && front > 0.0 && front < thickness;
}

TEST(pairs_are_those_of_all_nodes_and_edges)
{
    CLEANUP(close_scene) scene s;
    CLEANUP(surface_load_free) surface_load load = {0};
    open_scene(&s, 0.4 * thickness, 0.37 * spacing);
    assert_ok(surface_load_list(&load, s.contact, s.x));
    const contact_surface *of = &s.contact->surface;
    dem_index n = 0;
    for (dem_index k = 0; k < of->n_nodes; k++)
        for (dem_index e = 0; e < of->surface.n_edges; e++) n += pushes(&s, of->nodes[k], &of->surface.ends[2 * e]);
    assert_int_equal(load.n, n);
    assert_int_equal(n, 12); /* of each face 7 nodes, one of them beyond the other face */
    for (dem_index k = 0; k < n; k++) {
        const dem_pair p = surface_load_pair(&load, k, of, s.x);
        const double up = p.body == 1 ? 1.0 : -1.0;
        assert_true(pushes(&s, p.node, p.edge));
        assert_int_equal(p.body, p.node >= s.lattice.n_nodes / 2);
        assert_int_equal(p.other_body, 1 - p.body);
        assert_close(p.gap, 0.4 * thickness, 1e-15); /* rounding of places */
        assert_close(p.thickness, thickness, 0.0);
        assert_close(p.normal[1], up, 1e-12);
        assert_close(p.x[0], s.x[2 * p.node], 1e-15);
        assert_close(p.x[1], s.x[2 * p.node + 1] - up * p.gap, 1e-15);
    }
}

/* The force of a node is that of its pairs less what its edges bear, so that all pairs of the upper block against the
 * lower one, and back, give what it feels. */
TEST(the_forces_of_all_pairs_are_those_of_the_bodies)
{
    CLEANUP(close_scene) scene s;
    CLEANUP(surface_load_free) surface_load load = {0};
    open_scene(&s, 0.4 * thickness, 0.37 * spacing);
    assert_ok(surface_load_list(&load, s.contact, s.x));
    double felt = 0.0, of_pairs = 0.0;
    for (dem_index i = s.lattice.n_nodes / 2; i < s.lattice.n_nodes; i++) felt += s.force[2 * i + 1];
    for (dem_index k = 0; k < load.n; k++) {
        const dem_pair p = surface_load_pair(&load, k, &s.contact->surface, s.x);
        of_pairs += p.body == 1 ? p.force[1] : -p.force[1];
    }
    assert_true(felt > 100.0);
    assert_close(of_pairs, felt, 1e-12 * felt);
}
