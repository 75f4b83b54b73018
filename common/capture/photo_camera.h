/* photo_camera.h - a stored photograph as a camera in the world: what people mark are pixels of photographs.
 *
 * The pose is that of any of its views, turned back into the photo's own axes, with the lens that lenses.txt states. */
#ifndef REMODEL_PHOTO_CAMERA_H
#define REMODEL_PHOTO_CAMERA_H

#include "common/capture/camera_set.h"
#include "common/capture/lens_list.h"

struct photo_camera {
    struct camera lens;
    struct mat3 cam_from_world;
    struct vec3 translation; /* p_cam = cam_from_world p_world + translation */
    struct vec3 center;
    int view_idx; /* into the set: the photo's first view, or the one that was named */
};

/* name: a photo's id or a view's name. ST_DATA, as "PATH:LINE: ...", with a guess at what was meant: there is none. */
enum status photo_camera_find(struct photo_camera *camera, const char *name, const struct camera_set *set,
                              const struct lens_list *lenses, const char *path, int line, struct err *err);
/* Unit direction in the world of what the pixel shows, from the centre; false outside of the photo or its lens. */
bool photo_camera_ray(const struct photo_camera *camera, double u, double v, struct vec3 *ray);
/* The pixel that shows a point; false where the lens does not reach. It may lie outside of the photo. */
bool photo_camera_project(const struct photo_camera *camera, struct vec3 world, double *u, double *v);

#endif
