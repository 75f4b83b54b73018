/* hole_fill.c - hole filling from the far side, and beyond the photos from all sides.
 *
 * A hole opens where parallax separates a near surface from a farther one, so the farther one belongs there
 * [Colburn 2014, 3.6.1]. Every mean below is therefore weighted by a reversed soft z-buffer: of the known items in a
 * neighbourhood, the farthest has weight 1 and the others soft_z_weight(z_far - z).
 *
 * A hole also opens where the frame overhangs the photos. Nothing is hidden there, so a near surface that the rim cuts
 * goes on as a far one does. A pixel is beyond every photo if the point on its ray at the depth of the nearest known
 * pixel is inside the picture of no view: had that surface ended at the rim, some photo would have to show it, and none
 * does. If it is inside a picture, the view shows something else there, so the surface ends and a farther one begins.
 * An 8-connected hole is an overhang if most of its pixels are beyond every photo; its means prefer no side. To touch
 * the frame's edge is not enough: disocclusions run to the edge, too. The nearest known pixel is found breadth first
 * from the rim, in picture order.
 *
 * Narrow holes are those in which no diameter x diameter square of hole pixels contains the pixel: what a morphological
 * opening of the hole mask removes. Such a pixel gets the weighted mean of the known pixels in its 7x7 neighbourhood.
 * Passes are repeated on their own results until the far side has crossed the hole.
 *
 * Wide holes are filled by a pull-push pyramid [Gortler 1996]. Pull: a texel is the weighted mean of its known children
 * (2x2). Push: an unknown texel is interpolated from the four nearest texels of the next coarser level, bilinearly and
 * with the same preference for the far side. Texels are computed on demand, so the cost depends on the holes, not on
 * the frame.
 *
 * The thesis fills holes narrower than 6 px in one pass and leaves wider ones to the offline renderer; the repeated
 * passes, the opening, the pyramid and overhangs are additions. Picture borders need no special case. */
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

struct far_side { /* the reversed soft z-buffer */
    const struct soft_z *soft;
    float sigma; /* relative uncertainty of all depths */
    bool all;    /* of an overhang: no side is preferred */
};

/* Mean of the items by weights[i] times the reversed soft z weight. Weight 0 leaves an item out. False: no known
 * item. */
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
        const float w = far->all ? weights[i] : weights[i] * soft_z_weight(z_far - items[i].z, 0.1f * rho, rho);
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

/* ------------------------------------------------------------------------------------------------- overhangs */

struct overhang_job {
    const struct rendered_frame *frame;
    const struct hole_photos *photos;
    const uint32_t *list;    /* hole pixels */
    const uint32_t *nearest; /* known pixel nearest to each pixel of a hole */
    uint8_t *beyond;         /* w * h */
};

static void find_beyond(void *ctx, size_t begin, size_t end, int thread)
{
    const struct overhang_job *j = ctx;
    const struct view *camera = j->photos->camera;
    const uint32_t w = (uint32_t)j->frame->width;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        const uint32_t p = j->list[i];
        const float z = j->frame->z[j->nearest[p]];
        const struct vec3 point = view_unproject(camera, p % w + 0.5, p / w + 0.5, z);
        bool seen = !(z > 0);
        for (int k = 0; k < j->photos->count && !seen; k++) {
            const struct view *v = &j->photos->views[k];
            double x, y;
            seen = view_project(v, point, &x, &y) > 0 && x >= 0 && y >= 0 && x < v->width && y < v->height;
        }
        j->beyond[p] = !seen;
    }
}

#define NO_PIXEL UINT32_MAX

/* The pixels around p, sides first. Returns their number. */
static int neighbors(const struct rendered_frame *f, uint32_t p, uint32_t around[8])
{
    static const int dx[8] = {0, -1, 1, 0, -1, 1, -1, 1}, dy[8] = {-1, 0, 0, 1, -1, -1, 1, 1};
    const int x = (int)(p % (uint32_t)f->width), y = (int)(p / (uint32_t)f->width);
    int count = 0;
    for (int k = 0; k < 8; k++) {
        const int u = x + dx[k], v = y + dy[k];
        if (u < 0 || v < 0 || u >= f->width || v >= f->height) continue;
        around[count++] = (uint32_t)v * (uint32_t)f->width + (uint32_t)u;
    }
    return count;
}

/* Lists the hole pixels by their distance from the rim, and finds the known pixel nearest to each. Returns their
 * number: 0 if the whole frame is a hole. */
static size_t find_nearest(uint32_t *nearest, uint32_t *list, const struct rendered_frame *f)
{
    const uint32_t pixels = (uint32_t)f->width * (uint32_t)f->height;
    uint32_t around[8];
    size_t count = 0;

    for (uint32_t p = 0; p < pixels; p++) nearest[p] = f->rgba[4 * (size_t)p + 3] > 0 ? p : NO_PIXEL;
    for (uint32_t p = 0; p < pixels; p++) {
        if (nearest[p] != NO_PIXEL) continue;
        for (int k = 0, n = neighbors(f, p, around); k < n; k++) {
            if (nearest[around[k]] != around[k]) continue;
            nearest[p] = around[k];
            list[count++] = p;
            break;
        }
    }
    for (size_t i = 0; i < count; i++)
        for (int k = 0, n = neighbors(f, list[i], around); k < n; k++) {
            if (nearest[around[k]] != NO_PIXEL) continue;
            nearest[around[k]] = nearest[list[i]];
            list[count++] = around[k];
        }
    return count;
}

enum status hole_find_overhang(uint8_t *overhang, const struct rendered_frame *f, const struct hole_photos *photos,
                               struct err *err)
{
    const size_t pixels = (size_t)f->width * (size_t)f->height;
    uint32_t *nearest, *list, around[8];
    size_t empty = 0;

    memset(overhang, 0, pixels);
    for (size_t p = 0; p < pixels; p++) empty += !(f->rgba[4 * p + 3] > 0);
    if (!photos || photos->count == 0 || !empty) return ST_OK;
    nearest = malloc(pixels * sizeof *nearest);
    list = malloc(2 * empty * sizeof *list);
    if (!nearest || !list) {
        free(nearest);
        free(list);
        return err_nomem(err, "the holes of a frame", (pixels + 2 * empty) * sizeof *list);
    }
    const size_t count = find_nearest(nearest, list, f);
    struct overhang_job job = {f, photos, list, nearest, overhang};
    parallel_for(count, LIST_CHUNK, find_beyond, &job);
    uint32_t *hole = list + empty; /* pixels of one hole; nearest becomes NO_PIXEL in those of earlier holes */
    for (size_t i = 0; i < count; i++) {
        size_t size = 0, beyond = 0;
        if (nearest[list[i]] == NO_PIXEL) continue;
        nearest[list[i]] = NO_PIXEL;
        hole[size++] = list[i];
        for (size_t n = 0; n < size; n++) {
            beyond += overhang[hole[n]];
            for (int k = 0, m = neighbors(f, hole[n], around); k < m; k++) {
                const uint32_t q = around[k];
                if (nearest[q] == NO_PIXEL || f->rgba[4 * (size_t)q + 3] > 0) continue;
                nearest[q] = NO_PIXEL;
                hole[size++] = q;
            }
        }
        for (size_t n = 0; n < size; n++) overhang[hole[n]] = 2 * beyond > size;
    }
    free(nearest);
    free(list);
    return ST_OK;
}

/* ---------------------------------------------------------------------------------------------- narrow holes */

struct hole_mask {
    const struct rendered_frame *frame;
    uint8_t *flags, *spare; /* w * h; 1: hole */
    uint32_t *counts;       /* hole pixels of each row */
    int diameter;
};

static void mask_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct hole_mask *m = ctx;
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

/* to[x], x < count: 1 if all of from[x .. x + length) are set. */
static void find_runs(uint8_t *to, const uint8_t *from, size_t count, size_t length)
{
    memcpy(to, from, count);
    for (size_t k = 1; k < length; k++)
        for (size_t x = 0; x < count; x++) to[x] &= from[x + k];
}

/* Morphological opening by a diameter x diameter square, separable: clears the flags that no such square of flags
 * contains. Rows without flags are skipped. */
static void keep_wide(struct hole_mask *m)
{
    const size_t w = (size_t)m->frame->width, h = (size_t)m->frame->height, d = (size_t)m->diameter;

    memset(m->spare, 0, w * h);
    if (w < d || h < d) {
        memset(m->flags, 0, w * h);
        return;
    }
    for (size_t y = 0; y < h; y++) /* spare: a run of d begins here */
        if (m->counts[y] >= d) find_runs(m->spare + y * w, m->flags + y * w, w - d + 1, d);
    for (size_t y = 0; y + d <= h; y++) /* erosion: d such runs below each other, a square begins here */
        for (size_t k = 1; m->counts[y] && k < d; k++)
            for (size_t x = 0; x < w; x++) m->spare[y * w + x] &= m->spare[(y + k) * w + x];
    for (size_t y = h - d + 1; y < h; y++) memset(m->spare + y * w, 0, w);
    for (size_t y = 0; y < h; y++) { /* dilation along x: the first rows of the squares */
        if (!m->counts[y]) continue;
        uint8_t *row = m->spare + y * w;
        for (size_t x = w; x-- > 0;) { /* from the right, in place: a square that begins at x - k covers x */
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
    struct hole_mask m = {f, malloc(w * h), malloc(w * h), malloc((h + 1) * sizeof *m.counts), diameter};
    size_t n = 0;

    *count = *empty = 0;
    *list = NULL;
    if (!m.flags || !m.spare || !m.counts) {
        err_nomem(err, "the narrow holes of a frame", 2 * w * h);
        goto done;
    }
    parallel_for(h, 64, mask_rows, &m);
    for (size_t y = 0; y < h; y++) *empty += m.counts[y];
    *list = malloc((*empty + 1) * sizeof **list);
    if (!*list) {
        err_nomem(err, "the narrow holes of a frame", *empty * sizeof **list);
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
    return err->status;
}

struct narrow_pass {
    const struct rendered_frame *frame;
    const struct far_side *far;
    const uint32_t *list;
    const uint8_t *overhang;
    struct color_z *filled; /* of each pixel of the list; z 0: nothing known near it */
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
        const struct far_side far = {n->far->soft, n->far->sigma, n->overhang[n->list[i]]};
        n->filled[i] = (struct color_z){0};
        far_mean(&far, items, weights, count, &n->filled[i]);
    }
}

enum status hole_fill_pixels(struct rendered_frame *f, const uint32_t *list, size_t count, const uint8_t *overhang,
                             const struct soft_z *soft, float sigma, int diameter, struct err *err)
{
    const struct far_side far = {soft, sigma, false};
    struct color_z *filled = malloc((count + 1) * sizeof *filled);

    if (!filled) return err_nomem(err, "the narrow holes of a frame", count * sizeof *filled);
    /* a pass reads only the results of earlier passes, so the far side advances RADIUS pixels, in any order */
    for (int reached = 0; count && reached < diameter; reached += RADIUS) {
        struct narrow_pass pass = {f, &far, list, overhang, filled};
        parallel_for(count, LIST_CHUNK, narrow_chunk, &pass);
        for (size_t i = 0; i < count; i++)
            if (filled[i].z > 0) pixel_set(f, list[i], &filled[i]);
    }
    free(filled);
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------ wide holes */

/* Texels are computed on demand. */
enum texel_state { NOT_COMPUTED, PULLED, EMPTY, PUSHED };

struct fill_level {
    int w, h;
    struct color_z *texels;
    uint8_t *state;
};

struct fill_pyramid {
    const struct rendered_frame *frame;
    struct fill_level levels[MAX_LEVELS]; /* level 0 holds only PUSHED pixels; the others are in the frame */
    int count;
    const struct far_side *far;
};

/* Value of a texel from its four children; false: none of them is known. */
static bool pull(struct fill_pyramid *p, int level, int x, int y, struct color_z *value)
{
    struct fill_level *l = &p->levels[level];
    const size_t at = (size_t)y * (size_t)l->w + (size_t)x;

    if (level == 0) {
        *value = pixel_get(p->frame, at);
        return p->frame->rgba[4 * at + 3] > 0 && value->z > 0;
    }
    if (l->state[at] == NOT_COMPUTED) {
        struct color_z items[4];
        float weights[4] = {0};
        for (int k = 0; k < 4; k++) {
            const int u = 2 * x + (k & 1), v = 2 * y + (k >> 1);
            if (u < l[-1].w && v < l[-1].h && pull(p, level - 1, u, v, &items[k])) weights[k] = items[k].z > 0;
        }
        l->state[at] = far_mean(p->far, items, weights, 4, &l->texels[at]) ? PULLED : EMPTY;
    }
    if (l->state[at] != PULLED) return false;
    *value = l->texels[at];
    return true;
}

/* As pull(), but an unknown texel is interpolated from the coarser level: bilinear, weight 3/4 of the parent on each
 * axis. */
static bool push(struct fill_pyramid *p, int level, int x, int y, struct color_z *value)
{
    struct fill_level *l = &p->levels[level];
    const size_t at = (size_t)y * (size_t)l->w + (size_t)x;

    if (pull(p, level, x, y, value)) return true;
    if (l->state[at] != PUSHED && level + 1 < p->count) {
        struct color_z items[4];
        float weights[4] = {0};
        for (int k = 0; k < 4; k++) {
            const int u = x / 2 + ((k & 1) ? (x & 1 ? 1 : -1) : 0), v = y / 2 + ((k >> 1) ? (y & 1 ? 1 : -1) : 0);
            if (u < 0 || v < 0 || u >= l[1].w || v >= l[1].h || !push(p, level + 1, u, v, &items[k])) continue;
            weights[k] = ((k & 1) ? 0.25f : 0.75f) * ((k >> 1) ? 0.25f : 0.75f);
        }
        if (far_mean(p->far, items, weights, 4, &l->texels[at])) l->state[at] = PUSHED;
    }
    if (l->state[at] != PUSHED) return false;
    *value = l->texels[at];
    return true;
}

/* values[i]: colour and depth of list[i]; z 0: none. The frame stays as it is. */
static enum status fill_wide(struct color_z *values, const struct rendered_frame *f, const uint32_t *list, size_t count,
                             const struct far_side *far, struct err *err)
{
    const uint32_t w = (uint32_t)f->width;
    struct fill_pyramid p = {.frame = f, .levels = {{.w = f->width, .h = f->height}}, .count = 1, .far = far};
    struct color_z value;

    for (; p.levels[p.count - 1].w > 1 || p.levels[p.count - 1].h > 1; p.count++) {
        const struct fill_level *l = &p.levels[p.count - 1];
        p.levels[p.count] = (struct fill_level){.w = (l->w + 1) / 2, .h = (l->h + 1) / 2};
    }
    for (int i = 0; i < p.count; i++) {
        struct fill_level *l = &p.levels[i];
        const size_t size = (size_t)l->w * (size_t)l->h;
        l->texels = malloc(size * sizeof *l->texels);
        l->state = calloc(size, 1);
        if (!l->texels || !l->state) {
            err_nomem(err, "a pyramid of a frame", size * sizeof *l->texels);
            goto done;
        }
    }
    if (!pull(&p, p.count - 1, 0, 0, &value)) goto done; /* no pixel of the frame is known */
    for (size_t i = 0; i < count; i++)
        if (push(&p, 0, (int)(list[i] % w), (int)(list[i] / w), &value)) values[i] = value;
done:
    for (int i = 0; i < p.count; i++) {
        free(p.levels[i].texels);
        free(p.levels[i].state);
    }
    return err->status;
}

/* Fills the listed pixels, overhangs by a pyramid of their own, both from the unfilled frame. *filled: how many got a
 * colour. */
static enum status fill_wide_parts(struct rendered_frame *f, const uint32_t *list, size_t count,
                                   const uint8_t *overhang, const struct soft_z *soft, float sigma, size_t *filled,
                                   struct err *err)
{
    uint32_t *sorted = malloc((count + 1) * sizeof *sorted); /* disocclusions, then overhangs */
    struct color_z *values = calloc(count + 1, sizeof *values);
    size_t sizes[2] = {0}, n = 0;
    if (!sorted || !values) err_nomem(err, "the wide holes of a frame", count * sizeof *values);

    for (int k = 0; !err->status && k < 2; k++)
        for (size_t i = 0; i < count; i++) {
            if (overhang[list[i]] != k) continue;
            sorted[n++] = list[i];
            sizes[k]++;
        }
    for (size_t k = 0, from = 0; !err->status && k < 2; from += sizes[k++]) {
        const struct far_side far = {soft, sigma, k == 1};
        if (sizes[k]) fill_wide(values + from, f, sorted + from, sizes[k], &far, err);
    }
    *filled = 0;
    for (size_t i = 0; !err->status && i < count; i++)
        if (values[i].z > 0) {
            pixel_set(f, sorted[i], &values[i]);
            ++*filled;
        }
    free(sorted);
    free(values);
    return err->status;
}

enum status hole_fill(struct rendered_frame *frame, const struct hole_photos *photos, const struct soft_z *soft,
                      float sigma, int diameter, struct err *err)
{
    const size_t pixels = (size_t)frame->width * (size_t)frame->height;
    uint8_t *overhang = NULL;
    uint32_t *list = NULL;
    size_t narrow = 0, empty = 0, filled = 0;
    hole_narrow_pixels(&list, &narrow, &empty, frame, diameter > 0 ? diameter : 1, err);

    if (!err->status && diameter > 0 && empty) {
        overhang = malloc(pixels);
        if (overhang)
            hole_find_overhang(overhang, frame, photos, err);
        else
            err_nomem(err, "the holes of a frame", pixels);
        if (!err->status) hole_fill_pixels(frame, list, narrow, overhang, soft, sigma, diameter, err);
        for (size_t i = 0; !err->status && i < narrow; i++) filled += frame->rgba[4 * (size_t)list[i] + 3] > 0;
    }
    if (!err->status && diameter > 0 && filled < empty) {
        size_t wide = 0, left = narrow; /* narrow pixels with nothing known near them go to the pyramid, too */
        for (size_t i = narrow; i-- > 0;)
            if (!(frame->rgba[4 * (size_t)list[i] + 3] > 0)) list[--left] = list[i];
        fill_wide_parts(frame, list + left, empty - left, overhang, soft, sigma, &wide, err);
        filled += wide;
    }
    frame->unfilled_fraction = (double)(empty - filled) / (double)pixels;
    free(overhang);
    free(list);
    return err->status;
}
