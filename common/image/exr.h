/* exr.h - OpenEXR files: half, float and uint channels, lossless codecs.
 *
 * In memory a channel is a plane of float or uint32_t, row-major, width * height. Writing is atomic
 * (common/base/outfile.h) and gives the same bytes for the same input. Every file has chromaticities (Rec.709, D65) and
 * the provenance as string attributes remodel:stage, remodel:version, remodel:parameters, remodel:inputs. */
#ifndef REMODEL_EXR_H
#define REMODEL_EXR_H

#include <stdbool.h>
#include <stdint.h>

#include "common/base/err.h"
#include "common/base/provenance.h"
#include "common/product/product.h"

enum exr_type { EXR_UINT, EXR_HALF, EXR_FLOAT }; /* in the file; half and float are float in memory */

/* Compression of written files; ZIP packs 16 rows per chunk, the others one row. */
enum exr_codec { EXR_ZIP, EXR_ZIPS, EXR_RLE, EXR_NONE };

#define EXR_NAME_SIZE 64

enum { EXR_PADDING = 8 }; /* readable samples after the last of a channel, so that whole vectors may be loaded */

struct exr_plane {
    char name[EXR_NAME_SIZE]; /* "R", "interior.Z" */
    enum exr_type type;
    float *f;    /* EXR_HALF and EXR_FLOAT */
    uint32_t *u; /* EXR_UINT */
};

struct exr_image {
    int width, height;
    int count;
    enum exr_codec codec;     /* for exr_write(); exr_read() reads any codec and sets EXR_ZIP */
    struct exr_plane *planes; /* owned, with their data */
    bool has_chromaticities;  /* only of files that were read */
    float chromaticities[8];  /* x and y of red, green, blue, white */
    float pixel_aspect_ratio; /* of files that were read; 0: unknown */
    bool has_world_to_camera;
    float world_to_camera[16];  /* in Imath's row-vector convention, as in the file; see view_image_set_camera() */
    char (*attributes)[2][256]; /* other string attributes, name and value; owned; may be NULL */
    int attribute_count;
};

/* An image without planes. {0} is the empty state. ST_DATA: not 1 to 2^28 pixels. */
enum status exr_image_init(struct exr_image *im, int width, int height, struct err *err);
/* Adds a zeroed plane; *plane (if not NULL) is valid until the next one is added. ST_DATA: a name of 0 or more than 63
 * characters, or one that exists. */
enum status exr_add_plane(struct exr_image *im, const char *name, enum exr_type type, struct exr_plane **plane,
                          struct err *err);
/* An image of half channels R G B A from width * height * 4 samples. */
enum status exr_init_rgba(struct exr_image *im, const float *rgba, int width, int height, struct err *err);
struct exr_plane *exr_find(const struct exr_image *im, const char *name); /* NULL: not found */
enum status exr_set_attribute(struct exr_image *im, const char *name, const char *value, struct err *err);
enum status exr_set_number(struct exr_image *im, const char *name, double value, struct err *err); /* printed as %.9g */
const char *exr_attribute(const struct exr_image *im, const char *name);                           /* NULL: not found */
void exr_image_release(struct exr_image *im);

/* Values beyond the range of half, including infinity, are clamped to it. ST_DATA, naming channel and pixel: NaN, or
 * infinity in a float channel. */
enum status exr_write(const struct exr_image *im, const char *path, const struct provenance *prov, struct err *err);

/* Reads all channels, or with names != NULL only those; with name_count 0 only the header. Accepts single-part scanline
 * or tiled files of any codec of OpenEXRCore, without subsampled channels; the data window may start anywhere but must
 * have the size of the display window. Reads string attributes of at most 255 bytes, except the provenance and the
 * format's own. ST_DATA: a channel is missing (the error lists those of the file), NaN or infinity in a channel (named
 * with the pixel), missing chunks. On failure im is empty. */
enum status exr_read(struct exr_image *im, const char *path, const char *const *names, int name_count, struct err *err);
/* The same of a product, which is recorded in prov unless that is NULL: then the file is read whole, once. */
enum status exr_read_product(struct exr_image *im, enum product_id id, const char *path, const char *const *names,
                             int name_count, struct provenance *prov, struct err *err);
/* Reads all channels and keeps NaN and infinity, with which other programs mark unknown values. */
enum status exr_read_any(struct exr_image *im, const char *path, struct err *err);

#endif
