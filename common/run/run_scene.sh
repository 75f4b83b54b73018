#!/usr/bin/env bash
# run_scene.sh SCENE S O GOAL DRY JOBS CORES BIN MAKE... - one run of a scene: its lock, then the graph's phases in turn.
#
# S: what all qualities share; O: this quality's products; DRY: n under `make -n`. A phase ends where the next one needs a
# list that only a product can give. Jobs times threads never exceed CORES: each phase has as many jobs as it has work,
# and the threads that are left.
set -euo pipefail
scene=$1 S=$2 O=$3 goal=$4 dry=$5 jobs=$6 cores=$7 bin=$8; shift 8
make=("$@")
folder=scenes/$scene

# what the caller's -j says is an upper bound for jobs; the job server itself is not passed on
asked=$(grep -oE -- '(^| )-j *[0-9]+' <<<"${MAKEFLAGS-}" | grep -oE '[0-9]+' | head -n 1 || true)
MAKEFLAGS=$(sed -E 's/(^| )-j *[0-9]*( |$)/ /; s/--jobserver-[a-z]+=[^ ]*//' <<<"${MAKEFLAGS-}")
export MAKEFLAGS
most=$cores
[ -z "$asked" ] || [ "$asked" -ge "$cores" ] || most=$asked
quiet=-s
[ -z "${V-}" ] || quiet=
# the films of this run; auto and all are known once the subjects are
read -r -a effects <<<"$(tr ' ' '\n' <<<"$REMODEL_EFFECT" | awk 'NF && !seen[$0]++' | tr '\n' ' ')"
choose=
case ${effects[*]} in auto | all) choose=${effects[0]} effects=() ;; esac
# a scene that does not ask for films gets none but those that are asked for by name
films_wanted=1
case " $REMODEL_PRODUCTS $goal " in
*" parallax "* | *" choice "* | *" path "* | *" frames "* | *" video "* | *" pan_scan "* | *" morph "*) ;;
*) [ -n "$REMODEL_EFFECT_NAMED" ] || films_wanted= effects=() choose= ;;
esac
model_wanted=
[[ " $REMODEL_PRODUCTS " != *" model "* ]] || model_wanted=1
graph() { "${make[@]}" PHASE=graph EFFECTS="${effects[*]}" CHOOSE="$choose" "$@"; }
read_choice() { read -r -a effects <<<"$(sed -n 's/^EFFECTS := *//p' "$O/parallax/$choose-effects.mk")"; }
film_needs_a_name() { echo "$folder/keyframes/$1.txt: $1 means something else; give the film of keys another name." >&2; exit 2; }
for film in auto all morph; do [ ! -e "$folder/keyframes/$film.txt" ] || film_needs_a_name "$film"; done
# a name of no effect is told before hours of work
check_name()
{
    local words
    if [ -e "$folder/keyframes/$1.txt" ]; then
        ! "$bin/choose_effects" --effect "$1" >/dev/null 2>&1 || film_needs_a_name "$1"
        return 0
    fi
    words=$("$bin/choose_effects" --effect "$1" 2>&1) && return
    { grep -v ': used ' <<<"$words"; echo "${2:-Nor is there a film of keys $folder/keyframes/$1.txt.}"; } >&2
    exit 2
}
for effect in "${effects[@]}"; do
    check_name "$effect"
    [ -e "$folder/keyframes/$effect.txt" ] || continue
    for move in $(awk '$1 == "move" && $2 ~ /^[A-Za-z0-9_+-]+$/ { print $2 }' "$folder/keyframes/$effect.txt"); do
        check_name "$move" "$folder/keyframes/$effect.txt chains it."
    done
done

if [ -n "${REMODEL_DEPTH-}" ] && [ ! -d "$REMODEL_DEPTH" ]; then
    echo "DEPTH=$REMODEL_DEPTH is no folder. Give the folder that holds VIEW.exr or VIEW.png, the depth of views." >&2
    exit 2
fi
if [ ! -e "$folder/scene.mk" ]; then
    if [ -z "${REMODEL_PHOTOS-}" ]; then
        echo "There is no $folder/scene.mk. Give the folder of photos to begin: make PHOTOS=DIR SCENE=$scene" >&2
        exit 2
    fi
    if [ ! -d "$REMODEL_PHOTOS" ]; then
        echo "PHOTOS=$REMODEL_PHOTOS is no folder. Give the folder that holds the photos." >&2
        exit 2
    fi
    if [ "$dry" = n ]; then echo "would create $folder/scene.mk and scene.cfg, and go on from there"; exit 0; fi
    mkdir -p "$folder"
    for_make() { sed -e 's/\$/$$/g' -e 's/#/\\#/g' <<<"$1"; }
    {
        echo "# What this scene is made from. Every variable of \`make help\` may stand here; the command line wins."
        echo "PHOTOS := $(for_make "$REMODEL_PHOTOS")"
        [ -z "${REMODEL_SPLIT-}" ] || echo "SPLIT := $REMODEL_SPLIT"
        [ -z "${REMODEL_SFM-}" ] || echo "SFM := $(for_make "$REMODEL_SFM")"
        [ -z "${REMODEL_DEPTH-}" ] || echo "DEPTH := $(for_make "$REMODEL_DEPTH")"
        [ -z "${REMODEL_LRI-}" ] || echo "LRI := $(for_make "$REMODEL_LRI")"
        [ -z "${REMODEL_LRI_SFM-}" ] || echo "LRI_SFM := $(for_make "$REMODEL_LRI_SFM")"
        [ -z "${REMODEL_TRUTH-}" ] || echo "TRUTH := $(for_make "$REMODEL_TRUTH")"
        echo "# photos to leave out, by id or file name; names with blanks in quotes"
        echo "EXCLUDE := $(for_make "${REMODEL_EXCLUDE-}")"
        echo "PRODUCTS := ${REMODEL_PRODUCTS:-parallax}"
    } >"$folder/.scene.mk.tmp"
    [ -e "$folder/scene.cfg" ] || {
        echo "# Overrides of configs/default.cfg for this scene alone, a section a stage. For example:"
        echo "#"
        echo "# [sfm]"
        echo "# camera_model = OPENCV"
    } >"$folder/scene.cfg"
    mv "$folder/.scene.mk.tmp" "$folder/scene.mk"
    echo "made $folder/scene.mk and scene.cfg"
fi
if [ -z "${REMODEL_PHOTOS-}" ]; then
    echo "$folder/scene.mk sets no PHOTOS. Write there PHOTOS := DIR, the folder of the photos." >&2
    exit 2
fi
case $goal in model) wants_script=1 ;; all | report) wants_script=$model_wanted ;; *) wants_script= ;; esac
if [ "$wants_script" ] && [ ! -e "$folder/model.txt" ]; then
    echo "make $goal wants $folder/model.txt, the script of the model (docs/model-script.md). make suggest SCENE=$scene writes a first one, to be corrected." >&2
    exit 2
fi
mkdir -p "$S"
if [ "$dry" != n ] && [ "$goal" != why ]; then
    exec 9>"$S/.lock"
    if ! flock -n 9; then
        echo "Another run works on scene $scene (or on a part that an ended run left behind). Wait for it, or end it, and try again." >&2
        exit 1
    fi
fi

if [ "$dry" != n ]; then
    work=$(mktemp -d "${TMPDIR:-/tmp}/remodel.XXXXXX")
    trap 'rm -rf "$work"' EXIT
fi

# farm STAGE GOAL: the stale products of a per-view stage, here or on the cluster
farm()
{
    local plan=$work/$1.plan count wide threads
    : >"$plan"
    graph -s -j1 LAUNCH=plan PLAN="$plan" T="$3" "$2"
    count=$(wc -l <"$plan")
    [ "$count" -gt 0 ] || return 0
    if [ "$jobs" = slurm ]; then
        REMODEL_BIN=$bin common/run/slurm.sh "$1" "$plan" "$O/jobs/$1" "$4" "$3"
        graph -q "$2" || { echo "$1: the cluster's jobs have ended, but something of '$2' is still stale; see make why SCENE=$scene." >&2; exit 1; }
        return
    fi
    wide=$((count < most ? count : most))
    threads=$((cores / wide))
    date +%s >"$work/$1.tally"
    REMODEL_TALLY=$work/$1.tally REMODEL_COUNT=$count graph $quiet -j"$wide" T="$threads" "$2"
}
one() { graph $quiet -j1 T="$cores" "$@"; }

if [ "$goal" = edited ] && [ -z "${EDIT-}" ]; then
    echo "make edited wants EDIT=E, where $folder/scene-E.txt describes the edited scene." >&2
    exit 2
fi
# a described scene is photographed before its photos can be looked at
if [ -e "$folder/scene.txt" ]; then
    if [ "$dry" = n ] || [ "$goal" = why ]; then
        [ -e "$S/simulated/photos.mk" ] || { echo "# nothing is known before the scene is simulated: make SCENE=$scene"; exit 0; }
    else
        graph look-simulate
        one "$S/simulated/photos.mk"
        if [ "$goal" = edited ]; then
            one "$S/simulated/truth/edited-$EDIT/faces.txt"
            farm simulate edited 1 "${VIEWS_PER_JOB:-4}"
            echo "truth  $S/simulated/truth/edited-$EDIT"
            exit 0
        fi
        farm simulate simulated 1 "${VIEWS_PER_JOB:-4}"
    fi
fi
if [ -n "${REMODEL_TRUTH-}" ] && [ ! -d "$REMODEL_TRUTH" ]; then
    echo "TRUTH=$REMODEL_TRUTH is no folder. Give the folder that holds cameras.txt and images.txt of the truth." >&2
    exit 2
fi

if [ "$goal" = lri ]; then
    if [ -z "${REMODEL_LRI-}" ] || [ ! -d "$REMODEL_LRI" ]; then
        echo "make lri wants LRI=DIR, the folder of the lighting reference images${REMODEL_LRI:+; $REMODEL_LRI is none}." >&2
        exit 2
    fi
    if [ -n "${REMODEL_LRI_SFM-}" ] && [ ! -d "$REMODEL_LRI_SFM" ]; then
        echo "LRI_SFM=$REMODEL_LRI_SFM is no folder. Give the folder that holds cameras.txt and images.txt of the lighting reference images." >&2
        exit 2
    fi
fi

graph look
[ "$goal" != lri ] || graph look-lri
[ -z "$choose" ] || [ ! -e "$O/parallax/$choose-effects.mk" ] || read_choice
# two photos are too few for a camera move, unless one is asked for by name
pair=
[ -n "$REMODEL_EFFECT_NAMED" ] || [ "$(grep -c '^[^#]' "$S/photos/list.txt")" != 2 ] || pair=1
if [ "$goal" = why ]; then
    graph -n --debug=b --no-print-directory ${choose:+choice} report | common/run/explain.sh why "$S" "$O"
    exit 0
fi
if [ "$dry" = n ]; then
    [ -e "$O/views/views.mk" ] || echo "# not known before structure from motion has run: which views there are"
    if [ "$goal" = resfm ]; then graph -W "$S/photos/list.txt" sfm; exit 0; fi
    case $goal in
    all | report | path | frames | video | pan_scan)
        [ -z "$choose" ] || [ "${#effects[@]}" -gt 0 ] || [ "$pair" ] ||
            { echo "# not known before the subjects are found: which films EFFECT=$choose makes"; goal=choice; } ;;
    esac
    [ "$goal" = all ] && goal=report
    graph T="$cores" $([ -z "$choose" ] || [[ ! $goal =~ ^(report|path|frames|video|pan_scan)$ ]] || echo choice) "$goal"
    exit 0
fi

# farm_frames STAGE GOAL: frames are few processes with all threads each, since every one of them holds all views in memory
farm_frames()
{
    if [ "$jobs" = slurm ]; then farm "$1" "$2" "$cores" 1; else
        plan=$work/$1.plan; : >"$plan"
        graph -s -j1 LAUNCH=plan PLAN="$plan" "$2"
        date +%s >"$work/$1.tally"
        REMODEL_TALLY=$work/$1.tally REMODEL_COUNT=$(wc -l <"$plan") one "$2"
    fi
}
# the move in 2D: once it was asked for it is kept as new as the rest
pan_scan() { farm_frames pan_scan pan_frames; one pan_scan; }
# what the depth maps are worth: compared with photos held out, with the truth
evaluate()
{
    case $O in *+holdout*) farm_frames render_views heldout ;; esac
    one evaluate
}

# tell_depth LAST: what is stale of depth in all rounds up to the LAST one: how long it will take, and how much memory
tell_depth()
{
    local list=$work/depth.list wide
    # where this fails, making it will fail and say why
    graph -n -s depth 2>/dev/null | awk -v last="$1" '
        {
            view = out = ""
            for (i = 2; i < NF; i++) { if ($i == "segment_depth" && $(i - 2) ~ /run_stage.sh$/) view = $(i + 1); if ($i == "--out") out = $(i + 1) }
            if (view == "") next
            print view, match(out, /\/round[0-9]+\//) ? substr(out, RSTART + 6, RLENGTH - 7) : last
        }' >"$list" || return 0
    [ -s "$list" ] || return 0
    wide=$(cut -d' ' -f2 "$list" | sort | uniq -c | awk '$1 > n { n = $1 } END { print n }')
    wide=$((wide < most ? wide : most))
    [ "$jobs" != slurm ] || wide=0
    "$bin/segment_depth" --config "$O/slice/segment_depth.cfg" --threads $((wide ? cores / wide : 1)) --views "$O/views" \
        --estimate "$list" --jobs "$wide" >&2 2>"$work/words" || cat "$work/words" >&2
}

# photos that are exposures of one view are merged before anything sees them
merge_brackets()
{
    [ -e "$S/photos/brackets.txt" ] || return 0
    # a curve that was deleted is found anew
    [ -e "$S/hdr/response.txt" ] || rm -f "$S/stamp/response.txt"
    one response
    farm hdr_merge hdr 1 "${VIEWS_PER_JOB:-4}"
}

# make_models: the solid model that the scene's script describes, those of its edits, and their edges on the photographs
make_models()
{
    one model
    farm build_model overlays 1 "${VIEWS_PER_JOB:-4}"
}

# make_morph: the film between two photos
make_morph()
{
    local id
    graph look-morph # the photos are known only now
    if [ ! -e "$O/stamp/morph.txt" ]; then
        echo "make morph goes from one photo to another: make morph SCENE=$scene MORPH=\"A B\", with ids that $S/photos/list.txt lists." >&2
        exit 2
    fi
    for id in $(<"$O/stamp/morph.txt"); do
        [ -e "$S/photos/$id.txt" ] || { echo "MORPH: there is no photo $id; $S/photos/list.txt lists them." >&2; exit 2; }
    done
    one morph-path
    farm morph_views morph-frames "$cores" 1
    one morph
}

# the curve is the scene's: it is known before
make_lri()
{
    if [ -e "$S/photos/brackets.txt" ]; then
        [ -e "$S/hdr/response.txt" ] || rm -f "$S/stamp/response.txt"
        one response
    fi
    farm hdr_merge lri 1 "${VIEWS_PER_JOB:-4}"
    echo "light  $S/lri"
}

if [ "$goal" = lri ]; then make_lri; exit 0; fi
if [ "$goal" = resfm ]; then
    merge_brackets
    one -W "$S/photos/list.txt" sfm
    echo "make SCENE=$scene goes on from the new camera poses."
    exit 0
fi
merge_brackets
case $goal in hdr) exit 0 ;; esac
if [ "$pair" ] && [[ $goal = all || $goal = report || $goal = video || $goal = morph ]]; then
    [ -z "${REMODEL_SFM-}" ] || one sfm
    make_morph
    [[ $goal = video || $goal = morph ]] || one report
    common/run/explain.sh products "$O"
    exit 0
fi
case $goal in morph) make_morph; common/run/explain.sh products "$O"; exit 0 ;; esac
one sfm
common/run/explain.sh changed-photos "$S" "$scene"
case $goal in sfm) exit 0 ;; esac
farm rectify views 1 "${VIEWS_PER_JOB:-4}"
case $goal in views) exit 0 ;; esac
common/run/explain.sh given-depth "$S" "$O"
last_round=$(sed -n 's/^rounds = //p' "$O/slice/segment_depth.cfg")
tell_depth "$last_round"
for round in $(seq 0 "$last_round"); do
    farm segment_depth "depth-round$round" 1 "${VIEWS_PER_JOB:-4}"
done
one depth
case $goal in
depth) exit 0 ;;
points | axes | suggest | subjects) one "$goal"; exit 0 ;;
model) make_models; exit 0 ;;
evaluate) evaluate; common/run/explain.sh metrics "$O"; exit 0 ;;
esac
if [ "$model_wanted" ] && [[ $goal = all || $goal = report ]]; then make_models; fi
if [ -n "$choose" ]; then
    one choice
    read_choice
fi
[ -z "$films_wanted" ] || one path
case $goal in path) exit 0 ;; esac
if [ "$goal" = pan_scan ]; then
    pan_scan
    common/run/explain.sh products "$O"
    exit 0
fi
# here a film is whole before the next one begins; a cluster gets all of their frames at once
films=("${effects[@]}")
if [ "$jobs" = slurm ]; then farm_frames render_views frames; fi
for effect in "${films[@]}"; do
    effects=("$effect")
    [ "$jobs" = slurm ] || farm_frames render_views frames
    [ "$goal" = frames ] || one video
done
effects=("${films[@]}")
case $goal in
frames) exit 0 ;;
video) ;;
*)
    case $O${REMODEL_TRUTH:+ truth} in *+holdout* | *truth) evaluate ;; esac
    effects=()
    for effect in "${films[@]}"; do [ ! -e "$O/parallax/$effect/pan_scan/video.mp4" ] || effects+=("$effect"); done
    [ "${#effects[@]}" = 0 ] || pan_scan
    effects=("${films[@]}")
    one report ;;
esac
common/run/explain.sh products "$O"
