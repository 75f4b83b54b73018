#!/usr/bin/env bash
# slurm_task.sh FOLDER FIRST KIB BIN - one task of a job array: its pieces of work without a good verdict, in order.
#
# FIRST: the first task of this array; KIB: free space below which the disk counts as full. A verdict is a line "LINE WORD end": 0, or the exit status,
# or term (ended by a signal), disk (full), unwhole (`verify` found products that are not whole). One file for each
# attempt: a node that was given up may still be writing.
set -u -m # each command is a process group, which a signal reaches as a whole
folder=$1 task=$(($2 + SLURM_ARRAY_TASK_ID)) kib=$3 bin=$4
verdicts=$folder/verdicts/$task
line=0 child=

# a verdict that cannot be written ends the task: no later one could be, either. The newline before it ends a half-written one
verdict()
{
    printf '\n%s %s end\n' "$line" "$1" >>"$verdicts.${SLURM_RESTART_COUNT:-0}" || exit 75
}
disk_is_full() { [ "$(df --output=avail -k "$folder" | tail -n 1)" -lt "$kib" ]; }
ended()
{
    trap '' TERM
    [ -z "$child" ] || { kill -TERM -- "-$child" 2>/dev/null; wait "$child"; verdict term; }
    exit 143
}
trap ended TERM

good=" $(cat "$verdicts".* 2>/dev/null | sed -n 's/ 0 end$//p' | tr '\n' ' ')"
while IFS=$'\t' read -r line products command <&3; do
    [[ $good != *" $line "* ]] || continue
    if disk_is_full; then verdict disk; continue; fi
    bash -c "$command" 3<&- &
    child=$!
    wait "$child"
    rc=$?
    child=
    if [ "$rc" = 0 ]; then
        files=()
        for p in $products; do files+=(--file "$p"); done
        "$bin/verify" "${files[@]}" || rc=unwhole
    elif disk_is_full; then rc=disk
    fi
    verdict "$rc"
done 3<"$folder/tasks/$(printf %06d "$task")"
