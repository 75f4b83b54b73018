/* given_map.c - see given_map.h.
 *
 * A PFM is "Pf", width, height, a number whose sign tells the order of bytes (negative: least first), then floats, rows
 * from the bottom up. TIFF is read by libtiff, since photos are converted to 16 bits by their own reader. */
#include "stages/segment_depth/given_map.h"

#include <dirent.h>
#include <endian.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include <tiffio.h>

#include "common/base/file_bytes.h"
#include "common/base/file_path.h"
#include "common/base/scan.h"
#include "common/base/sort.h"
#include "common/image/exr.h"
#include "common/image/photo.h"

enum { MAX_SIDE = 1 << 20, MAX_PIXELS = 1 << 28 };

static const char *const endings[] = {".exr", ".png", ".pfm", ".tif", ".tiff"};
enum { ENDINGS = sizeof endings / sizeof *endings };

/* The place of a file's ending in the list; ENDINGS: none. */
static int ending_of(const char *file)
{
    const char *dot = strrchr(file, '.');
    int i = 0;
    while (i < ENDINGS && (!dot || strcasecmp(dot, endings[i]) != 0)) i++;
    return i;
}

/* How well a file fits: lower is better; -1: it does not. */
static int rank_of(const char *file, const char *name)
{
    const int ending = ending_of(file);
    const size_t stem = ending < ENDINGS ? strlen(file) - strlen(endings[ending]) : 0;
    if (!stem || stem != strlen(name) || strncasecmp(file, name, stem)) return -1;
    const bool exact = !strncmp(file, name, stem);
    return 2 * ending + (exact ? 0 : 2 * ENDINGS) + (strcmp(file + stem, endings[ending]) != 0);
}

enum status given_map_find(char **path, const char *folder, const char *name, struct err *err)
{
    struct dirent **names = NULL;
    const int count = scandir(folder, &names, NULL, alphasort);
    int best = -1, rank = 0;
    *path = NULL;
    if (count < 0) return err_errno(err, "open", folder);
    for (int i = 0; i < count; i++) {
        const int own = rank_of(names[i]->d_name, name);
        if (own < 0 || (best >= 0 && own >= rank)) continue;
        best = i;
        rank = own;
    }
    if (best >= 0 && asprintf(path, "%s/%s", folder, names[best]->d_name) < 0) {
        *path = NULL;
        err_nomem(err, "a file name", strlen(folder) + strlen(name));
    }
    for (int i = 0; i < count; i++) free(names[i]);
    free(names);
    return err->status;
}

static enum status init_map(struct given_map *m, int64_t width, int64_t height, const char *path, struct err *err)
{
    if (width < 1 || height < 1 || width > MAX_SIDE || height > MAX_SIDE || width * height > MAX_PIXELS)
        return err_set(err, ST_DATA, "%s has %lld x %lld pixels; wanted 1 to %d.", path, (long long)width,
                       (long long)height, MAX_PIXELS);
    const size_t pixels = (size_t)width * (size_t)height;
    m->width = (int)width;
    m->height = (int)height;
    m->samples = malloc(pixels * sizeof *m->samples);
    return m->samples ? ST_OK : err_nomem(err, "given depth", pixels * sizeof *m->samples);
}

static enum status read_exr(struct given_map *m, const char *path, struct err *err)
{
    struct exr_image exr = {0};
    exr_read_any(&exr, path, err);
    const struct exr_plane *plane = err->status ? NULL : exr_find(&exr, "Z");
    if (!err->status && !plane && exr.count == 1) plane = exr.planes;
    if (!err->status && !plane) {
        char channels[1024] = "";
        for (int c = 0; c < exr.count; c++) {
            const size_t length = strlen(channels);
            snprintf(channels + length, sizeof channels - length, " %s", exr.planes[c].name);
        }
        err_set(err, ST_DATA, "%s has the channels%s; wanted a channel Z, or a single channel.", path, channels);
    }
    if (!err->status) init_map(m, exr.width, exr.height, path, err);
    const size_t pixels = (size_t)m->width * (size_t)m->height;
    for (size_t i = 0; !err->status && i < pixels; i++)
        m->samples[i] = plane->f ? (double)plane->f[i] : (double)plane->u[i];
    exr_image_release(&exr);
    return err->status;
}

static enum status read_png(struct given_map *m, const char *path, struct err *err)
{
    struct photo photo = {0};
    if (!photo_read(&photo, path, err)) init_map(m, photo.info.width, photo.info.height, path, err);
    const size_t pixels = (size_t)m->width * (size_t)m->height;
    m->whole_numbers = true;
    for (size_t i = 0; !err->status && i < pixels; i++) {
        const uint16_t *s = photo.samples + 3 * i;
        if (s[0] != s[1] || s[0] != s[2])
            err_set(err, ST_DATA, "%s is a colour picture; wanted a grey PNG of 8 or 16 bits per pixel.", path);
        m->samples[i] = s[0];
    }
    photo_release(&photo);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------------ PFM */

/* The next word of the head, ended by one blank; "" if there is none or it is long. */
static void next_word(char word[32], const struct file_bytes *f, size_t *at)
{
    size_t n = 0;
    while (*at < f->size && strchr(" \t\r\n", f->bytes[*at])) ++*at;
    while (*at < f->size && !strchr(" \t\r\n", f->bytes[*at]) && n < 31) word[n++] = f->bytes[(*at)++];
    word[n] = '\0';
    if (*at < f->size) ++*at;
}

static enum status read_pfm(struct given_map *m, const char *path, struct err *err)
{
    struct file_bytes f = {0};
    char kind[32], words[3][32];
    int64_t size[2] = {0};
    double order = 0;
    size_t at = 0;
    if (file_bytes_read(&f, path, err)) return err->status;
    next_word(kind, &f, &at);
    for (int i = 0; i < 3; i++) next_word(words[i], &f, &at);
    const bool good = !strcmp(kind, "Pf") && scan_int(words[0], &size[0]) && scan_int(words[1], &size[1]) &&
                      scan_double(words[2], &order) && order != 0;
    if (!good)
        err_set(err, ST_DATA, "%s is no grey PFM; wanted \"Pf\", width, height and the order of bytes%s.", path,
                strcmp(kind, "PF") ? "" : ", but it is of colours");
    if (!err->status && !init_map(m, size[0], size[1], path, err) &&
        f.size - at < 4 * (size_t)m->width * (size_t)m->height)
        err_set(err, ST_DATA, "%s has %zu bytes of samples, wanted %zu; it was cut off.", path, f.size - at,
                4 * (size_t)m->width * (size_t)m->height);
    for (int y = m->height - 1; !err->status && y >= 0; y--)
        for (int x = 0; x < m->width; x++, at += 4) {
            uint32_t bits;
            float sample;
            memcpy(&bits, f.bytes + at, 4);
            bits = order < 0 ? le32toh(bits) : be32toh(bits);
            memcpy(&sample, &bits, 4);
            m->samples[(size_t)y * (size_t)m->width + (size_t)x] = (double)sample;
        }
    file_bytes_release(&f);
    return err->status;
}

/* ----------------------------------------------------------------------------------------------------------- TIFF */

static int keep_message(TIFF *t, void *ctx, const char *module, const char *format, va_list args)
{
    char *message = ctx;
    (void)t, (void)module;
    if (!*message) vsnprintf(message, 200, format, args);
    return 1; /* libtiff's own handler, which prints, is not called */
}

static int ignore(TIFF *t, void *ctx, const char *module, const char *format, va_list args)
{
    (void)t, (void)ctx, (void)module, (void)format, (void)args;
    return 1;
}

struct tiff_kind {
    uint32_t width, height;
    uint16_t bits, format, channels;
};

static double tiff_sample(const unsigned char *p, const struct tiff_kind *k)
{
    union {
        uint8_t u8;
        int8_t s8;
        uint16_t u16;
        int16_t s16;
        uint32_t u32;
        int32_t s32;
        float f;
        double d;
    } v;
    memcpy(&v, p, k->bits / 8);
    const bool is_signed = k->format == SAMPLEFORMAT_INT;
    if (k->format == SAMPLEFORMAT_IEEEFP) return k->bits == 64 ? v.d : (double)v.f;
    if (k->bits == 8) return is_signed ? v.s8 : v.u8;
    if (k->bits == 16) return is_signed ? v.s16 : v.u16;
    return is_signed ? (double)v.s32 : (double)v.u32;
}

static enum status read_rows(struct given_map *m, TIFF *t, const struct tiff_kind *k, const char *path,
                             const char *message, struct err *err)
{
    const size_t row = (size_t)TIFFScanlineSize(t), bytes = k->bits / 8;
    unsigned char *line = malloc(row + 8);
    if (!line) return err_nomem(err, "a row of depth", row);
    for (uint32_t y = 0; !err->status && y < k->height; y++) {
        if (row < bytes * k->width || TIFFReadScanline(t, line, y, 0) < 0)
            err_set(err, ST_DATA, "%s: row %u of %u cannot be read (%s); it was cut off, or is damaged.", path, y + 1,
                    k->height, *message ? message : "libtiff gives no reason");
        for (uint32_t x = 0; !err->status && x < k->width; x++)
            m->samples[(size_t)y * k->width + x] = tiff_sample(line + bytes * x, k);
    }
    free(line);
    return err->status;
}

static enum status read_tiff(struct given_map *m, const char *path, struct err *err)
{
    char message[200] = "";
    struct tiff_kind k = {0};
    TIFFOpenOptions *options = TIFFOpenOptionsAlloc();
    if (!options) return err_nomem(err, "TIFF", 0);
    TIFFOpenOptionsSetErrorHandlerExtR(options, keep_message, message);
    TIFFOpenOptionsSetWarningHandlerExtR(options, ignore, NULL);
    TIFF *t = TIFFOpenExt(path, "r", options);
    TIFFOpenOptionsFree(options);
    if (!t) return err_set(err, ST_DATA, "%s is no TIFF that can be read: %s.", path, message);
    TIFFGetField(t, TIFFTAG_IMAGEWIDTH, &k.width);
    TIFFGetField(t, TIFFTAG_IMAGELENGTH, &k.height);
    TIFFGetFieldDefaulted(t, TIFFTAG_BITSPERSAMPLE, &k.bits);
    TIFFGetFieldDefaulted(t, TIFFTAG_SAMPLEFORMAT, &k.format);
    TIFFGetFieldDefaulted(t, TIFFTAG_SAMPLESPERPIXEL, &k.channels);
    const bool is_float = k.format == SAMPLEFORMAT_IEEEFP;
    const bool whole = k.format == SAMPLEFORMAT_UINT || k.format == SAMPLEFORMAT_INT;
    if (k.channels != 1 || TIFFIsTiled(t) || !(is_float ? k.bits == 32 || k.bits == 64 : whole) ||
        (whole && k.bits != 8 && k.bits != 16 && k.bits != 32))
        err_set(err, ST_DATA,
                "%s has %d channels of %d bits, %s%s; wanted one channel of 16 or 32 bits, of whole numbers or floats, "
                "in strips.",
                path, k.channels, k.bits, is_float ? "floats" : "whole numbers", TIFFIsTiled(t) ? ", in tiles" : "");
    m->whole_numbers = whole;
    if (!err->status && !init_map(m, k.width, k.height, path, err)) read_rows(m, t, &k, path, message, err);
    TIFFClose(t);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------------ all */

enum status given_map_clear_sentinel(struct given_map *m, struct err *err)
{
    const size_t pixels = (size_t)m->width * (size_t)m->height;
    double *sorted = malloc((pixels + 1) * sizeof *sorted);
    size_t n = 0, low = 0, high = 0; /* samples that equal the least, and the greatest */
    m->sentinel = NAN;
    m->sentinels = 0;
    if (!sorted) return err_nomem(err, "given depth", pixels * sizeof *sorted);
    for (size_t i = 0; i < pixels; i++)
        if (!isnan(m->samples[i])) sorted[n++] = m->samples[i];
    sort_doubles(sorted, n);
    while (low < n && sorted[low] == sorted[0]) low++;
    while (high < n && sorted[n - 1 - high] == sorted[n - 1]) high++;
    if (low >= GIVEN_REPEATED && low < n && sorted[0] < 0 && sorted[low] >= 0) {
        m->sentinel = sorted[0];
        m->sentinels = (int)low;
    } else if (high >= GIVEN_REPEATED && high < n && sorted[n - 1 - high] > 0 &&
               sorted[n - 1] > GIVEN_GAP * sorted[n - 1 - high]) {
        m->sentinel = sorted[n - 1];
        m->sentinels = (int)high;
    }
    for (size_t i = 0; m->sentinels && i < pixels; i++)
        if (m->samples[i] == m->sentinel) m->samples[i] = NAN;
    free(sorted);
    return ST_OK;
}

enum status given_map_read(struct given_map *m, const char *path, struct err *err)
{
    static enum status (*const readers[ENDINGS])(struct given_map * m, const char *path, struct err *err) = {
        read_exr, read_png, read_pfm, read_tiff, read_tiff};
    const int ending = ending_of(path);
    *m = (struct given_map){.sentinel = NAN};
    if (ending == ENDINGS) return err_set(err, ST_DATA, "%s is none of .exr, .png, .pfm, .tif and .tiff.", path);
    readers[ending](m, path, err);
    const size_t pixels = (size_t)m->width * (size_t)m->height;
    for (size_t i = 0; !err->status && i < pixels; i++)
        if (!isfinite(m->samples[i])) m->samples[i] = NAN;
    if (!err->status) given_map_clear_sentinel(m, err);
    if (err->status) given_map_release(m);
    return err->status;
}

void given_map_release(struct given_map *m)
{
    if (!m) return;
    free(m->samples);
    *m = (struct given_map){0};
}
