/* photo_heif.c - HEIC and AVIF files of 8 to 16 bits, by libheif.
 *
 * The primary image is read. The file's own turns, mirrors and crops are applied, as its standard requires and every
 * viewer does, so the picture stands upright: the EXIF orientation, which repeats the turn, is 1. More than 8 bits
 * become 16. Alpha is dropped. */
#include "common/image/photo_formats.h"

#include <stdlib.h>

#include <libheif/heif.h>

static enum status heif_failed(const struct photo_bytes *file, struct heif_error problem, struct err *err)
{
    if (problem.code == heif_error_Memory_allocation_error)
        return err_set(
            err, ST_NOMEM,
            "%s asks for more memory than there is (%s); unless it is huge it is damaged: copy or export the "
            "photo again.",
            file->path, problem.message);
    if (problem.code == heif_error_Unsupported_feature || problem.code == heif_error_Unsupported_filetype)
        return err_set(err, ST_DATA,
                       "%s is a HEIC or AVIF file that libheif here cannot decode (%s); install its decoders "
                       "(libheif-plugin-libde265, libheif-plugin-dav1d), or convert it: heif-convert -q 95 IN OUT.jpg",
                       file->path, problem.message);
    return err_set(err, ST_DATA, "%s is a damaged or cut-off HEIC or AVIF file (%s); copy or export the photo again.",
                   file->path, problem.message);
}

static enum status read_heif_exif(struct photo_info *info, const struct heif_image_handle *handle, struct err *err)
{
    heif_item_id id;
    info->orientation = 1;
    if (heif_image_handle_get_list_of_metadata_block_IDs(handle, "Exif", &id, 1) != 1) return ST_OK;
    const size_t size = heif_image_handle_get_metadata_size(handle, id);
    if (size < 4 || size > PHOTO_MAX_EXIF) return ST_OK;
    unsigned char *block = malloc(size);
    if (!block) return err_nomem(err, "EXIF data", size);
    if (heif_image_handle_get_metadata(handle, id, block).code == heif_error_Ok) { /* an offset is before it */
        const size_t from = 4 + ((size_t)block[0] << 24 | (size_t)block[1] << 16 | (size_t)block[2] << 8 | block[3]);
        if (from < size) photo_exif_take(info, block + from, size - from, err);
    }
    free(block);
    info->orientation = 1;
    return err->status;
}

static enum status read_heif_pixels(struct photo *p, const struct photo_bytes *file,
                                    const struct heif_image_handle *handle, int bits, struct err *err)
{
    struct heif_image *image = NULL;
    const struct heif_error problem =
        heif_decode_image(handle, &image, heif_colorspace_RGB,
                          bits == 8 ? heif_chroma_interleaved_RGB : heif_chroma_interleaved_RRGGBB_LE, NULL);
    if (problem.code != heif_error_Ok) return heif_failed(file, problem, err);
    int stride = 0;
    const unsigned char *rows = heif_image_get_plane_readonly(image, heif_channel_interleaved, &stride);
    const int width = heif_image_get_width(image, heif_channel_interleaved),
              height = heif_image_get_height(image, heif_channel_interleaved);
    if (!rows || width != p->info.width || height != p->info.height)
        err_set(err, ST_DATA, "%s: its image has %d x %d pixels, its header says %d x %d; copy or export it again.",
                file->path, width, height, p->info.width, p->info.height);
    else
        photo_init_samples(p, err);
    const uint64_t most = (UINT64_C(1) << bits) - 1;
    const size_t row = (size_t)p->info.width * 3;
    for (size_t y = 0; !err->status && y < (size_t)height; y++) {
        const unsigned char *from = rows + y * (size_t)stride;
        uint16_t *to = p->samples + y * row;
        for (size_t i = 0; i < row; i++) {
            const uint64_t v = bits == 8 ? from[i] : from[2 * i] | (uint64_t)from[2 * i + 1] << 8;
            to[i] = (uint16_t)(bits == 8 ? v : (v * 65535 + most / 2) / most);
        }
    }
    heif_image_release(image);
    return err->status;
}

/* An ICC profile, or codes. */
static enum status read_heif_colours(struct photo *p, const struct heif_image_handle *handle, bool pixels,
                                     const char *path, struct err *err)
{
    const size_t size = heif_image_handle_get_raw_color_profile_size(handle);
    struct heif_color_profile_nclx *nclx = NULL;
    if (size > 0) {
        unsigned char *icc = malloc(size);
        if (!icc) return err_nomem(err, "a colour profile", size);
        const struct heif_error problem = heif_image_handle_get_raw_color_profile(handle, icc);
        photo_set_icc(p, icc, problem.code == heif_error_Ok ? size : 0, pixels, path, err);
        free(icc);
        return err->status;
    }
    if (heif_image_handle_get_color_profile_type(handle) != heif_color_profile_type_nclx)
        return photo_set_icc(p, NULL, 0, pixels, path, err);
    const bool known = heif_image_handle_get_nclx_color_profile(handle, &nclx).code == heif_error_Ok && nclx;
    if (known)
        photo_set_codes(p, (int)nclx->color_primaries, (int)nclx->transfer_characteristics, path, err);
    else
        err_set(err, ST_DATA, "%s: its colour codes are none that libheif knows; save the photo as sRGB.", path);
    if (nclx) heif_nclx_color_profile_free(nclx); /* libheif gives one after a failure, too */
    return err->status;
}

enum status photo_read_heif(struct photo *p, const struct photo_bytes *file, bool pixels, struct err *err)
{
    struct heif_context *context = heif_context_alloc();
    struct heif_image_handle *handle = NULL;
    if (!context) return err_nomem(err, "a HEIF decoder", 0);
    struct heif_error problem = heif_context_read_from_memory_without_copy(context, file->bytes, file->size, NULL);
    if (problem.code == heif_error_Ok) problem = heif_context_get_primary_image_handle(context, &handle);
    if (problem.code != heif_error_Ok) heif_failed(file, problem, err);
    if (!err->status) {
        const int bits = heif_image_handle_get_luma_bits_per_pixel(handle);
        const int width = heif_image_handle_get_width(handle), height = heif_image_handle_get_height(handle);
        p->info.width = width;
        p->info.height = height;
        p->info.bits = bits > 8 ? 16 : 8;
        if (bits < 8 || bits > 16)
            err_set(err, ST_DATA, "%s has samples of %d bits, wanted 8 to 16; export it as JPEG or TIFF.", file->path,
                    bits);
        else if (!photo_check_size(file->path, width > 0 ? (uint64_t)width : 0, height > 0 ? (uint64_t)height : 0,
                                   err) &&
                 !read_heif_exif(&p->info, handle, err) && (!pixels || !read_heif_pixels(p, file, handle, bits, err)))
            read_heif_colours(p, handle, pixels, file->path, err);
    }
    if (handle) heif_image_handle_release(handle);
    heif_context_free(context);
    return err->status;
}
