# lamps.sh - how near fitted lamps are to those of simulated rooms, and how often their intervals hold the truth.
#
# tests/bench/lamps.c says what the rooms are. error: median relative error of radiance. covered: the fraction of
# intervals of 95 % that hold the truth. BENCH_ROOMS (200), BENCH_OUTLIERS ("0 10 20": per cent of the marks).
title="Lamps from marks"
note="Random rooms of one to three lamps, of whose marks some are on posters, in shade or in the sun."
line=series label=outliers
x=outliers x_label="Marks that are off (per cent)" y=error y_label="Median relative error of radiance"
repeats=1

settings()
{
    printf 'series\toutliers\n'
    for outliers in ${BENCH_OUTLIERS:-0 10 20}; do printf 'lamps\t%s\n' "$outliers"; done
}

prepare()
{
    [ -x "$B/tests/bench/lamps" ] || missing "there is no program $B/tests/bench/lamps; this revision fits no marks."
}

sample() # SERIES OUTLIERS
{
    measured "$B/tests/bench/lamps" --outliers "$2" --rooms "${BENCH_ROOMS:-200}"
}
