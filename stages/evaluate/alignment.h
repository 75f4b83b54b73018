/* alignment.h - how far cameras are from the true ones, after the similarity that brings both scenes together.
 *
 * S. Umeyama, "Least-squares estimation of transformation parameters between two point patterns", 1991: the scale s,
 * rotation R and translation t that minimise sum |true - (s R found + t)|^2 over the centres. Where the centres stand on
 * one line (two cameras do) they leave the turn about it open: then R is the mean of the turns between found and true
 * cameras, nearest in the Frobenius norm. */
#ifndef REMODEL_ALIGNMENT_H
#define REMODEL_ALIGNMENT_H

#include "common/capture/camera.h"

struct similarity { /* true = scale * rotation * found + translation */
    double scale;
    struct mat3 rotation;
    struct vec3 translation;
};

/* ST_DATA: fewer than two cameras, or all found or all true centres in one place: there is no scale. */
enum status align_cameras(struct similarity *a, const struct pose *found, const struct pose *truth, int count,
                          struct err *err);

struct camera_errors {
    double center_median, center_max;     /* in units of the truth */
    double rotation_median, rotation_max; /* degrees */
};

/* The median of an even number is the mean of the middle two. count > 0. */
enum status measure_cameras(struct camera_errors *e, const struct similarity *a, const struct pose *found,
                            const struct pose *truth, int count, struct err *err);

/* Of count > 0 numbers, which it sorts. */
double median(double *values, int count);

#endif
