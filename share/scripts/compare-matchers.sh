#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Maps the benchmark's logs once with each matcher of loops and prints, as a table, what each comes to in whole runs:
# the error of the path, the loops accepted, and the time of matching loops, the last pass included.
#
#     share/scripts/compare-matchers.sh FOLDER [OUTPUT]     # FOLDER is the one that fetch-benchmark-logs.sh has filled
#
# Needs the programs that share/scripts/build.sh builds; PSI_SLAM_BUILD is the folder where they were built if not
# build/release. The maps are left in OUTPUT/MATCHER/LOG, by default out/matchers/MATCHER/LOG.
set -euo pipefail

# shellcheck source=share/scripts/benchmark-logs.bash
source "$(dirname "$0")/benchmark-logs.bash" matchers "psi-slam psi-slam-eval" "$@"
logs=(aces intel mit-killian mit-csail fr079)
matchers=(csm csm_ga ga adaptive)

# rows LOG: a line for each matcher.
rows() {
  python3 - "$outputs" "$1" "${matchers[@]}" <<'END'
import json
import sys

outputs, log, *matchers = sys.argv[1:]


def figures(matcher):
    folder = f"{outputs}/{matcher}/{log}"
    with open(f"{folder}/summary.json", encoding="utf-8") as file:
        summary = json.load(file)
    with open(f"{folder}/evaluation.json", encoding="utf-8") as file:
        evaluation = json.load(file)
    used = summary["loop_matchers"]
    return {
        "error_m": evaluation["translation_abs_m"]["mean"],
        "loops": sum(one["accepted"] for one in used),
        "seconds": sum(one["milliseconds"] for one in used) / 1000,
    }


csm = figures("csm")
for matcher in matchers:
    one = figures(matcher)
    print(f"| {log} | {matcher} | {one['error_m']:.4f} | {one['error_m'] / csm['error_m'] - 1:+.1%} "
          f"| {one['loops']:,} | {one['loops'] - csm['loops']:+,} "
          f"| {one['seconds']:.2f} | {one['seconds'] / csm['seconds']:.2f} |")
END
}

table=()
for log in "${logs[@]}"; do
  has_log "$log" || continue
  for matcher in "${matchers[@]}"; do
    say "mapping $log with $matcher"
    output=$outputs/$matcher/$log
    "${app[psi-slam]}" -c "$root/ini/$log.ini" "$folder/$log.clf.gz" -o "$output" --force --threads 1 --quiet \
      --set "loop_closure.matcher=$matcher" </dev/null
    "${app[psi-slam-eval]}" --json "$output/trajectory.tum" "$folder/$log.relations" >"$output/evaluation.json"
  done
  table+=("$(rows "$log")")
done
expect_results "${#table[@]}"

echo "| log | matcher | translation [m] | against csm | loops | against csm | matching loops [s] | share of csm's |"
echo "|---|---|---|---|---|---|---|---|"
printf '%s\n' "${table[@]}"
