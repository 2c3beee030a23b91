/* SPDX-License-Identifier: BSD-3-Clause */
/* Vectors for SUNDIALS (docs/algorithms.md, Vectors and norms of the integrator). Each N_Vector refers to a counted
 * buffer, and a copy shares the buffer of its original until one of them is written; ARKODE copies whole states often
 * and changes few of them. Linear combinations are one pass over all operands, shared out among threads. The norm of
 * the error is an exact sum of squares, so that the steps, and with them all results, do not depend on the number of
 * threads. A space has one buffer more than vectors, hence one is always free: no operation can fail for want of
 * memory. Sums may be deferred (deferral.c): who reads what is due has it carried out first, and who writes what a
 * deferred operation needs, too. The loops with vector instructions are in src/base/array_ops.h. */
#include "time/nvector.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "base/aligned.h"
#include "base/reduce.h"

enum { most_terms = 32, n_sampled = 16, NODE_LENGTH = 4 /* numbers of a node */ };

/* Numbers with a count of the vectors that refer to them; with none it is in the list of the free ones. */
typedef struct buffer {
    int users;
    struct buffer *next; /* of the free ones */
    double *values;
} buffer;

/* What an N_Vector points to. Contents of destroyed vectors are kept for the next ones. */
typedef struct content {
    nvector_space *space;
    buffer *buffer;
    nvector_use use;      /* by deferred operations */
    struct content *next; /* of the free ones */
} content;

struct nvector_space {
    nvector_shape shape;
    int n_shares;        /* of its loops */
    array_ops_sum *sums; /* [n_shares] */
    buffer *buffers;     /* the first free one */
    content *contents;
    N_Vector start;                   /* of a step; NULL: it is not known */
    const nvector_deferral *deferral; /* NULL: nothing is deferred */
};

static content *content_of(N_Vector v)
{
    return v->content;
}

/* ---- buffers ---- */

static bool add_buffer(nvector_space *s)
{
    buffer *b = calloc(1, sizeof *b);
    if (b != NULL) b->values = aligned_reals((size_t)s->shape.length);
    if (b == NULL || b->values == NULL) {
        free(b);
        return false;
    }
    b->next = s->buffers;
    s->buffers = b;
    return true;
}

/* Memory for one vector more: its content and a buffer. */
static bool add_content(nvector_space *s)
{
    content *c = calloc(1, sizeof *c);
    if (c == NULL || !add_buffer(s)) {
        free(c);
        return false;
    }
    *c = (content){.space = s, .next = s->contents};
    s->contents = c;
    return true;
}

/* One user less; the last one returns the buffer. */
static void leave(nvector_space *s, buffer *b)
{
    if (--b->users > 0) return;
    b->next = s->buffers;
    s->buffers = b;
}

/* A free buffer, with one user. There is one; see the banner. */
static buffer *take(nvector_space *s)
{
    buffer *b = s->buffers;
    s->buffers = b->next;
    b->users = 1;
    return b;
}

/* ---- where a step starts ---- */

void nvector_space_start(nvector_space *s, N_Vector start)
{
    s->start = start;
}

static bool is_start(const nvector_space *s, N_Vector x)
{
    return s->start != NULL && content_of(x)->use != NVECTOR_DUE &&
           content_of(x)->buffer == content_of(s->start)->buffer;
}

/* ---- what is deferred ---- */

void nvector_space_defer(nvector_space *s, const nvector_deferral *d)
{
    s->deferral = d;
}

void nvector_set_use(N_Vector v, nvector_use use)
{
    content_of(v)->use = use;
}

nvector_use nvector_get_use(N_Vector v)
{
    return content_of(v)->use;
}

static void begin_to_read(N_Vector v)
{
    const content *c = content_of(v);
    if (c->use == NVECTOR_DUE) c->space->deferral->before_read(c->space->deferral->self);
}

static void begin_to_write(N_Vector v)
{
    const content *c = content_of(v);
    if (c->use != NVECTOR_FREE) c->space->deferral->before_write(c->space->deferral->self);
}

/* ---- numbers ---- */

/* Numbers that no other vector has, undefined unless the vector was their only user. Others keep the old ones. */
double *nvector_fresh(N_Vector v)
{
    begin_to_write(v);
    content *c = content_of(v);
    if (c->buffer->users > 1) {
        leave(c->space, c->buffer);
        c->buffer = take(c->space);
    }
    return c->buffer->values;
}

const double *nvector_values(N_Vector v)
{
    begin_to_read(v);
    return content_of(v)->buffer->values;
}

/* The same numbers as nvector_values(), to be changed for all vectors that share them. */
double *nvector_shared(N_Vector v)
{
    begin_to_read(v);
    begin_to_write(v);
    return content_of(v)->buffer->values;
}

/* `b->users++` comes before leave(): both vectors may have the same buffer already. */
void nvector_share(N_Vector from, N_Vector to)
{
    begin_to_read(from);
    begin_to_write(to);
    content *c = content_of(to);
    buffer *b = content_of(from)->buffer;
    b->users++;
    leave(c->space, c->buffer);
    c->buffer = b;
}

/* ---- what ARKODE calls ---- */

static void fill(double value, N_Vector z)
{
    const content *c = content_of(z);
    double *to = nvector_fresh(z);
    for (dem_index k = 0; k < c->space->shape.length; k++) to[k] = value;
}

/* Numbers of z to write that are not those of an operand, which are read until the result is complete. An operand in a
 * buffer that z has alone goes back to the free list, where nobody takes it before the pass is over. */
static double *apart_from(N_Vector z, const double *const *in, int n)
{
    content *c = content_of(z);
    for (int p = 0; p < n; p++)
        if (in[p] == c->buffer->values && c->buffer->users == 1) {
            buffer *old = c->buffer;
            c->buffer = take(c->space);
            leave(c->space, old);
            break;
        }
    return nvector_fresh(z);
}

typedef struct combination {
    const nvector_space *space;
    double *out;
    int n;
    double factor[most_terms];
    const double *in[most_terms];
} combination;

/* A share of the pass; cuts are at the same components for every vector. */
static void combine_share(const void *context, int share, int thread)
{
    const combination *c = context;
    const nvector_space *s = c->space;
    const dem_index first = team_share(s->shape.length, s->n_shares, share);
    const double *from[most_terms];
    (void)thread;
    for (int k = 0; k < c->n; k++) from[k] = c->in[k] + first;
    s->shape.ops->combine(c->out + first, c->n, c->factor, from,
                          team_share(s->shape.length, s->n_shares, share + 1) - first);
}

/* Leaves out the terms that are 0 (many in a Butcher table); a sum of one vector with the factor 1 is shared instead of
 * copied. */
int nvector_combine(int n, const double *factor, N_Vector *x, N_Vector z)
{
    combination sum;
    int last = 0;
    begin_to_write(z);
    sum.space = content_of(z)->space;
    sum.n = 0;
    for (int k = 0; k < n; k++) {
        if (factor[k] == 0.0) continue;
        if (sum.n == most_terms) return -1;
        last = k;
        sum.factor[sum.n] = factor[k];
        sum.in[sum.n++] = nvector_values(x[k]);
    }
    if (sum.n == 0) {
        fill(0.0, z);
        return 0;
    }
    if (sum.n == 1 && sum.factor[0] == 1.0) {
        nvector_share(x[last], z);
        return 0;
    }
    sum.out = apart_from(z, sum.in, sum.n);
    team_run(sum.space->shape.team, sum.space->n_shares, combine_share, &sum);
    return 0;
}

static int combine(int n, sunrealtype *c, N_Vector *x, N_Vector z)
{
    const nvector_deferral *d = content_of(z)->space->deferral;
    int status;
    if (d != NULL && d->take_sum(d->self, n, c, x, z, &status)) return status;
    return nvector_combine(n, c, x, z);
}

static void add(sunrealtype a, N_Vector x, sunrealtype b, N_Vector y, N_Vector z)
{
    (void)combine(2, (sunrealtype[]){a, b}, (N_Vector[]){x, y}, z);
}

static void scale(sunrealtype a, N_Vector x, N_Vector z)
{
    (void)combine(1, &a, &x, z);
}

/* 1, 2^-20, 2^-40, ...: the first that takes numbers of this size to 32 at most. A power of 2 multiplies without
 * rounding. */
static double scale_of(double size)
{
    double scale = 1.0;
    while (size * scale > 32.0) scale *= 0x1p-20;
    return scale;
}

typedef struct squares {
    const nvector_space *space;
    const double *x;
    double scale;
} squares;

/* A share of the sum, into its own place. */
static void square_share(const void *context, int share, int thread)
{
    const squares *p = context;
    const nvector_space *s = p->space;
    const dem_index first = team_share(s->shape.length, s->n_shares, share);
    const dem_index n = team_share(s->shape.length, s->n_shares, share + 1) - first;
    (void)thread;
    s->sums[share] = (array_ops_sum){0};
    error_weights_square(s->shape.weights, &s->sums[share], p->x + first, p->scale, first, n);
}

/* The sum of (scale x_k w_k)^2. It is one of integers: no order and no shares change it. */
static array_ops_sum square(const nvector_space *s, const double *x, double scale)
{
    array_ops_sum sum = {0};
    team_run(s->shape.team, s->n_shares, square_share, &(squares){s, x, scale});
    for (int share = 0; share < s->n_shares; share++) array_ops_add(&sum, &s->sums[share]);
    return sum;
}

array_ops_sum nvector_squares(N_Vector x, double scale)
{
    return square(content_of(x)->space, nvector_values(x), scale);
}

/* The squares are added as integers in units of 2^-60, which hold for sizes up to 32 times a scale. */
bool nvector_norm_of_sum(const nvector_space *s, const array_ops_sum *sum, double *scale, double *norm)
{
    *norm = INFINITY;
    if (!isfinite(sum->largest)) return true;
    const double right = scale_of(sqrt(sum->largest) / *scale);
    const bool holds = right == *scale;
    if (holds) *norm = sqrt(array_ops_value(sum) / (double)s->shape.n_whole) / *scale;
    *scale = right;
    return holds;
}

/* A share of a bound of the norm. */
static void bound_share(const void *context, int share, int thread)
{
    const squares *p = context;
    const nvector_space *s = p->space;
    const dem_index first = team_share(s->shape.length, s->n_shares, share);
    const dem_index n = team_share(s->shape.length, s->n_shares, share + 1) - first;
    (void)thread;
    s->sums[share].largest = error_weights_bound(s->shape.weights, p->x + first, first, n);
}

/* A norm is no larger than the sum of |x_k w_k| over sqrt(n). */
static double bound_of(const nvector_space *s, const double *x)
{
    double sum = 0.0;
    team_run(s->shape.team, s->n_shares, bound_share, &(squares){.space = s, .x = x});
    for (int share = 0; share < s->n_shares; share++) sum += s->sums[share].largest;
    return sum / sqrt((double)s->shape.n_whole);
}

/* Whether a bound of the norm of the state from which a step goes is enough: ARKODE refuses tolerances where
 * DBL_EPSILON times it is more than 1. */
static bool bound_start(const nvector_space *s, N_Vector x, double *bound)
{
    if (s->shape.ranks->size > 1 || !is_start(s, x)) return false;
    *bound = bound_of(s, nvector_values(x));
    return *bound < 0.5 / DBL_EPSILON;
}

/* sqrt(sum of (x_k w_k)^2/n), infinity if a term is not finite. The scale is guessed from a sample of terms, and taken
 * again from the largest square of the sum until both agree. The result is that of the scale of the largest term,
 * whatever the sample was. ARKODE's vector of weights has no numbers: those of the space are meant. */
static sunrealtype norm(N_Vector x, N_Vector w)
{
    const nvector_space *s = content_of(x)->space;
    double largest = 0.0, result;
    (void)w;
    if (s->deferral != NULL && s->deferral->take_norm(s->deferral->self, x, &result)) return result;
    if (bound_start(s, x, &result)) return result;
    const double *values = nvector_values(x);
    for (dem_index k = 0; k < s->shape.length; k += s->shape.length / n_sampled + 1)
        largest = fmax(largest, fabs(values[k] * error_weights_at(s->shape.weights, k)));
    double scale = scale_of(reduce_max(s->shape.ranks, largest));
    for (;;) {
        const array_ops_sum sum = reduce_squares(s->shape.ranks, square(s, values, scale));
        if (nvector_norm_of_sum(s, &sum, &scale, &result)) return result;
    }
}

/* ARKODE asks for these and calls none of them, as weights and the first step are given. */

static sunrealtype largest(N_Vector x)
{
    const double *a = nvector_values(x);
    double most = 0.0;
    for (dem_index k = 0; k < content_of(x)->space->shape.length; k++) most = fmax(most, fabs(a[k]));
    return most;
}

static void divide(N_Vector x, N_Vector y, N_Vector z)
{
    const double *a = nvector_values(x), *b = nvector_values(y);
    double *to = nvector_fresh(z);
    for (dem_index k = 0; k < content_of(z)->space->shape.length; k++) to[k] = a[k] / b[k];
}

static void take_size(N_Vector x, N_Vector z)
{
    const double *a = nvector_values(x);
    double *to = nvector_fresh(z);
    for (dem_index k = 0; k < content_of(z)->space->shape.length; k++) to[k] = fabs(a[k]);
}

static void invert(N_Vector x, N_Vector z)
{
    const double *a = nvector_values(x);
    double *to = nvector_fresh(z);
    for (dem_index k = 0; k < content_of(z)->space->shape.length; k++) to[k] = 1.0 / a[k];
}

static void add_constant(N_Vector x, sunrealtype c, N_Vector z)
{
    const double *a = nvector_values(x);
    double *to = nvector_fresh(z);
    for (dem_index k = 0; k < content_of(z)->space->shape.length; k++) to[k] = a[k] + c;
}

/* ---- making and freeing ---- */

/* A kind of vector that SUNDIALS does not know, so that it uses the functions below only. */
static N_Vector_ID kind_of(N_Vector v)
{
    (void)v;
    return SUNDIALS_NVEC_CUSTOM;
}

static N_Vector clone(N_Vector v)
{
    return nvector_create(content_of(v)->space, v->sunctx);
}

static void destroy(N_Vector v)
{
    begin_to_write(v);
    content *c = content_of(v);
    leave(c->space, c->buffer);
    c->next = c->space->contents;
    c->space->contents = c;
    v->content = NULL;
    N_VFreeEmpty(v);
}

static void set_operations(N_Vector_Ops ops)
{
    ops->nvgetvectorid = kind_of;
    ops->nvclone = clone;
    ops->nvdestroy = destroy;
    ops->nvconst = fill;
    ops->nvlinearsum = add;
    ops->nvscale = scale;
    ops->nvlinearcombination = combine;
    ops->nvwrmsnorm = norm;
    ops->nvmaxnorm = largest;
    ops->nvdiv = divide;
    ops->nvabs = take_size;
    ops->nvinv = invert;
    ops->nvaddconst = add_constant;
}

/* There is always a free buffer, as every content came with one. */
N_Vector nvector_create(nvector_space *s, SUNContext context)
{
    if (s->contents == NULL && !add_content(s)) return NULL;
    N_Vector v = N_VNewEmpty(context);
    if (v == NULL) return NULL;
    content *c = s->contents;
    s->contents = c->next;
    c->buffer = take(s);
    c->use = NVECTOR_FREE;
    v->content = c;
    set_operations(v->ops);
    return v;
}

nvector_space *nvector_space_create(const nvector_shape *shape, int n_vectors)
{
    nvector_space *s = calloc(1, sizeof *s);
    if (s == NULL) return NULL;
    *s = (nvector_space){.shape = *shape, .n_shares = team_shares(shape->team, shape->length / NODE_LENGTH)};
    s->sums = calloc((size_t)s->n_shares, sizeof *s->sums);
    /* The buffer that no content came with: it keeps one free when all vectors have theirs. */
    bool complete = s->sums != NULL && add_buffer(s);
    for (int k = 0; k < n_vectors && complete; k++) complete = add_content(s);
    if (complete) return s;
    nvector_space_free(s);
    return NULL;
}

void nvector_space_free(nvector_space *s)
{
    if (s == NULL) return;
    while (s->buffers != NULL) {
        buffer *b = s->buffers;
        s->buffers = b->next;
        free(b->values);
        free(b);
    }
    while (s->contents != NULL) {
        content *c = s->contents;
        s->contents = c->next;
        free(c);
    }
    free(s->sums);
    free(s);
}
