/* ceres_bundle.h - bundle adjustment by Ceres. What is adjusted, and why, is decided in bundle.c. */
#ifndef REMODEL_CERES_BUNDLE_H
#define REMODEL_CERES_BUNDLE_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#include "common/base/err.h"
#include "common/capture/camera.h"

struct bundle_lens {
    struct camera camera;
    bool free[CAMERA_MAX_PARAMS];                                 /* the parameters that are adjusted */
    double expected[CAMERA_MAX_PARAMS], sigma[CAMERA_MAX_PARAMS]; /* their Gaussian priors; sigma 0: none */
    double aspect, aspect_sigma; /* the same for the ratio of the second focal length to the first */
};

struct bundle_station { /* where one or several images were taken */
    double center[3], expected[3];
    bool fixed; /* it is not adjusted */
};

/* A rigid frame of a multi-lens camera. Of a capture, one photo of such a camera: the pose of its body in the world. Of
 * a mount: the pose of a lens in the body. */
struct bundle_frame {
    double rotation[4]; /* body_from_world, cam_from_body; unit quaternions w x y z */
    double center[3];
};

struct bundle_image {
    int lens, station;               /* indices */
    int capture, mount;              /* indices of the rig's frames; -1: the image is not part of a rig */
    double rotation[4], expected[4]; /* cam_from_world, unit quaternions w x y z */
    double shift[2];                 /* added to the lens's principal point, px */
    bool fixed;                      /* its rotation is not adjusted */
};

struct bundle_observation {
    int image, point; /* indices */
    double u, v;      /* px */
};

struct bundle {
    /* parts of one allocation in this order: Ceres sorts unknowns by address, and the bits of sums depend on it */
    struct bundle_lens *lenses;
    struct bundle_station *stations;
    struct bundle_image *images;
    struct bundle_frame *captures, *mounts; /* mounts[0], of the reference lens, is the identity and not adjusted */
    double (*points)[3];
    struct bundle_observation *observations;
    int lens_count, station_count, image_count, point_count;
    size_t observation_count;
    double noise;                    /* sigma of a pixel coordinate, px: the scale of the robust loss */
    double freedom;                  /* degrees of freedom of the residuals' Student t distribution */
    double shift_sigma;              /* of the prior of each image's shift, px; 0: shifts are not adjusted */
    double center_sigma, turn_sigma; /* of the priors of poses, scene units and radians; 0: none, the frame is held */
    double mount_sigma, mount_turn_sigma; /* of a lens's pose in the body, scene units and radians; 0: no rig */
    bool points_only;                     /* nothing but points is adjusted */
    int iterations;                       /* maximum */
    double tolerance;                     /* relative change of the sum at which it ends */
};

/* Minimises the robust reprojection error and the priors over what is free, in place: half the sum of
 *   (freedom + 2) log(1 + r^2 / (freedom noise^2))   over observations, r the residual's length in px
 *   ((x - expected) / sigma)^2                       over priors
 *   (pose against capture and mount, / sigma)^2      over images of a rig, if both parts of their pose are adjusted
 * Every point must be in front of the cameras that observe it. Runs in one thread: the same input gives the same bits.
 * ST_DATA: Ceres found no usable solution. */
enum status ceres_bundle_adjust(struct bundle *b, struct err *err);

/* Standard deviations of the images' shifts at the solution, px: sigma[2 i], sigma[2 i + 1]; 0 of an image without
 * observations. ST_DATA: the covariance cannot be computed. */
enum status ceres_bundle_shift_sigma(double *sigma, struct bundle *b, struct err *err);

#ifdef __cplusplus
}
#endif

#endif
