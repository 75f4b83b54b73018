/* place_judge.h - whether the points in a rectangle show where a wall is. */
#ifndef REMODEL_BUILD_MODEL_PLACE_JUDGE_H
#define REMODEL_BUILD_MODEL_PLACE_JUDGE_H

#include "stages/build_model/place/place_pixels.h"

struct rectangle_wall {
    const struct placed_wall *wall; /* as it was found: its line, spread and points */
    const struct placer_photo *photo;
    const struct script_place *place;
    const struct visible_point *visible;
    size_t count;
    bool is_given; /* its direction, by the script: the points need not agree */
    bool is_free;  /* its direction is not that of an axis */
};

/* ST_DATA with the numbers and the ways out: the points are few, in few places, scattered, behind others, or of another
 * direction. */
enum status place_judge(const struct rectangle_wall *found, const struct placer *placer, const char *path, int line,
                        struct err *err);

#endif
