/* fill.c - texture for the texels that no view shows, as shifted copies of the same face.
 *
 * Floors and walls repeat themselves: boards, bricks, cloth. The offsets between similar patches of such a picture are
 * few [He 2012]. So each hole, a set of 4-connected unseen texels, takes the differences of its neighbours from texels
 * that lie a constant shift away on the face, and at most FILL_SHIFTS shifts serve a hole. A shift is on the face, not
 * in the raster: in a tile in perspective the copy is foreshortened as its new place is.
 *
 * The cost of a shift is the variance of the difference between the clean texels around the hole and those a shift
 * away, so that boards continue where they are. A constant difference costs nothing: the composite is of differences.
 * Shifts on a jittered lattice are tried, and each is moved to the least cost nearby by halved steps. The shift of
 * least cost per share of the hole that it leads to clean texels is taken first, then the next for the rest.
 * Clean texels only are read: not those beside what hides the face, which hold its shadow and rim.
 *
 * What differs from the source: shifts come from the rim of the hole, not from all pairs of patches; and a texel takes
 * the first shift that serves it, not one by a graph cut, since the gradient solver joins the copies. */
#include "common/texture/fill.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/sort.h"

enum { SAMPLES = 192, LATTICE = 12, TRIED = (2 * LATTICE + 1) * (2 * LATTICE + 1), BAND = 12, MIN_TEXELS = 64 };
static const float MAX_COST = 0.02f; /* variance, squared display units: nothing similar is there */
static const float MARGIN = 0.02f;   /* display units */
static const double OUTER = 0.06;    /* of the rim's texels */
static const float MAX_STEP = 0.15f; /* display units: between a seen texel and the copy of its place */
static const double MIN_COVER = 0.05;

struct search {
    const struct texture_fill *f;
    struct vec3 u, v; /* one texel on the face, at the hole */
    size_t rim[SAMPLES], inside[SAMPLES];
    float low[3], high[3]; /* range of the rim's colours, in which copies must lie */
    int rim_count, inside_count;
    bool covered[SAMPLES];
};

/* The value that lies `shift` from a texel. */
static bool shifted_value(float out[3], const struct texture_fill *f, size_t at, struct vec3 shift)
{
    const int width = f->tile->raster.width, height = f->tile->raster.height;
    struct vec3 p;
    if (!bake_tile_point(&p, f->tile, (double)(at % (size_t)width) + 0.5, (double)(at / (size_t)width) + 0.5))
        return false;
    p = vec3_add(p, shift);
    double h[3];
    for (int k = 0; k < 3; k++) {
        const double *m = f->tile->matrix[k];
        h[k] = m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3];
    }
    if (!(h[2] > 0)) return false;
    const double x = h[0] / h[2] - 0.5, y = h[1] / h[2] - 0.5;
    if (!(x >= 0 && y >= 0 && x < width - 1 && y < height - 1)) return false;
    const size_t corner = (size_t)y * (size_t)width + (size_t)x, below = corner + (size_t)width;
    if (!f->clean[corner] || !f->clean[corner + 1] || !f->clean[below] || !f->clean[below + 1]) return false;
    const float a = (float)(x - floor(x)), b = (float)(y - floor(y));
    for (size_t k = 0; k < 3; k++) {
        const float *top = f->value + 3 * corner + k, *low = f->value + 3 * below + k;
        out[k] = (1 - b) * ((1 - a) * top[0] + a * top[3]) + b * ((1 - a) * low[0] + a * low[3]);
    }
    return true;
}

static struct vec3 shift_of(const struct search *s, double a, double b)
{
    return vec3_add(vec3_scale(s->u, a), vec3_scale(s->v, b));
}

static float cost_of(const struct search *s, struct vec3 shift)
{
    double sum[3] = {0}, squares = 0;
    int count = 0;
    for (int i = 0; i < s->rim_count; i++) {
        float there[3];
        if (!shifted_value(there, s->f, s->rim[i], shift)) continue;
        count++;
        for (int k = 0; k < 3; k++) {
            const double d = there[k] - s->f->value[3 * s->rim[i] + (size_t)k];
            sum[k] += d;
            squares += d * d;
        }
    }
    if (count < 16 || 3 * count < s->rim_count) return FLT_MAX;
    for (int k = 0; k < 3; k++) squares -= sum[k] * sum[k] / count;
    return (float)(fmax(0, squares) / count);
}

/* The range of the colours around a hole, without OUTER at either end: a small picture that hangs there is left out. */
static void find_colours(struct search *s)
{
    float values[SAMPLES];
    const size_t count = (size_t)s->rim_count, outer = (size_t)(OUTER * (double)(count - 1));
    for (size_t k = 0; k < 3; k++) {
        for (size_t i = 0; i < count; i++) values[i] = s->f->value[3 * s->rim[i] + k];
        sort_floats(values, count);
        s->low[k] = values[outer] - MARGIN;
        s->high[k] = values[count - 1 - outer] + MARGIN;
    }
}

/* Whether a copy has a colour as around the hole: a picture on a wall does not, and is not copied. */
static bool fits(const struct search *s, float value[3], size_t at, struct vec3 shift)
{
    if (!shifted_value(value, s->f, at, shift)) return false;
    for (int k = 0; k < 3; k++)
        if (value[k] < s->low[k] || value[k] > s->high[k]) return false;
    return true;
}

/* The share of the hole that the shift serves and no earlier one does. */
static double cover_of(const struct search *s, struct vec3 shift)
{
    int count = 0;
    float value[3];
    for (int i = 0; i < s->inside_count; i++) count += !s->covered[i] && fits(s, value, s->inside[i], shift);
    return (double)count / s->inside_count;
}

/* A number in -0.5 to 0.5 from an index, the same on every machine. */
static double jitter(uint32_t i)
{
    i = (i ^ (i >> 15)) * 0x2c1b3c6du;
    i = (i ^ (i >> 12)) * 0x297a2d39u;
    return (double)((i ^ (i >> 15)) >> 8) / 16777216.0 - 0.5;
}

static float refine(const struct search *s, double *a, double *b, double step, float cost)
{
    for (; step >= 0.25; step /= 2)
        for (int k = 0; k < 4; k++) {
            const double x = *a + (k == 0 ? step : k == 1 ? -step : 0), y = *b + (k == 2 ? step : k == 3 ? -step : 0);
            const float next = cost_of(s, shift_of(s, x, y));
            if (next < cost) cost = next, *a = x, *b = y;
        }
    return cost;
}

static enum status search_shifts(const struct search *start, struct fill_hole *hole, double extent, struct err *err)
{
    struct search s = *start;
    struct {
        struct vec3 shift;
        float cost;
    } *tried = malloc(TRIED * sizeof *tried);
    if (!tried) return err_nomem(err, "shifts of a texture", TRIED * sizeof *tried);
    const double step = exp2(ceil(log2(fmax(1, 2 * extent / LATTICE)))); /* refined steps stay whole for long */
    for (int i = 0; i < TRIED; i++) {
        double a = (i % (2 * LATTICE + 1) - LATTICE) * step + round(jitter(2 * (uint32_t)i) * step);
        double b = (i / (2 * LATTICE + 1) - LATTICE) * step + round(jitter(2 * (uint32_t)i + 1) * step);
        tried[i].cost = FLT_MAX;
        if (cover_of(&s, shift_of(&s, a, b)) < MIN_COVER) continue;
        tried[i].cost = cost_of(&s, shift_of(&s, a, b));
        if (tried[i].cost < FLT_MAX) tried[i].cost = refine(&s, &a, &b, step / 2, tried[i].cost);
        tried[i].shift = shift_of(&s, a, b);
    }
    while (hole->shifts < FILL_SHIFTS) {
        int best = -1;
        double least = DBL_MAX;
        for (int i = 0; i < TRIED; i++) {
            if (tried[i].cost > MAX_COST) continue;
            const double cover = cover_of(&s, tried[i].shift);
            if (cover < MIN_COVER || (tried[i].cost + 1e-6) / cover >= least) continue;
            least = (tried[i].cost + 1e-6) / cover;
            best = i;
        }
        if (best < 0) break;
        float value[3];
        for (int i = 0; i < s.inside_count; i++)
            s.covered[i] = s.covered[i] || fits(&s, value, s.inside[i], tried[best].shift);
        hole->shift[hole->shifts++] = tried[best].shift;
    }
    free(tried);
    return ST_OK;
}

/* Every so many of the texels, SAMPLES at most. */
static int take_samples(size_t *out, const int32_t *list, size_t count)
{
    const size_t taken = count < SAMPLES ? count : SAMPLES;
    for (size_t i = 0; i < taken; i++) out[i] = (size_t)list[i * count / taken];
    return (int)taken;
}

/* Clean texels within BAND of the box of a hole that lie near one of its texels, in the order of the raster. */
static size_t list_rim(int32_t *out, const struct texture_fill *f, const int box[4], int hole, int band)
{
    const int width = f->tile->raster.width, height = f->tile->raster.height;
    size_t count = 0;
    for (int y = box[1] - band; y <= box[3] + band; y++)
        for (int x = box[0] - band; x <= box[2] + band; x++) {
            if (x < 0 || y < 0 || x >= width || y >= height || !f->clean[(size_t)y * (size_t)width + (size_t)x])
                continue;
            bool near = false;
            for (int k = 0; k < 8 && !near; k++) {
                static const int dx[8] = {1, -1, 0, 0, 1, 1, -1, -1}, dy[8] = {0, 0, 1, -1, 1, -1, 1, -1};
                for (int d = band / 2; d <= band && !near; d += band / 2) {
                    const int u = x + d * dx[k], v = y + d * dy[k];
                    near = u >= 0 && v >= 0 && u < width && v < height && f->hole[v * width + u] == hole;
                }
            }
            if (near) out[count++] = y * width + x;
        }
    return count;
}

static enum status fill_hole(struct texture_fill *f, int index, const int32_t *list, size_t count, struct vec3 normal,
                             int32_t *rim, struct err *err)
{
    const int width = f->tile->raster.width;
    int box[4] = {INT32_MAX, INT32_MAX, 0, 0};
    for (size_t i = 0; i < count; i++) {
        const int x = list[i] % width, y = list[i] / width;
        box[0] = x < box[0] ? x : box[0], box[1] = y < box[1] ? y : box[1];
        box[2] = x > box[2] ? x : box[2], box[3] = y > box[3] ? y : box[3];
    }
    struct search s = {.f = f};
    struct vec3 p, q;
    const double x = list[count / 2] % width + 0.5, y = list[count / 2] / width + 0.5;
    if (!bake_tile_point(&p, f->tile, x, y) || !bake_tile_point(&q, f->tile, x + 1, y)) return ST_OK;
    s.u = vec3_sub(q, p);
    s.v = vec3_cross(normal, s.u);
    s.inside_count = take_samples(s.inside, list, count);
    s.rim_count = take_samples(s.rim, rim, list_rim(rim, f, box, index, BAND));
    if (s.rim_count < 16) return ST_OK;
    find_colours(&s);
    struct fill_hole *hole = &f->holes[index];
    const int wide = box[2] - box[0], high = box[3] - box[1];
    search_shifts(&s, hole, (wide > high ? wide : high) + 2 * BAND, err);
    for (size_t i = 0; i < count; i++) {
        float value[3];
        int k = 0;
        while (k < hole->shifts && !fits(&s, value, (size_t)list[i], hole->shift[k])) k++;
        f->choice[list[i]] = (uint8_t)(k < hole->shifts ? k : FILL_SHIFTS);
    }
    return err->status;
}

/* Lists the hole that holds `first`. */
static size_t list_hole(struct texture_fill *f, const uint8_t *unseen, int32_t first, int index, int32_t *list)
{
    const int width = f->tile->raster.width, height = f->tile->raster.height;
    size_t count = 0;
    f->hole[first] = index;
    list[count++] = first;
    for (size_t i = 0; i < count; i++) {
        const int32_t at = list[i];
        const int x = at % width, y = at / width;
        const int32_t around[4] = {x > 0 ? at - 1 : -1, x + 1 < width ? at + 1 : -1, y > 0 ? at - width : -1,
                                   y + 1 < height ? at + width : -1};
        for (int k = 0; k < 4; k++) {
            if (around[k] < 0 || !unseen[around[k]] || f->hole[around[k]] >= 0) continue;
            f->hole[around[k]] = index;
            list[count++] = around[k];
        }
    }
    return count;
}

enum status texture_fill_find(struct texture_fill *f, const struct bake_tile *tile, struct vec3 normal,
                              const uint8_t *unseen, const uint8_t *clean, const float *value, struct err *err)
{
    const size_t n = (size_t)tile->raster.width * (size_t)tile->raster.height;
    *f = (struct texture_fill){.tile = tile, .value = value, .clean = clean};
    f->hole = malloc(n * sizeof *f->hole);
    f->choice = malloc(n);
    f->holes = calloc(n / MIN_TEXELS + 1, sizeof *f->holes);
    int32_t *list = malloc(2 * n * sizeof *list);
    if (!f->hole || !f->choice || !f->holes || !list) err_nomem(err, "the holes of a tile", 8 * n);
    for (size_t i = 0; !err->status && i < n; i++) f->hole[i] = -1, f->choice[i] = FILL_SHIFTS;
    for (size_t i = 0; !err->status && i < n; i++) {
        if (!unseen[i] || f->hole[i] >= 0) continue;
        const size_t count = list_hole(f, unseen, (int32_t)i, f->hole_count, list);
        if (count >= MIN_TEXELS)
            fill_hole(f, f->hole_count++, list, count, normal, list + n, err);
        else /* too small for texture */
            for (size_t k = 0; k < count; k++) f->hole[list[k]] = INT32_MAX;
    }
    free(list);
    return err->status;
}

/* Whether the copy beside a seen texel is like it: otherwise an edge of the copy would show there. */
static bool joins(const struct texture_fill *f, size_t at, const float copy[3])
{
    if (f->hole[at] >= 0) return true;
    for (size_t k = 0; k < 3; k++)
        if (fabsf(copy[k] - f->value[3 * at + k]) > MAX_STEP) return false;
    return true;
}

bool texture_fill_copy(float copy[3], const struct texture_fill *f, size_t at, size_t of)
{
    if (f->choice[at] == FILL_SHIFTS) return false;
    return shifted_value(copy, f, of, f->holes[f->hole[at]].shift[f->choice[at]]);
}

bool texture_fill_difference(float difference[3], const struct texture_fill *f, size_t at, size_t next)
{
    if (f->choice[at] == FILL_SHIFTS) return false;
    if (f->hole[next] >= 0 && f->choice[next] == FILL_SHIFTS) return false; /* its copy does not fit in here */
    const struct vec3 shift = f->holes[f->hole[at]].shift[f->choice[at]];
    float here[3], there[3];
    if (!shifted_value(here, f, at, shift) || !shifted_value(there, f, next, shift)) return false;
    if (!joins(f, next, there)) return false;
    for (int k = 0; k < 3; k++) difference[k] = there[k] - here[k];
    return true;
}

void texture_fill_release(struct texture_fill *f)
{
    free(f->hole);
    free(f->choice);
    free(f->holes);
}
