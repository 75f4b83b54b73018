/* colmap_progress.h - progress of a command of COLMAP, from the log that it is writing. */
#ifndef REMODEL_COLMAP_PROGRESS_H
#define REMODEL_COLMAP_PROGRESS_H

#include <stdbool.h>
#include <stdio.h>

#include "common/base/progress.h"

struct colmap_progress {
    struct progress *progress;
    const char *path, *mark; /* the log; a line counts if it contains the mark */
    bool numbered;           /* the count is the largest number in parentheses after a mark (of the mapper: photos that
                                it has tried to place); else each line counts 1 */
    long read;               /* bytes */
    long long count;
};

/* Follows the log at `path` from its present end on; it may be missing. Its counts are added to `progress`, which other
 * logs may share. The pointers are kept. */
void colmap_progress_start(struct colmap_progress *p, struct progress *progress, const char *path, const char *mark,
                           bool numbered);
/* Reads what is new; p is a struct colmap_progress, for process_run_watched(). */
void colmap_progress_tick(void *p);

#endif
