/* true_depth.h - the true depth of a photograph: which of its points other photographs see, and its depth in a view.
 *
 * A photograph may have a fisheye lens; its view is a pinhole picture with the same centre. Points are in the axes
 * of the photo's camera, in the unit of the truth. */
#ifndef REMODEL_TRUE_DEPTH_H
#define REMODEL_TRUE_DEPTH_H

#include <stdbool.h>
#include <stdint.h>

#include "common/capture/camera_set.h"
#include "common/capture/lens_list.h"

struct true_photo {
    struct camera lens;
    struct pose pose; /* photo_from_world of the truth */
    bool along_ray;   /* depth is the length of the ray, not z along the axis */
    float *depth;     /* owned; lens.width x lens.height, 0 unknown; NULL: the truth has no depth map of this photo */
};

/* points[i]: the point at the centre of pixel i; {0, 0, 0} if its depth is unknown. photo->depth must not be NULL. */
void true_points(struct vec3 *points, const struct true_photo *photo);

/* occluded[i] = 1 if none of the other photos sees point i of `photo`: it is outside their pictures, or something is in
 * front of it. That is found from the other photo's true depth, or, if it has none, from the points themselves, warped
 * forward into that photo. others: without `photo` itself; nearest first is fastest. ST_NOMEM. */
enum status true_occlusion(uint8_t *occluded, const struct true_photo *photo, const struct vec3 *points,
                           const struct true_photo *const *others, int count, struct err *err);

/* z (along the view's axis) and occluded (0 or 1) of each pixel of the view, both 0 where the truth is unknown. A pixel
 * takes the one true pixel that contains its centre, through the lens with which the view was rectified. Nothing is
 * interpolated, so that no depth is a mean across a depth edge. */
void true_depth_in_view(float *z, uint8_t *occluded, const struct view *view, const struct lens *lens,
                        const struct true_photo *photo, const struct vec3 *points, const uint8_t *photo_occluded);

#endif
