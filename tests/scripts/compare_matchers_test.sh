#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs compare-matchers.sh on the beginning of one real log.
#
#     compare_matchers_test.sh BUILD_FOLDER
set -euo pipefail

root=$(cd "$(dirname "$0")/../.." && pwd)
export PSI_SLAM_BUILD=$1
if [ ! -r "${PSI_SLAM_DATA:-}/intel.clf.gz" ] || [ ! -r "${PSI_SLAM_DATA:-}/intel.relations" ]; then
  printf 'compare_matchers_test.sh: Skipped\nneeds the benchmark logs: set PSI_SLAM_DATA to their folder\n'
  exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
  echo "compare_matchers_test.sh: $*" >&2
  cat "$work/table" "$work/messages" >&2
  exit 1
}

mkdir "$work/logs" "$work/empty"
gzip --decompress --stdout "$PSI_SLAM_DATA/intel.clf.gz" | awk '/^FLASER/ && ++scans > 2500 { next } { print }' |
  gzip >"$work/logs/intel.clf.gz"
cp "$PSI_SLAM_DATA/intel.relations" "$work/logs"
"$root/share/scripts/compare-matchers.sh" "$work/logs" "$work/maps" >"$work/table" 2>"$work/messages" ||
  fail "compare-matchers.sh ends with exit code $?, expected 0"
for matcher in csm csm_ga ga adaptive; do
  grep -qE "^[|] intel [|] $matcher [|] [0-9.]+ [|] [+-][0-9.]+% [|] [0-9,]+ [|] [+-][0-9,]+ [|] [0-9.]+ [|] [0-9.]+ [|]$" \
    "$work/table" || fail "the row of $matcher is missing"
  [ -s "$work/maps/$matcher/intel/map.png" ] || fail "the map of $matcher is missing"
done
grep -qE '^[|] intel [|] csm [|] [0-9.]+ [|] [+]0.0% [|] [1-9][0-9,]* [|] [+]0 [|] [0-9.]+ [|] 1.00 [|]$' "$work/table" ||
  fail "the row of csm must compare csm with itself: +0.0%, +0 and 1.00"

status=0
"$root/share/scripts/compare-matchers.sh" "$work/empty" "$work/none" >"$work/table" 2>"$work/messages" || status=$?
[ "$status" -eq 2 ] || fail "compare-matchers.sh ends with exit code $status if the folder has no logs, expected 2"
