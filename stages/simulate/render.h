/* render.h - images of a scene: radiance, depth and face ids. */
#ifndef REMODEL_SIMULATE_RENDER_H
#define REMODEL_SIMULATE_RENDER_H

#include "common/image/image.h"
#include "stages/simulate/path_trace.h"
#include "stages/simulate/shoot_file.h"
#include "stages/simulate/simulate_params.h"

struct camera_view {
    const struct shoot_lens *lens;
    struct vec3 centre;
    struct mat3 world_from_cam;
};

struct camera_view render_view_make(const struct shoot *s, const struct shoot_photo *photo);

/* The ray through the image point (u, w), in pixels; false outside the image circle of the lens. */
bool render_view_ray(const struct camera_view *v, double u, double w, struct path_ray *ray);

/* Radiance, 3 channels: the mean over each pixel's area. Random numbers are keyed by (seed, name, pixel or group of
 * pixels): the result is the same for any number of threads. Adds the number of rays traced to *rays (may be NULL).
 * ST_NOMEM. The caller releases the image. */
enum status render_radiance(struct image *radiance, const struct world *w, const struct camera_view *view,
                            const char *name, const struct simulate_params *params, uint64_t *rays, struct err *err);

/* ST_DATA: no light reaches the camera, the image is black. */
enum status render_check_light(const struct image *radiance, const char *name, struct err *err);

/* Traces one ray through each pixel's centre. Depth is z along the axis for a pinhole, the length of the ray for a
 * fisheye; ids count faces from 1. Both are 0 where nothing is hit. Arrays of width * height. */
void render_surfaces(float *depth, uint32_t *ids, const struct world *w, const struct camera_view *view);

#endif
