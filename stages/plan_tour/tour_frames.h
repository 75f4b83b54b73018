/* tour_frames.h - the frames of a tour: walks along the ways between its stops [Colburn 2014, 4.7.1]. */
#ifndef REMODEL_TOUR_FRAMES_H
#define REMODEL_TOUR_FRAMES_H

#include "common/capture/camera_path.h"
#include "common/texture/viewpoint_pairs.h"
#include "stages/plan_tour/tour_graph.h"

/* A place on the tour at a time. */
struct tour_key {
    double time;
    struct vec3 at;
    double azimuth, elevation; /* of the axis; azimuths of neighbouring keys differ by at most pi */
    int node;                  /* the viewpoint that the tour comes from */
};

/* The whole tour as keys, between which place and axis are interpolated linearly. *keys is malloc'ed. */
enum status tour_keys_make(struct tour_key **keys, int *count, const struct tour_graph *g,
                           const struct tour_stop *stops, int stop_count, const struct tour_params *params,
                           struct err *err);

/* Cameras of the frames, in the frame of O/views, and the viewpoints that each blends. path and pairs are empty on
 * entry; the caller releases both in each case. ST_INTERNAL: a frame is nearer to the model than the clearance. */
enum status tour_frames_make(struct camera_path *path, struct viewpoint_pairs *pairs, const struct tour_key *keys,
                             int key_count, const struct tour_graph *g, const struct model_axes *axes,
                             const struct model_rays *model, const struct tour_params *params, struct err *err);

#endif
