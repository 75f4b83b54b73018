/* encode.c - see encode.h.
 *
 * ffmpeg reads raw RGB from a pipe and writes to the temporary file of the output, which is committed only if ffmpeg
 * took every frame and exited with 0. */
#include "stages/encode_video/encode.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/base/outfile.h"
#include "common/base/process.h"
#include "common/base/progress.h"
#include "common/image/exr.h"
#include "common/image/image.h"
#include "common/product/product.h"

#define PARAM_STRUCT struct encode_params
const struct param encode_param_table[] = {ENCODE_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

/* x264's output depends on its number of threads, so the number is fixed */
#define ENCODER_THREADS "2"

/* primaries and transfer are set in the frames: ffmpeg 7 drops them as options of the output */
static const char filters[] = "scale=out_color_matrix=bt709:out_range=tv:flags=accurate_rnd+full_chroma_int+bitexact,"
                              "format=yuv420p,setparams=color_primaries=bt709:color_trc=bt709";

static enum status start_encoder(struct process *ffmpeg, const struct camera_path *path, const char *file,
                                 const struct encode_params *params, struct err *err)
{
    const struct view *camera = &path->frames[0].camera;
    char size[32], rate[32], crf[16];

    snprintf(size, sizeof size, "%dx%d", camera->width, camera->height);
    snprintf(rate, sizeof rate, "%.9g", path->fps);
    snprintf(crf, sizeof crf, "%d", params->crf);
    /* clang-format off */
    const char *const argv[] = {
        "ffmpeg", "-hide_banner", "-loglevel", "error", "-y",
        "-f", "rawvideo", "-pix_fmt", "rgb24", "-video_size", size, "-framerate", rate, "-i", "pipe:0",
        "-vf", filters,
        "-c:v", "libx264", "-preset", params->preset, "-crf", crf, "-threads", ENCODER_THREADS,
        "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709", "-color_range", "tv",
        "-flags:v", "+bitexact", "-fflags", "+bitexact", "-map_metadata", "-1",
        "-movflags", "+faststart", "-f", "mp4", file, NULL,
    };
    /* clang-format on */
    return process_start(ffmpeg, argv, NULL, err);
}

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

static enum status check_result(int code, int written, const struct camera_path *path, const char *file,
                                struct err *err)
{
    struct stat info;
    if (code || written < path->frame_count)
        return err_set(err, ST_IO,
                       "ffmpeg ended with status %d after %d of %d frames; its messages are above or in the log.", code,
                       written, path->frame_count);
    if (stat(file, &info)) return err_errno(err, "read", file);
    if (info.st_size == 0)
        return err_set(err, ST_IO, "ffmpeg succeeded, but its output %s is empty; encode again.", file);
    return ST_OK;
}

enum status encode_frames(const struct camera_path *path, const char *folder, const char *out,
                          const struct encode_params *params, struct err *err)
{
    const int width = path->frame_count ? path->frames[0].camera.width : 0;
    const int height = path->frame_count ? path->frames[0].camera.height : 0;
    const size_t bytes = 3 * (size_t)width * (size_t)height;
    struct process ffmpeg = {0};
    struct outfile file = {0};
    struct progress progress;
    unsigned char *rgb = NULL;
    int written = 0, code = 0;

    if (!path->frame_count) return err_set(err, ST_DATA, "the path has no frames; plan it again.");
    if (width % 2 || height % 2)
        return err_set(err, ST_DATA,
                       "the path's frames have %d x %d pixels, wanted even sizes for H.264 with 4:2:0 chroma; plan the "
                       "path again.",
                       width, height);
    if (!(rgb = malloc(bytes))) return err_nomem(err, "a frame", bytes);

    progress_start(&progress, "encoding", path->frame_count, "frames");
    if (!read_frame(rgb, path, 0, folder, err) && !outfile_open(&file, out, err) &&
        !start_encoder(&ffmpeg, path, file.temp, params, err)) {
        while (fwrite(rgb, 1, bytes, ffmpeg.input) == bytes && ++written < path->frame_count) {
            progress_add(&progress, 1);
            if (read_frame(rgb, path, written, folder, err)) break;
        }
        if (err->status)
            process_kill(&ffmpeg);
        else if (!process_finish(&ffmpeg, &code, err))
            check_result(code, written, path, file.temp, err);
    }
    progress_end(&progress);
    if (!err->status) outfile_commit(&file, err);
    outfile_discard(&file);
    free(rgb);
    return err->status;
}
