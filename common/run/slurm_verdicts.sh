#!/usr/bin/env bash
# slurm_verdicts.sh STAGE PLAN FOLDER LINES MOST JOBS - what a job array made: exit 1, and FOLDER/failed.txt, if not everything.
#
# LINES of the plan made a task; MOST tasks made an array; JOBS: the arrays' ids. A line of failed.txt is a piece of work, the
# reason and its log, with tabs between them.
set -euo pipefail
stage=$1 plan=$2 folder=$3 lines=$4 most=$5 jobs=$6
declare -A verdict=()
read_verdicts()
{
    local line word
    while read -r line word; do [ "${verdict[$line]-}" = 0 ] || verdict[$line]=$word
    done < <(cat "$folder"/verdicts/* 2>/dev/null | sed -n 's/ end$//p')
}
# the states of the array's last tasks; Slurm forgets older ones
declare -A state=()
read_states()
{
    local array task word
    while read -r array task word; do state[$array.$task]=$word
    done < <(squeue -h -r -t all -j "$jobs" -o '%F %K %T' 2>/dev/null || true)
}
# why_no_verdict TASK: in words; a task's last words count, and then its state
why_no_verdict()
{
    local first=$(($1 / most * most)) ids word out
    IFS=, read -r -a ids <<<"$jobs"
    out=$(grep -a 'slurmstepd: ' "$folder/$first+$(($1 - first)).out" 2>/dev/null | tail -n 2 || true)
    word=${state[${ids[$(($1 / most))]}.$(($1 - first))]-}
    case $out in
    *'TIME LIMIT'*) word=TIMEOUT ;;
    *oom* | *'emory limit'*) word=OUT_OF_MEMORY ;;
    *PREEMPT*) word=PREEMPTED ;;
    *'NODE FAIL'*) word=NODE_FAIL ;;
    *CANCELLED*) word=${word:-CANCELLED} ;;
    esac
    if grep -qx "${ids[$(($1 / most))]}_$(($1 - first))" "$folder/held" 2>/dev/null; then word=HELD; fi
    case $word in
    TIMEOUT) echo "its task ran out of time" ;;
    OUT_OF_MEMORY) echo "its task ran out of memory" ;;
    PREEMPTED) echo "its task had to make way for another job" ;;
    NODE_FAIL) echo "its node was lost" ;;
    HELD) echo "its task could not be started on the node" ;;
    CANCELLED*) echo "its task was cancelled" ;;
    *) if [ "$(df --output=avail -k "$folder" | tail -n 1)" -lt 1024 ]; then echo "the disk is full"
       else echo "its task ended without a verdict"; fi ;;
    esac
}
# why LINE: in words; LOG is the log of the piece
why()
{
    local last
    last=$(grep -a ': error: ' "$2" 2>/dev/null | tail -n 1 | tr '\t' ' ' || true)
    case ${verdict[$1]-} in
    '') why_no_verdict $((($1 - 1) / lines)) ;;
    0) echo "its products are missing on this side of the file system" ;;
    unwhole) echo "its products are not whole" ;;
    disk) echo "the disk is full${last:+; $last}" ;;
    term | 143) case $(why_no_verdict $((($1 - 1) / lines))) in
          *out\ of\ time*) echo "its task ran out of time" ;;
          *way*) echo "its task had to make way for another job" ;;
          *) echo "it was ended by a signal" ;;
          esac ;;
    137) echo "it was killed; perhaps it ran out of memory" ;;
    *) echo "${last:-exit status ${verdict[$1]}}" ;;
    esac
}
# all_there PRODUCTS
all_there() { local p; for p in $1; do [ -s "$p" ] || return 1; done; }

# judge: sets bad to the numbers of the lines whose verdict is not good or whose products are not here
judge()
{
    local products i=0
    bad=()
    read_verdicts
    while IFS=$'\t' read -r products _; do
        i=$((i + 1))
        { [ "${verdict[$i]-}" = 0 ] && all_there "$products"; } || bad+=("$i")
    done <"$plan"
}
judge
# on a shared file system what a node wrote may show a little later
for ((try = 0; try < 5 && ${#bad[@]} > 0; try++)); do sleep 0.2; judge; done
[ "${#bad[@]}" -gt 0 ] || { rm -f "$folder/reserve"; exit 0; }
read_states
mapfile -t all <"$plan"
list=
for i in "${bad[@]}"; do
    # the command of a line: common/run/run_stage.sh MODE STAGE ITEM FOLDER ...
    command=${all[$((i - 1))]#*$'\t'}
    read -r -a words <<<"${command#*/run_stage.sh }"
    log=${words[3]-}/log/${words[1]-}.${words[2]-}.log
    list+="${words[2]-line $i}"$'\t'$(why "$i" "$log")$'\t'$log$'\n'
done
rm -f "$folder/reserve"
{
    head -n 3 <<<"${list%$'\n'}" | awk -F '\t' -v stage="$stage" '{ print stage ": " $1 ": " $2 " (" $3 ")" }'
    printf '%s' "$list" >"$folder/failed.txt.new" && mv "$folder/failed.txt.new" "$folder/failed.txt" ||
        { rm -f "$folder/failed.txt.new"; echo "$stage: $folder/failed.txt could not be written. The pieces that were not made:"; printf '%s' "$list"; }
    echo "$stage: ${#bad[@]} of ${#all[@]} pieces of work failed on the cluster; $folder/failed.txt lists them. What was made is kept; run make again to make the rest."
} >&2
exit 1
