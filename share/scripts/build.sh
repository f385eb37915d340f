#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs the dependencies, configures the release build and builds it in build/release.
#
#     share/scripts/build.sh [--tests] [TARGET...]     # default: everything
#
# --tests also builds the tests and installs what they need. Without it, a new build folder has no tests, and an older one
# keeps what it has.
#
# Uses one job per processor, but at most one job per 2 GB of free memory. CMAKE_BUILD_PARALLEL_LEVEL overrides this.
set -euo pipefail
cd "$(dirname "$0")/../.."

readonly kilobytes_per_job=$((2 * 1024 * 1024))

fail() {
  echo "build.sh: $*" >&2
  exit 1
}

jobs_for_this_machine() {
  local processors free_kilobytes jobs
  processors=$(nproc)
  free_kilobytes=$(sed -n 's/^MemAvailable: *\([0-9]*\) kB/\1/p' /proc/meminfo)
  jobs=$((${free_kilobytes:-0} / kilobytes_per_job))
  if [ "$jobs" -gt "$processors" ]; then jobs=$processors; fi
  if [ "$jobs" -lt 1 ]; then jobs=1; fi
  echo "$jobs"
}

lists=(build runtime)
options=()
if [ "${1:-}" = --tests ]; then
  shift
  lists+=(test)
  options=(-D PSI_SLAM_BUILD_TESTS=ON)
elif [ ! -f build/release/CMakeCache.txt ]; then
  options=(-D PSI_SLAM_BUILD_TESTS=OFF)
fi
share/scripts/install-dependencies.sh "${lists[@]}"
cmake --preset release "${options[@]}" >&2 || fail "the configuration failed. Read the message of CMake above"
targets=()
if [ $# -gt 0 ]; then targets=(--target "$@"); fi
cmake --build --preset release --parallel "${CMAKE_BUILD_PARALLEL_LEVEL:-$(jobs_for_this_machine)}" \
  "${targets[@]}" >&2 || fail "the build failed. Read the message of the compiler above"
