#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests share/scripts/carmen-from-text.py: writes a drive through a room as a JSON log of CSM and as tables of both kinds, converts and
maps them, and compares the poses with the true ones.

usage: carmen_from_text_test.py SOURCES BUILD
"""
import json
import math
import pathlib
import subprocess
import sys
import tempfile

sources, build = (pathlib.Path(path) for path in sys.argv[1:3])
CONVERTER = sources / "share/scripts/carmen-from-text.py"
BEAMS, STEP = 181, math.radians(1.5)
BEARINGS = [STEP * (i - BEAMS // 2) for i in range(BEAMS)]


def range_in_room(x, y, heading):
    dx, dy = math.cos(heading), math.sin(heading)
    walls = [((3 if dx > 0 else -2.5) - x) / dx if dx else math.inf, ((2 if dy > 0 else -4) - y) / dy if dy else math.inf]
    return min(walls)


def drive():
    """Yields time in seconds, true pose and ranges."""
    for i in range(200):
        angle = 0.05 * i
        x, y, theta = 1.2 * math.cos(angle), 1.2 * math.sin(angle) - 1, angle + math.pi / 2
        yield 1000 + 0.2 * i, (x, y, theta), [range_in_room(x, y, theta + b) for b in BEARINGS]


def convert(path, *options, status=0):
    run = subprocess.run([CONVERTER, *options, path], capture_output=True, text=True, check=False)
    assert run.returncode == status, run.stderr
    return run.stdout if status == 0 else run.stderr


def poses_of(text, folder):
    """Maps a CARMEN log and returns times and positions, relative to the first pose."""
    log = folder / "converted.log"
    log.write_text(text)
    out = folder / "map"
    subprocess.run([build / "apps/psi-slam/psi-slam", log, "-o", out, "--force", "-q"], check=True)
    rows = [[float(word) for word in line.split()] for line in (out / "trajectory.tum").read_text().splitlines()]
    return [(t, x, y) for t, x, y, *_ in rows]


def check_map(name, text, folder):
    poses = poses_of(text, folder)
    truth = list(drive())
    assert len(poses) == len(truth), f"{name}: {len(poses)} poses"
    x0, y0, theta0 = truth[0][1]
    for (time, x, y), (true_time, (tx, ty, _), _) in zip(poses, truth):
        dx, dy = tx - x0, ty - y0
        ahead, left = dx * math.cos(theta0) + dy * math.sin(theta0), dy * math.cos(theta0) - dx * math.sin(theta0)
        error = math.hypot(x - ahead, y - left)
        assert abs(time - true_time) < 1e-6 and error < 0.03, f"{name}: error of {error:.3f} m at {time:.1f} s"


def csm(with_odometry):
    return "\n".join(json.dumps({
        "nrays": BEAMS, "min_theta": BEARINGS[0], "max_theta": BEARINGS[-1], "theta": BEARINGS, "readings": ranges,
        "valid": [1] * BEAMS, "timestamp": [int(t), round(t % 1 * 1e6)],
        "odometry": pose if with_odometry else [None, None, None]}) for t, pose, ranges in drive())


def table_of_ros():
    names = ["%time", "field.header.frame_id", "field.angle_min", "field.angle_increment", "field.range_max"]
    rows = [",".join(names + [f"field.ranges{i}" for i in range(BEAMS)])]
    for t, _, ranges in drive():
        rows.append(",".join([f"{round(t * 1e9)}", "laser", str(BEARINGS[0]), str(STEP), "30"] + [str(r) for r in ranges]))
    return "\n".join(rows)


def table_of_bearings(separator):
    rows = [separator.join(["time_s", "x", "y", "theta"] + [f"{math.degrees(b):.6f}" for b in BEARINGS])]
    for t, pose, ranges in drive():
        rows.append(separator.join([str(t)] + [str(v) for v in pose] + [str(r) for r in ranges]))
    return "\n".join(rows)


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    file = folder / "log"
    for name, text, options in (("odometry of CSM", csm(True), []), ("CSM", csm(False), []), ("table of ROS", table_of_ros(), []),
                                ("odometry of a table", table_of_bearings(","), ["--degrees"]),
                                ("odometry of a table with semicolons", table_of_bearings(";"), ["--degrees"])):
        file.write_text(text)
        check_map(name, convert(file, *options), folder)

    # Readings that are invalid, and beams without a return.
    file.write_text('{"min_theta": -1, "max_theta": 1, "readings": [null, NaN, 2.5], "valid": [1, 1, 1], "timestamp": [5, 250000]}')
    words = convert(file).split()
    assert words[:1] + words[8:12] == ["RAWLASER1", "3", "0", "0", "2.5000"], words
    assert words[-3] == "5.250000", words
    file.write_text("time_s,range_max,-1,0,1\n7,20,1.5,inf,3\n")
    assert convert(file).split()[9:12] == ["1.5000", "20", "3.0000"]

    # Maximum ranges that the log leaves out, a byte order mark, and stamps in seconds and nanoseconds.
    file.write_text('{"min_theta": -1, "max_theta": 1, "readings": [1, 2, 3], "timestamp": [5, 0], "max_reading": null}')
    assert convert(file).split()[5] == "1000"
    file.write_text("\ufefftime_s,range_max,-1,0,1\n7,,1.5,2,3\n")
    assert convert(file).split()[5] == "1000"
    for text, time in (("stamp,-1,1\n1700000000.5,1,2", "1700000000.500000"),
                       ("stamp,-1,1\n1700000000500000000,1,2", "1700000000.500000"),
                       ("%time,field.header.stamp,-1,1\n9000000000,8000000000,1,2", "8.000000")):
        file.write_text(text)
        assert convert(file).split()[-1] == time, convert(file)

    for text, sentence in (("", "is empty"), ("a,b\n1,2\n", "the header lacks the time"), ("time_s,x\n1,2\n", "lacks bearings"),
                           ("time_s,-1,0,1\n1,2\n", ":2: 2 columns, expected 4"), ("time_s,-1,0,3\n1,2,2,2\n", "even steps"),
                           ("{\"readings\": [1, 2]}", "scan 1 lacks a valid field, expected"),
                           ('{"min_theta": -1, "max_theta": 1, "readings": [1, 2], "timestamp": [null, null]}',
                            "lacks a valid field, expected"), ("[{\"readings\": ", "expected a JSON object")):
        file.write_text(text)
        found = convert(file, status=2)
        assert sentence in found and found.count("\n") == 1, found
print("all logs are converted")
