/* ends.h - choice of a move's two ends among the valid viewpoints, for the most parallax [Colburn 2014, 3.4.2].
 *
 * "Path" is the way of the camera between the two ends. */
#ifndef REMODEL_ENDS_H
#define REMODEL_ENDS_H

#include "common/film/validity.h"
#include "stages/plan_path/plan_params.h"

struct move_ends {
    struct vec3 at[2];        /* start, end; world */
    double length;            /* scene units */
    double angle;             /* degrees, at the scene's centroid */
    double parallax;          /* stages/plan_path/parallax.h */
    double worst_h, worst_at; /* largest H on the path, and where: 0 start .. 1 end */
    double worst_outside;     /* largest on the path (struct viewpoint) */
    bool valid;               /* everywhere on the path */
};

struct ends_notes {
    struct move_ends discrete; /* the thesis's result: the longest pairs' best by parallax, valid or not */
    int longest;               /* number of those pairs */
    int pairs;                 /* number of pairs whose parallax was measured */
    int chosen;   /* rank by parallax of the pair that the ends began as; 0: the best; -1: none, ends were drawn in */
    bool refined; /* the ends are off the grid */
    long renders; /* number of depth pictures rendered */
};

/* Samples of a path in the first test of its validity; the frames' positions follow if it passes. */
#define PATH_SAMPLES 25

/* Fraction of the path that is done at frame i of `count`, 0 to 1. ease: "none" or "smooth". */
double path_fraction(int i, int count, const char *ease);

/* Chooses the ends. notes->renders counts from 0. ST_DATA: no cell of a region is valid. Same bits for any number of
 * threads. */
enum status ends_choose(struct move_ends *best, struct ends_notes *notes, const struct layer_scene *scene,
                        const struct validity *v, const struct plan_params *params, struct err *err);

/* Fills the rest of e for the ends e->at. */
enum status ends_measure(struct move_ends *e, const struct layer_scene *scene, const struct validity *v,
                         const struct plan_params *params, struct err *err);

/* Where a cell's candidates lie: as near as is valid or as far back, as the move requires, or opposite. */
enum side { SIDE_OWN, SIDE_OTHER };

/* The candidate viewpoint of a cell for one end of the move. */
struct vec3 ends_candidate(const struct validity *v, int end, int cell, enum side side);

#endif
