// SPDX-License-Identifier: BSD-3-Clause
// Plots of positive values on a logarithmic axis, as SVG files.
#pragma once

#include <string>
#include <vector>

#include "batch/seeds.h"

namespace psi_slam {

/// Plot of lines over labelled points of the horizontal axis. The vertical axis is logarithmic.
struct GrowthPlot {
  std::string title;
  std::string unit = "ms";          ///< unit of the values
  std::vector<std::string> labels;  ///< labels of the horizontal axis, from left to right

  struct Line {
    std::string name;
    /// One element for each label. The line joins the means, and a bar joins the least and the greatest
    /// value. Means that are not positive are left out.
    std::vector<SeedSpread> values;
    bool faint = false;  ///< drawn thin, without bars and name, in the colour of the preceding line
  };
  std::vector<Line> lines;
};

std::string growth_svg(const GrowthPlot& plot);

/// Horizontal bars, from top to bottom; the horizontal axis is logarithmic.
struct BarPlot {
  std::string title;
  std::string unit;

  struct Bar {
    std::string name;
    double value = 0;   ///< a value that is not positive has a bar of length 0
    bool ours = false;  ///< true for psi-slam: drawn in a different colour
  };
  std::vector<Bar> bars;
};

std::string bar_svg(const BarPlot& plot);

}  // namespace psi_slam
