#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Draws the pictures of share/doc/troubleshooting.md: parts of wrong maps of real logs, beside the same parts of right maps.
#
#     PSI_SLAM_DATA=benchmark-logs share/scripts/draw-troubleshooting.sh FOLDER
#
# PSI_SLAM_DATA has aces.clf.gz, fr079.clf.gz, mit-csail.clf.gz and mit-killian.clf.gz, which
# share/scripts/fetch-benchmark-logs.sh fetches. FOLDER gets the pictures, and the messages of all runs as NAME.txt in
# FOLDER/messages. It takes a few minutes. Needs Debian's package python3-pil and the program psi-slam,
# which share/scripts/build.sh builds. PSI_SLAM_BUILD names the build folder if it is not build/release.
set -euo pipefail

fail() {
  echo "draw-troubleshooting.sh: $*" >&2
  exit 2
}

case ${1:-} in
  -h | --help)
    sed -n '3,/^set /{/^#/s/^# \{0,1\}//p}' "$0"
    exit 0
    ;;
esac
[ $# -eq 1 ] || fail "usage: PSI_SLAM_DATA=LOGS $0 FOLDER"
folder=$1

root=$(cd "$(dirname "$0")/../.." && pwd)
psi_slam=${PSI_SLAM_BUILD:-$root/build/release}/apps/psi-slam/psi-slam
[ -x "$psi_slam" ] || fail "$psi_slam is missing. Build it with share/scripts/build.sh psi-slam"
logs=${PSI_SLAM_DATA:-}
for log in aces fr079 mit-csail mit-killian; do
  [ -f "$logs/$log.clf.gz" ] || fail "$log.clf.gz is not in PSI_SLAM_DATA=$logs. Fetch it with share/scripts/fetch-benchmark-logs.sh"
done
# Debian installs Pillow for its own Python, which need not be the first one in PATH.
for python in python3 /usr/bin/python3 ''; do
  [ -n "$python" ] || fail "Python cannot load Pillow. Install it with: sudo apt-get install python3-pil"
  ! "$python" -c 'import PIL' 2>/dev/null || break
done

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$folder/messages"

# map_log NAME LOG SETTINGS [OPTION...]: maps a log into $work/NAME and keeps the messages.
map_log() {
  local name=$1 log=$2 settings=$3
  shift 3
  "$psi_slam" -c "$root/ini/$settings.ini" "$log" -o "$work/$name" "$@" 2>&1 | sed "s#$work#out#g" >"$folder/messages/$name.txt"
}

map_log aces "$logs/aces.clf.gz" aces
map_log double-wall "$logs/aces.clf.gz" aces --set loop_closure.enabled=false
map_log mit-killian "$logs/mit-killian.clf.gz" mit-killian
map_log drift "$logs/mit-killian.clf.gz" mit-killian --set loop_closure.enabled=false
map_log ghosts "$logs/fr079.clf.gz" fr079 --set map.keep_moving=true
map_log no-ghosts "$logs/fr079.clf.gz" fr079
map_log mit-csail "$logs/mit-csail.clf.gz" mit-csail
# The robot is carried: scans 700 to 1000 and all from 1060 on are missing.
zcat "$logs/mit-csail.clf.gz" | awk '$1 != "FLASER" { print; next } { n++ } n < 700 || (n > 1000 && n < 1060)' >"$work/cut.clf"
map_log lost "$work/cut.clf" mit-csail
for name in double-wall drift lost; do
  if grep -q '"state": "good"' "$work/$name/summary.json"; then
    echo "draw-troubleshooting.sh: the verdict of the picture $name is good, so another log should show this fault" >&2
  fi
done

# Each line of the table: picture, pixels per metre, then for both halves the map and the left, bottom, right and top edge in metres.
"$python" - "$work" "$folder" <<'PYTHON'
import sys

from PIL import Image, ImageDraw

work, folder = sys.argv[1:]
GAP_PX = 12
TABLE = """
double-wall 30 double-wall -25 -8 -5 4 aces -25 -8 -5 4
drift 1.8 drift -221 -86 33 175 mit-killian -221 -86 33 175
lost 10 lost -11 -15 30 25 mit-csail -11 -15 30 25
ghosts 100 ghosts -5 2 -1 6 no-ghosts -5 2 -1 6
"""


def crop(name, edges, scale):
    """The part of map.pgm between the edges, in the frame of the map."""
    with open(f"{work}/{name}/map.yaml", encoding="utf-8") as file:
        facts = dict(line.split(": ", 1) for line in file if ": " in line)
    cell = float(facts["resolution"])
    x, y = (float(number) for number in facts["origin"].strip(" []\n").split(",")[:2])
    image = Image.open(f"{work}/{name}/map.pgm").convert("L")
    left, bottom, right, top = edges
    columns = [round((edge - x) / cell) for edge in (left, right)]
    rows = [image.height - round((edge - y) / cell) for edge in (top, bottom)]
    part = Image.new("L", (columns[1] - columns[0], rows[1] - rows[0]), 205)
    part.paste(image, (-columns[0], -rows[0]))
    size = (round((right - left) * scale), round((top - bottom) * scale))
    if scale * cell >= 1:
        return part.resize(size, Image.NEAREST)
    walls = part.point(lambda value: 255 if value < 100 else 0).resize(size, Image.BOX)
    small = part.resize(size, Image.BOX)
    small.paste(0, mask=walls.point(lambda share: min(255, 6 * share)))  # walls are thinner than a pixel
    return small


for line in TABLE.strip().splitlines():
    name, scale, *halves = line.split()
    parts = [crop(one[0], [float(edge) for edge in one[1:]], float(scale)) for one in (halves[:5], halves[5:])]
    height = max(part.height for part in parts)
    picture = Image.new("L", (parts[0].width + GAP_PX + parts[1].width, height), 255)
    picture.paste(parts[0], (0, 0))
    picture.paste(parts[1], (parts[0].width + GAP_PX, 0))
    ImageDraw.Draw(picture).line([(parts[0].width + GAP_PX // 2, 0), (parts[0].width + GAP_PX // 2, height)], fill=120)
    picture.quantize(16).save(f"{folder}/troubleshooting-{name}.png", optimize=True)
PYTHON
