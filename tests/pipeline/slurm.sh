# JOBS=slurm gives the bytes of JOBS=local, also after failed and cancelled jobs; on a cluster of three nodes on this host
. tests/lib.sh
project slurm

# free_ports COUNT: the first of COUNT consecutive ports nobody listens on, below those that the kernel hands out
free_ports()
{
    local first p
    for first in $(shuf -i 20000-32000 -n 100); do
        for ((p = first; p < first + $1; p++)); do ! (: <"/dev/tcp/127.0.0.1/$p") 2>/dev/null || continue 2; done
        echo "$first"
        return
    done
    return 1
}
# a controller and three nodes from a generated configuration: no systemd, no cgroups, no munge
start_cluster()
{
    export SLURM_CONF=$scratch/slurm.conf
    local host port; host=$(hostname -s); port=$(free_ports 4) || return
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
    # a container may have no cgroups: name a plugin, which is never used, and a folder of its own
    printf "CgroupPlugin=cgroup/v1\nCgroupMountpoint=%s/cgroup\n" "$scratch" >"$scratch/cgroup.conf"
    export PATH=$PATH:/usr/sbin:/sbin
    slurmctld -D >"$scratch/ctld.out" 2>&1 &
    pids=$!
    for n in n1 n2 n3; do slurmd -D -N "$n" >"$scratch/$n.out" 2>&1 & pids="$pids $!"; done
    for _ in $(seq 600); do
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
if ! start_cluster; then echo "not ok cluster: its nodes did not start"; exit 1; fi

photos set --views 4 >/dev/null
small local; small cluster

for s in local cluster; do echo 'subject photo_2 76 58 108 94' >scenes/$s/subjects.txt; done

the_cluster_gives_the_bytes_of_a_local_run()
{
    films='establishing_dolly dolly_in dolly_in+narrow_dof dolly_out+dim' # of six frames
    make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=local EFFECT="$films" >log 2>&1 || { cat log; fail "local run"; }
    make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=cluster EFFECT="$films" JOBS=slurm VIEWS_PER_JOB=2 FRAMES_PER_JOB=3 >log 2>&1 || { cat log; fail "cluster run"; }
    grep -q 'segment_depth: job' log || { cat log; fail "nothing went to the cluster"; }
    grep -qE '^depth: .* of one core in all, up to [0-9]+ MiB a view \(SLURM_ARGS=' log || { cat log; fail "the run does not announce what its jobs need"; }
    grep -q 'render_views: job .* of 8 tasks' log || { cat log; fail "the films were not one job"; }
    products local >a; products cluster >b
    [ "$(grep -c video.mp4 a)" = 4 ] || fail "there are not four films"
    diff a b || fail "the cluster gives other bytes"
    make -s DEPS=manual SCENE=cluster EFFECT="$films" JOBS=slurm >log 2>&1
    ! grep -q ': job' log || { cat log; fail "a second run went to the cluster again"; }
}

depth_is_that_of_local() { products local | grep ' depth/' | diff - <(products cluster | grep ' depth/') || fail "other bytes came out"; }

brackets_are_merged_on_the_cluster()
{
    photos bracketed --brackets 3 --views 3 >/dev/null
    make -s DEPS=manual PHOTOS=bracketed/photos SFM=bracketed/model SCENE=hdrlocal hdr >log 2>&1 || { cat log; fail "local run"; }
    make -s DEPS=manual PHOTOS=bracketed/photos SFM=bracketed/model SCENE=hdrcluster JOBS=slurm hdr >log 2>&1 || { cat log; fail "cluster run"; }
    grep -q 'hdr_merge: job' log || { cat log; fail "nothing went to the cluster"; }
    (cd out/hdrlocal/hdr && sha256sum -- *) >a; (cd out/hdrcluster/hdr && sha256sum -- *) >b
    diff a b || fail "the cluster gives other bytes"
}

a_failed_task_fails_the_run_and_is_redone()
{
    (cd out/cluster && rm depth/photo_2.exr depth/photo_4.exr)
    cp out/cluster/views/photo_3.exr keep.exr
    head -c 2000 keep.exr >out/cluster/views/photo_3.exr # a cut view: all that read it must fail
    if make -s DEPS=manual SCENE=cluster JOBS=slurm depth >log 2>&1; then fail "the run succeeded"; fi
    grep -q 'failed on the cluster' log || { cat log; fail "the message does not say that tasks failed"; }
    cp keep.exr out/cluster/views/photo_3.exr
    make -s DEPS=manual SCENE=cluster JOBS=slurm depth >log 2>&1 || { cat log; fail "the run with the view restored"; }
    depth_is_that_of_local
}

a_cancelled_job_fails_the_run_and_is_redone()
{
    for _ in 1 2 3 4 5; do
        rm -f out/cluster/depth/*.exr
        make -s DEPS=manual SCENE=cluster JOBS=slurm VIEWS_PER_JOB=9 depth >log 2>&1 &
        run=$!
        while kill -0 "$run" 2>/dev/null && ! squeue -h -t R -o '%i' | matches .; do sleep 0.05; done
        scancel -u root
        rc=0; wait "$run" || rc=$?
        [ "$rc" = 0 ] || break # else the job was over before it was cancelled
    done
    [ "$rc" -ne 0 ] || { cat log; fail "the run succeeded"; }
    make -s DEPS=manual SCENE=cluster JOBS=slurm depth >log 2>&1 || { cat log; fail "the run after it"; }
    depth_is_that_of_local
}

for t in the_cluster_gives_the_bytes_of_a_local_run brackets_are_merged_on_the_cluster a_failed_task_fails_the_run_and_is_redone \
    a_cancelled_job_fails_the_run_and_is_redone; do run "$t"; done
