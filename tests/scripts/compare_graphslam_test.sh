#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# compare-graphslam.sh on the beginning of one real log: compare_graphslam_test.sh BUILD_FOLDER
set -euo pipefail

root=$(cd "$(dirname "$0")/../.." && pwd)
export PSI_SLAM_BUILD=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
  echo "compare_graphslam_test.sh: $*" >&2
  cat "$work/table" "$work/messages" >&2
  exit 1
}

mkdir "$work/logs" "$work/empty"
status=0
"$root/share/scripts/compare-graphslam.sh" "$work/empty" "$work/none" >"$work/table" 2>"$work/messages" || status=$?
[ "$status" -eq 2 ] || fail "a folder without logs: exit code $status, expected 2"

if [ ! -r "${PSI_SLAM_DATA:-}/intel.clf.gz" ] || [ ! -r "${PSI_SLAM_DATA:-}/intel.relations" ]; then
  printf 'compare_graphslam_test.sh: Skipped\nneeds the benchmark logs: set PSI_SLAM_DATA to their folder\n'
  exit 77
fi
gzip --decompress --stdout "$PSI_SLAM_DATA/intel.clf.gz" | awk '/^FLASER/ && ++scans > 600 { next } { print }' |
  gzip >"$work/logs/intel.clf.gz"
cp "$PSI_SLAM_DATA/intel.relations" "$work/logs"
LOGS=intel LIMIT_S=10 "$root/share/scripts/compare-graphslam.sh" "$work/logs" "$work/runs" >"$work/table" \
  2>"$work/messages" || fail "exit code $?, expected 0"
ours='^[|] intel [|] CPsiFrontEndNRD [|] CPsiLoopCloserERD [|] CPsiSpaGSO [|]'
grep -qE "$ours 0[.][0-9]+ [|] [0-9.]+ [|] [0-9,]+ [|] [0-9,]+ [|] 1.00 [|]$" "$work/table" || fail "expected our row"
[ "$(grep -c '^| intel |' "$work/table")" -eq 7 ] || fail "expected a row for each choice of deciders"
[ -s "$work/runs/intel/CPsiFrontEndNRD-CPsiLoopCloserERD-CPsiSpaGSO/results/output_map.png" ] || fail "the map is missing"
