#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Checks that man shows the manual pages without warnings and that they contain the expected texts.
#
#     man_pages_test.sh BUILD
set -euo pipefail
build=$1
command -v man >/dev/null || exit 77

fail() {
  echo "man_pages_test.sh: $*" >&2
  exit 1
}

for program in "$build"/apps/*/psi-*; do
  [ ! -f "$program" ] || [ -f "$build/man/${program##*/}.1.gz" ] || fail "${program##*/} has no manual page"
done
for page in "$build"/man/*.gz; do
  complaints=$(LC_ALL=C.UTF-8 MANROFFSEQ='' MANWIDTH=80 man --warnings -E UTF-8 -l -Tutf8 -Z "$page" 2>&1 >/dev/null)
  [ -z "$complaints" ] || fail "$page: $complaints"
done
shown() { LC_ALL=C.UTF-8 MANWIDTH=200 man -E UTF-8 -l "$build/man/$1" | sed 's/.\x08//g'; }
expect() { grep -qF -- "$2" <<<"$(shown "$1")" || fail "$1 lacks: $2"; }

expect psi-slam.1.gz "psi-slam - draws floor plans from the scans of a 2D lidar and wheel odometry"
expect psi-slam.1.gz "-o, --output DIR"
expect psi-slam.1.gz "psi-slam check [OPTION]... [LOG]"
expect psi-slam.1.gz "psi-slam -c my.ini my.log -o out/ --set map.resolution_m=0.025"
expect psi-slam.1.gz "psi-slam map [OPTION]... [LOG]"
expect psi-slam.1.gz "psi-slam help [COMMAND]..."
expect psi-slam.1.gz "psi-slam eval [OPTION]... [TRAJECTORY] [RELATIONS]"
expect psi-slam.1.gz "Takes the options above."
expect psi-slam.1.gz "Takes the arguments of psi-slam-bench(1)."
expect psi-slam.1.gz "Ctrl-C ends map and live with this code, too"
expect psi-slam-gui.1.gz "--set SECTION.KEY=VALUE"
expect psi-slam-bench.1.gz "psi-slam-bench freiburg [OPTION]..."
expect psi-graphslam.1.gz "psi-graphslam - runs MRPT's graph-slam engine with the deciders of MRPT and of psi-slam"
expect psi-slam.1.gz "psi-graphslam(1)"
expect psi-slam.1.gz "Commands that give 1 another meaning say so in their description"
expect psi-slam.1.gz "compare the results (exit code 1 if a run failed)"
expect psi-slam.ini.5.gz "m, between 0.005 and 10; default 0.05"
if grep -q "freiburg-run\|man-page" <<<"$(shown psi-slam-bench.1.gz)"; then
  fail "psi-slam-bench.1.gz shows hidden commands or options"
fi
count=$("$build/apps/psi-slam/psi-slam" --dump-config | grep -c '^[a-z_0-9]* = ')
items=$(zcat "$build/man/psi-slam.ini.5.gz" | grep -c '^\.TP$')
[ "$count" -eq "$items" ] || fail "psi-slam.ini(5) lists $items of $count options"
