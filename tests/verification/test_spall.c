/* SPDX-License-Identifier: BSD-3-Clause */
/* Spall of a chain: its first nodes, the flyer, move towards the others. Both ends send the compression back as
 * tension, and where the two meet, as far from the other end as the flyer is long, the chain breaks. Stretched in its
 * own line a chain is linear: with masses m, springs k = E/d0 and free ends its modes are cos(p pi (i + 1/2)/n), of the
 * frequencies w_p = 2 sqrt(k/m) sin(p pi/(2 n)). So the spring that breaks, its time, and what the two pieces do then
 * are known. */
#include "verification/support.h"

#include <stdlib.h>

enum { N = 80, FLYER = 15 };

static const double mass = 1.0, stiffness = 1.0, speed = 0.01,
                    limit = 0.0045; /* kg, N = N/m, m/s; of v/(2 c) = 0.005 */

/* Displacements and velocities of n nodes of a free chain at t, from those at t = 0. */
static void move(dem_index n, const double *u0, const double *v0, double t, double *u, double *v)
{
    const double pi = acos(-1.0);
    for (dem_index i = 0; i < n; i++) u[i] = v[i] = 0.0;
    for (dem_index p = 0; p < n; p++) {
        const double w = 2.0 * sqrt(stiffness / mass) * sin((double)p * pi / (2.0 * (double)n));
        const double norm = (p == 0 ? 1.0 : 2.0) / (double)n;
        double a = 0.0, b = 0.0;
        for (dem_index i = 0; i < n; i++) {
            const double mode = cos((double)p * pi * ((double)i + 0.5) / (double)n);
            a += norm * mode * u0[i];
            b += norm * mode * v0[i];
        }
        for (dem_index i = 0; i < n; i++) {
            const double mode = cos((double)p * pi * ((double)i + 0.5) / (double)n);
            u[i] += mode * (a * cos(w * t) + (p == 0 ? b * t : b * sin(w * t) / w));
            v[i] += mode * (b * cos(w * t) - a * w * sin(w * t));
        }
    }
}

static void start(double *u, double *v)
{
    for (dem_index i = 0; i < N; i++) {
        u[i] = 0.0;
        v[i] = i < FLYER ? speed : 0.0;
    }
}

/* The largest strain, and where. */
static double largest(double t, dem_index *spring)
{
    double u0[N], v0[N], u[N], v[N], most = 0.0;
    start(u0, v0);
    move(N, u0, v0, t, u, v);
    for (dem_index k = 0; k < N - 1; k++) {
        if (u[k + 1] - u[k] <= most) continue;
        most = u[k + 1] - u[k];
        *spring = k;
    }
    return most;
}

/* When the largest strain first reaches the limit, and in which spring. */
static double find_break(dem_index *spring)
{
    double before = 0.0, after = 0.0;
    while (largest(after, spring) < limit) {
        before = after;
        after += 0.05;
        assert_true(after < 200.0);
    }
    for (int k = 0; k < 60; k++) {
        const double middle = 0.5 * (before + after);
        *(largest(middle, spring) < limit ? &before : &after) = middle;
    }
    (void)largest(after, spring);
    return after;
}

/* `only`: the spring that may break; -1: all. */
static void open_chain(support_run *run, dem_contact_method way, dem_index only)
{
    double x[2 * N], v[2 * N], masses[N], u1[N], v1[N];
    dem_index ends[2 * (N - 1)];
    start(u1, v1);
    for (dem_index i = 0; i < N; i++) {
        x[2 * i] = (double)i;
        x[2 * i + 1] = v[2 * i + 1] = 0.0;
        v[2 * i] = v1[i];
        masses[i] = mass;
    }
    for (dem_index k = 0; k < 2 * (N - 1); k++) ends[k] = (k + 1) / 2;
    CLEANUP(dem_lattice_free) dem_lattice chain = support_lattice(N, x, masses, N - 1, ends, 1.0, stiffness, NULL);
    support_start(&chain, NULL, v);
    chain.critical_stretch = malloc((N - 1) * sizeof *chain.critical_stretch);
    assert_non_null(chain.critical_stretch);
    for (dem_index k = 0; k < N - 1; k++) chain.critical_stretch[k] = only < 0 || k == only ? limit : (double)INFINITY;
    dem_options options = dem_options_default();
    options.gravity[1] = 0.0;
    options.rtol = 1e-12;
    options.contact = way;
    support_open(run, &chain, NULL, 0, &options);
}

static dem_index count_broken(const support_run *run, unsigned char *broken)
{
    dem_index n = 0;
    assert_ok(dem_simulation_broken(run->simulation, NULL, broken));
    for (dem_index k = 0; k < N - 1; k++) n += broken[k];
    return n;
}

/* rtol 1e-12 of a spacing over some hundred steps leaves 1e-10 of it, in strains that grow at 1e-3 a second at least:
 * 1e-7 s of 80 s. The energy of the spring is half of 1 N 1 m limit^2. */
TEST(a_chain_breaks_where_and_when_its_modes_say)
{
    const dem_contact_method ways[2] = {DEM_CONTACT_LOCAL, DEM_CONTACT_EXACT};
    dem_index spring = -1;
    const double t = find_break(&spring);
    assert_in_range(spring, N - FLYER - 4, N - FLYER + 2);
    for (int way = 0; way < 2; way++) {
        CLEANUP(support_close) support_run run;
        unsigned char broken[N - 1];
        open_chain(&run, ways[way], -1);
        (void)support_at(&run, t * (1.0 - 1e-9));
        assert_int_equal(count_broken(&run, broken), 0);
        const motion s = support_at(&run, t * (1.0 + 1e-9));
        assert_int_equal(count_broken(&run, broken), 1);
        assert_int_equal(broken[spring], 1);
        assert_close(s.energy.fracture, 0.5 * limit * limit, 1e-13);
    }
}

/* From there the pieces move as free chains if nothing else may break: the release waves have the exact dispersion. */
TEST(release_waves_are_those_of_free_chains)
{
    dem_index spring = -1;
    const double t = find_break(&spring), after = 20.0;
    double u0[N], v0[N], u[N], v[N];
    unsigned char broken[N - 1];
    CLEANUP(support_close) support_run run;
    start(u, v);
    move(N, u, v, t, u0, v0);
    move(spring + 1, u0, v0, after, u, v);
    move(N - spring - 1, u0 + spring + 1, v0 + spring + 1, after, u + spring + 1, v + spring + 1);
    open_chain(&run, DEM_CONTACT_LOCAL, spring);
    const motion s = support_at(&run, t + after);
    assert_int_equal(count_broken(&run, broken), 1);
    for (dem_index i = 0; i < N; i++) {
        assert_close(s.x[2 * i] - (double)i, u[i], 1e-10);
        assert_close(s.v[2 * i], v[i], 1e-10);
    }
}
