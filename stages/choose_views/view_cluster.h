/* view_cluster.h - the views that films of a scene are made from: those that see one thing. */
#ifndef REMODEL_VIEW_CLUSTER_H
#define REMODEL_VIEW_CLUSTER_H

#include <stdbool.h>

#include "common/capture/camera_set.h"
#include "stages/choose_views/cluster_params.h"

/* Length of the mean of the unit viewing directions: 1 if all are parallel, 0 if they cancel out. */
double views_agreement(const struct camera_set *set);

struct view_cluster {
    bool *member;    /* of each view; owned; NULL: no cluster */
    int count;       /* number of members */
    int seed;        /* the view that the cluster is around */
    int central;     /* the first of central_views() of the members */
    double coverage; /* fraction of the central view's picture that shows points with parallax */
    double variety;  /* of the depths there: mean deviation of ln z from its median */
};

/* The cluster with the largest product of coverage and variety. seed: only the one around this view; -1: of all.
 * wanted[wanted_count]: views that must be members. c->member is NULL if no cluster has them or shows parallax.
 * The caller releases c, which is empty after a failure. ST_NOMEM. */
enum status view_cluster_find(struct view_cluster *c, const struct camera_set *set, int seed, const int *wanted,
                              int wanted_count, const struct cluster_params *params, struct err *err);
void view_cluster_release(struct view_cluster *c);

#endif
