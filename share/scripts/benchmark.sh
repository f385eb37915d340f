#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Maps the benchmark logs with psi-slam and measures the errors of the paths over the relations of the benchmark. Prints
# errors, speed and memory beside the errors of Karto.
#
#     share/scripts/benchmark.sh FOLDER [OUTPUT]     # FOLDER: filled by fetch-benchmark-logs.sh
#
# Needs the programs that share/scripts/build.sh builds. PSI_SLAM_BUILD names the build folder, by default build/release.
# Writes the maps to OUTPUT/LOG, by default out/benchmark/LOG. Skips logs that FOLDER lacks.
# Maps with one thread. Run nothing else at the same time, because it would slow the mapping down.
set -euo pipefail

# shellcheck source=share/scripts/benchmark-logs.bash
source "$(dirname "$0")/benchmark-logs.bash" benchmark psi-slam "$@"

# log | name | mean translation error of Karto [m]
benchmark="
aces        | ACES         | 0.0492
intel       | Intel        | 0.0213
mit-killian | MIT Killian  | 1.09
mit-csail   | MIT CSAIL    | 0.0407
fr079       | Freiburg 079 | 2.89
"

# row NAME KARTO SUMMARY EVALUATION: prints one line of the table.
row() {
  python3 - "$@" <<'END'
import json
import sys

name, karto, *files = sys.argv[1:]
summary, evaluation = (json.load(open(file, encoding="utf-8")) for file in files)


def mean_and_deviation(errors, decimals):
    return f"{errors['mean']:.{decimals}f} ± {errors['std']:.{decimals}f}"


relations = evaluation["relations"]
if relations["skipped"]:
    print(f"benchmark.sh: {name}: skipped {relations['skipped']} relations that lie outside the trajectory", file=sys.stderr)
print("|", " | ".join([
    name,
    f"{summary['log']['scans']:,}",
    mean_and_deviation(evaluation["translation_abs_m"], 3),
    mean_and_deviation(evaluation["rotation_abs_deg"], 2),
    karto,
    f"{summary['real_time_factor']:.0f}",
    f"{summary['peak_memory_mib'] / 1024:.2f} GiB",
]), "|")
END
}

commit() {
  git -C "$root" rev-parse --short=12 HEAD 2>/dev/null || echo "unknown"
  git -C "$root" diff --quiet HEAD 2>/dev/null || echo "with changes"
}

processor() {
  sed -n 's/^model name[[:space:]]*: *//p' /proc/cpuinfo | head -n 1
}

rows=()
sums=()
while IFS='|' read -r log name karto; do
  log=$(xargs <<<"$log") name=$(xargs <<<"$name") karto=$(xargs <<<"$karto")
  [ -n "$log" ] || continue
  has_log "$log" || continue
  say "mapping $name"
  output=$outputs/$log
  "${app[psi-slam]}" -c "$root/ini/$log.ini" "$folder/$log.clf.gz" -o "$output" --force --threads 1 --quiet </dev/null
  "${app[psi-slam]}" eval --json "$output/trajectory.tum" "$folder/$log.relations" >"$output/evaluation.json"
  rows+=("$(row "$name" "$karto" "$output/summary.json" "$output/evaluation.json")")
  sums+=("$(sha256sum <"$folder/$log.clf.gz" | cut -d ' ' -f 1)  $log.clf.gz")
done <<<"$benchmark"
expect_results "${#rows[@]}"

echo "| log | scans | translation [m] | rotation [deg] | Karto: translation [m] | times faster than real time | memory |"
echo "|---|---|---|---|---|---|---|"
printf '%s\n' "${rows[@]}"
cat <<END

Mean ± standard deviation of the absolute errors. Karto: Open Karto with sparse pose adjustment and default settings,
measured on the same logs with the same metric. This script does not run Karto.

Commit $(commit | paste -sd ' '), one thread of: $(processor). SHA-256 of the logs:

END
printf '    %s\n' "${sums[@]}"
