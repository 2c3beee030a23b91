/* SPDX-License-Identifier: BSD-3-Clause */
#include "script.h"

#include <math.h>

#include "sheet.h"

/* Velocity Verlet is stable up to 2/omega. */
static const double usual_step = 0.1; /* times 1/omega */

typedef struct course {
    double time; /* s */
    double steps;
} course;

/* Springs alone: area term and couplings are left out. */
static bool find_omega(const molecule *m, double *omega)
{
    dem_lattice springs = *m->lattice;
    dem_model *model = NULL;
    springs.area_stiffness = springs.coupling = NULL;
    if (!task_holds(m->task, dem_model_create(&model, &springs, NULL, 0))) return false;
    *omega = dem_model_omega_max(model);
    dem_model_destroy(model);
    return true;
}

static bool plan(const molecule *m, course *out)
{
    dem_index n = 0;
    double omega = 0.0, end = m->t;
    const double *times = dem_reader_times(m->task->reader, &n);
    for (size_t k = 0; k < m->task->frames.n; k++) end = fmax(end, times[m->task->frames.frame[k]]);
    if (!find_omega(m, &omega)) return false;
    const double step = omega > 0.0 ? usual_step / omega : end > m->t ? 1e-3 * (end - m->t) : 1.0;
    out->time = end > m->t ? end - m->t : 1000.0 * step;
    out->steps = ceil(out->time / step);
    return true;
}

static void write_head(sheet *s, const molecule *m, const course *c)
{
    const char *name = m->task->name;
    sheet_print(s, "# LAMMPS input by dem_export: the body of %s.data from t = %.17g s on, moving freely.\n", name,
                m->t);
    if (m->omissions[0] != '\0') sheet_print(s, "# %s\n", m->omissions);
    sheet_print(s, "# lmp -in in.%s              to the last frame\n", name);
    sheet_print(s, "# lmp -in in.%s -var n 4000  in so many steps; -var time 1e-3: so long, s\n", name);
    sheet_print(s, "variable time index %.17g\nvariable n index %.0f\n\n", c->time, c->steps);
}

static void write_body(sheet *s, const molecule *m)
{
    sheet_print(s, "units si\ndimension 2\nboundary s s p\natom_style bond\natom_modify map array\nnewton on\n");
    sheet_print(s, "pair_style none\nbond_style %s\nspecial_bonds lj 0 1 1\n", m->bonds.n > 0 ? "harmonic" : "none");
    sheet_print(s, "comm_modify cutoff %.17g\nneighbor %.17g bin\n", 2.5 * m->longest, 0.5 * m->longest);
    sheet_print(s, "read_data %s.data\n\n", m->task->name);
}

/* Types of fixed nodes are the last ones. */
static void write_motion(sheet *s, const molecule *m)
{
    const double *g = m->loads.gravity, size = hypot(g[0], g[1]);
    dem_index free_types = 0;
    while (free_types < m->atoms.n && m->atoms.values[free_types].a == 0.0) free_types++;
    if (free_types > 0) sheet_print(s, "group free type 1:%lld\n", (long long)free_types);
    if (free_types == 0) sheet_print(s, "group free empty\n");
    sheet_print(s, "fix move free nve\n");
    if (size > 0.0)
        sheet_print(s, "fix weight free gravity %.17g vector %.17g %.17g 0\n", size, g[0] / size, g[1] / size);
    sheet_print(s, "fix plane all enforce2d\n\n");
}

static void write_run(sheet *s, const molecule *m)
{
    sheet_print(s, "variable h equal v_time/v_n\ntimestep ${h}\n");
    sheet_print(s, "thermo_style custom step time pe ke etotal\nthermo_modify format float %%.15g\n");
    sheet_print(s, "run ${n}\n");
    sheet_print(s, "write_dump all custom %s.end.dump id type x y vx vy modify sort id format float %%.17g\n",
                m->task->name);
}

bool script_write(const molecule *m)
{
    sheet s;
    course c;
    if (!plan(m, &c) || !sheet_open(&s, m->task, "in.", "")) return false;
    write_head(&s, m, &c);
    write_body(&s, m);
    write_motion(&s, m);
    write_run(&s, m);
    return sheet_close(&s, true);
}
