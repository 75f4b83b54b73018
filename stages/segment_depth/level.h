/* level.h - a view and its neighbours in one size of their pictures: the full one, or half of it. */
#ifndef REMODEL_LEVEL_H
#define REMODEL_LEVEL_H

#include "stages/segment_depth/plane_match.h"

struct level {
    struct camera_set set; /* borrowed, except `views` of a halved level */
    struct observed_points seen;
    struct gamma_image gamma; /* the view's picture */
    struct segmentation segments;
    struct matcher matcher;
    bool halved;
};

/* The cameras, the points and the picture of `full` in half the size; segments and matcher stay empty. half is {0} on
 * entry; release it also after a failure (ST_NOMEM). */
enum status level_halve(struct level *half, const struct level *full, struct err *err);

/* Adds a neighbour to the matcher of `full`, and to that of `half` unless it is NULL, as matcher_add() does. picture:
 * in the full size; changed. ST_NOMEM. */
enum status level_add(struct level *full, struct level *half, int view_idx, int neighbour_idx, double typical,
                      struct gamma_image *picture, struct err *err);

void level_release(struct level *l);

#endif
