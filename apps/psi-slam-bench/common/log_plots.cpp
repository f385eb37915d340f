// SPDX-License-Identifier: BSD-3-Clause
#include "common/log_plots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/number_text.h"
#include "base/portable_math.h"
#include "map/report/html_text.h"

namespace psi_slam {
namespace {

/// A logarithmic axis over whole decades.
struct LogAxis {
  double low = 0.1;
  double high = 1;

  /// Position of a value: 0 at `low`, 1 at `high`.
  double position(double value) const { return portable::log(value / low) / portable::log(high / low); }

  /// Calls draw(value, label) for each decade.
  template <class Draw>
  void for_each_decade(const std::string& unit, const Draw& draw) const {
    for (double value = low; value <= high * 1.001; value *= 10) {
      const int decimals = std::max(0, static_cast<int>(std::lround(-portable::log10(value))));
      draw(value, fixed_text(value, decimals) + ' ' + unit);
    }
  }
};

/// Range of positive values. add() ignores values that are not positive.
struct PositiveRange {
  double least = std::numeric_limits<double>::infinity();
  double most = 0;

  void add(double value) {
    if (!(value > 0)) return;
    least = std::min(least, value);
    most = std::max(most, value);
  }

  /// Axis over the range; from 0.1 to 1 if no positive value was added.
  LogAxis axis() const {
    if (!(most > 0)) return {};
    LogAxis axis{portable::pow(10, std::floor(portable::log10(least))),
                 portable::pow(10, std::ceil(portable::log10(most)))};
    if (axis.high <= axis.low) axis.high = 10 * axis.low;
    return axis;
  }
};

/// Number of pixels as text with one decimal.
std::string px(double pixels) {
  return fixed_text(pixels, 1);
}

/// SVG text element at (x, y) in pixels. `content` is plain text; `attributes` are XML, such as
/// "text-anchor=\"end\"".
std::string svg_text(double x, double y, const std::string& attributes, const std::string& content) {
  return "<text x=\"" + px(x) + "\" y=\"" + px(y) + "\" " + attributes + '>' + escape_html(content) +
         "</text>\n";
}

/// SVG file with a white background. Width and height are in pixels.
std::string svg_page(double width, double height, const std::string& content) {
  const std::string size = fixed_text(width, 0) + ' ' + fixed_text(height, 0);
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + size + "\" width=\"" +
         fixed_text(width, 0) + "\" height=\"" + fixed_text(height, 0) +
         "\" font-family=\"sans-serif\" font-size=\"13\" fill=\"#333\">\n"
         "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n" +
         content + "</svg>\n";
}

namespace growth {

constexpr double kWidth = 760;
constexpr double kHeight = 400;
constexpr double kLeft = 70;
constexpr double kRight = 120;  // room for the names of the lines
constexpr double kTop = 46;
constexpr double kBottom = 40;
constexpr double kNameHeight = 16;
constexpr std::array<const char*, 6> kColours = {"#1f5fa8", "#c2571a", "#2f8f4e",
                                                 "#8a3fa0", "#a88a1f", "#555555"};

LogAxis axis_of(const GrowthPlot& plot) {
  PositiveRange range;
  for (const GrowthPlot::Line& line : plot.lines)
    for (const SeedSpread& spread : line.values)
      for (const double value : {spread.mean, spread.min, spread.max}) range.add(value);
  return range.axis();
}

double y_of(const LogAxis& axis, double value) {
  return kHeight - kBottom - axis.position(value) * (kHeight - kTop - kBottom);
}

double x_of(std::size_t place, std::size_t places) {
  if (places < 2) return kLeft;
  return kLeft + 24 +
         static_cast<double>(place) / static_cast<double>(places - 1) * (kWidth - kLeft - kRight - 48);
}

std::string axes(const GrowthPlot& plot, const LogAxis& axis) {
  std::string svg;
  axis.for_each_decade(plot.unit, [&](double value, const std::string& label) {
    const double y = y_of(axis, value);
    svg += "<path d=\"M" + fixed_text(kLeft, 0) + ',' + px(y) + 'H' + fixed_text(kWidth - kRight, 0) +
           "\" stroke=\"#ddd\"/>\n";
    svg += svg_text(kLeft - 8, y + 4, "text-anchor=\"end\"", label);
  });
  for (std::size_t i = 0; i < plot.labels.size(); ++i)
    svg += svg_text(x_of(i, plot.labels.size()), kHeight - 14, "text-anchor=\"middle\"", plot.labels[i]);
  return svg;
}

/// Vertical positions in pixels of the names of all lines, moved apart where they would overlap; 0 for a
/// faint line, which has no name.
std::vector<double> name_places(const GrowthPlot& plot, const LogAxis& axis) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < plot.lines.size(); ++i) {
    if (plot.lines[i].faint) continue;
    const std::vector<SeedSpread>& values = plot.lines[i].values;
    const double last = values.empty() ? 0 : values.back().mean;
    order.emplace_back(last > 0 ? y_of(axis, last) : kTop, i);
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

/// Bar from the least to the greatest value at label number `place`, with a dash at each end. Empty if the
/// values are equal or the least value is not positive.
std::string spread_svg(const GrowthPlot::Line& line, std::size_t place, const char* colour,
                       const LogAxis& axis) {
  const SeedSpread& spread = line.values[place];
  if (!(spread.min > 0) || !(spread.max > spread.min)) return {};
  constexpr double kDash = 4;
  const double x = x_of(place, line.values.size());
  const std::string low = px(y_of(axis, spread.min));
  const std::string high = px(y_of(axis, spread.max));
  const std::string dash = px(x - kDash) + ',';
  const std::string to = 'H' + px(x + kDash);
  return "<path class=\"spread\" d=\"M" + px(x) + ',' + low + 'V' + high + 'M' + dash + low + to + 'M' +
         dash + high + to + "\" stroke=\"" + colour + "\" fill=\"none\"/>\n";
}

std::string line_svg(const GrowthPlot::Line& line, const char* colour, const LogAxis& axis, double name_y) {
  std::string path;
  std::string dots;
  for (std::size_t i = 0; i < line.values.size(); ++i) {
    if (!(line.values[i].mean > 0)) continue;
    const std::string x = fixed_text(x_of(i, line.values.size()), 1);
    const std::string y = px(y_of(axis, line.values[i].mean));
    path += (path.empty() ? 'M' : 'L') + x + ',' + y;
    dots += spread_svg(line, i, colour, axis) + "<circle cx=\"" + x + "\" cy=\"" + y +
            "\" r=\"3.5\" fill=\"" + colour + "\"/>\n";
  }
  const std::string stroke = "<path d=\"" + path + "\" fill=\"none\" stroke=\"" + colour + '"';
  if (line.faint) return stroke + " stroke-width=\"1\" stroke-opacity=\"0.5\" stroke-dasharray=\"4 3\"/>\n";
  return stroke + " stroke-width=\"2\"/>\n" + dots +
         svg_text(kWidth - kRight + 6, name_y + 4, std::string("fill=\"") + colour + '"', line.name);
}

}  // namespace growth

namespace bars {

constexpr double kWidth = 760;
constexpr double kLeft = 190;  // room for the names of the bars
constexpr double kRight = 90;  // room for the value after the longest bar
constexpr double kTop = 40;
constexpr double kBottom = 30;
constexpr double kPitch = 24;
constexpr double kBarHeight = 16;

double x_of(const LogAxis& axis, double value) {
  return kLeft + axis.position(std::max(value, axis.low)) * (kWidth - kLeft - kRight);
}

LogAxis axis_of(const std::vector<BarPlot::Bar>& bars) {
  PositiveRange range;
  for (const BarPlot::Bar& bar : bars) range.add(bar.value);
  range.least *= 0.9;  // gives the shortest bar a length
  return range.axis();
}

}  // namespace bars
}  // namespace

std::string growth_svg(const GrowthPlot& plot) {
  using namespace growth;
  const LogAxis axis = axis_of(plot);
  std::string svg = svg_text(kLeft, 24, "font-size=\"15\"", plot.title) + axes(plot, axis);
  const std::vector<double> names = name_places(plot, axis);
  std::size_t colours = 0;
  for (std::size_t i = 0; i < plot.lines.size(); ++i) {
    if (i > 0 && !plot.lines[i].faint) ++colours;
    svg += line_svg(plot.lines[i], kColours[colours % kColours.size()], axis, names[i]);
  }
  return svg_page(kWidth, kHeight, svg);
}

std::string bar_svg(const BarPlot& plot) {
  using namespace bars;
  const LogAxis axis = axis_of(plot.bars);
  const double bottom = kTop + kPitch * static_cast<double>(plot.bars.size());
  std::string svg = svg_text(kLeft, 24, "font-size=\"15\"", plot.title);
  axis.for_each_decade(plot.unit, [&](double value, const std::string& label) {
    const double x = x_of(axis, value);
    svg += "<path d=\"M" + px(x) + ',' + px(kTop) + 'V' + px(bottom) + "\" stroke=\"#ddd\"/>\n";
    svg += svg_text(x, bottom + 18, "text-anchor=\"middle\"", label);
  });
  double y = kTop + (kPitch - kBarHeight) / 2;
  for (const BarPlot::Bar& bar : plot.bars) {
    const double end = bar.value > 0 ? x_of(axis, bar.value) : kLeft;
    svg += svg_text(kLeft - 8, y + 13, "text-anchor=\"end\"", bar.name);
    svg += "<rect x=\"" + px(kLeft) + "\" y=\"" + px(y) + "\" width=\"" + px(end - kLeft) + "\" height=\"" +
           px(kBarHeight) + "\" fill=\"" + (bar.ours ? "#c2571a" : "#1f5fa8") + "\"/>\n";
    svg += svg_text(end + 6, y + 13, "font-size=\"12\"", fixed_text(bar.value, 3));
    y += kPitch;
  }
  return svg_page(kWidth, bottom + kBottom, svg);
}

}  // namespace psi_slam
