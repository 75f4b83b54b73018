/* place_line.h - walls from lines in photographs: where a wall meets the floor or the ceiling.
 *
 * A pixel of such a line has a known height, so its ray gives its position without any point of the wall. What a click
 * that is a little off does to the position is carried along, as a covariance: it grows with the square of the distance
 * and is largest away from the camera. */
#ifndef REMODEL_BUILD_MODEL_PLACE_LINE_H
#define REMODEL_BUILD_MODEL_PLACE_LINE_H

#include "stages/build_model/place/place.h"

struct placed_corner { /* a pixel's place in plan */
    const char *view;  /* as the script has it; with x, y for messages */
    double x, y;       /* px */
    double p[2], camera[2];
    double xx, xy, yy; /* covariance of p for clicks with the standard error `click` */
};

enum place_level { PLACE_ON_FLOOR, PLACE_ON_CEILING };

/* Where the pixel's ray meets the horizontal plane at height z, a floor or a ceiling. ST_DATA: unknown view, a pixel
 * outside the photo or at the wrong side of the horizon, a camera below the floor or above the ceiling. */
enum status place_corner(struct placed_corner *corner, const struct placer *placer, const struct script_corner *pixel,
                         double z, enum place_level level, const char *path, int line, struct err *err);

struct placed_line {
    double d[2], c;    /* in face: n p = c with n = (d.y, -d.x), d from start to end */
    double ends[2][2]; /* the most probable places of the two corners on it */
    double turn;       /* degrees between d and the direction from corner to corner */
    double turn_error; /* degrees, standard error of that for clicks */
    double max_turn;   /* above which `turn` is too large for clicks and the photos' errors */
    double error;      /* standard error of c for clicks */
};

/* The line through two corners, its start and its end. along: its direction, of either sign; NULL: the nearest axis.
 * is_free: the direction from corner to corner; then `turn` is 0. ST_DATA: both are at one place. */
enum status place_line(struct placed_line *line, const struct placer *placer, const struct placed_corner *start,
                       const struct placed_corner *end, const double along[2], bool is_free, const char *path,
                       int number, struct err *err);

#endif
