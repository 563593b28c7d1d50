# A Slurm of a controller and two nodes of one processor each, all on this host, for slurm_test.sh: in the
# folder $folder, on free ports, by Debian's programs alone (no systemd, no munge, no cgroups).

export SLURM_CONF=$folder/slurm.conf

isFree() { ! (exec 3<>"/dev/tcp/127.0.0.1/$1") 2>/dev/null; }

freePorts() {  # the first of three free ones in a row
    local port
    for port in $(shuf -i 17000-32000 -n 50); do
        if isFree "$port" && isFree $((port + 1)) && isFree $((port + 2)); then
            echo "$port"
            return
        fi
    done
}

writeSlurmConf() {
    local host user port
    host=$(hostname | cut -d. -f1) user=$(id -un) port=$(freePorts)
    cat > "$SLURM_CONF" <<END
ClusterName=etendue
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
AuthType=auth/none
CredType=cred/none
# How long what is requeued waits, at least.
AuthInfo=cred_expire=5
SlurmUser=$user
SlurmdUser=$user
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool-%n
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd-%n.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0
ReturnToService=2
# A restarted node that has lost a job older than their sum has it requeued.
BatchStartTimeout=1
MessageTimeout=5
SlurmdTimeout=60
KillWait=10
MaxArraySize=5
NodeName=n[1-2] NodeHostname=$host NodeAddr=127.0.0.1 Port=[$((port + 1))-$((port + 2))] CPUs=1 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
END
}

startCluster() {
    writeSlurmConf
    mkdir "$folder/state"
    slurmctld -f "$SLURM_CONF"
    startNode n1
    startNode n2
    waitFor 20 allNodesIdle || fail "the nodes have not come up: $(sinfo 2>&1)"
}

allNodesIdle() { [ "$(sinfo --noheader --states=idle --format=%D 2>/dev/null)" = 2 ]; }
startNode() { slurmd -f "$SLURM_CONF" -N "$1"; }

# Everything that was started from here has this environment, daemons and jobs.
ourProcesses() {
    local entry
    for entry in /proc/[0-9]*; do
        [ "${entry#/proc/}" = $$ ] || [ "${entry#/proc/}" = $BASHPID ] && continue
        grep -qsF -- "$1" "$entry/environ" && echo "${entry#/proc/}"
    done
}

# The loss of a node: its daemon, what watches its jobs, and the jobs, all at once.
killNode() {
    local pids pid
    pids=$(cat "$folder/slurmd-$1.pid")
    for pid in $(ourProcesses "SLURMD_NODENAME=$1"); do
        pids="$pids $pid $(parentOf "$pid")"
    done
    # shellcheck disable=SC2086
    kill -9 $pids 2>/dev/null
}

parentOf() { sed -n 's/^PPid:\t//p' "/proc/$1/status" 2>/dev/null | grep -vx 1; }

stopCluster() {
    local daemon
    scancel --user="$(id -un)" 2>/dev/null
    waitFor 10 queueIsEmpty
    for daemon in slurmd-n1 slurmd-n2 slurmctld; do
        [ ! -e "$folder/$daemon.pid" ] || kill "$(cat "$folder/$daemon.pid")" 2>/dev/null
    done
    waitFor 5 nothingIsOurs
    # shellcheck disable=SC2046
    kill -9 $(ourProcesses "SLURM_CONF=$SLURM_CONF") 2>/dev/null
    [ -n "${KEEP:-}" ] || rm -rf "$folder"
}

queueIsEmpty() { [ -z "$(squeue --noheader 2>/dev/null)" ]; }
nothingIsOurs() { [ -z "$(ourProcesses "SLURM_CONF=$SLURM_CONF")" ]; }

waitFor() {  # SECONDS COMMAND …: until it succeeds
    local end=$((SECONDS + $1))
    shift
    until "$@"; do
        [ $SECONDS -lt $end ] || return 1
        sleep 0.1
    done
}
