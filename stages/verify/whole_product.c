/* whole_product.c - whether a product is whole.
 *
 * A job on a cluster may be killed while it writes, and a disk may be full. Products appear whole or not at all
 * (outfile.h), so this is a second look: it reads a file to its end, in the way of its format.
 *   - EXR: all channels are decoded; points, atlases, maps and lists: their own readers, which check each record
 *   - PNG, JPEG: the signature, then all pixels are decoded
 *   - MP4: the boxes of ISO/IEC 14496-12 are followed from the first to the last: each must fit into the file, ftyp
 *     comes first, moov and mdat are there. A video that was cut off fails this without a decoder
 *   - SVG, HTML, JSON: the text ends as it must; other text: it ends with a line break and has no NUL byte
 * An atlas is read with the sizes of all its pages.
 *
 * The table of products says the format; of a file that is no product, the name does. Memory: one product. */
#include "stages/verify/whole_product.h"

#include <ctype.h>
#include <inttypes.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "common/capture/point_cloud.h"
#include "common/image/exr.h"
#include "common/image/photo.h"
#include "common/light/object_list.h"
#include "common/product/product.h"
#include "common/texture/atlas.h"
#include "common/texture/texture_map.h"

static enum status verify_exr(const char *path, struct err *err)
{
    struct exr_image im = {0};
    exr_read(&im, path, NULL, 0, err);
    exr_image_release(&im);
    return err->status;
}

static enum status verify_points(const char *path, struct err *err)
{
    struct point_cloud cloud = {0};
    point_cloud_read(&cloud, path, NULL, err);
    point_cloud_release(&cloud);
    return err->status;
}

/* Decodes a picture whose first bytes are `signature`. */
static enum status verify_picture(const char *path, const char *signature, const char *format, struct err *err)
{
    struct photo photo = {0};
    char head[8] = {0};
    FILE *f = fopen(path, "rb");
    if (!f) return err_errno(err, "open", path);
    const size_t size = fread(head, 1, strlen(signature), f);
    const bool failed = ferror(f);
    fclose(f);
    if (failed) return err_errno(err, "read", path);
    if (size && memcmp(head, signature, strlen(signature)) != 0)
        return err_set(err, ST_DATA, "%s: found no %s signature, wanted %s by its extension; make it again.", path,
                       format, format);
    photo_read(&photo, path, err);
    photo_release(&photo);
    return err->status;
}

static enum status verify_png(const char *path, struct err *err) { return verify_picture(path, "\x89PNG", "PNG", err); }
static enum status verify_jpeg(const char *path, struct err *err)
{
    return verify_picture(path, "\xff\xd8\xff", "JPEG", err);
}

static uint64_t big_endian(const unsigned char *bytes, int count)
{
    uint64_t value = 0;
    for (int i = 0; i < count; i++) value = value << 8 | bytes[i];
    return value;
}

/* ISO/IEC 14496-12: a box is a 32-bit size and a type of four letters; size 1: a 64-bit size follows; size 0: the box
 * reaches to the end of the file. Sizes include the head. */
static enum status verify_boxes(FILE *f, uint64_t size, const char *path, struct err *err)
{
    bool has_moov = false, has_mdat = false;
    for (uint64_t at = 0; at < size;) {
        unsigned char head[16] = {0};
        if (fseeko(f, (off_t)at, SEEK_SET)) return err_errno(err, "read", path);
        const size_t got = fread(head, 1, sizeof head, f);
        if (ferror(f)) return err_errno(err, "read", path);
        uint64_t box = big_endian(head, 4), head_size = 8;
        if (box == 1) box = big_endian(head + 8, 8), head_size = 16;
        if (box == 0) box = size - at;
        if (got < head_size || box < head_size || box > size - at)
            return err_set(err, ST_DATA,
                           "%s: the box at byte %" PRIu64 " does not fit into the file of %" PRIu64
                           " bytes; the video is cut off, make it again.",
                           path, at, size);
        if (at == 0 && memcmp(head + 4, "ftyp", 4) != 0)
            return err_set(err, ST_DATA, "%s: found another first box, wanted ftyp; it is not an MP4, make it again.",
                           path);
        has_moov |= !memcmp(head + 4, "moov", 4);
        has_mdat |= !memcmp(head + 4, "mdat", 4);
        at += box;
    }
    if (!has_moov || !has_mdat)
        return err_set(err, ST_DATA, "%s: found no %s box, wanted one; the video is cut off, make it again.", path,
                       has_moov ? "mdat" : "moov");
    return ST_OK;
}

static enum status verify_mp4(const char *path, struct err *err)
{
    struct stat info;
    FILE *f = fopen(path, "rb");
    if (!f) return err_errno(err, "open", path);
    if (fstat(fileno(f), &info)) err_errno(err, "read", path);
    if (!err->status) verify_boxes(f, (uint64_t)info.st_size, path, err);
    fclose(f);
    return err->status;
}

struct text_ends {
    char first;    /* that is not white space; 0: there is none */
    char tail[32]; /* the last characters before the white space at the end, padded in front with 0 */
};

static enum status verify_text_ends(const char *path, struct text_ends *ends, struct err *err)
{
    char block[65536], last = 0;
    size_t size;
    FILE *f = fopen(path, "rb");
    if (!f) return err_errno(err, "open", path);
    *ends = (struct text_ends){0};
    bool has_nul = false;
    while ((size = fread(block, 1, sizeof block, f)) > 0) {
        has_nul |= memchr(block, 0, size) != NULL;
        for (size_t i = 0; i < size; i++) {
            last = block[i];
            if (isspace((unsigned char)last)) continue;
            if (!ends->first) ends->first = last;
            memmove(ends->tail, ends->tail + 1, sizeof ends->tail - 1);
            ends->tail[sizeof ends->tail - 1] = last;
        }
    }
    if (ferror(f)) err_errno(err, "read", path);
    fclose(f);
    if (!err->status && (!last || last != '\n' || has_nul))
        err_set(err, ST_DATA, "%s: found %s, wanted lines of text; make it again.", path,
                has_nul ? "a NUL byte"
                : !last ? "nothing"
                        : "no line break at the end");
    return err->status;
}

static enum status verify_text(const char *path, struct err *err)
{
    struct text_ends ends;
    return verify_text_ends(path, &ends, err);
}

/* A text that must have the first line of its product. */
static enum status verify_head(enum product_id id, const char *path, struct err *err)
{
    struct textfile t = {0};
    product_open(&t, NULL, id, path, NULL, err);
    textfile_release(&t);
    return err->status;
}

static enum status verify_markup(const char *path, const char *closing, struct err *err)
{
    struct text_ends ends;
    if (verify_text_ends(path, &ends, err)) return err->status;
    const char *tail = ends.tail + sizeof ends.tail - strlen(closing);
    if (memcmp(tail, closing, strlen(closing)) != 0)
        return err_set(err, ST_DATA, "%s: found another end, wanted %s; it is cut off, make it again.", path, closing);
    return ST_OK;
}

static enum status verify_svg(const char *path, struct err *err) { return verify_markup(path, "</svg>", err); }
static enum status verify_html(const char *path, struct err *err) { return verify_markup(path, "</html>", err); }

static enum status verify_json(const char *path, struct err *err)
{
    struct text_ends ends;
    if (verify_text_ends(path, &ends, err)) return err->status;
    const char last = ends.tail[sizeof ends.tail - 1];
    if (!((ends.first == '{' && last == '}') || (ends.first == '[' && last == ']')))
        return err_set(err, ST_DATA, "%s: wanted an object or an array of JSON with both its brackets; make it again.",
                       path);
    return ST_OK;
}

/* atlas.txt, and the sizes of the pages beside it. */
static enum status verify_atlas(const char *path, struct err *err)
{
    struct atlas atlas = {0};
    struct exr_image page = {0};
    char folder[FILE_PATH], name[FILE_PATH];
    const char *slash = strrchr(path, '/');
    snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - path) : 1, slash ? path : ".");
    atlas_read(&atlas, folder, NULL, err);
    for (int i = 0; !err->status && i < atlas.page_count; i++) {
        const int *size = atlas.page_sizes[i];
        if (!atlas_page_path(name, folder, i, err)) exr_read(&page, name, NULL, 0, err);
        if (!err->status && (page.width != size[0] || page.height != size[1]))
            err_set(err, ST_DATA, "%s: found %d x %d texels, wanted %d x %d by atlas.txt; make it again.", name,
                    page.width, page.height, size[0], size[1]);
        exr_image_release(&page);
    }
    atlas_release(&atlas);
    return err->status;
}

static enum status verify_texture_map(const char *path, struct err *err)
{
    struct texture_map map = {0};
    texture_map_read(&map, path, NULL, err);
    texture_map_release(&map);
    return err->status;
}

static enum status verify_objects(const char *path, struct err *err)
{
    struct object_list list = {0};
    object_list_read(&list, path, NULL, err);
    object_list_release(&list);
    return err->status;
}

static enum status verify_not_empty(const char *path, struct err *err)
{
    struct stat info;
    if (stat(path, &info)) return err_errno(err, "open", path);
    if (!S_ISREG(info.st_mode)) return err_set(err, ST_DATA, "%s is not a regular file; make it again.", path);
    return info.st_size ? ST_OK : err_set(err, ST_DATA, "%s: found nothing, wanted a product; make it again.", path);
}

/* The product of a path; elsewhere than in a scene's folder that of the file's name. PRODUCT_COUNT: none. */
static enum product_id find_product(const char *path, const char *name)
{
    enum product_id id = product_at(path);
    for (enum product_id i = 0; id == PRODUCT_COUNT && i < PRODUCT_COUNT; i++)
        if (!strcmp(products[i].file, name)) id = i;
    return id;
}

/* The format of products with this extension; PRODUCT_FORMAT_COUNT: there are none. */
static enum product_format format_of(const char *extension)
{
    for (enum product_id i = 0; i < PRODUCT_COUNT; i++) {
        const char *dot = strrchr(products[i].file, '.');
        if (dot && !strcasecmp(dot, extension)) return products[i].format;
    }
    return PRODUCT_FORMAT_COUNT;
}

enum status product_verify(const char *path, struct err *err)
{
    static enum status (*const checks[PRODUCT_FORMAT_COUNT + 1])(const char *path, struct err *err) = {
        [PRODUCT_IS_EXR] = verify_exr,       [PRODUCT_IS_PNG] = verify_png,
        [PRODUCT_IS_JPEG] = verify_jpeg,     [PRODUCT_IS_SVG] = verify_svg,
        [PRODUCT_IS_HTML] = verify_html,     [PRODUCT_IS_MP4] = verify_mp4,
        [PRODUCT_IS_PLY] = verify_points,    [PRODUCT_IS_TEXT] = verify_text,
        [PRODUCT_IS_COLMAP] = verify_text,   [PRODUCT_IS_MAKE] = verify_text,
        [PRODUCT_IS_JSON] = verify_json,     [PRODUCT_IS_PYTHON] = verify_text,
        [PRODUCT_IS_OBJ] = verify_text,      [PRODUCT_IS_GLB] = verify_not_empty,
        [PRODUCT_IS_IFC] = verify_not_empty, [PRODUCT_FORMAT_COUNT] = verify_not_empty,
    };
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path, *dot = strrchr(name, '.');
    const enum product_id id = find_product(path, name);
    if (id == PRODUCT_COUNT) return checks[dot ? format_of(dot) : PRODUCT_FORMAT_COUNT](path, err);
    if (id == PRODUCT_ATLAS) return verify_atlas(path, err);
    /* the reader of points knows no other PLY */
    if (id != PRODUCT_POINTS && products[id].format == PRODUCT_IS_PLY) return verify_not_empty(path, err);
    if (id == PRODUCT_TEXTURE_MAP) return verify_texture_map(path, err);
    if (id == PRODUCT_OBJECTS) return verify_objects(path, err);
    const enum product_format format = checks[products[id].format] ? products[id].format : PRODUCT_FORMAT_COUNT;
    if (!checks[format](path, err) && products[id].head && products[id].format == PRODUCT_IS_TEXT)
        verify_head(id, path, err);
    return err->status;
}
