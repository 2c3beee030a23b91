/* SPDX-License-Identifier: BSD-3-Clause */
#include "csv.h"

#include <stdlib.h>
#include <string.h>

#include "label.h"
#include "sheet.h"
#include "still.h"

enum { ENDING = 128 };

/* Numbers that are held of a table at a time: 32 MB. */
static const dem_index most_numbers = 1 << 22;

static void end_row(sheet *s)
{
    sheet_print(s, "\r\n");
}

static void write_unit(sheet *s, const char *unit)
{
    if (*unit != '\0') sheet_print(s, " [%s]", unit);
}

static void write_name(sheet *s, const char *name, const char *component, const char *unit)
{
    sheet_print(s, "%s%s%s", name, *component != '\0' ? "_" : "", component);
    write_unit(s, unit);
}

/* ---- frames ---- */

static const struct {
    const char *ending, *head;
} of_frames[] = {{".nodes.csv", "frame,t [s],node,x [m],y [m]"}, {".springs.csv", "frame,t [s],spring,first,second"}};

static void write_still_head(sheet *s, const still *frame, int of_springs)
{
    sheet_print(s, "%s", of_frames[of_springs].head);
    for (dem_index a = 0; a < frame->n_arrays; a++) {
        const dem_reader_array *what = frame->arrays[a].what;
        for (int c = 0; c < what->components; c++) {
            sheet_print(s, ",");
            write_name(s, what->name, label_component(what->name, c, what->components), what->unit);
        }
    }
    end_row(s);
}

static void write_still_row(sheet *s, const still *frame, int of_springs, dem_index row)
{
    const dem_index *ends = dem_reader_lattice(frame->task->reader)->ends;
    if (of_springs)
        sheet_print(s, "%lld,%lld,%lld", (long long)row, (long long)ends[2 * row], (long long)ends[2 * row + 1]);
    else
        sheet_print(s, "%lld,%.17g,%.17g", (long long)row, frame->x[2 * row], frame->x[2 * row + 1]);
    for (dem_index a = 0; a < frame->n_arrays; a++) {
        const dem_reader_array *what = frame->arrays[a].what;
        for (int c = 0; c < what->components; c++) {
            sheet_print(s, ",");
            sheet_number(s, frame->arrays[a].values[row * what->components + c], what->type);
        }
    }
    end_row(s);
}

static bool write_stills(sheet *s, still *frame, int of_springs)
{
    const frame_list *frames = &frame->task->frames;
    dem_index n = 0;
    const double *times = dem_reader_times(frame->task->reader, &n);
    const dem_index rows = of_springs ? frame->n_springs : frame->n_nodes;
    write_still_head(s, frame, of_springs);
    for (size_t k = 0; k < frames->n; k++) {
        const dem_index number = frames->frame[k];
        if (!still_read(frame, number)) return false;
        for (dem_index row = 0; row < rows; row++) {
            sheet_print(s, "%lld,%.17g,", (long long)number, times[number]);
            write_still_row(s, frame, of_springs, row);
        }
    }
    return true;
}

static bool export_frames(const task *t, int of_springs)
{
    const still_choice choice = {.of_springs = of_springs};
    still frame;
    sheet s;
    bool good = still_open(&frame, t, &choice) && sheet_open(&s, t, "", of_frames[of_springs].ending);
    if (good) good = sheet_close(&s, write_stills(&s, &frame, of_springs));
    still_free(&frame);
    return good;
}

/* ---- tables ---- */

/* The columns of one table, which follow each other. */
typedef struct table {
    const dem_reader_column *columns; /* [n] */
    dem_index n, width;               /* numbers in a row */
} table;

/* The table that begins with a column. */
static table find_table(const dem_reader_column *columns, dem_index n)
{
    table found = {columns, 0, 0};
    while (found.n < n && strcmp(columns[found.n].table, columns->table) == 0) found.width += columns[found.n++].width;
    return found;
}

/* probes/NAME becomes .probes.NAME.csv. */
static void name_table(char ending[ENDING], const table *t)
{
    (void)snprintf(ending, ENDING, ".%s.csv", t->columns->table);
    for (char *c = ending; *c != '\0'; c++)
        if (*c == '/') *c = '.';
}

/* Items have numbers: body_centre_0_x. */
static void write_column_names(sheet *s, const dem_reader_column *c, bool numbered)
{
    for (dem_index k = 0; k < c->width; k++) {
        const char *component = label_component(c->name, k % c->components, c->components);
        if (k > 0) sheet_print(s, ",");
        sheet_print(s, "%s", c->name);
        if (numbered) sheet_print(s, "_%lld", (long long)(k / c->components));
        write_name(s, "", component, c->unit);
    }
}

/* Those of bodies, obstacles and boundaries, of however few. */
static bool has_items(const dem_reader_column *c)
{
    static const char *const items[] = {"body_", "obstacle_", "boundary_"};
    for (size_t k = 0; k < sizeof items / sizeof *items; k++)
        if (strcmp(c->table, "history") == 0 && strncmp(c->name, items[k], strlen(items[k])) == 0) return true;
    return c->items > 1;
}

static void write_table_head(sheet *s, const table *t)
{
    for (dem_index c = 0; c < t->n; c++) {
        if (c > 0) sheet_print(s, ",");
        write_column_names(s, &t->columns[c], has_items(&t->columns[c]));
    }
    end_row(s);
}

/* Columns lie behind one another, [count][width] each. */
static void write_rows(sheet *s, const table *t, dem_index count, const double *values)
{
    for (dem_index row = 0; row < count; row++) {
        const double *column = values;
        for (dem_index c = 0; c < t->n; c++) {
            const dem_index width = t->columns[c].width;
            for (dem_index k = 0; k < width; k++) {
                if (c > 0 || k > 0) sheet_print(s, ",");
                sheet_number(s, column[row * width + k], t->columns[c].type);
            }
            column += count * width;
        }
        end_row(s);
    }
}

static bool read_rows(const task *t, const table *of, dem_index first, dem_index count, double *values)
{
    for (dem_index c = 0; c < of->n; c++) {
        if (!task_holds(t, dem_reader_read_rows(t->reader, &of->columns[c], first, count, values))) return false;
        values += count * of->columns[c].width;
    }
    return true;
}

static bool write_table(sheet *s, const task *t, const table *of)
{
    const dem_index rows = of->columns->n_rows, at_once = of->width < most_numbers ? most_numbers / of->width : 1;
    const dem_index most = rows < at_once ? rows : at_once;
    double *values = task_allocate(t, most * of->width, sizeof *values);
    bool good = values != NULL;
    write_table_head(s, of);
    for (dem_index first = 0; good && first < rows; first += most) {
        const dem_index count = rows - first < most ? rows - first : most;
        good = read_rows(t, of, first, count, values);
        if (good) write_rows(s, of, count, values);
    }
    free(values);
    return good;
}

static bool export_table(const task *t, const table *of)
{
    char ending[ENDING];
    sheet s;
    name_table(ending, of);
    return sheet_open(&s, t, "", ending) && sheet_close(&s, write_table(&s, t, of));
}

/* ---- all ---- */

static bool each_table(const task *t, bool (*act)(const task *t, const table *of))
{
    dem_index n = 0;
    const dem_reader_column *columns = dem_reader_columns(t->reader, &n);
    for (dem_index k = 0; k < n;) {
        const table found = find_table(columns + k, n - k);
        if (!act(t, &found)) return false;
        k += found.n;
    }
    return true;
}

static bool table_is_free(const task *t, const table *of)
{
    char ending[ENDING];
    name_table(ending, of);
    return sheet_is_free(t, "", ending);
}

bool csv_export(const task *t)
{
    bool good = each_table(t, table_is_free);
    for (int k = 0; good && t->frames.n > 0 && k < 2; k++) good = sheet_is_free(t, "", of_frames[k].ending);
    for (int k = 0; good && t->frames.n > 0 && k < 2; k++) good = export_frames(t, k);
    return good && each_table(t, export_table);
}
