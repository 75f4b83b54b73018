/* resample.h - resamples a photograph to the pinhole camera of a view.
 *
 * Both cameras have the same centre, so no depth is needed: the ray of a view's pixel is rotated into the photo's axes
 * and projected by its lens. Colour is scene-linear; pixel centres are at +0.5. */
#ifndef REMODEL_RESAMPLE_H
#define REMODEL_RESAMPLE_H

#include "common/capture/camera_set.h"
#include "common/capture/linear_photo.h"
#include "common/capture/photo_quality.h"
#include "common/image/image.h"

struct resample_source {
    const struct image *linear;          /* R G B of the lens's size, or */
    const struct linear_photo *photo;    /* one exposure, of which parts are made linear when they are needed */
    const unsigned char *masked;         /* a byte per pixel, not 0 where masked; NULL: no mask */
    const struct photo_quality *quality; /* of the pixels of `linear`; NULL: unknown */
};

/* out gets R G B A of the view's size; A is 1 inside the photo, and A and colour are 0 outside. It is empty on entry,
 * and the caller releases it. A pixel of the view is also outside if a masked photo pixel is among the nearest samples.
 * out_quality: noise and marks of the view's pixels, empty on entry; it stays so if it is unknown of the photo. NULL:
 * not wanted. A pixel has the marks of all samples under its kernel.
 *
 * A view with the photo's own pinhole camera gets its pixels unchanged. Other views are filtered by Lanczos-3, widened
 * where the view is smaller than the photo. Results are clamped to the range of the nearest samples: no halos, no
 * negative values. The result does not depend on the number of threads. ST_DATA: photo and lens differ in size;
 * ST_NOMEM. */
enum status resample_photo(struct image *out, struct photo_quality *out_quality, const struct resample_source *source,
                           const struct camera *lens, const struct mat3 *photo_from_view, const struct view *view,
                           struct err *err);

#endif
