/* photo_tiff.c - TIFF files of 8 and 16 bits, and of floating-point samples, by libtiff.
 *
 * RGB and grey samples are read as stored, in strips, tiles or planes; libtiff converts other 8-bit kinds to RGB.
 * Floating-point samples are linear light. Of several pages the first is the photo. libtiff rather than OpenCV's
 * reader, because it is C, keeps 16 bits and gives the EXIF data. */
#include "common/image/photo_formats.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <tiffio.h>

#define TAG_DNG_VERSION 50706

struct tiff_reader {
    const struct photo_bytes *file;
    toff_t at;
    char message[200]; /* libtiff's first error message */
};

static tmsize_t read_bytes(thandle_t handle, void *to, tmsize_t size)
{
    struct tiff_reader *r = (struct tiff_reader *)handle;
    if (r->at >= r->file->size || size < 0) return 0;
    const size_t left = r->file->size - (size_t)r->at, n = (size_t)size < left ? (size_t)size : left;
    memcpy(to, r->file->bytes + r->at, n);
    r->at += n;
    return (tmsize_t)n;
}

static tmsize_t write_nothing(thandle_t handle, void *from, tmsize_t size)
{
    return (void)handle, (void)from, (void)size, 0;
}

static toff_t seek(thandle_t handle, toff_t offset, int whence)
{
    struct tiff_reader *r = (struct tiff_reader *)handle;
    r->at = offset + (whence == SEEK_CUR ? r->at : whence == SEEK_END ? r->file->size : 0);
    return r->at;
}

static int close_nothing(thandle_t handle) { return (void)handle, 0; }
static toff_t size_of(thandle_t handle) { return ((struct tiff_reader *)handle)->file->size; }

static int keep_message(TIFF *t, void *ctx, const char *module, const char *format, va_list args)
{
    struct tiff_reader *r = ctx;
    (void)t, (void)module;
    if (!*r->message) vsnprintf(r->message, sizeof r->message, format, args);
    return 1; /* libtiff's own handler, which prints, is not called */
}

static int ignore(TIFF *t, void *ctx, const char *module, const char *format, va_list args)
{
    (void)t, (void)ctx, (void)module, (void)format, (void)args;
    return 1;
}

static TIFF *open_tiff(struct tiff_reader *r)
{
    TIFFOpenOptions *options = TIFFOpenOptionsAlloc();
    if (!options) return NULL;
    TIFFOpenOptionsSetErrorHandlerExtR(options, keep_message, r);
    TIFFOpenOptionsSetWarningHandlerExtR(options, ignore, NULL);
    /* m: no memory mapping, since the file is in memory */
    TIFF *t = TIFFClientOpenExt(r->file->path, "rm", (thandle_t)r, read_bytes, write_nothing, seek, close_nothing,
                                size_of, NULL, NULL, options);
    TIFFOpenOptionsFree(options);
    return t;
}

static enum status damaged(const struct tiff_reader *r, struct err *err)
{
    return err_set(err, ST_DATA, "%s is a damaged or cut-off TIFF (%s); copy or export the photo again.", r->file->path,
                   *r->message ? r->message : "decoding failed");
}

bool photo_tiff_is_raw(const struct photo_bytes *file)
{
    struct tiff_reader r = {.file = file};
    TIFF *t = open_tiff(&r);
    if (!t) return false;
    uint32_t subfile = 0;
    uint16_t photometric = PHOTOMETRIC_RGB, compression = COMPRESSION_NONE;
    TIFFGetField(t, TIFFTAG_SUBFILETYPE, &subfile);
    TIFFGetField(t, TIFFTAG_PHOTOMETRIC, &photometric);
    TIFFGetFieldDefaulted(t, TIFFTAG_COMPRESSION, &compression);
    uint16_t count = 0;
    const void *version = NULL;
    const bool dng = TIFFFindField(t, TAG_DNG_VERSION, TIFF_ANY) && TIFFGetField(t, TAG_DNG_VERSION, &version, &count);
    const bool raw = dng || version || subfile & FILETYPE_REDUCEDIMAGE || photometric == PHOTOMETRIC_CFA ||
                     photometric == 34892 /* LinearRaw */ || !TIFFIsCODECConfigured(compression);
    TIFFClose(t);
    return raw;
}

/* ------------------------------------------------------------------------------------------------------------- EXIF */

/* A number; libtiff returns it as float, double, or a list of shorts (ISO speed). */
static double exif_number(TIFF *t, uint32_t tag)
{
    const TIFFField *field = TIFFFindField(t, tag, TIFF_ANY);
    if (!field) return 0;
    if (TIFFFieldPassCount(field)) {
        uint16_t count = 0;
        const uint16_t *shorts = NULL;
        if (TIFFFieldDataType(field) != TIFF_SHORT || TIFFFieldReadCount(field) != TIFF_VARIABLE) return 0;
        return TIFFGetField(t, tag, &count, &shorts) && count && shorts ? shorts[0] : 0;
    }
    if (TIFFFieldDataType(field) == TIFF_SHORT) {
        uint16_t value = 0;
        return TIFFGetField(t, tag, &value) ? value : 0;
    }
    if (TIFFFieldSetGetSize(field) == 8) {
        double value = 0;
        return TIFFGetField(t, tag, &value) ? value : 0;
    }
    float value = 0;
    return TIFFGetField(t, tag, &value) ? (double)value : 0;
}

static double plausible(double value) { return value > 0 && value < 1e9 ? value : 0; }

static void keep_text(TIFF *t, uint32_t tag, char *text, size_t size)
{
    const char *found = NULL;
    if (!TIFFGetField(t, tag, &found) || !found) found = "";
    photo_keep_text(text, size, found, SIZE_MAX);
}

static void read_exif(struct photo_info *info, TIFF *t)
{
    uint16_t orientation = 1;
    toff_t exif = 0;
    if (TIFFGetField(t, TIFFTAG_ORIENTATION, &orientation) && orientation >= 1 && orientation <= 8)
        info->orientation = orientation;
    keep_text(t, TIFFTAG_MAKE, info->make, sizeof info->make);
    keep_text(t, TIFFTAG_MODEL, info->model, sizeof info->model);
    if (!TIFFGetField(t, TIFFTAG_EXIFIFD, &exif) || !TIFFReadEXIFDirectory(t, exif)) return;
    char date[32], subseconds[16];
    keep_text(t, EXIFTAG_DATETIMEORIGINAL, date, sizeof date);
    keep_text(t, EXIFTAG_SUBSECTIMEORIGINAL, subseconds, sizeof subseconds);
    info->taken = photo_time(date, subseconds);
    info->seconds = plausible(exif_number(t, EXIFTAG_EXPOSURETIME));
    info->f_number = plausible(exif_number(t, EXIFTAG_FNUMBER));
    info->iso = plausible(exif_number(t, EXIFTAG_ISOSPEEDRATINGS));
    info->focal_mm = plausible(exif_number(t, EXIFTAG_FOCALLENGTH));
    info->focal35_mm = plausible(exif_number(t, EXIFTAG_FOCALLENGTHIN35MMFILM));
}

/* ----------------------------------------------------------------------------------------------------------- pixels */

struct tiff_layout {
    uint16_t bits, samples, planar, photometric, format, compression;
    uint16_t alpha; /* number of the sample that is alpha; 0: none */
    bool premultiplied, real;
    bool plain; /* rows or tiles of RGB or grey, of 8 or 16 bits, or real numbers */
};

static void find_alpha(struct tiff_layout *l, TIFF *t, uint16_t colours)
{
    uint16_t count = 0;
    const uint16_t *kinds = NULL;
    if (!TIFFGetField(t, TIFFTAG_EXTRASAMPLES, &count, &kinds) || !count || l->samples <= colours) return;
    if (kinds[0] != EXTRASAMPLE_ASSOCALPHA && kinds[0] != EXTRASAMPLE_UNASSALPHA) return;
    l->alpha = colours;
    l->premultiplied = kinds[0] == EXTRASAMPLE_ASSOCALPHA;
}

static enum status read_layout(struct tiff_layout *l, struct photo_info *info, TIFF *t, const char *path,
                               struct err *err)
{
    uint32_t width = 0, height = 0;
    *l = (struct tiff_layout){.photometric = PHOTOMETRIC_MINISBLACK};
    TIFFGetField(t, TIFFTAG_IMAGEWIDTH, &width);
    TIFFGetField(t, TIFFTAG_IMAGELENGTH, &height);
    TIFFGetFieldDefaulted(t, TIFFTAG_BITSPERSAMPLE, &l->bits);
    TIFFGetFieldDefaulted(t, TIFFTAG_SAMPLESPERPIXEL, &l->samples);
    TIFFGetFieldDefaulted(t, TIFFTAG_PLANARCONFIG, &l->planar);
    TIFFGetFieldDefaulted(t, TIFFTAG_SAMPLEFORMAT, &l->format);
    TIFFGetFieldDefaulted(t, TIFFTAG_COMPRESSION, &l->compression);
    TIFFGetField(t, TIFFTAG_PHOTOMETRIC, &l->photometric);
    if (photo_check_size(path, width, height, err)) return err->status;
    info->width = (int)width;
    info->height = (int)height;
    const bool rgb = l->photometric == PHOTOMETRIC_RGB && l->samples >= 3,
               black = l->photometric == PHOTOMETRIC_MINISBLACK && l->samples >= 1,
               white = l->photometric == PHOTOMETRIC_MINISWHITE && l->samples >= 1;
    l->real = l->format == SAMPLEFORMAT_IEEEFP && (l->bits == 16 || l->bits == 32 || l->bits == 64);
    info->bits = l->real ? 32 : l->bits == 16 ? 16 : 8;
    l->plain = (rgb || black || (white && !l->real)) && l->samples <= 8 &&
               (l->real || (l->format == SAMPLEFORMAT_UINT && (l->bits == 8 || l->bits == 16)));
    if (l->plain) find_alpha(l, t, rgb ? 3 : 1);
    if (!l->plain && (l->bits > 8 || l->format != SAMPLEFORMAT_UINT || l->photometric == PHOTOMETRIC_SEPARATED))
        return err_set(
            err, ST_DATA,
            "%s is a TIFF of an unsupported kind (%d samples of %d bits%s%s); save it as RGB of 8 or 16 bits, or as "
            "EXR.",
            path, l->samples, l->bits,
            l->format == SAMPLEFORMAT_IEEEFP ? ", floating point"
            : l->format == SAMPLEFORMAT_INT  ? ", with a sign"
                                             : "",
            l->photometric == PHOTOMETRIC_SEPARATED ? ", CMYK" : "");
    return ST_OK;
}

static float half_of(uint16_t h)
{
    const int exponent = h >> 10 & 31, mantissa = h & 1023;
    const double size = exponent == 31  ? (mantissa ? NAN : INFINITY)
                        : exponent == 0 ? ldexp(mantissa, -24)
                                        : ldexp(mantissa + 1024, exponent - 25);
    return (float)(h & 0x8000 ? -size : size);
}

/* A sample as a number; not a number and infinite ones are 0. */
static float number_at(const unsigned char *at, uint16_t bits)
{
    float f = 0;
    double d = 0;
    uint16_t h = 0;
    if (bits == 16) {
        memcpy(&h, at, sizeof h);
        f = half_of(h);
    } else if (bits == 32) {
        memcpy(&f, at, sizeof f);
    } else {
        memcpy(&d, at, sizeof d);
        f = (float)d;
    }
    return isfinite(f) ? f : 0;
}

/* Where the samples of a block go: rows x columns, whose first pixel is at (x, y). */
struct tiff_block {
    int x, y, columns, rows;
    uint16_t plane;
    size_t row; /* bytes */
};

static void take_block(struct photo *p, unsigned char *alpha, const struct tiff_layout *l, const struct tiff_block *b,
                       const unsigned char *bytes)
{
    const bool separate = l->planar == PLANARCONFIG_SEPARATE, grey = l->photometric != PHOTOMETRIC_RGB;
    const size_t size = l->bits / 8, step = separate ? 1 : l->samples;
    const int last_x = p->info.width - b->x, last_y = p->info.height - b->y;
    for (int v = 0; v < b->rows && v < last_y; v++)
        for (int u = 0; u < b->columns && u < last_x; u++) {
            const unsigned char *from = bytes + (size_t)v * b->row + (size_t)u * step * size;
            const size_t pixel = (size_t)(b->y + v) * (size_t)p->info.width + (size_t)(b->x + u);
            for (size_t s = 0; s < step; s++) {
                const uint16_t sample = separate ? b->plane : (uint16_t)s;
                const unsigned char *at = from + s * size;
                uint16_t value = *at;
                if (!l->real && size == 2) memcpy(&value, at, sizeof value);
                if (l->photometric == PHOTOMETRIC_MINISWHITE && sample == 0)
                    value = (uint16_t)((size == 2 ? 65535 : 255) - value);
                const float number = l->real ? number_at(at, l->bits) : (float)value / (size == 2 ? 65535.0f : 255.0f);
                if (alpha && sample == l->alpha) alpha[pixel] = (unsigned char)lrintf(255 * fminf(fmaxf(number, 0), 1));
                for (uint16_t c = 0; c < 3; c++) {
                    if (sample != (grey ? 0 : c)) continue;
                    if (l->real)
                        p->values[3 * pixel + c] = number;
                    else
                        p->samples[3 * pixel + c] = value;
                }
            }
        }
}

/* Counts what is transparent, and divides colours by their alpha if they were multiplied by it. */
static void apply_alpha(struct photo *p, const unsigned char *alpha, bool premultiplied)
{
    const size_t pixels = (size_t)p->info.width * (size_t)p->info.height;
    const double largest = p->info.bits == 16 ? 65535 : 255;
    size_t hidden = 0;
    for (size_t i = 0; i < pixels; i++) {
        hidden += alpha[i] < 128;
        for (size_t c = 0; premultiplied && alpha[i] && c < 3; c++) {
            if (p->values)
                p->values[3 * i + c] *= 255.0f / alpha[i];
            else
                p->samples[3 * i + c] = (uint16_t)lrint(fmin(largest, p->samples[3 * i + c] * 255.0 / alpha[i]));
        }
    }
    p->transparent = (double)hidden / (double)pixels;
}

/* Rows of strips, or tiles, of each plane. */
static enum status read_plain(struct photo *p, TIFF *t, const struct tiff_layout *l, const struct tiff_reader *r,
                              struct err *err)
{
    const bool separate = l->planar == PLANARCONFIG_SEPARATE, tiled = TIFFIsTiled(t);
    const size_t pixels = (size_t)p->info.width * (size_t)p->info.height, step = separate ? 1 : l->samples;
    uint32_t columns = (uint32_t)p->info.width, rows = 1;
    if (tiled && (!TIFFGetField(t, TIFFTAG_TILEWIDTH, &columns) || !TIFFGetField(t, TIFFTAG_TILELENGTH, &rows)))
        return damaged(r, err);
    if (!columns || !rows || columns > 1 << 20 || rows > 1 << 20) return damaged(r, err);
    const size_t row = (size_t)(tiled ? TIFFTileRowSize(t) : TIFFScanlineSize(t)), bytes = row * rows;
    if (row < columns * step * (l->bits / 8) || (tiled && (size_t)TIFFTileSize(t) < bytes)) return damaged(r, err);
    unsigned char *block = malloc(tiled ? (size_t)TIFFTileSize(t) : bytes),
                  *alpha = l->alpha ? calloc(pixels, 1) : NULL;
    if (!block || (l->alpha && !alpha))
        err_nomem(err, "a part of a photo", bytes + pixels);
    else if (l->real)
        photo_init_values(p, err);
    else
        photo_init_samples(p, err);
    for (uint16_t plane = 0; !err->status && plane < (separate ? l->samples : 1); plane++)
        for (int y = 0; !err->status && y < p->info.height; y += (int)rows)
            for (int x = 0; !err->status && x < p->info.width; x += (int)columns) {
                const struct tiff_block at = {x, y, (int)columns, (int)rows, plane, row};
                const bool good = tiled ? TIFFReadTile(t, block, (uint32_t)x, (uint32_t)y, 0, plane) >= 0
                                        : TIFFReadScanline(t, block, (uint32_t)y, plane) == 1;
                if (good)
                    take_block(p, alpha, l, &at, block);
                else
                    damaged(r, err);
            }
    if (!err->status && alpha) apply_alpha(p, alpha, l->premultiplied);
    if (!err->status && l->real) p->saturation = photo_find_saturation(p);
    free(alpha);
    free(block);
    return err->status;
}

/* Palettes, fewer bits, YCbCr: libtiff converts them to 8-bit RGB. */
static enum status read_converted(struct photo *p, TIFF *t, const struct tiff_reader *r, struct err *err)
{
    const size_t pixels = (size_t)p->info.width * (size_t)p->info.height;
    uint32_t *rgba = malloc(pixels * sizeof *rgba);
    if (rgba)
        photo_init_samples(p, err);
    else
        err_nomem(err, "a photo", pixels * sizeof *rgba);
    /* rows from the top as stored, whatever the orientation */
    TIFFSetField(t, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
    if (!err->status &&
        !TIFFReadRGBAImageOriented(t, (uint32_t)p->info.width, (uint32_t)p->info.height, rgba, ORIENTATION_TOPLEFT, 1))
        damaged(r, err);
    for (size_t i = 0; !err->status && i < pixels; i++) {
        p->samples[3 * i] = (uint16_t)TIFFGetR(rgba[i]);
        p->samples[3 * i + 1] = (uint16_t)TIFFGetG(rgba[i]);
        p->samples[3 * i + 2] = (uint16_t)TIFFGetB(rgba[i]);
    }
    free(rgba);
    return err->status;
}

/* The photos in a file: pages that are neither reduced copies nor masks. */
static int count_pages(TIFF *t)
{
    enum { MOST = 1000 };
    int count = 1;
    for (int i = 0; i < MOST && TIFFReadDirectory(t); i++) {
        uint32_t kind = 0;
        TIFFGetField(t, TIFFTAG_SUBFILETYPE, &kind);
        count += !(kind & (FILETYPE_REDUCEDIMAGE | FILETYPE_MASK));
    }
    return count;
}

enum status photo_read_tiff(struct photo *p, const struct photo_bytes *file, bool pixels, struct err *err)
{
    struct tiff_reader r = {.file = file};
    struct tiff_layout layout;
    TIFF *t = open_tiff(&r);
    if (!t) return damaged(&r, err);
    read_layout(&layout, &p->info, t, file->path, err);
    /* refuse sizes that the file cannot hold, at a compression of at most 1000:1, before allocating memory */
    if (!err->status && pixels && (double)p->info.width * p->info.height > 1000.0 * (double)file->size)
        damaged(&r, err);
    if (!err->status && pixels) {
        if (layout.plain)
            read_plain(p, t, &layout, &r, err);
        else
            read_converted(p, t, &r, err);
    }
    uint32_t size = 0;
    void *tag = NULL;
    unsigned char *icc = NULL;
    if (!err->status && TIFFGetField(t, TIFFTAG_ICCPROFILE, &size, &tag) && size && (icc = malloc(size)))
        memcpy(icc, tag, size);
    const int pages = !err->status && pixels ? count_pages(t) : 1;
    if (pages > 1) p->pages = pages;
    TIFFClose(t);
    if (!err->status) photo_set_icc(p, icc, icc ? size : 0, pixels, file->path, err);
    free(icc);
    if (err->status) return err->status;
    r = (struct tiff_reader){.file = file}; /* reading EXIF changes the current directory, so open again */
    t = open_tiff(&r);
    if (t) {
        read_exif(&p->info, t);
        TIFFClose(t);
    }
    return ST_OK;
}
