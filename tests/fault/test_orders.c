/* SPDX-License-Identifier: BSD-3-Clause */
/* One rank of several, which are threads, cannot carry out its part of an order about a field (base/field_order.h): the
 * frame fails on rank 0, with its status and message, and none waits for another. The linker wraps the functions that
 * fail. */
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

#include <dem/trajectory.h>

#include "base/field_order.h"
#include "base/status.h"
#include "simulation/led_run.h"
#include "unit/scratch.h"
#include "verification/rank_runs.h"
#include "verification/support.h"

enum { N_RANKS = 3, TEXT = 256 };

/* ---- functions that fail ---- */

typedef enum failing { BEGIN, MAKE, TAKE, END, N_FAILING } failing;

static atomic_bool fails[N_FAILING];

static dem_status lack(failing which)
{
    return atomic_load(&fails[which]) ? status_fail(DEM_ERROR_MEMORY, "out of memory for order %d", (int)which)
                                      : DEM_OK;
}

dem_status __real_field_order_begin(const field_order *o, int stripe, int n_shares);
dem_status __wrap_field_order_begin(const field_order *o, int stripe, int n_shares);
dem_status __real_field_order_make(const field_order *o, const void *rows, field_portion *portion);
dem_status __wrap_field_order_make(const field_order *o, const void *rows, field_portion *portion);
dem_status __real_field_order_take(const field_order *o, const field_portion *portion);
dem_status __wrap_field_order_take(const field_order *o, const field_portion *portion);
dem_status __real_field_order_end(const field_order *o, int stripe);
dem_status __wrap_field_order_end(const field_order *o, int stripe);

dem_status __wrap_field_order_begin(const field_order *o, int stripe, int n_shares)
{
    const dem_status status = lack(BEGIN);
    return status == DEM_OK ? __real_field_order_begin(o, stripe, n_shares) : status;
}

dem_status __wrap_field_order_make(const field_order *o, const void *rows, field_portion *portion)
{
    const dem_status status = lack(MAKE);
    return status == DEM_OK ? __real_field_order_make(o, rows, portion) : status;
}

dem_status __wrap_field_order_take(const field_order *o, const field_portion *portion)
{
    const dem_status status = lack(TAKE);
    return status == DEM_OK ? __real_field_order_take(o, portion) : status;
}

dem_status __wrap_field_order_end(const field_order *o, int stripe)
{
    const dem_status status = lack(END);
    return status == DEM_OK ? __real_field_order_end(o, stripe) : status;
}

/* ---- runs ---- */

typedef struct written {
    const dem_model *model;
    const char *path;
    int writers;
    dem_status status;
    char message[TEXT];
} written;

static dem_status write_frames(dem_simulation *s, const written *w)
{
    dem_trajectory *t = NULL;
    dem_observer observer = {.struct_size = sizeof observer};
    dem_trajectory_options options = dem_trajectory_options_default();
    options.frame_interval = 1e-4;
    options.writers = w->writers;
    dem_status status = dem_trajectory_create(&t, w->path, s, &options);
    if (status == DEM_OK) status = dem_trajectory_observer(t, &observer);
    if (status == DEM_OK) status = dem_simulation_observe(s, &observer);
    if (status == DEM_OK) status = dem_simulation_advance(s, 2e-4);
    dem_trajectory_destroy(t);
    return status;
}

static void write_as_leader(const ranks *r, void *context)
{
    written *w = context;
    const dem_options options = dem_options_default();
    dem_simulation *s = NULL;
    w->status = dem_simulation_create(&s, w->model, &options);
    if (w->status == DEM_OK) w->status = dem_private_lead(s, r, &options, NULL);
    if (w->status == DEM_OK) w->status = write_frames(s, w);
    if (w->status != DEM_OK) (void)snprintf(w->message, TEXT, "%s", dem_status_message());
    dem_simulation_destroy(s);
}

static written run(const dem_model *model, int writers)
{
    static const char *const others[] = {"led.part.vtkhdf", "led.obstacle.vtkhdf", "led.body.vtkhdf"};
    scratch_folder folder;
    folder_open(&folder);
    written w = {.model = model, .path = folder_file(&folder, "led.vtkhdf"), .writers = writers};
    (void)folder_file(&folder, "led.00001.1of2.h5");
    (void)folder_file(&folder, "led.00001.2of2.h5");
    for (int k = 0; k < 3; k++) (void)folder_file(&folder, others[k]);
    rank_runs_lead(N_RANKS, NULL, write_as_leader, &w);
    folder_close(&folder);
    return w;
}

static void check(failing which)
{
    const dem_material rubber =
        SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0, .thickness = 1.0);
    CLEANUP(dem_lattice_free) dem_lattice l = support_rectangle(0.06, 0.05, 8e-3, &rubber);
    dem_model *model = support_model(&l, NULL, 0);
    for (int writers = 0; writers <= 2; writers += 2) {
        written w = run(model, writers);
        assert_int_equal(w.status, DEM_OK);
        atomic_store(&fails[which], true);
        w = run(model, writers);
        atomic_store(&fails[which], false);
        assert_int_equal(w.status, DEM_ERROR_MEMORY);
        assert_non_null(strstr(w.message, "out of memory for order"));
    }
    dem_model_destroy(model);
}

TEST(a_rank_that_cannot_begin_to_write_fails_the_frame)
{
    check(BEGIN);
}

TEST(a_rank_that_cannot_pack_its_rows_fails_the_frame)
{
    check(MAKE);
}

TEST(a_rank_that_cannot_take_what_is_packed_fails_the_frame)
{
    check(TAKE);
}

TEST(a_rank_that_cannot_write_at_the_end_fails_the_frame)
{
    check(END);
}
