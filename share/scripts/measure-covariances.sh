#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Measures how well the covariances of poses fit the errors of simulated runs of 1 km. Writes a report for each
# run, and prints the table in share/doc/covariances.md.
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

# Maps one run and prints its row: NAME SEED OPTION...
measure() {
  name=$1
  seed=$2
  run=$(echo "$name-$seed" | tr -c "a-z0-9\n" "-")
  shift 2
  "$bench" simulate --path-m "$path_m" --seed "$seed" "$@" --json "$folder/$run.json" >"$folder/$run.md"
  awk -F ' *[|] *' -v run="$name" -v seed="$seed" '
    $3 ~ /with independent constraints$/ { independent = $5 " | " $7 }
    $3 ~ /^any two nodes, by the whole graph$/ { pairs = "**" $5 "** | " $6 " | " $7 }
    $3 ~ /^nodes within / { neighbours = $5 " | " $6 " | " $7 }
    $3 ~ /^nodes relative to the first/ { to_first = $5 }
    END {
      if (independent == "" || pairs == "" || neighbours == "" || to_first == "") {
        print "measure-covariances.sh: the report of " run ", seed " seed ", lacks a row" >"/dev/stderr"
        exit 1
      }
      print "| " run " | " seed " | " independent " | " pairs " | " neighbours " | " to_first " |"
    }' "$folder/$run.md"
}

echo "| run of $(awk "BEGIN { print $path_m / 1000 }") km"' | seed | independent: mean | beyond | any two nodes: mean | median | beyond | neighbours: mean | median | beyond | to the first: mean |'
echo '|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|'
for seed in 1 2 3 4 5; do measure 'no people, no glass' "$seed" --people 0 --glass 0; done
for seed in 1 2 3 4 5; do measure '5 people for every 500 m, 10 % glass' "$seed"; done
for seed in 1 2; do measure '15 people for every 500 m, 30 % glass' "$seed" --people 15 --glass 0.3; done
for seed in 1 2; do measure 'laser with a range of 15 m' "$seed" --max-range-m 15; done
for seed in 1 2; do measure 'laser with a noise of 2 cm' "$seed" --range-noise-m 0.02; done
