/* photo.c - reads photographs.
 *
 * A file is read into memory once. Its format follows from its first bytes, not from its name; each format has a file
 * of its own (photo_formats.h). */
#include "common/image/photo.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/image/exr.h"
#include "common/image/photo_formats.h"
#include "common/image/photo_kind.h"

/* name: in prov; NULL: the photo is not recorded. */
static enum status read_bytes(struct photo_bytes *file, const char *path, const char *name, struct provenance *prov,
                              struct err *err)
{
    struct file_bytes read = {0};
    if (name)
        provenance_read(prov, name, &read, path, err);
    else
        file_bytes_read(&read, path, err);
    *file = (struct photo_bytes){path, (unsigned char *)read.bytes, read.size};
    if (!err->status && !file->size) err_set(err, ST_DATA, "%s is empty; copy the photo again.", path);
    return err->status;
}

static enum status unknown_kind(const struct photo_bytes *file, enum photo_kind kind, struct err *err)
{
    if (kind == PHOTO_KIND_VIDEO)
        return err_set(err, ST_DATA, "%s is a video, not a photo; only the folder of photos may contain videos.",
                       file->path);
    char begin[32] = "";
    for (size_t i = 0; i < file->size && i < 8; i++) sprintf(begin + 3 * i, " %02x", file->bytes[i]);
    return err_set(
        err, ST_DATA,
        "%s is neither JPEG, PNG, TIFF, HEIC, AVIF, WebP, JPEG XL, EXR nor a known raw format (it begins with "
        "the bytes%s); save it as one of them.",
        file->path, begin);
}

/* The primaries of an EXR file; Rec.709 without the attribute. */
static enum status read_exr_colours(struct photo *p, const struct exr_image *exr, const char *path, struct err *err)
{
    struct chromaticities c;
    if (exr->pixel_aspect_ratio > 0 && fabsf(exr->pixel_aspect_ratio - 1) > 1e-3f)
        return err_set(err, ST_DATA,
                       "%s: its pixels are %.4g times as wide as high, wanted square ones; save it with a pixel aspect "
                       "ratio of 1.",
                       path, (double)exr->pixel_aspect_ratio);
    if (!exr->has_chromaticities) return ST_OK;
    for (int i = 0; i < 8; i++) c.xy[i / 2][i % 2] = (double)exr->chromaticities[i];
    return photo_set_primaries(p, &c, 1, "EXR chromaticities", path, err);
}

/* EXR is linear. It has no EXIF data: exposure and camera stay unknown. */
static enum status read_exr(struct photo *p, const struct photo_bytes *file, bool pixels, struct err *err)
{
    static const char *const names[] = {"R", "G", "B"};
    struct exr_image exr = {0};
    exr_read(&exr, file->path, names, pixels ? 3 : 0, err);
    for (int c = 0; !err->status && pixels && c < 3; c++)
        if (!exr_find(&exr, names[c])->f)
            err_set(err, ST_DATA, "%s: channel %s holds integers, wanted half or float; export it as half or float.",
                    file->path, names[c]);
    p->info.bits = 32;
    if (!err->status) {
        p->info.width = exr.width;
        p->info.height = exr.height;
        photo_check_size(file->path, (uint64_t)exr.width, (uint64_t)exr.height, err);
    }
    if (!err->status && pixels) photo_init_values(p, err);
    const size_t count = (size_t)p->info.width * (size_t)p->info.height;
    for (size_t c = 0; !err->status && pixels && c < 3; c++) {
        const float *from = exr_find(&exr, names[c])->f;
        for (size_t i = 0; i < count; i++) p->values[3 * i + c] = from[i];
    }
    if (!err->status && pixels) p->saturation = photo_find_saturation(p);
    if (!err->status) read_exr_colours(p, &exr, file->path, err);
    exr_image_release(&exr);
    return err->status;
}

/* Orientations 2, 4, 5 and 7 are mirrored: rows are reversed, so that what is left is a turn. */
static void unmirror(struct photo *p)
{
    static const int turns[] = {[2] = 1, [4] = 3, [5] = 8, [7] = 6};
    const int o = p->info.orientation, w = p->info.width;
    if (o != 2 && o != 4 && o != 5 && o != 7) return;
    p->info.orientation = turns[o];
    if (!p->bytes && !p->samples && !p->values) return;
    for (int y = 0; y < p->info.height; y++)
        for (int x = 0; x < w / 2; x++)
            for (int c = 0; c < 3; c++) {
                const size_t row = (size_t)y * (size_t)w, a = 3 * (row + (size_t)x) + (size_t)c,
                             b = 3 * (row + (size_t)(w - 1 - x)) + (size_t)c;
                if (p->bytes) {
                    const uint8_t kept = p->bytes[a];
                    p->bytes[a] = p->bytes[b];
                    p->bytes[b] = kept;
                }
                if (p->samples) {
                    const uint16_t kept = p->samples[a];
                    p->samples[a] = p->samples[b];
                    p->samples[b] = kept;
                }
                if (p->values) {
                    const float kept = p->values[a];
                    p->values[a] = p->values[b];
                    p->values[b] = kept;
                }
            }
}

enum read { ANY_FORMAT = 1, GAIN = 2 /* apply gain maps */ };

static enum status read_photo(struct photo *p, const char *path, enum photo_want want, unsigned how, const char *name,
                              struct provenance *prov, struct err *err)
{
    static enum status (*const read[])(struct photo *, const struct photo_bytes *, bool, struct err *) = {
        [PHOTO_KIND_PNG] = photo_read_png, [PHOTO_KIND_TIFF] = photo_read_tiff, [PHOTO_KIND_EXR] = read_exr,
        [PHOTO_KIND_RAW] = photo_read_raw, [PHOTO_KIND_HEIF] = photo_read_heif, [PHOTO_KIND_WEBP] = photo_read_webp,
        [PHOTO_KIND_JXL] = photo_read_jxl,
    };
    struct photo_bytes file = {0};
    enum photo_kind kind = PHOTO_KIND_OTHER;
    *p = (struct photo){.info.orientation = 1};
    if (!read_bytes(&file, path, name, prov, err)) kind = photo_kind_of(file.bytes, file.size);
    if (kind == PHOTO_KIND_TIFF && photo_tiff_is_raw(&file)) kind = PHOTO_KIND_RAW;
    if (!err->status && (kind == PHOTO_KIND_OTHER || kind == PHOTO_KIND_VIDEO)) unknown_kind(&file, kind, err);
    if (!err->status && !(how & ANY_FORMAT) && (kind == PHOTO_KIND_EXR || kind == PHOTO_KIND_RAW))
        err_set(err, ST_DATA, "%s is %s; wanted JPEG, PNG, TIFF, HEIC, AVIF, WebP or JPEG XL here.", path,
                kind == PHOTO_KIND_EXR ? "an EXR file" : "a camera's raw file");
    if (!err->status && kind == PHOTO_KIND_JPEG)
        photo_read_jpeg(p, &file, want, err);
    else if (!err->status)
        read[kind](p, &file, want != PHOTO_HEADER, err);
    if (!err->status && how & GAIN && kind == PHOTO_KIND_JPEG) photo_apply_gain(p, &file, want, err);
    free(file.bytes);
    if (!err->status && !(how & ANY_FORMAT) && p->info.bits == 32)
        err_set(err, ST_DATA, "%s is a TIFF of floating-point samples; wanted 8 or 16 bits here.", path);
    if (!err->status) unmirror(p);
    if (err->status) photo_release(p);
    return err->status;
}

enum status photo_read(struct photo *p, const char *path, struct err *err)
{
    return read_photo(p, path, PHOTO_SAMPLES, 0, NULL, NULL, err);
}

enum status photo_read_input(struct photo *p, const char *path, const char *name, struct provenance *prov,
                             struct err *err)
{
    return read_photo(p, path, PHOTO_SAMPLES, 0, name, prov, err);
}

enum status photo_read_any(struct photo *p, const char *path, struct err *err)
{
    return read_photo(p, path, PHOTO_SAMPLES, ANY_FORMAT, NULL, NULL, err);
}

enum status photo_read_hdr(struct photo *p, const char *path, struct err *err)
{
    return read_photo(p, path, PHOTO_SAMPLES, ANY_FORMAT | GAIN, NULL, NULL, err);
}

enum status photo_read_compact(struct photo *p, const char *path, const char *name, struct provenance *prov,
                               struct err *err)
{
    return read_photo(p, path, PHOTO_BYTES, 0, name, prov, err);
}

static enum status read_info(struct photo_info *info, const char *path, enum photo_want want, unsigned how,
                             struct err *err)
{
    struct photo p = {0};
    read_photo(&p, path, want, how, NULL, NULL, err);
    *info = p.info;
    photo_release(&p);
    return err->status;
}

enum status photo_read_info(struct photo_info *info, const char *path, struct err *err)
{
    return read_info(info, path, PHOTO_HEADER, ANY_FORMAT, err);
}

enum status photo_read_hdr_info(struct photo_info *info, const char *path, struct err *err)
{
    return read_info(info, path, PHOTO_HEADER, ANY_FORMAT | GAIN, err);
}

enum status photo_check(struct photo *p, const char *path, bool gain_maps, struct err *err)
{
    if (read_photo(p, path, PHOTO_CHECK, ANY_FORMAT | (gain_maps ? GAIN : 0), NULL, NULL, err)) return err->status;
    photo_release_pixels(p);
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------------ light */

enum status photo_light_init(struct photo_light *l, const struct photo *p, struct err *err)
{
    const size_t levels = p->info.bits == 16 ? 65536 : 256;
    *l = (struct photo_light){p, {NULL}, NULL};
    for (size_t c = 0; p->space && c < 3; c++) l->curves[c] = p->space->light + c * levels;
    if (p->space) return ST_OK;
    l->curve = malloc(levels * sizeof *l->curve);
    if (!l->curve) return err_nomem(err, "a tone curve", levels * sizeof *l->curve);
    for (size_t i = 0; i < levels; i++) l->curve[i] = linear_from_srgb((float)i / (float)(levels - 1));
    for (size_t c = 0; c < 3; c++) l->curves[c] = l->curve;
    return ST_OK;
}

void photo_light_take(const struct photo_light *l, float *rgb, size_t first, size_t count)
{
    const struct photo *p = l->photo;
    const float *const red = l->curves[0], *const green = l->curves[1], *const blue = l->curves[2];
    if (p->bytes) {
        const uint8_t *from = p->bytes + 3 * first;
        for (size_t i = 0; i < 3 * count; i += 3) {
            rgb[i] = red[from[i]];
            rgb[i + 1] = green[from[i + 1]];
            rgb[i + 2] = blue[from[i + 2]];
        }
    } else {
        const uint16_t *from = p->samples + 3 * first;
        for (size_t i = 0; i < 3 * count; i += 3) {
            rgb[i] = red[from[i]];
            rgb[i + 1] = green[from[i + 1]];
            rgb[i + 2] = blue[from[i + 2]];
        }
    }
    if (p->space) colour_space_to_rec709(p->space, rgb, count);
}

void photo_light_release(struct photo_light *l)
{
    if (!l) return;
    free(l->curve);
    *l = (struct photo_light){0};
}

struct linear_job {
    const struct photo_light *light;
    float *out;
};

static void take_some(void *ctx, size_t begin, size_t end, int thread)
{
    (void)thread;
    const struct linear_job *job = ctx;
    photo_light_take(job->light, job->out + 3 * begin, begin, end - begin);
}

enum status photo_to_linear(struct image *out, const struct photo *p, struct err *err)
{
    struct photo_light light;
    *out = (struct image){0};
    if (!photo_light_init(&light, p, err) && !image_init(out, p->info.width, p->info.height, 3, err)) {
        struct linear_job job = {&light, out->data};
        parallel_for((size_t)p->info.width * (size_t)p->info.height, 1 << 15, take_some, &job);
    }
    photo_light_release(&light);
    return err->status;
}
