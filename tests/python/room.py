# SPDX-License-Identifier: BSD-3-Clause
"""A robot that drives in rounds through a room with a pillar and a niche: scans, odometry, and a CARMEN log of them."""

import math

import numpy as np

BEAMS = 181
MAX_RANGE_M = 40.0
WALLS = np.array(
    [
        [0, 0, 12, 0],
        [12, 0, 12, 8],
        [12, 8, 7, 8],
        [7, 8, 7, 9.5],
        [7, 9.5, 4, 9.5],
        [4, 9.5, 4, 8],
        [4, 8, 0, 8],
        [0, 8, 0, 0],
        [5, 3.4, 7, 3],
        [7, 3, 7.4, 4.6],
        [7.4, 4.6, 5.2, 5],
        [5.2, 5, 5, 3.4],
    ],
    dtype=float,
)


def bearings_rad():
    return -math.pi / 2 + np.arange(BEAMS) * math.pi / (BEAMS - 1)


def ranges_m(pose):
    """Distances to the nearest walls along all beams, rounded to millimetres as in the log."""
    x, y, yaw = pose
    dx, dy = np.cos(yaw + bearings_rad())[:, None], np.sin(yaw + bearings_rad())[:, None]
    x0, y0, x1, y1 = WALLS.T
    wx, wy = x1 - x0, y1 - y0
    determinant = dx * wy - dy * wx
    with np.errstate(divide="ignore", invalid="ignore"):
        along_beam = ((x0 - x) * wy - (y0 - y) * wx) / determinant
        along_wall = ((x0 - x) * dy - (y0 - y) * dx) / determinant
    hit = (along_beam > 0) & (along_wall >= 0) & (along_wall <= 1)
    return np.where(hit, along_beam, np.inf).min(axis=1).round(3)


def true_pose(i):
    turn = i * 0.04
    tangent = math.atan2(2.6 * math.cos(turn), -4 * math.sin(turn))
    return 6.2 + 4 * math.cos(turn), 4 + 2.6 * math.sin(turn), tangent


def drive(scans, stalled=()):
    """Yields time, odometry and ranges of each scan, which repeat those before if it is stalled. Odometry turns too far
    by one percent."""
    odometry = np.zeros(3)
    ranges = None
    for i in range(scans):
        if i > 0:
            x, y, yaw = true_pose(i - 1)
            x1, y1, yaw1 = true_pose(i)
            ahead = math.hypot(x1 - x, y1 - y)
            turn = (yaw1 - yaw + math.pi) % (2 * math.pi) - math.pi
            heading = odometry[2] + turn / 2
            odometry += [ahead * math.cos(heading), ahead * math.sin(heading), 1.01 * turn]
            odometry[2] = (odometry[2] + math.pi) % (2 * math.pi) - math.pi
        ranges = ranges if i in stalled else ranges_m(true_pose(i))
        yield 1000 + i * 0.25, tuple(odometry.round(6)), ranges.copy()


def write_log(path, scans, stalled=()):
    with open(path, "w") as log:
        for time_s, (x, y, yaw), ranges in drive(scans, stalled):
            pose = f"{x:.6f} {y:.6f} {yaw:.6f}"
            readings = " ".join(f"{reading:.3f}" for reading in ranges)
            log.write(f"FLASER {BEAMS} {readings} {pose} {pose} {time_s:.6f} robot {time_s:.6f}\n")
