/* SPDX-License-Identifier: BSD-3-Clause */
/* The methods of integration by name, their tables of coefficients, and their stability on undamped oscillations
 * (docs/method.md, Methods). SUNDIALS owns the coefficients; they are read from it by the name of the table, so that
 * none is copied by hand but those of the classical method, RK4. Steps are taken in arkode_integrator.c and, by the
 * same tables, in src/events/local_correction.c. */
#include "time/butcher.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h> /* ARKODE's header needs it */
#include <string.h>

#include <arkode/arkode_butcher_erk.h>
#include <sundials/sundials_version.h>

#include "base/status.h"
#include "base/struct_size.h"

/* A table in SUNDIALS, and the first version that has it, 100 major + minor. */
typedef struct butcher_row {
    const char *name, *table;
    int since;
} butcher_row;

static const butcher_row rows[] = {
    [DEM_METHOD_FEHLBERG45] = {"fehlberg45", "ARKODE_FEHLBERG_6_4_5", 604},
    [DEM_METHOD_DOPRI45] = {"dopri45", "ARKODE_DORMAND_PRINCE_7_4_5", 604},
    [DEM_METHOD_CASHKARP45] = {"cashkarp45", "ARKODE_CASH_KARP_6_4_5", 604},
    [DEM_METHOD_ZONNEVELD34] = {"zonneveld34", "ARKODE_ZONNEVELD_5_3_4", 604},
    [DEM_METHOD_BS23] = {"bs23", "ARKODE_BOGACKI_SHAMPINE_4_2_3", 604},
    [DEM_METHOD_HEUN12] = {"heun12", "ARKODE_HEUN_EULER_2_1_2", 604},
    [DEM_METHOD_SAYFYABURUB34] = {"sayfyaburub34", "ARKODE_SAYFY_ABURUB_6_3_4", 604},
    [DEM_METHOD_ARK23] = {"ark23", "ARKODE_ARK324L2SA_ERK_4_2_3", 604},
    [DEM_METHOD_ARK34] = {"ark34", "ARKODE_ARK436L2SA_ERK_6_3_4", 604},
    [DEM_METHOD_ARK34B] = {"ark34b", "ARKODE_ARK437L2SA_ERK_7_3_4", 604},
    [DEM_METHOD_ARK45] = {"ark45", "ARKODE_ARK548L2SA_ERK_8_4_5", 604},
    [DEM_METHOD_ARK45B] = {"ark45b", "ARKODE_ARK548L2SAb_ERK_8_4_5", 604},
    [DEM_METHOD_VERNER56] = {"verner56", "ARKODE_VERNER_8_5_6", 604},
    [DEM_METHOD_VERNER67] = {"verner67", "ARKODE_VERNER_10_6_7", 607},
    [DEM_METHOD_VERNER78] = {"verner78", "ARKODE_VERNER_13_7_8", 607},
    [DEM_METHOD_VERNER89] = {"verner89", "ARKODE_VERNER_16_8_9", 607},
    [DEM_METHOD_FEHLBERG78] = {"fehlberg78", "ARKODE_FEHLBERG_13_7_8", 604},
    [DEM_METHOD_KNOTHWOLKE3] = {"knothwolke3", "ARKODE_KNOTH_WOLKE_3_3", 604},
    [DEM_METHOD_RK4] = {"rk4", NULL, 0},
    [DEM_METHOD_VERLET] = {"verlet", NULL, 0},
};
static const int n_rows = sizeof rows / sizeof rows[0];

/* a_ij of a table: the rows stand one behind the other, without gaps. */
static double *entry(butcher_table *t, int i, int j)
{
    return &t->a[i * t->stages + j];
}

/* The classical method: 1/6, 1/3, 1/3, 1/6. */
static const butcher_table rk4 = {.stages = 4,
                                  .order = 4,
                                  .a = {0.0, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0},
                                  .b = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0},
                                  .c = {0.0, 0.5, 0.5, 1.0}};

/* Copies a table of SUNDIALS. Its embedded weights d and their order are there only if the method estimates its error;
 * d = NULL means that it takes fixed steps only. An append_solution() must still fit, hence fewer stages than there is
 * room for. */
static dem_status read_table(butcher_table *out, const butcher_row *row)
{
    CHECK(100 * SUNDIALS_VERSION_MAJOR + SUNDIALS_VERSION_MINOR >= row->since, DEM_ERROR_ARGUMENT,
          "method '%s' needs SUNDIALS %d.%d or later, this is " SUNDIALS_VERSION, row->name, row->since / 100,
          row->since % 100);
    ARKodeButcherTable table = ARKodeButcherTable_LoadERKByName(row->table);
    CHECK(table != NULL && table->stages < BUTCHER_STAGES, DEM_ERROR_ARGUMENT, "SUNDIALS gives no table %s",
          row->table);
    const size_t size = (size_t)table->stages * sizeof(double);
    *out = (butcher_table){.stages = table->stages, .order = table->q};
    for (int i = 0; i < table->stages; i++) memcpy(entry(out, i, 0), table->A[i], size);
    memcpy(out->b, table->b, size);
    memcpy(out->c, table->c, size);
    if (table->d != NULL) {
        out->embedded_order = table->p;
        memcpy(out->d, table->d, size);
    }
    ARKodeButcherTable_Free(table);
    return DEM_OK;
}

/* Whether the last stage is the solution, so that its derivative is the first of the next step. */
static bool ends_with_solution(butcher_table *t)
{
    for (int j = 0; j < t->stages; j++)
        if (fabs(*entry(t, t->stages - 1, j) - t->b[j]) > 1e-14) return false;
    return true;
}

/* SUNDIALS before 6.7 takes any last stage at the end of the step for the solution, and loses order where it is not
 * (LLNL/sundials #311). One stage more, the solution, makes it true, and costs nothing: ARKODE would call for that
 * derivative all the same. */
static void append_solution(butcher_table *t)
{
    const int n = t->stages;
    butcher_table longer = {.stages = n + 1, .order = t->order, .embedded_order = t->embedded_order};
    for (int i = 0; i < n; i++) memcpy(entry(&longer, i, 0), entry(t, i, 0), (size_t)n * sizeof(double));
    memcpy(entry(&longer, n, 0), t->b, (size_t)n * sizeof(double));
    memcpy(longer.b, t->b, (size_t)n * sizeof(double));
    memcpy(longer.c, t->c, (size_t)n * sizeof(double));
    memcpy(longer.d, t->d, (size_t)n * sizeof(double));
    longer.c[n] = 1.0;
    *t = longer;
}

/* NULL for a number that is no method: the enumeration comes from the caller. */
static const butcher_row *row_of(dem_method method)
{
    return (int)method >= 0 && (int)method < n_rows ? &rows[method] : NULL;
}

dem_status butcher_load_own(butcher_table *out, dem_method method)
{
    const butcher_row *row = row_of(method);
    CHECK(row != NULL, DEM_ERROR_ARGUMENT, "unknown method %d", (int)method);
    CHECK(method != DEM_METHOD_VERLET, DEM_ERROR_ARGUMENT, "method '%s' has no table", row->name);
    if (method == DEM_METHOD_RK4)
        *out = rk4;
    else
        TRY(read_table(out, row));
    return DEM_OK;
}

/* A last stage at c = 1 that is not the solution gets the solution as a stage behind it, see append_solution(). */
dem_status butcher_load(butcher_table *out, dem_method method)
{
    TRY(butcher_load_own(out, method));
    if (out->c[out->stages - 1] == 1.0 && !ends_with_solution(out)) append_solution(out);
    return DEM_OK;
}

/* ---- reach ---- */

/* Sums of |a_ij|, and of |a_ij| |a_jk|, for the weights of stage i or of the end. */
static void add_reach(step_reach *reach, butcher_table *t, const double *weight)
{
    double position = 0.0, time = 0.0;
    for (int j = 0; j < t->stages; j++) {
        time += weight[j];
        for (int k = 0; k < j; k++) position += fabs(weight[j]) * fabs(*entry(t, j, k));
    }
    reach->time = fmax(reach->time, fabs(time));
    reach->position = fmax(reach->position, position);
}

/* Verlet: x1 = x0 + h v0 + h^2/2 a0, v1 = v0 + h/2 (a0 + a1). */
bool butcher_ends_in_stage(const butcher_table *t)
{
    bool same = true;
    for (int k = 0; k < t->stages; k++) same = same && t->a[(t->stages - 1) * t->stages + k] == t->b[k];
    return same;
}

/* Weights of a sum over n stages.  \return the most rings of those in it */
static int most_rings(const double *weight, const int *rings, int n)
{
    int most = 0;
    for (int j = 0; j < n; j++)
        if (weight[j] != 0.0 && rings[j] > most) most = rings[j];
    return most;
}

static int larger(int a, int b)
{
    return a > b ? a : b;
}

/* Positions at a stage follow from velocities at stages before, and velocities from accelerations; these, from a ring
 * more of positions. */
int butcher_rings(const butcher_table *t)
{
    int v[BUTCHER_STAGES], a[BUTCHER_STAGES];
    const int n = t->stages;
    for (int i = 0; i < n; i++) {
        const double *weights = &t->a[i * t->stages];
        v[i] = most_rings(weights, a, i);
        a[i] = larger(most_rings(weights, v, i) + 1, v[i]);
    }
    const int at_end = larger(most_rings(t->b, v, n), most_rings(t->b, a, n));
    return larger(at_end, t->embedded_order > 0 ? larger(most_rings(t->d, v, n), most_rings(t->d, a, n)) : 0);
}

dem_status butcher_reach(step_reach *out, dem_method method)
{
    butcher_table table;
    *out = (step_reach){.time = 1.0, .position = 0.5, .velocity = 1.0};
    if (method == DEM_METHOD_VERLET) return DEM_OK;
    TRY(butcher_load(&table, method));
    *out = (step_reach){0};
    for (int i = 0; i < table.stages; i++) add_reach(out, &table, entry(&table, i, 0));
    add_reach(out, &table, table.b);
    for (int j = 0; j < table.stages; j++) out->velocity += fabs(table.b[j]);
    return DEM_OK;
}

/* ---- stability ---- */

/* |R(i z)|, the factor by which one step multiplies the amplitude of y' = i omega y, with z = omega h. The stages are
 *   Y_j = 1 + i z sum of a_jk Y_k over k < j,   R = 1 + i z sum of b_j Y_j,
 * in real and imaginary parts. On an undamped lattice all eigenvalues are imaginary, so |R| <= 1 is the stability
 * bound. */
static double table_growth(butcher_table *t, double z)
{
    double re[BUTCHER_STAGES], im[BUTCHER_STAGES], sum_re = 1.0, sum_im = 0.0;
    for (int j = 0; j < t->stages; j++) {
        re[j] = 1.0;
        im[j] = 0.0;
        for (int k = 0; k < j; k++) {
            re[j] -= z * *entry(t, j, k) * im[k];
            im[j] += z * *entry(t, j, k) * re[k];
        }
        sum_re -= z * t->b[j] * im[j];
        sum_im += z * t->b[j] * re[j];
    }
    return hypot(sum_re, sum_im);
}

/* Velocity Verlet on x'' = -omega^2 x maps (x, v) by a matrix of determinant 1 and trace 2 - z^2. Up to z = 2 its two
 * eigenvalues are conjugate with modulus 1; beyond, they are real, and the larger modulus is p + sqrt(p^2 - 1) with p =
 * z^2/2 - 1. */
static double verlet_integrator_growth(double z)
{
    const double half = 0.5 * z * z - 1.0;
    return z > 2.0 ? half + sqrt(half * half - 1.0) : 1.0;
}

/* The largest z, to 1e-3, below which no growth |R| - 1 exceeds `allowed`. Near z = 0 growth is below rounding whatever
 * its sign; a method that first leaves 1 upwards is unstable from the start, and has the bound 0. */
static double largest_step(butcher_table *t, double allowed)
{
    const double rounding = 1e-13, step = 1e-3;
    double z = step;
    bool moves = false; /* growth is not 1 to rounding */
    for (; z < 20.0; z += step) {
        const double over = table_growth(t, z) - 1.0;
        if (over > fmax(allowed, rounding)) break;
        moves = moves || fabs(over) > rounding;
    }
    return moves ? z - step : 0.0;
}

/* A method whose last stage is the solution evaluates one derivative less per step, as that one is the first of the
 * next. */
static dem_method_traits traits_of(const char *name, butcher_table *t)
{
    return (dem_method_traits){.name = name,
                               .order = t->order,
                               .evaluations = t->stages - (ends_with_solution(t) ? 1 : 0),
                               .adaptive = t->embedded_order > 0,
                               .stable = largest_step(t, 0.0),
                               .usable = largest_step(t, 1e-3)};
}

dem_status dem_method_describe(dem_method_traits *out, dem_method method)
{
    const butcher_row *row = row_of(method);
    butcher_table table;
    CHECK(out != NULL, DEM_ERROR_ARGUMENT, "dem_method_describe: out is NULL");
    CHECK(row != NULL, DEM_ERROR_ARGUMENT, "unknown method %d", (int)method);
    dem_method_traits own = {.name = row->name, .order = 2, .evaluations = 1, .stable = 2.0, .usable = 2.0};
    if (method != DEM_METHOD_VERLET) {
        TRY(butcher_load(&table, method));
        own = traits_of(row->name, &table);
    }
    return struct_size_write(&STRUCT_KIND(dem_method_traits), out, &own);
}

dem_status dem_method_find(dem_method *out, const char *name)
{
    CHECK(out != NULL && name != NULL, DEM_ERROR_ARGUMENT, "dem_method_find: %s is NULL", out == NULL ? "out" : "name");
    for (int k = 0; k < n_rows; k++)
        if (strcmp(rows[k].name, name) == 0) {
            *out = (dem_method)k;
            return DEM_OK;
        }
    return status_fail(DEM_ERROR_ARGUMENT, "no method is called '%s'", name);
}

/* NAN for an unknown method, or one that this SUNDIALS lacks: a growth has no status to return. */
double dem_method_growth(dem_method method, double omega_h)
{
    butcher_table table;
    if (method == DEM_METHOD_VERLET) return verlet_integrator_growth(omega_h);
    return butcher_load(&table, method) == DEM_OK ? table_growth(&table, omega_h) : (double)NAN;
}

int butcher_rings_of(dem_method method)
{
    butcher_table table;
    if (method == DEM_METHOD_VERLET || butcher_load(&table, method) != DEM_OK) return 0;
    return butcher_ends_in_stage(&table) ? 0 : butcher_rings(&table);
}
