/* photo_raw.c - develops cameras' raw files to linear radiance, by libraw.
 *
 * The settings are the same for every file, so that exposures can be compared: black level subtracted; the camera's
 * white balance from the file; AHD demosaicing; Rec.709 primaries; no gamma, no automatic brightness, no saturation
 * level adjusted to the image; highlights clipped, not reconstructed; not rotated. A value of 1 is where the sensor
 * saturates in the colour with the smallest white balance factor. Fix the white balance on the camera: if it differs
 * between photos, so do their colours. */
#include "common/image/photo_formats.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include <libraw/libraw.h>

static enum status failed(const struct photo_bytes *file, const char *what, int code, struct err *err)
{
    return err_set(err, ST_DATA,
                   "%s is a raw file that cannot be %s (libraw: %s); copy it again, or develop it to a 16-bit TIFF.",
                   file->path, what, libraw_strerror(code));
}

static double plausible(double value) { return value > 0 && value < 1e9 ? value : 0; }

/* libraw takes the camera's clock for local time; the result does not depend on the time zone here. */
static double time_taken(time_t timestamp)
{
    struct tm t;
    return timestamp > 0 && localtime_r(&timestamp, &t) ? fmax(0, (double)timegm(&t)) : 0;
}

/* The size is that of the developed image, except for rotated sensors and non-square pixels. */
static void keep_info(struct photo_info *info, const libraw_data_t *raw)
{
    static const int orientation[] = {[0] = 1, [3] = 3, [5] = 8, [6] = 6};
    const int flip = raw->sizes.flip;
    info->width = raw->sizes.width;
    info->height = raw->sizes.height;
    info->bits = 32;
    info->orientation = flip == 3 || flip == 5 || flip == 6 ? orientation[flip] : 1;
    info->seconds = plausible((double)raw->other.shutter);
    info->f_number = plausible((double)raw->other.aperture);
    info->iso = plausible((double)raw->other.iso_speed);
    info->focal_mm = plausible((double)raw->other.focal_len);
    info->focal35_mm = plausible((double)raw->lens.FocalLengthIn35mmFormat);
    info->taken = time_taken(raw->other.timestamp);
    photo_keep_text(info->make, sizeof info->make, raw->idata.make, sizeof raw->idata.make);
    photo_keep_text(info->model, sizeof info->model, raw->idata.model, sizeof raw->idata.model);
}

static enum status develop(struct photo *p, libraw_data_t *raw, const struct photo_bytes *file, struct err *err)
{
    int code = libraw_unpack(raw);
    if (code) return failed(file, "decoded", code, err);
    code = libraw_dcraw_process(raw);
    if (code) return failed(file, "developed", code, err);
    libraw_processed_image_t *picture = libraw_dcraw_make_mem_image(raw, &code);
    if (!picture) return failed(file, "developed", code, err);
    if (picture->type != LIBRAW_IMAGE_BITMAP || picture->bits != 16 || (picture->colors != 3 && picture->colors != 1))
        err_set(err, ST_DATA, "%s: libraw developed it to %d colours, wanted 3; develop it to a TIFF yourself.",
                file->path, picture->colors);
    p->info.width = picture->width;
    p->info.height = picture->height;
    if (!err->status) photo_init_values(p, err);
    const size_t pixels = (size_t)p->info.width * (size_t)p->info.height, colours = picture->colors;
    for (size_t i = 0; !err->status && i < pixels; i++)
        for (size_t c = 0; c < 3; c++) {
            uint16_t value;
            memcpy(&value, picture->data + 2 * (colours * i + (colours == 3 ? c : 0)), sizeof value);
            p->values[3 * i + c] = (float)value / 65535;
        }
    p->saturation = 1;
    libraw_dcraw_clear_mem(picture);
    return err->status;
}

enum status photo_read_raw(struct photo *p, const struct photo_bytes *file, bool pixels, struct err *err)
{
    libraw_data_t *raw = libraw_init(LIBRAW_OPTIONS_NONE);
    if (!raw) return err_nomem(err, "a reader of raw files", 0);
    libraw_set_dataerror_handler(raw, NULL, NULL); /* the default handler prints */
    libraw_output_params_t *o = &raw->params;
    o->use_camera_wb = 1;
    o->use_auto_wb = 0;
    o->output_color = 1;
    o->output_bps = 16;
    o->gamm[0] = o->gamm[1] = 1;
    o->no_auto_bright = 1;
    o->adjust_maximum_thr = 0;
    o->highlight = 0;
    o->user_qual = 3;
    o->user_flip = 0;
    int code = libraw_open_buffer(raw, file->bytes, file->size);
    if (code) failed(file, "read", code, err);
    if (!err->status) {
        keep_info(&p->info, raw);
        photo_check_size(file->path, (uint64_t)p->info.width, (uint64_t)p->info.height, err);
    }
    if (!err->status && pixels) develop(p, raw, file, err);
    libraw_close(raw);
    return err->status;
}
