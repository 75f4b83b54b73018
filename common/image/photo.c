/* photo.c - JPEG by libjpeg-turbo, PNG by libpng, EXIF by libexif; TIFF and raw files by photo_tiff.c and photo_raw.c.
 *
 * A file is read into memory once; what it is follows from its first bytes. EXIF of JPEG and PNG is found here, in
 * JPEG's APP1 or PNG's eXIf, and handed to libexif alone. */
#include "common/image/photo.h"

#include <errno.h>
#include <math.h>
#include <setjmp.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <libexif/exif-data.h>
#include <png.h>
#include <turbojpeg.h>

#include "common/base/outfile.h"
#include "common/base/parallel.h"
#include "common/image/exr.h"
#include "common/image/photo_formats.h"

#define PNG_LEVEL 6 /* zlib's; part of the reproducible bytes */

static enum status read_bytes(struct photo_bytes *file, const char *path, struct err *err)
{
    *file = (struct photo_bytes){.path = path};
    FILE *from = fopen(path, "rb");
    if (!from) return err_errno(err, "open", path);
    enum status st = ST_OK;
    size_t capacity = 0;
    while (!st && !feof(from)) {
        if (file->size == capacity) {
            capacity = capacity ? 2 * capacity : (size_t)1 << 20;
            unsigned char *bytes = realloc(file->bytes, capacity);
            if (!bytes) {
                st = err_nomem(err, "a photo", capacity);
                break;
            }
            file->bytes = bytes;
        }
        file->size += fread(file->bytes + file->size, 1, capacity - file->size, from);
        if (ferror(from)) st = err_errno(err, "read", path);
    }
    fclose(from);
    if (!st && !file->size) st = err_set(err, ST_DATA, "%s is empty; copy the photo again.", path);
    return st;
}

enum photo_kind { KIND_JPEG, KIND_PNG, KIND_TIFF, KIND_EXR, KIND_RAW };

static enum status photo_kind(const struct photo_bytes *file, enum photo_kind *kind, struct err *err)
{
    static const unsigned char jpeg[] = {0xff, 0xd8, 0xff}, png[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'},
                               exr[] = {0x76, 0x2f, 0x31, 0x01};
    if (file->size >= sizeof jpeg && !memcmp(file->bytes, jpeg, sizeof jpeg)) {
        *kind = KIND_JPEG;
    } else if (file->size >= sizeof png && !memcmp(file->bytes, png, sizeof png)) {
        *kind = KIND_PNG;
    } else if (file->size >= sizeof exr && !memcmp(file->bytes, exr, sizeof exr)) {
        *kind = KIND_EXR;
    } else if (photo_is_raw(file)) {
        *kind = KIND_RAW;
    } else if (photo_is_tiff(file)) {
        *kind = KIND_TIFF;
    } else {
        char begin[32] = "";
        for (size_t i = 0; i < file->size && i < 8; i++) sprintf(begin + 3 * i, " %02x", file->bytes[i]);
        return err_set(err, ST_DATA,
                       "%s is neither JPEG, PNG, TIFF, EXR nor a known raw format (it begins with the bytes%s); save "
                       "it as one of them.",
                       file->path, begin);
    }
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------------- EXIF */

static const unsigned char exif_mark[6] = {'E', 'x', 'i', 'f', 0, 0};

/* The TIFF block of a JPEG's APP1 segment; false if there is none before the picture's data. */
static bool find_exif_jpeg(const struct photo_bytes *file, const unsigned char **block, size_t *size)
{
    const unsigned char *b = file->bytes;
    for (size_t at = 2; at + 4 <= file->size && b[at] == 0xff;) {
        if (b[at + 1] == 0xff) { /* fill */
            at++;
            continue;
        }
        size_t length = (size_t)b[at + 2] << 8 | b[at + 3];
        if (b[at + 1] == 0xda || length < 2 || at + 2 + length > file->size) return false;
        if (b[at + 1] == 0xe1 && length >= 2 + sizeof exif_mark && !memcmp(b + at + 4, exif_mark, sizeof exif_mark)) {
            *block = b + at + 4 + sizeof exif_mark;
            *size = length - 2 - sizeof exif_mark;
            return true;
        }
        at += 2 + length;
    }
    return false;
}

static bool find_exif_png(const struct photo_bytes *file, const unsigned char **block, size_t *size)
{
    const unsigned char *b = file->bytes;
    for (size_t at = 8; at + 12 <= file->size;) {
        size_t length = (size_t)b[at] << 24 | (size_t)b[at + 1] << 16 | (size_t)b[at + 2] << 8 | b[at + 3];
        if (length > file->size - at - 12) return false;
        if (!memcmp(b + at + 4, "eXIf", 4)) {
            *block = b + at + 8;
            *size = length;
            return true;
        }
        at += 12 + length;
    }
    return false;
}

/* A number of an entry's first value; 0 if there is none. */
static double exif_number(ExifData *data, ExifIfd ifd, ExifTag tag)
{
    ExifEntry *e = exif_content_get_entry(data->ifd[ifd], tag);
    ExifByteOrder order = exif_data_get_byte_order(data);
    if (!e || !e->data || !e->components || e->size < exif_format_get_size(e->format)) return 0;
    double value = 0;
    if (e->format == EXIF_FORMAT_SHORT) value = exif_get_short(e->data, order);
    if (e->format == EXIF_FORMAT_LONG) value = exif_get_long(e->data, order);
    if (e->format == EXIF_FORMAT_RATIONAL) {
        ExifRational r = exif_get_rational(e->data, order);
        value = r.denominator ? (double)r.numerator / r.denominator : 0;
    }
    return value;
}

static void exif_text(ExifData *data, ExifTag tag, char *text, size_t size)
{
    ExifEntry *e = exif_content_get_entry(data->ifd[EXIF_IFD_0], tag);
    const bool there = e && e->data && e->format == EXIF_FORMAT_ASCII;
    photo_keep_text(text, size, there ? (const char *)e->data : "", there ? e->size : 0);
}

static enum status read_exif(struct photo_info *info, const struct photo_bytes *file, enum photo_kind kind,
                             struct err *err)
{
    const unsigned char *block = NULL;
    size_t size = 0;
    info->orientation = 1;
    if (!(kind == KIND_JPEG ? find_exif_jpeg : find_exif_png)(file, &block, &size)) return ST_OK;
    if (size > 1 << 20) return ST_OK; /* no camera writes so much */

    unsigned char *marked = malloc(sizeof exif_mark + size);
    ExifData *data = exif_data_new();
    enum status st = ST_OK;
    if (!marked || !data) {
        st = err_nomem(err, "EXIF data", size);
    } else {
        memcpy(marked, exif_mark, sizeof exif_mark);
        memcpy(marked + sizeof exif_mark, block, size);
        exif_data_unset_option(data, EXIF_DATA_OPTION_FOLLOW_SPECIFICATION); /* report what is there, invent nothing */
        exif_data_load_data(data, marked, (unsigned)(sizeof exif_mark + size));
        double orientation = exif_number(data, EXIF_IFD_0, EXIF_TAG_ORIENTATION);
        if (orientation >= 1 && orientation <= 8) info->orientation = (int)orientation;
        info->focal_mm = exif_number(data, EXIF_IFD_EXIF, EXIF_TAG_FOCAL_LENGTH);
        info->focal35_mm = exif_number(data, EXIF_IFD_EXIF, EXIF_TAG_FOCAL_LENGTH_IN_35MM_FILM);
        info->seconds = exif_number(data, EXIF_IFD_EXIF, EXIF_TAG_EXPOSURE_TIME);
        info->f_number = exif_number(data, EXIF_IFD_EXIF, EXIF_TAG_FNUMBER);
        info->iso = exif_number(data, EXIF_IFD_EXIF, EXIF_TAG_ISO_SPEED_RATINGS);
        exif_text(data, EXIF_TAG_MAKE, info->make, sizeof info->make);
        exif_text(data, EXIF_TAG_MODEL, info->model, sizeof info->model);
    }
    if (data) exif_data_unref(data);
    free(marked);
    return st;
}

/* ------------------------------------------------------------------------------------------------------------- JPEG */

static enum status jpeg_damaged(const struct photo_bytes *file, tjhandle handle, struct err *err)
{
    return err_set(err, ST_DATA, "%s is a damaged or cut-off JPEG (%s); copy or export the photo again.", file->path,
                   tjGetErrorStr2(handle));
}

static enum status read_jpeg_header(struct photo_info *info, const struct photo_bytes *file, tjhandle handle,
                                    struct err *err)
{
    int subsampling = 0, space = 0;
    if (tjDecompressHeader3(handle, file->bytes, file->size, &info->width, &info->height, &subsampling, &space))
        return jpeg_damaged(file, handle, err);
    if (info->width < 1) /* no error of the decoder, which waits for more */
        return err_set(err, ST_DATA, "%s is a JPEG that ends in its header; copy the photo again.", file->path);
    if (space == TJCS_CMYK || space == TJCS_YCCK)
        return err_set(err, ST_DATA, "%s is a CMYK JPEG, made for printing; export the photo as RGB.", file->path);
    info->bits = 8;
    return photo_check_size(file->path, (uint64_t)info->width, (uint64_t)info->height, err);
}

/* Any warning of the decoder means that pixels are missing or made up, but for one: some cameras write padding between
 * the complete picture and the end marker 0xd9. */
static enum status read_jpeg_pixels(struct photo *p, const struct photo_bytes *file, tjhandle handle, struct err *err)
{
    size_t samples = (size_t)p->info.width * (size_t)p->info.height * 3;
    unsigned char *rgb = malloc(samples);
    if (!rgb) return err_nomem(err, "a photo", samples);

    int rv = tjDecompress2(handle, file->bytes, file->size, rgb, p->info.width, 0, p->info.height, TJPF_RGB,
                           TJFLAG_STOPONWARNING | TJFLAG_LIMITSCANS);
    if (rv && strstr(tjGetErrorStr2(handle), "extraneous bytes before marker 0xd9")) {
        rv = tjDecompress2(handle, file->bytes, file->size, rgb, p->info.width, 0, p->info.height, TJPF_RGB,
                           TJFLAG_LIMITSCANS);
        if (rv && tjGetErrorCode(handle) == TJERR_WARNING) rv = 0;
    }
    enum status st = rv ? jpeg_damaged(file, handle, err) : photo_init_samples(p, err);
    for (size_t i = 0; !st && i < samples; i++) p->samples[i] = rgb[i];
    free(rgb);
    return st;
}

static enum status read_jpeg(struct photo *p, const struct photo_bytes *file, bool pixels, struct err *err)
{
    tjhandle handle = tjInitDecompress();
    if (!handle) return err_nomem(err, "a JPEG decoder", 0);
    enum status st = read_jpeg_header(&p->info, file, handle, err);
    if (!st && pixels) st = read_jpeg_pixels(p, file, handle, err);
    tjDestroy(handle);
    return st;
}

/* -------------------------------------------------------------------------------------------------------------- PNG */

/* All that outlives a longjmp out of libpng is in here, behind a pointer, so that no register can hold an old value. */
struct png_reader {
    const struct photo_bytes *file;
    size_t at;
    png_structp png;
    png_infop info;
    png_bytepp rows; /* owned */
    struct photo *photo;
    char message[200];
};

static void png_keep_message(png_structp png, png_const_charp message)
{
    struct png_reader *r = png_get_error_ptr(png);
    snprintf(r->message, sizeof r->message, "%s", message);
    png_longjmp(png, 1);
}

static void png_ignore_warning(png_structp png, png_const_charp message) { (void)png, (void)message; }

static void png_take_bytes(png_structp png, png_bytep to, size_t size)
{
    struct png_reader *r = png_get_io_ptr(png);
    if (size > r->file->size - r->at) png_error(png, "the file ends too early");
    memcpy(to, r->file->bytes + r->at, size);
    r->at += size;
}

static enum status png_damaged(const struct png_reader *r, struct err *err)
{
    return err_set(err, ST_DATA, "%s is a damaged or cut-off PNG (%s); copy or export the photo again.", r->file->path,
                   r->message);
}

static enum status read_png_header(struct png_reader *r, struct err *err)
{
    if (setjmp(png_jmpbuf(r->png))) return png_damaged(r, err);
    png_set_read_fn(r->png, r, png_take_bytes);
    png_set_user_limits(r->png, 1 << 28, 1 << 28); /* photo_check_size() has the last word */
    png_read_info(r->png, r->info);
    png_uint_32 width = png_get_image_width(r->png, r->info), height = png_get_image_height(r->png, r->info);
    if (photo_check_size(r->file->path, width, height, err)) return err ? err->status : ST_DATA;
    r->photo->info.width = (int)width;
    r->photo->info.height = (int)height;
    r->photo->info.bits = png_get_bit_depth(r->png, r->info) == 16 ? 16 : 8;
    return ST_OK;
}

/* Every kind of PNG becomes 16-bit RGB: palettes, grey and few bits expanded, alpha dropped; 8 bits come as v * 257. */
static enum status read_png_pixels(struct png_reader *r, struct err *err)
{
    struct photo *p = r->photo;
    size_t row = (size_t)p->info.width * 3, height = (size_t)p->info.height;
    enum status st = photo_init_samples(p, err);
    if (st) return st;
    r->rows = malloc(height * sizeof *r->rows);
    if (!r->rows) return err_nomem(err, "a photo's rows", height * sizeof *r->rows);
    for (size_t y = 0; y < height; y++) r->rows[y] = (png_bytep)(p->samples + y * row);

    if (setjmp(png_jmpbuf(r->png))) return png_damaged(r, err);
    png_set_expand_16(r->png);
    png_set_gray_to_rgb(r->png);
    png_set_strip_alpha(r->png);
    png_set_swap(r->png); /* libpng's samples are big-endian */
    png_set_interlace_handling(r->png);
    png_read_update_info(r->png, r->info);
    if (png_get_rowbytes(r->png, r->info) != row * sizeof *p->samples)
        png_error(r->png, "its rows are of no known kind");
    png_read_image(r->png, r->rows);
    png_read_end(r->png, NULL);
    if (p->info.bits == 8)
        for (size_t i = 0; i < row * height; i++) p->samples[i] >>= 8;
    return ST_OK;
}

static enum status read_png(struct photo *p, const struct photo_bytes *file, bool pixels, struct err *err)
{
    struct png_reader r = {.file = file, .photo = p};
    r.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &r, png_keep_message, png_ignore_warning);
    if (r.png) r.info = png_create_info_struct(r.png);
    enum status st = r.info ? ST_OK : err_nomem(err, "a PNG decoder", 0);
    if (!st) st = read_png_header(&r, err);
    if (!st && pixels) st = read_png_pixels(&r, err);
    png_destroy_read_struct(&r.png, &r.info, NULL);
    free(r.rows);
    return st;
}

/* ----------------------------------------------------------------------------------------------------------- photos */

/* EXR is linear already; it says nothing about how it was exposed. */
static enum status read_exr(struct photo *p, const struct photo_bytes *file, bool pixels, struct err *err)
{
    static const char *const names[] = {"R", "G", "B"};
    struct exr_image exr = {0};
    enum status st = exr_read(&exr, file->path, names, pixels ? 3 : 0, err);
    for (int c = 0; !st && pixels && c < 3; c++)
        if (!exr_find(&exr, names[c])->f)
            st = err_set(err, ST_DATA, "%s: channel %s holds integers, wanted half or float; export it so.", file->path,
                         names[c]);
    p->info.bits = 32;
    if (!st) {
        p->info.width = exr.width;
        p->info.height = exr.height;
        st = photo_check_size(file->path, (uint64_t)exr.width, (uint64_t)exr.height, err);
    }
    if (!st && pixels) st = photo_init_values(p, err);
    const size_t count = (size_t)p->info.width * (size_t)p->info.height;
    for (size_t c = 0; !st && pixels && c < 3; c++) {
        const float *from = exr_find(&exr, names[c])->f;
        for (size_t i = 0; i < count; i++) p->values[3 * i + c] = fmaxf(from[i], 0);
    }
    if (!st && pixels) p->saturation = photo_find_saturation(p);
    exr_image_release(&exr);
    return st;
}

static enum status read_photo(struct photo *p, const char *path, bool pixels, bool linear, struct err *err)
{
    static enum status (*const read[])(struct photo *, const struct photo_bytes *, bool, struct err *) = {
        [KIND_JPEG] = read_jpeg, [KIND_PNG] = read_png,       [KIND_TIFF] = photo_read_tiff,
        [KIND_EXR] = read_exr,   [KIND_RAW] = photo_read_raw,
    };
    struct photo_bytes file = {0};
    enum photo_kind kind = KIND_JPEG;
    *p = (struct photo){.info.orientation = 1};
    enum status st = read_bytes(&file, path, err);
    if (!st) st = photo_kind(&file, &kind, err);
    if (!st && !linear && (kind == KIND_EXR || kind == KIND_RAW))
        st = err_set(err, ST_DATA, "%s is %s; wanted JPEG, PNG or TIFF here.", path,
                     kind == KIND_EXR ? "an EXR file" : "a camera's raw file");
    if (!st) st = read[kind](p, &file, pixels, err);
    if (!st && (kind == KIND_JPEG || kind == KIND_PNG)) st = read_exif(&p->info, &file, kind, err);
    free(file.bytes);
    if (st) photo_release(p);
    return st;
}

enum status photo_read(struct photo *p, const char *path, struct err *err)
{
    return read_photo(p, path, true, false, err);
}

enum status photo_read_any(struct photo *p, const char *path, struct err *err)
{
    return read_photo(p, path, true, true, err);
}

enum status photo_read_info(struct photo_info *info, const char *path, struct err *err)
{
    struct photo p = {0};
    enum status st = read_photo(&p, path, false, true, err);
    *info = p.info;
    return st;
}

struct linear_job {
    const struct photo *photo;
    const float *curve;
    float *out;
};

static void linear_samples(void *ctx, size_t begin, size_t end, int thread)
{
    (void)thread;
    const struct linear_job *job = ctx;
    for (size_t i = begin; i < end; i++) job->out[i] = job->curve[job->photo->samples[i]];
}

enum status photo_to_linear(struct image *out, const struct photo *p, struct err *err)
{
    *out = (struct image){0};
    size_t levels = p->info.bits == 16 ? 65536 : 256;
    float *curve = malloc(levels * sizeof *curve);
    if (!curve) return err_nomem(err, "a tone curve", levels * sizeof *curve);
    for (size_t i = 0; i < levels; i++) curve[i] = linear_from_srgb((float)i / (float)(levels - 1));
    enum status st = image_init(out, p->info.width, p->info.height, 3, err);
    if (!st) {
        struct linear_job job = {p, curve, out->data};
        parallel_for((size_t)p->info.width * (size_t)p->info.height * 3, 1 << 16, linear_samples, &job);
    }
    free(curve);
    return st;
}

/* ---------------------------------------------------------------------------------------------------------- writing */

struct png_writer {
    png_structp png;
    png_infop info;
    char message[200];
};

static void png_keep_write_message(png_structp png, png_const_charp message)
{
    struct png_writer *w = png_get_error_ptr(png);
    snprintf(w->message, sizeof w->message, "%s", message);
    png_longjmp(png, 1);
}

struct png_picture {
    const unsigned char *pixels; /* interleaved; 16-bit samples in this machine's order */
    int width, height, channels, bits;
    const unsigned char *exif; /* NULL: none */
    unsigned exif_size;
};

static enum status write_png_rows(struct png_writer *w, FILE *fp, const char *path, const struct png_picture *p,
                                  struct err *err)
{
    const size_t row = (size_t)p->width * (size_t)p->channels * (size_t)(p->bits / 8);
    if (setjmp(png_jmpbuf(w->png))) return err_set(err, ST_IO, "cannot write %s: %s.", path, w->message);
    png_init_io(w->png, fp);
    png_set_user_limits(w->png, 1 << 28, 1 << 28);
    png_set_compression_level(w->png, PNG_LEVEL);
    png_set_IHDR(w->png, w->info, (png_uint_32)p->width, (png_uint_32)p->height, p->bits,
                 p->channels == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (p->exif) png_set_eXIf_1(w->png, w->info, p->exif_size, (png_bytep)p->exif);
    png_write_info(w->png, w->info);
    if (p->bits == 16) png_set_swap(w->png); /* libpng's samples are big-endian */
    for (int y = 0; y < p->height; y++) png_write_row(w->png, p->pixels + (size_t)y * row);
    png_write_end(w->png, w->info);
    return ST_OK;
}

static enum status write_png(const char *path, const struct png_picture *p, struct err *err)
{
    struct png_writer w = {0};
    struct outfile f = {0};
    if (p->width < 1 || p->height < 1 || (p->channels != 1 && p->channels != 3))
        return err_set(err, ST_INTERNAL, "cannot write %s: no PNG is %d x %d pixels of %d channels.", path, p->width,
                       p->height, p->channels);
    w.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &w, png_keep_write_message, png_ignore_warning);
    if (w.png) w.info = png_create_info_struct(w.png);
    enum status st = w.info ? ST_OK : err_nomem(err, "a PNG encoder", 0);
    if (!st) st = outfile_open(&f, path, err);
    if (!st) st = write_png_rows(&w, f.fp, path, p, err);
    if (!st) st = outfile_commit(&f, err);
    outfile_discard(&f);
    png_destroy_write_struct(&w.png, &w.info);
    return st;
}

enum status png_write(const char *path, const unsigned char *pixels, int width, int height, int channels,
                      struct err *err)
{
    return write_png(path, &(struct png_picture){pixels, width, height, channels, 8, NULL, 0}, err);
}

enum status jpeg_encode(unsigned char **bytes, size_t *size, const unsigned char *rgb, int width, int height,
                        int quality, struct err *err)
{
    unsigned char *made = NULL; /* libjpeg-turbo's memory */
    unsigned long length = 0;
    tjhandle handle = tjInitCompress();
    enum status st = handle ? ST_OK : err_nomem(err, "a JPEG encoder", 0);

    *bytes = NULL;
    *size = 0;
    if (!st && tjCompress2(handle, rgb, width, 0, height, TJPF_RGB, &made, &length, TJSAMP_420, quality, 0))
        st = err_set(err, ST_INTERNAL, "cannot make a JPEG of %d x %d pixels at quality %d: %s.", width, height,
                     quality, tjGetErrorStr2(handle));
    if (!st && !(*bytes = malloc(length))) st = err_nomem(err, "a JPEG", length);
    if (!st) {
        memcpy(*bytes, made, length);
        *size = length;
    }
    tjFree(made);
    if (handle) tjDestroy(handle);
    return st;
}

/* EXIF's fractions: of exposure times 1/n where that is what is meant, else millionths or what fits. */
static ExifRational exif_rational(double value)
{
    const double inverse = 1 / value;
    if (value < 1 && inverse < 4e9 && fabs(inverse - round(inverse)) < 1e-9 * inverse)
        return (ExifRational){1, (ExifLong)round(inverse)};
    ExifLong below = 1000000;
    while (below > 1 && value * below > 4e9) below /= 10;
    return (ExifRational){(ExifLong)round(value * below), below};
}

/* A new entry of `count` values; NULL: no memory. Its data is the entry's. */
static ExifEntry *exif_add(ExifData *data, ExifIfd ifd, ExifTag tag, ExifFormat format, size_t count)
{
    ExifMem *mem = exif_mem_new_default();
    ExifEntry *e = mem ? exif_entry_new_mem(mem) : NULL;
    const size_t size = count * exif_format_get_size(format);
    unsigned char *room = e ? exif_mem_alloc(mem, (ExifLong)size) : NULL;
    if (room) {
        e->tag = tag;
        e->format = format;
        e->components = count;
        e->size = (unsigned)size;
        e->data = room;
        exif_content_add_entry(data->ifd[ifd], e);
    }
    if (e) exif_entry_unref(e); /* the content holds its own */
    if (mem) exif_mem_unref(mem);
    return room ? e : NULL;
}

static bool exif_put_text(ExifData *data, ExifTag tag, const char *text)
{
    if (!*text) return true;
    ExifEntry *e = exif_add(data, EXIF_IFD_0, tag, EXIF_FORMAT_ASCII, strlen(text) + 1);
    if (e) memcpy(e->data, text, strlen(text) + 1);
    return e;
}

static bool exif_put_short(ExifData *data, ExifIfd ifd, ExifTag tag, double value)
{
    if (!(value > 0)) return true;
    ExifEntry *e = exif_add(data, ifd, tag, EXIF_FORMAT_SHORT, 1);
    if (e) exif_set_short(e->data, exif_data_get_byte_order(data), (ExifShort)fmin(65535, fmax(1, round(value))));
    return e;
}

static bool exif_put_rational(ExifData *data, ExifTag tag, double value)
{
    if (!(value > 0)) return true;
    ExifEntry *e = exif_add(data, EXIF_IFD_EXIF, tag, EXIF_FORMAT_RATIONAL, 1);
    if (e) exif_set_rational(e->data, exif_data_get_byte_order(data), exif_rational(value));
    return e;
}

/* The block as it stands in an APP1 segment, "Exif" and two zeros before it; libexif's memory. */
static enum status exif_block(unsigned char **block, unsigned *size, const struct photo_info *info, struct err *err)
{
    ExifData *data = exif_data_new();
    bool made = data;
    *block = NULL;
    if (made) {
        exif_data_set_byte_order(data, EXIF_BYTE_ORDER_INTEL);
        exif_data_unset_option(data, EXIF_DATA_OPTION_FOLLOW_SPECIFICATION);
        made = exif_put_text(data, EXIF_TAG_MAKE, info->make) && exif_put_text(data, EXIF_TAG_MODEL, info->model) &&
               exif_put_short(data, EXIF_IFD_0, EXIF_TAG_ORIENTATION, info->orientation) &&
               exif_put_rational(data, EXIF_TAG_EXPOSURE_TIME, info->seconds) &&
               exif_put_rational(data, EXIF_TAG_FNUMBER, info->f_number) &&
               exif_put_short(data, EXIF_IFD_EXIF, EXIF_TAG_ISO_SPEED_RATINGS, info->iso) &&
               exif_put_rational(data, EXIF_TAG_FOCAL_LENGTH, info->focal_mm) &&
               exif_put_short(data, EXIF_IFD_EXIF, EXIF_TAG_FOCAL_LENGTH_IN_35MM_FILM, info->focal35_mm);
    }
    if (made) exif_data_save_data(data, block, size);
    if (data) exif_data_unref(data);
    return *block && *size <= 65533 ? ST_OK : err_nomem(err, "EXIF data", 65533);
}

enum status photo_write_jpeg(const char *path, const unsigned char *rgb, int width, int height, int quality,
                             const struct photo_info *info, struct err *err)
{
    struct outfile f = {0};
    unsigned char *bytes = NULL, *exif = NULL;
    size_t size = 0;
    unsigned exif_size = 0;
    enum status st = jpeg_encode(&bytes, &size, rgb, width, height, quality, err);
    if (!st) st = exif_block(&exif, &exif_size, info, err);
    if (!st) st = outfile_open(&f, path, err);
    if (!st) { /* behind the start marker */
        const unsigned char segment[4] = {0xff, 0xe1, (unsigned char)((exif_size + 2) >> 8),
                                          (unsigned char)(exif_size + 2)};
        if (fwrite(bytes, 1, 2, f.fp) != 2 || fwrite(segment, 1, 4, f.fp) != 4 ||
            fwrite(exif, 1, exif_size, f.fp) != exif_size || fwrite(bytes + 2, 1, size - 2, f.fp) != size - 2)
            st = err_errno(err, "write", path);
    }
    if (!st) st = outfile_commit(&f, err);
    outfile_discard(&f);
    free(exif);
    free(bytes);
    return st;
}

enum status photo_write_part(const char *path, const struct photo *p, int x, int y, int width, int height,
                             const struct photo_info *info, struct err *err)
{
    const size_t row = (size_t)width * 3, size = p->info.bits == 16 ? 2 : 1;
    unsigned char *pixels = malloc(row * (size_t)height * size), *exif = NULL;
    unsigned exif_size = 0;
    enum status st = pixels ? ST_OK : err_nomem(err, "a picture", row * (size_t)height * size);
    for (int k = 0; !st && k < height; k++) {
        const uint16_t *from = p->samples + ((size_t)(y + k) * (size_t)p->info.width + (size_t)x) * 3;
        unsigned char *to = pixels + (size_t)k * row * size;
        if (size == 2) memcpy(to, from, row * size);
        for (size_t i = 0; size == 1 && i < row; i++) to[i] = (unsigned char)from[i];
    }
    if (!st) st = exif_block(&exif, &exif_size, info, err);
    if (!st) {
        const unsigned mark = sizeof exif_mark; /* PNG goes without it */
        st = write_png(
            path, &(struct png_picture){pixels, width, height, 3, p->info.bits, exif + mark, exif_size - mark}, err);
    }
    free(exif);
    free(pixels);
    return st;
}

enum status jpeg_write(const char *path, const unsigned char *rgb, int width, int height, int quality, struct err *err)
{
    struct outfile f = {0};
    unsigned char *bytes = NULL;
    size_t size = 0;
    enum status st = jpeg_encode(&bytes, &size, rgb, width, height, quality, err);
    if (!st) st = outfile_open(&f, path, err);
    if (!st && fwrite(bytes, 1, size, f.fp) != size) st = err_errno(err, "write", path);
    if (!st) st = outfile_commit(&f, err);
    outfile_discard(&f);
    free(bytes);
    return st;
}
