/* hole_fill.c - see hole_fill.h. */
#include "common/layers/hole_fill.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"

#define RADIUS     3 /* 7x7 */
#define LIST_CHUNK 1024
#define MAX_LEVELS 32

struct color_z {
    float rgb[3], z; /* z 0: unknown */
};

struct far_side {
    const struct soft_z *soft;
    float sigma;
};

/* Weighted mean that prefers the far ones; weights as given, 0 leaves one out. False if there is nothing. */
static bool far_mean(const struct far_side *far, const struct color_z *items, const float *weights, int count,
                     struct color_z *mean)
{
    float z_far = 0, sum = 0;
    for (int i = 0; i < count; i++)
        if (weights[i] > 0 && items[i].z > z_far) z_far = items[i].z;
    if (!(z_far > 0)) return false;

    const float rho = soft_z_rho(far->soft, z_far, far->sigma, z_far, far->sigma);
    struct color_z m = {0};
    for (int i = 0; i < count; i++) {
        if (!(weights[i] > 0) || !(items[i].z > 0)) continue;
        const float w = weights[i] * soft_z_weight(z_far - items[i].z, 0.1f * rho, rho);
        for (int k = 0; k < 3; k++) m.rgb[k] += w * items[i].rgb[k];
        m.z += w * items[i].z;
        sum += w;
    }
    for (int k = 0; k < 3; k++) mean->rgb[k] = m.rgb[k] / sum;
    mean->z = m.z / sum;
    return true;
}

static struct color_z pixel_get(const struct rendered_frame *f, size_t p)
{
    const float *c = f->rgba + 4 * p;
    return (struct color_z){{c[0], c[1], c[2]}, f->z[p]};
}

static void pixel_set(struct rendered_frame *f, size_t p, const struct color_z *v)
{
    float *c = f->rgba + 4 * p;
    memcpy(c, v->rgb, sizeof v->rgb);
    c[3] = 1;
    f->z[p] = v->z;
}

/* ---------------------------------------------------------------------------------------------- narrow holes */

struct mask { /* bytes, a flag a pixel */
    const struct rendered_frame *frame;
    uint8_t *flags, *spare; /* w * h */
    uint32_t *counts;       /* a row: flags of empty pixels */
    int diameter;
};

static void mask_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct mask *m = ctx;
    const size_t w = (size_t)m->frame->width;
    (void)thread;
    for (size_t y = begin; y < end; y++) {
        m->counts[y] = 0;
        for (size_t p = y * w; p < (y + 1) * w; p++) {
            m->flags[p] = !(m->frame->rgba[4 * p + 3] > 0);
            m->counts[y] += m->flags[p];
        }
    }
}

/* to[x] of `count` bytes: whether all of from[x .. x + length) are set. */
static void runs_of(uint8_t *to, const uint8_t *from, size_t count, size_t length)
{
    memcpy(to, from, count);
    for (size_t k = 1; k < length; k++)
        for (size_t x = 0; x < count; x++) to[x] &= from[x + k];
}

/* Leaves those flags alone that a diameter x diameter square of flags holds: an opening, by rows and columns. A row
 * without flags is passed over. */
static void keep_wide(struct mask *m)
{
    const size_t w = (size_t)m->frame->width, h = (size_t)m->frame->height, d = (size_t)m->diameter;

    memset(m->spare, 0, w * h);
    if (w < d || h < d) {
        memset(m->flags, 0, w * h);
        return;
    }
    for (size_t y = 0; y < h; y++) /* spare: where a run of d begins */
        if (m->counts[y] >= d) runs_of(m->spare + y * w, m->flags + y * w, w - d + 1, d);
    for (size_t y = 0; y + d <= h; y++) /* and d rows have one: where a square begins */
        for (size_t k = 1; m->counts[y] && k < d; k++)
            for (size_t x = 0; x < w; x++) m->spare[y * w + x] &= m->spare[(y + k) * w + x];
    for (size_t y = h - d + 1; y < h; y++) memset(m->spare + y * w, 0, w);
    for (size_t y = 0; y < h; y++) { /* the squares' first rows, in full width */
        if (!m->counts[y]) continue;
        uint8_t *row = m->spare + y * w;
        for (size_t x = w; x-- > 0;) { /* from the right: what begins at x - k covers x */
            uint8_t any = 0;
            for (size_t k = 0; k < d && k <= x; k++) any |= row[x - k];
            row[x] = any;
        }
    }
    for (size_t y = 0; y < h; y++) {
        memset(m->flags + y * w, 0, m->counts[y] ? w : 0);
        for (size_t k = 0; m->counts[y] && k < d && k <= y; k++)
            for (size_t x = 0; x < w; x++) m->flags[y * w + x] |= m->spare[(y - k) * w + x];
    }
}

enum status hole_narrow_pixels(uint32_t **list, size_t *count, size_t *empty, const struct rendered_frame *f,
                               int diameter, struct err *err)
{
    const size_t w = (size_t)f->width, h = (size_t)f->height;
    struct mask m = {f, malloc(w * h), malloc(w * h), malloc((h + 1) * sizeof *m.counts), diameter};
    size_t n = 0;
    enum status st = ST_OK;

    *count = *empty = 0;
    *list = NULL;
    if (!m.flags || !m.spare || !m.counts) {
        st = err_nomem(err, "the narrow holes of a frame", 2 * w * h);
        goto done;
    }
    parallel_for(h, 64, mask_rows, &m);
    for (size_t y = 0; y < h; y++) *empty += m.counts[y];
    *list = malloc((*empty + 1) * sizeof **list);
    if (!*list) {
        st = err_nomem(err, "the narrow holes of a frame", *empty * sizeof **list);
        goto done;
    }
    if (*empty) keep_wide(&m);
    for (int wide = 0; wide < 2; wide++) {
        for (size_t y = 0; y < h; y++)
            for (size_t p = y * w; m.counts[y] && p < (y + 1) * w; p++)
                if (m.flags[p] == wide && !(f->rgba[4 * p + 3] > 0)) (*list)[n++] = (uint32_t)p;
        if (!wide) *count = n;
    }
done:
    free(m.flags);
    free(m.spare);
    free(m.counts);
    return st;
}

struct narrow_pass {
    const struct rendered_frame *frame;
    const struct far_side *far;
    const uint32_t *list;
    struct color_z *filled; /* parallel to the list */
};

static void narrow_chunk(void *ctx, size_t begin, size_t end, int thread)
{
    const struct narrow_pass *n = ctx;
    const struct rendered_frame *f = n->frame;
    (void)thread;

    for (size_t i = begin; i < end; i++) {
        const int x = (int)(n->list[i] % (uint32_t)f->width), y = (int)(n->list[i] / (uint32_t)f->width);
        struct color_z items[(2 * RADIUS + 1) * (2 * RADIUS + 1)];
        float weights[(2 * RADIUS + 1) * (2 * RADIUS + 1)];
        int count = 0;
        for (int v = y - RADIUS; v <= y + RADIUS; v++)
            for (int u = x - RADIUS; u <= x + RADIUS; u++) {
                if (u < 0 || v < 0 || u >= f->width || v >= f->height) continue;
                const size_t p = (size_t)v * (size_t)f->width + (size_t)u;
                weights[count] = f->rgba[4 * p + 3];
                items[count++] = pixel_get(f, p);
            }
        n->filled[i] = (struct color_z){0};
        far_mean(n->far, items, weights, count, &n->filled[i]);
    }
}

enum status hole_fill_pixels(struct rendered_frame *f, const uint32_t *list, size_t count, const struct soft_z *soft,
                             float sigma, int diameter, struct err *err)
{
    const struct far_side far = {soft, sigma};
    struct color_z *filled = malloc((count + 1) * sizeof *filled);

    if (!filled) return err_nomem(err, "the narrow holes of a frame", count * sizeof *filled);
    /* each pass reads the one before only, so the far side crosses RADIUS pixels a pass, whatever the order */
    for (int reached = 0; count && reached < diameter; reached += RADIUS) {
        struct narrow_pass pass = {f, &far, list, filled};
        parallel_for(count, LIST_CHUNK, narrow_chunk, &pass);
        for (size_t i = 0; i < count; i++)
            if (filled[i].z > 0) pixel_set(f, list[i], &filled[i]);
    }
    free(filled);
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------ wide holes */

/* What is asked of a level's texel is computed when it is asked for first: what is far from holes never is. */
enum known { NOT_ASKED, PULLED, EMPTY, PUSHED };

struct level {
    int w, h;
    struct color_z *texels;
    uint8_t *known;
};

struct pyramid {
    const struct rendered_frame *frame;
    struct level levels[MAX_LEVELS]; /* 0 is the frame: of it only what is PUSHED stands here */
    int count;
    const struct far_side *far;
};

/* The far side of a texel's 2x2; false if none of them is known. */
static bool pull(struct pyramid *p, int level, int x, int y, struct color_z *value)
{
    struct level *l = &p->levels[level];
    const size_t at = (size_t)y * (size_t)l->w + (size_t)x;

    if (level == 0) {
        *value = pixel_get(p->frame, at);
        return p->frame->rgba[4 * at + 3] > 0 && value->z > 0;
    }
    if (l->known[at] == NOT_ASKED) {
        struct color_z items[4];
        float weights[4] = {0};
        for (int k = 0; k < 4; k++) {
            const int u = 2 * x + (k & 1), v = 2 * y + (k >> 1);
            if (u < l[-1].w && v < l[-1].h && pull(p, level - 1, u, v, &items[k])) weights[k] = items[k].z > 0;
        }
        l->known[at] = far_mean(p->far, items, weights, 4, &l->texels[at]) ? PULLED : EMPTY;
    }
    if (l->known[at] != PULLED) return false;
    *value = l->texels[at];
    return true;
}

/* The same, and where none is known from the level above: bilinear, the parent has 3/4 of each axis. */
static bool push(struct pyramid *p, int level, int x, int y, struct color_z *value)
{
    struct level *l = &p->levels[level];
    const size_t at = (size_t)y * (size_t)l->w + (size_t)x;

    if (pull(p, level, x, y, value)) return true;
    if (l->known[at] != PUSHED && level + 1 < p->count) {
        struct color_z items[4];
        float weights[4] = {0};
        for (int k = 0; k < 4; k++) {
            const int u = x / 2 + ((k & 1) ? (x & 1 ? 1 : -1) : 0), v = y / 2 + ((k >> 1) ? (y & 1 ? 1 : -1) : 0);
            if (u < 0 || v < 0 || u >= l[1].w || v >= l[1].h || !push(p, level + 1, u, v, &items[k])) continue;
            weights[k] = ((k & 1) ? 0.25f : 0.75f) * ((k >> 1) ? 0.25f : 0.75f);
        }
        if (far_mean(p->far, items, weights, 4, &l->texels[at])) l->known[at] = PUSHED;
    }
    if (l->known[at] != PUSHED) return false;
    *value = l->texels[at];
    return true;
}

/* The pixels of the list; how many of them got a colour. */
static enum status fill_wide(struct rendered_frame *f, const uint32_t *list, size_t count, const struct far_side *far,
                             size_t *filled, struct err *err)
{
    const uint32_t w = (uint32_t)f->width;
    struct pyramid p = {.frame = f, .levels = {{.w = f->width, .h = f->height}}, .count = 1, .far = far};
    struct color_z value;
    enum status st = ST_OK;

    for (; p.levels[p.count - 1].w > 1 || p.levels[p.count - 1].h > 1; p.count++) {
        const struct level *l = &p.levels[p.count - 1];
        p.levels[p.count] = (struct level){.w = (l->w + 1) / 2, .h = (l->h + 1) / 2};
    }
    for (int i = 0; i < p.count; i++) {
        struct level *l = &p.levels[i];
        const size_t size = (size_t)l->w * (size_t)l->h;
        l->texels = malloc(size * sizeof *l->texels);
        l->known = calloc(size, 1);
        if (!l->texels || !l->known) {
            st = err_nomem(err, "a pyramid of a frame", size * sizeof *l->texels);
            goto done;
        }
    }
    *filled = 0;
    if (!pull(&p, p.count - 1, 0, 0, &value))
        goto done; /* nothing is known: whatever is asked for would be asked in vain */
    for (size_t i = 0; i < count; i++) push(&p, 0, (int)(list[i] % w), (int)(list[i] / w), &value);
    for (size_t i = 0; i < count; i++) /* all are computed from the frame as it was */
        if (p.levels[0].known[list[i]] == PUSHED) {
            pixel_set(f, list[i], &p.levels[0].texels[list[i]]);
            ++*filled;
        }
done:
    for (int i = 0; i < p.count; i++) {
        free(p.levels[i].texels);
        free(p.levels[i].known);
    }
    return st;
}

enum status hole_fill(struct rendered_frame *frame, const struct soft_z *soft, float sigma, int diameter,
                      struct err *err)
{
    const struct far_side far = {soft, sigma};
    uint32_t *list = NULL;
    size_t narrow = 0, empty = 0, filled = 0;
    enum status st = hole_narrow_pixels(&list, &narrow, &empty, frame, diameter > 0 ? diameter : 1, err);

    if (!st && diameter > 0) {
        st = hole_fill_pixels(frame, list, narrow, soft, sigma, diameter, err);
        for (size_t i = 0; !st && i < narrow; i++) filled += frame->rgba[4 * (size_t)list[i] + 3] > 0;
    }
    if (!st && diameter > 0 && filled < empty) {
        size_t wide = 0, left = narrow; /* narrow ones that found nothing near are left to the pyramid, too */
        for (size_t i = narrow; i-- > 0;)
            if (!(frame->rgba[4 * (size_t)list[i] + 3] > 0)) list[--left] = list[i];
        st = fill_wide(frame, list + left, empty - left, &far, &wide, err);
        filled += wide;
    }
    frame->unfilled_fraction = (double)(empty - filled) / ((double)frame->width * (double)frame->height);
    free(list);
    return st;
}
