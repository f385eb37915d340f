#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Maps each log several times: three times as usual, with 1, 2, 4 and 8 threads, and with the kernels for smaller instruction sets.
# Prints a row for each log: the checksum of all files of the first run, and how many runs gave other files. Ends with exit code 1
# if any did. The rows of other builds and systems can be compared by the checksums.
#
#     share/scripts/measure-same-bytes.sh FOLDER [LOG...]     # FOLDER: filled by fetch-benchmark-logs.sh; LOG: aces, ...
#
# Needs psi-slam, built by share/scripts/build.sh. PSI_SLAM_BUILD names the build folder, by default build/release. Skips logs that
# FOLDER lacks, also in its folder sparse.
set -euo pipefail

[ $# -ge 1 ] && [ -d "$1" ] || { echo "usage: $0 FOLDER [LOG...]" >&2; exit 2; }
folder=$(cd "$1" && pwd)
shift
cd "$(dirname "$0")/../.."
program=${PSI_SLAM_BUILD:-build/release}/apps/psi-slam/psi-slam
[ -x "$program" ] || { echo "$0: $program is missing. Build it with share/scripts/build.sh psi-slam" >&2; exit 2; }
if [ $# -eq 0 ]; then set -- aces intel mit-killian mit-csail fr079 acapulco fhw freiburg-campus; fi
outputs=$(mktemp -d)
trap 'rm -rf "$outputs"' EXIT

variants=("threads=1" "threads=1" "threads=1" "threads=2" "threads=4" "threads=8" "set=baseline" "set=avx2" "set=avx512")

# checksum_of_run LOG VARIANT [-c INI]: maps a log and prints the checksum of all files without times.
checksum_of_run() {
  local threads=2 set=avx512
  local log=$1 variant=$2
  shift 2
  local "$variant"  # sets one of the two
  rm -rf "$outputs/map"
  PSI_SLAM_MAX_INSTRUCTIONS=$set "$program" "$@" "$log" -o "$outputs/map" --threads "$threads" --quiet </dev/null \
    2>"$outputs/words" || { echo "$0: $log with $variant failed: $(cat "$outputs/words")" >&2; exit 1; }
  # The files left out contain times, or are computed by MRPT when it writes them (map.simplemap.gz).
  (cd "$outputs/map" && find . -type f ! -name frames.csv ! -name loops.csv ! -name report.html ! -name summary.json \
    ! -name map.simplemap.gz | LC_ALL=C sort | xargs sha256sum | sha256sum | cut -c1-16)
}

echo "| log | runs | checksum | other files |"
echo "|---|---:|---|---:|"
status=0
for log; do
  file=$folder/$log.clf.gz
  [ -r "$file" ] || file=$folder/sparse/$log.clf.gz
  [ -r "$file" ] || { echo "$0: $folder has no $log.clf.gz, so this log is skipped" >&2; continue; }
  settings=()
  [ -r "ini/$log.ini" ] && settings=(-c "ini/$log.ini")
  first= different=0
  for variant in "${variants[@]}"; do
    checksum=$(checksum_of_run "$file" "$variant" "${settings[@]}")
    : "${first:=$checksum}"
    if [ "$checksum" != "$first" ]; then
      echo "$0: $log with $variant gives other files" >&2
      different=$((different + 1)) status=1
    fi
  done
  echo "| $log | ${#variants[@]} | $first | $different |"
done
exit "$status"
