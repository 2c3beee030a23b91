/* SPDX-License-Identifier: BSD-3-Clause */
/* The units of all numbers that a trajectory holds, in one list by name, so that readers and exports agree. A name has
 * the same unit in all tables but for those that are listed with their table: `obstacle` is a work in the history, and
 * the number of an obstacle elsewhere. docs/output.md has the same units for people. */
#include "output/units.h"

#include <stdbool.h>
#include <string.h>

enum { MOST = 32 };

static const struct unit {
    const char *unit, *names[MOST]; /* NULL behind the last */
} units[] = {
    {"s", {"t", "h", "peak_von_mises_time", "peak_strain_time"}},
    {"m",
     {"x", "displacement", "length", "body_centre", "obstacle_point", "obstacle_displacement", "boundary_displacement",
      "gap_min", "crack_length", "size"}},
    {"kg", {"mass", "median_fragment"}},
    {"rad", {"obstacle_angle"}},
    {"W", {"obstacle_power"}},
    {"m/s", {"v", "velocity", "before", "after", "body_velocity"}},
    {"N", {"force", "contact_force", "obstacle_reaction", "boundary_force"}},
    {"N s", {"normal_impulse", "tangential_impulse", "obstacle_impulse", "obstacle_friction_impulse"}},
    {"kg m^2/s", {"body_angular_momentum", "angular_momentum"}},
    {"Pa", {"stress", "von_mises", "principal_stress", "contact_pressure", "peak_von_mises", "peak_stress"}},
    {"1",
     {"strain", "peak_strain", "strain_min", "strain_max", "area_min", "closure", "weight", "normal",
      "largest_fragment", "debris", "damage"}},
    {"J", {"energy",          "kinetic",          "elastic",         "area",           "guard",
           "gravity",         "impact",           "friction",        "damping",        "projection",
           "boundary",        "kinetic_energy",   "elastic_energy",  "area_energy",    "guard_energy",
           "gravity_energy",  "impact_energy",    "friction_energy", "damping_energy", "projection_energy",
           "boundary_energy", "contact",          "fracture",        "contact_energy", "fracture_energy",
           "obstacle_energy", "history/obstacle", "kinetic_centre",  "kinetic_spin",   "kinetic_internal"}},
};

static bool is_listed_as(const char *listed, const char *table, const char *name)
{
    const size_t n = table != NULL ? strlen(table) : 0;
    if (n > 0 && strncmp(listed, table, n) == 0 && listed[n] == '/') return strcmp(listed + n + 1, name) == 0;
    return strcmp(listed, name) == 0;
}

/* A name that is not listed counts things, names them, or is not of this library: it has no unit. */
const char *units_of(const char *table, const char *name)
{
    for (size_t u = 0; u < sizeof units / sizeof units[0]; u++)
        for (int k = 0; k < MOST && units[u].names[k] != NULL; k++)
            if (is_listed_as(units[u].names[k], table, name)) return units[u].unit;
    return "";
}
