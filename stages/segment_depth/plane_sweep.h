/* plane_sweep.h - a first plane for every segment: the depths of a sweep, smoothed.
 *
 * Planes z = const, evenly spaced in 1/z, a step about one pixel; at every depth also the horizontal plane, which is how
 * floors and ceilings lie. */
#ifndef REMODEL_PLANE_SWEEP_H
#define REMODEL_PLANE_SWEEP_H

#include "stages/segment_depth/given_depth.h"
#include "stages/segment_depth/plane_match.h"
#include "stages/segment_depth/point_evidence.h"
#include "stages/segment_depth/segment_params.h"

struct plane_sweep {
    double least, step; /* of 1/z; the depths are least + k step */
    int planes;
    float *cost;                     /* planes a segment: matching alone */
    const struct given_depth *given; /* NULL: nothing is; set by the caller */
};

/* How many depths a sweep from least to most takes, and their distance. */
void plane_sweep_steps(struct plane_sweep *w, const struct matcher *m, double least, double most,
                       const struct segment_params *params);

/* plane[]: one a segment. weights as touch_weights(); down in the view's axes. w: plane_sweep_steps() has filled it;
 * release it also after a failure. The same for any number of threads. */
enum status plane_sweep_run(struct plane_sweep *w, struct plane *plane, const struct matcher *m,
                            const struct point_evidence *points, const float *weights, const struct view *view,
                            struct vec3 down, const struct segment_params *params, struct err *err);
void plane_sweep_release(struct plane_sweep *w);

#endif
