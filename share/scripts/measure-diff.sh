#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Measures how many changes psi-slam diff reports in simulated buildings where nothing changed. Cuts a run of 300 m into two
# logs, its first and its last 65 %, maps both, and compares the maps. Prints a row for each run, which share/doc/diff.md sums up.
# Usage: measure-diff.sh PSI-SLAM PSI-SLAM-BENCH FOLDER [RUNS]
set -eu
if [ $# -lt 3 ]; then
  echo "usage: $0 PSI-SLAM PSI-SLAM-BENCH FOLDER [RUNS]" >&2
  exit 2
fi
app=$1
bench=$2
folder=$3
runs=${4:-13}
mkdir -p "$folder"

# Compares the maps of the two parts of one run and prints its row: NAME SEED OPTION...
measure() {
  name=$1
  seed=$2
  run=$folder/$(echo "$name-$seed" | tr -c "a-z0-9\n" "-")
  shift 2
  "$bench" simulate --path-m 300 --seed "$seed" "$@" --write-log "$run.clf.gz" >"$run.md"
  zcat "$run.clf.gz" >"$run.clf"
  scans=$(grep -c '^FLASER' "$run.clf")
  part=$((scans * 65 / 100))
  for which in head tail; do
    grep '^PARAM' "$run.clf" >"$run-$which.log"
    grep '^FLASER' "$run.clf" | "$which" -n "$part" >>"$run-$which.log"
    "$app" "$run-$which.log" -q --force -o "$run-$which"
  done
  code=0
  "$app" diff "$run-head" "$run-tail" -q --force -o "$run-diff" || code=$?
  [ "$code" -le 1 ] || exit "$code"
  awk -F , -v run="$name" -v seed="$seed" '
    NR > 1 { ++walls[$1]; metres[$1] += $8 }
    function cell(kind) { return walls[kind] ? sprintf("%d (%.1f m)", walls[kind], metres[kind]) : 0 }
    END { print "| " run " | " seed " | " cell("appeared") " | " cell("vanished") " | " cell("moved") " |" }' "$run-diff/diff.csv"
}

echo '| building | seed | appeared | vanished | moved |'
echo '|---|---:|---:|---:|---:|'
for seed in $(seq "$runs"); do measure 'no people, no glass' "$seed" --people 0 --glass 0; done
for seed in $(seq "$runs"); do measure '5 people for every 500 m, 10 % glass' "$seed"; done
