/* resample.h - a photograph seen through the pinhole camera of its view.
 *
 * Both cameras share one centre, so that no depth is needed: a view's pixel is a ray, the ray is turned into the photo's
 * axes and goes through its lens. Colour is scene-linear; pixel centres are at +0.5. */
#ifndef REMODEL_RESAMPLE_H
#define REMODEL_RESAMPLE_H

#include "common/capture/camera_set.h"
#include "common/image/image.h"

/* out: R G B A of the view's size (empty on entry, the caller releases it), A 1 inside the photo and 0 outside, where the
 * colour is 0 too. photo: R G B of the lens' size. A view that is the photo's own pinhole camera gets its pixels as they
 * are. Otherwise Lanczos-3, widened where the view is smaller than the photo; results stay within the range
 * of the samples nearest to the pixel, so that there are no halos and nothing is negative. masked (NULL: nothing is): a byte a
 * pixel of the photo; where one of the nearest samples is not 0 there, the view has no pixel, as outside of the photo. */
enum status resample_photo(struct image *out, const struct image *photo, const unsigned char *masked,
                           const struct camera *lens, const struct mat3 *photo_from_view, const struct view *view,
                           struct err *err);

#endif
