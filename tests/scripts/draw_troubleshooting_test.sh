#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs draw-troubleshooting.sh on a small simulated log under the names of the benchmark logs.
#
#     draw_troubleshooting_test.sh BUILD_FOLDER
set -euo pipefail

root=$(cd "$(dirname "$0")/../.." && pwd)
export PSI_SLAM_BUILD=$1
python=
for one in python3 /usr/bin/python3; do
  ! "$one" -c 'import PIL' 2>/dev/null || python=$one
done
if [ -z "$python" ]; then
  printf 'draw_troubleshooting_test.sh: Skipped\nneeds Pillow: sudo apt-get install python3-pil\n'
  exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
  echo "draw_troubleshooting_test.sh: $*" >&2
  cat "$work/messages" >&2
  exit 1
}

"$PSI_SLAM_BUILD/apps/psi-slam-bench/psi-slam-bench" simulate --path-m 30 --people 0 --write-log "$work/aces.clf.gz" \
  >"$work/messages" 2>&1 || fail "psi-slam-bench could not simulate a log"
for log in fr079 mit-csail mit-killian; do
  cp "$work/aces.clf.gz" "$work/$log.clf.gz"
done
PSI_SLAM_DATA=$work "$root/share/scripts/draw-troubleshooting.sh" "$work/pictures" >"$work/messages" 2>&1 ||
  fail "exit code $?, expected 0"
grep -q ' 0 loops closed' "$work/pictures/messages/double-wall.txt" || fail "the map with a double wall has loops"
"$python" - "$work/pictures" >"$work/messages" 2>&1 <<'PYTHON' || fail "a picture is not as expected"
import sys

from PIL import Image

for name in ("double-wall", "drift", "lost", "ghosts"):
    picture = Image.open(f"{sys.argv[1]}/troubleshooting-{name}.png").convert("L")
    width, height = picture.size
    assert 700 < width < 1300 and 300 < height < 600, f"{name}: {width} x {height} pixels"
    # The page says that the left half is the wrong map: both halves exist, divided by a line in a white gap.
    assert picture.getpixel((width // 2, height // 2)) < 180, f"{name}: no line between the halves"
    assert picture.getpixel((width // 2 - 4, height // 2)) > 240, f"{name}: no gap between the halves"
    free = sum(pixel > 240 for pixel in picture.crop((0, 0, width // 2 - 8, height)).getdata())
    assert free > 100, f"{name}: the left half shows no free space"
PYTHON

expect_usage_error() {
  local status=0
  "$root/share/scripts/draw-troubleshooting.sh" "$@" >"$work/messages" 2>&1 || status=$?
  [ "$status" -eq 2 ] || fail "draw-troubleshooting.sh $*: exit code $status, expected 2"
}
expect_usage_error
PSI_SLAM_DATA=$work expect_usage_error "$work/pictures" more
PSI_SLAM_DATA='' expect_usage_error "$work/pictures"
PSI_SLAM_DATA=$work PSI_SLAM_BUILD=$work expect_usage_error "$work/pictures"
rm "$work/mit-killian.clf.gz"
PSI_SLAM_DATA=$work expect_usage_error "$work/pictures"
