/* plane_match.c - the matching cost; most of the stage's time is spent in neighbour_cost().
 *
 * Eight bytes a pixel: R G B, fine gradient x y, coarse gradient x y (offset 128), validity. A neighbour's texture keeps
 * a pixel's bytes interleaved with those of the pixel below, so that 32 bytes from one address hold the four corners of
 * a bilinear sample of all channels: _mm256_maddubs_epi16 weighs them, and the two columns are added. The sum of
 * weighted truncated differences is an integer; validity has a weight that lifts a pixel over every honest cost. */
#include "stages/segment_depth/plane_match.h"

#include <immintrin.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/base/sort.h"

#define CHANNELS 8
#define UNIT     127 /* corners' weights sum to it, so features are bytes times it */

/* Truncations (in bytes) and weights, found by trial on pairs with known disparities. Gradients are divided by their
 * deviation in the surroundings, which lets weak texture count and exposure not; they are trusted more than colours, as in
 * PatchMatch Stereo (Bleyer 2011). */
#define SURROUNDINGS 1 /* px: half width of the window that gradients are measured against */
#define DEVIATION    20.0f
#define MIN_NOISE  1.5f /* grey levels: gradients of the pictures' noise are half believed, of this much at least */
#define SMOOTHED     0.3f /* of the noise is left in coarse gradients */
#define NOISY        3.0f /* grey levels of noise at which coarse gradients count half of what they may */
enum { COLOUR_LIMIT = 16, FINE_LIMIT = 14, COARSE_LIMIT = 14 };
enum { COLOUR_WEIGHT = 10, FINE_WEIGHT = 50, COARSE_WEIGHT = 20, VALID_WEIGHT = 1000 };
enum {
    WORST = UNIT * (3 * COLOUR_LIMIT * COLOUR_WEIGHT + 2 * FINE_LIMIT * FINE_WEIGHT + 2 * COARSE_LIMIT * COARSE_WEIGHT),
    OUT_OF_SIGHT = WORST + 1,
};

#define EDGE_REACH      2    /* px */
#define EDGE_FALLOFF    0.5  /* a px: how much less the edge at some distance matters */
#define EDGE_DIFFERENCE 15.0 /* grey levels: halves what a pixel counts */

static uint8_t byte_from(float x) { return (uint8_t)(x <= 0 ? 0 : x >= 255 ? 255 : x + 0.5f); }

/* Of a neighbour: the cost where it does not see the segment, or another surface hides the segment from it, as its own
 * depth says; and its weight against that of the next better one. At most MATCH_WORST, for a match of texture with a
 * blank wall must not look better than one with other texture. */
#define UNSEEN_COST 0.4f
#define HIDDEN_COST 0.67f
#define RANK_WEIGHT 0.6

#define USEFUL_CONTRAST 0.25 /* of the best neighbour's: below it one shows something else, or nothing */
#define MIN_CONTRAST  0.05 /* between good and chance matches: pictures that show nothing at all */

struct pack_job {
    const struct gamma_image *g;
    const float *luma, *smooth, *fine_scale, *coarse_scale; /* the scales make gradients' bytes */
    float gain[3];
    float turn[2][2]; /* gradient in the reference's axes = turn (gx, gy) */
    uint8_t *packed;  /* CHANNELS a pixel */
};

static int inside(int x, int size) { return x < 0 ? 0 : x >= size ? size - 1 : x; }

static void gradient(float out[2], const float turn[2][2], const float *luma, int w, int h, int x, int y, int step)
{
    float gx = luma[y * w + inside(x + step, w)] - luma[y * w + inside(x - step, w)];
    float gy = luma[inside(y + step, h) * w + x] - luma[inside(y - step, h) * w + x];
    out[0] = turn[0][0] * gx + turn[0][1] * gy;
    out[1] = turn[1][0] * gx + turn[1][1] * gy;
}

/* Mean over a window of (2 r + 1)^2, in place, two passes of running sums; the ends repeat. line: max(w, h) floats. */
static void box_line(float *at, int count, size_t step, float *line, int r)
{
    double sum = 0;
    for (int i = 0; i < count; i++) line[i] = at[(size_t)i * step];
    for (int i = -r; i <= r; i++) sum += (double)line[inside(i, count)];
    for (int i = 0; i < count; i++) {
        at[(size_t)i * step] = (float)(sum / (2 * r + 1));
        sum += (double)line[inside(i + r + 1, count)] - (double)line[inside(i - r, count)];
    }
}

/* Factor that brings gradients to DEVIATION bytes a standard deviation of their surroundings. */
static void gradient_scale(float *scale, const float turn[2][2], const float *luma, float *line, int w, int h, int step,
                           float deviation, float noise)
{
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            float d[2];
            gradient(d, turn, luma, w, h, x, y, step);
            scale[(size_t)y * (size_t)w + (size_t)x] = 0.5f * (d[0] * d[0] + d[1] * d[1]);
        }
    for (int y = 0; y < h; y++) box_line(scale + (size_t)y * (size_t)w, w, 1, line, SURROUNDINGS);
    for (int x = 0; x < w; x++) box_line(scale + x, h, (size_t)w, line, SURROUNDINGS);
    for (size_t i = 0; i < (size_t)w * (size_t)h; i++) scale[i] = deviation / (sqrtf(fmaxf(scale[i], 0)) + noise / 255);
}

static void pack_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct pack_job *job = ctx;
    int w = job->g->width;
    (void)thread;
    for (int y = (int)begin; y < (int)end; y++)
        for (int x = 0; x < w; x++) {
            size_t i = (size_t)y * (size_t)w + (size_t)x;
            uint8_t *p = job->packed + CHANNELS * i;
            float fine[2], coarse[2];
            gradient(fine, job->turn, job->luma, w, job->g->height, x, y, 1);
            gradient(coarse, job->turn, job->smooth, w, job->g->height, x, y, 2);
            for (int c = 0; c < 3; c++) p[c] = byte_from(255 * job->gain[c] * job->g->rgb[c][i]);
            for (int c = 0; c < 2; c++) {
                p[3 + c] = byte_from(128 + job->fine_scale[i] * fine[c]);
                p[5 + c] = byte_from(128 + job->coarse_scale[i] * coarse[c]);
            }
            p[7] = job->g->valid[i] ? 255 : 0;
        }
}

/* (1 4 6 4 1)/16 both ways; from and to differ; line holds w * h floats. */
static void smooth_luma(float *to, const float *from, float *line, int w, int h)
{
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            const float *p = from + (size_t)y * (size_t)w;
            line[(size_t)y * (size_t)w + (size_t)x] = 0.375f * p[x] +
                                                      0.25f * (p[inside(x - 1, w)] + p[inside(x + 1, w)]) +
                                                      0.0625f * (p[inside(x - 2, w)] + p[inside(x + 2, w)]);
        }
    for (int y = 0; y < h; y++) {
        const float *p[5];
        for (int k = 0; k < 5; k++) p[k] = line + (size_t)inside(y + k - 2, h) * (size_t)w;
        float *q = to + (size_t)y * (size_t)w;
        for (int x = 0; x < w; x++)
            q[x] = 0.375f * p[2][x] + 0.25f * (p[1][x] + p[3][x]) + 0.0625f * (p[0][x] + p[4][x]);
    }
}

/* Grey levels of noise: a low quantile of how much pixels differ from the planes through their surroundings (J. Immerkaer, "Fast
 * noise variance estimation", 1996, with a quantile in place of the mean: texture is in the upper ones). */
static float noise_of(const struct gamma_image *g)
{
    enum { BINS = 512, A_LEVEL = 16 };
    const int w = g->width;
    size_t count[BINS] = {0}, all = 0, below = 0;
    for (int y = 1; y + 1 < g->height; y++)
        for (int x = 1; x + 1 < w; x++) {
            const size_t i = (size_t)y * (size_t)w + (size_t)x;
            const float *p = g->rgb[1] + i;
            if (!g->valid[i] || !(p[0] > 0.02f && p[0] < 0.98f)) continue; /* clipped pixels have none */
            const float corners = p[-w - 1] + p[-w + 1] + p[w - 1] + p[w + 1], sides = p[-w] + p[w] + p[-1] + p[1];
            const float off = fabsf(corners - 2 * sides + 4 * p[0]) * (255.0f / 6);
            count[off < (float)(BINS - 1) / A_LEVEL ? (int)(off * A_LEVEL) : BINS - 1]++;
            all++;
        }
    int bin = 0;
    while (bin < BINS - 1 && (below += count[bin]) < all / 5) bin++;
    return all ? ((float)bin + 0.5f) / A_LEVEL / 0.2533f
               : 0; /* a fifth of a normal distribution lies within so much of it */
}

/* CHANNELS bytes a pixel, allocated; NULL: no memory. noise: of the view, grey levels. */
static uint8_t *pack(const struct gamma_image *g, const double gain[3], double turn[2][2], float noise)
{
    size_t pixels = (size_t)g->width * (size_t)g->height;
    size_t longest = (size_t)(g->width > g->height ? g->width : g->height);
    float *luma = malloc((4 * pixels + longest) * sizeof *luma);
    uint8_t *packed = malloc(CHANNELS * pixels);
    if (!luma || !packed) {
        free(luma);
        free(packed);
        return NULL;
    }
    for (size_t i = 0; i < pixels; i++)
        luma[i] = (float)(0.3 * gain[0]) * g->rgb[0][i] + (float)(0.6 * gain[1]) * g->rgb[1][i] +
                  (float)(0.1 * gain[2]) * g->rgb[2][i];
    float *smooth = luma + pixels, *fine = luma + 2 * pixels, *coarse = luma + 3 * pixels, *line = luma + 4 * pixels;
    smooth_luma(smooth, luma, fine, g->width, g->height);
    struct pack_job job = {
        .g = g, .luma = luma, .smooth = smooth, .fine_scale = fine, .coarse_scale = coarse, .packed = packed};
    for (int c = 0; c < 3; c++) job.gain[c] = (float)gain[c];
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++) job.turn[i][j] = (float)turn[i][j];
    const float believed = fmaxf(noise, MIN_NOISE), noisy = noise * noise / (noise * noise + NOISY * NOISY);
    gradient_scale(fine, job.turn, luma, line, g->width, g->height, 1, DEVIATION, believed);
    gradient_scale(coarse, job.turn, smooth, line, g->width, g->height, 2, DEVIATION * noisy,
                   fmaxf(SMOOTHED * noise, MIN_NOISE));
    parallel_for((size_t)g->height, 16, pack_rows, &job);
    free(luma);
    return packed;
}

/* What a pixel counts. One beside an edge of its segment has the edge in its gradients, and an edge moves with what stands
 * in front: the surface behind would be matched at that depth. So the more its colour differs from that of a near pixel
 * of another segment, the less it counts. */
#define FULL_WEIGHT 16
static int edge_weight(const struct segmentation *s, const uint8_t *packed, int pixel)
{
    const int x = pixel % s->width, y = pixel / s->width;
    const uint8_t *own = packed + (size_t)pixel * CHANNELS;
    double most = 0;
    for (int j = -EDGE_REACH; j <= EDGE_REACH; j++)
        for (int i = -EDGE_REACH; i <= EDGE_REACH; i++) {
            const int other = inside(y + j, s->height) * s->width + inside(x + i, s->width);
            if (s->label[other] == s->label[pixel]) continue;
            const uint8_t *theirs = packed + (size_t)other * CHANNELS;
            int difference = 0;
            for (int c = 0; c < 3; c++) {
                const int d = abs(own[c] - theirs[c]);
                difference = d > difference ? d : difference;
            }
            most = fmax(most, difference / (1 + EDGE_FALLOFF * (hypot(i, j) - 1)));
        }
    const int weight = (int)(FULL_WEIGHT / (1 + most * most / (EDGE_DIFFERENCE * EDGE_DIFFERENCE)) + 0.5);
    return weight < 1 ? 1 : weight;
}

static void put_pixel(struct matcher *m, int i, int pixel, const uint8_t *packed, int weight)
{
    static const int lane[8] = {0, 4, 1, 5, 2, 6, 3, 7}; /* as neighbour_cost() sums them */
    m->weight[(i & ~7) + lane[i & 7]] = weight;
    m->x[i] = (float)(pixel % m->segments->width) + 0.5f;
    m->y[i] = (float)(pixel / m->segments->width) + 0.5f;
    for (int c = 0; c < CHANNELS; c++) m->features[i * CHANNELS + c] = (int16_t)(UNIT * packed[c]);
}

enum status matcher_init(struct matcher *m, const struct segmentation *s, const struct gamma_image *reference,
                         struct err *err)
{
    const double gain[3] = {1, 1, 1};
    double turn[2][2] = {{1, 0}, {0, 1}};
    size_t room = 0;
    *m = (struct matcher){.segments = s, .good = 0, .random = 1, .noise = noise_of(reference)};
    m->first = malloc(((size_t)s->count + 1) * sizeof *m->first);
    if (!m->first) return err_nomem(err, "a matcher", (size_t)s->count * sizeof *m->first);
    for (int k = 0; k < s->count; k++) {
        m->first[k] = (int)room;
        room += ((size_t)s->segments[k].pixels + 7) & ~(size_t)7;
    }
    m->first[s->count] = (int)room;
    m->x = aligned_alloc(32, (room + 8) * sizeof *m->x);
    m->y = aligned_alloc(32, (room + 8) * sizeof *m->y);
    m->weight = aligned_alloc(32, (room + 8) * sizeof *m->weight);
    m->features = aligned_alloc(32, (room + 8) * CHANNELS * sizeof *m->features);
    uint8_t *packed = pack(reference, gain, turn, m->noise);
    if (!m->x || !m->y || !m->weight || !m->features || !packed) {
        free(packed);
        return err_nomem(err, "the pixels of a matcher", room * 24);
    }
    for (int k = 0; k < s->count; k++) {
        const int *pixel = s->pixel + s->segments[k].first, count = s->segments[k].pixels;
        int i = m->first[k];
        for (int part = 0; part < 2; part++) /* of every fourth pixel first: see match_cost_rough() */
            for (int n = 0; n < count; n++)
                if ((pixel[n] % s->width % 2 || pixel[n] / s->width % 2) == part)
                    put_pixel(m, i++, pixel[n], packed + (size_t)pixel[n] * CHANNELS, edge_weight(s, packed, pixel[n]));
        for (; i < m->first[k + 1]; i++) {
            put_pixel(m, i, pixel[0], packed + (size_t)pixel[0] * CHANNELS, 0);
            m->features[i * CHANNELS + 7] = -UNIT * 128; /* filling: never in sight */
        }
    }
    free(packed);
    return ST_OK;
}

void match_homography(double base[3][3], double shift_out[3], const struct view *view, const struct view *other)
{
    /* p' = K' (R K^-1 [u v 1] + T / z) */
    struct mat3 r = mat3_multiply(other->cam_from_world, mat3_transpose(view->cam_from_world));
    struct vec3 t = vec3_sub(other->translation, mat3_apply(r, view->translation));
    const double shift[3] = {t.x, t.y, t.z};
    double turned[3][3];
    for (int i = 0; i < 3; i++) {
        turned[i][0] = r.m[i][0] / view->fx;
        turned[i][1] = r.m[i][1] / view->fy;
        turned[i][2] = r.m[i][2] - r.m[i][0] * view->cx / view->fx - r.m[i][1] * view->cy / view->fy;
    }
    for (int j = 0; j < 3; j++) {
        base[0][j] = other->fx * turned[0][j] + other->cx * turned[2][j];
        base[1][j] = other->fy * turned[1][j] + other->cy * turned[2][j];
        base[2][j] = turned[2][j];
    }
    shift_out[0] = other->fx * shift[0] + other->cx * shift[2];
    shift_out[1] = other->fy * shift[1] + other->cy * shift[2];
    shift_out[2] = shift[2];
}

static bool carry(const struct match_neighbour *n, double u, double v, double inverse_z, double *nu, double *nv)
{
    double p[3];
    for (int i = 0; i < 3; i++) p[i] = n->base[i][0] * u + n->base[i][1] * v + n->base[i][2] + n->shift[i] * inverse_z;
    if (!(p[2] > 1e-9)) return false;
    *nu = p[0] / p[2];
    *nv = p[1] / p[2];
    return true;
}

/* Median ratio of the view's colours to the neighbour's, at the points that both observed; where those are too few, the
 * photos are taken to have been exposed alike. */
static enum status estimate_gain(double gain[3], const struct camera_set *set, const struct view *other,
                                 int neighbour_idx, const struct observed_points *seen, const struct gamma_image *reference,
                                 const struct gamma_image *picture, struct err *err)
{
    double *ratios = malloc(((size_t)seen->count + 1) * 3 * sizeof *ratios);
    double same_light = pow(reference->tone.exposure / picture->tone.exposure, reference->tone.power);
    int count = 0;
    if (!ratios) return err_nomem(err, "colour ratios", (size_t)seen->count * 24);
    for (int i = 0; i < seen->count; i++) {
        const struct sfm_point *p = &set->model.points[seen->points[i].point_idx];
        bool both = false;
        float mine[3], theirs[3];
        double u, v;
        for (int k = 0; k < p->track_count; k++) both = both || p->track[k].image_idx == neighbour_idx;
        if (!both || !(view_project(other, p->position, &u, &v) > 0)) continue;
        if (!gamma_image_at(reference, seen->points[i].u, seen->points[i].v, mine)) continue;
        if (!gamma_image_at(picture, u, v, theirs)) continue;
        bool well_exposed = true;
        for (int c = 0; c < 3; c++)
            well_exposed = well_exposed && mine[c] > 0.05f && mine[c] < 0.97f && theirs[c] > 0.05f && theirs[c] < 0.97f;
        if (!well_exposed) continue;
        for (int c = 0; c < 3; c++) ratios[c * seen->count + count] = (double)mine[c] / (double)theirs[c];
        count++;
    }
    for (int c = 0; c < 3; c++) {
        double *r = ratios + (size_t)c * (size_t)seen->count;
        sort_doubles(r, (size_t)count);
        gain[c] = count >= 12 ? fmin(fmax(r[count / 2], 0.25 * same_light), 4 * same_light) : same_light;
    }
    free(ratios);
    return ST_OK;
}

/* Interleaves rows y and y + 1; one more column repeats the last, and the end is padded for 32-byte loads. */
static enum status make_texture(struct match_neighbour *n, const uint8_t *packed, struct err *err)
{
    size_t w = (size_t)n->width, h = (size_t)n->height, size = (w + 1) * h * 2 * CHANNELS + 32;
    n->texture = calloc(size, 1);
    if (!n->texture) return err_nomem(err, "a texture to match with", size);
    for (size_t y = 0; y < h; y++)
        for (size_t x = 0; x <= w; x++) {
            size_t column = x < w ? x : w - 1, below = y + 1 < h ? y + 1 : y;
            uint8_t *to = n->texture + (y * (w + 1) + x) * 2 * CHANNELS;
            for (size_t c = 0; c < CHANNELS; c++) {
                to[2 * c] = packed[(y * w + column) * CHANNELS + c];
                to[2 * c + 1] = packed[(below * w + column) * CHANNELS + c];
            }
        }
    return ST_OK;
}

enum status matcher_add(struct matcher *m, const struct camera_set *set, int view_idx, int neighbour_idx,
                        const struct observed_points *seen, double typical, const struct gamma_image *reference,
                        struct gamma_image *picture, struct err *err)
{
    const struct view *view = &set->views[view_idx];
    struct view other = set->views[neighbour_idx];
    struct match_neighbour *n = &m->neighbours[m->neighbour_count];
    double turn[2][2] = {{1, 0}, {0, 1}}, gain[3], u0, v0, ux, vx, uy, vy;
    double u = view->width / 2.0, v = view->height / 2.0;
    if (estimate_gain(gain, set, &other, neighbour_idx, seen, reference, picture, err)) return err->status;
    for (;;) {
        match_homography(n->base, n->shift, view, &other);
        if (!carry(n, u, v, typical, &u0, &v0) || !carry(n, u + 1, v, typical, &ux, &vx) ||
            !carry(n, u, v + 1, typical, &uy, &vy))
            break;
        turn[0][0] = ux - u0; /* gradients are covectors: the transposed Jacobian brings them here */
        turn[0][1] = vx - v0;
        turn[1][0] = uy - u0;
        turn[1][1] = vy - v0;
        double scale = sqrt(fabs(turn[0][0] * turn[1][1] - turn[0][1] * turn[1][0]));
        if (!(scale > 1.6) || picture->width < 2 || picture->height < 2) break;
        if (gamma_image_halve(picture, err)) return err->status;
        other.width = picture->width;
        other.height = picture->height;
        other.fx /= 2;
        other.fy /= 2;
        other.cx /= 2;
        other.cy /= 2;
    }
    n->width = picture->width;
    n->height = picture->height;
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++) turn[i][j] = fmin(fmax(turn[i][j], -2), 2);
    uint8_t *packed = pack(picture, gain, turn, m->noise);
    if (!packed) return err_nomem(err, "a picture to match with", (size_t)n->width * (size_t)n->height * 20);
    enum status st = make_texture(n, packed, err);
    free(packed);
    if (!st) m->neighbour_count++;
    return st;
}

void matcher_release(struct matcher *m)
{
    if (!m) return;
    for (int i = 0; i < m->neighbour_count; i++) free(m->neighbours[i].texture);
    free(m->unseen_cost);
    free(m->occluded_cost);
    free(m->first);
    free(m->x);
    free(m->y);
    free(m->features);
    free(m->weight);
    *m = (struct matcher){0};
}

/* Weighted truncated differences of two pixels, a lane each, summed by pairs of channels. at: of the upper left corner, in
 * halves of a texture element; corners: weights of the corners that sum to UNIT, those of the left column in bytes 0 and 1. */
static inline __m256i pair_differences(const uint8_t *texture, const int *at, const int *corners,
                                       const int16_t *reference)
{
    const __m256i columns = _mm256_set_m128i(_mm_set1_epi16(0x0302), _mm_set1_epi16(0x0100));
    const __m256i limit = _mm256_setr_epi16(
        UNIT * COLOUR_LIMIT, UNIT * COLOUR_LIMIT, UNIT * COLOUR_LIMIT, UNIT * FINE_LIMIT, UNIT * FINE_LIMIT,
        UNIT * COARSE_LIMIT, UNIT * COARSE_LIMIT, 32767, UNIT * COLOUR_LIMIT, UNIT * COLOUR_LIMIT, UNIT * COLOUR_LIMIT,
        UNIT * FINE_LIMIT, UNIT * FINE_LIMIT, UNIT * COARSE_LIMIT, UNIT * COARSE_LIMIT, 32767);
    const __m256i weight =
        _mm256_setr_epi16(COLOUR_WEIGHT, COLOUR_WEIGHT, COLOUR_WEIGHT, FINE_WEIGHT, FINE_WEIGHT, COARSE_WEIGHT,
                          COARSE_WEIGHT, VALID_WEIGHT, COLOUR_WEIGHT, COLOUR_WEIGHT, COLOUR_WEIGHT, FINE_WEIGHT,
                          FINE_WEIGHT, COARSE_WEIGHT, COARSE_WEIGHT, VALID_WEIGHT);
    __m256i p =
        _mm256_maddubs_epi16(_mm256_loadu_si256((const __m256i *)(texture + (size_t)(unsigned)at[0] * CHANNELS)),
                             _mm256_shuffle_epi8(_mm256_set1_epi32(corners[0]), columns));
    __m256i q =
        _mm256_maddubs_epi16(_mm256_loadu_si256((const __m256i *)(texture + (size_t)(unsigned)at[1] * CHANNELS)),
                             _mm256_shuffle_epi8(_mm256_set1_epi32(corners[1]), columns));
    __m256i sample = _mm256_add_epi16(_mm256_permute2x128_si256(p, q, 0x20), _mm256_permute2x128_si256(p, q, 0x31));
    /* saturating: the filling's validity is far below any sample's */
    __m256i difference = _mm256_abs_epi16(_mm256_subs_epi16(sample, _mm256_load_si256((const __m256i *)reference)));
    return _mm256_madd_epi16(_mm256_min_epi16(difference, limit), weight);
}

/* Mean cost of a segment in one neighbour, 0 .. 1, and the fraction of its pixels that the neighbour sees. */
static float neighbour_cost(const struct matcher *m, const struct match_neighbour *n, int begin, int end,
                            struct plane plane, int *seen)
{
    const double slope[3] = {plane.a, plane.b, plane.c};
    __m256 h[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) h[i][j] = _mm256_set1_ps((float)(n->base[i][j] + n->shift[i] * slope[j]));
    const __m256 half = _mm256_set1_ps(0.5f), zero = _mm256_setzero_ps(), small = _mm256_set1_ps(1e-9f);
    const __m256 right = _mm256_set1_ps((float)(n->width - 1)), bottom = _mm256_set1_ps((float)(n->height - 1));
    const __m256 low = _mm256_set1_ps(-0.5f);
    const __m256 max_u = _mm256_add_ps(right, half), max_v = _mm256_add_ps(bottom, half);
    const __m256i stride = _mm256_set1_epi32(n->width + 1);
    __m256i sum = _mm256_setzero_si256(), count = _mm256_setzero_si256(), believed = count;
    for (int i = begin; i < end; i += 8) {
        __m256 x = _mm256_load_ps(m->x + i), y = _mm256_load_ps(m->y + i), p[3];
        for (int k = 0; k < 3; k++)
            p[k] = _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(h[k][0], x), _mm256_mul_ps(h[k][1], y)), h[k][2]);
        __m256 inverse = _mm256_div_ps(_mm256_set1_ps(1), p[2]);
        __m256 u = _mm256_sub_ps(_mm256_mul_ps(p[0], inverse), half);
        __m256 v = _mm256_sub_ps(_mm256_mul_ps(p[1], inverse), half);
        __m256 in_sight = _mm256_and_ps(
            _mm256_cmp_ps(p[2], small, _CMP_GT_OQ),
            _mm256_and_ps(_mm256_and_ps(_mm256_cmp_ps(u, low, _CMP_GE_OQ), _mm256_cmp_ps(u, max_u, _CMP_LE_OQ)),
                          _mm256_and_ps(_mm256_cmp_ps(v, low, _CMP_GE_OQ), _mm256_cmp_ps(v, max_v, _CMP_LE_OQ))));
        if (_mm256_testz_ps(in_sight, in_sight)) continue;
        u = _mm256_min_ps(_mm256_max_ps(u, zero), right); /* NaN becomes 0: max returns its second operand */
        v = _mm256_min_ps(_mm256_max_ps(v, zero), bottom);
        __m256i column = _mm256_cvttps_epi32(u), row = _mm256_cvttps_epi32(v);
        const __m256 unit = _mm256_set1_ps(UNIT), fv = _mm256_sub_ps(v, _mm256_cvtepi32_ps(row));
        const __m256 fu = _mm256_mul_ps(_mm256_sub_ps(u, _mm256_cvtepi32_ps(column)), unit);
        /* rounded so that the corners' weights sum to UNIT; the upper left one may be -1 */
        const __m256i lower_right = _mm256_cvtps_epi32(_mm256_mul_ps(fu, fv));
        const __m256i upper_right = _mm256_sub_epi32(_mm256_cvtps_epi32(fu), lower_right);
        const __m256i lower_left = _mm256_sub_epi32(_mm256_cvtps_epi32(_mm256_mul_ps(fv, unit)), lower_right);
        const __m256i upper_left = _mm256_sub_epi32(
            _mm256_set1_epi32(UNIT), _mm256_add_epi32(_mm256_add_epi32(lower_right, upper_right), lower_left));
        const __m256i low_byte = _mm256_set1_epi32(255);
        _Alignas(32) int at[8], corners[8];
        _mm256_store_si256((__m256i *)at,
                           _mm256_slli_epi32(_mm256_add_epi32(_mm256_mullo_epi32(row, stride), column), 1));
        _mm256_store_si256(
            (__m256i *)corners,
            _mm256_or_si256(_mm256_or_si256(_mm256_and_si256(upper_left, low_byte), _mm256_slli_epi32(lower_left, 8)),
                            _mm256_or_si256(_mm256_slli_epi32(upper_right, 16), _mm256_slli_epi32(lower_right, 24))));
        __asm__("" : "+m"(at), "+m"(corners)); /* they are to be loaded one by one, not taken apart in registers */
        const int16_t *reference = m->features + (size_t)i * CHANNELS;
        __m256i q[4];
        for (int k = 0; k < 4; k++)
            q[k] = pair_differences(n->texture, at + 2 * k, corners + 2 * k, reference + (ptrdiff_t)(2 * k) * CHANNELS);
        /* lanes: pixels 0 2 4 6 | 1 3 5 7; their order does not matter to integer sums, but it does to mask and weight */
        __m256i cost = _mm256_hadd_epi32(_mm256_hadd_epi32(q[0], q[1]), _mm256_hadd_epi32(q[2], q[3]));
        __m256i mask =
            _mm256_permutevar8x32_epi32(_mm256_castps_si256(in_sight), _mm256_setr_epi32(0, 2, 4, 6, 1, 3, 5, 7));
        mask = _mm256_and_si256(mask, _mm256_cmpgt_epi32(_mm256_set1_epi32(OUT_OF_SIGHT), cost));
        const __m256i weight = _mm256_load_si256((const __m256i *)(m->weight + i));
        sum = _mm256_add_epi32(sum, _mm256_mullo_epi32(_mm256_srli_epi32(_mm256_and_si256(mask, cost), 8), weight));
        believed = _mm256_add_epi32(believed, _mm256_and_si256(mask, weight));
        count = _mm256_sub_epi32(count, mask);
    }
    _Alignas(32) uint32_t sums[8];
    _Alignas(32) int counts[8], weights[8];
    _mm256_store_si256((__m256i *)weights, believed);
    _mm256_store_si256((__m256i *)sums, sum);
    _mm256_store_si256((__m256i *)counts, count);
    int64_t total = 0, all = 0;
    *seen = 0;
    for (int k = 0; k < 8; k++) {
        total += sums[k];
        *seen += counts[k];
        all += weights[k];
    }
    return all > 0 ? (float)((double)total * 256 / ((double)WORST * (double)all)) : 1; /* weights are 1 at least */
}

/* A neighbour that sees less than half of the pixels does not see the segment. */
static float ranked_cost(const struct matcher *m, int segment, int pixels, struct plane plane, unsigned hidden)
{
    float costs[MAX_NEIGHBOURS];
    const int begin = m->first[segment],
              end = pixels < m->segments->segments[segment].pixels ? begin + pixels : m->first[segment + 1];
    const float unseen = m->unseen_cost ? m->unseen_cost[segment] : UNSEEN_COST;
    int count = 0;
    int useful = 0;
    for (int k = 0; k < m->neighbour_count; k++) {
        int seen = pixels, at;
        if (m->excluded >> k & 1) continue;
        useful++;
        float cost = m->occluded_cost ? m->occluded_cost[segment] : HIDDEN_COST;
        if (!(hidden >> k & 1))
            cost = (neighbour_cost(m, &m->neighbours[k], begin, end, plane, &seen) - m->good_cost) / (m->chance_cost - m->good_cost);
        if (2 * seen < pixels) continue;
        cost = fminf(fmaxf(cost, MATCH_BEST), MATCH_WORST);
        for (at = count++; at > 0 && costs[at - 1] > cost; at--) costs[at] = costs[at - 1];
        costs[at] = cost;
    }
    double sum = 0, total = 0, weight = 1;
    for (int k = 0; k < useful; k++, weight *= RANK_WEIGHT) {
        sum += weight * (double)(k < count ? costs[k] : unseen);
        total += weight;
    }
    return useful ? (float)(sum / total) : unseen;
}

float match_cost(const struct matcher *m, int segment, struct plane plane, unsigned hidden)
{
    return ranked_cost(m, segment, m->segments->segments[segment].pixels, plane, hidden);
}

/* Of a segment's pixels, rounded up to groups of eight. */
static int fourth_of(int pixels)
{
    const int part = (pixels / 4 + 7) / 8 * 8;
    return part < 8 ? (pixels < 8 ? pixels : 8) : part < pixels ? part : pixels;
}

float match_cost_rough(const struct matcher *m, int segment, struct plane plane, unsigned hidden)
{
    return ranked_cost(m, segment, fourth_of(m->segments->segments[segment].pixels), plane, hidden);
}

struct calibration {
    struct matcher *m;
    double least, most;
    float *best, *mean; /* raw costs over depths, of each segment in each neighbour; UNSEEN: it is not in sight */
};
#define UNSEEN 2.0f

static void calibrate_segments(void *ctx, size_t begin, size_t end, int thread)
{
    enum { DEPTHS = 48 };
    const struct calibration *job = ctx;
    const struct matcher *m = job->m;
    (void)thread;
    for (size_t i = begin; i < end; i++)
        for (int k = 0; k < m->neighbour_count; k++) {
            const int pixels = fourth_of(m->segments->segments[i].pixels);
            const size_t at = i * MAX_NEIGHBOURS + (size_t)k;
            double best = 1, sum = 0;
            int count = 0;
            for (int d = 0; d < DEPTHS; d++) {
                const struct plane plane = {0, 0, job->least + (job->most - job->least) * d / (DEPTHS - 1)};
                int seen;
                const double cost =
                    (double)neighbour_cost(m, &m->neighbours[k], m->first[i], m->first[i] + pixels, plane, &seen);
                if (2 * seen < pixels) continue;
                best = fmin(best, cost);
                sum += cost;
                count++;
            }
            job->best[at] = 2 * count >= DEPTHS ? (float)best : UNSEEN;
            job->mean[at] = 2 * count >= DEPTHS ? (float)(sum / count) : UNSEEN;
        }
}

/* Means over segments and the neighbours of which `use` has the bit. False: no segment is in sight of any. */
static bool mean_costs(const struct calibration *job, int begin, int end, unsigned use, double *good, double *random)
{
    int count = 0;
    *good = *random = 0;
    for (int i = begin; i < end; i++)
        for (int k = 0; k < job->m->neighbour_count; k++) {
            const size_t at = (size_t)i * MAX_NEIGHBOURS + (size_t)k;
            if (!(use >> k & 1) || !(job->best[at] < UNSEEN)) continue;
            *good += (double)job->best[at];
            *random += (double)job->mean[at];
            count++;
        }
    if (!count) return false;
    *good /= count;
    *random /= count;
    return true;
}

enum status matcher_calibrate(struct matcher *m, double least, double most, struct err *err)
{
    const int count = m->segments->count;
    const size_t costs = (size_t)count * MAX_NEIGHBOURS + 1;
    struct calibration job = {m, least, most, malloc(costs * sizeof(float)), malloc(costs * sizeof(float))};
    double good, random, contrast[MAX_NEIGHBOURS] = {0}, max_contrast = 0;
    m->unseen_cost = malloc(((size_t)count + 1) * sizeof *m->unseen_cost);
    m->occluded_cost = malloc(((size_t)count + 1) * sizeof *m->occluded_cost);
    enum status st = job.best && job.mean && m->unseen_cost && m->occluded_cost
                         ? ST_OK
                         : err_nomem(err, "costs of segments", costs * 2 * sizeof(float));
    if (!st) parallel_for((size_t)count, 32, calibrate_segments, &job);
    for (int k = 0; !st && k < m->neighbour_count; k++) {
        if (mean_costs(&job, 0, count, 1u << k, &good, &random)) contrast[k] = random - good;
        max_contrast = fmax(max_contrast, contrast[k]);
    }
    m->excluded = 0;
    for (int k = 0; k < m->neighbour_count; k++)
        if (contrast[k] < USEFUL_CONTRAST * max_contrast) m->excluded |= 1u << k;
    if (!st && mean_costs(&job, 0, count, ~m->excluded, &good, &random)) {
        m->good_cost = (float)good;
        m->chance_cost = (float)fmax(random, good + MIN_CONTRAST);
    }
    for (int i = 0; !st && i < count; i++) {
        m->unseen_cost[i] = UNSEEN_COST;
        m->occluded_cost[i] = HIDDEN_COST;
        if (!mean_costs(&job, i, i + 1, ~m->excluded, &good, &random)) continue;
        const float best = ((float)good - m->good_cost) / (m->chance_cost - m->good_cost);
        const float spread = (float)(random - good) / (m->chance_cost - m->good_cost);
        m->unseen_cost[i] = fminf(UNSEEN_COST, best + UNSEEN_COST * spread);
        m->occluded_cost[i] = fminf(HIDDEN_COST, best + HIDDEN_COST * spread);
    }
    free(job.best);
    free(job.mean);
    return st;
}

double matcher_shift(const struct matcher *m, double least, double most)
{
    enum { GRID = 7, STEPS = 8 };
    double largest = 0;
    for (int k = 0; k < m->neighbour_count; k++) {
        double paths[GRID * GRID];
        int count = 0;
        for (int g = 0; g < GRID * GRID; g++) {
            double u = (g % GRID + 0.5) / GRID * m->segments->width,
                   v = (double)(g / GRID + 0.5) / GRID * m->segments->height;
            double path = 0, pu = 0, pv = 0, nu, nv;
            bool had = false;
            for (int i = 0; i <= STEPS; i++) {
                bool has = carry(&m->neighbours[k], u, v, least + (most - least) * i / STEPS, &nu, &nv);
                /* only where the neighbour could see it: behind its frame shifts grow without bound */
                has = has && nu >= 0 && nv >= 0 && nu <= m->neighbours[k].width && nv <= m->neighbours[k].height;
                if (had && has) path += hypot(nu - pu, nv - pv);
                had = has;
                pu = nu;
                pv = nv;
            }
            if (path > 0) paths[count++] = path;
        }
        if (!count) continue;
        sort_doubles(paths, (size_t)count);
        largest = fmax(largest, paths[count * 3 / 4]);
    }
    return largest;
}

#define PREFETCHED 64 /* px: a larger segment would push out of the cache what it fetched */

void match_prefetch(const struct matcher *m, int segment, struct plane plane)
{
    const struct segment *g = &m->segments->segments[segment];
    const double d = plane_at(plane, g->cx, g->cy);
    if (g->x1 - g->x0 > PREFETCHED || g->y1 - g->y0 > PREFETCHED) return;
    for (int k = 0; k < m->neighbour_count; k++) {
        const struct match_neighbour *n = &m->neighbours[k];
        double p[3];
        if (m->excluded >> k & 1) continue;
        for (int i = 0; i < 3; i++)
            p[i] = n->base[i][0] * g->cx + n->base[i][1] * g->cy + n->base[i][2] + n->shift[i] * d;
        if (!(p[2] > 1e-9)) continue;
        const float u = (float)(p[0] / p[2]), v = (float)(p[1] / p[2]);
        if (!(u >= 0 && v >= 0 && u < (float)n->width && v < (float)n->height)) continue;
        const int half_h = (g->y1 - g->y0) / 2 + 1, half_w = (g->x1 - g->x0) / 2 + 1;
        const int y0 = inside((int)v - half_h, n->height), y1 = inside((int)v + half_h, n->height);
        const int x0 = inside((int)u - half_w, n->width), x1 = inside((int)u + half_w + 1, n->width);
        for (int y = y0; y <= y1; y++) {
            const uint8_t *row = n->texture + ((size_t)y * (size_t)(n->width + 1)) * 2 * CHANNELS;
            for (int x = x0; x <= x1 + 3; x += 4)
                _mm_prefetch((const char *)(row + (size_t)x * 2 * CHANNELS), _MM_HINT_T0);
        }
    }
}
