// SPDX-License-Identifier: BSD-3-Clause
#include "common/bar_plot.h"

#include <algorithm>
#include <cmath>

#include "base/number_text.h"
#include "common/svg_parts.h"

namespace psi_slam {
namespace {

constexpr double kWidth = 760;
constexpr double kLeft = 190;  // room for the names
constexpr double kRight = 90;  // room for a value behind the longest bar
constexpr double kTop = 40;
constexpr double kBottom = 30;
constexpr double kPitch = 24;
constexpr double kBarHeight = 16;

/// The axis: whole decades.
struct Axis {
  double low = 0.1;
  double high = 1;

  double x(double value) const {
    const double share = std::log(std::max(value, low) / low) / std::log(high / low);
    return kLeft + share * (kWidth - kLeft - kRight);
  }
};

Axis axis_of(const std::vector<BarPlot::Bar>& bars) {
  std::vector<double> values;
  for (const BarPlot::Bar& bar : bars)
    if (bar.value > 0) values.push_back(bar.value);
  if (values.empty()) return {};
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  // The least bar has some length too.
  Axis axis{std::pow(10, std::floor(std::log10(0.9 * *least))), std::pow(10, std::ceil(std::log10(*most)))};
  if (axis.high <= axis.low) axis.high = 10 * axis.low;
  return axis;
}

std::string grid(const Axis& axis, double bottom, const std::string& unit) {
  std::string svg;
  for (double value = axis.low; value <= axis.high * 1.001; value *= 10) {
    const std::string x = fixed_text(axis.x(value), 1);
    svg += "<path d=\"M" + x + ',' + fixed_text(kTop, 1) + 'V' + fixed_text(bottom, 1) +
           "\" stroke=\"#ddd\"/>\n";
    const int decimals = std::max(0, static_cast<int>(std::lround(-std::log10(value))));
    svg += svg_text(axis.x(value), bottom + 18, "text-anchor=\"middle\"",
                    fixed_text(value, decimals) + ' ' + unit);
  }
  return svg;
}

}  // namespace

std::string bar_svg(const BarPlot& plot) {
  const Axis axis = axis_of(plot.bars);
  const double bottom = kTop + kPitch * static_cast<double>(plot.bars.size());
  std::string svg = svg_text(kLeft, 24, "font-size=\"15\"", plot.title) + grid(axis, bottom, plot.unit);
  double y = kTop + (kPitch - kBarHeight) / 2;
  for (const BarPlot::Bar& bar : plot.bars) {
    const double end = bar.value > 0 ? axis.x(bar.value) : kLeft;
    svg += svg_text(kLeft - 8, y + 13, "text-anchor=\"end\"", bar.name);
    svg += "<rect x=\"" + fixed_text(kLeft, 1) + "\" y=\"" + fixed_text(y, 1) + "\" width=\"" +
           fixed_text(end - kLeft, 1) + "\" height=\"" + fixed_text(kBarHeight, 1) + "\" fill=\"" +
           (bar.ours ? "#c2571a" : "#1f5fa8") + "\"/>\n";
    svg += svg_text(end + 6, y + 13, "font-size=\"12\"", fixed_text(bar.value, 3));
    y += kPitch;
  }
  return svg_page(kWidth, bottom + kBottom, svg);
}

}  // namespace psi_slam
