/* encode.c - see encode.h.
 *
 * A film in PQ states the brightest pixel and the brightest mean of a frame, so its frames are read twice. */
#include "stages/encode_video/encode.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/base/progress.h"
#include "common/film/frame_encoder.h"
#include "common/image/exr.h"
#include "common/image/image.h"
#include "common/product/product.h"

#define PARAM_STRUCT struct encode_params
const struct param encode_param_table[] = {ENCODE_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

/* Reads the frame of one eye. `linear` has the size of the path's frames. */
static enum status read_eye(struct image *linear, const struct camera_path *path, int frame, const char *folder,
                            struct err *err)
{
    static const char *const names[] = {"R", "G", "B"};
    const struct view *camera = &path->frames[frame].camera;
    struct exr_image exr = {0};
    char file[FILE_PATH];

    product_path_in(file, folder, PRODUCT_FRAME, &(struct product_key){.frame = camera->name}, err);
    if (!err->status && access(file, F_OK))
        err_set(err, ST_DATA, "frame %d of %d is missing: there is no %s; render it, then encode again.", frame + 1,
                path->frame_count, file);
    if (!err->status) exr_read(&exr, file, names, 3, err);
    if (!err->status && (exr.width != camera->width || exr.height != camera->height))
        err_set(err, ST_DATA, "%s has %d x %d pixels, wanted %d x %d as in the path; render it again.", file, exr.width,
                exr.height, camera->width, camera->height);
    for (size_t k = 0; !err->status && k < 3; k++) {
        const struct exr_plane *plane = exr_find(&exr, names[k]);
        const size_t pixels = (size_t)exr.width * (size_t)exr.height;
        for (size_t p = 0; p < pixels; p++) linear->data[3 * p + k] = plane->f[p];
    }
    exr_image_release(&exr);
    return err->status;
}

struct encode_job {
    const struct camera_path *path;
    const struct encode_source *source;
    const struct film_format *format;
    double peak;
    struct image left, right, picture; /* picture: of two eyes */
    void *signal;
};

static enum status job_init(struct encode_job *job, int width, int height, struct err *err)
{
    const struct view *camera = &job->path->frames[0].camera;
    const size_t bytes = film_format_bytes(job->format, width, height);
    if (image_init(&job->left, camera->width, camera->height, 3, err)) return err->status;
    if (job->source->right && (image_init(&job->right, camera->width, camera->height, 3, err) ||
                               image_init(&job->picture, width, height, 3, err)))
        return err->status;
    return (job->signal = malloc(bytes)) ? ST_OK : err_nomem(err, "a frame", bytes);
}

/* The picture of a frame, of one eye or two; it belongs to the job. NULL after an error. */
static const struct image *read_frame(struct encode_job *job, int frame, struct err *err)
{
    const struct encode_source *s = job->source;
    if (read_eye(&job->left, job->path, frame, s->frames, err)) return NULL;
    if (!s->right) return &job->left;
    if (read_eye(&job->right, job->path, frame, s->right, err)) return NULL;
    eyes_picture(&job->picture, &job->left, &job->right, s->eyes);
    return &job->picture;
}

static enum status measure_light(struct encode_job *job, struct film_light *light, struct err *err)
{
    for (int i = 0; i < job->path->frame_count; i++) {
        const struct image *picture = read_frame(job, i, err);
        if (!picture) return err->status;
        film_light_add(light, picture, job->peak);
    }
    return ST_OK;
}

static enum status put_frame(struct encode_job *job, struct frame_encoder *encoder, int frame, struct err *err)
{
    const struct image *picture = read_frame(job, frame, err);
    if (picture && !film_format_signal(job->format, picture, job->peak, job->signal, err))
        frame_encoder_put(encoder, job->signal);
    return err->status;
}

static enum status encode(struct encode_job *job, struct frame_quality *quality, int width, int height, const char *out,
                          struct err *err)
{
    const struct camera_path *path = job->path;
    struct frame_encoder encoder = {0};
    struct progress progress;
    progress_start(&progress, "encoding", path->frame_count, "frames");
    if (job->format->curve == FILM_PQ) measure_light(job, &quality->light, err);
    /* the first frame is read before ffmpeg starts, so that a missing one is reported by itself */
    if (!err->status && read_frame(job, 0, err) &&
        !frame_encoder_begin(&encoder, out, width, height, path->fps, quality, err)) {
        while (!encoder.ended && encoder.written < path->frame_count) {
            if (put_frame(job, &encoder, encoder.written, err)) break;
            progress_add(&progress, 1);
        }
        if (!err->status) frame_encoder_end(&encoder, path->frame_count, err);
    }
    progress_end(&progress);
    frame_encoder_release(&encoder);
    return err->status;
}

enum status encode_frames(const struct camera_path *path, const struct encode_source *source, const char *out,
                          const struct encode_params *params, struct err *err)
{
    int width = path->frame_count ? path->frames[0].camera.width : 0;
    int height = path->frame_count ? path->frames[0].camera.height : 0;
    struct encode_job job = {.path = path, .source = source, .peak = params->peak};
    struct frame_quality quality = {.preset = params->preset, .crf = params->crf, .peak = params->peak};

    if (!path->frame_count) return err_set(err, ST_DATA, "the path has no frames; plan it again.");
    if (width % 2 || height % 2)
        return err_set(
            err, ST_DATA,
            "the path's frames have %d x %d pixels, wanted even sizes, since pixels share their chroma; plan "
            "the path again.",
            width, height);
    job.format = quality.format = source->format ? source->format : film_format_find("h264");
    if (source->right) eyes_size(source->eyes, &width, &height);
    quality.stereo = source->right ? eyes_mode(source->eyes) : STEREO_NONE;
    quality.half_sphere = source->eyes == FILM_VR180;
    if (!job_init(&job, width, height, err)) encode(&job, &quality, width, height, out, err);
    image_release(&job.left);
    image_release(&job.right);
    image_release(&job.picture);
    free(job.signal);
    return err->status;
}
