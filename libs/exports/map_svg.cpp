// SPDX-License-Identifier: BSD-3-Clause
#include "exports/map_svg.h"

#include <string_view>

#include "rendering/picture_ink.h"
#include "base/number_text.h"

namespace psi_slam {
namespace {

/// In millimetres of paper.
constexpr double kMargin_mm = 5;
constexpr double kFooter_mm = 12;
constexpr double kTextHeight_mm = 3.5;
constexpr double kArrow_mm = 8;

std::string number(double value_m) {
  std::string text = fixed_text(value_m, 4);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string path_data(const MapLine& line, std::string_view end) {
  std::string data;
  for (const auto& point : line) {
    data += data.empty() ? 'M' : 'L';
    data += number(point.x) + ' ' + number(point.y);
  }
  return data + std::string(end);
}

/// A layer, for the programs that know of layers.
std::string layer(const std::string& id, const std::string& style, const std::string& content) {
  return "<g id=\"" + id + "\" inkscape:label=\"" + id + "\" inkscape:groupmode=\"layer\" " + style +
         " transform=\"scale(1,-1)\">\n" + content + "</g>\n";
}

std::string text_at(double x, double y, double height, const std::string& content) {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" font-size=\"" + number(height) +
         "\" font-family=\"sans-serif\" stroke=\"none\">" + content + "</text>\n";
}

/// What stands below the map; `mm` is a millimetre of paper in metres, (x, y) the footer's upper left corner.
std::string footer(double x, double y, double width_m, double mm, double scale) {
  const double bar_m = scale_bar_m(width_m, 0.01);
  const double middle = y + kFooter_mm / 2 * mm;
  const double tip = kArrow_mm * mm;
  const double axes_y = y + kFooter_mm * mm;
  std::string text = "<path d=\"M" + number(x) + ' ' + number(middle - mm) + 'v' + number(2 * mm) + "m0 " +
                     number(-mm) + 'h' + number(bar_m) + "m0 " + number(-mm) + 'v' + number(2 * mm) +
                     "\"/>\n" +
                     text_at(x + bar_m + 2 * mm, middle + kTextHeight_mm / 3 * mm, kTextHeight_mm * mm,
                             number(bar_m) + " m, 1:" + number(scale));
  const double axes_x = x + width_m - tip - 4 * mm;
  text += "<path id=\"axes\" fill=\"none\" d=\"M" + number(axes_x) + ' ' + number(axes_y - tip) + 'v' +
          number(tip) + 'h' + number(tip) + 'm' + number(-1.5 * mm) + ' ' + number(-0.7 * mm) + 'l' +
          number(1.5 * mm) + ' ' + number(0.7 * mm) + 'l' + number(-1.5 * mm) + ' ' + number(0.7 * mm) + 'M' +
          number(axes_x - 0.7 * mm) + ' ' + number(axes_y - tip + 1.5 * mm) + 'l' + number(0.7 * mm) + ' ' +
          number(-1.5 * mm) + 'l' + number(0.7 * mm) + ' ' + number(1.5 * mm) + "\"/>\n";
  text += text_at(axes_x + tip + mm, axes_y + mm, kTextHeight_mm * mm, "x");
  return text + text_at(axes_x - 3 * mm, axes_y - tip + mm, kTextHeight_mm * mm, "y");
}

}  // namespace

std::string map_svg(const MapDrawing& drawing, double scale) {
  const double mm = scale / 1000;
  const DrawingExtent& extent = drawing.extent;
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

  const std::string box = number(left) + ' ' + number(top) + ' ' + number(width) + ' ' + number(height);
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
         "<svg xmlns=\"http://www.w3.org/2000/svg\" "
         "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" width=\"" +
         number(width / mm) + "mm\" height=\"" + number(height / mm) + "mm\" viewBox=\"" + box + "\">\n" +
         "<title>Floor plan, 1:" + number(scale) + "</title>\n<rect x=\"" + number(left) + "\" y=\"" +
         number(top) + "\" width=\"" + number(width) + "\" height=\"" + number(height) +
         "\" fill=\"#fff\"/>\n" +
         layer("trajectory",
               "fill=\"none\" stroke=\"#c2410c\" stroke-linejoin=\"round\" stroke-width=\"" +
                   number(0.25 * mm) + '"',
               trajectories) +
         layer("walls",
               "fill=\"#161c26\" stroke=\"#161c26\" stroke-linejoin=\"round\" stroke-linecap=\"round\" "
               "stroke-width=\"" +
                   number(drawing.cell_m) + '"',
               walls) +
         "<g id=\"legend\" fill=\"none\" stroke=\"#161c26\" stroke-width=\"" + number(0.35 * mm) + "\">\n" +
         "<g fill=\"#161c26\">\n" +
         footer(extent.x_min_m, -extent.y_min_m + kMargin_mm * mm, extent.width_m(), mm, scale) +
         "</g>\n</g>\n</svg>\n";
}

}  // namespace psi_slam
