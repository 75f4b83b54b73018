/* parallel.h - loops over fixed chunks, with the same result for any number of threads.
 *
 * Chunks are cut by `chunk` alone, never by the number of threads, so partial sums kept per chunk and added in chunk
 * order are reproducible. */
#ifndef REMODEL_PARALLEL_H
#define REMODEL_PARALLEL_H

#include <stddef.h>

void parallel_set_threads(int threads); /* 0: as many as there are cores */
int parallel_threads(void);

/* fn(ctx, begin, end, thread) over [0, count) in chunks of `chunk`; thread in [0, parallel_threads()) is for scratch
 * memory only. Nested calls run serially. */
void parallel_for(size_t count, size_t chunk, void (*fn)(void *ctx, size_t begin, size_t end, int thread), void *ctx);

#endif
