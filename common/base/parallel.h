/* parallel.h - parallel loops with the same result for any number of threads.
 *
 * The range is divided by `chunk` alone, never by the number of threads: sums kept per chunk and added in chunk order
 * are reproducible. */
#ifndef REMODEL_PARALLEL_H
#define REMODEL_PARALLEL_H

#include <stddef.h>

void parallel_set_threads(int threads); /* 0: one per core */
int parallel_threads(void);

/* Calls fn(ctx, begin, end, thread) for the chunks of [0, count). `thread`, in [0, parallel_threads()), may select
 * scratch memory only. Nested calls run serially. */
void parallel_for(size_t count, size_t chunk, void (*fn)(void *ctx, size_t begin, size_t end, int thread), void *ctx);

#endif
