#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs the commands of the README and of the pages in share/doc and its folder history. The ```sh blocks of a page run in
# order, in a new folder with small simulated logs. Blocks that cannot run are ```console blocks, with the reason in the line
# above. Each filter of tests on a page must select a test.
#
#     documentation_test.sh SOURCE BUILD [PAGE...]     # default: all pages with sh or console blocks
set -euo pipefail

source=$(cd "$1" && pwd)
build=$(cd "$2" && pwd)
shift 2
export PATH="$build/apps/psi-slam:$PATH"  # the line of the README; psi-slam finds the other programs
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# blocks FILE: prints the contents of all sh blocks.
blocks() {
  awk '/^```sh$/ { inside = 1; next } /^```/ { inside = 0; next } inside' "$1"
}

# check_reasons FILE: fails if a console block has no reason in the line above it.
check_reasons() {
  awk -v page="$1" '
    /^```console$/ && before !~ /^<!-- not run .*-->$/ {
      print page ":" NR ": this console block has no reason. Add a line <!-- not run ...: ... --> above it"; wrong = 1 }
    { before = $0 } END { exit wrong }' "$1"
}

# check_filters FILE: fails if a filter for GoogleTest on the page selects no test.
check_filters() {
  local program filter
  while read -r program filter; do
    [[ $("$build/tests/$program" --gtest_list_tests --gtest_filter="${filter//\'/}") == *$'\n  '* ]] ||
      { echo "documentation_test.sh: $1: $program has no test that fits $filter" >&2; return 1; }
  done < <(grep -oE "[a-z_]+_tests --gtest_filter=('[^']+'|[^\` ]+)" "$source/$1" | sed 's/--gtest_filter=//')
}

# Makes the files that the pages use: a log with its relations, and a folder with one log of the benchmark.
write_logs() {
  mkdir -p "$scratch/logs/benchmark-logs"
  cd "$scratch/logs"
  psi-slam bench simulate --path-m 40 --people 0 --write-log benchmark-logs/intel.clf.gz >simulate.md
  cp benchmark-logs/intel.clf.gz my.log
  cp my.log new.log  # a second run of the robot, for merge and localize
  cp benchmark-logs/intel.relations my.relations
}

# run_page PAGE: runs the commands of the page and prints their number.
run_page() {
  local folder="$scratch/${1//\//-}" status=0
  mkdir "$folder"
  cd "$folder"
  cp -r "$scratch/logs/." .
  ln -s "$source/ini" "$source/share" .
  blocks "$source/$1" >commands.sh
  bash -euxo pipefail commands.sh >words 2>&1 || status=$?
  if [ "$status" -ne 0 ]; then
    echo "documentation_test.sh: $1: a command ended with exit code $status. Its last output:" >&2
    tail -n 20 words >&2
    return 1
  fi
  echo "$1: $(grep -c . commands.sh || true) lines run"
}

if [ "$#" -eq 0 ]; then
  mapfile -t pages < <(cd "$source" && grep -lE '^```(sh|console)$' README.md CONTRIBUTING.md share/doc/*.md share/doc/history/*.md)
  set -- "${pages[@]}"
fi
write_logs
for page in "$@"; do
  check_reasons "$source/$page"
  check_filters "$page"
  run_page "$page"
done
