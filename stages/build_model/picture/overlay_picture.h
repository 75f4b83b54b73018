/* overlay_picture.h - a model's edges on a photograph, to check it by eye. */
#ifndef REMODEL_OVERLAY_PICTURE_H
#define REMODEL_OVERLAY_PICTURE_H

#include "common/capture/photo_camera.h"
#include "common/image/photo.h"
#include "common/model/solid_mesh.h"

/* JPEG: the photograph, as it is stored, with the model's edges: bright where they are visible, thin where the model
 * hides them, blue for glass. At most `side` px wide and high. */
enum status overlay_write(const struct solid_mesh *mesh, const struct photo_camera *camera, const struct photo *photo,
                          int side, const char *path, struct err *err);

#endif
