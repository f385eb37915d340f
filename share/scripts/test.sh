#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs the dependencies, builds all targets and runs all tests. The last line counts the tests that passed, failed and
# were skipped. The exit code is 0 if no test failed.
#
#     share/scripts/test.sh [CTEST OPTION...]     # e.g. -R pose_graph
#
# Tests with real logs need the environment variable PSI_SLAM_DATA. It names the folder that fetch-benchmark-logs.sh filled.
set -euo pipefail

if [ -n "${PSI_SLAM_DATA:-}" ]; then
  if [ ! -d "$PSI_SLAM_DATA" ]; then
    echo "test.sh: PSI_SLAM_DATA=$PSI_SLAM_DATA is not a folder. Name the folder of the benchmark logs, or unset it" >&2
    exit 2
  fi
  PSI_SLAM_DATA=$(cd "$PSI_SLAM_DATA" && pwd)
  export PSI_SLAM_DATA
fi
cd "$(dirname "$0")/../.."

results="$PWD/build/release/test-results.xml"

share/scripts/build.sh --tests
rm -rf "$results" build/release/test-results
status=0
# Runs one more test than there are processors, because tests of the window mostly wait.
ctest --preset release --parallel "$(($(nproc) + 1))" --output-junit "$results" "$@" || status=$?
if [ ! -s "$results" ]; then
  echo "test.sh: ctest wrote no results to $results. Read its message above" >&2
  exit 1
fi
python3 share/scripts/test-summary.py "$results" || status=1
exit "$status"
