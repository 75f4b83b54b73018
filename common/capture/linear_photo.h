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

/* A photo whose parts become linear colour when they are needed: in floats, with its noise and marks, a photo takes 17
 * bytes a pixel, as a JPEG 3. {0} is the empty state. */
struct linear_photo {
    int width, height;
    struct image linear;          /* all of it, of merged exposures; else empty, and */
    struct photo_quality quality; /* the same */
    struct photo photo;           /* one exposure */
    struct photo_light light;     /* of it */
    struct exposure_judge judge;
};

/* The same photo as linear_photo_read() reads, with its noise and marks. Release it also after a failure. */
enum status linear_photo_open(struct linear_photo *p, char radiometry[RADIOMETRY_SIZE], const char *photos,
                              const struct photo_record *record, const struct single_exposure *assumed,
                              struct provenance *prov, struct err *err);
/* Of one exposure: `count` pixels from pixel `first` on, in order of rows. */
void linear_photo_take(const struct linear_photo *p, float *rgb, float *variance, uint8_t *marks, size_t first,
                       size_t count);
void linear_photo_release(struct linear_photo *p);

#endif
