/* SPDX-License-Identifier: BSD-3-Clause */
/* Strength of a wide plate with a crack across its middle: by linear elastic fracture mechanics it breaks under the
 * tension S at which K = S sqrt(pi L sec(pi L/W)) is K_Ic, with L half of the crack's length, and W the width of the
 * plate (Feddersen's factor). The toughness of the lattice, G_c = 3.5 strength^2 a/E, gives K_Ic = 1.87 strength
 * sqrt(a): the same crack in a lattice of half the spacing is one of twice as many spacings. Where triangles soften
 * K_Ic = sqrt(E G) is an input. `long` as argument: three cracks instead of one. */
#include "clamped_strip.h"

#include <stdlib.h>
#include <string.h>

#include "ask.h"
#include "driving.h"

static const double spacing = CLAMPED_STRIP_SPACING, nu = 1.0 / 3.0;
static const double strength = CLAMPED_STRIP_MODULUS * CLAMPED_STRIP_LIMIT;
static const double unit_time = CLAMPED_STRIP_SPACING / CLAMPED_STRIP_SPEED; /* a/c */

/* Half of a plate's width is 60 `size` spacings, and it is 180 of them high. */
typedef struct plate_case {
    double size, half; /* spacings: half of the crack's length */
    double toughness;  /* that is asked for, G E/(strength^2 a); 0: brittle, by the strength alone */
} plate_case;

static double wide(const plate_case *k)
{
    return 120.0 * k->size * spacing;
}

/* Times in which the plate comes to rest, and is pulled. */
static double rest(const plate_case *k)
{
    return 540.0 * k->size * unit_time;
}

static double ramp(const plate_case *k)
{
    return (k->toughness > 0.0 ? 3200.0 : 400.0) * k->size * unit_time;
}

typedef struct plate {
    dem_lattice lattice;
    clamped_strip outline; /* its lower and its upper side */
    support_run run;
} plate;

/* As it is under a tension without the crack. */
static void stretch(const plate *p, dem_lattice *l, double tension)
{
    const double strain = tension / CLAMPED_STRIP_MODULUS, middle = p->outline.middle;
    double *position = calloc((size_t)(2 * l->n_nodes), sizeof *position);
    assert_non_null(position);
    for (dem_index i = 0; i < l->n_nodes; i++) {
        position[2 * i] = l->x[2 * i] * (1.0 - nu * strain);
        position[2 * i + 1] = middle + (l->x[2 * i + 1] - middle) * (1.0 + strain);
    }
    support_start(l, position, NULL);
    free(position);
}

/* What pulls at both sides with a tension that grows until a time.  \param[out] pull  [2] */
static void add_pull(const plate *p, double tension, double until, dem_boundary *pull)
{
    for (int side = 0; side < 2; side++) {
        const dem_index n = p->outline.n_sides[side];
        double *area = calloc((size_t)n, sizeof *area), sum = 0.0;
        assert_non_null(area);
        assert_ok(dem_lattice_edge_shares(&p->lattice, p->outline.sides[side], n, NULL, area));
        for (dem_index j = 0; j < n; j++) sum += area[j];
        for (dem_index j = 0; j < n; j++) area[j] /= sum;
        pull[side] = (dem_boundary)SIZED(dem_boundary, .kind = DEM_BOUNDARY_FORCE,
                                         .components = DEM_COMPONENT_X | DEM_COMPONENT_Y,
                                         .nodes = p->outline.sides[side], .n_nodes = n, .share = area,
                                         .value = {0.0, (side ? 1.0 : -1.0) * sum * tension}, .ramp = until);
    }
}

/* Waves along the plate are damped until rest().
 * \param tension  Pa, at the start; it grows by `more` until ramp() */
static void open_plate(plate *p, bool breaks, const plate_case *k, double tension, double more)
{
    dem_material solid = clamped_strip_material(false, nu);
    dem_options options = dem_options_default();
    dem_boundary pull[4];
    if (!breaks) solid.strength = 0.0;
    solid.fracture_energy = k->toughness * solid.strength * solid.strength * spacing / solid.youngs_modulus;
    p->lattice = support_rectangle(wide(k), 1.5 * wide(k), spacing, &solid);
    p->outline = clamped_strip_of(&p->lattice);
    stretch(p, &p->lattice, tension);
    add_pull(p, tension, 0.0, pull);
    add_pull(p, more, ramp(k), pull + 2);
    options.gravity[1] = 0.0;
    options.method = DEM_METHOD_VERLET;
    options.mass_damping = 2.0 * M_PI / (240.0 * k->size * unit_time);
    options.n_boundaries = more > 0.0 ? 4 : 2;
    options.boundaries = pull;
    support_open(&p->run, &p->lattice, NULL, 0, &options);
    for (int j = 0; j < 4; j++) free((void *)(uintptr_t)pull[j].share);
    const double middle = 0.5 * (p->outline.begin + p->outline.end), half = k->half * spacing;
    clamped_strip_cut(&p->outline, p->run.simulation, &p->lattice, middle - half, middle + half);
}

static void close_plate(plate *p)
{
    support_close(&p->run);
    clamped_strip_free(&p->outline);
    dem_lattice_free(&p->lattice);
}

/* What was cut is reported at the start. */
static dem_status note(void *context, const dem_simulation *s, const dem_break *what)
{
    (void)context;
    (void)s;
    return what->t == 0.0 ? DEM_OK : DEM_STOPPED;
}

/* A plate that starts as `other` at rest, under the tension `start`, and is pulled further by a hundredth of that,
 * breaks, and not as soon as it starts. */
static void check_law(const plate *other, const plate_case *k, double of_other, double start)
{
    plate p;
    const dem_lattice *l = &other->lattice;
    const dem_observer observer = {.struct_size = sizeof observer, .broken = note};
    const double *at_rest = ask_state(other->run.simulation).x;
    double *x = calloc((size_t)(2 * l->n_nodes), sizeof *x);
    assert_non_null(x);
    for (dem_index j = 0; j < 2 * l->n_nodes; j++) x[j] = l->x[j] + start / of_other * (at_rest[j] - l->x[j]);
    open_plate(&p, true, k, start, 0.01 * start);
    assert_ok(dem_simulation_observe(p.run.simulation, &observer));
    assert_ok(dem_simulation_set_motion(p.run.simulation, x, NULL));
    assert_int_equal(dem_simulation_advance(p.run.simulation, 2.0 * ramp(k)), DEM_STOPPED);
    assert_true(ask_state(p.run.simulation).t > 0.3 * ramp(k)); /* found: 0.71 to 0.78 */
    close_plate(&p);
    free(x);
}

/* K over strength sqrt(a) where a plate breaks. The tension is found from the stresses at rest under a tenth of the
 * strength, and confirmed by a plate that breaks between 0.995 and 1.005 of it. */
static double toughness(const plate_case *k)
{
    const double half = k->half * spacing, little = 0.1 * strength;
    plate p;
    dem_index next;
    open_plate(&p, false, k, little, 0.0);
    assert_ok(dem_simulation_advance(p.run.simulation, rest(k)));
    const double tension = little * strength / driving_most(p.run.simulation, &p.lattice, &next);
    check_law(&p, k, little, 0.995 * tension);
    close_plate(&p);
    return tension / strength * sqrt(M_PI * k->half / cos(M_PI * half / wide(k)));
}

/* To 5 %: cracks of few spacings are weaker than continuous bodies with them. */
static double check_toughness(const plate_case *k)
{
    const double found = toughness(k);
    assert_close(found, 1.87, 0.05 * 1.87);
    return found;
}

TEST(a_plate_breaks_where_its_crack_has_the_critical_stress_intensity)
{
    check_toughness(&(plate_case){0.6, 6.5, 0.0});
}

/* Found: 1.780, 1.819, 1.836. So the tension that an infinite plate stands falls as the length of the crack to the
 * power of -0.476 rather than -0.5; another code found -0.47. */
static void of_three_cracks(void **state)
{
    const plate_case list[3] = {{1.0, 4.5, 0.0}, {1.0, 8.5, 0.0}, {1.0, 16.5, 0.0}};
    double found[3];
    (void)state;
    for (int j = 0; j < 3; j++) found[j] = check_toughness(&list[j]);
    assert_close(log(found[2] / found[0]) / log(list[2].half / list[0].half) - 0.5, -0.47, 0.03);
}

/* ---- where triangles soften ---- */

typedef struct gone {
    double middle, half; /* m, of the crack, when it has gone so far */
    double t;            /* s */
} gone;

static dem_status note_far(void *context, const dem_simulation *s, const dem_break *what)
{
    gone *g = context;
    (void)s;
    if (what->t == 0.0 || fabs(what->x[0] - g->middle) < g->half) return DEM_OK;
    g->t = what->t;
    return DEM_STOPPED;
}

/* The tension of K_Ic = sqrt(E G), Pa. */
static double by_theory(const plate_case *k)
{
    const double half = k->half * spacing;
    return strength * sqrt(k->toughness * spacing / (M_PI * half) * cos(M_PI * half / wide(k)));
}

/* The tension grows from 0.75 of theory to 1.25, and is read when the crack has grown by an eighth at one end. */
static void check_softening(const plate_case *k)
{
    const double tension = by_theory(k);
    plate p;
    gone g = {.t = 0.0};
    const dem_observer observer = {.struct_size = sizeof observer, .broken = note_far, .context = &g};
    open_plate(&p, true, k, 0.75 * tension, 0.5 * tension);
    g.middle = 0.5 * (p.outline.begin + p.outline.end);
    g.half = 1.125 * k->half * spacing;
    assert_ok(dem_simulation_observe(p.run.simulation, &observer));
    assert_int_equal(dem_simulation_advance(p.run.simulation, ramp(k)), DEM_STOPPED);
    const double s = g.t / ramp(k), grown = s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
    assert_close(0.75 + 0.5 * grown, 1.0, 0.1);
    close_plate(&p);
}

/* Found: 1.019 of theory. */
TEST(a_plate_that_softens_stands_the_tension_of_its_toughness)
{
    check_softening(&(plate_case){0.35, 8.5, 4.2});
}

/* The same body and material at half and at a quarter of the spacing. Found: 1.015, 1.000. */
static void of_finer_plates(void **state)
{
    (void)state;
    check_softening(&(plate_case){0.7, 17.0, 8.4});
    check_softening(&(plate_case){1.4, 34.0, 16.8});
}

int main(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "long") == 0) {
        test_add(&(struct CMUnitTest)cmocka_unit_test(of_three_cracks), 1000);
        test_add(&(struct CMUnitTest)cmocka_unit_test(of_finer_plates), 1001);
    }
    return test_run();
}
