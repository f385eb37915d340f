#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Measures how well the covariances of poses fit the errors of simulated runs of 1 km. Writes a report for each
# run, and prints the rows of the table in share/doc/covariances.md.
# Usage: measure-covariances.sh PSI-SLAM-BENCH FOLDER [PATH_M]
set -eu
if [ $# -lt 2 ]; then
  echo "usage: $0 PSI-SLAM-BENCH FOLDER [PATH_M]" >&2
  exit 2
fi
bench=$1
folder=$2
path_m=${3:-1000}
mkdir -p "$folder"

# Maps one run and prints the rows of its covariances from the whole graph: NAME SEED OPTION...
measure() {
  name=$1
  seed=$2
  run=$(echo "$name-$seed" | tr -c "a-z0-9\n" "-")
  shift 2
  "$bench" simulate --path-m "$path_m" --seed "$seed" "$@" --json "$folder/$run.json" >"$folder/$run.md" 2>/dev/null
  grep 'by the whole graph' "$folder/$run.md" | sed "s/^| [^|]*|/| $name | $seed |/"
}

echo '| run | seed | of | poses | mean | median | beyond 95 % point |'
echo '|---|---:|---|---:|---:|---:|---:|'
for seed in 1 2 3; do
  measure 'no people, no glass' "$seed" --people 0 --glass 0
  measure '5 people for every 500 m, 10 % glass' "$seed"
done
for seed in 1 2; do
  measure '15 people for every 500 m, 30 % glass' "$seed" --people 15 --glass 0.3
  measure 'laser with a range of 15 m' "$seed" --max-range-m 15
  measure 'laser with a noise of 2 cm' "$seed" --range-noise-m 0.02
done
