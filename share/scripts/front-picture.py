#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws a corrected log of psi-slam twice, side by side: at its odometry poses and at its map poses.

    front-picture.py trajectory.carmen OUT.png

Needs Pillow. draw-front-picture.sh makes the corrected log from any log that psi-slam reads.
"""
import math
import sys

from PIL import Image, ImageDraw, ImageFont

CAPTIONS = ("Scans placed by wheel odometry", "The same scans mapped by psi-slam")
LARGEST_PX = (1360, 680)  # width of both halves together, and height
MARGIN_PX = 20
CAPTION_PX = 44
SCALE_PX = 28  # height of the strip with the scale bar
OVERSAMPLING = 3  # the picture is drawn larger by this factor, then reduced
NODE_DISTANCE_M = 0.1  # scans closer to the last drawn scan, and turned less than NODE_TURN_RAD, are left out
NODE_TURN_RAD = math.radians(5)
FARTHEST_M = 20  # beams are cut at this length, because far walls at grazing angles are noisy
FULL_INK_HITS = 3  # a pixel is black when this many points fall into it
FREE = (228, 236, 245)
PATHS = ((200, 60, 40), (30, 100, 190))
INK = (25, 30, 40)


class Scan:
    """One scan: points in the robot's frame, and the pose of the robot by odometry and in the map."""

    def __init__(self, origin, ends, hits, odom, corrected):
        self.origin = origin  # position of the laser
        self.ends = ends  # ends of the beams, cut at FARTHEST_M
        self.hits = hits  # ends that are returns
        self.poses = (odom, corrected)


def read_scans(path):
    """Reads the scans of a corrected log. Its first lines state mount, beam angles and largest range of each laser."""
    mounts, angles, farthest = {}, {}, {}
    scans = []
    with open(path, encoding="utf-8") as file:
        laser = "front"
        for line in file:
            words = line.split()
            if line.startswith("# rear laser"):
                laser = "rear"
            elif line.startswith("# beams:"):  # "# beams: 180, from -90.0 to 90.0 degrees"
                angles[laser] = (float(words[4]), float(words[6]))
            elif line.startswith("PARAM robot_"):
                name = words[1].replace("robot_", "")
                if name.endswith("_laser_max"):
                    farthest[laser] = float(words[2])
                else:
                    mounts.setdefault(laser, {})[name.split("laser_")[1]] = float(words[2])
            elif words and words[0] in ("FLASER", "RLASER"):
                laser = "front" if words[0] == "FLASER" else "rear"
                scans.append(scan_of(words, mounts[laser], angles[laser], farthest[laser]))
    return scans


def scan_of(words, mount, angles, farthest_m):
    count = int(words[1])
    ranges = [float(word) for word in words[2 : 2 + count]]
    poses = [float(word) for word in words[2 + count : 8 + count]]
    x, y, yaw = mount["offset"], mount["side_offset"], mount["angular_offset"]
    first, last = (yaw + math.radians(angle) for angle in angles)
    step = (last - first) / max(count - 1, 1)
    ends, hits = [], []
    for i, measured in enumerate(ranges):
        if measured >= farthest_m or measured <= 0:
            continue
        length = min(measured, FARTHEST_M)
        end = (x + length * math.cos(first + i * step), y + length * math.sin(first + i * step))
        ends.append(end)
        if measured <= FARTHEST_M:
            hits.append(end)
    return Scan((x, y), ends, hits, tuple(poses[3:6]), tuple(poses[0:3]))


def thinned(scans):
    kept = []
    for scan in scans:
        if kept:
            (x, y, yaw), (last_x, last_y, last_yaw) = scan.poses[1], kept[-1].poses[1]
            turn = abs(math.remainder(yaw - last_yaw, 2 * math.pi))
            if math.hypot(x - last_x, y - last_y) < NODE_DISTANCE_M and turn < NODE_TURN_RAD:
                continue
        kept.append(scan)
    return kept


def placed(points, pose):
    x, y, yaw = pose
    c, s = math.cos(yaw), math.sin(yaw)
    return [(x + c * px - s * py, y + s * px + c * py) for px, py in points]


def wall_direction(scans):
    """The heading in [-45, 45) degrees along which the finished map has most of its walls."""
    bins = [0] * 180  # counts of directions modulo 90 degrees, in bins of half a degree
    for scan in scans[::5]:
        points = placed(scan.hits, scan.poses[1])
        for (ax, ay), (bx, by) in zip(points, points[4:]):
            if math.hypot(bx - ax, by - ay) < 0.6:
                bins[int(math.degrees(math.atan2(by - ay, bx - ax)) % 90 * 2) % 180] += 1
    smooth = [sum(bins[(i + k) % 180] for k in range(-2, 3)) for i in range(180)]
    best = smooth.index(max(smooth)) * 0.5 + 0.25
    return math.radians(best if best < 45 else best - 90)


def turned(pose, angle):
    x, y, yaw = pose
    c, s = math.cos(-angle), math.sin(-angle)
    return (c * x - s * y, s * x + c * y, yaw - angle)


def box_of(scans, which):
    """The box (x range, y range) that holds the path and all but the outermost 0.4 % of the points on each side."""
    points = [point for scan in scans[::3] for point in placed(scan.hits[::3], scan.poses[which])]
    path = [scan.poses[which][:2] for scan in scans]
    box = []
    for axis in (0, 1):
        values = sorted(point[axis] for point in points)
        cut = len(values) // 250
        low = min([values[cut]] + [place[axis] for place in path])
        high = max([values[-1 - cut]] + [place[axis] for place in path])
        spare = 0.02 * (high - low) + 0.5
        box.append((low - spare, high + spare))
    return box


def draw_panel(scans, which, box, panel_px, metres_per_px):
    size = tuple(OVERSAMPLING * px for px in panel_px)
    scale = OVERSAMPLING / metres_per_px
    middle = [(low + high) / 2 for low, high in box]

    def pixels(points):
        return [(size[0] / 2 + (x - middle[0]) * scale, size[1] / 2 - (y - middle[1]) * scale) for x, y in points]

    panel = Image.new("RGB", size, "white")
    draw = ImageDraw.Draw(panel)
    hits = {}
    for scan in scans:
        pose = scan.poses[which]
        fan = pixels(placed([scan.origin] + scan.ends, pose))
        if len(fan) > 2:
            draw.polygon(fan, fill=FREE)
        for x, y in pixels(placed(scan.hits, pose)):
            if 0 <= x < size[0] and 0 <= y < size[1]:
                pixel = (int(x), int(y))
                hits[pixel] = hits.get(pixel, 0) + 1
    ink = Image.new("L", size, 0)
    ink_pixels = ink.load()
    for (x, y), count in hits.items():
        ink_pixels[x, y] = min(255, 255 * count // FULL_INK_HITS)
    panel.paste(INK, mask=ink)
    path = pixels([scan.poses[which][:2] for scan in scans])
    draw.line(path, fill=PATHS[which], width=OVERSAMPLING + 1, joint="curve")
    return panel.resize(panel_px, Image.LANCZOS)


def font(size, bold=False):
    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    try:
        return ImageFont.truetype(name, size)
    except OSError:
        return ImageFont.load_default()


def draw_caption(draw, which, middle, width):
    size = 22
    while size > 8 and draw.textlength(CAPTIONS[which], font=font(size, bold=True)) > width:
        size -= 1
    draw.text((middle, MARGIN_PX + 20), CAPTIONS[which], fill=PATHS[which], font=font(size, bold=True), anchor="ms")


def draw_scale_bar(draw, right, bottom, metres_per_px):
    length_m = max(m for m in (1, 2, 5, 10, 20, 50, 100, 200) if m / metres_per_px <= 140 or m == 1)
    left = right - length_m / metres_per_px
    draw.line([(left, bottom - 5), (left, bottom), (right, bottom), (right, bottom - 5)], fill=INK, width=2)
    draw.text(((left + right) / 2, bottom - 6), f"{length_m} m", fill=INK, font=font(14), anchor="ms")


def draw_picture(scans):
    """Draws both halves at the same scale. The width of each half depends on its content."""
    scans = thinned(scans)
    angle = wall_direction(scans)
    for scan in scans:
        scan.poses = tuple(turned(pose, angle) for pose in scan.poses)
    boxes = [box_of(scans, which) for which in (0, 1)]
    widths_m, heights_m = ([high - low for low, high in axis] for axis in zip(*boxes))
    metres_per_px = max(sum(widths_m) / LARGEST_PX[0], max(heights_m) / LARGEST_PX[1])
    height = round(max(heights_m) / metres_per_px)

    width = round(sum(widths_m) / metres_per_px) + 4 * MARGIN_PX
    picture = Image.new("RGB", (width, height + CAPTION_PX + SCALE_PX + 2 * MARGIN_PX), "white")
    draw = ImageDraw.Draw(picture)
    left = MARGIN_PX
    for which in (0, 1):
        panel_px = (round(widths_m[which] / metres_per_px), height)
        picture.paste(draw_panel(scans, which, boxes[which], panel_px, metres_per_px), (left, MARGIN_PX + CAPTION_PX))
        draw_caption(draw, which, left + panel_px[0] / 2, panel_px[0])
        left += panel_px[0] + 2 * MARGIN_PX
    between = round(widths_m[0] / metres_per_px) + 2 * MARGIN_PX
    draw.line([(between, MARGIN_PX), (between, picture.height - MARGIN_PX)], fill=(215, 220, 228), width=1)
    draw_scale_bar(draw, width - MARGIN_PX, picture.height - MARGIN_PX, metres_per_px)
    return picture.quantize(colors=128, dither=Image.Dither.NONE if hasattr(Image, "Dither") else 0)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__.split("\n\n")[1].strip())
    scans = read_scans(sys.argv[1])
    if not scans:
        sys.exit(f"front-picture.py: {sys.argv[1]} has no FLASER line")
    draw_picture(scans).save(sys.argv[2], optimize=True)


if __name__ == "__main__":
    main()
