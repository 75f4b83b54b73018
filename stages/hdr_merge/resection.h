/* resection.h - the pose of a camera from pixels that show known points. */
#ifndef REMODEL_RESECTION_H
#define REMODEL_RESECTION_H

#include "common/capture/camera.h"

enum { RESECTION_MIN = 3, RESECTION_MAX = 64, RESECTION_POSES = 8 };

struct resection_mark {
    double x, y; /* pixel */
    struct vec3 point;
};

struct resection_pose {
    struct pose cam_from_world;
    double rms, max;   /* distance of the marks from the points' pixels; px */
    double degrees;    /* root mean square of the angles between the marks' rays and the points */
    int worst;         /* the mark of `max` */
    struct vec3 error; /* half of the 95 % interval of the centre along the world's axes */
    double turn_error; /* the same of the direction, about the axis where it is largest; degrees */
};

/* Poses between which the marks do not decide: the one that fits best, then others that fit nearly as well. */
struct resection {
    struct resection_pose poses[RESECTION_POSES];
    int count;
};

/* count: RESECTION_MIN..RESECTION_MAX. click: standard error of a mark, px; larger distances of the marks from the
 * points raise the intervals, too, which needs more than three marks. name: the image, for errors. ST_DATA: a pixel
 * that the lens does not have, marks on a line, marks that no camera has. */
enum status resection_find(struct resection *r, const struct camera *lens, const struct resection_mark *marks,
                           int count, double click, const char *name, struct err *err);

#endif
