/* SPDX-License-Identifier: BSD-3-Clause */
/* Every allocation of the readers fails in turn, once and from then on, while a deck with every shape is read: it says
 * that memory ran out, nothing crashes, nothing leaks (the sanitizers' run sees that). The linker wraps the readers'
 * malloc, calloc and realloc; the libraries keep theirs. */
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "../unit/close.h"
#include "../unit/whole_deck.h"

#include "allocations.h"

static const char *const files[][2] = {
    {"fault.nml", "&run t_end = 1 /\n"
                  "&material name = 'rubber', youngs_modulus = 1e7, density = 1000 /\n"
                  "&body shape = 'ring', radius = 4, inner_radius = 2, spacing = 1, material = 'rubber' /\n"
                  "&body shape = 'polygon', points = 0,0, 6,0, 6,6, 0,6, spacing = 1, material = 'rubber' /\n"
                  "&body shape = 'mask', file = 'fault.pgm', scale = 1, spacing = 1, material = 'rubber', disconnected "
                  "= 'remove' /\n"
                  "&body shape = 'mesh', file = 'fault.msh', scale = 1, material = 'rubber' /\n"
                  "&void body = 2, shape = 'polygon', centre = 3, 3, points = -0.5,-0.5, 0.5,-0.5, 0,0.5 /\n"
                  "&void body = 2, shape = 'rectangle', centre = 4, 3, size = 1, 1, angle = 30 /\n"
                  "&pores body = 2, porosity = 0.02, radius = 0.3, 0.5, wall = 0.1 /\n"
                  "&crack body = 1, points = 1,0, 5,0 /\n"
                  "&obstacle points = -9,-9, 9,-9 /\n"},
    {"fault.pgm", "P2 6 4 1  1 1 1 1 0 1  1 1 1 1 1 1  1 1 1 1 1 1  1 1 1 1 1 1\n"},
    {"fault.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 4 1 4\n2 1 0 4\n1\n2\n3\n4\n0 0 0\n2 0 0\n2 2 0\n0 "
                  "2 0\n$EndNodes\n"
                  "$Elements\n1 2 1 2\n2 1 2 2\n1 1 2 3\n2 1 3 4\n$EndElements\n"}};

static int write_files(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof files / sizeof *files; k++) {
        FILE *file = fopen(files[k][0], "w");
        if (file == NULL || fputs(files[k][1], file) < 0 || fclose(file) != 0) return 1;
    }
    return 0;
}

static int remove_files(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof files / sizeof *files; k++) (void)unlink(files[k][0]);
    return 0;
}

static deck_status read_once(char *message, size_t size)
{
    CLEANUP(namelist_errors_free) namelist_errors errors = {0};
    CLEANUP(deck_free) deck d;
    const deck_status status = whole_deck_read(&d, files[0][0], &errors);
    (void)snprintf(message, size, "%s", errors.n > 0 ? errors.list[0].text : "no message");
    return status;
}

static void each_allocation_may_fail(int stays_so)
{
    char message[256];
    failing = allocations = 0;
    if (read_once(message, sizeof message) != DECK_OK) fail_msg("%s", message);
    const long all = allocations;
    assert_true(all > 200);
    from_then_on = stays_so;
    for (failing = 1; failing <= all; failing++) {
        allocations = 0;
        const deck_status status = read_once(message, sizeof message);
        if (status != DECK_MEMORY) fail_msg("allocation %ld of %ld: status %d, %s", failing, all, (int)status, message);
    }
    failing = 0;
    assert_int_equal(read_once(message, sizeof message), DECK_OK);
}

TEST(one_failed_allocation_ends_reading_with_its_status)
{
    each_allocation_may_fail(0);
}

TEST(memory_that_stays_away_ends_reading_with_its_status)
{
    each_allocation_may_fail(1);
}

TEST_GROUP(write_files, remove_files);
