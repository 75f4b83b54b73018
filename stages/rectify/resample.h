/* resample.h - resamples a photograph to the pinhole camera of a view.
 *
 * Both cameras have the same centre, so no depth is needed: the ray of a view's pixel is rotated into the photo's axes
 * and projected by its lens. Colour is scene-linear; pixel centres are at +0.5. */
#ifndef REMODEL_RESAMPLE_H
#define REMODEL_RESAMPLE_H

#include "common/capture/camera_set.h"
#include "common/image/image.h"

/* out gets R G B A of the view's size; A is 1 inside the photo, and A and colour are 0 outside. It is empty on entry,
 * and the caller releases it. photo: R G B of the lens's size. masked: a byte per pixel of the photo, or NULL; a pixel
 * of the view is also outside if a masked (not 0) photo pixel is among the nearest samples.
 *
 * A view with the photo's own pinhole camera gets its pixels unchanged. Other views are filtered by Lanczos-3, widened
 * where the view is smaller than the photo. Results are clamped to the range of the nearest samples: no halos, no
 * negative values. The result does not depend on the number of threads. ST_DATA: photo and lens differ in size;
 * ST_NOMEM. */
enum status resample_photo(struct image *out, const struct image *photo, const unsigned char *masked,
                           const struct camera *lens, const struct mat3 *photo_from_view, const struct view *view,
                           struct err *err);

#endif
