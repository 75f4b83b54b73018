/* establishing_dolly.h - a camera move along the views, pointing at the scene's centroid (thesis 3.4.2, "Establishing
 * dolly").
 *
 * Scene units, degrees where a name says so; depth is z along a camera's axis. */
#ifndef REMODEL_ESTABLISHING_DOLLY_H
#define REMODEL_ESTABLISHING_DOLLY_H

#include <stdbool.h>

#include "common/camera_path.h"
#include "common/layer_render.h"
#include "common/param.h"

/* name, type, default, least, most, unit, help */
#define PLAN_PARAMS(X)                                                                                                \
    X(seconds, double, 4, 0, 3600, "s", "length of the film")                                                         \
    X(fps, double, 30, 1, 240, "1/s", "frames a second")                                                              \
    X(width, int, 0, 0, 16384, "px", "of the film, made even; 0: by the centremost view's shape")                     \
    X(height, int, 0, 0, 16384, "px", "of the film, made even; 0: by the centremost view's shape")                    \
    X(max_side, int, 1280, 16, 16384, "px", "longest side of the film where width and height are 0")                  \
    X(ease, choice, "smooth", 0, 0, "none|smooth", "how the move starts and stops")                                   \
    X(max_holes, double, 0.01, 0, 1, "", "part of a frame that no view covers, at most, before filling")              \
    X(max_outside, double, 0.03, 0, 1, "", "part of a frame beyond the borders of the views that it blends, at most") \
    X(extent, double, 1, 0, 10, "", "length of the move, at most, as a part of the views' spread")                    \
    X(max_angle, double, 25, 0.1, 90, "degrees", "between the ends, seen from the scene's centroid")                  \
    X(max_zoom, double, 1.5, 1, 4, "", "longest focal length, as a multiple of the views' mean")                      \
    X(check_side, int, 320, 16, 4096, "px", "longest side of the pictures in which holes are counted")

struct plan_params {
    PLAN_PARAMS(PARAM_FIELD)
};
#define PLAN_PARAMS_DEFAULT        \
    {                              \
        PLAN_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param plan_param_table[];

/* CLI_PARAMS' check: ST_USAGE if the film has fewer than two frames. */
enum status plan_params_check(const void *values, struct err *err);

/* What a person should know about the path; the figures are the path's scores. */
struct dolly_notes {
    const char *center_view; /* the set's */
    double zoom;             /* focal length / the views' mean */
    double hole_limit;       /* max_holes, or more where even the centremost view cannot keep it */
    double outside_limit;    /* max_outside, likewise */
    bool stands_still;       /* no move keeps the limit */
};

/* ups: a view's upright direction in its own camera (0 -1 0 for a picture that is stored upright), one a view; NULL:
 * all upright. The film is upright, and turned by 90 degrees against pictures stored so. path is empty on entry; on
 * failure it is left empty. ST_DATA: the scene has no depth. Same bits for any number of threads. */
enum status plan_establishing_dolly(struct camera_path *path, struct dolly_notes *notes,
                                    const struct layer_scene *scene, const struct vec3 *ups,
                                    const struct plan_params *params, struct err *err);

#endif
