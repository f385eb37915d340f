#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Maps the benchmark logs once with each loop matcher. Prints a table with the error of the path, the number of accepted
# loops, and the time of loop matching, including the final loop search.
#
#     share/scripts/compare-matchers.sh FOLDER [OUTPUT]     # FOLDER: filled by fetch-benchmark-logs.sh
#
# Needs the programs that share/scripts/build.sh builds. PSI_SLAM_BUILD names the build folder, by default build/release.
# Writes the maps to OUTPUT/MATCHER/LOG, by default out/matchers/MATCHER/LOG.
set -euo pipefail

# shellcheck source=share/scripts/benchmark-logs.bash
source "$(dirname "$0")/benchmark-logs.bash" matchers "psi-slam psi-slam-eval" "$@"
logs=(aces intel mit-killian mit-csail fr079)
matchers=(csm csm_ga ga adaptive)

# rows LOG: prints one line of the table per matcher.
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

echo "| log | matcher | translation [m] | against csm | loops | against csm | loop matching [s] | relative to csm |"
echo "|---|---|---|---|---|---|---|---|"
printf '%s\n' "${table[@]}"
