#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Measures how far the last bit of sine, arctangent and the like changes maps. Maps each benchmark log once as usual and RUNS
# times with about half of those results changed in their last bit, differently in each run. Prints the spread of the errors over
# the relations, how far the paths are from the usual one, and the standard deviation of the positions that the usual run predicts.
#
#     share/scripts/measure-rounding.sh FOLDER [OUTPUT] [RUNS]     # FOLDER: filled by fetch-benchmark-logs.sh; RUNS: 20
#
# Needs a C compiler and the programs that share/scripts/build.sh builds. PSI_SLAM_BUILD names the build folder, by default
# build/release. Writes the paths to OUTPUT, by default out/rounding. Skips logs that FOLDER lacks.
set -euo pipefail

runs=${3:-20}
# shellcheck source=share/scripts/benchmark-logs.bash
source "$(dirname "$0")/benchmark-logs.bash" rounding psi-slam "${@:1:2}"

mkdir -p "$outputs"
cc -shared -fPIC -O2 -o "$outputs/perturbed-sleef.so" "$(dirname "$0")/perturbed-sleef.c" -lm -ldl

echo "| log | usual error [m] | $runs runs: mean [m] | least [m] | greatest [m] | distance of paths, mean [m] | of one run, at most [m] | of one pose, at most [m] | predicted standard deviation, mean [m] |"
echo "|---|---:|---:|---:|---:|---:|---:|---:|---:|"
for log in aces intel mit-killian mit-csail fr079; do
  has_log "$log" || continue
  for run in $(seq 0 "$runs"); do
    say "mapping $log, run $run of $runs"
    output=$outputs/$log-$run
    ROUNDING_SEED=$run LD_PRELOAD=$(realpath "$outputs/perturbed-sleef.so") "${app[psi-slam]}" -c "$root/ini/$log.ini" \
      "$folder/$log.clf.gz" -o "$output" --force --threads 1 --quiet </dev/null 2>/dev/null
    "${app[psi-slam]}" eval --json "$output/trajectory.tum" "$folder/$log.relations" >"$output/evaluation.json"
  done
  python3 - "$log" "$outputs" "$runs" <<'END'
import csv
import json
import math
import sys

log, folder, runs = sys.argv[1], sys.argv[2], int(sys.argv[3])


def error_m(run):
    with open(f"{folder}/{log}-{run}/evaluation.json", encoding="utf-8") as file:
        return json.load(file)["translation_abs_m"]["mean"]


def positions(run):
    with open(f"{folder}/{log}-{run}/trajectory.tum", encoding="utf-8") as file:
        return [tuple(map(float, line.split()[1:3])) for line in file if not line.startswith("#")]


def predicted_deviation_m():
    with open(f"{folder}/{log}-0/trajectory.csv", encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["cov_xx_m2"]]
    return sum(math.sqrt(float(row["cov_xx_m2"]) + float(row["cov_yy_m2"])) for row in rows) / len(rows)


usual = positions(0)
distances = [[math.dist(a, b) for a, b in zip(usual, positions(run), strict=True)] for run in range(1, runs + 1)]
means = [sum(run) / len(run) for run in distances]
errors = [error_m(run) for run in range(1, runs + 1)]
print("|", " | ".join([
    log,
    f"{error_m(0):.4f}",
    f"{sum(errors) / runs:.4f}",
    f"{min(errors):.4f}",
    f"{max(errors):.4f}",
    f"{sum(means) / runs:.3f}",
    f"{max(means):.3f}",
    f"{max(map(max, distances)):.3f}",
    f"{predicted_deviation_m():.3f}",
]), "|")
END
done
