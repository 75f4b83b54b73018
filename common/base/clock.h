/* clock.h - how long things take. Only for what is told to people, never in products. */
#ifndef REMODEL_CLOCK_H
#define REMODEL_CLOCK_H

#include <time.h>

static inline double clock_read(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Seconds, from a beginning of no meaning; never set back. */
static inline double clock_seconds(void) { return clock_read(CLOCK_MONOTONIC); }

/* Processor seconds of all threads of this process. */
static inline double clock_cpu_seconds(void) { return clock_read(CLOCK_PROCESS_CPUTIME_ID); }

#endif
