# matching.sh - time of an exact search for nearest descriptors by their number, beside the peak of the processor.
#
# N x N random descriptors of 128 bytes, one thread (tests/bench/matching.c). `plain` is a loop in C as the compiler makes it.
# The baseline, peak, is the same number of multiplications and additions with nothing else: the ratio says how many times as
# long the search takes. products: multiply-adds, 10^9. BENCH_SIZES ("1024 2048 4096 8192") chooses others.
title="Exact search for nearest descriptors: time against their number"
note="One thread; 128 bytes a descriptor."
baseline=peak
match="size"
rate=products
line=series label=size
x=size x_label="Descriptors of each picture" y=seconds y_label="CPU time (s)"
repeats=3

settings()
{
    printf 'series\tsize\n'
    for size in ${BENCH_SIZES:-1024 2048 4096 8192}; do
        printf 'peak\t%s\nremodel\t%s\n' "$size" "$size"
        [ "$size" -gt 4096 ] || printf 'plain\t%s\n' "$size"
    done
}

prepare()
{
    [ -x "$B/tests/bench/matching" ] || missing "$B/tests/bench/matching is missing: this revision cannot match descriptors."
}

sample() # SERIES SIZE
{
    measured "$B/tests/bench/matching" --series "$1" --size "$2"
}
