/* thing_light.c - see thing_light.h.
 *
 * Overview. Photos tell the mean radiance of each of six sides of a thing, not what its parts send out, and nothing of
 * what no photo shows: the surface is open there, and the floor below a table sees the back of its top. With the mean
 * everywhere the floor below and beside furniture is found too bright, and the contact shadow stays in part when the
 * furniture goes.
 *
 * So a thing has one albedo for each of its six sides, such that the light which these get in the room before the edit
 * gives the mean that photos show. Each part of it then sends out the albedo of its side times the light on it, and
 * its back does so with the light on the back. Light is gathered twice, since things light each other.
 *
 * A part is what of a side lies in one cube of a grid. Its light is the mean over some places, spread by area: surfaces
 * are rough, and most parts are small. Where an edit puts a thing, it has the parts and the sides that it had before.
 *
 * Mathematics. With A the area of a part, E its irradiance and L the mean radiance of its side, the albedo of a side is
 * pi sum(A L) / sum(A E), at most 0.95. Photos hardly see a side that is turned to a wall or to the floor, and give it
 * the mean of the thing: in the dark that seems nearly white. So a thing has an albedo too, that of a fit of pi L = a E
 * to its sides by least squares, which the bright ones make. Where a side seems brighter than that, and its light e is
 * less than the thing's, E, its albedo keeps (e / E)^2 of the difference. E is the mean of light weighted by light.
 * What faces down keeps its own albedo: furniture is found a little too large, so that the floor below it gets too
 * little light before the edit, and a bright underside makes up for that. */
#include "common/relight/thing_light.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/gather/irradiance.h"
#include "common/math/numbers.h"
#include "common/relight/light_quotient.h"

enum { PLACES = 8, RAYS = 16, ROUNDS = 2 }; /* places of a part as large as a side of its cube */
enum { SIDES = 6, DOWN = 5 };
enum { CUBES = 1 << 15 }; /* in a row of the grid; what is beyond belongs to the last */

struct part {
    int first, count; /* triangles, in `list` */
    int before;       /* its number before the edit */
    int thing, side;
    double area;
    struct rgb light[2]; /* of its front and of its back */
};

/* The parts of all things of one room. */
struct parts {
    struct thing_surfaces *s;
    const struct light_field *field;
    double cube; /* its width */
    int *list;   /* triangles, by part */
    struct part *parts;
    int count;
};

struct keyed {
    uint64_t key; /* of the part */
    int triangle;
};

struct thing_sum {
    double area[SIDES], light[3][SIDES], sent[3][SIDES]; /* light: area times irradiance; sent: area times radiance */
};

static struct vec3 cross_of(const struct thing_surfaces *s, int i)
{
    const struct vec3 *p = s->triangles[i];
    return vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0]));
}

static double area_of(const struct thing_surfaces *s, int i) { return 0.5 * vec3_length(cross_of(s, i)); }

static struct vec3 middle_of(const struct thing_surfaces *s, int i)
{
    const struct vec3 *p = s->triangles[i];
    return vec3_scale(vec3_add(vec3_add(p[0], p[1]), p[2]), 1.0 / 3);
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

/* ------------------------------------------------------------------------------------------------------------ parts */

static int compare(const void *a, const void *b)
{
    const struct keyed *x = a, *y = b;
    if (x->key != y->key) return x->key < y->key ? -1 : 1;
    return x->triangle < y->triangle ? -1 : x->triangle > y->triangle;
}

/* Sorts the keyed triangles into parts. */
static enum status make_parts(struct parts *p, struct keyed *keyed, int count, struct err *err)
{
    p->list = malloc(((size_t)count + 1) * sizeof *p->list);
    p->parts = malloc(((size_t)count + 1) * sizeof *p->parts);
    if (!p->list || !p->parts) return err_nomem(err, "the parts of furniture", (size_t)count * sizeof *p->parts);
    qsort(keyed, (size_t)count, sizeof *keyed, compare);
    for (int i = 0; i < count; i++) {
        const int triangle = p->list[i] = keyed[i].triangle;
        if (!i || keyed[i].key != keyed[i - 1].key) {
            p->parts[p->count] = (struct part){.first = i, .before = p->count, .thing = p->s->thing[triangle]};
            p->count++;
        }
        struct part *part = &p->parts[p->count - 1];
        part->count++;
        part->area += area_of(p->s, triangle);
    }
    return ST_OK;
}

static uint64_t cube_of(double from_low, double cube) { return (uint64_t)clamp(from_low / cube, 0, CUBES - 1); }

/* Keys of the triangles before the edit: thing, side and cube. lows: a corner of each thing. */
static void set_keys(struct keyed *keyed, const struct parts *p, struct vec3 *lows, int things)
{
    const struct thing_surfaces *s = p->s;
    for (int k = 0; k < things; k++) lows[k] = vec3_make(INFINITY, INFINITY, INFINITY);
    for (int i = 0; i < s->count; i++) {
        struct vec3 *low = &lows[s->thing[i]];
        const struct vec3 at = middle_of(s, i);
        *low = vec3_make(fmin(low->x, at.x), fmin(low->y, at.y), fmin(low->z, at.z));
    }
    for (int i = 0; i < s->count; i++) {
        const struct vec3 at = vec3_sub(middle_of(s, i), lows[s->thing[i]]);
        uint64_t key = (uint64_t)(s->thing[i] * SIDES + side_of(s, i));
        key = key * CUBES + cube_of(at.x, p->cube);
        key = key * CUBES + cube_of(at.y, p->cube);
        keyed[i] = (struct keyed){key * CUBES + cube_of(at.z, p->cube), i};
    }
}

static enum status find_parts_before(struct parts *p, struct vec3 *lows, int things, struct err *err)
{
    const int count = p->s->count;
    struct keyed *keyed = malloc(((size_t)count + 1) * sizeof *keyed);
    if (!keyed) return err_nomem(err, "the parts of furniture", (size_t)count * sizeof *keyed);
    set_keys(keyed, p, lows, things);
    make_parts(p, keyed, count, err);
    free(keyed);
    for (int i = 0; !err->status && i < p->count; i++) p->parts[i].side = side_of(p->s, p->list[p->parts[i].first]);
    return err->status;
}

/* The triangles of a thing come in one order at each of its places, from `first` of all: so each has the part of its
 * likeness before the edit. */
static enum status find_parts_after(struct parts *p, int first, const struct parts *was, struct err *err)
{
    const int count = p->s->count - first, before = was->s->count;
    const size_t bytes = ((size_t)count + 1) * sizeof(struct keyed);
    struct keyed *keyed = malloc(bytes);
    int *part = malloc(((size_t)before + 1) * sizeof *part);
    if (keyed && part) {
        for (int k = 0; k < was->count; k++)
            for (int i = 0; i < was->parts[k].count; i++) part[was->list[was->parts[k].first + i]] = k;
        for (int i = 0, begin = 0, end = 0, n = 0, place = 0; i < count; i++, n++) {
            const int thing = p->s->thing[first + i];
            if (!i || thing != p->s->thing[first + i - 1]) {
                begin = end = n = place = 0;
                while (begin < before && was->s->thing[begin] != thing) begin++;
                for (end = begin; end < before && was->s->thing[end] == thing;) end++;
            }
            if (n == end - begin) n = 0, place++;
            keyed[i] = (struct keyed){(uint64_t)place * (uint64_t)was->count + (uint64_t)part[begin + n], first + i};
        }
        make_parts(p, keyed, count, err);
        for (int i = 0; !err->status && i < p->count; i++) {
            p->parts[i].before = (int)(keyed[p->parts[i].first].key % (uint64_t)was->count);
            p->parts[i].side = was->parts[p->parts[i].before].side;
        }
    } else
        err_nomem(err, "the parts of furniture", bytes);
    free(keyed);
    free(part);
    return err->status;
}

static void release_parts(struct parts *p)
{
    free(p->list);
    free(p->parts);
}

/* ------------------------------------------------------------------------------------------------------------ light */

static struct rgb light_of_part(const struct parts *p, const struct part *part, int side)
{
    const int places = (int)clamp(ceil(PLACES * part->area / (p->cube * p->cube)), 1, PLACES);
    struct rgb sum = {0, 0, 0};
    double passed = 0;
    int at = -1;
    if (!(part->area > 0)) return sum;
    for (int k = 0; k < places; k++) {
        while (at + 1 < part->count && passed <= (k + 0.5) / places * part->area)
            passed += area_of(p->s, p->list[part->first + ++at]);
        const int i = p->list[part->first + at];
        const struct vec3 normal = vec3_normalize(cross_of(p->s, i));
        const uint64_t key = ((uint64_t)part->before * 2 + (uint64_t)side) * PLACES + (uint64_t)k;
        struct irradiance e;
        ray_irradiance(&e, p->field, (struct gather_point){middle_of(p->s, i), vec3_scale(normal, side ? -1 : 1)}, RAYS,
                       key);
        sum = rgb_add(sum, e.value);
    }
    return rgb_scale(sum, 1.0 / places);
}

static void gather_some(void *ctx, size_t begin, size_t end, int thread)
{
    const struct parts *p = ctx;
    (void)thread;
    for (size_t n = begin; n < end; n++)
        for (int side = 0; side < 2; side++) p->parts[n].light[side] = light_of_part(p, &p->parts[n], side);
}

static void add_to(double sums[3][SIDES], int side, struct rgb value)
{
    sums[0][side] += value.r;
    sums[1][side] += value.g;
    sums[2][side] += value.b;
}

/* Of one channel. light, sent: of each side of a thing, with its area. */
static void albedos_of(double albedo[SIDES], const double area[SIDES], const double light[SIDES],
                       const double sent[SIDES])
{
    double sum = 0, squares = 0, products = 0;
    for (int k = 0; k < SIDES; k++) {
        if (!(area[k] > 0)) continue;
        sum += light[k];
        squares += light[k] * light[k] / area[k];
        products += light[k] * sent[k] / area[k];
    }
    for (int k = 0; k < SIDES; k++) {
        const double own = light[k] > 0 ? clamp(PI * sent[k] / light[k], 0, LIGHT_ALBEDO_MAX) : 0;
        const double whole = squares > 0 ? clamp(PI * products / squares, 0, LIGHT_ALBEDO_MAX) : 0;
        const double bright = area[k] > 0 && squares > 0 ? light[k] / area[k] * sum / squares : 0;
        albedo[k] = k != DOWN && own > whole && bright < 1 ? whole + bright * bright * (own - whole) : own;
    }
}

/* given: the radiance of each triangle that photos show. */
static void find_albedos(struct rgb (*albedo)[SIDES], int things, const struct parts *p, const struct rgb (*given)[2],
                         struct thing_sum *sums)
{
    memset(sums, 0, (size_t)things * sizeof *sums);
    for (int k = 0; k < p->count; k++) {
        const struct part *part = &p->parts[k];
        struct thing_sum *sum = &sums[part->thing];
        add_to(sum->light, part->side, rgb_scale(part->light[0], part->area));
        sum->area[part->side] += part->area;
        for (int n = part->first; n < part->first + part->count; n++)
            add_to(sum->sent, part->side, rgb_scale(given[p->list[n]][0], area_of(p->s, p->list[n])));
    }
    for (int k = 0; k < things; k++) {
        double found[3][SIDES];
        for (int c = 0; c < 3; c++) albedos_of(found[c], sums[k].area, sums[k].light[c], sums[k].sent[c]);
        for (int i = 0; i < SIDES; i++) albedo[k][i] = rgb_make(found[0][i], found[1][i], found[2][i]);
    }
}

static void set_radiance(const struct parts *p, const struct rgb (*albedo)[SIDES])
{
    for (int k = 0; k < p->count; k++) {
        const struct part *part = &p->parts[k];
        const struct rgb a = rgb_scale(albedo[part->thing][part->side], 1 / PI);
        for (int n = part->first; n < part->first + part->count; n++)
            for (int side = 0; side < 2; side++) p->s->radiance[p->list[n]][side] = rgb_multiply(a, part->light[side]);
    }
}

static enum status find(struct parts *before, struct parts *after, int things, struct err *err)
{
    const size_t count = (size_t)before->s->count;
    struct rgb(*albedo)[SIDES] = calloc((size_t)things, sizeof *albedo);
    struct rgb(*given)[2] = malloc((count + 1) * sizeof *given);
    struct thing_sum *sums = malloc((size_t)things * sizeof *sums);
    if (albedo && given && sums) {
        memcpy(given, before->s->radiance, count * sizeof *given);
        for (int round = 0; round < ROUNDS; round++) {
            parallel_for((size_t)before->count, 4, gather_some, before);
            find_albedos(albedo, things, before, (const struct rgb(*)[2])given, sums);
            set_radiance(before, (const struct rgb(*)[SIDES])albedo);
            parallel_for((size_t)after->count, 4, gather_some, after);
            set_radiance(after, (const struct rgb(*)[SIDES])albedo);
        }
    } else
        err_nomem(err, "the light of furniture", (count + 1) * sizeof *given);
    free(albedo);
    free(given);
    free(sums);
    return err->status;
}

enum status thing_light_find(struct thing_surfaces *before, const struct light_field *was, struct thing_surfaces *after,
                             int first, const struct light_field *is, double cube, struct err *err)
{
    struct parts old = {.s = before, .field = was, .cube = cube}, new = {.s = after, .field = is, .cube = cube};
    int things = 1;
    for (int i = 0; i < before->count; i++)
        if (before->thing[i] >= things) things = before->thing[i] + 1;
    struct vec3 *lows = malloc((size_t)things * sizeof *lows);
    if (!lows) return err_nomem(err, "furniture", (size_t)things * sizeof *lows);
    if (!find_parts_before(&old, lows, things, err) && !find_parts_after(&new, first, &old, err))
        find(&old, &new, things, err);
    free(lows);
    release_parts(&old);
    release_parts(&new);
    return err->status;
}
