/* photo_png.c - PNG files, by libpng. */
#include <math.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <png.h>

#include "common/base/outfile.h"
#include "common/image/photo.h"
#include "common/image/photo_formats.h"

#define PNG_LEVEL 6 /* zlib's compression level; determines the bytes */

/* ---------------------------------------------------------------------------------------------------------- reading */

/* State that must survive a longjmp() from libpng is in memory, behind a pointer, not in registers. */
struct png_reader {
    const struct photo_bytes *file;
    size_t at;
    png_structp png;
    png_infop info;
    png_bytepp rows;   /* owned */
    png_uint_16p rgba; /* of a picture with alpha; owned */
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
    if (strcasestr(r->message, "memory")) return err_nomem(err, "a PNG decoder", 0); /* the photo may be whole */
    return err_set(err, ST_DATA, "%s is a damaged or cut-off PNG (%s); copy or export the photo again.", r->file->path,
                   r->message);
}

static enum status read_png_header(struct png_reader *r, struct err *err)
{
    if (setjmp(png_jmpbuf(r->png))) return png_damaged(r, err);
    png_set_read_fn(r->png, r, png_take_bytes);
    png_set_user_limits(r->png, 1 << 28, 1 << 28); /* photo_check_size() checks the area */
    png_read_info(r->png, r->info);
    png_uint_32 width = png_get_image_width(r->png, r->info), height = png_get_image_height(r->png, r->info);
    if (photo_check_size(r->file->path, width, height, err)) return err->status;
    r->photo->info.width = (int)width;
    r->photo->info.height = (int)height;
    r->photo->info.bits = png_get_bit_depth(r->png, r->info) == 16 ? 16 : 8;
    return ST_OK;
}

/* Every PNG becomes 16-bit RGB: palettes, grey and fewer bits are expanded (8 bits as v * 257), alpha is counted. */
static enum status read_png_pixels(struct png_reader *r, struct err *err)
{
    struct photo *p = r->photo;
    const bool alpha =
        png_get_color_type(r->png, r->info) & PNG_COLOR_MASK_ALPHA || png_get_valid(r->png, r->info, PNG_INFO_tRNS);
    const size_t channels = alpha ? 4 : 3, row = (size_t)p->info.width * channels, height = (size_t)p->info.height;
    const size_t pixels = (size_t)p->info.width * height;
    if (photo_init_samples(p, err)) return err->status;
    if (alpha && !(r->rgba = malloc(row * height * sizeof *r->rgba)))
        return err_nomem(err, "a photo", row * height * sizeof *r->rgba);
    r->rows = malloc(height * sizeof *r->rows);
    if (!r->rows) return err_nomem(err, "a photo's rows", height * sizeof *r->rows);
    for (size_t y = 0; y < height; y++) r->rows[y] = (png_bytep)((alpha ? r->rgba : p->samples) + y * row);

    if (setjmp(png_jmpbuf(r->png))) return png_damaged(r, err);
    png_set_expand_16(r->png);
    png_set_gray_to_rgb(r->png);
    png_set_swap(r->png); /* libpng's samples are big-endian */
    png_set_interlace_handling(r->png);
    png_read_update_info(r->png, r->info);
    if (png_get_rowbytes(r->png, r->info) != row * sizeof *p->samples) png_error(r->png, "unknown row format");
    png_read_image(r->png, r->rows);
    png_read_end(r->png, NULL);
    size_t hidden = 0;
    for (size_t i = 0; alpha && i < pixels; i++) {
        memcpy(p->samples + 3 * i, r->rgba + 4 * i, 3 * sizeof *r->rgba);
        hidden += r->rgba[4 * i + 3] < 32768;
    }
    p->transparent = (double)hidden / (double)pixels;
    if (p->info.bits == 8)
        for (size_t i = 0; i < 3 * pixels; i++) p->samples[i] >>= 8;
    return ST_OK;
}

/* The chunk cICP: codes of primaries and transfer. libpng before 1.6.45 does not know it. */
static bool get_codes(const struct png_reader *r, png_byte codes[2])
{
#ifdef PNG_cICP_SUPPORTED
    png_byte matrix = 0, full = 0;
    return png_get_cICP(r->png, r->info, &codes[0], &codes[1], &matrix, &full) != 0;
#else
    png_unknown_chunkp chunks = NULL;
    const int count = png_get_unknown_chunks(r->png, r->info, &chunks);
    for (int i = 0; i < count; i++)
        if (!memcmp(chunks[i].name, "cICP", 4) && chunks[i].size == 4) {
            codes[0] = chunks[i].data[0];
            codes[1] = chunks[i].data[1];
            return true;
        }
    return false;
#endif
}

/* What the chunks say of colours. As the standard demands, codes count first, then a profile, the word sRGB, and gamma
 * and primaries. A gamma near 1/2.2 is the curve of sRGB, as programs mean it. */
static enum status read_png_colours(struct png_reader *r, bool pixels, struct err *err)
{
    static const struct chromaticities rec709 = {{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}}};
    struct chromaticities c = rec709;
    png_charp name = NULL;
    png_bytep icc = NULL;
    png_uint_32 size = 0;
    int method = 0, intent = 0;
    double gamma = 1 / 2.2;
    const char *path = r->file->path;
    png_byte codes[2];
    if (get_codes(r, codes)) return photo_set_codes(r->photo, codes[0], codes[1], path, err);
    if (png_get_iCCP(r->png, r->info, &name, &method, &icc, &size))
        return photo_set_icc(r->photo, icc, size, pixels, path, err);
    if (png_get_sRGB(r->png, r->info, &intent)) return ST_OK;
    const bool has_gamma = png_get_gAMA(r->png, r->info, &gamma) != 0;
    const bool has_primaries = png_get_cHRM(r->png, r->info, &c.xy[3][0], &c.xy[3][1], &c.xy[0][0], &c.xy[0][1],
                                            &c.xy[1][0], &c.xy[1][1], &c.xy[2][0], &c.xy[2][1]) != 0;
    if (!has_gamma && !has_primaries) return photo_set_icc(r->photo, NULL, 0, pixels, path, err);
    if (!(gamma > 0.01 && gamma < 100))
        return err_set(err, ST_DATA, "%s: its chunk gAMA says %g, wanted 0.01 to 100; save the photo as sRGB.", path,
                       gamma);
    char text[32];
    const bool usual = fabs(gamma * 2.2 - 1) < 0.02;
    snprintf(text, sizeof text, "gAMA %.5g%s", gamma, has_primaries ? " and cHRM" : "");
    return photo_set_primaries(r->photo, &c, usual ? 0 : 1 / gamma, has_gamma ? text : "cHRM", path, err);
}

enum status photo_read_png(struct photo *p, const struct photo_bytes *file, bool pixels, struct err *err)
{
    struct png_reader r = {.file = file, .photo = p};
    r.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &r, png_keep_message, png_ignore_warning);
    if (r.png) r.info = png_create_info_struct(r.png);
    if (!r.info) err_nomem(err, "a PNG decoder", 0);
#ifndef PNG_cICP_SUPPORTED
    if (r.info) png_set_keep_unknown_chunks(r.png, PNG_HANDLE_CHUNK_ALWAYS, (png_const_bytep) "cICP", 1);
#endif
    if (!err->status) read_png_header(&r, err);
    if (!err->status && pixels) read_png_pixels(&r, err);
    if (!err->status && !photo_exif_read(&p->info, file, true, err)) read_png_colours(&r, pixels, err);
    png_destroy_read_struct(&r.png, &r.info, NULL);
    free(r.rows);
    free(r.rgba);
    return err->status;
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
    const unsigned char *pixels; /* interleaved; 16-bit samples in native byte order */
    int width, height, channels, bits;
    const unsigned char *exif; /* NULL: none */
    unsigned exif_size;
    const struct colour_space *space; /* NULL: sRGB */
};

static void put_space(struct png_writer *w, const struct colour_space *space)
{
    const png_byte primaries = (png_byte)space->primaries, transfer = (png_byte)space->transfer;
    if (space->icc) {
        png_set_iCCP(w->png, w->info, "profile", PNG_COMPRESSION_TYPE_BASE, space->icc, (png_uint_32)space->icc_size);
        return;
    }
#ifdef PNG_cICP_SUPPORTED
    png_set_cICP(w->png, w->info, primaries, transfer, 0, 1);
#else
    png_byte codes[4] = {primaries, transfer, 0, 1}; /* RGB, full range */
    png_unknown_chunk chunk = {.name = "cICP", .data = codes, .size = sizeof codes, .location = PNG_HAVE_IHDR};
    png_set_keep_unknown_chunks(w->png, PNG_HANDLE_CHUNK_ALWAYS, chunk.name, 1);
    png_set_unknown_chunks(w->png, w->info, &chunk, 1);
#endif
}

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
    if (p->space) put_space(w, p->space);
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
        return err_set(err, ST_INTERNAL,
                       "cannot write %s as PNG: %d x %d pixels of %d channels, wanted a positive size and 1 or 3 "
                       "channels.",
                       path, p->width, p->height, p->channels);
    w.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &w, png_keep_write_message, png_ignore_warning);
    if (w.png) w.info = png_create_info_struct(w.png);
    if (!w.info) err_nomem(err, "a PNG encoder", 0);
    if (!err->status && !outfile_open(&f, path, err) && !write_png_rows(&w, f.fp, path, p, err))
        outfile_commit(&f, err);
    outfile_discard(&f);
    png_destroy_write_struct(&w.png, &w.info);
    return err->status;
}

enum status png_write(const char *path, const unsigned char *pixels, int width, int height, int channels,
                      struct err *err)
{
    return write_png(path, &(struct png_picture){pixels, width, height, channels, 8, NULL, 0, NULL}, err);
}

enum status photo_write_part(const char *path, const struct photo *p, int x, int y, int width, int height,
                             const struct photo_info *info, struct err *err)
{
    const size_t row = (size_t)width * 3, size = p->info.bits == 16 ? 2 : 1;
    unsigned char *pixels = malloc(row * (size_t)height * size), *exif = NULL;
    unsigned exif_size = 0;
    if (!pixels) err_nomem(err, "a picture", row * (size_t)height * size);
    for (int k = 0; !err->status && k < height; k++) {
        const uint16_t *from = p->samples + ((size_t)(y + k) * (size_t)p->info.width + (size_t)x) * 3;
        unsigned char *to = pixels + (size_t)k * row * size;
        if (size == 2) memcpy(to, from, row * size);
        for (size_t i = 0; size == 1 && i < row; i++) to[i] = (unsigned char)from[i];
    }
    if (!err->status) photo_exif_block(&exif, &exif_size, info, err);
    if (!err->status) {
        const unsigned mark = PHOTO_EXIF_MARK; /* PNG stores the block without it */
        write_png(
            path,
            &(struct png_picture){pixels, width, height, 3, p->info.bits, exif + mark, exif_size - mark, p->space},
            err);
    }
    free(exif);
    free(pixels);
    return err->status;
}
