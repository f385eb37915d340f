#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Maps the benchmark's logs with whole runs of the program, measures the paths against the true relations, and prints errors,
# speed and memory beside what Karto reaches.
#
#     share/scripts/benchmark.sh FOLDER [OUTPUT]     # FOLDER is the one that fetch-benchmark-logs.sh has filled
#
# Needs the programs that share/scripts/build.sh builds; PSI_SLAM_BUILD is the folder where they were built if not
# build/release. The maps are left in OUTPUT/LOG, by default out/benchmark/LOG. Logs that FOLDER lacks are left out.
# One thread maps; let nothing else run beside it, or the speed is not the machine's.
set -euo pipefail

root=$(cd "$(dirname "$0")/../.." && pwd)
programs=${PSI_SLAM_BUILD:-$root/build/release}/apps
psi_slam=$programs/psi-slam/psi-slam
psi_slam_eval=$programs/psi-slam-eval/psi-slam-eval

# log | name | mean translation error of Karto [m]
benchmark="
aces        | ACES         | 0.0492
intel       | Intel        | 0.0213
mit-killian | MIT Killian  | 1.09
mit-csail   | MIT CSAIL    | 0.0407
fr079       | Freiburg 079 | 2.89
"

say() {
  echo "benchmark.sh: $*" >&2
}

wrong_usage() {
  say "$*"
  exit 2
}

# row NAME KARTO SUMMARY EVALUATION: one line of the table.
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
    print(f"benchmark.sh: {name}: {relations['skipped']} relations lie outside the trajectory", file=sys.stderr)
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

case ${1:-} in
  -h | --help)
    sed -n '3,/^set /{/^#/s/^# \{0,1\}//p}' "$0"
    exit 0
    ;;
esac
[ $# -eq 1 ] || [ $# -eq 2 ] || wrong_usage "usage: $0 FOLDER [OUTPUT]"
[ -d "$1" ] || wrong_usage "$1 is no folder"
folder=$(cd "$1" && pwd)
outputs=${2:-$root/out/benchmark}
for program in "$psi_slam" "$psi_slam_eval"; do
  [ -x "$program" ] || wrong_usage "$program is missing; share/scripts/build.sh psi-slam psi-slam-eval makes it"
done

rows=()
sums=()
while IFS='|' read -r log name karto; do
  log=$(xargs <<<"$log") name=$(xargs <<<"$name") karto=$(xargs <<<"$karto")
  [ -n "$log" ] || continue
  if [ ! -r "$folder/$log.clf.gz" ] || [ ! -r "$folder/$log.relations" ]; then
    say "$folder has no $log.clf.gz with $log.relations"
    continue
  fi
  say "mapping $name"
  output=$outputs/$log
  "$psi_slam" -c "$root/ini/$log.ini" "$folder/$log.clf.gz" -o "$output" --force --threads 1 --quiet </dev/null
  "$psi_slam_eval" --json "$output/trajectory.tum" "$folder/$log.relations" >"$output/evaluation.json"
  rows+=("$(row "$name" "$karto" "$output/summary.json" "$output/evaluation.json")")
  sums+=("$(sha256sum <"$folder/$log.clf.gz" | cut -d ' ' -f 1)  $log.clf.gz")
done <<<"$benchmark"
[ "${#rows[@]}" -gt 0 ] || wrong_usage "$folder has none of the benchmark's logs; fetch-benchmark-logs.sh fetches them"

echo "| log | scans | translation [m] | rotation [deg] | Karto's translation [m] | times faster than recorded | memory |"
echo "|---|---|---|---|---|---|---|"
printf '%s\n' "${rows[@]}"
cat <<END

Mean ± standard deviation of the absolute errors. Karto: Open Karto with sparse pose adjustment and the settings that
it ships with, measured on the same logs with the same metric; not run by this script.

Commit $(commit | paste -sd ' '), one thread of: $(processor). SHA-256 of the logs:

END
printf '    %s\n' "${sums[@]}"
