/* exact.c - exact predicates on planes, points and lines.
 *
 * Overview. Planes have integer coefficients; everything else is made from them. The point of three planes has the
 * homogeneous coordinates of Cramer's rule, h = d_a (n_b x n_c) + d_b (n_c x n_a) + d_c (n_a x n_b) and w = n_a .
 * (n_b x n_c), as 128-bit integers divided by their greatest common divisor; a line has Pluecker's six numbers. In
 * reduced form, with a fixed sign, equal things have equal numbers. They are stored once, in hash tables, so
 * equality is a comparison of indices.
 *
 * Predicates are filtered: the result in doubles decides if it exceeds its error bound, integers otherwise. Bounds
 * on the coefficients (exact.h) keep every sum within 127 bits; where two such numbers must be compared as products,
 * they are multiplied to 256 bits. Most calls end in the filter.
 *
 *   exact_side     sign of n . p - d
 *   exact_compare  order of two points along an axis
 *   exact_turn     sign of (a x b) . n
 *   exact_before   order of directions around n, by quadrant, then by turn
 *
 * The greatest common divisor is the binary one: shifts and subtractions instead of 128-bit divisions. */
#include "stages/build_model/solid/exact.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

__extension__ typedef unsigned __int128 uwide;

/* error bound of differences of rounded coordinates: these are below 2^31, with an error of a few 2^-53 of that */
#define ERROR_BOUND (1.0 / (1 << 18))

void exact_release(struct exact_space *s)
{
    if (!s) return;
    free(s->planes);
    free(s->points);
    free(s->lines);
    free(s->plane_table.slots);
    free(s->point_table.slots);
    free(s->line_table.slots);
    *s = (struct exact_space){0};
}

enum status exact_grow(void *items, int *capacity, int need, size_t size, struct err *err)
{
    void *old;
    if (need <= *capacity) return ST_OK;
    const size_t more = (size_t)need + (size_t)need / 2 + 16;
    if (more > INT32_MAX) return err_nomem(err, "the union of solids", more * size);
    memcpy(&old, items, sizeof old);
    void *grown = realloc(old, more * size);
    if (!grown) return err_nomem(err, "the union of solids", more * size);
    memcpy(items, &grown, sizeof grown);
    *capacity = (int)more;
    return ST_OK;
}

/* ---------------------------------------------------------------------------------------------------------- tables */

static uint64_t mix(uint64_t hash, uint64_t x)
{
    hash ^= x;
    hash *= 0x9e3779b97f4a7c15u;
    return hash ^ (hash >> 29);
}

static uint64_t mix_wide(uint64_t hash, wide x) { return mix(mix(hash, (uint64_t)x), (uint64_t)((uwide)x >> 64)); }

static uint64_t hash_plane(const struct exact_plane *p)
{
    return mix(mix(mix(mix(1, (uint64_t)p->n[0]), (uint64_t)p->n[1]), (uint64_t)p->n[2]), (uint64_t)p->d);
}

static uint64_t hash_point(const struct exact_point *p)
{
    return mix_wide(mix_wide(mix_wide(mix_wide(2, p->h[0]), p->h[1]), p->h[2]), p->h[3]);
}

static uint64_t hash_line(const struct exact_line *l)
{
    const uint64_t d = mix(mix(mix(3, (uint64_t)l->d[0]), (uint64_t)l->d[1]), (uint64_t)l->d[2]);
    return mix_wide(mix_wide(mix_wide(d, l->m[0]), l->m[1]), l->m[2]);
}

static bool same_plane(const struct exact_plane *a, const struct exact_plane *b)
{
    return a->d == b->d && !memcmp(a->n, b->n, sizeof a->n);
}

static bool same_point(const struct exact_point *a, const struct exact_point *b)
{
    return !memcmp(a->h, b->h, sizeof a->h);
}

static bool same_line(const struct exact_line *a, const struct exact_line *b)
{
    return !memcmp(a->d, b->d, sizeof a->d) && !memcmp(a->m, b->m, sizeof a->m);
}

/* Doubles the number of slots and enters every item again. */
#define REHASH(table, items, count, hash_of, err)                                                  \
    do {                                                                                           \
        if ((table)->size >= 2 * ((count) + 1)) break;                                             \
        const int size_ = (table)->size ? 2 * (table)->size : 64;                                  \
        int *slots_ = malloc((size_t)size_ * sizeof *slots_);                                      \
        if (!slots_) return err_nomem(err, "the union of solids", (size_t)size_ * sizeof *slots_); \
        for (int i_ = 0; i_ < size_; i_++) slots_[i_] = -1;                                        \
        for (int i_ = 0; i_ < (count); i_++) {                                                     \
            unsigned at_ = (unsigned)hash_of(&(items)[i_]) & (unsigned)(size_ - 1);                \
            while (slots_[at_] >= 0) at_ = (at_ + 1) & (unsigned)(size_ - 1);                      \
            slots_[at_] = i_;                                                                      \
        }                                                                                          \
        free((table)->slots);                                                                      \
        (table)->slots = slots_;                                                                   \
        (table)->size = size_;                                                                     \
    } while (0)

/* Sets *index to the equal item, or adds the item. */
#define ADD(kind, s, item, index, err)                                                                            \
    do {                                                                                                          \
        REHASH(&(s)->kind##_table, (s)->kind##s, (s)->kind##_count, hash_##kind, err);                            \
        const unsigned mask_ = (unsigned)(s)->kind##_table.size - 1;                                              \
        unsigned slot_ = (unsigned)hash_##kind(&(item)) & mask_;                                                  \
        for (int at_; (at_ = (s)->kind##_table.slots[slot_]) >= 0; slot_ = (slot_ + 1) & mask_)                   \
            if (same_##kind(&(s)->kind##s[at_], &(item))) {                                                       \
                *(index) = at_;                                                                                   \
                return ST_OK;                                                                                     \
            }                                                                                                     \
        if (exact_grow(&(s)->kind##s, &(s)->kind##_capacity, (s)->kind##_count + 1, sizeof *(s)->kind##s, (err))) \
            return ST_NOMEM;                                                                                      \
        (s)->kind##s[(s)->kind##_count] = (item);                                                                 \
        (s)->kind##_table.slots[slot_] = (s)->kind##_count;                                                       \
        *(index) = (s)->kind##_count++;                                                                           \
    } while (0)

/* -------------------------------------------------------------------------------------------------------- integers */

static uwide magnitude(wide x) { return x < 0 ? -(uwide)x : (uwide)x; }

static int zeros(uwide x) { return (uint64_t)x ? __builtin_ctzll((uint64_t)x) : 64 + __builtin_ctzll(x >> 64); }

/* Greatest common divisor; that of 0 and b is b. */
static uwide divisor(uwide a, uwide b)
{
    if (!a || !b) return a | b;
    const int shift = zeros(a | b);
    a >>= zeros(a);
    while (b) {
        b >>= zeros(b);
        if (a > b) {
            const uwide t = a;
            a = b;
            b = t;
        }
        b -= a;
    }
    return a << shift;
}

static void product(uwide a, uwide b, uwide *high, uwide *low)
{
    const uint64_t a1 = (uint64_t)(a >> 64), a0 = (uint64_t)a, b1 = (uint64_t)(b >> 64), b0 = (uint64_t)b;
    const uwide l = (uwide)a0 * b0, m = (uwide)a1 * b0, n = (uwide)a0 * b1;
    const uwide middle = (l >> 64) + (uint64_t)m + (uint64_t)n;
    *low = (middle << 64) | (uint64_t)l;
    *high = (uwide)a1 * b1 + (m >> 64) + (n >> 64) + (middle >> 64);
}

/* Sign of a * b - c * d; b and d are positive. */
static int compare_products(wide a, wide b, wide c, wide d)
{
    if ((a < 0) != (c < 0)) return a < 0 ? -1 : 1;
    uwide h0, l0, h1, l1;
    product(magnitude(a), (uwide)b, &h0, &l0);
    product(magnitude(c), (uwide)d, &h1, &l1);
    const int s = h0 != h1 ? (h0 > h1 ? 1 : -1) : (l0 > l1) - (l0 < l1);
    return a < 0 ? -s : s;
}

static void cross(const int64_t a[3], const int64_t b[3], int64_t c[3])
{
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

static int sign(wide x) { return (x > 0) - (x < 0); }

/* ------------------------------------------------------------------------------------------ planes, points, lines */

enum status exact_plane_add(struct exact_space *s, const int64_t n[3], int64_t d, int *plane, int *side,
                            struct err *err)
{
    struct exact_plane p = {.axis = -1};
    *side = n[0] ? (n[0] > 0 ? 1 : -1) : n[1] ? (n[1] > 0 ? 1 : -1) : n[2] > 0 ? 1 : -1;
    p.d = d * *side;
    for (int i = 0; i < 3; i++) {
        p.n[i] = n[i] * *side;
        if (!n[(i + 1) % 3] && !n[(i + 2) % 3]) p.axis = i;
    }
    ADD(plane, s, p, plane, err);
    return ST_OK;
}

enum status exact_meet(struct exact_space *s, int plane0, int plane1, int plane2, int *point, struct err *err)
{
    const struct exact_plane *a = &s->planes[plane0], *b = &s->planes[plane1], *c = &s->planes[plane2];
    struct exact_point p;
    memset(&p, 0, sizeof p);
    *point = -1;
    if (a->axis >= 0 && b->axis >= 0 && c->axis >= 0) {
        if (a->axis == b->axis || b->axis == c->axis || a->axis == c->axis) return ST_OK;
        p.h[a->axis] = a->d;
        p.h[b->axis] = b->d;
        p.h[c->axis] = c->d;
        p.h[3] = 1;
    } else {
        int64_t bc[3], ca[3], ab[3];
        cross(b->n, c->n, bc);
        cross(c->n, a->n, ca);
        cross(a->n, b->n, ab);
        wide w = 0;
        for (int i = 0; i < 3; i++) {
            w += (wide)a->n[i] * bc[i];
            p.h[i] = (wide)a->d * bc[i] + (wide)b->d * ca[i] + (wide)c->d * ab[i];
        }
        if (!w) return ST_OK;
        p.h[3] = w;
        uwide g = magnitude(w);
        for (int i = 0; i < 3 && g > 1; i++) g = divisor(g, magnitude(p.h[i]));
        const wide by = w < 0 ? -(wide)g : (wide)g;
        if (by != 1)
            for (int i = 0; i < 4; i++) p.h[i] /= by;
    }
    for (int i = 0; i < 3; i++) p.p[i] = (double)p.h[i] / (double)p.h[3];
    ADD(point, s, p, point, err);
    return ST_OK;
}

enum status exact_line_add(struct exact_space *s, int plane0, int plane1, int *line, struct err *err)
{
    const struct exact_plane *a = &s->planes[plane0], *b = &s->planes[plane1];
    struct exact_line l;
    memset(&l, 0, sizeof l);
    l.plane[0] = plane0;
    l.plane[1] = plane1;
    cross(a->n, b->n, l.d);
    uwide g = 0;
    for (int i = 0; i < 3; i++) {
        l.m[i] = (wide)a->n[i] * b->d - (wide)b->n[i] * a->d;
        g = divisor(g, magnitude(l.d[i]));
    }
    assert(g);
    for (int i = 0; i < 3 && g > 1; i++) g = divisor(g, magnitude(l.m[i]));
    const int64_t first = l.d[0] ? l.d[0] : l.d[1] ? l.d[1] : l.d[2];
    const wide by = first < 0 ? -(wide)g : (wide)g;
    for (int i = 0; i < 3; i++) {
        l.d[i] = (int64_t)(l.d[i] / by);
        l.m[i] /= by;
    }
    for (int i = 1; i < 3; i++)
        if (llabs(l.d[i]) > llabs(l.d[l.axis])) l.axis = i;
    ADD(line, s, l, line, err);
    return ST_OK;
}

bool exact_parallel(const struct exact_space *s, int plane0, int plane1)
{
    return !memcmp(s->planes[plane0].n, s->planes[plane1].n, sizeof s->planes[plane0].n);
}

int exact_side(const struct exact_space *s, int point, int plane)
{
    const struct exact_point *p = &s->points[point];
    const struct exact_plane *q = &s->planes[plane];
    double v = -(double)q->d, size = fabs(v);
    if (q->axis >= 0) {
        v += p->p[q->axis];
        if (fabs(v) > ERROR_BOUND) return v > 0 ? 1 : -1;
        return sign(p->h[q->axis] - (wide)q->d * p->h[3]);
    }
    wide exact = -(wide)q->d * p->h[3];
    for (int i = 0; i < 3; i++) {
        const double t = (double)q->n[i] * p->p[i];
        v += t;
        size += fabs(t);
    }
    if (fabs(v) > size * 0x1p-48) return v > 0 ? 1 : -1;
    for (int i = 0; i < 3; i++) exact += q->n[i] * p->h[i];
    return sign(exact);
}

int exact_compare(const struct exact_space *s, int a, int b, int axis)
{
    if (a == b) return 0;
    const struct exact_point *p = &s->points[a], *q = &s->points[b];
    const double v = p->p[axis] - q->p[axis];
    if (fabs(v) > ERROR_BOUND) return v > 0 ? 1 : -1;
    if (p->h[3] == 1 && q->h[3] == 1) return sign(p->h[axis] - q->h[axis]);
    return compare_products(p->h[axis], q->h[3], q->h[axis], p->h[3]);
}

int exact_turn(const int64_t a[3], const int64_t b[3], const int64_t n[3])
{
    wide s = 0;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        s += n[i] * ((wide)a[j] * b[k] - (wide)a[k] * b[j]);
    }
    return sign(s);
}

static int dot_sign(const int64_t a[3], const int64_t b[3])
{
    return sign((wide)a[0] * b[0] + (wide)a[1] * b[1] + (wide)a[2] * b[2]);
}

/* Angle from r to a about n: 0 if equal, 1 below half a turn, 2 half a turn, 3 above. */
static int quarter(const int64_t r[3], const int64_t a[3], const int64_t n[3])
{
    const int t = exact_turn(r, a, n);
    return t > 0 ? 1 : t < 0 ? 3 : dot_sign(r, a) > 0 ? 0 : 2;
}

bool exact_before(const int64_t r[3], const int64_t a[3], const int64_t b[3], const int64_t n[3])
{
    const int qa = quarter(r, a, n), qb = quarter(r, b, n);
    if (qa != qb) return qa < qb;
    return (qa & 1) && exact_turn(a, b, n) > 0;
}
