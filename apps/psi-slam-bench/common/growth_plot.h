// SPDX-License-Identifier: BSD-3-Clause
// A small plot of how something grows, logarithmic, as an SVG file.
#pragma once

#include <string>
#include <vector>

namespace psi_slam {

struct GrowthPlot {
  std::string title;
  std::string unit = "ms";          ///< of the values
  std::vector<std::string> labels;  ///< of the places along the horizontal axis, left to right

  struct Line {
    std::string name;
    std::vector<double> values;  ///< one a label; what is not positive is left out
    std::vector<double> low{};   ///< one a value, or none: from where to where it spreads
    std::vector<double> high{};
    bool faint = false;  ///< thin and light, in the colour of the line before
  };
  std::vector<Line> lines;
};

std::string growth_svg(const GrowthPlot& plot);

}  // namespace psi_slam
