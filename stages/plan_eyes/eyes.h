/* eyes.h - the cameras of two eyes for each frame of a film, within limits of comfort.
 *
 * Lengths are in scene units. Depth is z along the film's camera, the same for both eyes. Disparity is the position in
 * the right eye's picture less that in the left one's, in px: negative in front of the screen, positive behind it. */
#ifndef REMODEL_PLAN_EYES_EYES_H
#define REMODEL_PLAN_EYES_EYES_H

#include <stdbool.h>

#include "common/capture/camera_path.h"
#include "common/layers/layer_scene.h"
#include "stages/plan_eyes/eyes_params.h"

enum eyes_kind {
    EYES_FLAT,        /* pictures for a screen, which converge at a depth */
    EYES_HALF_SPHERE, /* 180 degrees for each eye; nothing converges */
};

struct eyes_depth {
    double nearest, farthest; /* percentiles of the depths that a frame shows; 0: it shows nothing */
    double convergence;       /* depth without disparity; 0: infinity */
};

struct eyes_plan {
    enum eyes_kind kind;
    double base;               /* between the eyes */
    const char *limit;         /* what limits it: "near_ratio", "disparity" or "base" (given) */
    double nearest, farthest;  /* over all frames */
    double front, behind;      /* largest disparities over all frames, px; both are 0 or more */
    int front_at, behind_at;   /* in these frames, from 0 */
    struct eyes_depth *frames; /* one per frame of the film; owned */
    int frame_count;
    int width; /* of an eye's picture, px */
};

/* Disparity of a point at depth z in a frame of the film, px. */
double eyes_disparity(const struct eyes_plan *plan, const struct view *camera, int frame, double z);

/* Fills the plan from depths measured elsewhere, one per frame of the path (convergence is computed). ST_DATA: no frame
 * shows anything. The plan is {0} on entry; the caller releases it in each case. */
enum status eyes_plan_from_depths(struct eyes_plan *plan, const struct camera_path *film,
                                  const struct eyes_depth *depths, enum eyes_kind kind,
                                  const struct eyes_params *params, struct err *err);
/* The same, with depths measured in the layers. */
enum status eyes_plan(struct eyes_plan *plan, const struct camera_path *film, const struct layer_scene *scene,
                      enum eyes_kind kind, const struct eyes_params *params, struct err *err);
/* Makes the path of an eye, side -1 the left one, 1 the right one. The caller releases it. A half-sphere is given as
 * the pinhole camera of 90 degrees that looks along its middle, with the size of its picture. */
enum status eyes_path(struct camera_path *eye, const struct camera_path *film, const struct eyes_plan *plan, int side,
                      struct err *err);
/* Writes eyes.txt. */
enum status eyes_write(const struct eyes_plan *plan, const struct camera_path *film, const struct eyes_params *params,
                       const char *path, const struct provenance *prov, struct err *err);
void eyes_plan_release(struct eyes_plan *plan);

#endif
