/* exr_openexr.h - the baseline of the bench `exr`: the C++ interface of the OpenEXR library, which programs that
 * write EXR files (ImageMagick, OpenCV, ...) use. Its pictures are those of common/image/exr.h. */
#ifndef REMODEL_BENCH_EXR_OPENEXR_H
#define REMODEL_BENCH_EXR_OPENEXR_H

#ifdef __cplusplus
extern "C" {
#endif
#include "common/image/exr.h"

void openexr_set_threads(int threads);
/* Writes with the picture's codec; half channels are rounded from float as in exr_write(). Not atomic, no fsync. */
enum status openexr_write(const struct exr_image *im, const char *path, struct err *err);
/* Reads all channels of a scanline file, in order of name. */
enum status openexr_read(struct exr_image *im, const char *path, struct err *err);

#ifdef __cplusplus
}
#endif
#endif
