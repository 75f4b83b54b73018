/* camera.h - COLMAP's camera models.
 *
 * Camera axes: x right, y down, z forward. Pixel (x, y) has its centre at (x + 0.5, y + 0.5), so (cx, cy) of a centred
 * camera is (width / 2, height / 2). Parameters are in COLMAP's order:
 *   SIMPLE_PINHOLE f cx cy; PINHOLE fx fy cx cy; SIMPLE_RADIAL f cx cy k; RADIAL f cx cy k1 k2;
 *   OPENCV fx fy cx cy k1 k2 p1 p2; OPENCV_FISHEYE fx fy cx cy k1 k2 k3 k4;
 *   FULL_OPENCV fx fy cx cy k1 k2 p1 p2 k3 k4 k5 k6; FOV fx fy cx cy omega; SIMPLE_RADIAL_FISHEYE f cx cy k;
 *   RADIAL_FISHEYE f cx cy k1 k2; THIN_PRISM_FISHEYE fx fy cx cy k1 k2 p1 p2 k3 k4 sx1 sy1 */
#ifndef REMODEL_CAMERA_H
#define REMODEL_CAMERA_H

#include <stdbool.h>

#include "common/base/err.h"
#include "common/capture/pose.h"

enum camera_model {
    CAMERA_SIMPLE_PINHOLE,
    CAMERA_PINHOLE,
    CAMERA_SIMPLE_RADIAL,
    CAMERA_RADIAL,
    CAMERA_OPENCV,
    CAMERA_OPENCV_FISHEYE,
    CAMERA_FULL_OPENCV,
    CAMERA_FOV,
    CAMERA_SIMPLE_RADIAL_FISHEYE,
    CAMERA_RADIAL_FISHEYE,
    CAMERA_THIN_PRISM_FISHEYE,
    CAMERA_MODEL_COUNT,
};

#define CAMERA_MAX_PARAMS 12

struct camera {
    enum camera_model model;
    int width, height;
    double params[CAMERA_MAX_PARAMS];
};

const char *camera_model_name(enum camera_model model);
int camera_model_params(enum camera_model model);
bool camera_model_from_name(const char *name, enum camera_model *model);
bool camera_model_is_fisheye(enum camera_model model);    /* radii follow the angle from the axis, which may be wide */
bool camera_model_has_one_focal(enum camera_model model); /* its parameters are f cx cy ..., not fx fy cx cy ... */

/* The OPENCV_FISHEYE nearest to an equisolid fisheye, r = 2 focal sin(theta / 2). */
struct camera camera_equisolid(int width, int height, double focal, double cx, double cy);

/* ST_DATA: a parameter is not finite, a focal length not > 0, a side < 1, a FOV lens of 180 degrees or more. */
enum status camera_check(const struct camera *c, struct err *err);

void camera_focal(const struct camera *c, double *fx, double *fy, double *cx, double *cy);

/* The camera of the same pictures at another size. False: the shapes differ by more than the half pixel, of the smaller
 * picture, that rounding explains; *c is unchanged. */
bool camera_resize(struct camera *c, int width, int height);

/* Point in camera coordinates -> pixel. False: behind the camera (z <= 0; for a fisheye only the origin and the
 * negative axis), or beyond the radius up to which the distortion is one-to-one. */
bool camera_project(const struct camera *c, struct vec3 p, double *u, double *v);

/* The projection and its derivatives: d_point by the point's coordinates, d_params by the model's parameters (in their
 * order; the columns beyond them are not set). False as camera_project(). */
bool camera_project_derivatives(const struct camera *c, struct vec3 p, double pixel[2], double d_point[2][3],
                                double d_params[2][CAMERA_MAX_PARAMS]);

/* Pixel -> ray of length 1 in camera coordinates, accurate to 1e-10 focal lengths. False: no ray maps to this pixel. */
bool camera_unproject(const struct camera *c, double u, double v, struct vec3 *ray);

#endif
