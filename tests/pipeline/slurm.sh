# JOBS=slurm on a cluster of three nodes on this host gives the bytes of JOBS=local, also when a job is lost
. tests/lib.sh
project slurm

# a controller and three nodes from a generated configuration: no systemd, no cgroups, no munge
start_cluster()
{
    export SLURM_CONF=$scratch/slurm.conf
    local host port; host=$(hostname -s); port=$((20000 + $$ % 20000))
    mkdir -p "$scratch"/{state,n1,n2,n3}
    cat >"$SLURM_CONF" <<CONF
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmUser=root
SlurmdUser=root
AuthType=auth/none
CredType=cred/none
AuthInfo=cred_expire=5
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
StateSaveLocation=$scratch/state
SlurmdSpoolDir=$scratch/%n
SlurmctldPidFile=$scratch/slurmctld.pid
SlurmdPidFile=$scratch/%n.pid
SlurmctldLogFile=$scratch/slurmctld.log
SlurmdLogFile=$scratch/%n.log
ReturnToService=2
SchedulerParameters=sched_interval=1
MailProg=/bin/true
SwitchType=switch/none
MpiDefault=none
NodeName=n1 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 1)) CPUs=2
NodeName=n2 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 2)) CPUs=2
NodeName=n3 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 3)) CPUs=2
PartitionName=all Nodes=n1,n2,n3 Default=YES State=UP MaxTime=60
CONF
    # a container may have no cgroups: a plugin that is never used, in a folder of its own
    printf "CgroupPlugin=cgroup/v1\nCgroupMountpoint=%s/cgroup\n" "$scratch" >"$scratch/cgroup.conf"
    export PATH=$PATH:/usr/sbin:/sbin
    slurmctld -D >"$scratch/ctld.out" 2>&1 &
    pids=$!
    for n in n1 n2 n3; do slurmd -D -N "$n" >"$scratch/$n.out" 2>&1 & pids="$pids $!"; done
    for _ in $(seq 100); do
        [ "$(sinfo -h -t idle -o '%D' 2>/dev/null)" = 3 ] && return 0
        sleep 0.2
    done
    tail -n 5 "$scratch"/*.log "$scratch"/*.out
    return 1
}
stop_cluster() { kill $pids 2>/dev/null; wait $pids 2>/dev/null; }

if ! PATH=$PATH:/usr/sbin command -v slurmctld >/dev/null; then echo "skip slurm: slurmctld is not installed"; exit 0; fi
if [ "$(id -u)" != 0 ]; then echo "skip slurm: starting slurmd needs root"; exit 0; fi
pids=
trap 'stop_cluster; rm -rf --one-file-system "$scratch"' EXIT
if ! start_cluster; then echo "not ok cluster: it did not come up"; exit 1; fi

photos set >/dev/null
small local; small cluster

cluster_gives_the_bytes_of_local()
{
    make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=local >log 2>&1 || { cat log; fail "local run"; }
    make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=cluster JOBS=slurm VIEWS_PER_JOB=2 FRAMES_PER_JOB=2 >log 2>&1 || { cat log; fail "cluster run"; }
    grep -q 'segment_depth: job' log || { cat log; fail "nothing went to the cluster"; }
    grep -qE '^depth: .* of one core in all, up to [0-9]+ MiB a view \(SLURM_ARGS=' log || { cat log; fail "what the cluster's jobs need is not told"; }
    products local >a; products cluster >b
    diff a b || fail "the cluster gives other bytes"
    make -s DEPS=manual SCENE=cluster JOBS=slurm >log 2>&1
    ! grep -q ': job' log || { cat log; fail "a second run went to the cluster again"; }
}

films_of_all_effects_are_rendered_on_the_cluster()
{
    for s in effects_local effects_cluster; do tiny $s; echo 'subject photo_2 76 58 108 94' >scenes/$s/subjects.txt; done
    make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=effects_local EFFECT=all video >log 2>&1 || { cat log; fail "local run"; }
    make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=effects_cluster EFFECT=all JOBS=slurm FRAMES_PER_JOB=2 video >log 2>&1 || { cat log; fail "cluster run"; }
    grep -q 'render_views: job .* of 60 tasks' log || { cat log; fail "the films were not one job"; }
    products effects_local >a; products effects_cluster >b
    [ "$(grep -c video.mp4 a)" = 30 ] || fail "not 30 films"
    diff a b || fail "the cluster gives other bytes"
}

brackets_are_merged_on_the_cluster()
{
    photos bracketed --brackets 3 >/dev/null
    make -s DEPS=manual PHOTOS=bracketed/photos SFM=bracketed/model SCENE=hdrlocal hdr >log 2>&1 || { cat log; fail "local run"; }
    make -s DEPS=manual PHOTOS=bracketed/photos SFM=bracketed/model SCENE=hdrcluster JOBS=slurm hdr >log 2>&1 || { cat log; fail "cluster run"; }
    grep -q 'hdr_merge: job' log || { cat log; fail "nothing went to the cluster"; }
    (cd out/hdrlocal/hdr && sha256sum -- *) >a; (cd out/hdrcluster/hdr && sha256sum -- *) >b
    diff a b || fail "the cluster gives other bytes"
}

a_task_that_fails_is_told_and_not_trusted()
{
    rm out/cluster/depth/photo_2.exr out/cluster/depth/photo_4.exr
    cp out/cluster/views/photo_3.exr keep.exr
    head -c 2000 keep.exr >out/cluster/views/photo_3.exr # a view that is not whole: its readers must fail
    if make -s DEPS=manual SCENE=cluster JOBS=slurm depth >log 2>&1; then fail "the run was called good"; fi
    grep -q 'failed on the cluster' log || { cat log; fail "the failure is not told"; }
    cp keep.exr out/cluster/views/photo_3.exr
    make -s DEPS=manual SCENE=cluster JOBS=slurm >log 2>&1 || { cat log; fail "the run after the mend"; }
    products local >a; products cluster >b
    diff a b || fail "other bytes after the mend"
}

a_cancelled_job_is_not_called_good()
{
    rm -f out/cluster/depth/*.exr
    make -s DEPS=manual SCENE=cluster JOBS=slurm VIEWS_PER_JOB=9 depth >log 2>&1 &
    run=$!
    for _ in $(seq 100); do squeue -h -o '%i' | matches . && break; sleep 0.1; done
    scancel -u root
    if wait "$run"; then fail "the run was called good"; fi
    make -s DEPS=manual SCENE=cluster JOBS=slurm >log 2>&1 || { cat log; fail "the run after it"; }
    products local >a; products cluster >b
    diff a b || fail "other bytes after a cancelled job"
}

run cluster_gives_the_bytes_of_local
run films_of_all_effects_are_rendered_on_the_cluster
run brackets_are_merged_on_the_cluster
run a_task_that_fails_is_told_and_not_trusted
run a_cancelled_job_is_not_called_good
