#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Converts a JSON log of CSM (Canonical Scan Matcher) or a CSV table of ranges to a CARMEN log on standard output.

    share/scripts/carmen-from-text.py [--degrees] LOG > NEW.log

share/doc/logs.md describes the columns of a table. Invalid readings become 0, readings without a return the maximum range.
"""
import argparse
import csv
import json
import math
import sys

TIMES_S = ("time", "time_s", "timestamp", "t")
STAMPS = ("stamp", "%time")  # the time of measurement goes before the time of receipt
MOST_SECONDS = 1e12  # a larger number in a column "stamp" is in nanoseconds
MAX_RANGE_M = 1000.0  # of a log that states none


class Mistake(Exception):
    """An error that the user can correct."""


def carmen_line(time_s, first_rad, span_rad, max_range_m, ranges_m, odometry):
    """Returns a ROBOTLASER1 line with the pose of odometry (x, y, theta in metres and radians), else a RAWLASER1 line."""
    step_rad = span_rad / max(len(ranges_m) - 1, 1)
    texts = ["0", f"{first_rad:.9f}", f"{span_rad:.9f}", f"{step_rad:.9f}", f"{max_range_m:g}", "0.01", "0", str(len(ranges_m))]
    texts += [f"{range_m:.4f}" if range_m > 0 and math.isfinite(range_m) else f"{max_range_m if range_m == math.inf else 0:g}"
              for range_m in ranges_m]
    texts.append("0")
    if odometry:
        texts += 2 * [f"{value:.6f}" for value in odometry] + 5 * ["0"]
    stamp = f"{time_s:.6f}"
    return " ".join(["ROBOTLASER1" if odometry else "RAWLASER1"] + texts + [stamp, "converted", stamp])


def number(text):
    """Returns a number; NaN for other text, such as an empty cell."""
    try:
        return float(text)
    except (TypeError, ValueError):
        return math.nan


def max_range(text):
    """Returns the stated maximum range in metres; MAX_RANGE_M if there is none."""
    range_m = number(text)
    return range_m if range_m > 0 and math.isfinite(range_m) else MAX_RANGE_M


def even_span(bearings_rad, place):
    """Returns the span of bearings in even steps, radians. CARMEN cannot state others."""
    span_rad = bearings_rad[-1] - bearings_rad[0]
    for i, bearing_rad in enumerate(bearings_rad):
        if abs(bearing_rad - bearings_rad[0] - span_rad * i / max(len(bearings_rad) - 1, 1)) > 1e-3:
            raise Mistake(f"{place}: beam {i} at {bearing_rad:.4f} rad is not in even steps, expected equal steps "
                          "within 0.001 rad. Resample the scans")
    return span_rad


def objects_of(text, path):
    """Yields the JSON objects of a text, one after the other or in an array."""
    decoder = json.JSONDecoder()
    at = 0
    while True:
        while at < len(text) and text[at] in " \t\r\n,[]":
            at += 1
        if at == len(text):
            return
        try:
            found, at = decoder.raw_decode(text, at)
        except json.JSONDecodeError as error:
            raise Mistake(f"{path}: character {at}: {error.msg}, expected a JSON object. Fetch the log again") from error
        yield found


def lines_of_csm(text, path):
    """Yields the lines for the scans of CSM's JSON log."""
    for count, scan in enumerate(objects_of(text, path), 1):
        place = f"{path}: scan {count}"
        try:
            valid = scan.get("valid") or [1] * len(scan["readings"])
            ranges_m = [number(r) if v else 0.0 for r, v in zip(scan["readings"], valid)]
            if scan.get("theta"):
                first_rad, span_rad = scan["theta"][0], even_span(scan["theta"], place)
            else:
                first_rad, span_rad = scan["min_theta"], scan["max_theta"] - scan["min_theta"]
            seconds, microseconds = scan["timestamp"]
            time_s = seconds + 1e-6 * microseconds
            numbers = first_rad, span_rad, time_s
            if not all(map(math.isfinite, numbers)):
                raise ValueError(numbers)
            odometry = scan.get("odometry")
            if odometry and not all(isinstance(v, (int, float)) and math.isfinite(v) for v in odometry):
                odometry = None
        except (AttributeError, KeyError, TypeError, ValueError) as error:
            raise Mistake(f"{place} lacks a valid field, expected readings, timestamp, and theta or min_theta and max_theta. "
                          "Correct the log") from error
        yield carmen_line(time_s, first_rad, span_rad, max_range(scan.get("max_reading")), ranges_m, odometry)


def column_name(name):
    """Returns the last part of a column's name: "angle_min" of "field.angle_min"."""
    return name if math.isfinite(number(name)) else name.strip().split(".")[-1].lower()


def lines_of_table(lines, path, degrees):
    """Yields the lines for the rows of a CSV table."""
    dialect = csv.Sniffer().sniff(lines[0], delimiters=",;\t ")
    rows = csv.reader(lines, dialect)
    names = [column_name(name) for name in next(rows)]
    at = {name: i for i, name in reversed(list(enumerate(names)))}
    time = next((name for name in TIMES_S + STAMPS if name in at), None)
    numbered = [i for i, name in enumerate(names) if name.startswith("ranges") and name[6:].strip("[]_").isdigit()]
    named = [i for i, name in enumerate(names) if math.isfinite(number(name))]
    ranges = numbered if "angle_min" in at and "angle_increment" in at else named
    if time is None or len(ranges) < 2:
        raise Mistake(f"{path}:1: the header lacks {'the time' if time is None else 'bearings'}, expected a column {TIMES_S[1]} and "
                      "columns of ranges that are named by their bearings, or angle_min, angle_increment, ranges0, ranges1, ... "
                      "Correct the header")
    unit = math.radians(1) if degrees else 1
    for line, row in enumerate(rows, 2):
        if not row:
            continue
        place = f"{path}:{line}"
        if len(row) < len(names):
            raise Mistake(f"{place}: {len(row)} columns, expected {len(names)}. Correct the row")
        if ranges is numbered:
            first_rad = number(row[at["angle_min"]])
            span_rad = number(row[at["angle_increment"]]) * (len(ranges) - 1)
        else:
            bearings_rad = [unit * number(names[i]) for i in ranges]
            first_rad, span_rad = bearings_rad[0], even_span(bearings_rad, place)
        time_s = number(row[at[time]])
        if time in STAMPS and ("%time" in at or time_s > MOST_SECONDS):  # ROS counts nanoseconds
            time_s *= 1e-9
        if not all(map(math.isfinite, (first_rad, span_rad, time_s))):
            raise Mistake(f"{place}: the time or a bearing is not a number. Correct the row")
        odometry = [number(row[at[name]]) for name in ("x", "y", "theta") if name in at]
        max_range_m = max_range(row[at["range_max"]] if "range_max" in at else None)
        yield carmen_line(time_s, first_rad, span_rad, max_range_m, [number(row[i]) for i in ranges],
                          odometry if len(odometry) == 3 else None)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("log", metavar="LOG", help="JSON log of CSM, or CSV table whose first line names the columns")
    parser.add_argument("--degrees", action="store_true", help="the columns of the table are named by bearings in degrees")
    arguments = parser.parse_args()
    try:
        with open(arguments.log, encoding="utf-8-sig", errors="replace", newline="") as file:
            text = file.read()
        if not text.strip():
            raise Mistake(f"{arguments.log} is empty, expected a JSON log of CSM or a CSV table")
        is_json = text.lstrip()[0] in "{["
        lines = lines_of_csm(text, arguments.log) if is_json else lines_of_table(text.splitlines(), arguments.log, arguments.degrees)
        for line in lines:
            print(line)
    except (Mistake, OSError, csv.Error) as error:
        print(f"carmen-from-text.py: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
