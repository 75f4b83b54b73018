/* encode.c - see encode.h. */
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

/* Reads a frame as 8-bit sRGB. */
static enum status read_frame(unsigned char *rgb, const struct camera_path *path, int frame, const char *folder,
                              struct err *err)
{
    static const char *const names[] = {"R", "G", "B"};
    const struct view *camera = &path->frames[frame].camera;
    struct exr_image exr = {0};
    struct image linear = {0};
    char file[FILE_PATH];

    product_path_in(file, folder, PRODUCT_FRAME, &(struct product_key){.frame = camera->name}, err);
    if (!err->status && access(file, F_OK))
        err_set(err, ST_DATA, "frame %d of %d is missing: there is no %s; render it, then encode again.", frame + 1,
                path->frame_count, file);
    if (!err->status) exr_read(&exr, file, names, 3, err);
    if (!err->status && (exr.width != camera->width || exr.height != camera->height))
        err_set(err, ST_DATA, "%s has %d x %d pixels, wanted %d x %d as in the path; render it again.", file, exr.width,
                exr.height, camera->width, camera->height);
    if (!err->status && !image_init(&linear, exr.width, exr.height, 3, err)) {
        for (size_t k = 0; k < 3; k++) {
            const struct exr_plane *plane = exr_find(&exr, names[k]);
            const size_t pixels = (size_t)exr.width * (size_t)exr.height;
            for (size_t p = 0; p < pixels; p++) linear.data[3 * p + k] = plane->f[p];
        }
        image_to_srgb8(&linear, rgb);
    }
    image_release(&linear);
    exr_image_release(&exr);
    return err->status;
}

enum status encode_frames(const struct camera_path *path, const char *folder, const char *out,
                          const struct encode_params *params, struct err *err)
{
    const int width = path->frame_count ? path->frames[0].camera.width : 0;
    const int height = path->frame_count ? path->frames[0].camera.height : 0;
    const size_t bytes = 3 * (size_t)width * (size_t)height;
    const struct frame_quality quality = {params->preset, params->crf};
    struct frame_encoder encoder = {0};
    struct progress progress;
    unsigned char *rgb = NULL;

    if (!path->frame_count) return err_set(err, ST_DATA, "the path has no frames; plan it again.");
    if (width % 2 || height % 2)
        return err_set(err, ST_DATA,
                       "the path's frames have %d x %d pixels, wanted even sizes for H.264 with 4:2:0 chroma; plan the "
                       "path again.",
                       width, height);
    if (!(rgb = malloc(bytes))) return err_nomem(err, "a frame", bytes);

    progress_start(&progress, "encoding", path->frame_count, "frames");
    if (!read_frame(rgb, path, 0, folder, err) &&
        !frame_encoder_begin(&encoder, out, width, height, path->fps, &quality, err)) {
        for (frame_encoder_put(&encoder, rgb); !encoder.ended && encoder.written < path->frame_count;) {
            progress_add(&progress, 1);
            if (read_frame(rgb, path, encoder.written, folder, err)) break;
            frame_encoder_put(&encoder, rgb);
        }
        if (!err->status) frame_encoder_end(&encoder, path->frame_count, err);
    }
    progress_end(&progress);
    frame_encoder_release(&encoder);
    free(rgb);
    return err->status;
}
