#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Draws the picture at the top of the README: the scans of a log at the poses of the odometry, beside the same scans at
# the poses that psi-slam found. Both halves have the same scale and are drawn by the same code.
#
#     share/scripts/draw-front-picture.sh LOG OUT.png [PSI-SLAM OPTION...]
#     share/scripts/draw-front-picture.sh benchmark-logs/mit-csail.clf.gz share/doc/front.png -c ini/mit-csail.ini
#
# Needs Debian's package python3-pil and the program psi-slam, which share/scripts/build.sh builds. PSI_SLAM_BUILD names
# the build folder if it is not build/release.
set -euo pipefail

fail() {
  echo "draw-front-picture.sh: $*" >&2
  exit 2
}

case ${1:-} in
  -h | --help)
    sed -n '3,/^set /{/^#/s/^# \{0,1\}//p}' "$0"
    exit 0
    ;;
esac
[ $# -ge 2 ] || fail "usage: $0 LOG OUT.png [PSI-SLAM OPTION...]"
log=$1
picture=$2
shift 2

scripts=$(cd "$(dirname "$0")" && pwd)
psi_slam=${PSI_SLAM_BUILD:-$scripts/../../build/release}/apps/psi-slam/psi-slam
[ -x "$psi_slam" ] || fail "$psi_slam is missing. Build it with share/scripts/build.sh psi-slam"
# Debian installs Pillow for its own Python, which need not be the first one in PATH.
for python in python3 /usr/bin/python3 ''; do
  [ -n "$python" ] || fail "Python cannot load Pillow. Install it with: sudo apt-get install python3-pil"
  ! "$python" -c 'import PIL' 2>/dev/null || break
done

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$psi_slam" --quiet "$@" "$log" -o "$work/map"
"$python" "$scripts/front-picture.py" "$work/map/trajectory.carmen" "$picture"
