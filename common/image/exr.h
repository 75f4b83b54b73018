/* exr.h - OpenEXR files, on OpenEXRCore: scanline, half or float or uint channels, lossless codecs.
 *
 * In memory a channel is a plane of float or uint32_t, row-major, w * h. Writing is atomic (common/base/outfile.h) and gives
 * the same bytes for the same input. Every file carries chromaticities (Rec.709, D65) and the provenance as string
 * attributes remodel:stage, remodel:version, remodel:parameters, remodel:inputs. */
#ifndef REMODEL_EXR_H
#define REMODEL_EXR_H

#include <stdbool.h>
#include <stdint.h>

#include "common/base/err.h"
#include "common/base/provenance.h"

enum exr_type { EXR_UINT, EXR_HALF, EXR_FLOAT }; /* on disk; both float kinds are float in memory */

/* How a file is written; ZIP packs 16 rows together, the others a row by itself. */
enum exr_codec { EXR_ZIP, EXR_ZIPS, EXR_RLE, EXR_NONE };

#define EXR_NAME_SIZE 64

struct exr_plane {
    char name[EXR_NAME_SIZE]; /* "R", "interior.Z" */
    enum exr_type type;
    float *f;    /* EXR_HALF and EXR_FLOAT */
    uint32_t *u; /* EXR_UINT */
};

struct exr_image {
    int width, height;
    int count;
    enum exr_codec codec;     /* exr_write() uses it, exr_read() takes any and leaves EXR_ZIP here */
    struct exr_plane *planes; /* owned, with their data */
    bool has_world_to_camera;
    float world_to_camera[16];  /* Imath's row-vector convention: as stored in the file's m44f; see exr_set_camera */
    char (*attributes)[2][256]; /* further string attributes, name and value; owned; may be NULL */
    int attribute_count;
};

/* An empty picture of a size; {0} is the empty state. */
enum status exr_image_init(struct exr_image *im, int width, int height, struct err *err);
/* Adds a zeroed plane. */
enum status exr_add_plane(struct exr_image *im, const char *name, enum exr_type type, struct exr_plane **plane,
                          struct err *err);
/* A picture of R G B A, half, from w * h * 4 samples. */
enum status exr_init_rgba(struct exr_image *im, const float *rgba, int width, int height, struct err *err);
struct exr_plane *exr_find(const struct exr_image *im, const char *name); /* NULL if it is not there */
enum status exr_set_attribute(struct exr_image *im, const char *name, const char *value, struct err *err);
enum status exr_set_number(struct exr_image *im, const char *name, double value, struct err *err); /* 9 digits */
const char *exr_attribute(const struct exr_image *im, const char *name); /* NULL if it is not there */
void exr_image_release(struct exr_image *im);

/* Values beyond half's range, infinity too, are written as the largest half; NaN, and infinity in a float channel, is
 * ST_DATA naming channel and pixel. */
enum status exr_write(const struct exr_image *im, const char *path, const struct provenance *prov, struct err *err);

/* Reads all channels (or, with names != NULL, those, a missing one being ST_DATA that lists what is there; others are
 * not looked at; with no name at all only the header is read). Single-part scanline or tiled files of any codec
 * OpenEXRCore has, no channel subsampled; the data window may start anywhere but must be as large as the display
 * window. NaN or infinity in a float channel is ST_DATA naming channel and pixel. A file with missing chunks is
 * ST_DATA. The attributes read are its strings of at most 255 bytes but for the provenance and the format's own. */
enum status exr_read(struct exr_image *im, const char *path, const char *const *names, int name_count, struct err *err);
/* All channels, with NaN and infinity where the file has them: for what other programs wrote, who mark so what they do
 * not know. */
enum status exr_read_any(struct exr_image *im, const char *path, struct err *err);

#endif
