#!/usr/bin/env bash
# run_scene.sh SCENE S O GOAL DRY JOBS CORES BIN MAKE... - one run of a scene: its lock, then the steps up to GOAL in turn.
#
# S: what all qualities share; O: this quality's products; DRY: n under `make -n`. A step ends where the next one needs a
# list that only a product can give. Jobs times threads never exceed CORES: each step has as many jobs as it has work,
# and the threads that are left.
#
# Which steps a goal needs, in which order, comes from the rules of the stages (stages/STAGE/rules.c), which print_graph prints
# before each call of Make. stages/STAGE/look.sh BIN S O SCENE_FOLDER, where there is one, looks at what people gave, photos
# first, and rewrites records and stamps of what changed. A stage may say more in stages/STAGE/run.sh, which is sourced here
# and defines some of these functions:
#   begin_STAGE    settles variables that others read
#   check_STAGE    refuses what is wrong before anything is made
#   prepare_STAGE  makes what must exist before the photos can be read
#   look_STAGE     runs after the photos have been read
#   run_STEP       makes a step, in place of what its kind says
#   estimate_STAGE  reads the commands of per-view work, one a line, and prints what the stage's --estimate says of it
#                  (common/base/work_estimate.h): it sets the size of the tasks on a cluster, and `make plan` adds it up
#   dry_STAGE      before `make -n` prints: may add to `first`, which Make makes before the goal, or change `goal`
#   unknown_STAGE  says what `make plan` cannot know yet
#   end_STAGE      after the last step: says where the products are
# They use the variables and functions of this script: scene, folder, S, O, goal, dry, jobs, cores, max_jobs, bin, work, the
# films of this run in `effects`, auto or all in `choose`; usage, graph, one, farm, farm_frames, items, slices.
set -euo pipefail
scene=$1 S=$2 O=$3 goal=$4 dry=$5 jobs=$6 cores=$7 bin=$8; shift 8
make=("$@")
folder=scenes/$scene
# what a message tells people to give to make, to get at the products of this run
again="SCENE=$scene$([ "${REMODEL_QUALITY:-default}" = default ] || echo " QUALITY=$REMODEL_QUALITY")"

usage() { echo "$*" >&2; exit 2; }
# print_graph WHAT [GOAL]: the graph of products, with this run's films (common/graph/print_graph.c)
print_graph() { REMODEL_FILMS="${effects[*]}" REMODEL_CHOOSE=$choose "$bin/print_graph" "$1" "$folder" "$S" "$O" "$bin" "${@:2}"; }
# execute ...: Make, on the graph as it was printed; graph ...: on that of now
execute() { "${make[@]}" PHASE=graph O="$O" "$@"; }
graph() { print_graph write && execute "$@"; }
# commands_to_come [OPTION...]: one a line, of all steps up to the goal, on the graph as it was printed
# shellcheck disable=SC2120 # status_scene.sh passes -B
commands_to_come() { execute -n -s "$@" ${choose:+choice} "$goal" | sed -e ':a' -e '/\\$/{N;s/\\\n//;ba' -e '}' | grep -a 'run_stage.sh [a-z]* ' || true; }
# one TARGET...: made here, with all cores
one() { graph $quiet -j1 T="$cores" "$@"; }

# items: of commands, one a line, the pieces of work
items() { sed -nE 's|.*/run_stage.sh [a-z]+ [a-z_]+ ([^ ]+) .*|\1|p'; }
# work_of STAGE: of commands, one a line, "ITEMS SECONDS MIB BYTES LONGEST"; nothing where the stage does not say. What makes an
# estimate fail makes the stage fail too, which then says why
work_of() { ! is_function "estimate_$1" || { "estimate_$1" 2>/dev/null || true; } | sed -n 's/^estimate //p'; }
# plan_of TARGET THREADS: the pieces of work that are stale, as lines of a plan
plan_of()
{
    local commands
    print_graph write || return
    commands=$(execute -n -s T="$2" "$1") || return
    [[ $commands != *run_stage.sh* ]] || common/run/plan_lines.sh "$O/graph" <<<"$commands"
}
# farm STAGE TARGET [THREADS] [LINES]: the stale products of a per-view stage, here or on the cluster, where a task has THREADS
# cores and LINES of the plan; otherwise VIEWS_PER_JOB, or what the stage's estimate says
farm()
{
    local plan=$work/$1.plan count wide threads
    plan_of "$2" "${3:-1}" >"$plan"
    [ -s "$plan" ] || return 0
    count=$(wc -l <"$plan")
    if [ "$jobs" = slurm ]; then
        # shellcheck disable=SC2046 # five numbers, or none
        REMODEL_BIN=$bin common/run/slurm.sh "$1" "$plan" "$O/jobs/$1" "${3:-1}" "${4:-${VIEWS_PER_JOB-}}" $(cut -f2- "$plan" | tr '\t' ' ' | work_of "$1")
        graph -q "$2" || { echo "$1: the cluster's jobs have ended, but something of '$2' is still stale; see make why $again." >&2; exit 1; }
        return
    fi
    wide=$((count < max_jobs ? count : max_jobs))
    threads=$((cores / wide))
    begin_tally "$count"
    if [ -n "$(cut -sf3 "$plan")" ]; then farm_plan "$plan" "$2" "$wide" "$threads"
    else execute $quiet -j"$wide" T="$threads" "$2"; fi
    unset REMODEL_TALLY
}
# farm_plan PLAN TARGET WIDE THREADS: runs the plan of a stage whose processes make several pieces of work, WIDE processes at a
# time, each with VIEWS_PER_JOB pieces, or a quarter of its share, at most 50. Like Make, begins no other once a piece has failed
farm_plan()
{
    local chunks=$1.chunks lines
    if [ "$4" != 1 ]; then
        plan_of "$2" "$4" >"$1"
    fi
    lines=$((($(wc -l <"$1") + 4 * $3 - 1) / (4 * $3)))
    lines=${VIEWS_PER_JOB:-$((lines < 50 ? lines : 50))}
    rm -rf "$chunks" "$1.failed"; mkdir "$chunks"
    split -l "$lines" -d -a 6 "$1" "$chunks/"
    # shellcheck disable=SC2016
    printf '%s\n' "$chunks"/* | xargs -d '\n' -P "$3" -n 1 bash -c '[ -e "$0" ] || common/run/run_lines.sh <"$1" >/dev/null || : >"$0"' "$1.failed"
    [ ! -e "$1.failed" ] || { echo "$(basename "$1" .plan): something failed; its words are above. What was made is kept." >&2; exit 2; }
}
# farm_frames STAGE TARGET: few processes with all threads each, since every one of them holds all views in memory
farm_frames()
{
    if [ "$jobs" = slurm ]; then farm "$1" "$2" "$cores" 1; else
        local plan=$work/$1.plan
        plan_of "$2" "$cores" >"$plan"
        begin_tally "$(wc -l <"$plan")"
        one "$2"
        unset REMODEL_TALLY
    fi
}
. common/run/run_record.sh
# is_function NAME
is_function() { declare -F "$1" >/dev/null; }
# hooks NAME: NAME_STAGE of every stage that has it
hooks() { local s; for s in $REMODEL_STAGES; do ! is_function "$1_$s" || "$1_$s"; done; }
for s in $REMODEL_STAGES; do
    # shellcheck source=/dev/null
    [ ! -e "stages/$s/run.sh" ] || . "stages/$s/run.sh"
done

# what the caller's -j says is an upper bound for jobs; the job server itself is not passed on
asked=$(grep -oE -- '(^| )-j *[0-9]+' <<<"${MAKEFLAGS-}" | grep -oEm1 '[0-9]+' || true)
MAKEFLAGS=$(sed -E 's/(^| )-j *[0-9]*( |$)/ /; s/--jobserver-[a-z]+=[^ ]*//' <<<"${MAKEFLAGS-}")
export MAKEFLAGS
max_jobs=$cores
[ -z "$asked" ] || [ "$asked" -ge "$cores" ] || max_jobs=$asked
quiet=-s
[ -z "${V-}" ] || quiet=

# slices FOLDER STAGES [CONFIG]: the effective parameters of these stages
slices()
{
    local configs=(configs/default.cfg "${@:3}")
    [ ! -e "$folder/scene.cfg" ] || configs+=("$folder/scene.cfg")
    common/run/look.sh slices "$bin" "$1/slice" "$2" "${configs[@]}"
}
if [ "$goal" = verify ]; then
    ! is_at_work || usage "A run works on scene $scene. What it makes is not yet in the ledger: wait until it ends."
    exec "$bin/verify" --threads "$cores" --scene "$S" --run "$O"
fi
quality_config=("configs/$REMODEL_QUALITY.cfg")
[ "$REMODEL_QUALITY" != default ] || quality_config=()

# the films of this run, and auto or all, which are known once the subjects are
effects=() choose=
hooks begin
print_graph check
hooks check
# a plan and a status are dry runs whose commands are counted
planning=
case $goal in plan | status) planning=$goal dry=n goal=${REMODEL_TO:-all} ;; esac

# a lens is said once: later runs find it in scene.cfg
if [ -n "${REMODEL_LENS-}" ]; then
    [[ $REMODEL_LENS =~ ^[A-Z_]+$ ]] || usage "LENS=$REMODEL_LENS: wanted a camera model, such as EQUISOLID or OPENCV."
    [ ! -e "$folder/scene.cfg" ] || grep -qE "^[[:space:]]*camera_model[[:space:]]*=[[:space:]]*${REMODEL_LENS}[[:space:]]*\$" "$folder/scene.cfg" ||
        usage "LENS=$REMODEL_LENS is for a new scene, but $folder/scene.cfg exists and names no such lens. Write camera_model = $REMODEL_LENS in its section [sfm]."
fi
# is_photos: PHOTOS is a folder or a clip, or names clips; names with blanks are quoted
is_photos()
{
    local n
    [ ! -e "$REMODEL_PHOTOS" ] || return 0
    while IFS= read -r -d '' n; do [ -f "$n" ] || return 1; done < <(xargs printf '%s\0' 2>/dev/null <<<"$REMODEL_PHOTOS")
    [ -n "${n-}" ]
}
if [ ! -e "$folder/scene.mk" ]; then
    [ -n "${REMODEL_PHOTOS-}" ] || usage "There is no $folder/scene.mk. Give the folder of photos to begin: make PHOTOS=DIR $again"
    is_photos || usage "PHOTOS=$REMODEL_PHOTOS is neither a folder nor a list of clips. Give the folder that holds the photos, or clips; quote names with blanks."
    # by their names: nothing is created for what cannot be photos
    [ ! -f "$REMODEL_PHOTOS" ] || case ${REMODEL_PHOTOS,,} in
        *.zip | *.rar | *.7z | *.tar | *.gz | *.tgz) usage "PHOTOS=$REMODEL_PHOTOS is an archive. Unpack it, and give the folder of its photos." ;;
        *.jpg | *.jpeg | *.png | *.tif | *.tiff | *.hei[cf] | *.webp | *.avif | *.jxl | *.exr | *.dng)
            usage "PHOTOS=$REMODEL_PHOTOS is one photo. Give the folder that holds all photos of the scene." ;;
    esac
    if [ "$dry" = n ]; then echo "would create $folder/scene.mk and scene.cfg, and go on from there"; exit 0; fi
    common/run/new_scene.sh "$folder" "$goal"
fi
[ -n "${REMODEL_PHOTOS-}" ] || usage "$folder/scene.mk sets no PHOTOS. Add a line PHOTOS := DIR, the folder of the photos."
mkdir -p "$S"
if [ "$dry" != n ] && [ "$goal" != why ]; then
    exec 9>"$S/.lock"
    if ! flock -w 1 9; then # `make status` looks at it for a moment
        echo "Another run works on scene $scene (or a process that an ended run left behind). Wait until it ends, or end it, and try again." >&2
        exit 1
    fi
fi
if [ "$dry" != n ] || [ -n "$planning" ]; then
    work=$(mktemp -d "${TMPDIR:-/tmp}/remodel.XXXXXX")
    trap 'rm -rf "$work"' EXIT
fi
[ "$planning" != status ] || . common/run/status_scene.sh
if [ "$dry" != n ] && [ "$goal" != why ]; then
    record_run "$([ "$goal" = all ] && echo report || echo "$goal")"
    trap 'end_run "$?"; rm -rf "$work"' EXIT
fi

hooks prepare
slices "$O" "$REMODEL_STAGES" "${quality_config[@]}"
# what all qualities share does not follow the parameters of one
slices "$S" "$REMODEL_SHARED_STAGES"
for s in $REMODEL_STAGES; do [ ! -e "stages/$s/look.sh" ] || "stages/$s/look.sh" "$bin" "$S" "$O" "$folder"; done
hooks look
if [ "$goal" = why ]; then
    graph -n --debug=b --no-print-directory ${choose:+choice} report | common/run/explain.sh why "$S" "$O"
    exit 0
fi
[ "$goal" != all ] || goal=report
case $planning in
plan) . common/run/plan_scene.sh ;;
status) print_graph write; print_status; exit 0 ;;
esac
if [ "$dry" = n ]; then
    [ -e "$O/views/views.mk" ] || echo "# not known before structure from motion has run: which views there are"
    first=()
    hooks dry
    graph T="$cores" "${first[@]}" "$goal"
    exit 0
fi

steps=$(print_graph steps "$goal")
mapfile -t steps <<<"$steps"
n=0
while read -r stage run step <&3; do
    record_step $((++n)) "${#steps[@]}" "$stage" "$step"
    if is_function "run_$step"; then "run_$step"
    elif [ "$run" = farm ]; then farm "$stage" "$step"
    elif [ "$run" = wide ]; then farm_frames "$stage" "$step"
    else one "$step"; fi
done 3< <(printf '%s\n' "${steps[@]}")
hooks end
