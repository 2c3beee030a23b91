/* SPDX-License-Identifier: BSD-3-Clause */
#include "shape/msh.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text_reader.h"

enum { TYPE_LINE = 1, TYPE_TRIANGLE = 2, TYPE_POINT = 15 }; /* of elements */
enum { NODE_BYTES = 8, ELEMENT_BYTES = 4 };                 /* "1\n0 0 0\n", "1 1\n" */

typedef struct label {
    int64_t tag;
    dem_index node;
} label;

/* What has been read. */
typedef struct mesh {
    dem_index n_nodes, n_triangles;
    double *x;            /* [n_nodes][2] */
    label *labels;        /* [n_nodes], by tag once all are there */
    dem_index *triangles; /* [n_triangles][3], counter-clockwise */
    size_t *lines;        /* [n_triangles] where they stand */
    bool out_of_memory;
} mesh;

static bool lack(mesh *m)
{
    m->out_of_memory = true;
    return false;
}

static void drop(mesh *m)
{
    free(m->x);
    free(m->labels);
    free(m->triangles);
    free(m->lines);
}

/* ---- nodes ---- */

static int by_tag(const void *a, const void *b)
{
    const int64_t p = ((const label *)a)->tag, q = ((const label *)b)->tag;
    return (p > q) - (p < q);
}

static bool read_node(mesh *m, text_reader *w, dem_index i, int64_t parameters)
{
    double z, parameter;
    if (!text_reader_real(w, "x", &m->x[2 * i]) || !text_reader_real(w, "y", &m->x[2 * i + 1]) ||
        !text_reader_real(w, "z", &z))
        return false;
    if (z != 0.0) return text_reader_fail(w, "the mesh must lie in the plane z = 0, but a node has z = %g", z);
    for (int64_t k = 0; k < parameters; k++)
        if (!text_reader_real(w, "a parameter", &parameter)) return false;
    return true;
}

/* The tags of a block stand before its places. */
static bool read_node_block(mesh *m, text_reader *w, dem_index first, dem_index total, dem_index *n)
{
    int64_t dimension, entity, parametric, count;
    if (!text_reader_integer(w, "the dimension", 0, 3, &dimension) ||
        !text_reader_integer(w, "the entity", INT64_MIN, INT64_MAX, &entity) ||
        !text_reader_integer(w, "'parametric'", 0, 1, &parametric) ||
        !text_reader_integer(w, "the number of nodes in a block", 0, total - first, &count))
        return false;
    for (dem_index k = first; k < first + count; k++) {
        m->labels[k].node = k;
        if (!text_reader_integer(w, "the tag of a node", 1, INT64_MAX, &m->labels[k].tag)) return false;
    }
    for (dem_index k = first; k < first + count; k++)
        if (!read_node(m, w, k, parametric != 0 ? dimension : 0)) return false;
    *n = count;
    return true;
}

static bool sort_labels(mesh *m, text_reader *w)
{
    qsort(m->labels, (size_t)m->n_nodes, sizeof *m->labels, by_tag);
    for (dem_index k = 1; k < m->n_nodes; k++)
        if (m->labels[k].tag == m->labels[k - 1].tag)
            return text_reader_fail(w, "two nodes have the tag %lld", (long long)m->labels[k].tag);
    return true;
}

/* How many blocks and how many things of at least `bytes` there are; their least and largest tags are not needed. */
static bool read_counts(text_reader *w, const char *things, size_t bytes, int64_t *blocks, int64_t *n)
{
    int64_t unused;
    if (!text_reader_integer(w, "the number of blocks", 0, INT64_MAX, blocks) ||
        !text_reader_integer(w, "how many there are", 1, INT64_MAX, n))
        return false;
    if (*n > (int64_t)(text_reader_left(w) / bytes))
        return text_reader_fail(w, "%lld %s do not fit in the %zu bytes that follow", (long long)*n, things,
                                text_reader_left(w));
    return text_reader_integer(w, "the least tag", 0, INT64_MAX, &unused) &&
           text_reader_integer(w, "the largest tag", 0, INT64_MAX, &unused);
}

static bool read_nodes(mesh *m, text_reader *w)
{
    int64_t blocks, total;
    if (m->x != NULL) return text_reader_fail(w, "a second section of nodes");
    if (!read_counts(w, "nodes", NODE_BYTES, &blocks, &total)) return false;
    m->x = calloc((size_t)total, 2 * sizeof *m->x);
    m->labels = calloc((size_t)total, sizeof *m->labels);
    if (m->x == NULL || m->labels == NULL) return lack(m);
    for (int64_t k = 0; k < blocks; k++) {
        dem_index n = 0;
        if (!read_node_block(m, w, m->n_nodes, total, &n)) return false;
        m->n_nodes += n;
    }
    if (m->n_nodes != total)
        return text_reader_fail(w, "%lld nodes are announced, the blocks have %lld", (long long)total,
                                (long long)m->n_nodes);
    return text_reader_expect(w, "$EndNodes") && sort_labels(m, w);
}

/* ---- elements ---- */

static bool read_corner(const mesh *m, text_reader *w, dem_index *node)
{
    label key = {0};
    if (!text_reader_integer(w, "the node of an element", 1, INT64_MAX, &key.tag)) return false;
    const label *found = bsearch(&key, m->labels, (size_t)m->n_nodes, sizeof key, by_tag);
    if (found == NULL) return text_reader_fail(w, "there is no node %lld", (long long)key.tag);
    *node = found->node;
    return true;
}

static bool read_triangle(mesh *m, text_reader *w)
{
    dem_index *corner = m->triangles + 3 * m->n_triangles;
    for (int c = 0; c < 3; c++)
        if (!read_corner(m, w, &corner[c])) return false;
    const double *a = m->x + 2 * corner[0], *b = m->x + 2 * corner[1], *c = m->x + 2 * corner[2];
    const double area = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
    if (!isnormal(area)) return text_reader_fail(w, "a triangle has the area %g", area);
    if (area < 0.0) {
        const dem_index second = corner[1];
        corner[1] = corner[2];
        corner[2] = second;
    }
    m->lines[m->n_triangles++] = w->last;
    return true;
}

static bool read_element(mesh *m, text_reader *w, int64_t type)
{
    int64_t unused;
    dem_index node;
    if (!text_reader_integer(w, "the tag of an element", 1, INT64_MAX, &unused)) return false;
    if (type == TYPE_TRIANGLE) return read_triangle(m, w);
    for (int k = 0; k < (type == TYPE_LINE ? 2 : 1); k++)
        if (!read_corner(m, w, &node)) return false;
    return true;
}

static bool read_element_block(mesh *m, text_reader *w, int64_t most_elements, int64_t *n)
{
    int64_t dimension, entity, type;
    if (!text_reader_integer(w, "the dimension", 0, 3, &dimension) ||
        !text_reader_integer(w, "the entity", INT64_MIN, INT64_MAX, &entity) ||
        !text_reader_integer(w, "the type of elements", 1, INT32_MAX, &type))
        return false;
    if (type != TYPE_LINE && type != TYPE_TRIANGLE && type != TYPE_POINT)
        return text_reader_fail(w, "elements of type %lld; only triangles of 3 nodes, type 2, can be read",
                                (long long)type);
    if (!text_reader_integer(w, "the number of elements in a block", 0, most_elements, n)) return false;
    for (int64_t k = 0; k < *n; k++)
        if (!read_element(m, w, type)) return false;
    return true;
}

static bool read_elements(mesh *m, text_reader *w)
{
    int64_t blocks, total, read = 0;
    if (m->x == NULL) return text_reader_fail(w, "the elements stand before the nodes");
    if (m->triangles != NULL) return text_reader_fail(w, "a second section of elements");
    if (!read_counts(w, "elements", ELEMENT_BYTES, &blocks, &total)) return false;
    m->triangles = calloc((size_t)total, 3 * sizeof *m->triangles);
    m->lines = calloc((size_t)total, sizeof *m->lines);
    if (m->triangles == NULL || m->lines == NULL) return lack(m);
    for (int64_t k = 0; k < blocks; k++) {
        int64_t n = 0;
        if (!read_element_block(m, w, total - read, &n)) return false;
        read += n;
    }
    if (read != total)
        return text_reader_fail(w, "%lld elements are announced, the blocks have %lld", (long long)total,
                                (long long)read);
    return text_reader_expect(w, "$EndElements");
}

/* ---- the whole ---- */

typedef struct arrow {
    dem_index from, to;
    size_t line;
} arrow;

static int by_ends(const void *a, const void *b)
{
    const arrow *p = a, *q = b;
    if (p->from != q->from) return p->from < q->from ? -1 : 1;
    if (p->to != q->to) return p->to < q->to ? -1 : 1;
    return (p->line > q->line) - (p->line < q->line);
}

/* Counter-clockwise triangles on the same side of an edge overlap. */
static bool check_overlaps(mesh *m, text_reader *w)
{
    const size_t n = 3 * (size_t)m->n_triangles;
    arrow *list = calloc(n, sizeof *list);
    bool good = true;
    if (list == NULL) return lack(m);
    for (size_t k = 0; k < n; k++)
        list[k] = (arrow){m->triangles[k], m->triangles[k % 3 == 2 ? k - 2 : k + 1], m->lines[k / 3]};
    qsort(list, n, sizeof *list, by_ends);
    for (size_t k = 1; k < n && good; k++) {
        if (list[k].from != list[k - 1].from || list[k].to != list[k - 1].to) continue;
        w->last = list[k].line;
        good = text_reader_fail(w, "this triangle overlaps that of line %zu", list[k - 1].line);
    }
    free(list);
    return good;
}

static bool read_format(text_reader *w)
{
    char version[TEXT_READER_LONGEST + 1];
    int64_t type, size;
    if (!text_reader_expect(w, "$MeshFormat")) return false;
    if (!text_reader_next(w, version) || strcmp(version, "4.1") != 0)
        return text_reader_fail(w, "MSH version 4.1 is expected; 'gmsh -format msh41' writes it");
    if (!text_reader_integer(w, "the type of the file", 0, 1, &type)) return false;
    if (type != 0) return text_reader_fail(w, "a binary mesh; text is expected ('Mesh.Binary = 0')");
    return text_reader_integer(w, "the size of a number", 1, 64, &size) && text_reader_expect(w, "$EndMeshFormat");
}

static bool read_sections(mesh *m, text_reader *w)
{
    char name[TEXT_READER_LONGEST + 1], end[TEXT_READER_LONGEST + 8];
    while (text_reader_next(w, name)) {
        bool good;
        if (strcmp(name, "$Nodes") == 0) {
            good = read_nodes(m, w);
        } else if (strcmp(name, "$Elements") == 0) {
            good = read_elements(m, w);
        } else if (name[0] == '$') {
            (void)snprintf(end, sizeof end, "$End%s", name + 1);
            good = text_reader_seek(w, end);
        } else {
            good = text_reader_fail(w, "a section is expected, which begins with '$'");
        }
        if (!good) return false;
    }
    if (w->fault[0] != '\0') return false;
    return m->n_triangles > 0 ? check_overlaps(m, w) : text_reader_fail(w, "the mesh has no triangles");
}

/* Hands the arrays over and drops nodes without triangles. */
static dem_status give(dem_lattice *out, mesh *m)
{
    bool *keep = malloc((size_t)m->n_triangles);
    if (keep == NULL) return DEM_ERROR_MEMORY;
    memset(keep, 1, (size_t)m->n_triangles);
    out->n_nodes = m->n_nodes, out->n_triangles = m->n_triangles;
    out->x = m->x, out->triangles = m->triangles;
    m->x = NULL, m->triangles = NULL;
    const dem_status status = dem_lattice_trim(out, keep);
    if (status != DEM_OK) dem_lattice_free(out);
    free(keep);
    return status;
}

dem_status msh_parse(dem_lattice *out, char *fault, const char *text, size_t size)
{
    mesh m = {0};
    text_reader w = text_reader_begin(text, size, '\0');
    *out = dem_lattice_empty();
    const bool good = read_format(&w) && read_sections(&m, &w);
    dem_status status = m.out_of_memory ? DEM_ERROR_MEMORY : DEM_ERROR_MODEL;
    if (good)
        status = give(out, &m);
    else
        (void)snprintf(fault, MSH_FAULT, "%zu: %s", w.last, w.fault);
    drop(&m);
    return status;
}
