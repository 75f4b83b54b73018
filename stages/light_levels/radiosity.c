/* radiosity.c - see radiosity.h.
 *
 * Mathematics. The irradiance of patch i from a group is E_i = D_i + pi sum_j F_ij B_j with D what arrives directly and
 * F the form factors; its radiance is B_i = R_i + rho_i / pi E_i, where R is not 0 in the group `rest` alone. The sums
 * are linear in D and R, so each group and channel is a system of its own with one matrix. Gauss-Seidel rounds use the
 * newest values; since the rows of F sum to 1 at most and rho is below 1, they converge, the slower the whiter the
 * room.
 *
 * Groups are solved in blocks of BLOCK columns. A block's radiance stays in the cache, the inner loop is a vector of
 * BLOCK floats, and blocks are independent, so that bits do not depend on threads. Groups without light cost nothing.
 *
 * Source: the radiosity system of [Cohen 1985]. Different here: form factors are counted rays, and all groups are
 * columns of one solve. */
#include "stages/light_levels/radiosity.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/math/numbers.h"

enum { GROUPS = 16, BLOCK = 3 * GROUPS, MOST_ROUNDS = 1000 };

struct solve {
    const struct light_rows *rows;
    const struct patch_colour *colours;
    float *radiance;
    int rest;
    double tolerance;
    int *rounds;        /* of each block */
    struct err *errors; /* of each block */
};

/* The columns of a block. */
struct block {
    int first, count; /* groups */
    float *values;    /* BLOCK for each patch */
};

/* Whether the block has light anywhere. */
static bool start_block(const struct solve *s, const struct block *b)
{
    const struct light_rows *r = s->rows;
    const size_t stride = 3 * (size_t)r->groups;
    const bool has_rest = s->rest >= b->first && s->rest < b->first + b->count;
    bool any = false;
    for (int i = 0; i < r->count; i++) {
        const float *d = r->direct + stride * (size_t)i + 3 * (size_t)b->first;
        for (int c = 0; c < 3 * b->count; c++) any |= d[c] > 0;
        if (!has_rest) continue;
        float *v = b->values + (size_t)i * BLOCK + 3 * (s->rest - b->first);
        v[0] = (float)s->colours[i].rest.r;
        v[1] = (float)s->colours[i].rest.g;
        v[2] = (float)s->colours[i].rest.b;
        any |= v[0] > 0 || v[1] > 0 || v[2] > 0;
    }
    return any;
}

static void set_fixed(float fixed[BLOCK], float factor[BLOCK], const struct solve *s, const struct block *b, int patch)
{
    const struct patch_colour *k = &s->colours[patch];
    const float rho[3] = {(float)(k->reflectance.r / PI), (float)(k->reflectance.g / PI),
                          (float)(k->reflectance.b / PI)};
    const float rest[3] = {(float)k->rest.r, (float)k->rest.g, (float)k->rest.b};
    const float *d = s->rows->direct + 3 * ((size_t)s->rows->groups * (size_t)patch + (size_t)b->first);
    for (int c = 0; c < BLOCK; c++) {
        const bool is_rest = b->first + c / 3 == s->rest;
        factor[c] = c < 3 * b->count ? rho[c % 3] : 0;
        fixed[c] = c < 3 * b->count ? factor[c] * d[c] + (is_rest ? rest[c % 3] : 0) : 0;
    }
}

/* One round; change[c] becomes the largest change, most[c] the largest value. */
static void run_round(float change[BLOCK], float most[BLOCK], const struct solve *s, const struct block *b)
{
    float fixed[BLOCK], factor[BLOCK], sum[BLOCK];
    memset(change, 0, BLOCK * sizeof *change);
    memset(most, 0, BLOCK * sizeof *most);
    for (int i = 0; i < s->rows->count; i++) {
        const struct light_row *row = &s->rows->rows[i];
        float *own = b->values + (size_t)i * BLOCK;
        memset(sum, 0, sizeof sum);
        for (int e = 0; e < row->count; e++) {
            const float *from = b->values + (size_t)row->entries[e].patch * BLOCK, w = row->entries[e].share;
            for (int c = 0; c < BLOCK; c++) sum[c] += w * from[c];
        }
        set_fixed(fixed, factor, s, b, i);
        for (int c = 0; c < BLOCK; c++) {
            const float now = fixed[c] + (float)PI * factor[c] * sum[c], d = fabsf(now - own[c]);
            own[c] = now;
            change[c] = d > change[c] ? d : change[c];
            most[c] = now > most[c] ? now : most[c];
        }
    }
}

static bool is_settled(const float change[BLOCK], const float most[BLOCK], double tolerance)
{
    for (int c = 0; c < BLOCK; c++)
        if ((double)change[c] > tolerance * (double)most[c]) return false;
    return true;
}

static void solve_block(struct solve *s, int k)
{
    float change[BLOCK], most[BLOCK];
    const int patches = s->rows->count, left = s->rows->groups - GROUPS * k;
    struct block b = {GROUPS * k, left < GROUPS ? left : GROUPS, calloc((size_t)patches * BLOCK + 1, sizeof(float))};
    if (!b.values) {
        err_nomem(&s->errors[k], "radiance of patches", (size_t)patches * BLOCK * sizeof(float));
        return;
    }
    if (start_block(s, &b)) {
        do run_round(change, most, s, &b);
        while (++s->rounds[k] < MOST_ROUNDS && !is_settled(change, most, s->tolerance));
        for (int i = 0; i < patches; i++)
            memcpy(s->radiance + 3 * ((size_t)s->rows->groups * (size_t)i + (size_t)b.first),
                   b.values + (size_t)i * BLOCK, 3 * (size_t)b.count * sizeof(float));
    }
    free(b.values);
}

static void solve_some(void *ctx, size_t begin, size_t end, int thread)
{
    (void)thread;
    for (size_t i = begin; i < end; i++) solve_block(ctx, (int)i);
}

enum status radiosity_solve(struct radiosity *r, const struct light_rows *rows, const struct patch_colour *colours,
                            int rest, double tolerance, struct err *err)
{
    const size_t blocks = ((size_t)rows->groups + GROUPS - 1) / GROUPS,
                 values = 3 * (size_t)rows->groups * (size_t)rows->count;
    *r = (struct radiosity){calloc(values + 1, sizeof *r->radiance), 0};
    struct solve s = {rows,
                      colours,
                      r->radiance,
                      rest,
                      tolerance,
                      calloc(blocks + 1, sizeof *s.rounds),
                      calloc(blocks + 1, sizeof *s.errors)};
    if (!r->radiance || !s.rounds || !s.errors) err_nomem(err, "radiance of patches", values * sizeof *r->radiance);
    if (!err->status) parallel_for(blocks, 1, solve_some, &s);
    for (size_t k = 0; s.rounds && s.errors && k < blocks; k++) {
        if (!err->status && s.errors[k].status) *err = s.errors[k];
        if (s.rounds[k] > r->rounds) r->rounds = s.rounds[k];
    }
    free(s.rounds);
    free(s.errors);
    return err->status;
}

void radiosity_release(struct radiosity *r)
{
    free(r->radiance);
    *r = (struct radiosity){0};
}

void radiosity_gather(float *to, const struct light_rows *at, int row, const struct radiosity *r)
{
    const size_t columns = 3 * (size_t)at->groups;
    const struct light_row *from = &at->rows[row];
    memcpy(to, at->direct + columns * (size_t)row, columns * sizeof *to);
    for (int e = 0; e < from->count; e++) {
        const float *radiance = r->radiance + columns * (size_t)from->entries[e].patch;
        const float w = (float)PI * from->entries[e].share;
        for (size_t c = 0; c < columns; c++) to[c] += w * radiance[c];
    }
}
