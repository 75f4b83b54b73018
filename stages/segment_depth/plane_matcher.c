/* plane_matcher.c - preparation of a view and its neighbours for matching.
 *
 * A matcher holds what plane_match.c needs for every cost, in the order in which it needs it.
 *
 * The view. Features are stored segment by segment, every fourth pixel first, which are those of the rough cost,
 * padded to groups of eight with pixels of weight 0. Within a group weights are in the order of the sums over lanes.
 *
 * Weights. Near an edge of its segment a pixel's gradients are those of the edge, which moves with the surface in
 * front; the surface behind would match at that surface's depth. So a pixel with a colour difference D from a pixel
 * of another segment within 2 px, less where that is farther, counts 1 / (1 + (D / 15)^2) of a full one. Weights by
 * colour are those of [Yoon 2006], which compares with the middle of a window and has no segments.
 *
 * A neighbour is halved while its pixels are more than 1.6 times as fine as the view's at a typical depth, so that
 * both pictures have the same detail. Its colours are multiplied by the median ratio over the sparse points that
 * both see, if they are well exposed and at least twelve, else by that of what both pictures show, if that is clear, or
 * by the ratio of exposures. Its gradients are turned
 * to the view's axes: they are covectors and transform by the transposed Jacobian of the map between the pictures.
 *
 * The map of a pixel at depth z is p' ~ K' (R K^-1 p + t / z): base and shift of struct match_neighbour.
 *
 * A neighbour's texture interleaves the bytes of a pixel with those of the pixel below it, so that 32 bytes from one
 * address hold the four corners of a bilinear sample of all channels.
 *
 * Memory: about 45 bytes a pixel of the view, and 16 a pixel of each neighbour. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/sort.h"
#include "common/math/numbers.h"
#include "stages/segment_depth/match_features.h"
#include "stages/segment_depth/plane_match.h"

#define EDGE_REACH      2    /* px */
#define EDGE_FALLOFF    0.5  /* per px: how much less a more distant edge matters */
#define EDGE_DIFFERENCE 15.0 /* grey levels: colour difference that halves a pixel's weight */

/* Weight of a pixel. Near an edge of its segment the gradients are those of the edge, which moves with the surface in
 * front; the surface behind would match at that surface's depth. So a pixel counts less, the more its colour differs
 * from a nearby pixel of another segment. */
static int edge_weight(const struct segmentation *s, const uint8_t *packed, int pixel)
{
    const int x = pixel % s->width, y = pixel / s->width;
    const uint8_t *own = packed + (size_t)pixel * FEATURE_CHANNELS;
    double strongest = 0;
    for (int j = -EDGE_REACH; j <= EDGE_REACH; j++)
        for (int i = -EDGE_REACH; i <= EDGE_REACH; i++) {
            const int other = clamp_int(y + j, 0, s->height - 1) * s->width + clamp_int(x + i, 0, s->width - 1);
            if (s->label[other] == s->label[pixel]) continue;
            const uint8_t *theirs = packed + (size_t)other * FEATURE_CHANNELS;
            int difference = 0;
            for (int c = 0; c < 3; c++) {
                const int d = abs(own[c] - theirs[c]);
                difference = d > difference ? d : difference;
            }
            strongest = fmax(strongest, difference / (1 + EDGE_FALLOFF * (hypot(i, j) - 1)));
        }
    const int weight =
        (int)(MATCH_FULL_WEIGHT / (1 + strongest * strongest / (EDGE_DIFFERENCE * EDGE_DIFFERENCE)) + 0.5);
    return weight < 1 ? 1 : weight;
}

static void put_pixel(struct matcher *m, int i, int pixel, const uint8_t *packed, int weight)
{
    static const int lane[8] = {0, 4, 1, 5, 2, 6, 3, 7}; /* the order of neighbour_cost()'s sums */
    m->weight[(i & ~7) + lane[i & 7]] = weight;
    m->x[i] = (float)(pixel % m->segments->width) + 0.5f;
    m->y[i] = (float)(pixel / m->segments->width) + 0.5f;
    for (int c = 0; c < FEATURE_CHANNELS; c++)
        m->features[i * FEATURE_CHANNELS + c] = (int16_t)(FEATURE_UNIT * packed[c]);
}

enum status matcher_init(struct matcher *m, const struct segmentation *s, const struct gamma_image *reference,
                         const struct segment_params *params, struct err *err)
{
    const double gain[3] = {1, 1, 1};
    double jacobian[2][2] = {{1, 0}, {0, 1}};
    size_t room = 0;
    *m = (struct matcher){
        .params = params, .segments = s, .good_cost = 0, .chance_cost = 1, .noise = match_image_noise(reference)};
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
    m->features = aligned_alloc(32, (room + 8) * FEATURE_CHANNELS * sizeof *m->features);
    const size_t pixels = (size_t)s->width * (size_t)s->height;
    m->raster = calloc(pixels + 8, FEATURE_CHANNELS * sizeof *m->raster);
    m->edge = malloc(pixels);
    uint8_t *packed = match_features(reference, gain, jacobian, m->noise);
    if (!m->raster || !m->edge || !m->x || !m->y || !m->weight || !m->features || !packed) {
        free(packed);
        return err_nomem(err, "the pixels of a matcher", room * 24);
    }
    for (size_t i = 0; i < pixels * FEATURE_CHANNELS; i++) m->raster[i] = (int16_t)(FEATURE_UNIT * packed[i]);
    for (size_t i = 0; i < pixels; i++) m->edge[i] = s->label[i] < 0 ? 0 : (uint8_t)edge_weight(s, packed, (int)i);
    for (int k = 0; k < s->count; k++) {
        const int *pixel = s->pixel + s->segments[k].first, count = s->segments[k].pixels;
        int i = m->first[k];
        for (int part = 0; part < 2; part++) /* every fourth pixel first, for match_cost_rough() */
            for (int n = 0; n < count; n++)
                if ((pixel[n] % s->width % 2 || pixel[n] / s->width % 2) == part)
                    put_pixel(m, i++, pixel[n], packed + (size_t)pixel[n] * FEATURE_CHANNELS, m->edge[pixel[n]]);
        for (; i < m->first[k + 1]; i++) {
            put_pixel(m, i, pixel[0], packed + (size_t)pixel[0] * FEATURE_CHANNELS, 0);
            m->features[i * FEATURE_CHANNELS + 7] = -FEATURE_UNIT * 128; /* padding: never visible */
        }
    }
    free(packed);
    return ST_OK;
}

void matcher_homography(double base[3][3], double shift_out[3], const struct view *view, const struct view *other)
{
    /* p' = K' (R K^-1 [u v 1] + T / z) */
    struct mat3 r = mat3_multiply(other->cam_from_world, mat3_transpose(view->cam_from_world));
    struct vec3 t = vec3_sub(other->translation, mat3_apply(r, view->translation));
    const double shift[3] = {t.x, t.y, t.z};
    double rotated[3][3];
    for (int i = 0; i < 3; i++) {
        rotated[i][0] = r.m[i][0] / view->fx;
        rotated[i][1] = r.m[i][1] / view->fy;
        rotated[i][2] = r.m[i][2] - r.m[i][0] * view->cx / view->fx - r.m[i][1] * view->cy / view->fy;
    }
    for (int j = 0; j < 3; j++) {
        base[0][j] = other->fx * rotated[0][j] + other->cx * rotated[2][j];
        base[1][j] = other->fy * rotated[1][j] + other->cy * rotated[2][j];
        base[2][j] = rotated[2][j];
    }
    shift_out[0] = other->fx * shift[0] + other->cx * shift[2];
    shift_out[1] = other->fy * shift[1] + other->cy * shift[2];
    shift_out[2] = shift[2];
}

static bool well_exposed(const float mine[3], const float theirs[3])
{
    for (int c = 0; c < 3; c++)
        if (!(mine[c] > 0.05f && mine[c] < 0.97f && theirs[c] > 0.05f && theirs[c] < 0.97f)) return false;
    return true;
}

#define GAIN_GRID   24   /* pixels of the view in each direction that are compared */
#define MIN_COMMON  60   /* of them in the neighbour's frame */
#define SAME_RATIO  1.15 /* of the largest to the smallest ratio of quartiles */
#define CLEAR_RATIO 1.25 /* by which a gain must differ from what the exposures say */

/* The ratio of the median colours of what both pictures show, if all of it lies at one typical depth: it depends little
 * on which pixel falls on which. False: they share too little, or other things: light changes all quartiles by one
 * ratio; or the ratio is about gain[]. */
static bool gains_of_pictures(double gain[3], const struct match_neighbour *map, const struct view *view,
                              const struct view *other, double typical, const struct gamma_image *reference,
                              const struct gamma_image *picture)
{
    double mine[3][GAIN_GRID * GAIN_GRID], theirs[3][GAIN_GRID * GAIN_GRID];
    int count = 0;
    for (int k = 0; k < GAIN_GRID * GAIN_GRID; k++) {
        const double u = (k % GAIN_GRID + 0.5) / GAIN_GRID * view->width,
                     v = (double)(k / GAIN_GRID + 0.5) / GAIN_GRID * view->height;
        double nu, nv;
        float a[3], b[3];
        if (!match_project(map, u, v, typical, &nu, &nv)) continue;
        if (!(nu >= 0 && nv >= 0 && nu < other->width && nv < other->height)) continue;
        if (!gamma_image_at(reference, u, v, a) || !gamma_image_at(picture, nu, nv, b) || !well_exposed(a, b)) continue;
        for (int c = 0; c < 3; c++) mine[c][count] = (double)a[c], theirs[c][count] = (double)b[c];
        count++;
    }
    if (count < MIN_COMMON) return false;
    double middle[3];
    bool differs = false;
    for (int c = 0; c < 3; c++) {
        double low = INFINITY, high = 0;
        sort_doubles(mine[c], (size_t)count);
        sort_doubles(theirs[c], (size_t)count);
        for (int q = 1; q < 4; q++) {
            const double ratio = mine[c][q * count / 4] / theirs[c][q * count / 4];
            low = fmin(low, ratio);
            high = fmax(high, ratio);
            if (q == 2) middle[c] = ratio;
        }
        if (!(high <= SAME_RATIO * low)) return false;
        differs = differs || middle[c] > CLEAR_RATIO * gain[c] || middle[c] * CLEAR_RATIO < gain[c];
    }
    if (!differs) return false;
    memcpy(gain, middle, sizeof middle);
    return true;
}

#define SURE_POINTS 12 /* that both views observed, for their median ratio to be used */

/* Median ratio of the view's colours to the neighbour's, at the points that both observed; if these are too few, that
 * of the whole pictures. */
static enum status estimate_gains(double gain[3], const struct match_neighbour *map, const struct camera_set *set,
                                  const struct view *view, const struct view *other, int neighbour_idx, double typical,
                                  const struct observed_points *seen, const struct gamma_image *reference,
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
        if (!well_exposed(mine, theirs)) continue;
        for (int c = 0; c < 3; c++) ratios[c * seen->count + count] = (double)mine[c] / (double)theirs[c];
        count++;
    }
    for (int c = 0; c < 3; c++) {
        double *r = ratios + (size_t)c * (size_t)seen->count;
        sort_doubles(r, (size_t)count);
        gain[c] = count >= SURE_POINTS ? r[count / 2] : same_light;
    }
    if (count < SURE_POINTS) gains_of_pictures(gain, map, view, other, typical, reference, picture);
    for (int c = 0; c < 3; c++) gain[c] = clamp(gain[c], 0.25 * same_light, 4 * same_light);
    free(ratios);
    return ST_OK;
}

/* Interleaves rows y and y + 1. The last column is repeated, and the end padded, for 32-byte loads. */
static enum status make_texture(struct match_neighbour *n, const uint8_t *packed, struct err *err)
{
    size_t w = (size_t)n->width, h = (size_t)n->height, size = (w + 1) * h * 2 * FEATURE_CHANNELS + 32;
    n->texture = calloc(size, 1);
    if (!n->texture) return err_nomem(err, "a texture to match with", size);
    for (size_t y = 0; y < h; y++)
        for (size_t x = 0; x <= w; x++) {
            size_t column = x < w ? x : w - 1, below = y + 1 < h ? y + 1 : y;
            uint8_t *to = n->texture + (y * (w + 1) + x) * 2 * FEATURE_CHANNELS;
            for (size_t c = 0; c < FEATURE_CHANNELS; c++) {
                to[2 * c] = packed[(y * w + column) * FEATURE_CHANNELS + c];
                to[2 * c + 1] = packed[(below * w + column) * FEATURE_CHANNELS + c];
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
    double jacobian[2][2] = {{1, 0}, {0, 1}}, gain[3], u0, v0, ux, vx, uy, vy;
    double u = view->width / 2.0, v = view->height / 2.0;
    matcher_homography(n->base, n->shift, view, &other);
    if (estimate_gains(gain, n, set, view, &other, neighbour_idx, typical, seen, reference, picture, err))
        return err->status;
    for (;;) {
        matcher_homography(n->base, n->shift, view, &other);
        if (!match_project(n, u, v, typical, &u0, &v0) || !match_project(n, u + 1, v, typical, &ux, &vx) ||
            !match_project(n, u, v + 1, typical, &uy, &vy))
            break;
        jacobian[0][0] = ux - u0; /* gradients are covectors: they transform by the transposed Jacobian */
        jacobian[0][1] = vx - v0;
        jacobian[1][0] = uy - u0;
        jacobian[1][1] = vy - v0;
        double scale = sqrt(fabs(jacobian[0][0] * jacobian[1][1] - jacobian[0][1] * jacobian[1][0]));
        if (!(scale > 1.6) || picture->width < 2 || picture->height < 2) break;
        if (gamma_image_halve(picture, err)) return err->status;
        other = view_halved(other, picture->width, picture->height);
    }
    n->width = picture->width;
    n->height = picture->height;
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++) jacobian[i][j] = clamp(jacobian[i][j], -2, 2);
    uint8_t *packed = match_features(picture, gain, jacobian, m->noise);
    if (!packed) return err_nomem(err, "a picture to match with", (size_t)n->width * (size_t)n->height * 20);
    make_texture(n, packed, err);
    free(packed);
    if (!err->status) m->neighbour_count++;
    return err->status;
}

void matcher_take(struct matcher *m, struct matcher *half)
{
    m->excluded = half->excluded;
    m->good_cost = half->good_cost;
    m->chance_cost = half->chance_cost;
    m->use = half->use;
    m->out_of_view_cost = half->out_of_view_cost;
    m->occluded_cost = half->occluded_cost;
    half->use = NULL;
    half->out_of_view_cost = half->occluded_cost = NULL;
}

void matcher_release(struct matcher *m)
{
    if (!m) return;
    for (int i = 0; i < m->neighbour_count; i++) free(m->neighbours[i].texture);
    free(m->out_of_view_cost);
    free(m->occluded_cost);
    free(m->first);
    free(m->x);
    free(m->y);
    free(m->features);
    free(m->weight);
    free(m->raster);
    free(m->edge);
    free(m->use);
    *m = (struct matcher){0};
}
