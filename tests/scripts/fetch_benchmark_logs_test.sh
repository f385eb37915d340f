#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Tests fetch-benchmark-logs.sh with a small home page in a folder. Needs no network.
set -euo pipefail

script="$(cd "$(dirname "$0")/../.." && pwd)/share/scripts/fetch-benchmark-logs.sh"
if ! command -v curl >/dev/null; then
  printf 'fetch_benchmark_logs_test.sh: Skipped\nneeds curl\n'
  exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
home="$work/home"
logs="$work/logs"
export PSI_SLAM_BENCHMARK_URL="file://$home"
unset PSI_SLAM_DATA
mkdir -p "$home/datasets"

fail() {
  echo "fetch_benchmark_logs_test.sh: $*" >&2
  cat "$work/output" >&2
  exit 1
}

# expect CODE ARGUMENT...: runs the script and checks its exit code. Writes its output to $work/output.
expect() {
  local code=$1 found=0
  shift
  "$script" -o "$logs" "$@" >"$work/output" 2>&1 || found=$?
  [ "$found" -eq "$code" ] || fail "fetch-benchmark-logs.sh $* ends with exit code $found, expected $code"
}

# expect_said TEXT: checks that the last output contains TEXT.
expect_said() {
  grep -qF -- "$1" "$work/output" || fail "the output lacks \"$1\""
}

# log_of NUMBER: prints a log with a garbled line and NUMBER scans.
log_of() {
  echo "FLASER 3 1.0 garb"
  for i in $(seq "$1"); do echo "FLASER 3 1.0 2.0 3.0 0 0 0 0 0 0 $i.0 host $i.0"; done
}

log_of 150 >"$home/datasets/aces.clf"
printf '# true relations\n1.0 2.0 0 0 0 0 0 0\n2.0 3.0 0 0 0 0 0 1e-3\n' >"$home/datasets/aces.relations"

# Downloads a log and its relations unchanged, gzips the log, and thanks the person who recorded it.
expect 0 aces
expect_said "aces.clf.gz: 150 scans"
expect_said "aces.relations: 2 relations"
expect_said "aces: Patrick Beeson"
gzip --decompress --stdout "$logs/aces.clf.gz" | cmp - "$home/datasets/aces.clf" || fail "the log has changed"
cmp "$logs/aces.relations" "$home/datasets/aces.relations" || fail "the relations have changed"

# Keeps files that exist, even if the home page has changed.
log_of 200 >"$home/datasets/aces.clf"
expect 0 aces
expect_said "aces.clf.gz exists"
[ "$(gzip --decompress --stdout "$logs/aces.clf.gz" | wc -l)" -eq 151 ] || fail "an existing file was replaced"

# Resumes an interrupted download.
log_of 200 >"$home/datasets/intel.clf"
cp "$home/datasets/aces.relations" "$home/datasets/intel.relations"
head -c 1000 "$home/datasets/intel.clf" | tr 1 7 >"$logs/.part-intel.clf.gz"
expect 0 intel
gzip --decompress --stdout "$logs/intel.clf.gz" | head -c 1000 | cmp - <(head -c 1000 "$home/datasets/intel.clf" | tr 1 7) ||
  fail "the part that existed was downloaded again"
gzip --decompress --stdout "$logs/intel.clf.gz" | tail -c +1001 | cmp - <(tail -c +1001 "$home/datasets/intel.clf") ||
  fail "the resumed part differs from the file of the home page"

# Refuses a web page, a log with too many garbled lines, and a missing file. Leaves no files of them.
echo "<html>moved</html>" >"$home/datasets/mit-csail.clf"
{ log_of 50 && log_of 50; } >"$home/datasets/fr079.clf"
expect 1 mit-csail fr079 mit-killian
expect_said "mit-csail.clf: expected a file of scans"
expect_said "fr079.clf: expected a file of scans"
expect_said "not downloaded: mit-csail fr079 mit-killian"
for name in mit-csail fr079 mit-killian; do
  [ -z "$(find "$logs" -name "*$name*" -size +0)" ] || fail "files of $name remain in $logs"
done

# Refuses an unknown name.
expect 2 nowhere
expect_said 'unknown log "nowhere"'
echo "fetch_benchmark_logs_test.sh: passed"
