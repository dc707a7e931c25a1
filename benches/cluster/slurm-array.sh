#!/bin/sh
# The jobs of a plan as one Slurm job array: task N runs line N of plan.txt.
#
#   mkdir -p runs
#   sahara study plan all --dir runs > runs/plan.txt
#   sbatch --array="1-$(wc -l < runs/plan.txt)%16" benches/cluster/slurm-array.sh runs/plan.txt
#
# %16 limits the number of simultaneous jobs. Run the same command again to measure missing cases: a job whose file
# exists ends at once. If `sahara` is not on the PATH of the nodes, set SAHARA to the path of the program.
#
#SBATCH --job-name=sahara
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=1
# If a node fails, Slurm runs its task again; the log keeps the earlier output.
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=slurm-%A_%a.log
set -eu

plan=${1:?name the file that "sahara study plan" has printed}
line=$(sed -n "${SLURM_ARRAY_TASK_ID:?no task of an array: hand this script to sbatch with --array}p" "$plan")
if [ -z "$line" ]; then
  echo "error: $plan has no line $SLURM_ARRAY_TASK_ID: --array goes from 1 to the number of its lines" >&2
  exit 1
fi

# sahara pins threads to the idlest allowed cores. Two jobs that may use each other's cores can choose the same core.
if [ "$(nproc)" -gt "${SLURM_CPUS_ON_NODE:-$(nproc)}" ]; then
  echo "warning: this cluster does not bind jobs to their cores: ask for whole nodes, sbatch --exclusive" >&2
fi

# A line is a complete shell command that begins with the word sahara.
sahara() { command "${SAHARA:-sahara}" "$@"; }
eval "$line"
