/* photo_camera.h - a stored photograph as a camera in the world, for pixels that users mark in photographs.
 *
 * The pose is that of one of its views, rotated back to the photo's axes; the lens is that in lenses.txt. */
#ifndef REMODEL_PHOTO_CAMERA_H
#define REMODEL_PHOTO_CAMERA_H

#include "common/capture/camera_set.h"
#include "common/capture/lens_list.h"

struct photo_camera {
    struct camera lens;
    struct mat3 cam_from_world;
    struct vec3 translation; /* p_cam = cam_from_world p_world + translation */
    struct vec3 center;
    int view_idx; /* into the set: the photo's first view, or the named view */
};

/* Photo and lens of a view of the set, by index; NULL: lenses.txt does not list it. */
const struct lens *photo_lens_of_view(const struct camera_set *set, const struct lens_list *lenses, int view);
/* The first view of the photo that a view is of, by index into the set, which stands for the photo: the views of one
 * photo follow each other. A view without a lens stands for itself. */
int photo_of_view(const struct camera_set *set, const struct lens_list *lenses, int view);

/* name: a photo's id or a view's name. ST_DATA, as "PATH:LINE: ...": unknown name; the message suggests a similar
 * one. */
enum status photo_camera_find(struct photo_camera *camera, const char *name, const struct camera_set *set,
                              const struct lens_list *lenses, const char *path, int line, struct err *err);
/* Direction of the pixel's ray in the world, of length 1. False: outside the photo or its lens. */
bool photo_camera_ray(const struct photo_camera *camera, double u, double v, struct vec3 *ray);
/* Pixel of a world point, possibly outside the photo. False: outside the lens. */
bool photo_camera_project(const struct photo_camera *camera, struct vec3 world, double *u, double *v);

#endif
