/* SPDX-License-Identifier: BSD-3-Clause */
#include "obstacles.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "conditional_keys.h"
#include "motion.h"
#include "profile.h"

static const double default_segments = 200.0; /* of a profile */
static const double lost = 1e-6;              /* of a segment: rounding must not hide more */

static const conditional_key profile_keys[] = {
    {"resolution", "smooth, rough", false},
    {"roughness", "rough", true},
    {"correlation", "rough", true},
    {"seed", "rough", false},
};
static const conditional_keys profile_uses = {"obstacle", "profile", sizeof profile_keys / sizeof *profile_keys,
                                              profile_keys};

/* ---- checks ---- */

static bool has_paper_law(const schema_instance *obstacle)
{
    return strcmp(schema_text(obstacle, "friction_law"), "paper") == 0;
}

/* Squares of lengths must be numbers that can be computed with. */
static bool is_degenerate(const double *a)
{
    const double x = a[2] - a[0], y = a[3] - a[1];
    return !isnormal(x * x + y * y);
}

/* Reports the first degenerate segment of an obstacle, from 1, and how many there are. */
static bool check_segments(const double *points, size_t n_points, size_t number, namelist_place place,
                           namelist_errors *errors)
{
    size_t first = 0, n = 0;
    char more[80] = "";
    for (size_t k = n_points; k-- > 1;) {
        if (!is_degenerate(points + 2 * k - 2)) continue;
        first = k;
        n++;
    }
    if (n == 0) return true;
    const double *a = points + 2 * first - 2, length = hypot(a[2] - a[0], a[3] - a[1]);
    if (n > 1) (void)snprintf(more, sizeof more, "; so it is with %zu of %zu segments", n, n_points - 1);
    namelist_errors_add(errors, place,
                        "'points' in &obstacle: segment %zu of obstacle %zu, from (%g, %g) to (%g, %g) m, %s%s", first,
                        number, a[0], a[1], a[2], a[3],
                        length > 1.0 ? "is too long" : (length > 0.0 ? "is too short" : "has no length"), more);
    return false;
}

/* Reports two segments of an obstacle that have more than a point in common that joins them, and a motion that cannot
 * be computed with. False when memory runs out. */
static bool check_made(const dem_obstacle *obstacle, size_t number, namelist_place place, namelist_errors *errors)
{
    dem_index pair[2];
    const dem_status status = dem_obstacle_check(obstacle, pair);
    if (status == DEM_ERROR_MEMORY) return false;
    if (status != DEM_OK && pair[0] < 0) /* behind the library's number */
        namelist_errors_add(errors, place, "obstacle %zu%s", number, strchr(dem_status_message(), ':'));
    if (pair[0] < 0) return true;
    const bool follows = pair[1] == (pair[0] + 1) % (obstacle->n_points - 1);
    namelist_errors_add(errors, place,
                        follows ? "'points' in &obstacle: segment %lld of obstacle %zu goes back over segment %lld"
                                : "'points' in &obstacle: segment %lld of obstacle %zu meets segment %lld",
                        (long long)pair[follows] + 1, number, (long long)pair[!follows] + 1);
    return true;
}

static bool has_profile(const schema_instance *obstacle)
{
    return strcmp(schema_text(obstacle, "profile"), "polyline") != 0;
}

/* m along x. */
static double extent_of(const schema_value *points)
{
    return points->reals[points->count - 2] - points->reals[0];
}

static double count_segments(const schema_instance *obstacle)
{
    const double extent = extent_of(schema_value_of(obstacle, "points")), length = schema_real(obstacle, "resolution");
    return length > 0.0 ? ceil(extent / length * (1.0 - 1e-12)) : default_segments; /* rounding adds none */
}

static bool check_increase(const schema_instance *obstacle, size_t number, namelist_errors *errors)
{
    const schema_value *points = schema_value_of(obstacle, "points");
    for (int k = 2; k < points->count; k += 2) {
        if (points->reals[k] > points->reals[k - 2]) continue;
        namelist_errors_add(errors, points->place,
                            "'points' in &obstacle must increase in x for profile '%s'; point %d of obstacle %zu is at "
                            "%g m, the one before at %g m",
                            schema_text(obstacle, "profile"), k / 2 + 1, number, points->reals[k],
                            points->reals[k - 2]);
        return false;
    }
    return true;
}

static void check_resolution(const schema_instance *obstacle, size_t number, namelist_errors *errors)
{
    const schema_value *points = schema_value_of(obstacle, "points");
    const schema_value *resolution = schema_value_of(obstacle, "resolution");
    const double extent = extent_of(points), n = count_segments(obstacle), length = extent / n;
    const double largest = fmax(fabs(points->reals[0]), fabs(points->reals[points->count - 2]));
    if (resolution->given && schema_real(obstacle, "resolution") > extent)
        namelist_errors_add(errors, resolution->place,
                            "'resolution' in &obstacle must not exceed the extent of its points, %g m, got %g m",
                            extent, schema_real(obstacle, "resolution"));
    else if (n > PROFILE_MAX)
        namelist_errors_add(errors, resolution->place,
                            "'resolution' in &obstacle, %g m, makes %g segments of obstacle %zu; the limit is %d",
                            schema_real(obstacle, "resolution"), n, number, PROFILE_MAX);
    else if (largest * DBL_EPSILON > lost * length)
        namelist_errors_add(errors, resolution->place,
                            "obstacle %zu has points at x of up to %g m, so large that rounding blurs its segments of "
                            "%g m",
                            number, largest, length);
}

/* Segments may come out half as long as asked for. */
static void check_correlation(const schema_instance *obstacle, namelist_errors *errors)
{
    const schema_value *resolution = schema_value_of(obstacle, "resolution");
    const double correlation = schema_real(obstacle, "correlation");
    const double length =
        resolution->given ? resolution->reals[0] : extent_of(schema_value_of(obstacle, "points")) / default_segments;
    const int coarsest = PROFILE_COARSEST, finest = PROFILE_FINEST / 2;
    if (correlation <= 0.0 || (length <= correlation / coarsest && length >= correlation / finest)) return;
    namelist_errors_add(errors, resolution->place,
                        "'resolution' in &obstacle must be 1/%d to 1/%d of 'correlation', %g m, got %g m%s", finest,
                        coarsest, correlation, length, resolution->given ? "" : ", the default");
}

/* The default, none by Coulomb's law, would stop all sliding by the paper's. */
static void check_friction(const schema_instance *obstacle, namelist_errors *errors)
{
    const schema_value *friction = schema_value_of(obstacle, "friction");
    if (!has_paper_law(obstacle) || friction->faulty) return;
    if (!friction->given)
        namelist_errors_add(errors, obstacle->place,
                            "'friction' in &obstacle must be given for friction_law 'paper', in [0, 1]: an impact "
                            "leaves this part of the tangential velocity, and 1 is frictionless");
    else if (friction->reals[0] > 1.0)
        namelist_errors_add(errors, friction->place,
                            "'friction' in &obstacle must be in [0, 1] for friction_law 'paper', got %g",
                            friction->reals[0]);
}

static void check_obstacle(const schema_instance *obstacle, size_t number, namelist_errors *errors)
{
    const schema_value *points = schema_value_of(obstacle, "points");
    const bool pairs = points->count % 2 == 0;
    conditional_keys_check(obstacle, &profile_uses, errors);
    check_friction(obstacle, errors);
    motion_check(obstacle, errors);
    if (!pairs)
        namelist_errors_add(errors, points->place, "'points' in &obstacle must be pairs of x and y, got %d values",
                            points->count);
    if (!pairs || points->faulty || points->count == 0) return;
    const bool good = check_segments(points->reals, (size_t)points->count / 2, number, points->place, errors);
    if (!good || !has_profile(obstacle) || !check_increase(obstacle, number, errors)) return;
    if (schema_value_of(obstacle, "resolution")->faulty) return;
    const size_t before = errors->n;
    check_resolution(obstacle, number, errors);
    if (errors->n == before) check_correlation(obstacle, errors);
}

void obstacles_check(const schema_deck *groups, namelist_errors *errors)
{
    for (size_t k = 0; k < schema_count(groups, "obstacle"); k++)
        check_obstacle(schema_get(groups, "obstacle", k), k + 1, errors);
}

void obstacles_drop_unused(schema_deck *groups)
{
    conditional_keys_drop(groups, &profile_uses);
    motion_drop_unused(groups);
}

/* ---- making ---- */

/* The points that bodies touch; NULL when memory runs out. */
static double *make_points(size_t *n_points, const schema_instance *obstacle)
{
    const schema_value *from = schema_value_of(obstacle, "points");
    profile_recipe recipe = {.points = from->reals,
                             .n_points = (size_t)from->count / 2,
                             .smooth = strcmp(schema_text(obstacle, "profile"), "smooth") == 0,
                             .roughness = schema_real(obstacle, "roughness"),
                             .correlation = schema_real(obstacle, "correlation"),
                             .seed = (unsigned long)schema_real(obstacle, "seed")};
    if (has_profile(obstacle)) recipe.n_segments = (size_t)count_segments(obstacle);
    *n_points = has_profile(obstacle) ? recipe.n_segments + 1 : recipe.n_points;
    double *points = calloc(2 * *n_points, sizeof *points);
    if (points == NULL) return NULL;
    if (!has_profile(obstacle)) return memcpy(points, from->reals, 2 * *n_points * sizeof *points);
    if (profile_sample(points, &recipe) == DEM_OK) return points;
    free(points);
    return NULL;
}

/* Makes obstacle `number`, from 1. False when memory runs out. */
static bool make(dem_obstacle *made, const schema_instance *group, size_t number, namelist_errors *errors)
{
    const namelist_place place = schema_place(group, "points");
    size_t n_points;
    double *points = make_points(&n_points, group);
    if (points == NULL) return false;
    *made = (dem_obstacle){.struct_size = sizeof(dem_obstacle),
                           .n_points = (dem_index)n_points,
                           .points = points,
                           .restitution = schema_real(group, "restitution"),
                           .friction = schema_real(group, "friction"),
                           .friction_law = has_paper_law(group) ? DEM_FRICTION_PAPER : DEM_FRICTION_COULOMB};
    motion_set(made, group);
    return !check_segments(points, n_points, number, place, errors) || check_made(made, number, place, errors);
}

dem_obstacle *obstacles_make(const schema_deck *groups, namelist_errors *errors)
{
    const size_t n = schema_count(groups, "obstacle");
    dem_obstacle *list = calloc(n + 1, sizeof *list);
    bool good = list != NULL;
    for (size_t k = 0; k < n && good; k++) good = make(&list[k], schema_get(groups, "obstacle", k), k + 1, errors);
    if (good) return list;
    obstacles_free(list, (dem_index)n);
    return NULL;
}

void obstacles_free(dem_obstacle *list, dem_index n)
{
    for (dem_index k = 0; k < n && list != NULL; k++) free((void *)(uintptr_t)list[k].points);
    free(list);
}

/* ---- at rest ---- */

/* A copy with points of its own, NULL if they cannot be had. Only memory may lack: all motions of decks have poses. */
static dem_obstacle still_copy(const dem_obstacle *moving)
{
    double *points = malloc(2 * (size_t)moving->n_points * sizeof *points);
    if (points != NULL && dem_obstacle_points(moving, 0.0, points) != DEM_OK) {
        free(points);
        points = NULL;
    }
    return (dem_obstacle){.struct_size = sizeof(dem_obstacle),
                          .n_points = moving->n_points,
                          .points = points,
                          .restitution = moving->restitution,
                          .friction = moving->friction,
                          .friction_law = moving->friction_law};
}

dem_obstacle *obstacles_still(const dem_obstacle *list, dem_index n)
{
    bool good = true;
    dem_obstacle *still = calloc((size_t)n + 1, sizeof *still);
    for (dem_index k = 0; k < n && still != NULL; k++) {
        still[k] = still_copy(&list[k]);
        good = good && still[k].points != NULL;
    }
    if (good) return still;
    obstacles_free(still, n);
    return NULL;
}
