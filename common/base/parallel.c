/* parallel.c - parallel loops on OpenMP. */
#include "common/base/parallel.h"

#include <assert.h>
#include <omp.h>

static int thread_count; /* 0: not set */

void parallel_set_threads(int threads) { thread_count = threads > 0 ? threads : 0; }

int parallel_threads(void) { return thread_count ? thread_count : omp_get_num_procs(); }

void parallel_for(size_t count, size_t chunk, void (*fn)(void *ctx, size_t begin, size_t end, int thread), void *ctx)
{
    assert(chunk > 0);
    const size_t chunks = count / chunk + (count % chunk != 0);
    const size_t limit = (size_t)parallel_threads();
    const int threads = (int)(chunks < limit ? chunks : limit);

    if (threads <= 1 || omp_in_parallel()) {
        /* a nested loop keeps its thread's number, so that it uses that thread's scratch memory */
        const int thread = omp_get_thread_num();
        for (size_t c = 0; c < chunks; c++)
            fn(ctx, c * chunk, count - c * chunk > chunk ? (c + 1) * chunk : count, thread);
        return;
    }
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
    for (size_t c = 0; c < chunks; c++)
        fn(ctx, c * chunk, count - c * chunk > chunk ? (c + 1) * chunk : count, omp_get_thread_num());
}
