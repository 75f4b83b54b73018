/* linear_photo.h - a photograph as scene-linear colour, whether it is one exposure or merged from several. */
#ifndef REMODEL_LINEAR_PHOTO_H
#define REMODEL_LINEAR_PHOTO_H

#include "common/base/provenance.h"
#include "common/capture/photo_list.h"
#include "common/image/image.h"

enum { RADIOMETRY_SIZE = 256 };

/* linear: R G B as the photo is stored. Of one exposure PHOTOS/FILE, linear by the sRGB curve; of several
 * PHOTOS/ID.exr, which hdr_merge made of them. radiometry: what is known of the values, "approximate" of one exposure.
 * The file becomes an input. */
enum status linear_photo_read(struct image *linear, char radiometry[RADIOMETRY_SIZE], const char *photos,
                              const struct photo_record *record, struct provenance *prov, struct err *err);

#endif
