#!/bin/bash
# Runs studies on a Slurm cluster that it starts on this machine, through the scripts that users submit.
#
#   cluster_test.sh SCRIPTS stand-in           the scripts, with a program that takes no time
#   cluster_test.sh SCRIPTS GRIDMERGE STUDY N  a study of N runs by the real program
#
# Ends with 77, and says why, where no cluster can be started.
set -euo pipefail
here=$(dirname "$(realpath "$0")")
# shellcheck source-path=SCRIPTDIR
. "$here/slurm_on_this_machine.sh"

scripts=$(realpath "$1")
work=$(mktemp -d)
trap 'stop_slurm; rm -rf "$work"' EXIT
trap 'exit 1' INT TERM HUP

fail() {
  echo "FAILED: $*"
  tail -n 20 "$work"/*/log/* "$work"/slurm/*.log 2>/dev/null || true
  exit 1
}

# expect WHAT FOUND WANTED
expect() {
  [ "$2" = "$3" ] || fail "$1: found '$2', wanted '$3'"
}

submit() {
  "$scripts/submit" "$@" >"$work/said" 2>&1
}

# submit_refused WORDS ARGUMENTS...
submit_refused() {
  local words=$1
  shift
  if submit "$@"; then
    fail "submit $* was taken, it should say: $words"
  fi
  grep -qF -- "$words" "$work/said" || fail "submit $*: says '$(cat "$work/said")', wanted: $words"
}

# until_true SECONDS COMMAND...: polls
until_true() {
  local tries=$(($1 * 10))
  shift
  while ((tries-- > 0)); do
    if "$@"; then
      return 0
    fi
    sleep 0.1
  done
  return 1
}

wait_for_the_end() { until_true 25 no_job_left || fail "jobs do not end: $(squeue)"; }
state_of() { scontrol --oneliner show job "$1" | grep -o 'JobState=[A-Z]*' | sort -u | xargs; }
last_merge_job() { tail -n 1 "$1/log/jobs" | cut -d, -f2; }
last_array_job() { tail -n 1 "$1/log/jobs" | cut -d, -f1; }
runs_in() { cut -d' ' -f1 "$1" | xargs; }

completes_a_study() {
  echo '-- an array runs every shard, and its end joins them'
  submit "$study" "$work/whole % of it" 3 --cpus-per-task=1
  wait_for_the_end
  local rows="$work/whole % of it/rows.csv"
  expect 'runs' "$(runs_in "$rows")" '0 1 2 3 4 5 6 7 8 9'
  expect 'a row' "$(grep '^4 ' "$rows")" '4 shard 2/3 jobs 1'
  [ -s "$work/whole % of it/log/shard-3.txt" ] || fail 'no log of shard 3'
}

goes_on_after_a_failure() {
  echo '-- a shard that fails holds the joining back; the same command again goes on'
  STAND_IN_FAILS=2 submit "$study" "$work/failing" 3 --cpus-per-task=1
  wait_for_the_end
  expect 'the joining job' "$(state_of "$(last_merge_job "$work/failing")")" 'JobState=CANCELLED'
  [ ! -e "$work/failing/rows.csv" ] || fail 'joined, though a shard failed'
  expect 'shard 2' "$(runs_in "$work/failing/rows-2-of-3.sqlite")" '1'
  submit_refused 'was begun with 3 shards, so N must be 3' "$study" "$work/failing" 4
  submit "$study" "$work/failing" 3 --cpus-per-task=1
  wait_for_the_end
  expect 'runs' "$(runs_in "$work/failing/rows.csv")" '0 1 2 3 4 5 6 7 8 9'
}

survives_a_requeue() {
  echo '-- a task that is requeued in the midst loses nothing and runs nothing twice'
  STAND_IN_RUN_S=0.3 submit "$study" "$work/requeued" 1 --cpus-per-task=1
  until_true 15 test -s "$work/requeued/rows-1-of-1.sqlite" || fail 'the shard does not begin'
  submit_refused 'is still at it' "$study" "$work/requeued" 1
  scontrol requeue "$(last_array_job "$work/requeued")_1"
  wait_for_the_end
  expect 'runs' "$(runs_in "$work/requeued/rows.csv")" '0 1 2 3 4 5 6 7 8 9'
  grep -q 'restarted 1 times' "$work/requeued/log/shard-1.txt" || fail 'was not restarted'
}

refuses_what_cannot_be() {
  echo '-- what cannot be is refused before anything is submitted'
  submit_refused 'usage: submit STUDY.yaml DIR N' "$study" "$work/none"
  submit_refused "N: '0' is no number of shards" "$study" "$work/none" 0
  submit_refused 'none.yaml: cannot be read' "$work/none.yaml" "$work/none" 2
  GRIDMERGE=$work/none submit_refused 'none: no such program' "$study" "$work/none" 2
  [ ! -e "$work/none" ] || fail 'a refused study left a folder'
  SLURM_ARRAY_JOB_ID=1 SLURM_ARRAY_TASK_ID=5 SLURM_ARRAY_TASK_COUNT=4 SLURM_ARRAY_TASK_MIN=5 SLURM_ARRAY_TASK_MAX=8 \
    "$scripts/study.sbatch" "$study" "$work/none" 2>"$work/said" && fail 'an array from 5 to 8 was taken'
  grep -qF -- '--array must be 1-N without gaps' "$work/said" || fail "says '$(cat "$work/said")'"
}

# runs_the_real_program STUDY RUNS
runs_the_real_program() {
  echo "-- $GRIDMERGE runs $2 runs of $1 as two shards"
  submit "$1" "$work/real" 2 --cpus-per-task=1
  wait_for_the_end
  [ -s "$work/real/rows.csv" ] || fail 'there is no rows.csv'
  expect 'rows' "$(tail -n +2 "$work/real/rows.csv" | wc -l)" "$2"
  expect 'different runs' "$(tail -n +2 "$work/real/rows.csv" | cut -d, -f1 | sort -u | wc -l)" "$2"
  "$GRIDMERGE" study "$1" -o "$work/alone" --jobs 1 >"$work/said" 2>&1 || fail "$(cat "$work/said")"
  cmp <(cut -d, -f1-3 "$work/real/rows.csv") <(cut -d, -f1-3 "$work/alone/rows.csv") ||
    fail 'the rows are not those of a study that is run in one piece'
  [ -s "$work/real/report.html" ] || fail 'there is no report.html'
  expect 'shards' "$(find "$work/real" -name 'rows-*-of-2.sqlite' | wc -l)" 2
}

start_slurm "$work/slurm" || {
  [ $? -eq 77 ] || fail 'Slurm'
  echo "skipped: $slurm_why_not"
  exit 77
}
if [ "$2" = stand-in ]; then
  export GRIDMERGE=$here/stand_in
  study=$work/study.yaml
  echo 'read by nobody' >"$study"
  refuses_what_cannot_be
  completes_a_study
  goes_on_after_a_failure
  survives_a_requeue
else
  GRIDMERGE=$(realpath "$2")
  export GRIDMERGE
  runs_the_real_program "$3" "$4"
fi
echo "passed in $SECONDS s"
