/* fuse.h - points on which the depth maps of several views agree. */
#ifndef REMODEL_FUSE_H
#define REMODEL_FUSE_H

#include "common/capture/point_cloud.h"
#include "stages/fuse_points/fuse_params.h"
#include "stages/fuse_points/surface.h"

struct fuse_stats {
    int views;            /* number of views that had to agree */
    double depth;         /* the scene's median */
    int64_t samples;      /* pixels of confident segments, over all views */
    int64_t unsupported;  /* of these, with too few views that agree */
    int64_t seen_through; /* of the others, seen through by other views */
    int64_t reads;        /* of depth maps into the cache */
};

/* cloud: {0} on entry; the caller releases it. max_bytes: size of the cache of depth maps. Same bits for any cache size
 * and any number of threads. ST_DATA: no confident segment, or no point that the views agree on. */
enum status fuse_points(struct point_cloud *cloud, struct fuse_stats *stats, const struct camera_set *set,
                        const struct depth_reader *source, const struct fuse_params *params, size_t max_bytes,
                        struct err *err);

#endif
