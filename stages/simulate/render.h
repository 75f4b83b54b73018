/* render.h - what a camera in a scene sees. */
#ifndef REMODEL_SIMULATE_RENDER_H
#define REMODEL_SIMULATE_RENDER_H

#include "common/image/image.h"
#include "stages/simulate/path_trace.h"
#include "stages/simulate/shoot_file.h"
#include "stages/simulate/simulate_params.h"

struct camera_view {
    const struct lens *lens;
    struct vec3 centre;
    struct mat3 world_from_cam;
};

struct camera_view camera_view_make(const struct shoot *s, const struct shot *shot);

/* The ray through a place of the picture; false: the lens shows nothing there. */
bool camera_view_ray(const struct camera_view *v, double u, double w, struct ray *ray);

/* Radiance, 3 channels: the mean over each pixel's square. The random numbers are those of (seed, name), the same for
 * any number of threads. *rays (may be NULL) counts what was traced. ST_DATA: no light reaches the picture. */
enum status render_radiance(struct image *radiance, const struct world *w, const struct camera_view *view,
                            const char *name, const struct simulate_params *params, uint64_t *rays, struct err *err);

/* By one ray through each pixel's centre: depth (z along the axis for a pinhole, length of the ray for a fisheye) and
 * the id of the face; 0 where there is none. Planes of width * height. */
void render_surfaces(float *depth, uint32_t *ids, const struct world *w, const struct camera_view *view);

#endif
