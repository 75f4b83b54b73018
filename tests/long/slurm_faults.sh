# What goes wrong on a cluster ends with the right bytes, or with a list of what was not made and why; the next run makes just
# that. In most tests the stage is a stand-in: a shell command that writes a known product; in the last ones it is bake_vdta, six
# viewpoints by one process.
. tests/lib.sh
. tests/cluster.sh
project faults
with_cluster SchedulerParameters=sched_interval=1 MaxArraySize=4

# piece FOLDER N COMMAND: a line of a plan; COMMAND runs before the product is written
piece()
{
    printf '%s\t%s\n' "$1/$2.bin" "common/run/run_stage.sh quiet work piece$2 $1 bash -c '$3; { seq $2 999; seq 5000; } >$1/.$2.tmp && mv $1/.$2.tmp $1/$2.bin || { echo \"work: error: cannot write $1/$2.bin: no space left\" >&2; exit 1; }'"
}
# plan_missing FOLDER COUNT COMMAND: the plan of those pieces of 1 to COUNT that have no product
plan_missing()
{
    local n
    mkdir -p "$1"
    for n in $(seq "$2"); do [ -e "$1/$n.bin" ] || piece "$1" "$n" "$3"; done >"$1.plan"
}
# farm FOLDER LINES [ESTIMATE...]: runs FOLDER.plan
farm() { REMODEL_BIN=$B/bin common/run/slurm.sh work "$1.plan" "$1/jobs" 1 "${@:2}" >"$1.log" 2>&1; }
# right FOLDER COUNT: all products have the right bytes
right()
{
    local n
    [ ! -e "$1/jobs/failed.txt" ] || fail "there is a failed.txt"
    for n in $(seq "$2"); do cmp -s "$1/$n.bin" <(seq "$n" 999; seq 5000) || fail "$1/$n.bin is not right"; done
}
# failed FOLDER: the pieces in failed.txt
failed() { cut -f1 "$1/jobs/failed.txt" | tr '\n' ' '; }
# wait_for COMMAND...: up to 30 s
wait_for() { local i; for i in $(seq 600); do ! "$@" || return 0; sleep 0.05; done; fail "$* never became true"; }
some_verdict() { grep -qs ' 0 end' "$1"/verdicts/"$2".*; }
job_of() { cat "$1/jobs/jobs"; }

a_task_that_is_started_again_skips_what_is_made()
{
    plan_missing requeued 4 'echo n >>requeued/count; sleep 0.5'
    farm requeued 4 &
    local run=$!
    wait_for some_verdict requeued/jobs 0
    scontrol requeue "$(job_of requeued)_0" || scontrol requeue "$(job_of requeued)"
    wait "$run" || { cat requeued.log; fail "the run failed"; }
    right requeued 4
    [ "$(wc -l <requeued/count)" -le 5 ] || fail "pieces were made twice"
}

a_task_that_is_told_to_end_is_listed_and_made_by_the_next_run()
{
    plan_missing told 6 '[ ! -e told/slow ] || sleep 20'
    touch told/slow
    farm told 3 &
    local run=$! rc=0
    wait_for compgen -G 'told/log/work.piece1.log' >/dev/null
    wait_for compgen -G 'told/log/work.piece4.log' >/dev/null
    rm told/slow # task 0 waits in its first piece, and so does task 1
    scancel --signal=TERM --full "$(job_of told)_0" "$(job_of told)_1"
    wait "$run" || rc=$?
    [ "$rc" = 1 ] || { cat told.log; fail "the run did not fail"; }
    [ "$(failed told)" = "piece1 piece2 piece3 piece4 piece5 piece6 " ] || { cat told/jobs/failed.txt; fail "other pieces are listed"; }
    grep -qP '^piece1\tit was ended by a signal\ttold/log/work.piece1.log$' told/jobs/failed.txt || { cat told/jobs/failed.txt; fail "it does not say why"; }
    plan_missing told 6 true
    farm told 3 || { cat told.log; fail "the next run"; }
    right told 6
}

a_task_over_its_time_limit_is_listed_and_gets_twice_the_time()
{
    plan_missing slow 2 '[ ! -e slow/asleep ] || sleep 60'
    touch slow/asleep
    farm slow 1 2 20 100 1000 10 &
    local run=$! rc=0
    wait_for compgen -G 'slow/log/work.piece1.log' >/dev/null
    wait_for compgen -G 'slow/log/work.piece2.log' >/dev/null
    rm slow/asleep
    [ "$(squeue -h -r -j "$(job_of slow)" -o '%l %m' | sort -u)" = "10:00 256M" ] || fail "the tasks have other limits than those of the estimate"
    scontrol update JobId="$(job_of slow)_1" EndTime=now # its limit is over
    scontrol update JobId="$(job_of slow)_0" EndTime=now
    wait "$run" || rc=$?
    [ "$rc" = 1 ] || { cat slow.log; fail "the run did not fail"; }
    [ "$(grep -c 'ran out of time' slow/jobs/failed.txt)" = 2 ] || { cat slow/jobs/failed.txt slow/jobs/*.out; fail "it does not say why"; }
    plan_missing slow 2 true
    farm slow 1 2 20 100 1000 10 || { cat slow.log; fail "the next run"; }
    grep -q '1 a task with 256 MiB and 20 minutes' slow.log || { cat slow.log; fail "the next run has the old limit"; }
    right slow 2
}

a_full_disk_is_listed_and_the_next_run_makes_the_rest()
{
    mkdir -p full
    mount -t tmpfs -o size=1700k tmpfs full 2>/dev/null || skip "no file system can be mounted here"
    trap 'umount full' EXIT
    local rc=0 pad=$((100 * 1024))
    plan_missing full 12 "head -c $pad /dev/zero >full/\$RANDOM.pad"
    farm full 3 12 12 10 $((12 * pad)) 1 || rc=$?
    [ "$rc" = 1 ] || { cat full.log; fail "the run did not fail"; }
    grep -q 'the disk is full' full/jobs/failed.txt || { cat full/jobs/failed.txt full.log; fail "it does not say why"; }
    [ -e full/1.bin ] || fail "nothing was made while there was room"
    rm -f full/*.pad
    mount -o remount,size=20m full
    local left; left=$(wc -l <full/jobs/failed.txt)
    plan_missing full 12 true
    [ "$(wc -l <full.plan)" = "$left" ] || fail "failed.txt lists $left pieces, but others have no product"
    farm full 3 || { cat full.log; fail "the next run"; }
    right full 12
}

an_array_may_be_larger_than_slurm_allows()
{
    scontrol show config | matches 'MaxArraySize *= 4$' || fail "the cluster allows larger arrays"
    plan_missing many 9 true
    farm many 1 || { cat many.log; fail "the run failed"; }
    [ "$(wc -l <many/jobs/jobs)" = 3 ] || fail "there are not three arrays"
    right many 9
}

# processes_on NODE: of its daemon, of its tasks, and of their parents, which are Slurm's
processes_on()
{
    local p parent
    cat "$scratch/$1.process"
    for p in $(grep -lsz "^SLURM_CONF=$SLURM_CONF\$" /proc/[0-9]*/environ | cut -d/ -f3); do
        grep -qz "^SLURMD_NODENAME=$1\$" "/proc/$p/environ" 2>/dev/null || continue
        echo "$p"
        parent=$(sed -n 's/^PPid:[[:space:]]*//p' "/proc/$p/status" 2>/dev/null)
        [ "$(cat "/proc/${parent:-0}/comm" 2>/dev/null)" != slurmstepd ] || echo "$parent"
    done
}

# bakes: the atlases of the scene below, on the cluster
bakes() { make -s DEPS=manual SFM=set/model SCENE=baked JOBS=slurm VIEWS_PER_JOB=6 vdta >bakes.log 2>&1; }
J=out/baked/jobs/bake_vdta
a_local_run_bakes_what_the_cluster_must()
{
    photos set >/dev/null
    boxed baked textures
    make -s DEPS=manual SFM=set/model SCENE=baked vdta >local.log 2>&1 || { cat local.log; fail "local run"; }
    [ "$(ls out/baked/vdta/*/atlas.txt | wc -l)" = 6 ] || fail "wanted six atlases"
    cp -a out/baked/vdta whole
}
# hold: bakes wait in the fourth viewpoint, which reads a pipe that nobody writes to; go_on: no longer
held=out/baked/reveal/photo_4.exr
hold() { rm -rf out/baked/vdta $J; mv $held held.exr; mkfifo $held; }
go_on() { rm $held; mv held.exr $held; }
three_are_good() { [ "$(cat $J/verdicts/0.0 2>/dev/null | grep -c ' 0 end$')" = 3 ]; }
times_of_three() { stat -c '%n %Y %i' out/baked/vdta/photo_[123]/atlas.txt; }
bakes_are_right()
{
    [ ! -e $J/failed.txt ] || fail "there is a failed.txt"
    times_of_three | diff three - || fail "what was made before was made again"
    diff -r -x '.*' whole out/baked/vdta || fail "other bytes came out"
}

bakes_that_are_told_to_end_are_listed_and_made_by_the_next_run()
{
    hold
    bakes &
    local run=$! rc=0
    wait_for three_are_good
    scancel --signal=TERM --full "$(cat $J/jobs)_0" || scancel --signal=TERM --full "$(cat $J/jobs)"
    wait "$run" || rc=$?
    go_on
    [ "$rc" != 0 ] || { cat bakes.log; fail "the run did not fail"; }
    [ "$(cut -f1 $J/failed.txt | tr '\n' ' ')" = "photo_4 photo_5 photo_6 " ] || { cat $J/failed.txt bakes.log; fail "other viewpoints are listed"; }
    grep -qP '^photo_4\tit was ended by a signal\t' $J/failed.txt || { cat $J/failed.txt; fail "it does not say why"; }
    times_of_three >three
    bakes || { cat bakes.log; fail "the next run"; }
    grep -q '^bake_vdta: job [0-9]* of 1 tasks, 3 pieces of work' bakes.log || { cat bakes.log; fail "the next run makes something else than the rest"; }
    bakes_are_right
}

# last, since the node does not come back
a_node_killed_in_the_middle_of_bakes_costs_nothing_but_time()
{
    hold
    SLURM_ARGS=--exclusive bakes &
    local run=$! node
    wait_for three_are_good
    times_of_three >three
    node=$(squeue -h -r -t R -j "$(cat $J/jobs)" -o '%K %N' | sed -n 's/^0 //p')
    # the node's daemon, and all that it started, are gone at once
    for p in $(processes_on "$node"); do kill -9 "$p" 2>/dev/null || true; done
    go_on
    wait "$run" || { cat bakes.log; fail "the run failed"; }
    [ -e $J/verdicts/0.1 ] || { ls $J/verdicts; fail "the task was not started again"; }
    bakes_are_right
}

for t in a_task_that_is_started_again_skips_what_is_made a_task_that_is_told_to_end_is_listed_and_made_by_the_next_run \
    a_task_over_its_time_limit_is_listed_and_gets_twice_the_time a_full_disk_is_listed_and_the_next_run_makes_the_rest \
    an_array_may_be_larger_than_slurm_allows; do run "$t"; done
for t in a_local_run_bakes_what_the_cluster_must bakes_that_are_told_to_end_are_listed_and_made_by_the_next_run \
    a_node_killed_in_the_middle_of_bakes_costs_nothing_but_time; do run "$t"; done
