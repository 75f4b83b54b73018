/* exposure_list.h - exposures.txt: how photographs were exposed, as people write it down.
 *
 *   FILE SECONDS [F_NUMBER ISO [FILTER]]
 * a line a photo. FILTER is a neutral density filter's factor, 1000 letting a thousandth pass. What is not written, or
 * written as 0, is taken from EXIF. No exposure can be told without SECONDS. */
#ifndef REMODEL_EXPOSURE_LIST_H
#define REMODEL_EXPOSURE_LIST_H

#include "common/base/err.h"

struct exposure {
    double seconds, f_number, iso; /* 0: not stated */
    double filter;                 /* factor; 1 without one */
};

/* How much light counts: seconds x ISO / (f-number^2 x filter). An f-number or ISO that is not stated is left out, so
 * only exposures that state the same can be compared. 0 without seconds. */
double exposure_value(const struct exposure *e);

struct exposure_line {
    char *file; /* owned */
    struct exposure exposure;
    int line; /* of the file, from 1 */
};

struct exposure_list {
    char *path; /* owned */
    struct exposure_line *lines;
    int count;
};

/* ST_DATA with file and line: a photo twice, a number that is negative, seconds or filter of 0. {0} is the empty list. */
enum status exposure_list_read(struct exposure_list *list, const char *path, struct err *err);
void exposure_list_release(struct exposure_list *list);

#endif
