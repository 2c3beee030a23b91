/* SPDX-License-Identifier: BSD-3-Clause */
/* near_contact.c: what is near by the gaps and speeds of a state, against heights over a floor, and when parts are made
 * anew for it. */
#include "contact/near_contact.h"
#include "unit/simulation/runs.h"

static const double fall[2] = {0.0, -4.0};

/* Two blocks, one on top of the other with a gap, over a floor; both come down. */
typedef struct blocks {
    dem_lattice lattice;
    dem_model *model;
    dem_options options;
    near_contact near;
    double edge; /* m, the longest one of a surface as it counts */
} blocks;

enum { N_STEPS = 100 };

static const double step = 1e-5; /* s */

static void open_blocks(blocks *b, double height, double gap, dem_bodies touching)
{
    const dem_material rubber =
        SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0, .thickness = 1.0);
    const dem_obstacle plane = SIZED(dem_obstacle, .n_points = 2, .points = floor_points, .restitution = 1.0);
    *b = (blocks){.lattice = support_rectangle(0.1, 0.08, spacing, &rubber), .options = dem_options_default()};
    CLEANUP(dem_lattice_free) dem_lattice upper = support_rectangle(0.1, 0.08, spacing, &rubber);
    const double up = height - support_bottom(&b->lattice);
    dem_lattice_move(&b->lattice, 0.0, (const double[2]){0.0, up});
    dem_lattice_move(&upper, 0.0, (const double[2]){0.0, up + 0.08 + gap});
    assert_ok(dem_lattice_append(&b->lattice, &upper));
    assert_ok(dem_lattice_launch(&b->lattice, fall));
    b->model = support_model(&b->lattice, &plane, 1);
    b->options.checkpoint_steps = N_STEPS;
    b->options.max_step = step;
    b->options.bodies = touching;
    b->edge = 1.25 * spacing;
    assert_ok(near_contact_create(&b->near, b->model, &b->options));
}

static void close_blocks(blocks *b)
{
    near_contact_free(&b->near);
    dem_model_destroy(b->model);
    dem_lattice_free(&b->lattice);
}

/* The state with all nodes higher by so much. */
static void look(blocks *b, double higher)
{
    const dem_lattice *l = &b->model->lattice;
    CLEANUP(free_memory) double *x = malloc(2 * (size_t)l->n_nodes * sizeof *x);
    for (dem_index k = 0; k < 2 * l->n_nodes; k++) x[k] = l->position[k] + (k % 2 == 1 ? higher : 0.0);
    near_contact_look(&b->near, &(near_contact_state){0.0, x, l->velocity});
}

static bool may_touch(const blocks *b, dem_index i)
{
    return b->model->lattice.flags[i] & DEM_NODE_CONTACT;
}

/* \param n_edges  how many may lie between what touches and what that concerns */
static void assert_near(const blocks *b, int n_edges)
{
    const unsigned char *is_near = near_contact_nodes(&b->near);
    const double reach = 1.25 * N_STEPS * step * 4.0 + n_edges * b->edge;
    dem_index n = 0;
    for (dem_index i = 0; i < b->model->lattice.n_nodes; i++) {
        assert_int_equal(is_near[i] != 0, may_touch(b, i) && b->model->lattice.position[2 * i + 1] <= reach);
        n += is_near[i] != 0;
    }
    assert_int_equal(b->near.n_near, n);
}

TEST(what_can_get_to_an_obstacle_before_the_next_checkpoint_is_near)
{
    CLEANUP(close_blocks) blocks b;
    open_blocks(&b, 0.01, 0.01, DEM_BODIES_NONE);
    assert_null(near_contact_nodes(&b.near));
    look(&b, 0.0);
    near_contact_take(&b.near, 0.0, 0.0);
    assert_near(&b, 2);
    assert_true(b.near.n_near >= 11 && b.near.n_near < 30); /* the lower side, and somewhat more */
}

/* As far as four rings may go from there, over to the other body as well. */
TEST(surfaces_beside_what_is_near_are_near_where_bodies_touch)
{
    CLEANUP(close_blocks) blocks b;
    open_blocks(&b, 0.01, 0.001, DEM_BODIES_OTHERS);
    look(&b, 0.0);
    near_contact_take(&b.near, 0.0, 0.0);
    assert_near(&b, 8);
    dem_index n_upper = 0;
    for (dem_index i = 0; i < b.model->lattice.n_nodes; i++)
        n_upper += b.model->lattice.body[i] == 1 && near_contact_nodes(&b.near)[i];
    assert_true(n_upper >= 10);
}

TEST(parts_are_made_anew_before_what_is_not_near_can_touch)
{
    CLEANUP(close_blocks) blocks b;
    open_blocks(&b, 0.03, 0.01, DEM_BODIES_NONE);
    look(&b, 0.05);
    assert_true(near_contact_is_outdated(&b.near, 0.0, 0.0)); /* so far all are near */
    near_contact_take(&b.near, 0.0, 0.0);
    assert_int_equal(b.near.n_near, 0);
    look(&b, 0.01);
    assert_false(near_contact_is_outdated(&b.near, 0.0, 0.0));
    look(&b, 0.0);
    assert_true(near_contact_is_outdated(&b.near, 0.0, 0.0));
    near_contact_take(&b.near, 0.0, 0.0);
    assert_true(b.near.n_near >= 11);
    assert_false(near_contact_is_outdated(&b.near, 0.0, 0.0));
}

/* As soon as that has paid: work for twenty times the price. */
TEST(parts_are_made_anew_when_little_is_near_any_more)
{
    CLEANUP(close_blocks) blocks b;
    open_blocks(&b, 0.01, 0.01, DEM_BODIES_NONE);
    look(&b, 0.0);
    near_contact_take(&b.near, 0.0, 0.0);
    look(&b, 0.1);
    assert_false(near_contact_is_outdated(&b.near, 19.0, 1.0));
    assert_true(near_contact_is_outdated(&b.near, 21.0, 1.0));
}

TEST(looks_reach_farther_where_parts_have_been_made_too_soon)
{
    CLEANUP(close_blocks) blocks b;
    open_blocks(&b, 0.03, 0.01, DEM_BODIES_NONE);
    look(&b, 0.0);
    near_contact_take(&b.near, 0.0, 1.0); /* for the first time */
    assert_true(b.near.n_windows == 1.0);
    near_contact_take(&b.near, 21.0, 1.0);
    assert_true(b.near.n_windows == 1.0);
    near_contact_take(&b.near, 19.0, 1.0);
    assert_true(b.near.n_windows == 2.0);
    near_contact_take(&b.near, 5.0, 1.0);
    assert_true(b.near.n_windows == 8.0);
    near_contact_take(&b.near, 0.0, 1.0);
    assert_true(b.near.n_windows == 64.0);
    near_contact_take_all(&b.near);
    assert_true(b.near.n_windows == 128.0 && near_contact_nodes(&b.near) == NULL);
    look(&b, 0.05);
    assert_true(near_contact_is_outdated(&b.near, 0.0, 1.0));
    near_contact_take(&b.near, 0.0, 1.0);
    assert_true(b.near.n_windows == 128.0 && near_contact_nodes(&b.near) != NULL);
}

/* All that may touch is near without obstacles or checkpoints, or where the whole body stops at an event. */
TEST(it_is_not_asked_where_that_is_of_no_use)
{
    for (int way = 0; way < 2; way++) {
        CLEANUP(close_blocks) blocks b;
        near_contact near;
        open_blocks(&b, 0.03, 0.01, DEM_BODIES_NONE);
        if (way == 0) b.options.checkpoint_steps = 0;
        if (way == 1) b.options.contact = DEM_CONTACT_EXACT;
        assert_ok(near_contact_create(&near, b.model, &b.options));
        near_contact_look(&near, NULL);
        near_contact_take(&near, 0.0, 0.0);
        assert_false(near_contact_is_outdated(&near, 0.0, 0.0));
        assert_null(near_contact_nodes(&near));
        near_contact_free(&near);
    }
}

int main(void)
{
    return test_run();
}
