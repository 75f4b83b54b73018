/* sensor.c - noise and response of the sensor.
 *
 * Random numbers are counter-based, keyed by the sample (pixel and channel), so that threads do not matter. */
#include "stages/simulate/sensor.h"

#include <math.h>

#include "common/base/parallel.h"
#include "common/math/numbers.h"

struct job {
    unsigned char *rgb;
    const struct image *radiance;
    double signal, electrons, read_noise;
    const struct rng *rng;
};

/* A standard normal number for a sample [Box 1958]. */
static double normal(const struct rng *rng, uint64_t sample, uint64_t index)
{
    const double a = rng_uniform(rng, sample, 2 * index), b = rng_uniform(rng, sample, 2 * index + 1);
    return sqrt(-2 * log(1 - a)) * cos(2 * PI * b);
}

/* A Poisson count: by inversion of the distribution up to a mean of 30, above it rounded from a normal
 * approximation. */
static double poisson(const struct rng *rng, uint64_t sample, double mean)
{
    if (mean > 30) return fmax(0, round(mean + sqrt(mean) * normal(rng, sample, 0)));
    double left = rng_uniform(rng, sample, 0), p = exp(-mean);
    int count = 0;
    while (left >= p && count < 200) {
        left -= p;
        p *= mean / ++count;
    }
    return count;
}

static void expose(void *ctx, size_t begin, size_t end, int thread)
{
    (void)thread;
    const struct job *job = ctx;
    for (size_t i = begin; i < end; i++) {
        const double mean = (double)job->radiance->data[i] * job->signal * job->electrons;
        /* far above white, noise does not matter, and skipping it keeps the count finite */
        double count = mean < 4 * job->electrons ? poisson(job->rng, i, mean) : mean;
        count += job->read_noise * normal(job->rng, i, 1);
        job->rgb[i] = (unsigned char)lrintf(255 * srgb_from_linear((float)(count / job->electrons)));
    }
}

void sensor_expose(unsigned char *rgb, const struct image *radiance, const struct shoot_sensor *sensor,
                   const struct shoot_exposure *exposure, const struct rng *rng)
{
    const double opening = 8 / exposure->f_number;
    struct job job = {
        .rgb = rgb,
        .radiance = radiance,
        .signal = sensor->gain * exposure->seconds * (exposure->iso / 100) * opening * opening / exposure->filter,
        .electrons = sensor->full_well * 100 / exposure->iso,
        .read_noise = sensor->read_noise,
        .rng = rng,
    };
    parallel_for((size_t)radiance->width * (size_t)radiance->height * 3, 1 << 14, expose, &job);
}
