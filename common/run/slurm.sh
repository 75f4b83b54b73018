#!/usr/bin/env bash
# slurm.sh STAGE PLAN FOLDER LINES CPUS - runs a plan's lines as one Slurm job array and waits for it.
#
# PLAN: lines of "PRODUCTS<tab>COMMAND", frozen now: jobs do not look at the graph again. LINES of them make a task of CPUS
# cores. Nothing is taken on trust: each line must have left its verdict and whole products. A task that Slurm starts
# again on another node skips the lines whose verdict is good.
set -euo pipefail
stage=$1 plan=$2 folder=$3 lines=$4 cpus=$5
command -v sbatch >/dev/null || { echo "JOBS=slurm: sbatch is not there. Install slurm-client, or run with JOBS=local." >&2; exit 2; }

rm -rf "$folder"; mkdir -p "$folder"
cp "$plan" "$folder/plan"
count=$(wc -l <"$folder/plan")
tasks=$(((count + lines - 1) / lines))
cat >"$folder/task" <<TASK
#!/usr/bin/env bash
set -u
first=\$((SLURM_ARRAY_TASK_ID * $lines + 1))
for ((i = first; i < first + $lines && i <= $count; i++)); do
    [ "\$(cat "$folder/\$i.rc" 2>/dev/null)" != 0 ] || continue
    command=\$(sed -n "\${i}p" "$folder/plan" | cut -f2)
    bash -c "\$command"
    echo \$? >"$folder/\$i.rc.\$\$" && mv "$folder/\$i.rc.\$\$" "$folder/\$i.rc"
done
TASK

# shellcheck disable=SC2086 # SLURM_ARGS is a list of options
id=$(sbatch --parsable --array=0-$((tasks - 1)) --cpus-per-task="$cpus" --job-name="remodel-$stage" --chdir="$PWD" \
    --output="$folder/%a.out" --export=ALL --requeue --open-mode=append ${SLURM_ARGS-} "$folder/task")
id=${id%%;*}
trap 'scancel "$id" 2>/dev/null || true' INT TERM
echo "$stage: job $id of $tasks tasks, $count pieces of work" >&2
began=$(date +%s) shown=-1
while state=$(squeue -h -r -j "$id" -o '%T' 2>&1) || [[ $state != *[Ii]nvalid\ job\ id* ]]; do
    [ -n "$state" ] || break
    done=$(find "$folder" -name '*.rc' | wc -l)
    if [ "$done" -ne "$shown" ]; then
        shown=$done
        left=$((($(date +%s) - began) * (count - done) / (done > 0 ? done : 1)))
        printf '%s %d/%d on the cluster%s\n' "$stage" "$done" "$count" "$([ "$done" = 0 ] || printf ', about %d:%02d left' $((left / 60)) $((left % 60)))" >&2
    fi
    sleep 0.5
done
# on a shared file system what a node wrote may show a little later: give it time before judging
bad=0
for ((i = 1; i <= count; i++)); do
    for ((try = 0; try < 10; try++)); do [ -e "$folder/$i.rc" ] && break; [ "$try" -lt 9 ] && sleep 0.2; done
    products=$(sed -n "${i}p" "$folder/plan" | cut -f1)
    verdict=$(cat "$folder/$i.rc" 2>/dev/null || echo none)
    if [ "$verdict" != 0 ]; then
        bad=$((bad + 1))
        [ "$bad" -gt 3 ] || { echo "$stage: line $i of $folder/plan ($products): $([ "$verdict" = none ] && echo 'its job ended without a verdict (node lost, cancelled, or out of time or memory)' || echo "exit $verdict")"; tail -n 6 "$folder/$(((i - 1) / lines)).out" 2>/dev/null | sed 's/^/    /'; } >&2
    else
        files=()
        for p in $products; do files+=(--file "$p"); done
        "${REMODEL_BIN:?}/verify" "${files[@]}" 2>>"$folder/verify.log" || { tail -n 2 "$folder/verify.log" >&2; bad=$((bad + 1)); }
    fi
done
if [ "$bad" -gt 0 ]; then
    echo "$stage: $bad of $count pieces of work failed on the cluster. What was made is kept; run make again to redo the rest." >&2
    exit 1
fi
