#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Reads files of a run as other programs read them, and prints what they find there.

    foreign_readers.py evo TRAJECTORY.tum    prints lines: time x y heading
    foreign_readers.py gtsam GRAPH.g2o       prints lines: pose ID x y theta, edge FROM TO dx dy dtheta and the six
    foreign_readers.py g2o GRAPH.g2o         numbers of the upper triangle of its information, fixed ID, chi2 SUM
    foreign_readers.py nav2 MAP.yaml         prints width, height, resolution and the three numbers of the origin,
                                             then a line for each row of cells from below: pairs VALUE COUNT

GTSAM itself reads if its Python module is installed. Otherwise, and for the others, the readers below follow the
documentation of the formats, and refuse what the programs refuse or misread. Units are metres, radians and seconds.
"""
import itertools
import math
import pathlib
import re
import sys


def fail(text):
    sys.exit("foreign_readers.py: " + text)


def evo(path):
    """TUM trajectories: eight numbers in each row with one blank between them; '#' begins a row of comment.

    evo checks that quaternions are normalised and that times increase. Its plots project onto x and y.
    """
    last = -math.inf
    for number, line in enumerate(pathlib.Path(path).read_text().splitlines(), 1):
        if line.startswith("#"):
            continue
        row = [float(word) for word in line.split(" ")]  # two blanks make an empty word, which is no number
        if len(row) != 8:
            fail("row %d has %d numbers" % (number, len(row)))
        time, x, y, z, qx, qy, qz, qw = row
        if abs(math.hypot(qx, qy, qz, qw) - 1) > 1e-6:
            fail("row %d has no unit quaternion" % number)
        if time <= last:
            fail("the time of row %d does not increase" % number)
        last = time
        heading = math.atan2(2 * (qw * qz + qx * qy), 1 - 2 * (qy * qy + qz * qz))
        print("%.6f %.17g %.17g %.17g" % (time, x, y, heading))


class Graph:
    """Poses by their id, edges (from, to, dx, dy, dtheta, six numbers of information), and fixed ids."""

    def __init__(self):
        self.poses, self.edges, self.fixed = {}, [], []

    def add_pose(self, words):
        """VERTEX_SE2 id x y theta"""
        key = int(words[0])
        if key in self.poses or key < 0:
            fail("vertex %d is a second one of this id, or negative" % key)
        self.poses[key] = numbers(words[1:], 3)

    def add_edge(self, words):
        """EDGE_SE2 from to dx dy dtheta xx xy xt yy yt tt"""
        first, second = int(words[0]), int(words[1])
        if first not in self.poses or second not in self.poses:
            fail("the edge from %d to %d has no vertex" % (first, second))
        values = numbers(words[2:], 9)
        xx, xy, xt, yy, yt, tt = values[3:]
        minor = xx * yy - xy * xy
        if xx <= 0 or minor <= 0 or tt * minor - xx * yt * yt + 2 * xy * xt * yt - yy * xt * xt <= 0:
            fail("the information of the edge from %d to %d is not positive definite" % (first, second))
        self.edges.append((first, second, *values))

    def chi2(self):
        """Sum over the edges of the error z^-1 (a^-1 b), weighted with the information."""
        total = 0
        for first, second, dx, dy, dtheta, xx, xy, xt, yy, yt, tt in self.edges:
            x, y, t = seen_from((dx, dy, dtheta), seen_from(self.poses[first], self.poses[second]))
            total += xx * x * x + yy * y * y + tt * t * t + 2 * (xy * x * y + xt * x * t + yt * y * t)
        return total

    def report(self):
        for key, pose in self.poses.items():
            print("pose %d %.17g %.17g %.17g" % (key, *pose))
        for edge in self.edges:
            print("edge %d %d" % edge[:2], *("%.17g" % value for value in edge[2:]))
        for key in self.fixed:
            print("fixed %d" % key)
        print("chi2 %.17g" % self.chi2())


def numbers(words, count):
    values = [float(word) for word in words]
    if len(values) != count or not all(map(math.isfinite, values)):
        fail("expected %d finite numbers, found %s" % (count, " ".join(words)))
    return values


def seen_from(a, b):
    """Pose of b in the frame of a."""
    c, s, dx, dy = math.cos(a[2]), math.sin(a[2]), b[0] - a[0], b[1] - a[1]
    return c * dx + s * dy, c * dy - s * dx, math.remainder(b[2] - a[2], 2 * math.pi)


def lines_of_words(path):
    for line in pathlib.Path(path).read_text().splitlines():
        words = line.split()
        if words and not words[0].startswith("#"):
            yield words


def read_gtsam(path):
    """GTSAM reads all vertices first, then the edges, and passes over lines of other kinds, such as FIX."""
    graph = Graph()
    lines = list(lines_of_words(path))
    for tag, *words in lines:
        if tag == "VERTEX_SE2":
            graph.add_pose(words)
    for tag, *words in lines:
        if tag == "EDGE_SE2":
            graph.add_edge(words)
    return graph


def gtsam(path):
    try:
        import gtsam as library
    except ImportError:
        return read_gtsam(path).report()
    factors, poses = library.readG2o(path, False)
    for key in poses.keys():
        pose = poses.atPose2(key)
        print("pose %d %.17g %.17g %.17g" % (key, pose.x(), pose.y(), pose.theta()))
    for i in range(factors.size()):
        factor = factors.at(i)
        z, information = factor.measured(), factor.noiseModel().information()
        upper = [information[row, column] for row in range(3) for column in range(row, 3)]
        print("edge %d %d" % tuple(factor.keys()), *("%.17g" % v for v in [z.x(), z.y(), z.theta(), *upper]))
    print("chi2 %.17g" % (2 * factors.error(poses)))


def g2o(path):
    """g2o reads line by line: an edge, and FIX with any number of ids, follow their vertices. Ids have 32 bits."""
    graph = Graph()
    for tag, *words in lines_of_words(path):
        if tag == "VERTEX_SE2":
            graph.add_pose(words)
            if int(words[0]) >= 2**31:
                fail("vertex %s has too large an id" % words[0])
        elif tag == "EDGE_SE2":
            graph.add_edge(words)
        elif tag == "FIX":
            graph.fixed += [int(word) for word in words]
            if not set(graph.fixed) <= graph.poses.keys():
                fail("a vertex is fixed before it is defined")
        else:
            fail("unknown type " + tag)
    graph.report()


def yaml_of(path):
    """Returns the keys of a flat YAML file with their texts."""
    values = {}
    for line in pathlib.Path(path).read_text().splitlines():
        if line.strip() and not line.startswith("#"):
            key, text = line.split(": ", 1)
            if key in values:
                fail("the key %s is repeated" % key)
            values[key] = text.strip()
    return values


def real(text):
    """A number that YAML reads as a floating point number or an integer."""
    if not re.fullmatch(r"[-+]?[0-9]+(\.[0-9]*)?([eE][-+]?[0-9]+)?", text):
        fail(text + " is no number")
    return float(text)


def nav2(path):
    """Maps of nav2's map_server: white is free and black occupied, unless `negate`; row 0 of the image is on top.

    Occupancy is the darkness from 0 to 1. Mode trinary makes 100 above occupied_thresh, 0 below free_thresh and -1
    between them; mode scale interpolates between the thresholds; mode raw takes the pixels 0 to 100 as they are.
    """
    from PIL import Image

    values = yaml_of(path)
    resolution = real(values["resolution"])
    origin = [real(text) for text in re.fullmatch(r"\[(.*)\]", values["origin"]).group(1).split(", ")]
    occupied, free = real(values["occupied_thresh"]), real(values["free_thresh"])
    negate, mode = int(values["negate"]), values.get("mode", "trinary")
    if len(origin) != 3 or resolution <= 0 or not 0 <= free < occupied <= 1 or negate not in (0, 1):
        fail("%s has impossible values: %s" % (path, values))
    image = Image.open(pathlib.Path(path).parent / values["image"])
    if image.mode != "L":
        fail("the image is %s, expected grey of 8 bits" % image.mode)

    def value(pixel):
        if mode == "raw":
            return pixel if pixel <= 100 else -1
        occupancy = pixel / 255 if negate else 1 - pixel / 255
        if occupancy > occupied:
            return 100
        if occupancy < free:
            return 0
        if mode == "trinary":
            return -1
        return round((occupancy - free) / (occupied - free) * 100)

    if mode not in ("trinary", "scale", "raw"):
        fail("unknown mode " + mode)
    print(image.width, image.height, resolution, *origin)
    pixels = image.tobytes()
    for row in reversed(range(image.height)):
        runs = itertools.groupby(pixels[row * image.width:(row + 1) * image.width])
        print(*("%d %d" % (value(pixel), len(list(run))) for pixel, run in runs))


if __name__ == "__main__":
    reader = {"evo": evo, "gtsam": gtsam, "g2o": g2o, "nav2": nav2}[sys.argv[1]]
    try:
        reader(sys.argv[2])
    except ImportError as missing:
        print(missing, file=sys.stderr)
        sys.exit(77)
