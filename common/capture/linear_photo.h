/* linear_photo.h - a photograph as scene-linear colour, from one exposure or merged from several. */
#ifndef REMODEL_LINEAR_PHOTO_H
#define REMODEL_LINEAR_PHOTO_H

#include "common/base/provenance.h"
#include "common/capture/photo_list.h"
#include "common/capture/photo_quality.h"
#include "common/image/image.h"

enum { RADIOMETRY_SIZE = 256 };

/* linear: R G B in the orientation of the stored photo. One exposure: PHOTOS/FILE, linearised by the sRGB curve.
 * Several: PHOTOS/ID.exr, made by hdr_merge. quality: noise and marks of its pixels; NULL: not wanted, and `assumed`,
 * for one exposure, may be NULL too. radiometry: how exact the values are; "approximate" for one exposure. The file is
 * added to prov as an input. */
enum status linear_photo_read(struct image *linear, struct photo_quality *quality, char radiometry[RADIOMETRY_SIZE],
                              const char *photos, const struct photo_record *record,
                              const struct single_exposure *assumed, struct provenance *prov, struct err *err);

#endif
