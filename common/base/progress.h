/* progress.h - how far a long step is, its rate, and the time left.
 *
 * On a terminal one line is redrawn a few times a second; in a log (stderr is not a terminal) a plain line comes
 * every ten seconds and at the end of steps that took longer than that. Safe to call from several threads. */
#ifndef REMODEL_PROGRESS_H
#define REMODEL_PROGRESS_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

struct progress {
    const char *what, *unit; /* "plane sweep", "planes" */
    int64_t total;
    atomic_llong done;
    double started, shown; /* seconds, monotonic */
    atomic_flag drawing;
    bool terminal;
};

void progress_start(struct progress *p, const char *what, int64_t total, const char *unit);
void progress_add(struct progress *p, int64_t n);
void progress_end(struct progress *p); /* idempotent */

#endif
