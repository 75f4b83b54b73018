/* exr.c - OpenEXR files: OpenEXRCore does headers, chunks and codecs (but for ZIP: exr_zip.h); samples are packed and
 * unpacked here, a row of a channel at a time, so that only the wanted channels are converted and every float is looked
 * at once.
 *
 * A chunk's uncompressed bytes are the format's own: for each row, for each channel in order of name, the row's
 * samples, little-endian, as on the machines this program is built for. */
#include "common/image/exr.h"

#include <immintrin.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <half.h>
#include <openexr.h>

#include "common/base/outfile.h"
#include "common/base/parallel.h"
#include "common/image/exr_zip.h"
#include "common/image/samples.h"

#define MOST_PIXELS  (INT64_C(1) << 28)
#define ZIP_ROWS     16
#define LARGEST_HALF 65504.0F
#define SHORT_NAME   31 /* longer names need a flag in the file's version */

static const char *const provenance_names[] = {"remodel:stage", "remodel:version", "remodel:parameters",
                                               "remodel:inputs"};

/* ---------------------------------------------------------------------------------------------- pictures in memory */

enum status exr_image_init(struct exr_image *im, int width, int height, struct err *err)
{
    *im = (struct exr_image){0};
    if (width < 1 || height < 1 || (int64_t)width * height > MOST_PIXELS)
        return err_set(err, ST_DATA, "a picture of %d x %d pixels cannot be made; it needs 1 to 2^28 pixels.", width,
                       height);
    im->width = width;
    im->height = height;
    return ST_OK;
}

enum status exr_add_plane(struct exr_image *im, const char *name, enum exr_type type, struct exr_plane **plane,
                          struct err *err)
{
    if (!*name || strlen(name) >= EXR_NAME_SIZE)
        return err_set(err, ST_DATA, "a channel cannot be called \"%s\"; a name has 1 to %d characters.", name,
                       EXR_NAME_SIZE - 1);
    if (exr_find(im, name)) return err_set(err, ST_DATA, "the channel %s is there twice.", name);

    struct exr_plane *planes = realloc(im->planes, ((size_t)im->count + 1) * sizeof *planes);
    if (!planes) return err_nomem(err, "a list of channels", ((size_t)im->count + 1) * sizeof *planes);
    im->planes = planes;
    size_t samples = (size_t)im->width * (size_t)im->height;
    void *data = samples_alloc(samples * 4);
    if (!data) return err_nomem(err, "a channel", samples * 4);

    struct exr_plane *p = &planes[im->count++];
    *p = (struct exr_plane){.type = type};
    strcpy(p->name, name);
    if (type == EXR_UINT)
        p->u = data;
    else
        p->f = data;
    if (plane) *plane = p;
    return ST_OK;
}

enum status exr_init_rgba(struct exr_image *im, const float *rgba, int width, int height, struct err *err)
{
    static const char *const names[] = {"R", "G", "B", "A"};
    enum status st = exr_image_init(im, width, height, err);
    for (size_t c = 0; !st && c < 4; c++) {
        struct exr_plane *plane;
        st = exr_add_plane(im, names[c], EXR_HALF, &plane, err);
        for (size_t p = 0; !st && p < (size_t)width * (size_t)height; p++) plane->f[p] = rgba[4 * p + c];
    }
    return st;
}

struct exr_plane *exr_find(const struct exr_image *im, const char *name)
{
    for (int i = 0; i < im->count; i++)
        if (!strcmp(im->planes[i].name, name)) return &im->planes[i];
    return NULL;
}

enum status exr_set_attribute(struct exr_image *im, const char *name, const char *value, struct err *err)
{
    if (!*name || strlen(name) >= sizeof im->attributes[0][0] || strlen(value) >= sizeof im->attributes[0][1])
        return err_set(err, ST_DATA, "the attribute %s is too long; names and values have at most %zu characters.",
                       name, sizeof im->attributes[0][0] - 1);
    int at = 0;
    while (at < im->attribute_count && strcmp(im->attributes[at][0], name)) at++;
    if (at == im->attribute_count) {
        size_t bytes = ((size_t)at + 1) * sizeof *im->attributes;
        void *attributes = realloc(im->attributes, bytes);
        if (!attributes) return err_nomem(err, "a list of attributes", bytes);
        im->attributes = attributes;
        im->attribute_count++;
        strcpy(im->attributes[at][0], name);
    }
    strcpy(im->attributes[at][1], value);
    return ST_OK;
}

enum status exr_set_number(struct exr_image *im, const char *name, double value, struct err *err)
{
    char text[32];
    snprintf(text, sizeof text, "%.9g", value);
    return exr_set_attribute(im, name, text, err);
}

const char *exr_attribute(const struct exr_image *im, const char *name)
{
    for (int i = 0; i < im->attribute_count; i++)
        if (!strcmp(im->attributes[i][0], name)) return im->attributes[i][1];
    return NULL;
}

void exr_image_release(struct exr_image *im)
{
    if (!im) return;
    for (int i = 0; i < im->count; i++) {
        free(im->planes[i].f);
        free(im->planes[i].u);
    }
    free(im->planes);
    free(im->attributes);
    *im = (struct exr_image){0};
}

/* ------------------------------------------------------------------------------------------- the library's messages */

/* The library tells the thread that hit an error why; the first message of a call is the precise one. */
static _Thread_local char library_message[512];

static void keep_message(exr_const_context_t ctxt, exr_result_t code, const char *message)
{
    (void)ctxt, (void)code;
    if (!library_message[0]) snprintf(library_message, sizeof library_message, "%s", message);
}

static exr_context_initializer_t initializer(void)
{
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.error_handler_fn = keep_message;
    library_message[0] = 0;
    return init;
}

static enum status library_error(struct err *err, enum status status, const char *verb, const char *path,
                                 exr_result_t code)
{
    const char *why = library_message[0] ? library_message : exr_get_default_error_message(code);
    size_t length = strlen(why);
    while (length && strchr(".\n ", why[length - 1])) length--;
    if (code == EXR_ERR_OUT_OF_MEMORY) status = ST_NOMEM;
    return err_set(err, status, "cannot %s %s: %.*s%s.", verb, path, (int)length, why,
                   status == ST_DATA ? "; it is damaged or no OpenEXR file: make it again" : "");
}

/* What went wrong in one chunk; kept per chunk so that the first in the file is named for any number of threads. */
struct chunk_fault {
    exr_result_t code; /* 0: nothing */
    int plane, x, y;   /* plane >= 0: this sample is not a number */
};

static enum status first_fault(struct err *err, const char *verb, const char *path, const char *advice,
                               const struct exr_image *im, const struct chunk_fault *faults, size_t chunks)
{
    for (size_t i = 0; i < chunks; i++) {
        const struct chunk_fault *f = &faults[i];
        if (!f->code) continue;
        if (f->plane >= 0)
            return err_set(
                err, ST_DATA,
                "cannot %s %s: channel %s holds NaN or infinity at pixel (%d, %d); every sample must be finite.", verb,
                path, im->planes[f->plane].name, f->x, f->y);
        if (f->code == EXR_ERR_OUT_OF_MEMORY)
            return err_set(err, ST_NOMEM, "cannot %s %s: not enough memory for a chunk.", verb, path);
        return err_set(err, ST_DATA, "cannot %s %s: chunk %zu of %zu failed (%s)%s.", verb, path, i + 1, chunks,
                       exr_get_default_error_message(f->code), advice);
    }
    return ST_OK;
}

/* ---------------------------------------------------------------------------------------------------------- writing */

struct packed_chunk {
    void *bytes; /* owned */
    size_t size;
};

struct writer {
    const struct exr_image *im;
    exr_context_t ctxt;
    int part;
    exr_chunk_info_t *infos;
    struct packed_chunk *packed;
    exr_encode_pipeline_t *pipes; /* owned; one a thread */
    struct exr_zip *zips;         /* owned; one a thread */
    struct chunk_fault *faults;
    size_t chunks;
    int rows; /* of a chunk */
};

struct write_job {
    struct writer *w;
    struct exr_zip *zip;
    size_t chunk;
};

/* One row to half or float; the place of the first sample that cannot be written, or -1. */
static int pack_half(uint8_t *to, const float *from, int width)
{
    const __m256 most = _mm256_set1_ps(LARGEST_HALF), least = _mm256_set1_ps(-LARGEST_HALF);
    int x = 0;
    for (; x + 8 <= width; x += 8) {
        const __m256 v = _mm256_loadu_ps(from + x);
        if (_mm256_movemask_ps(_mm256_cmp_ps(v, v, _CMP_UNORD_Q))) break; /* the loop below finds which */
        const __m256 held = _mm256_min_ps(_mm256_max_ps(v, least), most);
        _mm_storeu_si128((__m128i *)(to + 2 * x), _mm256_cvtps_ph(held, _MM_FROUND_TO_NEAREST_INT));
    }
    for (; x < width; x++) {
        if (isnan(from[x])) return x;
        const float held = from[x] > LARGEST_HALF ? LARGEST_HALF : from[x] < -LARGEST_HALF ? -LARGEST_HALF : from[x];
        const uint16_t bits = imath_float_to_half(held);
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
    const struct write_job *job = pipe->encoding_user_data;
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
                    (struct chunk_fault){EXR_ERR_INVALID_ARGUMENT, (int)(plane - im->planes), bad, y};
                return EXR_ERR_INVALID_ARGUMENT;
            }
            to += (size_t)im->width * (plane->type == EXR_HALF ? 2 : 4);
        }
    }
    pipe->packed_bytes = (uint64_t)(to - (uint8_t *)pipe->packed_buffer);
    return EXR_ERR_SUCCESS;
}

static bool zips(const struct exr_image *im) { return im->codec == EXR_ZIP || im->codec == EXR_ZIPS; }

/* Stands in for the library's write: chunks are compressed in any order and written in theirs. */
static exr_result_t keep_chunk(exr_encode_pipeline_t *pipe)
{
    const struct write_job *job = pipe->encoding_user_data;
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
    struct writer *w = ctx;
    exr_encode_pipeline_t *pipe = &w->pipes[thread];
    for (size_t i = begin; i < end; i++) {
        struct write_job job = {w, &w->zips[thread], i};
        exr_result_t rv = EXR_ERR_SUCCESS;
        if (pipe->context) {
            rv = exr_encoding_update(w->ctxt, w->part, &w->infos[i], pipe);
        } else {
            rv = exr_encoding_initialize(w->ctxt, w->part, &w->infos[i], pipe);
            if (!rv) rv = exr_encoding_choose_default_routines(w->ctxt, w->part, pipe);
            pipe->convert_and_pack_fn = pack_chunk;
            pipe->yield_until_ready_fn = NULL; /* the order is kept by write_chunks() */
            pipe->write_fn = keep_chunk;
            if (zips(w->im)) pipe->compress_fn = NULL; /* keep_chunk() does */
        }
        if (!rv) {
            pipe->encoding_user_data = &job;
            for (int c = 0; c < pipe->channel_count; c++) /* pack_chunk() needs none, but the library refuses NULL */
                pipe->channels[c].encode_from_ptr = (const uint8_t *)w->im->planes;
            rv = exr_encoding_run(w->ctxt, w->part, pipe);
        }
        if (rv) { /* its buffers may be half made */
            exr_encoding_destroy(w->ctxt, pipe);
            *pipe = (exr_encode_pipeline_t)EXR_ENCODE_PIPELINE_INITIALIZER;
            if (!w->faults[i].code) w->faults[i] = (struct chunk_fault){rv, -1, 0, 0};
        }
    }
}

static exr_result_t write_header(struct writer *w, const struct provenance *prov, const char *inputs)
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
    for (int i = 0; !rv && i < im->count; i++) /* the library keeps them in order of name */
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
        for (int i = 0; !rv && i < 4; i++) rv = exr_attr_set_string(w->ctxt, w->part, provenance_names[i], values[i]);
    }
    for (int i = 0; !rv && i < im->attribute_count; i++)
        rv = exr_attr_set_string(w->ctxt, w->part, im->attributes[i][0], im->attributes[i][1]);
    if (!rv) rv = exr_write_header(w->ctxt);
    return rv;
}

static enum status write_chunks(struct writer *w, const char *path, struct err *err)
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
    if (rv) return library_error(err, ST_INTERNAL, "write", path, rv);

    parallel_for(w->chunks, 1, compress_chunks, w);
    for (int i = 0; i < parallel_threads(); i++) {
        exr_encoding_destroy(w->ctxt, &w->pipes[i]);
        exr_zip_release(&w->zips[i]);
    }
    enum status st = first_fault(err, "write", path, "", w->im, w->faults, w->chunks);
    for (size_t i = 0; !st && i < w->chunks; i++) {
        rv = exr_write_scanline_chunk(w->ctxt, w->part, (int)i * w->rows, w->packed[i].bytes, w->packed[i].size);
        if (rv) st = library_error(err, ST_IO, "write", path, rv);
    }
    return st;
}

enum status exr_write(const struct exr_image *im, const char *path, const struct provenance *prov, struct err *err)
{
    struct writer w = {.im = im};
    struct outfile file = {0};
    exr_context_initializer_t init = initializer();
    char *inputs = NULL;
    enum status st = ST_OK;
    exr_result_t rv = EXR_ERR_SUCCESS;

    if (im->count < 1) return err_set(err, ST_INTERNAL, "cannot write %s: the picture has no channel.", path);
    if (prov && prov->stage && !(inputs = provenance_inputs_text(prov)))
        return err_nomem(err, "a list of inputs", (size_t)prov->count * (HASH_TEXT + 1));
    st = outfile_open(&file, path, err);
    if (!st) {
        rv = exr_start_write(&w.ctxt, file.temp, EXR_WRITE_FILE_DIRECTLY, &init);
        if (!rv) rv = write_header(&w, prov, inputs);
        if (rv) st = library_error(err, ST_IO, "write", path, rv);
    }
    if (!st) st = write_chunks(&w, path, err);
    if (w.ctxt) { /* the table of chunks is written here */
        rv = exr_finish(&w.ctxt);
        if (!st && rv) st = library_error(err, ST_IO, "write", path, rv);
    }
    if (!st) st = outfile_commit(&file, err);

    outfile_discard(&file);
    free(w.pipes);
    free(w.zips);
    for (size_t i = 0; w.packed && i < w.chunks; i++) free(w.packed[i].bytes);
    free(w.infos);
    free(w.packed);
    free(w.faults);
    free(inputs);
    return st;
}

/* ---------------------------------------------------------------------------------------------------------- reading */

struct reader {
    struct exr_image *im;
    exr_context_t ctxt;
    exr_attr_box2i_t window;
    bool any; /* NaN and infinity are no fault */
    bool tiled;
    int chunk_width, chunk_height, chunks_across;
    size_t chunks;
    int *plane_from_channel;      /* owned; -1: not wanted */
    exr_decode_pipeline_t *pipes; /* owned; one a thread */
    struct exr_zip *zips;         /* owned; one a thread */
    struct chunk_fault *faults;
};

struct read_job {
    struct reader *r;
    struct exr_zip *zip;
    struct chunk_fault *fault;
    int x, y; /* of the chunk's first pixel in the picture */
};

static int unpack_half(float *to, const uint8_t *from, int width, bool any)
{
    const __m128i exponent = _mm_set1_epi16(0x7c00);
    int x = 0;
    for (; x + 8 <= width; x += 8) {
        const __m128i bits = _mm_loadu_si128((const __m128i *)(from + 2 * x));
        if (_mm_movemask_epi8(_mm_cmpeq_epi16(_mm_and_si128(bits, exponent), exponent))) break;
        _mm256_storeu_ps(to + x, _mm256_cvtph_ps(bits));
    }
    for (; x < width; x++) {
        uint16_t bits;
        memcpy(&bits, from + 2 * x, 2);
        if ((bits & 0x7c00) == 0x7c00 && !any) return x;
        to[x] = imath_half_to_float(bits);
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
    const struct read_job *job = pipe->decoding_user_data;
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
        return EXR_ERR_CORRUPT_CHUNK; /* the library would leave the rest of the buffer as it was */

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
                *job->fault = (struct chunk_fault){EXR_ERR_INVALID_ARGUMENT, p, job->x + bad, job->y + row};
                return EXR_ERR_INVALID_ARGUMENT;
            }
            from += (size_t)width * (size_t)pipe->channels[c].bytes_per_element;
        }
    }
    return EXR_ERR_SUCCESS;
}

static exr_result_t unzip_chunk(exr_decode_pipeline_t *pipe)
{
    static const exr_result_t results[] = {[EXR_ZIP_GOOD] = EXR_ERR_SUCCESS,
                                           [EXR_ZIP_DAMAGED] = EXR_ERR_CORRUPT_CHUNK,
                                           [EXR_ZIP_NOMEM] = EXR_ERR_OUT_OF_MEMORY};
    const struct read_job *job = pipe->decoding_user_data;
    const size_t packed = pipe->chunk.packed_size, size = pipe->chunk.unpacked_size;
    if (packed < size)
        return results[exr_zip_unpack(job->zip, pipe->packed_buffer, packed, pipe->unpacked_buffer, size)];
    if (packed > size) return EXR_ERR_CORRUPT_CHUNK;
    if (pipe->unpacked_buffer != pipe->packed_buffer) memcpy(pipe->unpacked_buffer, pipe->packed_buffer, size);
    return EXR_ERR_SUCCESS;
}

static exr_result_t chunk_info(const struct reader *r, size_t chunk, exr_chunk_info_t *info)
{
    int across = (int)(chunk % (size_t)r->chunks_across), down = (int)(chunk / (size_t)r->chunks_across);
    if (r->tiled) return exr_read_tile_chunk_info(r->ctxt, 0, across, down, 0, 0, info);
    return exr_read_scanline_chunk_info(r->ctxt, 0, r->window.min.y + down * r->chunk_height, info);
}

static void decode_chunks(void *ctx, size_t begin, size_t end, int thread)
{
    struct reader *r = ctx;
    exr_decode_pipeline_t *pipe = &r->pipes[thread];
    for (size_t i = begin; i < end; i++) {
        struct read_job job = {r, &r->zips[thread], &r->faults[i], (int)(i % (size_t)r->chunks_across) * r->chunk_width,
                               (int)(i / (size_t)r->chunks_across) * r->chunk_height};
        exr_chunk_info_t info;
        exr_result_t rv = chunk_info(r, i, &info);
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
        if (rv) { /* its buffers may be half made */
            exr_decoding_destroy(r->ctxt, pipe);
            *pipe = (exr_decode_pipeline_t)EXR_DECODE_PIPELINE_INITIALIZER;
            if (!job.fault->code) *job.fault = (struct chunk_fault){rv, -1, 0, 0};
        }
    }
}

/* Adds the planes that are wanted and maps the file's channels to them. */
static enum status choose_channels(struct reader *r, const char *path, const char *const *names, int name_count,
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
        char there[1024] = "";
        for (int c = 0; c < list->num_channels; c++) {
            size_t length = strlen(there);
            snprintf(there + length, sizeof there - length, " %s", list->entries[c].name.str);
        }
        return err_set(err, ST_DATA, "cannot read %s: it has no channel %s; it has%s.", path, names[n], there);
    }
    return ST_OK;
}

/* worldToCamera, and the string attributes but for provenance, the format's own, and those too long for the list. */
static enum status read_attributes(struct reader *r, struct err *err)
{
    int32_t count = 0;
    exr_get_attribute_count(r->ctxt, 0, &count);
    for (int32_t i = 0; i < count; i++) {
        const exr_attribute_t *a = NULL;
        if (exr_get_attribute_by_index(r->ctxt, 0, EXR_ATTR_LIST_FILE_ORDER, i, &a)) continue;
        if (a->type == EXR_ATTR_M44F && !strcmp(a->name, "worldToCamera")) {
            memcpy(r->im->world_to_camera, a->m44f->m, sizeof r->im->world_to_camera);
            r->im->has_world_to_camera = true;
            for (int k = 0; k < 16; k++) r->im->has_world_to_camera &= isfinite(a->m44f->m[k]) != 0;
        }
        if (a->type != EXR_ATTR_STRING || !a->string->str) continue;
        bool ours = !strcmp(a->name, "type") || !strcmp(a->name, "name");
        for (int k = 0; k < 4; k++) ours |= !strcmp(a->name, provenance_names[k]);
        if (ours || strlen(a->string->str) >= sizeof r->im->attributes[0][1]) continue;
        if (exr_set_attribute(r->im, a->name, a->string->str, err)) return err->status;
    }
    return ST_OK;
}

static enum status read_header(struct reader *r, const char *path, struct err *err)
{
    exr_attr_box2i_t display = {0};
    exr_storage_t storage = EXR_STORAGE_LAST_TYPE;
    int parts = 0, rows = 0;
    exr_result_t rv = exr_get_count(r->ctxt, &parts);
    if (!rv) rv = exr_get_storage(r->ctxt, 0, &storage);
    if (!rv) rv = exr_get_data_window(r->ctxt, 0, &r->window);
    if (!rv) rv = exr_get_display_window(r->ctxt, 0, &display);
    if (rv) return library_error(err, ST_DATA, "read", path, rv);
    if (parts != 1)
        return err_set(err, ST_DATA, "cannot read %s: it has %d parts; save the picture alone, in one part.", path,
                       parts);
    if (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED)
        return err_set(err, ST_DATA, "cannot read %s: it holds deep data; save it flat, in scanlines or tiles.", path);

    int64_t width = (int64_t)r->window.max.x - r->window.min.x + 1,
            height = (int64_t)r->window.max.y - r->window.min.y + 1;
    if (width < 1 || height < 1 || width > MOST_PIXELS || height > MOST_PIXELS || width * height > MOST_PIXELS)
        return err_set(err, ST_DATA, "cannot read %s: its size of %lld x %lld is not one of 1 to 2^28 pixels.", path,
                       (long long)width, (long long)height);
    if (width != (int64_t)display.max.x - display.min.x + 1 || height != (int64_t)display.max.y - display.min.y + 1)
        return err_set(err, ST_DATA,
                       "cannot read %s: its data window of %lld x %lld is not the size of its display window; save it "
                       "without crop or overscan.",
                       path, (long long)width, (long long)height);
    if (exr_image_init(r->im, (int)width, (int)height, err)) return err->status;

    r->tiled = storage == EXR_STORAGE_TILED;
    r->chunk_width = (int)width;
    rv = r->tiled ? exr_get_tile_sizes(r->ctxt, 0, 0, 0, &r->chunk_width, &r->chunk_height)
                  : exr_get_scanlines_per_chunk(r->ctxt, 0, &rows);
    if (!r->tiled) r->chunk_height = rows;
    if (rv || r->chunk_width < 1 || r->chunk_height < 1) return library_error(err, ST_DATA, "read", path, rv);
    r->chunks_across = (int)((width + r->chunk_width - 1) / r->chunk_width);
    r->chunks = (size_t)r->chunks_across * (size_t)((height + r->chunk_height - 1) / r->chunk_height);
    return ST_OK;
}

static enum status read_file(struct exr_image *im, const char *path, const char *const *names, int name_count, bool any,
                             struct err *err)
{
    struct reader r = {.im = im, .any = any};
    exr_context_initializer_t init = initializer();
    exr_chunk_info_t info;
    int threads = parallel_threads();
    enum status st = ST_OK;

    *im = (struct exr_image){0};
    init.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION; /* what is missing is an error, not a guess */
    if (access(path, R_OK)) return err_errno(err, "open", path);
    exr_result_t rv = exr_start_read(&r.ctxt, path, &init);
    if (rv) st = library_error(err, ST_DATA, "read", path, rv);
    if (!st) st = read_header(&r, path, err);
    if (!st &&
        (rv = chunk_info(&r, 0, &info))) /* loads the table of chunks, which proves that the file can hold them */
        st = library_error(err, ST_DATA, "read", path, rv);
    if (!st) st = choose_channels(&r, path, names, name_count, err);
    if (!st) st = read_attributes(&r, err);
    if (!st && im->count > 0) { /* with no channel asked for, the header is all */
        r.pipes = calloc((size_t)threads, sizeof *r.pipes);
        r.zips = calloc((size_t)threads, sizeof *r.zips);
        r.faults = calloc(r.chunks, sizeof *r.faults);
        if (!r.pipes || !r.zips || !r.faults) st = err_nomem(err, "a list of chunks", r.chunks * sizeof *r.faults);
    }
    if (!st && im->count > 0) {
        parallel_for(r.chunks, 1, decode_chunks, &r);
        st = first_fault(err, "read", path, "; it is damaged or cut off: make it again", im, r.faults, r.chunks);
    }

    for (int i = 0; r.pipes && i < threads; i++) exr_decoding_destroy(r.ctxt, &r.pipes[i]);
    for (int i = 0; r.zips && i < threads; i++) exr_zip_release(&r.zips[i]);
    free(r.pipes);
    free(r.zips);
    free(r.faults);
    free(r.plane_from_channel);
    if (r.ctxt) exr_finish(&r.ctxt);
    if (st) exr_image_release(im);
    return st;
}

enum status exr_read(struct exr_image *im, const char *path, const char *const *names, int name_count, struct err *err)
{
    return read_file(im, path, names, name_count, false, err);
}

enum status exr_read_any(struct exr_image *im, const char *path, struct err *err)
{
    return read_file(im, path, NULL, 0, true, err);
}
