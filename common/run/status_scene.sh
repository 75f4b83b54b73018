# status_scene.sh - `make status`: what of a goal is made, stale and failed, and how long the rest may take. Sourced by
# run_scene.sh; makes nothing, and looks at a run at work without disturbing it.
#
# A run at work is known by its lock, and says in S/log/run.txt what it does (common/run/run_record.sh).

# stage_items: of commands, one a line, "STAGE ITEM"
stage_items() { sed -nE 's|.*/run_stage.sh [a-z]+ ([a-z_]+) ([^ ]+) .*|\1 \2|p'; }

# print_status: a row for each stage of the goal, and what is left
print_status()
{
    local failed
    commands_to_come >"$work/commands"
    stage_items <"$work/commands" >"$work/stale"
    commands_to_come -B | stage_items >"$work/all"
    failed=$(find "$O/log" -name '*.failed' -printf '%f\n' 2>/dev/null | sed 's/\.failed$//' | LC_ALL=C sort)
    awk -v stages="$REMODEL_STAGES" -v failed="$failed" '
        FILENAME ~ /stale$/ { stale[$1]++; next }
        { all[$1]++ }
        END {
            n = split(failed, f, "\n")
            for (i = 1; i <= n; i++) { split(f[i], part, "."); if (stale[part[1]]) bad[part[1]]++ }
            printf "%-18s %7s %7s %7s\n", "stage", "made", "stale", "failed"
            n = split(stages, s, " ")
            for (i = 1; i <= n; i++) if (all[s[i]]) printf "%-18s %7d %7d %7d\n", s[i], all[s[i]] - stale[s[i]], stale[s[i]], bad[s[i]]
        }' "$work/stale" "$work/all"
    [ ! -s "$work/stale" ] && echo "Nothing is stale." && return
    say_left
    say_failed "$failed"
}

# say_left: from the estimates of the stages
say_left()
{
    local stage seconds total=0 unknown=()
    for stage in $REMODEL_STAGES; do
        grep -aE "run_stage.sh [a-z]+ $stage " "$work/commands" >"$work/of.$stage" || continue
        read -r _ seconds _ <<<"$(work_of "$stage" <"$work/of.$stage")"
        if [ -n "$seconds" ]; then total=$(awk -v a="$total" -v b="$seconds" 'BEGIN { print a + b }'); else unknown+=("$stage"); fi
    done
    echo "left: about $(span "$(awk -v t="$total" -v c="$cores" 'BEGIN { printf "%d", t / c }')") on $cores cores, by the stages' estimates${unknown:+; these have none: ${unknown[*]}}"
    [ -e "$O/views/views.mk" ] || echo "Which views there are is not known yet, so that what is made of them is not counted."
}

# say_failed NAMES: the last words of pieces that failed
say_failed()
{
    local name
    for name in $1; do
        grep -q "^${name%%.*} " "$work/stale" || continue
        echo "failed: ${name%%.*} ${name#*.}; $O/log/$name.log ends with:"
        tail -n 2 "$O/log/$name.log" | sed 's/^/    /'
    done
}

say_run "$scene"
# a run at work has printed the graph, and goes on printing it
if is_at_work; then
    goal=${REMODEL_TO:-$(recorded goal)}
    [ ! -e "$O/graph/all.mk" ] || print_status
    exit 0
fi
