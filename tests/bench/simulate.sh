# simulate.sh - noise of simulate against samples: relative RMS error of one photo against its own converged run.
#
# The converged run has 16 times the samples of the last setting and another seed. Error: the root of the mean over
# pixels and channels of ((v - t) / (t + m / 100))^2, where t is the converged value and m the mean of all: relative, so
# that a window does not outweigh the room. The baseline is the error of independent random samples: the error at the
# smallest count, falling as samples^-1/2, in simulate's own time. BENCH_SCENE (scenes/still-life), BENCH_PHOTO (the
# first), BENCH_SAMPLES ("1 4 16 64") and BENCH_SCALE (0.25 of the photo's size) set other values.
title="simulate: noise against time"
note="Error relative to a converged run. Points: samples per pixel."
baseline="independent samples"
line=series label=samples
x_label="Time of one photo (s)" y_label="Relative RMS error"
slope="samples seconds"

scene=${BENCH_SCENE:-scenes/still-life}
counts=${BENCH_SAMPLES:-1 4 16 64}

render() # SAMPLES SEED FOLDER
{
    measured "$B/bin/simulate" --scene "$scene" --photo "$photo" --out "$3" --set "samples=$1" --set "seed=$2" --set "scale=${BENCH_SCALE:-0.25}"
}

prepare()
{
    [ -x "$B/bin/simulate" ] || missing "there is no program $B/bin/simulate; this revision cannot render described scenes."
    [ -e "$scene/scene.txt" ] || missing "there is no $scene/scene.txt; set BENCH_SCENE=DIR to the folder of a described scene."
    photo=${BENCH_PHOTO:-$(awk '$1 == "photo" { print $2; exit }' "$scene/cameras.txt")}
    [ -n "$photo" ] || missing "$scene/cameras.txt has no photo."
    render $((16 * ${counts##* })) 2 "$work/converged" >/dev/null || { tail -n 5 "$work/err" >&2; missing "the converged run failed."; }
}

settings()
{
    printf 'series\tsamples\n'
    for n in $counts; do printf 'simulate\t%s\nindependent samples\t%s\n' "$n" "$n"; done
}

sample() # SERIES SAMPLES
{
    if [ "$1" != simulate ]; then # its row follows that of the sample that it uses
        awk -v n="$2" -v n0="${counts%% *}" 'FNR == NR { if ($1 == "error") e = $2; next } $1 == "seconds" || $1 == "peak_mib"
            END { printf "error %.5g\nunit 1\n", e * sqrt(n0 / n) }' "$work/error.${counts%% *}" "$work/output.$2"
        return
    fi
    rm -rf "$work/noisy"
    render "$2" 1 "$work/noisy" >"$work/output.$2" || return
    "$B/tests/bench/picture_error" "$work/noisy/truth/hdr/$photo.exr" "$work/converged/truth/hdr/$photo.exr" >"$work/error.$2" 2>"$work/err" || return
    cat "$work/output.$2" "$work/error.$2"
    awk -v n="$2" '$1 == "pixels" { printf "paths %.9g\n", $2 * n }' "$work/error.$2"
}
