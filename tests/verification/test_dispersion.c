/* SPDX-License-Identifier: BSD-3-Clause */
/* Standing plane waves in lattices of triangles and of squares, against the dispersion relation of the infinite
 * lattice: the eigenvalues of a sum over the neighbours of one node. A wave of wave vector q stands about a node in the
 * middle of a block; after a quarter of its period the node is where it rests, before anything arrives from the
 * boundary. */
#include <stdbool.h>
#include <stdlib.h>

#include "harness/motion.h"
#include "support.h"

static const double E = 1e7, rho = 1050.0, a = 5e-3, amplitude = 1e-5; /* of the spacing */

typedef struct wave {
    bool squares;
    double nu, diagonal; /* of squares: stiffness of diagonals over sides */
    double q, direction; /* over 1/a; degrees from x */
    bool longitudinal;
} wave;

/* ---- the infinite lattice ---- */

typedef struct matrix {
    double xx, xy, yy;
} matrix;

static void add(matrix *m, double s, double x, double y)
{
    m->xx += s * x * x;
    m->xy += s * x * y;
    m->yy += s * y * y;
}

/* Springs of stiffness k to both neighbours at +-d: 2 k (1 - cos q.d) n n^T. */
static void add_springs(matrix *m, double k, const double q[2], double dx, double dy)
{
    add(m, 2.0 * k * (1.0 - cos(q[0] * dx + q[1] * dy)) / (dx * dx + dy * dy), dx, dy);
}

/* The six triangles at a node: kappa/A0 g (g.u + the others' gradients and phases). The imaginary parts of opposite
 * triangles cancel. */
static void add_areas(matrix *m, double kappa, const double q[2])
{
    const double area = sqrt(3.0) / 4.0 * a * a, turn = M_PI / 3.0;
    for (int t = 0; t < 6; t++) {
        const double b[2] = {a * cos(turn * t), a * sin(turn * t)},
                     c[2] = {a * cos(turn * (t + 1)), a * sin(turn * (t + 1))};
        const double g[2] = {-0.5 * (c[1] - b[1]), 0.5 * (c[0] - b[0])}, gb[2] = {0.5 * c[1], -0.5 * c[0]},
                     gc[2] = {-0.5 * b[1], 0.5 * b[0]};
        const double cb = cos(q[0] * b[0] + q[1] * b[1]), cc = cos(q[0] * c[0] + q[1] * c[1]);
        const double sum[2] = {g[0] + cb * gb[0] + cc * gc[0], g[1] + cb * gb[1] + cc * gc[1]};
        m->xx += kappa / area * g[0] * sum[0];
        m->xy += 0.5 * kappa / area * (g[0] * sum[1] + g[1] * sum[0]);
        m->yy += kappa / area * g[1] * sum[1];
    }
}

/* omega of the wave, whose direction is one of symmetry: longitudinal along q, transverse across. Per thickness. */
static double omega_of(const wave *w, double e[2])
{
    const double turn = M_PI / 180.0 * w->direction, q[2] = {w->q / a * cos(turn), w->q / a * sin(turn)};
    const double G = 0.5 * E / (1.0 + w->nu), kappa = E * w->nu / (1.0 - w->nu * w->nu) - G;
    matrix m = {0.0, 0.0, 0.0};
    double mass = rho * a * a;
    if (w->squares) {
        add_springs(&m, 2.0 * G, q, a, 0.0);
        add_springs(&m, 2.0 * G, q, 0.0, a);
        add_springs(&m, 2.0 * G * w->diagonal, q, a, a);
        add_springs(&m, 2.0 * G * w->diagonal, q, a, -a);
    } else {
        for (int n = 0; n < 3; n++)
            add_springs(&m, 4.0 * G / sqrt(3.0), q, a * cos(M_PI / 3.0 * n), a * sin(M_PI / 3.0 * n));
        add_areas(&m, kappa, q);
        mass *= sqrt(3.0) / 2.0;
    }
    e[0] = w->longitudinal ? cos(turn) : -sin(turn);
    e[1] = w->longitudinal ? sin(turn) : cos(turn);
    const double along[2] = {m.xx * e[0] + m.xy * e[1], m.xy * e[0] + m.yy * e[1]};
    const double value = along[0] * e[0] + along[1] * e[1];
    assert_close(hypot(along[0] - value * e[0], along[1] - value * e[1]), 0.0,
                 1e-10 * value); /* it is an eigenvector */
    return sqrt(value / mass);
}

/* ---- the run ---- */

static dem_index middle_of(const dem_lattice *l)
{
    dem_index best = 0;
    for (dem_index i = 0; i < l->n_nodes; i++)
        if (hypot(l->x[2 * i], l->x[2 * i + 1] - 13.0 * a) < hypot(l->x[2 * best], l->x[2 * best + 1] - 13.0 * a))
            best = i;
    return best;
}

static void make_block(dem_lattice *l, const wave *w)
{
    const dem_material solid =
        SIZED(dem_material, .youngs_modulus = E, .poissons_ratio = w->nu, .density = rho, .thickness = 1.0);
    if (w->squares) {
        assert_ok(dem_lattice_squares(l, 26.0 * a, 26.0 * a, a));
        assert_ok(dem_lattice_assemble_squares(l, &solid, w->diagonal));
    } else {
        assert_ok(dem_lattice_rectangle(l, 26.0 * a, 26.0 * a, a));
        assert_ok(dem_lattice_assemble(l, &solid));
    }
}

/* |u|/amplitude at the time where it should be 0 is the relative error of omega times pi/2. */
static double error_of(const wave *w)
{
    CLEANUP(dem_lattice_free) dem_lattice l = dem_lattice_empty();
    CLEANUP(support_close) support_run run;
    dem_options options = support_options();
    double e[2];
    make_block(&l, w);
    const double omega = omega_of(w, e), turn = M_PI / 180.0 * w->direction;
    const dem_index middle = middle_of(&l);
    const double x0 = l.x[2 * middle], y0 = l.x[2 * middle + 1];
    CLEANUP(free_memory) double *start = malloc(2 * (size_t)l.n_nodes * sizeof *start);
    assert_non_null(start);
    for (dem_index i = 0; i < l.n_nodes; i++) {
        const double phase = w->q / a * (cos(turn) * (l.x[2 * i] - x0) + sin(turn) * (l.x[2 * i + 1] - y0));
        for (int c = 0; c < 2; c++) start[2 * i + c] = l.x[2 * i + c] + amplitude * a * cos(phase) * e[c];
    }
    support_start(&l, start, NULL);
    options.gravity[1] = 0.0;
    options.rtol = 1e-9;
    options.v_scale = amplitude * a * omega;
    support_open(&run, &l, NULL, 0, &options);
    const motion state = support_at(&run, 0.5 * M_PI / omega);
    const double u = (state.x[2 * middle] - x0) * e[0] + (state.x[2 * middle + 1] - y0) * e[1];
    return fabs(u) / (amplitude * a) / (0.5 * M_PI);
}

static void check(const wave *w)
{
    double e[2];
    const double error = error_of(w), omega = omega_of(w, e);
    print_message("# %s, nu %.3f, diagonal %.2f: q a %.2f at %2.0f deg, %s: omega a/c %.5f, error %.1e\n",
                  w->squares ? "squares" : "triangles", w->nu, w->diagonal, w->q, w->direction,
                  w->longitudinal ? "longitudinal" : "transverse", omega * a / sqrt(E / rho), error);
    assert_true(error < 1e-6); /* 1e-4 is what is asked for; rtol 1e-9 over some ten steps */
}

TEST(waves_in_triangles_have_the_frequency_of_the_infinite_lattice)
{
    static const double ratios[] = {0.0, 1.0 / 3.0, 1.0 / 3.0, 0.45}, lengths[] = {1.0, 0.5, 1.0, 1.0};
    for (int k = 0; k < 16; k++) {
        const wave w = {.nu = ratios[k / 4],
                        .q = lengths[k / 4],
                        .direction = k / 2 % 2 == 0 ? 0.0 : 30.0,
                        .longitudinal = k % 2 == 0};
        check(&w);
    }
}

/* Without area term, whose triangles make every second cell another one. */
TEST(waves_in_squares_have_the_frequency_of_the_infinite_lattice)
{
    static const double diagonals[] = {0.5, 0.3};
    for (int k = 0; k < 8; k++) {
        const wave w = {.squares = true,
                        .diagonal = diagonals[k / 4],
                        .nu = diagonals[k / 4] / (1.0 + diagonals[k / 4]),
                        .q = 1.0,
                        .direction = k / 2 % 2 == 0 ? 0.0 : 45.0,
                        .longitudinal = k % 2 == 0};
        check(&w);
    }
}

/* omega over that of long waves, c q, from an independent program: triangles at nu = 1/3, along and across bonds. */
TEST(the_relation_is_that_of_an_independent_program)
{
    static const struct {
        double q, direction, transverse, longitudinal;
    } table[] = {{0.5, 0.0, 0.99740, 0.99048}, {1.0, 0.0, 0.98962, 0.96232}, {1.0, 30.0, 0.96904, 0.96904}};
    for (size_t k = 0; k < sizeof table / sizeof table[0]; k++)
        for (int longitudinal = 0; longitudinal < 2; longitudinal++) {
            const wave w = {
                .nu = 1.0 / 3.0, .q = table[k].q, .direction = table[k].direction, .longitudinal = longitudinal == 1};
            const double c = sqrt((longitudinal ? 9.0 : 3.0) / 8.0 * E / rho);
            double e[2];
            assert_close(omega_of(&w, e) * a / (c * w.q), longitudinal ? table[k].longitudinal : table[k].transverse,
                         6e-6);
        }
}
