/* photo_jpeg.c - JPEG files, by libjpeg-turbo.
 *
 * JPEG rounds the coefficients of an orthonormal transform of blocks of 8 x 8 pixels to multiples of the steps q_k in
 * the file. If the errors are spread evenly, their variance is q_k^2 / 12 each, so that of a pixel is the mean over k.
 * Where coefficients are smaller than half a step, it is less. */
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jpeglib.h>

#include <jerror.h>
#include <turbojpeg.h>

#include "common/base/outfile.h"
#include "common/image/photo.h"
#include "common/image/photo_formats.h"

/* ---------------------------------------------------------------------------------------------------------- reading */

static enum status jpeg_damaged(const struct photo_bytes *file, const char *reason, struct err *err)
{
    if (strcasestr(reason, "memory")) return err_nomem(err, "a JPEG decoder", 0); /* the photo may be whole */
    return err_set(err, ST_DATA, "%s is a damaged or cut-off JPEG (%s); copy or export the photo again.", file->path,
                   reason);
}

static enum status read_jpeg_header(struct photo_info *info, const struct photo_bytes *file, tjhandle handle,
                                    struct err *err)
{
    int subsampling = 0, space = 0;
    if (tjDecompressHeader3(handle, file->bytes, file->size, &info->width, &info->height, &subsampling, &space))
        return jpeg_damaged(file, tjGetErrorStr2(handle), err);
    if (info->width < 1) /* not an error to the decoder, which waits for more data */
        return err_set(err, ST_DATA, "%s is a JPEG that ends within its header; copy the photo again.", file->path);
    if (space == TJCS_CMYK || space == TJCS_YCCK)
        return err_set(err, ST_DATA, "%s is a CMYK JPEG, made for printing; export the photo as RGB.", file->path);
    info->bits = 8;
    return photo_check_size(file->path, (uint64_t)info->width, (uint64_t)info->height, err);
}

struct jpeg_reader {
    struct jpeg_decompress_struct d;
    struct jpeg_error_mgr errors;
    struct jpeg_progress_mgr progress;
    jmp_buf failed;
    char reason[JMSG_LENGTH_MAX];
    unsigned char *row; /* R G B; owned */
};

static _Noreturn void give_up(j_common_ptr c)
{
    struct jpeg_reader *r = c->client_data;
    c->err->format_message(c, r->reason);
    longjmp(r->failed, 1);
}

/* A decoder's warning means that pixels are missing or invented. One warning is harmless: some cameras write padding
 * between the complete image and the end marker 0xd9. */
static void take_message(j_common_ptr c, int level)
{
    if (level < 0 && !(c->err->msg_code == JWRN_EXTRANEOUS_DATA && c->err->msg_parm.i[1] == 0xd9)) give_up(c);
}

/* A small file may ask for thousands of scans of a huge picture. */
static void count_scans(j_common_ptr c)
{
    enum { MAX_SCANS = 500 };
    struct jpeg_reader *r = c->client_data;
    if (r->d.input_scan_number <= MAX_SCANS) return;
    snprintf(r->reason, sizeof r->reason, "it has more than %d scans", MAX_SCANS);
    longjmp(r->failed, 1);
}

/* Decodes row by row, so that a picture is in memory once; want = PHOTO_CHECK: not at all. */
static void decode_rows(struct photo *p, const struct photo_bytes *file, enum photo_want want, struct jpeg_reader *r)
{
    const size_t samples = (size_t)p->info.width * 3;
    jpeg_mem_src(&r->d, file->bytes, file->size);
    jpeg_read_header(&r->d, TRUE);
    r->d.out_color_space = JCS_EXT_RGB;
    jpeg_start_decompress(&r->d);
    while (r->d.output_scanline < r->d.output_height) {
        const size_t at = r->d.output_scanline * samples;
        unsigned char *row = want == PHOTO_BYTES ? p->bytes + at : r->row;
        jpeg_read_scanlines(&r->d, &row, 1);
        for (size_t i = 0; want == PHOTO_SAMPLES && i < samples; i++) p->samples[at + i] = row[i];
    }
    jpeg_finish_decompress(&r->d);
}

static enum status read_jpeg_pixels(struct photo *p, const struct photo_bytes *file, enum photo_want want,
                                    struct err *err)
{
    const size_t row = (size_t)p->info.width * 3;
    struct jpeg_reader *r = calloc(1, sizeof *r);
    if (!r || !(r->row = malloc(row))) err_nomem(err, "a JPEG decoder", sizeof *r + row);
    if (!err->status && want == PHOTO_SAMPLES) photo_init_samples(p, err);
    if (!err->status && want == PHOTO_BYTES && !(p->bytes = malloc(row * (size_t)p->info.height)))
        err_nomem(err, "a photo", row * (size_t)p->info.height);
    if (!err->status) {
        r->d.err = jpeg_std_error(&r->errors);
        r->errors.error_exit = give_up;
        r->errors.emit_message = take_message;
        r->progress.progress_monitor = count_scans;
        if (setjmp(r->failed)) {
            jpeg_damaged(file, r->reason, err);
        } else {
            r->d.client_data = r;
            jpeg_create_decompress(&r->d);
            r->d.progress = &r->progress;
            decode_rows(p, file, want, r);
        }
        jpeg_destroy_decompress(&r->d);
    }
    if (r) free(r->row);
    free(r);
    return err->status;
}

/* The mean of q^2 / 12 over the first quantization table, that of luma; 0: none is found before the pixels. */
static double jpeg_variance(const struct photo_bytes *file)
{
    const unsigned char *b = file->bytes;
    for (size_t at = 2; at + 4 <= file->size && b[at] == 0xff && b[at + 1] != 0xda;) {
        const size_t length = (size_t)b[at + 2] << 8 | b[at + 3], end = at + 2 + length;
        const bool wide = b[at + 1] == 0xdb && length > 2 && at + 4 < file->size && b[at + 4] >> 4;
        if (length < 2 || end > file->size) return 0;
        if (b[at + 1] == 0xdb && length >= (wide ? 131 : 67) && (b[at + 4] & 15) == 0) {
            double sum = 0;
            for (size_t k = 0; k < 64; k++) {
                const unsigned char *q = b + at + 5 + (wide ? 2 * k : k);
                const double step = wide ? q[0] << 8 | q[1] : q[0];
                sum += step * step / 12;
            }
            return sum / 64;
        }
        at = end;
    }
    return 0;
}

/* The parts of the ICC profile, in order of their numbers; NULL: none, or parts are missing. The caller frees it. */
static unsigned char *jpeg_profile(size_t *size, const struct photo_bytes *file)
{
    enum { MARK = 14 /* the name, a NUL, the part's number, their count */, MAX_PARTS = 256 };
    const unsigned char *b = file->bytes, *parts[MAX_PARTS] = {NULL};
    size_t lengths[MAX_PARTS] = {0}, count = 0;
    *size = 0;
    for (size_t at = 2; at + 4 <= file->size && b[at] == 0xff && b[at + 1] != 0xda;) {
        if (b[at + 1] == 0xff) { /* fill byte */
            at++;
            continue;
        }
        const size_t length = (size_t)b[at + 2] << 8 | b[at + 3];
        if (length < 2 || at + 2 + length > file->size) break;
        if (b[at + 1] == 0xe2 && length > 2 + MARK && !memcmp(b + at + 4, "ICC_PROFILE", 12)) {
            const unsigned char part = b[at + 4 + 12];
            count = b[at + 4 + 13];
            parts[part] = b + at + 4 + MARK;
            lengths[part] = length - 2 - MARK;
        }
        at += 2 + length;
    }
    for (size_t i = 1; i <= count; i++) *size = parts[i] && (*size || i == 1) ? *size + lengths[i] : 0;
    unsigned char *icc = *size ? malloc(*size) : NULL, *to = icc;
    for (size_t i = 1; icc && i <= count; i++) {
        memcpy(to, parts[i], lengths[i]);
        to += lengths[i];
    }
    if (!icc) *size = 0;
    return icc;
}

/* The profile is one of tables, by which samples of 8 bits become those of 16. */
static enum status widen_bytes(struct photo *p, const unsigned char *icc, size_t size, const char *path,
                               struct err *err)
{
    const size_t samples = (size_t)p->info.width * (size_t)p->info.height * 3;
    if (photo_init_samples(p, err)) return err->status;
    for (size_t i = 0; i < samples; i++) p->samples[i] = p->bytes[i];
    free(p->bytes);
    p->bytes = NULL;
    p->info.bits = 8;
    colour_space_release(p->space);
    p->space = NULL;
    return photo_set_icc(p, icc, size, true, path, err);
}

enum status photo_read_jpeg(struct photo *p, const struct photo_bytes *file, enum photo_want want, struct err *err)
{
    tjhandle handle = tjInitDecompress();
    if (!handle) return err_nomem(err, "a JPEG decoder", 0);
    read_jpeg_header(&p->info, file, handle, err);
    if (!err->status && want != PHOTO_HEADER) read_jpeg_pixels(p, file, want, err);
    p->jpeg_variance = jpeg_variance(file);
    if (!err->status) photo_exif_read(&p->info, file, false, err);
    size_t size = 0;
    unsigned char *icc = err->status ? NULL : jpeg_profile(&size, file);
    if (!err->status) photo_set_icc(p, icc, size, want == PHOTO_SAMPLES, file->path, err);
    if (!err->status && p->bytes && p->info.bits == 16) widen_bytes(p, icc, size, file->path, err);
    free(icc);
    tjDestroy(handle);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- writing */

enum status photo_decode_jpeg(struct photo *p, const unsigned char *bytes, size_t size, const char *name,
                              struct err *err)
{
    const struct photo_bytes file = {name, (unsigned char *)bytes, size};
    *p = (struct photo){.saturation = 0};
    if (photo_read_jpeg(p, &file, PHOTO_BYTES, err)) photo_release(p);
    return err->status;
}

enum status jpeg_encode(unsigned char **bytes, size_t *size, const unsigned char *rgb, int width, int height,
                        int quality, struct err *err)
{
    unsigned char *made = NULL; /* allocated by libjpeg-turbo */
    unsigned long length = 0;
    tjhandle handle = tjInitCompress();
    if (!handle) err_nomem(err, "a JPEG encoder", 0);

    *bytes = NULL;
    *size = 0;
    if (!err->status && tjCompress2(handle, rgb, width, 0, height, TJPF_RGB, &made, &length, TJSAMP_420, quality, 0))
        err_set(err, ST_INTERNAL, "cannot encode a JPEG of %d x %d pixels at quality %d: %s.", width, height, quality,
                tjGetErrorStr2(handle));
    if (!err->status && !(*bytes = malloc(length))) err_nomem(err, "a JPEG", length);
    if (!err->status) {
        memcpy(*bytes, made, length);
        *size = length;
    }
    tjFree(made);
    if (handle) tjDestroy(handle);
    return err->status;
}

enum status jpeg_write(const char *path, const unsigned char *rgb, int width, int height, int quality, struct err *err)
{
    struct outfile f = {0};
    unsigned char *bytes = NULL;
    size_t size = 0;
    if (!jpeg_encode(&bytes, &size, rgb, width, height, quality, err)) outfile_open(&f, path, err);
    if (!err->status && fwrite(bytes, 1, size, f.fp) != size) err_errno(err, "write", path);
    if (!err->status) outfile_commit(&f, err);
    outfile_discard(&f);
    free(bytes);
    return err->status;
}

enum status photo_write_jpeg(const char *path, const unsigned char *rgb, int width, int height, int quality,
                             const struct photo_info *info, struct err *err)
{
    struct outfile f = {0};
    unsigned char *bytes = NULL, *exif = NULL;
    size_t size = 0;
    unsigned exif_size = 0;
    if (!jpeg_encode(&bytes, &size, rgb, width, height, quality, err) &&
        !photo_exif_block(&exif, &exif_size, info, err))
        outfile_open(&f, path, err);
    if (!err->status) { /* the APP1 segment follows the start marker */
        const unsigned char segment[4] = {0xff, 0xe1, (unsigned char)((exif_size + 2) >> 8),
                                          (unsigned char)(exif_size + 2)};
        if (fwrite(bytes, 1, 2, f.fp) != 2 || fwrite(segment, 1, 4, f.fp) != 4 ||
            fwrite(exif, 1, exif_size, f.fp) != exif_size || fwrite(bytes + 2, 1, size - 2, f.fp) != size - 2)
            err_errno(err, "write", path);
    }
    if (!err->status) outfile_commit(&f, err);
    outfile_discard(&f);
    free(exif);
    free(bytes);
    return err->status;
}
