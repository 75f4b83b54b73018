#!/usr/bin/env bash
# run_lines.sh [FOLDER KIB] - runs lines of a plan, from standard input; one process makes all that it can make together.
#
# A line is "PRODUCTS<tab>COMMAND[<tab>OWN]" (common/make/graph.mk). Lines that follow each other and have OWN, and whose
# commands are the same but for the item, are one process with the options OWN of all: what their pieces of work share is
# read once. Standard output gets a word for each line, in order, as soon as it has ended: its exit status, or disk: there
# were less than KIB KiB free on the disk of FOLDER, and it was not begun. Exits with 1 if any word is not 0.
#
# Such a process ends the words of each piece by "STAGE: made 2 of 7: NAME" or "failed" (common/base/cli.h); the log of an
# item has its own words. If it is killed in the middle of a piece, this piece has failed, and a new process makes those behind it.
# If it fails before the first piece, all of its pieces have failed.
set -u
room=${1-} kib=${2-}
export OMP_WAIT_POLICY=${OMP_WAIT_POLICY-passive}
MOST=200 # pieces for a process: what the system takes as arguments is limited
failed=0

# word WORD: of the next line
word()
{
    [ "$1" = 0 ] || failed=1
    echo "$1"
}
disk_is_full() { [ -n "$room" ] && [ "$(df --output=avail -k "$room" | tail -n 1)" -lt "$kib" ]; }
# said COMMAND: shown where V is set
said() { [ -z "${V-}" ] || echo "$1" >&2; }

run_one() # COMMAND
{
    if disk_is_full; then word disk; return; fi
    said "$1"
    bash -c "$1" >&2
    word $?
}

# the group of lines at hand: their items and own options, and the parts of their command
items=() own=()
run='' mode='' stage='' folder='' program=''
at=0     # the item that is being made
words='' # what the process has said of it

# ended STATUS: of the item at hand
ended()
{
    printf %s "$words" | "$run" "$mode" "$stage" "${items[at]}" "$folder" bash -c 'cat >&2; exit "$0"' "$1" >&2
    word "$1"
    at=$((at + 1)) words=''
}
# run_items: one process for the items from `first` on, until it ends; sets rc to its status
run_items()
{
    local line command="exec $program ${own[*]:first}"
    said "${command#exec }"
    while IFS= read -r line; do
        case $line in
        "$stage: made $((at - first + 1)) of $((${#items[@]} - first)): "*) ended 0 ;;
        "$stage: failed $((at - first + 1)) of $((${#items[@]} - first)): "*) ended 1 ;;
        *) words+=$line$'\n'; continue ;;
        esac
        if [ "$at" -lt "${#items[@]}" ] && disk_is_full; then kill "$!"; break; fi
    done < <(exec bash -c "$command" 2>&1 >/dev/null)
    wait "$!"
    rc=$?
}
# run_group: makes the group, and empties it
run_group()
{
    local first rc shared
    at=0 words=''
    while [ "$at" -lt "${#items[@]}" ]; do
        if disk_is_full; then word disk; at=$((at + 1)); continue; fi
        first=$at
        run_items
        [ "$at" -lt "${#items[@]}" ] || break
        # all fail for one reason, or the process was for one item and said nothing of it
        if [ "$at" = "$first" ] && [ "$rc" -le 128 ]; then
            [ "$rc" != 0 ] || [ "$at" = $((${#items[@]} - 1)) ] || rc=1
            shared=$words
            while [ "$at" -lt "${#items[@]}" ]; do words=$shared; ended "$rc"; done
        elif ! disk_is_full; then ended $((rc == 0 ? 1 : rc)); fi
    done
    items=() own=()
}

while IFS=$'\t' read -r _ command options <&3; do
    if [ -z "$options" ]; then run_group; run_one "$command"; continue; fi
    read -r new_run new_mode new_stage item new_folder new_program <<<"$command"
    if [ "${#items[@]}" = "$MOST" ] || [ "$run $mode $stage $folder $program" != "$new_run $new_mode $new_stage $new_folder $new_program" ]; then
        run_group
        run=$new_run mode=$new_mode stage=$new_stage folder=$new_folder program=$new_program
    fi
    items+=("$item") own+=("$options")
done 3<&0 </dev/null
run_group
exit "$failed"
