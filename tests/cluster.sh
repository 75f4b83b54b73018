# cluster.sh - a Slurm cluster of three nodes on this host, for tests that have sourced lib.sh. `with_cluster` starts it.

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
# start_cluster [LINE...]: more lines for the configuration;
# a controller and three nodes from a generated configuration: no systemd, no cgroups, no munge
start_cluster()
{
    export SLURM_CONF=$scratch/slurm.conf
    local extra; extra=$(printf '%s\n' "$@")
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
SlurmdTimeout=4
KillWait=2
MailProg=/bin/true
SwitchType=switch/none
MpiDefault=none
$extra
NodeName=n1 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 1)) CPUs=2 RealMemory=8000
NodeName=n2 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 2)) CPUs=2 RealMemory=8000
NodeName=n3 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 3)) CPUs=2 RealMemory=8000
PartitionName=all Nodes=n1,n2,n3 Default=YES State=UP MaxTime=60
CONF
    # a container may have no cgroups: name a plugin, which is never used, and a folder of its own
    printf "CgroupPlugin=cgroup/v1\nCgroupMountpoint=%s/cgroup\n" "$scratch" >"$scratch/cgroup.conf"
    export PATH=$PATH:/usr/sbin:/sbin
    slurmctld -D >"$scratch/ctld.out" 2>&1 &
    pids=$!
    for n in n1 n2 n3; do slurmd -D -N "$n" >"$scratch/$n.out" 2>&1 & pids="$pids $!"; echo $! >"$scratch/$n.process"; done
    for _ in $(seq 600); do
        [ "$(sinfo -h -t idle -o '%D' 2>/dev/null)" = 3 ] && return 0
        sleep 0.2
    done
    tail -n 5 "$scratch"/*.log "$scratch"/*.out
    return 1
}
stop_cluster() { kill $pids 2>/dev/null; wait $pids 2>/dev/null; }

# with_cluster [LINE...]: starts it, or ends the script where it cannot be had
with_cluster()
{
    if ! PATH=$PATH:/usr/sbin command -v slurmctld >/dev/null; then echo "skip slurm: slurmctld is not installed"; exit 0; fi
    if [ "$(id -u)" != 0 ]; then echo "skip slurm: starting slurmd needs root"; exit 0; fi
    pids=
    trap 'stop_cluster; rm -rf --one-file-system "$scratch"' EXIT
    if ! start_cluster "$@"; then echo "not ok cluster: its nodes did not start"; exit 1; fi
}
