/* model_axes.h - the frame of a room's model in its scene (axes, floor, ceiling, scale): out/SCENE/model/axes.txt.
 *
 * Model frame: right-handed, z up, floor at z = 0, x and y along the walls; metres if a scale was given, else scene
 * units. The world is the frame of out/SCENE/views and points. They are related by a similarity:
 *   p_model = scale * R(rotation) p_world + translation
 *
 *   remodel-axes 1
 *   rotation W X Y Z                     unit quaternion, model_from_world
 *   translation X Y Z                    model units
 *   scale S metres|unknown               model units per scene unit; unknown: S is 1
 *   ceiling H|none                       height above the floor, model units
 *   thickness T|none                     of all walls, measured by a user, model units
 *   error tilt D                         estimated standard errors: of the up direction, degrees
 *   error heading D                      of the rotation about it, degrees
 *   error floor E                        of the floor's height, model units
 *   error ceiling E|none                 of the ceiling's height above the floor, model units
 *   error scale E|none                   of the scale, as a fraction of it */
#ifndef REMODEL_MODEL_AXES_H
#define REMODEL_MODEL_AXES_H

#include <stdbool.h>

#include "common/base/provenance.h"
#include "common/capture/camera_set.h"

struct model_axes {
    struct quat rotation;              /* model_from_world */
    struct vec3 translation;           /* model units */
    double scale;                      /* model units per scene unit, > 0; 1 unless metric */
    bool metric;                       /* model units are metres */
    double ceiling;                    /* height above the floor, > 0; 0: unknown */
    double thickness;                  /* of the walls, > 0; 0: unknown */
    double tilt_error, heading_error;  /* degrees, standard errors */
    double floor_error, ceiling_error; /* model units, standard errors; ceiling_error is 0 without a ceiling */
    double scale_error;                /* fraction of the scale; 0 unless metric */
};

/* A failure leaves axes zero. ST_DATA with file and line: a quaternion of another length than 1, numbers out of the
 * ranges above, missing lines. */
enum status model_axes_read(struct model_axes *axes, const char *path, struct provenance *prov, struct err *err);
enum status model_axes_write(const struct model_axes *axes, const char *path, const struct provenance *prov,
                             struct err *err);

struct vec3 model_from_world_point(const struct model_axes *axes, struct vec3 world);
struct vec3 world_from_model_point(const struct model_axes *axes, struct vec3 model);
/* Rotated, not scaled. */
struct vec3 model_from_world_direction(const struct model_axes *axes, struct vec3 world);
struct vec3 world_from_model_direction(const struct model_axes *axes, struct vec3 model);

/* The camera in the model's frame: it has the same picture, and its depths are in model units. */
struct view model_from_world_view(const struct model_axes *axes, const struct view *world);

#endif
