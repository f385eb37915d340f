#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs every command of the README and of the pages in share/doc: the ```sh blocks of a page in their order, in a folder of
# their own with small made-up logs. Blocks that cannot be run are ```console, with the reason above them.
#
#     documentation_test.sh SOURCE BUILD [PAGE...]     # default: all that have such blocks
set -euo pipefail

source=$(cd "$1" && pwd)
build=$(cd "$2" && pwd)
shift 2
for app in psi-slam psi-slam-eval psi-slam-bench psi-graphslam; do
  PATH="$build/apps/$app:$PATH"
done
export PATH
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

blocks() {
  awk '/^```sh$/ { inside = 1; next } /^```/ { inside = 0; next } inside' "$1"
}

# A block that is not run says why in the line above it.
check_reasons() {
  awk -v page="$1" '
    /^```console$/ && before !~ /^<!-- not run .*-->$/ {
      print page ":" NR ": say above this block why it is not run: <!-- not run ...: ... -->"; wrong = 1 }
    { before = $0 } END { exit wrong }' "$1"
}

# The files that the pages speak of: a log with its true relations, and a folder of logs named as in the benchmark.
write_logs() {
  mkdir -p "$scratch/logs/benchmark-logs"
  cd "$scratch/logs"
  psi-slam-bench simulate --path-m 40 --people 0 --write-log benchmark-logs/intel.clf.gz >simulate.md
  cp benchmark-logs/intel.clf.gz my.log
  cp my.log new.log  # the robot comes again, started elsewhere for all that its odometry says
  cp benchmark-logs/intel.relations my.relations
}

run_page() {
  local folder="$scratch/${1//\//-}" status=0
  mkdir "$folder"
  cd "$folder"
  cp -r "$scratch/logs/." .
  ln -s "$source/ini" "$source/share" .
  blocks "$source/$1" >commands.sh
  bash -euxo pipefail commands.sh >words 2>&1 || status=$?
  if [ "$status" -ne 0 ]; then
    echo "documentation_test.sh: $1: a command ended with $status; the last words:" >&2
    tail -n 20 words >&2
    return 1
  fi
  echo "$1: $(grep -c . commands.sh || true) lines run"
}

if [ "$#" -eq 0 ]; then
  mapfile -t pages < <(cd "$source" && grep -lE '^```(sh|console)$' README.md share/doc/*.md)
  set -- "${pages[@]}"
fi
write_logs
for page in "$@"; do
  check_reasons "$source/$page"
  run_page "$page"
done
