/* SPDX-License-Identifier: BSD-3-Clause */
/* Toughness: a strip with clamped sides and an edge crack, pulled slowly. Whatever the length of the crack, the energy
 * released per area is that of the strip ahead, G = E (D/H)^2 H/(2 (1 - nu^2)) with D the way by which the sides have
 * parted and H their distance (plane stress; the sides hold the strip along itself). A brittle lattice needs
 * G = beta strength^2 a/E, with beta of the criterion and the lattice alone. `long` as argument: other Poisson's
 * ratios, and a strip of twice the size. */
#include "verification/support.h"

#include <stdlib.h>
#include <string.h>

#include "ask.h"

static const double modulus = 1e9, density = 1000.0, spacing = 0.01; /* Pa, kg/m^3, m: c = 1000 m/s */
static const double limit = 1e-3; /* strength/E, or critical stretch: small enough for what is linear, to 1e-3 */

/* A case of the table below. */
typedef struct strip_case {
    bool by_stretch;
    double nu;
    int scale; /* the strip is so many times as large */
    double beta, tolerance;
} strip_case;
enum { WIDE = 70, HIGH = 44, CRACK = 22, MOST = 30 }; /* spacings; triangles that break */

typedef struct strip {
    support_run run;
    double height; /* m, between the sides */
    double start;  /* m, by which they have parted at the start */
    double speed;  /* m/s, at which they part */
    double most;   /* m, by which they had parted at the last break under a growing load */
    dem_index n_broken, n_cut;
    double middle, tip, off; /* m: of the crack; how far it has come, and its largest distance from straight */
    const dem_lattice *lattice;
    unsigned char *broken;
} strip;

static double centre(const dem_lattice *l, dem_index triangle, int axis)
{
    double sum = 0.0;
    for (int c = 0; c < 3; c++) sum += l->x[2 * l->triangles[3 * triangle + c] + axis] / 3.0;
    return sum;
}

/* Only the first break of those between two pauses is one by the load; others follow it by waves and by what it has
 * left over the limit. */
static dem_status note(void *context, const dem_simulation *s)
{
    strip *p = context;
    dem_index n = 0;
    assert_ok(dem_simulation_broken(s, p->broken, NULL));
    for (dem_index t = 0; t < p->lattice->n_triangles; t++) {
        if (!p->broken[t]) continue;
        n++;
        p->tip = fmax(p->tip, centre(p->lattice, t, 0));
        p->off = fmax(p->off, fabs(centre(p->lattice, t, 1) - p->middle));
    }
    if (n == p->n_broken) return DEM_OK;
    p->most = p->start + p->speed * dem_simulation_ramp_time(s);
    p->n_broken = n;
    return n - p->n_cut >= MOST ? DEM_STOPPED : DEM_OK;
}

static void cut(strip *p)
{
    dem_index *list = calloc((size_t)p->lattice->n_triangles, sizeof *list), n = 0;
    assert_non_null(list);
    for (dem_index t = 0; t < p->lattice->n_triangles; t++)
        if (fabs(centre(p->lattice, t, 1) - p->middle) < 0.3 * spacing && centre(p->lattice, t, 0) < p->tip)
            list[n++] = t;
    assert_true(n > CRACK);
    assert_ok(dem_simulation_break(p->run.simulation, list, n, NULL, 0));
    p->n_cut = p->n_broken = n;
    free(list);
}

/* Nodes of the upper (side 1) or lower side. */
static dem_index list_side(const dem_lattice *l, int side, dem_index *list)
{
    const double y = side ? support_top(l) : support_bottom(l);
    dem_index n = 0;
    for (dem_index i = 0; i < l->n_nodes; i++)
        if (fabs(l->x[2 * i + 1] - y) < 0.1 * spacing) list[n++] = i;
    return n;
}

static dem_lattice make(const strip_case *k)
{
    const dem_material solid = {.struct_size = sizeof(dem_material),
                                .youngs_modulus = modulus,
                                .poissons_ratio = k->nu,
                                .density = density,
                                .thickness = 1.0,
                                .strength = k->by_stretch ? 0.0 : modulus * limit,
                                .critical_stretch = k->by_stretch ? limit : 0.0};
    return support_rectangle(k->scale * WIDE * spacing, k->scale * HIGH * spacing, spacing, &solid);
}

/* The strip starts stretched by 0.85 of what it is expected to stand. */
static void stretch(dem_lattice *l, double parted, double height)
{
    const double bottom = support_bottom(l);
    double *position = calloc((size_t)(2 * l->n_nodes), sizeof *position);
    assert_non_null(position);
    for (dem_index i = 0; i < l->n_nodes; i++) {
        position[2 * i] = l->x[2 * i];
        position[2 * i + 1] = l->x[2 * i + 1] + parted * ((l->x[2 * i + 1] - bottom) / height - 0.5);
    }
    support_start(l, position, NULL);
    free(position);
}

/* The drag is critical for the slowest wave between the sides, pi c/H. */
static void open_strip(strip *p, const dem_lattice *l, double wave_speed)
{
    dem_index *sides = calloc((size_t)(2 * l->n_nodes), sizeof *sides);
    dem_boundary pull[2];
    assert_non_null(sides);
    for (int side = 0; side < 2; side++)
        pull[side] = (dem_boundary)SIZED(
            dem_boundary, .kind = DEM_BOUNDARY_VELOCITY, .components = DEM_COMPONENT_X | DEM_COMPONENT_Y,
            .nodes = sides + side * l->n_nodes, .n_nodes = list_side(l, side, sides + side * l->n_nodes),
            .value = {0.0, (side ? 0.5 : -0.5) * p->speed});
    dem_options options = dem_options_default();
    options.gravity[1] = 0.0;
    options.rtol = 1e-8;
    options.mass_damping = 2.0 * M_PI * wave_speed / p->height;
    options.pause = 1e-3;
    options.n_boundaries = 2;
    options.boundaries = pull;
    support_open(&p->run, l, NULL, 0, &options);
    free(sides);
    p->lattice = dem_model_lattice(p->run.model);
    const dem_observer observer = {.struct_size = sizeof observer, .step = note, .context = p};
    assert_ok(dem_simulation_observe(p->run.simulation, &observer));
}

/* G E/(strength^2 a) at the break under the largest load. Until the expected one the strip is pulled by 0.15 of that in
 * 750 H/(44 a) of a/c. */
static double toughness(const strip_case *k)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make(k);
    const double c = sqrt(modulus / density), bottom = support_bottom(&l), height = support_top(&l) - bottom;
    const double scale = 2.0 * (1.0 - k->nu * k->nu) * limit * limit * spacing / height; /* of (D/H)^2 */
    const double parted = height * sqrt(k->beta * scale), last = 5000.0 * k->scale * spacing / c;
    const double row = 0.5 * sqrt(3.0) * spacing, below = floor(0.5 * round(height / row)); /* rows below the crack's */
    strip p = {
        .height = height, .start = 0.85 * parted, .speed = parted / last, .middle = bottom + (below + 0.5) * row};
    p.broken = calloc((size_t)l.n_triangles, 1);
    assert_non_null(p.broken);
    for (dem_index i = 0; i < l.n_nodes; i++) p.tip = fmin(p.tip, l.x[2 * i]);
    p.tip += k->scale * CRACK * spacing;
    stretch(&l, p.start, height);
    open_strip(&p, &l, c);
    cut(&p);
    assert_int_equal(dem_simulation_advance(p.run.simulation, 20.0 * last), DEM_STOPPED);
    assert_true(p.off < 0.5 * spacing); /* along its row */
    support_close(&p.run);
    free(p.broken);
    return p.most * p.most / (height * height) / scale;
}

/* Expected are means over a crack by an independent static code, in which loads may fall;
 * the largest of the loads is half a per cent of G above that. The last drag and inertia of a load that grows by the
 * whole of itself in 5000 a/c add as much. */
static void check(const strip_case *list, size_t n)
{
    for (size_t k = 0; k < n; k++) assert_close(toughness(&list[k]), list[k].beta, list[k].tolerance * list[k].beta);
}

TEST(toughness_is_that_of_the_criterion)
{
    const strip_case list[] = {{false, 1.0 / 3.0, 1, 3.40, 0.02}, {true, 1.0 / 3.0, 1, 1.325, 0.02}};
    check(list, sizeof list / sizeof *list);
}

static void of_other_ratios(void **state)
{
    const strip_case list[] = {{false, 0.0, 1, 3.48, 0.02}, {false, 0.2, 1, 3.41, 0.02}, {false, 0.45, 1, 3.45, 0.02}};
    (void)state;
    check(list, sizeof list / sizeof *list);
}

static void of_twice_the_size(void **state)
{
    const strip_case list[] = {{false, 1.0 / 3.0, 2, 3.51, 0.02}, {true, 1.0 / 3.0, 2, 1.345, 0.02}};
    (void)state;
    check(list, sizeof list / sizeof *list);
}

int main(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "long") == 0) {
        test_add(&(struct CMUnitTest)cmocka_unit_test(of_other_ratios), 1000);
        test_add(&(struct CMUnitTest)cmocka_unit_test(of_twice_the_size), 1001);
    }
    return test_run();
}
