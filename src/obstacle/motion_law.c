/* SPDX-License-Identifier: BSD-3-Clause */
/* How an obstacle moves: the list of kinds of motion, and their sum as a pose (docs/method.md, Moving obstacles). A
 * kind has a header of its own (uniform_motion.h), and this is the only file that knows which there are: checks,
 * comparison and the fields by which a motion is given go through the table of motion_kind.h. Kinematics of a point
 * follow from the pose (pose.h); what contact makes of them is in contact/. */
#include "obstacle/motion_law.h"

#include <stdio.h>
#include <string.h>

#include "base/status.h"
#include "obstacle/given_motion.h"
#include "obstacle/obstacle_input.h"
#include "obstacle/oscillation.h"
#include "obstacle/rotation.h"
#include "obstacle/uniform_motion.h"

static const motion_kind *const kinds[] = {&uniform_motion, &oscillation, &rotation, &given_motion};
enum { N_KINDS = sizeof kinds / sizeof kinds[0] };

/* The field that all kinds share. */
static const dem_motion_field ramp_field = {"ramp", "s", 1, offsetof(dem_obstacle, ramp)};

/* Whether the motion has a part of this kind. */
static bool moves_by(const motion_law *law, int kind)
{
    return (law->kinds & 1u << kind) != 0;
}

/* A kind of motion whose bound of the speed is 0 does nothing, and is left out. */
motion_law motion_law_of(const dem_obstacle *obstacle)
{
    motion_law law = {.of = obstacle, .reach = given_motion_reach(obstacle)};
    for (int k = 0; k < N_KINDS; k++)
        if (kinds[k]->bounds(obstacle).speed != 0.0) law.kinds |= 1u << k;
    law.moves = law.kinds != 0;
    return law;
}

/* Kinds add to c, c' and c''; one of them turns. The sums begin at -0, since adding to -0 changes no bit: the first
 * kind keeps the sign even of its zeros. */
pose motion_law_pose(const motion_law *law, double t)
{
    const vec2 none = {-0.0, -0.0};
    if (law->has_start && t == 0.0) return law->start;
    pose sum = {.centre = none, .velocity = none, .acceleration = {0.0, 0.0}, .axis = {1.0, 0.0}};
    for (int k = 0; k < N_KINDS; k++)
        if (moves_by(law, k)) kinds[k]->add(law, t, &sum);
    return sum;
}

/* Speeds and accelerations of kinds add up at most; the shortest step is that of the fastest kind. */
motion_bounds motion_law_bounds(const motion_law *law)
{
    motion_bounds sum = {0};
    for (int k = 0; k < N_KINDS; k++) {
        if (!moves_by(law, k)) continue;
        const motion_bounds b = kinds[k]->bounds(law->of);
        sum.speed += b.speed;
        sum.acceleration += b.acceleration;
        sum.step_rate = fmax(sum.step_rate, b.step_rate);
    }
    return sum;
}

/* Reads the one or two numbers of a field at its place in the obstacle's struct. */
static void read_field(const dem_obstacle *obstacle, const dem_motion_field *field, double value[2])
{
    memcpy(value, (const char *)obstacle + field->offset, (size_t)field->n * sizeof *value);
}

/* The third component of a field that is a vector; 0 of one that is a number. */
static double third_of(const dem_obstacle *obstacle, const dem_motion_field *field)
{
    double third = 0.0;
    if (field->n == 2) memcpy(&third, (const char *)obstacle + field->offset + 2 * sizeof third, sizeof third);
    return third;
}

/* A field has finite numbers, and no third one in the plane. */
static dem_status check_field(const dem_motion_field *field, const dem_obstacle *obstacle, dem_index o)
{
    double value[2] = {0.0, 0.0};
    const double third = third_of(obstacle, field);
    read_field(obstacle, field, value);
    for (int d = 0; d < 2; d++)
        CHECK(isfinite(value[d]), DEM_ERROR_MODEL, "obstacle %lld: %s of %g %s is not finite", (long long)o,
              field->name, value[d], field->unit);
    CHECK(third == 0.0, DEM_ERROR_MODEL, "obstacle %lld: %s has a third component in the plane: %g", (long long)o,
          field->name, third);
    return DEM_OK;
}

/* The field with the largest number, which is the likely cause where products overflow. */
static const char *largest_field(const motion_kind *kind, const dem_obstacle *obstacle)
{
    const char *name = "its motion";
    double most = 0.0;
    for (dem_index f = 0; f < kind->n_fields; f++) {
        double value[2] = {0.0, 0.0};
        read_field(obstacle, &kind->fields[f], value);
        const double size = fmax(fabs(value[0]), fabs(value[1]));
        if (size > most) name = kind->fields[f].name;
        most = fmax(most, size);
    }
    return name;
}

/* The bounds that follow from the fields must be finite, too: products may overflow. */
static dem_status check_kind(const motion_kind *kind, const dem_obstacle *obstacle, dem_index o)
{
    for (dem_index f = 0; f < kind->n_fields; f++) TRY(check_field(&kind->fields[f], obstacle, o));
    const char *fault = kind->fault != NULL ? kind->fault(obstacle) : NULL;
    CHECK(fault == NULL, DEM_ERROR_MODEL, "obstacle %lld: %s", (long long)o, fault);
    const motion_bounds b = kind->bounds(obstacle);
    CHECK(isfinite(b.speed) && isfinite(b.acceleration) && isfinite(b.step_rate), DEM_ERROR_MODEL,
          "obstacle %lld: %s makes it move by up to %g m/s and %g m/s^2, which cannot be computed with", (long long)o,
          largest_field(kind, obstacle), b.speed, b.acceleration);
    return DEM_OK;
}

dem_status motion_law_check(const dem_obstacle *obstacle, dem_index o)
{
    TRY(check_field(&ramp_field, obstacle, o));
    CHECK(obstacle->ramp >= 0.0, DEM_ERROR_MODEL, "obstacle %lld: ramp must be >= 0, got %g s", (long long)o,
          obstacle->ramp);
    for (int k = 0; k < N_KINDS; k++) TRY(check_kind(kinds[k], obstacle, o));
    return DEM_OK;
}

/* A motion by a function must be known at t = 0: a fault of the model, not of a step. */
dem_status motion_law_ask_start(motion_law *law, dem_index o)
{
    char why[160];
    if (law->of->motion == NULL) return DEM_OK;
    law->start = motion_law_pose(law, 0.0);
    law->has_start = given_motion_failure() == DEM_OK;
    if (law->has_start) return DEM_OK;
    (void)snprintf(why, sizeof why, "%s", dem_status_message());
    return status_fail(DEM_ERROR_MODEL, "obstacle %lld: %s", (long long)o, why);
}

/* Whether two obstacles have equal numbers in all fields of a kind. */
static bool is_same_kind(const motion_kind *kind, const dem_obstacle *a, const dem_obstacle *b)
{
    for (dem_index f = 0; f < kind->n_fields; f++) {
        double one[2] = {0.0, 0.0}, other[2] = {0.0, 0.0};
        read_field(a, &kind->fields[f], one);
        read_field(b, &kind->fields[f], other);
        if (one[0] != other[0] || one[1] != other[1]) return false;
    }
    return true;
}

/* Equal numbers and functions mean equal poses at all times: neither moves as seen from the other. */
bool motion_law_is_same(const motion_law *a, const motion_law *b)
{
    if (a->kinds != b->kinds) return false;
    if (!a->moves) return true;
    if (a->of->ramp != b->of->ramp || a->of->motion != b->of->motion) return false;
    if (a->of->motion_context != b->of->motion_context) return false;
    for (int k = 0; k < N_KINDS; k++)
        if (moves_by(a, k) && !is_same_kind(kinds[k], a->of, b->of)) return false;
    return true;
}

/* ---- public ---- */

/* Field k when the fields of all kinds are numbered through; the one that they share is the last. */
const dem_motion_field *dem_motion_field_at(dem_index k)
{
    if (k < 0) return NULL;
    for (int kind = 0; kind < N_KINDS; k -= kinds[kind++]->n_fields)
        if (k < kinds[kind]->n_fields) return &kinds[kind]->fields[k];
    return k == 0 ? &ramp_field : NULL;
}

static bool has_field(const motion_kind *kind, const dem_motion_field *field)
{
    for (dem_index f = 0; f < kind->n_fields; f++)
        if (kind->fields[f].offset == field->offset) return true;
    return false;
}

/* Whether it moves at all (by = NULL), or by the kind of motion that has this field; a ramp of 0 is none. */
bool dem_obstacle_moves(const dem_obstacle *obstacle, const dem_motion_field *by)
{
    dem_obstacle own;
    if (obstacle_input_read(&own, obstacle) != DEM_OK) return false;
    const motion_law law = motion_law_of(&own);
    bool moves = law.moves && (by == NULL || (by->offset == ramp_field.offset && own.ramp != 0.0));
    for (int k = 0; k < N_KINDS; k++) moves = moves || (moves_by(&law, k) && has_field(kinds[k], by));
    return moves;
}

/* Where the points of the polyline are at time t. */
dem_status dem_obstacle_points(const dem_obstacle *obstacle, double t, double *points)
{
    dem_obstacle own;
    CHECK(points != NULL, DEM_ERROR_ARGUMENT, "dem_obstacle_points: points is NULL");
    TRY(obstacle_input_read(&own, obstacle));
    const motion_law law = motion_law_of(&own);
    const pose at = motion_law_pose(&law, t);
    TRY(given_motion_failure());
    memmove(points, own.points, 2 * (size_t)own.n_points * sizeof *points);
    for (dem_index k = 0; k < own.n_points && law.moves; k++)
        vec2_put(points, k, pose_outside(&at, vec2_at(points, k)));
    return DEM_OK;
}

/* What is at rest has no pose. */
dem_status dem_obstacle_velocity(const dem_obstacle *obstacle, double t, const double *x, double *velocity)
{
    dem_obstacle own;
    CHECK(x != NULL && velocity != NULL, DEM_ERROR_ARGUMENT, "dem_obstacle_velocity: %s is NULL",
          x == NULL ? "x" : "velocity");
    TRY(obstacle_input_read(&own, obstacle));
    const motion_law law = motion_law_of(&own);
    const pose at = motion_law_pose(&law, t);
    TRY(given_motion_failure());
    vec2_put(velocity, 0, law.moves ? pose_velocity(&at, vec2_at(x, 0)) : (vec2){0.0, 0.0});
    return DEM_OK;
}
