/* exr_read.c - reads OpenEXR files.
 *
 * OpenEXRCore does headers, chunks and codecs other than ZIP (exr_zip.h). Samples are unpacked here, a row of a channel
 * at a time, so that only the wanted channels are converted and every sample is checked once. Chunks are read in
 * parallel. The layout of a chunk's bytes is described in exr_write.c. */
#include "common/image/exr.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <half.h>

#include "common/base/parallel.h"
#include "common/image/exr_file.h"
#include "common/image/exr_zip.h"
#include "common/math/lanes.h"

#define DEFLATE_RATIO 1032 /* bytes that one packed byte can stand for, at most (zlib's technical details) */

struct exr_reader {
    struct exr_image *im;
    exr_context_t ctxt;
    exr_attr_box2i_t window;
    bool any; /* NaN and infinity are allowed */
    bool tiled;
    int chunk_width, chunk_height, chunks_across;
    size_t chunks;
    int *plane_from_channel;      /* owned; -1: not wanted */
    exr_decode_pipeline_t *pipes; /* owned; one a thread */
    struct exr_zip *zips;         /* owned; one a thread */
    struct exr_chunk_fault *faults;
};

struct unpack_job {
    struct exr_reader *r;
    struct exr_zip *zip;
    struct exr_chunk_fault *fault;
    int x, y; /* the chunk's first pixel in the image */
};

static int unpack_half(float *to, const uint8_t *from, int width, bool any)
{
    int x = 0;
    for (; x + 8 <= width; x += 8) {
        const i16x8 bits = i16x8_load(from + 2 * x);
        if (i16x8_any((bits & 0x7c00) == 0x7c00)) break;
        uint16_t halves[8];
        memcpy(halves, from + 2 * x, sizeof halves);
        f32x8_store(to + x, f32x8_from_half(halves));
    }
    for (; x < width; x++) {
        uint16_t bits;
        memcpy(&bits, from + 2 * x, 2);
        if ((bits & 0x7c00) == 0x7c00 && !any) return x;
        to[x] = float_from_half(bits);
    }
    return -1;
}

static int unpack_float(float *to, const uint8_t *from, int width, bool any)
{
    memcpy(to, from, (size_t)width * 4);
    for (int x = 0; x < width && !any; x++)
        if (!isfinite(to[x])) return x;
    return -1;
}

static exr_result_t unpack_chunk(exr_decode_pipeline_t *pipe)
{
    const struct unpack_job *job = pipe->decoding_user_data;
    const struct exr_image *im = job->r->im;
    int width = pipe->chunk.width, height = pipe->chunk.height;
    const uint8_t *from = pipe->unpacked_buffer ? pipe->unpacked_buffer : pipe->packed_buffer;

    uint64_t row_bytes = 0;
    for (int c = 0; c < pipe->channel_count; c++)
        row_bytes += (uint64_t)width * (uint64_t)pipe->channels[c].bytes_per_element;
    if (width < 1 || height < 1 || width > im->width - job->x || height > im->height - job->y ||
        row_bytes * (uint64_t)height != pipe->chunk.unpacked_size)
        return EXR_ERR_CORRUPT_CHUNK;
    if (pipe->chunk.compression == EXR_COMPRESSION_NONE && pipe->chunk.packed_size != pipe->chunk.unpacked_size)
        return EXR_ERR_CORRUPT_CHUNK; /* the library would not fill the rest of the buffer */

    for (int row = 0; row < height; row++) {
        size_t at = (size_t)(job->y + row) * (size_t)im->width + (size_t)job->x;
        for (int c = 0; c < pipe->channel_count; c++) {
            int p = job->r->plane_from_channel[c], bad = -1;
            if (p >= 0) {
                const struct exr_plane *plane = &im->planes[p];
                if (plane->type == EXR_HALF)
                    bad = unpack_half(plane->f + at, from, width, job->r->any);
                else if (plane->type == EXR_FLOAT)
                    bad = unpack_float(plane->f + at, from, width, job->r->any);
                else
                    memcpy(plane->u + at, from, (size_t)width * 4);
            }
            if (bad >= 0) {
                *job->fault = (struct exr_chunk_fault){EXR_ERR_INVALID_ARGUMENT, p, job->x + bad, job->y + row};
                return EXR_ERR_INVALID_ARGUMENT;
            }
            from += (size_t)width * (size_t)pipe->channels[c].bytes_per_element;
        }
    }
    return EXR_ERR_SUCCESS;
}

static exr_result_t unzip_chunk(exr_decode_pipeline_t *pipe)
{
    static const exr_result_t results[] = {[EXR_ZIP_OK] = EXR_ERR_SUCCESS,
                                           [EXR_ZIP_DAMAGED] = EXR_ERR_CORRUPT_CHUNK,
                                           [EXR_ZIP_NOMEM] = EXR_ERR_OUT_OF_MEMORY};
    const struct unpack_job *job = pipe->decoding_user_data;
    const size_t packed = pipe->chunk.packed_size, size = pipe->chunk.unpacked_size;
    if (packed < size)
        return results[exr_zip_unpack(job->zip, pipe->packed_buffer, packed, pipe->unpacked_buffer, size)];
    if (packed > size) return EXR_ERR_CORRUPT_CHUNK;
    if (pipe->unpacked_buffer != pipe->packed_buffer) memcpy(pipe->unpacked_buffer, pipe->packed_buffer, size);
    return EXR_ERR_SUCCESS;
}

static exr_result_t chunk_info(const struct exr_reader *r, size_t chunk, exr_chunk_info_t *info)
{
    int across = (int)(chunk % (size_t)r->chunks_across), down = (int)(chunk / (size_t)r->chunks_across);
    if (r->tiled) return exr_read_tile_chunk_info(r->ctxt, 0, across, down, 0, 0, info);
    return exr_read_scanline_chunk_info(r->ctxt, 0, r->window.min.y + down * r->chunk_height, info);
}

/* Whether a chunk claims to unpack to more than Deflate can hold in its bytes. A damaged file of a few bytes must not
 * reserve gigabytes. */
static bool unpacks_to_too_much(const exr_chunk_info_t *info)
{
    return (info->compression == EXR_COMPRESSION_ZIP || info->compression == EXR_COMPRESSION_ZIPS) &&
           info->unpacked_size / DEFLATE_RATIO > info->packed_size;
}

static void decode_chunks(void *ctx, size_t begin, size_t end, int thread)
{
    struct exr_reader *r = ctx;
    exr_decode_pipeline_t *pipe = &r->pipes[thread];
    for (size_t i = begin; i < end; i++) {
        struct unpack_job job = {r, &r->zips[thread], &r->faults[i],
                                 (int)(i % (size_t)r->chunks_across) * r->chunk_width,
                                 (int)(i / (size_t)r->chunks_across) * r->chunk_height};
        exr_chunk_info_t info;
        exr_result_t rv = chunk_info(r, i, &info);
        if (!rv && unpacks_to_too_much(&info)) rv = EXR_ERR_CORRUPT_CHUNK;
        if (!rv && pipe->context) {
            rv = exr_decoding_update(r->ctxt, 0, &info, pipe);
        } else if (!rv) {
            rv = exr_decoding_initialize(r->ctxt, 0, &info, pipe);
            if (!rv) rv = exr_decoding_choose_default_routines(r->ctxt, 0, pipe);
            pipe->unpack_and_convert_fn = unpack_chunk;
            if (info.compression == EXR_COMPRESSION_ZIP || info.compression == EXR_COMPRESSION_ZIPS)
                pipe->decompress_fn = unzip_chunk;
        }
        if (!rv) {
            pipe->decoding_user_data = &job;
            rv = exr_decoding_run(r->ctxt, 0, pipe);
        }
        if (rv) { /* its buffers may be incomplete */
            exr_decoding_destroy(r->ctxt, pipe);
            *pipe = (exr_decode_pipeline_t)EXR_DECODE_PIPELINE_INITIALIZER;
            if (!job.fault->code) *job.fault = (struct exr_chunk_fault){rv, -1, 0, 0};
        }
    }
}

/* Adds the wanted planes and maps the file's channels to them. */
static enum status choose_channels(struct exr_reader *r, const char *path, const char *const *names, int name_count,
                                   struct err *err)
{
    const exr_attr_chlist_t *list = NULL;
    exr_result_t rv = exr_get_channels(r->ctxt, 0, &list);
    if (rv || list->num_channels < 1)
        return err_set(err, ST_DATA, "cannot read %s: it has no channels; make it again.", path);
    r->plane_from_channel = malloc((size_t)list->num_channels * sizeof(int));
    if (!r->plane_from_channel) return err_nomem(err, "a list of channels", (size_t)list->num_channels * sizeof(int));

    for (int c = 0; c < list->num_channels; c++) {
        const exr_attr_chlist_entry_t *entry = &list->entries[c];
        enum exr_type type = entry->pixel_type == EXR_PIXEL_UINT   ? EXR_UINT
                             : entry->pixel_type == EXR_PIXEL_HALF ? EXR_HALF
                                                                   : EXR_FLOAT;
        bool wanted = !names;
        for (int n = 0; n < name_count && names; n++) wanted |= !strcmp(names[n], entry->name.str);
        if (entry->x_sampling != 1 || entry->y_sampling != 1)
            return err_set(err, ST_DATA,
                           "cannot read %s: channel %s is subsampled; save the file with every channel at full size.",
                           path, entry->name.str);
        r->plane_from_channel[c] = wanted ? r->im->count : -1;
        if (wanted && exr_add_plane(r->im, entry->name.str, type, NULL, err))
            return err_context(err, "cannot read %s", path);
    }
    for (int n = 0; n < name_count && names; n++) {
        if (exr_find(r->im, names[n])) continue;
        char channels[1024] = "";
        for (int c = 0; c < list->num_channels; c++) {
            size_t length = strlen(channels);
            snprintf(channels + length, sizeof channels - length, " %s", list->entries[c].name.str);
        }
        return err_set(err, ST_DATA, "cannot read %s: it has no channel %s; it has%s.", path, names[n], channels);
    }
    return ST_OK;
}

/* Reads worldToCamera and the string attributes, except provenance, the format's own, and those of more than 255
 * bytes. */
static enum status read_attributes(struct exr_reader *r, struct err *err)
{
    int32_t count = 0;
    exr_get_pixel_aspect_ratio(r->ctxt, 0, &r->im->pixel_aspect_ratio);
    exr_get_attribute_count(r->ctxt, 0, &count);
    for (int32_t i = 0; i < count; i++) {
        const exr_attribute_t *a = NULL;
        if (exr_get_attribute_by_index(r->ctxt, 0, EXR_ATTR_LIST_FILE_ORDER, i, &a)) continue;
        if (a->type == EXR_ATTR_M44F && !strcmp(a->name, "worldToCamera")) {
            memcpy(r->im->world_to_camera, a->m44f->m, sizeof r->im->world_to_camera);
            r->im->has_world_to_camera = true;
            for (int k = 0; k < 16; k++) r->im->has_world_to_camera &= isfinite(a->m44f->m[k]) != 0;
        }
        if (a->type == EXR_ATTR_CHROMATICITIES && !strcmp(a->name, "chromaticities")) {
            const exr_attr_chromaticities_t *c = a->chromaticities;
            const float xy[8] = {c->red_x,  c->red_y,  c->green_x, c->green_y,
                                 c->blue_x, c->blue_y, c->white_x, c->white_y};
            memcpy(r->im->chromaticities, xy, sizeof xy);
            r->im->has_chromaticities = true;
        }
        if (a->type != EXR_ATTR_STRING || !a->string->str) continue;
        bool reserved = !strcmp(a->name, "type") || !strcmp(a->name, "name");
        for (int k = 0; k < EXR_PROVENANCE_COUNT; k++) reserved |= !strcmp(a->name, exr_provenance_names[k]);
        if (reserved || strlen(a->string->str) >= sizeof r->im->attributes[0][1]) continue;
        if (exr_set_attribute(r->im, a->name, a->string->str, err)) return err->status;
    }
    return ST_OK;
}

static enum status read_header(struct exr_reader *r, const char *path, struct err *err)
{
    exr_attr_box2i_t display = {0};
    exr_storage_t storage = EXR_STORAGE_LAST_TYPE;
    int parts = 0, rows = 0;
    exr_result_t rv = exr_get_count(r->ctxt, &parts);
    if (!rv) rv = exr_get_storage(r->ctxt, 0, &storage);
    if (!rv) rv = exr_get_data_window(r->ctxt, 0, &r->window);
    if (!rv) rv = exr_get_display_window(r->ctxt, 0, &display);
    if (rv) return exr_library_error(err, ST_DATA, "read", path, rv);
    if (parts != 1)
        return err_set(err, ST_DATA, "cannot read %s: it has %d parts; save the image in a file of one part.", path,
                       parts);
    if (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED)
        return err_set(err, ST_DATA, "cannot read %s: it holds deep data; save it flat, in scanlines or tiles.", path);

    int64_t width = (int64_t)r->window.max.x - r->window.min.x + 1,
            height = (int64_t)r->window.max.y - r->window.min.y + 1;
    if (width < 1 || height < 1 || width > EXR_MAX_PIXELS || height > EXR_MAX_PIXELS || width * height > EXR_MAX_PIXELS)
        return err_set(err, ST_DATA, "cannot read %s: its size is %lld x %lld; the limits are 1 and 2^28 pixels.", path,
                       (long long)width, (long long)height);
    if (width != (int64_t)display.max.x - display.min.x + 1 || height != (int64_t)display.max.y - display.min.y + 1)
        return err_set(
            err, ST_DATA,
            "cannot read %s: its data window of %lld x %lld differs in size from its display window; save it "
            "without crop or overscan.",
            path, (long long)width, (long long)height);
    if (exr_image_init(r->im, (int)width, (int)height, err)) return err->status;

    r->tiled = storage == EXR_STORAGE_TILED;
    r->chunk_width = (int)width;
    rv = r->tiled ? exr_get_tile_sizes(r->ctxt, 0, 0, 0, &r->chunk_width, &r->chunk_height)
                  : exr_get_scanlines_per_chunk(r->ctxt, 0, &rows);
    if (!r->tiled) r->chunk_height = rows;
    if (rv || r->chunk_width < 1 || r->chunk_height < 1) return exr_library_error(err, ST_DATA, "read", path, rv);
    r->chunks_across = (int)((width + r->chunk_width - 1) / r->chunk_width);
    r->chunks = (size_t)r->chunks_across * (size_t)((height + r->chunk_height - 1) / r->chunk_height);
    return ST_OK;
}

static int64_t read_bytes(exr_const_context_t ctxt, void *user, void *to, uint64_t size, uint64_t offset,
                          exr_stream_error_func_ptr_t error)
{
    const struct file_bytes *file = user;
    (void)ctxt, (void)error;
    if (offset >= file->size) return 0;
    if (size > file->size - offset) size = file->size - offset;
    memcpy(to, file->bytes + offset, size);
    return (int64_t)size;
}

static int64_t count_bytes(exr_const_context_t ctxt, void *user)
{
    (void)ctxt;
    return (int64_t)((const struct file_bytes *)user)->size;
}

/* file: the bytes, or NULL: they are read from the path as they are needed. */
static enum status read_file(struct exr_image *im, const char *path, struct file_bytes *file, const char *const *names,
                             int name_count, bool any, struct err *err)
{
    struct exr_reader r = {.im = im, .any = any};
    exr_context_initializer_t init = exr_library_init();
    exr_chunk_info_t info;
    int threads = parallel_threads();
    const int refused = exr_library_refused();

    *im = (struct exr_image){0};
    init.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION; /* a missing chunk is an error */
    if (file) {
        init.user_data = file;
        init.read_fn = read_bytes;
        init.size_fn = count_bytes;
    } else if (access(path, R_OK)) {
        return err_errno(err, "open", path);
    }
    exr_result_t rv = exr_start_read(&r.ctxt, path, &init);
    if (rv) exr_library_error(err, ST_DATA, "read", path, rv);
    if (!err->status) read_header(&r, path, err);
    /* this loads the table of chunks: the file is large enough for it before memory is allocated */
    if (!err->status && (rv = chunk_info(&r, 0, &info))) exr_library_error(err, ST_DATA, "read", path, rv);
    if (!err->status && unpacks_to_too_much(&info))
        err_set(err, ST_DATA,
                "cannot read %s: chunk 1 of %zu is too short for its pixels; it is damaged: make it again.", path,
                r.chunks);
    if (!err->status && !choose_channels(&r, path, names, name_count, err)) read_attributes(&r, err);
    if (!err->status && im->count > 0) { /* without channels only the header is read */
        r.pipes = calloc((size_t)threads, sizeof *r.pipes);
        r.zips = calloc((size_t)threads, sizeof *r.zips);
        r.faults = calloc(r.chunks, sizeof *r.faults);
        if (!r.pipes || !r.zips || !r.faults) err_nomem(err, "a list of chunks", r.chunks * sizeof *r.faults);
    }
    if (!err->status && im->count > 0) {
        parallel_for(r.chunks, 1, decode_chunks, &r);
        exr_first_fault(err, "read", path, "; it is damaged or cut off: make it again", im, r.faults, r.chunks);
    }

    for (int i = 0; r.pipes && i < threads; i++) exr_decoding_destroy(r.ctxt, &r.pipes[i]);
    for (int i = 0; r.zips && i < threads; i++) exr_zip_release(&r.zips[i]);
    free(r.pipes);
    free(r.zips);
    free(r.faults);
    free(r.plane_from_channel);
    if (r.ctxt) exr_finish(&r.ctxt);
    if (!err->status && exr_library_refused() != refused) err_nomem(err, "an EXR file", 0);
    if (err->status) exr_image_release(im);
    return err->status;
}

enum status exr_read(struct exr_image *im, const char *path, const char *const *names, int name_count, struct err *err)
{
    return read_file(im, path, NULL, names, name_count, false, err);
}

enum status exr_read_product(struct exr_image *im, enum product_id id, const char *path, const char *const *names,
                             int name_count, struct provenance *prov, struct err *err)
{
    const char *name = product_name(id, path);
    struct file_bytes file = {0};

    if (!prov || provenance_has(prov, name)) return exr_read(im, path, names, name_count, err);
    *im = (struct exr_image){0};
    if (!provenance_read(prov, name, &file, path, err)) read_file(im, path, &file, names, name_count, false, err);
    file_bytes_release(&file);
    return err->status;
}

enum status exr_read_any(struct exr_image *im, const char *path, struct err *err)
{
    return read_file(im, path, NULL, NULL, 0, true, err);
}
