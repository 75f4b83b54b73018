# solve.sh - time and error of gradient solves by the size of the picture: multigrid against sparse Cholesky factors.
#
# Pictures of N x N pixels are composed of 4 sources (tests/bench/solve.c). `weak`: only data of weight 1e-5, as in a
# texture that is seen orthogonally; `half`: about half the pixels are fixed, in patches; `rough`: four differences of
# five have weight 1e-5; `parts`: many small parts. One thread.
#
# The baseline, direct, is CHOLMOD. seconds: CPU time of the fastest of the solves in half a second; error: the largest
# difference from the direct solution, over the range of its values; peak_mib: of the process, with the picture.
# BENCH_SIZES ("32 128 256 512 1024") and BENCH_KINDS ("weak half rough parts") choose others.
title="Gradient solves: time against size"
note="Four sources, three channels; one thread."
baseline=direct
match="kind size"
line=series label=size panel=kind
x=free x_label="Unknowns" y=seconds y_label="CPU time of a solve (s)"
repeats=3

settings()
{
    printf 'series\tkind\tsize\n'
    for kind in ${BENCH_KINDS:-weak half rough parts}; do for size in ${BENCH_SIZES:-32 128 256 512 1024}; do
        printf 'multigrid\t%s\t%s\ndirect\t%s\t%s\n' "$kind" "$size" "$kind" "$size"
    done; done
}

prepare()
{
    [ -x "$B/tests/bench/solve" ] || missing "there is no program $B/tests/bench/solve; this revision has no gradient solves."
}

sample() # SERIES KIND SIZE
{
    measured "$B/tests/bench/solve" --solver "$1" --kind "$2" --size "$3"
}
