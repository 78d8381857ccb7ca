#!/bin/bash
# Evaluates the sensors of a daylight simulation as an array of Slurm, one part per task, and merges the parts. All
# tasks share the light in FOLDER/light.h5, which a first job finds.
#
#   light=$(sbatch --parsable --array=1 daylight_array.sh 8 -o year office.obj --epw city.epw --points desks.csv)
#   parts=$(sbatch --parsable --array=2-8 --dependency=afterok:$light daylight_array.sh 8 -o year office.obj ...)
#   sbatch --dependency=afterok:$parts --wrap "exitance daylight -o year office.obj ... --merge"
#SBATCH --cpus-per-task=4
#SBATCH --time=04:00:00
#SBATCH --requeue
set -e
parts=${1:?usage: daylight_array.sh PARTS OPTIONS-OF-DAYLIGHT}
shift
exec exitance daylight "$@" --part "$SLURM_ARRAY_TASK_ID/$parts" --threads "$SLURM_CPUS_PER_TASK" --progress none
