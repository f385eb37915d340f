#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Measures how well the covariances of poses fit the errors of simulated runs of 1 km. Writes a report for each
# run, and prints the table in share/doc/covariances.md. Below the runs of a kind, prints their means.
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

# Maps a run for each seed and prints the rows and their means: NAME "SEED..." OPTION...
measure_all() {
  name=$1
  seeds=$2
  shift 2
  : >"$folder/rows.md"
  for seed in $seeds; do
    row=$(measure "$name" "$seed" "$@")
    echo "$row" | tee -a "$folder/rows.md"
  done
  awk -F ' *[|] *' '
    { for (i = 4; i <= 11; ++i) { cell = $i; gsub(/[*%]/, "", cell); sum[i] += cell } }
    END {
      printf "| mean of these %d runs | | %.2f | %.1f %% | **%.2f** | %.2f | %.1f %% | %.2f | %.2f | %.1f %% | |\n", NR,
        sum[4] / NR, sum[5] / NR, sum[6] / NR, sum[7] / NR, sum[8] / NR, sum[9] / NR, sum[10] / NR, sum[11] / NR
    }' "$folder/rows.md"
}

echo "| run of $(awk "BEGIN { print $path_m / 1000 }") km"' | seed | independent: mean | beyond | any two nodes: mean | median | beyond | neighbours: mean | median | beyond | to the first: mean |'
echo '|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|'
measure_all 'no people, no glass' '1 2 3 4 5' --people 0 --glass 0
measure_all '5 people for every 500 m, 10 % glass' '1 2 3 4 5'
measure_all '15 people for every 500 m, 30 % glass' '1 2' --people 15 --glass 0.3
measure_all 'laser with a range of 15 m' '1 2' --max-range-m 15
measure_all 'laser with a noise of 2 cm' '1 2' --range-noise-m 0.02
