/* SPDX-License-Identifier: BSD-3-Clause */
#include "quantity.h"

#include <math.h>
#include <string.h>

enum { LENGTH = -1 };

/* The first that a trajectory has is the default. */
static const struct {
    const char *name, *array;
    int part;
    palette_kind scale;
    const char *label;
} known[] = {
    {"strain", "strain", 0, PALETTE_DIVERGING, "strain of springs"},
    {"force", "force", 0, PALETTE_DIVERGING, "force in springs"},
    {"von_mises", "von_mises", 0, PALETTE_SEQUENTIAL, "von Mises stress"},
    {"speed", "velocity", LENGTH, PALETTE_SEQUENTIAL, "speed"},
    {"velocity_x", "velocity", 0, PALETTE_DIVERGING, "velocity along x"},
    {"velocity_y", "velocity", 1, PALETTE_DIVERGING, "velocity along y"},
    {"displacement", "displacement", LENGTH, PALETTE_SEQUENTIAL, "displacement"},
    {"stress_xx", "stress", 0, PALETTE_DIVERGING, "stress xx"},
    {"stress_yy", "stress", 1, PALETTE_DIVERGING, "stress yy"},
    {"stress_xy", "stress", 3, PALETTE_DIVERGING, "stress xy"},
    {"principal_1", "principal_stress", 0, PALETTE_DIVERGING, "larger principal stress"},
    {"principal_2", "principal_stress", 1, PALETTE_DIVERGING, "smaller principal stress"},
    {"contact_pressure", "contact_pressure", 0, PALETTE_SEQUENTIAL, "contact pressure"},
    {"contact_force", "contact_force", LENGTH, PALETTE_SEQUENTIAL, "contact force"},
    {"fragment", "fragment", 0, PALETTE_PIECES, "fragments, grey: half of a body or more"},
    {"damage", "damage", 0, PALETTE_SEQUENTIAL, "damage"},
    {"peak_strain", "peak_strain", 0, PALETTE_DIVERGING, "peak strain of springs"},
    {"peak_von_mises", "peak_von_mises", 0, PALETTE_SEQUENTIAL, "peak von Mises stress"},
};

enum { KNOWN = sizeof known / sizeof *known };

_Static_assert((int)KNOWN == (int)QUANTITY_KNOWN, "as the header has it");

static const char none[] = "none";

bool quantity_is_known(const char *name)
{
    size_t k = 0;
    while (k < KNOWN && strcmp(name, known[k].name) != 0) k++;
    return k < KNOWN || strcmp(name, none) == 0;
}

bool quantity_is_unordered(const char *name)
{
    for (size_t k = 0; k < KNOWN; k++)
        if (strcmp(name, known[k].name) == 0) return known[k].scale == PALETTE_PIECES;
    return false;
}

void quantity_list(FILE *out)
{
    for (size_t k = 0; k < KNOWN; k++) (void)fprintf(out, "%s, ", known[k].name);
    (void)fputs(none, out);
}

bool quantity_at(quantity *q, const dem_reader *reader, size_t k)
{
    const dem_reader_array *source = dem_reader_array_find(reader, known[k].array);
    *q = (quantity){known[k].name, known[k].label, source, known[k].part, known[k].scale};
    return source != NULL;
}

bool quantity_find(quantity *q, const dem_reader *reader, const char *name, outcome *o)
{
    *q = (quantity){.name = none, .label = ""};
    if (name != NULL && strcmp(name, none) == 0) return true;
    for (size_t k = 0; k < KNOWN; k++) {
        if (name != NULL && strcmp(name, known[k].name) != 0) continue;
        if (quantity_at(q, reader, k)) return true;
        *q = (quantity){.name = none, .label = ""};
        if (name == NULL) continue;
        outcome_fail(o, EXIT_INVALID, "dem_plot", "the file has no '%s' to colour by: 'fields' in &output names it",
                     known[k].array);
        return false;
    }
    return true;
}

bool quantity_fills_triangles(const quantity *q, const dem_lattice *lattice)
{
    return q->source != NULL && !q->source->of_springs && lattice->n_triangles > 0;
}

size_t quantity_count(const quantity *q, const dem_lattice *lattice)
{
    if (q->source == NULL) return 0;
    return (size_t)(q->source->of_springs ? lattice->n_springs : lattice->n_nodes);
}

static double reduce(const double *row, int components, int part)
{
    if (part != LENGTH) return part < components ? row[part] : (double)NAN;
    double sum = 0.0;
    for (int k = 0; k < components; k++) sum += row[k] * row[k];
    return sqrt(sum);
}

dem_status quantity_read(const quantity *q, const dem_reader *reader, dem_index frame, double *value, double *rows)
{
    const size_t n = quantity_count(q, dem_reader_lattice(reader)), components = (size_t)q->source->components;
    const dem_status status = dem_reader_read(reader, q->source, frame, rows);
    for (size_t k = 0; k < n && status == DEM_OK; k++)
        value[k] = reduce(rows + components * k, q->source->components, q->part);
    return status;
}
