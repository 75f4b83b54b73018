/* progress.h - progress of a long step: count, rate, time left.
 *
 * On a terminal, one line is redrawn a few times a second. In a log (stderr is not a terminal), a line is printed every
 * ten seconds and at the end of steps that take longer. progress_add() may be called from several threads. */
#ifndef REMODEL_PROGRESS_H
#define REMODEL_PROGRESS_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

struct progress {
    const char *what, *unit; /* "plane sweep", "planes"; pointers are kept */
    int64_t total;
    atomic_llong done;
    double started, drawn; /* time of the start and of the last line, s, monotonic */
    atomic_flag drawing;
    bool terminal;
};

void progress_start(struct progress *p, const char *what, int64_t total, const char *unit);
void progress_add(struct progress *p, int64_t n);
void progress_end(struct progress *p); /* idempotent */

#endif
