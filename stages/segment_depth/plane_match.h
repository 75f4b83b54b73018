/* plane_match.h - how well a segment on a plane matches the neighbouring views.
 *
 * A plane is 1/z = a u + b v + c in the view's pixel coordinates. Costs are normalized by the view's own pictures: 0 is
 * a good match, 1 a chance one. plane_matcher.c prepares the pictures, plane_match.c computes the costs. */
#ifndef REMODEL_PLANE_MATCH_H
#define REMODEL_PLANE_MATCH_H

#include "stages/segment_depth/neighbours.h"
#include "stages/segment_depth/oversegment.h"
#include "stages/segment_depth/segment_params.h"

struct plane {
    double a, b, c;
};

static inline double plane_at(struct plane p, double u, double v) { return p.a * u + p.b * v + p.c; }

/* The plane as n . X = 1, X in the axes of the camera; and back. */
static inline struct vec3 plane_normal(const struct view *v, struct plane p)
{
    return vec3_make(p.a * v->fx, p.b * v->fy, plane_at(p, v->cx, v->cy));
}

static inline struct plane plane_of_normal(const struct view *v, struct vec3 n)
{
    const double a = n.x / v->fx, b = n.y / v->fy;
    return (struct plane){a, b, n.z - a * v->cx - b * v->cy};
}

/* Whether a segment's plane stays in a range of inverse depths: nearly so at the centroid; over the segment and a
 * margin that its layer may extend into, from PLANE_MIN_FACTOR times min to PLANE_MAX_FACTOR times max. */
#define PLANE_MIN_FACTOR 0.7
#define PLANE_MAX_FACTOR 1.3

static inline bool plane_within(struct plane p, const struct segment *g, double min_inverse_z, double max_inverse_z)
{
    const double margin = 3, u[2] = {g->x0 - margin, g->x1 + 1 + margin}, v[2] = {g->y0 - margin, g->y1 + 1 + margin};
    const double middle = plane_at(p, g->cx, g->cy), slack = 0.02 * (max_inverse_z - min_inverse_z);
    if (!(middle >= min_inverse_z - slack && middle <= max_inverse_z + slack)) return false;
    for (int k = 0; k < 4; k++) {
        const double d = plane_at(p, u[k & 1], v[k >> 1]);
        if (!(d >= PLANE_MIN_FACTOR * min_inverse_z && d <= PLANE_MAX_FACTOR * max_inverse_z)) return false;
    }
    return true;
}

struct match_neighbour {
    double base[3][3], shift[3]; /* [u' v' 1] ~ base [u v 1] + shift / z */
    int width, height;
    uint8_t *texture; /* owned; see plane_match.c */
};

struct matcher {
    const struct segment_params *params; /* of the cost: best_neighbours, how many of the lowest costs count */
    const struct segmentation *segments;
    int *first;   /* count + 1: where each segment's pixels begin in x, y, weight and features; multiples of eight */
    float *x, *y; /* pixel centres */
    int16_t *features; /* FEATURE_CHANNELS per pixel */
    int *weight;       /* of each pixel, in the order of neighbour_cost()'s sums */
    int16_t *raster;   /* the same features row by row, with room for a group of eight pixels at the end */
    uint8_t *edge;     /* weight of each pixel row by row, 1 .. MATCH_FULL_WEIGHT */
    struct match_neighbour neighbours[MAX_NEIGHBOURS];
    int neighbour_count;
    unsigned *use;                /* of each segment, bit k: matched with neighbour k; NULL: with all */
    float noise;                  /* of the view, grey levels */
    unsigned excluded;            /* bit k: neighbour k hardly tells good matches from chance ones; ignored */
    float good_cost, chance_cost; /* raw costs of a good match and of a chance one */
    float *out_of_view_cost, *occluded_cost; /* of each segment, for a neighbour that cannot see it */
};

#define MATCH_BEST   (-1.0f) /* minimum matching cost */
#define MATCH_CHANCE 1.0f    /* of a chance match, in the mean */
#define MATCH_WORST  1.33f   /* maximum matching cost */

#define MATCH_FULL_WEIGHT 16   /* of a pixel that is not beside an edge of its segment */
#define MATCH_UNSEEN      1e3f /* match_row(): the neighbour does not see the pixel */

/* The camera of a picture of half the size, width x height, whose pixel coordinates are exactly half of the view's. */
static inline struct view view_halved(struct view v, int width, int height)
{
    v.width = width;
    v.height = height;
    v.fx /= 2;
    v.fy /= 2;
    v.cx /= 2;
    v.cy /= 2;
    return v;
}

/* The projection of the view's pixels into `other`: [u' v' 1] ~ base [u v 1] + shift / z. */
void matcher_homography(double base[3][3], double shift[3], const struct view *view, const struct view *other);

/* Projects a pixel at an inverse depth into a neighbour; false if it is not in front of it. */
static inline bool match_project(const struct match_neighbour *n, double u, double v, double inverse_z, double *nu,
                                 double *nv)
{
    double p[3];
    for (int i = 0; i < 3; i++) p[i] = n->base[i][0] * u + n->base[i][1] * v + n->base[i][2] + n->shift[i] * inverse_z;
    if (!(p[2] > 1e-9)) return false;
    *nu = p[0] / p[2];
    *nv = p[1] / p[2];
    return true;
}

/* m is {0} on entry; release it also after a failure. It keeps the segments and the parameters, which stay the
 * caller's. */
enum status matcher_init(struct matcher *m, const struct segmentation *segments, const struct gamma_image *reference,
                         const struct segment_params *params, struct err *err);

/* Adds a neighbour. Its picture is halved while it is more than 1.6 times as fine as the view at inverse depth
 * `typical`; its colours are multiplied by the median ratio at the points that both views observed, and its gradients
 * are rotated to the view's axes. */
enum status matcher_add(struct matcher *m, const struct camera_set *set, int view_idx, int neighbour_idx,
                        const struct observed_points *seen, double typical, const struct gamma_image *reference,
                        struct gamma_image *picture, struct err *err);

/* Measures the costs of good and chance matches over the range of inverse depths. Being out of view or occluded costs a
 * segment a part of the way from its best match to its mean one: a blank segment, which matches everywhere, is not
 * drawn to where it is visible. Neighbours of much less contrast than the best one are excluded. Call it once, after
 * the last matcher_add() and before the first cost. */
enum status match_calibrate(struct matcher *m, double min_inverse_z, double max_inverse_z, struct err *err);
/* Takes the calibration and the selection away from a matcher of the same segments and neighbours in half the size,
 * which has no costs any more. */
void matcher_take(struct matcher *m, struct matcher *half);
/* Restricts each segment to the `ranks` neighbours that match its plane best. occluded: of each segment, as
 * match_cost(), or NULL; a neighbour that does not see it comes last. */
enum status match_select(struct matcher *m, const struct plane *planes, const unsigned *occluded, struct err *err);
void matcher_release(struct matcher *m);

/* The matching cost of a segment on a plane. occluded: bit k is set if the segment is occluded in neighbour k. */
float match_cost(const struct matcher *m, int segment, struct plane plane, unsigned occluded);
/* The same from every fourth pixel, in a fourth of the time. */
float match_cost_rough(const struct matcher *m, int segment, struct plane plane, unsigned occluded);
/* The same of the neighbours in the bit set `use`; *best (may be NULL): those that count. */
float match_cost_sweep(const struct matcher *m, int segment, struct plane plane, unsigned use, unsigned *best);
/* The mean cost by rank of the neighbours that see the segment on the plane; MATCH_WORST if none does. Returns how many
 * do. */
int match_evidence(const struct matcher *m, int segment, struct plane plane, unsigned occluded, float *cost);
/* The mean length of the normalized gradients of a segment's pixels (match_features.h), in grey levels: up to 25 where
 * it has texture, and up to 15 where it has nothing but noise. */
double match_texture(const struct matcher *m, int segment);
/* Mean by rank of `count` costs in ascending order, of `useful` neighbours; those that are missing cost out_of_view. */
float match_rank(const struct matcher *m, const float *sorted, int count, int useful, float out_of_view);
/* The neighbours that a segment is matched with, as a bit set. */
unsigned match_neighbours_of(const struct matcher *m, int segment);
/* The costs of `count` pixels from (x, y) on, each on the plane in one neighbour, MATCH_UNSEEN where that does not see
 * them; not clamped. costs: room for the next multiple of eight. The pixels beyond the row's end are any. */
void match_row(const struct matcher *m, int neighbour, struct plane plane, int x, int y, int count, float *costs);
/* Prefetches the neighbours' pixels for a match_cost() that follows soon. */
void match_prefetch(const struct matcher *m, int segment, struct plane plane);

/* The largest disparity, in pixels, over the range of inverse depths: the maximum over the neighbours of the upper
 * quartile over a grid of the view's pixels. */
double match_shift(const struct matcher *m, double min_inverse_z, double max_inverse_z);

#endif
