/* frame_encoder.c - see frame_encoder.h.
 *
 * ffmpeg reads raw pictures from a pipe and writes to the temporary file of the output, which is committed only if
 * ffmpeg took every frame and exited with 0. */
#include "common/film/frame_encoder.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* x264's output depends on its number of threads, so the number is fixed */
#define ENCODER_THREADS "2"

/* primaries and transfer are set in the frames: ffmpeg 7 drops them as options of the output */
static const char rgb_filters[] = "scale=out_color_matrix=bt709:out_range=tv:flags=accurate_rnd+full_chroma_int+"
                                  "bitexact,format=yuv420p,setparams=color_primaries=bt709:color_trc=bt709";

enum { MAX_WORDS = 64, WORD = 512 };

struct command { /* of ffmpeg */
    const char *words[MAX_WORDS];
    int count;
    char size[32], rate[32], crf[16], preset[16], filters[256], codec[WORD];
};

static void add(struct command *c, const char *const *words)
{
    while (*words && c->count < MAX_WORDS - 1) c->words[c->count++] = *words++;
}
#define ADD(c, ...) add(c, (const char *const[]){__VA_ARGS__, NULL})

static const char *matrix_of(enum film_curve curve) { return curve == FILM_SRGB ? "bt709" : "bt2020nc"; }
static const char *primaries_of(enum film_curve curve) { return curve == FILM_SRGB ? "bt709" : "bt2020"; }

static const char *transfer_of(enum film_curve curve)
{
    return curve == FILM_SRGB ? "bt709" : curve == FILM_HLG ? "arib-std-b67" : "smpte2084";
}

/* SVT-AV1 numbers its presets; the slowest of these takes about as long as x265's. */
static int av1_preset(const char *preset)
{
    static const char *const presets[] = {"veryslow", "slower",   "slow",      "medium",   "fast",
                                          "faster",   "veryfast", "superfast", "ultrafast"};
    for (int i = 0; i < 9; i++)
        if (!strcmp(preset, presets[i])) return 4 + i;
    return 7;
}

static void add_x264(struct command *c, const struct frame_quality *q)
{
    ADD(c, "-preset", q->preset, "-crf", c->crf, "-threads", ENCODER_THREADS);
    /* televisions find it in the stream itself; headsets want the boxes alone */
    if (q->half_sphere || !q->stereo) return;
    ADD(c, "-x264-params", q->stereo == STEREO_SIDE_BY_SIDE ? "frame-packing=3" : "frame-packing=4");
}

static void add_x265(struct command *c, const struct frame_quality *q, enum film_curve curve)
{
    const int used = snprintf(c->codec, sizeof c->codec,
                              "log-level=error:info=0:pools=" ENCODER_THREADS ":frame-threads=1:repeat-headers=1:"
                              "colorprim=%s:transfer=%s:colormatrix=%s:range=limited:chromaloc=0",
                              primaries_of(curve), transfer_of(curve), matrix_of(curve));
    /* the mastering display: primaries and white of BT.2020, in 0.00002; light in 0.0001 cd/m2 [SMPTE 2018] */
    if (curve == FILM_PQ && used > 0 && used < WORD)
        snprintf(c->codec + used, sizeof c->codec - (size_t)used,
                 ":hdr10=1:hdr10-opt=1:master-display=G(8500,39850)B(6550,2300)R(35400,14600)WP(15635,16450)L(%.0f,1):"
                 "max-cll=%.0f,%.0f",
                 fmin(q->peak, 10000) * 10000, ceil(q->light.max_cll), ceil(q->light.max_fall));
    ADD(c, "-preset", q->preset, "-crf", c->crf, "-x265-params", c->codec, "-tag:v", "hvc1");
}

static void add_codec(struct command *c, const struct frame_quality *q, const struct film_format *format)
{
    ADD(c, "-c:v", format->encoder);
    if (!strcmp(format->name, "h264")) {
        add_x264(c, q);
    } else if (!strcmp(format->encoder, "libx265")) {
        add_x265(c, q, format->curve);
    } else if (!strcmp(format->name, "av1")) {
        snprintf(c->crf, sizeof c->crf, "%d", (q->crf * 63 + 25) / 51); /* its scale ends at 63 */
        snprintf(c->preset, sizeof c->preset, "%d", av1_preset(q->preset));
        setenv("SVT_LOG", "1", 0); /* errors only; it does not heed ffmpeg's -loglevel */
        snprintf(c->codec, sizeof c->codec, "lp=%s", ENCODER_THREADS);
        ADD(c, "-preset", c->preset, "-crf", c->crf, "-svtav1-params", c->codec);
    } else {
        ADD(c, "-profile:v", "hq", "-vendor", "apl0", "-threads", ENCODER_THREADS);
    }
}

static enum status start(struct frame_encoder *e, int width, int height, double fps, struct err *err)
{
    const struct frame_quality *q = &e->quality;
    const struct film_format *format = q->format;
    const char *primaries = primaries_of(format->curve), *transfer = transfer_of(format->curve);
    const char *matrix = matrix_of(format->curve);
    struct command c = {.count = 0};
    snprintf(c.size, sizeof c.size, "%dx%d", width, height);
    snprintf(c.rate, sizeof c.rate, "%.9g", fps);
    snprintf(c.crf, sizeof c.crf, "%d", q->crf);
    snprintf(c.filters, sizeof c.filters, "setparams=range=tv:color_primaries=%s:color_trc=%s:colorspace=%s", primaries,
             transfer, matrix);
    ADD(&c, "ffmpeg", "-hide_banner", "-loglevel", "error", "-y", "-f", "rawvideo", "-pix_fmt", format->samples);
    ADD(&c, "-video_size", c.size, "-framerate", c.rate, "-i", "pipe:0");
    ADD(&c, "-vf", format->depth == 8 ? rgb_filters : c.filters);
    add_codec(&c, q, format);
    ADD(&c, "-colorspace", matrix, "-color_primaries", primaries, "-color_trc", transfer, "-color_range", "tv");
    if (format->depth > 8) ADD(&c, "-chroma_sample_location", "left");
    ADD(&c, "-flags:v", "+bitexact", "-fflags", "+bitexact", "-map_metadata", "-1");
    ADD(&c, "-movflags", "+faststart", "-f", format->ending, e->file.temp);
    return process_start(&e->ffmpeg, c.words, NULL, err);
}

enum status frame_encoder_begin(struct frame_encoder *e, const char *path, int width, int height, double fps,
                                const struct frame_quality *quality, struct err *err)
{
    *e = (struct frame_encoder){.quality = *quality};
    if (!e->quality.format) e->quality.format = film_format_find("h264");
    e->bytes = film_format_bytes(e->quality.format, width, height);
    if (width % 2 || height % 2)
        return err_set(err, ST_DATA,
                       "%s: frames have %d x %d pixels, wanted even sizes, since pixels share their chroma.", path,
                       width, height);
    return outfile_open(&e->file, path, err) ? err->status : start(e, width, height, fps, err);
}

void frame_encoder_put(struct frame_encoder *e, const void *frame)
{
    if (!e->ended) e->ended = fwrite(frame, 1, e->bytes, e->ffmpeg.input) != e->bytes;
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
    if (e->quality.stereo && stereo_boxes_add(e->file.temp, e->quality.stereo, e->quality.half_sphere, err))
        return err->status;
    return outfile_commit(&e->file, err);
}

void frame_encoder_release(struct frame_encoder *e)
{
    process_kill(&e->ffmpeg);
    outfile_discard(&e->file);
    *e = (struct frame_encoder){.written = 0};
}
