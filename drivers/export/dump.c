/* SPDX-License-Identifier: BSD-3-Clause */
/* The time step of a frame is its number. */
#include "dump.h"

#include <string.h>

#include "label.h"
#include "sheet.h"
#include "still.h"

static const char broken[] = "broken";

static void write_head(sheet *s, const molecule *m, const still *frame, dem_index number, const char *items,
                       dem_index n_items)
{
    const molecule_box box = molecule_box_of(m, frame->x);
    sheet_print(s, "ITEM: TIMESTEP\n%lld\nITEM: NUMBER OF %s\n%lld\n", (long long)number, items, (long long)n_items);
    sheet_print(s, "ITEM: BOX BOUNDS ss ss pp\n%.17g %.17g\n%.17g %.17g\n%.17g %.17g\nITEM: %s", box.low[0],
                box.high[0], box.low[1], box.high[1], -0.5 * m->longest, 0.5 * m->longest, items);
}

/* LAMMPS has names of its own for velocities only. */
static void write_names(sheet *s, const still *frame)
{
    for (dem_index a = 0; a < frame->n_arrays; a++) {
        const dem_reader_array *what = frame->arrays[a].what;
        for (int c = 0; c < what->components && !what->constant && strcmp(what->name, broken) != 0; c++) {
            const char *component = label_component(what->name, c, what->components);
            if (strcmp(what->name, "velocity") == 0)
                sheet_print(s, " v%s", component);
            else
                sheet_print(s, " %s%s%s", what->name, *component != '\0' ? "_" : "", component);
        }
    }
    sheet_print(s, "\n");
}

static void write_values(sheet *s, const still *frame, dem_index row)
{
    for (dem_index a = 0; a < frame->n_arrays; a++) {
        const still_array *array = &frame->arrays[a];
        const dem_reader_array *what = array->what;
        for (int c = 0; c < what->components && !what->constant && strcmp(what->name, broken) != 0; c++) {
            sheet_print(s, " ");
            sheet_number(s, array->values[row * what->components + c], what->type);
        }
    }
    sheet_print(s, "\n");
}

static void write_atoms(sheet *s, const molecule *m, const still *frame, dem_index number)
{
    const dem_lattice *l = m->lattice;
    write_head(s, m, frame, number, "ATOMS", l->n_nodes);
    sheet_print(s, " id mol type x y z");
    write_names(s, frame);
    for (dem_index i = 0; i < l->n_nodes; i++) {
        sheet_print(s, "%lld %lld %lld %.17g %.17g 0", (long long)i + 1,
                    l->body != NULL ? (long long)l->body[i] + 1 : 1LL, (long long)m->atoms.of[i] + 1, frame->x[2 * i],
                    frame->x[2 * i + 1]);
        write_values(s, frame, i);
    }
}

/* Broken ones are left out. */
static void write_bonds(sheet *s, const molecule *m, const still *frame, dem_index number)
{
    const dem_lattice *l = m->lattice;
    const double *gone = still_values(frame, broken);
    dem_index n = 0;
    for (dem_index k = 0; k < l->n_springs; k++) n += gone == NULL || gone[k] == 0.0;
    write_head(s, m, frame, number, "ENTRIES", n);
    sheet_print(s, " index btype batom1 batom2");
    write_names(s, frame);
    for (dem_index k = 0; k < l->n_springs; k++) {
        if (gone != NULL && gone[k] != 0.0) continue;
        sheet_print(s, "%lld %lld %lld %lld", (long long)k + 1, (long long)m->bonds.of[k] + 1,
                    (long long)l->ends[2 * k] + 1, (long long)l->ends[2 * k + 1] + 1);
        write_values(s, frame, k);
    }
}

static bool write_all(const molecule *m, const char *ending, int of_springs)
{
    const still_choice choice = {.of_springs = of_springs};
    const frame_list *frames = &m->task->frames;
    still frame;
    sheet s;
    bool good = still_open(&frame, m->task, &choice);
    const bool opened = good && sheet_open(&s, m->task, "", ending);
    good = opened;
    for (size_t k = 0; good && k < frames->n; k++) {
        good = still_read(&frame, frames->frame[k]);
        if (good) (of_springs ? write_bonds : write_atoms)(&s, m, &frame, frames->frame[k]);
    }
    if (opened) good = sheet_close(&s, good);
    still_free(&frame);
    return good;
}

bool dump_atoms(const molecule *m)
{
    return write_all(m, ".dump", 0);
}

bool dump_bonds(const molecule *m)
{
    return write_all(m, ".local.dump", 1);
}
