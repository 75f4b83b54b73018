/* plane_sweep.h - initial planes of the segments: a sweep of the depth range, smoothed. */
#ifndef REMODEL_PLANE_SWEEP_H
#define REMODEL_PLANE_SWEEP_H

#include "stages/segment_depth/given_depth.h"
#include "stages/segment_depth/plane_match.h"
#include "stages/segment_depth/point_evidence.h"
#include "stages/segment_depth/segment_params.h"

/* Normals of the planes that interiors are made of, unit vectors in the view's axes: of level planes first. */
#define MAX_FAMILIES 5
struct plane_families {
    struct vec3 normal[MAX_FAMILIES];
    int count;
};

struct plane_sweep {
    double min_inverse_z, step; /* inverse depth of label k: min_inverse_z + k step */
    int planes;
    float *cost;                     /* the cost volume: `planes` matching costs per segment */
    const struct given_depth *given; /* NULL if no depth is given; set by the caller */
};

/* Sets the number of planes of a sweep of the range, and their distance: about one pixel, or more where that needs more
 * than params->planes. */
void plane_sweep_steps(struct plane_sweep *w, const struct matcher *m, double min_inverse_z, double max_inverse_z,
                       const struct segment_params *params);

/* Fills plane[], one plane per segment. weights: of smooth_border_weights(); w comes from
 * plane_sweep_steps(); release it also after a failure. Same result for any number of threads. */
enum status plane_sweep_run(struct plane_sweep *w, struct plane *plane, const struct matcher *m,
                            const struct point_evidence *points, const float *weights, const struct view *view,
                            const struct plane_families *families, const struct segment_params *params,
                            struct err *err);
void plane_sweep_release(struct plane_sweep *w);

#endif
