#!/usr/bin/env bash
# slurm.sh STAGE PLAN FOLDER CPUS LINES [ITEMS SECONDS MIB BYTES LONGEST] - runs a plan's lines as Slurm job arrays.
#
# PLAN: lines of "PRODUCTS<tab>COMMAND", frozen now: jobs do not look at the graph again. A task has CPUS cores; LINES of the
# plan make one, or what job_size.sh finds where LINES is empty. The last five are the stage's estimate; it sets memory and
# time limit of a task. SLURM_ARGS comes after them, so that a user's word counts.
#
# Nothing is taken on trust: each line needs a good verdict, which its task writes after `verify` has read the products on the
# node. A task that Slurm starts again on another node skips the lines that have one. Afterwards FOLDER/failed.txt lists
# the pieces of work that were not made, why, and their logs; there is no such file if all were. The next run makes those.
# Where a task ran out of time or memory, the next run gives twice as much.
#
# FOLDER: tasks/N lines of task N, verdicts/N.ATTEMPT, N.out its words, limits "MIB MINUTES", jobs, reserve, failed.txt
set -euo pipefail
stage=$1 plan=$2 folder=$3 cpus=$4 lines=$5; shift 5
here=$(dirname "$0")
command -v sbatch >/dev/null || { echo "JOBS=slurm: sbatch is not there. Install slurm-client, or run with JOBS=local." >&2; exit 2; }

# what a run left behind that was killed may still be at work
if [ -e "$folder/jobs" ]; then
    left=$(paste -sd, "$folder/jobs")
    # shellcheck disable=SC2046 # a list of numbers
    scancel --quiet --name="remodel-$stage" $(cat "$folder/jobs") 2>/dev/null || true
    while [ -n "$(squeue -h --name="remodel-$stage" -j "$left" -o '%i' 2>/dev/null)" ]; do sleep 0.5; done
fi
read -r lines mib minutes <<<"$("$here/job_size.sh" "$cpus" "$lines" "$@")"
if [ -e "$folder/failed.txt" ] && [ "$minutes" -gt 0 ]; then
    read -r old_mib old_minutes <"$folder/limits"
    ! grep -q 'ran out of time' "$folder/failed.txt" || minutes=$((minutes > 2 * old_minutes ? minutes : 2 * old_minutes))
    ! grep -q 'ran out of memory' "$folder/failed.txt" || mib=$((mib > 2 * old_mib ? mib : 2 * old_mib))
fi
rm -rf "$folder"; mkdir -p "$folder/tasks" "$folder/verdicts"
echo "$mib $minutes" >"$folder/limits"
awk '{ print NR "\t" $0 }' "$plan" | split -l "$lines" -d -a 6 - "$folder/tasks/"
count=$(wc -l <"$plan")
tasks=$(((count + lines - 1) / lines))
piece_kib=$(awk -v items="${1:-0}" -v bytes="${4:-0}" 'BEGIN { k = items > 0 ? int(bytes / items / 1024) : 0; print (k > 1024 ? k : 1024) }')

# room for failed.txt, should the disk be full by then
head -c $((count * 300)) /dev/zero >"$folder/reserve"

# an index must be below MaxArraySize, so that a large plan is several arrays
most=$(scontrol show config | sed -nE 's/^MaxArraySize *= *([0-9]+).*/\1/p' || true)
most=${most:-1001}
limits=()
[ "$mib" = 0 ] || limits=(--mem="${mib}M" --time="$minutes")
ids=()
trap '[ "${#ids[@]}" = 0 ] || scancel "${ids[@]}" 2>/dev/null || true' INT TERM
for ((first = 0; first < tasks; first += most)); do
    last=$((tasks - first < most ? tasks - first - 1 : most - 1))
    # shellcheck disable=SC2086 # SLURM_ARGS is a list of options
    id=$(sbatch --parsable --array=0-"$last" --cpus-per-task="$cpus" --job-name="remodel-$stage" --chdir="$PWD" \
        --output="$folder/$first+%a.out" --export=ALL --requeue --open-mode=append "${limits[@]}" ${SLURM_ARGS-} \
        "$here/slurm_task.sh" "$folder" "$first" "$piece_kib" "${REMODEL_BIN:?}") ||
        { echo "$stage: sbatch refused the job array; its words are above." >&2
          [ "${#ids[@]}" = 0 ] || scancel "${ids[@]}"; exit 1; }
    ids+=("${id%%;*}")
    echo "${id%%;*}" >>"$folder/jobs"
done
all=$(IFS=,; echo "${ids[*]}")
echo "$stage: job $all of $tasks tasks, $count pieces of work$([ "$mib" = 0 ] || echo ", $lines a task with $mib MiB and $minutes minutes")" >&2

# waits until no task is left; asks less and less often, so that many runs do not burden the scheduler
began=$(date +%s) shown=-1 pause=0.5
while state=$(squeue -h -j "$all" -o '%i %r' 2>&1) || [[ $state != *[Ii]nvalid\ job\ id* ]]; do
    [ -n "$state" ] || break
    # Slurm holds a task whose launch failed on its node; nobody would release it
    held=$(sed -n 's/ launch failed requeued held$//p' <<<"$state")
    # shellcheck disable=SC2086 # a list of tasks
    [ -z "$held" ] || { echo "$held" >>"$folder/held"; scancel $held 2>/dev/null || true; }
    done=$(cat "$folder"/verdicts/* 2>/dev/null | grep -c ' 0 end$' || true)
    if [ "$done" -ne "$shown" ]; then
        shown=$done
        left=$((($(date +%s) - began) * (count - done) / (done > 0 ? done : 1)))
        printf '%s %d/%d on the cluster%s\n' "$stage" "$done" "$count" "$([ "$done" = 0 ] || printf ', about %d:%02d left' $((left / 60)) $((left % 60)))" >&2
    fi
    sleep "$pause"
    pause=$(awk -v p="$pause" 'BEGIN { p *= 1.05; print (p < 10 ? p : 10) }')
done
"$here/slurm_verdicts.sh" "$stage" "$plan" "$folder" "$lines" "$most" "$all"
