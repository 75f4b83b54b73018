/* clip_reader.c - the frames of a video.
 *
 * Samples. A frame's luma and chroma are taken to full size and 16 bits by libswscale, which does no arithmetic on
 * colours here. Range and matrix [ITU 2021] are applied in float, once, so that nothing is rounded to 8 bits on the way
 * if the clip has more. What the numbers mean is left to the code that reads photos: primaries and transfer are codes,
 * as in HEIC. A clip that does not state its matrix has that of BT.601 if it has fewer than 720 rows, as players
 * assume.
 *
 * Interlaced frames show two moments, in even and odd rows. The even rows are used; the odd ones are interpolated,
 * so that
 * all pictures of a clip lie half a pixel lower than they should, all alike.
 *
 * Damage. A decoder hides damage by repeating older pictures. Such a frame would be taken for a photo, so that a clip
 * with a damaged frame is refused. */
#include "stages/import_photos/clip_reader.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/display.h>
#include <libavutil/dovi_meta.h>
#include <libavutil/imgutils.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>

#include "common/base/parallel.h"
#include "common/image/photo_formats.h"

enum { SCALING = SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT | SWS_FULL_CHR_H_INP | SWS_BITEXACT };

struct clip_reader {
    const char *path; /* borrowed */
    AVFormatContext *format;
    AVCodecContext *decoder;
    AVStream *stream;
    AVPacket *packet;
    AVFrame *frame;
    struct SwsContext *to_grey, *to_samples;
    bool drained;         /* the decoder was told that there are no more packets */
    int next;             /* number of the next frame */
    double seconds;       /* of the present frame */
    double shown;         /* to when the packets are shown that were read */
    bool interlaced;      /* a frame is */
    int turn[4];          /* from stored to upright: x' = turn[0] x + turn[1] y, y' = turn[2] x + turn[3] y */
    int width, height;    /* of the upright picture */
    struct photo_info of; /* what the file says of its camera */
};

static enum status damaged(const struct clip_reader *c, int code, struct err *err)
{
    char why[AV_ERROR_MAX_STRING_SIZE] = "a frame is incomplete";
    if (code < 0) av_strerror(code, why, sizeof why);
    if (!c->decoder)
        return err_set(err, ST_DATA, "%s is damaged, cut off or no video (%s); copy the clip again.", c->path, why);
    return err_set(err, ST_DATA, "%s is damaged or cut off after %.1f s (%s); copy the clip again, or cut it there.",
                   c->path, c->seconds, why);
}

/* ---------------------------------------------------------------------------------------------------------- opening */

static const uint8_t *side_data(const AVStream *s, enum AVPacketSideDataType type)
{
#if LIBAVFORMAT_VERSION_MAJOR >= 61
    const AVPacketSideData *d =
        av_packet_side_data_get(s->codecpar->coded_side_data, s->codecpar->nb_coded_side_data, type);
    return d ? d->data : NULL;
#else
    return av_stream_get_side_data(s, type, NULL);
#endif
}

/* The matrix of the file, by quarter turns and mirrors. */
static void find_turn(struct clip_reader *c)
{
    const int32_t *m = (const int32_t *)side_data(c->stream, AV_PKT_DATA_DISPLAYMATRIX);
    c->turn[0] = c->turn[3] = 1;
    if (!m) return;
    const bool straight = abs(m[0]) >= abs(m[1]);
    c->turn[0] = !straight ? 0 : m[0] < 0 ? -1 : 1;
    c->turn[3] = !straight ? 0 : m[4] < 0 ? -1 : 1;
    c->turn[1] = straight ? 0 : m[3] < 0 ? -1 : 1;
    c->turn[2] = straight ? 0 : m[1] < 0 ? -1 : 1;
}

static const char *tag_of(const struct clip_reader *c, const char *const *names)
{
    for (int i = 0; names[i]; i++) {
        const AVDictionaryEntry *e = av_dict_get(c->format->metadata, names[i], NULL, 0);
        if (!e) e = av_dict_get(c->stream->metadata, names[i], NULL, 0);
        if (e && *e->value) return e->value;
    }
    return "";
}

static void read_tags(struct clip_reader *c)
{
    static const char *const makes[] = {"com.apple.quicktime.make", "com.android.manufacturer", "make", NULL};
    static const char *const models[] = {"com.apple.quicktime.model", "com.android.model", "model", NULL};
    static const char *const focals[] = {"com.apple.quicktime.camera.focal_length.35mm_equivalent", NULL};
    photo_keep_text(c->of.make, sizeof c->of.make, tag_of(c, makes), 60);
    photo_keep_text(c->of.model, sizeof c->of.model, tag_of(c, models), 60);
    static const char *const times[] = {"com.apple.quicktime.creationdate", "creation_time", NULL};
    char time[32] = ""; /* 2024-05-01T12:02:02... */
    photo_keep_text(time, sizeof time, tag_of(c, times), 19);
    if (strlen(time) == 19 && time[10] == 'T') {
        time[4] = time[7] = ':';
        time[10] = ' ';
        c->of.taken = photo_time(time, "");
    }
    const double focal = atof(tag_of(c, focals));
    if (focal > 1 && focal < 10000) c->of.focal35_mm = focal;
}

/* Pixels wider or higher than square ones are stretched. */
static void find_size(struct clip_reader *c)
{
    const AVRational aspect = av_guess_sample_aspect_ratio(c->format, c->stream, NULL);
    const double wide = aspect.num > 0 && aspect.den > 0 ? av_q2d(aspect) : 1;
    const int w = (int)lrint(c->decoder->width * fmax(wide, 1)), h = (int)lrint(c->decoder->height / fmin(wide, 1));
    c->width = c->turn[0] ? w : h;
    c->height = c->turn[0] ? h : w;
}

static enum status refuse_unreadable(const struct clip_reader *c, struct err *err)
{
    const AVDOVIDecoderConfigurationRecord *dolby =
        (const AVDOVIDecoderConfigurationRecord *)side_data(c->stream, AV_PKT_DATA_DOVI_CONF);
    if (!dolby || dolby->dv_profile != 5) return ST_OK;
    return err_set(err, ST_DATA,
                   "%s has the colours of Dolby Vision profile 5, which are not read here; export the clip as HLG, PQ "
                   "or SDR.",
                   c->path);
}

static enum status open_decoder(struct clip_reader *c, struct err *err)
{
    const AVCodec *codec = NULL;
    const int at = av_find_best_stream(c->format, AVMEDIA_TYPE_VIDEO, -1, -1, &codec, 0);
    if (at < 0 && at != AVERROR_DECODER_NOT_FOUND)
        return err_set(err, ST_DATA, "%s has no video stream; leave the file out, or give a video.", c->path);
    if (at < 0)
        return err_set(err, ST_DATA, "%s: libavcodec cannot decode its video; convert the clip to H.264 or HEVC.",
                       c->path);
    c->stream = c->format->streams[at];
    if (c->stream->disposition & AV_DISPOSITION_ATTACHED_PIC)
        return err_set(err, ST_DATA, "%s has no video stream, only a cover picture; leave the file out.", c->path);
    for (unsigned i = 0; i < c->format->nb_streams; i++)
        if ((int)i != at) c->format->streams[i]->discard = AVDISCARD_ALL;
    c->packet = av_packet_alloc();
    c->frame = av_frame_alloc();
    AVCodecContext *d = avcodec_alloc_context3(codec);
    if (!d || !c->packet || !c->frame || avcodec_parameters_to_context(d, c->stream->codecpar) < 0) {
        avcodec_free_context(&d);
        return err_nomem(err, "a video decoder", 0);
    }
    d->thread_count = parallel_threads();
    d->pkt_timebase = c->stream->time_base;
    const int code = avcodec_open2(d, codec, NULL);
    if (code >= 0 && d->width > 0 && d->height > 0 && d->pix_fmt != AV_PIX_FMT_NONE) {
        c->decoder = d;
        find_turn(c);
        find_size(c);
        read_tags(c);
        return photo_check_size(c->path, (uint64_t)c->width, (uint64_t)c->height, err) || refuse_unreadable(c, err)
                   ? err->status
                   : ST_OK;
    }
    avcodec_free_context(&d);
    return damaged(c, code < 0 ? code : AVERROR_INVALIDDATA, err);
}

enum status clip_open(struct clip_reader **clip, const char *path, struct err *err)
{
    struct clip_reader *c = calloc(1, sizeof *c);
    AVDictionary *options = NULL;
    char *url = NULL;
    *clip = c;
    if (!c || asprintf(&url, "file:%s", path) < 0) return err_nomem(err, "a video reader", sizeof *c);
    c->path = path;
    av_log_set_level(AV_LOG_QUIET);
    av_dict_set(&options, "protocol_whitelist", "file", 0); /* a clip refers to nothing else */
    av_dict_set(&options, "format_whitelist", "mov,mp4,m4a,3gp,3g2,mj2,matroska,webm,avi", 0);
    int code = avformat_open_input(&c->format, url, NULL, &options);
    if (code >= 0) code = avformat_find_stream_info(c->format, NULL);
    av_dict_free(&options);
    free(url);
    if (code == AVERROR(ENOENT) || code == AVERROR(EACCES) || code == AVERROR(EISDIR)) {
        errno = AVUNERROR(code);
        return err_errno(err, "open", path);
    }
    return code < 0 ? damaged(c, code, err) : open_decoder(c, err);
}

/* --------------------------------------------------------------------------------------------------------- decoding */

/* Since the clip began. */
static double seconds_of(const struct clip_reader *c, int64_t time)
{
    const int64_t begin = c->stream->start_time == AV_NOPTS_VALUE ? 0 : c->stream->start_time;
    return (double)(time - begin) * av_q2d(c->stream->time_base);
}

/* Gives the decoder the stream's next packet, or the end. */
static enum status feed(struct clip_reader *c, struct err *err)
{
    int code = av_read_frame(c->format, c->packet);
    if (code == AVERROR_EOF) {
        c->drained = true;
        code = avcodec_send_packet(c->decoder, NULL);
        return code < 0 && code != AVERROR_EOF ? damaged(c, code, err) : ST_OK;
    }
    if (code < 0) return damaged(c, code, err);
    const bool ours = c->packet->stream_index == c->stream->index, whole = !(c->packet->flags & AV_PKT_FLAG_CORRUPT);
    if (ours && c->packet->pts != AV_NOPTS_VALUE && c->packet->duration > 0)
        c->shown = fmax(c->shown, seconds_of(c, c->packet->pts + c->packet->duration));
    if (ours && whole) code = avcodec_send_packet(c->decoder, c->packet);
    av_packet_unref(c->packet);
    return ours && (!whole || code < 0) ? damaged(c, code, err) : ST_OK;
}

/* The last packet of a file that was cut off may be whole. A whole file may show its last frame for long. */
static enum status check_end(const struct clip_reader *c, struct err *err)
{
    const double wanted = c->stream->duration > 0 ? (double)c->stream->duration * av_q2d(c->stream->time_base) : 0;
    const double frame = c->next > 1 ? c->seconds / (c->next - 1) : 0;
    return c->next && fmax(c->shown, c->seconds + 1.5 * frame) + 0.5 < wanted ? damaged(c, AVERROR_EOF, err) : ST_OK;
}

static bool is_interlaced(const AVFrame *f)
{
#ifdef AV_FRAME_FLAG_INTERLACED
    return f->flags & AV_FRAME_FLAG_INTERLACED && f->height > 1;
#else
    return f->interlaced_frame && f->height > 1;
#endif
}

bool clip_next(struct clip_reader *c, struct clip_frame *frame, struct err *err)
{
    int code;
    av_frame_unref(c->frame);
    while ((code = avcodec_receive_frame(c->decoder, c->frame)) == AVERROR(EAGAIN))
        if (c->drained || feed(c, err)) return false;
    if (code == AVERROR_EOF) {
        if (!c->next)
            err_set(err, ST_DATA, "%s contains no frames; copy the clip again, or leave it out.", c->path);
        else
            check_end(c, err);
        return false;
    }
    if (code < 0 || c->frame->decode_error_flags || c->frame->flags & AV_FRAME_FLAG_CORRUPT) {
        damaged(c, code, err);
        return false;
    }
    if (c->frame->best_effort_timestamp != AV_NOPTS_VALUE) c->seconds = seconds_of(c, c->frame->best_effort_timestamp);
    c->interlaced |= is_interlaced(c->frame);
    *frame = (struct clip_frame){c->next++, c->seconds};
    return true;
}

/* --------------------------------------------------------------------------------------------------------- pictures */

bool clip_is_interlaced(const struct clip_reader *c) { return c->interlaced; }

void clip_size(const struct clip_reader *c, int longest, int *width, int *height)
{
    const int w = c->turn[0] ? c->width : c->height, h = c->turn[0] ? c->height : c->width;
    const double scale = fmin(1, (double)longest / (w > h ? w : h));
    *width = (int)fmax(1, lrint(w * scale));
    *height = (int)fmax(1, lrint(h * scale));
}

static enum status no_scaler(const struct clip_reader *c, struct err *err)
{
    const char *name = av_get_pix_fmt_name(c->frame->format);
    return err_set(err, ST_DATA, "%s: frames of the kind %s cannot be converted; convert the clip to H.264 or HEVC.",
                   c->path, name ? name : "unknown");
}

/* Scales the frame without a change of its numbers. */
static enum status scale_frame(const struct clip_reader *c, struct SwsContext **scaler, uint8_t *const to[4],
                               const int stride[4], int width, int height, enum AVPixelFormat format, int method,
                               struct err *err)
{
    const AVFrame *f = c->frame;
    const int *matrix = sws_getCoefficients(SWS_CS_DEFAULT);
    const int every = is_interlaced(f) ? 2 : 1, rows = (f->height + every - 1) / every;
    int from[4];
    for (int i = 0; i < 4; i++) from[i] = every * f->linesize[i];
    *scaler = sws_getCachedContext(*scaler, f->width, rows, f->format, width, height, format, method | SCALING, NULL,
                                   NULL, NULL);
    if (!*scaler) return no_scaler(c, err);
    sws_setColorspaceDetails(*scaler, matrix, 1, matrix, 1, 0, 1 << 16, 1 << 16); /* both "full": as they are */
    if (sws_scale(*scaler, (const uint8_t *const *)f->data, from, 0, rows, to, stride) < 0) return no_scaler(c, err);
    return ST_OK;
}

enum status clip_grey(struct clip_reader *c, unsigned char *grey, int width, int height, struct err *err)
{
    uint8_t *const to[4] = {grey};
    const int stride[4] = {width};
    return scale_frame(c, &c->to_grey, to, stride, width, height, AV_PIX_FMT_GRAY8, SWS_AREA, err);
}

/* Kr and Kb of the matrix; false: it is none of luma and chroma by constant weights. */
static bool weights(const struct clip_reader *c, double *kr, double *kb)
{
    enum AVColorSpace code = c->frame->colorspace;
    if (code == AVCOL_SPC_UNSPECIFIED || code == AVCOL_SPC_RESERVED)
        code = c->frame->colorspace = c->frame->height < 720 ? AVCOL_SPC_SMPTE170M : AVCOL_SPC_BT709;
    switch (code) {
    case AVCOL_SPC_BT709:
        return *kr = 0.2126, *kb = 0.0722, true;
    case AVCOL_SPC_BT470BG:
    case AVCOL_SPC_SMPTE170M:
        return *kr = 0.299, *kb = 0.114, true;
    case AVCOL_SPC_FCC:
        return *kr = 0.30, *kb = 0.11, true;
    case AVCOL_SPC_SMPTE240M:
        return *kr = 0.212, *kb = 0.087, true;
    case AVCOL_SPC_BT2020_NCL:
        return *kr = 0.2627, *kb = 0.0593, true;
    default:
        return false;
    }
}

struct paint_job {
    const struct clip_reader *clip;
    const uint16_t *planes[3]; /* of the stored picture: Y, Cb, Cr, or G, B, R */
    int width, height;         /* of the stored picture */
    double kr, kb;
    bool rgb, full;
    struct photo *to;
};

static double sample_of(double value, double largest)
{
    return fmin(fmax(value, 0), 1) * largest; /* NaN cannot occur: values come from integers */
}

static void paint_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct paint_job *j = ctx;
    const int *turn = j->clip->turn;
    /* samples of n bits are shifted up to 16: black, and the ranges of luma and chroma */
    const double black = j->full ? 0 : 16 * 256, largest = j->to->info.bits == 16 ? 65535 : 255;
    const double depth = fmin(16, av_pix_fmt_desc_get(j->clip->frame->format)->comp[0].depth);
    const double top = (exp2(depth) - 1) * exp2(16 - depth);
    const double luma = j->full ? top : 219 * 256, chroma = j->full ? top : 224 * 256, middle = 128 * 256;
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (size_t x = 0; x < (size_t)j->width; x++) {
            const size_t at = y * (size_t)j->width + x;
            double p[3], rgb[3];
            for (int k = 0; k < 3; k++) p[k] = j->planes[k][at];
            const double l = (p[0] - black) / luma, b = (p[1] - middle) / chroma, r = (p[2] - middle) / chroma;
            rgb[0] = j->rgb ? (p[2] - black) / luma : l + 2 * (1 - j->kr) * r;
            rgb[2] = j->rgb ? (p[1] - black) / luma : l + 2 * (1 - j->kb) * b;
            rgb[1] = j->rgb ? l : (l - j->kr * rgb[0] - j->kb * rgb[2]) / (1 - j->kr - j->kb);
            const int ux = turn[0] * (int)x + turn[1] * (int)y, uy = turn[2] * (int)x + turn[3] * (int)y;
            const size_t to_x = (size_t)(turn[0] + turn[1] < 0 ? j->to->info.width - 1 + ux : ux),
                         to_y = (size_t)(turn[2] + turn[3] < 0 ? j->to->info.height - 1 + uy : uy);
            uint16_t *to = j->to->samples + 3 * (to_y * (size_t)j->to->info.width + to_x);
            for (int k = 0; k < 3; k++) to[k] = (uint16_t)lrint(sample_of(rgb[k], largest));
        }
}

enum status clip_photo(struct clip_reader *c, struct photo *p, struct err *err)
{
    const AVFrame *f = c->frame;
    const AVPixFmtDescriptor *kind = av_pix_fmt_desc_get(f->format);
    struct paint_job job = {.clip = c, .to = p, .width = c->turn[0] ? c->width : c->height};
    const size_t pixels = (size_t)c->width * (size_t)c->height;
    uint8_t *to[4] = {0};
    int stride[4] = {0};
    if (!kind) return no_scaler(c, err);
    *p = (struct photo){.info = c->of};
    p->info.width = c->width;
    p->info.height = c->height;
    p->info.orientation = 1;
    p->info.bits = kind->comp[0].depth > 8 ? 16 : 8;
    job.height = (int)(pixels / (size_t)job.width);
    job.rgb = (kind->flags & AV_PIX_FMT_FLAG_RGB) != 0;
    job.full = job.rgb ? f->color_range != AVCOL_RANGE_MPEG : f->color_range == AVCOL_RANGE_JPEG;
    if (kind->nb_components < 3 && !(kind->flags & AV_PIX_FMT_FLAG_PAL))
        job.kr = job.kb = 1.0 / 3; /* grey */
    else if (!job.rgb && !weights(c, &job.kr, &job.kb))
        return err_set(err, ST_DATA,
                       "%s: its colours have the matrix %s, which is not read here; export the clip as "
                       "HLG, PQ or SDR.",
                       c->path, av_color_space_name(f->colorspace) ? av_color_space_name(f->colorspace) : "unknown");
    uint16_t *planes = malloc(3 * pixels * sizeof *planes);
    if (!planes) return err_nomem(err, "a frame", 3 * pixels * sizeof *planes);
    for (int k = 0; k < 3; k++) {
        to[k] = (uint8_t *)(planes + (size_t)k * pixels);
        job.planes[k] = planes + (size_t)k * pixels;
        stride[k] = job.width * 2;
    }
    scale_frame(c, &c->to_samples, to, stride, job.width, job.height,
                job.rgb ? AV_PIX_FMT_GBRP16LE : AV_PIX_FMT_YUV444P16LE, SWS_BICUBIC, err);
    if (!err->status && !photo_init_samples(p, err)) parallel_for((size_t)job.height, 16, paint_rows, &job);
    if (!err->status)
        photo_set_codes(p, f->color_primaries == AVCOL_PRI_RESERVED0 ? AVCOL_PRI_UNSPECIFIED : (int)f->color_primaries,
                        f->color_trc == AVCOL_TRC_RESERVED0 ? AVCOL_TRC_UNSPECIFIED : (int)f->color_trc, c->path, err);
    free(planes);
    if (err->status) photo_release(p);
    return err->status;
}

void clip_close(struct clip_reader *c)
{
    if (!c) return;
    sws_freeContext(c->to_grey);
    sws_freeContext(c->to_samples);
    av_frame_free(&c->frame);
    av_packet_free(&c->packet);
    avcodec_free_context(&c->decoder);
    avformat_close_input(&c->format);
    free(c);
}
