/* photo_webp.c - WebP files, by libwebp. Alpha is counted. Animations are refused. */
#include "common/image/photo_formats.h"

#include <stdlib.h>

#include <webp/decode.h>
#include <webp/demux.h>

static enum status read_webp_exif(struct photo_info *info, const WebPDemuxer *demuxer, struct err *err)
{
    WebPChunkIterator chunk;
    if (demuxer && WebPDemuxGetChunk(demuxer, "EXIF", 1, &chunk)) {
        photo_exif_take(info, chunk.chunk.bytes, chunk.chunk.size, err);
        WebPDemuxReleaseChunkIterator(&chunk);
    }
    return err->status;
}

static enum status read_webp_colours(struct photo *p, const WebPDemuxer *demuxer, bool pixels, const char *path,
                                     struct err *err)
{
    WebPChunkIterator chunk;
    if (!demuxer || !WebPDemuxGetChunk(demuxer, "ICCP", 1, &chunk)) return photo_set_icc(p, NULL, 0, pixels, path, err);
    photo_set_icc(p, chunk.chunk.bytes, chunk.chunk.size, pixels, path, err);
    WebPDemuxReleaseChunkIterator(&chunk);
    return err->status;
}

static enum status read_webp_pixels(struct photo *p, const struct photo_bytes *file, struct err *err)
{
    const size_t pixels = (size_t)p->info.width * (size_t)p->info.height;
    unsigned char *rgba = malloc(4 * pixels);
    size_t hidden = 0;
    if (!rgba) return err_nomem(err, "a photo", 4 * pixels);
    if (!WebPDecodeRGBAInto(file->bytes, file->size, rgba, 4 * pixels, 4 * p->info.width))
        err_set(err, ST_DATA, "%s is a damaged or cut-off WebP file; copy or export the photo again.", file->path);
    else
        photo_init_samples(p, err);
    for (size_t i = 0; !err->status && i < pixels; i++) {
        for (size_t c = 0; c < 3; c++) p->samples[3 * i + c] = rgba[4 * i + c];
        hidden += rgba[4 * i + 3] < 128;
    }
    p->transparent = (double)hidden / (double)pixels;
    free(rgba);
    return err->status;
}

enum status photo_read_webp(struct photo *p, const struct photo_bytes *file, bool pixels, struct err *err)
{
    WebPBitstreamFeatures features;
    if (WebPGetFeatures(file->bytes, file->size, &features) != VP8_STATUS_OK)
        return err_set(err, ST_DATA, "%s is a damaged or cut-off WebP file; copy or export the photo again.",
                       file->path);
    if (features.has_animation)
        return err_set(err, ST_DATA, "%s is an animated WebP file; export one photo as JPEG or PNG.", file->path);
    p->info.width = features.width;
    p->info.height = features.height;
    p->info.bits = 8;
    if (photo_check_size(file->path, (uint64_t)features.width, (uint64_t)features.height, err)) return err->status;
    const WebPData data = {file->bytes, file->size};
    WebPDemuxer *demuxer = WebPDemux(&data);
    if (!read_webp_exif(&p->info, demuxer, err) && (!pixels || !read_webp_pixels(p, file, err)))
        read_webp_colours(p, demuxer, pixels, file->path, err);
    WebPDemuxDelete(demuxer);
    return err->status;
}
