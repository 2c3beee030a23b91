/* SPDX-License-Identifier: BSD-3-Clause */
/* A process alone: what is reduced is what it has, and there is nobody to send to. */
#include "base/ranks.h"

static void keep(void *self, void *packet, size_t size, ranks_join *join)
{
    (void)self;
    (void)packet;
    (void)size;
    (void)join;
}

static void send_nothing(void *self, int n, const ranks_message *sent, const ranks_message *received)
{
    (void)self;
    (void)n;
    (void)sent;
    (void)received;
}

const ranks ranks_alone = {.size = 1, .reduce = keep, .exchange = send_nothing};
