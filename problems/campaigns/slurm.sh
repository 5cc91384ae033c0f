#!/bin/bash
# A job script for Slurm: a campaign on many machines. Call ./corridor --version first, which builds the program.
#   sbatch problems/campaigns/slurm.sh problems/campaigns/error.yaml results
# Submit it again to continue: the finished runs are kept.
#SBATCH --job-name=corridor
#SBATCH --ntasks=64
#SBATCH --time=24:00:00
#SBATCH --signal=B:TERM@60
# Slurm sends SIGTERM to this script 60 s before the wall time. mpirun would kill all ranks one second after SIGTERM.
# It hands on SIGUSR1, which corridor takes as an interrupt: there is a minute to write the reports.
campaign=${1:?the file of a campaign is needed} results=${2:?a folder for the results is needed}
mpirun ${MPIRUN_OPTIONS-} ./corridor benchmark "$campaign" -o "$results" --resume &
job=$! stopped=
# Repeats the signal, because mpirun does not hand on one that arrives before the ranks are there.
trap 'stopped=1; while kill -USR1 "$job" 2>/dev/null; do sleep 3; done' TERM INT
status=0
wait "$job" || status=$?
if [[ $stopped ]]; then  # the signal ended the first wait
  status=0
  wait "$job" || status=$?
fi
exit "$status"
