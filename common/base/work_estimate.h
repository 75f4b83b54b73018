/* work_estimate.h - what the pieces of a stage's work will cost, and the line that says so to scripts.
 *
 * A stage with --estimate prints the line once, on standard output. A job array takes from it how many pieces make a
 * task, and the task's memory and time limit; `make plan` adds it up (common/run/job_plan.sh). */
#ifndef REMODEL_WORK_ESTIMATE_H
#define REMODEL_WORK_ESTIMATE_H

#include <stdio.h>

/* {0} is the estimate of no work. */
struct work_estimate {
    int items;      /* pieces of work: views, viewpoints */
    double seconds; /* core-seconds of all pieces together */
    double mib;     /* peak memory of the largest piece, MiB */
    double bytes;   /* written by all pieces together */
    double longest; /* core-seconds of the longest piece */
};

/* Adds a piece. Its numbers must be finite and not negative. */
void work_estimate_add(struct work_estimate *w, double seconds, double mib, double bytes);

/* "estimate ITEMS SECONDS MIB BYTES LONGEST", with a newline; numbers are rounded up: whole MiB and bytes,
 * milliseconds.
 */
void work_estimate_print(FILE *to, const struct work_estimate *w);

#endif
