#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs compare-graphslam.sh on MRPT's simulated logs and on the beginning of one real log.
#
#     compare_graphslam_test.sh BUILD_FOLDER
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
[ "$status" -eq 2 ] || fail "compare-graphslam.sh ends with exit code $status if the folder has no logs, expected 2"

# Simulated logs with true poses. The ranges of the second log have noise of 0.3 m. The path of odometry is 10.9 m off.
# error_with LOG SETTINGS: prints the error of psi-slam's path in millimetres.
error_with() {
  LOGS=$1 TEAMS=1 SET=$2 "$root/share/scripts/compare-graphslam.sh" "$demos" "$work/$1" >"$work/table" 2>"$work/messages" ||
    fail "compare-graphslam.sh ends with exit code $? on $1, expected 0"
  grep "^| $1 | CPsiFrontEndNRD |" "$work/table" | awk -F'|' '$6 ~ /^ [0-9]+[.][0-9]+ $/ { print int(1000 * $6) }'
}
demos=/usr/share/mrpt/datasets/graphslam-engine-demos/action_observations_map
if [ -d "$demos" ]; then
  error_mm=$(error_with simul "")
  [ -n "$error_mm" ] && [ "$error_mm" -lt 100 ] ||
    fail "simul: the error is ${error_mm:-unknown} mm, expected less than 100 mm"
  error_mm=$(error_with range_030_bearing_015 "")
  [ -n "$error_mm" ] && [ "$error_mm" -lt 800 ] ||
    fail "range_030_bearing_015 with default settings: the error is ${error_mm:-unknown} mm, expected less than 800 mm"
  error_mm=$(error_with range_030_bearing_015 "local_maps.smoothing_sigma_m=0.2")
  [ -n "$error_mm" ] && [ "$error_mm" -lt 600 ] ||
    fail "range_030_bearing_015: the error is ${error_mm:-unknown} mm, expected less than 600 mm"
fi

if [ ! -r "${PSI_SLAM_DATA:-}/intel.clf.gz" ] || [ ! -r "${PSI_SLAM_DATA:-}/intel.relations" ]; then
  printf 'compare_graphslam_test.sh: Skipped\nneeds the benchmark logs: set PSI_SLAM_DATA to their folder\n'
  exit 77
fi
gzip --decompress --stdout "$PSI_SLAM_DATA/intel.clf.gz" | awk '/^FLASER/ && ++scans > 600 { next } { print }' |
  gzip >"$work/logs/intel.clf.gz"
cp "$PSI_SLAM_DATA/intel.relations" "$work/logs"
LOGS=intel LIMIT_S=10 "$root/share/scripts/compare-graphslam.sh" "$work/logs" "$work/runs" >"$work/table" \
  2>"$work/messages" || fail "compare-graphslam.sh ends with exit code $?, expected 0"
ours='^[|] intel [|] CPsiFrontEndNRD [|] CPsiLoopCloserERD [|] CPsiSpaGSO [|]'
grep -qE "$ours 0[.][0-9]+ [|] [0-9.]+ [|] [0-9,]+ [|] [0-9,]+ [|] 1.00 [|]$" "$work/table" ||
  fail "the row of psi-slam is missing"
[ "$(grep -c '^| intel |' "$work/table")" -eq 7 ] ||
  fail "the table must have seven rows for intel, one for each combination of deciders"
[ -s "$work/runs/intel/CPsiFrontEndNRD-CPsiLoopCloserERD-CPsiSpaGSO/results/output_map.png" ] ||
  fail "output_map.png of psi-slam is missing"
