#!/bin/sh
# A Slurm cluster of one node, this machine: munge, controller and worker. All its files are in FOLDER.
#
#   start_slurm.sh FOLDER        starts it; Slurm commands need SLURM_CONF=FOLDER/slurm.conf and PATH=FOLDER/bin:$PATH
#   start_slurm.sh FOLDER stop   stops it
set -eu

folder=${1:?name a folder}
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
export SLURM_CONF="$folder/slurm.conf"

# Ends the processes of the cluster, the worker and its jobs first.
stop() {
  for name in slurmd slurmctld munged; do
    pid=$(cat "$folder/$name.pid" 2> /dev/null) || continue
    kill "$pid" 2> /dev/null || continue
    while kill -0 "$pid" 2> /dev/null; do sleep 0.1; done
  done
}
if [ "${2:-}" = stop ]; then
  stop
  exit 0
fi

# Debian installs the daemons in folders that the PATH of a user may lack.
PATH=$PATH:/usr/sbin:/sbin
for program in munged slurmctld slurmd sbatch; do
  command -v "$program" > /dev/null || {
    echo "error: there is no $program: apt-get install slurm-wlm munge" >&2
    exit 1
  }
done

# Munge needs a secret key. --force: munged otherwise rejects a folder below /tmp, which everybody may write.
chmod 711 "$folder"
(umask 077 && head -c 1024 /dev/urandom > "$folder/munge.key")
munged --force --socket="$folder/munge.socket" --key-file="$folder/munge.key" --pid-file="$folder/munged.pid" \
  --log-file="$folder/munged.log" --seed-file="$folder/munge.seed"

# Find free ports.
ports=$(python3 -c 'import socket
sockets = [socket.socket() for _ in range(2)]
[s.bind(("", 0)) for s in sockets]
print(*[s.getsockname()[1] for s in sockets])')

# A container has neither accounting nor control groups. Jobs are not bound to cores, so do not measure on this cluster.
host=$(hostname -s)
megabytes=$(awk '/^MemTotal:/ { print int($2 / 1024) }' /proc/meminfo)
mkdir -p "$folder/state" "$folder/spool"
cat > "$folder/slurm.conf" << CONF
ClusterName=test
SlurmctldHost=$host
SlurmctldPort=${ports% *}
SlurmdPort=${ports#* }
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket
CredType=cred/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
NodeName=$host CPUs=$(nproc) RealMemory=$megabytes State=UNKNOWN
PartitionName=test Nodes=$host Default=YES MaxTime=INFINITE State=UP
CONF
slurmctld -c
slurmd -c

# The Snakemake executor drops SLURM_CONF when it starts a job step: a wrapper of srun sets it again.
mkdir -p "$folder/bin"
printf '#!/bin/sh\nSLURM_CONF="%s" exec "%s" "$@"\n' "$SLURM_CONF" "$(command -v srun)" > "$folder/bin/srun"
chmod +x "$folder/bin/srun"

# Wait until the node is idle.
for _ in $(seq 100); do
  if [ "$(sinfo --noheader --format=%T 2> /dev/null)" = idle ]; then
    exit 0
  fi
  sleep 0.2
done
echo "error: the node is not idle after 20 s:" >&2
tail -n 5 "$folder/slurmctld.log" "$folder/slurmd.log" >&2
stop
exit 1
