/* crop_fit.h - the part of a photograph that looks most like what another camera sees.
 *
 * A crop is a rectangle of the photograph, in its pixels; a frame shows it enlarged or reduced, nothing else. Frame
 * pixels are those of the film. Pixel (x, y) has its centre at (x + 0.5, y + 0.5). */
#ifndef REMODEL_CROP_FIT_H
#define REMODEL_CROP_FIT_H

#include <stddef.h>

#include "common/base/err.h"

struct crop {
    double x, y, width, height;
};

struct crop_pair { /* a point of the scene */
    double x, y;   /* in the photograph */
    double u, v;   /* in the frame, where it should be seen */
};

struct crop_task {
    double photo_width, photo_height;
    double frame_width, frame_height;
    double step_x, step_y; /* photo pixels a frame pixel, by the two focal lengths: crops are these times one factor */
    double tolerance;      /* frame px: points that are missed by more weigh less */
    const struct crop_pair *pairs;
    size_t count;
};

struct crop_result {
    struct crop crop;
    double beyond; /* frame px by which the best crop of all would leave the photograph; 0: it is the one */
};

/* The crop within the photograph that misses the points least. ST_DATA: fewer than MIN_CROP_POINTS points, or all at one
 * place. */
enum { MIN_CROP_POINTS = 4 };
enum status crop_fit(struct crop_result *result, const struct crop_task *task, struct err *err);

/* Where the frame that shows this crop has a point of the photograph. */
void crop_apply(const struct crop_task *task, const struct crop *crop, double x, double y, double *u, double *v);

/* The median distance, in frame px, of the points from where they should be seen; 0 without points. ST_NOMEM. */
enum status crop_misfit(double *misfit, const struct crop_task *task, const struct crop *crop, struct err *err);

#endif
