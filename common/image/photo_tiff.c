/* photo_tiff.c - TIFF files of 8 and 16 bits, by libtiff.
 *
 * RGB and grey samples are read as stored; libtiff converts other 8-bit kinds to RGB. libtiff rather than OpenCV's
 * reader, because it is C, keeps 16 bits and gives the EXIF data. */
#include "common/image/photo_formats.h"

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
    bool plain; /* rows of RGB or grey, 8 or 16 bits */
};

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
    info->bits = l->bits == 16 ? 16 : 8;
    const bool rgb = l->photometric == PHOTOMETRIC_RGB && l->samples >= 3,
               grey = l->photometric == PHOTOMETRIC_MINISBLACK && l->samples >= 1;
    l->plain = (rgb || grey) && (l->bits == 8 || l->bits == 16) && l->format == SAMPLEFORMAT_UINT && l->samples <= 8 &&
               !TIFFIsTiled(t);
    if (!l->plain && (l->bits > 8 || l->format != SAMPLEFORMAT_UINT || l->photometric == PHOTOMETRIC_SEPARATED))
        return err_set(
            err, ST_DATA,
            "%s is a TIFF of an unsupported kind (%d samples of %d bits%s%s); save it as RGB of 8 or 16 bits "
            "without tiles, or as EXR.",
            path, l->samples, l->bits, l->format == SAMPLEFORMAT_IEEEFP ? ", floating point" : "",
            TIFFIsTiled(t) ? ", in tiles" : "");
    return ST_OK;
}

static enum status read_plain(struct photo *p, TIFF *t, const struct tiff_layout *l, const struct tiff_reader *r,
                              struct err *err)
{
    const size_t row = (size_t)TIFFScanlineSize(t), width = (size_t)p->info.width;
    const bool separate = l->planar == PLANARCONFIG_SEPARATE, grey = l->photometric == PHOTOMETRIC_MINISBLACK;
    const size_t step = separate ? 1 : l->samples;
    if (row < width * step * (l->bits / 8)) return damaged(r, err);
    unsigned char *line = malloc(row);
    if (line)
        photo_init_samples(p, err);
    else
        err_nomem(err, "a row of a photo", row);
    for (uint16_t plane = 0; !err->status && plane < (separate && !grey ? 3 : 1); plane++)
        for (int y = 0; !err->status && y < p->info.height; y++) {
            uint16_t *to = p->samples + (size_t)y * width * 3;
            if (TIFFReadScanline(t, line, (uint32_t)y, plane) != 1) {
                damaged(r, err);
                break;
            }
            for (size_t x = 0; x < width; x++)
                for (size_t c = separate && !grey ? plane : 0; c < (separate && !grey ? plane + 1u : 3u); c++) {
                    const size_t at = x * step + (separate || grey ? 0 : c);
                    uint16_t value = line[at];
                    if (l->bits != 8) memcpy(&value, line + at * sizeof value, sizeof value);
                    to[3 * x + c] = value;
                }
        }
    free(line);
    return err->status;
}

/* Palettes, fewer bits, YCbCr, tiles: libtiff converts them to 8-bit RGB. */
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
