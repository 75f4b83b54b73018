/* true_depth.h - the true depth of a photograph: which of its points other photographs see, and how it looks in a view.
 *
 * A photograph may be a fisheye's; its view is a pinhole picture of the same centre. Points are in the photo camera's
 * axes, in units of the truth. */
#ifndef REMODEL_TRUE_DEPTH_H
#define REMODEL_TRUE_DEPTH_H

#include <stdbool.h>
#include <stdint.h>

#include "common/capture/camera_set.h"
#include "common/capture/lens_list.h"

struct true_photo {
    struct camera lens;
    struct pose pose; /* photo_from_world of the truth */
    bool along_ray;   /* depth is the length of the ray; else z along the axis */
    float *depth;     /* owned; lens.width x lens.height, 0 unknown; NULL: the truth has no depth of this photo */
};

/* points[i]: of pixel i, through the pixel's centre; {0, 0, 0} where nothing is known. photo->depth is not NULL. */
void true_points(struct vec3 *points, const struct true_photo *photo);

/* occluded[i] = 1 where none of the other photos sees point i of `photo`: it is outside their pictures or something is
 * before it. What is before it is told by the other photo's own true depth, or, where the truth has none, by the
 * points themselves, warped forward into its picture. others: with `photo` itself left out; nearest first is fastest. */
enum status true_occlusion(uint8_t *occluded, const struct true_photo *photo, const struct vec3 *points,
                           const struct true_photo *const *others, int count, struct err *err);

/* z and occluded (0 or 1) of the view's pixels, 0 where nothing is known: each takes the one true pixel in which its
 * centre lies, through the lens that the view was rectified with; nothing is interpolated, so that no depth is a mean
 * across a jump. z is that true point's own, along the view's axis. */
void true_depth_in_view(float *z, uint8_t *occluded, const struct view *view, const struct lens *lens,
                        const struct true_photo *photo, const struct vec3 *points, const uint8_t *photo_occluded);

#endif
