/* SPDX-License-Identifier: BSD-3-Clause */
/* Beside what is broken the stress of a node is the mean of its triangles that are whole,
 *     S = (1/V) sum over these of (1/3) (sum over springs of w r x f + sum of r x f of its couplings + A dW/dA I),
 * with V a third of their volumes, w the triangle's share of each spring, and f the force of the whole spring: w of it
 * is what the triangle carries. To count broken triangles with a stress of 0 would make the node look unloaded where it
 * carries most, at the tip of a crack. Of a triangle that has softened each part in tension counts as it is left; of
 * the effective stress all counts. Where all elements are whole model/stress.c has the same sum by rows. */
#include "model/node_stress.h"

#include "model/spring_share.h"

/* What counts of a triangle in tension. */
static double counted(const element_state *s, node_stress_kind kind, dem_index triangle)
{
    return kind == NODE_STRESS_CARRIED && s->left != NULL ? s->left[triangle] : 1.0;
}

/* Adds w r x f of the springs that a triangle holds, all of it. */
static inline void add_springs(const dem_lattice *l, const element_state *s, dem_index triangle, const double *x,
                               double sum[3])
{
    const int32_t first = s->row[triangle], n = s->row[triangle + 1] - first;
    springs_add_virials(l, n, s->spring + first, s->share + first, x, sum);
}

/* The same of what is left of it. A spring is pulled if the trace of its r x f is positive. */
static void add_carried(const dem_lattice *l, const element_state *s, dem_index triangle, const double *x,
                        double sum[3])
{
    for (dem_index p = s->row[triangle]; p < s->row[triangle + 1]; p++) {
        double virial[3];
        springs_virial(l, s->spring[p], x, virial);
        const double share = element_state_share(s, triangle, p, virial[0] + virial[1] > 0.0);
        for (int k = 0; k < 3; k++) sum[k] += share * virial[k];
    }
}

/* Half of r x f of the springs at the node that no triangle holds, as three halves of what is divided by 3. */
static void add_loose(const dem_model *m, const element_state *s, dem_index i, const double *x, double sum[3])
{
    const springs *all = &m->springs;
    for (dem_index p = all->row[i]; p < all->row[i + 1]; p++) {
        const dem_index k = all->spring[p];
        double virial[3];
        if (s->held[k] || s->integrity[k] == 0.0) continue;
        springs_virial(&m->lattice, k, x, virial);
        for (int c = 0; c < 3; c++) sum[c] += 1.5 * virial[c];
    }
}

static void add_couplings(const couplings *c, const element_state *s, node_stress_kind kind, dem_index i,
                          const double *x, double sum[3])
{
    for (dem_index p = c->row[i]; p < c->row[i + 1]; p++) {
        const dem_index triangle = c->list[c->slot[p] / 3].triangle;
        double virial[3];
        if (s->triangle[triangle]) continue;
        couplings_virial(c, p, x, virial);
        for (int k = 0; k < 3; k++) sum[k] += counted(s, kind, triangle) * virial[k];
    }
}

static void add_areas(const triangles *t, const element_state *s, node_stress_kind kind, dem_index i, const double *x,
                      double sum[3])
{
    const triangles_integrity q = kind == NODE_STRESS_CARRIED ? element_state_triangles(s) : TRIANGLES_WHOLE;
    for (dem_index p = t->row[i]; p < t->row[i + 1]; p++) {
        const dem_index triangle = t->triangle[p];
        const double spread = s->triangle[triangle] ? 0.0 : triangles_virial(t, q, i, p, x);
        sum[0] += spread;
        sum[1] += spread;
    }
}

/* A third of everything falls to this corner; the thirds of r x f and of V cancel. */
static void of_whole_triangles(const dem_model *m, const element_state *s, node_stress_kind kind, dem_index i,
                               const double *x, double stress[3])
{
    double volume = 0.0;
    stress[0] = stress[1] = stress[2] = 0.0;
    for (dem_index p = s->at_row[i]; p < s->at_row[i + 1]; p++) {
        if (s->triangle[s->at[p]]) continue;
        if (kind == NODE_STRESS_CARRIED && s->left != NULL)
            add_carried(&m->lattice, s, s->at[p], x, stress);
        else
            add_springs(&m->lattice, s, s->at[p], x, stress);
        volume += spring_share_volume(&m->lattice, s->at[p]);
    }
    if (volume == 0.0) return;
    add_loose(m, s, i, x, stress);
    add_couplings(&m->couplings, s, kind, i, x, stress);
    add_areas(&m->triangles, s, kind, i, x, stress);
    for (int k = 0; k < 3; k++) stress[k] /= volume;
}

/* A triangle has a slot in the row of each of its corners, of which the first is taken. */
static void add_couplings_of(const couplings *c, dem_index corner, dem_index triangle, const double *x, double sum[3])
{
    for (dem_index p = c->row[corner]; p < c->row[corner + 1]; p++) {
        double virial[3];
        if (c->list[c->slot[p] / 3].triangle != triangle) continue;
        couplings_virial(c, p, x, virial);
        for (int k = 0; k < 3; k++) sum[k] += virial[k];
    }
}

void node_stress_of_triangle(const dem_model *m, const element_state *s, dem_index triangle, const double *x,
                             double stress[3])
{
    const dem_lattice *l = &m->lattice;
    const dem_index *corner = &l->triangles[3 * triangle];
    const double rest_area = vec2_area_of(l->x, corner);
    double sum[3] = {0.0, 0.0, 0.0};
    add_springs(l, s, triangle, x, sum);
    if (m->couplings.n > 0) add_couplings_of(&m->couplings, corner[0], triangle, x, sum);
    const double spread = triangles_virial_of(l, triangle, rest_area, x);
    const double volume = l->thickness != NULL ? l->thickness[triangle] * rest_area : rest_area;
    stress[0] = (sum[0] + spread) / volume;
    stress[1] = (sum[1] + spread) / volume;
    stress[2] = sum[2] / volume;
}

void node_stress(const dem_model *model, const element_state *state, node_stress_kind kind, dem_index i,
                 const double *x, double stress[3])
{
    if (element_state_at(state, i) != NULL)
        of_whole_triangles(model, state, kind, i, x, stress);
    else
        stress_of_node(&model->stress, &model->lattice, &model->triangles, i, x, stress);
}
