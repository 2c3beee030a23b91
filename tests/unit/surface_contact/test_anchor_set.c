/* SPDX-License-Identifier: BSD-3-Clause */
/* anchor_set.c, and what surface_contact.c makes of it: forces of all nodes against the gradient of the energy and
 * against those of single nodes, who is a neighbour, where anchors go, what a record may have. */
#include "surface_contact/surface_load.h"

#include <string.h>

#include "curves.h"
#include "evaluated.h"
#include "harness/cleanup_gsl.h"
#include "harness/message.h"
#include "verification/support.h"

typedef struct scene {
    dem_lattice lattice;
    surface_contact *contact;
    double *x;
} scene;

/* Stars side by side with a random shift of all nodes, whose anchors are where they are put first; then the nodes are
 * moved a little, so that the springs pull. */
static void open_scene(scene *s, gsl_rng *rng, double friction)
{
    const surface_contact_rule rule = {.within_bodies = true, .stiffness = 1.0, .friction = friction};
    *s = (scene){.lattice = curves_make(rng, 9, 24, 2.1)};
    assert_ok(surface_contact_create(&s->contact, &s->lattice, &rule));
    s->x = curves_shift(rng, &s->lattice, 0.1);
    assert_ok(surface_contact_settle(s->contact, s->x));
    for (dem_index k = 0; k < 2 * s->lattice.n_nodes; k++) s->x[k] += 0.001 * (gsl_rng_uniform(rng) - 0.5);
}

static void close_scene(scene *s)
{
    surface_contact_destroy(s->contact);
    dem_lattice_free(&s->lattice);
    free(s->x);
}

/* Some springs hold and some slide. The power is that of the forces. */
TEST(single_nodes_have_the_bits_of_all_and_no_force_or_moment_is_left)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(close_scene) scene s;
    open_scene(&s, rng, 0.05);
    CLEANUP(free_memory) double *v = malloc(2 * (size_t)s.lattice.n_nodes * sizeof *v);
    vec2 sum = {0.0, 0.0};
    double moment = 0.0, power = 0.0, size = 0.0;
    assert_true(surface_contact_evaluate(s.contact, s.x));
    for (dem_index i = 0; i < s.lattice.n_nodes; i++) {
        vec2 force;
        vec2_put(v, i, (vec2){gsl_rng_uniform(rng), gsl_rng_uniform(rng)});
        const bool pushed = surface_contact_has(s.contact, i) && surface_contact_force(s.contact, i, s.x, &force);
        const vec2 expected = evaluated_force(s.contact, i);
        assert_true(pushed == surface_contact_acts(expected));
        if (!pushed) continue;
        assert_memory_equal(&force, &expected, sizeof force);
        const vec2 friction = surface_contact_friction(s.contact, i, s.x);
        power -= vec2_dot(friction, vec2_at(v, i));
        sum = vec2_add(sum, friction);
        moment += vec2_cross(vec2_at(s.x, i), friction);
        size += vec2_norm(friction);
    }
    assert_true(size > 0.0);
    assert_close(vec2_norm(sum), 0.0, 1e-14 * size);
    assert_close(moment, 0.0, 1e-13 * size); /* at places of up to 5 m */
    assert_close(surface_contact_friction_power(s.contact, s.x, v), power, 1e-14 * size);
    assert_close(surface_contact_evaluated_power(s.contact, v), power, 1e-14 * size);
}

static bool is_neighbour(const surface_contact *c, dem_index i, dem_index j)
{
    dem_index node;
    for (surface_neighbours n = surface_contact_neighbours(c, i); surface_contact_next_neighbour(&n, &node);)
        if (node == j) return true;
    return false;
}

/* A local correction relies on both directions. */
TEST(the_force_on_a_node_depends_on_its_neighbours_alone)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(close_scene) scene s;
    open_scene(&s, rng, 0.05);
    assert_true(surface_contact_evaluate(s.contact, s.x));
    const dem_index n = s.lattice.n_nodes;
    int n_changed = 0;
    for (dem_index j = 0; j < n; j++) {
        const vec2 here = vec2_at(s.x, j);
        for (dem_index i = 0; i < n; i++) {
            vec2 before = {0.0, 0.0}, after = {0.0, 0.0};
            if (!surface_contact_has(s.contact, i)) continue;
            (void)surface_contact_force(s.contact, i, s.x, &before);
            vec2_put(s.x, j, vec2_add(here, (vec2){1e-4, -2e-4}));
            (void)surface_contact_force(s.contact, i, s.x, &after);
            vec2_put(s.x, j, here);
            if (before.x == after.x && before.y == after.y) continue;
            n_changed++;
            assert_true(is_neighbour(s.contact, i, j) && is_neighbour(s.contact, j, i));
        }
    }
    assert_true(n_changed > 60);
}

/* ---- the spring ---- */

/* Stars whose springs pull in the state that a step has reached; friction has no limit. */
static void open_stretched(scene *s, gsl_rng *rng)
{
    open_scene(s, rng, 1e9);
    assert_ok(surface_contact_settle(s->contact, s->x));
    assert_true(surface_contact_stored(s->contact, s->x) > 0.0);
}

/* After the last step. Differences of fourth order leave out h^4 times fifth derivatives, and have the rounding of the
 * energy over h. */
TEST(friction_that_holds_is_minus_the_gradient_of_its_energy)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(close_scene) scene s;
    open_stretched(&s, rng);
    double size = 0.0, off = 0.0;
    for (dem_index c = 0; c < 2 * s.lattice.n_nodes; c++) {
        const double h = 2e-6, here = s.x[c], steps[4] = {h, -h, 2.0 * h, -2.0 * h};
        const vec2 force = surface_contact_friction(s.contact, c / 2, s.x);
        const double found = c % 2 == 0 ? force.x : force.y;
        double energy[4];
        if (!surface_contact_has(s.contact, c / 2)) continue;
        for (int k = 0; k < 4; k++) {
            s.x[c] = here + steps[k];
            energy[k] = surface_contact_stored(s.contact, s.x);
        }
        s.x[c] = here;
        size = fmax(size, fabs(found));
        off = fmax(off, fabs(found + (8.0 * (energy[0] - energy[1]) - (energy[2] - energy[3])) / (12.0 * h)));
    }
    assert_true(size > 0.0 && off < 1e-7 * size);
}

/* Far from where the step began. The forces turn with it, to the rounding of places of up to 5 m and ways of 1 mm. */
TEST(a_rotation_of_everything_stretches_nothing)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(close_scene) scene s;
    open_stretched(&s, rng);
    const double stored = surface_contact_stored(s.contact, s.x), angle = 0.7, cosine = cos(angle), sine = sin(angle);
    const dem_index n = s.lattice.n_nodes;
    CLEANUP(free_memory) double *before = malloc(2 * (size_t)n * sizeof *before);
    double size = 0.0;
    for (dem_index i = 0; i < n; i++) vec2_put(before, i, surface_contact_friction(s.contact, i, s.x));
    for (dem_index i = 0; i < n; i++) {
        const vec2 x = vec2_at(s.x, i);
        size = fmax(size, vec2_norm(vec2_at(before, i)));
        vec2_put(s.x, i, (vec2){3.0 + cosine * x.x - sine * x.y, sine * x.x + cosine * x.y});
    }
    assert_ok(surface_contact_follow(s.contact, s.x));
    assert_close(surface_contact_stored(s.contact, s.x), stored, 1e-9 * stored);
    for (dem_index i = 0; i < n; i++) {
        const vec2 f = vec2_at(before, i), expected = {cosine * f.x - sine * f.y, sine * f.x + cosine * f.y};
        const vec2 found = surface_contact_friction(s.contact, i, s.x);
        assert_close(vec2_norm(vec2_sub(found, expected)), 0.0, 1e-9 * size);
    }
}

static void add_bound(void *to, dem_index node, double stiffness)
{
    double *bound = to;
    bound[node] += stiffness;
}

/* The energy of a motion h u is h^2 k (g.u)^2/2 where nothing has been stretched; the bound is that of k (g.u)^2. */
TEST(the_stiffness_is_bounded)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(close_scene) scene s;
    open_scene(&s, rng, 1e9);
    anchor_set_clear(&s.contact->anchors);
    assert_ok(surface_contact_settle(s.contact, s.x));
    const dem_index n = s.lattice.n_nodes;
    CLEANUP(free_memory) double *bound = calloc((size_t)n, sizeof *bound);
    CLEANUP(free_memory) double *x = malloc(2 * (size_t)n * sizeof *x);
    anchor_set_add_stiffness(&s.contact->anchors, add_bound, bound);
    double most = 0.0;
    for (int k = 0; k < 200; k++) {
        const double h = 1e-6;
        double sum = 0.0;
        for (dem_index i = 0; i < n; i++) {
            const vec2 u = {gsl_rng_uniform(rng) - 0.5, gsl_rng_uniform(rng) - 0.5};
            vec2_put(x, i, vec2_along(vec2_at(s.x, i), h, u));
            sum += bound[i] * vec2_dot(u, u);
        }
        most = fmax(most, 2.0 * surface_contact_stored(s.contact, x) / (h * h) / sum);
    }
    assert_true(most > 0.05 && most < 1.0);
}

/* ---- where anchors go ---- */

static const dem_material rubber =
    SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0, .thickness = 1.0);

/* A scene of a lattice, in its places. */
static void open_lattice(scene *s, double friction)
{
    const surface_contact_rule rule = {.stiffness = 1.0, .friction = friction};
    s->lattice.flags = calloc((size_t)s->lattice.n_nodes, 1);
    assert_ok(surface_contact_create(&s->contact, &s->lattice, &rule));
    s->x = malloc(2 * (size_t)s->lattice.n_nodes * sizeof *s->x);
    memcpy(s->x, s->lattice.x, 2 * (size_t)s->lattice.n_nodes * sizeof *s->x);
}

/* Two squares of 30 mm with nodes 5 mm apart, the upper one 0.9 mm above the lower one: 0.9 of the thickness. */
static void open_squares(scene *s, double friction)
{
    *s = (scene){.lattice = support_rectangle(0.03, 0.03, 5e-3, &rubber)};
    CLEANUP(dem_lattice_free) dem_lattice upper = support_rectangle(0.03, 0.03, 5e-3, &rubber);
    const double height = support_top(&upper) - support_bottom(&upper);
    dem_lattice_move(&upper, 0.0, (const double[2]){1e-3, height + 9e-4});
    assert_ok(dem_lattice_append(&s->lattice, &upper));
    open_lattice(s, friction);
}

static void shift_upper(scene *s, double dx, double dy)
{
    for (dem_index i = 0; i < s->lattice.n_nodes; i++)
        if (s->lattice.body[i] == 1) vec2_put(s->x, i, vec2_add(vec2_at(s->x, i), (vec2){dx, dy}));
}

/* The force of friction on the upper square along x, N. */
static double pull_on_upper(const scene *s)
{
    double sum = 0.0;
    for (dem_index i = 0; i < s->lattice.n_nodes; i++)
        if (s->lattice.body[i] == 1) sum += surface_contact_friction(s->contact, i, s->x).x;
    return sum;
}

static void settle(scene *s)
{
    assert_ok(surface_contact_settle(s->contact, s->x));
}

TEST(anchors_hold_where_they_are_and_slide_at_the_limit)
{
    CLEANUP(close_scene) scene s;
    open_squares(&s, 0.5);
    settle(&s);
    assert_true(s.contact->anchors.now.n >= 6);
    assert_close(pull_on_upper(&s), 0.0, 1e-9); /* the rounding of places, of forces of some hundred N */
    shift_upper(&s, 1e-6, 0.0);
    const double held = pull_on_upper(&s);
    assert_true(held < 0.0);
    for (int k = 0; k < 1000; k++) settle(&s);
    assert_close(pull_on_upper(&s), held, 1e-12 * fabs(held)); /* no creep */
    shift_upper(&s, 4e-4, 0.0);
    const double most = pull_on_upper(&s), stored = surface_contact_stored(s.contact, s.x);
    settle(&s);
    assert_close(pull_on_upper(&s), most, 1e-12 * fabs(most));                    /* sliding changes neither force */
    assert_close(surface_contact_stored(s.contact, s.x), stored, 1e-12 * stored); /* nor energy */
    shift_upper(&s, -1e-6, 0.0);
    assert_true(fabs(pull_on_upper(&s)) < fabs(most)); /* it begins to come back at once */
}

/* Nodes pass the ends of edges and turn round corners: their forces and what they store stay. */
TEST(what_a_step_has_reached_changes_no_force)
{
    CLEANUP(close_scene) scene s;
    open_squares(&s, 0.5);
    settle(&s);
    for (int k = 0; k < 40; k++) {
        shift_upper(&s, 2e-4, 0.0);
        const double stored = surface_contact_stored(s.contact, s.x), pull = pull_on_upper(&s);
        settle(&s);
        assert_close(surface_contact_stored(s.contact, s.x), stored, 1e-12 * stored);
        assert_close(pull_on_upper(&s), pull, 1e-12 * fabs(pull));
    }
}

/* Work of friction on nodes that go from x0 to x1 along straight lines, by Simpson's rule: minus what it takes, J. */
static double work_between(const scene *s, const double *x0, const double *x1, double *x)
{
    static const double weights[5] = {1.0 / 12.0, 1.0 / 3.0, 1.0 / 6.0, 1.0 / 3.0, 1.0 / 12.0};
    double sum = 0.0;
    for (int q = 0; q < 5; q++) {
        for (dem_index c = 0; c < 2 * s->lattice.n_nodes; c++) x[c] = x0[c] + 0.25 * q * (x1[c] - x0[c]);
        for (dem_index i = 0; i < s->lattice.n_nodes; i++)
            sum += weights[q] *
                   vec2_dot(surface_contact_friction(s->contact, i, x), vec2_sub(vec2_at(x1, i), vec2_at(x0, i)));
    }
    return sum;
}

/* What friction takes in n steps, less what it has stored, over that. The nodes of the upper square pass ends of edges
 * of the lower one, all go round an arc and turn, and nothing slides or opens. */
static double left_over(int n)
{
    CLEANUP(close_scene) scene s;
    open_squares(&s, 1e9);
    const size_t size = 2 * (size_t)s.lattice.n_nodes * sizeof *s.x;
    CLEANUP(free_memory) double *start = malloc(size);
    CLEANUP(free_memory) double *next = malloc(size);
    CLEANUP(free_memory) double *x = malloc(size);
    double work = 0.0;
    shift_upper(&s, -5e-4, -3e-4);
    memcpy(start, s.x, size);
    memcpy(next, s.x, size);
    settle(&s);
    for (int k = 1; k <= n; k++) {
        const double part = (double)k / n, angle = 2e-3 * sin(6.0 * part);
        for (dem_index i = 0; i < s.lattice.n_nodes; i++) {
            const vec2 from = vec2_at(start, i);
            if (s.lattice.body[i] == 1)
                vec2_put(next, i,
                         (vec2){from.x - 1e-3 * part - angle * from.y,
                                from.y + angle * (from.x - 0.015) - 2e-4 * sin(3.0 * part)});
        }
        work -= work_between(&s, s.x, next, x);
        memcpy(s.x, next, size);
        settle(&s);
    }
    const double stored = surface_contact_stored(s.contact, s.x);
    return (work - stored) / stored;
}

/* The trapezoidal rule of the way is of second order. */
TEST(what_friction_takes_without_sliding_it_stores)
{
    const double coarse = left_over(200), fine = left_over(400);
    assert_true(fabs(coarse) < 1e-9 && fabs(fine) < 0.3 * fabs(coarse));
}

/* The node that is farthest along x, by a direction of 1 or -1. */
static vec2 farthest(const dem_lattice *l, double direction)
{
    dem_index out = 0;
    for (dem_index i = 1; i < l->n_nodes; i++)
        if (direction * l->x[2 * i] > direction * l->x[2 * out]) out = i;
    return vec2_at(l->x, out);
}

/* Two rectangles as one body, 1.2 mm apart, and in the middle of the slot the corner of a square, 1 mm deep. */
static void open_slot(scene *s)
{
    *s = (scene){.lattice = support_rectangle(0.03, 0.026, 5e-3, &rubber)};
    CLEANUP(dem_lattice_free) dem_lattice upper = support_rectangle(0.03, 0.026, 5e-3, &rubber);
    CLEANUP(dem_lattice_free) dem_lattice square = support_rectangle(0.03, 0.03, 5e-3, &rubber);
    dem_lattice_move(&upper, 0.0, (const double[2]){0.0, support_top(&upper) - support_bottom(&upper) + 1.2e-3});
    dem_lattice_move(&square, 45.0, (const double[2]){0.0, 0.0});
    const vec2 corner = farthest(&square, 1.0);
    const vec2 to = {farthest(&upper, -1.0).x + 1e-3, 0.5 * (support_top(&s->lattice) + support_bottom(&upper))};
    dem_lattice_move(&square, 0.0, (const double[2]){to.x - corner.x, to.y - corner.y});
    assert_ok(dem_lattice_append(&s->lattice, &upper));
    for (dem_index i = 0; i < s->lattice.n_nodes; i++) s->lattice.body[i] = 0;
    assert_ok(dem_lattice_append(&s->lattice, &square));
    open_lattice(s, 0.5);
}

/* The largest change of friction of a node, N, while the corner goes in n steps from below the middle of the slot to
 * above, with a spring that has been stretched along it. */
static double largest_change(int n)
{
    CLEANUP(close_scene) scene s;
    open_slot(&s);
    CLEANUP(free_memory) double *before = calloc(2 * (size_t)s.lattice.n_nodes, sizeof *before);
    double most = 0.0;
    shift_upper(&s, 0.0, -1e-4);
    settle(&s);
    shift_upper(&s, 5e-5, 0.0);
    for (int k = 0; k <= n; k++) {
        for (dem_index i = 0; i < s.lattice.n_nodes; i++) {
            const vec2 friction = surface_contact_friction(s.contact, i, s.x);
            if (k > 0) most = fmax(most, vec2_norm(vec2_sub(friction, vec2_at(before, i))));
            vec2_put(before, i, friction);
        }
        shift_upper(&s, 0.0, 2e-4 / n);
    }
    return most;
}

/* There what pushes the corner from below cancels what pushes it from above. */
TEST(friction_does_not_jump_where_pushes_cancel)
{
    const double coarse = largest_change(100), fine = largest_change(400);
    assert_true(coarse > 0.0 && fine < 0.3 * coarse);
}

TEST(anchors_go_when_nothing_pushes)
{
    CLEANUP(close_scene) scene s;
    open_squares(&s, 0.5);
    settle(&s);
    shift_upper(&s, 0.0, 2e-3);
    assert_close(pull_on_upper(&s), 0.0, 0.0);
    settle(&s);
    assert_int_equal(s.contact->anchors.now.n, 0);
}

/* The friction of all pairs of the upper square with the lower one, and of the opposite of the others, pulls it. */
TEST(pairs_say_how_much_friction_they_have_and_whether_they_slide)
{
    CLEANUP(close_scene) scene s;
    open_squares(&s, 0.5);
    settle(&s);
    for (int k = 0; k < 2; k++) {
        CLEANUP(surface_load_free) surface_load load = {0};
        double sum = 0.0;
        shift_upper(&s, k == 0 ? 1e-6 : 4e-4, 0.0);
        assert_ok(surface_load_list(&load, s.contact, s.x));
        assert_true(load.n > 6);
        for (dem_index j = 0; j < load.n; j++) {
            const dem_pair p = surface_load_pair(&load, j, &s.contact->surface, s.x);
            const double most = 0.5 * hypot(p.force[0], p.force[1]), size = hypot(p.friction[0], p.friction[1]);
            sum += p.body == 1 ? p.friction[0] : -p.friction[0];
            assert_int_equal(p.slides, k);
            assert_true(k == 0 ? size < 0.5 * most : fabs(size - most) <= 1e-14 * most);
            assert_close(p.friction[0] * p.force[0] + p.friction[1] * p.force[1], 0.0, 1e-14 * most * most);
        }
        assert_close(sum, pull_on_upper(&s), 1e-12 * fabs(sum));
    }
}

TEST(two_bodies_have_the_smaller_friction)
{
    CLEANUP(close_scene) scene s;
    open_squares(&s, 0.5);
    contact_surface_set_friction(&s.contact->surface, 0.5, (const double[2]){0.5, 0.25});
    settle(&s);
    assert_true(s.contact->anchors.now.n > 0);
    assert_close(s.contact->anchors.now.at[0].friction, 0.25, 0.0);
    contact_surface_set_friction(&s.contact->surface, 0.5, (const double[2]){0.0, 0.25});
    anchor_set_clear(&s.contact->anchors);
    settle(&s);
    assert_int_equal(s.contact->anchors.now.n, 0);
}

/* ---- records ---- */

typedef struct records {
    anchor_record *list;
    dem_index n;
} records;

static records take_records(const anchor_set *s)
{
    const records out = {malloc((size_t)s->now.n * sizeof *out.list), s->now.n};
    for (dem_index k = 0; k < out.n; k++) out.list[k] = anchor_set_record(s, k);
    return out;
}

static void free_records(records *r)
{
    free(r->list);
}

/* Pulls the upper square aside, so that something is remembered. */
static void open_pulled(scene *s)
{
    open_squares(s, 0.5);
    settle(s);
    shift_upper(s, 3e-5, 0.0);
    settle(s);
}

TEST(records_bring_back_every_bit)
{
    CLEANUP(close_scene) scene s;
    open_pulled(&s);
    anchor_set *anchors = &s.contact->anchors;
    CLEANUP(free_records) records saved = take_records(anchors);
    CLEANUP(free_memory) anchor *before = malloc((size_t)saved.n * sizeof *before);
    memcpy(before, anchors->now.at, (size_t)saved.n * sizeof *before);
    anchor_set_clear(anchors);
    assert_ok(surface_contact_restore(s.contact, saved.list, saved.n, s.x));
    assert_int_equal(anchors->now.n, saved.n);
    assert_true(fabs(before[0].force) > 1.0);
    assert_memory_equal(anchors->now.at, before, (size_t)saved.n * sizeof *before);
    const double pull = pull_on_upper(&s);
    shift_upper(&s, 1e-6, 0.0);
    assert_true(fabs(pull_on_upper(&s)) > fabs(pull));
}

/* Changes one record, and has it refused. */
#define REFUSE(k, member, value)                                                                                       \
    do {                                                                                                               \
        CLEANUP(free_records) records changed = take_records(anchors);                                                 \
        changed.list[k].member = (value);                                                                              \
        assert_int_equal(surface_contact_restore(s.contact, changed.list, changed.n, s.x), DEM_ERROR_IO);              \
        assert_message_parts("the checkpoint has an impossible friction: * N at node * by body ");                     \
        assert_ok(surface_contact_restore(s.contact, saved.list, saved.n, s.x));                                       \
    } while (0)

TEST(records_are_checked)
{
    CLEANUP(close_scene) scene s;
    open_pulled(&s);
    anchor_set *anchors = &s.contact->anchors;
    CLEANUP(free_records) records saved = take_records(anchors);
    REFUSE(0, node, saved.list[1].node + 1);
    REFUSE(1, node, saved.list[0].node);
    REFUSE(0, node, -1);
    REFUSE(1, node, s.lattice.n_nodes);
    REFUSE(0, node, saved.list[0].node - 1); /* nothing pushes this one */
    REFUSE(1, body, -1);
    REFUSE(1, body, saved.list[1].body ^ 1); /* the body of the node */
    REFUSE(0, force, (double)NAN);
    REFUSE(0, force, (double)INFINITY);
    assert_int_equal(surface_contact_restore(s.contact, saved.list, saved.n - 1, s.x), DEM_ERROR_IO);
    assert_message_parts("the checkpoint has friction at * nodes, but * are pushed");
}
