/* import_params.h - the stage's parameters. */
#ifndef REMODEL_IMPORT_PARAMS_H
#define REMODEL_IMPORT_PARAMS_H

#include "common/base/param.h"

/* name, type, default, minimum, maximum, unit, help */
#define PHOTO_PARAMS(X)                                                                                            \
    X(brackets, choice, "auto", 0, 0, "auto|yes|single|no",                                                        \
      "photos are several exposures of each view; auto: if brackets.txt exists or their exposures form a cycle; "  \
      "single: each photo is the only exposure of a view")                                                         \
    X(frames, int, 24, 2, 10000, "", "most frames of a clip that become photos")                                   \
    X(panoramas, choice, "auto", 0, 0, "auto|yes|no",                                                              \
      "photos of 2:1 are panoramas of 360 degrees, which become views; auto: if GPano data say so or their edges " \
      "meet")                                                                                                      \
    X(gain_map, choice, "no", 0, 0, "no|yes",                                                                      \
      "JPEGs with a gain map (Ultra HDR) become their linear HDR picture; no: the ordinary picture is used")       \
    X(split_border, int, 0, 0, 100000, "px", "with SPLIT: width of the border around all pictures of a photo")     \
    X(split_gap, int, 0, 0, 100000, "px", "with SPLIT: width of the gap between two pictures of a photo")          \
    X(split_dark, int, 0, 0, 254, "",                                                                              \
      "with SPLIT: sRGB value up to which straight lines between pictures are dark; 0: no lines, split evenly")

struct photo_params {
    PHOTO_PARAMS(PARAM_FIELD)
};
#define PHOTO_PARAMS_DEFAULT        \
    {                               \
        PHOTO_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param photo_param_table[];

/* ST_USAGE: split_dark is combined with split_border or split_gap. */
enum status photo_params_check(const void *params, struct err *err);

#endif
