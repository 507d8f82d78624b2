#!/bin/bash
# The hosted workflows do what anyone can do at home: they call the scripts of .ci, and those are there and run.
#
#   workflows_test.sh REPOSITORY
set -euo pipefail
cd "$1"

fail() {
  echo "$*" >&2
  exit 1
}

for script in .ci/run .ci/compare; do
  [ -x "$script" ] || fail "$script: is not there, or cannot be run"
  bash -n "$script"
  grep -qE "^ *- run: $script( |\$)" .github/workflows/*.yml || fail "$script: no workflow calls it"
done
for called in $(sed -nE 's/^ *- run: (\.ci\/[a-z_]+).*/\1/p' .github/workflows/*.yml); do
  [ -x "$called" ] || fail "$called: a workflow calls it, but it is not there"
done
if .ci/compare 2>/dev/null; then
  fail '.ci/compare: must refuse to run without a commit to compare with'
fi
[ -r configs/studies/ci.yaml ] || fail 'configs/studies/ci.yaml: the study that .ci/compare runs is not there'
