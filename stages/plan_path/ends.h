/* ends.h - where a move starts and ends (thesis 3.4.2, "Maximizing parallax"), among the valid viewpoints.
 *
 * A cell of the start's region gives a candidate for the start, its nearest or farthest valid z as the move goes, and
 * one of the end's region one for the end. A pair subtends no more than max_angle at the scene's centroid, and that of
 * a dolly in or out goes at least half of its length in or out. Of the longest pairs the one with most parallax is the
 * thesis' answer, which had to draw the scene anew for every pair. Here a cell is drawn once, and then comparing two
 * pictures costs less than a millisecond: so all pairs are compared.
 *
 * Every frame's place on the way is looked at too, not the ends alone: of the pairs with most parallax the first whose
 * way is valid all along is taken; if there is none, the thesis' answer is drawn together towards the origin until it
 * is.
 *
 * From there the ends leave the grid: by Levenberg-Marquardt (Ceres) on a smooth surrogate - for the parallax how far
 * the two sides of every depth edge of the origin's picture part between the two cameras, for the limits penalties that
 * rise beyond them, the regions interpolated between cells -, of which so much is taken as the real viewpoints and the
 * real parallax bear out; then by small moves of one end along one axis, each of which has to give more parallax. */
#ifndef REMODEL_ENDS_H
#define REMODEL_ENDS_H

#include "common/film/validity.h"
#include "stages/plan_path/plan_params.h"

struct move_ends {
    struct vec3 at[2];
    double length;            /* scene units */
    double angle;             /* degrees, at the scene's centroid */
    double parallax;          /* stages/plan_path/parallax.h */
    double worst_h, worst_at; /* along the way; at: 0 start .. 1 end */
    double worst_outside;
    bool valid; /* all along */
};

struct ends_notes {
    struct move_ends discrete; /* the thesis' answer: of the longest pairs the one with most parallax, valid or not */
    int longest;               /* of them */
    int pairs;                 /* measured in all */
    int chosen;   /* which of them, by parallax, is valid all along: 0 is the best; -1: none, drawn together */
    bool refined; /* the ends have left the grid */
    long renders;
};

#define WAY_PLACES 25 /* where viewpoints are looked at along the way; if all are valid, at every frame's place too */

/* How much of the way is done at the i-th of `count` frames, 0 to 1. */
double ends_part(int i, int count, const char *ease);

enum status ends_choose(struct move_ends *best, struct ends_notes *notes, const struct layer_scene *scene,
                        const struct validity *v, const struct plan_params *params, struct err *err);

/* Tells of the ends in e->at all that ends_choose tells. */
enum status ends_measure(struct move_ends *e, const struct layer_scene *scene, const struct validity *v,
                         const struct plan_params *params, struct err *err);

/* The candidate of a cell for one end of the move. */
struct vec3 ends_candidate(const struct validity *v, int end, int cell);

#endif
