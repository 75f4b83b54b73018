# run_record.sh - what a run writes down while it works, for `make status` and for ON_DONE. Sourced; S is the folder of what all
# qualities of a scene share.
#
# S/log/run.txt: lines "goal GOAL", "folder O", "jobs local|slurm", "began SECONDS"; "step I N STAGE STEP SECONDS" as each step
# begins; "ended SECONDS STATUS" at the end. SECONDS are of the clock. A run that was killed has no last line.
# S/log/ledger.txt: what was made and given, for `make verify` (common/base/ledger.h).
# S/log/run.tally: of the step at work, if it has several pieces: "SECONDS COUNT", and a line for each piece that is made.

record_run() # GOAL
{
    mkdir -p "$S/log/ledger"
    export REMODEL_LEDGER=$PWD/$S/log/ledger
    printf '%s\n' "goal $1" "folder $O" "jobs $jobs" "began $(date +%s)" >"$S/log/run.txt"
    rm -f "$S/log/run.tally"
}
record_step() # I N STAGE STEP
{
    [ ! -e "$S/log/run.tally" ] || rm -f "$S/log/run.tally"
    printf 'step %s %(%s)T\n' "$*" -1 >>"$S/log/run.txt"
}
# begin_tally COUNT: run_stage.sh adds a line for each of so many pieces
begin_tally()
{
    echo "$(date +%s) $1" >"$S/log/run.tally"
    export REMODEL_TALLY=$S/log/run.tally
}
# recorded WORD: the last value of a word
recorded() { sed -n "s/^$1 //p" "$S/log/run.txt" | tail -n 1; }
# gather_ledger RESULT: after a run that is done, what people gave belongs to what was made
gather_ledger()
{
    local given=() v n
    if [ "$1" = "done" ]; then
        given=(--given "$folder")
        for v in $REMODEL_PASSED; do # such as SFM and LRI
            n=REMODEL_$v
            if [ "$v" = PHOTOS ] || [ ! -e "${!n-}" ]; then continue; fi
            given+=(--given "${!n}")
        done
        if [ -e "$REMODEL_PHOTOS" ]; then given+=(--photos "$REMODEL_PHOTOS")
        else while IFS= read -r -d '' n; do given+=(--photos "$n"); done < <(xargs printf '%s\0' <<<"$REMODEL_PHOTOS"); fi
    fi
    "$bin/verify" --gather --scene "$S" "${given[@]}" 2>&1 | grep -v ': used ' >&2 || true
}
# end_run STATUS: the record's last line; then the command of ON_DONE, which neither holds the lock nor changes how the run ended
end_run()
{
    local result="done"
    [ "$1" = 0 ] || result=failed
    echo "ended $(date +%s) $1" >>"$S/log/run.txt"
    gather_ledger "$result"
    [ -n "${REMODEL_ON_DONE-}" ] || return 0
    REMODEL_SCENE=${S##*/} REMODEL_FOLDER=$O REMODEL_RESULT=$result REMODEL_SECONDS=$(($(date +%s) - $(recorded began))) \
        bash -c "$REMODEL_ON_DONE" 9>&- || echo "ON_DONE: the command ended with status $?; the run itself: $result." >&2
}

is_at_work() { [ -e "$S/.lock" ] && ! flock -n "$S/.lock" true; }
# span SECONDS: "2 h 05 min", "4 min", "30 s"
span()
{
    if [ "$1" -ge 3600 ]; then printf '%d h %02d min' $(($1 / 3600)) $(($1 % 3600 / 60))
    elif [ "$1" -ge 60 ]; then printf '%d min' $((($1 + 30) / 60))
    else printf '%d s' "$1"; fi
}
clock() { date -d "@$1" '+%Y-%m-%d %H:%M'; }
# tallied STAGE SINCE: "MADE COUNT SECONDS" of the step at work, if it has several pieces
tallied()
{
    local folder began=$2 count=0 made=0
    folder=$(recorded folder)/jobs/$1
    if [ -e "$S/log/run.tally" ]; then { read -r began count; made=$(wc -l); } <"$S/log/run.tally"
    elif [ "$(recorded jobs)" = slurm ] && [ -e "$folder/jobs" ]; then
        count=$(cat "$folder"/tasks/* | wc -l)
        made=$(cat "$folder"/verdicts/* 2>/dev/null | grep -c ' 0 end$' || true)
    fi
    [ "$count" = 0 ] || echo "$made $count $(($(date +%s) - began))"
}
# say_run SCENE: what its run does, or how the last one ended
say_run()
{
    local began ended status i n stage step since made count seconds where='' left=''
    if [ ! -e "$S/log/run.txt" ]; then echo "$1: no run has begun"; return; fi
    began=$(recorded began)
    read -r ended status <<<"$(recorded ended)"
    read -r i n stage step since <<<"$(recorded step)"
    [ -z "$i" ] || where=", in step $i of $n ($step)"
    if is_at_work; then
        read -r made count seconds <<<"$(tallied "$stage" "$since")"
        [ "${made:-0}" = 0 ] || left=", about $(span $((seconds * (count - made) / made))) left of the step"
        echo "$1: at work towards $(recorded goal) since $(clock "$began"), $(span $(($(date +%s) - began))), in $(recorded folder)$where${count:+, $made of $count pieces}$left"
    elif [ -z "$ended" ]; then echo "$1: the run towards $(recorded goal) of $(clock "$began") was ended without a word$where"
    elif [ "$status" = 0 ]; then echo "$1: the run towards $(recorded goal) ended well at $(clock "$ended"), after $(span $((ended - began)))"
    else echo "$1: the run towards $(recorded goal) failed at $(clock "$ended"), after $(span $((ended - began)))$where"
    fi
}
