/* SPDX-License-Identifier: BSD-3-Clause */
#include "molecule.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- types ---- */

static bool find_atoms(molecule *m)
{
    const dem_lattice *l = m->lattice;
    kinds_pair *pairs = task_allocate(m->task, l->n_nodes, sizeof *pairs);
    if (pairs == NULL) return false;
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const bool fixed = l->flags != NULL && (l->flags[i] & DEM_NODE_FIXED) != 0;
        pairs[i] = (kinds_pair){fixed ? 1.0 : 0.0, l->mass[i]};
    }
    const bool found = kinds_find(&m->atoms, m->task, l->n_nodes, pairs);
    free(pairs);
    return found;
}

static bool find_bonds(molecule *m)
{
    const dem_lattice *l = m->lattice;
    kinds_pair *pairs = task_allocate(m->task, l->n_springs, sizeof *pairs);
    if (pairs == NULL) return false;
    m->longest = l->n_springs > 0 ? 0.0 : 1.0;
    for (dem_index k = 0; k < l->n_springs; k++) {
        pairs[k] = (kinds_pair){l->stiffness[k], l->rest_length[k]};
        m->longest = fmax(m->longest, l->rest_length[k]);
    }
    const bool found = kinds_find(&m->bonds, m->task, l->n_springs, pairs);
    free(pairs);
    return found;
}

/* ---- the state ---- */

/* Whether the lattice's velocities are those of the frame before they were rounded. */
static bool starts_so(const dem_lattice *l, const double *v)
{
    bool so = true;
    for (dem_index i = 0; so && i < l->n_nodes; i++)
        for (int d = 0; d < 2; d++) {
            const double start = l->velocity != NULL ? l->velocity[2 * i + d] : 0.0;
            so = so && (double)(float)start == (double)(float)v[2 * i + d];
        }
    return so;
}

/* Three components become two. */
static bool read_velocities(molecule *m, const dem_reader_array *what, double *v)
{
    const dem_index n = m->lattice->n_nodes;
    double *three = task_allocate(m->task, what->components * n, sizeof *three);
    const bool read =
        three != NULL && task_holds(m->task, dem_reader_read(m->task->reader, what, m->task->frames.frame[0], three));
    for (dem_index k = 0; read && k < 2 * n; k++) v[k] = three[k / 2 * what->components + k % 2];
    free(three);
    return read;
}

/* Which springs are broken in the first frame; a run without frames has not begun to break. */
static bool find_gone(molecule *m)
{
    const dem_lattice *l = m->lattice;
    const dem_reader_array *broken = dem_reader_array_find(m->task->reader, "broken");
    m->gone = task_allocate(m->task, l->n_springs, sizeof *m->gone);
    if (m->gone == NULL) return false;
    const bool known = broken != NULL && m->task->frames.n > 0 && l->n_springs > 0;
    if (known && !task_holds(m->task, dem_reader_read(m->task->reader, broken, m->task->frames.frame[0], m->gone)))
        return false;
    for (dem_index k = 0; k < l->n_springs; k++) m->n_bonds += m->gone[k] == 0.0;
    return true;
}

static bool read_state(molecule *m)
{
    const dem_lattice *l = m->lattice;
    const dem_reader_array *velocity = dem_reader_array_find(m->task->reader, "velocity");
    for (int k = 0; k < 2; k++) m->own[k] = task_allocate(m->task, 2 * l->n_nodes, sizeof *m->own[k]);
    if (m->own[0] == NULL || m->own[1] == NULL) return false;
    m->x = m->own[0], m->v = m->own[1];
    if (!task_holds(m->task, dem_reader_positions(m->task->reader, m->task->frames.frame[0], m->own[0]))) return false;
    const bool known = velocity != NULL && velocity->components >= 2;
    if (known && !read_velocities(m, velocity, m->own[1])) return false;
    const bool rounded = known && velocity->type == DEM_READER_F32;
    if (m->t == 0.0 && l->velocity != NULL && (!known || (rounded && starts_so(l, m->v)))) m->v = l->velocity;
    if (!known && m->t > 0.0) task_warn(m->task, "has no velocities: in the data file they are 0");
    return true;
}

static bool find_state(molecule *m)
{
    const dem_lattice *l = m->lattice;
    dem_index n = 0;
    const double *times = dem_reader_times(m->task->reader, &n);
    if (m->task->frames.n > 0) {
        m->t = times[m->task->frames.frame[0]];
        return read_state(m);
    }
    m->own[1] = task_allocate(m->task, 2 * l->n_nodes, sizeof *m->own[1]);
    m->x = l->position != NULL ? l->position : l->x;
    m->v = l->velocity != NULL ? l->velocity : m->own[1];
    return m->own[1] != NULL;
}

molecule_box molecule_box_of(const molecule *m, const double *x)
{
    molecule_box box = {{x[0], x[1]}, {x[0], x[1]}};
    for (dem_index i = 0; i < m->lattice->n_nodes; i++)
        for (int d = 0; d < 2; d++) {
            box.low[d] = fmin(box.low[d], x[2 * i + d]);
            box.high[d] = fmax(box.high[d], x[2 * i + d]);
        }
    for (int d = 0; d < 2; d++) {
        const double room = m->longest + 0.1 * (box.high[d] - box.low[d]);
        box.low[d] -= room;
        box.high[d] += room;
    }
    return box;
}

/* ---- what a harmonic bond does not have ---- */

static dem_index count(const double *values, dem_index n)
{
    dem_index found = 0;
    for (dem_index k = 0; values != NULL && k < n; k++) found += values[k] != 0.0;
    return found;
}

static dem_index count_rigid(const dem_lattice *l)
{
    dem_index found = 0;
    for (dem_index i = 0; l->flags != NULL && i < l->n_nodes; i++) found += (l->flags[i] & DEM_NODE_RIGID) != 0;
    return found;
}

__attribute__((format(printf, 3, 4))) static void omit(molecule *m, bool is_there, const char *format, ...)
{
    const size_t used = strlen(m->omissions);
    va_list arguments;
    if (!is_there) return;
    const size_t begun =
        used + (size_t)snprintf(m->omissions + used, MOLECULE_OMISSIONS - used, "%s", used > 0 ? ", " : "left out: ");
    va_start(arguments, format);
    (void)vsnprintf(m->omissions + begun, MOLECULE_OMISSIONS - begun, format, arguments);
    va_end(arguments);
}

static const char *plural(dem_index n)
{
    return n == 1 ? "" : "s";
}

/* Their springs keep what other triangles hold of them. */
static dem_index count_broken_triangles(const molecule *m)
{
    const dem_index n = m->lattice->n_triangles;
    dem_index found = 0;
    unsigned char *flags = task_allocate(m->task, n, sizeof *flags);
    if (flags != NULL && m->task->frames.n > 0 &&
        dem_reader_broken_triangles(m->task->reader, m->task->frames.frame[0], flags) == DEM_OK)
        for (dem_index k = 0; k < n; k++) found += flags[k];
    free(flags);
    return found;
}

static void find_omissions(molecule *m)
{
    const dem_lattice *l = m->lattice;
    const dem_index broken = count_broken_triangles(m);
    const dem_index obstacles = dem_reader_n_obstacles(m->task->reader);
    const dem_reader_column *boundaries = dem_reader_column_find(m->task->reader, "history", "boundary_force");
    const dem_index area = count(l->area_stiffness, l->n_triangles), guard = count(l->guard, l->n_triangles);
    const dem_index coupled = count(l->coupling, 3 * l->n_triangles);
    const dem_index held = boundaries != NULL ? boundaries->items : 0;
    const dem_index damped = count(l->viscosity, l->n_springs), rigid = count_rigid(l);
    omit(m, area > 0, "the area term of %lld triangle%s", (long long)area, plural(area));
    omit(m, coupled > 0, "%lld coupling%s of springs", (long long)coupled, plural(coupled));
    omit(m, guard > 0, "the folding guard of %lld triangle%s", (long long)guard, plural(guard));
    omit(m, damped > 0, "the damping of %lld spring%s", (long long)damped, plural(damped));
    omit(m, m->loads.mass_damping > 0.0, "the damping of masses, %.17g 1/s", m->loads.mass_damping);
    omit(m, rigid > 0, "the rigidity of %lld node%s", (long long)rigid, plural(rigid));
    omit(m, broken > 0, "the loss of stiffness beside %lld broken triangle%s", (long long)broken, plural(broken));
    omit(m, obstacles > 0, "%lld obstacle%s", (long long)obstacles, plural(obstacles));
    omit(m, held > 0, "%lld boundary condition%s", (long long)held, plural(held));
    omit(m, !m->loads.known, "gravity, which a run without a deck does not state");
}

bool molecule_make(molecule *out, const task *t)
{
    *out = (molecule){.task = t, .lattice = dem_reader_lattice(t->reader)};
    if (!find_atoms(out) || !find_bonds(out) || !find_gone(out) || !find_state(out) || !loads_find(&out->loads, t))
        return false;
    find_omissions(out);
    return true;
}

void molecule_free(molecule *m)
{
    kinds_free(&m->atoms);
    kinds_free(&m->bonds);
    free(m->gone);
    free(m->own[0]);
    free(m->own[1]);
    *m = (molecule){0};
}
