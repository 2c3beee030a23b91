/* SPDX-License-Identifier: BSD-3-Clause */
/* Bodies that break under pressure, by the law of Mohr and Coulomb: a block that is deformed uniformly along all kinds
 * of paths, of which stress and time of the break are known, and a triangle that swings inwards by itself; then a block
 * that breaks here and there, by pressure, or in tension by the own stress of most triangles, by both methods of
 * contact, with no help of filters, with other threads and cuts. */
#include "support.h"

#include <stdlib.h>
#include <string.h>

#include "harness/message.h"
#include "simulation/private.h"

static const double tension = 1e6, pressure = 8e6; /* Pa, what the material stands */

static dem_options no_weight(double rtol, dem_contact_method contact)
{
    dem_options options = dem_options_default();
    options.gravity[1] = 0.0;
    options.rtol = rtol;
    options.contact = contact;
    return options;
}

static const dem_contact_method ways[2] = {DEM_CONTACT_LOCAL, DEM_CONTACT_EXACT};

static dem_material stone(dem_plane plane, double ratio)
{
    return (dem_material)SIZED(dem_material, .youngs_modulus = 1e9, .poissons_ratio = ratio, .plane = plane,
                               .density = 2500.0, .thickness = 0.3, .strength = tension,
                               .compressive_strength = pressure);
}

/* ---- a block that is deformed uniformly ---- */

/* xx, xy, yx, yy of displacements over places, at the start, and their rates, 1/s. */
typedef struct path {
    const char *name;
    double from[4], rate[4];
} path;

/* Tension breaks at strains of 1e-3, pressure at 8e-3. */
static const path paths[] = {
    {"pressed along x", {0, 0, 0, 0}, {-0.5, 0, 0, 0.1}},
    {"pressed along y", {0, 0, 0, 0}, {0, 0, 0, -0.5}},
    {"pressed alike along both", {0, 0, 0, 0}, {-0.5, 0, 0, -0.5}},
    {"pressed along both", {0, 0, 0, 0}, {-0.5, 0, 0, -0.2}},
    {"sheared", {0, 0, 0, 0}, {0, 0.3, 0.3, 0}},
    {"sheared along", {0, 0, 0, 0}, {0, 0.5, 0, 0}},
    {"pulled and pressed across", {0, 0, 0, 0}, {0.3, 0, 0, -0.8}},
    {"pulled", {0, 0, 0, 0}, {0.5, 0, 0, -0.1}},
    {"pulled along both", {0, 0, 0, 0}, {0.5, 0, 0, 0.4}},
    {"pressed first, then pulled", {-0.004, 0, 0, 0.0005}, {0, 0.1, 0.1, 0.3}},
    {"pressed, then pressed across", {-0.003, 0, 0, 0.0007}, {0.1, 0, 0, -0.7}},
    {"squeezed first, then let go on one side", {-0.003, 0, 0, -0.004}, {0.4, 0, 0, -0.2}},
};
enum { PATHS = sizeof paths / sizeof *paths };

/* The deformation gradient at t, turned by an angle. */
static void deform(const path *p, double angle, double t, double f[4])
{
    const double c = cos(angle), s = sin(angle);
    double u[4], half[4];
    for (int k = 0; k < 4; k++) u[k] = p->from[k] + t * p->rate[k];
    for (int k = 0; k < 2; k++) {
        half[k] = c * u[k] - s * u[2 + k];
        half[2 + k] = s * u[k] + c * u[2 + k];
    }
    for (int k = 0; k < 2; k++) {
        f[2 * k] = half[2 * k] * c - half[2 * k + 1] * s;
        f[2 * k + 1] = half[2 * k] * s + half[2 * k + 1] * c;
    }
}

/* Kirchhoff stress of equilateral triangles of edges a, area A, thickness h: each edge has (8/3) G h A/a of the
 * stiffness of its spring, in N, and the area term has the stiffness (lambda - G) h.
 * \param u  displacement gradient */
static void stress_of(const dem_material *m, const double u[4], double stress[3])
{
    const double nu = m->poissons_ratio, strain = m->plane == DEM_PLANE_STRAIN, side = 60.0 * acos(-1.0) / 180.0;
    const double modulus = strain > 0.0 ? m->youngs_modulus / (1.0 - nu * nu) : m->youngs_modulus,
                 ratio = strain > 0.0 ? nu / (1.0 - nu) : nu;
    const double shear = 0.5 * modulus / (1.0 + ratio), lambda = modulus * ratio / (1.0 - ratio * ratio);
    const double growth = (1.0 + u[0]) * (1.0 + u[3]) - u[1] * u[2],
                 spread = (lambda - shear) * (growth - 1.0) * growth;
    stress[0] = stress[1] = spread;
    stress[2] = 0.0;
    for (int k = 0; k < 3; k++) {
        const double n[2] = {cos(k * side), sin(k * side)};
        const double d[2] = {n[0] + u[0] * n[0] + u[1] * n[1], n[1] + u[2] * n[0] + u[3] * n[1]};
        const double length = hypot(d[0], d[1]), pull = 8.0 / 3.0 * shear * (length - 1.0) / length;
        stress[0] += pull * d[0] * d[0];
        stress[1] += pull * d[1] * d[1];
        stress[2] += pull * d[0] * d[1];
    }
}

/* The law of the textbooks: of all three principal stresses the largest over the strength in tension less the smallest
 * over that under pressure, where only tension and only pressure count. A plate has none across; in plane strain the
 * one across is between the others where that matters. */
static double law(const dem_material *m, const double stress[3])
{
    const double middle = 0.5 * (stress[0] + stress[1]), radius = hypot(0.5 * (stress[0] - stress[1]), stress[2]);
    double largest = middle + radius, smallest = fmin(middle - radius, 0.0);
    if (m->plane == DEM_PLANE_STRESS) largest = fmax(largest, 0.0);
    return largest / tension - smallest / pressure;
}

static double law_at(const dem_material *m, const path *p, double angle, double t)
{
    double u[4], stress[3];
    deform(p, angle, t, u);
    stress_of(m, u, stress);
    return law(m, stress);
}

static const double t_most = 0.03;

/* When the law is fulfilled first; infinity: not up to t_most. */
static double due(const dem_material *m, const path *p, double angle)
{
    enum { N = 3000 };
    for (int k = 1; k <= N; k++) {
        double before = t_most * (k - 1) / N, after = t_most * k / N;
        if (law_at(m, p, angle, after) < 1.0) continue;
        for (int i = 0; i < 60; i++) {
            const double t = 0.5 * (before + after);
            *(law_at(m, p, angle, t) < 1.0 ? &before : &after) = t;
        }
        return after;
    }
    return (double)INFINITY;
}

/* Times of breaks. */
typedef struct heard {
    dem_index n;
    double first, last; /* s */
} heard;

static dem_status on_break(void *context, const dem_simulation *simulation, const dem_break *what)
{
    heard *h = context;
    (void)simulation;
    if (h->n++ == 0) h->first = what->t;
    h->last = what->t;
    return DEM_OK;
}

enum { MOST_NODES = 32 };

/* Every node is led. */
static void lead(dem_lattice *block, const path *p, double angle, dem_boundary *boundaries, dem_index *numbers)
{
    double u[4], later[4], x[2 * MOST_NODES];
    deform(p, angle, 0.0, u);
    deform(p, angle, 1.0, later);
    assert_true(block->n_nodes <= MOST_NODES);
    for (dem_index i = 0; i < block->n_nodes; i++) {
        const double *at = &block->x[2 * i];
        numbers[i] = i;
        boundaries[i] = (dem_boundary)SIZED(dem_boundary, .components = DEM_COMPONENT_X | DEM_COMPONENT_Y, .n_nodes = 1,
                                            .nodes = &numbers[i]);
        for (int d = 0; d < 2; d++) {
            x[2 * i + d] = at[d] + u[2 * d] * at[0] + u[2 * d + 1] * at[1];
            for (int k = 0; k < 2; k++) boundaries[i].value[d] += (later[2 * d + k] - u[2 * d + k]) * at[k];
        }
    }
    support_start(block, x, NULL);
}

/* A block of edges of 1 m along the path, turned by an angle. */
static heard run_path(const dem_material *m, const path *p, double angle, dem_options options)
{
    CLEANUP(dem_lattice_free) dem_lattice block = support_rectangle(2.0, 1.8, 1.0, m);
    dem_boundary boundaries[MOST_NODES];
    dem_index numbers[MOST_NODES];
    heard h = {0};
    lead(&block, p, angle, boundaries, numbers);
    options.n_boundaries = block.n_nodes;
    options.boundaries = boundaries;
    const dem_observer observer = SIZED(dem_observer, .broken = on_break, .context = &h);
    CLEANUP(support_close) support_run run;
    support_open(&run, &block, NULL, 0, &options);
    assert_ok(dem_simulation_observe(run.simulation, &observer));
    (void)support_at(&run, t_most);
    assert_true(h.n == 0 || h.n == block.n_triangles);
    return h;
}

/* Within 1e-10 of the time, what rtol 1e-12 leaves; led by the integrators, nodes are where they are to its rounding.
 * */
static void assert_due(const path *p, const dem_material *m, double angle, const dem_options *options)
{
    const double expected = due(m, p, angle);
    const heard h = run_path(m, p, angle, *options);
    if (isinf(expected) != (h.n == 0)) fail_msg("%s: due at %g s, %lld breaks", p->name, expected, (long long)h.n);
    if (h.n == 0) return;
    assert_close(h.first, expected, 1e-10 * expected);
    assert_close(h.last, expected, 1e-10 * expected);
}

TEST(a_block_breaks_when_pressure_and_tension_must_break_it)
{
    const double ratios[3] = {0.1, 1.0 / 3.0, 0.25};
    int n_never = 0;
    for (int k = 0; k < PATHS; k++)
        for (int plane = 0; plane < 2; plane++)
            for (int q = 0; q < 4; q++) {
                const dem_material m = stone(plane == 0 ? DEM_PLANE_STRESS : DEM_PLANE_STRAIN, ratios[(k + q) % 3]);
                dem_options options = no_weight(1e-12, ways[q % 2]);
                if (q == 3) {
                    options.method = DEM_METHOD_VERLET;
                    options.fixed_step = 1e-4;
                }
                const double angle = 0.37 * (k + q);
                n_never += isinf(due(&m, &paths[k], angle));
                assert_due(&paths[k], &m, angle, &options);
            }
    assert_true(n_never > 0 && n_never < 2 * PATHS); /* squeezed alike in plane strain nothing breaks */
}

/* ---- a triangle that swings inwards ---- */

/* Three springs of 3 N and 1 m between masses of 1 kg that move inwards at u: the strain of all is -u/(R0 w) sin w t,
 * w = 3/s, R0 = 1/sqrt(3) m, the pressure the same in all directions, 2 sqrt(3) S e (1 - e) at the strain -e
 * (tests/unit/fracture/test_fracture_source.c). With the confinement k it breaks where that is 1/(1 - k) as large. */
static const double stiffness = 3.0, u_start = 0.2, w = 3.0, strain = 0.08;

static void open_triangle(support_run *run, double confinement, const dem_options *options)
{
    const double radius = 1.0 / sqrt(3.0);
    const double x[6] = {radius, 0.0, -0.5 * radius, 0.5, -0.5 * radius, -0.5}, masses[3] = {1.0, 1.0, 1.0};
    const dem_index ends[6] = {0, 1, 1, 2, 2, 0}, corners[3] = {0, 1, 2};
    double v[6];
    for (int c = 0; c < 6; c++) v[c] = -x[c] / radius * u_start;
    CLEANUP(dem_lattice_free) dem_lattice body = support_lattice(3, x, masses, 3, ends, 1.0, stiffness, NULL);
    support_start(&body, NULL, v);
    body.n_triangles = 1;
    body.triangles = malloc(sizeof corners);
    body.strength = malloc(sizeof *body.strength);
    body.compressive_strength = malloc(sizeof *body.compressive_strength);
    body.confinement = malloc(sizeof *body.confinement);
    assert_true(body.triangles && body.strength && body.compressive_strength && body.confinement);
    memcpy(body.triangles, corners, sizeof corners);
    body.compressive_strength[0] = (1.0 - confinement) * 2.0 * sqrt(3.0) * stiffness * strain * (1.0 - strain);
    body.strength[0] = 0.5 * body.compressive_strength[0];
    body.confinement[0] = confinement;
    support_open(run, &body, NULL, 0, options);
}

/* 1e-10 is what rtol 1e-12 leaves. */
TEST(a_triangle_that_is_pressed_breaks_when_it_must)
{
    const double radius = 1.0 / sqrt(3.0), broken = asin(strain * radius * w / u_start) / w;
    const double speed = u_start * cos(w * broken);
    for (int k = 0; k < 4; k++) {
        const dem_options options = no_weight(1e-12, ways[k % 2]);
        CLEANUP(support_close) support_run run;
        open_triangle(&run, k < 2 ? 0.0 : 0.4, &options);
        const motion s = support_at(&run, 1.0);
        assert_close(s.x[0], radius * (1.0 - strain) - speed * (1.0 - broken), 1e-10);
        assert_close(s.energy.fracture, 3.0 * stiffness * strain * strain / 2.0, 1e-11);
        assert_close(s.energy.ledger, 3.0 * u_start * u_start / 2.0, 1e-11);
    }
}

/* ---- a block that breaks here and there ---- */

enum { MOST_TRIANGLES = 1024 };

typedef struct ending {
    dem_energy energy;
    double x[512], v[512];
    dem_index n, n_broken;
    unsigned char broken[MOST_TRIANGLES];
} ending;

/* Pressed, as a plate and as a slice, or pulled, with triangles that soften by their own stress. */
enum { PLATE, SLICE, OWN, KINDS };

/* One triangle of four softens by the stresses of its corners. */
static void let_soften(dem_lattice *block)
{
    const dem_index n = block->n_triangles;
    block->softening = calloc((size_t)n, sizeof *block->softening);
    block->own_stress = calloc((size_t)n, 1);
    assert_true(block->softening != NULL && block->own_stress != NULL);
    for (dem_index t = 0; t < n; t++) {
        block->softening[t] = 3.0;
        block->own_stress[t] = t % 4 != 0;
    }
}

/* Pressed or pulled along y: every triangle has another strength. */
static void make_block(dem_lattice *block, int kind)
{
    const dem_material m = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 0.2,
                                 .plane = kind == SLICE ? DEM_PLANE_STRAIN : DEM_PLANE_STRESS, .density = 1050.0,
                                 .thickness = 1.0, .guard = 0.02, .springs = DEM_SPRINGS_COUPLED,
                                 .strength = kind == OWN ? 4e5 : 2e5, .compressive_strength = kind == OWN ? 0.0 : 8e5);
    assert_ok(dem_lattice_rectangle(block, 0.04, 0.08, 0.005));
    assert_ok(dem_lattice_jitter(block, 0.001, 3));
    assert_ok(dem_lattice_assemble(block, &m));
    assert_ok(dem_lattice_launch(block, (const double[2]){0.0, 0.0}));
    for (dem_index i = 0; i < block->n_nodes; i++) {
        block->velocity[2 * i] = 20.0 * block->x[2 * i];
        block->velocity[2 * i + 1] = (kind == OWN ? 300.0 : -300.0) * (block->x[2 * i + 1] - 0.04);
    }
    if (kind == OWN) let_soften(block);
    double factor[MOST_TRIANGLES];
    assert_true(block->n_triangles <= MOST_TRIANGLES && block->n_nodes <= 256);
    for (dem_index t = 0; t < block->n_triangles; t++)
        factor[t] = 1.0 + 0.5 * fmod((double)t * 0.6180339887498949, 1.0);
    assert_ok(dem_lattice_weaken(block, factor, NULL, NULL));
}

static void read_ending(support_run *run, double t, dem_index n_triangles, ending *out)
{
    const motion s = support_at(run, t);
    out->n = 2 * ask_sizes(run->model).n_nodes;
    out->energy = s.energy;
    memcpy(out->x, s.x, (size_t)out->n * sizeof *out->x);
    memcpy(out->v, s.v, (size_t)out->n * sizeof *out->v);
    assert_ok(dem_simulation_broken(run->simulation, out->broken, NULL));
    out->n_broken = 0;
    for (dem_index k = 0; k < n_triangles; k++) out->n_broken += out->broken[k];
}

static const double t_end = 4e-4;

/* The stress at every node is looked at in every step. */
static void look_everywhere(strain_filter *f, dem_index n)
{
    f->always = realloc(f->always, (size_t)n * sizeof *f->always);
    assert_non_null(f->always);
    for (dem_index i = 0; i < n; i++) f->always[i] = i;
    f->n_always = n;
    f->weakest = (utilisation_limits){.tension = 1.0, .pressure = 1.0};
}

static void run_block(const dem_options *options, int kind, bool all, int n_parts, ending *out)
{
    CLEANUP(dem_lattice_free) dem_lattice block = dem_lattice_empty();
    CLEANUP(support_close) support_run run;
    make_block(&block, kind);
    support_open(&run, &block, NULL, 0, options);
    fracture_source *source = &run.simulation->breaks;
    const double before = ask_energy(run.simulation).ledger;
    if (all) look_everywhere(&source->filter, block.n_nodes);
    for (int k = 1; k < n_parts; k++) (void)support_at(&run, t_end * k / n_parts);
    read_ending(&run, t_end, block.n_triangles, out);
    assert_true(out->n_broken > 10 && out->n_broken < block.n_triangles / 2);
    assert_close(out->energy.ledger, before, 1e3 * options->rtol * before); /* errors of some hundred steps */
}

static void assert_same_bits(const ending *a, const ending *b)
{
    assert_int_equal(a->n_broken, b->n_broken);
    assert_memory_equal(a->x, b->x, (size_t)a->n * sizeof *a->x);
    assert_memory_equal(a->v, b->v, (size_t)a->n * sizeof *a->v);
    assert_memory_equal(&a->energy, &b->energy, sizeof a->energy);
    assert_memory_equal(a->broken, b->broken, sizeof a->broken);
}

TEST(filters_hide_nothing_that_breaks)
{
    static ending whole, other;
    const dem_options options = no_weight(1e-6, DEM_CONTACT_LOCAL);
    for (int kind = 0; kind < KINDS; kind++) {
        run_block(&options, kind, false, 1, &whole);
        run_block(&options, kind, true, 1, &other);
        assert_same_bits(&whole, &other);
    }
}

TEST(bits_of_breaks_do_not_depend_on_threads_and_cuts)
{
    static ending whole, other;
    for (int kind = 0; kind < KINDS; kind++) {
        dem_options options = no_weight(1e-6, DEM_CONTACT_LOCAL);
        run_block(&options, kind, false, 1, &whole);
        run_block(&options, kind, false, 37, &other);
        assert_same_bits(&whole, &other);
        options.threads = 3;
        options.thread_nodes = 1;
        run_block(&options, kind, false, 1, &other);
        assert_same_bits(&whole, &other);
    }
}

/* The two ways resolve the same breaks at the same times. */
TEST(local_corrections_break_as_stops_of_the_whole_body_do)
{
    static ending local, exact;
    for (int kind = 0; kind < KINDS; kind++) {
        dem_options options = no_weight(1e-10, DEM_CONTACT_LOCAL);
        run_block(&options, kind, false, 1, &local);
        options.contact = DEM_CONTACT_EXACT;
        run_block(&options, kind, false, 1, &exact);
        double most = 0.0;
        for (dem_index k = 0; k < local.n; k++) most = fmax(most, fabs(local.x[k] - exact.x[k]));
        assert_memory_equal(local.broken, exact.broken, sizeof local.broken);
        assert_true(most < 1e-7);
    }
}

/* ---- what is refused ---- */

TEST(a_start_beyond_the_compressive_strength_is_refused)
{
    const dem_material m = stone(DEM_PLANE_STRESS, 1.0 / 3.0);
    CLEANUP(dem_lattice_free) dem_lattice block = support_rectangle(2.0, 1.8, 1.0, &m);
    double x[2 * MOST_NODES];
    for (dem_index i = 0; i < 2 * block.n_nodes; i++) x[i] = 0.99 * block.x[i];
    support_start(&block, x, NULL);
    dem_model *model = support_model(&block, NULL, 0);
    const dem_options options = no_weight(1e-6, DEM_CONTACT_LOCAL);
    dem_simulation *simulation = NULL;
    assert_int_equal(dem_simulation_create(&simulation, model, &options), DEM_ERROR_MODEL);
    assert_message_parts("triangle 0 of body 0 at (-0.99, 0) m is at * times what it stands at the start, by its "
                         "strength 1e+06 Pa and its "
                         "compressive strength 8e+06 Pa");
    dem_model_destroy(model);
}
