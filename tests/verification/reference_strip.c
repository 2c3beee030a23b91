/* SPDX-License-Identifier: BSD-3-Clause */
#include "reference_strip.h"

#include <stdlib.h>
#include <string.h>

#include "harness/test.h"

static const double row = 0.86602540378443865, area = 0.43301270189221932; /* sqrt(3)/2, sqrt(3)/4 */

typedef struct plate {
    int n_nodes, n_triangles;
    int *corner;                                 /* [n_triangles][3] */
    double *rest, *mass;                         /* [n_nodes][2], [n_nodes] */
    bool *held, *broken, *strong;                /* [n_nodes], [n_triangles], [n_triangles] */
    double *state, *next, *slope, *sum, *within; /* [n_nodes][4]: positions of all nodes, then velocities */
    double *stress, *use;                        /* [n_nodes][4]: sums of stresses and their number; [n_triangles] */
    double limit;
    bool by_stretch;
} plate;

static void *room(int n, size_t size)
{
    void *p = calloc((size_t)n, size);
    assert_non_null(p);
    return p;
}

/* Rows begin at 0 and at 1/2 by turns, and have wide + 1 and wide nodes. */
static int first_of(int r, int wide)
{
    return (r / 2) * (2 * wide + 1) + (r % 2) * (wide + 1);
}

static void add_triangle(plate *p, int i, int j, int k)
{
    const int corner[3] = {i, j, k};
    for (int c = 0; c < 3; c++) p->mass[corner[c]] += area / 3.0;
    memcpy(&p->corner[3 * p->n_triangles++], corner, sizeof corner);
}

static void add_layer(plate *p, int r, int wide)
{
    const int low = first_of(r, wide), high = first_of(r + 1, wide), odd = r % 2;
    for (int i = 0; i < wide - odd; i++) add_triangle(p, low + i, low + i + 1, high + i + odd);
    for (int i = 0; i < wide - 1 + odd; i++) add_triangle(p, low + i + 1 - odd, high + i, high + i + 1);
}

static plate plate_of(const reference_load *load)
{
    plate p = {.n_nodes = first_of(load->rows, load->wide), .limit = load->limit, .by_stretch = load->by_stretch};
    const int most = 2 * load->wide * load->rows;
    p.corner = room(3 * most, sizeof *p.corner);
    p.rest = room(2 * p.n_nodes, sizeof *p.rest);
    p.mass = room(p.n_nodes, sizeof *p.mass);
    p.held = room(p.n_nodes, sizeof *p.held);
    p.broken = room(most, sizeof *p.broken);
    p.strong = room(most, sizeof *p.strong);
    p.use = room(most, sizeof *p.use);
    double **const states[] = {&p.state, &p.next, &p.slope, &p.sum, &p.within, &p.stress};
    for (int k = 0; k < 6; k++) *states[k] = room(4 * p.n_nodes, sizeof(double));
    for (int r = 0; r < load->rows; r++)
        for (int i = first_of(r, load->wide); i < first_of(r + 1, load->wide); i++) {
            p.rest[2 * i] = i - first_of(r, load->wide) + 0.5 * (r % 2);
            p.rest[2 * i + 1] = r * row;
            p.held[i] = r == 0 || r == load->rows - 1;
        }
    for (int r = 0; r + 1 < load->rows; r++) add_layer(&p, r, load->wide);
    return p;
}

static void plate_free(plate *p)
{
    void *const all[] = {p->corner, p->rest,  p->mass, p->held,   p->broken, p->strong, p->state,
                         p->next,   p->slope, p->sum,  p->within, p->stress, p->use};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) free(all[k]);
}

static double centre(const plate *p, int t, int axis)
{
    double sum = 0.0;
    for (int c = 0; c < 3; c++) sum += p->rest[2 * p->corner[3 * t + c] + axis] / 3.0;
    return sum;
}

/* Edge k of triangle t at positions x: its ends, the way from one to the other, and its length. */
static double edge(const plate *p, const double *x, int t, int k, int ends[2], double way[2])
{
    for (int e = 0; e < 2; e++) ends[e] = p->corner[3 * t + (k + e) % 3];
    for (int axis = 0; axis < 2; axis++) way[axis] = x[2 * ends[1] + axis] - x[2 * ends[0] + axis];
    return sqrt(way[0] * way[0] + way[1] * way[1]);
}

/* Each triangle has a share of A/e in the stiffness E h A/e of its springs, and their force is (1): e = 1. */
static void rates(const plate *p, const double *state, double *slope)
{
    double *a = slope + 2 * p->n_nodes;
    memcpy(slope, state + 2 * p->n_nodes, (size_t)(2 * p->n_nodes) * sizeof *slope);
    memset(a, 0, (size_t)(2 * p->n_nodes) * sizeof *a);
    for (int t = 0; t < p->n_triangles; t++)
        for (int k = 0; k < 3 && !p->broken[t]; k++) {
            int ends[2];
            double way[2];
            const double length = edge(p, state, t, k, ends, way), pull = area * (length - 1.0) / length;
            for (int axis = 0; axis < 2; axis++) {
                a[2 * ends[0] + axis] += pull * way[axis] / p->mass[ends[0]];
                a[2 * ends[1] + axis] -= pull * way[axis] / p->mass[ends[1]];
            }
        }
    for (int i = 0; i < 2 * p->n_nodes; i++)
        if (p->held[i / 2]) a[i] = 0.0;
}

/* p->next is what p->state becomes after h. */
static void step(plate *p, double h)
{
    const int n = 4 * p->n_nodes;
    const double weight[] = {h / 6.0, h / 3.0, h / 3.0, h / 6.0}, to[] = {0.5 * h, 0.5 * h, h, 0.0};
    memcpy(p->sum, p->state, (size_t)n * sizeof *p->sum);
    memcpy(p->within, p->state, (size_t)n * sizeof *p->within);
    for (int stage = 0; stage < 4; stage++) {
        rates(p, p->within, p->slope);
        for (int i = 0; i < n; i++) p->sum[i] += weight[stage] * p->slope[i];
        for (int i = 0; i < n; i++) p->within[i] = p->state[i] + to[stage] * p->slope[i];
    }
    memcpy(p->next, p->sum, (size_t)n * sizeof *p->next);
}

/* Stress of triangle t, r x f over its volume: xx, yy, xy. */
static void stress_of(const plate *p, const double *x, int t, double stress[3])
{
    stress[0] = stress[1] = stress[2] = 0.0;
    for (int k = 0; k < 3; k++) {
        int ends[2];
        double way[2];
        const double length = edge(p, x, t, k, ends, way), pull = (length - 1.0) / length;
        stress[0] += pull * way[0] * way[0];
        stress[1] += pull * way[1] * way[1];
        stress[2] += pull * way[0] * way[1];
    }
}

/* Nodes have the mean of their triangles' stresses, whose volumes are alike. */
static void average(plate *p, const double *x)
{
    memset(p->stress, 0, (size_t)(4 * p->n_nodes) * sizeof *p->stress);
    for (int t = 0; t < p->n_triangles; t++) {
        double stress[3];
        if (p->broken[t]) continue;
        stress_of(p, x, t, stress);
        for (int c = 0; c < 3; c++) {
            double *at = &p->stress[4 * p->corner[3 * t + c]];
            for (int j = 0; j < 3; j++) at[j] += stress[j];
            at[3] += 1.0;
        }
    }
}

/* The largest principal value of the mean of its corners' stresses. */
static double tension(const plate *p, int t)
{
    double mean[3] = {0.0, 0.0, 0.0};
    for (int c = 0; c < 3; c++) {
        const double *at = &p->stress[4 * p->corner[3 * t + c]];
        for (int j = 0; j < 3; j++) mean[j] += at[j] / at[3] / 3.0;
    }
    return 0.5 * (mean[0] + mean[1]) + hypot(0.5 * (mean[0] - mean[1]), mean[2]);
}

static double longest(const plate *p, const double *x, int t)
{
    double most = 0.0;
    for (int k = 0; k < 3; k++) {
        int ends[2];
        double way[2];
        most = fmax(most, edge(p, x, t, k, ends, way) - 1.0);
    }
    return most;
}

/* The largest of all triangles' uses of their limits. A spring that reaches its limit takes both its triangles. */
static double most_used(plate *p, const double *x)
{
    double most = 0.0;
    if (!p->by_stretch) average(p, x);
    for (int t = 0; t < p->n_triangles; t++) {
        p->use[t] = 0.0;
        if (p->broken[t] || p->strong[t]) continue;
        p->use[t] = (p->by_stretch ? longest(p, x, t) : tension(p, t)) / p->limit;
        most = fmax(most, p->use[t]);
    }
    return most;
}

/* The time within a step of h at which a limit is reached, which it is at its end; p->next is the state then. Secants
 * between both sides (Illinois). */
static double time_of_break(plate *p, double h, double at_start, double at_end)
{
    double low = 0.0, high = h, below = at_start - 1.0, above = at_end - 1.0, reached = above;
    int side = 0; /* on which the last root of a secant was */
    while (reached > 1e-9) {
        const double s = low - (high - low) * below / (above - below);
        step(p, s);
        const double found = most_used(p, p->next) - 1.0;
        if (found < 0.0) {
            low = s, below = found;
            above *= side < 0 ? 0.5 : 1.0;
            side = -1;
        } else {
            high = s, above = reached = found;
            below *= side > 0 ? 0.5 : 1.0;
            side = 1;
        }
    }
    step(p, high);
    return high;
}

/* Breaks all that is at its limit, and what is beyond it by that. */
static int break_all(plate *p, double t, reference_break *list, int n, int most)
{
    for (double enough = 1.0 - 1e-9; most_used(p, p->state) >= enough; enough = 1.0)
        for (int k = 0; k < p->n_triangles; k++) {
            if (p->use[k] < enough) continue;
            assert_true(n < most);
            p->broken[k] = true;
            list[n++] = (reference_break){t, {centre(p, k, 0), centre(p, k, 1)}};
        }
    return n;
}

/* Stretched uniformly and at rest, cut, and strong where it shall not break. */
static void start(plate *p, const reference_load *load)
{
    const double height = (load->rows - 1) * row, nu = 1.0 / 3.0,
                 strain = load->limit * sqrt(load->g * 2.0 * (1.0 - nu * nu) / height);
    for (int i = 0; i < p->n_nodes; i++) {
        p->state[2 * i] = p->rest[2 * i];
        p->state[2 * i + 1] = p->rest[2 * i + 1] * (1.0 + strain);
    }
    for (int t = 0; t < p->n_triangles; t++) {
        const double x = centre(p, t, 0), y = centre(p, t, 1);
        p->broken[t] = (int)(y / row) == (load->rows - 1) / 2 && x < load->cut;
        p->strong[t] = fmin(fmin(y, height - y), load->wide - x) < load->margin;
    }
}

int reference_strip(const reference_load *load, double until, double longest_step, reference_break *list, int most)
{
    plate p = plate_of(load);
    double t = 0.0, tip = load->cut;
    int n = 0;
    start(&p, load);
    double used = most_used(&p, p.state);
    while (tip < until) {
        assert_true(t < 1000.0);
        step(&p, longest_step);
        const double after = most_used(&p, p.next);
        const bool breaks = after >= 1.0;
        t += breaks ? time_of_break(&p, longest_step, used, after) : longest_step;
        memcpy(p.state, p.next, (size_t)(4 * p.n_nodes) * sizeof *p.state);
        const int before = n;
        if (breaks) n = break_all(&p, t, list, n, most);
        for (int k = before; k < n; k++) tip = fmax(tip, list[k].x[0]);
        used = breaks ? most_used(&p, p.state) : after;
    }
    plate_free(&p);
    return n;
}
