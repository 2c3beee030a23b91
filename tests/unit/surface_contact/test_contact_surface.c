/* SPDX-License-Identifier: BSD-3-Clause */
/* Surfaces that change while triangles break: contact_surface.c and all that stands on it, against what is made from
 * the start of the triangles that are left. */
#include "surface_contact/contact_surface.h"

#include "curves.h"
#include "evaluated.h"
#include "harness/cleanup_gsl.h"
#include "surface_contact/surface_contact.h"
#include "verification/support.h"

enum { STARS = 9, CORNERS = 24, TRIANGLES = STARS * CORNERS };

/* Stars side by side, with a random shift of all nodes, so that many surfaces are near each other. */
typedef struct scene {
    dem_lattice lattice;
    surface_contact *contact;
    double *x;
    unsigned char broken[TRIANGLES];
    dem_index whole[STARS]; /* triangles left of each */
} scene;

static void open_scene(scene *s, gsl_rng *rng, double friction)
{
    const surface_contact_rule rule = {.within_bodies = true, .stiffness = 1.0, .friction = friction};
    *s = (scene){.lattice = curves_make(rng, STARS, CORNERS, 2.1)};
    assert_ok(surface_contact_create(&s->contact, &s->lattice, &rule));
    s->x = curves_shift(rng, &s->lattice, 0.1);
    for (int b = 0; b < STARS; b++) s->whole[b] = CORNERS;
}

static void close_scene(scene *s)
{
    surface_contact_destroy(s->contact);
    dem_lattice_free(&s->lattice);
    free(s->x);
}

static void break_contact(scene *s, const unsigned char *broken)
{
    CLEANUP(mesh_boundary_free) mesh_boundary boundary;
    assert_ok(mesh_boundary_create(&boundary, &s->lattice, broken));
    assert_ok(surface_contact_break(s->contact, &boundary, NULL, NULL));
    surface_contact_keep(s->contact);
}

/* Breaks one triangle of a star that has others. */
static void break_one(scene *s, gsl_rng *rng)
{
    dem_index triangle;
    do triangle = (dem_index)gsl_rng_uniform_int(rng, TRIANGLES);
    while (s->broken[triangle] || s->whole[triangle / CORNERS] == 1);
    s->broken[triangle] = 1;
    s->whole[triangle / CORNERS]--;
    break_contact(s, s->broken);
}

/* The contact of the triangles that are left, which has no others; its bodies push as the whole ones do. */
typedef struct leftover {
    dem_lattice lattice;
    surface_contact *contact;
} leftover;

static void open_leftover(leftover *r, const scene *s)
{
    const surface_contact_rule rule = {.within_bodies = true, .thickness = 1e-9, .stiffness = 1.0};
    r->lattice = s->lattice;
    r->lattice.triangles = calloc(3 * TRIANGLES, sizeof *r->lattice.triangles);
    r->lattice.n_triangles = 0;
    for (dem_index k = 0; k < TRIANGLES; k++) {
        if (s->broken[k]) continue;
        dem_index *corners = &r->lattice.triangles[3 * r->lattice.n_triangles++];
        memcpy(corners, &s->lattice.triangles[3 * k], 3 * sizeof *corners);
    }
    assert_ok(surface_contact_create(&r->contact, &r->lattice, &rule));
    contact_surface *to = &r->contact->surface;
    const contact_surface *from = &s->contact->surface;
    memcpy(to->laws, from->laws, STARS * sizeof *to->laws);
    to->least = from->least;
    to->most = from->most;
}

static void close_leftover(leftover *r)
{
    surface_contact_destroy(r->contact);
    free(r->lattice.triangles);
}

static void check_surface(const contact_surface *found, const contact_surface *expected)
{
    const size_t n_edges = (size_t)expected->surface.n_edges, n_nodes = (size_t)expected->n_nodes;
    assert_int_equal(found->surface.n_edges, expected->surface.n_edges);
    assert_int_equal(found->n_nodes, expected->n_nodes);
    assert_memory_equal(found->surface.ends, expected->surface.ends, 2 * n_edges * sizeof(dem_index));
    assert_memory_equal(found->surface.previous, expected->surface.previous, n_edges * sizeof(dem_index));
    assert_memory_equal(found->nodes, expected->nodes, n_nodes * sizeof(dem_index));
    assert_memory_equal(found->half_length, expected->half_length, n_nodes * sizeof(double));
    assert_memory_equal(found->corner, expected->corner, n_edges * sizeof(dem_index));
    assert_memory_equal(found->length, expected->length, n_edges * sizeof(double));
    assert_memory_equal(found->plate, expected->plate, n_edges * sizeof(double));
}

/* Forces of all nodes and of each, and the energy. */
static void check_forces(surface_contact *found, surface_contact *expected, const double *x)
{
    assert_true(surface_contact_evaluate(found, x) && surface_contact_evaluate(expected, x));
    for (dem_index i = 0; i < found->surface.lattice->n_nodes; i++) {
        const vec2 all = evaluated_force(found, i), others = evaluated_force(expected, i);
        vec2 force;
        assert_true(surface_contact_force(found, i, x, &force) == surface_contact_acts(all));
        assert_true(force.x == all.x && force.y == all.y && all.x == others.x && all.y == others.y);
    }
    assert_true(surface_contact_energy(found, x) == surface_contact_energy(expected, x));
}

TEST(triangles_that_break_leave_the_surface_of_the_others)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(close_scene) scene s;
    dem_index n_pushed = 0;
    open_scene(&s, rng, 0.0);
    for (int k = 0; k < TRIANGLES - STARS; k++) {
        CLEANUP(close_leftover) leftover r;
        break_one(&s, rng);
        open_leftover(&r, &s);
        check_surface(&s.contact->surface, &r.contact->surface);
        check_forces(s.contact, r.contact, s.x);
        n_pushed += evaluated_pushed(s.contact);
    }
    assert_true(n_pushed > 8 * TRIANGLES);
}

/* As when a step with breaks is taken again. */
TEST(triangles_that_become_whole_again_have_their_surface_back)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(close_scene) scene s;
    CLEANUP(close_leftover) leftover r;
    open_scene(&s, rng, 0.0);
    open_leftover(&r, &s);
    for (int k = 0; k < 40; k++) break_one(&s, rng);
    assert_true(surface_contact_evaluate(s.contact, s.x));
    assert_true(s.contact->surface.n_nodes > r.contact->surface.n_nodes);
    break_contact(&s, NULL);
    check_surface(&s.contact->surface, &r.contact->surface);
    check_forces(s.contact, r.contact, s.x);
}

/* ---- friction ---- */

/* What pulls at a node stays as long as the same body pushes it. With that much friction nothing slides. */
TEST(friction_stays_as_long_as_its_body_pushes)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(close_scene) scene s;
    const anchor_set *anchors;
    open_scene(&s, rng, 1e9);
    anchors = &s.contact->anchors;
    assert_ok(surface_contact_settle(s.contact, s.x));
    for (dem_index k = 0; k < 2 * s.lattice.n_nodes; k++) s.x[k] += 0.001 * (gsl_rng_uniform(rng) - 0.5);
    assert_ok(surface_contact_settle(s.contact, s.x));
    const dem_index n_first = anchors->now.n;
    int n_stayed = 0;
    assert_true(n_first > 10);
    while (anchors->now.n > 2) {
        const dem_index n = anchors->now.n;
        CLEANUP(free_memory) anchor *before = malloc((size_t)n * sizeof *before);
        memcpy(before, anchors->now.at, (size_t)n * sizeof *before);
        break_one(&s, rng);
        assert_ok(surface_contact_settle(s.contact, s.x));
        for (dem_index m = 0; m < n; m++) {
            const dem_index k = anchors->of[before[m].node];
            if (k < 0 || anchors->now.at[k].body != before[m].body) continue;
            assert_true(anchors->now.at[k].force == before[m].force);
            n_stayed += before[m].force != 0.0;
        }
    }
    assert_true(n_stayed > 8);
}
