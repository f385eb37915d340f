// SPDX-License-Identifier: BSD-3-Clause
#include "common/growth_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/number_text.h"
#include "common/svg_parts.h"

namespace psi_slam {
namespace {

constexpr double kWidth = 760;
constexpr double kHeight = 400;
constexpr double kLeft = 70;
constexpr double kRight = 120;  // room for the lines' names
constexpr double kTop = 46;
constexpr double kBottom = 40;
constexpr double kNameHeight = 16;
constexpr std::array<const char*, 6> kColours = {"#1f5fa8", "#c2571a", "#2f8f4e",
                                                 "#8a3fa0", "#a88a1f", "#555555"};

/// Whole decades of the values.
struct Decades {
  double low = 0.1;
  double high = 1;

  double y(double value) const {
    return kHeight - kBottom - std::log(value / low) / std::log(high / low) * (kHeight - kTop - kBottom);
  }
};

Decades decades_of(const GrowthPlot& plot) {
  double least = std::numeric_limits<double>::infinity();
  double most = 0;
  for (const GrowthPlot::Line& line : plot.lines)
    for (const std::vector<double>* values : {&line.values, &line.low, &line.high})
      for (const double value : *values) {
        if (!(value > 0)) continue;
        least = std::min(least, value);
        most = std::max(most, value);
      }
  if (!(most > 0)) return {};
  Decades decades{std::pow(10, std::floor(std::log10(least))), std::pow(10, std::ceil(std::log10(most)))};
  if (decades.high <= decades.low) decades.high = 10 * decades.low;
  return decades;
}

double x_of(std::size_t place, std::size_t places) {
  if (places < 2) return kLeft;
  return kLeft + 24 +
         static_cast<double>(place) / static_cast<double>(places - 1) * (kWidth - kLeft - kRight - 48);
}

std::string axes(const GrowthPlot& plot, const Decades& decades) {
  std::string svg;
  for (double value = decades.low; value <= decades.high * 1.001; value *= 10) {
    const double y = decades.y(value);
    svg += "<path d=\"M" + fixed_text(kLeft, 0) + ',' + fixed_text(y, 1) + 'H' +
           fixed_text(kWidth - kRight, 0) + "\" stroke=\"#ddd\"/>\n";
    const int decimals = std::max(0, static_cast<int>(std::lround(-std::log10(value))));
    svg += svg_text(kLeft - 8, y + 4, "text-anchor=\"end\"", fixed_text(value, decimals) + ' ' + plot.unit);
  }
  for (std::size_t i = 0; i < plot.labels.size(); ++i)
    svg += svg_text(x_of(i, plot.labels.size()), kHeight - 14, "text-anchor=\"middle\"", plot.labels[i]);
  return svg;
}

/// The places of the names beside the lines' ends, moved apart where they would cover each other.
std::vector<double> name_places(const GrowthPlot& plot, const Decades& decades) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < plot.lines.size(); ++i) {
    if (plot.lines[i].faint) continue;
    const std::vector<double>& values = plot.lines[i].values;
    order.emplace_back(values.empty() || !(values.back() > 0) ? kTop : decades.y(values.back()), i);
  }
  std::sort(order.begin(), order.end());
  std::vector<double> places(plot.lines.size());
  double next = kTop;
  for (const auto& [y, line] : order) {
    places[line] = std::max(y, next);
    next = places[line] + kNameHeight;
  }
  return places;
}

/// From the least to the greatest, with a dash at each end; empty where the value does not spread.
std::string spread_svg(const GrowthPlot::Line& line, std::size_t place, const char* colour,
                       const Decades& decades) {
  if (line.low.empty() || !(line.low[place] > 0) || !(line.high[place] > line.low[place])) return {};
  constexpr double kDash = 4;
  const double x = x_of(place, line.values.size());
  const std::string low = fixed_text(decades.y(line.low[place]), 1);
  const std::string high = fixed_text(decades.y(line.high[place]), 1);
  const std::string dash = fixed_text(x - kDash, 1) + ',';
  const std::string to = 'H' + fixed_text(x + kDash, 1);
  return "<path class=\"spread\" d=\"M" + fixed_text(x, 1) + ',' + low + 'V' + high + 'M' + dash + low + to +
         'M' + dash + high + to + "\" stroke=\"" + colour + "\" fill=\"none\"/>\n";
}

std::string line_svg(const GrowthPlot::Line& line, const char* colour, const Decades& decades,
                     double name_y) {
  std::string path;
  std::string dots;
  for (std::size_t i = 0; i < line.values.size(); ++i) {
    if (!(line.values[i] > 0)) continue;
    const std::string x = fixed_text(x_of(i, line.values.size()), 1);
    const std::string y = fixed_text(decades.y(line.values[i]), 1);
    path += (path.empty() ? 'M' : 'L') + x + ',' + y;
    dots += spread_svg(line, i, colour, decades) + "<circle cx=\"" + x + "\" cy=\"" + y +
            "\" r=\"3.5\" fill=\"" + colour + "\"/>\n";
  }
  const std::string stroke = "<path d=\"" + path + "\" fill=\"none\" stroke=\"" + colour + '"';
  if (line.faint) return stroke + " stroke-width=\"1\" stroke-opacity=\"0.5\" stroke-dasharray=\"4 3\"/>\n";
  return stroke + " stroke-width=\"2\"/>\n" + dots +
         svg_text(kWidth - kRight + 6, name_y + 4, std::string("fill=\"") + colour + '"', line.name);
}

}  // namespace

std::string growth_svg(const GrowthPlot& plot) {
  const Decades decades = decades_of(plot);
  std::string svg = svg_text(kLeft, 24, "font-size=\"15\"", plot.title) + axes(plot, decades);
  const std::vector<double> names = name_places(plot, decades);
  std::size_t colours = 0;
  for (std::size_t i = 0; i < plot.lines.size(); ++i) {
    if (i > 0 && !plot.lines[i].faint) ++colours;
    svg += line_svg(plot.lines[i], kColours[colours % kColours.size()], decades, names[i]);
  }
  return svg_page(kWidth, kHeight, svg);
}

}  // namespace psi_slam
