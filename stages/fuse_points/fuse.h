/* fuse.h - points on which the depth maps of several views agree. */
#ifndef REMODEL_FUSE_H
#define REMODEL_FUSE_H

#include "common/capture/point_cloud.h"
#include "stages/fuse_points/fuse_params.h"
#include "stages/fuse_points/surface.h"

struct fuse_stats {
    int views;            /* that had to agree */
    double depth;         /* the scene's median */
    int64_t samples;      /* pixels of confident segments, over all views */
    int64_t alone;        /* of these: too few views agreed */
    int64_t seen_through; /* of the others: views look through them */
    int64_t reads;        /* of depth maps, for their ids alone */
};

/* cloud: {0} on entry; the caller releases it. `room`: bytes for depth maps held at once. The same bits for any room and any number
 * of threads. ST_DATA: nothing that views agree on. */
enum status fuse_points(struct point_cloud *cloud, struct fuse_stats *stats, const struct camera_set *set,
                        const struct depth_source *source, const struct fuse_params *params, size_t room,
                        struct err *err);

#endif
