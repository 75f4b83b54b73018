/* photo_quality.c - noise and clipping of photographs.
 *
 * Of one exposure, noise is not measured but assumed: each colour v has the variance photon v + read^2
 * (common/image/noise_model.h), and the luminance, a sum of independent colours, the sum of the squares of its weights
 * times theirs. Errors of a JPEG's luma are the same in all colours, so their variance is that of a grey of the same
 * luminance. Merged exposures state the variance of the luminance divided by its square. */
#include "common/capture/photo_quality.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/parallel.h"
#include "common/image/luminance.h"
#include "common/image/noise_model.h"
#include "common/image/samples.h"

enum { CHUNK = 1 << 16 }; /* pixels */

_Static_assert(EXR_PADDING - QUALITY_PADDING >= 0, "a channel of a file becomes a photo's variance");

enum status photo_quality_init(struct photo_quality *q, int width, int height, struct err *err)
{
    const size_t pixels = (size_t)width * (size_t)height;
    q->variance = samples_alloc((pixels + QUALITY_PADDING) * sizeof *q->variance);
    q->marks = samples_alloc(pixels);
    if (q->variance && q->marks) return ST_OK;
    photo_quality_release(q);
    return err_nomem(err, "a photo's noise and marks", pixels * 5);
}

void photo_quality_release(struct photo_quality *q)
{
    if (!q) return;
    free(q->variance);
    free(q->marks);
    *q = (struct photo_quality){0};
}

static float light_of(const float v) { return v > 0 ? v : 0; }

/* Whether a sample is saturated: colours outside of Rec.709 exceed 1 without being so. */
static bool is_bright(const struct exposure_judge *job, size_t i)
{
    const struct photo *p = job->photo;
    const struct colour_space *s = p->space;
    bool bright = false;
    for (size_t c = 0; c < 3; c++) {
        const size_t sample = p->bytes ? p->bytes[3 * i + c] : p->samples[3 * i + c];
        bright |= s->light[c * (size_t)s->levels + sample] >= job->saturated * job->white;
    }
    return bright;
}

void photo_quality_judge_init(struct exposure_judge *j, const struct photo *photo,
                              const struct single_exposure *assumed)
{
    const struct response curve = {.space = photo->space};
    const struct noise n = noise_given(assumed->electrons, assumed->read_noise, &curve, photo->info.bits);
    const struct noise jpeg = noise_of_samples(photo->jpeg_variance, &curve, 8);
    *j = (struct exposure_judge){.photo = photo,
                                 .white = colour_space_white(photo->space),
                                 .photon = (float)n.photon,
                                 .read2 = (float)n.read2,
                                 .shared_photon = (float)jpeg.photon,
                                 .shared_read2 = (float)jpeg.read2,
                                 .saturated = (float)assumed->saturated,
                                 .dark = (float)assumed->dark};
}

void photo_quality_judge(const struct exposure_judge *j, float *variance, uint8_t *marks, const float *rgb,
                         size_t first, size_t count)
{
    const float photon = j->photon, read2 = j->read2, saturated = j->saturated, dark = j->dark;
    const float shared_photon = j->shared_photon, shared_read2 = j->shared_read2;
    static const float luma[3] = LUMINANCE_WEIGHTS;
    const float r2 = luma[0] * luma[0], g2 = luma[1] * luma[1], b2 = luma[2] * luma[2];
    const bool spaced = j->photo->space != NULL;
    for (size_t i = 0; i < count; i++) {
        const float *v = rgb + 3 * i;
        const float light = luminance_of(v), limit = light * light;
        const float noise = photon * (r2 * light_of(v[0]) + g2 * light_of(v[1]) + b2 * light_of(v[2])) +
                            read2 * (r2 + g2 + b2) + shared_photon * light_of(light) + shared_read2;
        const bool bright =
            spaced ? is_bright(j, first + i) : (v[0] >= saturated) | (v[1] >= saturated) | (v[2] >= saturated);
        const bool black = (v[0] <= dark) | (v[1] <= dark) | (v[2] <= dark);
        variance[i] = bright || noise > limit ? limit : noise;
        marks[i] = bright ? PHOTO_BRIGHT : black ? PHOTO_DARK : 0;
    }
}

struct exposure_job {
    const struct exposure_judge *judge;
    struct photo_quality *q;
    const float *rgb;
};

static void judge_pixels(void *ctx, size_t begin, size_t end, int thread)
{
    const struct exposure_job *job = ctx;
    (void)thread;
    photo_quality_judge(job->judge, job->q->variance + begin, job->q->marks + begin, job->rgb + 3 * begin, begin,
                        end - begin);
}

enum status photo_quality_of_exposure(struct photo_quality *q, const struct photo *photo, const struct image *linear,
                                      const struct single_exposure *assumed, struct err *err)
{
    struct exposure_judge judge;
    const size_t pixels = (size_t)linear->width * (size_t)linear->height;
    if (photo_quality_init(q, linear->width, linear->height, err)) return err->status;
    photo_quality_judge_init(&judge, photo, assumed);
    struct exposure_job job = {&judge, q, linear->data};
    parallel_for(pixels, CHUNK, judge_pixels, &job);
    return ST_OK;
}

struct merged_job {
    struct photo_quality *q; /* variance: relative on entry */
    const float *rgb;
    const uint32_t *clipped;
};

static void scale_pixels(void *ctx, size_t begin, size_t end, int thread)
{
    const struct merged_job *job = ctx;
    float *variance = job->q->variance;
    uint8_t *marks = job->q->marks;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        const float light = luminance_of(job->rgb + 3 * i), relative = variance[i];
        variance[i] = (relative > 0 && relative < 1 ? relative : 1) * (light * light);
        marks[i] = (uint8_t)(job->clipped[i] & (PHOTO_BRIGHT | PHOTO_DARK));
    }
}

enum status photo_quality_of_merged(struct photo_quality *q, struct exr_image *merged, const char *path,
                                    const struct image *linear, struct err *err)
{
    struct exr_plane *relative = exr_find(merged, "variance");
    const struct exr_plane *clipped = exr_find(merged, "clipped");
    const size_t pixels = (size_t)linear->width * (size_t)linear->height;
    if (!relative || !relative->f || !clipped || !clipped->u)
        return err_set(err, ST_DATA,
                       "%s: wanted the channels variance (float) and clipped (uint); merge the view again.", path);
    q->marks = samples_alloc(pixels);
    if (!q->marks) return err_nomem(err, "a photo's marks", pixels);
    q->variance = relative->f;
    relative->f = NULL;
    struct merged_job job = {q, linear->data, clipped->u};
    parallel_for(pixels, CHUNK, scale_pixels, &job);
    return ST_OK;
}

float photo_relative_sigma(float variance, float luminance)
{
    return luminance > 0 && variance < luminance * luminance ? sqrtf(variance) / luminance : 1;
}
