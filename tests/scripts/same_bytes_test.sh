#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Maps a log as usual, without the C library's code for newer processors, without psi-slam's own, and with a C library whose last
# bits are changed. Fails if a file differs.
#
#     same_bytes_test.sh BUILD SOURCE
set -euo pipefail

program=$1/apps/psi-slam/psi-slam
log=${PSI_SLAM_DATA:-}/mit-csail.clf.gz
if [ -z "${PSI_SLAM_DATA:-}" ] || [ ! -e "$log" ]; then
  echo "same_bytes_test.sh: PSI_SLAM_DATA does not contain the log of CSAIL"
  exit 77
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cc -shared -fPIC -O2 -fno-builtin -o "$folder/perturbed_math.so" "$2/tests/scripts/perturbed_math.c" -lm -ldl

number='import math; print(sum(math.sin(i) for i in range(9)))'
if [ "$(python3 -c "$number")" = "$(LD_PRELOAD=$folder/perturbed_math.so python3 -c "$number")" ]; then
  echo "same_bytes_test.sh: the preloaded library changes no result of sin()" >&2
  exit 1
fi

run() {
  local name=$1
  shift
  env "$@" "$program" "$log" -o "$folder/$name" >/dev/null 2>"$folder/$name.err" || { cat "$folder/$name.err" >&2; exit 1; }
}
run usual PSI_SLAM=usual
run older_processor GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-AVX2,-AVX512F,-FMA4
run baseline_kernels PSI_SLAM_MAX_INSTRUCTIONS=baseline
run other_library LD_PRELOAD="$folder/perturbed_math.so"

# These files contain times, or are computed by MRPT when it writes them (map.simplemap.gz).
other_files=(frames.csv loops.csv report.html summary.json map.simplemap.gz)
status=0
for name in older_processor baseline_kernels other_library; do
  diff --brief --recursive "${other_files[@]/#/--exclude=}" "$folder/usual" "$folder/$name" >&2 || status=1
done
exit $status
