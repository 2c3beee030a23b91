/* SPDX-License-Identifier: BSD-3-Clause */
#include "precision.h"

#include <float.h>
#include <math.h>

static const double least_roundings = 100.0; /* gaps are differences of coordinates, some times over */

static double largest_of(const double *array, dem_index n)
{
    double largest = 0.0;
    for (dem_index k = 0; k < n && array != NULL; k++) largest = fmax(largest, fabs(array[k]));
    return largest;
}

static double shortest_spring(const dem_lattice *lattice)
{
    double shortest = (double)INFINITY;
    for (dem_index k = 0; k < lattice->n_springs; k++) shortest = fmin(shortest, lattice->rest_length[k]);
    return shortest;
}

static void check_penetration_tolerance(const schema_instance *contact, double coordinate, namelist_errors *errors)
{
    const double least = least_roundings * DBL_EPSILON * coordinate;
    if (schema_given(contact, "penetration_tolerance") && schema_real(contact, "penetration_tolerance") < least)
        namelist_errors_add(
            errors, schema_place(contact, "penetration_tolerance"),
            "'penetration_tolerance' in &contact must be >= %.2g m, or rounding of coordinates of up to %g m hides it, "
            "got %g m",
            least, coordinate, schema_real(contact, "penetration_tolerance"));
}

void precision_check(const schema_deck *groups, const dem_lattice *lattice, namelist_errors *errors)
{
    const schema_instance *contact = schema_get(groups, "contact", 0), *solver = schema_get(groups, "solver", 0);
    const double *x = lattice->position != NULL ? lattice->position : lattice->x;
    const double coordinate = largest_of(x, 2 * lattice->n_nodes), rtol = schema_real(solver, "rtol");
    const double speed = largest_of(lattice->velocity, 2 * lattice->n_nodes), scale = schema_real(solver, "v_scale");
    const bool given = schema_given(solver, "spacing");
    const double spacing = given ? schema_real(solver, "spacing") : shortest_spring(lattice);
    check_penetration_tolerance(contact, coordinate, errors);
    if (rtol * spacing < DBL_EPSILON * coordinate)
        namelist_errors_add(errors, schema_place(solver, given ? "spacing" : "rtol"),
                            "'rtol' in &solver, %g of a spacing of %g m, asks for less than rounding makes of "
                            "coordinates of up to %g m",
                            rtol, spacing, coordinate);
    if (schema_given(solver, "v_scale") && rtol * scale < DBL_EPSILON * speed)
        namelist_errors_add(errors, schema_place(solver, "v_scale"),
                            "'rtol' in &solver, %g of 'v_scale', %g m/s, asks for less than rounding makes of "
                            "velocities of up to %g m/s",
                            rtol, scale, speed);
}
