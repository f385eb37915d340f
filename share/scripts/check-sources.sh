#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Checks all sources of libraries and programs with cppcheck: warnings, performance and portability. Prints the findings, and
# ends with exit code 1 if there are any. tests/cppcheck.supp lists the wrong findings, with a reason for each.
#
#     share/scripts/check-sources.sh
#
# Needs cppcheck (sudo apt-get install cppcheck) and a build folder with build/release/include, which build.sh makes. Takes a
# minute.
set -euo pipefail
cd "$(dirname "$0")/../.."

command -v cppcheck >/dev/null || {
  echo "check-sources.sh: cppcheck is missing. Install it with sudo apt-get install cppcheck" >&2
  exit 2
}

[ -d build/release/include ] || {
  echo "check-sources.sh: build/release/include is missing. Make it with share/scripts/build.sh" >&2
  exit 2
}

# The macro of the JSON library defines two functions that cppcheck does not need.
cppcheck --enable=warning,performance,portability --std=c++17 --language=c++ --quiet --error-exitcode=1 -j "$(nproc)" \
  --suppress=missingIncludeSystem --suppressions-list=<(grep -v '^#' tests/cppcheck.supp) \
  -D 'NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(...)=' -I libs -I libs/include -I build/release/include libs apps
