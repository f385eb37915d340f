#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs benchmark.sh on the beginning of one real log.
#
#     benchmark_test.sh BUILD_FOLDER
set -euo pipefail

root=$(cd "$(dirname "$0")/../.." && pwd)
export PSI_SLAM_BUILD=$1
if [ ! -r "${PSI_SLAM_DATA:-}/intel.clf.gz" ] || [ ! -r "${PSI_SLAM_DATA:-}/intel.relations" ]; then
  printf 'benchmark_test.sh: Skipped\nneeds the benchmark logs: set PSI_SLAM_DATA to their folder\n'
  exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
  echo "benchmark_test.sh: $*" >&2
  cat "$work/table" "$work/messages" >&2
  exit 1
}

expect() {
  grep -qE -- "$1" "$work/$2" || fail "$2 has no line that matches \"$1\""
}

mkdir "$work/logs"
gzip --decompress --stdout "$PSI_SLAM_DATA/intel.clf.gz" | awk '/^FLASER/ && ++scans > 400 { next } { print }' |
  gzip >"$work/logs/intel.clf.gz"
cp "$PSI_SLAM_DATA/intel.relations" "$work/logs"
"$root/share/scripts/benchmark.sh" "$work/logs" "$work/maps" >"$work/table" 2>"$work/messages" ||
  fail "benchmark.sh ends with exit code $?, expected 0"
number='[0-9]+([.][0-9]+)?'
expect '^[|] log [|] scans [|] translation \[m\] [|] rotation \[deg\] [|]' table
expect "^[|] Intel [|] 400 [|] $number ± $number [|] $number ± $number [|] 0.0213 [|] $number [|] $number GiB [|]$" table
expect "^    $(sha256sum <"$work/logs/intel.clf.gz" | cut -d ' ' -f 1)  intel.clf.gz$" table
[ "$(grep -c '^|' "$work/table")" -eq 3 ] || fail "the table must have exactly one row, for the log intel"
expect 'no aces.clf.gz' messages
expect 'Intel: skipped [0-9]+ relations that lie outside' messages
[ -s "$work/maps/intel/map.png" ] || fail "$work/maps/intel/map.png is missing"

mkdir "$work/empty"
code=0
"$root/share/scripts/benchmark.sh" "$work/empty" "$work/maps" >"$work/table" 2>"$work/messages" || code=$?
[ "$code" -eq 2 ] || fail "benchmark.sh ends with exit code $code if the folder has no logs, expected 2"
