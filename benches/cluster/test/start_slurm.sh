#!/bin/sh
# A cluster of one node, this machine, in a folder of its own: munge, controller and worker. Nothing of the system is changed.
#
#   start_slurm.sh FOLDER        starts it; sbatch, squeue and others find it by SLURM_CONF=FOLDER/slurm.conf and PATH=FOLDER/bin:$PATH
#   start_slurm.sh FOLDER stop   ends it
set -eu

folder=${1:?name a folder}
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
export SLURM_CONF="$folder/slurm.conf"

# Ends the processes of this folder, the worker with the jobs first.
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

# As Debian installs them, which a path of a user may lack.
PATH=$PATH:/usr/sbin:/sbin
for program in munged slurmctld slurmd sbatch; do
  command -v "$program" > /dev/null || {
    echo "error: there is no $program: apt-get install slurm-wlm munge" >&2
    exit 1
  }
done

# Munge: the key is made here and known to nobody else. --force: the folder is below /tmp, which everybody may write.
chmod 711 "$folder"
(umask 077 && head -c 1024 /dev/urandom > "$folder/munge.key")
munged --force --socket="$folder/munge.socket" --key-file="$folder/munge.key" --pid-file="$folder/munged.pid" \
  --log-file="$folder/munged.log" --seed-file="$folder/munge.seed"

# Ports that are free now.
ports=$(python3 -c 'import socket
sockets = [socket.socket() for _ in range(2)]
[s.bind(("", 0)) for s in sockets]
print(*[s.getsockname()[1] for s in sockets])')

# No accounting and no control groups: neither is there in a container. A job is bound to nothing, so it is no cluster to measure on.
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

# The executor of Snakemake drops SLURM_CONF where it starts a step of a job.
mkdir -p "$folder/bin"
printf '#!/bin/sh\nSLURM_CONF="%s" exec "%s" "$@"\n' "$SLURM_CONF" "$(command -v srun)" > "$folder/bin/srun"
chmod +x "$folder/bin/srun"

# It is there when the node is idle.
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
