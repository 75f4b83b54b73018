/* half_sphere.h - equirectangular pictures of the half-sphere before a camera, made of pinhole pictures.
 *
 * A picture of N x N pixels spans 180 degrees in both directions: longitude grows to the right and latitude down, the
 * camera's axis is in the middle. The camera is given as the pinhole camera of N x N pixels and 90 degrees that looks
 * along that axis. Depth is z along the axis, as in any picture: it is 0 at the rim. */
#ifndef REMODEL_RENDER_VIEWS_HALF_SPHERE_H
#define REMODEL_RENDER_VIEWS_HALF_SPHERE_H

#include "common/capture/view.h"
#include "common/layers/rendered_frame.h"

/* Renders a pinhole picture. */
typedef enum status half_sphere_face(void *ctx, const struct view *camera, struct rendered_frame *out, struct err *err);

/* Fills `out`, and its fractions. Same bits for any number of threads. ST_NOMEM, or the error of `face`. */
enum status half_sphere_render(struct rendered_frame *out, const struct view *camera, half_sphere_face *face, void *ctx,
                               struct err *err);

#endif
