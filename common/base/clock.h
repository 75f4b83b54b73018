/* clock.h - elapsed time, for log lines only: never in products. */
#ifndef REMODEL_CLOCK_H
#define REMODEL_CLOCK_H

#include <time.h>

static inline double clock_read(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Seconds since an arbitrary start; monotonic. */
static inline double clock_seconds(void) { return clock_read(CLOCK_MONOTONIC); }

/* CPU seconds of all threads of this process. */
static inline double clock_cpu_seconds(void) { return clock_read(CLOCK_PROCESS_CPUTIME_ID); }

#endif
