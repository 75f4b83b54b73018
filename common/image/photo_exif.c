/* photo_exif.c - EXIF data of photographs, by libexif.
 *
 * The block is found here, in JPEG's APP1 segment or PNG's eXIf chunk, and only the block is given to libexif. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <libexif/exif-data.h>

#include "common/image/photo_formats.h"

/* ---------------------------------------------------------------------------------------------------------- reading */

static const unsigned char exif_mark[PHOTO_EXIF_MARK] = {'E', 'x', 'i', 'f', 0, 0};

/* The TIFF block in a JPEG's APP1 segment. False if no APP1 segment precedes the image data. */
static bool find_exif_jpeg(const struct photo_bytes *file, const unsigned char **block, size_t *size)
{
    const unsigned char *b = file->bytes;
    for (size_t at = 2; at + 4 <= file->size && b[at] == 0xff;) {
        if (b[at + 1] == 0xff) { /* fill byte */
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

/* The first value of an entry as a number; 0 if there is none. */
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

static void exif_text(ExifData *data, ExifIfd ifd, ExifTag tag, char *text, size_t size)
{
    ExifEntry *e = exif_content_get_entry(data->ifd[ifd], tag);
    const bool has_text = e && e->data && e->format == EXIF_FORMAT_ASCII;
    photo_keep_text(text, size, has_text ? (const char *)e->data : "", has_text ? e->size : 0);
}

/* Cameras name Adobe RGB by a colour space of 2, or as "uncalibrated" with the interoperability index R03. */
static bool exif_is_adobe(ExifData *data)
{
    ExifEntry *e = exif_content_get_entry(data->ifd[EXIF_IFD_INTEROPERABILITY], EXIF_TAG_INTEROPERABILITY_INDEX);
    const double space = exif_number(data, EXIF_IFD_EXIF, EXIF_TAG_COLOR_SPACE);
    return space == 2 || (space != 1 && e && e->data && e->size >= 3 && !memcmp(e->data, "R03", 3));
}

enum status photo_exif_read(struct photo_info *info, const struct photo_bytes *file, bool png, struct err *err)
{
    const unsigned char *block = NULL;
    size_t size = 0;
    info->orientation = 1;
    return (png ? find_exif_png : find_exif_jpeg)(file, &block, &size) ? photo_exif_take(info, block, size, err)
                                                                       : ST_OK;
}

/* libexif leaves out what it has no memory for, and says nothing. This notes it. */
static _Thread_local bool starved;
static void *noted(void *p)
{
    if (!p) starved = true;
    return p;
}
static void *exif_take(ExifLong size) { return noted(calloc(1, size ? size : 1)); }
static void *exif_resize(void *old, ExifLong size) { return noted(realloc(old, size ? size : 1)); }

static ExifData *exif_new(void)
{
    starved = false;
    ExifMem *mem = exif_mem_new(exif_take, exif_resize, free);
    ExifData *data = mem ? exif_data_new_mem(mem) : NULL;
    if (mem) exif_mem_unref(mem);
    return data;
}

enum status photo_exif_take(struct photo_info *info, const unsigned char *block, size_t size, struct err *err)
{
    info->orientation = 1;
    if (size > sizeof exif_mark && !memcmp(block, exif_mark, sizeof exif_mark)) {
        block += sizeof exif_mark;
        size -= sizeof exif_mark;
    }
    if (size > PHOTO_MAX_EXIF) return ST_OK;
    unsigned char *marked = malloc(sizeof exif_mark + size);
    ExifData *data = exif_new();
    if (!marked || !data) {
        err_nomem(err, "EXIF data", size);
    } else {
        memcpy(marked, exif_mark, sizeof exif_mark);
        memcpy(marked + sizeof exif_mark, block, size);
        exif_data_unset_option(
            data, EXIF_DATA_OPTION_FOLLOW_SPECIFICATION); /* or libexif would add entries that are missing */
        exif_data_load_data(data, marked, (unsigned)(sizeof exif_mark + size));
        double orientation = exif_number(data, EXIF_IFD_0, EXIF_TAG_ORIENTATION);
        if (orientation >= 1 && orientation <= 8) info->orientation = (int)orientation;
        info->focal_mm = exif_number(data, EXIF_IFD_EXIF, EXIF_TAG_FOCAL_LENGTH);
        info->focal35_mm = exif_number(data, EXIF_IFD_EXIF, EXIF_TAG_FOCAL_LENGTH_IN_35MM_FILM);
        info->seconds = exif_number(data, EXIF_IFD_EXIF, EXIF_TAG_EXPOSURE_TIME);
        info->f_number = exif_number(data, EXIF_IFD_EXIF, EXIF_TAG_FNUMBER);
        info->iso = exif_number(data, EXIF_IFD_EXIF, EXIF_TAG_ISO_SPEED_RATINGS);
        exif_text(data, EXIF_IFD_0, EXIF_TAG_MAKE, info->make, sizeof info->make);
        exif_text(data, EXIF_IFD_0, EXIF_TAG_MODEL, info->model, sizeof info->model);
        char date[32], subseconds[16];
        exif_text(data, EXIF_IFD_EXIF, EXIF_TAG_DATE_TIME_ORIGINAL, date, sizeof date);
        exif_text(data, EXIF_IFD_EXIF, EXIF_TAG_SUB_SEC_TIME_ORIGINAL, subseconds, sizeof subseconds);
        info->taken = photo_time(date, subseconds);
        info->adobe_rgb = exif_is_adobe(data);
        if (starved) err_nomem(err, "EXIF data", size);
    }
    if (data) exif_data_unref(data);
    free(marked);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- writing */

/* 1/n if the value is one (exposure times); otherwise millionths, or the finest power of ten that fits. */
static ExifRational exif_rational(double value)
{
    const double inverse = 1 / value;
    if (value < 1 && inverse < 4e9 && fabs(inverse - round(inverse)) < 1e-9 * inverse)
        return (ExifRational){1, (ExifLong)round(inverse)};
    ExifLong below = 1000000;
    while (below > 1 && value * below > 4e9) below /= 10;
    return (ExifRational){(ExifLong)round(value * below), below};
}

/* Adds an entry of `count` values. NULL: out of memory. The entry owns its data. */
static ExifEntry *exif_add(ExifData *data, ExifIfd ifd, ExifTag tag, ExifFormat format, size_t count)
{
    ExifMem *mem = exif_mem_new_default();
    ExifEntry *e = mem ? exif_entry_new_mem(mem) : NULL;
    const size_t size = count * exif_format_get_size(format);
    unsigned char *values = e ? exif_mem_alloc(mem, (ExifLong)size) : NULL;
    if (values) {
        e->tag = tag;
        e->format = format;
        e->components = count;
        e->size = (unsigned)size;
        e->data = values;
        exif_content_add_entry(data->ifd[ifd], e);
    }
    if (e) exif_entry_unref(e); /* the content has its own reference */
    if (mem) exif_mem_unref(mem);
    return values ? e : NULL;
}

static bool exif_put_text(ExifData *data, ExifIfd ifd, ExifTag tag, const char *text)
{
    if (!*text) return true;
    ExifEntry *e = exif_add(data, ifd, tag, EXIF_FORMAT_ASCII, strlen(text) + 1);
    if (e) memcpy(e->data, text, strlen(text) + 1);
    return e;
}

/* In milliseconds. */
static bool exif_put_time(ExifData *data, double taken)
{
    const double rounded = floor(taken * 1000 + 0.5) / 1000, second = floor(rounded);
    const time_t time = (time_t)second;
    struct tm t;
    char date[32], subseconds[8];
    if (!(taken > 0) || !gmtime_r(&time, &t) || !strftime(date, sizeof date, "%Y:%m:%d %H:%M:%S", &t)) return true;
    snprintf(subseconds, sizeof subseconds, "%03d", (int)fmin(999, round((rounded - second) * 1000)));
    return exif_put_text(data, EXIF_IFD_EXIF, EXIF_TAG_DATE_TIME_ORIGINAL, date) &&
           exif_put_text(data, EXIF_IFD_EXIF, EXIF_TAG_SUB_SEC_TIME_ORIGINAL, subseconds);
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

enum status photo_exif_block(unsigned char **block, unsigned *size, const struct photo_info *info, struct err *err)
{
    ExifData *data = exif_new();
    bool made = data;
    *block = NULL;
    if (made) {
        exif_data_set_byte_order(data, EXIF_BYTE_ORDER_INTEL);
        exif_data_unset_option(data, EXIF_DATA_OPTION_FOLLOW_SPECIFICATION);
        made = exif_put_text(data, EXIF_IFD_0, EXIF_TAG_MAKE, info->make) &&
               exif_put_text(data, EXIF_IFD_0, EXIF_TAG_MODEL, info->model) && exif_put_time(data, info->taken) &&
               exif_put_short(data, EXIF_IFD_0, EXIF_TAG_ORIENTATION, info->orientation) &&
               exif_put_rational(data, EXIF_TAG_EXPOSURE_TIME, info->seconds) &&
               exif_put_rational(data, EXIF_TAG_FNUMBER, info->f_number) &&
               exif_put_short(data, EXIF_IFD_EXIF, EXIF_TAG_ISO_SPEED_RATINGS, info->iso) &&
               exif_put_rational(data, EXIF_TAG_FOCAL_LENGTH, info->focal_mm) &&
               exif_put_short(data, EXIF_IFD_EXIF, EXIF_TAG_FOCAL_LENGTH_IN_35MM_FILM, info->focal35_mm);
    }
    if (made) exif_data_save_data(data, block, size);
    if (data) exif_data_unref(data);
    return !starved && *block && *size <= 65533 ? ST_OK : err_nomem(err, "EXIF data", 65533);
}
