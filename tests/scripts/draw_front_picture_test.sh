#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs draw-front-picture.sh on a small simulated log.
#
#     draw_front_picture_test.sh BUILD_FOLDER
set -euo pipefail

root=$(cd "$(dirname "$0")/../.." && pwd)
export PSI_SLAM_BUILD=$1
python=
for one in python3 /usr/bin/python3; do
  ! "$one" -c 'import PIL' 2>/dev/null || python=$one
done
if [ -z "$python" ]; then
  printf 'draw_front_picture_test.sh: Skipped\nneeds Pillow: sudo apt-get install python3-pil\n'
  exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
  echo "draw_front_picture_test.sh: $*" >&2
  cat "$work/messages" >&2
  exit 1
}

"$PSI_SLAM_BUILD/apps/psi-slam-bench/psi-slam-bench" simulate --path-m 40 --people 0 --write-log "$work/room.clf.gz" \
  >"$work/messages" 2>&1 || fail "psi-slam-bench could not simulate a log"
"$root/share/scripts/draw-front-picture.sh" "$work/room.clf.gz" "$work/front.png" --set map.resolution_m=0.1 \
  >"$work/messages" 2>&1 || fail "exit code $?, expected 0"
"$python" - "$work/front.png" >"$work/messages" 2>&1 <<'PYTHON' || fail "the picture is not as expected"
import sys

from PIL import Image

picture = Image.open(sys.argv[1]).convert("RGB")
width, height = picture.size
assert 500 < width < 1500 and 200 < height < 900, f"{width} x {height} pixels"
assert picture.getpixel((0, 0)) == (255, 255, 255), "the background is not white"
half = width * 9 // 20  # width in pixels of the checked part of each half
for name, box, strongest in (("odometry", (0, 60, half, height), 0), ("map", (width - half, 60, width, height), 2)):
    part = list(picture.crop(box).getdata())
    assert sum(max(pixel) < 100 for pixel in part) > 50, f"no walls in the half of the {name}"
    path = [pixel for pixel in part if pixel[strongest] == max(pixel) and pixel[strongest] - min(pixel) > 100]
    assert len(path) > 50, f"no path in the half of the {name}"
PYTHON

expect_usage_error() {
  local status=0
  "$root/share/scripts/draw-front-picture.sh" "$@" >"$work/messages" 2>&1 || status=$?
  [ "$status" -eq 2 ] || fail "draw-front-picture.sh $*: exit code $status, expected 2"
}
expect_usage_error
expect_usage_error "$work/room.clf.gz"
PSI_SLAM_BUILD=$work expect_usage_error "$work/room.clf.gz" "$work/front.png"
