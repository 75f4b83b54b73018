/* camera_alignment.h - errors of cameras, after the similarity that best aligns them with the true ones.
 *
 * The scale s, rotation R and translation t minimise sum |true - (s R found + t)|^2 over the centres [Umeyama 1991]. If
 * the centres are on a line (as two cameras always are), they leave the rotation about it open; then R is the mean of
 * the rotations between found and true cameras, nearest in the Frobenius norm. */
#ifndef REMODEL_CAMERA_ALIGNMENT_H
#define REMODEL_CAMERA_ALIGNMENT_H

#include "common/capture/camera.h"

struct similarity { /* true = scale * rotation * found + translation */
    double scale;
    struct mat3 rotation;
    struct vec3 translation;
};

/* ST_DATA: there is no scale, because there are fewer than two cameras, or all found or all true centres coincide, or
 * no positive scale fits. metrics.tsv quotes this error. */
enum status camera_alignment_find(struct similarity *a, const struct pose *found, const struct pose *truth, int count,
                                  struct err *err);

struct camera_errors {
    double center_median, center_max;     /* in the unit of the truth */
    double rotation_median, rotation_max; /* degrees */
};

/* count > 0. ST_NOMEM. */
enum status camera_errors_measure(struct camera_errors *e, const struct similarity *a, const struct pose *found,
                                  const struct pose *truth, int count, struct err *err);

#endif
