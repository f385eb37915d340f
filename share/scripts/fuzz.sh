#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Builds the fuzz targets with Clang and runs them with mutated inputs. Stops at the first input that crashes a target, takes
# it longer than 10 s, or makes it use too much memory, keeps that input in FOLDER/found, and exits with 1.
set -eu

usage() {
  cat <<'EOF'
usage: fuzz.sh MINUTES [--jobs N] [--folder FOLDER] [--no-build] [TARGET...]

MINUTES    time for each target
--jobs     targets that run at once, by default 1
--folder   folder for grown corpora, found inputs and output, by default build/fuzz/run
--no-build runs the programs of an earlier build
TARGET     names of targets, by default all: tests/fuzz/TARGET_fuzz.cpp

Prints the number of executions of each target. Needs Debian's package clang.
EOF
}

fail() {
  echo "fuzz.sh: $1" >&2
  exit 2
}

cd "$(dirname "$0")/../.."
minutes= jobs=1 folder=build/fuzz/run build=yes targets=
while [ $# -gt 0 ]; do
  case $1 in
    -h | --help) usage; exit 0 ;;
    --jobs) [ $# -ge 2 ] || fail "--jobs needs a number"; jobs=$2; shift ;;
    --folder) [ $# -ge 2 ] || fail "--folder needs a folder"; folder=$2; shift ;;
    --no-build) build=no ;;
    -*) fail "unknown option $1, see fuzz.sh --help" ;;
    *) if [ -z "$minutes" ]; then minutes=$1; else targets="$targets $1"; fi ;;
  esac
  shift
done
case $minutes in
  '' | *[!0-9.]*) fail "MINUTES is \"$minutes\", expected a number of minutes for each target, such as 5" ;;
esac
case $jobs in
  '' | *[!0-9]* | 0) fail "--jobs is \"$jobs\", expected a number from 1" ;;
esac
seconds=$(awk "BEGIN { print int(60 * $minutes + 0.5) }")
[ "$seconds" -gt 0 ] || fail "MINUTES is $minutes, expected more than 0"
[ -n "$targets" ] || targets=$(for source in tests/fuzz/*_fuzz.cpp; do basename "$source" _fuzz.cpp; done)
for target in $targets; do
  [ -f "tests/fuzz/${target}_fuzz.cpp" ] || fail "there is no target $target. Targets are tests/fuzz/TARGET_fuzz.cpp"
done

if [ $build = yes ]; then
  command -v clang++ > /dev/null || fail "clang++ is missing, which the targets need. Install Debian's package clang"
  cmake --preset fuzz > /dev/null
  cmake --build --preset fuzz
fi
mkdir -p "$folder/found"
folder=$(cd "$folder" && pwd)

# Memory over the limit counts as found: the process may take 1 GiB, which sanitizers double, one allocation 512 MiB.
run() {
  mkdir -p "$folder/corpus/$1"
  # The variable switches off the search for leaks at the end, the option that after each input.
  ASAN_OPTIONS=detect_leaks=0 \
    "build/fuzz/tests/fuzz/$1_fuzz" -max_total_time="$seconds" -timeout=10 -detect_leaks=0 -rss_limit_mb=1024 \
    -malloc_limit_mb=512 -max_len=65536 -print_final_stats=1 -artifact_prefix="$folder/found/$1-" \
    "$folder/corpus/$1" "tests/fuzz/corpus/$1" > "$folder/$1.log" 2>&1
}

report() {
  awk -v name="$1" '/stat::number_of_executed_units/ { n = $2 } /stat::average_exec_per_sec/ { r = $2 }
    /stat::peak_rss_mb/ { m = $2 }
    END { printf "%-18s %12d executions, %7d a second, at most %5d MiB\n", name, n, r, m }' "$folder/$1.log"
}

status=0 running=
wait_for_first() {
  set -- $running
  pair=$1
  shift
  running=$*
  name=${pair%%:*}
  if wait "${pair#*:}"; then
    report "$name"
  else
    status=1
    echo "fuzz.sh: $name failed. The input is in $folder/found, the output in $folder/$name.log:" >&2
    grep -m 3 -E 'ERROR|SUMMARY|runtime error' "$folder/$name.log" >&2 || tail -n 3 "$folder/$name.log" >&2
  fi
}

for target in $targets; do
  run "$target" &
  running="$running $target:$!"
  set -- $running
  [ $# -lt "$jobs" ] || wait_for_first
  [ $status = 0 ] || break
done
while [ -n "${running# }" ]; do wait_for_first; done
exit $status
