#!/bin/bash
# Runs a sweep as an array of Slurm: every task runs PER_TASK variants.
#
#   count=$(exitance sweep plan.toml --list --json | python3 -c 'import json, sys; print(len(json.load(sys.stdin)["variants"]))')
#   sbatch --array=1-$count slurm_array.sh plan.toml
#
# A task that is killed or requeued continues from the finished steps. When all are done: exitance sweep plan.toml --collect
#SBATCH --cpus-per-task=4
#SBATCH --time=04:00:00
#SBATCH --requeue
#SBATCH --signal=TERM@60
set -e
plan=${1:?usage: slurm_array.sh plan.toml}
per_task=${PER_TASK:-1}
first=$(((SLURM_ARRAY_TASK_ID - 1) * per_task + 1))
last=$((first + per_task - 1))
exec exitance sweep "$plan" --run "$first-$last" --threads "$SLURM_CPUS_PER_TASK"
