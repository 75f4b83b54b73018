/* field_sky.c - see field_sky.h.
 *
 * Overview. A sun of half a degree is 1e-5 of the hemisphere and may give most of a room's light. Rays that go anywhere
 * miss it, so an estimator must know its cone. Suns are the connected sets of pixels above BRIGHT times the median
 * luminance of the sphere, a pixel counting by its solid angle; columns wrap around. The cone's axis is the mean
 * direction, weighted by luminance and solid angle. Its angle takes in the farthest pixel and one pixel more, because a
 * look-up is bilinear between pixels.
 *
 * The suns add no light: they only say where to look. A gather finds in them what the picture holds, so that the energy
 * is the picture's, whatever shape and limb a sun has there. */
#include "common/gather/field_sky.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/image/luminance.h"
#include "common/math/numbers.h"
#include "common/math/weighted.h"

enum { SHARE = 64 }; /* rows and columns of a picture that the median and means are taken from, at least */
static const double BRIGHT = 20, WIDEST = 30 * DEGREE;

static double luminance_at(const struct outdoors *o, size_t pixel) { return luminance_precise(o->rgb + 3 * pixel); }

/* Solid angle of a pixel of a row. */
static double solid_angle(const struct outdoors *o, int y)
{
    return (sin(PI / 2 - PI * y / o->height) - sin(PI / 2 - PI * (y + 1) / o->height)) * 2 * PI / o->width;
}

static int stride_of(const struct outdoors *o) { return o->height < 2 * SHARE ? 1 : o->height / SHARE; }

static enum status find_median(struct field_sky *s, const struct outdoors *o, struct err *err)
{
    const int stride = stride_of(o);
    const size_t most = ((size_t)o->height / (size_t)stride + 1) * ((size_t)o->width / (size_t)stride + 1);
    struct weighted *values = malloc(most * sizeof *values);
    size_t count = 0;
    if (!values) return err_nomem(err, "luminances of the outdoors", most * sizeof *values);
    for (int y = stride / 2; y < o->height; y += stride)
        for (int x = stride / 2; x < o->width; x += stride)
            values[count++] =
                (struct weighted){luminance_at(o, (size_t)y * (size_t)o->width + (size_t)x), solid_angle(o, y)};
    s->median = weighted_percentile(values, count, 0.5);
    s->bright = BRIGHT * s->median;
    free(values);
    return ST_OK;
}

double field_sky_mean(const struct field_sky *s, const struct outdoors *o, struct vec3 normal)
{
    const int stride = stride_of(o);
    double sum = 0, weights = 0;
    for (int y = stride / 2; y < o->height; y += stride)
        for (int x = stride / 2; x < o->width; x += stride) {
            const double cosine = -vec3_dot(normal, outdoors_direction(o, x + 0.5, y + 0.5));
            const double weight = cosine > 0 ? cosine * solid_angle(o, y) : 0;
            const double luminance = luminance_at(o, (size_t)y * (size_t)o->width + (size_t)x);
            sum += weight * (luminance > s->bright ? s->bright : luminance);
            weights += weight;
        }
    return weights > 0 ? sum / weights : 0;
}

/* ------------------------------------------------------------------------------------------------------------- suns */

struct flood {
    const struct outdoors *o;
    double bright;
    uint8_t *seen;
    size_t *stack; /* of pixels; grows */
    size_t count, capacity;
};

static enum status push(struct flood *f, int x, int y, struct err *err)
{
    if (y < 0 || y >= f->o->height) return ST_OK;
    x = (x + f->o->width) % f->o->width;
    const size_t at = (size_t)y * (size_t)f->o->width + (size_t)x;
    if (f->seen[at] || !(luminance_at(f->o, at) > f->bright)) return ST_OK;
    if (f->count == f->capacity) {
        const size_t wanted = 2 * f->capacity + 1024;
        size_t *more = realloc(f->stack, wanted * sizeof *more);
        if (!more) return err_nomem(err, "a bright part of the outdoors", wanted * sizeof *more);
        f->stack = more;
        f->capacity = wanted;
    }
    f->seen[at] = 1;
    f->stack[f->count++] = at;
    return ST_OK;
}

/* Collects the bright pixels connected with one: f->stack holds them afterwards. */
static enum status flood(struct flood *f, size_t from, struct err *err)
{
    const size_t width = (size_t)f->o->width;
    f->count = 0;
    push(f, (int)(from % width), (int)(from / width), err);
    for (size_t i = 0; !err->status && i < f->count; i++) {
        const int x = (int)(f->stack[i] % width), y = (int)(f->stack[i] / width);
        for (int k = 0; !err->status && k < 9; k++) push(f, x + k % 3 - 1, y + k / 3 - 1, err);
    }
    return err->status;
}

static struct vec3 direction_of(const struct outdoors *o, size_t pixel)
{
    return outdoors_direction(o, (double)(pixel % (size_t)o->width) + 0.5, (double)(pixel / (size_t)o->width) + 0.5);
}

static double angle_between(struct vec3 a, struct vec3 b)
{
    return atan2(vec3_length(vec3_cross(a, b)), vec3_dot(a, b));
}

/* The emitter that the collected pixels make. *light: its luminance times its solid angle. */
static struct emitter make_sun(const struct flood *f, double *light)
{
    struct emitter e = {.kind = EMITTER_SUN, .beta = PI / 2};
    struct vec3 sum = {0, 0, 0};
    double angle = 0;
    *light = 0;
    for (size_t i = 0; i < f->count; i++) {
        const double weight =
            luminance_at(f->o, f->stack[i]) * solid_angle(f->o, (int)(f->stack[i] / (size_t)f->o->width));
        sum = vec3_add(sum, vec3_scale(direction_of(f->o, f->stack[i]), weight));
        *light += weight;
    }
    e.normal = vec3_normalize(sum);
    for (size_t i = 0; i < f->count; i++) angle = fmax(angle, angle_between(e.normal, direction_of(f->o, f->stack[i])));
    angle += 1.5 * PI / f->o->height;
    e.cone = cos(fmin(angle, WIDEST));
    e.luminance = *light / (2 * PI * (1 - e.cone));
    return e;
}

static void insert(struct field_sky *s, double lights[MAX_SUNS], struct emitter sun, double light)
{
    int at = s->sun_count < MAX_SUNS ? s->sun_count++ : MAX_SUNS;
    if (at == MAX_SUNS && !(light > lights[--at])) return;
    for (; at > 0 && light > lights[at - 1]; at--) {
        s->suns[at] = s->suns[at - 1];
        lights[at] = lights[at - 1];
    }
    s->suns[at] = sun;
    lights[at] = light;
}

enum status field_sky_find(struct field_sky *s, const struct outdoors *o, struct err *err)
{
    const size_t pixels = (size_t)o->width * (size_t)o->height;
    double lights[MAX_SUNS] = {0};
    *s = (struct field_sky){0};
    if (!pixels || find_median(s, o, err)) return pixels ? err->status : ST_OK;
    struct flood f = {.o = o, .bright = s->bright, .seen = calloc(pixels, 1)};
    if (!f.seen) err_nomem(err, "a picture of the outdoors", pixels);
    for (size_t i = 0; !err->status && i < pixels; i++) {
        double light;
        if (f.seen[i] || !(luminance_at(o, i) > s->bright)) continue;
        if (flood(&f, i, err)) break;
        const struct emitter sun = make_sun(&f, &light);
        insert(s, lights, sun, light);
    }
    free(f.seen);
    free(f.stack);
    return err->status;
}
