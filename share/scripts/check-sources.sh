#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Checks all sources of libraries and programs with cppcheck and, with --tidy, also with clang-tidy. Prints the findings, and
# ends with exit code 1 if there are any. clang-tidy runs only if cppcheck finds nothing. tests/cppcheck.supp and .clang-tidy list
# what is left out, each with a reason.
#
#     share/scripts/check-sources.sh          # takes a minute
#     share/scripts/check-sources.sh --tidy   # takes half an hour
#
# Needs cppcheck and build/release/include, which build.sh makes. --tidy also needs clang and clang-tidy, and configures the build
# folder build/fuzz.
set -euo pipefail
cd "$(dirname "$0")/../.."

fail() {
  echo "check-sources.sh: $1" >&2
  exit 2
}

case "${1:-}" in
  '') programs=(cppcheck) ;;
  --tidy) programs=(cppcheck clang++ run-clang-tidy) ;;
  *) fail "unknown option $1, expected --tidy or nothing" ;;
esac
for program in "${programs[@]}"; do
  command -v "$program" >/dev/null || fail "$program is missing. Install it with sudo apt-get install cppcheck clang clang-tidy"
done
[ -d build/release/include ] || fail "build/release/include is missing. Make it with share/scripts/build.sh"

# The macro of the JSON library defines two functions that cppcheck does not need.
cppcheck --enable=warning,performance,portability --std=c++17 --language=c++ --quiet --error-exitcode=1 -j "$(nproc)" \
  --suppress=missingIncludeSystem --suppressions-list=<(grep -v '^#' tests/cppcheck.supp) \
  -D 'NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(...)=' -I libs -I libs/include -I build/release/include libs apps

[ "${1:-}" = --tidy ] || exit 0
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz --target psi_slam_commit >/dev/null  # makes a header
run-clang-tidy -p build/fuzz -quiet -j "$(nproc)" -header-filter "^$PWD/(libs|apps)/" "^$PWD/(build/fuzz/)?(libs|apps)/"
