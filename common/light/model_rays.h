/* model_rays.h - a solid model as rays see it. */
#ifndef REMODEL_MODEL_RAYS_H
#define REMODEL_MODEL_RAYS_H

#include "common/capture/camera_set.h"
#include "common/light/ray_scene.h"
#include "common/model/solid_mesh.h"

/* Adds the triangles of a model's faces to an empty scene, and commits it; a hit's id is the index of the face. glass:
 * panes (bodies "glass/...") too. The caller releases the scene in each case. */
enum status model_rays_make(struct ray_scene *rays, const struct solid_mesh *mesh, bool glass, struct err *err);

/* The face at the centre of each pixel of a pinhole camera in the model's frame, -1 if there is none, and its depth along
 * the camera's axis, 0 if there is none. As many as the camera's pixels; z may be NULL. */
void model_rays_view(int32_t *face, float *z, const struct ray_scene *rays, const struct view *camera);

#endif
