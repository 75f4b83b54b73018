/* view_faces.h - the faces of a model that a view shows. */
#ifndef REMODEL_VIEW_FACES_H
#define REMODEL_VIEW_FACES_H

#include "common/capture/camera_set.h"
#include "common/layers/layered_depth.h"
#include "common/light/model_rays.h"

#define JUMP_MAX 32 /* pixels: larger distances are not told apart */

/* All per pixel. */
struct view_faces {
    int width, height;
    int32_t *face;  /* index of the face, -1: none; owned */
    float *z;       /* depth along the axis, model units, 0: none; owned */
    float *jump;    /* distance to the nearest jump of depth, pixels, at most JUMP_MAX; owned */
    float *clutter; /* 0: the view shows the face, 1: something stands in front, between: not known; owned */
};

/* Faces, depth and jumps; clutter is 0. camera: in the model's frame. The caller releases f in each case. */
enum status view_faces_trace(struct view_faces *f, const struct solid_mesh *mesh, const struct ray_scene *rays,
                             const struct view *camera, struct err *err);
void view_faces_release(struct view_faces *f);

/* Sets clutter from the view's depth; scale: model units per unit of that depth. ST_DATA: another size. */
enum status view_faces_find_clutter(struct view_faces *f, const struct solid_mesh *mesh, const struct layered_depth *d,
                                    double scale, struct err *err);

#endif
