/* trace_estimate.h - time, memory and bytes that views will take, before they are traced. */
#ifndef REMODEL_TRACE_ESTIMATE_H
#define REMODEL_TRACE_ESTIMATE_H

#include <stdio.h>

#include "common/base/work_estimate.h"
#include "common/capture/camera_set.h"

enum trace_kind { TRACE_IDS, TRACE_REVEAL };

/* Adds what a view takes, on one core of the machine on which the constants were measured. */
void estimate_view(struct work_estimate *w, const struct view *view, enum trace_kind kind, int edits);

/* Prints a sentence, and the line of common/base/work_estimate.h, for the lines "VIEW ids" or "VIEW reveal" of the file
 * `list`. edits: how many models reveal something. views: the folder of the cameras, for messages. ST_USAGE: there is
 * no such view. */
enum status estimate_print(FILE *to, const char *list, const struct camera_set *set, const char *views, int edits,
                           struct err *err);

#endif
