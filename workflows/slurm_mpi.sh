#!/usr/bin/env bash
# One campaign over MPI ranks under Slurm; it submits itself again until the campaign is done.
#
#     sbatch workflows/slurm_mpi.sh
#
# Two minutes before its time is over Slurm sends SIGUSR1; rfmpm then writes what is finished and ends with exit code 75,
# and the script submits itself once more. To stop for good: touch DIR/STOP, or scancel --signal=KILL JOB.
# Tried: Slurm 22.05 on one machine, MPICH.

# ---- EDIT 1: resources --------------------------------------------------------------------------------------------
#SBATCH --job-name=rfmpm
#SBATCH --ntasks=64
#SBATCH --cpus-per-task=1
#SBATCH --mem-per-cpu=1G
#SBATCH --time=06:00:00
#SBATCH --signal=B:USR1@120
#SBATCH --output=rfmpm-%j.log
# ---- end of EDIT 1 ------------------------------------------------------------------------------------------------

# ---- EDIT 2: study and environment --------------------------------------------------------------------------------
STUDY=configs/short_slope_random.toml
DIR=results/short_slope_random
export PATH="$PWD/.venv/bin:$PATH"
# ---- end of EDIT 2 ------------------------------------------------------------------------------------------------

set -u
export OMP_NUM_THREADS=1 NUMBA_NUM_THREADS=1
script=$(scontrol show job "$SLURM_JOB_ID" | sed -n 's/^ *Command=//p')

mpirun -n "$SLURM_NTASKS" rfmpm run "$STUDY" --out "$DIR" &
campaign=$!
trap 'kill -USR1 "$campaign"' USR1 TERM
wait "$campaign"
code=$?
while kill -0 "$campaign" 2>/dev/null; do # a signal ended the wait, not the campaign
    wait "$campaign"
    code=$?
done

if [ "$code" -eq 75 ] && [ ! -e "$DIR/STOP" ]; then
    exec sbatch "$script"
fi
exit "$code"
