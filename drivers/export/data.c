/* SPDX-License-Identifier: BSD-3-Clause */
#include "data.h"

#include "sheet.h"

/* The rest of a line behind # is comment. */
static void write_head(sheet *s, const molecule *m)
{
    const molecule_box box = molecule_box_of(m, m->x);
    const double z = 0.5 * m->longest;
    sheet_print(s, "LAMMPS data file by dem_export of %s at t = %.17g s, units = si, 2-d\n", m->task->name, m->t);
    if (m->omissions[0] != '\0') sheet_print(s, "# %s\n", m->omissions);
    sheet_print(s,
                "# atom = node + 1, bond = spring + 1, molecule = body + 1; E = K (r - r0)^2, K = stiffness/(2 r0)\n");
    sheet_print(s, "\n%lld atoms\n%lld bonds\n", (long long)m->lattice->n_nodes, (long long)m->n_bonds);
    sheet_print(s, "%lld atom types\n%lld bond types\n\n", (long long)m->atoms.n, (long long)m->bonds.n);
    sheet_print(s, "%.17g %.17g xlo xhi\n", box.low[0], box.high[0]);
    sheet_print(s, "%.17g %.17g ylo yhi\n%.17g %.17g zlo zhi\n", box.low[1], box.high[1], -z, z);
}

static void write_types(sheet *s, const molecule *m)
{
    sheet_print(s, "\nMasses\n\n");
    for (dem_index k = 0; k < m->atoms.n; k++)
        sheet_print(s, "%lld %.17g%s\n", (long long)k + 1, m->atoms.values[k].b,
                    m->atoms.values[k].a > 0.0 ? " # fixed" : "");
    if (m->bonds.n > 0) sheet_print(s, "\nBond Coeffs # harmonic\n\n");
    for (dem_index k = 0; k < m->bonds.n; k++) {
        const double stiffness = m->bonds.values[k].a, length = m->bonds.values[k].b;
        sheet_print(s, "%lld %.17g %.17g\n", (long long)k + 1, stiffness / (2.0 * length), length);
    }
}

static void write_atoms(sheet *s, const molecule *m)
{
    const dem_lattice *l = m->lattice;
    sheet_print(s, "\nAtoms # bond\n\n");
    for (dem_index i = 0; i < l->n_nodes; i++)
        sheet_print(s, "%lld %lld %lld %.17g %.17g 0\n", (long long)i + 1,
                    l->body != NULL ? (long long)l->body[i] + 1 : 1LL, (long long)m->atoms.of[i] + 1, m->x[2 * i],
                    m->x[2 * i + 1]);
    sheet_print(s, "\nVelocities\n\n");
    for (dem_index i = 0; i < l->n_nodes; i++)
        sheet_print(s, "%lld %.17g %.17g 0\n", (long long)i + 1, m->v[2 * i], m->v[2 * i + 1]);
}

static void write_bonds(sheet *s, const molecule *m)
{
    const dem_lattice *l = m->lattice;
    if (m->n_bonds > 0) sheet_print(s, "\nBonds\n\n");
    for (dem_index k = 0; k < l->n_springs; k++)
        if (m->gone[k] == 0.0)
            sheet_print(s, "%lld %lld %lld %lld\n", (long long)k + 1, (long long)m->bonds.of[k] + 1,
                        (long long)l->ends[2 * k] + 1, (long long)l->ends[2 * k + 1] + 1);
}

bool data_write(const molecule *m)
{
    sheet s;
    if (!sheet_open(&s, m->task, "", ".data")) return false;
    write_head(&s, m);
    write_types(&s, m);
    write_atoms(&s, m);
    write_bonds(&s, m);
    return sheet_close(&s, true);
}
