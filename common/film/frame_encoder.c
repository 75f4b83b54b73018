/* frame_encoder.c - see frame_encoder.h.
 *
 * ffmpeg reads raw RGB from a pipe and writes to the temporary file of the output, which is committed only if ffmpeg
 * took every frame and exited with 0. */
#include "common/film/frame_encoder.h"

#include <stdio.h>
#include <sys/stat.h>

/* x264's output depends on its number of threads, so the number is fixed */
#define ENCODER_THREADS "2"

/* primaries and transfer are set in the frames: ffmpeg 7 drops them as options of the output */
static const char filters[] = "scale=out_color_matrix=bt709:out_range=tv:flags=accurate_rnd+full_chroma_int+bitexact,"
                              "format=yuv420p,setparams=color_primaries=bt709:color_trc=bt709";

static enum status start(struct frame_encoder *e, int width, int height, double fps,
                         const struct frame_quality *quality, struct err *err)
{
    char size[32], rate[32], crf[16];
    snprintf(size, sizeof size, "%dx%d", width, height);
    snprintf(rate, sizeof rate, "%.9g", fps);
    snprintf(crf, sizeof crf, "%d", quality->crf);
    /* clang-format off */
    const char *const argv[] = {
        "ffmpeg", "-hide_banner", "-loglevel", "error", "-y",
        "-f", "rawvideo", "-pix_fmt", "rgb24", "-video_size", size, "-framerate", rate, "-i", "pipe:0",
        "-vf", filters,
        "-c:v", "libx264", "-preset", quality->preset, "-crf", crf, "-threads", ENCODER_THREADS,
        "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709", "-color_range", "tv",
        "-flags:v", "+bitexact", "-fflags", "+bitexact", "-map_metadata", "-1",
        "-movflags", "+faststart", "-f", "mp4", e->file.temp, NULL,
    };
    /* clang-format on */
    return process_start(&e->ffmpeg, argv, NULL, err);
}

enum status frame_encoder_begin(struct frame_encoder *e, const char *path, int width, int height, double fps,
                                const struct frame_quality *quality, struct err *err)
{
    *e = (struct frame_encoder){.bytes = 3 * (size_t)width * (size_t)height};
    if (width % 2 || height % 2)
        return err_set(err, ST_DATA, "%s: frames have %d x %d pixels, wanted even sizes for H.264 with 4:2:0 chroma.",
                       path, width, height);
    return outfile_open(&e->file, path, err) ? err->status : start(e, width, height, fps, quality, err);
}

void frame_encoder_put(struct frame_encoder *e, const unsigned char *rgb)
{
    if (!e->ended) e->ended = fwrite(rgb, 1, e->bytes, e->ffmpeg.input) != e->bytes;
    if (!e->ended) e->written++;
}

enum status frame_encoder_end(struct frame_encoder *e, int frames, struct err *err)
{
    struct stat info;
    int code = 0;
    if (process_finish(&e->ffmpeg, &code, err)) return err->status;
    if (code || e->written < frames)
        return err_set(err, ST_IO,
                       "ffmpeg ended with status %d after %d of %d frames; its messages are above or in the log.", code,
                       e->written, frames);
    if (stat(e->file.temp, &info)) return err_errno(err, "read", e->file.temp);
    if (info.st_size == 0)
        return err_set(err, ST_IO, "ffmpeg succeeded, but its output %s is empty; encode again.", e->file.temp);
    return outfile_commit(&e->file, err);
}

void frame_encoder_release(struct frame_encoder *e)
{
    process_kill(&e->ffmpeg);
    outfile_discard(&e->file);
    *e = (struct frame_encoder){.written = 0};
}
