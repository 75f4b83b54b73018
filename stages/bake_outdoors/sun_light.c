/* sun_light.c - how much light the sun gives.
 *
 * Overview. Beside the edge of a patch lies the same material without sun. If E is its irradiance there, the surface is
 * L / E times as bright as its irradiance says, and the patch, q times as bright, gets (q - 1) E from the sun, which is
 * the sun's irradiance times the cosine of the angle to the surface. E is gathered from the atlas and the outdoors, as
 * all light indoors is.
 *
 * The squares near the edges of all patches are sorted into places: cubes of space on one face, a hand wide. In a place
 * with enough lit and unlit squares q is the quotient of their mean radiances; texture differs from square to square,
 * but not on average. Places whose lit squares are hardly brighter are shadows of furniture, and do not count. The
 * result is the weighted median over all places, of each colour. The atlas lacks the light of lamps that saturate in
 * all photographs, of cones of spots, and of lamps that hang in the room. sun_lamps.c fits it, roughly. So a place's
 * weight is the square of the share of its light that comes from outdoors: sills and reveals, which lamps hardly
 * reach, count most.
 *
 * The interval has two parts: the spread of the places, and how far the fitted lamps may be off, UNSURE of their share
 * of the light, which is the same at all places.
 *
 * Limits. A gloss brightens lit and unlit squares alike, and lowers q; so does the blur of pictures at an edge. */
#include "stages/bake_outdoors/sun_light.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "common/base/parallel.h"
#include "common/math/numbers.h"
#include "common/math/weighted.h"
#include "stages/bake_outdoors/sun_lamps.h"

enum { RAYS = 1024, MIN_SQUARES = 5, MOST = 400 };
static const double PLACE = 12;              /* squares: the side of a place */
static const double LIT = 0.95, DARK = 0.05; /* shares of the disk */
static const double LEAST = 1.1;             /* quotient of lit to unlit */
static const double GRAZING = 0.1;           /* cosine below which a surface does not measure */
static const double UNSURE = 0.5;            /* of the light of fitted lamps: half of its interval of 95 % */

/* ----------------------------------------------------------------------------------------------------------- places */

struct place {
    int tile;
    int64_t x, y, z; /* the cube */
    int lit, dark;
    double sum[2][3];       /* radiances of lit and dark squares */
    struct vec3 at, normal; /* of the dark squares, summed */
    double sun[3];          /* the irradiance that it tells */
    double weight;
    double lamps; /* share of its light that fitted lamps give */
};

static struct place *find_place(struct place *places, int *count, const struct atlas_square *t, double size)
{
    const int64_t x = (int64_t)floor(t->at.x / size), y = (int64_t)floor(t->at.y / size);
    const int64_t z = (int64_t)floor(t->at.z / size);
    for (int i = *count; i-- > 0;) {
        struct place *p = &places[i];
        if (p->tile == t->tile && p->x == x && p->y == y && p->z == z) return p;
    }
    if (*count == MOST) return NULL;
    places[*count] = (struct place){.tile = t->tile, .x = x, .y = y, .z = z, .normal = t->normal};
    return &places[(*count)++];
}

static void add_square(struct place *p, const struct atlas_square *t, double share)
{
    const bool lit = share > LIT;
    if (!lit && !(share < DARK)) return;
    *(lit ? &p->lit : &p->dark) += 1;
    for (int c = 0; c < 3; c++) p->sum[!lit][c] += exp((double)t->level[c]);
    if (!lit) p->at = vec3_add(p->at, t->at);
}

/* Drops the places that cannot measure. Returns their number. */
static int keep_useful(struct place *places, int count, struct vec3 direction)
{
    int kept = 0;
    for (int i = 0; i < count; i++) {
        struct place p = places[i];
        if (p.lit < MIN_SQUARES || p.dark < MIN_SQUARES || !(vec3_dot(p.normal, direction) > GRAZING)) continue;
        if (!(p.sum[0][1] / p.lit > LEAST * p.sum[1][1] / p.dark)) continue;
        p.at = vec3_scale(p.at, 1.0 / p.dark);
        places[kept++] = p;
    }
    return kept;
}

struct measuring {
    struct place *places;
    const struct sun_lamps *lamps;
    const struct model_rays *model;
    struct light_field field;
    struct vec3 direction;
};

static void measure_range(void *ctx, size_t begin, size_t end, int thread)
{
    const struct measuring *m = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        struct place *p = &m->places[i];
        struct irradiance e;
        ray_irradiance(&e, &m->field, (struct gather_point){p->at, p->normal}, RAYS, i);
        const struct rgb lamps = sun_lamps_irradiance(m->lamps, m->model, p->at, p->normal);
        const double without[3] = {e.value.r + lamps.r, e.value.g + lamps.g, e.value.b + lamps.b};
        const double cosine = vec3_dot(p->normal, m->direction), known = rgb_luminance(e.value);
        p->lamps = rgb_luminance(lamps) / fmax(known + rgb_luminance(lamps), DBL_MIN);
        const double sky = (e.from[LIGHT_SKY] + e.from[LIGHT_SKY_GUESSED]) * (1 - p->lamps);
        p->weight = sky * sky;
        for (int c = 0; c < 3; c++) {
            const double quotient = p->sum[0][c] / p->lit / (p->sum[1][c] / p->dark);
            p->sun[c] = fmax(0, (quotient - 1) * without[c] / cosine);
        }
    }
}

/* The value of a place for one colour, or for the luminance (c = 3). */
static double sun_of(const struct place *p, int c)
{
    return c < 3 ? p->sun[c] : rgb_luminance(rgb_make(p->sun[0], p->sun[1], p->sun[2]));
}

static double median_of(const struct place *places, int count, int c, struct weighted *scratch)
{
    for (int i = 0; i < count; i++) scratch[i] = (struct weighted){sun_of(&places[i], c), places[i].weight};
    return weighted_percentile(scratch, (size_t)count, 0.5);
}

/* For a normal distribution, a median deviates 1.2533 times as much as a mean, and the standard deviation is 1.2533
 * times the mean absolute one. */
static double spread_of(const struct place *places, int count, double luminance)
{
    double weights = 0, squares = 0, deviation = 0;
    for (int i = 0; i < count; i++) {
        const double w = places[i].weight;
        weights += w;
        squares += w * w;
        deviation += w * fabs(sun_of(&places[i], 3) - luminance);
    }
    if (!(weights > 0 && luminance > 0)) return INFINITY;
    return 1.96 * 1.2533 * 1.2533 * deviation / (weights * luminance) * sqrt(squares) / weights;
}

static double mean_share_of_lamps(const struct place *places, int count)
{
    double sum = 0, weights = 0;
    for (int i = 0; i < count; i++) {
        sum += places[i].weight * places[i].lamps;
        weights += places[i].weight;
    }
    return weights > 0 ? sum / weights : 0;
}

static void sum_up(struct sun_light *l, const struct place *places, int count, struct weighted *scratch)
{
    const double spread = spread_of(places, count, median_of(places, count, 3, scratch));
    if (!isfinite(spread)) return; /* no place has light from outdoors, or none is brighter in the sun */
    l->places = count;
    l->irradiance = rgb_make(median_of(places, count, 0, scratch), median_of(places, count, 1, scratch),
                             median_of(places, count, 2, scratch));
    l->lamps = mean_share_of_lamps(places, count);
    l->error = hypot(spread, UNSURE * l->lamps);
}

enum status sun_light_measure(struct sun_light *l, const struct sun_indoors *in, const struct atlas_squares *texels,
                              struct vec3 direction, double radius, struct err *err)
{
    struct place *places = malloc(MOST * sizeof *places);
    struct weighted *scratch = malloc(MOST * sizeof *scratch);
    float *share = malloc(((size_t)texels->count + 1) * sizeof *share);
    struct sun_lamps lamps = {0};
    int count = 0;
    *l = (struct sun_light){0};
    if (!places || !scratch || !share) err_nomem(err, "places", MOST * sizeof *places);
    if (!err->status) {
        sun_shares(share, texels, in->scene->model, direction, radius);
        for (int i = 0; i < texels->count; i++) {
            struct place *p = find_place(places, &count, &texels->list[i], PLACE * texels->side);
            if (p) add_square(p, &texels->list[i], (double)share[i]);
        }
        count = keep_useful(places, count, direction);
    }
    if (!err->status && count && !sun_lamps_fit(&lamps, in, texels, direction, radius, err)) {
        struct measuring m = {places, &lamps, in->scene->model, sun_indoors_field(in), direction};
        parallel_for((size_t)count, 1, measure_range, &m);
        sum_up(l, places, count, scratch);
    }
    sun_lamps_release(&lamps);
    free(places);
    free(scratch);
    free(share);
    return err->status;
}
