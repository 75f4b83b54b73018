/* import_params.h - the stage's parameters. */
#ifndef REMODEL_IMPORT_PARAMS_H
#define REMODEL_IMPORT_PARAMS_H

#include "common/base/param.h"

/* name, type, default, least, most, unit, help */
#define IMPORT_PARAMS(X)                                                                                        \
    X(brackets, choice, "auto", 0, 0, "auto|yes|single|no",                                                     \
      "photos are exposures of the same views; auto: if brackets.txt says so or their exposures form a cycle; " \
      "single: each "                                                                                           \
      "photo is a view's only exposure")                                                                        \
    X(split_border, int, 0, 0, 100000, "px", "with SPLIT: what surrounds the pictures of a photo on all sides") \
    X(split_gap, int, 0, 0, 100000, "px", "with SPLIT: what lies between two pictures of a photo")              \
    X(split_dark, int, 0, 0, 254, "",                                                                           \
      "with SPLIT: pictures are parted by straight lines as dark as this, of 255 in sRGB; 0: none are looked for")

struct import_params {
    IMPORT_PARAMS(PARAM_FIELD)
};
#define IMPORT_PARAMS_DEFAULT        \
    {                                \
        IMPORT_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param import_param_table[];

/* ST_USAGE: border or gap is given and dark lines are to be found, too. */
enum status import_params_check(const void *params, struct err *err);

#endif
