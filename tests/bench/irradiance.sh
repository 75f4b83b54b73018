# irradiance.sh - error of irradiance at 35 points against time, by estimator, on fields of light that are known.
#
# Cases: patch, a square light over a plane (closed form); box, six sides of different radiance (closed form); window, a
# quad of 1 % of the hemisphere, 1000 times as bright as all else (closed form); sun, points across the penumbra of a sun
# of 0.5 degrees; room, a closed room with two boxes, a lamp and a window, whose surfaces have known radiance. The last two
# are compared with converged runs of 2^21 rays. error: root mean square over the points of the relative error of the
# luminance. seconds: wall time of all points with one thread per core.
#
# Series: hemicube, n x n pixels; rays, towards emitters and by the cosine; blind rays, by the cosine alone. BENCH_CASES
# ("patch box window sun room") chooses cases.
title="Irradiance at 35 points: error against time"
note="Lower left is better. A trusted simulator, in a room of its own: 0.28 % in 0.70 s, 0.13 % in 0.99 s, 0.047 % in 7.4 s."
baseline=hemicube
match=case
line=series label=effort panel=case across=3
x=core_s x_label="Core-seconds of all points" y_label="Relative RMS error"
timed="core_s rays_per_core_s"
slope="rays core_s"
repeats=3

cases=${BENCH_CASES:-patch box window sun room}

prepare()
{
    local c
    [ -x "$B/tests/bench/irradiance" ] || missing "there is no program $B/tests/bench/irradiance; this revision cannot be measured."
    for c in $cases; do
        "$B/tests/bench/irradiance" --case "$c" --converge "$fast/$c.txt" 2>"$work/err" || { tail -n 3 "$work/err" >&2; missing "the truth of $c could not be made."; }
    done
}

settings()
{
    local c n
    printf 'series\tcase\teffort\n'
    for c in $cases; do
        for n in 32 64 128 256 512 1024; do printf 'hemicube\t%s\t%s\n' "$c" "$n"; done
        for n in 256 1024 4096 16384 65536; do printf 'rays\t%s\t%s\nblind rays\t%s\t%s\n' "$c" "$n" "$c" "$n"; done
    done
}

sample() # SERIES CASE EFFORT
{
    measured "$B/tests/bench/irradiance" --case "$2" --estimator "${1%% *}" --effort "$3" --truth "$fast/$2.txt"
}
