/* parallel.c - every index runs once, in the same chunks for any number of threads. */
#include "tests/unit/scratch.h"

#include <omp.h>

#include "common/base/parallel.h"

enum { COUNT = 10007 };

struct loop {
    int visits[COUNT];
    size_t ends[COUNT]; /* end of the chunk that begins here */
    double sums[COUNT]; /* sum of that chunk */
    int max_thread;
    int busy[64]; /* calls running under a thread number */
    int shared;   /* a thread number was used twice at a time */
};

static void visit(void *ctx, size_t begin, size_t end, int thread)
{
    struct loop *l = ctx;

    if (__atomic_exchange_n(&l->busy[thread], 1, __ATOMIC_ACQ_REL)) __atomic_store_n(&l->shared, 1, __ATOMIC_RELAXED);
    l->ends[begin] = end;
    for (size_t i = begin; i < end; i++) {
        l->visits[i]++;
        l->sums[begin] += 1.0 / (double)(i + 1);
    }
    if (thread > __atomic_load_n(&l->max_thread, __ATOMIC_RELAXED))
        __atomic_store_n(&l->max_thread, thread, __ATOMIC_RELAXED);
    __atomic_store_n(&l->busy[thread], 0, __ATOMIC_RELEASE);
}

static struct loop *run_loop(size_t count, size_t chunk, int threads)
{
    struct loop *l = calloc(1, sizeof *l);

    assert_non_null(l);
    parallel_set_threads(threads);
    parallel_for(count, chunk, visit, l);
    assert_true(l->max_thread < threads);
    assert_false(l->shared);
    return l;
}

static void chunks_do_not_depend_on_threads(void **state)
{
    static const size_t counts[] = {0, 1, 7, 8, 9, COUNT}, chunks[] = {1, 8, 100, 20000, SIZE_MAX};

    (void)state;
    for (size_t a = 0; a < sizeof counts / sizeof *counts; a++) {
        for (size_t b = 0; b < sizeof chunks / sizeof *chunks; b++) {
            struct loop *one = run_loop(counts[a], chunks[b], 1), *many = run_loop(counts[a], chunks[b], 7);
            for (size_t i = 0; i < COUNT; i++) assert_int_equal(one->visits[i], i < counts[a]);
            assert_memory_equal(one->visits, many->visits, sizeof one->visits);
            assert_memory_equal(one->ends, many->ends, sizeof one->ends);
            assert_memory_equal(one->sums, many->sums, sizeof one->sums);
            for (size_t i = 0; i < counts[a]; i = one->ends[i]) assert_true(one->ends[i] - i <= chunks[b]);
            free(one);
            free(many);
        }
    }
    parallel_set_threads(0);
}

struct nest {
    int threads[64]; /* of inner calls, by outer index */
    int inner[64];
};

static void inner_loop(void *ctx, size_t begin, size_t end, int thread)
{
    int *seen = ctx;

    if (seen[0] != thread) seen[0] = -1;
    seen[1] += (int)(end - begin);
}

static void outer_loop(void *ctx, size_t begin, size_t end, int thread)
{
    struct nest *n = ctx;

    for (size_t i = begin; i < end; i++) {
        int seen[2] = {thread, 0};
        parallel_for(100, 3, inner_loop, seen);
        n->threads[i] = seen[0] == thread;
        n->inner[i] = seen[1];
    }
}

static void nested_loops_keep_their_thread_number(void **state)
{
    struct nest n = {0};

    (void)state;
    parallel_set_threads(4);
    parallel_for(64, 1, outer_loop, &n);
    parallel_set_threads(0);
    for (int i = 0; i < 64; i++) {
        assert_int_equal(n.threads[i], 1);
        assert_int_equal(n.inner[i], 100);
    }
}

static void the_thread_count_can_be_set(void **state)
{
    (void)state;
    parallel_set_threads(5);
    assert_int_equal(parallel_threads(), 5);
    parallel_set_threads(0);
    assert_int_equal(parallel_threads(), omp_get_num_procs());
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(chunks_do_not_depend_on_threads),
        cmocka_unit_test(nested_loops_keep_their_thread_number),
        cmocka_unit_test(the_thread_count_can_be_set),
    };

    return cmocka_run_group_tests_name("parallel", tests, NULL, NULL);
}
