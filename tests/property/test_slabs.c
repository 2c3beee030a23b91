/* SPDX-License-Identifier: BSD-3-Clause */
/* The slabs of a lattice are what the whole has at their nodes, to the bit, and each node is one slab's own: random
 * rectangles, discs, rings, polygons and images, less voids and pores, of triangles and squares, jittered or not, in 1
 * to 9 parts, as they are made and as solids of two materials. So are the slabs of files, which end anywhere in a row.
 * `test_slabs [CASES [FIRST_SEED]]`. */
#include "verification/support.h"

#include <dem/trajectory.h>

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <gsl/gsl_rng.h>

#include "domain/domain.h"
#include "harness/cleanup.h"
#include "harness/cleanup_gsl.h"
#include "harness/message.h"
#include "lattice/lattice_arrays.h"
#include "lattice/mesh_edges.h"
#include "output/lattice_file.h"
#include "output/slab_file.h"

static long n_cases = 10000, first_seed = 1;

/* ---- cases ---- */

enum { MOST_VOIDS = 3, POLYGON = 7, PIXELS = 6 };

typedef struct recipe {
    double width, height, spacing, jitter, diagonal; /* diagonal = 0: triangles */
    uint64_t seed;
    dem_index n_parts;
    dem_material solids[2];
    bool is_shape; /* else a whole rectangle */
    dem_shape shape;
    dem_outline outline, voids[MOST_VOIDS];
    dem_image image;
    double points[2 * POLYGON], pores[3 * MOST_VOIDS];
    unsigned char pixels[PIXELS * PIXELS];
} recipe;

static double from(gsl_rng *random, double least, double most)
{
    return least + (most - least) * gsl_rng_uniform(random);
}

static bool toss(gsl_rng *random)
{
    return gsl_rng_uniform_int(random, 2) > 0;
}

/* Seen from the origin corners come in their order, so that edges do not meet. */
static dem_outline draw_polygon(gsl_rng *random, double *points, double size)
{
    for (int k = 0; k < POLYGON; k++) {
        const double angle = (k + from(random, 0.1, 0.9)) * 2.0 * 3.14159265358979 / POLYGON;
        const double reach = from(random, 0.3, 1.0) * size;
        points[2 * k] = reach * cos(angle);
        points[2 * k + 1] = reach * sin(angle);
    }
    return (dem_outline)SIZED(dem_outline, .kind = DEM_OUTLINE_POLYGON, .n_points = POLYGON, .points = points);
}

/* About the origin, of any kind but a polygon. */
static dem_outline draw_round(gsl_rng *random, double size)
{
    dem_outline o = SIZED(dem_outline, .kind = (dem_outline_kind)gsl_rng_uniform_int(random, DEM_OUTLINE_POLYGON),
                          .size = {from(random, 0.5, 2.0) * size, from(random, 0.5, 2.0) * size}, .radius = size,
                          .inner_radius = from(random, 0.2, 0.7) * size);
    return o;
}

static void draw_body(recipe *r, gsl_rng *random, double size)
{
    if (gsl_rng_uniform_int(random, 4) == 0) {
        for (int k = 0; k < PIXELS * PIXELS; k++) r->pixels[k] = gsl_rng_uniform_int(random, 4) > 0;
        r->image = (dem_image)SIZED(dem_image, .width = PIXELS, .height = PIXELS, .pixel = 2.0 * size / PIXELS,
                                    .solid = r->pixels);
        r->shape.image = &r->image;
        return;
    }
    r->outline = toss(random) ? draw_polygon(random, r->points, size) : draw_round(random, size);
    if (toss(random)) r->outline.angle = from(random, -1.0, 1.0);
    for (int c = 0; c < 2 && toss(random); c++) r->outline.centre[c] = from(random, -0.3, 0.3);
    r->shape.outline = &r->outline;
}

/* Some are outside. */
static void draw_voids(recipe *r, gsl_rng *random, double size)
{
    r->shape.n_voids = (dem_index)gsl_rng_uniform_int(random, MOST_VOIDS + 1);
    r->shape.n_pores = (dem_index)gsl_rng_uniform_int(random, MOST_VOIDS + 1);
    for (int k = 0; k < MOST_VOIDS; k++) {
        r->voids[k] = draw_round(random, from(random, 0.05, 0.5) * size);
        r->pores[3 * k + 2] = from(random, 0.05, 0.4) * size;
        for (int c = 0; c < 2; c++) {
            r->voids[k].centre[c] = r->outline.centre[c] + from(random, -0.8, 0.8) * size;
            r->pores[3 * k + c] = r->outline.centre[c] + from(random, -0.8, 0.8) * size;
        }
    }
    r->shape.voids = r->voids;
    r->shape.pores = r->pores;
}

static void draw_shape(recipe *r, gsl_rng *random)
{
    const double size = from(random, 2.0, 8.0) * r->spacing;
    r->shape = (dem_shape)SIZED(dem_shape, .spacing = r->spacing,
                                .grid = r->diagonal > 0.0 ? DEM_GRID_SQUARES : DEM_GRID_TRIANGLES);
    draw_body(r, random, size);
    draw_voids(r, random, size);
}

static void draw_solids(recipe *r, gsl_rng *random)
{
    r->solids[0] = (dem_material)SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 0.3, .density = 1050.0,
                                       .thickness = 0.1, .guard = 0.02, .damping_time = 1e-6);
    if (r->diagonal == 0.0 && toss(random)) r->solids[0].springs = DEM_SPRINGS_COUPLED;
    r->solids[1] = r->solids[0];
    r->solids[1].youngs_modulus = 3e7;
    r->solids[1].damping_time = 0.0;
}

static void draw(recipe *r, gsl_rng *random)
{
    *r = (recipe){.spacing = 1e-3 * from(random, 0.5, 1.5), .seed = gsl_rng_get(random)};
    r->width = from(random, 1.0, 10.0) * r->spacing;
    r->height = from(random, 1.0, 20.0) * r->spacing;
    r->jitter = gsl_rng_uniform_int(random, 3) > 0 ? from(random, 0.0, 0.3) * r->spacing : 0.0;
    r->diagonal = toss(random) ? 0.5 : 0.0;
    r->n_parts = 1 + (dem_index)gsl_rng_uniform_int(random, 9);
    r->is_shape = toss(random);
    draw_solids(r, random);
    if (r->is_shape) draw_shape(r, random);
}

/* Of two materials, the second one in a disc. */
static void assemble(dem_lattice *l, const recipe *r)
{
    const dem_outline inclusion =
        SIZED(dem_outline, .kind = DEM_OUTLINE_DISC, .radius = 2.5 * r->spacing, .centre = {0.0, 1.5 * r->spacing});
    bool *is_inside = malloc((size_t)l->n_triangles * sizeof *is_inside);
    dem_index *of = malloc((size_t)l->n_triangles * sizeof *of);
    assert_ok(dem_lattice_inside(l, &inclusion, r->diagonal > 0.0 ? 2 : 1, is_inside, NULL));
    for (dem_index t = 0; t < l->n_triangles; t++) of[t] = is_inside[t];
    assert_ok(dem_lattice_assemble_mixed(l, r->solids, 2, of, r->diagonal));
    free(is_inside);
    free(of);
}

/* Not jittered yet. */
static dem_status make_whole(dem_lattice *l, const recipe *r)
{
    *l = dem_lattice_empty();
    if (r->is_shape) return dem_shape_lattice(l, &r->shape, NULL);
    return r->diagonal > 0.0 ? dem_lattice_squares(l, r->width, r->height, r->spacing)
                             : dem_lattice_rectangle(l, r->width, r->height, r->spacing);
}

static dem_status make_slab(dem_slab *s, const recipe *r, dem_index part)
{
    *s = dem_slab_empty();
    if (r->is_shape) return dem_slab_shape(s, &r->shape, part, r->n_parts);
    return r->diagonal > 0.0 ? dem_slab_squares(s, r->width, r->height, r->spacing, part, r->n_parts)
                             : dem_slab_rectangle(s, r->width, r->height, r->spacing, part, r->n_parts);
}

/* Of a lattice whose nodes are where the grid has them. */
typedef struct rows {
    dem_index n, largest; /* those with nodes, and the most nodes in one */
} rows;

static rows count_rows(const dem_lattice *l)
{
    rows found = {0};
    dem_index in_row = 0;
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const bool is_new = i == 0 || l->x[2 * i + 1] != l->x[2 * i - 1];
        found.n += is_new;
        in_row = is_new ? 1 : in_row + 1;
        if (in_row > found.largest) found.largest = in_row;
    }
    return found;
}

/* ---- comparison ---- */

static bool is_own(const dem_slab *s, dem_index number)
{
    return number >= s->first_node && number < s->first_node + s->n_own;
}

static bool any_is_own(const dem_slab *s, const dem_index *number, int n)
{
    bool any = false;
    for (int k = 0; k < n; k++) any = any || is_own(s, number[k]);
    return any;
}

/* The number in the whole of a node of the slab. */
static dem_index number_of(const dem_slab *s, dem_index i)
{
    if (i < s->first_own) return s->rim[i];
    return i < s->first_own + s->n_own ? s->first_node + (i - s->first_own) : s->rim[i - s->n_own];
}

/* One item in all arrays of its kind but those of numbers of nodes. An array that is NULL is one of zeros: no strengths
 * are made here. */
static void assert_same_item(const dem_lattice *whole, dem_index at, const dem_lattice *slab, dem_index k,
                             lattice_items of)
{
    static const char zeros[3 * sizeof(double)] = {0};
    for (int a = 0; a < LATTICE_ARRAYS; a++) {
        const lattice_array *array = &lattice_arrays[a];
        const char *there = lattice_array_of(whole, array), *here = lattice_array_of(slab, array);
        if (array->of != of || (const void *)there == whole->ends || (const void *)there == whole->triangles) continue;
        assert_memory_equal(here != NULL ? here + (size_t)k * array->size : zeros,
                            there != NULL ? there + (size_t)at * array->size : zeros, array->size);
    }
}

static void assert_same_nodes(const dem_lattice *whole, const dem_slab *s, dem_index *next)
{
    assert_int_equal(s->n_nodes, whole->n_nodes);
    assert_int_equal(s->n_triangles, whole->n_triangles);
    assert_int_equal(s->first_node, *next);
    *next += s->n_own;
    for (dem_index i = 0; i < s->lattice.n_nodes; i++)
        assert_memory_equal(s->lattice.x + 2 * i, whole->x + 2 * number_of(s, i), 2 * sizeof(double));
    for (dem_index i = s->first_own; i < s->first_own + s->n_own; i++)
        assert_same_item(whole, number_of(s, i), &s->lattice, i, LATTICE_NODES);
}

/* Marks all nodes of what has an own one.  \param corner  [n][arity] */
static void mark_next(bool *is_next, const dem_slab *s, const dem_index *corner, int arity, dem_index n)
{
    for (dem_index k = 0; k < n; k++)
        for (int c = 0; c < arity && any_is_own(s, corner + arity * k, arity); c++)
            is_next[corner[arity * k + c]] = true;
}

/* The nodes next to own ones in springs and triangles, and whether they are on the boundary, if that is known. */
static void assert_same_rim(const dem_lattice *whole, const dem_slab *s)
{
    bool *is_rim = calloc((size_t)whole->n_nodes, sizeof *is_rim);
    unsigned char *boundary = calloc((size_t)whole->n_nodes, sizeof *boundary);
    dem_index k = 0;
    mark_next(is_rim, s, whole->ends, 2, whole->n_springs);
    mark_next(is_rim, s, whole->triangles, 3, whole->n_triangles);
    assert_ok(mesh_edges_contact_flags(boundary, whole));
    for (dem_index i = 0; i < whole->n_nodes; i++) {
        if (!is_rim[i] || is_own(s, i)) continue;
        assert_true(k < s->lattice.n_nodes - s->n_own);
        assert_int_equal(s->rim[k], i);
        if (s->rim_boundary != NULL) assert_int_equal(s->rim_boundary[k], boundary[i] != 0);
        k++;
    }
    assert_int_equal(k, s->lattice.n_nodes - s->n_own);
    free(is_rim);
    free(boundary);
}

/* All that are at own nodes, in the order of the whole, and no others. */
static void assert_same_triangles(const dem_lattice *whole, const dem_slab *s)
{
    dem_index k = 0, first = -1, end = 0;
    for (dem_index t = 0; t < whole->n_triangles; t++) {
        if (!any_is_own(s, whole->triangles + 3 * t, 3)) continue;
        first = k == 0 ? t : first;
        end = t + 1;
        assert_true(k < s->lattice.n_triangles);
        for (int c = 0; c < 3; c++)
            assert_int_equal(number_of(s, s->lattice.triangles[3 * k + c]), whole->triangles[3 * t + c]);
        assert_same_item(whole, t, &s->lattice, k++, LATTICE_TRIANGLES);
    }
    assert_int_equal(k, s->lattice.n_triangles);
    assert_int_equal(s->first_triangle, end - first == k ? first : -1);
}

/* The next spring of a slab from k on that is at an own node. */
static dem_index next_own(const dem_slab *s, dem_index k)
{
    for (; k < s->lattice.n_springs; k++) {
        const dem_index *end = s->lattice.ends + 2 * k;
        if (any_is_own(s, (const dem_index[]){number_of(s, end[0]), number_of(s, end[1])}, 2)) break;
    }
    return k;
}

static void assert_same_springs(const dem_lattice *whole, const dem_slab *s)
{
    dem_index k = next_own(s, 0);
    for (dem_index w = 0; w < whole->n_springs; w++) {
        if (!any_is_own(s, whole->ends + 2 * w, 2)) continue;
        assert_true(k < s->lattice.n_springs);
        for (int e = 0; e < 2; e++) assert_int_equal(number_of(s, s->lattice.ends[2 * k + e]), whole->ends[2 * w + e]);
        assert_same_item(whole, w, &s->lattice, k, LATTICE_SPRINGS);
        k = next_own(s, k + 1);
    }
    assert_int_equal(k, s->lattice.n_springs);
}

/* ---- tests ---- */

static long n_shapes; /* compared */

/* Of what cannot be made as a whole there is no slab, for the same reason. */
static void assert_refused(const recipe *r, dem_status status)
{
    CLEANUP(dem_slab_free) dem_slab s;
    assert_int_equal(make_slab(&s, r, 0), status);
    assert_int_equal(s.lattice.n_nodes, 0);
}

static void compare(const recipe *r, dem_lattice *whole)
{
    const rows found = count_rows(whole);
    CLEANUP(dem_lattice_free) dem_lattice solid = dem_lattice_empty();
    dem_index next = 0, next_solid = 0;
    assert_ok(make_whole(&solid, r));
    assert_ok(dem_lattice_jitter(whole, r->jitter, r->seed));
    assert_ok(dem_lattice_jitter(&solid, r->jitter, r->seed));
    assemble(&solid, r);
    for (dem_index part = 0; part < r->n_parts; part++) {
        CLEANUP(dem_slab_free) dem_slab s;
        const dem_status status = make_slab(&s, r, part);
        assert_int_equal(status, r->n_parts > found.n ? DEM_ERROR_MODEL : DEM_OK);
        if (status != DEM_OK) return;
        assert_ok(dem_slab_jitter(&s, r->jitter, r->seed));
        assert_true(!r->is_shape || s.n_own <= whole->n_nodes / r->n_parts + 1 + found.largest);
        assert_same_nodes(whole, &s, &next);
        assert_same_rim(whole, &s);
        assert_true(s.rim_boundary != NULL && s.first_triangle >= 0);
        assert_same_triangles(whole, &s);
        assemble(&s.lattice, r);
        assert_same_nodes(&solid, &s, &next_solid);
        assert_same_triangles(&solid, &s);
        assert_same_springs(&solid, &s);
    }
    assert_int_equal(next, whole->n_nodes);
    n_shapes += r->is_shape;
}

static void check(unsigned long seed)
{
    CLEANUP(free_rng) gsl_rng *random = gsl_rng_alloc(gsl_rng_taus);
    recipe r;
    gsl_rng_set(random, seed);
    draw(&r, random);
    CLEANUP(dem_lattice_free) dem_lattice whole = dem_lattice_empty();
    const dem_status status = make_whole(&whole, &r);
    if (status == DEM_OK)
        compare(&r, &whole);
    else
        assert_refused(&r, status);
}

TEST(slabs_are_the_rows_of_the_whole)
{
    for (long k = 0; k < n_cases; k++) check((unsigned long)(first_seed + k));
    assert_true(n_shapes > n_cases / 5);
}

/* ---- slabs of smooth edges ---- */

enum { MOST_PORES = 40 };

/* Slabs compared; of them those with triangles that do not follow each other; and shapes that slabs are refused of,
 * about one of 1000, in which pores overlap. */
static long n_smooth, n_flips, n_refused;

/* Spacing 1, so many rows that slabs do not see all of them. */
static void draw_tall(dem_shape *s, dem_outline *o, double *points, double *pores, gsl_rng *random)
{
    const double width = from(random, 8.0, 30.0), height = from(random, 150.0, 400.0);
    *o = draw_polygon(random, points, width);
    for (int k = 0; k < POLYGON; k++) points[2 * k + 1] *= height / width;
    if (toss(random)) *o = (dem_outline)SIZED(dem_outline, .size = {width, height}, .angle = from(random, -0.1, 0.1));
    if (gsl_rng_uniform_int(random, 8) == 0)
        *o = (dem_outline)SIZED(dem_outline, .kind = toss(random) ? DEM_OUTLINE_DISC : DEM_OUTLINE_RING,
                                .radius = from(random, 80.0, 100.0), .inner_radius = from(random, 10.0, 70.0));
    *s = (dem_shape)SIZED(dem_shape, .spacing = 1.0, .edge = DEM_EDGE_SMOOTH, .outline = o, .pores = pores);
    s->n_pores = (dem_index)gsl_rng_uniform_int(random, MOST_PORES + 1);
    for (dem_index k = 0; k < s->n_pores; k++) {
        pores[3 * k] = from(random, -0.5, 0.5) * width;
        pores[3 * k + 1] = from(random, -0.5, 0.5) * height;
        pores[3 * k + 2] = from(random, 0.5, 5.0);
    }
}

/* Ranks number the triangles whose lowest nodes are their own behind those of the slabs before: which is their order in
 * the whole.  \param[in,out] next  the first one that no slab before has */
static void assert_owned_in_order(const dem_lattice *whole, const dem_slab *s, dem_index *next)
{
    for (dem_index t = 0; t < whole->n_triangles; t++) {
        const dem_index *corner = whole->triangles + 3 * t;
        const dem_index lowest = domain_lowest(corner, 3);
        if (!is_own(s, lowest)) continue;
        assert_int_equal(t, *next);
        ++*next;
    }
}

static void compare_smooth(const dem_lattice *whole, const dem_shape *s, dem_index n_parts, gsl_rng *random)
{
    const double jitter = toss(random) ? from(random, 0.0, 0.2) : 0.0;
    CLEANUP(dem_lattice_free) dem_lattice jittered = dem_lattice_empty();
    dem_index next = 0, next_jittered = 0, next_triangle = 0;
    assert_ok(dem_shape_lattice(&jittered, s, NULL));
    const bool good = dem_lattice_jitter(&jittered, jitter, 3) == DEM_OK;
    for (dem_index part = 0; part < n_parts; part++) {
        CLEANUP(dem_slab_free) dem_slab slab = dem_slab_empty();
        const dem_status status = dem_slab_shape(&slab, s, part, n_parts);
        if (part == 0 && status == DEM_ERROR_MODEL) {
            assert_message_parts("triangles at smooth edges go by what is too far off for a slab");
            n_refused++;
            return;
        }
        assert_ok(status);
        assert_same_nodes(whole, &slab, &next);
        assert_same_rim(whole, &slab);
        assert_same_triangles(whole, &slab);
        assert_owned_in_order(whole, &slab, &next_triangle);
        n_smooth++;
        n_flips += slab.first_triangle < 0;
        if (good && dem_slab_jitter(&slab, jitter, 3) == DEM_OK)
            assert_same_nodes(&jittered, &slab, &next_jittered);
        else
            next_jittered += slab.n_own;
    }
    assert_int_equal(next, whole->n_nodes);
}

TEST(slabs_of_smooth_edges_are_rows_of_the_whole)
{
    CLEANUP(free_rng) gsl_rng *random = gsl_rng_alloc(gsl_rng_taus);
    double points[2 * POLYGON], pores[3 * MOST_PORES];
    for (long k = 0; k < n_cases / 100; k++) {
        CLEANUP(dem_lattice_free) dem_lattice whole = dem_lattice_empty();
        dem_shape s;
        dem_outline o;
        gsl_rng_set(random, (unsigned long)(first_seed + k));
        draw_tall(&s, &o, points, pores, random);
        if (dem_shape_lattice(&whole, &s, NULL) == DEM_OK) compare_smooth(&whole, &s, 2 + k % 6, random);
    }
    assert_true(n_smooth > n_cases / 50 && n_refused <= 1 + n_cases / 2000);
    assert_true(n_flips > 0 || n_cases < 10000);
}

/* ---- slabs of files ---- */

static const char path[] = "property_slabs.h5";
static long n_gaps; /* slabs whose triangles do not follow each other in the whole */

/* Some of what a lattice can have besides. */
static void decorate(dem_lattice *l, gsl_rng *random)
{
    CLEANUP(dem_lattice_free) dem_lattice other = dem_lattice_empty();
    if (toss(random)) assert_ok(dem_lattice_launch(l, (const double[2]){1.0, -2.0}));
    if (toss(random)) {
        l->position = malloc(2 * (size_t)l->n_nodes * sizeof *l->position);
        for (dem_index k = 0; k < 2 * l->n_nodes; k++) l->position[k] = l->x[k] + from(random, 0.0, 1e-5);
    }
    if (toss(random)) assert_ok(dem_lattice_spin(l, from(random, -1.0, 1.0)));
    if (toss(random)) assert_ok(dem_lattice_exclude(l, (const dem_index[]){l->n_nodes / 2}, 1));
    if (gsl_rng_uniform_int(random, 4) == 0) assert_ok(dem_lattice_stiffen(l, DEM_GUIDE_X));
    if (gsl_rng_uniform_int(random, 4) == 0) {
        assert_ok(dem_lattice_append(&other, l));
        assert_ok(dem_lattice_append(l, &other));
    }
}

static void write_file(const dem_lattice *l, int deflate)
{
    hdf5_file file;
    assert_ok(hdf5_open_new(&file, path, 4096));
    assert_ok(hdf5_close(&file, lattice_file_write(&file, &(lattice_source){l, NULL}, deflate)));
}

/* Also nodes of the rim have all that is in the file. */
static void compare_file(const dem_lattice *l, dem_index n_parts)
{
    dem_index next = 0;
    for (dem_index part = 0; part < n_parts; part++) {
        CLEANUP(dem_slab_free) dem_slab s = dem_slab_empty();
        assert_ok(dem_slab_read(&s, path, part, n_parts));
        assert_true(s.n_own == l->n_nodes / n_parts || s.n_own == l->n_nodes / n_parts + 1);
        assert_same_nodes(l, &s, &next);
        for (dem_index i = 0; i < s.lattice.n_nodes; i++)
            assert_same_item(l, number_of(&s, i), &s.lattice, i, LATTICE_NODES);
        assert_same_rim(l, &s);
        assert_same_triangles(l, &s);
        assert_same_springs(l, &s);
        n_gaps += s.first_triangle < 0;
    }
    assert_int_equal(next, l->n_nodes);
}

/* Which have rim_boundary besides. */
static void compare_ranges(const dem_lattice *l, dem_index step)
{
    CLEANUP(free_memory) dem_index *node_ranges = NULL;
    dem_index next = 0;
    while (next < l->n_nodes) {
        CLEANUP(dem_slab_free) dem_slab s = dem_slab_empty();
        const dem_index end = next + step < l->n_nodes ? next + step : l->n_nodes;
        assert_ok(dem_private_slab_of_file(&s, path, &node_ranges, next, end));
        assert_same_nodes(l, &s, &next);
        assert_int_equal(next, end);
        assert_non_null(s.rim_boundary);
        assert_same_rim(l, &s);
        assert_same_triangles(l, &s);
        assert_same_springs(l, &s);
    }
}

static void check_file(unsigned long seed)
{
    CLEANUP(free_rng) gsl_rng *random = gsl_rng_alloc(gsl_rng_taus);
    CLEANUP(dem_lattice_free) dem_lattice l = dem_lattice_empty();
    recipe r;
    gsl_rng_set(random, seed);
    draw(&r, random);
    if (toss(random)) r.solids[0].strength = r.solids[1].strength = 1e6;
    if (make_whole(&l, &r) != DEM_OK) return;
    assert_ok(dem_lattice_jitter(&l, r.jitter, r.seed));
    assemble(&l, &r);
    decorate(&l, random);
    write_file(&l, (int)gsl_rng_uniform_int(random, 2));
    const dem_index n_parts = 1 + (dem_index)gsl_rng_uniform_int(random, 7);
    compare_file(&l, toss(random) || n_parts > l.n_nodes ? l.n_nodes / 2 : n_parts);
    compare_ranges(&l, 1 + (dem_index)gsl_rng_uniform_int(random, (unsigned long)l.n_nodes));
}

TEST(slabs_of_files_are_what_the_whole_has)
{
    for (long k = 0; k < n_cases; k += 100) check_file((unsigned long)(first_seed + k));
    assert_true(n_gaps > n_cases / 100);
    assert_int_equal(unlink(path), 0);
}

int main(int n_arguments, char **arguments)
{
    if (n_arguments > 1) n_cases = atol(arguments[1]);
    if (n_arguments > 2) first_seed = atol(arguments[2]);
    return test_run();
}
