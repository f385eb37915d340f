// SPDX-License-Identifier: BSD-3-Clause
#include "map/report/decade_axis.h"

#include <algorithm>
#include <cmath>

#include "base/number_text.h"
#include "base/portable_math.h"

namespace psi_slam {

double DecadeAxis::share(double value) const {
  return std::clamp(portable::log(std::max(value, low) / low) / portable::log(high / low), 0.0, 1.0);
}

DecadeAxis decades_around(double least, double most) {
  DecadeAxis axis{portable::pow(10, std::floor(portable::log10(least))),
                  portable::pow(10, std::ceil(portable::log10(most)))};
  if (axis.high <= axis.low) axis.high = 10 * axis.low;
  return axis;
}

std::vector<AxisTick> decade_ticks(const DecadeAxis& axis, const std::function<std::string(double)>& label) {
  std::vector<AxisTick> ticks;
  for (double value = axis.low; value <= axis.high * 1.001; value *= 10)
    ticks.push_back({value, label(value)});
  return ticks;
}

std::string power_text(double value) {
  return fixed_text(value, std::max(0, -static_cast<int>(std::lround(portable::log10(value)))));
}

DecadeAxis psi_axis(double most, const PsiThresholds& thresholds) {
  most = std::max({most, 1.0, thresholds.psi_2});
  double least = 0.1;
  for (const double threshold : {thresholds.psi_1, thresholds.psi_2})
    if (threshold > 0) least = std::min(least, threshold / 10);
  return decades_around(std::max(least, 1e-6 * most), most);
}

std::vector<AxisTick> psi_ticks(const DecadeAxis& axis) {
  std::vector<AxisTick> ticks = decade_ticks(axis, power_text);
  ticks.front().label = "≤ " + ticks.front().label;
  return ticks;
}

}  // namespace psi_slam
