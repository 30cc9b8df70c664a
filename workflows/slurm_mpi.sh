#!/usr/bin/env bash
# One campaign over MPI ranks under Slurm, which submits itself again until all realisations are done:
#
#     sbatch workflows/slurm_mpi.sh
#
# Two minutes before its time is over Slurm sends SIGUSR1; rfmpm writes what is finished and ends with exit code 75, and
# the script goes back into the queue. To end it for good: scancel JOB, or touch DIR/STOP while it runs. Tried with
# Slurm 22.05 and MPICH, on one machine.

# ==== EDIT 1: resources ====
#SBATCH --job-name=rfmpm
#SBATCH --ntasks=64
#SBATCH --cpus-per-task=1
#SBATCH --mem-per-cpu=1G
#SBATCH --time=06:00:00
# ==== end of EDIT 1 ====
#SBATCH --signal=B:USR1@120
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=rfmpm-%j.log

# ==== EDIT 2: study and environment ====
STUDY=configs/short_slope_random.toml
DIR=results/short_slope_random
export PATH="$PWD/.venv/bin:$PATH"
# ==== end of EDIT 2 ====

set -u
export OMP_NUM_THREADS=1 NUMBA_NUM_THREADS=1

segments() { find "$DIR/segments" -name '*.rows' 2>/dev/null | wc -l; }
before=$(segments)
mpirun -n "$SLURM_NTASKS" rfmpm run "$STUDY" --out "$DIR" &
campaign=$!
cancelled=no
trap 'kill -USR1 "$campaign" 2>/dev/null' USR1
trap 'cancelled=yes; kill -TERM "$campaign" 2>/dev/null' TERM
while true; do # a signal ends a wait before the campaign has ended
    wait "$campaign"
    code=$?
    kill -0 "$campaign" 2>/dev/null || break
done

again=no
case $code in
75) if [ "$(segments)" -gt "$before" ]; then again=yes; else echo "nothing was finished in this time: ask for more" >&2; fi ;;
# a rank died of a signal, which MPICH and Open MPI tell differently; its realisation is set aside at the third death
6 | 7 | 9 | 11 | 134 | 135 | 137 | 139) [ "${SLURM_RESTART_COUNT:-0}" -lt 20 ] && again=yes ;;
esac
if [ "$again" = yes ] && [ "$cancelled" = no ] && [ ! -e "$DIR/STOP" ]; then
    scontrol requeue "$SLURM_JOB_ID"
    sleep 60 # Slurm ends this run of the job
fi
exit "$code"
