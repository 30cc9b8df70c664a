#!/usr/bin/env bash
# One campaign as an array of independent jobs under Slurm, each with its share of the realisations; no MPI:
#
#     sbatch workflows/slurm_array.sh
#
# A job whose time is nearly over ends with exit code 75 and goes back into the queue; the last one to finish merges the
# parts. To end it for good: scancel JOB. Tried with Slurm 22.05 on one machine.

# ==== EDIT 1: resources ====
#SBATCH --job-name=rfmpm
#SBATCH --array=0-19
#SBATCH --cpus-per-task=8
#SBATCH --mem-per-cpu=1G
#SBATCH --time=06:00:00
# ==== end of EDIT 1 ====
#SBATCH --signal=B:USR1@120
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=rfmpm-%A_%a.log

# ==== EDIT 2: study and environment ====
STUDY=configs/short_slope_random.toml
DIR=results/short_slope_random
REALISATIONS=10000
export PATH="$PWD/.venv/bin:$PATH"
# ==== end of EDIT 2 ====

set -u
export OMP_NUM_THREADS=1 NUMBA_NUM_THREADS=1
parts=$SLURM_ARRAY_TASK_COUNT
part=$((SLURM_ARRAY_TASK_ID - SLURM_ARRAY_TASK_MIN))
first=$((part * REALISATIONS / parts))
end=$(((part + 1) * REALISATIONS / parts))

segments() { find "$DIR/part-$part/segments" -name '*.rows' 2>/dev/null | wc -l; }
before=$(segments)
rfmpm run "$STUDY" --realisations "$REALISATIONS" --indices "$first:$end" --out "$DIR/part-$part" --allow-failed 1 \
    --workers "$SLURM_CPUS_PER_TASK" &
campaign=$!
cancelled=no
trap 'kill -USR1 "$campaign" 2>/dev/null' USR1
trap 'cancelled=yes; kill -TERM "$campaign" 2>/dev/null' TERM
while true; do # a signal ends a wait before the campaign has ended
    wait "$campaign"
    code=$?
    kill -0 "$campaign" 2>/dev/null || break
done

if [ "$code" -eq 75 ] && [ "$(segments)" -eq "$before" ]; then
    echo "nothing was finished in this time: ask for more" >&2
elif [ "$code" -eq 75 ] && [ "$cancelled" = no ]; then
    scontrol requeue "${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID"
    sleep 60 # Slurm ends this run of the job
    exit "$code"
fi
[ "$code" -eq 0 ] || exit "$code"
touch "$DIR/part-$part/done"
if [ "$(find "$DIR" -path "$DIR/part-*/done" | wc -l)" -eq "$parts" ] && mkdir "$DIR/merging" 2>/dev/null; then
    rfmpm merge "$DIR"/part-* --out "$DIR/merged"
    code=$?
    rmdir "$DIR/merging"
fi
exit "$code"
