/* surface.h - a view's depth map as planes in world space, and a cache of them. */
#ifndef REMODEL_SURFACE_H
#define REMODEL_SURFACE_H

#include <stdbool.h>

#include "common/layers/layered_depth.h"

struct surface_plane {
    struct vec3 normal;  /* world, length 1, towards the camera; {0, 0, 0}: no valid plane */
    double offset;       /* normal . X on the plane */
    double inverse_z[3]; /* 1/z = a u + b v + c */
    float sigma;         /* relative uncertainty of z, at least MIN_SIGMA */
    float confidence;
};

/* Relative; even exact depths have been rounded. */
#define MIN_SIGMA 1e-5

struct surface {
    const struct view *view;
    uint32_t *id;                 /* w * h, 0: unknown; owned */
    struct surface_plane *planes; /* [id - 1]; owned */
    int plane_count;
};

/* Where depth maps come from. The callbacks fill d, which is empty on entry; the caller releases it. */
struct depth_reader {
    enum status (*read_ids)(void *ctx, int view_idx, struct layered_depth *d, struct err *err); /* ids and segments */
    enum status (*read_interior)(void *ctx, int view_idx, struct layered_depth *d, struct err *err); /* + colours */
    void *ctx;
};

/* Transforms the planes of d's segments to the world; takes d->interior.id over. ST_DATA: the size is not the
 * camera's. */
enum status surface_make(struct surface *s, const struct view *view, struct layered_depth *d, struct err *err);
void surface_release(struct surface *s);

/* z of plane p at the view's pixel coordinates (u, v); 0 where the plane is not in front of the camera. */
static inline double surface_plane_z(const struct surface_plane *p, double u, double v)
{
    const double inverse = p->inverse_z[0] * u + p->inverse_z[1] * v + p->inverse_z[2];
    return inverse > 0 ? 1 / inverse : 0;
}

/* Surfaces, read on demand; the least recently used ones are evicted while they exceed max_bytes. The last one is
 * always kept. */
struct surface_cache {
    const struct camera_set *set;
    const struct depth_reader *source;
    struct surface *surfaces; /* one per view; owned */
    uint64_t *last_use;       /* clock of the last use, 0: not in memory */
    uint64_t clock;
    size_t max_bytes, used_bytes;
    int64_t reads;
};

enum status surface_cache_init(struct surface_cache *c, const struct camera_set *set, const struct depth_reader *source,
                               size_t max_bytes, struct err *err);
/* Reads the surface if it is not in memory. *s is valid until the next call. */
enum status surface_cache_get(struct surface_cache *c, int view_idx, const struct surface **s, struct err *err);
void surface_cache_release(struct surface_cache *c);

#endif
