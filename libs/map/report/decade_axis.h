// SPDX-License-Identifier: BSD-3-Clause
// Logarithmic axes of plots, for the report and the window.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// A logarithmic axis of whole decades.
struct DecadeAxis {
  double low = 0.1;  ///< lower end, a power of ten
  double high = 1;   ///< upper end, a larger power of ten

  /// Place of a value on the axis: 0 at the lower end and for all smaller values, 1 at the upper end and for
  /// all larger values.
  double share(double value) const;
};

/// A labelled value of an axis.
struct AxisTick {
  double value = 0;
  std::string label;
};

/// Returns the axis of the fewest decades that includes `least` and `most`, which must be positive.
DecadeAxis decades_around(double least, double most);

/// Returns a tick at each power of ten on the axis, with the text that `label` returns for it.
std::vector<AxisTick> decade_ticks(const DecadeAxis& axis, const std::function<std::string(double)>& label);

/// Returns a power of ten with as many decimals as it needs.
std::string power_text(double value);

/// Returns the axis for values of Psi up to `most`. It includes 1, and reaches one decade below each positive
/// threshold, but at most seven decades down. Psi is 0 if no loop was closed recently, and then has its place
/// at the lower end.
DecadeAxis psi_axis(double most, const PsiThresholds& thresholds);

/// Returns the ticks of a psi_axis(). The label of the lowest says that smaller values are there, too.
std::vector<AxisTick> psi_ticks(const DecadeAxis& axis);

}  // namespace psi_slam
