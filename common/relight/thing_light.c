/* thing_light.c - see thing_light.h.
 *
 * Overview. Photos tell the mean radiance of each of six sides of a thing, not what its parts send out, and nothing of
 * what no photo shows: the surface is open there, and the floor below a table sees the back of its top. With the mean
 * everywhere the floor below and beside furniture is found too bright, and the contact shadow stays in part when the
 * furniture goes.
 *
 * So a thing has one albedo for each of its six sides, such that the light which these get in the room before the edit
 * gives the mean that photos show. Each triangle then sends out the albedo of its side times the light at its middle,
 * and its back does so with the light on the back. Light is gathered twice, since things light each other.
 *
 * Mathematics. With A the area of a triangle, E its irradiance and L the mean radiance of its side, the albedo of a
 * side is pi sum(A L) / sum(A E), at most 0.95. */
#include "common/relight/thing_light.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/gather/irradiance.h"
#include "common/math/numbers.h"
#include "common/relight/light_quotient.h"

enum { RAYS = 64, ROUNDS = 2, SIDES = 6 };

struct side_sum {
    struct rgb light, sent; /* area times irradiance, area times radiance */
};

struct gather_job {
    const struct thing_surfaces *s;
    const struct light_field *field;
    const uint64_t *key; /* of each triangle: the same before and after the edit */
    int first;
    struct rgb (*light)[2]; /* of both sides of each triangle */
};

static struct vec3 cross_of(const struct thing_surfaces *s, int i)
{
    const struct vec3 *p = s->triangles[i];
    return vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0]));
}

/* Which of the six sides of a thing a triangle belongs to. */
static int side_of(const struct thing_surfaces *s, int i)
{
    const struct vec3 c = cross_of(s, i);
    const double n[3] = {c.x, c.y, c.z};
    int k = fabs(n[1]) > fabs(n[0]);
    if (fabs(n[2]) > fabs(n[k])) k = 2;
    return 2 * k + (n[k] < 0);
}

static void gather_some(void *ctx, size_t begin, size_t end, int thread)
{
    const struct gather_job *j = ctx;
    (void)thread;
    for (size_t n = begin; n < end; n++) {
        const int i = j->first + (int)n;
        const struct vec3 *p = j->s->triangles[i], normal = vec3_normalize(cross_of(j->s, i));
        const struct vec3 middle = vec3_scale(vec3_add(vec3_add(p[0], p[1]), p[2]), 1.0 / 3);
        for (int side = 0; side < 2; side++) {
            const struct gather_point at = {middle, side ? vec3_scale(normal, -1) : normal};
            struct irradiance e;
            ray_irradiance(&e, j->field, at, RAYS, 2 * j->key[i] + (uint64_t)side);
            j->light[i][side] = e.value;
        }
    }
}

/* The number of each triangle within its thing, with the thing's. Copies of a thing have the numbers of the first. */
static void find_keys(uint64_t *key, const struct thing_surfaces *s, int first, const int *counts)
{
    for (int i = first, n = 0; i < s->count; i++, n++) {
        if (i > first && s->thing[i] != s->thing[i - 1]) n = 0;
        key[i] = ((uint64_t)s->thing[i] << 32) + (uint64_t)(n % counts[s->thing[i]]);
    }
}

static double albedo_of(double sent, double light)
{
    return light > 0 ? clamp(PI * sent / light, 0, LIGHT_ALBEDO_MAX) : 0;
}

static void find_albedos(struct rgb (*albedo)[SIDES], int things, const struct thing_surfaces *s,
                         const struct rgb (*given)[2], const struct rgb (*light)[2], struct side_sum *sums)
{
    memset(sums, 0, (size_t)things * SIDES * sizeof *sums);
    for (int i = 0; i < s->count; i++) {
        struct side_sum *sum = &sums[s->thing[i] * SIDES + side_of(s, i)];
        const double area = 0.5 * vec3_length(cross_of(s, i));
        sum->light = rgb_add(sum->light, rgb_scale(light[i][0], area));
        sum->sent = rgb_add(sum->sent, rgb_scale(given[i][0], area));
    }
    for (int k = 0; k < things * SIDES; k++)
        albedo[k / SIDES][k % SIDES] =
            rgb_make(albedo_of(sums[k].sent.r, sums[k].light.r), albedo_of(sums[k].sent.g, sums[k].light.g),
                     albedo_of(sums[k].sent.b, sums[k].light.b));
}

static void set_radiance(struct thing_surfaces *s, int first, const struct rgb (*albedo)[SIDES],
                         const struct rgb (*light)[2])
{
    for (int i = first; i < s->count; i++) {
        const struct rgb a = rgb_scale(albedo[s->thing[i]][side_of(s, i)], 1 / PI);
        for (int side = 0; side < 2; side++) s->radiance[i][side] = rgb_multiply(a, light[i][side]);
    }
}

static enum status find(struct thing_surfaces *before, const struct light_field *was, struct thing_surfaces *after,
                        int first, const struct light_field *is, int things, struct err *err)
{
    const size_t most = (size_t)(before->count > after->count ? before->count : after->count) + 1;
    struct rgb(*albedo)[SIDES] = calloc((size_t)things, sizeof *albedo);
    struct rgb(*given)[2] = malloc(((size_t)before->count + 1) * sizeof *given);
    struct rgb(*light)[2] = malloc(most * sizeof *light);
    struct side_sum *sums = malloc((size_t)things * SIDES * sizeof *sums);
    uint64_t *keys = malloc(2 * most * sizeof *keys);
    int *counts = calloc((size_t)things, sizeof *counts);
    if (albedo && given && light && sums && keys && counts) {
        for (int i = 0; i < before->count; i++) counts[before->thing[i]]++;
        find_keys(keys, before, 0, counts);
        find_keys(keys + most, after, first, counts);
        memcpy(given, before->radiance, (size_t)before->count * sizeof *given);
        for (int round = 0; round < ROUNDS; round++) {
            struct gather_job old = {before, was, keys, 0, light}, new = {after, is, keys + most, first, light};
            parallel_for((size_t)before->count, 16, gather_some, &old);
            find_albedos(albedo, things, before, (const struct rgb(*)[2])given, (const struct rgb(*)[2])light, sums);
            set_radiance(before, 0, (const struct rgb(*)[SIDES])albedo, (const struct rgb(*)[2])light);
            parallel_for((size_t)(after->count - first), 16, gather_some, &new);
            set_radiance(after, first, (const struct rgb(*)[SIDES])albedo, (const struct rgb(*)[2])light);
        }
    } else
        err_nomem(err, "the light of furniture", most * sizeof *light);
    free(albedo);
    free(given);
    free(light);
    free(sums);
    free(keys);
    free(counts);
    return err->status;
}

enum status thing_light_find(struct thing_surfaces *before, const struct light_field *was, struct thing_surfaces *after,
                             int first, const struct light_field *is, struct err *err)
{
    int things = 1;
    for (int i = 0; i < before->count; i++)
        if (before->thing[i] >= things) things = before->thing[i] + 1;
    return find(before, was, after, first, is, things, err);
}
