/* estimate.h - how long depth will take and how much memory, told before it begins.
 *
 * An estimate, from what was measured (estimate.c): good to a third or so on a machine like the one measured on. */
#ifndef REMODEL_ESTIMATE_H
#define REMODEL_ESTIMATE_H

#include <stdio.h>

#include "common/capture/camera_set.h"
#include "stages/segment_depth/segment_params.h"

struct depth_work {
    double core_seconds, mib; /* of one view in one round; MiB at most at a time */
};
/* pixels: of the view; neighbours: that it is really matched with; first: the round has none before it. */
struct depth_work depth_work(double pixels, int neighbours, bool first, const struct segment_params *params);

/* Of one view of a scene. *neighbours: how many it will be matched with, 0: none can be. */
enum status view_work(struct depth_work *work, int *neighbours, const struct camera_set *set, int view_idx, bool first,
                      const struct segment_params *params, struct err *err);

/* Prints what the views of a list will take: a text file with a line "VIEW ROUND" for every view and round still to be made. jobs: how
 * many of them go on at a time, with all threads each; 0: on a cluster. No line: prints nothing. */
enum status tell_work(FILE *to, const char *list, const struct camera_set *set, int jobs,
                      const struct segment_params *params, struct err *err);

/* Says so of one view, if that is long or large; warns if it is more than the machine has free. */
enum status note_work(const struct camera_set *set, int view_idx, bool first, const struct segment_params *params,
                      struct err *err);

#endif
