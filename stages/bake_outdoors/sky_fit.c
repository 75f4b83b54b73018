/* sky_fit.c - a standard sky that continues the sky that pictures show.
 *
 * Overview. Windows show a part of the sky. How bright the rest is follows from weather and sun: the CIE's standard
 * general sky has 15 types, from overcast to clear, which were found by measuring skies. The type that agrees best with
 * what is seen is scaled to it, each colour on its own.
 *
 * Mathematics. The types are those of [CIE 2003] (common/daylight/sky_standard.h). For each of them the scale is the
 * weighted median of the quotients seen / standard, and the misfit the weighted mean deviation of their logarithms. A
 * narrow window may fit types that differ by a factor of three elsewhere: a type is charged FARTHER times the logarithm
 * by which its zenith differs from what is seen, and GUESSED if the sun's direction had to be guessed, from a grid. So
 * a sky that is as bright everywhere as what is seen is believed unless the pictures say otherwise.
 *
 * What differs from the source: nothing is guessed to be brighter than the sky that is seen. Around the sun and at the
 * zenith of an overcast sky that is too dark; but what shines there does not reach the pictures, and an error there
 * would light the rooms. */
#include "stages/bake_outdoors/sky_fit.h"

#include <math.h>
#include <stdlib.h>

#include "common/image/luminance.h"
#include "common/math/numbers.h"
#include "common/math/weighted.h"

enum { AZIMUTHS = 16 };
static const double FARTHER = 0.03, GUESSED = 0.01; /* of a misfit */
static const double SEEN = 0.95;                    /* percentile that counts as the brightest */
static const double elevations[] = {10, 25, 40, 60};

static double luminance_level(const double level[3])
{
    return log(LUMINANCE_R * exp(level[0]) + LUMINANCE_G * exp(level[1]) + LUMINANCE_B * exp(level[2]));
}

struct fitting {
    const struct sky_sample *samples;
    int count;
    double *standard; /* logarithm, of each sample */
    struct weighted *scratch;
};

/* The median of seen to standard, as a logarithm; c: colour, 3: luminance. */
static double scale_of(const struct fitting *f, int c)
{
    for (int i = 0; i < f->count; i++) {
        const double *level = f->samples[i].level;
        const double seen = c < 3 ? level[c] : luminance_level(level);
        f->scratch[i] = (struct weighted){seen - f->standard[i], f->samples[i].weight};
    }
    return weighted_percentile(f->scratch, (size_t)f->count, 0.5);
}

/* The misfit of a type, and what it is charged for. */
static double try_type(double *misfit, const struct fitting *f, int type, struct vec3 to_sun)
{
    static const struct vec3 zenith = {0, 0, 1};
    double sum = 0, weights = 0, mean = 0;
    for (int i = 0; i < f->count; i++) f->standard[i] = log(sky_standard(type, f->samples[i].direction, to_sun));
    const double scale = scale_of(f, 3);
    for (int i = 0; i < f->count; i++) {
        const double weight = f->samples[i].weight;
        sum += weight * fabs(luminance_level(f->samples[i].level) - f->standard[i] - scale);
        mean += weight * f->standard[i];
        weights += weight;
    }
    *misfit = sum / weights;
    return *misfit + FARTHER * fabs(log(sky_standard(type, zenith, to_sun)) - mean / weights);
}

static void take_if_better(struct sky_fit *best, double *least, const struct fitting *f, int type, struct vec3 to_sun,
                           double charge)
{
    double misfit;
    const double cost = try_type(&misfit, f, type, to_sun) + charge;
    if (!(cost < *least)) return;
    *least = cost;
    best->type = type;
    best->to_sun = to_sun;
    best->misfit = misfit;
}

static void try_suns(struct sky_fit *best, double *least, const struct fitting *f, int type)
{
    for (size_t k = 0; k < sizeof elevations / sizeof *elevations; k++)
        for (int i = 0; i < AZIMUTHS; i++) {
            const double azimuth = 2 * PI * i / AZIMUTHS, elevation = elevations[k] * DEGREE;
            const struct vec3 to_sun =
                vec3_make(cos(elevation) * cos(azimuth), cos(elevation) * sin(azimuth), sin(elevation));
            take_if_better(best, least, f, type, to_sun, GUESSED);
        }
}

static void find_levels(struct sky_fit *best, const struct fitting *f)
{
    for (int i = 0; i < f->count; i++)
        f->standard[i] = log(sky_standard(best->type, f->samples[i].direction, best->to_sun));
    for (int c = 0; c < 3; c++) best->level[c] = scale_of(f, c);
    for (int i = 0; i < f->count; i++)
        f->scratch[i] = (struct weighted){luminance_level(f->samples[i].level), f->samples[i].weight};
    best->brightest = exp(weighted_percentile(f->scratch, (size_t)f->count, SEEN));
}

enum status sky_fit_samples(struct sky_fit *best, const struct sky_sample *samples, int count,
                            const struct vec3 *to_sun, struct err *err)
{
    static const struct vec3 zenith = {0, 0, 1};
    struct fitting f = {samples, count, NULL, NULL};
    double least = INFINITY;
    *best = (struct sky_fit){.to_sun = zenith};
    if (!count) return ST_OK;
    f.standard = malloc((size_t)count * sizeof *f.standard);
    f.scratch = malloc((size_t)count * sizeof *f.scratch);
    if (!f.standard || !f.scratch) err_nomem(err, "a sky", (size_t)count * sizeof *f.scratch);
    if (!err->status) {
        take_if_better(best, &least, &f, SKY_UNIFORM, zenith, 0);
        for (int type = 1; type <= SKY_TYPES; type++) {
            if (sky_standard_needs_sun(type) && !to_sun)
                try_suns(best, &least, &f, type);
            else
                take_if_better(best, &least, &f, type, to_sun ? *to_sun : zenith, 0);
        }
        find_levels(best, &f);
    }
    free(f.standard);
    free(f.scratch);
    return err->status;
}

void sky_fit_level(double level[3], const struct sky_fit *f, struct vec3 direction)
{
    const double standard = log(sky_standard(f->type, direction, f->to_sun));
    for (int c = 0; c < 3; c++) level[c] = f->level[c] + standard;
    const double over = luminance_level(level) - log(f->brightest);
    for (int c = 0; c < 3 && over > 0; c++) level[c] -= over;
}
