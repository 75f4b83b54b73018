# simulate.sh - noise of simulate against time: relative RMS error of one photo against its own converged run.
#
# The converged run has 16 times the samples of the last setting and another seed. Error: the root of the mean over
# pixels and channels of ((v - t) / (t + m / 100))^2, where t is the converged value and m the mean of all: relative, so
# that a window does not outweigh the room. The baseline is the path tracer before paths were shared between pixels:
# revision 05cdbe1, whose seconds and errors are in simulate_before.tsv, measured on the machine that it names. Give
# BENCH_BEFORE=PROGRAM, simulate of that or another revision, to measure it here instead; other settings need it.
# BENCH_SCENE (scenes/loft), BENCH_PHOTO (the second), BENCH_SAMPLES ("1 4 16 32") and BENCH_SCALE (0.25 of the photo's
# size) set other values.
title="simulate: noise against time"
note="Error relative to a converged run. Points: samples per pixel."
baseline="unshared paths"
match=samples
line=series label=samples
x_label="Time of one photo (s)" y_label="Relative RMS error"
slope="samples seconds"

scene=${BENCH_SCENE:-scenes/loft}
counts=${BENCH_SAMPLES:-1 4 16 32}
before=$here/simulate_before.tsv

render() # PROGRAM SAMPLES SEED FOLDER
{
    measured "$1" --scene "$scene" --photo "$photo" --out "$4" --set "samples=$2" --set "seed=$3" --set "scale=${BENCH_SCALE:-0.25}"
}

# The table applies to the default scene, photo and size.
use_table() { [ -z "${BENCH_BEFORE-}${BENCH_SCENE-}${BENCH_PHOTO-}${BENCH_SCALE-}" ]; }

prepare()
{
    [ -x "$B/bin/simulate" ] || missing "there is no program $B/bin/simulate; this revision cannot render described scenes."
    [ -e "$scene/scene.txt" ] || missing "there is no $scene/scene.txt; set BENCH_SCENE=DIR to the folder of a described scene."
    [ -z "${BENCH_BEFORE-}" ] || [ -x "$BENCH_BEFORE" ] || missing "BENCH_BEFORE=$BENCH_BEFORE is not a program; give simulate of another revision."
    photo=${BENCH_PHOTO:-$(awk '$1 == "photo" && ++n <= 2 { p = $2 } END { print p }' "$scene/cameras.txt")}
    [ -n "$photo" ] || missing "$scene/cameras.txt has no photo."
    render "$B/bin/simulate" $((16 * ${counts##* })) 2 "$work/converged" >/dev/null || { tail -n 5 "$work/err" >&2; missing "the converged run failed."; }
}

settings()
{
    printf 'series\tsamples\n'
    for n in $counts; do
        printf 'simulate\t%s\n' "$n"
        if [ -n "${BENCH_BEFORE-}" ] || { use_table && awk -v n="$n" '$1 == n { found = 1 } END { exit !found }' "$before"; }; then
            printf 'unshared paths\t%s\n' "$n"
        fi
    done
}

sample() # SERIES SAMPLES
{
    local program=$B/bin/simulate
    if [ "$1" != simulate ]; then
        if [ -z "${BENCH_BEFORE-}" ]; then
            awk -v n="$2" '$1 == n { printf "seconds %s\npeak_mib %s\nerror %s\nunit 1\n", $2, $3, $4 }' "$before"
            return
        fi
        program=$BENCH_BEFORE
    fi
    rm -rf "$work/noisy"
    render "$program" "$2" 1 "$work/noisy" >/dev/null || return
    "$B/tests/bench/picture_error" "$work/noisy/truth/hdr/$photo.exr" "$work/converged/truth/hdr/$photo.exr" >"$work/error" 2>"$work/err" || return
    cat "$work/use" "$work/error"
    awk -v n="$2" '$1 == "pixels" { printf "paths %.9g\n", $2 * n }' "$work/error"
}
