# SPDX-License-Identifier: BSD-3-Clause
"""Compares two folders of results byte for byte, except for measured times and memory."""

import csv
import io
import json
import re

TIMES = ("wall_s", "real_time_factor", "peak_memory_mib", "stages", "milliseconds")


def without_times(value):
    if isinstance(value, dict):
        return {key: without_times(entry) for key, entry in value.items() if key not in TIMES}
    return [without_times(entry) for entry in value] if isinstance(value, list) else value


def comparable(path):
    if path.name in ("frames.csv", "loops.csv"):
        rows = list(csv.reader(io.StringIO(path.read_text())))
        kept = [i for i, name in enumerate(rows[0]) if not name.endswith("_ms") and name != "milliseconds"]
        return [[row[i] for i in kept] for row in rows]
    if path.name == "summary.json":
        return without_times(json.loads(path.read_text()))
    if path.name == "report.html":  # times appear in tables and plots: compares titles, map and hot spots
        text = path.read_text()
        cards = re.findall(r'<section class="card"><h2>(.*?)</h2>(.*?)</section>', text, re.S)
        return [(title, body if title == "Map" else "") for title, body in cards]
    return path.read_bytes()


def assert_same_results(one, other):
    names = sorted(path.name for path in one.iterdir())
    assert names == sorted(path.name for path in other.iterdir())
    assert "trajectory.tum" in names and "report.html" in names
    differing = [name for name in names if comparable(one / name) != comparable(other / name)]
    assert differing == []
