/* plane_match.h - how well a segment on a plane agrees with the neighbouring views.
 *
 * A plane is 1/z = a u + b v + c in the view's pixel coordinates, so that a segment's picture in a neighbour is a
 * homography. Per pixel the cost compares colours and gradients of luminance at two scales, each truncated; a
 * neighbour's cost is the mean over the segment's pixels that it sees, at most a fixed one, or another fixed one if it does
 * not see the segment. In order of cost each neighbour counts a little less than the one before: the worse ones may
 * not see the segment for something in front of it. Costs are measured against the pictures' own noise: 0 is what a good match
 * costs in this view, 1 what a chance one does (matcher_calibrate()). */
#ifndef REMODEL_PLANE_MATCH_H
#define REMODEL_PLANE_MATCH_H

#include "stages/segment_depth/neighbours.h"
#include "stages/segment_depth/oversegment.h"

struct plane {
    double a, b, c;
};

static inline double plane_at(struct plane p, double u, double v) { return p.a * u + p.b * v + p.c; }

/* A segment's plane stays within [least, most] of the inverse depths swept at the segment's middle, and over the segment and a
 * margin around it, where its edge may be painted, within [PLANE_LEAST x least, PLANE_MOST x most]. */
#define PLANE_MIN_FACTOR 0.7
#define PLANE_MAX_FACTOR  1.3

static inline bool plane_within(struct plane p, const struct segment *g, double least, double most)
{
    const double margin = 3, u[2] = {g->x0 - margin, g->x1 + 1 + margin}, v[2] = {g->y0 - margin, g->y1 + 1 + margin};
    const double middle = plane_at(p, g->cx, g->cy), slack = 0.02 * (most - least);
    if (!(middle >= least - slack && middle <= most + slack)) return false;
    for (int k = 0; k < 4; k++) {
        const double d = plane_at(p, u[k & 1], v[k >> 1]);
        if (!(d >= PLANE_MIN_FACTOR * least && d <= PLANE_MAX_FACTOR * most)) return false;
    }
    return true;
}

struct match_neighbour {
    double base[3][3], shift[3]; /* [u' v' 1] ~ base [u v 1] + shift / z */
    int width, height;
    uint8_t *texture; /* owned; see plane_match.c */
};

struct matcher {
    const struct segmentation *segments;
    int *first;        /* of each segment's pixels in x, y and features; groups of eight; count + 1 */
    float *x, *y;      /* pixel centres */
    int16_t *features; /* eight a pixel */
    int *weight;       /* one a pixel, in the order in which they are summed */
    struct match_neighbour neighbours[MAX_NEIGHBOURS];
    int neighbour_count;
    float noise;            /* of the view, grey levels */
    unsigned excluded;       /* bit k: neighbour k tells good matches from chance ones hardly, and is not looked at */
    float good, random;     /* raw costs of a good match and of a chance one */
    float *unseen, *hidden; /* of each segment: what a neighbour costs that cannot see it, or that it is hidden from */
};

#define MATCH_BEST  (-1.0f) /* no match costs less */
#define MATCH_WORST 1.33f   /* nor more */

/* [u' v' 1] of `other` ~ base [u v 1] + shift / z. */
void match_homography(double base[3][3], double shift[3], const struct view *view, const struct view *other);

/* m is {0} on entry; release it also after a failure. */
enum status matcher_init(struct matcher *m, const struct segmentation *segments, const struct gamma_image *reference,
                         struct err *err);

/* Adds a neighbour. The picture is halved while it is more than 1.6 times as fine as the view at inverse depth `typical`;
 * its colours are multiplied by the median ratio at the points both see, its gradients turned to the view's axes. */
enum status matcher_add(struct matcher *m, const struct camera_set *set, int view_idx, int neighbour_idx,
                        const struct observed_points *seen, double typical, const struct gamma_image *reference,
                        struct gamma_image *picture, struct err *err);
/* Measures what good and chance matches cost at inverse depths from least to most. A segment that cannot be seen costs a part
 * of the way from its best match to its mean one, so that a blank one, which matches everywhere, is not drawn to where it
 * would be seen. A neighbour that tells good from chance far less than the best one is left out. To be called once, after the last neighbour and before the first cost. */
enum status matcher_calibrate(struct matcher *m, double least, double most, struct err *err);
void matcher_release(struct matcher *m);

/* hidden: bit k is set if neighbour k cannot see the segment there, which then costs a fixed amount. */
float match_cost(const struct matcher *m, int segment, struct plane plane, unsigned hidden);
/* The same of every fourth pixel, in a fourth of the time. */
float match_cost_rough(const struct matcher *m, int segment, struct plane plane, unsigned hidden);
/* Has the pictures of the segment on the plane fetched from memory, for a match_cost() that follows soon. */
void match_prefetch(const struct matcher *m, int segment, struct plane plane);

/* Pixels by which a neighbour's picture of the view shifts when 1/z goes from least to most: the largest over the
 * neighbours, each at the upper quartile of a grid of the view's pixels. */
double matcher_shift(const struct matcher *m, double least, double most);

#endif
