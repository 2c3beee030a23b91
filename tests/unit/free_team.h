/* SPDX-License-Identifier: BSD-3-Clause */
/* A team that ends where its block does: `CLEANUP(free_team) team *t = team_create(2, 1);`. */
#ifndef DEM_TEST_FREE_TEAM_H
#define DEM_TEST_FREE_TEAM_H

#include "base/team.h"

static inline void free_team(team **t)
{
    team_destroy(*t);
}

#endif
