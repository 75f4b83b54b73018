/* surface.h - a view's depth map as planes in the world, and as many of them in memory as there is room for. */
#ifndef REMODEL_SURFACE_H
#define REMODEL_SURFACE_H

#include <stdbool.h>

#include "common/layers/layered_depth.h"

struct surface_plane {
    struct vec3 normal;  /* world, length 1, towards the camera; {0, 0, 0}: this segment says nothing */
    double offset;       /* normal . X on the plane */
    double inverse_z[3]; /* 1/z = a u + b v + c */
    float sigma;         /* relative uncertainty of z, at least LEAST_SIGMA */
    float confidence;
};

/* Depths that are said to be exact still went through rounding. */
#define LEAST_SIGMA 1e-5

struct surface {
    const struct view *view;
    uint32_t *id;                 /* w * h, 0: nothing known; owned */
    struct surface_plane *planes; /* [id - 1]; owned */
    int plane_count;
};

/* Where depth maps come from. What is filled is empty on entry and passes to the caller. */
struct depth_source {
    enum status (*read_ids)(void *ctx, int view_idx, struct layered_depth *d, struct err *err); /* ids and segments */
    enum status (*read_interior)(void *ctx, int view_idx, struct layered_depth *d, struct err *err); /* + colours */
    void *ctx;
};

/* The planes of d's segments in the world; d->interior.id passes to the surface. ST_DATA: the size is not the camera's. */
enum status surface_make(struct surface *s, const struct view *view, struct layered_depth *d, struct err *err);
void surface_release(struct surface *s);

/* z along the view's axis at the point (u, v) of segment plane p; 0 where the plane is not in front of the camera. */
static inline double surface_plane_z(const struct surface_plane *p, double u, double v)
{
    const double inverse = p->inverse_z[0] * u + p->inverse_z[1] * v + p->inverse_z[2];
    return inverse > 0 ? 1 / inverse : 0;
}

/* Surfaces read when they are asked for; those that were asked for longest ago give way when `room` bytes are full.
 * The one asked for last is always there, whatever it takes. */
struct surface_cache {
    const struct camera_set *set;
    const struct depth_source *source;
    struct surface *surfaces; /* one a view, owned */
    uint64_t *asked;          /* when, 0: not in memory */
    uint64_t clock;
    size_t room, used;
    int64_t reads;
};

enum status surface_cache_init(struct surface_cache *c, const struct camera_set *set, const struct depth_source *source,
                               size_t room, struct err *err);
/* *s lives until the next call. */
enum status surface_cache_get(struct surface_cache *c, int view_idx, const struct surface **s, struct err *err);
void surface_cache_release(struct surface_cache *c);

#endif
