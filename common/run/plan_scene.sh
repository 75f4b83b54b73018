# plan_scene.sh - `make plan`: what a run up to a goal would take. Sourced by run_scene.sh once the photos have been read.
#
# It counts the commands that the graph would run. What is not yet known is said: pieces of work that only a product will
# list, and stages that have no estimate ("?").

matches_word() { case " $2 " in *" $1 "*) ;; *) return 1 ;; esac; } # WORD LIST

# plan_row STAGE: its commands are in $work/of.STAGE. Numbers for the table, "?" for what is not known
plan_row()
{
    local pieces estimate size lines=${VIEWS_PER_JOB-} cpus=1 tasks=- mib=0
    pieces=$(wc -l <"$work/of.$1")
    estimate=$(work_of "$1" <"$work/of.$1")
    if grep -q 'run_stage.sh quiet ' "$work/of.$1"; then
        # work that takes all cores is a task a piece
        if matches_word "$1" "$wide_stages"; then lines=1 cpus=$cores; fi
        # shellcheck disable=SC2086 # five numbers, or none
        size=$(common/run/job_size.sh "$cpus" "$lines" $estimate)
        read -r lines mib _ <<<"$size"
        tasks=$(((pieces + lines - 1) / lines))
    fi
    echo "$1 $pieces $tasks ${mib:-0} ${estimate:-0 0 0 0 0}"
}

print_plan()
{
    local stage
    print_graph write
    commands_to_come >"$work/commands"
    for stage in $REMODEL_STAGES; do
        grep -aE "run_stage.sh [a-z]+ $stage " "$work/commands" >"$work/of.$stage" || continue
        plan_row "$stage"
    done | awk '
        function known(x, text) { return x > 0 ? text : "?" }
        BEGIN { printf "%-16s %7s %7s %11s %11s %12s\n", "stage", "pieces", "tasks", "core-hours", "GiB a task", "GiB written" }
        {
            printf "%-16s %7d %7s %11s %11s %12s\n", $1, $2, $3, known($5, sprintf("%.2f", $6 / 3600)),
                known($5, sprintf("%.2f", ($3 == "-" ? $7 : $4) / 1024)), known($5, sprintf("%.2f", $8 / 2^30))
            pieces += $2; tasks += $3; hours += $6 / 3600; gib += $8 / 2^30
            if ($5 == 0) unknown = unknown (unknown == "" ? "" : ", ") $1
        }
        END {
            if (!NR) { print "Nothing is stale."; exit }
            printf "%-16s %7d %7d %11.2f %11s %12.2f\n", "known of all", pieces, tasks, hours, "", gib
            print "tasks: of a job array with JOBS=slurm; -: made here, by one process at a time"
            if (unknown != "") print "?: these have no estimate: " unknown
        }'
    [ -e "$O/views/views.mk" ] || echo "not known before structure from motion has run: which views there are, and all that is made of them"
    hooks unknown
}
case $goal in all) goal=report ;; esac
wide_stages=$(print_graph steps "$goal" | awk '$2 == "wide" { print $1 }' | tr '\n' ' ')
print_plan
exit 0
