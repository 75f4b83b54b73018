/* exr_write.c - writes OpenEXR files.
 *
 * OpenEXRCore does headers, chunks and codecs other than ZIP (exr_zip.h). Samples are packed here, a row of a channel
 * at a time, so that every sample is checked once and converted with SIMD instructions. Chunks are compressed in
 * parallel and written in order.
 *
 * The uncompressed bytes of a chunk are those of the format: for each row, for each channel in order of name, the row's
 * samples, little-endian like the machines that this program is built for. */
#include "common/image/exr.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <half.h>

#include "common/base/outfile.h"
#include "common/base/parallel.h"
#include "common/image/exr_file.h"
#include "common/image/exr_zip.h"
#include "common/math/lanes.h"

#define ZIP_ROWS   16
#define MAX_HALF   65504.0F
#define SHORT_NAME 31 /* longer names need a flag in the file's version */

struct packed_chunk {
    void *bytes; /* owned */
    size_t size;
};

struct exr_writer {
    const struct exr_image *im;
    exr_context_t ctxt;
    int part;
    exr_chunk_info_t *infos;
    struct packed_chunk *packed;
    exr_encode_pipeline_t *pipes; /* owned; one a thread */
    struct exr_zip *zips;         /* owned; one a thread */
    struct exr_chunk_fault *faults;
    size_t chunks;
    int rows; /* of a chunk */
};

struct pack_job {
    struct exr_writer *w;
    struct exr_zip *zip;
    size_t chunk;
};

/* Pack a row as half or float. Return the column of the first sample that cannot be written, or -1. */
static int pack_half(uint8_t *to, const float *from, int width)
{
    int x = 0;
    for (; x + 8 <= width; x += 8) {
        const f32x8 v = f32x8_load(from + x);
        if (i32x8_signs(v <= INFINITY) != 0xFF) break; /* the loop below finds the NaN */
        uint16_t halves[8];
        f32x8_to_half(halves, f32x8_min(f32x8_max(v, f32x8_all(-MAX_HALF)), f32x8_all(MAX_HALF)));
        memcpy(to + 2 * x, halves, sizeof halves);
    }
    for (; x < width; x++) {
        if (isnan(from[x])) return x;
        const float clamped = from[x] > MAX_HALF ? MAX_HALF : from[x] < -MAX_HALF ? -MAX_HALF : from[x];
        const uint16_t bits = half_from_float(clamped);
        memcpy(to + 2 * x, &bits, 2);
    }
    return -1;
}

static int pack_float(uint8_t *to, const float *from, int width)
{
    for (int x = 0; x < width; x++)
        if (!isfinite(from[x])) return x;
    memcpy(to, from, (size_t)width * 4);
    return -1;
}

static exr_result_t pack_chunk(exr_encode_pipeline_t *pipe)
{
    const struct pack_job *job = pipe->encoding_user_data;
    const struct exr_image *im = job->w->im;
    uint8_t *to = pipe->packed_buffer;
    for (int y = pipe->chunk.start_y; y < pipe->chunk.start_y + pipe->chunk.height; y++) {
        for (int c = 0; c < pipe->channel_count; c++) {
            const struct exr_plane *plane = exr_find(im, pipe->channels[c].channel_name);
            size_t row = (size_t)y * (size_t)im->width;
            int bad = -1;
            if (plane->type == EXR_HALF)
                bad = pack_half(to, plane->f + row, im->width);
            else if (plane->type == EXR_FLOAT)
                bad = pack_float(to, plane->f + row, im->width);
            else
                memcpy(to, plane->u + row, (size_t)im->width * 4);
            if (bad >= 0) {
                job->w->faults[job->chunk] =
                    (struct exr_chunk_fault){EXR_ERR_INVALID_ARGUMENT, (int)(plane - im->planes), bad, y};
                return EXR_ERR_INVALID_ARGUMENT;
            }
            to += (size_t)im->width * (plane->type == EXR_HALF ? 2 : 4);
        }
    }
    pipe->packed_bytes = (uint64_t)(to - (uint8_t *)pipe->packed_buffer);
    return EXR_ERR_SUCCESS;
}

static bool zips(const struct exr_image *im) { return im->codec == EXR_ZIP || im->codec == EXR_ZIPS; }

/* Replaces the library's write function: chunks are compressed in any order and written in order by write_chunks(). */
static exr_result_t keep_chunk(exr_encode_pipeline_t *pipe)
{
    const struct pack_job *job = pipe->encoding_user_data;
    struct packed_chunk *packed = &job->w->packed[job->chunk];
    const void *bytes = pipe->compressed_buffer;
    packed->size = pipe->compressed_bytes;
    if (zips(job->w->im)) {
        if (!exr_zip_pack(job->zip, pipe->packed_buffer, pipe->packed_bytes, &packed->size))
            return EXR_ERR_OUT_OF_MEMORY;
        bytes = packed->size < pipe->packed_bytes ? job->zip->bytes : pipe->packed_buffer;
    }
    packed->bytes = malloc(packed->size ? packed->size : 1);
    if (!packed->bytes) return EXR_ERR_OUT_OF_MEMORY;
    memcpy(packed->bytes, bytes, packed->size);
    return EXR_ERR_SUCCESS;
}

static void compress_chunks(void *ctx, size_t begin, size_t end, int thread)
{
    struct exr_writer *w = ctx;
    exr_encode_pipeline_t *pipe = &w->pipes[thread];
    for (size_t i = begin; i < end; i++) {
        struct pack_job job = {w, &w->zips[thread], i};
        exr_result_t rv = EXR_ERR_SUCCESS;
        if (pipe->context) {
            rv = exr_encoding_update(w->ctxt, w->part, &w->infos[i], pipe);
        } else {
            rv = exr_encoding_initialize(w->ctxt, w->part, &w->infos[i], pipe);
            if (!rv) rv = exr_encoding_choose_default_routines(w->ctxt, w->part, pipe);
            pipe->convert_and_pack_fn = pack_chunk;
            pipe->yield_until_ready_fn = NULL; /* write_chunks() keeps the order */
            pipe->write_fn = keep_chunk;
            if (zips(w->im)) pipe->compress_fn = NULL; /* keep_chunk() compresses */
        }
        if (!rv) {
            pipe->encoding_user_data = &job;
            for (int c = 0; c < pipe->channel_count; c++) /* not used by pack_chunk(), but the library refuses NULL */
                pipe->channels[c].encode_from_ptr = (const uint8_t *)w->im->planes;
            rv = exr_encoding_run(w->ctxt, w->part, pipe);
        }
        if (rv) { /* its buffers may be incomplete */
            exr_encoding_destroy(w->ctxt, pipe);
            *pipe = (exr_encode_pipeline_t)EXR_ENCODE_PIPELINE_INITIALIZER;
            if (!w->faults[i].code) w->faults[i] = (struct exr_chunk_fault){rv, -1, 0, 0};
        }
    }
}

static exr_result_t write_header(struct exr_writer *w, const struct provenance *prov, const char *inputs)
{
    static const exr_attr_chromaticities_t rec709 = {0.64F, 0.33F, 0.30F, 0.60F, 0.15F, 0.06F, 0.3127F, 0.3290F};
    static const exr_pixel_type_t type[] = {
        [EXR_UINT] = EXR_PIXEL_UINT, [EXR_HALF] = EXR_PIXEL_HALF, [EXR_FLOAT] = EXR_PIXEL_FLOAT};
    static const exr_compression_t codec[] = {[EXR_ZIP] = EXR_COMPRESSION_ZIP,
                                              [EXR_ZIPS] = EXR_COMPRESSION_ZIPS,
                                              [EXR_RLE] = EXR_COMPRESSION_RLE,
                                              [EXR_NONE] = EXR_COMPRESSION_NONE};
    const struct exr_image *im = w->im;
    exr_result_t rv = exr_add_part(w->ctxt, NULL, EXR_STORAGE_SCANLINE, &w->part);
    if (!rv) rv = exr_initialize_required_attr_simple(w->ctxt, w->part, im->width, im->height, codec[im->codec]);
    bool long_names = false;
    for (int i = 0; i < im->count; i++) long_names |= strlen(im->planes[i].name) > SHORT_NAME;
    for (int i = 0; i < im->attribute_count; i++) long_names |= strlen(im->attributes[i][0]) > SHORT_NAME;
    if (!rv && long_names) rv = exr_set_longname_support(w->ctxt, 1);
    for (int i = 0; !rv && i < im->count; i++) /* the library sorts them by name */
        rv = exr_add_channel(w->ctxt, w->part, im->planes[i].name, type[im->planes[i].type],
                             EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    if (!rv) rv = exr_attr_set_chromaticities(w->ctxt, w->part, "chromaticities", &rec709);
    if (!rv && im->has_world_to_camera) {
        exr_attr_m44f_t m;
        memcpy(m.m, im->world_to_camera, sizeof m.m);
        rv = exr_attr_set_m44f(w->ctxt, w->part, "worldToCamera", &m);
    }
    if (prov && prov->stage) {
        const char *values[] = {prov->stage, prov->version ? prov->version : "", prov->params ? prov->params : "",
                                inputs};
        for (int i = 0; !rv && i < 4; i++)
            rv = exr_attr_set_string(w->ctxt, w->part, exr_provenance_names[i], values[i]);
    }
    for (int i = 0; !rv && i < im->attribute_count; i++)
        rv = exr_attr_set_string(w->ctxt, w->part, im->attributes[i][0], im->attributes[i][1]);
    if (!rv) rv = exr_write_header(w->ctxt);
    return rv;
}

static enum status write_chunks(struct exr_writer *w, const char *path, struct err *err)
{
    w->rows = w->im->codec == EXR_ZIP ? ZIP_ROWS : 1;
    w->chunks = ((size_t)w->im->height + (size_t)w->rows - 1) / (size_t)w->rows;
    w->infos = calloc(w->chunks, sizeof *w->infos);
    w->packed = calloc(w->chunks, sizeof *w->packed);
    w->faults = calloc(w->chunks, sizeof *w->faults);
    w->pipes = calloc((size_t)parallel_threads(), sizeof *w->pipes);
    w->zips = calloc((size_t)parallel_threads(), sizeof *w->zips);
    if (!w->infos || !w->packed || !w->faults || !w->pipes || !w->zips)
        return err_nomem(err, "a list of chunks", w->chunks * sizeof *w->infos);

    exr_result_t rv = EXR_ERR_SUCCESS;
    for (size_t i = 0; !rv && i < w->chunks; i++)
        rv = exr_write_scanline_chunk_info(w->ctxt, w->part, (int)i * w->rows, &w->infos[i]);
    if (rv) return exr_library_error(err, ST_INTERNAL, "write", path, rv);

    parallel_for(w->chunks, 1, compress_chunks, w);
    for (int i = 0; i < parallel_threads(); i++) {
        exr_encoding_destroy(w->ctxt, &w->pipes[i]);
        exr_zip_release(&w->zips[i]);
    }
    exr_first_fault(err, "write", path, "", w->im, w->faults, w->chunks);
    for (size_t i = 0; !err->status && i < w->chunks; i++) {
        rv = exr_write_scanline_chunk(w->ctxt, w->part, (int)i * w->rows, w->packed[i].bytes, w->packed[i].size);
        if (rv) exr_library_error(err, ST_IO, "write", path, rv);
    }
    return err->status;
}

enum status exr_write(const struct exr_image *im, const char *path, const struct provenance *prov, struct err *err)
{
    struct exr_writer w = {.im = im};
    struct outfile file = {0};
    exr_context_initializer_t init = exr_library_init();
    char *inputs = NULL;
    exr_result_t rv = EXR_ERR_SUCCESS;

    if (im->count < 1) return err_set(err, ST_INTERNAL, "cannot write %s: the image has no channels.", path);
    if (prov && prov->stage && !(inputs = provenance_inputs_text(prov)))
        return err_nomem(err, "a list of inputs", (size_t)prov->count * (HASH_TEXT + 1));
    if (!outfile_open(&file, path, err)) {
        rv = exr_start_write(&w.ctxt, file.temp, EXR_WRITE_FILE_DIRECTLY, &init);
        if (!rv) rv = write_header(&w, prov, inputs);
        if (rv) exr_library_error(err, ST_IO, "write", path, rv);
    }
    if (!err->status) write_chunks(&w, path, err);
    if (w.ctxt) { /* writes the table of chunks */
        rv = exr_finish(&w.ctxt);
        if (!err->status && rv) exr_library_error(err, ST_IO, "write", path, rv);
    }
    if (!err->status) outfile_commit(&file, err);

    outfile_discard(&file);
    free(w.pipes);
    free(w.zips);
    for (size_t i = 0; w.packed && i < w.chunks; i++) free(w.packed[i].bytes);
    free(w.infos);
    free(w.packed);
    free(w.faults);
    free(inputs);
    return err->status;
}
