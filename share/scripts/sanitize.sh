#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs the dependencies, builds the tests with sanitizers and runs them. The last line counts the tests that passed, failed and
# were skipped. The exit code is 0 if tests ran and none failed.
#
#     share/scripts/sanitize.sh asan [CTEST OPTION...]     # addresses and undefined behaviour: all tests but those below
#     share/scripts/sanitize.sh tsan [CTEST OPTION...]     # threads: the tests of the libraries that use threads
#
# Builds in build/asan with everything, or in build/tsan with these tests only. Both have assertions and little optimisation.
# CTest options can only narrow the selection, by -E. Tests of scripts and packages do not run: they test builds without
# sanitizers. Tests with real logs need the environment variable PSI_SLAM_DATA. It names the folder that fetch-benchmark-logs.sh
# filled. CMAKE_BUILD_PARALLEL_LEVEL sets the number of compilers, by default one per processor.
set -euo pipefail

fail() {
  echo "sanitize.sh: $1" >&2
  exit "$2"
}

readonly threaded=(base batch exports gui live local_maps loop_closure mapping mrpt replay report session)
targets=()
case "${1:-}" in
  asan) selection=(--exclude-regex '^(scripts|package)\.') ;;
  tsan)
    selection=(--tests-regex "^($(IFS='|'; echo "${threaded[*]}"))\.")
    targets=(--target "${threaded[@]/%/_tests}")
    ;;
  *) fail "expected asan or tsan. Usage: share/scripts/sanitize.sh asan|tsan [CTEST OPTION...]" 2 ;;
esac
preset=$1
shift
if [ -n "${PSI_SLAM_DATA:-}" ]; then
  [ -d "$PSI_SLAM_DATA" ] ||
    fail "PSI_SLAM_DATA=$PSI_SLAM_DATA is not a folder. Name the folder of the benchmark logs, or unset it" 2
  PSI_SLAM_DATA=$(cd "$PSI_SLAM_DATA" && pwd)
  export PSI_SLAM_DATA
fi
cd "$(dirname "$0")/../.."

share/scripts/install-dependencies.sh build runtime test
cmake --preset "$preset" -D PSI_SLAM_BUILD_TESTS=ON >/dev/null
cmake --build --preset "$preset" --parallel "${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}" "${targets[@]}"
results=$PWD/build/$preset/test-results.xml
rm -rf "$results" "build/$preset/test-results"
status=0
ctest --preset "$preset" --parallel "$(nproc)" "${selection[@]}" --output-junit "$results" "$@" || status=$?
[ -s "$results" ] || fail "ctest wrote no results to $results. Read its message above" 1
python3 share/scripts/test-summary.py "$results" || status=1
exit "$status"
