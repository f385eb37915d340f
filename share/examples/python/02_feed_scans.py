# SPDX-License-Identifier: BSD-3-Clause
"""Feeds scans from NumPy arrays to the mapper, as the driver of a robot does. A simulated hall replaces the robot.

    python3 02_feed_scans.py OUTPUT_FOLDER
"""

import math
import sys
from typing import Any

import numpy as np
import numpy.typing as npt

import psi_slam

Array = npt.NDArray[Any]

BEAMS = 270
FIELD_OF_VIEW_RAD = math.radians(270)
MAX_RANGE_M = 30.0
# Walls of the hall and of three boxes in it, each from (x0, y0) to (x1, y1) in metres.
CORNERS: list[list[tuple[float, float]]] = [
    [(0, 0), (14, 0), (14, 9), (9, 9), (9, 11), (0, 11)],
    [(5, 4), (8, 4), (8, 6), (5, 6)],
    [(1, 9), (2, 9), (2, 10), (1, 10)],
    [(11, 1), (12, 1), (12, 2), (11, 2)],
]
WALLS = np.array([[*a, *b] for box in CORNERS for a, b in zip(box, box[1:] + box[:1])])


def measured_ranges(x: float, y: float, yaw: float, random: np.random.Generator) -> Array:
    """Ranges along all beams, with noise of 1 cm."""
    bearings = yaw + np.linspace(-FIELD_OF_VIEW_RAD / 2, FIELD_OF_VIEW_RAD / 2, BEAMS)
    dx, dy = np.cos(bearings)[:, None], np.sin(bearings)[:, None]
    x0, y0, x1, y1 = WALLS.T
    wx, wy = x1 - x0, y1 - y0
    with np.errstate(divide="ignore", invalid="ignore"):
        along_beam = ((x0 - x) * wy - (y0 - y) * wx) / (dx * wy - dy * wx)
        along_wall = ((x0 - x) * dy - (y0 - y) * dx) / (dx * wy - dy * wx)
    hit = (along_beam > 0) & (along_wall >= 0) & (along_wall <= 1)
    ranges: Array = np.where(hit, along_beam, np.inf).min(axis=1) + random.normal(0, 0.01, BEAMS)
    return ranges


def true_path(scans: int) -> Array:
    """Poses (x, y, yaw) of two rounds through the hall."""
    turn = np.linspace(0, 4 * np.pi, scans)
    return np.stack(
        [6.5 + 4.5 * np.cos(turn), 5 + 3 * np.sin(turn), np.arctan2(3 * np.cos(turn), -4.5 * np.sin(turn))], axis=1
    )


def seen_from(pose: Array, other: Array) -> Array:
    """The pose `other` in the frame of `pose`."""
    dx, dy, turn = other - pose
    c, s = np.cos(pose[2]), np.sin(pose[2])
    return np.array([c * dx + s * dy, -s * dx + c * dy, (turn + np.pi) % (2 * np.pi) - np.pi])


def composed(pose: Array, motion: Array) -> Array:
    """The pose that is `motion` away from `pose`, in its frame."""
    c, s = np.cos(pose[2]), np.sin(pose[2])
    x, y, turn = motion
    return np.array([pose[0] + c * x - s * y, pose[1] + s * x + c * y, pose[2] + turn])


def main() -> int:
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    random = np.random.default_rng(1)
    path = true_path(400)
    odometry: Array = np.zeros(3)
    mapper = psi_slam.Mapper({"map.resolution_m": 0.05}, name="simulated hall", estimate_covariance=True)
    for i, (x, y, yaw) in enumerate(path):
        if i > 0:  # wheels slip: odometry is wrong by a few percent
            odometry = composed(odometry, seen_from(path[i - 1], path[i]) * random.normal(1, 0.03, 3))
        scan = psi_slam.Scan(
            measured_ranges(x, y, yaw, random),
            time_s=0.1 * i,
            max_range_m=MAX_RANGE_M,
            angle_min_rad=-FIELD_OF_VIEW_RAD / 2,
            angle_increment_rad=FIELD_OF_VIEW_RAD / (BEAMS - 1),
        )
        pose = mapper.add(scan, odometry)  # the pose is known at once; loops correct it later
        if i % 100 == 0:
            print(f"scan {i}: x {pose.x_m:.2f} m, y {pose.y_m:.2f} m, heading {math.degrees(pose.yaw_rad):.0f} deg")
    result = mapper.finish()
    truth = np.array([seen_from(path[0], pose) for pose in path])
    errors = np.hypot(result.poses["x_m"] - truth[:, 0], result.poses["y_m"] - truth[:, 1])
    print(f"{len(result.poses)} scans, mean error {errors.mean():.3f} m, largest error {errors.max():.3f} m")
    result.save(sys.argv[1], force=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
