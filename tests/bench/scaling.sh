# scaling.sh - cost of a view of a house, by the number of its views (docs/scaling.md).
#
# The houses are made by scaling_house.c: twelve views and about fourteen faces a room. Of each house the 48 views of four rooms
# in the middle are worked on, by one process with one thread; a run puts up to 50 into one here, and as many as take ten
# minutes on a cluster. `trace`: trace_ids; `bake`: bake_vdta; the views of other rooms stand in the index without a face.
# `trace_alone`, `bake_alone`: a process for each view, of twelve of them. `read`: the same for views of 8 x 8 px, which is what
# is paid before the first ray: the model and the cameras are read. Seconds, core-seconds and MiB read are those of one view. BENCH_VIEWS ("100 1000 10000") sets other houses.
title="cost of a view in a house of many"
note="Views of 853 x 853 px; one thread."
x=views x_label="Views of the house" y=view_cpu_s y_label="Core-seconds a view"
timed="view_cpu_s"
repeats=3

settings()
{
    printf 'series\tviews\n'
    for n in ${BENCH_VIEWS:-100 1000 10000}; do printf '%s\n' trace trace_alone read bake bake_alone | sed "s/\$/\t$n/"; done
}

prepare()
{
    [ -x "$B/bin/trace_ids" ] || missing "there is no program $B/bin/trace_ids; this revision has no index of faces."
    local n
    for n in ${BENCH_VIEWS:-100 1000 10000}; do
        "$B/tests/bench/scaling_house" --out "$fast/trace$n" --views "$n" --size 853 --first "$(first_of "$n")" --count 48 >/dev/null 2>&1
        index_house "$n"
        "$B/tests/bench/scaling_house" --out "$fast/read$n" --views "$n" --size 8 --first "$(first_of "$n")" --count 12 >/dev/null 2>&1
    done
}
# house FOLDER: the options that say which house
house() { printf -- '--model %s/model/model.txt --axes %s/model/axes.txt --views %s/views' "$1" "$1" "$1"; }
# the faces of the room's views, and the index that a bake reads
index_house() # VIEWS
{
    local to=$fast/trace$1
    mkdir -p "$to/ids"
    seq 0 $(($1 - 1)) | awk -v ids="$to/ids" '{ f = sprintf("%s/v%06d.txt", ids, $1); print "remodel-view-faces 2" >f; close(f) }'
    # shellcheck disable=SC2046 # a list of options
    "$B/bin/trace_ids" $(house "$to") --depth "$to/depth" $(views_of "$1" 48 | sed "s|.*|--view & --out $to/ids/&.exr|") 2>/dev/null
    # shellcheck disable=SC2046
    "$B/bin/trace_ids" $(house "$to") --reveal $(views_of "$1" 48 | sed "s|.*|--view & --out $to/reveal/&.exr|") 2>/dev/null
    # shellcheck disable=SC2046
    "$B/bin/trace_ids" $(house "$to") --index "$to/ids" --out "$to/ids/index.txt" 2>/dev/null
}
# the first view of the room in the middle
first_of() { local room=$(($1 / 24)); echo $((12 * room)); }
# views_of VIEWS COUNT: the names of COUNT views from there on
views_of() { seq -f v%06g "$(first_of "$1")" $(($(first_of "$1") + $2 - 1)); }

# command_of SERIES HOUSE VIEW...: the program and its options
command_of()
{
    local series=$1 house=$2 v; shift 2
    case $series in
    bake*)
        echo "bake_vdta --ids $house/ids --reveal $house/reveal --out $house/vdta"
        printf -- '--photo %s\n' "$@" ;;
    *)
        echo "trace_ids --depth $house/depth"
        for v; do echo "--view $v --out $house/ids/$v.exr"; done ;;
    esac
    house "$house"
}
sample() # SERIES VIEWS
{
    local house=$fast/$1$2 k views count=12 each=1
    case $1 in trace* | bake*) house=$fast/trace$2 ;; esac
    case $1 in trace | bake) count=48 each=48 ;; esac
    mapfile -t views < <(views_of "$2" $count)
    for ((k = 0; k < count; k += each)); do command_of "$1" "$house" "${views[@]:k:each}" | tr '\n' ' '; echo; done >"$fast/commands"
    # a shell's counters include those of the processes that it has waited for
    # shellcheck disable=SC2016
    measured bash -c 'while read -r command; do "$0/bin/"$command --threads 1 2>/dev/null </dev/null || exit 1; done <"$1"
            sed -n "s/^rchar: /rchar /p" /proc/$$/io' "$B" "$fast/commands" |
        awk -v n=$count '$1 == "seconds" { print "seconds", $2 / n } $1 == "cpu_seconds" { print "view_cpu_s", $2 / n } $1 == "peak_mib" { print }
             $1 == "rchar" { printf "read_mib %.1f\n", $2 / n / 2^20 }'
    [ "$house" = "$fast/read$2" ] || awk '$1 == "face" { n++ } END { print "faces_seen", n / 48 }' "$house"/ids/*.txt
}
