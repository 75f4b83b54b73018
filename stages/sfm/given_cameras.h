/* given_cameras.h - a model that is built of cameras alone, for the readers of formats without points. */
#ifndef REMODEL_GIVEN_CAMERAS_H
#define REMODEL_GIVEN_CAMERAS_H

#include <stdbool.h>

#include "common/capture/photo_list.h"
#include "common/capture/sfm_model.h"
#include "common/capture/transforms_file.h"

/* The camera model that has these coefficients. ST_DATA, with `where` in front: a fourth radial coefficient, which no
 * model has, or no camera. */
enum status given_lens_camera(struct camera *c, const struct given_lens *lens, const char *where, struct err *err);

/* Stands for the lens of a panorama, which has no camera model: panorama_poses_expand() replaces its images. ST_DATA,
 * with `where` in front: the panorama itself is a photo of the scene, which would be taken for a pinhole picture. */
enum status given_panorama_lens(struct camera *c, const char *name, const struct photo_list *photos, const char *where,
                                struct err *err);

/* The index of this camera in the model, or -1. */
int given_cameras_find(const struct sfm_model *m, const struct camera *c);

/* An image with its camera and pose: axes[k] is the direction of the camera's x (right), y (down), z (forward) axis in
 * the world; they may have any one length. ST_DATA, with `where` in front: they are not perpendicular, or mirrored. */
enum status given_cameras_add(struct sfm_model *m, const char *name, const struct camera *c, const struct vec3 axes[3],
                              struct vec3 center, const char *where, struct err *err);

/* Sorts the images, once all are added. ST_DATA, with `path` in front: no image, or two of one name. */
enum status given_cameras_end(struct sfm_model *m, const char *path, struct err *err);

#endif
