#!/usr/bin/env bash
# slurm_task.sh FOLDER FIRST KIB BIN - one task of a job array: its pieces of work without a good verdict, in order.
#
# FIRST: the first task of this array; KIB: free space below which the disk counts as full. A verdict is a line "LINE WORD end": 0, or the exit status,
# or term (ended by a signal), disk (full), unwhole (`verify` found products that are not whole). One file for each
# attempt: a node that was given up may still be writing.
set -u -m # the pieces' processes are a process group, which a signal reaches as a whole
folder=$1 task=$(($2 + SLURM_ARRAY_TASK_ID)) kib=$3 bin=$4
verdicts=$folder/verdicts/$task
attempt=$verdicts.${SLURM_RESTART_COUNT:-0}
child='' line=0

# a verdict that cannot be written ends the task: no later one could be, either. The newline before it ends a half-written one
verdict()
{
    printf '\n%s %s end\n' "$line" "$1" >>"$attempt" || exit 75
}
disk_is_full() { [ "$(df --output=avail -k "$folder" | tail -n 1)" -lt "$kib" ]; }
# shellcheck disable=SC2317 # a trap runs it
ended()
{
    local had
    trap '' TERM
    if [ -n "$child" ]; then
        kill -TERM -- "-$child" 2>/dev/null
        wait "$child"
        had=$(grep -c ' end$' "$attempt" 2>/dev/null) # the piece behind those that have a verdict was being made
        line=${numbers[${had:-0} - ${before:-0}]-}
        [ -z "$line" ] || verdict term
    fi
    exit 143
}

# the lines to run, and their numbers in the plan
good=" $(cat "$verdicts".* 2>/dev/null | sed -n 's/ 0 end$//p' | tr '\n' ' ')"
numbers=() products=() lines=''
while IFS=$'\t' read -r line made command; do
    [[ $good != *" $line "* ]] || continue
    numbers+=("$line") products+=("$made") lines+=$made$'\t'$command$'\n'
done <"$folder/tasks/$(printf %06d "$task")"
before=$(grep -c ' end$' "$attempt" 2>/dev/null)
trap ended TERM

# judge: a verdict for each word of run_lines.sh
judge()
{
    local i=0 word p files
    while read -r word; do
        line=${numbers[i]}
        if [ "$word" = 0 ]; then
            files=()
            for p in ${products[i]}; do files+=(--file "$p"); done
            "$bin/verify" "${files[@]}" || word=unwhole
        elif disk_is_full; then word=disk
        fi
        verdict "$word"
        i=$((i + 1))
    done
}
(set +m; printf %s "$lines" | common/run/run_lines.sh "$folder" "$kib" | judge) &
child=$!
wait "$child"
rc=$?
# without a judge the rest would be made for nothing
[ "$rc" = 0 ] || kill -TERM -- "-$child" 2>/dev/null
exit "$rc"
