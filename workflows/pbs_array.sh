#!/usr/bin/env bash
# One campaign as an array of independent jobs under PBS, each with its share of the realisations; no MPI:
#
#     qsub workflows/pbs_array.sh
#
# A job whose walltime is nearly over ends with exit code 75 and submits itself once more, alone; the last one to finish
# merges the parts. To end it for good: touch DIR/STOP, and qdel what runs or waits. Not tried under PBS: none could be
# installed; its body was run by hand.

# ==== EDIT 1: resources; PARTS as many as in -J, TIME_TO_RUN a few minutes less than walltime ====
#PBS -N rfmpm
#PBS -J 0-19
#PBS -l select=1:ncpus=8:mem=8gb
#PBS -l walltime=06:00:00
PARTS=20
PROCESSORS=8
TIME_TO_RUN=5:55:00
# ==== end of EDIT 1 ====
#PBS -j oe

# ==== EDIT 2: study and environment ====
STUDY=configs/short_slope_random.toml
DIR=results/short_slope_random
REALISATIONS=10000
SCRIPT=workflows/pbs_array.sh
cd "$PBS_O_WORKDIR" || exit 2
export PATH="$PWD/.venv/bin:$PATH"
# ==== end of EDIT 2 ====

set -u
export OMP_NUM_THREADS=1 NUMBA_NUM_THREADS=1
part=${PART:-$PBS_ARRAY_INDEX} # PART: of a job that is submitted once more
first=$((part * REALISATIONS / PARTS))
end=$(((part + 1) * REALISATIONS / PARTS))

rfmpm run "$STUDY" --realisations "$REALISATIONS" --indices "$first:$end" --out "$DIR/part-$part" --allow-failed 1 \
    --workers "$PROCESSORS" --wall-time "$TIME_TO_RUN"
code=$?

if [ "$code" -eq 75 ] && [ ! -e "$DIR/STOP" ]; then
    grep -v '^#PBS -J' "$SCRIPT" | qsub -v PART="$part" || exit "$code"
    exit 0
fi
[ "$code" -eq 0 ] || exit "$code"
touch "$DIR/part-$part/done"
if [ "$(find "$DIR" -path "$DIR/part-*/done" | wc -l)" -eq "$PARTS" ] && mkdir "$DIR/merging" 2>/dev/null; then
    rfmpm merge "$DIR"/part-* --out "$DIR/merged"
    code=$?
    rmdir "$DIR/merging"
fi
exit "$code"
