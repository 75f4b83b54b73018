# scaling.sh - cost of a view of a house, by the number of its views (docs/scaling.md).
#
# The houses are made by scaling_house.c: twelve views and about fourteen faces a room. Of each house the twelve views of a room
# in the middle are worked on, one process each, with one thread. `trace`: trace_ids; `read`: the same of a view of 8 x 8
# px, which is what is paid before the first ray: the model, the cameras and the points are read. `bake`: bake_vdta of four
# of the room's viewpoints; the views of other rooms stand in the index without a face. Seconds, core-seconds
# and MiB read are those of one view. BENCH_VIEWS ("100 1000 10000") sets other houses.
title="cost of a view in a house of many"
note="Views of 853 x 853 px; one thread."
x=views x_label="Views of the house" y=view_cpu_s y_label="Core-seconds a view"
timed="view_cpu_s"
repeats=3

settings()
{
    printf 'series\tviews\n'
    for n in ${BENCH_VIEWS:-100 1000 10000}; do printf 'trace\t%s\nread\t%s\nbake\t%s\n' "$n" "$n" "$n"; done
}

prepare()
{
    [ -x "$B/bin/trace_ids" ] || missing "there is no program $B/bin/trace_ids; this revision has no index of faces."
    local n
    for n in ${BENCH_VIEWS:-100 1000 10000}; do
        "$B/tests/bench/scaling_house" --out "$fast/trace$n" --views "$n" --size 853 --first "$(first_of "$n")" --count 12 >/dev/null 2>&1
        index_house "$n"
        "$B/tests/bench/scaling_house" --out "$fast/read$n" --views "$n" --size 8 --first "$(first_of "$n")" --count 12 >/dev/null 2>&1
    done
}
# house FOLDER: the options that say which house
house() { printf -- '--model %s/model/model.txt --axes %s/model/axes.txt --views %s/views' "$1" "$1" "$1"; }
# the faces of the room's views, and the index that a bake reads
index_house() # VIEWS
{
    local to=$fast/trace$1 k v
    mkdir -p "$to/ids"
    seq 0 $(($1 - 1)) | awk -v ids="$to/ids" '{ f = sprintf("%s/v%06d.txt", ids, $1); print "remodel-view-faces 1" >f; close(f) }'
    for ((k = $(first_of "$1"); k < $(first_of "$1") + 12; k++)); do
        v=$(printf v%06d $k)
        # shellcheck disable=SC2046 # a list of options
        "$B/bin/trace_ids" $(house "$to") --depth "$to/depth" --view "$v" --out "$to/ids/$v.exr" 2>/dev/null
        # shellcheck disable=SC2046
        "$B/bin/trace_ids" $(house "$to") --view "$v" --reveal --out "$to/reveal/$v.exr" 2>/dev/null
    done
    # shellcheck disable=SC2046
    "$B/bin/trace_ids" $(house "$to") --index "$to/ids" --out "$to/ids/index.txt" 2>/dev/null
}
# the first view of the room in the middle
first_of() { local room=$(($1 / 24)); echo $((12 * room)); }

sample_bake() # VIEWS
{
    # shellcheck disable=SC2016
    measured bash -c 'for ((k = $2; k < $2 + 4; k++)); do
            "$0/bin/bake_vdta" --threads 1 --model "$1/model/model.txt" --axes "$1/model/axes.txt" --views "$1/views" --ids "$1/ids" --reveal "$1/reveal" --photo "$(printf v%06d $k)" --out "$1/vdta" 2>/dev/null || exit 1
        done; sed -n "s/^rchar: /rchar /p" /proc/$$/io' "$B" "$fast/trace$1" "$(first_of "$1")" |
        awk '$1 == "seconds" { print "seconds", $2 / 4 } $1 == "cpu_seconds" { print "view_cpu_s", $2 / 4 } $1 == "peak_mib" { print }
             $1 == "rchar" { printf "read_mib %.1f\n", $2 / 4 / 2^20 }'
}

sample() # SERIES VIEWS
{
    local house=$fast/$1$2
    if [ "$1" = bake ]; then sample_bake "$2"; return; fi
    # a shell's counters include those of the processes that it has waited for
    # shellcheck disable=SC2016
    measured bash -c 'for ((k = $2; k < $2 + 12; k++)); do
            v=$(printf v%06d $k)
            "$0/bin/trace_ids" --threads 1 --model "$1/model/model.txt" --axes "$1/model/axes.txt" --views "$1/views" --depth "$1/depth" --view $v --out "$1/ids/$v.exr" 2>/dev/null || exit 1
        done; sed -n "s/^rchar: /rchar /p" /proc/$$/io' "$B" "$house" "$(first_of "$2")" |
        awk '$1 == "seconds" { print "seconds", $2 / 12 } $1 == "cpu_seconds" { print "view_cpu_s", $2 / 12 } $1 == "peak_mib" { print }
             $1 == "rchar" { printf "read_mib %.1f\n", $2 / 12 / 2^20 }'
    awk '$1 == "face" { n++ } END { print "faces_seen", n / 12 }' "$house"/ids/*.txt
}
