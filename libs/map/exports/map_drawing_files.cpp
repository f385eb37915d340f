// SPDX-License-Identifier: BSD-3-Clause
#include <string_view>
#include <utility>

#include "base/number_text.h"
#include "map/exports/drawing_layers.h"
#include "map/exports/map_files.h"
#include "map/rendering/picture_ink.h"

namespace psi_slam {
namespace {

/// Text of a DXF file: pairs of lines, each a group code and its value.
class DxfText {
 public:
  DxfText& pair(int code, const std::string& value) {
    text_ += std::to_string(code) + '\n' + value + '\n';
    return *this;
  }
  DxfText& pair(int code, int value) { return pair(code, std::to_string(value)); }
  /// Writes x under `code`, y under `code` + 10 and z = 0 under `code` + 20.
  DxfText& point(double x, double y, int code = 10) {
    return pair(code, fixed_text(x, 4)).pair(code + 10, fixed_text(y, 4)).pair(code + 20, "0.0");
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

void write_header(DxfText& dxf, const MapRectangle& extent) {
  dxf.pair(999, "Floor plan by psi-slam; one unit is a metre");
  dxf.pair(0, "SECTION").pair(2, "HEADER").pair(9, "$ACADVER").pair(1, "AC1009");
  constexpr int kMetres = 6;
  constexpr int kMetric = 1;
  dxf.pair(9, "$INSUNITS").pair(70, kMetres).pair(9, "$MEASUREMENT").pair(70, kMetric);
  dxf.pair(9, "$EXTMIN").point(extent.x_min_m, extent.y_min_m);
  dxf.pair(9, "$EXTMAX").point(extent.x_max_m, extent.y_max_m);
  dxf.pair(0, "ENDSEC");
}

void write_tables(DxfText& dxf) {
  constexpr int kForeground = 7;
  constexpr int kRed = 1;
  dxf.pair(0, "SECTION").pair(2, "TABLES");
  dxf.pair(0, "TABLE").pair(2, "LTYPE").pair(70, 1);
  dxf.pair(0, "LTYPE").pair(2, "CONTINUOUS").pair(70, 0).pair(3, "Solid line");
  dxf.pair(72, 65).pair(73, 0).pair(40, "0.0").pair(0, "ENDTAB");
  dxf.pair(0, "TABLE").pair(2, "LAYER").pair(70, 3);
  const std::pair<const char*, int> layers[] = {
      {"0", kForeground}, {kWallLayer, kForeground}, {kTrajectoryLayer, kRed}};
  for (const auto& [name, colour] : layers)
    dxf.pair(0, "LAYER").pair(2, name).pair(70, 0).pair(62, colour).pair(6, "CONTINUOUS");
  dxf.pair(0, "ENDTAB").pair(0, "ENDSEC");
}

void write_line(DxfText& dxf, const MapLine& line, const char* layer, bool closed) {
  if (line.size() < 2) return;
  if (line.size() == 2) {
    dxf.pair(0, "LINE").pair(8, layer).point(line[0].x, line[0].y).point(line[1].x, line[1].y, 11);
    return;
  }
  dxf.pair(0, "POLYLINE").pair(8, layer).pair(66, 1).point(0, 0).pair(70, closed ? 1 : 0);
  for (const auto& point : line) dxf.pair(0, "VERTEX").pair(8, layer).point(point.x, point.y);
  dxf.pair(0, "SEQEND").pair(8, layer);
}

// Sizes in millimetres of paper.
constexpr double kMargin_mm = 5;
constexpr double kFooter_mm = 12;
constexpr double kTextHeight_mm = 3.5;
constexpr double kArrow_mm = 8;

std::string svg_number(double value) {
  return trimmed_text(value, 4);
}

std::string path_data(const MapLine& line, std::string_view end) {
  std::string data;
  for (const auto& point : line) {
    data += data.empty() ? 'M' : 'L';
    data += svg_number(point.x) + ' ' + svg_number(point.y);
  }
  return data + std::string(end);
}

/// Returns an SVG group that Inkscape shows as a layer.
std::string layer(const std::string& id, const std::string& style, const std::string& content) {
  return "<g id=\"" + id + "\" inkscape:label=\"" + id + "\" inkscape:groupmode=\"layer\" " + style +
         " transform=\"scale(1,-1)\">\n" + content + "</g>\n";
}

std::string attribute(const char* name, double value) {
  return std::string(" ") + name + "=\"" + svg_number(value) + '"';
}

std::string text_at(double x, double y, double height, const std::string& content) {
  return "<text" + attribute("x", x) + attribute("y", y) + attribute("font-size", height) +
         " font-family=\"sans-serif\" stroke=\"none\">" + content + "</text>\n";
}

/// Returns the scale bar and the axes below the map. (x, y) is the upper left corner of the footer in SVG
/// coordinates. `mm` is the length in the map, in metres, of one millimetre of paper.
std::string footer(double x, double y, double width_m, double mm, double scale) {
  const auto go = [](const char* command, double dx, double dy) {
    return command + svg_number(dx) + ' ' + svg_number(dy);
  };
  const auto along = [](const char* command, double length) { return command + svg_number(length); };
  const double bar_m = scale_bar_m(width_m, 0.01);
  const double middle = y + kFooter_mm / 2 * mm;
  const double tip = kArrow_mm * mm;
  const double axes_x = x + width_m - tip - 4 * mm;
  const double axes_y = y + kFooter_mm * mm;
  const std::string bar = go("M", x, middle - mm) + along("v", 2 * mm) + go("m", 0, -mm) + along("h", bar_m) +
                          go("m", 0, -mm) + along("v", 2 * mm);
  const std::string axes = go("M", axes_x, axes_y - tip) + along("v", tip) + along("h", tip) +
                           go("m", -1.5 * mm, -0.7 * mm) + go("l", 1.5 * mm, 0.7 * mm) +
                           go("l", -1.5 * mm, 0.7 * mm) +
                           go("M", axes_x - 0.7 * mm, axes_y - tip + 1.5 * mm) +
                           go("l", 0.7 * mm, -1.5 * mm) + go("l", 0.7 * mm, 1.5 * mm);
  return "<path d=\"" + bar + "\"/>\n" +
         text_at(x + bar_m + 2 * mm, middle + kTextHeight_mm / 3 * mm, kTextHeight_mm * mm,
                 svg_number(bar_m) + " m, 1:" + svg_number(scale)) +
         "<path id=\"axes\" fill=\"none\" d=\"" + axes + "\"/>\n" +
         text_at(axes_x + tip + mm, axes_y + mm, kTextHeight_mm * mm, "x") +
         text_at(axes_x - 3 * mm, axes_y - tip + mm, kTextHeight_mm * mm, "y");
}

}  // namespace

std::string map_dxf(const MapDrawing& drawing) {
  DxfText dxf;
  write_header(dxf, drawing.extent);
  write_tables(dxf);
  dxf.pair(0, "SECTION").pair(2, "ENTITIES");
  for (const MapLine& wall : drawing.walls) write_line(dxf, wall, kWallLayer, true);
  for (const MapLine& line : drawing.trajectories) write_line(dxf, line, kTrajectoryLayer, false);
  dxf.pair(0, "ENDSEC").pair(0, "EOF");
  return dxf.take();
}

std::string map_svg(const MapDrawing& drawing, double scale) {
  const double mm = scale / 1000;
  const MapRectangle& extent = drawing.extent;
  const double left = extent.x_min_m - kMargin_mm * mm;
  const double top = -extent.y_max_m - kMargin_mm * mm;
  const double width = extent.width_m() + 2 * kMargin_mm * mm;
  const double height = extent.height_m() + (3 * kMargin_mm + kFooter_mm) * mm;

  std::string walls = "<path fill-rule=\"evenodd\" d=\"";
  for (const MapLine& line : drawing.walls) walls += path_data(line, "Z\n");
  walls += "\"/>\n";
  std::string trajectories;
  for (const MapLine& line : drawing.trajectories)
    if (!line.empty()) trajectories += "<path d=\"" + path_data(line, "") + "\"/>\n";

  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
         "<svg xmlns=\"http://www.w3.org/2000/svg\" "
         "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" width=\"" +
         svg_number(width / mm) + "mm\" height=\"" + svg_number(height / mm) + "mm\" viewBox=\"" +
         svg_number(left) + ' ' + svg_number(top) + ' ' + svg_number(width) + ' ' + svg_number(height) +
         "\">\n<title>Floor plan, 1:" + svg_number(scale) + "</title>\n<rect" + attribute("x", left) +
         attribute("y", top) + attribute("width", width) + attribute("height", height) +
         " fill=\"#fff\"/>\n" +
         layer("trajectory",
               "fill=\"none\" stroke=\"#c2410c\" stroke-linejoin=\"round\"" +
                   attribute("stroke-width", 0.25 * mm),
               trajectories) +
         layer("walls",
               "fill=\"#161c26\" stroke=\"#161c26\" stroke-linejoin=\"round\" stroke-linecap=\"round\"" +
                   attribute("stroke-width", drawing.cell_m),
               walls) +
         "<g id=\"legend\" fill=\"none\" stroke=\"#161c26\"" + attribute("stroke-width", 0.35 * mm) +
         ">\n<g fill=\"#161c26\">\n" +
         footer(extent.x_min_m, -extent.y_min_m + kMargin_mm * mm, extent.width_m(), mm, scale) +
         "</g>\n</g>\n</svg>\n";
}

}  // namespace psi_slam
