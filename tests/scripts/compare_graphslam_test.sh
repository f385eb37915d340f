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

# Simulated logs with their true poses. The second one has 0.3 m of noise on its ranges: by default nothing can be matched,
# with settings that say so the path is nearer to the truth than that of MRPT's scan matching.
# error_with LOG SETTINGS: of our path, in millimetres.
error_with() {
  LOGS=$1 TEAMS=1 SET=$2 "$root/share/scripts/compare-graphslam.sh" "$demos" "$work/$1" >"$work/table" 2>"$work/messages" ||
    fail "exit code $?, expected 0"
  grep "^| $1 | CPsiFrontEndNRD |" "$work/table" | awk -F'|' '$6 ~ /^ [0-9]+[.][0-9]+ $/ { print int(1000 * $6) }'
}
demos=/usr/share/mrpt/datasets/graphslam-engine-demos/action_observations_map
if [ -d "$demos" ]; then
  error_mm=$(error_with simul "")
  [ -n "$error_mm" ] && [ "$error_mm" -lt 100 ] || fail "simul: ${error_mm:-no error in} mm"
  error_mm=$(error_with range_030_bearing_015 "front_end.min_response=0.05 local_maps.smoothing_sigma_m=0.3")
  [ -n "$error_mm" ] && [ "$error_mm" -lt 600 ] || fail "range_030_bearing_015: ${error_mm:-no error in} mm"
fi

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
