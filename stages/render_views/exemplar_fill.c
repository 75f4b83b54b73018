/* exemplar_fill.c - exemplar-based inpainting [Criminisi 2004], restricted to the far side of a hole
 * [Colburn 2014, 3.6.2].
 *
 * The algorithm fills a hole patch by patch. The fill front is the set of hole pixels that touch usable pixels. The
 * next patch is centred at the front pixel of greatest priority
 *   P(p) = C(p) (D(p) + D0)      C(p) = sum of the confidences of the patch's usable pixels / pixels of the patch
 *                                D(p) = |isophote . normal of the front|, in units of the mean brightness
 * that is, patches come first that are mostly known, and where a line meets the front. The source patch in the window
 * that differs least from it (sum of squared differences over the target's usable pixels) is copied into the patch's
 * empty pixels, whose confidence becomes C(p). Known pixels have confidence 1. The isophote is the strongest gradient
 * in the patch, turned by a right angle. Colours are compared by the square root of each channel, which is nearly
 * uniform perceptually and makes the choice of a patch independent of exposure. Ties are broken by picture order.
 *
 * From the thesis: the depths of the hole's rim, the known pixels beside it, are split into two clusters, and pixels
 * nearer than the border between the clusters are not usable: they do not extend the front, and are neither sources nor
 * compared. Depth is filled along with each patch: the mean of the usable pixels around, weighted by the reversed soft
 * z-buffer (the farthest has weight 1) over the squared distance in pixels.
 *
 * What differs from the sources:
 * - D0 gives uniform regions an order;
 * - there are two clusters only if the gap between their means in ln z is above 4 sqrt(2) sigma, twice what the depths
 *   of one surface may differ by error; if at most 1/8 of the rim lies in the middle third of the gap (a slanted wall
 *   has 1/6 there, a Gaussian 1/5); and if each cluster has at least 1/20 of the rim. Before, 1/40 of the rim is left
 *   out at either end, so that outliers neither make a cluster nor hide one;
 * - a hole that overhangs the photos (common/layers/hole_fill.c) is not a disocclusion: all pixels of its rim are
 *   usable, and depth is blended without preference for the far side;
 * - a pixel that was copied n times adds a penalty to the patch around it, n times half of the difference that noise
 *   makes between two patches, so that uniform areas are not tiled with the one smoothest patch. Noise is estimated by
 *   the mean step between adjacent source pixels;
 * - where the window has no source patch (deep in a wide hole), it is moved to where a pixel of the target was itself
 *   copied from, then doubled until it covers the frame; without any source patch, colour is blended like depth. */
#include "stages/render_views/exemplar_fill.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/parallel.h"
#include "common/base/sort.h"
#include "common/math/lanes.h"

#define MAX_RADIUS    7
#define MAX_PATCH     ((2 * MAX_RADIUS + 1) * (2 * MAX_RADIUS + 1))
#define GAP_SIGMAS    4.0  /* of sqrt(2) sigma */
#define VALLEY_SHARE  8    /* max 1 / VALLEY_SHARE of the rim is between the clusters */
#define CLUSTER_SHARE 20   /* min 1 / CLUSTER_SHARE of the rim is in each cluster */
#define STRAY_SHARE   40   /* 1 / STRAY_SHARE of the rim is left out at either end */
#define EVEN_PRIORITY 0.1f /* D0 */
#define COPY_PENALTY  0.5f /* per earlier copy, of the difference that noise makes between two patches */
#define LANES         8
#define NOWHERE       UINT32_MAX
#define KNOWN         0 /* label of pixels outside of holes; hole i has label i + 1 */

struct frame_hole {
    size_t first, count; /* its range in the list of pixels */
    int x0, y0, x1, y1;  /* bounding box; x1 and y1 exclusive */
};

struct front_pixel {
    float priority;
    uint32_t pixel;
};

struct fill_scratch {        /* one per thread */
    uint8_t *valid, *copies; /* one block: centres of source patches, and how often each pixel was copied (max 255) */
    size_t valid_size;
    int *run;
    struct front_pixel *heap;
    size_t heap_count, heap_size;
    float *rim;
    size_t rim_size;
    struct exemplar_stats stats;
    enum status status;
};

struct fill_job {
    struct rendered_frame *frame;
    const struct exemplar_depth *depth;
    int w, h, radius, window;
    size_t stride;     /* of the planes */
    float *planes[3];  /* square roots of the colours known before; rows have LANES of padding */
    float *luma;       /* of known and filled pixels, relative to the mean of the known ones; the last is that mean */
    float *confidence; /* 0: still empty */
    float *priority;   /* of front pixels; entries of the heap with another priority are stale */
    uint32_t *origin;  /* pixel that a filled pixel was copied from; NOWHERE: it was blended */
    uint32_t *label;
    uint8_t *overhang; /* 1 in holes beyond the photos */
    uint32_t *list;    /* pixels of all holes, hole by hole */
    struct frame_hole *holes;
    size_t hole_count;
    struct fill_scratch *scratch;
};

struct hole_job { /* filling of one hole */
    const struct fill_job *job;
    struct fill_scratch *s;
    uint32_t label;
    bool overhangs;                     /* beyond the photos: no side is preferred */
    float border;                       /* known pixels not farther than this are not usable; -1: all are */
    float noise;                        /* square of the mean step between adjacent source pixels */
    int bx, by, bw, bh, margin, stride; /* the box that `valid` and `copies` describe */
};

/* --------------------------------------------------------------------------------------------------- clusters */

float exemplar_far_border(float *z, size_t count, float sigma)
{
    double sum = 0, near_sum = 0, best = -1, border = 0, gap = 0;
    size_t first = 0, near_count = 0, between = 0;

    sort_floats(z, count);
    while (first < count && !(z[first] > 0)) first++;
    first += (count - first) / STRAY_SHARE;
    count -= first + (count - first) / (STRAY_SHARE - 1);
    z += first;
    if (count < 2) return 0;

    const double base = log(z[count / 2]); /* keeps the sums small */
    for (size_t i = 0; i < count; i++) sum += log(z[i]) - base;
    for (size_t i = 0; i + 1 < count; i++) { /* near: [0, i] */
        near_sum += log(z[i]) - base;
        if (!(z[i] < z[i + 1])) continue;
        const double n = (double)(i + 1), m = (double)(count - i - 1), far_sum = sum - near_sum;
        const double apart = near_sum * near_sum / n + far_sum * far_sum / m; /* variance between the clusters */
        if (apart > best) {
            best = apart;
            border = base + 0.5 * (near_sum / n + far_sum / m);
            gap = far_sum / m - near_sum / n;
            near_count = i + 1;
        }
    }
    for (size_t i = 0; i < count; i++) between += z[i] > exp(border - gap / 6) && z[i] < exp(border + gap / 6);
    const bool two = gap > GAP_SIGMAS * M_SQRT2 * fmax(sigma, SOFT_Z_MIN_SIGMA) && between * VALLEY_SHARE <= count &&
                     near_count * CLUSTER_SHARE >= count && (count - near_count) * CLUSTER_SHARE >= count;
    return two ? (float)exp(border) : 0;
}

/* ------------------------------------------------------------------------------------------------ usable pixels */

/* Known and far, or filled in this hole. */
static bool is_usable(const struct hole_job *f, size_t p)
{
    const uint32_t label = f->job->label[p];
    if (label == KNOWN) return f->job->frame->z[p] > f->border;
    return label == f->label && f->job->confidence[p] > 0;
}

/* Still empty. */
static bool is_open(const struct hole_job *f, size_t p)
{
    return f->job->label[p] == f->label && !(f->job->confidence[p] > 0);
}

static bool usable_at(const struct hole_job *f, int x, int y)
{
    const struct fill_job *j = f->job;
    return x >= 0 && y >= 0 && x < j->w && y < j->h && is_usable(f, (size_t)y * (size_t)j->w + (size_t)x);
}

/* Open, and adjacent to a usable pixel. */
static bool on_front(const struct hole_job *f, int x, int y)
{
    if (!is_open(f, (size_t)y * (size_t)f->job->w + (size_t)x)) return false;
    for (int v = y - 1; v <= y + 1; v++)
        for (int u = x - 1; u <= x + 1; u++)
            if (usable_at(f, u, v)) return true;
    return false;
}

static float luma_of(const float *rgba, float mean)
{
    return (sqrtf(fmaxf(0, rgba[0])) + sqrtf(fmaxf(0, rgba[1])) + sqrtf(fmaxf(0, rgba[2]))) / (3 * mean);
}

/* ------------------------------------------------------------------------------------------------- priorities */

/* C(p) */
static float confidence_at(const struct hole_job *f, int x, int y)
{
    const struct fill_job *j = f->job;
    const int r = j->radius;
    float sum = 0;

    for (int v = y - r; v <= y + r; v++)
        for (int u = x - r; u <= x + r; u++)
            if (usable_at(f, u, v)) sum += j->confidence[(size_t)v * (size_t)j->w + (size_t)u];
    return sum / (float)((2 * r + 1) * (2 * r + 1));
}

/* D(p) */
static float data_at(const struct hole_job *f, int x, int y)
{
    const struct fill_job *j = f->job;
    const int r = j->radius, side = 2 * r + 3;
    bool usable[(2 * MAX_RADIUS + 3) * (2 * MAX_RADIUS + 3)];
    float strongest = 0, gx = 0, gy = 0;

    for (int v = 0; v < side; v++)
        for (int u = 0; u < side; u++) usable[v * side + u] = usable_at(f, x - r - 1 + u, y - r - 1 + v);
#define AT(u, v) ((float)usable[(v)*side + (u)])
    const int c = r + 1;
    const float nx =
        AT(c + 1, c - 1) + 2 * AT(c + 1, c) + AT(c + 1, c + 1) - AT(c - 1, c - 1) - 2 * AT(c - 1, c) - AT(c - 1, c + 1);
    const float ny =
        AT(c - 1, c + 1) + 2 * AT(c, c + 1) + AT(c + 1, c + 1) - AT(c - 1, c - 1) - 2 * AT(c, c - 1) - AT(c + 1, c - 1);
#undef AT
    if (nx == 0 && ny == 0) return 0;
    for (int v = 1; v + 1 < side; v++)
        for (int u = 1; u + 1 < side; u++) {
            const bool *k = usable + v * side + u;
            if (!k[0] || !k[-1] || !k[1] || !k[-side] || !k[side]) continue;
            const float *l = j->luma + (size_t)(y - c + v) * (size_t)j->w + (size_t)(x - c + u);
            const float dx = 0.5f * (l[1] - l[-1]), dy = 0.5f * (l[j->w] - l[-j->w]), square = dx * dx + dy * dy;
            if (square > strongest) {
                strongest = square;
                gx = dx;
                gy = dy;
            }
        }
    return fabsf(gx * ny - gy * nx) / sqrtf(nx * nx + ny * ny);
}

static bool goes_before(struct front_pixel a, struct front_pixel b)
{
    return a.priority > b.priority || (a.priority == b.priority && a.pixel < b.pixel);
}

static bool heap_push(struct fill_scratch *s, struct front_pixel item)
{
    if (s->heap_count == s->heap_size) {
        const size_t size = s->heap_size ? 2 * s->heap_size : 1024;
        struct front_pixel *heap = realloc(s->heap, size * sizeof *heap);
        if (!heap) return false;
        s->heap = heap;
        s->heap_size = size;
    }
    size_t i = s->heap_count++;
    while (i && goes_before(item, s->heap[(i - 1) / 2])) {
        s->heap[i] = s->heap[(i - 1) / 2];
        i = (i - 1) / 2;
    }
    s->heap[i] = item;
    return true;
}

static struct front_pixel heap_pop(struct fill_scratch *s)
{
    const struct front_pixel top = s->heap[0], last = s->heap[--s->heap_count];
    size_t i = 0;
    for (;;) {
        size_t child = 2 * i + 1;
        if (child >= s->heap_count) break;
        if (child + 1 < s->heap_count && goes_before(s->heap[child + 1], s->heap[child])) child++;
        if (!goes_before(s->heap[child], last)) break;
        s->heap[i] = s->heap[child];
        i = child;
    }
    s->heap[i] = last;
    return top;
}

/* Pushes (x, y) if it is on the front and its priority changed. False: out of memory. */
static bool front_update(const struct hole_job *f, int x, int y)
{
    if (!on_front(f, x, y)) return true;
    const size_t p = (size_t)y * (size_t)f->job->w + (size_t)x;
    const float priority = confidence_at(f, x, y) * (data_at(f, x, y) + EVEN_PRIORITY);
    if (priority == f->job->priority[p]) return true;
    f->job->priority[p] = priority;
    return heap_push(f->s, (struct front_pixel){priority, (uint32_t)p});
}

/* ------------------------------------------------------------------------------------------------ source patches */

static int min_int(int a, int b) { return a < b ? a : b; }
static int max_int(int a, int b) { return a > b ? a : b; }

/* Marks the centres of source patches, all of whose pixels are known and usable, up to `margin` px around the hole.
 * False: out of memory. */
static bool find_sources(struct hole_job *f, const struct frame_hole *hole, int margin)
{
    const struct fill_job *j = f->job;
    struct fill_scratch *s = f->s;
    const int r = j->radius, side = 2 * r + 1;

    f->margin = margin;
    f->bx = max_int(0, hole->x0 - margin);
    f->by = max_int(0, hole->y0 - margin);
    f->bw = min_int(j->w, hole->x1 + margin) - f->bx;
    f->bh = min_int(j->h, hole->y1 + margin) - f->by;
    f->stride = f->bw + LANES;
    const size_t size = (size_t)f->stride * (size_t)f->bh;
    if (size > s->valid_size) {
        free(s->valid);
        s->valid_size = 0;
        s->valid = malloc(2 * size);
        if (!s->valid) return false;
        s->valid_size = size;
    }
    s->copies = s->valid + size;
    memset(s->valid, 0, 2 * size);
    memset(s->run, 0, (size_t)f->bw * sizeof *s->run);
    double steps = 0, pairs = 0;
    for (int y = 0; y < f->bh; y++) {
        int across = 0; /* length of the run of source pixels that ends here; run[x]: rows of `side` such pixels */
        for (int x = 0; x < f->bw; x++) {
            const size_t p = (size_t)(f->by + y) * (size_t)j->w + (size_t)(f->bx + x);
            across = j->label[p] == KNOWN && j->frame->z[p] > f->border ? across + 1 : 0;
            if (across > 1) {
                const size_t q = (size_t)(f->by + y) * j->stride + (size_t)(f->bx + x);
                for (int k = 0; k < 3; k++) steps += fabsf(j->planes[k][q] - j->planes[k][q - 1]);
                pairs += 3;
            }
            s->run[x] = across >= side ? s->run[x] + 1 : 0;
            if (s->run[x] >= side) s->valid[(size_t)(y - r) * (size_t)f->stride + (size_t)(x - r)] = 0xff;
        }
    }
    const double step = pairs > 0 ? steps / pairs : 0;
    f->noise = (float)(step * step);
    return true;
}

struct target_patch { /* the usable pixels of the patch to fill */
    int count;
    uint32_t origin;             /* origin of one of its filled pixels, or NOWHERE */
    ptrdiff_t offset[MAX_PATCH]; /* from the centre, in the planes */
    float v[MAX_PATCH][3];       /* square roots of the colour */
};

static void target_make(struct target_patch *t, const struct hole_job *f, int x, int y)
{
    const struct fill_job *j = f->job;
    const int r = j->radius;

    t->count = 0;
    t->origin = NOWHERE;
    for (int dy = -r; dy <= r; dy++)
        for (int dx = -r; dx <= r; dx++) {
            if (!usable_at(f, x + dx, y + dy)) continue;
            const size_t p = (size_t)(y + dy) * (size_t)j->w + (size_t)(x + dx);
            for (size_t k = 0; k < 3; k++) t->v[t->count][k] = sqrtf(fmaxf(0, j->frame->rgba[4 * p + k]));
            t->offset[t->count++] = dy * (ptrdiff_t)j->stride + dx;
            if (t->origin == NOWHERE && j->label[p] != KNOWN) t->origin = j->origin[p];
        }
}

/* *found: centre of the source patch most similar to the target, less than `half` px from (x, y). False: there is no
 * source patch. */
static bool search(const struct hole_job *f, const struct target_patch *t, int x, int y, int half, size_t *found)
{
    const struct fill_job *j = f->job;
    const int r = j->radius; /* keeps patches inside the frame, also those of lanes that are not sources */
    const int x0 = max_int(max_int(f->bx, r), x - half), x1 = min_int(min_int(f->bx + f->bw, j->w - r), x + half);
    const int y0 = max_int(max_int(f->by, r), y - half), y1 = min_int(min_int(f->by + f->bh, j->h - r), y + half);
    const float *const red = j->planes[0], *const green = j->planes[1], *const blue = j->planes[2];
    const f32x8 penalty = f32x8_all(COPY_PENALTY * 3 * (float)t->count * f->noise);
    float best = INFINITY;
    bool any = false;

    for (int v = y0; v < y1; v++) {
        const size_t row = (size_t)(v - f->by) * (size_t)f->stride;
        const uint8_t *const valid = f->s->valid + row, *const copies = f->s->copies + row;
        for (int u = x0; u < x1; u += LANES) {
            uint64_t lanes;
            memcpy(&lanes, valid + (u - f->bx), sizeof lanes);
            if (x1 - u < LANES) lanes &= ((uint64_t)1 << (8 * (x1 - u))) - 1;
            if (!lanes) continue;
            const i32x8 allowed = i32x8_from_u8((const uint8_t *)&lanes) > 0;
            const f32x8 limit = f32x8_all(best);
            const size_t at = (size_t)v * j->stride + (size_t)u;
            f32x8 sum = penalty * f32x8_from_i32(i32x8_from_u8(copies + (u - f->bx)));
            int left = 0;
            for (int i = 0; i < t->count;) {
                for (const int end = min_int(t->count, i + 5); i < end; i++) {
                    const size_t q = at + (size_t)t->offset[i];
                    const f32x8 dr = f32x8_load(red + q) - t->v[i][0];
                    const f32x8 dg = f32x8_load(green + q) - t->v[i][1];
                    const f32x8 db = f32x8_load(blue + q) - t->v[i][2];
                    sum += dr * dr + (dg * dg + db * db);
                }
                left = i32x8_signs(allowed & (sum < limit));
                if (!left) break;
            }
            if (!left) continue;
            float sums[LANES];
            f32x8_store(sums, sum);
            for (int k = 0; k < LANES; k++)
                if ((left >> k & 1) && sums[k] < best) {
                    best = sums[k];
                    *found = (size_t)v * (size_t)j->w + (size_t)(u + k);
                    any = true;
                }
        }
    }
    return any;
}

/* ------------------------------------------------------------------------------------------------------ filling */

/* Mean colour and depth of the usable pixels around (x, y), far side preferred unless the hole is an overhang. */
static void blend(const struct hole_job *f, int x, int y, float rgb[3], float *z)
{
    const struct fill_job *j = f->job;
    const int r = j->radius + 1; /* all pixels of a patch on the front have a usable pixel within this distance */
    float z_far = 0, sum = 0, z_sum = 0, colors = 0;

    for (int v = y - r; v <= y + r; v++)
        for (int u = x - r; u <= x + r; u++)
            if (usable_at(f, u, v)) z_far = fmaxf(z_far, j->frame->z[(size_t)v * (size_t)j->w + (size_t)u]);
    const float rho = soft_z_rho(&j->depth->soft, z_far, j->depth->sigma, z_far, j->depth->sigma);
    *z = rgb[0] = rgb[1] = rgb[2] = 0;
    for (int v = y - r; v <= y + r; v++)
        for (int u = x - r; u <= x + r; u++) {
            if (!usable_at(f, u, v)) continue;
            const size_t p = (size_t)v * (size_t)j->w + (size_t)u;
            const float nearness = 1 / (float)((u - x) * (u - x) + (v - y) * (v - y));
            const float w = f->overhangs ? nearness : nearness * soft_z_weight(z_far - j->frame->z[p], 0.1f * rho, rho);
            for (int k = 0; k < 3; k++) rgb[k] += w * j->frame->rgba[4 * p + (size_t)k];
            colors += w;
            if (!(j->frame->z[p] > 0)) continue;
            z_sum += w * j->frame->z[p];
            sum += w;
        }
    for (int k = 0; k < 3 && colors > 0; k++) rgb[k] /= colors;
    if (sum > 0) *z = z_sum / sum;
}

/* Counts a copy of pixel `from`. */
static void count_copy(struct hole_job *f, size_t from)
{
    const size_t x = from % (size_t)f->job->w - (size_t)f->bx, y = from / (size_t)f->job->w - (size_t)f->by;
    uint8_t *copies = f->s->copies + y * (size_t)f->stride + x;
    if (*copies < UINT8_MAX) ++*copies;
}

/* Fills the patch around pixel p, and updates the front. False: out of memory. */
static bool fill_patch(struct hole_job *f, const struct frame_hole *hole, size_t p)
{
    const struct fill_job *j = f->job;
    const int r = j->radius, x = (int)(p % (size_t)j->w), y = (int)(p / (size_t)j->w);
    const float confidence = confidence_at(f, x, y);
    struct target_patch target;
    struct {
        size_t p;
        float rgb[3], z;
        uint32_t origin;
    } filled[MAX_PATCH];
    size_t source = 0;
    int count = 0;

    target_make(&target, f, x, y);
    bool found = search(f, &target, x, y, j->window / 2, &source);
    if (!found) {
        f->s->stats.moved++;
        if (target.origin != NOWHERE)
            found = search(f, &target, (int)(target.origin % (uint32_t)j->w), (int)(target.origin / (uint32_t)j->w),
                           j->window / 2, &source);
    }
    for (int half = j->window; !found; half *= 2) {
        if (f->margin < half && !find_sources(f, hole, half)) return false;
        found = search(f, &target, x, y, half, &source);
        if (half >= max_int(j->w, j->h)) break;
    }
    f->s->stats.patches += found;
    f->s->stats.no_patch += !found;

    for (int v = max_int(0, y - r); v <= min_int(j->h - 1, y + r); v++)
        for (int u = max_int(0, x - r); u <= min_int(j->w - 1, x + r); u++) {
            const size_t q = (size_t)v * (size_t)j->w + (size_t)u;
            if (!is_open(f, q)) continue;
            filled[count].p = q;
            blend(f, u, v, filled[count].rgb, &filled[count].z);
            const size_t from = source + q - p; /* no wrap-around: the source patch is inside the frame */
            filled[count].origin = found ? (uint32_t)from : NOWHERE;
            if (found) {
                memcpy(filled[count].rgb, j->frame->rgba + 4 * from, 3 * sizeof(float));
                count_copy(f, from);
            }
            count++;
        }
    for (int i = 0; i < count; i++) {
        const size_t q = filled[i].p;
        memcpy(j->frame->rgba + 4 * q, filled[i].rgb, sizeof filled[i].rgb);
        j->frame->rgba[4 * q + 3] = 1;
        j->frame->z[q] = filled[i].z;
        j->confidence[q] = confidence;
        j->origin[q] = filled[i].origin;
        j->luma[q] = luma_of(filled[i].rgb, j->luma[(size_t)j->w * (size_t)j->h]);
    }
    /* priorities depend on pixels up to r + 1 away, because of gradients */
    for (int v = max_int(0, y - 2 * r - 1); v <= min_int(j->h - 1, y + 2 * r + 1); v++)
        for (int u = max_int(0, x - 2 * r - 1); u <= min_int(j->w - 1, x + 2 * r + 1); u++)
            if (!front_update(f, u, v)) return false;
    return true;
}

/* Depths along a hole's rim: one for each side shared by a hole pixel and a known pixel. False: out of memory. */
static bool rim_depths(const struct hole_job *f, const struct frame_hole *hole, size_t *count)
{
    const struct fill_job *j = f->job;
    struct fill_scratch *s = f->s;

    if (4 * hole->count > s->rim_size) {
        free(s->rim);
        s->rim_size = 0;
        s->rim = malloc(4 * hole->count * sizeof *s->rim);
        if (!s->rim) return false;
        s->rim_size = 4 * hole->count;
    }
    *count = 0;
    for (size_t i = 0; i < hole->count; i++) {
        const size_t p = j->list[hole->first + i], w = (size_t)j->w;
        const int x = (int)(p % w), y = (int)(p / w);
        if (x > 0 && j->label[p - 1] == KNOWN) s->rim[(*count)++] = j->frame->z[p - 1];
        if (x + 1 < j->w && j->label[p + 1] == KNOWN) s->rim[(*count)++] = j->frame->z[p + 1];
        if (y > 0 && j->label[p - w] == KNOWN) s->rim[(*count)++] = j->frame->z[p - w];
        if (y + 1 < j->h && j->label[p + w] == KNOWN) s->rim[(*count)++] = j->frame->z[p + w];
    }
    return true;
}

/* False: out of memory. */
static bool fill_hole(const struct fill_job *j, struct fill_scratch *s, size_t index)
{
    const struct frame_hole *hole = &j->holes[index];
    struct hole_job f = {.job = j, .s = s, .label = (uint32_t)index + 1, .border = -1};
    size_t count;

    f.overhangs = j->overhang[j->list[hole->first]];
    if (!f.overhangs) {
        if (!rim_depths(&f, hole, &count)) return false;
        const float border = exemplar_far_border(s->rim, count, j->depth->sigma);
        if (border > 0) f.border = border;
        s->stats.classified += border > 0;
    }
    s->stats.holes++;
    s->stats.overhangs += f.overhangs;
    if (!find_sources(&f, hole, j->window / 2)) return false;

    s->heap_count = 0;
    for (size_t i = 0; i < hole->count; i++) {
        const uint32_t p = j->list[hole->first + i];
        if (!front_update(&f, (int)(p % (uint32_t)j->w), (int)(p / (uint32_t)j->w))) return false;
    }
    while (s->heap_count) {
        const struct front_pixel next = heap_pop(s);
        if (next.priority != j->priority[next.pixel] || !is_open(&f, next.pixel)) continue;
        if (!fill_patch(&f, hole, next.pixel)) return false;
    }
    return true;
}

static void fill_holes(void *ctx, size_t begin, size_t end, int thread)
{
    const struct fill_job *j = ctx;
    struct fill_scratch *s = &j->scratch[thread];
    for (size_t i = begin; i < end; i++)
        if (!s->status && !fill_hole(j, s, i)) s->status = ST_NOMEM;
}

/* ------------------------------------------------------------------------------------------------------- holes */

static int compare_holes(const void *a, const void *b) /* largest first, for load balance */
{
    const struct frame_hole *x = a, *y = b;
    if (x->count != y->count) return x->count > y->count ? -1 : 1;
    return x->first < y->first ? -1 : x->first > y->first;
}

/* Labels and lists the holes, largest first. */
static enum status find_holes(struct fill_job *j, struct err *err)
{
    const size_t pixels = (size_t)j->w * (size_t)j->h;
    size_t listed = 0;

    j->hole_count = 0;
    for (size_t p = 0; p < pixels; p++) j->label[p] = j->frame->rgba[4 * p + 3] > 0 ? KNOWN : UINT32_MAX;
    for (size_t p = 0; p < pixels; p++) {
        if (j->label[p] != UINT32_MAX) continue;
        if (array_append(&j->holes, j->hole_count, sizeof *j->holes, "holes of a frame", err)) return err->status;
        struct frame_hole *hole = &j->holes[j->hole_count++];
        *hole = (struct frame_hole){listed, 0, j->w, j->h, 0, 0};
        j->label[p] = 1;
        j->list[listed++] = (uint32_t)p;
        for (size_t i = hole->first; i < listed; i++) {
            const int x = (int)(j->list[i] % (uint32_t)j->w), y = (int)(j->list[i] / (uint32_t)j->w);
            hole->x0 = min_int(hole->x0, x);
            hole->y0 = min_int(hole->y0, y);
            hole->x1 = max_int(hole->x1, x + 1);
            hole->y1 = max_int(hole->y1, y + 1);
            for (int v = max_int(0, y - 1); v <= min_int(j->h - 1, y + 1); v++)
                for (int u = max_int(0, x - 1); u <= min_int(j->w - 1, x + 1); u++) {
                    const size_t q = (size_t)v * (size_t)j->w + (size_t)u;
                    if (j->label[q] != UINT32_MAX) continue;
                    j->label[q] = 1;
                    j->list[listed++] = (uint32_t)q;
                }
        }
        hole->count = listed - hole->first;
    }
    if (j->hole_count) qsort(j->holes, j->hole_count, sizeof *j->holes, compare_holes);
    for (size_t i = 0; i < j->hole_count; i++)
        for (size_t k = 0; k < j->holes[i].count; k++) j->label[j->list[j->holes[i].first + k]] = (uint32_t)i + 1;
    return ST_OK;
}

/* Fills the holes whose pixels are all narrow. */
static enum status fill_narrow_holes(struct fill_job *j, int diameter, struct err *err)
{
    const struct exemplar_depth *d = j->depth;
    uint32_t *narrow = NULL;
    size_t *narrow_count = NULL, count = 0, empty = 0, kept = 0;
    if (find_holes(j, err) || !j->hole_count) return err->status;
    hole_narrow_pixels(&narrow, &count, &empty, j->frame, diameter, err);
    narrow_count = calloc(j->hole_count, sizeof *narrow_count);
    if (!err->status && !narrow_count) err_nomem(err, "the holes of a frame", j->hole_count * sizeof *narrow_count);
    for (size_t i = 0; !err->status && i < count; i++) narrow_count[j->label[narrow[i]] - 1]++;
    for (size_t i = 0; !err->status && i < count; i++) {
        const uint32_t hole = j->label[narrow[i]] - 1;
        if (narrow_count[hole] == j->holes[hole].count) narrow[kept++] = narrow[i];
    }
    if (!err->status) hole_fill_pixels(j->frame, narrow, kept, j->overhang, &d->soft, d->sigma, diameter, err);
    free(narrow_count);
    free(narrow);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------- a frame */

static void job_release(struct fill_job *j)
{
    for (int i = 0; j->scratch && i < parallel_threads(); i++) {
        free(j->scratch[i].valid);
        free(j->scratch[i].run);
        free(j->scratch[i].heap);
        free(j->scratch[i].rim);
    }
    free(j->scratch);
    free(j->planes[0]);
    free(j->luma);
    free(j->confidence);
    free(j->priority);
    free(j->origin);
    free(j->label);
    free(j->overhang);
    free(j->list);
    free(j->holes);
}

static enum status prepare_patches(struct fill_job *j, struct err *err)
{
    const struct rendered_frame *f = j->frame;
    const size_t w = (size_t)j->w, h = (size_t)j->h, pixels = w * h, threads = (size_t)parallel_threads();
    double sum = 0;
    size_t known = 0;

    j->stride = w + LANES;
    const size_t plane = j->stride * h + 2 * LANES;
    j->planes[0] = calloc(3 * plane, sizeof(float));
    j->luma = calloc(pixels + 1, sizeof *j->luma);
    j->confidence = calloc(pixels, sizeof *j->confidence);
    j->priority = malloc(pixels * sizeof *j->priority);
    j->origin = malloc(pixels * sizeof *j->origin);
    j->scratch = calloc(threads, sizeof *j->scratch);
    if (!j->origin || !j->planes[0] || !j->luma || !j->confidence || !j->priority || !j->scratch)
        return err_nomem(err, "the patches of a frame", pixels * 24);
    for (size_t i = 0; i < threads; i++) {
        j->scratch[i].run = malloc(w * sizeof *j->scratch[i].run);
        if (!j->scratch[i].run) return err_nomem(err, "the patches of a frame", w * sizeof(int));
    }
    for (size_t k = 1; k < 3; k++) j->planes[k] = j->planes[0] + k * plane;
    for (size_t p = 0; p < pixels; p++) {
        j->priority[p] = -1;
        if (j->label[p] != KNOWN) continue;
        for (size_t k = 0; k < 3; k++) j->planes[k][p / w * j->stride + p % w] = sqrtf(fmaxf(0, f->rgba[4 * p + k]));
        j->confidence[p] = 1;
        j->luma[p] = luma_of(f->rgba + 4 * p, 1);
        sum += j->luma[p];
        known++;
    }
    const float mean = known && sum > 0 ? (float)(sum / (double)known) : 1;
    for (size_t p = 0; p < pixels; p++) j->luma[p] /= mean;
    j->luma[pixels] = mean;
    return ST_OK;
}

enum status exemplar_fill(struct rendered_frame *frame, const struct hole_photos *photos,
                          const struct exemplar_depth *depth, int diameter, const struct exemplar_params *params,
                          struct exemplar_stats *stats, struct err *err)
{
    const size_t pixels = (size_t)frame->width * (size_t)frame->height;
    struct fill_job j = {.frame = frame, .depth = depth, .w = frame->width, .h = frame->height};
    struct exemplar_stats total = {0};
    size_t empty = 0, left = 0;

    j.radius = min_int(MAX_RADIUS, params->fill_patch / 2);
    j.window = params->fill_window;
    for (size_t p = 0; p < pixels; p++) empty += !(frame->rgba[4 * p + 3] > 0);
    total.empty = left = empty;
    if (diameter <= 0 || !empty || empty == pixels) goto done;

    j.label = malloc(pixels * sizeof *j.label);
    j.list = malloc(empty * sizeof *j.list);
    j.overhang = malloc(pixels);
    if (j.label && j.list && j.overhang)
        hole_find_overhang(j.overhang, frame, photos, err);
    else
        err_nomem(err, "the holes of a frame", (pixels + empty) * sizeof *j.label);
    if (!err->status && !fill_narrow_holes(&j, diameter, err)) find_holes(&j, err); /* the remaining ones */
    if (!err->status && j.hole_count) prepare_patches(&j, err);
    if (err->status) goto done;
    parallel_for(j.hole_count, 1, fill_holes, &j);
    for (int i = 0; j.scratch && i < parallel_threads(); i++) {
        const struct exemplar_stats *s = &j.scratch[i].stats;
        if (j.scratch[i].status) err_nomem(err, "the filling of a hole", pixels);
        total.holes += s->holes;
        total.classified += s->classified;
        total.overhangs += s->overhangs;
        total.patches += s->patches;
        total.no_patch += s->no_patch;
        total.moved += s->moved;
    }
    total.narrow = empty;
    for (size_t i = 0; i < j.hole_count; i++) total.narrow -= j.holes[i].count;
    left = 0;
    for (size_t p = 0; p < pixels; p++) left += !(frame->rgba[4 * p + 3] > 0);
done:
    frame->unfilled_fraction = (double)left / (double)pixels;
    if (stats) *stats = total;
    job_release(&j);
    return err->status;
}
