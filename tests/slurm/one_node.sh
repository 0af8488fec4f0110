#!/usr/bin/env bash
# Runs a command beside a SLURM of its own: a controller and one node on this machine, which end with the command.
#
#   tests/slurm/one_node.sh sbatch --wait --wrap hostname
#
# The command finds it by SLURM_CONF. All files are in a temporary folder, all ports are free ones: a SLURM that this
# machine belongs to is neither used nor touched. Exit code: that of the command, or 2 if SLURM does not start.
#
# Debian's packages: slurmctld slurmd slurm-client munge. Root is not needed; nor are cgroups and systemd.
set -euo pipefail

if [ $# -eq 0 ]; then
    echo "${0##*/}: no command, expected one and its arguments: ${0##*/} sbatch --wait --wrap hostname" >&2
    exit 2
fi
PATH=$PATH:/usr/sbin:/sbin
cpus=${POGOSIM_SLURM_CPUS:-4} # may be more than there are

for program in munged slurmctld slurmd sbatch setpriv; do
    if ! command -v "$program" >/dev/null; then
        echo "${0##*/}: $program is missing; apt-get install slurmctld slurmd slurm-client munge" >&2
        exit 2
    fi
done

folder=$(mktemp -d /tmp/one_node.XXXXXX) # short: it has a socket, whose path may have 107 characters
chmod 755 "$folder"
mkdir "$folder/state" "$folder/spool"
export SLURM_CONF=$folder/slurm.conf
unset "${!SBATCH_@}" "${!SQUEUE_@}" "${!SCANCEL_@}"
daemons=""

# start NAME COMMAND...: a daemon that ends with this script, whatever ends it.
start() {
    local name=$1
    shift
    setpriv --pdeathsig KILL "$@" >"$folder/$name.out" 2>&1 </dev/null &
    daemons="$! $daemons"
}

# strays: processes of this SLURM apart from its daemons: those of jobs, and what supervises them.
strays() {
    local process
    for process in /proc/[0-9]*; do
        case " $$ $BASHPID $daemons" in *" ${process#/proc/} "*) continue ;; esac
        if tr '\0' '\n' 2>/dev/null <"$process/environ" | grep -qxF "SLURM_CONF=$SLURM_CONF"; then
            echo "${process#/proc/}"
        fi
    done
}

# wait_for SECONDS COMMAND...: until the command succeeds.
wait_for() {
    local left=$(($1 * 10))
    shift
    until "$@"; do
        left=$((left - 1))
        [ "$left" -gt 0 ] || return 1
        sleep 0.1
    done
}

are_gone() { ! kill -0 "$@" 2>/dev/null; }
no_jobs() { [ -z "$(squeue --noheader --format=%i 2>/dev/null)" ]; }

shut_down() {
    trap '' INT TERM HUP
    if [ -n "$daemons" ]; then
        timeout 10 scancel --user="$(id -un)" 2>/dev/null || true
        wait_for 10 no_jobs || true
        # shellcheck disable=SC2086 # a list of words
        kill $daemons 2>/dev/null || true
        # shellcheck disable=SC2086
        wait_for 5 are_gone $daemons || kill -KILL $daemons 2>/dev/null || true
        # shellcheck disable=SC2046
        kill -KILL $(strays) 2>/dev/null || true
        wait
    fi
    rm -rf "$folder"
}
trap shut_down EXIT
trap 'exit 130' INT TERM HUP

# Two ports that nothing listens at, outside of the range for outgoing connections.
free_ports() {
    local port found=0
    for port in $(shuf -i 20000-30000); do
        if ! (: <"/dev/tcp/127.0.0.1/$port") 2>/dev/null; then
            echo "$port"
            found=$((found + 1))
            [ "$found" -lt 2 ] || return 0
        fi
    done
}

node=$(hostname -s)
mapfile -t ports < <(free_ports)

cat >"$SLURM_CONF" <<END
ClusterName=one_node
SlurmctldHost=$node(127.0.0.1)
SlurmctldPort=${ports[0]}
SlurmdPort=${ports[1]}
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket
CredType=cred/munge
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
SchedulerParameters=batch_sched_delay=0,sched_min_interval=100000
ReturnToService=2
KillWait=5
NodeName=$node NodeAddr=127.0.0.1 CPUs=$cpus RealMemory=100000 State=UNKNOWN
PartitionName=main Nodes=$node Default=YES MaxTime=60 State=UP
PartitionName=closed Nodes=$node State=DOWN
END

# From this version on, slurmd looks for cgroups even if no plugin uses them.
version=$(slurmd -V)
if [ "$(printf '%s\n' "${version#slurm-wlm }" 23.11 | sort -V | head -n 1)" = 23.11 ]; then
    echo CgroupPlugin=disabled >"$folder/cgroup.conf"
fi

dd if=/dev/urandom of="$folder/munge.key" bs=128 count=1 status=none
chmod 400 "$folder/munge.key"

is_idle() { [ "$(timeout 10 sinfo --noheader --partition=main --format=%T 2>/dev/null)" = idle ]; }

give_up() {
    echo "${0##*/}: $1 does not start:" >&2
    tail -n 20 "$folder"/*.out "$folder"/*.log >&2
    exit 2
}

start munged munged --foreground --socket="$folder/munge.socket" --key-file="$folder/munge.key" \
    --pid-file="$folder/munged.pid" --seed-file="$folder/munge.seed" --log-file="$folder/munged.log" --num-threads=2
wait_for 20 test -S "$folder/munge.socket" || give_up munged
start slurmctld slurmctld -D -c
start slurmd slurmd -D
wait_for 60 is_idle || give_up "the node"

# In the background, so that a signal ends the wait; with the standard input that would be closed otherwise.
status=0
"$@" <&0 &
command=$!
trap 'kill "$command" 2>/dev/null; exit 130' INT TERM HUP
wait "$command" || status=$?
exit "$status"
