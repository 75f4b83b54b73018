# depth.sh - segment_depth: error against time for each of its parameters, on rectified pairs and scenes of known depth.
#
# Pairs: teddy, cones, venus, Art, Books, motorcycle of the Middlebury stereo sets, in BENCH_PAIRS
# (../shared/data/middlebury; without that folder only scenes are measured). Both views get their depth, so that rounds
# can compare them; the left one is evaluated. Error: bad-2, the fraction of pixels seen by both views whose disparity
# is off by more than 2 px of the full picture (stereo_score.c), mean over the pairs; each pair has a column of its own.
#
# Scenes: BENCH_SCENES (still-life, loft, and the folder ../shared/data/apartment if it exists). A name is one of
# scenes/ whose scene.mk has a TRUTH; `make sfm` is run for it first. A folder has photos/ and truth/, whose cameras are
# used. Views are BENCH_SCENE_SIZE (0.5) of the photos' size. The error is depth.bad2_visible of docs/evaluation.md; the
# table also has the relative errors, the fraction within 2 % and the known fraction.
#
# BENCH_SWEEPS="quality rounds": only these panels. The default setting is in every panel; a panel varies one parameter.
# `quality` has the [segment_depth] of configs/draft.cfg and final.cfg beside the default; `threads` and `jobs` are one
# and two threads per view, and one and two views at a time. Constant z is the form of [Colburn 2014]: slants cost more
# than they can gain.
#
# `candidates` chooses without the pair that is reported (left_out.awk): BENCH_CANDIDATES lists settings, each KEY=VALUE or
# several of them with commas, the default beside them; by default each parameter that matters is halved and doubled. For
# each pair the setting with the lowest mean error over the other pairs is chosen. The result is depth_left_out.tsv; these
# rows are not plotted.
#
# Baseline: OpenCV's StereoSGBM (stereo_sgbm.c) on the same views: its best settings, left-right checked and filled;
# block is its window; `plain` is without the margin for the left columns. It computes the depth of one view, ours of
# two.
#
# seconds: wall time of the programs over all items of the set, in BENCH_THREADS (1) threads. core_s_per_mp: CPU time
# per megapixel of all views that got a depth, including all rounds. size: of the views, as a fraction of the photos'
# size. The rows of the sweeps `threads` and `jobs` only compare seconds.
# shellcheck disable=SC2030,SC2031 # parallel jobs measure in work folders of their own
title="Depth maps: error against time"
note="Lower left is better. Each panel varies one parameter; the others have their defaults."
baseline=SGBM
match="set sweep size"
timed=core_s_per_mp
line=series label=value panel="set sweep"
x=core_s_per_mp x_label="Core-seconds per megapixel of view" y_label="Pixels off by more than 2 px (%)"

pairs=${BENCH_PAIRS-../shared/data/middlebury}
apartment=../shared/data/apartment
[ -d "$apartment" ] || apartment=
scenes=${BENCH_SCENES-still-life loft $apartment}
scene_size=${BENCH_SCENE_SIZE:-0.5}
threads=${BENCH_THREADS:-1}
candidates=${BENCH_CANDIDATES-smoothness=0.5 smoothness=2 jump=6 jump=24 slant=0.005 slant=0.02 cross_view=0.85 cross_view=3.4 \
    segment_pixels=32 segment_pixels=128 fine_pixels=8 fine_pixels=32 passes=1 passes=6 far_bias=0.005 far_bias=0.02 compactness=4 compactness=16}

# value_of FILE NAME: the last value of NAME in lines "NAME VALUE"
value_of() { awk -v k="$2" '$1 == k { v = $2 } END { print v }' "$1"; }
quietly() { "$@" >"$work/messages" 2>&1 || { tail -n 5 "$work/messages" >&2; missing "${1##*/} failed on the bench's input."; }; }

# ITEM is a pair or a scene: photos, records, sfm, truth in $work/ITEM, and the parameters that it needs in
# $work/ITEM/knobs
prepare_pair() # NAME
{
    local to=$work/$1 v
    "$B/tests/bench/stereo_pair" --pair "$pairs/$1" --out "$to" >"$work/pair" 2>"$work/messages" || { cat "$work/messages" >&2; missing "$pairs/$1 cannot be used."; }
    quietly "$B/bin/import_photos" --photos "$to/photos" --out "$to/records"
    mkdir "$to/sfm" # as the stage sfm would write it
    mv "$to/model" "$to/sfm/0"
    printf 'remodel-sfm 1\n0 colmap\n' >"$to/sfm/models.txt"
    for v in left right; do echo "$v $(value_of "$to/records/$v.txt" hash)"; done >"$to/sfm/photos.txt"
    value_of "$work/pair" near >"$to/near"
    printf '%s\n' --set "near=$(cat "$to/near")" --set far=1000 >"$to/knobs"
}
prepare_scene() # NAME
{
    local to=$work/$1 mk=scenes/$1/scene.mk photos truth
    photos=$(sed -n 's/^PHOTOS *:*= *//p' "$mk" 2>/dev/null) truth=$(sed -n 's/^TRUTH *:*= *//p' "$mk" 2>/dev/null)
    if [ -z "$photos" ] || [ -z "$truth" ]; then missing "$mk names no PHOTOS or no TRUTH; BENCH_SCENES=\"NAMES\" lists scenes with both."; fi
    echo "depth: photos and cameras of $1 (make SCENE=$1 sfm)" >&2
    "${MAKE:-make}" --no-print-directory SCENE="$1" QUALITY=default sfm >"$work/messages" 2>&1 || { tail -n 5 "$work/messages" >&2; missing "make SCENE=$1 sfm failed."; }
    mkdir -p "$to"
    if grep -q '^BRACKETED := yes' "out/$1/photos/photos.mk"; then photos=out/$1/hdr; fi
    ln -s "$(realpath "$photos")" "$to/photos"
    ln -s "$(realpath "out/$1/photos")" "$to/records"
    ln -s "$(realpath "out/$1/sfm")" "$to/sfm"
    ln -s "$(realpath "$truth")" "$to/truth"
    : >"$to/knobs"
}

# a folder of photos and truth, whose cameras become the model
prepare_folder() # DIR
{
    local to made id photos=$1/photos
    to=$work/${1##*/} made=$work/${1##*/}/made
    if [ ! -d "$1/photos" ] || [ ! -d "$1/truth" ]; then missing "$1 holds no photos/ or no truth/; BENCH_SCENES=\"NAMES\" lists scenes, or folders with both."; fi
    echo "depth: photos and cameras of $1" >&2
    mkdir -p "$made"
    quietly "$B/bin/import_photos" --photos "$photos" --out "$made/photos"
    if grep -q '^BRACKETED := yes' "$made/photos/photos.mk"; then
        for id in $(sed -n 's/^PHOTO_IDS := //p' "$made/photos/photos.mk"); do
            quietly "$B/bin/hdr_merge" --id "$id" --photos "$photos" --records "$made/photos" --out "$made/hdr"
        done
        photos=$made/hdr
    fi
    quietly "$B/bin/sfm" --photos "$photos" --records "$made/photos" --model "$1/truth" --out "$made/sfm"
    ln -s "$(realpath "$photos")" "$to/photos"
    ln -s "$made/photos" "$to/records"
    ln -s "$made/sfm" "$to/sfm"
    ln -s "$(realpath "$1/truth")" "$to/truth"
    : >"$to/knobs"
}

prepare()
{
    [ -x "$B/bin/segment_depth" ] || missing "there is no program $B/bin/segment_depth."
    "$B/bin/segment_depth" --print-config >"$work/defaults"
    local p s
    found_pairs=
    for p in teddy cones venus Art Books motorcycle; do
        if [ -d "$pairs/$p" ]; then prepare_pair "$p"; found_pairs+=" $p"; fi
    done
    [ -n "$found_pairs" ] || echo "depth: there are no Middlebury pairs in '$pairs' (set BENCH_PAIRS=DIR); only scenes are measured, without a baseline." >&2
    found_scenes=
    for s in $scenes; do
        case $s in */*) prepare_folder "${s%/}" ;; *) prepare_scene "$s" ;; esac
        s=${s%/}; found_scenes+=" ${s##*/}"
    done
    for s in draft final; do # the parameters that a quality changes, as options
        "$B/bin/segment_depth" --config "configs/$s.cfg" --print-config | comm -13 <(sort "$work/defaults") <(sort -) | sed 's/ = /=/' >"$work/$s"
    done
    [ -n "$found_pairs$found_scenes" ] || missing "there are neither pairs nor scenes."
}

default_of() { sed -n "s/^$1 = //p" "$work/defaults"; }

settings()
{
    printf 'series\tset\tsweep\tvalue\tsize\n'
    # SERIES SET SWEEP VALUE
    row()
    {
        local size=1
        case " ${BENCH_SWEEPS:-$3} " in *" $3 "*) ;; *) return 0 ;; esac
        [ "$2" = Middlebury ] || size=$scene_size
        [ "$3" != resolution ] || size=$4
        printf '%s\t%s\t%s\t%s\t%s\n' "$@" "$size"
    }
    sweep() # SET KNOB SERIES VALUES...: rows for these values and the default, in order
    {
        local set=$1 knob=$2 series=$3 v; shift 3
        for v in $(printf '%s\n' "$@" "$(default_of "$knob")" | sort -gu); do row "$series" "$set" "$knob" "$v"; done
    }
    local v s
    if [ -n "$found_pairs" ]; then
        for s in slanted 'constant z'; do sweep Middlebury rounds "$s" 0 1 2; done
        for v in 'block 1' 'block 3' 'block 5' plain; do row SGBM Middlebury rounds "$v"; done
        for s in slanted 'constant z'; do for v in ${BENCH_SIZES:-0.5 0.7 1}; do row "$s" Middlebury resolution "$v"; done; done
        for v in ${BENCH_SIZES:-0.5 0.7 1}; do row SGBM Middlebury resolution "$v"; done
        sweep Middlebury segment_pixels slanted 32 128 256; row SGBM Middlebury segment_pixels 'block 1'
        sweep Middlebury planes slanted 8 16 32; row SGBM Middlebury planes 'block 1'
        sweep Middlebury passes slanted 0 1 2; row SGBM Middlebury passes 'block 1'
        for v in draft default final; do row slanted Middlebury quality "$v"; done; row SGBM Middlebury quality 'block 1'
        [ "$(nproc)" = 1 ] || for s in threads jobs; do for v in 1 2; do row slanted Middlebury "$s" "$v"; done; done
        # not where revisions are compared: an older one may lack a parameter
        [ -n "$old" ] || for v in default $candidates; do row slanted Middlebury candidates "$v"; done
    fi
    for v in $found_scenes; do
        sweep "$v" neighbours slanted 1 2 4
        row 'constant z' "$v" neighbours "$(default_of neighbours)"
        sweep "$v" rounds slanted 0
        for s in draft default final; do row slanted "$v" quality "$s"; done
    done
}

# views ITEM SIZE: makes its rectified views at this fraction of the photos' size, once; prints their folder
views()
{
    local from=$work/$1 to=$work/$1/views@$2 limit=0 p
    if [ ! -e "$to/views.mk" ]; then
        [ "$2" = 1 ] || limit=$(cat "$from"/records/*.txt | awk -v s="$2" '$1 == "size" { print $2 * $3 * s * s * 1e-6; exit }')
        quietly "$B/bin/sfm_import" --sfm "$from/sfm/" --records "$from/records" --set "max_megapixels=$limit" --out "$to"
        for p in $(sed -n 's/^VIEWS := //p' "$to/views.mk" | tr ' ' '\n' | sed 's/@.*//' | sort -u); do
            # ours, also if an older revision is measured, because its options differ
            quietly "${builds[0]}/bin/rectify" --photo "$p" --photos "$from/photos/" --records "$from/records" --views "$to" --out "$to"
        done
    fi
    echo "$to"
}
megapixels() { awk '/^[^#]/ && NF >= 8 { n += $3 * $4 } END { print n * 1e-6 }' "$1/cameras.txt"; }

# use FILE MEGAPIXELS COMMAND...: measures a process and appends "seconds cpu peak megapixels" to FILE
use()
{
    local to=$1 mp=$2; shift 2
    measured "$@" >"$work/use1" || return
    echo "$(value_of "$work/use1" seconds) $(value_of "$work/use1" cpu_seconds) $(value_of "$work/use1" peak_mib) $mp" >>"$to"
}
# sums USES JUDGED: prints a sample's lines from the files of use() and judge(); error is the mean over the items
sums()
{
    awk '{ s += $1; c += $2; mp += $4; if ($3 > peak) peak = $3 } END { printf "seconds %.6f\npeak_mib %.1f\ncore_s_per_mp %.4g\n", s, peak, c / mp }' "$1"
    awk '{ if (!(($2) in n)) order[++k] = $2; n[$2]++; sum[$2] += $3; items[$1] = 1; if ($2 == "error") { own[++m] = $1; bad[m] = $3 } }
        END {
            for (i = 1; i <= k; i++) printf "%s %.4g\n", order[i], sum[order[i]] / n[order[i]]
            print "unit %"
            for (i = 1; m > 1 && i <= m; i++) printf "%s %.4g\n", own[i], bad[i]
        }' "$2"
}

# judge ITEM SIZE DEPTH: prints "ITEM NAME VALUE" lines; DEPTH is the left view's file of a pair or a scene's folder
judge()
{
    local of=$work/$1 folder=$fast/judged
    if [ -d "$3" ]; then
        rm -rf "$folder"; mkdir -p "$folder"
        ln -s "$of/views@$2" "$folder/views"; ln -s "$3" "$folder/depth"
        "$B/bin/evaluate" --folder "$folder" --shared "$(dirname "$(realpath "$of/records")")" --truth "$of/truth/" --out "$folder/metrics.tsv" 2>"$work/err" || return
        awk -v item="$1" 'BEGIN { n = split("depth.bad2_visible error depth.bad1_visible bad1 depth.known known depth.within2_visible within2 depth.error50_visible relative50 depth.error90_visible relative90", w, " ")
                for (i = 1; i < n; i += 2) name[w[i]] = w[i + 1] }
            $1 in name { print item, name[$1], $2 }' "$folder/metrics.tsv"
    else
        "$B/tests/bench/stereo_score" --truth "$of/truth" --views "$of/views@$2" --depth "$3" 2>"$work/err" | awk -v item="$1" '$1 ~ /^(error|bad1|known)$/ { print item, $1, $2 }'
    fi
}

# solved KEY SIZE ITEMS ROUND THREADS JOBS ARGS...: makes $fast/KEY.ROUND, a sample's lines
#
# The default is in every panel, so the result of a setting is kept for the rest of the repeat. Rounds build on each
# other, so the depth of the last round is kept until another setting runs.
solved()
{
    local key=$1 size=$2 items=$3 round=$4 threads=$5 jobs=$6 now=$fast/rounds k item v in before args command running began; shift 6
    [ ! -e "$fast/$key.$round" ] || return 0
    [ -e "$now/key" ] && [ "$(cat "$now/key")" = "$key" ] && [ "$(cat "$now/next")" -le "$round" ] || { rm -rf "$now"; mkdir "$now"; echo "$key" >"$now/key"; echo 0 >"$now/next"; }
    for ((k = $(cat "$now/next"); k <= round; k++)); do
        : >"$now/judged"
        for item in $items; do
            in=$(views "$item" "$size") before=()
            [ "$k" = 0 ] || before=(--before "$now/$item.$((k - 1))")
            mkdir "$now/$item.$k"
            mapfile -t args <"$work/$item/knobs"
            running=() began=$EPOCHREALTIME
            for v in $(sed -n 's/^VIEWS := //p' "$in/views.mk"); do
                command=("$B/bin/segment_depth" --threads "$threads" "${args[@]}" "$@" --views "$in" --view "$v" "${before[@]}" --out "$now/$item.$k/$v.exr")
                if [ "$jobs" = 1 ]; then
                    use "$now/uses" 0 "${command[@]}" || return
                else # in parallel, each with its own files for the measurements
                    if [ "${#running[@]}" = "$jobs" ]; then wait "${running[0]}" || return; running=("${running[@]:1}"); fi
                    (work=$now/job.$v; mkdir -p "$work"; use "$now/uses" 0 "${command[@]}") &
                    running+=($!)
                fi
            done
            for v in "${running[@]}"; do wait "$v" || return; done
            [ "$jobs" = 1 ] || echo "$began $EPOCHREALTIME" >>"$now/walls"
            [ "$k" = 0 ] || rm -r "$now/$item.$((k - 1))"
            [ "$k" != 0 ] || echo "0 0 0 $(megapixels "$in")" >>"$now/uses"
            if [ -e "$work/$item/near" ]; then v=/left.exr; else v=; fi
            judge "$item" "$size" "$now/$item.$k$v" >>"$now/judged" || return
        done
        sums "$now/uses" "$now/judged" >"$fast/$key.$k"
        if [ "$jobs" != 1 ]; then # from the start of the first to the end of the last
            awk '{ s += $2 - $1 } END { printf "seconds %.6f\n", s }' "$now/walls" >"$fast/wall"
            grep -v '^seconds ' "$fast/$key.$k" >>"$fast/wall"; mv "$fast/wall" "$fast/$key.$k"
        fi
        echo $((k + 1)) >"$now/next"
    done
}

sgbm() # KEY SIZE ARGS...
{
    local key=$1 size=$2 item in; shift 2
    [ ! -e "$fast/$key" ] || return 0
    rm -f "$fast/uses" "$fast/judged.txt"
    for item in $found_pairs; do
        in=$(views "$item" "$size")
        use "$fast/uses" "$(megapixels "$in" | awk '{ print $1 / 2 }')" "$B/tests/bench/stereo_sgbm" --views "$in" --set "near=$(cat "$work/$item/near")" "$@" --out "$fast/sgbm.exr" &&
            judge "$item" "$size" "$fast/sgbm.exr" >>"$fast/judged.txt" || return
    done
    sums "$fast/uses" "$fast/judged.txt" >"$fast/$key"
}

sample() # SERIES SET SWEEP VALUE SIZE
{
    local size=$5 items=$found_pairs rounds on=$threads side=1 args=() key
    rounds=$(default_of rounds)
    [ "$2" = Middlebury ] || items=$2
    if [ "$1" = SGBM ]; then
        case $4 in block*) args=(--set "block=${4#block }") ;; plain) args=(--set widen=no) ;; esac
        key="SGBM $r ${B//\//_} $size ${args[*]#block=1}"
        sgbm "$key" "$size" "${args[@]}" && cat "$fast/$key"
        return
    fi
    # the lines KEY=VALUE of standard input
    set_all() { local v; while read -r v; do case $v in rounds=*) rounds=${v#*=} ;; ?*) args+=(--set "$v") ;; esac; done; }
    [ "$1" = slanted ] || args+=(--set slant=10)
    case $3 in
    rounds) rounds=$4 ;;
    resolution) ;;
    threads) on=$4 ;;
    jobs) side=$4 ;;
    quality) [ "$4" = default ] || set_all <"$work/$4" ;;
    candidates) [ "$4" = default ] || set_all <<<"${4//,/$'\n'}" ;;
    *) [ "$4" = "$(default_of "$3")" ] || args+=(--set "$3=$4") ;;
    esac
    key="$2 $r ${B//\//_} $size $on $side ${args[*]}"
    solved "$key" "$size" "$items" "$rounds" "$on" "$side" "${args[@]}" || return
    case $3 in
    threads | jobs | candidates) grep -v '^core_s_per_mp ' "$fast/$key.$rounds" ;;
    *) cat "$fast/$key.$rounds" ;;
    esac
}

# of each candidate a column for each pair, or only the column error if there is one pair
finish() # TABLE
{
    awk -F'\t' -v pairs="$found_pairs" '
        /^#/ { next }
        !n { n = NF; for (i = 1; i <= n; i++) column[$i] = i; count = split(pairs, pair, " "); next }
        $(column["sweep"]) == "candidates" { for (i = 1; i <= count; i++) print pair[i] "\t" $(column["value"]) "\t" $(column[count > 1 ? pair[i] : "error"]) }
        ' "$1" >"$work/candidates"
    [ ! -s "$work/candidates" ] || left_out lower <"$work/candidates"
}
