/* SPDX-License-Identifier: BSD-3-Clause */
/* From a caller's mesh, a file or its text, to a lattice: dem/shape.h. */
#include <dem/shape.h>

#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/status.h"
#include "base/struct_size.h"
#include "lattice/lattice.h"
#include "shape/msh.h"
#include "shape/triangle_numbers.h"

static const size_t most = (size_t)1 << 30; /* bytes of a file */

enum { SHOWN = 200 }; /* bytes of a path in messages, which must not lose what is wrong */

static dem_status read_mesh(dem_mesh *ours, const dem_mesh *theirs)
{
    static const struct_kind kind = {"dem_mesh", STRUCT_SIZE_WITH(dem_mesh, numbered), sizeof(dem_mesh)};
    CHECK(theirs != NULL, DEM_ERROR_ARGUMENT, "mesh is NULL");
    TRY(struct_size_read(&kind, ours, theirs));
    CHECK((ours->path != NULL) != (ours->text != NULL), DEM_ERROR_ARGUMENT,
          "a mesh must have a path or a text, and not both");
    CHECK(ours->size >= 0, DEM_ERROR_ARGUMENT, "the text of a mesh must have 0 bytes or more, got %lld",
          (long long)ours->size);
    CHECK(lattice_is_positive(ours->scale), DEM_ERROR_ARGUMENT, "the scale of a mesh must be > 0, got %g m",
          ours->scale);
    return DEM_OK;
}

/* Of a long path its end. */
static const char *name_of(const dem_mesh *ours)
{
    if (ours->path == NULL) return "the mesh";
    const size_t length = strlen(ours->path);
    return length > SHOWN ? ours->path + length - SHOWN : ours->path;
}

static dem_status parse(dem_lattice *out, const dem_mesh *ours, const char *text, size_t size)
{
    char fault[MSH_FAULT];
    const dem_status status = msh_parse(out, fault, text, size);
    CHECK(status != DEM_ERROR_MODEL, DEM_ERROR_MODEL, "%s:%s", name_of(ours), fault);
    CHECK(status != DEM_ERROR_MEMORY, DEM_ERROR_MEMORY, "out of memory for the mesh of %zu bytes", size);
    return status;
}

static dem_status parse_file(dem_lattice *out, const dem_mesh *ours)
{
    char *text, why[FILE_WHY];
    size_t size;
    const file_status read = file_read(&text, &size, ours->path, most, why);
    CHECK(read != FILE_REFUSED, DEM_ERROR_IO, "%s: %s", name_of(ours), why);
    CHECK(read == FILE_READ, DEM_ERROR_MEMORY, "out of memory for %s", name_of(ours));
    const dem_status status = parse(out, ours, text, size);
    free(text);
    return status;
}

dem_status dem_mesh_lattice(dem_lattice *out, const dem_mesh *theirs)
{
    dem_mesh ours = {0};
    dem_lattice lattice = dem_lattice_empty();
    TRY(lattice_check_out(out));
    TRY(read_mesh(&ours, theirs));
    TRY(ours.path != NULL ? parse_file(&lattice, &ours) : parse(&lattice, &ours, ours.text, (size_t)ours.size));
    for (dem_index k = 0; k < 2 * lattice.n_nodes; k++) lattice.x[k] *= ours.scale;
    const dem_status status = ours.numbered ? triangle_numbers_add(&lattice) : DEM_OK;
    if (status == DEM_OK)
        lattice_give(out, &lattice);
    else
        dem_lattice_free(&lattice);
    return status;
}
