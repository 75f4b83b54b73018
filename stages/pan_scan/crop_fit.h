/* crop_fit.h - the crop of a photograph that best matches the picture of another camera.
 *
 * A crop is a rectangle in pixels of the photograph; a frame shows it scaled to its own size. Pixel (x, y) has its
 * centre at (x + 0.5, y + 0.5). */
#ifndef REMODEL_CROP_FIT_H
#define REMODEL_CROP_FIT_H

#include <stddef.h>

#include "common/base/err.h"

struct crop {
    double x, y, width, height;
};

struct crop_pair { /* a point of the scene */
    double x, y;   /* in the photograph */
    double u, v;   /* in the other camera's picture, where the frame should show it */
};

struct crop_task {
    double photo_width, photo_height;
    double frame_width, frame_height;
    double step_x,
        step_y;       /* photo pixels per frame pixel, times a common factor that is free; from the focal lengths */
    double tolerance; /* threshold of Huber's loss, frame px: points that miss by more weigh less */
    const struct crop_pair *pairs;
    size_t count;
};

struct crop_result {
    struct crop crop;
    double beyond; /* frame px by which the best unconstrained crop would leave the photograph; 0: not at all */
};

/* Finds the crop within the photograph with the smallest loss. ST_DATA: fewer than MIN_CROP_POINTS points, or all at
 * the same position. */
enum { MIN_CROP_POINTS = 4 };
enum status crop_fit(struct crop_result *result, const struct crop_task *task, struct err *err);

/* Position in the frame of a point (x, y) of the photograph. */
void crop_apply(const struct crop_task *task, const struct crop *crop, double x, double y, double *u, double *v);

/* Median distance of the points from where they should be, frame px; 0 without points. ST_NOMEM. */
enum status crop_misfit(double *misfit, const struct crop_task *task, const struct crop *crop, struct err *err);

#endif
