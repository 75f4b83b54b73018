/* depth_estimate.h - time and memory that depth will take, estimated beforehand from measured constants.
 *
 * Accurate to about a third on a machine like the one that was measured (depth_estimate.c). */
#ifndef REMODEL_DEPTH_ESTIMATE_H
#define REMODEL_DEPTH_ESTIMATE_H

#include <stdio.h>

#include "common/capture/camera_set.h"
#include "stages/segment_depth/segment_params.h"

struct depth_work {
    double core_seconds, mib, bytes; /* of one view in one round; mib: peak memory; bytes: written */
};

/* pixels: of the view; neighbours: number of views that it is matched with; first: whether this is the first round. */
struct depth_work depth_work(double pixels, int neighbours, bool first, const struct segment_params *params);

/* Work of one view of a scene. *neighbours: how many views it will be matched with; 0 if there is none. */
enum status estimate_view(struct depth_work *work, int *neighbours, const struct camera_set *set, int view_idx,
                          bool first, const struct segment_params *params, struct err *err);

/* Prints the work of the views in a list: a text file with a line "VIEW ROUND" for every view and round that is still
 * to be made. First a sentence, then the line of work_estimate.h. jobs: number of views made at a time, each with all
 * threads; 0: on a cluster. Prints nothing for an empty list. */
enum status estimate_print(FILE *to, const char *list, const struct camera_set *set, int jobs,
                           const struct segment_params *params, struct err *err);

/* Prints what is known before there are cameras, "foresee LOW HIGH MIB BYTES": core-seconds of all rounds with two
 * neighbours a view and only the first round, and with all neighbours and rounds; peak memory of a view; bytes written.
 * list: a file of lines "WIDTH HEIGHT", the views. */
enum status estimate_foresee(FILE *to, const char *list, const struct segment_params *params, struct err *err);

/* Logs the work of one view if it is long or large; warns if it exceeds the free memory. */
enum status estimate_log(const struct camera_set *set, int view_idx, bool first, const struct segment_params *params,
                         struct err *err);

#endif
