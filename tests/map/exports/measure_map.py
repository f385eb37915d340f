#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Opens a map file with a program or library of another project and measures the outer walls in the map.

    measure_map.py FILE

prints one line: x_min x_max y_min y_max of the occupied area, in metres of the map (of the coordinate
system for .tif), then further facts about the file. Exit code 77 means that the program or library that
reads the file is not installed.
"""
import shutil
import subprocess
import sys
import tempfile


def report(x_min, x_max, y_min, y_max, *facts):
    print("%.4f %.4f %.4f %.4f" % (x_min, x_max, y_min, y_max), *facts)


def dark_box(image, below):
    """Returns the first and last columns and rows with a dark pixel above row `below`, ends exclusive."""
    grey = image.crop((0, 0, image.width, below)).convert("L")
    return grey.point(lambda value: 255 if value < 100 else 0).getbbox()


def measure_svg(path):
    """Measures the drawing as librsvg draws it, with 10 pixels per millimetre of paper."""
    from PIL import Image
    import xml.etree.ElementTree as tree

    if not shutil.which("rsvg-convert"):
        raise ImportError("rsvg-convert")
    root = tree.parse(path).getroot()
    left, top, width, _ = (float(number) for number in root.get("viewBox").split())
    paper_mm = float(root.get("width").removesuffix("mm"))
    with tempfile.NamedTemporaryFile(suffix=".png") as drawn:
        dpi = ["--dpi-x", "254", "--dpi-y", "254"]
        subprocess.run(["rsvg-convert", *dpi, "-o", drawn.name, path], check=True)
        image = Image.open(drawn.name).convert("RGB")
    metre_px = image.width / width
    box = dark_box(image, image.height - round(22 * 10))
    report(left + box[0] / metre_px, left + box[2] / metre_px,
           -top - box[3] / metre_px, -top - box[1] / metre_px,
           "%.2f" % paper_mm, image.width, image.height)


def measure_dxf(path):
    import ezdxf
    from ezdxf import bbox

    drawing = ezdxf.readfile(path)
    audit = drawing.audit()
    walls = drawing.modelspace().query('*[layer=="WALLS"]')
    paths = drawing.modelspace().query('POLYLINE[layer=="TRAJECTORY"]')
    box = bbox.extents(walls)
    faults = audit.errors + audit.fixes
    report(box.extmin.x, box.extmax.x, box.extmin.y, box.extmax.y, len(walls), len(paths), len(faults),
           drawing.units, drawing.header["$MEASUREMENT"])


def measure_tif(path):
    from osgeo import gdal

    gdal.UseExceptions()
    data = gdal.Open(path)
    band = data.GetRasterBand(1)
    cells = band.ReadRaster()
    corners = []
    for row in range(data.RasterYSize):
        for column in range(data.RasterXSize):
            if 50 < cells[row * data.RasterXSize + column] <= 100:
                corners += [gdal.ApplyGeoTransform(data.GetGeoTransform(), column + i, row + j)
                            for i in (0, 1) for j in (0, 1)]
    eastings, northings = zip(*corners)
    system = data.GetSpatialRef()
    report(min(eastings), max(eastings), min(northings), max(northings),
           system.GetAuthorityCode(None) or "local", system.GetLinearUnitsName(), band.GetNoDataValue())


def measure_gpkg(path):
    """Compares the file with the specification, without GDAL's driver, and measures the walls."""
    from osgeo import ogr
    from osgeo_utils.samples import validate_gpkg

    ogr.UseExceptions()
    validate_gpkg.check(path, extra_checks=True, warning_as_error=True)
    data = ogr.Open(path)
    box = data.GetLayer("walls").GetExtent()
    system = data.GetLayer("walls").GetSpatialRef()
    report(*box, system.GetAuthorityCode(None) or system.GetName().replace(" ", "_"), "%g" % system.GetLinearUnits(),
           *("%s:%d" % (layer.GetName(), layer.GetFeatureCount()) for layer in data))


if __name__ == "__main__":
    measure = {"svg": measure_svg, "dxf": measure_dxf, "tif": measure_tif, "gpkg": measure_gpkg}
    try:
        measure[sys.argv[1].rsplit(".", 1)[1]](sys.argv[1])
    except ImportError as missing:
        print(missing, file=sys.stderr)
        sys.exit(77)
