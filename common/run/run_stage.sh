#!/usr/bin/env bash
# run_stage.sh live|quiet|silent STAGE ITEM FOLDER COMMAND... - runs one stage; its words go to FOLDER/log/STAGE.ITEM.log.
#
# live: they are shown as they come. quiet: its warnings, and one line when the stage has ended, with the time left when REMODEL_TALLY
# (a file, begun by run_record.sh) says how many there are. silent: not even that. A failure shows the log's end; the product
# that was there before is left alone.
set -uo pipefail
mode=$1 stage=$2 item=$3 folder=$4; shift 4
# threads with nothing to do sleep, not spin: on a machine with other work spinning takes the core from who has work
export OMP_WAIT_POLICY=${OMP_WAIT_POLICY-passive}
[ -d "$folder/log" ] || mkdir -p "$folder/log"
log=$folder/log/$stage.$item.log
failed=$folder/log/$stage.$item.failed # for `make status`
[ ! -e "$failed" ] || rm -f "$failed"
if [ "$mode" = live ]; then
    "$@" 2>&1 >/dev/null | tee "$log" >&2
    rc=${PIPESTATUS[0]}
else
    "$@" 2>"$log"
    rc=$?
fi
if [ "$rc" -ne 0 ]; then
    echo "$rc" >"$failed"
    {
        [ "$rc" -le 128 ] || echo "$stage: $item was ended by signal $((rc - 128))$([ "$rc" -ne 137 ] || echo ' (killed: perhaps there was not enough memory)')."
        [ "$mode" = live ] || { echo "$stage: $item failed; the end of $log says:"; tail -n 5 "$log" | sed 's/^/    /'; }
    } >&2
    exit "$rc"
fi
[ "$mode" = quiet ] || exit 0
# by the shell alone where it can: a house has thousands of pieces, and each program that starts costs milliseconds
{ words=$(<"$log"); } 2>/dev/null
[[ $words != *': warning: '* ]] || grep -a '^[a-z_]*: warning: ' "$log" >&2 || true
if [ -n "${REMODEL_TALLY-}" ] && [ -e "$REMODEL_TALLY" ]; then
    echo "$item" >>"$REMODEL_TALLY"
    { read -r began count; mapfile -t made; } <"$REMODEL_TALLY"
    done=${#made[@]}
    printf -v now '%(%s)T' -1
    left=$(((now - began) * (count - done) / (done > 0 ? done : 1)))
    printf '%s %d/%d %s, about %d:%02d left\n' "$stage" "$done" "$count" "$item" $((left / 60)) $((left % 60)) >&2
else
    printf '%s %s\n' "$stage" "$item" >&2
fi
