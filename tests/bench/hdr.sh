# hdr.sh - how fast exposures are read and merged, by number and threads; the radiance's error; how fast they become
# views.
#
# The view is synthetic, 3000 x 2000 px (BENCH_SIZE=WIDTHxHEIGHT sets another size), as JPEGs of quality 94 with a
# camera's noise, so that its radiance is known. seconds: reading the JPEGs, estimating shifts and noise, merging;
# read_s, align_s, merge_s: the parts. Separately: tone_s, the picture for structure from motion without encoding it,
# and write_s, the EXR. error: median relative error of the luminance of pixels that an exposure shows well. Files are
# in memory if there is /dev/shm.
#
# merge and rectify: the exposures are treated as those of an equisolid fisheye lens, with as many photos at once as
# there are threads, up to all views of each, by the stages' own code: the merge, then reading the radiance again and
# resampling. Views have at most 2 megapixels (the default) or any size (QUALITY=final). rectify_s: that part; cpu_s:
# CPU time of both parts together, which other load on the machine hardly changes; write_s: the EXRs of radiance and
# views. asked: the goal for mpixels_per_s, on 2 cores.
title="hdr_merge and rectify: time against the number of exposures"
note="Reading JPEGs, aligning, merging, resampling; without writing. Goal: 20 megapixels of exposures per second on 2 cores."
line="threads" label=exposures panel=series across=3
x_label="Time (s)" y=mpixels y_label="Megapixels of all exposures"
rate=mpixels
timed="cpu_s read_s align_s merge_s rectify_s tone_s write_s"
repeats=3

size=${BENCH_SIZE:-3000x2000}
prepare()
{
    [ -x "$B/tests/bench/hdr" ] && [ -x "$B/tests/bench/hdr_views" ] || missing "there is no program $B/tests/bench/hdr or hdr_views; this revision cannot be measured."
    for n in ${BENCH_EXPOSURES:-1 3 5}; do
        mkdir -p "$fast/$n"
        "$B/tests/bench/hdr" --paint --folder "$fast/$n" --exposures "$n" --width "${size%x*}" --height "${size#*x}" 2>"$work/err" ||
            { tail -n 3 "$work/err" >&2; missing "the exposures could not be made."; }
    done
}

settings()
{
    local threads=${BENCH_THREADS:-1 $([ "$(nproc)" = 1 ] || nproc)} n t max
    printf 'series\texposures\tthreads\tmax_megapixels\tasked\n'
    for t in $threads; do
        for n in ${BENCH_EXPOSURES:-1 3 5}; do printf 'hdr_merge\t%s\t%s\t-\t-\n' "$n" "$t"; done
    done
    for max in 2 0; do
        for t in $threads; do
            for n in ${BENCH_EXPOSURES:-3}; do
                printf 'merge and rectify%s\t%s\t%s\t%s\t%s\n' "$([ $max != 0 ] || echo ', views of any size')" "$n" "$t" "$max" "$([ "$t" = 2 ] && echo 20 || echo -)"
            done
        done
    done
}

sample() # SERIES EXPOSURES THREADS MAX_MEGAPIXELS
{
    local view=(--folder "$fast/$2" --exposures "$2" --threads "$3" --width "${size%x*}" --height "${size#*x}")
    if [ "$1" = hdr_merge ]; then
        measured "$B/tests/bench/hdr" "${view[@]}"
    else
        measured "$B/tests/bench/hdr_views" "${view[@]}" --photos "$3" --max-megapixels "$4"
    fi
}
