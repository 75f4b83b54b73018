/* portrait_depth.c - the depth image of a HEIC or AVIF, by libheif.
 *
 * It is an auxiliary picture, often smaller than the photo, whose samples s from 0 to 1 stand for disparity, larger
 * where the scene is nearer: low + (high - low) s. Phones of Apple state low and high, and whether that is disparity or
 * depth, in XMP data of the picture ("pixel data info"); other files may do so in a message of their stream. Without
 * either, low is a level above 0, since the farthest surface is somewhere. Their unit does not matter: the scale of a
 * single photo is free. */
#include "stages/import_photos/portrait_depth.h"

#include <dirent.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <expat.h>
#include <libheif/heif.h>

#include "common/base/file_path.h"
#include "common/base/log.h"
#include "common/base/outfile.h"
#include "common/base/scan.h"

enum { MAX_TEXT = 64, MAX_XMP = 1 << 20, MAX_SIDE = 1 << 14 };

struct meaning {      /* of samples from 0 to 1 */
    double low, high; /* NaN: not stated */
    bool depth;       /* else disparity */
};

/* ------------------------------------------------------------------------------------------------------------- XMP */

struct xmp_reader {
    struct meaning *to;
    char text[MAX_TEXT];
    size_t length;
};

static void take_property(struct xmp_reader *r, const char *name, const char *text)
{
    static const char space[] = "http://ns.apple.com/pixeldatainfo/1.0/ ";
    double value = NAN;
    if (strncmp(name, space, sizeof space - 1) != 0) return;
    name += sizeof space - 1;
    const bool number = scan_double(text, &value) && fabs(value) < 1e12;
    if (number && !strcmp(name, "FloatMinValue")) r->to->low = value;
    if (number && !strcmp(name, "FloatMaxValue")) r->to->high = value;
    if (!strcmp(name, "AuxiliaryImageType")) r->to->depth = !strcmp(text, "depth");
}

static void XMLCALL open_element(void *ctx, const char *name, const char **attributes)
{
    struct xmp_reader *r = ctx;
    (void)name;
    r->length = 0;
    for (; *attributes; attributes += 2) take_property(r, attributes[0], attributes[1]);
}

static void XMLCALL add_text(void *ctx, const char *text, int length)
{
    struct xmp_reader *r = ctx;
    for (int i = 0; i < length && r->length + 1 < MAX_TEXT; i++)
        if (!strchr(" \t\r\n", text[i])) r->text[r->length++] = text[i];
}

static void XMLCALL close_element(void *ctx, const char *name)
{
    struct xmp_reader *r = ctx;
    r->text[r->length] = 0;
    if (r->length) take_property(r, name, r->text);
    r->length = 0;
}

/* Damaged data say nothing. */
static enum status read_xmp(struct meaning *to, const struct heif_image_handle *depth, struct err *err)
{
    heif_item_id id;
    if (heif_image_handle_get_list_of_metadata_block_IDs(depth, "mime", &id, 1) != 1) return ST_OK;
    const size_t size = heif_image_handle_get_metadata_size(depth, id);
    if (!size || size > MAX_XMP) return ST_OK;
    char *xmp = malloc(size);
    XML_Parser parser = XML_ParserCreateNS(NULL, ' ');
    struct meaning found = {NAN, NAN, false};
    struct xmp_reader r = {.to = &found};
    if (!xmp || !parser) {
        err_nomem(err, "XMP data", size);
    } else if (heif_image_handle_get_metadata(depth, id, xmp).code == heif_error_Ok) {
        XML_SetUserData(parser, &r);
        XML_SetElementHandler(parser, open_element, close_element);
        XML_SetCharacterDataHandler(parser, add_text);
        if (XML_Parse(parser, xmp, (int)size, 1) == XML_STATUS_OK) *to = found;
    }
    if (parser) XML_ParserFree(parser);
    free(xmp);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- samples */

static void read_message(struct meaning *to, const struct heif_image_handle *photo, heif_item_id id)
{
    const struct heif_depth_representation_info *info = NULL;
    if (!heif_image_handle_get_depth_image_representation_info(photo, id, &info) || !info) return;
    to->depth = info->depth_representation_type == heif_depth_representation_type_uniform_Z;
    if (to->depth && info->has_z_near && info->has_z_far) { /* the greatest sample is the nearest */
        to->low = info->z_far;
        to->high = info->z_near;
    } else if (info->has_z_near && info->has_z_far && info->z_near > 0 && info->z_far > 0) {
        to->low = 1 / info->z_far;
        to->high = 1 / info->z_near;
    }
    heif_depth_representation_info_free(info);
}

/* Rows of a PFM run from the bottom, and its bytes least first. */
static enum status write_map(const struct heif_image *image, const struct meaning *m, const char *path, struct err *err)
{
    int stride = 0;
    const unsigned char *rows = heif_image_get_plane_readonly(image, heif_channel_Y, &stride);
    const int width = heif_image_get_width(image, heif_channel_Y),
              height = heif_image_get_height(image, heif_channel_Y),
              bits = heif_image_get_bits_per_pixel_range(image, heif_channel_Y);
    if (!rows || width < 1 || height < 1 || width > MAX_SIDE || height > MAX_SIDE || bits < 8 || bits > 16)
        return err_set(err, ST_DATA, "its depth has %d x %d samples of %d bits", width, height, bits);
    const double most = (1 << bits) - 1;
    const bool stated = isfinite(m->low) && isfinite(m->high) && m->low != m->high;
    const double low = stated ? m->low : 1 / most, high = stated ? m->high : 1 + 1 / most;
    char head[64];
    const size_t begin = (size_t)snprintf(head, sizeof head, "Pf\n%d %d\n-1.0\n", width, height);
    const size_t size = begin + 4 * (size_t)width * (size_t)height;
    unsigned char *bytes = malloc(size);
    if (!bytes) return err_nomem(err, "a depth map", size);
    memcpy(bytes, head, begin);
    unsigned char *to = bytes + begin;
    for (int y = height - 1; y >= 0; y--)
        for (int x = 0; x < width; x++, to += 4) {
            const unsigned char *row = rows + (size_t)y * (size_t)stride;
            const int sample = bits == 8 ? row[x] : row[2 * x] | row[2 * x + 1] << 8;
            const double value = low + (high - low) * sample / most;
            const float kept = value > 0 ? (float)value : 0; /* behind infinity: unknown */
            uint32_t word;
            memcpy(&word, &kept, sizeof word);
            for (int i = 0; i < 4; i++) to[i] = (unsigned char)(word >> (8 * i));
        }
    outfile_write_if_changed(path, (const char *)bytes, size, err);
    free(bytes);
    return err->status;
}

static enum status write_depth(const struct heif_image_handle *photo, heif_item_id id, const char *name,
                               const char *out, struct err *err)
{
    struct meaning m = {NAN, NAN, false};
    struct heif_image_handle *handle = NULL;
    struct heif_image *image = NULL;
    char path[FILE_PATH], units[FILE_PATH];
    struct heif_error problem = heif_image_handle_get_depth_image_handle(photo, id, &handle);
    if (problem.code == heif_error_Ok)
        problem = heif_decode_image(handle, &image, heif_colorspace_monochrome, heif_chroma_monochrome, NULL);
    if (problem.code != heif_error_Ok) err_set(err, ST_DATA, "its depth is damaged (%s)", problem.message);
    read_message(&m, photo, id);
    if (!err->status && !read_xmp(&m, handle, err) && !outfile_make_folders(out, err) &&
        !file_path(path, out, name, ".pfm", err) && !file_path(units, out, "depth", ".txt", err) &&
        !write_map(image, &m, path, err)) {
        const char *text = m.depth ? "samples depth\n" : "samples disparity\n";
        outfile_write_if_changed(units, text, strlen(text), err);
    }
    if (image) heif_image_release(image);
    if (handle) heif_image_handle_release(handle);
    return err->status;
}

enum status portrait_depth_take(bool *taken, const char *photo, const char *id, const char *out, struct err *err)
{
    struct heif_context *context = heif_context_alloc();
    struct heif_image_handle *handle = NULL;
    heif_item_id item;
    *taken = false;
    if (!context) return err_nomem(err, "a HEIF decoder", 0);
    /* a photo that cannot be read was refused before */
    if (heif_context_read_from_file(context, photo, NULL).code == heif_error_Ok &&
        heif_context_get_primary_image_handle(context, &handle).code == heif_error_Ok &&
        heif_image_handle_get_list_of_depth_image_IDs(handle, &item, 1) == 1) {
        if (write_depth(handle, item, id, out, err) == ST_DATA)
            err_context(err, "%s: copy or export the photo again, or give its depth (DEPTH)", photo);
        *taken = !err->status;
    }
    if (handle) heif_image_handle_release(handle);
    heif_context_free(context);
    return err->status;
}

enum status portrait_depth_remove(const char *id, const char *out, struct err *err)
{
    char path[FILE_PATH];
    DIR *dir = opendir(out);
    if (!dir) return ST_OK;
    for (struct dirent *e; !err->status && (e = readdir(dir));) {
        const size_t length = strlen(e->d_name), stem = length > 4 ? length - 4 : 0;
        const bool map = stem && !strcmp(e->d_name + stem, ".pfm");
        const bool kept = id && (map ? strlen(id) == stem && !strncmp(e->d_name, id, stem) : true);
        if (kept || (!map && strcmp(e->d_name, "depth.txt") != 0)) continue;
        if (!file_path(path, out, e->d_name, "", err) && unlink(path)) err_errno(err, "remove", path);
    }
    closedir(dir);
    if (!err->status && !id) rmdir(out); /* which stays if it has other files */
    return err->status;
}
