// SPDX-License-Identifier: BSD-3-Clause
// A bar for each of a few positive values that may lie decades apart, lying, on a logarithmic axis: an SVG
// file.
#pragma once

#include <string>
#include <vector>

namespace psi_slam {

struct BarPlot {
  std::string title;
  std::string unit;

  struct Bar {
    std::string name;
    double value = 0;   ///< of the unit; a bar that is not positive has no length
    bool ours = false;  ///< drawn in another colour
  };
  std::vector<Bar> bars;  ///< from top to bottom
};

std::string bar_svg(const BarPlot& plot);

}  // namespace psi_slam
