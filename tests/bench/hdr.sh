# hdr.sh - how fast the exposures of a view are read and merged, by their number and by threads, and how exact the radiance is.
#
# The view is made here, 3000 x 2000 px (BENCH_SIZE=WIDTHxHEIGHT names another size), JPEGs of quality 94 with a camera's noise,
# so that its radiance is known. seconds: reading the JPEGs, looking for shifts, measuring the noise, merging; read_s, align_s,
# merge_s: the parts. Apart from that: tone_s, the picture for structure from motion without encoding it, and write_s, the EXR.
# error: median relative error of the luminance of pixels that an exposure shows well. Files are in memory where there is /dev/shm.
title="hdr_merge: time of a view against the number of its exposures"
note="Reading JPEGs, aligning, merging; writing not counted."
line="threads" label=exposures
x_label="Time of a view (s)" y=mpixels y_label="Megapixels of all exposures"
rate=mpixels
timed="read_s align_s merge_s tone_s write_s"
repeats=3

size=${BENCH_SIZE:-3000x2000}
prepare()
{
    [ -x "$B/tests/bench/hdr" ] || missing "there is no program $B/tests/bench/hdr; this revision cannot be measured."
    for n in ${BENCH_EXPOSURES:-1 3 5}; do
        mkdir -p "$fast/$n"
        "$B/tests/bench/hdr" --paint --folder "$fast/$n" --exposures "$n" --width "${size%x*}" --height "${size#*x}" 2>"$work/err" ||
            { tail -n 3 "$work/err" >&2; missing "the exposures could not be made."; }
    done
}

settings()
{
    printf 'series\texposures\tthreads\n'
    for t in ${BENCH_THREADS:-1 $([ "$(nproc)" = 1 ] || nproc)}; do
        for n in ${BENCH_EXPOSURES:-1 3 5}; do printf 'hdr_merge\t%s\t%s\n' "$n" "$t"; done
    done
}

sample() # SERIES EXPOSURES THREADS
{
    measured "$B/tests/bench/hdr" --folder "$fast/$2" --exposures "$2" --threads "$3" --width "${size%x*}" --height "${size#*x}"
}
