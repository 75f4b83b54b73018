/* gradient_multigrid.c - gradient problems by conjugate gradients with a multigrid preconditioner.
 *
 * Weak data against strong gradients make a system whose smooth errors are invisible in its residual: with weights of
 * 1e-5 and 1, conjugate gradients alone need thousands of steps. Multigrid removes each error where it is not smooth: a
 * Gauss-Seidel sweep makes it smooth, the residual goes to groups of nodes (gradient_levels.h), which solve for one
 * correction per group, and a sweep in reverse order follows. The groups' own equations are solved by two steps of
 * conjugate gradients, each with a visit of the level below as preconditioner: the K-cycle [Notay 2008]. They make up
 * for corrections that are constant per group. Around it, flexible conjugate gradients [Notay 2000] run on the finest
 * level.
 *
 * From the visit of a level, with A = D - L - U (diagonal, links to smaller nodes, links to larger ones):
 *     x = (D - L)^-1 b                   first sweep, from 0
 *     b - A x = U x                      its residual
 *     x = x + P x of the next level      t = b + L x
 *     x = (D - U)^-1 t                   second sweep
 *     A x = t - L x                      what conjugate gradients need
 * so that the visit and A x take together two and a half times the work of one product with A.
 *
 * Cycles run in single precision, which carries weights of 1e-7 to 1; others are not solved here. The finest level
 * evaluates A x from differences of x, so that a small excess does not drown in the rounding of the diagonal. Values
 * are summed in double precision: after every few steps the correction found so far is added to them, and the residual
 * is evaluated anew from them. As a cycle's result z approximates the error itself, its largest value says when to
 * stop.
 *
 * Each channel has its own step lengths; all are in one vector register. Everything is summed in a fixed order, by one
 * thread: callers have many pictures to solve at a time.
 *
 * Differs from the sources: no guaranteed rate; a level takes one step only where its nodes are not far fewer than
 * those of the level above. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "common/math/gradient_levels.h"
#include "common/math/lanes.h"

enum {
    MAX_ITERATIONS = 150,
    RENEW = 8,  /* steps after which the residual is evaluated anew */
    BLOCK = 64, /* terms of a sum in single precision */
};
#define RENEW_DROP 1e-3 /* of the largest residual: the same */
#define TOLERANCE  3e-6 /* of the range of the values: the largest correction that is not worth another step */
#define PRECISION  1e-7 /* the same, of the largest value */
#define MAX_SPAN   1e-7 /* the smallest weight above 0, over the largest, that single precision can tell from 0 */

typedef double loose_d4 __attribute__((vector_size(32), aligned(8), may_alias)); /* double[4] anywhere */

/* Vectors of a level: 3 channels and a spare one. */
struct vectors {
    f32x4 *b, *x;         /* right-hand side and solution; one more node for those without a group */
    f32x4 *c, *v, *d, *w; /* two steps towards it, and A times each */
};

struct cycle {
    const struct gradient_levels *levels;
    struct vectors at[GRADIENT_MAX_LEVELS];
};

static enum status cycle_init(struct cycle *cy, const struct gradient_levels *levels, struct err *err)
{
    cy->levels = levels;
    for (int k = 0; k < levels->count; k++) {
        const size_t n = (size_t)levels->level[k].count + 1, bytes = 6 * n * sizeof(f32x4);
        f32x4 *all = calloc(6 * n, sizeof *all);
        if (!all) return err_nomem(err, "vectors of a gradient problem", bytes);
        cy->at[k] = (struct vectors){all, all + n, all + 2 * n, all + 3 * n, all + 4 * n, all + 5 * n};
    }
    return ST_OK;
}

static void cycle_release(struct cycle *cy)
{
    for (int k = 0; k < GRADIENT_MAX_LEVELS; k++) free(cy->at[k].b);
}

static inline f32x4 larger_size(f32x4 most, f32x4 a) { return f32x4_max(most, f32x4_abs(a)); }

static inline f64x4 widen(f32x4 a) { return __builtin_convertvector(a, f64x4); }

/* a / b per channel; 0 where b is not above 0. */
static f32x4 quotient(f64x4 a, f64x4 b)
{
    f32x4 q = {0};
    for (int c = 0; c < 4; c++) q[c] = b[c] > 0 ? (float)(a[c] / b[c]) : 0;
    return q;
}

static f32x4 more_links(const struct gradient_link *more, int begin, int end, const f32x4 *x)
{
    f32x4 sum = {0};
    for (int e = begin; e < end; e++) sum += more[e].weight * x[more[e].to];
    return sum;
}

#define INLINE static inline __attribute__((always_inline))

/* The sum over n places. */
INLINE f32x4 placed_links(const int *to, const float *weight, int n, const f32x4 *x)
{
    f32x4 sum = weight[0] * x[to[0]];
    for (int e = 1; e < n; e++) sum += weight[e] * x[to[e]];
    return sum;
}

/* L x of node i without its last place, which is the link to the nearest node. */
INLINE f32x4 far_smaller(const struct gradient_level *l, int width, int i, const f32x4 *x)
{
    const size_t at = 2 * (size_t)width * (size_t)i;
    f32x4 sum = placed_links(l->to + at, l->weight + at, width - 1, x);
    if (width > GRADIENT_FINE_WIDTH && l->more)
        sum += more_links(l->more, l->more_begin[2 * i], l->more_begin[2 * i + 1], x);
    return sum;
}

/* U x of node i without its first place. */
INLINE f32x4 far_larger(const struct gradient_level *l, int width, int i, const f32x4 *x)
{
    const size_t at = 2 * (size_t)width * (size_t)i + (size_t)width + 1;
    f32x4 sum = placed_links(l->to + at, l->weight + at, width - 1, x);
    if (width > GRADIENT_FINE_WIDTH && l->more)
        sum += more_links(l->more, l->more_begin[2 * i + 1], l->more_begin[2 * i + 2], x);
    return sum;
}

INLINE f32x4 near_smaller(const struct gradient_level *l, int width, int i, const f32x4 *x)
{
    const size_t at = 2 * (size_t)width * (size_t)i + (size_t)width - 1;
    return l->weight[at] * x[l->to[at]];
}

INLINE f32x4 near_larger(const struct gradient_level *l, int width, int i, const f32x4 *x)
{
    const size_t at = 2 * (size_t)width * (size_t)i + (size_t)width;
    return l->weight[at] * x[l->to[at]];
}

/* x = (D - L)^-1 b. The nearest node's value comes last, and is multiplied by one number only: it has just been found,
 * and the next waits for it. So in the second sweep. */
INLINE void first_sweep(const struct gradient_level *l, int width, f32x4 *x, const f32x4 *b)
{
    for (int i = 0; i < l->count; i++) {
        const size_t near = 2 * (size_t)width * (size_t)i + (size_t)width - 1;
        const f32x4 far = (b[i] + far_smaller(l, width, i, x)) * l->inverse[i];
        x[i] = far + l->weight[near] * l->inverse[i] * x[l->to[near]];
    }
}

/* Adds U x of each node to its group. */
INLINE void restrict_residual(const struct gradient_level *l, int width, f32x4 *b, const f32x4 *x)
{
    for (int i = 0; i < l->count; i++) b[l->group[i]] += near_larger(l, width, i, x) + far_larger(l, width, i, x);
}

/* t = b + L x, x = (D - U)^-1 t */
INLINE void second_sweep(const struct gradient_level *l, int width, f32x4 *x, f32x4 *t, const f32x4 *b)
{
    for (int i = l->count - 1; i >= 0; i--) {
        const size_t near = 2 * (size_t)width * (size_t)i + (size_t)width;
        t[i] = b[i] + far_smaller(l, width, i, x) + near_smaller(l, width, i, x);
        const f32x4 far = (t[i] + far_larger(l, width, i, x)) * l->inverse[i];
        x[i] = far + l->weight[near] * l->inverse[i] * x[l->to[near]];
    }
}

/* A x of node i from differences. */
INLINE f32x4 product_of(const struct gradient_level *l, int i, const f32x4 *x)
{
    const int *to = l->to + 2 * GRADIENT_FINE_WIDTH * (size_t)i;
    const float *weight = l->weight + 2 * GRADIENT_FINE_WIDTH * (size_t)i;
    f32x4 sum = l->excess[i] * x[i];
    for (int e = 0; e < 2 * GRADIENT_FINE_WIDTH; e++) sum += weight[e] * (x[i] - x[to[e]]);
    return sum;
}

/* Sums over all nodes. */
struct sums {
    f64x4 xy, xb, xq;
    f32x4 largest; /* |x| */
};

/* y = A x, where y is t of the second sweep; and sums. */
INLINE struct sums product(const struct gradient_level *l, int width, const f32x4 *x, f32x4 *y, const f32x4 *b,
                           const f32x4 *q)
{
    struct sums s = {0};
    for (int begin = 0; begin < l->count; begin += BLOCK) {
        const int end = begin + BLOCK < l->count ? begin + BLOCK : l->count;
        f32x4 xy = {0}, xb = {0}, xq = {0};
        for (int i = begin; i < end; i++) {
            if (width == GRADIENT_FINE_WIDTH)
                y[i] = product_of(l, i, x);
            else
                y[i] -= far_smaller(l, width, i, x) + near_smaller(l, width, i, x);
            xy += x[i] * y[i];
            xb += x[i] * b[i];
            xq += x[i] * q[i];
            s.largest = larger_size(s.largest, x[i]);
        }
        s.xy += widen(xy);
        s.xb += widen(xb);
        s.xq += widen(xq);
    }
    return s;
}

static void solve_dense(const struct gradient_levels *levels, f32x4 *x, const f32x4 *b)
{
    const int n = levels->level[levels->count - 1].count;
    for (int k = 0; k < n; k++) x[k] = b[k];
    for (int k = 0; k < n; k++)
        for (int i = k + 1; i < n; i++) x[i] += levels->dense[k * GRADIENT_DENSE + i] * x[k];
    for (int k = n - 1; k >= 0; k--) {
        f32x4 sum = x[k] * levels->inverse_pivot[k];
        for (int i = k + 1; i < n; i++) sum += levels->dense[k * GRADIENT_DENSE + i] * x[i];
        x[k] = sum;
    }
}

static void solve_level(struct cycle *cy, int k);

/* x: the cycle's result for b, y = A x; q: for the sums. They are of level k, and all differ. */
INLINE struct sums visit_width(struct cycle *cy, int k, int width, f32x4 *x, f32x4 *y, const f32x4 *b, const f32x4 *q)
{
    const struct gradient_level *l = &cy->levels->level[k];
    first_sweep(l, width, x, b);
    if (l->group) {
        const struct vectors *next = &cy->at[k + 1];
        memset(next->b, 0, ((size_t)cy->levels->level[k + 1].count + 1) * sizeof *next->b);
        restrict_residual(l, width, next->b, x);
        solve_level(cy, k + 1);
        for (int i = 0; i < l->count; i++) x[i] += next->x[l->group[i]];
    }
    second_sweep(l, width, x, y, b);
    return product(l, width, x, y, b, q);
}

static struct sums visit_finest(struct cycle *cy, f32x4 *x, f32x4 *y, const f32x4 *b, const f32x4 *q)
{
    const struct gradient_level *l = &cy->levels->level[0];
    if (l->group || !cy->levels->dense) return visit_width(cy, 0, GRADIENT_FINE_WIDTH, x, y, b, q);
    solve_dense(cy->levels, x, b);
    return product(l, GRADIENT_FINE_WIDTH, x, y, b, q);
}

static struct sums visit(struct cycle *cy, int k, f32x4 *x, f32x4 *y, const f32x4 *b, const f32x4 *q)
{
    return visit_width(cy, k, GRADIENT_COARSE_WIDTH, x, y, b, q);
}

/* b -= step v; returns whether that makes b four times smaller in all channels. */
static bool reduce(f32x4 *b, f32x4 step, const f32x4 *v, int count)
{
    f64x4 before = {0}, after = {0};
    for (int begin = 0; begin < count; begin += BLOCK) {
        const int end = begin + BLOCK < count ? begin + BLOCK : count;
        f32x4 old = {0}, new = {0};
        for (int i = begin; i < end; i++) {
            old += b[i] * b[i];
            b[i] -= step * v[i];
            new += b[i] * b[i];
        }
        before += widen(old);
        after += widen(new);
    }
    bool small = true;
    for (int c = 0; c < 3; c++) small = small && after[c] <= before[c] / 16;
    return small;
}

/* x of level k from its b, which is overwritten: one or two steps of flexible conjugate gradients, c and d - back c. */
static void solve_level(struct cycle *cy, int k)
{
    const struct vectors *at = &cy->at[k];
    const int n = cy->levels->level[k].count;
    if (k + 1 == cy->levels->count && cy->levels->dense) {
        solve_dense(cy->levels, at->x, at->b);
        return;
    }
    const struct sums one = visit(cy, k, at->c, at->v, at->b, at->b);
    f32x4 step = quotient(one.xb, one.xy), second = {0};
    if (cy->levels->level[k].twice && !reduce(at->b, step, at->v, n)) {
        const struct sums two = visit(cy, k, at->d, at->w, at->b, at->v);
        const f32x4 back = quotient(two.xq, one.xy);
        second = quotient(two.xb, two.xy - widen(back) * two.xq);
        step -= second * back;
    }
    for (int i = 0; i < n; i++) at->x[i] = step * at->c[i] + second * at->d[i];
}

/* The iteration on the finest level. r, e and so on are its vectors b, x, c, v, d, w. */
struct outer {
    const struct gradient_system *s;
    const struct gradient_level *l;
    double (*v)[4];               /* values */
    double weight_scale;          /* of the level, over that of the system */
    f64x4 scale;                  /* of r and e per channel, over the true ones */
    f32x4 *r, *e, *z, *y, *p, *q; /* residual, correction of v, cycle's result, A times it, direction, A times it */
    double tolerance;             /* of corrections of v */
};

/* Adds e to v, and makes the tolerance from the range of v. */
static void add_correction(struct outer *o)
{
    double low = o->s->low, high = o->s->high;
    for (int i = 0; i < o->s->count; i++) {
        loose_d4 *v = (loose_d4 *)o->v[i];
        *v += widen(o->e[i]) / o->scale;
        o->e[i] = (f32x4){0};
        for (int c = 0; c < 3; c++) {
            low = o->v[i][c] < low ? o->v[i][c] : low;
            high = o->v[i][c] > high ? o->v[i][c] : high;
        }
    }
    o->tolerance = fmax(TOLERANCE * (high - low), PRECISION * fmax(fabs(low), fabs(high)));
}

/* r from v; returns its largest per channel. */
static f32x4 renew(struct outer *o)
{
    const struct gradient_level *l = o->l;
    const f64x4 scale = o->scale;
    f32x4 largest = {0};
    for (int i = 0; i < l->count; i++) {
        const f64x4 here = *(const loose_d4 *)o->v[i];
        f64x4 sum = (*(const loose_d4 *)o->s->rhs[i] - o->s->excess[i] * here) * o->weight_scale;
        for (int e = 0; e < 2 * GRADIENT_FINE_WIDTH; e++) {
            const size_t at = 2 * GRADIENT_FINE_WIDTH * (size_t)i + (size_t)e;
            sum += (double)l->weight[at] * (*(const loose_d4 *)o->v[l->to[at]] - here);
        }
        o->r[i] = __builtin_convertvector(sum * scale, f32x4);
        largest = larger_size(largest, o->r[i]);
    }
    return largest;
}

/* One step along z + beta p; returns the largest |r| per channel. */
static f32x4 take_step(struct outer *o, f32x4 beta, f32x4 alpha)
{
    f32x4 largest = {0};
    for (int i = 0; i < o->l->count; i++) {
        o->p[i] = o->z[i] - beta * o->p[i];
        o->q[i] = o->y[i] - beta * o->q[i];
        o->e[i] += alpha * o->p[i];
        o->r[i] -= alpha * o->q[i];
        largest = larger_size(largest, o->r[i]);
    }
    return largest;
}

static bool below(f32x4 a, f64x4 limit)
{
    bool below = true;
    for (int c = 0; c < 3; c++) below = below && (double)a[c] <= limit[c];
    return below;
}

/* Returns the number of iterations; -1: no convergence. */
static int iterate(struct cycle *cy, struct outer *o)
{
    f64x4 pq = {0};
    o->scale = (f64x4){1, 1, 1, 1};
    add_correction(o);
    f32x4 left = renew(o), bound = left;
    for (int c = 0; c < 4; c++) o->scale[c] = left[c] > 0 ? 1 / (double)left[c] : 1;
    renew(o);
    for (int iteration = 1, since = 0; iteration <= MAX_ITERATIONS; iteration++) {
        const struct sums s = visit_finest(cy, o->z, o->y, o->r, o->q);
        if (below(s.largest, o->tolerance * o->scale)) {
            for (int i = 0; i < o->l->count; i++) o->e[i] += o->z[i];
            add_correction(o);
            return iteration;
        }
        const f32x4 beta = quotient(s.xq, pq);
        pq = s.xy - widen(beta) * s.xq;
        left = take_step(o, beta, quotient(s.xb, pq));
        if (++since < RENEW && !below(left, RENEW_DROP * widen(bound))) continue;
        since = 0;
        add_correction(o);
        bound = renew(o);
    }
    return -1;
}

static enum status run(const struct gradient_system *s, const struct gradient_levels *levels, double (*v)[4],
                       int *iterations, struct err *err)
{
    struct cycle cy = {0};
    enum status status = cycle_init(&cy, levels, err);
    if (!status) {
        const struct vectors *at = &cy.at[0];
        struct outer o = {
            .s = s, .l = &levels->level[0], .v = v, .weight_scale = (double)levels->scale, .r = at->b, .e = at->x};
        o.z = at->c;
        o.y = at->v;
        o.p = at->d;
        o.q = at->w;
        *iterations = iterate(&cy, &o);
    }
    cycle_release(&cy);
    return status;
}

/* Whether the weights are of similar enough size for single precision. */
static bool weights_fit(const struct gradient_system *s)
{
    double low = INFINITY, high = 0;
    for (int i = 0; i < s->count; i++) {
        const double all[] = {s->excess[i], (double)s->weight[i][0], (double)s->weight[i][1]};
        for (int k = 0; k < 3; k++) {
            low = all[k] > 0 && all[k] < low ? all[k] : low;
            high = all[k] > high ? all[k] : high;
        }
    }
    return !(low < MAX_SPAN * high);
}

enum status gradient_multigrid(const struct gradient_system *s, double (*v)[4], int *iterations, struct err *err)
{
    struct gradient_levels levels = {0};
    *iterations = s->count && !weights_fit(s) ? -1 : 0;
    if (!s->count || *iterations < 0) return ST_OK;
    /* parts that have converged are full of denormal numbers, which are slow */
    const uint64_t before = denormals_flush();
    enum status status = gradient_levels_init(&levels, s, err);
    if (!status) status = run(s, &levels, v, iterations, err);
    gradient_levels_release(&levels);
    denormals_restore(before);
    return status;
}
