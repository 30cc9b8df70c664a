#!/usr/bin/env bash
# One campaign over MPI ranks under PBS, which submits itself again until all realisations are done:
#
#     qsub workflows/pbs_mpi.sh
#
# Some minutes before its walltime rfmpm writes what is finished and ends with exit code 75, and the script submits
# itself once more. To end it for good: touch DIR/STOP while it runs, qdel it while it waits (a run that starts removes
# an old STOP). Not tried under PBS: none could be installed; its body was run by hand.

# ==== EDIT 1: resources; TIME_TO_RUN a few minutes less than walltime ====
#PBS -N rfmpm
#PBS -l select=4:ncpus=16:mpiprocs=16:mem=16gb
#PBS -l walltime=06:00:00
TIME_TO_RUN=5:55:00
# ==== end of EDIT 1 ====
#PBS -j oe

# ==== EDIT 2: study and environment ====
STUDY=configs/short_slope_random.toml
DIR=results/short_slope_random
SCRIPT=workflows/pbs_mpi.sh
cd "$PBS_O_WORKDIR" || exit 2
export PATH="$PWD/.venv/bin:$PATH"
# ==== end of EDIT 2 ====

set -u
export OMP_NUM_THREADS=1 NUMBA_NUM_THREADS=1

mpirun -n "$(wc -l <"$PBS_NODEFILE")" rfmpm run "$STUDY" --out "$DIR" --wall-time "$TIME_TO_RUN"
code=$?

again=no
case $code in
75) again=yes ;;
# a rank died of a signal, which MPICH and Open MPI tell differently; its realisation is set aside at the third death
6 | 7 | 9 | 11 | 134 | 135 | 137 | 139) [ "${TRIES:-0}" -lt 20 ] && again=yes ;;
esac
if [ "$again" = yes ] && [ ! -e "$DIR/STOP" ]; then
    qsub -v TRIES=$((${TRIES:-0} + 1)) "$SCRIPT" || exit "$code"
    exit 0
fi
exit "$code"
