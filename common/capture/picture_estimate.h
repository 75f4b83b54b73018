/* picture_estimate.h - what processes that draw pictures of a scene will take, by the pixels of the pictures. */
#ifndef REMODEL_PICTURE_ESTIMATE_H
#define REMODEL_PICTURE_ESTIMATE_H

#include <stdio.h>

#include "common/base/err.h"

struct picture_cost {
    double process_seconds, seconds; /* core-seconds of a process; of a million pixels */
    double process_mib, mib;         /* of a process; of a million pixels of its largest picture */
    double bytes;                    /* of a million pixels */
};

/* Prints the line of common/base/work_estimate.h. list: a file with a line `process NAME...` for each process, the
 * names of its pictures. A name that the folder `views` does not have, such as that of a frame of a film, and a line
 * without names count as a picture of the views' mean size. ST_DATA: the folder has no cameras. */
enum status picture_estimate_print(FILE *to, const char *list, const char *views, const struct picture_cost *cost,
                                   struct err *err);

#endif
