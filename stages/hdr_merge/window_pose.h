/* window_pose.h - the pose of a lighting reference image that looks straight out of a window. */
#ifndef REMODEL_WINDOW_POSE_H
#define REMODEL_WINDOW_POSE_H

#include "common/capture/camera.h"

struct window_pose {
    struct vec3 at;       /* the camera, in the model's frame */
    struct vec3 out;      /* unit, horizontal: the azimuth in which the image's axis points */
    bool level;           /* the camera was held upright and level; otherwise: */
    double horizon[2][2]; /* two pixels of the horizon, in any order */
};

/* The pose in the model's frame. ST_DATA with a text that can follow a file's name: pixels without a ray, or that are
 * too close to each other; an axis that points up or down, so that its azimuth is open. */
enum status window_pose_find(struct pose *cam_from_model, const struct window_pose *w, const struct camera *lens,
                             struct err *err);

#endif
