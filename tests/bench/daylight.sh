# daylight.sh - error of daylight factors against time, by estimator, in a room whose truth is a closed form.
#
# 25 points of a work plane, a window without glass, the overcast sky (tests/bench/daylight.c). `levels` is what `make lux`
# uses, whose rays give the light of all patches of the sky and of as many suns at once; hemicube: a plain hemicube, n x n
# pixels; cosine: rays by the cosine. One thread. error: root mean square over the points of the relative error. The patches
# have one luminance each, which is what is left of the error of `levels` with many rays.
title="Daylight factors at 25 points: error against time"
note="An unglazed window below the overcast sky; black walls."
baseline=hemicube
match=
line=series label=effort
x=seconds x_label="Core-seconds of all points" y=error y_label="Relative RMS error"
repeats=3

settings()
{
    printf 'series\teffort\n'
    for n in 32 64 128 256; do printf 'hemicube\t%s\n' $n; done
    for n in 128 512 2048 8192; do printf 'levels\t%s\n' $n; done
    for n in 1024 4096 16384 65536; do printf 'cosine\t%s\n' $n; done
}

prepare()
{
    [ -x "$B/tests/bench/daylight" ] || missing "$B/tests/bench/daylight is missing; this revision computes no light levels."
}

sample() # SERIES EFFORT
{
    measured "$B/tests/bench/daylight" --series "$1" --effort "$2"
}
